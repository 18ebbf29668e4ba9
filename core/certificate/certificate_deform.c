/* Deforming blocks and leaves on demand.

   Margins. Let u = 2^-24, the relative error of one float operation, and let B (side->bound)
   bound |t| + |c| + sum |h_k| + sum_j reach_j |w_j| in each coordinate, t being the translation
   relative to the query's origin: a bound of the sum of the absolute values of all terms of a
   box's centre, half axes and half width together.
   - Each of these is a sum of at most n + 4 terms, where n functions are active in the block; a
     term is a product of two factors, of which one was rounded twice. So every coordinate of a
     point of the box is wrong by at most (n + 7) u B, and its projection on a direction by
     sqrt(3) as much.
   - A projection onto a direction of length <= 1 + 6 u has at most 9 roundings of terms whose
     absolute values sum up to at most sqrt(3) B: 16 u B. The difference of two projections
     rounds once more: 2 u B for each box.
   - The empty corners that are subtracted from a reach are stored too small by 1 part in
   25,000, which is more than the three roundings of their product.
   - Dividing a gap, at most 2 sqrt(3) B, by a length of 1 + 6 u changes it by 21 u B, half of
   it for each box. Along a line that is not divided by its length, all of this is multiplied by
   the length, and a root and two products more are 4 u of what it is compared with. A direction
   rounded to float shifts a projection by sqrt(3) u B, and so does a threshold. The sum is
   below (n + 40) u B. To it are added tree->leak, by which rest vertices stick out of boxes
   whose axes are rounded, and the rounding of the double precision positions themselves, at
   most 2^-50 of the coordinates' size in the world for each function. The half width grows by
   this in every coordinate, and so the projection on any direction by at least as much. */
#include "core/certificate/certificate_state.h"
#include "core/base/clones.h"

#include <stdlib.h>
#include <string.h>

#define WIDTH MOTE_CERT_WIDTH
/* A box that crosses the plane by more than this part of its extent is not worth opening, since
   most of what is inside crosses the plane too. Leaves are cheaper to open. */
#define CROSSING 0.4F
#define CROSSING_LEAF 0.5F

#define FLOAT_ROUNDING 0x1p-24

static double largest(mote_vec3 v)
{
    const double a = fabs(v.x) > fabs(v.y) ? fabs(v.x) : fabs(v.y);
    return a > fabs(v.z) ? a : fabs(v.z);
}

static float rounded_up(double x)
{
    return (float)(x * (1 + 0x1p-22));
}

void mote_cert_side_begin(mote_cert_side *side, const mote_body_state *state, mote_vec3 origin)
{
    const mote_cert_tree *tree = side->tree;
    const mote_pose *pose = &state->pose;
    side->state = state;
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c)
            side->rotation[r][c] = (float)pose->rotation.m[r][c];
    }
    const mote_vec3 moved = mote_rotate(&pose->rotation, tree->origin);
    const mote_vec3 t =
        mote_scale(mote_add(moved, mote_sub(pose->translation, origin)), tree->scale);
    side->exact_translation = t;
    side->translation[0] = (float)t.x;
    side->translation[1] = (float)t.y;
    side->translation[2] = (float)t.z;
    mote_vec3 field = {0, 0, 0};
    mote_vec3 sum = {0, 0, 0};
    const uint32_t functions = tree->body->field->count;
    for (uint32_t j = 0; j < functions; ++j) {
        const double scale = tree->scale / tree->basis_scale[j];
        const mote_vec3 w = {state->weights.x[j] * scale, state->weights.y[j] * scale,
                             state->weights.z[j] * scale};
        side->weight[0][j] = (float)w.x;
        side->weight[1][j] = (float)w.y;
        side->weight[2][j] = (float)w.z;
        const double own = tree->basis_scale[j];
        side->single[0][j] = (float)(w.x * own);
        side->single[1][j] = (float)(w.y * own);
        side->single[2][j] = (float)(w.z * own);
        sum = mote_add(sum, mote_vec3_make(fabs(w.x) * own, fabs(w.y) * own, fabs(w.z) * own));
        field.x += fabs(w.x) * tree->row_bound[j];
        field.y += fabs(w.y) * tree->row_bound[j];
        field.z += fabs(w.z) * tree->row_bound[j];
    }
    side->bound = largest(t) + tree->radius + largest(field);
    const double world = (largest(pose->translation) + largest(moved)) * tree->scale;
    side->exact = 0x1p-50 * (functions + 4) * (world + side->bound);
    side->margin_unit = rounded_up(2 * FLOAT_ROUNDING * side->bound);
    side->margin_base =
        rounded_up(40 * FLOAT_ROUNDING * side->bound + tree->leak + side->exact);
    side->reach_margin = rounded_up(4 * FLOAT_ROUNDING * side->bound);
    side->leaf_margin = rounded_up(32 * FLOAT_ROUNDING * side->bound);
    side->single_sum[0] = rounded_up(sum.x);
    side->single_sum[1] = rounded_up(sum.y);
    side->single_sum[2] = rounded_up(sum.z);
    side->node_count = 0;
    side->reached = NULL;
    for (size_t i = 0; i < MOTE_CERT_HULLS; ++i)
        side->hulls[i].leaf = NULL;
}

