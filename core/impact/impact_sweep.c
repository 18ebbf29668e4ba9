/* The traversal of impact_sweep.h.

   Margins. A box's half widths hold the rounding of its own numbers (certificate_fitted.c,
   skin_frame.c). What is added here, sums of two boxes' and their displacements' numbers along
   a direction in single precision, has at most 64 roundings of terms that add up to at most
   sqrt(3) times the bounds of both sides: `spare` is 2^-17 of those bounds. Triangles are
   decided in double precision; their positions and displacements are rounded by less than the
   noise that the tolerance includes, since a step is so short that no body turns by more than a
   radian in it. */
#include "core/impact/impact_sweep.h"

#include "core/certificate/certificate_bounds.h"
#include "core/certificate/certificate_fitted.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define WIDTH MOTE_CERT_WIDTH

static void *aligned(size_t count, size_t size, size_t *bytes)
{
    const size_t all = (count * size + 127) / 64 * 64;
    *bytes += all;
    void *memory = aligned_alloc(64, all);
    if (memory)
        memset(memory, 0, all);
    return memory;
}

mote_status mote_sweep_create(mote_certificate *certificate, mote_sweep *sweep, size_t *bytes)
{
    sweep->certificate = certificate;
    for (int i = 0; i < 2; ++i) {
        const mote_cert_side *side = &certificate->side[i];
        mote_sweep_side *own = &sweep->side[i];
        const size_t frame = side->tree->bounds->frame_bytes(side->tree);
        own->boxes = aligned(1, sizeof *own->boxes, bytes);
        own->nodes = aligned(side->node_room, sizeof *own->nodes, bytes);
        own->stamps = aligned(side->node_room, sizeof *own->stamps, bytes);
        own->leaves = aligned(MOTE_SWEEP_LEAVES, sizeof *own->leaves, bytes);
        if (!own->boxes || !own->nodes || !own->stamps || !own->leaves)
            return mote_fail(MOTE_ENOMEM, "no memory for the boxes of a sweep");
        own->boxes->tree = side->tree;
        own->boxes->frame_bytes = frame;
        own->boxes->frame = aligned(frame, 1, bytes);
        if (!own->boxes->frame)
            return mote_fail(MOTE_ENOMEM, "no memory for the boxes of a sweep");
        const uint32_t vertices = side->tree->body->mesh->vertex_count;
        const uint32_t expected = vertices < 4096 ? 128 + vertices / 4 : 2048;
        const mote_status status = mote_lazy_init(&own->moved, side->tree->body, expected);
        if (status != MOTE_OK)
            return status;
        own->moved.fixed = true;
        *bytes += ((size_t)own->moved.mask + 1) * sizeof *own->moved.slots;
    }
    return MOTE_OK;
}

void mote_sweep_destroy(mote_sweep *sweep)
{
    for (int i = 0; i < 2; ++i) {
        mote_sweep_side *own = &sweep->side[i];
        if (own->boxes)
            free(own->boxes->frame);
        free(own->boxes);
        free(own->nodes);
        free(own->stamps);
        free(own->leaves);
        mote_lazy_free(&own->moved);
    }
}

/* A child of a node: a box with its motion. */
typedef struct part {
    mote_cert_node *node, *motion;
    size_t lane;
} part;

/* One part, by value: [0] where it is, [1] its displacement. */
typedef struct moving_box {
    float centre[2][3], axis[2][3][3], width[2][3];
} moving_box;

static void load(const mote_cert_node *node, size_t lane, size_t k, moving_box *box)
{
    for (size_t r = 0; r < 3; ++r) {
        box->centre[k][r] = node->centre[r][lane];
        box->width[k][r] = node->width[r][lane];
        for (size_t a = 0; a < 3; ++a)
            box->axis[k][a][r] = node->axis[a][r][lane];
    }
}

