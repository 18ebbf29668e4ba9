/* Allocations that succeed, and ones that fail: the process ends with one line and a status. */
#include "harness/base/memory.h"

#include "harness/process/child.h"
#include "harness/base/options.h"
#include "tests/support/program.h"
#include "tests/support/test.h"

#include <stdint.h>

TEST(allocate_gives_zeroed_blocks_also_for_nothing)
{
    unsigned char *block = mote_allocate(1000, 3);
    for (int i = 0; i < 3000; ++i)
        assert_int_equal(block[i], 0);
    free(block);
    void *nothing = mote_allocate(0, 8);
    assert_non_null(nothing);
    free(nothing);
}

TEST(resize_keeps_what_was_there)
{
    int *numbers = mote_resize(NULL, 2, sizeof *numbers);
    numbers[0] = 1, numbers[1] = 2;
    numbers = mote_resize(numbers, 100000, sizeof *numbers);
    assert_true(numbers[0] == 1 && numbers[1] == 2);
    numbers = mote_resize(numbers, 0, sizeof *numbers);
    assert_non_null(numbers);
    free(numbers);
}

TEST(reserve_grows_to_twice_what_is_needed)
{
    size_t capacity = 0;
    int *numbers = NULL;
    for (size_t i = 0; i < 1000; ++i) {
        const size_t before = capacity;
        numbers = mote_reserve(numbers, i + 1, &capacity, sizeof *numbers);
        assert_true(capacity >= i + 1);
        assert_true(capacity == before || capacity == 2 * (i + 1));
        numbers[i] = (int)i;
    }
    for (int i = 0; i < 1000; ++i)
        assert_int_equal(numbers[i], i);
    free(numbers);
}

TEST(duplicate_is_another_block_with_the_same_text)
{
    static const char text[] = "frames";
    char *copy = mote_duplicate(text);
    assert_true(copy != text);
    assert_string_equal(copy, text);
    free(copy);
}

static void ask_for_half_of_all(void)
{
    free(mote_allocate(SIZE_MAX / 2 + 1, 1));
}

static void ask_for_more_than_all(void)
{
    free(mote_allocate(SIZE_MAX / 2, 4));
}

static void grow_beyond_all(void)
{
    free(mote_resize(NULL, SIZE_MAX / 2, 4));
}

static void grow_to_half_of_all(void)
{
    size_t capacity = 0;
    free(mote_reserve(NULL, SIZE_MAX / 2, &capacity, 1));
}

/* Runs work in a process and returns its exit status; text receives its output. */
static int status_after(void (*work)(void), char text[512])
{
    static const char said[] = "test_memory_said";
    (void)fflush(NULL);
    const pid_t pid = fork();
    if (pid == 0) {
        const int out = open(said, O_WRONLY | O_CREAT | O_TRUNC, 0644);
        if (out < 0 || dup2(out, STDERR_FILENO) < 0 || dup2(out, STDOUT_FILENO) < 0)
            _exit(99);
        printf("half of a table");
        work();
        _exit(0);
    }
    const int status = program_wait(pid);
    program_read(said, text, 512);
    (void)remove(said);
    return status;
}

TEST(memory_that_runs_out_ends_the_process_with_a_line_and_a_status)
{
    static void (*const works[])(void) = {ask_for_half_of_all, ask_for_more_than_all,
                                          grow_beyond_all, grow_to_half_of_all};
    static const char *const bytes[] = {"9223372036854775808", "18446744073709551615",
                                        "18446744073709551615", "9223372036854775807"};
    for (size_t i = 0; i < sizeof works / sizeof works[0]; ++i) {
        char text[512], expected[256];
        assert_int_equal(status_after(works[i], text), MOTE_EXIT_OUT_OF_MEMORY);
        (void)snprintf(expected, sizeof expected,
                       "mote: out of memory for another %s bytes; use a machine with more, or "
                       "ask for less at a time: what was finished is kept\n",
                       bytes[i]);
        /* AddressSanitizer reports it first, in a line of its own. */
        const char *line = strncmp(text, "==", 2) == 0 ? strchr(text, '\n') : NULL;
        assert_string_equal(line ? line + 1 : text, expected);
    }
}

static mote_status ask_for_too_much(void *context, int output)
{
    static const char part[] = "a part of the answer";
    (void)context;
    (void)mote_child_put(output, part, sizeof part);
    ask_for_half_of_all();
    return MOTE_OK;
}

TEST(memory_that_runs_out_in_a_child_is_its_status)
{
    const mote_child_limits limits = {.seconds = 20, .output_bytes = 1 << 16};
    char *output = NULL;
    size_t size = 0;
    assert_int_equal(mote_child_run("the cell", ask_for_too_much, NULL, limits, &output, &size),
                     MOTE_ENOMEM);
    assert_null(output);
    assert_non_null(strstr(mote_error_text(), "out of memory for another 92"));
}

TEST(command_that_fails_for_memory_ends_with_that_status)
{
    (void)mote_fail(MOTE_ENOMEM, "no memory for a mesh");
    assert_int_equal(mote_command_fail(), MOTE_EXIT_OUT_OF_MEMORY);
    (void)mote_fail(MOTE_EINVAL, "no mesh");
    assert_int_equal(mote_command_fail(), MOTE_EXIT_BAD_INPUT);
}
