/* The points of leaves in the gap's axes, which are computed only for groups that the traversal
   opens. */
#include "core/stream/stream_state.h"

#include "core/base/clones.h"

#define WIDTH MOTE_STREAM_WIDTH

/* Exact positions of a leaf, by coordinate, filled up with copies of the last. */
typedef struct gathered {
    double x[3][MOTE_CERT_POINTS];
} gathered;

static void gather(const mote_stream_body *body, const uint32_t *vertices, uint32_t count,
                   uint32_t padded, gathered *to)
{
    for (uint32_t i = 0; i < count; ++i) {
        const mote_vec3 p = mote_position_at(&body->positions, vertices[i]);
        to->x[0][i] = p.x;
        to->x[1][i] = p.y;
        to->x[2][i] = p.z;
    }
    for (uint32_t i = count; i < padded; ++i) {
        for (size_t k = 0; k < 3; ++k)
            to->x[k][i] = to->x[k][count - 1];
    }
}

/* The least and the largest of eight numbers. */
MOTE_INLINE void fold(float least[WIDTH], float most[WIDTH], float *low, float *high)
{
    for (size_t width = WIDTH / 2; width > 0; width /= 2) {
        for (size_t l = 0; l < width; ++l) {
            least[l] = least[l + width] < least[l] ? least[l + width] : least[l];
            most[l] = most[l + width] > most[l] ? most[l + width] : most[l];
        }
    }
    *low = least[0];
    *high = most[0];
}

/* Turns the positions into the gap's axes, and boxes them. */
MOTE_CLONES
static void turn_leaf(const mote_stream_search *restrict s, const gathered *restrict from,
                      mote_stream_slot *restrict to)
{
    const double origin[3] = {s->origin.x, s->origin.y, s->origin.z};
    for (size_t r = 0; r < 3; ++r) {
        const double x = s->axes[r][0] * s->scale;
        const double y = s->axes[r][1] * s->scale;
        const double z = s->axes[r][2] * s->scale;
        float least[WIDTH], most[WIDTH];
        for (size_t l = 0; l < WIDTH; ++l) {
            least[l] = HUGE_VALF;
            most[l] = -HUGE_VALF;
        }
        for (size_t g = 0; g < to->groups * WIDTH; g += WIDTH) {
            MOTE_LANE_LOOP
            for (size_t l = 0; l < WIDTH; ++l) {
                const float p = (float)((from->x[0][g + l] - origin[0]) * x +
                                        (from->x[1][g + l] - origin[1]) * y +
                                        (from->x[2][g + l] - origin[2]) * z);
                to->x[r][g + l] = p;
                least[l] = p < least[l] ? p : least[l];
                most[l] = p > most[l] ? p : most[l];
            }
        }
        fold(least, most, &to->low[r], &to->high[r]);
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
    gather(of->body, tree->leaf_vertices + first, count, slot->groups * WIDTH, &points);
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
