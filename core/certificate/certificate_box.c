#include "core/certificate/certificate_box.h"
#include "core/base/clones.h"

#include <float.h>

/* Positions of some vertices by coordinate, in the tree's units. The last group of MOTE_LANES
   is filled up with copies of the last vertex. */
typedef struct gathered {
    double x[3][MOTE_CERT_FIT_CHUNK];
    size_t count; /* a multiple of MOTE_LANES */
} gathered;

/* Gathers each stride-th of the first `count` vertices, 1 .. MOTE_CERT_FIT_CHUNK in all. */
static void gather(const mote_cert_tree *tree, const uint32_t *vertices, size_t count,
                   size_t stride, gathered *g)
{
    size_t k = 0;
    for (size_t i = 0; i < count; i += stride, ++k) {
        const mote_vec3 x = mote_cert_tree_position(tree, vertices[i]);
        g->x[0][k] = x.x;
        g->x[1][k] = x.y;
        g->x[2][k] = x.z;
    }
    for (; k % MOTE_LANES != 0; ++k) {
        for (int c = 0; c < 3; ++c)
            g->x[c][k] = g->x[c][k - 1];
    }
    g->count = k;
}

static size_t chunk_of(size_t left)
{
    return left < MOTE_CERT_FIT_CHUNK ? left : MOTE_CERT_FIT_CHUNK;
}

/* One Jacobi rotation that makes a[p][q] zero; v gathers the rotations. */
static void jacobi_rotate(double a[3][3], double v[3][3], int p, int q)
{
    if (!(fabs(a[p][q]) > 0))
        return;
    const double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
    const double t = (theta >= 0 ? 1 : -1) / (fabs(theta) + sqrt(theta * theta + 1));
    const double c = 1 / sqrt(t * t + 1);
    const double s = t * c;
    for (int k = 0; k < 3; ++k) {
        const double akp = a[k][p];
        const double akq = a[k][q];
        a[k][p] = c * akp - s * akq;
        a[k][q] = s * akp + c * akq;
    }
    for (int k = 0; k < 3; ++k) {
        const double apk = a[p][k];
        const double aqk = a[q][k];
        a[p][k] = c * apk - s * aqk;
        a[q][k] = s * apk + c * aqk;
        const double vkp = v[k][p];
        const double vkq = v[k][q];
        v[k][p] = c * vkp - s * vkq;
        v[k][q] = s * vkp + c * vkq;
    }
}

void mote_cert_principal_axes(double matrix[3][3], mote_vec3 axes[3])
{
    double v[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int sweep = 0; sweep < 12; ++sweep) {
        const double off = fabs(matrix[0][1]) + fabs(matrix[0][2]) + fabs(matrix[1][2]);
        if (off <= DBL_EPSILON * (matrix[0][0] + matrix[1][1] + matrix[2][2]))
            break;
        jacobi_rotate(matrix, v, 0, 1);
        jacobi_rotate(matrix, v, 0, 2);
        jacobi_rotate(matrix, v, 1, 2);
    }
    int order[3] = {0, 1, 2};
    for (int i = 1; i < 3; ++i) {
        for (int k = i;
             k > 0 && matrix[order[k]][order[k]] > matrix[order[k - 1]][order[k - 1]]; --k) {
            const int swap = order[k];
            order[k] = order[k - 1];
            order[k - 1] = swap;
        }
    }
    for (int i = 0; i < 3; ++i)
        axes[i] = mote_vec3_make(v[0][order[i]], v[1][order[i]], v[2][order[i]]);
}

/* The covariance matrix of the vertices' positions. */
static void spread(const mote_cert_tree *tree, const uint32_t *vertices, size_t count,
                   double matrix[3][3])
{
    const mote_vec3 base = mote_cert_tree_position(tree, vertices[0]);
    mote_vec3 mean = {0, 0, 0};
    double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
    for (size_t i = 0; i < count; ++i) {
        const mote_vec3 d = mote_sub(mote_cert_tree_position(tree, vertices[i]), base);
        mean = mote_add(mean, d);
        xx += d.x * d.x;
        xy += d.x * d.y;
        xz += d.x * d.z;
        yy += d.y * d.y;
        yz += d.y * d.z;
        zz += d.z * d.z;
    }
    const double n = 1 / (double)count;
    mean = mote_scale(mean, n);
    matrix[0][0] = xx * n - mean.x * mean.x;
    matrix[1][1] = yy * n - mean.y * mean.y;
    matrix[2][2] = zz * n - mean.z * mean.z;
    matrix[0][1] = matrix[1][0] = xy * n - mean.x * mean.y;
    matrix[0][2] = matrix[2][0] = xz * n - mean.x * mean.z;
    matrix[1][2] = matrix[2][1] = yz * n - mean.y * mean.z;
}

