#include "core/skin/skin.h"

#include "core/body/field_kinds.h"
#include "core/skin/skin_bounds.h"
#include "core/skin/skin_kinds.h"

#include <stdlib.h>
#include <string.h>

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

/* What the morph targets move a vertex by, for the weights of a frame. */
MOTE_INLINE mote_vec3 morphed_by(const mote_skin *skin, uint32_t vertex,
                                 const mote_weights *weights)
{
    const mote_morph *morph = &skin->morph;
    const double *amount = weights->x + mote_morph_first(skin);
    mote_vec3 d = {0, 0, 0};
    for (uint32_t i = morph->start[vertex]; i < morph->start[vertex + 1]; ++i) {
        const double m = amount[morph->target[i]];
        d.x += m * (double)morph->move[i][0];
        d.y += m * (double)morph->move[i][1];
        d.z += m * (double)morph->move[i][2];
    }
    return d;
}

/* By the bones, of a vertex that is at x before they move it. A bone's four functions are in
   four lanes side by side: the first four or the last. */
MOTE_INLINE mote_vec3 displace(const mote_skin *skin, mote_vec3 at, uint32_t vertex,
                               const mote_weights *weights)
{
    double q[4];
    local_position(skin, at, q);
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

/* With M_b x = R x + t + W_b (x, 1) in the world, and d what the targets move the vertex by,
       sum_b w_b M_b (x + d) = R x + t + R d + sum_b w_b W_b (x + d, 1). */
MOTE_INLINE mote_vec3 morph(const mote_skin *skin, const mote_mesh *mesh, uint32_t vertex,
                            const mote_weights *weights)
{
    const mote_vec3 d = morphed_by(skin, vertex, weights);
    const mote_vec3 posed =
        displace(skin, mote_add(mesh->positions[vertex], d), vertex, weights);
    const size_t r = (size_t)4 * skin->bones; /* the columns of R */
    const double *x = weights->x + r;
    const double *y = weights->y + r;
    const double *z = weights->z + r;
    return mote_add(posed, mote_vec3_make(x[0] * d.x + x[1] * d.y + x[2] * d.z,
                                          y[0] * d.x + y[1] * d.y + y[2] * d.z,
                                          z[0] * d.x + z[1] * d.y + z[2] * d.z));
}

MOTE_CLONES
static mote_vec3 skin_displacement(const mote_field *field, const mote_mesh *mesh,
                                   uint32_t vertex, const mote_weights *weights)
{
    return displace(mote_skin_of(field), mesh->positions[vertex], vertex, weights);
}

MOTE_CLONES
static mote_vec3 morph_displacement(const mote_field *field, const mote_mesh *mesh,
                                    uint32_t vertex, const mote_weights *weights)
{
    return morph(mote_skin_of(field), mesh, vertex, weights);
}

MOTE_INLINE void store(mote_vec3 d, size_t v, double displacement[3][MOTE_LANES])
{
    displacement[0][v] = d.x;
    displacement[1][v] = d.y;
    displacement[2][v] = d.z;
}

MOTE_CLONES
static void skin_group(const mote_field *field, const mote_mesh *mesh,
                       const uint32_t vertices[MOTE_LANES], const mote_weights *weights,
                       double displacement[3][MOTE_LANES])
{
    for (size_t v = 0; v < MOTE_LANES; ++v)
        store(displace(mote_skin_of(field), mesh->positions[vertices[v]], vertices[v], weights),
              v, displacement);
}

MOTE_CLONES
static void morph_group(const mote_field *field, const mote_mesh *mesh,
                        const uint32_t vertices[MOTE_LANES], const mote_weights *weights,
                        double displacement[3][MOTE_LANES])
{
    for (size_t v = 0; v < MOTE_LANES; ++v)
        store(morph(mote_skin_of(field), mesh, vertices[v], weights), v, displacement);
}

static void displace_single(const mote_skin *skin, mote_vec3 at, uint32_t vertex,
                            const mote_weights_single *weights, float displacement[3])
{
    double q[4];
    local_position(skin, at, q);
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

static void skin_displacement_single(const mote_field *field, const mote_mesh *mesh,
                                     uint32_t vertex, const mote_weights_single *weights,
                                     float displacement[3])
{
    displace_single(mote_skin_of(field), mesh->positions[vertex], vertex, weights,
                    displacement);
}

static void morph_displacement_single(const mote_field *field, const mote_mesh *mesh,
                                      uint32_t vertex, const mote_weights_single *weights,
                                      float displacement[3])
{
    const mote_skin *skin = mote_skin_of(field);
    const mote_morph *morph = &skin->morph;
    const float *amount = weights->x + mote_morph_first(skin);
    float d[3] = {0, 0, 0};
    for (uint32_t i = morph->start[vertex]; i < morph->start[vertex + 1]; ++i) {
        for (size_t c = 0; c < 3; ++c)
            d[c] += amount[morph->target[i]] * morph->move[i][c];
    }
    const mote_vec3 moved = {(double)d[0], (double)d[1], (double)d[2]};
    displace_single(skin, mote_add(mesh->positions[vertex], moved), vertex, weights,
                    displacement);
    const float *const w[3] = {weights->x, weights->y, weights->z};
    for (size_t r = 0; r < 3; ++r) {
        const float *row = w[r] + (size_t)4 * skin->bones;
        displacement[r] += row[0] * d[0] + row[1] * d[1] + row[2] * d[2];
    }
}

void mote_skin_free(mote_skin *skin)
{
    free(skin->start);
    free(skin->bone);
    free(skin->weight);
    free(skin->morph.start);
    free(skin->morph.target);
    free(skin->morph.move);
    free(skin->morph.size);
    free(skin);
}

static void skin_destroy(mote_field *field)
{
    mote_skin_free((mote_skin *)(uintptr_t)field->data);
    free(field);
}

const mote_field_kind mote_skin_kind = {.name = "skin",
                                        .basis = skin_basis,
                                        .sparse = skin_sparse,
                                        .displacement = skin_displacement,
                                        .displacement_single = skin_displacement_single,
                                        .group = skin_group,
                                        .bounds = &mote_skin_bounds,
                                        .destroy = skin_destroy};

const mote_field_kind mote_morph_kind = {.name = "morphs",
                                         .displacement = morph_displacement,
                                         .displacement_single = morph_displacement_single,
                                         .group = morph_group,
                                         .bounds = &mote_skin_bounds,
                                         .destroy = skin_destroy};

const mote_skin *mote_field_skin(const mote_field *field)
{
    const bool own = field->kind == &mote_skin_kind || field->kind == &mote_morph_kind;
    return own ? mote_skin_of(field) : NULL;
}

/* The weights of bone b. */
static void write_bone(const mote_skin *skin, uint32_t b, const double m[3][4],
                       const mote_mat3 *rotation, double *const by[3])
{
    const mote_vec3 o = skin->origin;
    const double at[3] = {o.x, o.y, o.z};
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
        by[0][j] = turned.x;
        by[1][j] = turned.y;
        by[2][j] = turned.z;
    }
}

void mote_morph_weights(const mote_field *field, const double (*matrices)[3][4],
                        const double *amounts, const mote_mat3 *rotation, double *x, double *y,
                        double *z)
{
    const mote_skin *skin = mote_skin_of(field);
    double *const by[3] = {x, y, z};
    for (size_t r = 0; r < 3; ++r)
        memset(by[r], 0, field->padded * sizeof *by[r]);
    for (uint32_t b = 0; matrices && b < skin->bones; ++b)
        write_bone(skin, b, matrices[b], rotation, by);
    const mote_morph *morph = &skin->morph;
    if (morph->targets == 0)
        return;
    for (size_t r = 0; r < 3; ++r)
        memcpy(by[r] + (size_t)4 * skin->bones, rotation->m[r], sizeof rotation->m[r]);
    for (uint32_t k = 0; amounts && k < morph->targets; ++k)
        x[mote_morph_first(skin) + k] = amounts[k] * morph->size[k];
}

void mote_skin_weights(const mote_field *field, const double (*matrices)[3][4],
                       const mote_mat3 *rotation, double *x, double *y, double *z)
{
    mote_morph_weights(field, matrices, NULL, rotation, x, y, z);
}
