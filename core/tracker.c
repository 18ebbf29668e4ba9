#include "core/tracker.h"

#include "core/descent.h"
#include "core/particles.h"

#include <stdlib.h>
#include <string.h>

/* Seeds live on the finest level that has at most this many nodes, or five times their number:
   descents that start on coarse levels take fewer steps, and end at least as near. */
#define SEED_NODES_MAX 200

/* Relative motion since the last query, in units of L, at which every seed is launched. */
#define COLD_MOTION 0.1

/* Vertices that a query is likely to visit on one body. */
#define EXPECTED_VERTICES 512

/* Steps of the forces a query, and the part of the particles whose rest ends them. */
#define FORCE_STEPS 3
#define FORCE_REST 5

/* One body as the tracker sees it. */
typedef struct tracked_body {
    const mote_mesh *mesh;
    mote_lazy own_lazy;
    mote_lazy *lazy; /* own_lazy, or that of the forces */
    const mote_levels *levels;
    int seed_level;
    uint32_t seed_count;
    uint32_t *seed;    /* [seed_count], nodes of seed_level, where launches start */
    mote_place *place; /* [seed_count], of this frame */
    uint32_t turn;     /* the seed that is launched next */
    uint32_t *home;    /* with forces: the node of seed_level in whose cell a vertex is */
} tracked_body;

/* A vertex of each body. */
typedef struct candidate {
    double squared;          /* of their distance */
    double reach_squared[2]; /* of the longest edge at each */
    uint32_t vertex[2];
    mote_vec3 world[2];
    bool refined;
} candidate;

/* How the bodies stood to each other at the last query. */
typedef struct memory {
    bool known;        /* there was a last query, and it looked everywhere */
    bool has_triangle; /* its nearest pair was checked exactly */
    uint32_t triangle[2][3], vertex[2];
    mote_vec3 offset;   /* between those vertices, seen from body 0 */
    mote_mat3 rotation; /* of body 1 seen from body 0 */
    mote_vec3 centre;   /* of body 1's box at rest seen from body 0's */
} memory;

struct mote_tracker {
    mote_tracker_options options;
    double length;
    mote_levels *owned_levels[2]; /* [1] is NULL when the bodies share a mesh */
    tracked_body body[2];
    mote_particles *particles; /* NULL without forces */
    candidate candidates[MOTE_TRACK_MAX];
    uint32_t candidate_count;
    uint32_t pair[MOTE_TRACK_MAX][2]; /* minima of the last query */
    uint32_t pair_count;
    memory last;
};

/* What a query is about. */
typedef struct request {
    mote_tracker *tracker;
    mote_ground ground[2];
    mote_lazy *lazy[2];
    double worth_squared, enough_squared;
    uint32_t refined;
    mote_counters *counters;
    mote_refined *best;
} request;

mote_tracker_options mote_default_tracker_options(void)
{
    const mote_tracker_options options = {.count = 8,
                                          .launch = 2,
                                          .track = 8,
                                          .refine = 4,
                                          .farthest = true,
                                          .descend = true,
                                          .reseed = true,
                                          .seed = 1};
    return options;
}

static mote_status check_options(const mote_body *const bodies[2],
                                 const mote_tracker_options *options)
{
    for (int b = 0; b < 2; ++b) {
        if (options->count > bodies[b]->mesh->vertex_count)
            return mote_fail(MOTE_EINVAL,
                             "n=%u is not valid; body %d has %u vertices, so n must be "
                             "from 0 to %u",
                             options->count, b, bodies[b]->mesh->vertex_count,
                             bodies[b]->mesh->vertex_count);
    }
    if (options->track > MOTE_TRACK_MAX || options->refine < 1)
        return mote_fail(MOTE_EINVAL,
                         "track=%u, refine=%u is not valid; track must be from 0 to %d, refine "
                         "at least 1",
                         options->track, options->refine, MOTE_TRACK_MAX);
    return MOTE_OK;
}

/* The finest level that is small enough, or the coarsest. */
static int choose_seed_level(const mote_levels *levels, uint32_t count)
{
    const uint32_t most = 5 * count > SEED_NODES_MAX ? 5 * count : SEED_NODES_MAX;
    int level = 0;
    while (level + 1 < (int)levels->depth && levels->level[level].count > most)
        ++level;
    return level;
}

