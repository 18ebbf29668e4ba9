/* Compactly supported radial basis functions (paper section 4): Wendland's C2 function. */
#include "core/body/field_kinds.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* phi of one group of MOTE_LANES centres. */
MOTE_INLINE void evaluate_lanes(const mote_field *field, uint32_t first, mote_vec3 p,
                                double inverse, double phi[MOTE_LANES])
{
    const double *cx = field->centre_x + first;
    const double *cy = field->centre_y + first;
    const double *cz = field->centre_z + first;
    MOTE_LANE_LOOP
    for (int l = 0; l < MOTE_LANES; ++l) {
        const double dx = (p.x - cx[l]) * inverse;
        const double dy = (p.y - cy[l]) * inverse;
        const double dz = (p.z - cz[l]) * inverse;
        phi[l] = mote_wendland_c2(sqrt(dx * dx + dy * dy + dz * dz));
    }
}

MOTE_CLONES
static void csrbf_basis(const mote_field *field, const mote_mesh *mesh, uint32_t vertex,
                        double *phi)
{
    const mote_vec3 p = mesh->positions[vertex];
    const double inverse = 1 / field->support;
    for (uint32_t j = 0; j < field->padded; j += MOTE_LANES)
        evaluate_lanes(field, j, p, inverse, phi + j);
    for (uint32_t j = field->count; j < field->padded; ++j)
        phi[j] = 0;
}

/* The padding has weight zero, so the values of its functions do not matter. */
MOTE_CLONES
static mote_vec3 csrbf_displacement(const mote_field *field, const mote_mesh *mesh,
                                    uint32_t vertex, const mote_weights *weights)
{
    const mote_vec3 p = mesh->positions[vertex];
    const double inverse = 1 / field->support;
    double x[MOTE_LANES] = {0};
    double y[MOTE_LANES] = {0};
    double z[MOTE_LANES] = {0};
    for (uint32_t j = 0; j < field->padded; j += MOTE_LANES) {
        double phi[MOTE_LANES];
        evaluate_lanes(field, j, p, inverse, phi);
        MOTE_LANE_LOOP
        for (int l = 0; l < MOTE_LANES; ++l) {
            x[l] += phi[l] * weights->x[j + (uint32_t)l];
            y[l] += phi[l] * weights->y[j + (uint32_t)l];
            z[l] += phi[l] * weights->z[j + (uint32_t)l];
        }
    }
    return mote_vec3_make(mote_lane_sum(x), mote_lane_sum(y), mote_lane_sum(z));
}

MOTE_CLONES
static void csrbf_displacement_single(const mote_field *field, const mote_mesh *mesh,
                                      uint32_t vertex, const mote_weights_single *weights,
                                      float displacement[3])
{
    const mote_vec3 p = mesh->positions[vertex];
    const float px = (float)p.x;
    const float py = (float)p.y;
    const float pz = (float)p.z;
    const float inverse = (float)(1 / field->support);
    const float *cx = field->centre_single;
    const float *cy = cx + field->padded;
    const float *cz = cy + field->padded;
    float x[MOTE_LANES] = {0};
    float y[MOTE_LANES] = {0};
    float z[MOTE_LANES] = {0};
    for (size_t j = 0; j < field->padded; j += MOTE_LANES) {
        MOTE_LANE_LOOP
        for (size_t l = 0; l < MOTE_LANES; ++l) {
            const float dx = (px - cx[j + l]) * inverse;
            const float dy = (py - cy[j + l]) * inverse;
            const float dz = (pz - cz[j + l]) * inverse;
            const float phi = mote_wendland_c2_single(sqrtf(dx * dx + dy * dy + dz * dz));
            x[l] += phi * weights->x[j + l];
            y[l] += phi * weights->y[j + l];
            z[l] += phi * weights->z[j + l];
        }
    }
    displacement[0] = mote_lane_sum_single(x);
    displacement[1] = mote_lane_sum_single(y);
    displacement[2] = mote_lane_sum_single(z);
}

/* Lane l of the sums of MOTE_LANES vertices: the functions with j % MOTE_LANES = l. A function
   that is 0 adds +0 or -0 to a lane that is never -0. */
