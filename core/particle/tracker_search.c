#include "core/particle/tracker_state.h"

#include <string.h>

/* Motion is an estimate. Bodies may have come nearer by this many times the estimate. With n =
   8 on ww and comb, 1 and 4 give as many exact frames for 4 % fewer and more positions. */
#define MOTION_MARGIN 2

/* The square of the longest edge at a vertex, in the shape. */
static double longest_edge_squared(const mote_ground *ground, uint32_t vertex)
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

static mote_pair make_candidate(const mote_request *r, const uint32_t vertex[2], double squared)
{
    mote_pair c = {.squared = squared, .travelled = r->tracker->travelled};
    for (int b = 0; b < 2; ++b) {
        c.vertex[b] = vertex[b];
        c.shape[b] = r->ground[b].shape[vertex[b]];
        c.longest_edge_squared[b] = longest_edge_squared(&r->ground[b], vertex[b]);
    }
    return c;
}

static void keep_places(mote_request *r, const mote_walker at[2], double squared)
{
    const uint32_t vertex[2] = {at[0].vertex, at[1].vertex};
    r->nearest_squared = fmin(r->nearest_squared, squared);
    const mote_pair c = make_candidate(r, vertex, squared);
    mote_pairs_keep(&r->tracker->pairs, &c);
}

/* The distance that a search has to come below. */
static double distance_to_beat(const mote_request *r)
{
    return sqrt(fmin(fmin(r->best->squared, r->worth_squared), r->nearest_squared));
}

/* True if a minimum that was found earlier may have come near enough since; also where the
   frame in which it was found had positions that are no numbers. */
static bool worth_following(const mote_request *r, const mote_pair *c)
{
    const double since = r->tracker->travelled - c->travelled;
    return !(sqrt(c->squared) - mote_pair_edges(c) - MOTION_MARGIN * since >
             distance_to_beat(r));
}

/* Estimates whether an exact check of two vertices can come below the best distance. Walks are
   guided by the rest shape and need not end at a minimum of the frame, so an exact check gains
   more than it would at a minimum: about half of the longest edges there. */
static bool worth_refining(const mote_request *r, const mote_pair *c)
{
    return sqrt(c->squared) - 0.5 * mote_pair_edges(c) <=
           sqrt(fmin(r->best->squared, r->worth_squared));
}

static void keep_result(mote_request *r, const mote_refined *result)
{
    ++r->refined;
    ++r->counters->refined;
    r->counters->triangle_tests += result->triangle_tests;
    if (result->squared < r->best->squared)
        *r->best = *result;
}

/* A candidate with its distance in this frame. */
static mote_pair vertex_candidate(const mote_request *r, const uint32_t vertex[2])
{
    return make_candidate(r, vertex,
                          mote_distance_squared(mote_lazy_position(r->lazy[0], vertex[0]),
                                                mote_lazy_position(r->lazy[1], vertex[1])));
}

/* The candidate that an exact check ended at. */
static mote_pair result_candidate(const mote_request *r, const mote_refined *result)
{
    mote_pair c = vertex_candidate(r, result->vertex);
    c.refined = true;
    return c;
}

void mote_tracker_refine_last(mote_request *r)
{
    const mote_nearest_pair *last = &r->tracker->last;
    if (r->worth_squared < HUGE_VAL) {
        const mote_pair c = vertex_candidate(r, last->vertex);
        if (!worth_refining(r, &c)) {
            mote_pairs_keep(&r->tracker->pairs, &c);
            return;
        }
    }
    mote_refined result;
    mote_refine_triangles(r->lazy, last->triangle[0], last->triangle[1], r->enough_squared,
                          &result);
    keep_result(r, &result);
    const mote_pair end = result_candidate(r, &result);
    mote_pairs_keep(&r->tracker->pairs, &end);
}

static void follow_pairs(mote_request *r)
{
    const mote_tracker *t = r->tracker;
    const int level[2] = {MOTE_MESH_LEVEL, MOTE_MESH_LEVEL};
    for (uint32_t i = 0; i < t->pair_count; ++i) {
        mote_pair c = t->pair[i];
        if (!worth_following(r, &c)) {
            c.refined = false;
            for (int b = 0; b < 2; ++b)
                c.shape[b] = r->ground[b].shape[c.vertex[b]];
            mote_pairs_keep(&r->tracker->pairs, &c);
            continue;
        }
        mote_walker at[2];
        for (int b = 0; b < 2; ++b)
            at[b] = mote_walker_at(&r->ground[b], MOTE_MESH_LEVEL, c.vertex[b]);
        keep_places(r, at, mote_walk(r->ground, level, at, &r->counters->moves));
    }
}

