/* The method certified: the exact distance with its proof (DESIGN section 5). */
#include "core/certificate.h"

#include <math.h>
#include <stdlib.h>

enum { P_SEED, P_SLACK, P_BUDGET, P_WIDTH, P_FITS, P_PLANE, P_DIRECTIONS, P_RESTARTS, P_COUNT };

static const mote_parameter parameters[] = {
    [P_SEED] = {.key = "seed",
                .kind = MOTE_PARAMETER_CHOICE,
                .choices = "witness|pair|none",
                .fallback = "witness",
                .help = "first upper bound: the last faces, refined or not, or none: no state "
                        "is kept"},
    [P_SLACK] = {.key = "slack",
                 .kind = MOTE_PARAMETER_REAL,
                 .minimum = 0,
                 .maximum = 1,
                 .fallback = "0",
                 .help = "stop when upper - lower <= slack L, and return both"},
    [P_BUDGET] = {.key = "budget",
                  .kind = MOTE_PARAMETER_REAL,
                  .minimum = 0,
                  .maximum = HUGE_VAL,
                  .fallback = "inf",
                  .help = "stop after so many pairs of boxes, and return the bracket"},
    [P_WIDTH] = {.key = "width",
                 .kind = MOTE_PARAMETER_CHOICE,
                 .choices = "8|4|2",
                 .fallback = "8",
                 .help = "children a block of the tree"},
    [P_FITS] = {.key = "fits",
                .kind = MOTE_PARAMETER_CHOICE,
                .choices = "linear|constant",
                .fallback = "linear",
                .help = "how boxes follow the field: its gradient or its mean"},
    [P_PLANE] = {.key = "plane",
                 .kind = MOTE_PARAMETER_CHOICE,
                 .choices = "on|off",
                 .fallback = "on",
                 .help = "rule out what is beyond a plane across the gap, tree by tree"},
    [P_DIRECTIONS] = {.key = "directions",
                      .kind = MOTE_PARAMETER_CHOICE,
                      .choices = "on|off",
                      .fallback = "on",
                      .help = "test leaf pairs along directions before their triangles"},
    [P_RESTARTS] = {.key = "restarts",
                    .kind = MOTE_PARAMETER_INTEGER,
                    .minimum = 0,
                    .maximum = 100,
                    .fallback = "6",
                    .help = "how often the traversal starts again after an improvement"},
};

typedef struct certified_state {
    mote_certificate *certificate;
    mote_ask ask;
    double tolerance;
    bool exact; /* no slack */
} certified_state;

static mote_traits traits(const double *values)
{
    return (mote_traits){.keeps_state = values[P_SEED] < 2,
                         .exact = !(values[P_SLACK] > 0) && isinf(values[P_BUDGET])};
}

static mote_certificate_options options_of(const mote_setup *setup)
{
    static const mote_cert_seed seeds[] = {MOTE_CERT_SEED_WITNESS, MOTE_CERT_SEED_PAIR,
                                           MOTE_CERT_SEED_NONE};
    static const uint32_t widths[] = {8, 4, 2};
    const double *v = setup->values;
    mote_certificate_options options = mote_default_certificate_options(setup->length);
    options.seed = seeds[(int)v[P_SEED]];
    options.slack = v[P_SLACK];
    options.budget = v[P_BUDGET] < 0x1p63 ? (uint64_t)v[P_BUDGET] : UINT64_MAX;
    options.width = widths[(int)v[P_WIDTH]];
    options.linear_fits = !(v[P_FITS] > 0);
    options.plane = !(v[P_PLANE] > 0);
    options.directions = !(v[P_DIRECTIONS] > 0);
    options.restarts = (uint32_t)v[P_RESTARTS];
    return options;
}

static void destroy(void *state)
{
    certified_state *s = state;
    if (!s)
        return;
    mote_certificate_destroy(s->certificate);
    free(s);
}

static mote_status create(const mote_setup *setup, void **state)
{
    certified_state *made = calloc(1, sizeof *made);
    if (!made)
        return mote_fail(MOTE_ENOMEM, "no memory for certified");
    const mote_certificate_options options = options_of(setup);
    const mote_status status =
        mote_certificate_create(setup->body, &options, &made->certificate);
    if (status != MOTE_OK) {
        free(made);
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
    certified_state *s = state;
    const bool contact_only = s->ask == MOTE_ASK_CONTACT;
    mote_certificate_answer found;
    mote_certificate_query(s->certificate, frame, NULL, contact_only ? s->tolerance : -1,
                           &found);
    answer->distance = found.distance;
    answer->lower = found.lower;
    answer->witness[0] = found.witness[0];
    answer->witness[1] = found.witness[1];
    answer->contact = found.distance <= s->tolerance;
    /* A contact question ends before the distance is known. */
    answer->has_distance = !contact_only;
    answer->has_witness = !contact_only || answer->contact;
    answer->has_lower = true;
    /* A bracket around the tolerance leaves the contact open. */
    answer->has_contact =
        answer->contact || found.lower > s->tolerance || (s->exact && !found.stopped);
    answer->counters = found.counters;
    return MOTE_OK;
}

MOTE_METHOD(certified) = {
    .name = "certified",
    .summary = "the exact distance, proven by rest trees deformed on demand",
    .parameters = parameters,
    .parameter_count = P_COUNT,
    .traits = traits,
    .create = create,
    .destroy = destroy,
    .query = query,
};
