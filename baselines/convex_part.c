#include "baselines/convex_part.h"

#include "core/parts/parts.h"

#include <stdlib.h>

static uint32_t part_of_triangle(const uint32_t *label, const uint32_t triangle[3])
{
    uint32_t a = label[triangle[0]], b = label[triangle[1]], c = label[triangle[2]];
    return b == c ? b : a;
}

/* Marks the corners of a part's triangles with their local index + 1 in order of the mesh. */
static uint32_t mark_vertices(const mote_mesh *mesh, const uint32_t *label, uint32_t which,
                              uint32_t *local)
{
    for (uint32_t v = 0; v < mesh->vertex_count; ++v)
        local[v] = 0;
    for (uint32_t f = 0; f < mesh->triangle_count; ++f) {
        const uint32_t *t = mesh->triangles[f];
        if (part_of_triangle(label, t) == which)
            local[t[0]] = local[t[1]] = local[t[2]] = 1;
    }
    uint32_t count = 0;
    for (uint32_t v = 0; v < mesh->vertex_count; ++v) {
        if (local[v])
            local[v] = ++count;
    }
    return count;
}

static uint32_t count_neighbours(const mote_mesh *mesh, const uint32_t *local)
{
    uint32_t count = 0;
    for (uint32_t v = 0; v < mesh->vertex_count; ++v) {
        for (uint32_t k = mesh->ring_start[v]; local[v] && k < mesh->ring_start[v + 1]; ++k)
            count += local[MOTE_RING_VERTEX(mesh->ring[k])] != 0;
    }
    return count;
}

static void fill_part(const mote_mesh *mesh, const uint32_t *local, mote_convex_part *part)
{
    uint32_t i = 0, n = 0;
    for (uint32_t v = 0; v < mesh->vertex_count; ++v) {
        if (!local[v])
            continue;
        part->vertex[i] = v;
        part->ring_start[i++] = n;
        for (uint32_t k = mesh->ring_start[v]; k < mesh->ring_start[v + 1]; ++k) {
            uint32_t neighbour = local[MOTE_RING_VERTEX(mesh->ring[k])];
            if (neighbour)
                part->ring[n++] = neighbour - 1;
        }
    }
    part->ring_start[i] = n;
}

/* Farthest points at rest, starting with the part's first vertex. */
static void choose_landmarks(const mote_mesh *mesh, mote_convex_part *part, double *nearest)
{
    for (uint32_t i = 0; i < part->count; ++i)
        nearest[i] = HUGE_VAL;
    uint32_t next = 0;
    while (part->landmark_count < MOTE_CONVEX_LANDMARKS && nearest[next] > 0) {
        part->landmark[part->landmark_count++] = next;
        mote_vec3 p = mesh->positions[part->vertex[next]];
        for (uint32_t i = 0; i < part->count; ++i)
            nearest[i] =
                fmin(nearest[i], mote_distance_squared(p, mesh->positions[part->vertex[i]]));
        for (uint32_t i = 0; i < part->count; ++i) {
            if (nearest[i] > nearest[next])
                next = i;
        }
    }
}

static mote_status build_part(const mote_mesh *mesh, const uint32_t *label, uint32_t which,
                              uint32_t *local, mote_convex_part *part)
{
    part->count = mark_vertices(mesh, label, which, local);
    if (part->count == 0)
        return MOTE_OK;
    part->vertex = calloc(part->count, sizeof *part->vertex);
    part->ring_start = malloc((part->count + 1) * sizeof *part->ring_start);
    part->ring = malloc((count_neighbours(mesh, local) + 1) * sizeof *part->ring);
    double *nearest = calloc(part->count, sizeof *nearest);
    mote_status status = MOTE_OK;
    if (!part->vertex || !part->ring_start || !part->ring || !nearest) {
        status =
            mote_fail(MOTE_ENOMEM, "no memory for a convex part of %u vertices", part->count);
    } else {
        fill_part(mesh, local, part);
        choose_landmarks(mesh, part, nearest);
    }
    free(nearest);
    return status;
}

static mote_status build(const mote_mesh *mesh, const mote_parts *labels,
                         mote_convex_parts *parts)
{
    uint32_t *local = malloc(mesh->vertex_count * sizeof *local);
    parts->part = calloc(labels->count, sizeof *parts->part);
    mote_status status = MOTE_OK;
    if (!local || !parts->part) {
        free(local);
        return mote_fail(MOTE_ENOMEM, "no memory for %u convex parts", labels->count);
    }
    for (uint32_t k = 0; k < labels->count && status == MOTE_OK; ++k) {
        /* A part without triangles is left out. */
        mote_convex_part *part = &parts->part[parts->count];
        status = build_part(mesh, labels->label, k, local, part);
        if (part->count > 0)
            parts->count++;
    }
    free(local);
    return status;
}

mote_status mote_convex_parts_create(const mote_mesh *mesh, mote_convex_parts **parts)
{
    mote_parts *labels = NULL;
    mote_status status = mote_parts_create(mesh, NULL, &labels);
    if (status != MOTE_OK)
        return status;
    mote_convex_parts *result = calloc(1, sizeof *result);
    if (!result)
        status = mote_fail(MOTE_ENOMEM, "no memory for convex parts");
    else
        status = build(mesh, labels, result);
    mote_parts_destroy(labels);
    if (status == MOTE_OK)
        *parts = result;
    else
        mote_convex_parts_destroy(result);
    return status;
}

void mote_convex_parts_destroy(mote_convex_parts *parts)
{
    if (!parts)
        return;
    for (uint32_t k = 0; k < parts->count; ++k) {
        free(parts->part[k].vertex);
        free(parts->part[k].ring_start);
        free(parts->part[k].ring);
    }
    free(parts->part);
    free(parts);
}

/* The farthest of some vertices: of all (which is NULL), or of the local ones listed. */
static uint32_t best_of(const mote_convex_part *part, const mote_vec3 *positions,
                        mote_vec3 direction, const uint32_t *which, uint32_t count)
{
    uint32_t best = which ? which[0] : 0;
    double height = mote_dot(direction, positions[part->vertex[best]]);
    for (uint32_t k = 1; k < count; ++k) {
        uint32_t i = which ? which[k] : k;
        double h = mote_dot(direction, positions[part->vertex[i]]);
        if (h > height) {
            height = h;
            best = i;
        }
    }
    return best;
}

uint32_t mote_convex_part_support(const mote_convex_part *part, const mote_vec3 *positions,
                                  mote_vec3 direction, bool scan)
{
    if (scan)
        return part->vertex[best_of(part, positions, direction, NULL, part->count)];
    uint32_t best = best_of(part, positions, direction, part->landmark, part->landmark_count);
    double height = mote_dot(direction, positions[part->vertex[best]]);
    for (;;) {
        uint32_t here = best;
        for (uint32_t k = part->ring_start[here]; k < part->ring_start[here + 1]; ++k) {
            double h = mote_dot(direction, positions[part->vertex[part->ring[k]]]);
            if (h > height) {
                height = h;
                best = part->ring[k];
            }
        }
        if (best == here)
            return part->vertex[best];
    }
}

mote_vec3 mote_convex_part_centre(const mote_convex_part *part, const mote_vec3 *positions)
{
    mote_vec3 sum = {0, 0, 0};
    for (uint32_t k = 0; k < part->landmark_count; ++k)
        sum = mote_add(sum, positions[part->vertex[part->landmark[k]]]);
    return mote_scale(sum, 1.0 / part->landmark_count);
}