/* Moves the seeds with the paper's forces. */
static void move_seeds(mote_request *r)
{
    mote_tracker *t = r->tracker;
    mote_particles_relax(t->particles, -1, r->counters);
    for (int b = 0; b < 2; ++b) {
        mote_tracked_body *body = &t->body[b];
        for (uint32_t i = 0; i < body->count; ++i)
            body->seed[i] = body->home[mote_particles_site(t->particles, b, i).a];
    }
}

/* Looks up the first seeds of a body, once a query. */
static void look_at_seeds(mote_request *r, int b)
{
    mote_tracked_body *body = &r->tracker->body[b];
    if (r->looked[b])
        return;
    r->looked[b] = true;
    for (uint32_t i = 0; i < body->count; i += MOTE_LANES) {
        uint32_t vertex[MOTE_LANES], count = 0;
        for (; count < MOTE_LANES && i + count < body->count; ++count)
            vertex[count] = body->levels->vertex[body->seed[i + count]];
        mote_lazy_fetch(r->lazy[b], vertex, count);
    }
    for (uint32_t i = 0; i < body->count; ++i)
        body->place[i] = mote_walker_at(&r->ground[b], body->seed_level, body->seed[i]);
}

static mote_walker nearest_place(const mote_tracked_body *body, mote_vec3 p)
{
    uint32_t best = 0;
    double least = HUGE_VAL;
    for (uint32_t i = 0; i < body->count; ++i) {
        const double squared = mote_distance_squared(body->place[i].world, p);
        if (squared < least) {
            least = squared;
            best = i;
        }
    }
    return body->place[best];
}

/* The node of the seeds' level that is nearest to a point of the world, by the rest shape in
   its pose: only that node's position is evaluated. */
static mote_walker nearest_by_shape(const mote_request *r, int b, mote_vec3 world)
{
    const mote_tracked_body *body = &r->tracker->body[b];
    const mote_ground *ground = &r->ground[b];
    const uint32_t nodes = body->levels->level[body->seed_level].count;
    const mote_pose *pose = &r->lazy[b]->state->pose;
    const bool given = !ground->rotation;
    const mote_vec3 goal =
        given ? world : mote_rotate_back(&pose->rotation, mote_sub(world, pose->translation));
    uint32_t best = 0;
    double least = HUGE_VAL;
    for (uint32_t node = 0; node < nodes; ++node) {
        const mote_vec3 p =
            given ? ground->shape[body->levels->vertex[node]] : body->node_rest[node];
        const double squared = mote_distance_squared(p, goal);
        if (squared < least) {
            least = squared;
            best = node;
        }
    }
    return mote_walker_at(ground, body->seed_level, best);
}

/* Where a launch from a place of body b starts on the other body: at the nearest seed where
   seeds move or are not descended from, otherwise at the nearest node of the seeds' level. */
static mote_walker opposite(mote_request *r, int b, mote_vec3 world)
{
    const mote_tracker *t = r->tracker;
    if (t->options.descend && t->options.reseed && !t->particles)
        return nearest_by_shape(r, 1 - b, world);
    look_at_seeds(r, 1 - b);
    return nearest_place(&t->body[1 - b], world);
}

/* The vertices of the nearest pair that was checked exactly; NULL: none was. */
static const uint32_t *nearest_known(const mote_request *r)
{
    return r->best->squared < HUGE_VAL ? r->best->vertex : NULL;
}

static void launch(mote_request *r, int b, uint32_t i)
{
    mote_tracker *t = r->tracker;
    const int level[2] = {t->body[0].seed_level, t->body[1].seed_level};
    mote_walker at[2];
    at[b] = mote_walker_at(&r->ground[b], level[b], t->body[b].seed[i]);
    at[1 - b] = opposite(r, b, at[b].world);
    ++r->counters->launches;
    if (!t->options.descend) {
        keep_places(r, at, mote_distance_squared(at[0].world, at[1].world));
        return;
    }
    if (!t->options.reseed) {
        mote_walk(r->ground, level, at, &r->counters->moves);
        t->body[b].seed[i] = at[b].node;
    }
    mote_outcome *end = &t->body[b].outcome[i];
    end->travelled = t->travelled;
    const double squared = mote_descend(r->ground, level, at, distance_to_beat(r),
                                        nearest_known(r), &end->least, &r->counters->moves);
    if (squared < HUGE_VAL)
        keep_places(r, at, squared);
}

/* False if a launch ended so far away that it can hardly be nearer by now; true also where it
   ended at no number. */
static bool worth_launching(const mote_request *r, const mote_outcome *last)
{
    const double since = r->tracker->travelled - last->travelled;
    return !(last->least - MOTION_MARGIN * since > distance_to_beat(r));
}