static mote_status place_seeds(tracked_body *body, const mote_tracker_options *options)
{
    const uint32_t components = body->mesh->component_count;
    const uint32_t nodes = body->levels->level[body->seed_level].count;
    const uint32_t wanted = options->count > components ? options->count : components;
    body->seed_count = wanted < nodes ? wanted : nodes;
    body->seed = malloc(body->seed_count * sizeof *body->seed);
    body->place = malloc(body->seed_count * sizeof *body->place);
    if (!body->seed || !body->place)
        return mote_fail(MOTE_ENOMEM, "no memory for %u seeds", body->seed_count);
    return mote_levels_spread(body->levels, body->mesh, (uint32_t)body->seed_level,
                              body->seed_count, options->farthest, options->seed, body->seed);
}

static mote_status make_body(mote_tracker *t, int b, const mote_body *body)
{
    tracked_body *tracked = &t->body[b];
    tracked->mesh = body->mesh;
    tracked->lazy = &tracked->own_lazy;
    mote_status status = MOTE_OK;
    if (b == 1 && body->mesh == t->body[0].mesh) {
        tracked->levels = t->owned_levels[0];
    } else {
        status = mote_levels_create(body->mesh, &t->owned_levels[b]);
        tracked->levels = t->owned_levels[b];
    }
    if (status != MOTE_OK)
        return status;
    tracked->seed_level = choose_seed_level(tracked->levels, t->options.count);
    if (t->options.count > 0)
        status = place_seeds(tracked, &t->options);
    if (status == MOTE_OK && !t->options.forces)
        status = mote_lazy_init(&tracked->own_lazy, body, EXPECTED_VERTICES);
    return status;
}

/* With forces the particles' positions are the tracker's too. */
static mote_status make_particles(mote_tracker *t, const mote_body *const bodies[2])
{
    mote_particles_options options = mote_default_particles_options();
    options.count = t->options.count;
    for (int b = 0; b < 2; ++b) {
        if (t->body[b].mesh->component_count > options.count)
            options.count = t->body[b].mesh->component_count;
    }
    options.nmin = options.count / FORCE_REST;
    options.nmax = FORCE_STEPS;
    options.coherent = !t->options.reseed;
    options.start = t->options.farthest ? MOTE_START_FARTHEST : MOTE_START_RANDOM;
    options.seed = t->options.seed;
    mote_status status = mote_particles_create(bodies, t->length, &options, &t->particles);
    for (int b = 0; b < 2 && status == MOTE_OK; ++b) {
        tracked_body *body = &t->body[b];
        body->lazy = mote_particles_lazy(t->particles, b);
        body->seed_count = options.count;
        free(body->seed);
        free(body->place);
        body->seed = calloc(options.count, sizeof *body->seed);
        body->place = calloc(options.count, sizeof *body->place);
        if (!body->seed || !body->place)
            status = mote_fail(MOTE_ENOMEM, "no memory for %u seeds", options.count);
        else
            status = mote_levels_home(body->levels, body->mesh, (uint32_t)body->seed_level,
                                      &body->home);
    }
    return status;
}

mote_status mote_tracker_create(const mote_body *const bodies[2], double length,
                                const mote_tracker_options *options, mote_tracker **tracker)
{
    mote_status status = check_options(bodies, options);
    if (status != MOTE_OK)
        return status;
    mote_tracker *made = calloc(1, sizeof *made);
    if (!made)
        return mote_fail(MOTE_ENOMEM, "no memory for a tracker");
    made->options = *options;
    made->options.forces = options->forces && options->count > 0;
    made->length = length;
    for (int b = 0; b < 2 && status == MOTE_OK; ++b)
        status = make_body(made, b, bodies[b]);
    if (status == MOTE_OK && made->options.forces)
        status = make_particles(made, bodies);
    if (status != MOTE_OK) {
        mote_tracker_destroy(made);
        return status;
    }
    *tracker = made;
    return MOTE_OK;
}

void mote_tracker_destroy(mote_tracker *tracker)
{
    if (!tracker)
        return;
    for (int b = 0; b < 2; ++b) {
        mote_lazy_free(&tracker->body[b].own_lazy);
        free(tracker->body[b].seed);
        free(tracker->body[b].place);
        free(tracker->body[b].home);
        mote_levels_destroy(tracker->owned_levels[b]);
    }
    mote_particles_destroy(tracker->particles);
    free(tracker);
}

