/* The method certified: the exact distance with its proof (docs/architecture.md). */
#include "core/certificate/bracket.h"
#include "core/certificate/certificate.h"
#include "core/particle/tracker.h"

#include <math.h>
#include <stdlib.h>

enum {
    P_SEED,
    P_SLACK,
    P_BUDGET,
    P_WIDTH,
    P_FITS,
    P_PLANE,
    P_DIRECTIONS,
    P_RESTARTS,
    P_THREADS,
    P_COUNT
};

static const mote_parameter parameters[] = {
    [P_SEED] = {.key = "seed",
                .kind = MOTE_PARAMETER_CHOICE,
                .choices = "witness|pair|none|tracked",
                .fallback = "witness",
                .help = "first upper bound: the last faces, refined (witness) or as they are "
                        "(pair); none: no state is kept; tracked: from tracked particles"},
    [P_SLACK] = MOTE_PARAMETER_SLACK,
    [P_BUDGET] = MOTE_PARAMETER_BUDGET,
    [P_WIDTH] = {.key = "width",
                 .kind = MOTE_PARAMETER_CHOICE,
                 .choices = "8|4|2",
                 .fallback = "8",
                 .help = "children of a block of the tree"},
    [P_FITS] = {.key = "fits",
                .kind = MOTE_PARAMETER_CHOICE,
                .choices = "linear|constant",
                .fallback = "linear",
                .help = "boxes follow the field's linear fit, or only its mean"},
    [P_PLANE] = {.key = "plane",
                 .kind = MOTE_PARAMETER_CHOICE,
                 .choices = "on|off",
                 .fallback = "on",
                 .help = "first rule out what lies on its own side of a plane across the gap"},
    [P_DIRECTIONS] = {.key = "directions",
                      .kind = MOTE_PARAMETER_CHOICE,
                      .choices = "on|off",
                      .fallback = "on",
                      .help =
                          "look for a direction that separates two leaves before testing their "
                          "triangles"},
    [P_RESTARTS] = {.key = "restarts",
                    .kind = MOTE_PARAMETER_INTEGER,
                    .minimum = 0,
                    .maximum = 100,
                    .fallback = "6",
                    .help =
                        "the traversal starts again at most this often after an improvement"},
    [P_THREADS] = {.key = "build",
                   .kind = MOTE_PARAMETER_INTEGER,
                   .minimum = 1,
                   .maximum = 2,
                   .fallback = "1",
                   .help = "threads that build the two trees"},
};

/* The choices of seed, in the table's order. */
enum { SEED_WITNESS, SEED_PAIR, SEED_NONE, SEED_TRACKED };

typedef struct certified_state {
    mote_certificate *certificate;
    mote_tracker *tracker; /* or NULL */
    mote_ask ask;
    double tolerance;
    bool exact; /* no slack */
} certified_state;

static mote_traits traits(const double *values)
{
    return (mote_traits){.needs_field = true,
                         .keeps_state = (int)values[P_SEED] != SEED_NONE,
                         .exact = !(values[P_SLACK] > 0) && isinf(values[P_BUDGET])};
}

static mote_certificate_options options_of(const mote_setup *setup)
{
    static const mote_cert_seed seeds[] = {[SEED_WITNESS] = MOTE_CERT_SEED_WITNESS,
                                           [SEED_PAIR] = MOTE_CERT_SEED_PAIR,
                                           [SEED_NONE] = MOTE_CERT_SEED_NONE,
                                           [SEED_TRACKED] = MOTE_CERT_SEED_PAIR};
    static const uint32_t widths[] = {8, 4, 2};
    const double *v = setup->values;
    mote_certificate_options options = mote_default_certificate_options(setup->length);
    options.seed = seeds[(int)v[P_SEED]];
    options.slack = v[P_SLACK];
    options.budget = mote_budget_of(v[P_BUDGET]);
    options.width = widths[(int)v[P_WIDTH]];
    options.linear_fits = !(v[P_FITS] > 0);
    options.plane = !(v[P_PLANE] > 0);
    options.directions = !(v[P_DIRECTIONS] > 0);
    options.restarts = (uint32_t)v[P_RESTARTS];
    options.threads = (uint32_t)v[P_THREADS];
    return options;
}

static void destroy(void *state)
{
    certified_state *s = state;
    if (!s)
        return;
    mote_certificate_destroy(s->certificate);
    mote_tracker_destroy(s->tracker);
    free(s);
}

static mote_status create(const mote_setup *setup, void **state)
{
    certified_state *made = calloc(1, sizeof *made);
    if (!made)
        return mote_fail(MOTE_ENOMEM, "no memory for certified");
    const mote_certificate_options options = options_of(setup);
    mote_status status = mote_certificate_create(setup->body, &options, &made->certificate);
    if (status == MOTE_OK && (int)setup->values[P_SEED] == SEED_TRACKED) {
        const mote_tracker_options defaults = mote_default_tracker_options();
        status = mote_tracker_create(setup->body, setup->length, &defaults, &made->tracker);
    }
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
    certified_state *s = state;
    const bool contact_only = s->ask == MOTE_ASK_CONTACT;
    const uint32_t(*first)[3] = NULL;
    mote_refined best;
    if (s->tracker) {
        const double enough = contact_only ? s->tolerance * s->tolerance : 0;
        mote_tracker_query(s->tracker, frame, false, HUGE_VAL, enough, &answer->counters,
                           &best);
        if (best.squared < HUGE_VAL)
            first = (const uint32_t(*)[3])best.triangle;
    }
    mote_certificate_answer found;
    mote_certificate_query(s->certificate, frame, first, contact_only ? s->tolerance : -1,
                           &found);
    mote_certificate_report(&found, s->ask, s->tolerance, s->exact, answer);
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
