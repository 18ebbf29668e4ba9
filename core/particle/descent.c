#include "core/particle/descent.h"

#include <stddef.h>

/* In 97 of 100 successful descents, what is gained below a level is less than this times the
   mean distance of neighbours on that level, added over both bodies. Measured with n = 8 on
   ww: 99.73, 99.75 and 99.78 % of the frames are exact with 1, 2 and 4, for 42, 45 and 47
   positions. */
#define GAIN_MAX 2

mote_ground mote_ground_of(mote_lazy *lazy, const mote_levels *levels)
{
    const bool given = lazy->given != NULL;
    return (mote_ground){.lazy = lazy,
                         .levels = levels,
                         .shape = given ? lazy->given : lazy->body->mesh->positions,
                         .rotation = given ? NULL : &lazy->state->pose.rotation};
}

mote_walker mote_walker_at(const mote_ground *ground, int level, uint32_t node)
{
    const uint32_t vertex = level == MOTE_MESH_LEVEL ? node : ground->levels->vertex[node];
    return (mote_walker){node, vertex, mote_lazy_position(ground->lazy, vertex)};
}

/* The target in the coordinates of the rest shape, as if the body around the place had moved
   rigidly. */
static mote_vec3 carry_back(const mote_ground *ground, const mote_walker *at, mote_vec3 target)
{
    if (!ground->rotation)
        return target;
    return mote_add(ground->shape[at->vertex],
                    mote_rotate_back(ground->rotation, mote_sub(target, at->world)));
}

/* The neighbour of a node whose shape is nearest to the target, if below *squared; else the
   node itself. */
static uint32_t nearest_node(const mote_ground *ground, int level, uint32_t node,
                             mote_vec3 target, double *squared)
{
    const mote_level *graph = &ground->levels->level[level];
    const uint32_t *vertex = ground->levels->vertex;
    const uint32_t end = graph->start[node + 1];
    uint32_t best = node;
    for (uint32_t k = graph->start[node]; k < end; ++k) {
        const uint32_t u = graph->neighbour[k];
        const double s = mote_distance_squared(ground->shape[vertex[u]], target);
        if (s < *squared) {
            *squared = s;
            best = u;
        }
    }
    return best;
}

static uint32_t nearest_vertex(const mote_ground *ground, uint32_t node, mote_vec3 target,
                               double *squared)
{
    const mote_mesh *mesh = ground->lazy->body->mesh;
    const uint32_t end = mesh->ring_start[node + 1];
    uint32_t best = node;
    for (uint32_t k = mesh->ring_start[node]; k < end; ++k) {
        const uint32_t u = MOTE_RING_VERTEX(mesh->ring[k]);
        const double s = mote_distance_squared(ground->shape[u], target);
        if (s < *squared) {
            *squared = s;
            best = u;
        }
    }
    return best;
}

/* Moves one place towards the target, as far as steps chosen in the rest shape lead; false if
   it does not come nearer. */
static bool move_by_shape(const mote_ground *ground, int level, mote_walker *at,
                          mote_vec3 target, double *squared)
{
    const mote_vec3 goal = carry_back(ground, at, target);
    double left = mote_distance_squared(ground->shape[at->vertex], goal);
    uint32_t node = at->node;
    for (;;) {
        const uint32_t next = level == MOTE_MESH_LEVEL
                                  ? nearest_vertex(ground, node, goal, &left)
                                  : nearest_node(ground, level, node, goal, &left);
        if (next == node)
            break;
        node = next;
    }
    if (node == at->node)
        return false;
    const mote_walker there = mote_walker_at(ground, level, node);
    const double reached = mote_distance_squared(there.world, target);
    if (!(reached < *squared))
        return false;
    *at = there;
    *squared = reached;
    return true;
}

/* Moves a place on the mesh to the neighbour whose position in the frame is nearest to the
   target; false if none comes nearer. */
