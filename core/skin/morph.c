/* Morph targets, ordered by vertex. */
#include "core/skin/skin_kinds.h"

#include <math.h>
#include <stdlib.h>

static mote_status check_target(const mote_mesh *mesh, const mote_morph_targets *targets,
                                uint32_t k)
{
    const uint32_t *start = targets->start;
    if (start[k + 1] < start[k])
        return mote_fail(MOTE_EINVAL, "morph target %u ends at %u, before its start at %u", k,
                         start[k + 1], start[k]);
    for (uint32_t i = start[k]; i < start[k + 1]; ++i) {
        const uint32_t v = targets->vertex[i];
        if (v >= mesh->vertex_count)
            return mote_fail(MOTE_EINVAL,
                             "morph target %u moves vertex %u of %u, counted from 0", k, v,
                             mesh->vertex_count);
        const mote_vec3 d = targets->move[i];
        if (!mote_is_finite(d))
            return mote_fail(MOTE_EINVAL,
                             "morph target %u moves vertex %u by (%g, %g, %g); it must be "
                             "finite",
                             k, v, d.x, d.y, d.z);
    }
    return MOTE_OK;
}

mote_status mote_morph_check(const mote_mesh *mesh, const mote_morph_targets *targets)
{
    if (targets->count < 1 || targets->count > MOTE_MORPH_TARGETS_MAX)
        return mote_fail(MOTE_EINVAL, "there are 1 to %d morph targets, not %u",
                         MOTE_MORPH_TARGETS_MAX, targets->count);
    if (targets->start[0] != 0)
        return mote_fail(MOTE_EINVAL, "morph target 0 starts at %u, not at 0",
                         targets->start[0]);
    mote_status status = MOTE_OK;
    for (uint32_t k = 0; k < targets->count && status == MOTE_OK; ++k)
        status = check_target(mesh, targets, k);
    return status;
}

/* 0 for a target that moves nothing. */
static double size_of(const mote_morph_targets *targets, uint32_t k)
{
    double most = 0;
    for (uint32_t i = targets->start[k]; i < targets->start[k + 1]; ++i)
        most = fmax(most, mote_largest_coordinate(targets->move[i]));
    return most > 0 ? ldexp(1, ilogb(most)) : 0;
}

/* A displacement as it is kept; false where all of it is 0. */
static bool rounded(mote_vec3 d, double size, float move[3])
{
    if (!(size > 0))
        return false;
    move[0] = (float)(d.x / size);
    move[1] = (float)(d.y / size);
    move[2] = (float)(d.z / size);
    return fabsf(move[0]) > 0 || fabsf(move[1]) > 0 || fabsf(move[2]) > 0;
}

/* Counts the targets of each vertex v in start[v + 1]. last[v]: the last target that named it,
   plus 1. */
static mote_status count(const mote_morph_targets *targets, mote_morph *morph, uint32_t *last)
{
    for (uint32_t k = 0; k < targets->count; ++k) {
        for (uint32_t i = targets->start[k]; i < targets->start[k + 1]; ++i) {
            const uint32_t v = targets->vertex[i];
            float move[3];
            if (last[v] == k + 1)
                return mote_fail(MOTE_EINVAL, "morph target %u names vertex %u twice", k, v);
            last[v] = k + 1;
            morph->start[v + 1] += rounded(targets->move[i], morph->size[k], move);
        }
    }
    return MOTE_OK;
}

static void place(const mote_morph_targets *targets, mote_morph *morph, uint32_t *next)
{
    for (uint32_t k = 0; k < targets->count; ++k) {
        for (uint32_t i = targets->start[k]; i < targets->start[k + 1]; ++i) {
            float move[3];
            if (!rounded(targets->move[i], morph->size[k], move))
                continue;
            const uint32_t at = next[targets->vertex[i]]++;
            morph->target[at] = (uint16_t)k;
            for (size_t c = 0; c < 3; ++c)
                morph->move[at][c] = move[c];
        }
    }
}

/* scratch[vertex_count] is zeroed. */
static mote_status order(const mote_mesh *mesh, const mote_morph_targets *targets,
                         mote_morph *morph, uint32_t *scratch)
{
    const uint32_t n = mesh->vertex_count;
    mote_status status = count(targets, morph, scratch);
    if (status != MOTE_OK)
        return status;
    for (uint32_t v = 0; v < n; ++v) {
        morph->most = morph->start[v + 1] > morph->most ? morph->start[v + 1] : morph->most;
        morph->start[v + 1] += morph->start[v];
        scratch[v] = morph->start[v];
    }
    const size_t kept = morph->start[n];
    morph->target = malloc((kept + 1) * sizeof *morph->target); /* one more: never 0 bytes */
    morph->move = malloc((kept + 1) * sizeof *morph->move);
    if (!morph->target || !morph->move)
        return mote_fail(MOTE_ENOMEM, "no memory for %zu displacements of morph targets", kept);
    place(targets, morph, scratch);
    return MOTE_OK;
}

mote_status mote_morph_fill(const mote_mesh *mesh, const mote_morph_targets *targets,
                            mote_morph *morph)
{
    const size_t n = mesh->vertex_count;
    morph->targets = targets->count;
    morph->start = calloc(n + 1, sizeof *morph->start);
    morph->size = malloc(targets->count * sizeof *morph->size);
    uint32_t *scratch = calloc(n, sizeof *scratch);
    mote_status status = MOTE_OK;
    if (!morph->start || !morph->size || !scratch) {
        status = mote_fail(MOTE_ENOMEM, "no memory for %u morph targets", targets->count);
    } else {
        for (uint32_t k = 0; k < targets->count; ++k)
            morph->size[k] = size_of(targets, k);
        status = order(mesh, targets, morph, scratch);
    }
    free(scratch);
    return status;
}