/* The gap along (x, y, z) of box d and lane l of node e at the part f of the step. */
MOTE_INLINE float gap_along(const moving_box *restrict d, const mote_cert_node *restrict e,
                            const mote_cert_node *restrict m, size_t l, float f, float x,
                            float y, float z)
{
    float half = 0;
    for (size_t a = 0; a < 3; ++a) {
        half += fabsf((d->axis[0][a][0] + f * d->axis[1][a][0]) * x +
                      (d->axis[0][a][1] + f * d->axis[1][a][1]) * y +
                      (d->axis[0][a][2] + f * d->axis[1][a][2]) * z);
        half += fabsf((e->axis[a][0][l] + f * m->axis[a][0][l]) * x +
                      (e->axis[a][1][l] + f * m->axis[a][1][l]) * y +
                      (e->axis[a][2][l] + f * m->axis[a][2][l]) * z);
    }
    const float own[3] = {d->width[0][0] + f * d->width[1][0],
                          d->width[0][1] + f * d->width[1][1],
                          d->width[0][2] + f * d->width[1][2]};
    half += (own[0] + e->width[0][l] + f * m->width[0][l]) * fabsf(x) +
            (own[1] + e->width[1][l] + f * m->width[1][l]) * fabsf(y) +
            (own[2] + e->width[2][l] + f * m->width[2][l]) * fabsf(z);
    const float apart =
        (e->centre[0][l] + f * m->centre[0][l] - (d->centre[0][0] + f * d->centre[1][0])) * x +
        (e->centre[1][l] + f * m->centre[1][l] - (d->centre[0][1] + f * d->centre[1][1])) * y +
        (e->centre[2][l] + f * m->centre[2][l] - (d->centre[0][2] + f * d->centre[1][2])) * z;
    return apart - half;
}

/* The lanes of e, with the motion m, that are not shown to stay apart from box d. need: at the
   start and at the part f. */
MOTE_CLONES
static uint32_t row(const moving_box *restrict d, const mote_cert_node *restrict e,
                    const mote_cert_node *restrict m, float f, const float need[2],
                    const float facing[3])
{
    float spare[WIDTH];
    MOTE_LANE_LOOP
    for (size_t l = 0; l < WIDTH; ++l) {
        const float g = 0.5F * f;
        const float x =
            e->centre[0][l] + g * m->centre[0][l] - (d->centre[0][0] + g * d->centre[1][0]);
        const float y =
            e->centre[1][l] + g * m->centre[1][l] - (d->centre[0][1] + g * d->centre[1][1]);
        const float z =
            e->centre[2][l] + g * m->centre[2][l] - (d->centre[0][2] + g * d->centre[1][2]);
        const float length = sqrtf(x * x + y * y + z * z) * (1 + 0x1p-20F) + 0x1p-50F;
        const float a0 = gap_along(d, e, m, l, 0, x, y, z) - need[0] * length;
        const float a1 = gap_along(d, e, m, l, f, x, y, z) - need[1] * length;
        const float b0 = gap_along(d, e, m, l, 0, facing[0], facing[1], facing[2]) - need[0];
        const float b1 = gap_along(d, e, m, l, f, facing[0], facing[1], facing[2]) - need[1];
        const float a = a0 < a1 ? a0 : a1;
        const float b = b0 < b1 ? b0 : b1;
        spare[l] = a > b ? a : b;
    }
    uint32_t bits = 0;
    MOTE_LANE_LOOP
    for (size_t l = 0; l < WIDTH; ++l)
        bits |= spare[l] > 0 ? 0 : 1u << l; /* a NaN counts as not shown */
    return bits & e->block->mask;
}

/* The boxes of other kinds of bounds need not be linear in z: puts their axes into their
   widths, so that they count for any z of the positions. */
static void forget_axes(mote_cert_node *node)
{
    for (size_t r = 0; r < 3; ++r) {
        for (size_t a = 0; a < 3; ++a) {
            for (size_t l = 0; l < WIDTH; ++l) {
                node->width[r][l] += fabsf(node->axis[a][r][l]) * (1 + 0x1p-20F);
                node->axis[a][r][l] = 0;
            }
        }
    }
}

/* The motion of a node's boxes; NULL where the node is not one that is kept. */
static mote_cert_node *motion_of(mote_sweep *w, int s, mote_cert_node *node)
{
    const mote_cert_side *side = &w->certificate->side[s];
    mote_sweep_side *own = &w->side[s];
    /* of a node that is not kept, anything from their number on */
    const size_t index = ((uintptr_t)node - (uintptr_t)side->nodes) / sizeof *node;
    if (index >= side->node_count)
        return NULL;
    mote_cert_node *motion = &own->nodes[index];
    if (own->stamps[index] != w->stamp) {
        own->stamps[index] = w->stamp;
        own->boxes->tree->bounds->boxes(own->boxes, node->block, motion);
        if (own->boxes->tree->bounds != &mote_cert_fitted)
            forget_axes(motion);
    }
    mote_cert_make_boxes(w->certificate, s, node);
    return motion;
}

/* A leaf with its motion, evaluated once a sweep as long as it is not pushed out. */
static const mote_moving_leaf *leaf_of(mote_sweep *w, int s, const part *p)
{
    const int32_t number = ~p->node->block->child[p->lane];
    mote_moving_leaf *leaf = &w->side[s].leaves[number % MOTE_SWEEP_LEAVES];
    if (leaf->stamp == w->stamp && leaf->number == number)
        return leaf;
    leaf->stamp = w->stamp;
    mote_moving_leaf_load(&w->certificate->side[s], &w->side[s].moved, number,
                          mote_scale(w->direction, s ? -1 : 1), w->part, leaf);
    return leaf;
}

