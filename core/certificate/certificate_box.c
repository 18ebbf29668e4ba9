#include "core/certificate/certificate_box.h"

#include <float.h>

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

/* z of a vertex, held within the box. */
static inline void box_coordinates(const mote_cert_box *box, const double inverse[3],
                                   mote_vec3 x, double z[3])
{
    const mote_vec3 d = mote_sub(x, box->centre);
    for (int k = 0; k < 3; ++k) {
        const double value = mote_dot(d, box->half[k]) * inverse[k];
        z[k] = value < -1 ? -1 : value > 1 ? 1 : value;
    }
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
    box_coordinates(box, inverse, x, z);
}

void mote_cert_cut_corners(const mote_cert_tree *tree, const uint32_t *vertices, size_t count,
                           const mote_cert_box *box, int32_t cut[3])
{
    static const int axes[3][2] = {{0, 1}, {0, 2}, {1, 2}};
    double inverse[3];
    double most[3][4];
    inverse_squares(box, inverse);
    for (int k = 0; k < 12; ++k)
        most[k / 4][k % 4] = -2;
    for (size_t i = 0; i < count; ++i) {
        double z[3];
        box_coordinates(box, inverse, mote_cert_tree_position(tree, vertices[i]), z);
        for (int k = 0; k < 3; ++k) {
            const double a = z[axes[k][0]];
            const double b = z[axes[k][1]];
            const double sums[4] = {a + b, a - b, b - a, -a - b};
            for (int q = 0; q < 4; ++q)
                most[k][q] = sums[q] > most[k][q] ? sums[q] : most[k][q];
        }
    }
    for (int k = 0; k < 3; ++k) {
        uint32_t word = 0;
        for (int q = 0; q < 4; ++q) {
            const double empty = 2 - most[k][q];
            /* slightly less, so that float rounding cannot make it too large when used */
            const double whole = floor((empty < 1 ? empty : 1) * 255 - 0.01);
            word |= (whole > 0 ? (uint32_t)whole : 0) << (8 * q);
        }
        cut[k] = (int32_t)word;
    }
}

/* How far vertices stick out of the box since its centre and axes were rounded: measured, not
   estimated. */
static void measure_leak(mote_cert_tree *tree, const uint32_t *vertices, size_t count,
                         const mote_cert_box *box)
{
    double inverse[3];
    inverse_squares(box, inverse);
    double worst = 0;
    for (size_t i = 0; i < count; ++i) {
        const mote_vec3 x = mote_cert_tree_position(tree, vertices[i]);
        double z[3];
        box_coordinates(box, inverse, x, z);
        mote_vec3 inside = box->centre;
        for (int k = 0; k < 3; ++k)
            inside = mote_add_scaled(inside, z[k], box->half[k]);
        const double out = mote_distance_squared(inside, x);
        worst = out > worst ? out : worst;
    }
    worst = sqrt(worst);
    tree->leak = worst > tree->leak ? worst : tree->leak;
}

/* The area of the rectangle along u and v around the vertices, or around a sample of them. */
static double area_along(const mote_cert_tree *tree, const uint32_t *vertices, size_t count,
                         mote_vec3 u, mote_vec3 v)
{
    const size_t stride = (count + MOTE_CERT_FIT_CHUNK - 1) / MOTE_CERT_FIT_CHUNK;
    double low[2] = {DBL_MAX, DBL_MAX};
    double high[2] = {-DBL_MAX, -DBL_MAX};
    for (size_t i = 0; i < count; i += stride) {
        const mote_vec3 x = mote_cert_tree_position(tree, vertices[i]);
        const double p[2] = {mote_dot(x, u), mote_dot(x, v)};
        for (int k = 0; k < 2; ++k) {
            low[k] = p[k] < low[k] ? p[k] : low[k];
            high[k] = p[k] > high[k] ? p[k] : high[k];
        }
    }
    return (high[0] - low[0]) * (high[1] - low[1]);
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
    double least = area_along(tree, vertices, count, a, b);
    for (int i = 0; i < 9; ++i) {
        const mote_vec3 u = mote_add_scaled(mote_scale(a, turns[i][0]), turns[i][1], b);
        const mote_vec3 v = mote_add_scaled(mote_scale(b, turns[i][0]), -turns[i][1], a);
        const double area = area_along(tree, vertices, count, u, v);
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
    double low[3] = {DBL_MAX, DBL_MAX, DBL_MAX};
    double high[3] = {-DBL_MAX, -DBL_MAX, -DBL_MAX};
    for (size_t i = 0; i < count; ++i) {
        const mote_vec3 x = mote_cert_tree_position(tree, vertices[i]);
        for (int k = 0; k < 3; ++k) {
            const double p = mote_dot(x, axes[k]);
            low[k] = p < low[k] ? p : low[k];
            high[k] = p > high[k] ? p : high[k];
        }
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
