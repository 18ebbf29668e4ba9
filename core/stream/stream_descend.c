/* A near pair of faces by the boxes alone: from the roots down to two groups, then the vertices
   of those that are near each other, and downhill from there. */
#include "core/stream/stream_state.h"

#include "core/body/triangle.h"

#include <string.h>

#define WIDTH MOTE_STREAM_WIDTH

/* Of boxes that overlap the other, the one with the nearest centre is taken: this part of the
   squared distance of the centres is added to that of the boxes. */
#define CENTRES 0.0125F

/* The child of a node that is nearest to a box. */
static uint32_t nearest_child(const mote_stream_block *children, const mote_stream_box *box)
{
    float squared[WIDTH];
    mote_stream_distances(box, children, squared);
    uint32_t best = 0;
    float least = HUGE_VALF;
    for (uint32_t l = 0; l < WIDTH; ++l) {
        float centres = 0;
        for (size_t k = 0; k < 3; ++k) {
            const float d =
                (children->low[k][l] + children->high[k][l]) - (box->low[k] + box->high[k]);
            centres += d * d;
        }
        const float key = squared[l] + CENTRES * centres;
        if (key < least) {
            least = key;
            best = l;
        }
    }
    return best;
}

/* Two groups that are near each other. */
static void find_groups(const mote_stream_search *s, uint32_t group[2])
{
    uint32_t level[2] = {0, 0};
    group[0] = group[1] = 0;
    for (;;) {
        mote_stream_box box[2];
        bool open[2];
        for (int k = 0; k < 2; ++k) {
            box[k] = mote_stream_box_of(s->side[k].body, level[k], group[k]);
            open[k] = level[k] < s->side[k].body->tree->height;
        }
        if (!open[0] && !open[1])
            return;
        int side = mote_stream_size(&box[1]) > mote_stream_size(&box[0]);
        side = open[side] ? side : 1 - side;
        const mote_stream_box other =
            mote_stream_moved_box(s, 1 - side, level[1 - side], group[1 - side]);
        const mote_stream_block *children =
            mote_stream_children(s->side[side].body, level[side], group[side]);
        group[side] = group[side] * WIDTH + nearest_child(children, &other);
        ++level[side];
    }
}

/* The face of a group whose first vertex is nearest to a point. */
static const uint32_t *nearest_face(const mote_stream_body *body, uint32_t group, mote_vec3 to,
                                    mote_vec3 *at)
{
    const mote_stream_tree *tree = body->tree;
    const size_t first = (size_t)group * MOTE_STREAM_GROUP;
    const size_t left = tree->mesh->triangle_count - first;
    const size_t count = left < MOTE_STREAM_GROUP ? left : MOTE_STREAM_GROUP;
    const uint32_t *best = tree->mesh->triangles[tree->order[first]];
    double least = HUGE_VAL;
    for (size_t i = first; i < first + count; ++i) {
        const uint32_t *face = tree->mesh->triangles[tree->order[i]];
        const mote_vec3 p = mote_position_at(&body->positions, face[0]);
        const double squared = mote_distance_squared(p, to);
        if (squared < least) {
            least = squared;
            best = face;
            *at = p;
        }
    }
    return best;
}

/* The middle of a group, in the world. */
static mote_vec3 middle_of(const mote_stream_body *body, uint32_t group)
{
    const mote_stream_box box = mote_stream_box_of(body, body->tree->height, group);
    const mote_vec3 sum = {(double)box.low[0] + (double)box.high[0],
                           (double)box.low[1] + (double)box.high[1],
                           (double)box.low[2] + (double)box.high[2]};
    return mote_add_scaled(body->origin, 0.5 / body->scale, sum);
}

void mote_stream_find_anew(mote_stream_search *s)
{
    uint32_t group[2];
    find_groups(s, group);
    const mote_stream_body *a = s->side[0].body, *b = s->side[1].body;
    mote_vec3 on_a = middle_of(a, group[0]), on_b = middle_of(b, group[1]);
    (void)nearest_face(a, group[0], on_b, &on_a);
    const uint32_t *second = nearest_face(b, group[1], on_a, &on_b);
    const uint32_t *first = nearest_face(a, group[0], on_b, &on_a);
    mote_refined slid = {.squared = 0};
    mote_vec3 corner[2][3];
    memcpy(slid.triangle[0], first, sizeof slid.triangle[0]);
    memcpy(slid.triangle[1], second, sizeof slid.triangle[1]);
    for (int k = 0; k < 3; ++k) {
        corner[0][k] = mote_position_at(&a->positions, first[k]);
        corner[1][k] = mote_position_at(&b->positions, second[k]);
    }
    slid.squared =
        mote_triangle_triangle(corner[0], corner[1], &slid.witness[0], &slid.witness[1]);
    mote_lazy *const lazy[2] = {&s->side[0].lazy, &s->side[1].lazy};
    mote_refine_slide(lazy, s->enough > 0 ? s->enough * s->enough : 0, &slid);
    s->counters.triangle_tests += 1 + slid.triangle_tests;
    ++s->counters.refined;
    if (slid.squared < s->best.squared)
        s->best = slid;
}