static void decide_leaves(mote_sweep *w, const part pair[2])
{
    ++w->leaf_pairs;
    const mote_moving_leaf *first = leaf_of(w, 0, &pair[0]);
    w->part = mote_moving_leaves(first, leaf_of(w, 1, &pair[1]), &w->question, w->part,
                                 &w->triangle_tests);
}

static bool is_leaf(const part *p)
{
    return p->node->block->child[p->lane] < 0;
}

/* Decides about two parts that were not shown to stay apart: opens the larger one. */
static void visit(mote_sweep *w, const part pair[2], uint32_t depth)
{
    if (!(w->part > 0) || w->failed)
        return;
    if (is_leaf(&pair[0]) && is_leaf(&pair[1])) {
        decide_leaves(w, pair);
        return;
    }
    const bool first = is_leaf(&pair[1]) ||
                       (!is_leaf(&pair[0]) &&
                        pair[0].node->size[pair[0].lane] > pair[1].node->size[pair[1].lane]);
    const int s = first ? 0 : 1;
    mote_cert_node *node =
        mote_cert_child(w->certificate, s, pair[s].node, pair[s].lane, depth);
    mote_cert_node *motion = motion_of(w, s, node);
    if (!motion) {
        w->failed = true;
        return;
    }
    moving_box box;
    const part *other = &pair[1 - s];
    load(other->node, other->lane, 0, &box);
    load(other->motion, other->lane, 1, &box);
    const double scale = w->certificate->scale;
    const float f = (float)w->part * (1 + 0x1p-22F);
    const float need[2] = {
        (float)(w->question.tolerance * scale) * (1 + 0x1p-20F) + w->spare,
        (float)((w->question.tolerance + w->question.bend * w->part * w->part) * scale) *
                (1 + 0x1p-20F) +
            w->spare};
    /* from the box to the node's */
    const float sign = s == 1 ? 1 : -1;
    const float facing[3] = {sign * w->facing[0], sign * w->facing[1], sign * w->facing[2]};
    uint32_t left = row(&box, node, motion, f, need, facing);
    w->box_tests += node->block->children;
    for (; left; left &= left - 1) {
        part next[2];
        next[s] = (part){node, motion, (size_t)__builtin_ctz(left)};
        next[1 - s] = *other;
        visit(w, next, depth + 1);
    }
}

/* What the certificate found nearest is likely to meet first. */
static void decide_best(mote_sweep *w)
{
    const mote_certificate *c = w->certificate;
    mote_moving_triangle t[2];
    for (int s = 0; s < 2; ++s) {
        for (int k = 0; k < 3; ++k) {
            const uint32_t v = c->best.triangle[s][k];
            t[s].p[k] = mote_lazy_position(&w->certificate->side[s].lazy, v);
            t[s].d[k] = mote_lazy_position(&w->side[s].moved, v);
        }
    }
    w->part = mote_moving_triangles(&t[0], &t[1], &w->question, w->part, &w->triangle_tests);
}

double mote_sweep_query(mote_sweep *w, mote_vec3 direction, double tolerance, double bend)
{
    mote_certificate *c = w->certificate;
    ++w->stamp;
    w->part = 1;
    w->failed = false;
    w->box_tests = w->triangle_tests = w->leaf_pairs = 0;
    double bound = 0;
    for (int s = 0; s < 2; ++s) {
        mote_cert_side *boxes = w->side[s].boxes;
        mote_cert_side_begin(boxes, &w->side[s].state, mote_vec3_make(0, 0, 0));
        mote_lazy_begin(&w->side[s].moved, &w->side[s].state, false);
        bound += c->side[s].bound + boxes->bound;
    }
    w->spare = (float)(bound * 0x1p-17);
    w->direction = direction;
    w->question =
        (mote_leaf_question){.tolerance = tolerance, .bend = bend, .apart = direction};
    w->facing[0] = (float)direction.x;
    w->facing[1] = (float)direction.y;
    w->facing[2] = (float)direction.z;
    decide_best(w);
    part pair[2];
    for (int s = 0; s < 2; ++s) {
        pair[s].node = mote_cert_root(c, s);
        pair[s].motion = motion_of(w, s, pair[s].node);
    }
    for (uint32_t i = 0; i < pair[0].node->block->children; ++i) {
        for (uint32_t j = 0; j < pair[1].node->block->children; ++j) {
            pair[0].lane = i;
            pair[1].lane = j;
            visit(w, pair, 0);
        }
    }
    return w->failed ? 0 : w->part;
}
