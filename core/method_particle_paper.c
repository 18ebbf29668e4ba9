/* The method `particle-paper`: the paper's particle system as it stands (paper 3.3 to 3.5). */
#include "core/method.h"
#include "core/particles.h"

#include <math.h>
#include <stdlib.h>

enum parameter_index {
    P_N,
    P_LAW,
    P_ATTRACT_A,
    P_ATTRACT_B,
    P_REPEL_A,
    P_REPEL_B,
    P_REFF,
    P_NMIN,
    P_NMAX,
    P_MOVE,
    P_START,
    P_SEED,
    P_COHERENT,
    P_FAR_CACHE,
    P_PRECISION,
    P_TOLERANCE,
    P_POSITIONS,
    P_COUNT
};

#define LAWS "log|inverse|inverse-square"

static const mote_parameter parameters[P_COUNT] = {
    [P_N] = {"n", MOTE_PARAMETER_INTEGER, 1, 16777216, NULL, "8",
             "particles on each body (paper 3.2)"},
    [P_LAW] = {"law", MOTE_PARAMETER_CHOICE, 0, 0, LAWS, "log",
               "potential of attraction and repulsion (paper 3.3)"},
    [P_ATTRACT_A] = {"attract_a", MOTE_PARAMETER_CHOICE, 0, 0, "law|" LAWS, "law",
                     "law by which the first body's particles are attracted"},
    [P_ATTRACT_B] = {"attract_b", MOTE_PARAMETER_CHOICE, 0, 0, "law|" LAWS, "law",
                     "law by which the second body's particles are attracted"},
    [P_REPEL_A] = {"repel_a", MOTE_PARAMETER_CHOICE, 0, 0, "law|" LAWS, "law",
                   "law by which the first body's particles repel each other"},
    [P_REPEL_B] = {"repel_b", MOTE_PARAMETER_CHOICE, 0, 0, "law|" LAWS, "law",
                   "law by which the second body's particles repel each other"},
    [P_REFF] = {"reff", MOTE_PARAMETER_REAL, 0, HUGE_VAL, NULL, "1",
                "effective radius of attraction over L (paper 3.3)"},
    [P_NMIN] = {"nmin", MOTE_PARAMETER_INTEGER, 0, 33554432, "auto", "auto",
                "a query ends when fewer particles move in a step; auto: n/10 (paper 3.5)"},
    [P_NMAX] = {"nmax", MOTE_PARAMETER_INTEGER, 0, 1e9, "auto", "auto",
                "steps at most; auto: the square root of the vertex count (paper 3.5)"},
    [P_MOVE] = {"move", MOTE_PARAMETER_CHOICE, 0, 0, "vertex|surface", "vertex",
                "sites: vertices, or edge midpoints and face centroids too (paper 3.4)"},
    [P_START] = {"start", MOTE_PARAMETER_CHOICE, 0, 0, "random|fps", "random",
                 "first places: random or farthest points (paper 3.3)"},
    [P_SEED] = {"seed", MOTE_PARAMETER_INTEGER, 0, 9007199254740991, "auto", "auto",
                "seed of the first places; auto: the run's"},
    [P_COHERENT] = {"coherent", MOTE_PARAMETER_CHOICE, 0, 0, "no|yes", "yes",
                    "start where the last query ended (paper 3.5), or anew"},
    [P_FAR_CACHE] =
        {"far_cache", MOTE_PARAMETER_REAL, 0, 1, NULL, "0",
         "part by which a distance may change before a distant influence is computed "
         "anew; 0: always anew (paper 3.5)"},
    [P_PRECISION] = {"precision", MOTE_PARAMETER_CHOICE, 0, 0, "double|single", "double",
                     "positions evaluated and remembered as double or float (lazy positions)"},
    [P_TOLERANCE] = {"tolerance", MOTE_PARAMETER_REAL, 0, HUGE_VAL, "auto", "auto",
                     "added to the scenario's tolerance for a contact, over L; auto: two mean "
                     "edges when vertices stand for the surface"},
    [P_POSITIONS] = {"positions", MOTE_PARAMETER_CHOICE, 0, 0, "lazy|given", "lazy",
                     "vertices: deformed when looked at, or given by the animation"},
};

typedef struct paper_state {
    mote_particles *particles;
    bool given;
    mote_ask ask;
    double contact_distance; /* the scenario's tolerance and the declared resolution */
} paper_state;