void mote_cert_side_face(mote_cert_side *side, mote_vec3 facing, double threshold)
{
    const mote_cert_tree *tree = side->tree;
    const mote_weights *w = &side->state->weights;
    const mote_vec3 local = mote_rotate_back(&side->state->pose.rotation, facing);
    side->facing = facing;
    side->facing_f[0] = (float)local.x;
    side->facing_f[1] = (float)local.y;
    side->facing_f[2] = (float)local.z;
    side->facing_world[0] = (float)facing.x;
    side->facing_world[1] = (float)facing.y;
    side->facing_world[2] = (float)facing.z;
    side->shift = (float)mote_dot(side->exact_translation, facing);
    for (uint32_t j = 0; j < tree->body->field->count; ++j) {
        const double push =
            tree->scale * (w->x[j] * facing.x + w->y[j] * facing.y + w->z[j] * facing.z);
        side->along[j] = (float)(push / tree->basis_scale[j]);
    }
    side->threshold = threshold;
    side->threshold_f = (float)threshold;
}

MOTE_INLINE uint32_t bits_at_most(const float x[WIDTH], float limit)
{
    uint32_t bits = 0;
    MOTE_LANE_LOOP
    for (size_t l = 0; l < WIDTH; ++l)
        bits |= x[l] <= limit ? 1u << l : 0;
    return bits;
}

