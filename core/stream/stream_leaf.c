/* The points of leaves in the gap's axes, which are computed only for groups that the traversal
   opens. */
#include "core/stream/stream_state.h"

#include "core/base/clones.h"

#define WIDTH MOTE_STREAM_WIDTH

/* Points that are turned at a time: as many floats as the widest vectors hold. */
#define TURN (2 * WIDTH)

/* Positions of a leaf relative to the origin, filled up to a multiple of TURN with copies of
   the last. The fourth number of each is no coordinate. */
typedef struct gathered {
    float point[MOTE_CERT_POINTS][4];
} gathered;

/* Four numbers are read and converted at once where the mesh has a vertex after this one. */
#define GATHER(from, vertex, last, origin, scale, to)                                          \
    do {                                                                                       \
        const size_t wanted = (vertex) < (last) ? 4 : 3;                                       \
        if (wanted == 4) {                                                                     \
            MOTE_LANE_LOOP                                                                     \
            for (size_t k = 0; k < 4; ++k)                                                     \
                (to)[k] = (float)(((double)(from)[k] - (origin)[k]) * (scale));                \
        } else {                                                                               \
            for (size_t k = 0; k < 3; ++k)                                                     \
                (to)[k] = (float)(((double)(from)[k] - (origin)[k]) * (scale));                \
            (to)[3] = 0;                                                                       \
        }                                                                                      \
    } while (0)

MOTE_CLONES
static void gather(const mote_stream_search *restrict s, const mote_stream_body *restrict body,
                   const uint32_t *restrict vertices, uint32_t count, gathered *restrict to)
{
    const char *data = body->positions.data;
    const size_t stride = body->positions.stride;
    const uint32_t last = body->tree->mesh->vertex_count - 1;
    const double origin[4] = {s->origin.x, s->origin.y, s->origin.z, 0};
    const double scale = s->scale;
    for (uint32_t i = 0; !body->positions.single && i < count; ++i) {
        const void *at = data + vertices[i] * stride;
        const double *p = at;
        GATHER(p, vertices[i], last, origin, scale, to->point[i]);
    }
    for (uint32_t i = 0; body->positions.single && i < count; ++i) {
        const void *at = data + vertices[i] * stride;
        const float *p = at;
        GATHER(p, vertices[i], last, origin, scale, to->point[i]);
    }
    for (uint32_t i = count; i % TURN; ++i) {
        for (size_t k = 0; k < 4; ++k)
            to->point[i][k] = to->point[count - 1][k];
    }
}

/* The least and the largest of the first 2 * width numbers, in the first `width`. */
MOTE_INLINE void halve(float *restrict least, float *restrict most, size_t width)
{
    MOTE_LANE_LOOP
    for (size_t l = 0; l < width; ++l) {
        least[l] = least[l + width] < least[l] ? least[l + width] : least[l];
        most[l] = most[l + width] > most[l] ? most[l + width] : most[l];
    }
}

/* The points along one axis, with the least and the largest. */
typedef struct along {
    float least[TURN], most[TURN];
} along;

MOTE_INLINE void start(along *a)
{
    MOTE_LANE_LOOP
    for (size_t l = 0; l < TURN; ++l) {
        a->least[l] = HUGE_VALF;
        a->most[l] = -HUGE_VALF;
    }
}

MOTE_INLINE void finish(along *a, float *low, float *high)
{
    halve(a->least, a->most, 8);
    halve(a->least, a->most, 4);
    halve(a->least, a->most, 2);
    *low = a->least[1] < a->least[0] ? a->least[1] : a->least[0];
    *high = a->most[1] > a->most[0] ? a->most[1] : a->most[0];
}

/* One coordinate of the positions. */
MOTE_INLINE void pick(const gathered *restrict from, size_t count, size_t k, float *restrict to)
{
    for (size_t g = 0; g < count; g += TURN) {
        MOTE_LANE_LOOP
        for (size_t l = 0; l < TURN; ++l)
            to[g + l] = from->point[g + l][k];
    }
}

