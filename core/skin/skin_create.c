/* Making a skin: weights in order, normalised, and morph targets by vertex. */
#include "core/skin/skin.h"
#include "core/skin/skin_kinds.h"
#include "core/body/field_kinds.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define WHOLE 0x1p24 /* weights are integers times 1 / WHOLE */

/* A vertex's weights while they are put in order. */
typedef struct influence {
    double weight;
    uint16_t bone;
} influence;

static int by_bone(const void *a, const void *b)
{
    return (int)((const influence *)a)->bone - (int)((const influence *)b)->bone;
}

static mote_status check_vertex(uint32_t vertex, uint32_t bones, const uint32_t *start,
                                const uint16_t *bone, const double *weight)
{
    if (start[vertex + 1] <= start[vertex])
        return mote_fail(MOTE_EINVAL, "vertex %u has no bone; it needs at least one", vertex);
    double sum = 0;
    for (uint32_t i = start[vertex]; i < start[vertex + 1]; ++i) {
        if (bone[i] >= bones)
            return mote_fail(MOTE_EINVAL, "vertex %u follows bone %u of %u, counted from 0",
                             vertex, bone[i], bones);
        if (!isfinite(weight[i]) || weight[i] < 0)
            return mote_fail(MOTE_EINVAL,
                             "vertex %u has the weight %g; it must be finite and not negative",
                             vertex, weight[i]);
        sum += weight[i];
    }
    if (!(sum > 0) || !isfinite(sum))
        return mote_fail(MOTE_EINVAL,
                         "the weights of vertex %u add up to %g; their sum must be positive "
                         "and finite",
                         vertex, sum);
    return MOTE_OK;
}

static mote_status check_input(const mote_mesh *mesh, uint32_t bones, const uint32_t *start,
                               const uint16_t *bone, const double *weight)
{
    if (bones < 1 || bones > MOTE_SKIN_BONES_MAX)
        return mote_fail(MOTE_EINVAL, "a skin has 1 to %d bones, not %u", MOTE_SKIN_BONES_MAX,
                         bones);
    if (start[0] != 0)
        return mote_fail(MOTE_EINVAL, "the weights of vertex 0 start at %u, not at 0",
                         start[0]);
    mote_status status = MOTE_OK;
    for (uint32_t v = 0; v < mesh->vertex_count && status == MOTE_OK; ++v)
        status = check_vertex(v, bones, start, bone, weight);
    return status;
}

/* Sorts by bone and adds up those of one bone; returns how many are left. */
static size_t merge(influence *list, size_t count)
{
    qsort(list, count, sizeof *list, by_bone);
    size_t kept = 0;
    for (size_t i = 0; i < count; ++i) {
        if (kept > 0 && list[kept - 1].bone == list[i].bone)
            list[kept - 1].weight += list[i].weight;
        else
            list[kept++] = list[i];
    }
    return kept;
}

/* Makes the weights integers that add up to WHOLE: all are rounded down, and the largest takes
   what that leaves. */
static void round_weights(influence *list, size_t count, double *off)
{
    double sum = 0;
    size_t largest = 0;
    for (size_t i = 0; i < count; ++i) {
        sum += list[i].weight;
        largest = list[i].weight > list[largest].weight ? i : largest;
    }
    *off = fabs(sum - 1) > *off ? fabs(sum - 1) : *off;
    double others = 0;
    for (size_t i = 0; i < count; ++i) {
        list[i].weight = floor(list[i].weight / sum * WHOLE);
        others += i == largest ? 0 : list[i].weight;
    }
    list[largest].weight = WHOLE - others;
}

static void append_vertex(mote_skin *skin, uint32_t vertex, const influence *list, size_t count)
{
    uint32_t end = skin->start[vertex];
    for (size_t i = 0; i < count; ++i) {
        if (!(list[i].weight > 0))
            continue;
        skin->bone[end] = list[i].bone;
        skin->weight[end++] = (float)(list[i].weight / WHOLE);
    }
    const uint32_t own = end - skin->start[vertex];
    skin->start[vertex + 1] = end;
    skin->most = own > skin->most ? own : skin->most;
}

static mote_status fill(mote_skin *skin, const uint32_t *start, const uint16_t *bone,
                        const double *weight)
{
    uint32_t most = 0;
    for (uint32_t v = 0; v < skin->vertex_count; ++v)
        most = start[v + 1] - start[v] > most ? start[v + 1] - start[v] : most;
    influence *list = malloc(most * sizeof *list);
    if (!list)
        return mote_fail(MOTE_ENOMEM, "no memory for %u weights of a vertex", most);
    skin->start[0] = 0;
    for (uint32_t v = 0; v < skin->vertex_count; ++v) {
        const size_t count = start[v + 1] - start[v];
        for (size_t i = 0; i < count; ++i)
            list[i] = (influence){weight[start[v] + i], bone[start[v] + i]};
        const size_t kept = merge(list, count);
        round_weights(list, kept, &skin->off);
        append_vertex(skin, v, list, kept);
    }
    free(list);
    return MOTE_OK;
}

