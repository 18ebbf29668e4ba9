/* The method particle-paper: the paper's particle system as described (paper 3.3 to 3.5). */
#include "core/method/method.h"
#include "core/particle/particles.h"
#include "core/parts/parts.h"
#include "core/particle/refine.h"

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
    P_REFINE,
    P_FAR_CACHE,
    P_PRECISION,
    P_TOLERANCE,
    P_POSITIONS,
    P_COUNT
};

#define LAWS "log|inverse|inverse-square"

static const mote_parameter parameters[P_COUNT] = {
    [P_N] = {"n", MOTE_PARAMETER_INTEGER, 1, 16777216, "auto", "auto",
             "particles on each body; auto: twice its convex parts (paper 3.5)"},
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
    [P_REFINE] =
        {"refine", MOTE_PARAMETER_CHOICE, 0, 0, "no|near|always", "near",
         "exact check of the faces around the closest pair: never, when nearer than the "
         "longest edges around it together, or always (paper 3.4, 3.5)"},
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

typedef enum refine_when { REFINE_NO, REFINE_NEAR, REFINE_ALWAYS } refine_when;

typedef struct paper_state {
    mote_particles *particles;
    refine_when refine;
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

/* Twice the convex parts of the body that has more of them (paper 3.5), but no more than either
   body has vertices. */
static mote_status automatic_count(const mote_setup *setup, uint32_t *count)
{
    uint32_t most = 1;
    uint32_t limit = UINT32_MAX;
    for (int b = 0; b < 2; ++b) {
        const mote_mesh *mesh = setup->body[b]->mesh;
        limit = mesh->vertex_count < limit ? mesh->vertex_count : limit;
        if (b == 1 && mesh == setup->body[0]->mesh)
            break;
        mote_parts *parts = NULL;
        const mote_status status = mote_parts_create(mesh, NULL, &parts);
        if (status != MOTE_OK)
            return status;
        most = parts->count > most ? parts->count : most;
        mote_parts_destroy(parts);
    }
    *count = 2 * most < limit ? 2 * most : limit;
    return MOTE_OK;
}

static mote_particles_options options_of(const mote_setup *setup, uint32_t count)
{
    const double *v = setup->values;
    mote_particles_options o = mote_default_particles_options();
    o.count = count;
    o.attract[0] = law_of(v, P_ATTRACT_A);
    o.attract[1] = law_of(v, P_ATTRACT_B);
    o.repel[0] = law_of(v, P_REPEL_A);
    o.repel[1] = law_of(v, P_REPEL_B);
    o.effective_radius = v[P_REFF];
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
    if (setup->values[P_REFINE] != REFINE_NO)
        return 0;
    return setup->body[0]->mesh->mean_edge + setup->body[1]->mesh->mean_edge;
}

static mote_status create(const mote_setup *setup, void **state)
{
    uint32_t count = (uint32_t)fmax(setup->values[P_N], 0);
    mote_status status = MOTE_OK;
    if (setup->values[P_N] == MOTE_AUTO)
        status = automatic_count(setup, &count);
    if (status != MOTE_OK)
        return status;
    paper_state *made = calloc(1, sizeof *made);
    if (!made)
        return mote_fail(MOTE_ENOMEM, "no memory for particle-paper");
    const mote_particles_options options = options_of(setup, count);
    status = mote_particles_create(setup->body, setup->length, &options, &made->particles);
    if (status != MOTE_OK) {
        free(made);
        return status;
    }
    made->refine = (refine_when)setup->values[P_REFINE];
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

/* The vertex of a site that is nearest to a point. */
static uint32_t nearest_vertex(mote_lazy *lazy, mote_site site, mote_vec3 p)
{
    const uint32_t vertices[3] = {site.a, site.b, site.c};
    uint32_t best = site.a;
    double least = HUGE_VAL;
    for (int k = 0; k < 3; ++k) {
        const double squared = mote_distance_squared(mote_lazy_position(lazy, vertices[k]), p);
        if (squared < least) {
            least = squared;
            best = vertices[k];
        }
    }
    return best;
}

/* The size of the faces around a vertex: its longest edge. */
static double longest_edge(mote_lazy *lazy, uint32_t vertex)
{
    const mote_mesh *mesh = lazy->body->mesh;
    const mote_vec3 centre = mote_lazy_position(lazy, vertex);
    double longest = 0;
    for (uint32_t k = mesh->ring_start[vertex]; k < mesh->ring_start[vertex + 1]; ++k) {
        const uint32_t u = MOTE_RING_VERTEX(mesh->ring[k]);
        longest = fmax(longest, mote_distance_squared(mote_lazy_position(lazy, u), centre));
    }
    return sqrt(longest);
}

/* The exact check in the neighbourhood of the closest pair, when it is due. */
static void refine_pair(paper_state *s, const uint32_t pair[2], mote_answer *answer)
{
    mote_lazy *const lazy[2] = {mote_particles_lazy(s->particles, 0),
                                mote_particles_lazy(s->particles, 1)};
    uint32_t vertex[2];
    for (int b = 0; b < 2; ++b)
        vertex[b] = nearest_vertex(lazy[b], mote_particles_site(s->particles, b, pair[b]),
                                   answer->witness[1 - b]);
    if (s->refine == REFINE_NEAR &&
        answer->distance > longest_edge(lazy[0], vertex[0]) + longest_edge(lazy[1], vertex[1]))
        return;
    mote_refined refined;
    const double enough = s->ask == MOTE_ASK_CONTACT ? s->contact_distance : 0;
    mote_refine_vertices(lazy, vertex, enough * enough, &refined);
    answer->counters.refined = 1;
    answer->counters.triangle_tests = refined.triangle_tests;
    const double distance = sqrt(refined.squared);
    if (distance >= answer->distance)
        return; /* a particle between vertices may already be nearer */
    answer->distance = distance;
    answer->witness[0] = refined.witness[0];
    answer->witness[1] = refined.witness[1];
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
    const mote_status status = mote_refuse_infinite(answer->distance);
    if (status != MOTE_OK)
        return status;
    const bool known = s->ask == MOTE_ASK_CONTACT && answer->distance <= s->contact_distance;
    if (s->refine != REFINE_NO && !known)
        refine_pair(s, pair, answer);
    answer->contact = answer->distance <= s->contact_distance;
    answer->has_distance = answer->has_witness = answer->has_contact = true;
    answer->counters.positions = evaluated(s) - before;
    return MOTE_OK;
}

static size_t particles(const void *state, int body, mote_vec3 *positions, size_t capacity)
{
    const paper_state *s = state;
    const uint32_t count = mote_particles_count(s->particles);
    for (uint32_t i = 0; i < count && i < capacity; ++i)
        positions[i] = mote_particles_position(s->particles, body, i);
    return count;
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
    .particles = particles,
};