MOTE_INLINE void group_lane(const mote_field *field, double p[3][MOTE_LANES], uint32_t l,
                            const mote_weights *weights, double lane[3][MOTE_LANES])
{
    const double inverse = 1 / field->support;
    double x[MOTE_LANES] = {0};
    double y[MOTE_LANES] = {0};
    double z[MOTE_LANES] = {0};
    for (uint32_t j = l; j < field->count; j += MOTE_LANES) {
        const double cx = field->centre_x[j];
        const double cy = field->centre_y[j];
        const double cz = field->centre_z[j];
        const double wx = weights->x[j];
        const double wy = weights->y[j];
        const double wz = weights->z[j];
        MOTE_LANE_LOOP
        for (size_t v = 0; v < MOTE_LANES; ++v) {
            const double dx = (p[0][v] - cx) * inverse;
            const double dy = (p[1][v] - cy) * inverse;
            const double dz = (p[2][v] - cz) * inverse;
            const double phi = mote_wendland_c2(sqrt(dx * dx + dy * dy + dz * dz));
            x[v] += phi * wx;
            y[v] += phi * wy;
            z[v] += phi * wz;
        }
    }
    memcpy(lane[0], x, sizeof x);
    memcpy(lane[1], y, sizeof y);
    memcpy(lane[2], z, sizeof z);
}

/* Here the lanes hold vertices, where in csrbf_displacement they hold functions; the sums are
   added in the same order. */
MOTE_CLONES
static void csrbf_group(const mote_field *field, const mote_mesh *mesh,
                        const uint32_t vertices[MOTE_LANES], const mote_weights *weights,
                        double displacement[3][MOTE_LANES])
{
    _Alignas(64) double p[3][MOTE_LANES];
    for (size_t v = 0; v < MOTE_LANES; ++v) {
        const mote_vec3 x = mesh->positions[vertices[v]];
        p[0][v] = x.x;
        p[1][v] = x.y;
        p[2][v] = x.z;
    }
    _Alignas(64) double lane[MOTE_LANES][3][MOTE_LANES];
    for (uint32_t l = 0; l < MOTE_LANES; ++l)
        group_lane(field, p, l, weights, lane[l]);
    for (size_t c = 0; c < 3; ++c) {
        MOTE_LANE_LOOP
        for (size_t v = 0; v < MOTE_LANES; ++v)
            displacement[c][v] =
                ((lane[0][c][v] + lane[4][c][v]) + (lane[2][c][v] + lane[6][c][v])) +
                ((lane[1][c][v] + lane[5][c][v]) + (lane[3][c][v] + lane[7][c][v]));
    }
}

/* Rest positions relative to the first, in units of the support radius. They are small where a
   function is not 0 at all vertices, so that floats lose little. Returns the largest sum of a
   vertex's absolute coordinates. */
MOTE_INLINE float relative_positions(const mote_field *field, const mote_mesh *mesh,
                                     const uint32_t vertices[MOTE_LANES],
                                     float p[3][MOTE_LANES])
{
    const double inverse = 1 / field->support;
    const mote_vec3 base = mesh->positions[vertices[0]];
    double d[3][MOTE_LANES];
    for (size_t v = 0; v < MOTE_LANES; ++v) {
        const mote_vec3 x = mesh->positions[vertices[v]];
        d[0][v] = x.x - base.x;
        d[1][v] = x.y - base.y;
        d[2][v] = x.z - base.z;
    }
    float size[MOTE_LANES] = {0};
    for (size_t c = 0; c < 3; ++c) {
        MOTE_LANE_LOOP
        for (size_t v = 0; v < MOTE_LANES; ++v) {
            p[c][v] = (float)(d[c][v] * inverse);
            size[v] += fabsf(p[c][v]);
        }
    }
    float most = 0;
    for (size_t v = 0; v < MOTE_LANES; ++v)
        most = size[v] > most ? size[v] : most;
    return most;
}

/* With u = 2^-24 and |p| <= E: a coordinate of p - c is wrong by u (2 E + 2), since the centre
   of a function that is not 0 is at most E + 1 away; so r is wrong by u (3.5 E + 6.5), and phi,
   whose slope is at most 2.11, by u (8 E + 24), evaluation included; the sum adds u a term. */