static bool move_by_frame(const mote_ground *ground, mote_walker *at, mote_vec3 target,
                          double *squared)
{
    const mote_mesh *mesh = ground->lazy->body->mesh;
    const uint32_t centre = at->vertex;
    mote_lazy_fetch_rings(ground->lazy, &centre, 1);
    for (uint32_t k = mesh->ring_start[centre]; k < mesh->ring_start[centre + 1]; ++k) {
        const mote_walker there =
            mote_walker_at(ground, MOTE_MESH_LEVEL, MOTE_RING_VERTEX(mesh->ring[k]));
        const double reached = mote_distance_squared(there.world, target);
        if (reached < *squared) {
            *squared = reached;
            *at = there;
        }
    }
    return at->vertex != centre;
}

/* Moves one place towards the target, on the mesh to where no neighbour is nearer in the frame;
   false if it does not come nearer. */
static bool move(const mote_ground *ground, int level, mote_walker *at, mote_vec3 target,
                 double *squared)
{
    bool moved = move_by_shape(ground, level, at, target, squared);
    if (level != MOTE_MESH_LEVEL || !ground->rotation)
        return moved;
    while (move_by_frame(ground, at, target, squared)) {
        moved = true;
        move_by_shape(ground, level, at, target, squared);
    }
    return moved;
}

double mote_walk(const mote_ground ground[2], const int level[2], mote_walker at[2],
                 uint64_t *moves)
{
    double squared = mote_distance_squared(at[0].world, at[1].world);
    int side = 0;
    for (int still = 0; still < 2; side = 1 - side) {
        const bool moved =
            move(&ground[side], level[side], &at[side], at[1 - side].world, &squared);
        still = moved ? 0 : still + 1;
        *moves += moved;
    }
    return squared;
}

/* By how much a place may still come nearer on the levels below. */
static double gain_below(const mote_ground *ground, int level)
{
    return GAIN_MAX * (level == MOTE_MESH_LEVEL ? ground->lazy->body->mesh->mean_edge
                                                : ground->levels->level[level].spacing);
}

/* True if two vertices are at most two edges apart. */
static bool within_two_rings(const mote_mesh *mesh, uint32_t v, uint32_t w)
{
    if (v == w)
        return true;
    const uint32_t *ring = mesh->ring, *start = mesh->ring_start;
    for (uint32_t k = start[v]; k < start[v + 1]; ++k) {
        const uint32_t beside = MOTE_RING_VERTEX(ring[k]);
        if (beside == w)
            return true;
        for (uint32_t j = start[w]; j < start[w + 1]; ++j) {
            if (MOTE_RING_VERTEX(ring[j]) == beside)
                return true;
        }
    }
    return false;
}

double mote_descend(const mote_ground ground[2], const int level[2], mote_walker at[2],
                    double worth, const uint32_t *known, double *least, uint64_t *moves)
{
    int on[2] = {level[0], level[1]};
    while (on[0] != MOTE_MESH_LEVEL || on[1] != MOTE_MESH_LEVEL) {
        double squared = mote_distance_squared(at[0].world, at[1].world);
        for (int side = 0; side < 2; ++side) {
            /* Out over the mesh and back is a long way, edge by edge. */
            if (level[side] != MOTE_MESH_LEVEL)
                *moves += move_by_shape(&ground[side], on[side], &at[side], at[1 - side].world,
                                        &squared);
        }
        *least = sqrt(squared) - gain_below(&ground[0], on[0]) - gain_below(&ground[1], on[1]);
        if (*least > worth)
            return HUGE_VAL;
        for (int side = 0; side < 2; ++side) {
            if (on[side] != MOTE_MESH_LEVEL && --on[side] == MOTE_MESH_LEVEL)
                at[side].node = at[side].vertex;
        }
    }
    const bool joins = known &&
                       within_two_rings(ground[0].lazy->body->mesh, at[0].vertex, known[0]) &&
                       within_two_rings(ground[1].lazy->body->mesh, at[1].vertex, known[1]);
    const double squared = joins ? mote_distance_squared(at[0].world, at[1].world)
                                 : mote_walk(ground, on, at, moves);
    *least = sqrt(squared) - gain_below(&ground[0], on[0]) - gain_below(&ground[1], on[1]);
    return joins ? HUGE_VAL : squared;
}
