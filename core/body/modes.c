/* Linear modes: a displacement vector per vertex and mode. */
#include "core/body/field_kinds.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct modes_data {
    double *largest; /* [count / 3]: see field_kinds.h; behind phi */
    double phi[];    /* [vertex_count][padded] */
} modes_data;

static const double *row_of(const mote_field *field, uint32_t vertex)
{
    const modes_data *data = field->data;
    return data->phi + (size_t)vertex * field->padded;
}

static void modes_basis(const mote_field *field, const mote_mesh *mesh, uint32_t vertex,
                        double *phi)
{
    (void)mesh;
    memcpy(phi, row_of(field, vertex), field->padded * sizeof *phi);
}

MOTE_CLONES
static mote_vec3 modes_displacement(const mote_field *field, const mote_mesh *mesh,
                                    uint32_t vertex, const mote_weights *weights)
{
    (void)mesh;
    return mote_weighted_sum(row_of(field, vertex), weights, field->padded);
}

MOTE_CLONES
static void modes_displacement_single(const mote_field *field, const mote_mesh *mesh,
                                      uint32_t vertex, const mote_weights_single *weights,
                                      float displacement[3])
{
    (void)mesh;
    mote_weighted_sum_single(row_of(field, vertex), weights, field->padded, displacement);
}

/* Solves the symmetric system m g = b by Cramer's rule; false when it is singular. */
static bool solve3(double m[3][3], mote_vec3 b, mote_vec3 *g)
{
    const mote_vec3 r0 = {m[0][0], m[0][1], m[0][2]};
    const mote_vec3 r1 = {m[1][0], m[1][1], m[1][2]};
    const mote_vec3 r2 = {m[2][0], m[2][1], m[2][2]};
    const double determinant = mote_dot(r0, mote_cross(r1, r2));
    if (!(fabs(determinant) > 0))
        return false;
    const mote_vec3 sum = mote_add(
        mote_add(mote_scale(mote_cross(r1, r2), b.x), mote_scale(mote_cross(r2, r0), b.y)),
        mote_scale(mote_cross(r0, r1), b.z));
    *g = mote_scale(sum, 1 / determinant);
    return true;
}

/* From a vertex to entry k of its ring, times unit. */
static mote_vec3 ring_edge(const mote_mesh *mesh, uint32_t vertex, uint32_t k, double unit)
{
    const uint32_t u = MOTE_RING_VERTEX(mesh->ring[k]);
    return mote_scale(mote_sub(mesh->positions[u], mesh->positions[vertex]), unit);
}

/* The least-squares gradient over the one-ring. Directions in which the ring has no extent (a
   flat ring's normal) get slope 0, by a small ridge on the diagonal. Lengths are in units of
   the mean edge: the determinant has their sixth power, which would soon leave the range of a
   double. */
static void modes_gradient(const mote_field *field, const mote_mesh *mesh, uint32_t vertex,
                           mote_vec3 *gradient)
{
    double m[3][3] = {{0}};
    const uint32_t first = mesh->ring_start[vertex];
    const uint32_t end = mesh->ring_start[vertex + 1];
    const double unit = 1 / mesh->mean_edge;
    for (uint32_t k = first; k < end; ++k) {
        const mote_vec3 d = ring_edge(mesh, vertex, k, unit);
        const double v[3] = {d.x, d.y, d.z};
        for (int a = 0; a < 3; ++a) {
            for (int b = 0; b < 3; ++b)
                m[a][b] += v[a] * v[b];
        }
    }
    const double ridge = 1e-9 * (m[0][0] + m[1][1] + m[2][2]);
    for (int a = 0; a < 3; ++a)
        m[a][a] += ridge;
    const double *here = row_of(field, vertex);
    for (uint32_t j = 0; j < field->padded; ++j) {
        mote_vec3 b = {0, 0, 0};
        for (uint32_t k = first; k < end; ++k) {
            const double *there = row_of(field, MOTE_RING_VERTEX(mesh->ring[k]));
            const double slope = (there[j] - here[j]) * unit;
            b = mote_add_scaled(b, slope, ring_edge(mesh, vertex, k, unit));
        }
        if (!solve3(m, b, &gradient[j]))
            gradient[j] = mote_vec3_make(0, 0, 0);
    }
}

static void modes_destroy(mote_field *field)
{
    free((void *)(uintptr_t)field->data);
    free(field);
}

static const mote_field_kind modes_kind = {.name = "modes",
                                           .basis = modes_basis,
                                           .displacement = modes_displacement,
                                           .displacement_single = modes_displacement_single,
                                           .gradient = modes_gradient,
                                           .destroy = modes_destroy};

const double *mote_modes_largest(const mote_field *field)
{
    return field->kind == &modes_kind ? ((const modes_data *)field->data)->largest : NULL;
}

static mote_status check_input(const mote_vec3 *modes, uint32_t count, uint32_t vertex_count)
{
    if (count < 1 || count > MOTE_FIELD_MAX / 3)
        return mote_fail(MOTE_EINVAL, "a field has 1 to %d linear modes, not %u",
                         MOTE_FIELD_MAX / 3, count);
    for (size_t i = 0; i < (size_t)count * vertex_count; ++i) {
        if (!mote_is_finite(modes[i]))
            return mote_fail(MOTE_EINVAL, "mode %zu is not finite at vertex %zu",
                             i / vertex_count, i % vertex_count);
    }
    return MOTE_OK;
}

mote_status mote_field_create_modes(const mote_vec3 *modes, uint32_t count,
                                    uint32_t vertex_count, mote_field **field)
{
    mote_status status = check_input(modes, count, vertex_count);
    mote_field *made = NULL;
    if (status == MOTE_OK)
        status = mote_field_allocate(&modes_kind, 3 * count, &made);
    if (status != MOTE_OK)
        return status;
    const size_t values = (size_t)vertex_count * made->padded;
    const size_t bytes = sizeof(modes_data) + (values + count) * sizeof(double);
    modes_data *data = calloc(1, bytes);
    if (!data) {
        free(made);
        return mote_fail(MOTE_ENOMEM, "no memory for %u modes of %u vertices", count,
                         vertex_count);
    }
    data->largest = data->phi + values;
    for (uint32_t m = 0; m < count; ++m) {
        for (uint32_t i = 0; i < vertex_count; ++i) {
            const mote_vec3 u = modes[(size_t)m * vertex_count + i];
            double *row = data->phi + (size_t)i * made->padded + (size_t)3 * m;
            row[0] = u.x;
            row[1] = u.y;
            row[2] = u.z;
            data->largest[m] = fmax(data->largest[m], mote_largest_coordinate(u));
        }
    }
    made->data = data;
    made->bytes += bytes;
    *field = made;
    return MOTE_OK;
}
