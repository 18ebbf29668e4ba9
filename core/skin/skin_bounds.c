/* Bounds of a skin, in a query.

   Margins. Let u = 2^-24, and let S (side->bound) bound, for each bone and each coordinate r,
       |M_b[r][3]| + |row r of M_b| (|c| + sum_k |h_k|)
   of any box: by Cauchy's inequality, all terms of a coordinate of M_b x together, for any
   point of a box. Along a direction they add up to at most sqrt(3) S.

   - Matrices are rounded to floats once, or twice along a direction. Above the leaves each term
   of an end of an interval is rounded at most 9 times, and the end once more; the middle and
   half size of the union once more each: at most 24 u S. The union of intervals within -S .. S
   is within it, so that all terms of the box are at most 2 S; what tests of boxes round is at
   most 40 u of what these add up to (certificate_fitted.c): 24 sqrt(3) + 80 < 128 u S.
   - At leaves, with K (head.reach) the sum of the sizes of a child's entries, all terms add up
   to at most B = S (1 + 2 K): e and the d_k together are at most 2 S. Each is rounded at most
   13 times, and n times more where n bones are added up: sqrt(3) (n + 13) + 40 < 2 n + 64 u B.
   - Rest vertices stick out of boxes by tree->leak; a matrix whose rows are no longer than
   `stretch` makes that at most sqrt(3) stretch leak along any direction.
   - Positions in double precision are sums of 4 terms a bone; with V the size of the weight
   vectors and `world` that of the pose's coordinates, each is wrong by at most 2^-53 (4 n + 12)
   (world + V + S), n being the most bones of a vertex; 2^-48 (n + 4) is more, and covers the
   rounding of the matrices' entries in double precision too.
   - Hulls: a vertex in floats, a matrix's entries, four products and their sums are wrong by 7
   u S, the sum over n bones, whose weights are exact and add up to 1, by (n + 1) u S, and what
   follows is rounded as in certificate_leaf.c: less than (64 + n) u S. */
#include "core/skin/skin_bounds.h"
#include "core/certificate/certificate_project.h"
#include "core/skin/skin_data.h"

#include <float.h>
#include <string.h>

#define WIDTH MOTE_CERT_WIDTH
#define FLOAT_ROUNDING 0x1p-24

/* A leaf whose width is more than this part of its axes is worth measuring. */
#define WIDE 0.1F

/* The bones' matrices in the tree's units, relative to the query's origin. */
typedef struct skin_frame {
    float hull_width;
    float (*along)[4];    /* [bones] along the plane's normal */
    float matrix[][3][4]; /* [bones] */
} skin_frame;

static const skin_frame *frame_of(const mote_cert_side *side)
{
    return side->frame;
}

static float rounded_up(double x)
{
    return (float)(x * (1 + 0x1p-22));
}

static size_t skin_frame_bytes(const mote_cert_tree *tree)
{
    const size_t bones = mote_skin_of(tree->body->field)->bones;
    return sizeof(skin_frame) + bones * 16 * sizeof(float);
}

/* Sizes of all bones, for the margins. */
typedef struct sizes {
    double reach;   /* S */
    double stretch; /* the longest row */
    double moved;   /* V */
    double finite;  /* 0, or a NaN where any weight is not finite */
} sizes;

static double larger(double a, double b)
{
    return a > b ? a : b;
}

/* Row r of the matrix of a bone, whose weights begin at w; at: from the skin's origin to the
   tree's, in the skin's units. */
static void make_row(const mote_cert_side *side, const mote_skin *skin, const double *w,
                     const double at[3], size_t r, float row[4], sizes *all)
{
    const double t[3] = {side->exact_translation.x, side->exact_translation.y,
                         side->exact_translation.z};
    const double *rotation = side->state->pose.rotation.m[r];
    const double scale = side->tree->scale;
    double m[4], squared = 0, moved = 0;
    for (size_t k = 0; k < 3; ++k) {
        m[k] = rotation[k] + w[k] / skin->unit;
        squared += m[k] * m[k];
        moved += fabs(w[k]);
    }
    m[3] = t[r] + scale * (w[0] * at[0] + w[1] * at[1] + w[2] * at[2] + w[3]);
    for (size_t k = 0; k < 4; ++k)
        row[k] = (float)m[k];
    const double length = sqrt(squared);
    all->stretch = larger(length, all->stretch);
    all->reach = larger(fabs(m[3]) + length * side->tree->radius, all->reach);
    all->moved = larger(scale * (moved + fabs(w[3])), all->moved);
    all->finite += 0 * (m[0] + m[1] + m[2] + m[3]);
}

