/* Bounds of any field, in a query: fits of its basis functions (certificate_fitted.h), deformed
   on demand.

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
#include "core/certificate/certificate_fitted.h"
#include "core/certificate/certificate_project.h"

#include <float.h>

#define WIDTH MOTE_CERT_WIDTH
#define FLOAT_ROUNDING 0x1p-24

typedef mote_cert_row row;

/* The weights of a frame, in the tree's units: seven arrays, each as long as the field is
   padded. The first is of weights along facing, for functions in the tree's scale; then come x,
   y and z of these weights, and the same for the functions as they are. */
typedef struct fitted_frame {
    float single_sum[3];
    uint32_t padded;
    float along[];
} fitted_frame;

#define ARRAYS 7

static inline float *weights_of(const fitted_frame *frame, size_t coordinate)
{
    return (float *)(uintptr_t)(frame->along + (1 + coordinate) * frame->padded);
}

static inline float *singles_of(const fitted_frame *frame, size_t coordinate)
{
    return weights_of(frame, 3 + coordinate);
}

static const fitted_frame *frame_of(const mote_cert_side *side)
{
    return side->frame;
}

static const row *rows_of(const mote_cert_tree *tree, const mote_cert_block *block)
{
    return (const row *)(const void *)(tree->strips + block->first_strip);
}

static float rounded_up(double x)
{
    return (float)(x * (1 + 0x1p-22));
}

static size_t fitted_frame_bytes(const mote_cert_tree *tree)
{
    return sizeof(fitted_frame) + (size_t)ARRAYS * tree->body->field->padded * sizeof(float);
}

/* Bounds and margins of the frame; field: a bound of what the field adds to any box. */
static void set_margins(mote_cert_side *side, mote_vec3 field)
{
    const mote_cert_tree *tree = side->tree;
    const uint32_t functions = tree->body->field->most;
    /* A function that reaches no box has its say here alone, also where its weight is NaN. */
    const double finite = 0 * field.x + 0 * field.y + 0 * field.z;
    side->bound = mote_largest_coordinate(side->exact_translation) + tree->radius +
                  mote_largest_coordinate(field) + finite;
    side->noise = 0x1p-48 * side->bound * (functions > 256 ? functions / 256.0 : 1);
    side->exact = 0x1p-50 * (functions + 4) * (side->world + side->bound);
    side->margin_unit = rounded_up(2 * FLOAT_ROUNDING * side->bound);
    side->margin_base =
        rounded_up(40 * FLOAT_ROUNDING * side->bound + tree->leak + side->exact);
    side->reach_margin = rounded_up(4 * FLOAT_ROUNDING * side->bound);
    side->leaf_margin = rounded_up(32 * FLOAT_ROUNDING * side->bound);
}

/* What the weights of one coordinate add up to: of their sizes for the functions as they are,
   and of the field's bounds. */
typedef struct amounts {
    double sum, field;
} amounts;

/* Converts the weights of one coordinate. The sums are in ascending order. */
MOTE_INLINE amounts convert(const double *restrict weights, const mote_cert_scales *scales,
                            uint32_t padded, float *restrict weight, float *restrict single)
{
    amounts all = {0, 0};
    for (uint32_t j = 0; j < padded; j += MOTE_LANES) {
        double sum[MOTE_LANES], field[MOTE_LANES];
        MOTE_LANE_LOOP
        for (size_t l = 0; l < MOTE_LANES; ++l) {
            const double w = weights[j + l] * scales->unit[j + l];
            const double own = w * scales->scale[j + l];
            weight[j + l] = (float)w;
            single[j + l] = (float)own;
            sum[l] = fabs(own);
            field[l] = fabs(w) * scales->bound[j + l];
        }
        for (size_t l = 0; l < MOTE_LANES; ++l) {
            all.sum += sum[l];
            all.field += field[l];
        }
    }
    return all;
}

MOTE_CLONES
static void convert_all(const mote_weights *w, const mote_cert_scales *scales,
                        fitted_frame *frame, amounts all[3])
{
    const uint32_t n = frame->padded;
    all[0] = convert(w->x, scales, n, weights_of(frame, 0), singles_of(frame, 0));
    all[1] = convert(w->y, scales, n, weights_of(frame, 1), singles_of(frame, 1));
    all[2] = convert(w->z, scales, n, weights_of(frame, 2), singles_of(frame, 2));
}