static inline void inverse_squares(const mote_cert_box *box, double inverse[3])
{
    for (int k = 0; k < 3; ++k)
        inverse[k] = 1 / mote_length_squared(box->half[k]);
}

void mote_cert_box_coordinates(const mote_cert_box *box, mote_vec3 x, double z[3])
{
    double inverse[3];
    inverse_squares(box, inverse);
    const mote_vec3 d = mote_sub(x, box->centre);
    for (int k = 0; k < 3; ++k) {
        const double value = mote_dot(d, box->half[k]) * inverse[k];
        z[k] = value < -1 ? -1 : value > 1 ? 1 : value;
    }
}

/* The same of the gathered vertices from `first` on, MOTE_LANES of them. */
MOTE_INLINE void box_coordinates(const mote_cert_box *box, const double inverse[3],
                                 const gathered *g, size_t first, double z[3][MOTE_LANES])
{
    const mote_vec3 c = box->centre;
    for (size_t k = 0; k < 3; ++k) {
        const mote_vec3 h = box->half[k];
        MOTE_LANE_LOOP
        for (size_t l = 0; l < MOTE_LANES; ++l) {
            const double value =
                ((g->x[0][first + l] - c.x) * h.x + (g->x[1][first + l] - c.y) * h.y +
                 (g->x[2][first + l] - c.z) * h.z) *
                inverse[k];
            const double above = value < -1 ? -1 : value;
            z[k][l] = above > 1 ? 1 : above;
        }
    }
}

MOTE_CLONES
static void all_coordinates(const mote_cert_box *box, const gathered *g,
                            double z[3][MOTE_CERT_FIT_CHUNK])
{
    double inverse[3];
    inverse_squares(box, inverse);
    for (size_t i = 0; i < g->count; i += MOTE_LANES) {
        double here[3][MOTE_LANES];
        box_coordinates(box, inverse, g, i, here);
        for (size_t k = 0; k < 3; ++k) {
            MOTE_LANE_LOOP
            for (size_t l = 0; l < MOTE_LANES; ++l)
                z[k][i + l] = here[k][l];
        }
    }
}

size_t mote_cert_box_sample(const mote_cert_tree *tree, const uint32_t *vertices, size_t count,
                            const mote_cert_box *box, size_t stride,
                            double z[3][MOTE_CERT_FIT_CHUNK])
{
    gathered g;
    gather(tree, vertices, count, stride, &g);
    all_coordinates(box, &g, z);
    return (count + stride - 1) / stride;
}

/* Raises the largest z_i + z_j, z_i - z_j, z_j - z_i and -z_i - z_j of each pair of axes. */
MOTE_CLONES
static void raise_sums(const mote_cert_box *box, const gathered *g,
                       double most[3][4][MOTE_LANES])
{
    static const int axes[3][2] = {{0, 1}, {0, 2}, {1, 2}};
    double inverse[3];
    inverse_squares(box, inverse);
    for (size_t i = 0; i < g->count; i += MOTE_LANES) {
        double z[3][MOTE_LANES];
        box_coordinates(box, inverse, g, i, z);
        for (size_t k = 0; k < 3; ++k) {
            const double *x = z[axes[k][0]];
            const double *y = z[axes[k][1]];
            MOTE_LANE_LOOP
            for (size_t l = 0; l < MOTE_LANES; ++l) {
                const double sums[4] = {x[l] + y[l], x[l] - y[l], y[l] - x[l], -x[l] - y[l]};
                for (size_t q = 0; q < 4; ++q)
                    most[k][q][l] = sums[q] > most[k][q][l] ? sums[q] : most[k][q][l];
            }
        }
    }
}

static double largest_lane(const double lane[MOTE_LANES])
{
    double most = lane[0];
    for (size_t l = 1; l < MOTE_LANES; ++l)
        most = lane[l] > most ? lane[l] : most;
    return most;
}

