/* Converting the weights of a frame, and what the margins are made of.

   With R the rotation of the pose, t the translation and W_b the weight vectors of bone b, the
   rows of M_b are R + W_b / s and t + W_b's last. All bones together are bounded by the longest
   of their first columns, of their second and of their third: |A_b v| <= stretch |v| with the
   root of the sum of the three squares. Such lengths are found lane by lane, where rows would
   have to be added up across lanes.

   Let u = 2^-24, and let S (side->bound) bound, for each bone and each coordinate r,
       |M_b[r][3]| + |row r of M_b| (|c| + sum_k |h_k| + sum_j |m_j| bound_j)
   of any box: by Cauchy's inequality, all terms of a coordinate of M_b p0 together, for any
   point p0 of a box that targets have moved. Along a direction they add up to sqrt(3) S.

   - Rest vertices stick out of boxes by tree->leak, which the bones make at most stretch leak
   along any direction.
   - Positions in double precision are sums of a target's terms and of 4 terms a bone. The
   vertex is at most s + D from the skin's origin before the bones move it, D being the sum of
   |m_j| bound_j, so that with n the most bones and targets of a vertex and
       V = 2 (stretch + 3) (s + D) + |t| + |M_b's translation|
   each is wrong by at most 2^-53 (4 n + 16) (world + V + S), `world` being the size of the
   pose's coordinates; 2^-48 (n + 4) is more, and covers the rounding of the matrices' entries
   in double precision too.
   - Hulls: matrices are blended with weights that are exact and add up to 1. A vertex in
   floats, n targets and a matrix's entries, four products and their sums are wrong by (n + 11)
   u S, the sum over n bones by (n + 1) u S, and what follows is rounded as in
   certificate_leaf.c: less than (64 + n) u S with n the bones and the targets together. */
#include "core/skin/skin_frame.h"
#include "core/base/clones.h"
#include "core/skin/skin_data.h"

#include <string.h>

#define FLOAT_ROUNDING 0x1p-24

static float rounded_up(double x)
{
    return (float)(x * (1 + 0x1p-22));
}

/* Numbers of all bones in a row, rounded up to whole lanes. */
static size_t row_length(const mote_skin *skin)
{
    return ((size_t)4 * skin->bones + MOTE_LANES - 1) / MOTE_LANES * MOTE_LANES;
}

size_t mote_skin_frame_bytes(const mote_cert_tree *tree)
{
    const mote_skin *skin = mote_skin_of(tree->body->field);
    return sizeof(mote_skin_frame) +
           (4 * row_length(skin) + (size_t)MOTE_SKIN_COLUMNS * skin->bones +
            skin->morph.targets) *
               sizeof(float);
}

static mote_skin_frame *lay_out(mote_cert_side *side, const mote_skin *skin)
{
    const size_t length = row_length(skin);
    mote_skin_frame *frame = side->frame;
    for (size_t r = 0; r < 3; ++r)
        frame->row[r] = frame->numbers + r * length;
    frame->along = frame->numbers + 3 * length;
    frame->column = frame->numbers + 4 * length;
    frame->amount = frame->column + (size_t)MOTE_SKIN_COLUMNS * skin->bones;
    frame->has_columns = false;
    return frame;
}

/* What makes rows of weights: a row is base + weights * factor, for two bones side by side. */
typedef struct conversion {
    double base[3][MOTE_LANES], factor[MOTE_LANES];
} conversion;

/* By lane: the largest square of a column's length, of the three columns and of the translation
   of either bone, and 0, or a NaN where any number is not finite. */
typedef struct sizes {
    double squared[MOTE_LANES], finite[MOTE_LANES];
} sizes;

MOTE_INLINE void convert_lanes(const double *restrict x, const double *restrict y,
                               const double *restrict z, const conversion *restrict by,
                               size_t j, mote_skin_frame *restrict frame, sizes *restrict all)
{
    MOTE_LANE_LOOP
    for (size_t l = 0; l < MOTE_LANES; ++l) {
        const double a = by->base[0][l] + x[l] * by->factor[l];
        const double b = by->base[1][l] + y[l] * by->factor[l];
        const double c = by->base[2][l] + z[l] * by->factor[l];
        const double squared = (a * a + b * b) + c * c;
        frame->row[0][j + l] = (float)a;
        frame->row[1][j + l] = (float)b;
        frame->row[2][j + l] = (float)c;
        all->squared[l] = squared > all->squared[l] ? squared : all->squared[l];
        all->finite[l] += 0 * squared;
    }
}

MOTE_CLONES
static void convert(const mote_weights *weights, size_t bones, const conversion *by,
                    mote_skin_frame *frame, sizes *all)
{
    size_t j = 0;
    sizes own = *all;
    for (; j + MOTE_LANES <= 4 * bones; j += MOTE_LANES)
        convert_lanes(weights->x + j, weights->y + j, weights->z + j, by, j, frame, &own);
    if (j < 4 * bones) { /* what follows may be other weights */
        double last[3][MOTE_LANES] = {{0}};
        memcpy(last[0], weights->x + j, 4 * sizeof(double));
        memcpy(last[1], weights->y + j, 4 * sizeof(double));
        memcpy(last[2], weights->z + j, 4 * sizeof(double));
        convert_lanes(last[0], last[1], last[2], by, j, frame, &own);
    }
    *all = own;
}

