/* The points of leaves in the gap's axes, which are computed only for groups that the traversal
   opens. */
#include "core/stream/stream_state.h"

#include "core/base/clones.h"

#define WIDTH MOTE_STREAM_WIDTH

/* Points that are turned at a time: as many floats as the widest vectors hold. */
#define TURN (2 * WIDTH)

/* Positions of a leaf, filled up to a multiple of TURN with copies of the last. */
typedef struct gathered {
    double x[MOTE_CERT_POINTS], y[MOTE_CERT_POINTS], z[MOTE_CERT_POINTS];
} gathered;

static void gather(const mote_stream_body *restrict body, const uint32_t *restrict vertices,
                   size_t count, gathered *restrict to)
{
    const char *data = body->positions.data;
    const size_t stride = body->positions.stride;
    for (size_t i = 0; !body->positions.single && i < count; ++i) {
        const void *at = data + vertices[i] * stride;
        const double *p = at;
        to->x[i] = p[0];
        to->y[i] = p[1];
        to->z[i] = p[2];
    }
    for (size_t i = 0; body->positions.single && i < count; ++i) {
        const void *at = data + vertices[i] * stride;
        const float *p = at;
        to->x[i] = (double)p[0];
        to->y[i] = (double)p[1];
        to->z[i] = (double)p[2];
    }
    for (size_t i = count; i % TURN; ++i) {
        to->x[i] = to->x[count - 1];
        to->y[i] = to->y[count - 1];
        to->z[i] = to->z[count - 1];
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

/* The least and the largest coordinates of the points so far, in each lane. */
typedef struct extents {
    float least[3][TURN], most[3][TURN];
} extents;

MOTE_INLINE void widen(extents *e, size_t axis, size_t lane, float p)
{
    e->least[axis][lane] = p < e->least[axis][lane] ? p : e->least[axis][lane];
    e->most[axis][lane] = p > e->most[axis][lane] ? p : e->most[axis][lane];
}

MOTE_INLINE void finish(extents *e, mote_stream_slot *to)
{
    for (size_t k = 0; k < 3; ++k) {
        float *least = e->least[k], *most = e->most[k];
        halve(least, most, 8);
        halve(least, most, 4);
        halve(least, most, 2);
        to->low[k] = least[1] < least[0] ? least[1] : least[0];
        to->high[k] = most[1] > most[0] ? most[1] : most[0];
    }
}

/* Turns the positions into the gap's axes, and boxes them. */
MOTE_CLONES
static void turn_leaf(const mote_stream_search *restrict s, const gathered *restrict from,
                      mote_stream_slot *restrict to)
{
    const double ox = s->origin.x, oy = s->origin.y, oz = s->origin.z, scale = s->scale;
    const float ux = s->turn[0][0], uy = s->turn[0][1], uz = s->turn[0][2];
    const float vx = s->turn[1][0], vy = s->turn[1][1], vz = s->turn[1][2];
    const float wx = s->turn[2][0], wy = s->turn[2][1], wz = s->turn[2][2];
    extents e;
    for (size_t k = 0; k < 3; ++k) {
        MOTE_LANE_LOOP
        for (size_t l = 0; l < TURN; ++l) {
            e.least[k][l] = HUGE_VALF;
            e.most[k][l] = -HUGE_VALF;
        }
    }
    for (size_t g = 0; g < to->groups * WIDTH; g += TURN) {
        MOTE_LANE_LOOP
        for (size_t l = 0; l < TURN; ++l) {
            const float x = (float)((from->x[g + l] - ox) * scale);
            const float y = (float)((from->y[g + l] - oy) * scale);
            const float z = (float)((from->z[g + l] - oz) * scale);
            const float u = x * ux + y * uy + z * uz;
            const float v = x * vx + y * vy + z * vz;
            const float w = x * wx + y * wy + z * wz;
            to->x[0][g + l] = u;
            to->x[1][g + l] = v;
            to->x[2][g + l] = w;
            widen(&e, 0, l, u);
            widen(&e, 1, l, v);
            widen(&e, 2, l, w);
        }
    }
    finish(&e, to);
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
    slot->boxed = slot->averaged = false;
    slot->groups = (count + WIDTH - 1) / WIDTH;
    gathered points;
    gather(of->body, tree->leaf_vertices + first, count, &points);
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
