/* Deforming blocks and leaves on demand.

   Margins. Let u = 2^-24, the relative error of one float operation, and let B (side->bound)
   bound |t| + |c| + sum |h_k| + sum_j reach_j |w_j| in each coordinate, t being the translation
   relative to the query's origin: a bound of the sum of the absolute values of all terms of a
   box's centre, half axes and half width together.
   - Each of these is a sum of at most n + 4 terms, n the functions that reach the block; a term
     is a product of two factors, of which one was rounded twice. So every coordinate of a
     point of the box is wrong by at most (n + 7) u B, and its projection on a direction by
     sqrt(3) as much.
   - A projection onto a direction of length <= 1 + 6 u adds up at most 9 roundings of terms
   whose absolute values sum up to at most sqrt(3) B: 16 u B; the difference of two projections
     rounds once more: 2 u B for each box.
   - Dividing a gap, at most 2 sqrt(3) B, by a length of 1 + 6 u changes it by 21 u B, half of
   it for each box. A direction rounded to float shifts a projection by sqrt(3) u B, and so does
   a threshold. The sum is below (n + 40) u B. To it are added tree->leak, by which rest
   vertices stick out of boxes whose axes are rounded, and the rounding of the double precision
   positions themselves, at most 2^-50 of the coordinates' size in the world for each function.
   The half width grows by this in every coordinate, and so the projection on any direction by
   at least as much. */
#include "core/certificate_state.h"
#include "core/clones.h"

#include <stdlib.h>
#include <string.h>

#define WIDTH MOTE_CERT_WIDTH
/* A box that crosses the plane by more than this part of its extent is not worth opening: most
   of what is inside crosses it too. Leaves cost less to open. */
#define CROSSING 0.35F
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
    const uint32_t functions = tree->body->field->count;
    for (uint32_t j = 0; j < functions; ++j) {
        const double scale = tree->scale / tree->basis_scale[j];
        const mote_vec3 w = {state->weights.x[j] * scale, state->weights.y[j] * scale,
                             state->weights.z[j] * scale};
        side->weight[0][j] = (float)w.x;
        side->weight[1][j] = (float)w.y;
        side->weight[2][j] = (float)w.z;
        field.x += fabs(w.x) * tree->reach[j];
        field.y += fabs(w.y) * tree->reach[j];
        field.z += fabs(w.z) * tree->reach[j];
    }
    side->bound = largest(t) + tree->radius + largest(field);
    const double world = (largest(pose->translation) + largest(moved)) * tree->scale;
    side->exact = 0x1p-50 * (functions + 4) * (world + side->bound);
    side->margin_unit = rounded_up(2 * FLOAT_ROUNDING * side->bound);
    side->margin_base =
        rounded_up(40 * FLOAT_ROUNDING * side->bound + tree->leak + side->exact);
    side->reach_margin = rounded_up(4 * FLOAT_ROUNDING * side->bound);
    side->node_count = 0;
    side->point_count = 0;
    side->spare.leaf = UINT32_MAX;
}

