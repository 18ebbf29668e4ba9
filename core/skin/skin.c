#include "core/skin/skin.h"

#include "core/body/field_kinds.h"
#include "core/skin/skin_bounds.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define WHOLE 0x1p24 /* weights are integers times 1 / WHOLE */

/* (x - o) / s, and 1. No coordinate is larger than 1: s is more than half of L. */
static inline void local_position(const mote_skin *skin, mote_vec3 x, double q[4])
{
    const double inverse = 1 / skin->unit;
    q[0] = (x.x - skin->origin.x) * inverse;
    q[1] = (x.y - skin->origin.y) * inverse;
    q[2] = (x.z - skin->origin.z) * inverse;
    q[3] = 1;
}

static uint32_t skin_sparse(const mote_field *field, const mote_mesh *mesh, uint32_t vertex,
                            uint32_t *functions, double *phi)
{
    const mote_skin *skin = mote_skin_of(field);
    double q[4];
    local_position(skin, mesh->positions[vertex], q);
    uint32_t count = 0;
    for (uint32_t i = skin->start[vertex]; i < skin->start[vertex + 1]; ++i) {
        for (uint32_t k = 0; k < 4; ++k) {
            functions[count] = 4u * skin->bone[i] + k;
            phi[count++] = (double)skin->weight[i] * q[k];
        }
    }
    return count;
}

static void skin_basis(const mote_field *field, const mote_mesh *mesh, uint32_t vertex,
                       double *phi)
{
    const mote_skin *skin = mote_skin_of(field);
    double q[4];
    local_position(skin, mesh->positions[vertex], q);
    memset(phi, 0, field->padded * sizeof *phi);
    for (uint32_t i = skin->start[vertex]; i < skin->start[vertex + 1]; ++i) {
        for (size_t k = 0; k < 4; ++k)
            phi[(size_t)4 * skin->bone[i] + k] = (double)skin->weight[i] * q[k];
    }
}

/* A bone's four functions are in four lanes side by side: the first four or the last. */
MOTE_INLINE mote_vec3 displace(const mote_skin *skin, const mote_mesh *mesh, uint32_t vertex,
                               const mote_weights *weights)
{
    double q[4];
    local_position(skin, mesh->positions[vertex], q);
    double x[MOTE_LANES] = {0};
    double y[MOTE_LANES] = {0};
    double z[MOTE_LANES] = {0};
    for (uint32_t i = skin->start[vertex]; i < skin->start[vertex + 1]; ++i) {
        const size_t j = (size_t)4 * skin->bone[i];
        const size_t lane = j % MOTE_LANES;
        const double w = (double)skin->weight[i];
        MOTE_LANE_LOOP
        for (size_t k = 0; k < 4; ++k) {
            const double phi = w * q[k];
            x[lane + k] += phi * weights->x[j + k];
            y[lane + k] += phi * weights->y[j + k];
            z[lane + k] += phi * weights->z[j + k];
        }
    }
    return mote_vec3_make(mote_lane_sum(x), mote_lane_sum(y), mote_lane_sum(z));
}

MOTE_CLONES
static mote_vec3 skin_displacement(const mote_field *field, const mote_mesh *mesh,
                                   uint32_t vertex, const mote_weights *weights)
{
    return displace(mote_skin_of(field), mesh, vertex, weights);
}

MOTE_CLONES
static void skin_group(const mote_field *field, const mote_mesh *mesh,
                       const uint32_t vertices[MOTE_LANES], const mote_weights *weights,
                       double displacement[3][MOTE_LANES])
{
    for (size_t v = 0; v < MOTE_LANES; ++v) {
        const mote_vec3 d = displace(mote_skin_of(field), mesh, vertices[v], weights);
        displacement[0][v] = d.x;
        displacement[1][v] = d.y;
        displacement[2][v] = d.z;
    }
}