static void skin_begin(mote_cert_side *side)
{
    const mote_cert_tree *tree = side->tree;
    const mote_skin *skin = mote_skin_of(tree->body->field);
    const mote_weights *w = &side->state->weights;
    const double *const by[3] = {w->x, w->y, w->z};
    const mote_vec3 d = mote_sub(tree->origin, skin->origin);
    const double at[3] = {d.x / skin->unit, d.y / skin->unit, d.z / skin->unit};
    skin_frame *frame = side->frame;
    frame->along = (float(*)[4])(void *)frame->matrix[skin->bones];
    sizes all = {0, 0, 0, 0};
    for (size_t b = 0; b < skin->bones; ++b) {
        for (size_t r = 0; r < 3; ++r)
            make_row(side, skin, by[r] + 4 * b, at, r, frame->matrix[b][r], &all);
    }
    side->bound = all.reach + all.finite;
    side->noise = 0x1p-48 * side->bound;
    side->exact = 0x1p-48 * (skin->most + 4) * (side->world + all.moved + side->bound);
    side->margin_base = rounded_up(2 * tree->leak * all.stretch + side->exact);
    side->margin_unit = rounded_up(FLOAT_ROUNDING * side->bound);
    side->reach_margin = rounded_up(8 * FLOAT_ROUNDING * side->bound);
    side->leaf_margin = 32 * side->margin_unit;
    frame->hull_width =
        rounded_up((64 + skin->most) * FLOAT_ROUNDING * side->bound + side->exact);
}

static void skin_face(mote_cert_side *side)
{
    const mote_vec3 n = side->facing;
    const uint32_t bones = mote_skin_of(side->tree->body->field)->bones;
    skin_frame *frame = side->frame;
    for (uint32_t b = 0; b < bones; ++b) {
        float(*m)[4] = frame->matrix[b];
        for (size_t k = 0; k < 4; ++k)
            frame->along[b][k] =
                (float)((double)m[0][k] * n.x + (double)m[1][k] * n.y + (double)m[2][k] * n.z);
    }
}

static const mote_skin_head *head_of(const mote_cert_side *side, const mote_cert_block *block)
{
    return (const mote_skin_head *)(const void *)(side->tree->strips + block->first_strip);
}

/* One row of each bone's matrix, or all of it along a direction. */
typedef struct line {
    const float *first; /* four numbers of bone 0 */
    size_t stride;      /* to those of the next bone */
} line;

/* The image of a block's boxes along a line, without translation, by one bone: of centre and
 * axes. */
MOTE_INLINE void image(const mote_cert_block *restrict block, const float x, const float y,
                       const float z, size_t l, float at[4])
{
    at[0] = x * block->centre[0][l] + y * block->centre[1][l] + z * block->centre[2][l];
    for (size_t k = 0; k < 3; ++k)
        at[1 + k] =
            x * block->half[k][0][l] + y * block->half[k][1][l] + z * block->half[k][2][l];
}

/* --- above the leaves -----------------------------------------------------------------------
 */

/* The intervals along a line that hold the children: a middle and a half size. */
MOTE_INLINE void convex_along(const mote_cert_side *restrict side,
                              const mote_cert_block *restrict block, line to,
                              float middle[WIDTH], float half[WIDTH])
{
    const void *strips = side->tree->strips + block->first_strip + 1;
    const mote_skin_convex_row *rows = strips;
    const uint16_t *active = side->tree->active + block->first_active;
    float low[WIDTH], high[WIDTH];
    MOTE_LANE_LOOP
    for (size_t l = 0; l < WIDTH; ++l) {
        low[l] = 0x1p120F;
        high[l] = -0x1p120F;
    }
    for (size_t i = 0; i < block->active_count; ++i) {
        const mote_skin_convex_row *row = &rows[i];
        const float *m = to.first + to.stride * active[i];
        const float x = m[0], y = m[1], z = m[2], t = m[3];
        MOTE_LANE_LOOP
        for (size_t l = 0; l < WIDTH; ++l) {
            float p[4];
            image(block, x, y, z, l, p);
            const float at = (t + p[0]) + (p[1] * row->middle[0][l] + p[2] * row->middle[1][l] +
                                           p[3] * row->middle[2][l]);
            /* of a child that the bone does not move, an interval that no other one ends beyond
             */
            const float size = (fabsf(p[1]) * row->half[0][l] + fabsf(p[2]) * row->half[1][l] +
                                fabsf(p[3]) * row->half[2][l]) +
                               (row->present[l] - 1) * 0x1p110F;
            low[l] = low[l] < at - size ? low[l] : at - size;
            high[l] = high[l] > at + size ? high[l] : at + size;
        }
    }
    for (size_t l = block->children; l < WIDTH; ++l)
        low[l] = high[l] = 0;
    MOTE_LANE_LOOP
    for (size_t l = 0; l < WIDTH; ++l) {
        middle[l] = 0.5F * (low[l] + high[l]);
        half[l] = 0.5F * (high[l] - low[l]);
    }
}