MOTE_CLONES
static float csrbf_estimate(const mote_field *field, const mote_mesh *mesh,
                            const uint32_t vertices[MOTE_LANES], const uint16_t *functions,
                            size_t count, const float *const weights[3],
                            float displacement[3][MOTE_LANES])
{
    const double inverse = 1 / field->support;
    const mote_vec3 base = mesh->positions[vertices[0]];
    float p[3][MOTE_LANES];
    const float extent = relative_positions(field, mesh, vertices, p);
    float x[MOTE_LANES] = {0}, y[MOTE_LANES] = {0}, z[MOTE_LANES] = {0};
    for (size_t i = 0; i < count; ++i) {
        const size_t j = functions[i];
        const float cx = (float)((field->centre_x[j] - base.x) * inverse);
        const float cy = (float)((field->centre_y[j] - base.y) * inverse);
        const float cz = (float)((field->centre_z[j] - base.z) * inverse);
        const float wx = weights[0][j];
        const float wy = weights[1][j];
        const float wz = weights[2][j];
        MOTE_LANE_LOOP
        for (size_t v = 0; v < MOTE_LANES; ++v) {
            const float dx = p[0][v] - cx;
            const float dy = p[1][v] - cy;
            const float dz = p[2][v] - cz;
            const float phi = mote_wendland_c2_single(sqrtf(dx * dx + dy * dy + dz * dz));
            x[v] += phi * wx;
            y[v] += phi * wy;
            z[v] += phi * wz;
        }
    }
    memcpy(displacement[0], x, sizeof x);
    memcpy(displacement[1], y, sizeof y);
    memcpy(displacement[2], z, sizeof z);
    return 0x1p-24F * (8 * extent + 24 + (float)count);
}

/* With s = |x - c| / support: d phi / dx = -20 (1 - s)^3 (x - c) / support^2, smooth at s = 0.
 */
static void csrbf_gradient(const mote_field *field, const mote_mesh *mesh, uint32_t vertex,
                           mote_vec3 *gradient)
{
    const mote_vec3 p = mesh->positions[vertex];
    const double inverse = 1 / field->support;
    for (uint32_t j = 0; j < field->padded; ++j) {
        const mote_vec3 c =
            mote_vec3_make(field->centre_x[j], field->centre_y[j], field->centre_z[j]);
        const mote_vec3 d = mote_scale(mote_sub(p, c), inverse);
        const double q = 1 - mote_length(d);
        gradient[j] = j < field->count && q > 0 ? mote_scale(d, -20 * q * q * q * inverse)
                                                : mote_vec3_make(0, 0, 0);
    }
}

static void csrbf_destroy(mote_field *field)
{
    free(field->centre_x);
    free(field->centre_y);
    free(field->centre_z);
    free(field->centre_single);
    free(field);
}

static const mote_field_kind csrbf_kind = {.name = "csrbf",
                                           .basis = csrbf_basis,
                                           .displacement = csrbf_displacement,
                                           .displacement_single = csrbf_displacement_single,
                                           .group = csrbf_group,
                                           .estimate = csrbf_estimate,
                                           .gradient = csrbf_gradient,
                                           .destroy = csrbf_destroy};

/* 1 / support is finite above it. */
#define LEAST_SUPPORT 0x1p-1024

static mote_status check_input(const mote_vec3 *centres, uint32_t count, double support)
{
    if (count < 1 || count > MOTE_FIELD_MAX)
        return mote_fail(MOTE_EINVAL, "a CSRBF field has 1 to %d centres, not %u",
                         MOTE_FIELD_MAX, count);
    if (!(support > LEAST_SUPPORT) || !isfinite(support))
        return mote_fail(
            MOTE_EINVAL,
            "the support radius is %g; it must be finite and above 2^-1024, 5.6e-309", support);
    for (uint32_t j = 0; j < count; ++j) {
        if (!mote_is_finite(centres[j]))
            return mote_fail(MOTE_EINVAL, "centre %u is not finite", j);
    }
    return MOTE_OK;
}

mote_status mote_field_create_csrbf(const mote_vec3 *centres, uint32_t count, double support,
                                    mote_field **field)
{
    mote_status status = check_input(centres, count, support);
    mote_field *made = NULL;
    if (status == MOTE_OK)
        status = mote_field_allocate(&csrbf_kind, count, &made);
    if (status != MOTE_OK)
        return status;
    made->support = support;
    made->centre_x = malloc(made->padded * sizeof(double));
    made->centre_y = malloc(made->padded * sizeof(double));
    made->centre_z = malloc(made->padded * sizeof(double));
    made->centre_single = malloc(3 * made->padded * sizeof(float));
    if (!made->centre_x || !made->centre_y || !made->centre_z || !made->centre_single) {
        csrbf_destroy(made);
        return mote_fail(MOTE_ENOMEM, "no memory for a field of %u centres", count);
    }
    made->bytes += 3 * made->padded * (sizeof(double) + sizeof(float));
    for (uint32_t j = 0; j < made->padded; ++j) {
        const mote_vec3 c = centres[j < count ? j : 0];
        made->centre_x[j] = c.x;
        made->centre_y[j] = c.y;
        made->centre_z[j] = c.z;
        made->centre_single[j] = (float)c.x;
        made->centre_single[made->padded + j] = (float)c.y;
        made->centre_single[2 * made->padded + j] = (float)c.z;
    }
    *field = made;
    return MOTE_OK;
}
