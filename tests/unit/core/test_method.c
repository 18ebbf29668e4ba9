/* What stands for the functions that a method leaves out. */
#include "core/method/method.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

static mote_status query(void *state, const mote_frame *frame, mote_answer *answer)
{
    (void)frame;
    answer->distance = ((const mote_setup *)state)->length;
    return MOTE_OK;
}

static const mote_method least = {.name = "least", .query = query};

static void method_create_without_one_keeps_the_setup(void **unused)
{
    (void)unused;
    mote_setup setup = {.length = 3.5, .tolerance = 0.25};
    mote_answer answer = {0};
    void *state = NULL;
    assert_int_equal(mote_method_create(&least, &setup, &state), MOTE_OK);
    assert_ptr_not_equal(state, &setup);
    setup.length = 1;
    assert_int_equal(least.query(state, NULL, &answer), MOTE_OK);
    assert_true(answer.distance == 3.5);
    mote_method_destroy(&least, state);
    mote_method_destroy(&least, NULL);
}

static void method_traits_without_them_are_none(void **unused)
{
    (void)unused;
    mote_traits traits = mote_method_traits(&least, NULL);
    assert_false(traits.needs_vertices || traits.given_vertices || traits.keeps_state ||
                 traits.exact || traits.hulls);
}

static void method_functions_of_its_own_are_used(void **unused)
{
    (void)unused;
    const mote_method *method = mote_method_find("certified");
    double values[MOTE_PARAMETERS_MAX];
    assert_non_null(method);
    mote_parameters_default(method->parameters, method->parameter_count, values);
    assert_true(mote_method_traits(method, values).exact);
    mote_method_destroy(method, NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(method_create_without_one_keeps_the_setup),
        cmocka_unit_test(method_traits_without_them_are_none),
        cmocka_unit_test(method_functions_of_its_own_are_used),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