static float convex_margin(const mote_cert_side *side)
{
    return side->margin_base + 128 * side->margin_unit;
}

MOTE_CLONES
static void skin_convex_boxes(const mote_cert_side *restrict side,
                              const mote_cert_block *restrict block,
                              mote_cert_node *restrict node)
{
    const float margin = convex_margin(side);
    memset(node->axis, 0, sizeof node->axis);
    for (size_t r = 0; r < 3; ++r) {
        const line row = {frame_of(side)->matrix[0][r], 12};
        convex_along(side, block, row, node->centre[r], node->axis[r][r]);
        MOTE_LANE_LOOP
        for (size_t l = 0; l < WIDTH; ++l)
            node->width[r][l] = margin;
    }
    mote_cert_finish_boxes(node);
}

MOTE_CLONES
static void skin_convex_project(const mote_cert_side *restrict side,
                                const mote_cert_block *restrict block,
                                mote_cert_node *restrict node)
{
    const float margin = convex_margin(side);
    const line along = {frame_of(side)->along[0], 4};
    memset(node->slant, 0, sizeof node->slant);
    convex_along(side, block, along, node->middle, node->slant[0]);
    MOTE_LANE_LOOP
    for (size_t l = 0; l < WIDTH; ++l)
        node->loose[l] = margin;
    node->leaf_margin = side->leaf_margin;
    mote_cert_finish_projection(side, block, node, false);
}

/* --- leaves ---------------------------------------------------------------------------------
 */

static float leaf_margin(const mote_cert_side *side, const mote_cert_block *block)
{
    const float more = 1 + 2 * head_of(side, block)->reach;
    const float bones = (float)(block->active_count - WIDTH);
    return side->margin_base + side->margin_unit * more * (64 + 2 * bones) * (1 + 0x1p-20F);
}

/* Middle, three axes and half width along a line. */
typedef struct fitted {
    float middle[WIDTH], axis[3][WIDTH], width[WIDTH];
} fitted;

MOTE_INLINE void leaf_along(const mote_cert_side *restrict side,
                            const mote_cert_block *restrict block, line to, float margin,
                            fitted *restrict out)
{
    const void *strips = side->tree->strips + block->first_strip + 1;
    const mote_skin_leaf_row *rows = strips;
    const uint16_t *reference = side->tree->active + block->first_active;
    const uint16_t *active = reference + WIDTH;
    const size_t count = block->active_count - WIDTH;
    _Alignas(32) float own[4][WIDTH];
    for (size_t l = 0; l < WIDTH; ++l) {
        const float *m = to.first + to.stride * reference[l];
        for (size_t k = 0; k < 4; ++k)
            own[k][l] = m[k];
    }
    float middle[WIDTH], a0[WIDTH], a1[WIDTH], a2[WIDTH], width[WIDTH];
    MOTE_LANE_LOOP
    for (size_t l = 0; l < WIDTH; ++l) {
        float p[4];
        image(block, own[0][l], own[1][l], own[2][l], l, p);
        middle[l] = own[3][l] + p[0];
        a0[l] = p[1];
        a1[l] = p[2];
        a2[l] = p[3];
        width[l] = margin;
    }
    for (size_t i = 0; i < count; ++i) {
        const mote_skin_leaf_row *row = &rows[i];
        const float *m = to.first + to.stride * active[i];
        const float x = m[0], y = m[1], z = m[2], t = m[3];
        MOTE_LANE_LOOP
        for (size_t l = 0; l < WIDTH; ++l) {
            float d[4];
            image(block, x - own[0][l], y - own[1][l], z - own[2][l], l, d);
            const float e = (t - own[3][l]) + d[0];
            const float f = row->offset[l];
            middle[l] += f * e + (row->shift[0][l] * d[1] + row->shift[1][l] * d[2] +
                                  row->shift[2][l] * d[3]);
            a0[l] += row->slope[0][l] * e + f * d[1];
            a1[l] += row->slope[1][l] * e + f * d[2];
            a2[l] += row->slope[2][l] * e + f * d[3];
            width[l] += row->rest[l] * fabsf(e) +
                        (row->spread[0][l] * fabsf(d[1]) + row->spread[1][l] * fabsf(d[2]) +
                         row->spread[2][l] * fabsf(d[3]));
        }
    }
    memcpy(out->middle, middle, sizeof middle);
    memcpy(out->axis[0], a0, sizeof a0);
    memcpy(out->axis[1], a1, sizeof a1);
    memcpy(out->axis[2], a2, sizeof a2);
    memcpy(out->width, width, sizeof width);
}

