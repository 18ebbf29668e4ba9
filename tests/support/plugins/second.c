/* A method in a library of its own, beside another one; for test_plugin. */
#include <mote/method.h>

static mote_traits traits(const double *values)
{
    mote_traits own = {0};
    (void)values;
    return own;
}

static mote_status query(void *state, const mote_frame *frame, mote_answer *answer)
{
    (void)state;
    answer->has_distance = true;
    answer->distance = (double)frame->number;
    return MOTE_OK;
}

MOTE_METHOD(second) = {
    "plugin-second", "counts frames", NULL, 0, traits, NULL, NULL, NULL, query, NULL};