/* The square of the longest edge at a vertex, in the shape. */
static double reach_squared(const mote_ground *ground, uint32_t vertex)
{
    const mote_mesh *mesh = ground->lazy->body->mesh;
    const mote_vec3 p = ground->shape[vertex];
    double longest = 0;
    for (uint32_t k = mesh->ring_start[vertex]; k < mesh->ring_start[vertex + 1]; ++k) {
        const mote_vec3 q = ground->shape[MOTE_RING_VERTEX(mesh->ring[k])];
        longest = fmax(longest, mote_distance_squared(p, q));
    }
    return longest;
}

/* Two candidates whose vertices are within a ring of each other lead to the same minimum. */
static bool alike(const candidate *c, const candidate *d)
{
    return mote_distance_squared(c->world[0], d->world[0]) <= d->reach_squared[0] &&
           mote_distance_squared(c->world[1], d->world[1]) <= d->reach_squared[1];
}

/* Puts a candidate in its place by distance, unless one like it is nearer; drops those like it
   that are not, and the last one when the list is full. */
static void keep(request *r, candidate c)
{
    mote_tracker *t = r->tracker;
    uint32_t kept = 0;
    for (uint32_t i = 0; i < t->candidate_count; ++i) {
        const candidate *d = &t->candidates[i];
        if (alike(&c, d)) {
            if (d->squared <= c.squared || d->refined)
                return;
            continue;
        }
        t->candidates[kept++] = *d;
    }
    t->candidate_count = kept;
    if (kept == MOTE_TRACK_MAX) {
        if (t->candidates[kept - 1].squared <= c.squared)
            return;
        --kept;
    }
    uint32_t i = kept;
    for (; i > 0 && t->candidates[i - 1].squared > c.squared; --i)
        t->candidates[i] = t->candidates[i - 1];
    t->candidates[i] = c;
    t->candidate_count = kept + 1;
}

static void keep_places(request *r, const mote_place at[2], double squared)
{
    candidate c = {.squared = squared,
                   .vertex = {at[0].vertex, at[1].vertex},
                   .world = {at[0].world, at[1].world}};
    for (int b = 0; b < 2; ++b)
        c.reach_squared[b] = reach_squared(&r->ground[b], c.vertex[b]);
    keep(r, c);
}

static bool found_enough(const request *r)
{
    return r->best->squared <= r->enough_squared;
}

/* Estimates whether an exact check of two vertices can come below what is wanted. Walks end by
   the shape, not at a minimum of the frame, so that the gain is more than where no neighbour is
   nearer: about half of the longest edges there. */
static bool worth_refining(const request *r, const candidate *c)
{
    const double reach = sqrt(c->reach_squared[0]) + sqrt(c->reach_squared[1]);
    const double wanted = fmin(r->best->squared, r->worth_squared);
    return sqrt(c->squared) - 0.5 * reach <= sqrt(wanted);
}

static void take_result(request *r, const mote_refined *result)
{
    ++r->refined;
    ++r->counters->refined;
    r->counters->triangle_tests += result->triangle_tests;
    if (result->squared < r->best->squared)
        *r->best = *result;
}

static candidate vertex_candidate(const request *r, const uint32_t vertex[2])
{
    candidate c = {.vertex = {vertex[0], vertex[1]}};
    for (int b = 0; b < 2; ++b) {
        c.world[b] = mote_lazy_position(r->lazy[b], vertex[b]);
        c.reach_squared[b] = reach_squared(&r->ground[b], vertex[b]);
    }
    c.squared = mote_distance_squared(c.world[0], c.world[1]);
    return c;
}

/* The candidate that an exact check ended at. */
static candidate result_candidate(const request *r, const mote_refined *result)
{
    candidate c = vertex_candidate(r, result->vertex);
    c.refined = true;
    return c;
}

static void refine_last(request *r)
{
    const memory *last = &r->tracker->last;
    const candidate c = vertex_candidate(r, last->vertex);
    if (!worth_refining(r, &c)) {
        keep(r, c);
        return;
    }
    mote_refined result;
    mote_refine_triangles(r->lazy, last->triangle[0], last->triangle[1], r->enough_squared,
                          &result);
    take_result(r, &result);
    keep(r, result_candidate(r, &result));
}

static void follow_pairs(request *r)
{
    const mote_tracker *t = r->tracker;
    const int level[2] = {MOTE_MESH_LEVEL, MOTE_MESH_LEVEL};
    for (uint32_t i = 0; i < t->pair_count; ++i) {
        mote_place at[2];
        for (int b = 0; b < 2; ++b)
            at[b] = mote_place_at(&r->ground[b], MOTE_MESH_LEVEL, t->pair[i][b]);
        keep_places(r, at, mote_walk(r->ground, level, at, &r->counters->moves));
    }
}