static void skin_displacement_single(const mote_field *field, const mote_mesh *mesh,
                                     uint32_t vertex, const mote_weights_single *weights,
                                     float displacement[3])
{
    const mote_skin *skin = mote_skin_of(field);
    double q[4];
    local_position(skin, mesh->positions[vertex], q);
    float x[MOTE_LANES] = {0};
    float y[MOTE_LANES] = {0};
    float z[MOTE_LANES] = {0};
    for (uint32_t i = skin->start[vertex]; i < skin->start[vertex + 1]; ++i) {
        const size_t j = (size_t)4 * skin->bone[i];
        const size_t lane = j % MOTE_LANES;
        for (size_t k = 0; k < 4; ++k) {
            const float phi = (float)((double)skin->weight[i] * q[k]);
            x[lane + k] += phi * weights->x[j + k];
            y[lane + k] += phi * weights->y[j + k];
            z[lane + k] += phi * weights->z[j + k];
        }
    }
    displacement[0] = mote_lane_sum_single(x);
    displacement[1] = mote_lane_sum_single(y);
    displacement[2] = mote_lane_sum_single(z);
}

static void free_skin(mote_skin *skin)
{
    if (!skin)
        return;
    free(skin->start);
    free(skin->bone);
    free(skin->weight);
    free(skin);
}

static void skin_destroy(mote_field *field)
{
    free_skin((mote_skin *)(uintptr_t)field->data);
    free(field);
}

static const mote_field_kind skin_kind = {.name = "skin",
                                          .basis = skin_basis,
                                          .sparse = skin_sparse,
                                          .displacement = skin_displacement,
                                          .displacement_single = skin_displacement_single,
                                          .group = skin_group,
                                          .bounds = &mote_skin_bounds,
                                          .destroy = skin_destroy};

const mote_skin *mote_field_skin(const mote_field *field)
{
    return field->kind == &skin_kind ? field->data : NULL;
}

/* --- making one -----------------------------------------------------------------------------
 */

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
    free_skin(skin);
    return NULL;
}

mote_status mote_field_create_skin(const mote_mesh *mesh, uint32_t bones, const uint32_t *start,
                                   const uint16_t *bone, const double *weight,
                                   mote_field **field)
{
    mote_status status = check_input(mesh, bones, start, bone, weight);
    mote_field *made = NULL;
    if (status == MOTE_OK)
        status = mote_field_allocate(&skin_kind, 4 * bones, &made);
    if (status != MOTE_OK)
        return status;
    const size_t given = start[mesh->vertex_count];
    mote_skin *skin = allocate(mesh, bones, given);
    made->data = skin;
    status = skin ? fill(skin, start, bone, weight)
                  : mote_fail(MOTE_ENOMEM, "no memory for %zu weights of a skin", given);
    if (status != MOTE_OK) {
        skin_destroy(made);
        return status;
    }
    made->most = 4 * skin->most;
    made->bytes += sizeof *skin + ((size_t)mesh->vertex_count + 1) * sizeof *skin->start +
                   given * (sizeof *skin->bone + sizeof *skin->weight);
    *field = made;
    return MOTE_OK;
}

void mote_skin_weights(const mote_field *field, const double (*matrices)[3][4],
                       const mote_mat3 *rotation, double *x, double *y, double *z)
{
    const mote_skin *skin = mote_skin_of(field);
    const mote_vec3 o = skin->origin;
    const double at[3] = {o.x, o.y, o.z};
    for (uint32_t b = 0; b < skin->bones; ++b) {
        const double(*m)[4] = matrices[b];
        for (size_t k = 0; k < 4; ++k) {
            double w[3];
            for (size_t r = 0; r < 3; ++r) {
                if (k < 3)
                    w[r] = skin->unit * (m[r][k] - (r == k ? 1 : 0));
                else
                    w[r] = (m[r][0] * o.x + m[r][1] * o.y + m[r][2] * o.z + m[r][3]) - at[r];
            }
            const mote_vec3 turned = mote_rotate(rotation, mote_vec3_make(w[0], w[1], w[2]));
            const size_t j = (size_t)4 * b + k;
            x[j] = turned.x;
            y[j] = turned.y;
            z[j] = turned.z;
        }
    }
    for (uint32_t j = field->count; j < field->padded; ++j)
        x[j] = y[j] = z[j] = 0;
}
