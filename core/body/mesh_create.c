/* Checking the faces and vertices of a mesh, and measuring it. */
#include "core/body/mesh_ring.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static mote_status check_positions(const double *xyz, size_t vertex_count)
{
    static const char axis[3] = {'x', 'y', 'z'};
    for (size_t i = 0; i < 3 * vertex_count; ++i) {
        if (!isfinite(xyz[i]))
            return mote_fail(MOTE_EINVAL,
                             "vertex %zu: %c is not finite; every coordinate must be "
                             "a finite number",
                             i / 3, axis[i % 3]);
    }
    return MOTE_OK;
}

static mote_status check_faces(const uint32_t *indices, size_t triangle_count,
                               size_t vertex_count)
{
    for (size_t f = 0; f < triangle_count; ++f) {
        const uint32_t *t = indices + 3 * f;
        for (int k = 0; k < 3; ++k) {
            if (t[k] >= vertex_count)
                return mote_fail(MOTE_EINVAL,
                                 "face %zu: index %u is out of range; there are %zu "
                                 "vertices, counted from 0",
                                 f, t[k], vertex_count);
        }
        if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0])
            return mote_fail(MOTE_EINVAL,
                             "face %zu: repeats a vertex (%u, %u, %u); a face needs "
                             "three different vertices",
                             f, t[0], t[1], t[2]);
    }
    return MOTE_OK;
}

static mote_status check_input(const double *xyz, size_t vertex_count, const uint32_t *indices,
                               size_t triangle_count)
{
    if (triangle_count == 0 || vertex_count == 0)
        return mote_fail(MOTE_EINVAL, "the mesh has no triangle; at least one is needed");
    if (vertex_count >= MOTE_RING_END || triangle_count >= MOTE_RING_END / 3)
        return mote_fail(MOTE_EINVAL,
                         "the mesh has %zu vertices and %zu triangles; below 2^31 "
                         "vertices and 2^31 / 3 triangles are supported",
                         vertex_count, triangle_count);
    mote_status status = check_positions(xyz, vertex_count);
    return status == MOTE_OK ? check_faces(indices, triangle_count, vertex_count) : status;
}

static mote_status copy_input(mote_mesh *mesh, const double *xyz, const uint32_t *indices)
{
    mesh->positions = malloc(mesh->vertex_count * sizeof *mesh->positions);
    mesh->triangles = malloc(mesh->triangle_count * sizeof *mesh->triangles);
    if (!mesh->positions || !mesh->triangles)
        return mote_fail(MOTE_ENOMEM, "no memory for a mesh of %u vertices",
                         mesh->vertex_count);
    for (uint32_t i = 0; i < mesh->vertex_count; ++i)
        mesh->positions[i] = mote_vec3_make(xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]);
    memcpy(mesh->triangles, indices, mesh->triangle_count * sizeof *mesh->triangles);
    return MOTE_OK;
}

static mote_status measure_extent(mote_mesh *mesh)
{
    mote_vec3 low = mesh->positions[0];
    mote_vec3 high = low;
    for (uint32_t i = 1; i < mesh->vertex_count; ++i) {
        const mote_vec3 p = mesh->positions[i];
        low = mote_vec3_make(fmin(low.x, p.x), fmin(low.y, p.y), fmin(low.z, p.z));
        high = mote_vec3_make(fmax(high.x, p.x), fmax(high.y, p.y), fmax(high.z, p.z));
    }
    mesh->low = low;
    mesh->high = high;
    /* Halved first and scaled by a power of two, so that neither a difference nor a square
       leaves the range of a double while the diagonal itself is in it. */
    const mote_vec3 half = mote_sub(mote_scale(high, 0.5), mote_scale(low, 0.5));
    const double widest = fmax(half.x, fmax(half.y, half.z));
    if (!(widest > 0))
        return mote_fail(MOTE_EINVAL, "all vertices coincide; a mesh needs an extent");
    const int exponent = ilogb(widest);
    const mote_vec3 unit = mote_vec3_make(ldexp(half.x, -exponent), ldexp(half.y, -exponent),
                                          ldexp(half.z, -exponent));
    mesh->diagonal = ldexp(mote_length(unit), exponent + 1);
    if (!(mesh->diagonal >= MOTE_LENGTH_MIN && mesh->diagonal <= MOTE_LENGTH_MAX))
        return mote_fail(MOTE_EINVAL,
                         "the bounding-box diagonal is %.3g; it must be from %g to %g, since "
                         "distances are squared; use another unit of length",
                         mesh->diagonal, MOTE_LENGTH_MIN, MOTE_LENGTH_MAX);
    return MOTE_OK;
}

/* The power of two that brings L to 1 .. 2: lengths times it have squares in range, and keep
   their bits. */
static double unit_of(const mote_mesh *mesh)
{
    return ldexp(1, -ilogb(mesh->diagonal));
}

/* Each ring names every edge from both of its ends; a closed fan among several names its first
   edge again at its end. */
