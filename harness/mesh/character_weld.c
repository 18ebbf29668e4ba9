#include "harness/mesh/character_parts.h"

#include "harness/base/hash.h"
#include "harness/base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Deviations of a weight sum from 1 below this are rounding: single precision, a few
   weights. */
#define OFF_COUNTS 1e-4

static mote_status check_weight(const char *path, const mote_character_draft *draft,
                                uint32_t vertex, uint32_t at)
{
    const mote_character *c = &draft->made;
    const double weight = c->weight[at], *place = draft->soup.xyz + (size_t)3 * vertex;
    if (isfinite(weight) && weight >= 0)
        return MOTE_OK;
    const mote_rig_bone *bone = &c->rig.bones[c->bone[at]];
    return mote_fail(MOTE_EINVAL,
                     "%s: the vertex at (%.6g, %.6g, %.6g) has the weight %g for bone %.60s; "
                     "give a finite one that is not negative",
                     path, place[0], place[1], place[2], weight,
                     c->rig.names + c->rig.nodes[bone->node].name);
}

/* Makes the weights of a vertex add up to 1, with each bone once and no weight 0. They are
   moved to *end, which advances. */
static mote_status normalise_vertex(const char *path, mote_character_draft *draft,
                                    uint32_t vertex, uint32_t begin, uint32_t *end)
{
    mote_character *c = &draft->made;
    const uint32_t given = c->start[vertex + 1], first = *end;
    const double *place = draft->soup.xyz + (size_t)3 * vertex;
    double sum = 0;
    for (uint32_t i = begin; i < given; ++i) {
        const mote_status status = check_weight(path, draft, vertex, i);
        if (status != MOTE_OK)
            return status;
        sum += c->weight[i];
        if (!(c->weight[i] > 0))
            continue;
        if (*end > first && c->bone[*end - 1] == c->bone[i]) {
            c->weight[*end - 1] += c->weight[i];
        } else {
            c->bone[*end] = c->bone[i];
            c->weight[(*end)++] = c->weight[i];
        }
    }
    if (!(sum > 0) || !isfinite(sum))
        return mote_fail(MOTE_EINVAL,
                         "%s: the weights of the vertex at (%.6g, %.6g, %.6g) add up to %g; "
                         "give a positive sum",
                         path, place[0], place[1], place[2], sum);
    for (uint32_t i = first; i < *end; ++i)
        c->weight[i] /= sum;
    draft->import.off = fmax(draft->import.off, fabs(sum - 1));
    draft->import.off_count += fabs(sum - 1) > OFF_COUNTS;
    return MOTE_OK;
}

static mote_status normalise(const char *path, mote_character_draft *draft)
{
    mote_character *c = &draft->made;
    uint32_t begin = 0, end = 0;
    mote_status status = MOTE_OK;
    for (uint32_t v = 0; v < draft->soup.vertex_count && status == MOTE_OK; ++v) {
        const uint32_t next = c->start[v + 1];
        status = normalise_vertex(path, draft, v, begin, &end);
        begin = next;
        c->start[v + 1] = end;
    }
    c->bone_count = c->weight_count = end;
    return status;
}

/* Whether two vertices move alike, regardless of their positions. */
static bool same_motion(const mote_character *c, uint32_t a, uint32_t b)
{
    const size_t weights = c->start[a + 1] - c->start[a];
    const size_t shifts = c->shift_start[a + 1] - c->shift_start[a];
    return weights == c->start[b + 1] - c->start[b] &&
           shifts == c->shift_start[b + 1] - c->shift_start[b] &&
           memcmp(c->bone + c->start[a], c->bone + c->start[b], weights * sizeof *c->bone) ==
               0 &&
           memcmp(c->weight + c->start[a], c->weight + c->start[b],
                  weights * sizeof *c->weight) == 0 &&
           memcmp(c->target + c->shift_start[a], c->target + c->shift_start[b],
                  shifts * sizeof *c->target) == 0 &&
           memcmp(c->shift + c->shift_start[a], c->shift + c->shift_start[b],
                  shifts * sizeof *c->shift) == 0;
}

static uint64_t hash_motion(const mote_character *c, uint32_t v)
{
    const uint32_t w = c->start[v], s = c->shift_start[v];
    uint64_t hash =
        mote_hash_bytes(MOTE_HASH_START, c->bone + w, (c->start[v + 1] - w) * sizeof *c->bone);
    hash = mote_hash_bytes(hash, c->weight + w, (c->start[v + 1] - w) * sizeof *c->weight);
    hash =
        mote_hash_bytes(hash, c->target + s, (c->shift_start[v + 1] - s) * sizeof *c->target);
    return mote_hash_bytes(hash, c->shift + s, (c->shift_start[v + 1] - s) * sizeof *c->shift);
}