/* Looks up the seeds of both bodies; with forces, after they have moved. */
static void look_at_seeds(request *r)
{
    mote_tracker *t = r->tracker;
    if (t->particles)
        mote_particles_relax(t->particles, -1, r->counters);
    for (int b = 0; b < 2; ++b) {
        tracked_body *body = &t->body[b];
        for (uint32_t i = 0; i < body->seed_count; ++i) {
            if (t->particles)
                body->seed[i] = body->home[mote_particles_site(t->particles, b, i).a];
            body->place[i] = mote_place_at(&r->ground[b], body->seed_level, body->seed[i]);
        }
    }
}

static mote_place nearest_place(const tracked_body *body, mote_vec3 p)
{
    uint32_t best = 0;
    double least = HUGE_VAL;
    for (uint32_t i = 0; i < body->seed_count; ++i) {
        const double squared = mote_distance_squared(body->place[i].world, p);
        if (squared < least) {
            least = squared;
            best = i;
        }
    }
    return body->place[best];
}

static void launch(request *r, int b, uint32_t i)
{
    mote_tracker *t = r->tracker;
    const int level[2] = {t->body[0].seed_level, t->body[1].seed_level};
    mote_place at[2];
    at[b] = t->body[b].place[i];
    at[1 - b] = nearest_place(&t->body[1 - b], at[b].world);
    ++r->counters->launches;
    if (!t->options.descend) {
        keep_places(r, at, mote_distance_squared(at[0].world, at[1].world));
        return;
    }
    if (!t->options.reseed) {
        mote_walk(r->ground, level, at, &r->counters->moves);
        t->body[b].seed[i] = at[b].node;
    }
    keep_places(r, at, mote_descend(r->ground, level, at, &r->counters->moves));
}

/* Launches count seeds of each body, those whose turn it is; a part of 1 means all of them. */
static void launch_seeds(request *r, double part)
{
    mote_tracker *t = r->tracker;
    look_at_seeds(r);
    for (int b = 0; b < 2; ++b) {
        tracked_body *body = &t->body[b];
        const double wanted = t->options.launch + ceil(part * body->seed_count);
        uint32_t count = body->seed_count;
        if (wanted < count)
            count = (uint32_t)wanted;
        for (uint32_t k = 0; k < count; ++k) {
            launch(r, b, body->turn);
            body->turn = body->turn + 1 < body->seed_count ? body->turn + 1 : 0;
        }
    }
}

/* Without seeds the first pair is found from one node of each body. */
static void launch_first(request *r)
{
    const mote_tracker *t = r->tracker;
    int level[2];
    mote_place at[2];
    for (int b = 0; b < 2; ++b) {
        level[b] = (int)t->body[b].levels->depth - 1;
        at[b] = mote_place_at(&r->ground[b], level[b], 0);
    }
    keep_places(r, at, mote_descend(r->ground, level, at, &r->counters->moves));
}

/* Checks the nearest candidates that no check has ended at. */
static void refine_candidates(request *r)
{
    mote_tracker *t = r->tracker;
    for (uint32_t i = 0; i < t->candidate_count; ++i) {
        candidate *c = &t->candidates[i];
        if (found_enough(r) || r->refined >= t->options.refine)
            return;
        if (c->refined || !worth_refining(r, c))
            continue;
        mote_refined result;
        mote_refine_below(r->lazy, c->vertex, fmin(r->best->squared, r->worth_squared),
                          r->enough_squared, &result);
        take_result(r, &result);
        const candidate end = result_candidate(r, &result);
        for (int b = 0; b < 2; ++b)
            c->vertex[b] = end.vertex[b];
    }
}

static memory relation_of(const request *r, const mote_frame *frame)
{
    memory now = {.known = true};
    const mote_mat3 *r0 = &frame->body[0].pose.rotation;
    const mote_mat3 *r1 = &frame->body[1].pose.rotation;
    for (int j = 0; j < 3; ++j) {
        const mote_vec3 column =
            mote_rotate_back(r0, mote_vec3_make(r1->m[0][j], r1->m[1][j], r1->m[2][j]));
        now.rotation.m[0][j] = column.x;
        now.rotation.m[1][j] = column.y;
        now.rotation.m[2][j] = column.z;
    }
    mote_vec3 centre[2];
    for (int b = 0; b < 2; ++b) {
        const mote_mesh *mesh = r->tracker->body[b].mesh;
        centre[b] = mote_pose_apply(
            &frame->body[b].pose, mote_add_scaled(mote_scale(mesh->low, 0.5), 0.5, mesh->high));
    }
    now.centre = mote_rotate_back(r0, mote_sub(centre[1], centre[0]));
    return now;
}

