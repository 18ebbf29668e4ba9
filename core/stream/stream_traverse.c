/* The traversal of both trees, the nearest pair of boxes first. */
#include "core/stream/stream_state.h"

#include "core/base/clones.h"

#define WIDTH MOTE_STREAM_WIDTH

MOTE_INLINE void distances(const mote_stream_box *restrict a,
                           const mote_stream_block *restrict block, float squared[WIDTH])
{
    MOTE_LANE_LOOP
    for (size_t l = 0; l < WIDTH; ++l) {
        const float x0 = block->low[0][l] - a->high[0], x1 = a->low[0] - block->high[0][l];
        const float y0 = block->low[1][l] - a->high[1], y1 = a->low[1] - block->high[1][l];
        const float z0 = block->low[2][l] - a->high[2], z1 = a->low[2] - block->high[2][l];
        const float x01 = x0 > x1 ? x0 : x1, x = x01 > 0 ? x01 : 0;
        const float y01 = y0 > y1 ? y0 : y1, y = y01 > 0 ? y01 : 0;
        const float z01 = z0 > z1 ? z0 : z1, z = z01 > 0 ? z01 : 0;
        squared[l] = x * x + y * y + z * z;
    }
}

MOTE_CLONES
void mote_stream_distances(const mote_stream_box *box, const mote_stream_block *block,
                           float squared[WIDTH])
{
    distances(box, block, squared);
}

mote_stream_box mote_stream_moved_box(const mote_stream_search *s, int from, uint32_t level,
                                      uint32_t node)
{
    mote_stream_box box = mote_stream_box_of(s->side[from].body, level, node);
    for (size_t k = 0; k < 3; ++k) {
        const float offset = s->side[from].offset[k] - s->side[1 - from].offset[k];
        box.low[k] += offset;
        box.high[k] += offset;
    }
    return box;
}

float mote_stream_size(const mote_stream_box *box)
{
    const float x = box->high[0] - box->low[0];
    const float y = box->high[1] - box->low[1];
    const float z = box->high[2] - box->low[2];
    const float xy = x > y ? x : y;
    return xy > z ? xy : z;
}

/* Puts a pair on the stack, above those from `bottom` on that are not nearer. */
static void push(mote_stream_search *s, uint32_t bottom, const mote_stream_pair *pair)
{
    uint32_t at = s->pending++;
    for (; at > bottom && s->stack[at - 1].squared < pair->squared; --at)
        s->stack[at] = s->stack[at - 1];
    s->stack[at] = *pair;
}

/* Two groups in the gap's axes: pushes the pairs of their leaves that are near. */
static void open_groups(mote_stream_search *s, const mote_stream_pair *pair)
{
    const mote_stream_block *a = mote_stream_open_group(s, 0, pair->node[0]);
    const mote_stream_block *b = mote_stream_open_group(s, 1, pair->node[1]);
    const uint32_t bottom = s->pending;
    float near[WIDTH];
    mote_stream_distances(&s->side[1].groups[pair->node[1]], a, near);
    s->counters.box_tests += WIDTH;
    for (uint32_t i = 0; i < WIDTH; ++i) {
        if (!(near[i] < s->squared))
            continue;
        mote_stream_box box;
        for (size_t k = 0; k < 3; ++k) {
            box.low[k] = a->low[k][i];
            box.high[k] = a->high[k][i];
        }
        float squared[WIDTH];
        mote_stream_distances(&box, b, squared);
        s->counters.box_tests += WIDTH;
        ++s->counters.rows;
        for (uint32_t j = 0; j < WIDTH; ++j) {
            const mote_stream_pair leaves = {
                .node = {pair->node[0] * WIDTH + i, pair->node[1] * WIDTH + j},
                .level = {(uint8_t)(pair->level[0] + 1), (uint8_t)(pair->level[1] + 1)},
                .squared = squared[j]};
            if (squared[j] < s->squared)
                push(s, bottom, &leaves);
        }
    }
}

/* Opens the larger node of a pair that is no group: pushes the pairs of its children with the
   other node that are near. */
static void open_node(mote_stream_search *s, const mote_stream_pair *pair)
{
    const mote_stream_box box[2] = {
        mote_stream_box_of(s->side[0].body, pair->level[0], pair->node[0]),
        mote_stream_box_of(s->side[1].body, pair->level[1], pair->node[1])};
    int side = mote_stream_size(&box[1]) > mote_stream_size(&box[0]);
    if (pair->level[side] == s->side[side].body->tree->height)
        side = 1 - side;
    const mote_stream_box other =
        mote_stream_moved_box(s, 1 - side, pair->level[1 - side], pair->node[1 - side]);
    float squared[WIDTH];
    mote_stream_distances(
        &other, mote_stream_children(s->side[side].body, pair->level[side], pair->node[side]),
        squared);
    s->counters.box_tests += WIDTH;
    ++s->counters.rows;
    const uint32_t bottom = s->pending;
    for (uint32_t i = 0; i < WIDTH; ++i) {
        mote_stream_pair child = *pair;
        child.node[side] = pair->node[side] * WIDTH + i;
        ++child.level[side];
        child.squared = squared[i];
        if (squared[i] < s->squared)
            push(s, bottom, &child);
    }
}

/* The smallest bound of the pairs that the budget leaves unvisited. */
static void bound_unvisited(mote_stream_search *s)
{
    s->stopped = true;
    for (uint32_t i = 0; i < s->pending; ++i) {
        const double bound = sqrt((double)s->stack[i].squared) * (1 - 0x1p-20) - s->margin;
        s->unvisited = bound < s->unvisited ? bound : s->unvisited;
    }
}

void mote_stream_traverse(mote_stream_search *s)
{
    const uint32_t height[2] = {s->side[0].body->tree->height, s->side[1].body->tree->height};
    s->stack[0] = (mote_stream_pair){.squared = 0};
    s->pending = 1;
    while (s->pending > 0 && !s->done) {
        if (s->counters.box_tests >= s->options.budget) {
            bound_unvisited(s);
            return;
        }
        const mote_stream_pair pair = s->stack[--s->pending];
        if (!(pair.squared < s->squared))
            continue;
        if (pair.level[0] > height[0])
            mote_stream_leaf_pair(s, pair.node);
        else if (pair.level[0] == height[0] && pair.level[1] == height[1])
            open_groups(s, &pair);
        else
            open_node(s, &pair);
    }
}
