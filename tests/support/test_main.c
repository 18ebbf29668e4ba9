/* Runs the tests that registered themselves (test.h). */
#include "tests/support/test.h"

#include "tests/support/folder.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static test_case *first;
static size_t count;
static test_fixture before_all, after_all, before_each, after_each;
static char row[256]; /* of a table in the test that runs, or "" */

/* Compilers choose the order of constructors, so tests are sorted here. */
void test_register(test_case *test)
{
    test_case **place = &first;
    while (*place && (*place)->line < test->line)
        place = &(*place)->next;
    test->next = *place;
    *place = test;
    ++count;
}

void test_register_group(test_fixture before, test_fixture after)
{
    before_all = before;
    after_all = after;
}

void test_register_each(test_fixture before, test_fixture after)
{
    before_each = before;
    after_each = after;
}

size_t test_count(const char *text, const char *wanted)
{
    size_t times = 0;
    for (const char *at = text; (at = strstr(at, wanted)) != NULL; at += strlen(wanted))
        ++times;
    return times;
}

static int run_fixture(test_fixture fixture)
{
    return fixture ? fixture() : 0;
}

static int set_up_group(void **state)
{
    (void)state;
    return run_fixture(before_all);
}

static int tear_down_group(void **state)
{
    (void)state;
    return run_fixture(after_all);
}

static int set_up(void **state)
{
    (void)state;
    return run_fixture(before_each);
}

/* The row is still set if the test did not reach its end. */
static int tear_down(void **state)
{
    (void)state;
    if (row[0])
        print_error("in the row %s\n", row);
    row[0] = '\0';
    return run_fixture(after_each);
}

void test_row(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    (void)vsnprintf(row, sizeof row, format, arguments);
    va_end(arguments);
}

static void run_registered(void **state)
{
    const test_case *test = *state;
    test->run();
    row[0] = '\0';
}

int main(int argc, char **argv)
{
    const char *slash = strrchr(argv[0], '/');
    const char *program = slash ? slash + 1 : argv[0];
    struct CMUnitTest *tests = calloc(count + 1, sizeof *tests);
    if (count == 0 || !tests) {
        fprintf(stderr, "%s: %s\n", program, count == 0 ? "no test" : "out of memory");
        free(tests);
        return EXIT_FAILURE;
    }
    size_t filled = 0;
    for (test_case *test = first; test; test = test->next)
        tests[filled++] =
            (struct CMUnitTest){test->name, run_registered, set_up, tear_down, test};
    if (argc > 1)
        cmocka_set_test_filter(argv[1]);
    /* What the macro cmocka_run_group_tests calls; the macro takes only arrays of fixed
       size. */
    int failed = EXIT_FAILURE;
    if (folder_enter(program)) {
        failed = _cmocka_run_group_tests(program, tests, filled, set_up_group, tear_down_group);
        failed = folder_leave() ? failed : EXIT_FAILURE;
    }
    free(tests);
    return failed;
}