static conversion conversion_of(const mote_cert_side *side, const mote_skin *skin)
{
    const double t[3] = {side->exact_translation.x, side->exact_translation.y,
                         side->exact_translation.z};
    conversion by;
    for (size_t l = 0; l < MOTE_LANES; ++l) {
        const size_t k = l % 4;
        by.factor[l] = k < 3 ? 1 / skin->unit : side->tree->scale;
        for (size_t r = 0; r < 3; ++r)
            by.base[r][l] = k < 3 ? side->state->pose.rotation.m[r][k] : t[r];
    }
    return by;
}

/* Converts the amounts of morph targets, and returns D; a NaN where one is not finite. */
static double convert_amounts(const mote_cert_side *side, const mote_skin *skin,
                              mote_skin_frame *frame)
{
    const mote_skin_morph_bound *bounds = side->tree->fixed;
    const double *amount = side->state->weights.x + mote_morph_first(skin);
    double sum = 0;
    for (uint32_t k = 0; k < skin->morph.targets; ++k) {
        const double m = amount[k] * side->tree->scale;
        frame->amount[k] = (float)m;
        sum += fabs(m) * bounds[k] + 0 * m;
    }
    return sum * (1 + 0x1p-20); /* amounts are rounded */
}

static double larger(double a, double b)
{
    return a > b ? a : b;
}

void mote_skin_begin(mote_cert_side *side)
{
    const mote_cert_tree *tree = side->tree;
    const mote_skin *skin = mote_skin_of(tree->body->field);
    mote_skin_frame *frame = lay_out(side, skin);
    const conversion by = conversion_of(side, skin);
    sizes all = {{0}, {0}};
    convert(&side->state->weights, skin->bones, &by, frame, &all);
    double squared[4], finite = 0;
    for (size_t k = 0; k < 4; ++k) {
        squared[k] = larger(all.squared[k], all.squared[k + 4]);
        finite += all.finite[k] + all.finite[k + 4];
    }
    const double stretch = sqrt(squared[0] + squared[1] + squared[2]);
    const double shift = sqrt(squared[3]);
    const double morphed = convert_amounts(side, skin, frame);
    const mote_vec3 t = side->exact_translation;
    const double moved = 2 * (stretch + 3) * (skin->unit * tree->scale + morphed) +
                         (fabs(t.x) + fabs(t.y) + fabs(t.z)) + shift;
    const double most = skin->most + (double)skin->morph.most;
    side->bound = shift + stretch * (tree->radius + morphed) + finite;
    side->noise = 0x1p-48 * side->bound;
    side->exact = 0x1p-48 * (most + 4) * (side->world + moved + side->bound);
    side->margin_base = rounded_up(2 * tree->leak * stretch + side->exact);
    side->margin_unit = rounded_up(FLOAT_ROUNDING * side->bound);
    side->reach_margin = rounded_up(8 * FLOAT_ROUNDING * side->bound);
    side->leaf_margin = 32 * side->margin_unit;
    frame->hull_width = rounded_up((64 + most) * FLOAT_ROUNDING * side->bound + side->exact);
}

MOTE_CLONES
static void face_rows(mote_skin_frame *restrict frame, size_t length, double x, double y,
                      double z)
{
    const float *restrict a = frame->row[0];
    const float *restrict b = frame->row[1];
    const float *restrict c = frame->row[2];
    float *restrict along = frame->along;
    for (size_t j = 0; j < length; j += MOTE_LANES) {
        MOTE_LANE_LOOP
        for (size_t l = 0; l < MOTE_LANES; ++l)
            along[j + l] =
                (float)((double)a[j + l] * x + (double)b[j + l] * y + (double)c[j + l] * z);
    }
}

void mote_skin_face(mote_cert_side *side)
{
    const mote_vec3 n = side->facing;
    face_rows(side->frame, row_length(mote_skin_of(side->tree->body->field)), n.x, n.y, n.z);
}

const float *mote_skin_frame_columns(const mote_cert_side *side)
{
    mote_skin_frame *frame = side->frame;
    if (frame->has_columns)
        return frame->column;
    const size_t bones = mote_skin_of(side->tree->body->field)->bones;
    for (size_t b = 0; b < bones; ++b) {
        float *column = frame->column + MOTE_SKIN_COLUMNS * b;
        for (size_t k = 0; k < 4; ++k) {
            for (size_t r = 0; r < 3; ++r)
                column[4 * k + r] = frame->row[r][4 * b + k];
            column[4 * k + 3] = 0;
        }
    }
    frame->has_columns = true;
    return frame->column;
}
