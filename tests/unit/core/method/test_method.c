/* Defaults for the functions that a method leaves out. */
#include "core/method/method.h"
#include "tests/support/methods.h"
#include "tests/support/test.h"

#include <stddef.h>

static mote_status query(void *state, const mote_frame *frame, mote_answer *answer)
{
    (void)frame;
    answer->distance = ((const mote_setup *)state)->length;
    return MOTE_OK;
}

static const mote_method least = {.name = "least", .query = query};

TEST(method_create_without_one_keeps_the_setup)
{
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

TEST(method_traits_without_them_are_none)
{
    mote_traits traits = mote_method_traits(&least, NULL);
    assert_false(traits.needs_vertices || traits.given_vertices || traits.keeps_state ||
                 traits.exact || traits.hulls);
}

TEST(method_functions_of_its_own_are_used)
{
    double values[MOTE_PARAMETERS_MAX];
    const mote_method *method = method_with("certified", "", values);
    assert_true(mote_method_traits(method, values).exact);
    mote_method_destroy(method, NULL);
}