void mote_cert_side_face(mote_cert_side *side, mote_vec3 facing, double threshold)
{
    const mote_cert_tree *tree = side->tree;
    const mote_weights *w = &side->state->weights;
    const mote_vec3 rest = mote_rotate_back(&side->state->pose.rotation, facing);
    side->facing = facing;
    side->facing_rest = rest;
    side->facing_f[0] = (float)rest.x;
    side->facing_f[1] = (float)rest.y;
    side->facing_f[2] = (float)rest.z;
    side->shift = (float)mote_dot(side->exact_translation, facing);
    side->pushed_sum = 0;
    for (uint32_t j = 0; j < tree->body->field->count; ++j) {
        const double push =
            tree->scale * (w->x[j] * facing.x + w->y[j] * facing.y + w->z[j] * facing.z);
        side->along[j] = (float)(push / tree->basis_scale[j]);
        side->pushed[j] = (float)push;
        side->pushed_sum += fabs(push);
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
        const float turn = w * row->slope_unit;
        const float size = fabsf(w) * row->rest_unit;
        MOTE_LANE_LOOP
        for (size_t l = 0; l < WIDTH; ++l) {
            middle[l] += row->offset[l] * w;
            axis0[l] += (float)mote_cert_below(row->slopes[l]) * turn;
            axis1[l] += (float)mote_cert_above(row->slopes[l]) * turn;
            axis2[l] += (float)mote_cert_below(row->slope_rest[l]) * turn;
            width[l] += (float)mote_cert_above(row->slope_rest[l]) * size;
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
        const float half = fabsf(axis0[l]) + fabsf(axis1[l]) + fabsf(axis2[l]) + loose;
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

/* Adds what the field does to a block's boxes, all sums in registers. */
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
        const float tx = x * row->slope_unit;
        const float ty = y * row->slope_unit;
        const float tz = z * row->slope_unit;
        const float sx = fabsf(x) * row->rest_unit;
        const float sy = fabsf(y) * row->rest_unit;
        const float sz = fabsf(z) * row->rest_unit;
        MOTE_LANE_LOOP
        for (size_t l = 0; l < WIDTH; ++l) {
            const float f = row->offset[l];
            const float g0 = (float)mote_cert_below(row->slopes[l]);
            const float g1 = (float)mote_cert_above(row->slopes[l]);
            const float g2 = (float)mote_cert_below(row->slope_rest[l]);
            const float m = (float)mote_cert_above(row->slope_rest[l]);
            cx[l] += f * x;
            cy[l] += f * y;
            cz[l] += f * z;
            ax[l] += g0 * tx;
            ay[l] += g0 * ty;
            az[l] += g0 * tz;
            bx[l] += g1 * tx;
            by[l] += g1 * ty;
            bz[l] += g1 * tz;
            dx[l] += g2 * tx;
            dy[l] += g2 * ty;
            dz[l] += g2 * tz;
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

/* Normals of the two longest axes, thickness along them, and sizes. */
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
        float x = ay * bz - az * by;
        float y = az * bx - ax * bz;
        float z = ax * by - ay * bx;
        const float inverse = 1 / sqrtf(x * x + y * y + z * z + 0x1p-100F);
        x *= inverse;
        y *= inverse;
        z *= inverse;
        node->normal[0][l] = x;
        node->normal[1][l] = y;
        node->normal[2][l] = z;
        node->thickness[l] =
            fabsf(ax * x + ay * y + az * z) + fabsf(bx * x + by * y + bz * z) +
            fabsf(node->axis[2][0][l] * x + node->axis[2][1][l] * y + node->axis[2][2][l] * z) +
            (node->width[0][l] * fabsf(x) + node->width[1][l] * fabsf(y) +
             node->width[2][l] * fabsf(z));
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

/* World positions of one group of MOTE_LANES places of a leaf, as mote_body_position gives. */
MOTE_CLONES
static void place_group(const mote_body *body, const mote_body_state *state,
                        const uint32_t vertices[MOTE_LANES], const uint8_t *active,
                        size_t active_count, double *restrict x, double *restrict y,
                        double *restrict z)
{
    double p[3][MOTE_LANES];
    for (size_t v = 0; v < MOTE_LANES; ++v) {
        const mote_vec3 rest = body->mesh->positions[vertices[v]];
        p[0][v] = rest.x;
        p[1][v] = rest.y;
        p[2][v] = rest.z;
    }
    double moved[3][MOTE_LANES] = {{0}};
    if (active_count > 0)
        body->field->kind->group(body->field, body->mesh, vertices, active, active_count,
                                 &state->weights, moved);
    const double(*m)[3] = state->pose.rotation.m;
    const mote_vec3 t = state->pose.translation;
    MOTE_LANE_LOOP
    for (size_t v = 0; v < MOTE_LANES; ++v) {
        x[v] = m[0][0] * p[0][v] + m[0][1] * p[1][v] + m[0][2] * p[2][v] + t.x + moved[0][v];
        y[v] = m[1][0] * p[0][v] + m[1][1] * p[1][v] + m[1][2] * p[2][v] + t.y + moved[1][v];
        z[v] = m[2][0] * p[0][v] + m[2][1] * p[1][v] + m[2][2] * p[2][v] + t.z + moved[2][v];
    }
}

/* MOTE_LANES of a leaf's vertices from place `first` on, padded with copies of the last. */
static inline void take_vertices(const mote_cert_tree *tree, const mote_cert_leaf *leaf,
                                 uint32_t first, uint32_t v[MOTE_LANES])
{
    const uint32_t *vertices = tree->leaf_vertices + leaf->first_vertex;
    for (uint32_t i = 0; i < MOTE_LANES; ++i) {
        const uint32_t k = first + i;
        v[i] = vertices[k < leaf->vertex_count ? k : leaf->vertex_count - 1u];
    }
}

/* Where the field is linear, sum_k z_k slant_k = g.(x - centre) with one g for a box. Vertices
   stick out of it by the leak at most, which g turns into no more than leak * stretch. */
void mote_cert_leaf_linear(const mote_cert_side *side, const mote_cert_node *node, size_t lane,
                           double range[2])
{
    const mote_cert_tree *tree = side->tree;
    const mote_cert_block *block = node->block;
    const mote_vec3 *rest = tree->body->mesh->positions;
    mote_vec3 g = {0, 0, 0};
    double stretch = 0;
    for (size_t k = 0; k < 3; ++k) {
        const mote_vec3 h = {(double)block->half[k][0][lane], (double)block->half[k][1][lane],
                             (double)block->half[k][2][lane]};
        const double slant = (double)node->slant[k][lane];
        const double inverse = 1 / mote_length_squared(h);
        g = mote_add_scaled(g, slant * inverse, h);
        stretch += slant * slant * inverse;
    }
    const mote_vec3 centre = {(double)block->centre[0][lane], (double)block->centre[1][lane],
                              (double)block->centre[2][lane]};
    const mote_vec3 scaled = mote_scale(g, tree->scale);
    const mote_cert_leaf *leaf = &tree->leaves[~block->child[lane]];
    const uint32_t *vertices = tree->leaf_vertices + leaf->first_vertex;
    double most = -HUGE_VAL;
    for (uint32_t i = 0; i < leaf->vertex_count; ++i) {
        const double at = mote_dot(mote_sub(rest[vertices[i]], tree->origin), scaled);
        most = at > most ? at : most;
    }
    most += (double)node->middle[lane] - mote_dot(centre, g);
    /* sqrt(3 sum s^2) >= sum |s| */
    const double loose = (double)node->loose[lane] + tree->leak * sqrt(3 * stretch);
    range[0] = most - loose;
    range[1] = most + loose;
}

/* The largest coordinate along facing of `count` rigidly moved vertices plus what the field
   adds. */
static double reach_of_group(const mote_cert_side *side, const uint32_t *vertices,
                             uint32_t count, const float *field)
{
    const mote_cert_tree *tree = side->tree;
    const mote_vec3 *rest = tree->body->mesh->positions;
    const mote_vec3 u = mote_scale(side->facing_rest, tree->scale);
    double most = -HUGE_VAL;
    for (uint32_t i = 0; i < count; ++i) {
        const double at =
            mote_dot(mote_sub(rest[vertices[i]], tree->origin), u) + (double)field[i];
        most = at > most ? at : most;
    }
    return most + mote_dot(side->exact_translation, side->facing);
}

bool mote_cert_leaf_estimate(const mote_cert_side *side, uint32_t leaf, double range[2])
{
    const mote_cert_tree *tree = side->tree;
    const mote_body *body = tree->body;
    const mote_cert_leaf *l = &tree->leaves[leaf];
    const mote_cert_block *block = &tree->blocks[l->block];
    if (body->field->count > 0 && !body->field->kind->estimate)
        return false;
    double most = -HUGE_VAL;
    float factor = 0;
    for (uint32_t first = 0; first < l->vertex_count; first += MOTE_LANES) {
        uint32_t v[MOTE_LANES];
        float moved[MOTE_LANES] = {0};
        take_vertices(tree, l, first, v);
        if (block->active_count > 0) {
            const float f = body->field->kind->estimate(
                body->field, body->mesh, v, tree->active + block->first_active,
                block->active_count, side->pushed, moved);
            factor = f > factor ? f : factor;
        }
        const uint32_t left = l->vertex_count - first;
        const double reach =
            reach_of_group(side, v, left < MOTE_LANES ? left : MOTE_LANES, moved);
        most = reach > most ? reach : most;
    }
    const double error =
        ((double)factor + 0x1p-23) * side->pushed_sum + 0x1p-44 * side->bound + side->exact;
    range[0] = most - error;
    range[1] = most + error;
    return true;
}

static void place_leaf(const mote_cert_side *side, uint32_t id, mote_cert_points *points)
{
    const mote_cert_tree *tree = side->tree;
    const mote_body *body = tree->body;
    const mote_cert_leaf *leaf = &tree->leaves[id];
    const mote_cert_block *block = &tree->blocks[leaf->block];
    points->leaf = id;
    points->generation = 0;
    points->padded = (leaf->vertex_count + 7u) & ~7u;
    const bool groups = body->field->count == 0 || body->field->kind->group;
    for (uint32_t first = 0; first < points->padded; first += MOTE_LANES) {
        uint32_t v[MOTE_LANES];
        take_vertices(tree, leaf, first, v);
        if (groups) {
            place_group(body, side->state, v, tree->active + block->first_active,
                        block->active_count, points->x[0] + first, points->x[1] + first,
                        points->x[2] + first);
            continue;
        }
        for (uint32_t i = 0; i < MOTE_LANES; ++i) {
            const mote_vec3 p = mote_body_position(body, side->state, v[i]);
            points->x[0][first + i] = p.x;
            points->x[1][first + i] = p.y;
            points->x[2][first + i] = p.z;
        }
    }
}

/* Least and largest of a group's coordinates. */
MOTE_INLINE void range_of_group(const double *restrict x, const double *restrict y,
                                const double *restrict z, mote_vec3 d, mote_vec3 o,
                                double range[2])
{
    double p[8], low[4], high[4];
    MOTE_LANE_LOOP
    for (size_t v = 0; v < 8; ++v)
        p[v] = (x[v] - o.x) * d.x + (y[v] - o.y) * d.y + (z[v] - o.z) * d.z;
    MOTE_LANE_LOOP
    for (size_t v = 0; v < 4; ++v) {
        low[v] = p[v] < p[v + 4] ? p[v] : p[v + 4];
        high[v] = p[v] > p[v + 4] ? p[v] : p[v + 4];
    }
    const double low0 = low[0] < low[2] ? low[0] : low[2];
    const double low1 = low[1] < low[3] ? low[1] : low[3];
    const double high0 = high[0] > high[2] ? high[0] : high[2];
    const double high1 = high[1] > high[3] ? high[1] : high[3];
    range[0] = low0 < low1 ? low0 : low1;
    range[1] = high0 > high1 ? high0 : high1;
}

MOTE_CLONES
void mote_cert_range(const mote_cert_points *points, mote_vec3 direction, mote_vec3 origin,
                     double range[2])
{
    range_of_group(points->x[0], points->x[1], points->x[2], direction, origin, range);
    if (points->padded > MOTE_LANES) {
        double more[2];
        range_of_group(points->x[0] + 8, points->x[1] + 8, points->x[2] + 8, direction, origin,
                       more);
        range[0] = more[0] < range[0] ? more[0] : range[0];
        range[1] = more[1] > range[1] ? more[1] : range[1];
    }
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

/* Brings a node that is known up to date with the plane. */
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

mote_cert_points *mote_cert_leaf_child(mote_certificate *c, int s, mote_cert_node *node,
                                       size_t lane)
{
    mote_cert_side *side = &c->side[s];
    const uint32_t id = (uint32_t)~node->block->child[lane];
    mote_cert_points *points;
    if (node->child[lane] >= 0) {
        points = &side->points[node->child[lane]];
    } else if (side->point_count < side->point_room) {
        node->child[lane] = (int32_t)side->point_count;
        points = &side->points[side->point_count++];
        points->leaf = UINT32_MAX;
    } else {
        points = &side->spare;
    }
    if (points->leaf != id) {
        place_leaf(side, id, points);
        c->counters.positions += side->tree->leaves[id].vertex_count;
    }
    if (points->generation != c->generation) {
        double range[2];
        mote_cert_range(points, side->facing, c->origin, range);
        points->reach = range[1] * c->scale;
        points->generation = c->generation;
    }
    return points;
}