/* Coordinates of a block's boxes towards the other body. */
MOTE_CLONES
static void project_block(const mote_cert_side *restrict side,
                          const mote_cert_block *restrict block, mote_cert_node *restrict node)
{
    const mote_cert_row *rows = side->tree->rows + block->first_row;
    const uint8_t *active = side->tree->active + block->first_active;
    const float x = side->facing_f[0];
    const float y = side->facing_f[1];
    const float z = side->facing_f[2];
    float middle[WIDTH] = {0};
    float axis0[WIDTH] = {0};
    float axis1[WIDTH] = {0};
    float axis2[WIDTH] = {0};
    float width[WIDTH] = {0};
    for (size_t i = 0; i < block->active_count; ++i) {
        const mote_cert_row *row = &rows[i];
        const float w = side->along[active[i]];
        const float size = fabsf(w);
        MOTE_LANE_LOOP
        for (size_t l = 0; l < WIDTH; ++l) {
            middle[l] += row->offset[l] * w;
            axis0[l] += row->slope[0][l] * w;
            axis1[l] += row->slope[1][l] * w;
            axis2[l] += row->slope[2][l] * w;
            width[l] += row->residual[l] * size;
        }
    }
    const float shift = side->shift;
    const float margin = side->margin_base + side->margin_unit * (float)block->active_count;
    MOTE_LANE_LOOP
    for (size_t l = 0; l < WIDTH; ++l) {
        middle[l] += shift + (block->centre[0][l] * x + block->centre[1][l] * y +
                              block->centre[2][l] * z);
        axis0[l] +=
            block->half[0][0][l] * x + block->half[0][1][l] * y + block->half[0][2][l] * z;
        axis1[l] +=
            block->half[1][0][l] * x + block->half[1][1][l] * y + block->half[1][2][l] * z;
        axis2[l] +=
            block->half[2][0][l] * x + block->half[2][1][l] * y + block->half[2][2][l] * z;
        const float loose = width[l] + margin;
        const float size0 = fabsf(axis0[l]);
        const float size1 = fabsf(axis1[l]);
        const float size2 = fabsf(axis2[l]);
        const float empty01 = (float)mote_cert_cut_of(block->cut[0][l], axis0[l], axis1[l]) *
                              (size0 < size1 ? size0 : size1);
        const float empty02 = (float)mote_cert_cut_of(block->cut[1][l], axis0[l], axis2[l]) *
                              (size0 < size2 ? size0 : size2);
        const float empty12 = (float)mote_cert_cut_of(block->cut[2][l], axis1[l], axis2[l]) *
                              (size1 < size2 ? size1 : size2);
        const float empty0 = empty01 > empty02 ? empty01 : empty02;
        const float empty = (empty0 > empty12 ? empty0 : empty12) * (1.0F / 255);
        const float half = ((size0 + size1 + size2) - empty) + loose;
        node->middle[l] = middle[l];
        node->slant[0][l] = axis0[l];
        node->slant[1][l] = axis1[l];
        node->slant[2][l] = axis2[l];
        node->loose[l] = loose;
        node->reach[l] = middle[l] + half;
        node->extent[l] = 2 * half;
    }
    const float threshold = side->threshold_f;
    float excess[WIDTH];
    MOTE_LANE_LOOP
    for (size_t l = 0; l < WIDTH; ++l)
        excess[l] =
            node->reach[l] - (block->child[l] < 0 ? CROSSING_LEAF : CROSSING) * node->extent[l];
    node->clear = bits_at_most(node->reach, threshold) & block->mask;
    node->crossing = bits_at_most(excess, threshold) & block->mask & ~node->clear;
}

/* The rigid motion of a block's boxes. */
MOTE_INLINE void move(const mote_cert_side *restrict side,
                      const mote_cert_block *restrict block, mote_cert_node *restrict node)
{
    const float margin = side->margin_base + side->margin_unit * (float)block->active_count;
    for (size_t r = 0; r < 3; ++r) {
        const float a = side->rotation[r][0];
        const float b = side->rotation[r][1];
        const float c = side->rotation[r][2];
        const float t = side->translation[r];
        MOTE_LANE_LOOP
        for (size_t l = 0; l < WIDTH; ++l) {
            node->centre[r][l] =
                t + a * block->centre[0][l] + b * block->centre[1][l] + c * block->centre[2][l];
            for (size_t k = 0; k < 3; ++k)
                node->axis[k][r][l] = a * block->half[k][0][l] + b * block->half[k][1][l] +
                                      c * block->half[k][2][l];
            node->width[r][l] = margin;
        }
    }
}