static mote_traits traits(const double *values)
{
    const mote_traits t = {.given_vertices = values[P_POSITIONS] > 0,
                           .keeps_state = values[P_COHERENT] > 0};
    return t;
}

static mote_law law_of(const double *values, int key)
{
    return (mote_law)(values[key] > 0 ? values[key] - 1 : values[P_LAW]);
}

static uint32_t default_nmax(const mote_setup *setup)
{
    const uint32_t a = setup->body[0]->mesh->vertex_count;
    const uint32_t b = setup->body[1]->mesh->vertex_count;
    return (uint32_t)ceil(sqrt(a > b ? a : b));
}

static mote_particles_options options_of(const mote_setup *setup)
{
    const double *v = setup->values;
    mote_particles_options o = mote_default_particles_options();
    o.count = (uint32_t)v[P_N];
    o.attract[0] = law_of(v, P_ATTRACT_A);
    o.attract[1] = law_of(v, P_ATTRACT_B);
    o.repel[0] = law_of(v, P_REPEL_A);
    o.repel[1] = law_of(v, P_REPEL_B);
    o.reach = v[P_REFF];
    o.nmin = v[P_NMIN] == MOTE_AUTO ? o.count / 10 : (uint32_t)v[P_NMIN];
    o.nmax = v[P_NMAX] == MOTE_AUTO ? default_nmax(setup) : (uint32_t)v[P_NMAX];
    o.surface = v[P_MOVE] > 0;
    o.start = v[P_START] > 0 ? MOTE_START_FARTHEST : MOTE_START_RANDOM;
    o.seed = v[P_SEED] == MOTE_AUTO ? setup->seed : (uint64_t)v[P_SEED];
    o.far_cache = v[P_FAR_CACHE];
    o.single = v[P_PRECISION] > 0;
    o.coherent = v[P_COHERENT] > 0;
    return o;
}

static double resolution_of(const mote_setup *setup)
{
    if (setup->values[P_TOLERANCE] != MOTE_AUTO)
        return setup->values[P_TOLERANCE] * setup->length;
    return setup->body[0]->mesh->mean_edge + setup->body[1]->mesh->mean_edge;
}

static mote_status create(const mote_setup *setup, void **state)
{
    paper_state *made = calloc(1, sizeof *made);
    if (!made)
        return mote_fail(MOTE_ENOMEM, "no memory for particle-paper");
    const mote_particles_options options = options_of(setup);
    const mote_status status =
        mote_particles_create(setup->body, setup->length, &options, &made->particles);
    if (status != MOTE_OK) {
        free(made);
        return status;
    }
    made->given = setup->values[P_POSITIONS] > 0;
    made->ask = setup->ask;
    made->contact_distance = setup->tolerance + resolution_of(setup);
    *state = made;
    return MOTE_OK;
}

static void destroy(void *state)
{
    paper_state *s = state;
    if (!s)
        return;
    mote_particles_destroy(s->particles);
    free(s);
}

static uint64_t evaluated(const paper_state *s)
{
    return mote_particles_lazy(s->particles, 0)->evaluated +
           mote_particles_lazy(s->particles, 1)->evaluated;
}

static mote_status query(void *state, const mote_frame *frame, mote_answer *answer)
{
    paper_state *s = state;
    const uint64_t before = evaluated(s);
    mote_particles_begin(s->particles, frame, s->given);
    mote_particles_relax(s->particles, s->ask == MOTE_ASK_CONTACT ? s->contact_distance : -1,
                         &answer->counters);
    uint32_t pair[2];
    answer->distance = sqrt(mote_particles_closest(s->particles, pair));
    answer->witness[0] = mote_particles_position(s->particles, 0, pair[0]);
    answer->witness[1] = mote_particles_position(s->particles, 1, pair[1]);
    answer->contact = answer->distance <= s->contact_distance;
    answer->has_distance = answer->has_witness = answer->has_contact = true;
    answer->counters.positions = evaluated(s) - before;
    return MOTE_OK;
}

MOTE_METHOD(particle_paper) = {
    .name = "particle-paper",
    .summary = "the paper's particle system: attraction across, repulsion on each body",
    .parameters = parameters,
    .parameter_count = P_COUNT,
    .traits = traits,
    .create = create,
    .destroy = destroy,
    .query = query,
};