static void fitted_begin(mote_cert_side *side)
{
    const mote_cert_tree *tree = side->tree;
    fitted_frame *frame = side->frame;
    amounts all[3] = {{0, 0}, {0, 0}, {0, 0}};
    frame->padded = tree->body->field->padded;
    if (frame->padded > 0) {
        const mote_cert_scales scales = mote_cert_scales_of(tree);
        convert_all(&side->state->weights, &scales, frame, all);
    }
    set_margins(side, mote_vec3_make(all[0].field, all[1].field, all[2].field));
    for (size_t c = 0; c < 3; ++c)
        frame->single_sum[c] = rounded_up(all[c].sum);
}

MOTE_CLONES
static void project_weights(const mote_weights *w, const double *restrict unit, mote_vec3 n,
                            uint32_t padded, float *restrict along)
{
    for (uint32_t j = 0; j < padded; j += MOTE_LANES) {
        MOTE_LANE_LOOP
        for (size_t l = 0; l < MOTE_LANES; ++l) {
            const double push = w->x[j + l] * n.x + w->y[j + l] * n.y + w->z[j + l] * n.z;
            along[j + l] = (float)(unit[j + l] * push);
        }
    }
}

static void fitted_face(mote_cert_side *side)
{
    fitted_frame *frame = side->frame;
    if (frame->padded > 0)
        project_weights(&side->state->weights, mote_cert_scales_of(side->tree).unit,
                        side->facing, frame->padded, frame->along);
}

