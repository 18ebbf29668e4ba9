/* The method stream: the exact distance of bodies of which only positions are known. */
#include "core/certificate/bracket.h"
#include "core/stream/stream.h"

#include <math.h>
#include <stdlib.h>

enum { P_SEED, P_SLACK, P_BUDGET, P_POSITIONS, P_COUNT };

static const mote_parameter parameters[] = {
    [P_SEED] = {.key = "seed",
                .kind = MOTE_PARAMETER_CHOICE,
                .choices = "witness|none",
                .fallback = "witness",
                .help = "first upper bound: the last faces, refined (witness); none: from the "
                        "boxes, and no state is kept"},
    [P_SLACK] = MOTE_PARAMETER_SLACK,
    [P_BUDGET] = MOTE_PARAMETER_BUDGET,
    [P_POSITIONS] = {.key = "positions",
                     .kind = MOTE_PARAMETER_CHOICE,
                     .choices = "given|deform",
                     .fallback = "given",
                     .help = "given: they come free of charge; deform: pay for deforming all "
                             "vertices"},
};

typedef struct stream_state {
    mote_stream *stream;
    mote_ask ask;
    double tolerance;
    bool exact;    /* no slack */
    bool answered; /* the frame before was answered */
} stream_state;

static mote_traits traits(const double *values)
{
    const bool given = !(values[P_POSITIONS] > 0);
    return (mote_traits){.needs_vertices = !given,
                         .given_vertices = given,
                         .keeps_state = !(values[P_SEED] > 0),
                         .exact = !(values[P_SLACK] > 0) && isinf(values[P_BUDGET])};
}

static void destroy(void *state)
{
    stream_state *s = state;
    if (!s)
        return;
    mote_stream_destroy(s->stream);
    free(s);
}

static mote_status create(const mote_setup *setup, void **state)
{
    const double *v = setup->values;
    mote_stream_options options = mote_default_stream_options(setup->length);
    options.coherent = !(v[P_SEED] > 0);
    options.slack = v[P_SLACK];
    options.budget = mote_budget_of(v[P_BUDGET]);
    stream_state *made = calloc(1, sizeof *made);
    if (!made)
        return mote_fail(MOTE_ENOMEM, "no memory for stream");
    mote_status status = mote_stream_create(setup->body, &options, &made->stream);
    if (status != MOTE_OK) {
        destroy(made);
        return status;
    }
    made->ask = setup->ask;
    made->tolerance = setup->tolerance;
    made->exact = !(options.slack > 0);
    *state = made;
    return MOTE_OK;
}

static mote_status query(void *state, const mote_frame *frame, mote_answer *answer)
{
    stream_state *s = state;
    const bool contact_only = s->ask == MOTE_ASK_CONTACT;
    mote_stream_frame now;
    for (int b = 0; b < 2; ++b) {
        const mote_body_state *body = &frame->body[b];
        now.positions[b] = mote_positions_of(body->vertices);
        now.unchanged[b] = s->answered && !body->shape_changed && !body->pose_changed;
    }
    mote_certificate_answer bracket;
    mote_status status =
        mote_stream_query(s->stream, &now, contact_only ? s->tolerance : -1, &bracket);
    s->answered = status == MOTE_OK;
    if (status == MOTE_OK)
        mote_certificate_report(&bracket, s->ask, s->tolerance, s->exact, answer);
    return status;
}

MOTE_METHOD(stream) = {
    .name = "stream",
    .summary = "the exact distance, from arrays of positions read once a frame",
    .parameters = parameters,
    .parameter_count = P_COUNT,
    .traits = traits,
    .create = create,
    .destroy = destroy,
    .query = query,
};