/* The offset between two vertices seen from body 0. */
static mote_vec3 offset_of(const request *r, const mote_frame *frame, const uint32_t vertex[2])
{
    const mote_vec3 p = mote_lazy_position(r->lazy[0], vertex[0]);
    const mote_vec3 q = mote_lazy_position(r->lazy[1], vertex[1]);
    return mote_rotate_back(&frame->body[0].pose.rotation, mote_sub(q, p));
}

/* How much of a cold query this one needs: 0 if the bodies stand to each other as they did, 1
   if nothing is known or they have moved by COLD_MOTION. */
static double coldness(const request *r, const mote_frame *frame, const memory *now)
{
    const mote_tracker *t = r->tracker;
    const memory *last = &t->last;
    if (!last->known)
        return 1;
    double turned = 0;
    for (int i = 0; i < 9; ++i) {
        const double d = now->rotation.m[i / 3][i % 3] - last->rotation.m[i / 3][i % 3];
        turned += d * d;
    }
    /* A turn by a small angle changes the matrix by sqrt(2) times it, and moves points that are
       half of L away. */
    const double by_turn = sqrt(turned / 8) * t->length;
    const double by_shift = mote_length(mote_sub(now->centre, last->centre));
    const double by_shape =
        mote_length(mote_sub(offset_of(r, frame, last->vertex), last->offset));
    return fmin(1, fmax(by_turn + by_shift, by_shape) / (COLD_MOTION * t->length));
}

static void remember(request *r, const mote_frame *frame, memory now)
{
    mote_tracker *t = r->tracker;
    const bool checked = r->best->squared < HUGE_VAL;
    now.has_triangle = checked;
    memcpy(now.triangle, r->best->triangle, sizeof now.triangle);
    memcpy(now.vertex, checked ? r->best->vertex : t->candidates[0].vertex, sizeof now.vertex);
    now.offset = offset_of(r, frame, now.vertex);
    now.known = !found_enough(r) || t->options.count == 0;
    t->last = now;
    if (found_enough(r))
        return; /* the minima of the last full search are still the best that is known */
    t->pair_count = 0;
    for (uint32_t i = 0; i < t->candidate_count && i < t->options.track; ++i)
        memcpy(t->pair[t->pair_count++], t->candidates[i].vertex, sizeof t->pair[0]);
}

/* Everything but what the last query's closest pair tells. */
static void search(request *r, double cold)
{
    mote_tracker *t = r->tracker;
    follow_pairs(r);
    if (t->options.count > 0)
        launch_seeds(r, cold);
    else if (t->candidate_count == 0)
        launch_first(r);
    refine_candidates(r);
}

void mote_tracker_query(mote_tracker *tracker, const mote_frame *frame, bool use_given,
                        double worth_squared, double enough_squared, mote_counters *counters,
                        mote_refined *best)
{
    request r = {.tracker = tracker,
                 .worth_squared = worth_squared,
                 .enough_squared = enough_squared,
                 .counters = counters,
                 .best = best};
    uint64_t before = 0;
    if (tracker->particles)
        mote_particles_begin(tracker->particles, frame, use_given);
    for (int b = 0; b < 2; ++b) {
        tracked_body *body = &tracker->body[b];
        before += body->lazy->evaluated;
        if (!tracker->particles)
            mote_lazy_begin(body->lazy, &frame->body[b], use_given);
        r.lazy[b] = body->lazy;
        r.ground[b] = mote_ground_of(body->lazy, body->levels);
    }
    *best = (mote_refined){.squared = HUGE_VAL};
    tracker->candidate_count = 0;
    const memory now = relation_of(&r, frame);
    const double cold = coldness(&r, frame, &now);
    if (tracker->last.has_triangle)
        refine_last(&r);
    if (!found_enough(&r))
        search(&r, cold);
    remember(&r, frame, now);
    counters->positions +=
        tracker->body[0].lazy->evaluated + tracker->body[1].lazy->evaluated - before;
}