/* Adds the field's effect to a block's boxes; all sums are kept in registers. */
MOTE_INLINE void add_field(const mote_cert_side *restrict side,
                           const mote_cert_block *restrict block, mote_cert_node *restrict node)
{
    const mote_cert_row *rows = side->tree->rows + block->first_row;
    const uint8_t *active = side->tree->active + block->first_active;
    float cx[WIDTH] = {0}, cy[WIDTH] = {0}, cz[WIDTH] = {0};
    float ax[WIDTH] = {0}, ay[WIDTH] = {0}, az[WIDTH] = {0};
    float bx[WIDTH] = {0}, by[WIDTH] = {0}, bz[WIDTH] = {0};
    float dx[WIDTH] = {0}, dy[WIDTH] = {0}, dz[WIDTH] = {0};
    float ex[WIDTH] = {0}, ey[WIDTH] = {0}, ez[WIDTH] = {0};
    for (size_t i = 0; i < block->active_count; ++i) {
        const mote_cert_row *row = &rows[i];
        const float x = side->weight[0][active[i]];
        const float y = side->weight[1][active[i]];
        const float z = side->weight[2][active[i]];
        const float sx = fabsf(x);
        const float sy = fabsf(y);
        const float sz = fabsf(z);
        MOTE_LANE_LOOP
        for (size_t l = 0; l < WIDTH; ++l) {
            const float f = row->offset[l];
            const float g0 = row->slope[0][l];
            const float g1 = row->slope[1][l];
            const float g2 = row->slope[2][l];
            const float m = row->residual[l];
            cx[l] += f * x;
            cy[l] += f * y;
            cz[l] += f * z;
            ax[l] += g0 * x;
            ay[l] += g0 * y;
            az[l] += g0 * z;
            bx[l] += g1 * x;
            by[l] += g1 * y;
            bz[l] += g1 * z;
            dx[l] += g2 * x;
            dy[l] += g2 * y;
            dz[l] += g2 * z;
            ex[l] += m * sx;
            ey[l] += m * sy;
            ez[l] += m * sz;
        }
    }
    const float *const sums[3][5] = {
        {cx, ax, bx, dx, ex}, {cy, ay, by, dy, ey}, {cz, az, bz, dz, ez}};
    for (size_t r = 0; r < 3; ++r) {
        MOTE_LANE_LOOP
        for (size_t l = 0; l < WIDTH; ++l) {
            node->centre[r][l] += sums[r][0][l];
            node->axis[0][r][l] += sums[r][1][l];
            node->axis[1][r][l] += sums[r][2][l];
            node->axis[2][r][l] += sums[r][3][l];
            node->width[r][l] += sums[r][4][l];
        }
    }
}

/* Sizes of the boxes. */
MOTE_INLINE void measure(mote_cert_node *restrict node)
{
    MOTE_LANE_LOOP
    for (size_t l = 0; l < WIDTH; ++l) {
        const float ax = node->axis[0][0][l];
        const float ay = node->axis[0][1][l];
        const float az = node->axis[0][2][l];
        const float bx = node->axis[1][0][l];
        const float by = node->axis[1][1][l];
        const float bz = node->axis[1][2][l];
        node->size[l] = (ax * ax + ay * ay + az * az) + (bx * bx + by * by + bz * bz);
    }
}

MOTE_CLONES
static void deform_block(const mote_cert_side *restrict side,
                         const mote_cert_block *restrict block, mote_cert_node *restrict node)
{
    move(side, block, node);
    add_field(side, block, node);
    measure(node);
}

/* Projects a node onto the plane's normal. */
static mote_cert_node *face_node(mote_certificate *c, int s, mote_cert_node *node)
{
    project_block(&c->side[s], node->block, node);
    node->generation = c->generation;
    return node;
}

static mote_cert_node *new_node(mote_certificate *c, int s, const mote_cert_block *block,
                                mote_cert_node *node)
{
    node->block = block;
    node->boxes = false;
    for (size_t l = 0; l < WIDTH; ++l)
        node->child[l] = -1;
    ++c->counters.blocks;
    return face_node(c, s, node);
}

/* Projects a kept node again if the plane has changed since. */
static mote_cert_node *known_node(mote_certificate *c, int s, mote_cert_node *node)
{
    return node->generation == c->generation ? node : face_node(c, s, node);
}

void mote_cert_make_boxes(mote_certificate *c, int s, mote_cert_node *node)
{
    if (node->boxes)
        return;
    deform_block(&c->side[s], node->block, node);
    node->boxes = true;
}

mote_cert_node *mote_cert_root(mote_certificate *c, int s)
{
    mote_cert_side *side = &c->side[s];
    if (side->node_count > 0)
        return known_node(c, s, &side->nodes[0]);
    side->node_count = 1;
    return new_node(c, s, &side->tree->blocks[0], &side->nodes[0]);
}

mote_cert_node *mote_cert_child(mote_certificate *c, int s, mote_cert_node *node, size_t lane,
                                uint32_t depth)
{
    mote_cert_side *side = &c->side[s];
    if (node->child[lane] >= 0)
        return known_node(c, s, &side->nodes[node->child[lane]]);
    const mote_cert_block *block = &side->tree->blocks[node->block->child[lane]];
    if (side->node_count >= side->node_room)
        return new_node(c, s, block, &c->spare[depth]);
    node->child[lane] = (int32_t)side->node_count;
    return new_node(c, s, block, &side->nodes[side->node_count++]);
}