static mote_skin *allocate(const mote_mesh *mesh, uint32_t bones, size_t weights)
{
    mote_skin *skin = calloc(1, sizeof *skin);
    if (!skin)
        return NULL;
    skin->bones = bones;
    skin->vertex_count = mesh->vertex_count;
    skin->origin = mote_scale(mote_add(mesh->low, mesh->high), 0.5);
    skin->unit = ldexp(1, ilogb(mesh->diagonal));
    skin->start = malloc(((size_t)mesh->vertex_count + 1) * sizeof *skin->start);
    skin->bone = malloc(weights * sizeof *skin->bone);
    skin->weight = malloc(weights * sizeof *skin->weight);
    if (skin->start && skin->bone && skin->weight)
        return skin;
    mote_skin_free(skin);
    return NULL;
}

/* The bones of a skin; their weights have been checked. */
static mote_status create_bones(const mote_mesh *mesh, uint32_t bones, const uint32_t *start,
                                const uint16_t *bone, const double *weight, mote_skin **skin)
{
    const size_t given = start[mesh->vertex_count];
    mote_skin *made = allocate(mesh, bones, given);
    if (!made)
        return mote_fail(MOTE_ENOMEM, "no memory for %zu weights of a skin", given);
    mote_status status = fill(made, start, bone, weight);
    if (status == MOTE_OK)
        *skin = made;
    else
        mote_skin_free(made);
    return status;
}

/* One bone that moves all. */
static mote_status create_rigid(const mote_mesh *mesh, mote_skin **skin)
{
    const uint32_t n = mesh->vertex_count;
    mote_skin *made = allocate(mesh, 1, n);
    if (!made)
        return mote_fail(MOTE_ENOMEM, "no memory for a skin of %u vertices", n);
    made->most = 1;
    for (uint32_t v = 0; v < n; ++v) {
        made->start[v] = v;
        made->bone[v] = 0;
        made->weight[v] = 1;
    }
    made->start[n] = n;
    *skin = made;
    return MOTE_OK;
}

/* The field of a skin, which it owns; frees the skin when that fails. */
static mote_status create_field(const mote_mesh *mesh, mote_skin *skin, mote_field **field)
{
    const uint32_t targets = skin->morph.targets;
    mote_field *made;
    mote_status status = mote_field_allocate(targets ? &mote_morph_kind : &mote_skin_kind,
                                             mote_skin_functions(skin), &made);
    if (status != MOTE_OK) {
        mote_skin_free(skin);
        return status;
    }
    const size_t n = mesh->vertex_count;
    made->data = skin;
    made->numbers = targets;
    made->most = 4 * skin->most + (targets ? 3 + skin->morph.most : 0);
    made->bytes += sizeof *skin + (n + 1) * sizeof *skin->start +
                   skin->start[n] * (sizeof *skin->bone + sizeof *skin->weight);
    if (targets)
        made->bytes +=
            (n + 1) * sizeof *skin->morph.start +
            skin->morph.start[n] * (sizeof *skin->morph.target + sizeof *skin->morph.move) +
            targets * sizeof *skin->morph.size;
    *field = made;
    return MOTE_OK;
}

mote_status mote_field_create_skin(const mote_mesh *mesh, uint32_t bones, const uint32_t *start,
                                   const uint16_t *bone, const double *weight,
                                   mote_field **field)
{
    mote_skin *skin;
    mote_status status = check_input(mesh, bones, start, bone, weight);
    if (status == MOTE_OK)
        status = create_bones(mesh, bones, start, bone, weight, &skin);
    if (status == MOTE_OK)
        status = create_field(mesh, skin, field);
    return status;
}

mote_status mote_field_create_morphs(const mote_mesh *mesh, uint32_t bones,
                                     const uint32_t *start, const uint16_t *bone,
                                     const double *weight, const mote_morph_targets *targets,
                                     mote_field **field)
{
    mote_skin *skin;
    mote_status status = mote_morph_check(mesh, targets);
    if (status == MOTE_OK && bones > 0)
        status = check_input(mesh, bones, start, bone, weight);
    if (status == MOTE_OK)
        status = bones > 0 ? create_bones(mesh, bones, start, bone, weight, &skin)
                           : create_rigid(mesh, &skin);
    if (status != MOTE_OK)
        return status;
    status = mote_morph_fill(mesh, targets, &skin->morph);
    if (status != MOTE_OK) {
        mote_skin_free(skin);
        return status;
    }
    return create_field(mesh, skin, field);
}
