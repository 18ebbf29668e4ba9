#include "core/particle/start.h"

#include "core/base/random.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static mote_status check_count(const mote_mesh *mesh, uint32_t count)
{
    if (count < 1 || count > mesh->vertex_count)
        return mote_fail(MOTE_EINVAL,
                         "%u particles on a body of %u vertices; n must be from 1 to "
                         "the vertex count",
                         count, mesh->vertex_count);
    if (count < mesh->component_count)
        return mote_fail(MOTE_EUNSUPPORTED,
                         "%u particles on a body of %u connected components; "
                         "each needs at least one",
                         count, mesh->component_count);
    return MOTE_OK;
}

static void swap(uint32_t *a, uint32_t *b)
{
    const uint32_t c = *a;
    *a = *b;
    *b = c;
}

/* Shuffles the vertices, then brings the first of each component to the front. */
static mote_status choose_random(const mote_mesh *mesh, uint32_t count, mote_random *random,
                                 uint32_t *vertices)
{
    const uint32_t n = mesh->vertex_count;
    uint32_t *order = calloc(n, sizeof *order);
    unsigned char *seen = calloc(mesh->component_count, 1);
    if (!order || !seen) {
        free(order);
        free(seen);
        return mote_fail(MOTE_ENOMEM, "no memory to place particles on %u vertices", n);
    }
    for (uint32_t i = 0; i < n; ++i)
        order[i] = i;
    for (uint32_t i = 0; i + 1 < n; ++i)
        swap(&order[i], &order[i + mote_random_below(random, n - i)]);
    uint32_t front = 0;
    for (uint32_t i = 0; front < mesh->component_count; ++i) {
        const uint32_t label = mesh->component[order[i]];
        if (!seen[label]) {
            seen[label] = 1;
            swap(&order[i], &order[front++]);
        }
    }
    memcpy(vertices, order, count * sizeof *order);
    free(order);
    free(seen);
    return MOTE_OK;
}

/* squared[i] becomes the squared distance of vertex i to the nearest chosen one; a chosen
   vertex has -1, so that it is never chosen again even where vertices coincide. */
static void mark_chosen(const mote_mesh *mesh, uint32_t chosen, double *squared)
{
    const mote_vec3 p = mesh->positions[chosen];
    for (uint32_t i = 0; i < mesh->vertex_count; ++i)
        squared[i] = fmin(squared[i], mote_distance_squared(mesh->positions[i], p));
    squared[chosen] = -1;
}

/* The vertex farthest from those chosen, the lowest index on a tie; only on components without
   a particle while there are any. */
static uint32_t farthest(const mote_mesh *mesh, const double *squared,
                         const unsigned char *covered, bool uncovered_only)
{
    uint32_t best = 0;
    double most = -2;
    for (uint32_t i = 0; i < mesh->vertex_count; ++i) {
        if (uncovered_only && covered[mesh->component[i]])
            continue;
        if (squared[i] > most) {
            most = squared[i];
            best = i;
        }
    }
    return best;
}

static mote_status choose_farthest(const mote_mesh *mesh, uint32_t count, mote_random *random,
                                   uint32_t *vertices)
{
    const uint32_t n = mesh->vertex_count;
    double *squared = malloc(n * sizeof *squared);
    unsigned char *covered = calloc(mesh->component_count, 1);
    if (!squared || !covered) {
        free(squared);
        free(covered);
        return mote_fail(MOTE_ENOMEM, "no memory to place particles on %u vertices", n);
    }
    for (uint32_t i = 0; i < n; ++i)
        squared[i] = HUGE_VAL;
    uint32_t next = (uint32_t)mote_random_below(random, n);
    for (uint32_t i = 0; i < count; ++i) {
        if (i > 0)
            next = farthest(mesh, squared, covered, i < mesh->component_count);
        vertices[i] = next;
        covered[mesh->component[next]] = 1;
        mark_chosen(mesh, next, squared);
    }
    free(squared);
    free(covered);
    return MOTE_OK;
}

mote_status mote_start_vertices(const mote_mesh *mesh, uint32_t count, mote_start start,
                                uint64_t seed, uint32_t *vertices)
{
    const mote_status status = check_count(mesh, count);
    if (status != MOTE_OK)
        return status;
    mote_random random = {seed};
    return start == MOTE_START_RANDOM ? choose_random(mesh, count, &random, vertices)
                                      : choose_farthest(mesh, count, &random, vertices);
}