/* Turns the positions into the gap's axes, and boxes them. */
MOTE_CLONES
static void turn_leaf(const mote_stream_search *restrict s, const gathered *restrict from,
                      mote_stream_slot *restrict to)
{
    const size_t count = to->groups * WIDTH;
    float x[MOTE_CERT_POINTS], y[MOTE_CERT_POINTS], z[MOTE_CERT_POINTS];
    pick(from, count, 0, x);
    pick(from, count, 1, y);
    pick(from, count, 2, z);
    for (size_t r = 0; r < 3; ++r) {
        const float ax = s->turn[r][0];
        const float ay = s->turn[r][1];
        const float az = s->turn[r][2];
        along a;
        start(&a);
        for (size_t g = 0; g < count; g += TURN) {
            MOTE_LANE_LOOP
            for (size_t l = 0; l < TURN; ++l) {
                const float p = x[g + l] * ax + y[g + l] * ay + z[g + l] * az;
                to->x[r][g + l] = p;
                a.least[l] = p < a.least[l] ? p : a.least[l];
                a.most[l] = p > a.most[l] ? p : a.most[l];
            }
        }
        finish(&a, &to->low[r], &to->high[r]);
    }
}

mote_stream_slot *mote_stream_leaf(mote_stream_search *s, int side, uint32_t leaf)
{
    mote_stream_side *of = &s->side[side];
    mote_stream_slot *slot = &of->slots[leaf % MOTE_STREAM_SLOTS];
    if (slot->leaf == leaf && slot->stamp == s->stamp)
        return slot;
    const mote_stream_tree *tree = of->body->tree;
    const size_t first = tree->leaf_start[leaf];
    const uint32_t count = (uint32_t)(tree->leaf_start[leaf + 1] - first);
    slot->leaf = leaf;
    slot->stamp = s->stamp;
    slot->reach_stamp = 0;
    slot->groups = (count + WIDTH - 1) / WIDTH;
    gathered points;
    gather(s, of->body, tree->leaf_vertices + first, count, &points);
    turn_leaf(s, &points, slot);
    s->counters.positions += count;
    return slot;
}

const mote_stream_block *mote_stream_open_group(mote_stream_search *s, int side, uint32_t group)
{
    mote_stream_side *of = &s->side[side];
    mote_stream_block *block = &of->leaves[group];
    if (of->opened[group] == s->stamp)
        return block;
    const mote_stream_tree *tree = of->body->tree;
    const uint32_t first = group * WIDTH;
    const uint32_t count = tree->leaves - first < WIDTH ? tree->leaves - first : WIDTH;
    mote_stream_box *whole = &of->groups[group];
    for (size_t k = 0; k < 3; ++k) {
        whole->low[k] = HUGE_VALF;
        whole->high[k] = -HUGE_VALF;
    }
    for (uint32_t l = 0; l < WIDTH; ++l) {
        const mote_stream_slot *leaf = l < count ? mote_stream_leaf(s, side, first + l) : NULL;
        for (size_t k = 0; k < 3; ++k) {
            const float low = leaf ? leaf->low[k] : HUGE_VALF;
            const float high = leaf ? leaf->high[k] : -HUGE_VALF;
            block->low[k][l] = low;
            block->high[k][l] = high;
            whole->low[k] = low < whole->low[k] ? low : whole->low[k];
            whole->high[k] = high > whole->high[k] ? high : whole->high[k];
        }
    }
    of->opened[group] = s->stamp;
    ++s->counters.blocks;
    return block;
}

double mote_stream_reach(mote_stream_search *s, int side, mote_stream_slot *slot)
{
    if (slot->reach_stamp == s->aim)
        return slot->reach;
    const mote_stream_body *body = s->side[side].body;
    const mote_stream_tree *tree = body->tree;
    const double sign = side == 0 ? 1 : -1;
    double most = -HUGE_VAL;
    for (size_t i = tree->leaf_start[slot->leaf]; i < tree->leaf_start[slot->leaf + 1]; ++i) {
        const mote_vec3 p = mote_position_at(&body->positions, tree->leaf_vertices[i]);
        const double reach = sign * mote_dot(mote_sub(p, s->origin), s->toward);
        most = reach > most ? reach : most;
    }
    slot->reach_stamp = s->aim;
    slot->reach = most * s->scale;
    return slot->reach;
}