void mote_cert_cut_corners(const mote_cert_tree *tree, const uint32_t *vertices, size_t count,
                           const mote_cert_box *box, int32_t cut[3])
{
    double most[3][4][MOTE_LANES];
    for (size_t i = 0; i < 12 * (size_t)MOTE_LANES; ++i)
        most[i / (4 * MOTE_LANES)][i / MOTE_LANES % 4][i % MOTE_LANES] = -2;
    for (size_t i = 0; i < count; i += MOTE_CERT_FIT_CHUNK) {
        gathered g;
        gather(tree, vertices + i, chunk_of(count - i), 1, &g);
        raise_sums(box, &g, most);
    }
    for (int k = 0; k < 3; ++k) {
        uint32_t word = 0;
        for (int q = 0; q < 4; ++q) {
            const double empty = 2 - largest_lane(most[k][q]);
            /* slightly less, so that float rounding cannot make it too large when used */
            const double whole = floor((empty < 1 ? empty : 1) * 255 - 0.01);
            word |= (whole > 0 ? (uint32_t)whole : 0) << (8 * q);
        }
        cut[k] = (int32_t)word;
    }
}

/* Raises the largest squared distance of a vertex from where its coordinates place it. */
MOTE_CLONES
static void raise_leak(const mote_cert_box *box, const gathered *g, double worst[MOTE_LANES])
{
    double inverse[3];
    inverse_squares(box, inverse);
    const mote_vec3 c = box->centre;
    const mote_vec3 *h = box->half;
    for (size_t i = 0; i < g->count; i += MOTE_LANES) {
        double z[3][MOTE_LANES];
        box_coordinates(box, inverse, g, i, z);
        MOTE_LANE_LOOP
        for (size_t l = 0; l < MOTE_LANES; ++l) {
            const double a = z[0][l];
            const double b = z[1][l];
            const double d = z[2][l];
            const double x = (((c.x + a * h[0].x) + b * h[1].x) + d * h[2].x) - g->x[0][i + l];
            const double y = (((c.y + a * h[0].y) + b * h[1].y) + d * h[2].y) - g->x[1][i + l];
            const double w = (((c.z + a * h[0].z) + b * h[1].z) + d * h[2].z) - g->x[2][i + l];
            const double out = x * x + y * y + w * w;
            worst[l] = out > worst[l] ? out : worst[l];
        }
    }
}

/* How far vertices stick out of the box since its centre and axes were rounded: measured, not
   estimated. */
static void measure_leak(mote_cert_tree *tree, const uint32_t *vertices, size_t count,
                         const mote_cert_box *box)
{
    double worst[MOTE_LANES] = {0};
    for (size_t i = 0; i < count; i += MOTE_CERT_FIT_CHUNK) {
        gathered g;
        gather(tree, vertices + i, chunk_of(count - i), 1, &g);
        raise_leak(box, &g, worst);
    }
    const double most = sqrt(largest_lane(worst));
    tree->leak = most > tree->leak ? most : tree->leak;
}

/* The ends of the gathered vertices along some directions. */
typedef struct ends {
    double low[3][MOTE_LANES], high[3][MOTE_LANES];
} ends;

static ends no_ends(void)
{
    ends e;
    for (size_t l = 0; l < MOTE_LANES; ++l) {
        for (size_t k = 0; k < 3; ++k) {
            e.low[k][l] = DBL_MAX;
            e.high[k][l] = -DBL_MAX;
        }
    }
    return e;
}

MOTE_CLONES
static void widen_ends(const gathered *g, const mote_vec3 *axes, size_t count, ends *e)
{
    for (size_t i = 0; i < g->count; i += MOTE_LANES) {
        for (size_t k = 0; k < count; ++k) {
            const mote_vec3 u = axes[k];
            MOTE_LANE_LOOP
            for (size_t l = 0; l < MOTE_LANES; ++l) {
                const double p =
                    g->x[0][i + l] * u.x + g->x[1][i + l] * u.y + g->x[2][i + l] * u.z;
                e->low[k][l] = p < e->low[k][l] ? p : e->low[k][l];
                e->high[k][l] = p > e->high[k][l] ? p : e->high[k][l];
            }
        }
    }
}

static double low_of(const ends *e, size_t k)
{
    double least = e->low[k][0];
    for (size_t l = 1; l < MOTE_LANES; ++l)
        least = e->low[k][l] < least ? e->low[k][l] : least;
    return least;
}

/* The area of the rectangle along u and v around the gathered vertices. */
static double area_along(const gathered *g, mote_vec3 u, mote_vec3 v)
{
    const mote_vec3 axes[2] = {u, v};
    ends e = no_ends();
    widen_ends(g, axes, 2, &e);
    return (largest_lane(e.high[0]) - low_of(&e, 0)) *
           (largest_lane(e.high[1]) - low_of(&e, 1));
}