/* Launches the first n seeds of each body when cold, otherwise those whose turn it is. */
static void launch_seeds(mote_request *r)
{
    mote_tracker *t = r->tracker;
    if (t->particles)
        move_seeds(r);
    for (int b = 0; b < 2; ++b) {
        mote_tracked_body *body = &t->body[b];
        const uint32_t due = (uint32_t)body->due;
        const bool all = r->cold || t->options.launch >= body->count - due;
        const uint32_t count = all ? body->count : t->options.launch + due;
        body->due -= due;
        if (r->cold)
            body->turn = 0;
        for (uint32_t k = 0; k < count; ++k) {
            if (worth_launching(r, &body->outcome[body->turn]))
                launch(r, b, body->turn);
            body->turn = body->turn + 1 < body->seed_count ? body->turn + 1 : 0;
        }
    }
}

/* Lists the nodes of the seeds' level that are nearest to a vertex at rest, nearest first. */
static void list_near(mote_tracked_body *body, uint32_t vertex)
{
    const uint32_t nodes = body->levels->level[body->seed_level].count;
    const mote_vec3 p = body->mesh->positions[vertex];
    double squared[MOTE_NEAR_MAX];
    uint32_t count = 0;
    for (uint32_t node = 0; node < nodes; ++node) {
        const double s = mote_distance_squared(body->node_rest[node], p);
        if (count == MOTE_NEAR_MAX && s >= squared[MOTE_NEAR_MAX - 1])
            continue;
        uint32_t i = count < MOTE_NEAR_MAX ? count++ : MOTE_NEAR_MAX - 1;
        for (; i > 0 && squared[i - 1] > s; --i) {
            squared[i] = squared[i - 1];
            body->near[i] = body->near[i - 1];
        }
        squared[i] = s;
        body->near[i] = node;
    }
    body->near_count = count;
    body->near_to = vertex;
}

/* Descends from the next node around a pair's vertex of body b, towards its other vertex. */
static void leap(mote_request *r, int b, const uint32_t vertex[2])
{
    mote_tracked_body *body = &r->tracker->body[b];
    if (body->near_to != vertex[b])
        list_near(body, vertex[b]);
    body->near_turn = body->near_turn + 1 < body->near_count ? body->near_turn + 1 : 0;
    int level[2];
    mote_walker at[2];
    double least;
    level[b] = body->seed_level;
    level[1 - b] = MOTE_MESH_LEVEL;
    at[b] = mote_walker_at(&r->ground[b], level[b], body->near[body->near_turn]);
    at[1 - b] = mote_walker_at(&r->ground[1 - b], MOTE_MESH_LEVEL, vertex[1 - b]);
    ++r->counters->launches;
    const double squared = mote_descend(r->ground, level, at, distance_to_beat(r),
                                        nearest_known(r), &least, &r->counters->moves);
    if (squared < HUGE_VAL)
        keep_places(r, at, squared);
}

/* Looks around the nearest known pair for others that no walk from it reaches: across a gap, or
   along a ridge where many pairs are nearly as near. */
static void make_leaps(mote_request *r)
{
    mote_tracker *t = r->tracker;
    if (!t->options.leap || t->pairs.count == 0)
        return;
    uint32_t vertex[2];
    memcpy(vertex, t->pairs.list[0].vertex, sizeof vertex);
    if (r->best->squared < HUGE_VAL)
        memcpy(vertex, r->best->vertex, sizeof vertex);
    for (int b = 0; b < 2; ++b) {
        for (; t->body[b].leaps_due >= 1; --t->body[b].leaps_due)
            leap(r, b, vertex);
    }
}

/* Without seeds the first pair is found from one node of each body. */
static void launch_first(mote_request *r)
{
    const mote_tracker *t = r->tracker;
    int level[2];
    double least;
    mote_walker at[2];
    for (int b = 0; b < 2; ++b) {
        level[b] = (int)t->body[b].levels->depth - 1;
        at[b] = mote_walker_at(&r->ground[b], level[b], 0);
    }
    keep_places(
        r, at, mote_descend(r->ground, level, at, HUGE_VAL, NULL, &least, &r->counters->moves));
}

/* Checks the nearest candidates that are not results of a check. */
static void refine_candidates(mote_request *r)
{
    mote_tracker *t = r->tracker;
    for (uint32_t i = 0; i < t->pairs.count; ++i) {
        mote_pair *c = &t->pairs.list[i];
        if (mote_found_enough(r) || r->refined >= t->options.refine)
            return;
        if (c->refined || !worth_refining(r, c))
            continue;
        mote_refined result;
        if (!mote_refine_below(r->lazy, c->vertex, fmin(r->best->squared, r->worth_squared),
                               r->enough_squared, &result))
            continue;
        keep_result(r, &result);
        *c = result_candidate(r, &result);
    }
}

/* Everything but the check of the last query's closest pair. */
void mote_tracker_search(mote_request *r)
{
    mote_tracker *t = r->tracker;
    follow_pairs(r);
    if (t->options.count > 0) {
        launch_seeds(r);
        make_leaps(r);
    } else if (t->pairs.count == 0) {
        launch_first(r);
    }
    refine_candidates(r);
}