static void measure_edges(mote_mesh *mesh)
{
    const double unit = unit_of(mesh);
    double sum = 0;
    uint64_t count = 0;
    for (uint32_t v = 0; v < mesh->vertex_count; ++v) {
        uint32_t first = mesh->ring_start[v];
        const uint32_t end = mesh->ring_start[v + 1];
        for (uint32_t k = first; k < end; ++k) {
            const uint32_t u = MOTE_RING_VERTEX(mesh->ring[k]);
            const bool repeated = k > first && u == mesh->ring[first];
            if (mesh->ring[k] & MOTE_RING_END)
                first = k + 1;
            if (u < v || repeated)
                continue;
            const mote_vec3 edge = mote_sub(mesh->positions[u], mesh->positions[v]);
            sum += mote_length(mote_scale(edge, unit));
            ++count;
        }
    }
    mesh->mean_edge = sum / (double)count / unit;
}

static mote_status label_components(mote_mesh *mesh)
{
    const uint32_t n = mesh->vertex_count;
    mesh->component = malloc(n * sizeof *mesh->component);
    uint32_t *stack = malloc(n * sizeof *stack);
    if (!mesh->component || !stack) {
        free(stack);
        return mote_fail(MOTE_ENOMEM, "no memory for a mesh of %u vertices", n);
    }
    memset(mesh->component, 0xff, n * sizeof *mesh->component);
    for (uint32_t start = 0; start < n; ++start) {
        if (mesh->component[start] != UINT32_MAX)
            continue;
        const uint32_t label = mesh->component_count++;
        uint32_t depth = 0;
        stack[depth++] = start;
        mesh->component[start] = label;
        while (depth > 0) {
            const uint32_t v = stack[--depth];
            for (uint32_t k = mesh->ring_start[v]; k < mesh->ring_start[v + 1]; ++k) {
                const uint32_t u = MOTE_RING_VERTEX(mesh->ring[k]);
                if (mesh->component[u] == UINT32_MAX) {
                    mesh->component[u] = label;
                    stack[depth++] = u;
                }
            }
        }
    }
    free(stack);
    return MOTE_OK;
}

mote_status mote_mesh_create(const double *xyz, size_t vertex_count, const uint32_t *indices,
                             size_t triangle_count, mote_mesh **mesh)
{
    mote_status status = check_input(xyz, vertex_count, indices, triangle_count);
    if (status != MOTE_OK)
        return status;
    mote_mesh *made = calloc(1, sizeof *made);
    if (!made)
        return mote_fail(MOTE_ENOMEM, "no memory for a mesh");
    made->vertex_count = (uint32_t)vertex_count;
    made->triangle_count = (uint32_t)triangle_count;
    status = copy_input(made, xyz, indices);
    if (status == MOTE_OK)
        status = measure_extent(made);
    if (status == MOTE_OK)
        status = mote_mesh_build_rings(made);
    if (status == MOTE_OK)
        status = label_components(made);
    if (status != MOTE_OK) {
        mote_mesh_destroy(made);
        return status;
    }
    measure_edges(made);
    *mesh = made;
    return MOTE_OK;
}

void mote_mesh_destroy(mote_mesh *mesh)
{
    if (!mesh)
        return;
    free(mesh->positions);
    free(mesh->triangles);
    free(mesh->ring_start);
    free(mesh->ring);
    free(mesh->component);
    free(mesh);
}

size_t mote_mesh_bytes(const mote_mesh *mesh)
{
    const size_t n = mesh->vertex_count;
    return sizeof *mesh + n * sizeof *mesh->positions +
           mesh->triangle_count * sizeof *mesh->triangles + (n + 1) * sizeof *mesh->ring_start +
           mesh->ring_start[n] * sizeof *mesh->ring + n * sizeof *mesh->component;
}

int64_t mote_mesh_euler(const mote_mesh *mesh)
{
    return (int64_t)mesh->vertex_count - (int64_t)mesh->edge_count +
           (int64_t)mesh->triangle_count;
}

/* The smallest angle of a triangle in degrees; its sides are multiplied by unit. */
static double smallest_angle_of(mote_vec3 a, mote_vec3 b, mote_vec3 c, double unit)
{
    const mote_vec3 corner[3] = {a, b, c};
    double smallest = 180;
    for (int k = 0; k < 3; ++k) {
        const mote_vec3 u = mote_scale(mote_sub(corner[(k + 1) % 3], corner[k]), unit);
        const mote_vec3 v = mote_scale(mote_sub(corner[(k + 2) % 3], corner[k]), unit);
        const double angle = atan2(mote_length(mote_cross(u, v)), mote_dot(u, v));
        smallest = fmin(smallest, angle * 57.29577951308232);
    }
    return smallest;
}

double mote_mesh_smallest_angle(const mote_mesh *mesh)
{
    const double unit = unit_of(mesh);
    double smallest = 180;
    for (uint32_t f = 0; f < mesh->triangle_count; ++f) {
        const uint32_t *t = mesh->triangles[f];
        smallest =
            fmin(smallest, smallest_angle_of(mesh->positions[t[0]], mesh->positions[t[1]],
                                             mesh->positions[t[2]], unit));
    }
    return smallest;
}