/* Coordinates of a block's boxes towards the other body. */
MOTE_CLONES
static void project_block(const mote_cert_side *restrict side,
                          const mote_cert_block *restrict block, mote_cert_node *restrict node)
{
    const row *rows = rows_of(side->tree, block);
    const uint16_t *active = side->tree->active + block->first_active;
    const float x = side->facing_f[0];
    const float y = side->facing_f[1];
    const float z = side->facing_f[2];
    const float *along = frame_of(side)->along;
    float middle[WIDTH] = {0};
    float axis0[WIDTH] = {0};
    float axis1[WIDTH] = {0};
    float axis2[WIDTH] = {0};
    float width[WIDTH] = {0};
    for (size_t i = 0; i < block->active_count; ++i) {
        const row *r = &rows[i];
        const float w = along[active[i]];
        const float size = fabsf(w);
        MOTE_LANE_LOOP
        for (size_t l = 0; l < WIDTH; ++l) {
            middle[l] += r->offset[l] * w;
            axis0[l] += mote_cert_upper(r->slopes[l]) * w;
            axis1[l] += mote_cert_lower(r->slopes[l]) * w;
            axis2[l] += mote_cert_lower(r->rest[l]) * w;
            width[l] += mote_cert_upper(r->rest[l]) * size;
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
        const float axes[3] = {axis0[l], axis1[l], axis2[l]};
        mote_cert_project_lane(block, node, l, middle[l], axes, width[l] + margin);
    }
    node->leaf_margin = side->leaf_margin;
    mote_cert_finish_projection(side, block, node, true);
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
    const row *rows = rows_of(side->tree, block);
    const uint16_t *active = side->tree->active + block->first_active;
    const fitted_frame *frame = frame_of(side);
    const float *const weight[3] = {weights_of(frame, 0), weights_of(frame, 1),
                                    weights_of(frame, 2)};
    float cx[WIDTH] = {0}, cy[WIDTH] = {0}, cz[WIDTH] = {0};
    float ax[WIDTH] = {0}, ay[WIDTH] = {0}, az[WIDTH] = {0};
    float bx[WIDTH] = {0}, by[WIDTH] = {0}, bz[WIDTH] = {0};
    float dx[WIDTH] = {0}, dy[WIDTH] = {0}, dz[WIDTH] = {0};
    float ex[WIDTH] = {0}, ey[WIDTH] = {0}, ez[WIDTH] = {0};
    for (size_t i = 0; i < block->active_count; ++i) {
        const row *r = &rows[i];
        const float x = weight[0][active[i]];
        const float y = weight[1][active[i]];
        const float z = weight[2][active[i]];
        const float sx = fabsf(x);
        const float sy = fabsf(y);
        const float sz = fabsf(z);
        MOTE_LANE_LOOP
        for (size_t l = 0; l < WIDTH; ++l) {
            const float f = r->offset[l];
            const float g0 = mote_cert_upper(r->slopes[l]);
            const float g1 = mote_cert_lower(r->slopes[l]);
            const float g2 = mote_cert_lower(r->rest[l]);
            const float m = mote_cert_upper(r->rest[l]);
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

MOTE_CLONES
static void deform_block(const mote_cert_side *restrict side,
                         const mote_cert_block *restrict block, mote_cert_node *restrict node)
{
    move(side, block, node);
    add_field(side, block, node);
    mote_cert_finish_boxes(node);
}

/* Rest positions of MOTE_LANES vertices of a leaf from place `first` on, filled up with copies
   of the last, in the tree's units. */
static void load_group(const mote_cert_tree *tree, const mote_cert_leaf *leaf, uint32_t first,
                       uint32_t v[MOTE_LANES], float p[3][MOTE_LANES])
{
    const uint32_t *vertices = tree->leaf_vertices + leaf->first_vertex;
    for (uint32_t i = 0; i < MOTE_LANES; ++i) {
        const uint32_t k = first + i;
        v[i] = vertices[k < leaf->vertex_count ? k : leaf->vertex_count - 1u];
        const mote_vec3 x = mote_cert_tree_position(tree, v[i]);
        p[0][i] = (float)x.x;
        p[1][i] = (float)x.y;
        p[2][i] = (float)x.z;
    }
}

/* Moves a group rigidly and adds its displacements. */
MOTE_CLONES
static void move_group(const mote_cert_side *restrict side, float p[3][MOTE_LANES],
                       float moved[3][MOTE_LANES], uint32_t first,
                       mote_cert_hull *restrict hull)
{
    for (size_t r = 0; r < 3; ++r) {
        const float a = side->rotation[r][0];
        const float b = side->rotation[r][1];
        const float c = side->rotation[r][2];
        const float t = side->translation[r];
        MOTE_LANE_LOOP
        for (size_t l = 0; l < MOTE_LANES; ++l)
            hull->x[r][first + l] =
                (t + (a * p[0][l] + b * p[1][l] + c * p[2][l])) + moved[r][l];
    }
}

/* Whether the weights of functions as they are can be floats: those of tiny functions may be
   too large. */
static bool has_singles(const fitted_frame *frame)
{
    return frame->single_sum[0] + frame->single_sum[1] + frame->single_sum[2] <= FLT_MAX;
}

static bool fitted_hull(const mote_cert_side *side, const mote_cert_node *node, size_t lane,
                        mote_cert_hull *hull)
{
    const mote_cert_tree *tree = side->tree;
    const mote_body *body = tree->body;
    const mote_cert_block *block = node->block;
    const mote_cert_leaf *leaf = hull->leaf;
    const fitted_frame *frame = frame_of(side);
    const float *const single[3] = {singles_of(frame, 0), singles_of(frame, 1),
                                    singles_of(frame, 2)};
    (void)lane;
    if (body->field->count > 0 && !(body->field->kind->estimate && has_singles(frame)))
        return false;
    float factor = 0;
    for (uint32_t first = 0; first < leaf->vertex_count; first += MOTE_LANES) {
        uint32_t v[MOTE_LANES];
        float p[3][MOTE_LANES], moved[3][MOTE_LANES] = {{0}};
        load_group(tree, leaf, first, v, p);
        if (block->active_count > 0) {
            const float f = body->field->kind->estimate(body->field, body->mesh, v,
                                                        tree->active + block->first_active,
                                                        block->active_count, single, moved);
            factor = f > factor ? f : factor;
        }
        move_group(side, p, moved, first, hull);
    }
    for (size_t r = 0; r < 3; ++r)
        hull->width[r] = node->leaf_margin + rounded_up(side->exact) +
                         (factor + 0x1p-22F) * frame->single_sum[r];
    return true;
}

const mote_cert_bounds mote_cert_fitted = {.name = "fitted",
                                           .start = mote_cert_fitted_start,
                                           .fit = mote_cert_fitted_fit,
                                           .store = mote_cert_fitted_store,
                                           .stop = mote_cert_fitted_stop,
                                           .frame_bytes = fitted_frame_bytes,
                                           .begin = fitted_begin,
                                           .face = fitted_face,
                                           .project = project_block,
                                           .boxes = deform_block,
                                           .hull = fitted_hull};
