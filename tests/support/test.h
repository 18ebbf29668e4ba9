/* Tests that register themselves, run by cmocka:

       TEST(mesh_without_faces_is_refused)
       {
           assert_int_equal(...);
       }

   Every executable of tests/ links test_main.c, which runs its tests in the order of the
   source, in a new folder (folder.h). An argument runs only the tests whose names match a
   pattern: `test_mesh 'mesh_without_*'`. */
#ifndef MOTE_TESTS_TEST_H
#define MOTE_TESTS_TEST_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

typedef struct test_case {
    const char *name;
    void (*run)(void);
    int line; /* of the source; tests run in this order */
    struct test_case *next;
} test_case;

/* Fixtures return 0 when they are done; anything else fails the tests. */
typedef int (*test_fixture)(void);

/* Both keep pointers to their arguments. A fixture may be NULL. */
void test_register(test_case *test);
void test_register_group(test_fixture before_all, test_fixture after_all);
void test_register_each(test_fixture before, test_fixture after);

/* Names the table row that the following checks are about; printed if the test fails there. */
void test_row(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* How often a text contains another one, which is not empty. */
size_t test_count(const char *text, const char *wanted);

/* How many elements an array has. */
#define ROWS_OF(array) (sizeof(array) / sizeof(array)[0])

#define TEST_AT_START(function)                                                                \
    __attribute__((constructor)) static void function(void);                                   \
    static void function(void)

#define TEST(name)                                                                             \
    static void name(void);                                                                    \
    TEST_AT_START(register_##name)                                                             \
    {                                                                                          \
        static test_case test = {#name, name, __LINE__, NULL};                                 \
        test_register(&test);                                                                  \
    }                                                                                          \
    static void name(void)

/* Runs functions before the first test and after the last, at most once a program. */
#define TEST_GROUP(before_all, after_all)                                                      \
    TEST_AT_START(register_group)                                                              \
    {                                                                                          \
        test_register_group(before_all, after_all);                                            \
    }                                                                                          \
    typedef int test_group_is_registered

/* Runs functions before and after each test, at most once a program. */
#define TEST_EACH(before, after)                                                               \
    TEST_AT_START(register_each)                                                               \
    {                                                                                          \
        test_register_each(before, after);                                                     \
    }                                                                                          \
    typedef int test_each_is_registered

#endif
