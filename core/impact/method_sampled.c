/* The method impact-sampled, the control of impacts: contact is asked for at moments that are
   evenly spread over the time, as by a program that knows nothing but frames, and the first
   that is in contact is bisected. What lies between two moments it cannot see. */
#include "core/certificate/certificate.h"
#include "core/method/impact_method.h"

#include <stdlib.h>

enum { P_SAMPLES, P_COUNT };

static const mote_parameter parameters[P_COUNT] = {
    [P_SAMPLES] = {.key = "samples",
                   .kind = MOTE_PARAMETER_INTEGER,
                   .minimum = 1,
                   .maximum = 1e6,
                   .fallback = "10",
                   .help = "moments after the first, evenly spread, the last one at the end"},
};

/* Width to which the first contact is bisected, as a part of the time: that of certified. */
#define RESOLUTION 1e-6

typedef struct sampled_state {
    mote_certificate *certificate;
    mote_body body[2];
    double *weights[2];
    mote_frame frame;
    double tolerance;
    uint32_t samples;
} sampled_state;

static mote_traits traits(const double *values)
{
    (void)values;
    return (mote_traits){.needs_field = true};
}

static mote_status refuse(const mote_setup *setup, void **state)
{
    (void)setup;
    (void)state;
    return mote_fail(MOTE_EUNSUPPORTED,
                     "impact-sampled answers impacts alone; for distances and "
                     "contacts take certified");
}

static void destroy(void *state)
{
    sampled_state *s = state;
    if (!s)
        return;
    mote_certificate_destroy(s->certificate);
    free(s->weights[0]);
    free(s->weights[1]);
    free(s);
}

/* Never called: there is no state to call it with. */
static mote_status no_query(void *state, const mote_frame *frame, mote_answer *answer)
{
    (void)frame;
    (void)answer;
    return refuse(NULL, state);
}

static mote_status create(const mote_setup *setup, uint32_t pieces, void **state)
{
    (void)pieces;
    sampled_state *made = calloc(1, sizeof *made);
    if (!made)
        return mote_fail(MOTE_ENOMEM, "no memory for impact-sampled");
    made->tolerance = setup->tolerance;
    made->samples = (uint32_t)setup->values[P_SAMPLES];
    mote_status status = MOTE_OK;
    for (int i = 0; i < 2 && status == MOTE_OK; ++i) {
        made->body[i] = *setup->body[i];
        made->weights[i] = calloc(3 * (size_t)made->body[i].field->padded + 1, sizeof(double));
        if (!made->weights[i])
            status = mote_fail(MOTE_ENOMEM, "no memory for impact-sampled");
    }
    const mote_certificate_options options = mote_default_certificate_options(setup->length);
    if (status == MOTE_OK)
        status = mote_certificate_create(setup->body, &options, &made->certificate);
    if (status == MOTE_OK)
        *state = made;
    else
        destroy(made);
    return status;
}

/* Whether the bodies are in contact at a time; then with its witnesses. */
static bool touch_at(sampled_state *s, const mote_path *const path[2], double time,
                     mote_impact_answer *answer)
{
    mote_certificate_answer at;
    for (int i = 0; i < 2; ++i)
        mote_path_state(path[i], &s->body[i], time, s->weights[i], &s->frame.body[i]);
    ++s->frame.number;
    mote_certificate_query(s->certificate, &s->frame, NULL, s->tolerance, &at);
    ++answer->iterations;
#define ADD(name) answer->counters.name += at.counters.name;
    MOTE_COUNTERS(ADD)
    MOTE_COUNTERS_MORE(ADD)
#undef ADD
    if (at.distance > s->tolerance)
        return false;
    answer->has_witness = true;
    answer->witness[0] = at.witness[0];
    answer->witness[1] = at.witness[1];
    return true;
}

static mote_status query(void *state, const mote_path *const path[2],
                         mote_impact_answer *answer)
{
    sampled_state *s = state;
    answer->answered = true;
    for (uint32_t i = 0; i <= s->samples && !answer->impact; ++i) {
        answer->to = (double)i / s->samples;
        answer->impact = touch_at(s, path, answer->to, answer);
        if (!answer->impact)
            answer->from = answer->to;
    }
    while (answer->impact && answer->to - answer->from > RESOLUTION) {
        const double middle = 0.5 * (answer->from + answer->to);
        *(touch_at(s, path, middle, answer) ? &answer->to : &answer->from) = middle;
    }
    return MOTE_OK;
}

MOTE_METHOD(impact_sampled) = {
    .name = "impact-sampled",
    .summary = "impacts by certified contacts at evenly spread moments; a control",
    .parameters = parameters,
    .parameter_count = P_COUNT,
    .traits = traits,
    .create = refuse,
    .destroy = destroy,
    .query = no_query,
};

MOTE_IMPACT(impact_sampled) = {.method = "impact-sampled",
                               .alone = true,
                               .create = create,
                               .destroy = destroy,
                               .query = query};