/* Bit l: leaf l is much wider than the margin and than its axes. */
MOTE_INLINE uint32_t wide_leaves(const mote_cert_node *restrict node, float margin)
{
    uint32_t bits = 0;
    MOTE_LANE_LOOP
    for (size_t l = 0; l < WIDTH; ++l) {
        float size = 0, loose = 0;
        for (size_t r = 0; r < 3; ++r) {
            loose += node->width[r][l] - margin;
            size += fabsf(node->axis[0][r][l]) + fabsf(node->axis[1][r][l]) +
                    fabsf(node->axis[2][r][l]);
        }
        bits |= loose > WIDE * size ? 1u << l : 0;
    }
    return bits;
}

MOTE_CLONES
static void skin_leaf_boxes(const mote_cert_side *restrict side,
                            const mote_cert_block *restrict block,
                            mote_cert_node *restrict node)
{
    const float margin = leaf_margin(side, block);
    for (size_t r = 0; r < 3; ++r) {
        const line row = {frame_of(side)->matrix[0][r], 12};
        fitted f;
        leaf_along(side, block, row, margin, &f);
        memcpy(node->centre[r], f.middle, sizeof f.middle);
        for (size_t k = 0; k < 3; ++k)
            memcpy(node->axis[k][r], f.axis[k], sizeof f.axis[k]);
        memcpy(node->width[r], f.width, sizeof f.width);
    }
    uint32_t leaves = 0;
    for (size_t l = 0; l < WIDTH; ++l)
        leaves |= block->child[l] < 0 ? 1u << l : 0;
    node->wide = wide_leaves(node, margin) & leaves & block->mask;
    mote_cert_finish_boxes(node);
}

MOTE_CLONES
static void skin_leaf_project(const mote_cert_side *restrict side,
                              const mote_cert_block *restrict block,
                              mote_cert_node *restrict node)
{
    const line along = {frame_of(side)->along[0], 4};
    fitted f;
    leaf_along(side, block, along, leaf_margin(side, block), &f);
    memcpy(node->middle, f.middle, sizeof f.middle);
    memcpy(node->slant, f.axis, sizeof f.axis);
    memcpy(node->loose, f.width, sizeof f.width);
    node->leaf_margin =
        side->leaf_margin * (1 + 2 * head_of(side, block)->reach) * (1 + 0x1p-20F);
    mote_cert_finish_projection(side, block, node, false);
}

static void skin_boxes(const mote_cert_side *side, const mote_cert_block *block,
                       mote_cert_node *node)
{
    if (head_of(side, block)->convex > 0)
        skin_convex_boxes(side, block, node);
    else
        skin_leaf_boxes(side, block, node);
}

static void skin_project(const mote_cert_side *side, const mote_cert_block *block,
                         mote_cert_node *node)
{
    if (head_of(side, block)->convex > 0)
        skin_convex_project(side, block, node);
    else
        skin_leaf_project(side, block, node);
}

/* A vertex in floats. */
static void place(const mote_cert_side *side, const mote_skin *skin, uint32_t vertex,
                  float p[3])
{
    const mote_vec3 x = mote_cert_tree_position(side->tree, vertex);
    const float q[3] = {(float)x.x, (float)x.y, (float)x.z};
    p[0] = p[1] = p[2] = 0;
    for (uint32_t i = skin->start[vertex]; i < skin->start[vertex + 1]; ++i) {
        const float *m = frame_of(side)->matrix[skin->bone[i]][0];
        for (size_t r = 0; r < 3; ++r)
            p[r] += skin->weight[i] * ((m[4 * r] * q[0] + m[4 * r + 1] * q[1]) +
                                       (m[4 * r + 2] * q[2] + m[4 * r + 3]));
    }
}

static bool skin_hull(const mote_cert_side *side, const mote_cert_node *node, size_t lane,
                      mote_cert_hull *hull)
{
    const mote_skin *skin = mote_skin_of(side->tree->body->field);
    const uint32_t count = hull->leaf->vertex_count;
    const uint32_t *vertices = side->tree->leaf_vertices + hull->leaf->first_vertex;
    (void)node, (void)lane;
    for (uint32_t i = 0; i < hull->groups * WIDTH; ++i) {
        float p[3];
        place(side, skin, vertices[i < count ? i : count - 1], p);
        for (size_t r = 0; r < 3; ++r)
            hull->x[r][i] = p[r];
    }
    for (size_t r = 0; r < 3; ++r)
        hull->width[r] = frame_of(side)->hull_width;
    return true;
}

const mote_cert_bounds mote_skin_bounds = {.name = "skin",
                                           .start = mote_skin_fit_start,
                                           .fit = mote_skin_fit,
                                           .store = mote_skin_fit_store,
                                           .stop = mote_skin_fit_stop,
                                           .frame_bytes = skin_frame_bytes,
                                           .begin = skin_begin,
                                           .face = skin_face,
                                           .project = skin_project,
                                           .boxes = skin_boxes,
                                           .hull = skin_hull};
