/* Tracked particles behind the contract of methods: core/particle/tracker.h. */
#include "core/method/method.h"
#include "core/parts/parts.h"
#include "core/particle/tracker.h"

#include <math.h>
#include <stdlib.h>

/* n=auto chooses at least this. */
#define LEAST_SEEDS 8

enum {
    P_N,
    P_LAUNCH,
    P_TRACK,
    P_REFINE,
    P_START,
    P_DESCEND,
    P_RESEED,
    P_LEAP,
    P_FORCES,
    P_SEED,
    P_POSITIONS,
    P_COUNT
};

static const mote_parameter parameters[] = {
    [P_N] = {"n", MOTE_PARAMETER_INTEGER, 0, 1e6, "auto", "auto",
             "seeds on each body, at least one a connected component; 0: only the last closest "
             "pair is followed; auto: twice the convex parts, at least 8 (paper 3.5)"},
    [P_LAUNCH] = {"launch", MOTE_PARAMETER_INTEGER, 0, 1e6, "auto", "auto",
                  "seeds of each body that each warm query descends from, in turn, besides n "
                  "in every 0.2 L of "
                  "motion; auto: 0"},
    [P_TRACK] = {"track", MOTE_PARAMETER_INTEGER, 0, MOTE_TRACK_MAX, NULL, "8",
                 "local minima followed from query to query"},
    [P_REFINE] = {"refine", MOTE_PARAMETER_INTEGER, 1, MOTE_TRACK_MAX, NULL, "4",
                  "exact checks a query, at most (paper 3.5)"},
    [P_START] = {"start", MOTE_PARAMETER_CHOICE, 0, 0, "random|fps", "fps",
                 "seeds: at random, or farthest points"},
    [P_DESCEND] = {"descend", MOTE_PARAMETER_CHOICE, 0, 0, "off|on", "on",
                   "walk coarse to fine from each seed; off: check the nearest seeds as they "
                   "are"},
    [P_RESEED] = {"reseed", MOTE_PARAMETER_CHOICE, 0, 0, "off|on", "on",
                  "launch from the seeds each time; off: from where the last launch passed"},
    [P_LEAP] =
        {"leap", MOTE_PARAMETER_CHOICE, 0, 0, "off|on", "on",
         "also descend from around the nearest pair, in turn, as far as motion calls for"},
    [P_FORCES] = {"forces", MOTE_PARAMETER_CHOICE, 0, 0, "off|on", "off",
                  "the paper's forces move the seeds before each launch (paper 3.3)"},
    [P_SEED] = {"seed", MOTE_PARAMETER_INTEGER, 0, 9007199254740991.0, "auto", "auto",
                "random number that chooses the first seed on each body; auto: the run's"},
    [P_POSITIONS] = {"positions", MOTE_PARAMETER_CHOICE, 0, 0, "lazy|given", "lazy",
                     "vertices: deformed when looked at, or given by the animation"},
};

typedef struct particle_state {
    mote_tracker *tracker;
    bool given;
    mote_ask ask;
    double tolerance;
} particle_state;

static mote_traits traits(const double *values)
{
    const mote_traits t = {.given_vertices = values[P_POSITIONS] > 0, .keeps_state = true};
    return t;
}

/* Twice the convex parts of the body that has more of them. */
static mote_status default_count(const mote_setup *setup, uint32_t *count)
{
    uint32_t most = LEAST_SEEDS;
    for (int b = 0; b < 2; ++b) {
        if (b == 1 && setup->body[1]->mesh == setup->body[0]->mesh)
            break;
        mote_parts *parts = NULL;
        const mote_status status = mote_parts_create(setup->body[b]->mesh, NULL, &parts);
        if (status != MOTE_OK)
            return status;
        if (2 * parts->count > most)
            most = 2 * parts->count;
        mote_parts_destroy(parts);
    }
    for (int b = 0; b < 2; ++b) {
        if (most > setup->body[b]->mesh->vertex_count)
            most = setup->body[b]->mesh->vertex_count;
    }
    *count = most;
    return MOTE_OK;
}

static mote_status options_of(const mote_setup *setup, mote_tracker_options *options)
{
    const double *v = setup->values;
    mote_tracker_options o = mote_default_tracker_options();
    mote_status status = MOTE_OK;
    if (v[P_N] == MOTE_AUTO)
        status = default_count(setup, &o.count);
    else
        o.count = (uint32_t)v[P_N];
    o.launch = v[P_LAUNCH] == MOTE_AUTO ? 0 : (uint32_t)v[P_LAUNCH];
    o.track = (uint32_t)v[P_TRACK];
    o.refine = (uint32_t)v[P_REFINE];
    o.farthest = v[P_START] > 0;
    o.descend = v[P_DESCEND] > 0;
    o.reseed = v[P_RESEED] > 0;
    o.leap = v[P_LEAP] > 0;
    o.forces = v[P_FORCES] > 0;
    o.seed = v[P_SEED] == MOTE_AUTO ? setup->seed : (uint64_t)v[P_SEED];
    *options = o;
    return status;
}

static mote_status create(const mote_setup *setup, void **state)
{
    mote_tracker_options options;
    mote_status status = options_of(setup, &options);
    if (status != MOTE_OK)
        return status;
    particle_state *made = calloc(1, sizeof *made);
    if (!made)
        return mote_fail(MOTE_ENOMEM, "no memory for particle");
    status = mote_tracker_create(setup->body, setup->length, &options, &made->tracker);
    if (status != MOTE_OK) {
        free(made);
        return status;
    }
    made->given = setup->values[P_POSITIONS] > 0;
    made->ask = setup->ask;
    made->tolerance = setup->tolerance;
    *state = made;
    return MOTE_OK;
}

static void destroy(void *state)
{
    particle_state *s = state;
    if (!s)
        return;
    mote_tracker_destroy(s->tracker);
    free(s);
}

static mote_status query(void *state, const mote_frame *frame, mote_answer *answer)
{
    particle_state *s = state;
    const double tolerance_squared = s->tolerance * s->tolerance;
    const bool only_contact = s->ask == MOTE_ASK_CONTACT;
    mote_refined best;
    mote_tracker_query(s->tracker, frame, s->given, only_contact ? tolerance_squared : HUGE_VAL,
                       only_contact ? tolerance_squared : 0, &answer->counters, &best);
    const double distance = sqrt(best.squared);
    const mote_status status = only_contact ? MOTE_OK : mote_refuse_infinite(distance);
    if (status != MOTE_OK)
        return status;
    answer->has_contact = true;
    answer->contact = distance <= s->tolerance;
    if (only_contact)
        return MOTE_OK;
    answer->has_distance = answer->has_witness = true;
    answer->distance = distance;
    answer->witness[0] = best.witness[0];
    answer->witness[1] = best.witness[1];
    return MOTE_OK;
}

static size_t particles(const void *state, int body, mote_vec3 *positions, size_t capacity)
{
    const particle_state *s = state;
    return mote_tracker_particles(s->tracker, body, positions, capacity);
}

MOTE_METHOD(particle) = {
    .name = "particle",
    .summary = "tracked particles: minima followed, seeds descending coarse to fine",
    .parameters = parameters,
    .parameter_count = P_COUNT,
    .traits = traits,
    .create = create,
    .destroy = destroy,
    .query = query,
    .particles = particles,
};