/* Sets the kind of each vertex: the first vertex that moves like it. */
static void set_kinds(mote_character_draft *draft)
{
    const uint32_t count = (uint32_t)draft->soup.vertex_count;
    size_t slot_count = 64;
    while (slot_count < 2 * (size_t)count)
        slot_count *= 2;
    uint32_t *slots = mote_allocate(slot_count, sizeof *slots);
    uint32_t *kind = mote_allocate(count, sizeof *kind);
    memset(slots, 0xff, slot_count * sizeof *slots);
    for (uint32_t v = 0; v < count; ++v) {
        size_t slot = hash_motion(&draft->made, v) & (slot_count - 1);
        while (slots[slot] != UINT32_MAX && !same_motion(&draft->made, slots[slot], v))
            slot = (slot + 1) & (slot_count - 1);
        if (slots[slot] == UINT32_MAX)
            slots[slot] = v;
        kind[v] = slots[slot];
    }
    free(slots);
    draft->soup.kind = kind;
}

/* The largest difference of a bone's weight between two vertices of the file. */
static double weight_difference(const mote_character *c, uint32_t a, uint32_t b)
{
    uint32_t i = c->start[a], k = c->start[b];
    double most = 0;
    while (i < c->start[a + 1] || k < c->start[b + 1]) {
        const uint32_t own = i < c->start[a + 1] ? c->bone[i] : UINT32_MAX;
        const uint32_t other = k < c->start[b + 1] ? c->bone[k] : UINT32_MAX;
        const double w = own <= other ? c->weight[i++] : 0;
        const double u = other <= own ? c->weight[k++] : 0;
        most = fmax(most, fabs(w - u));
    }
    return most;
}

static int compare_places(const void *a, const void *b)
{
    const double *p = *(const double *const *)a, *q = *(const double *const *)b;
    for (int c = 0; c < 3; ++c) {
        if (p[c] != q[c])
            return p[c] < q[c] ? -1 : 1;
    }
    return (p > q) - (p < q);
}

/* Counts the vertices kept apart from another one at the same place. */
static void count_apart(mote_character_draft *draft)
{
    const mote_soup *soup = &draft->soup;
    const size_t count = soup->vertex_count;
    const double **places = mote_allocate(count, sizeof *places);
    for (size_t v = 0; v < count; ++v)
        places[v] = soup->xyz + 3 * v;
    qsort(places, count, sizeof *places, compare_places);
    size_t first = 0; /* vertex at this place */
    for (size_t i = 1; i < count; ++i) {
        const double *a = places[first], *b = places[i];
        if (a[0] != b[0] || a[1] != b[1] || a[2] != b[2]) {
            first = i;
            continue;
        }
        const uint32_t u = soup->kind[(a - soup->xyz) / 3], v = soup->kind[(b - soup->xyz) / 3];
        ++draft->import.apart;
        draft->import.apart_most =
            fmax(draft->import.apart_most, weight_difference(&draft->made, u, v));
    }
    free(places);
}

/* Replaces the arrays of the file's vertices with those of the mesh's vertices. */
static void set_arrays(mote_character_draft *draft)
{
    mote_character *old = &draft->made, made = {.mesh = NULL};
    const size_t count = draft->soup.vertex_count;
    MOTE_RIG_GROW(&made, start, count + 1);
    MOTE_RIG_GROW(&made, shift_start, count + 1);
    for (size_t v = 0; v < count; ++v) {
        const uint32_t from = draft->soup.kind[v];
        const size_t weights = old->start[from + 1] - old->start[from];
        const size_t shifts = old->shift_start[from + 1] - old->shift_start[from];
        const uint32_t w = made.start[v], s = made.shift_start[v];
        MOTE_RIG_GROW(&made, bone, weights);
        MOTE_RIG_GROW(&made, weight, weights);
        MOTE_RIG_GROW(&made, target, shifts);
        MOTE_RIG_GROW(&made, shift, shifts);
        memcpy(made.bone + w, old->bone + old->start[from], weights * sizeof *made.bone);
        memcpy(made.weight + w, old->weight + old->start[from], weights * sizeof *made.weight);
        memcpy(made.target + s, old->target + old->shift_start[from],
               shifts * sizeof *made.target);
        memcpy(made.shift + s, old->shift + old->shift_start[from],
               shifts * sizeof *made.shift);
        made.start[v + 1] = (uint32_t)made.bone_count;
        made.shift_start[v + 1] = (uint32_t)made.target_count;
    }
    mote_character_set_arrays(old, &made);
}

mote_status mote_character_weld(const char *path, mote_character_draft *draft)
{
    draft->import.given = draft->soup.vertex_count;
    mote_status status = normalise(path, draft);
    if (status != MOTE_OK)
        return status;
    set_kinds(draft);
    mote_soup_weld(&draft->soup);
    if (draft->soup.triangle_count == 0)
        return mote_fail(MOTE_EINVAL,
                         "%s: each of its %zu faces has two corners at one place; give "
                         "triangles with three places",
                         path, draft->soup.collapsed);
    count_apart(draft);
    mote_soup_split(&draft->soup, &draft->import.mesh.split);
    set_arrays(draft);
    draft->import.mesh.single_precision = draft->soup.single_precision;
    draft->import.mesh.welded = draft->soup.welded;
    draft->import.mesh.collapsed = draft->soup.collapsed;
    draft->import.mesh.unused = draft->soup.unused;
    return MOTE_OK;
}