/* Turns the two main axes about the third so that the box is smallest: where a patch is about
   as wide as it is long, its main axes point anywhere. */
static void turn_axes(const mote_cert_tree *tree, const uint32_t *vertices, size_t count,
                      mote_vec3 axes[3])
{
    /* cosine and sine of 9, 18 ... 81 degrees: written out, for the same bits everywhere */
    static const double turns[9][2] = {
        {0.98768834059513777, 0.15643446504023087}, {0.95105651629515353, 0.3090169943749474},
        {0.89100652418836779, 0.45399049973954675}, {0.80901699437494745, 0.58778525229247314},
        {0.70710678118654757, 0.70710678118654757}, {0.58778525229247314, 0.80901699437494745},
        {0.45399049973954675, 0.89100652418836779}, {0.3090169943749474, 0.95105651629515353},
        {0.15643446504023087, 0.98768834059513777}};
    const mote_vec3 a = axes[0];
    const mote_vec3 b = axes[1];
    gathered g;
    gather(tree, vertices, count, mote_cert_sample_stride(count), &g);
    double least = area_along(&g, a, b);
    for (int i = 0; i < 9; ++i) {
        const mote_vec3 u = mote_add_scaled(mote_scale(a, turns[i][0]), turns[i][1], b);
        const mote_vec3 v = mote_add_scaled(mote_scale(b, turns[i][0]), -turns[i][1], a);
        const double area = area_along(&g, u, v);
        if (area < 0.98 * least) {
            least = area;
            axes[0] = u;
            axes[1] = v;
        }
    }
}

mote_cert_box mote_cert_box_of(mote_cert_tree *tree, const uint32_t *vertices, size_t count)
{
    double matrix[3][3];
    mote_vec3 axes[3];
    spread(tree, vertices, count, matrix);
    mote_cert_principal_axes(matrix, axes);
    turn_axes(tree, vertices, count, axes);
    ends e = no_ends();
    for (size_t i = 0; i < count; i += MOTE_CERT_FIT_CHUNK) {
        gathered g;
        gather(tree, vertices + i, chunk_of(count - i), 1, &g);
        widen_ends(&g, axes, 3, &e);
    }
    double low[3], high[3];
    for (size_t k = 0; k < 3; ++k) {
        low[k] = low_of(&e, k);
        high[k] = largest_lane(e.high[k]);
    }
    int order[3] = {0, 1, 2};
    for (int i = 1; i < 3; ++i) {
        for (int k = i;
             k > 0 && high[order[k]] - low[order[k]] > high[order[k - 1]] - low[order[k - 1]];
             --k) {
            const int swap = order[k];
            order[k] = order[k - 1];
            order[k - 1] = swap;
        }
    }
    mote_cert_box box = {.centre = {0, 0, 0}};
    double radius = 0;
    for (int i = 0; i < 3; ++i) {
        const int k = order[i];
        const double pad = 0x1p-23; /* so that no axis is 0 and little sticks out */
        const double length = 0.5 * (high[k] - low[k]) + pad;
        box.centre = mote_add_scaled(box.centre, 0.5 * (high[k] + low[k]), axes[k]);
        box.half[i] = mote_as_floats(mote_scale(axes[k], length));
        radius += length;
    }
    box.centre = mote_as_floats(box.centre);
    radius += mote_length(box.centre);
    radius *= 1 + 0x1p-20;
    tree->radius = radius > tree->radius ? radius : tree->radius;
    measure_leak(tree, vertices, count, &box);
    return box;
}

void mote_cert_factor(double a[4][4])
{
    for (int i = 0; i < 4; ++i) {
        for (int j = 0; j <= i; ++j) {
            double s = a[i][j];
            for (int k = 0; k < j; ++k)
                s -= a[i][k] * a[j][k];
            a[i][j] = i == j ? sqrt(s) : s / a[j][j];
        }
    }
}

void mote_cert_solve(const double a[4][4], double b[4])
{
    for (int i = 0; i < 4; ++i) {
        for (int k = 0; k < i; ++k)
            b[i] -= a[i][k] * b[k];
        b[i] /= a[i][i];
    }
    for (int i = 3; i >= 0; --i) {
        for (int k = i + 1; k < 4; ++k)
            b[i] -= a[k][i] * b[k];
        b[i] /= a[i][i];
    }
}
