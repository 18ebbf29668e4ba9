#include "core/deform.h"

#include <stdlib.h>

/* Vertices are kept in blocks of MOTE_LANES, padded with copies of the last one. A block is
   x[LANES], y[LANES], z[LANES] at rest, then phi_j[LANES] for each of the padded basis
   functions. */
struct mote_deform {
    const mote_body *body;
    uint32_t blocks;
    size_t stride; /* doubles a block */
    double *table; /* [blocks][stride] */
};

static void fill_block(mote_deform *deform, uint32_t block, double *phi)
{
    const mote_mesh *mesh = deform->body->mesh;
    const mote_field *field = deform->body->field;
    double *out = deform->table + block * deform->stride;
    for (uint32_t lane = 0; lane < MOTE_LANES; ++lane) {
        uint32_t vertex = block * MOTE_LANES + lane;
        if (vertex >= mesh->vertex_count)
            vertex = mesh->vertex_count - 1;
        const mote_vec3 p = mesh->positions[vertex];
        out[lane] = p.x;
        out[MOTE_LANES + lane] = p.y;
        out[2 * MOTE_LANES + lane] = p.z;
        field->kind->basis(field, mesh, vertex, phi);
        for (uint32_t j = 0; j < field->padded; ++j)
            out[(3 + j) * MOTE_LANES + lane] = phi[j];
    }
}

mote_status mote_deform_create(const mote_body *body, mote_deform **deform)
{
    mote_deform *made = calloc(1, sizeof *made);
    if (!made)
        return mote_fail(MOTE_ENOMEM, "no memory to deform a body");
    made->body = body;
    made->blocks = (body->mesh->vertex_count + MOTE_LANES - 1) / MOTE_LANES;
    made->stride = (size_t)MOTE_LANES * (3 + body->field->padded);
    /* The stride is a multiple of 64 bytes, so that every row is aligned. */
    made->table = aligned_alloc(64, made->blocks * made->stride * sizeof(double));
    if (!made->table) {
        free(made);
        return mote_fail(MOTE_ENOMEM, "no memory for the basis values of %u vertices",
                         body->mesh->vertex_count);
    }
    double phi[MOTE_FIELD_MAX];
    for (uint32_t block = 0; block < made->blocks; ++block)
        fill_block(made, block, phi);
    *deform = made;
    return MOTE_OK;
}

void mote_deform_destroy(mote_deform *deform)
{
    if (!deform)
        return;
    free(deform->table);
    free(deform);
}

/* One world coordinate of a block: the rotation's row, the translation and the weights'
   coordinate, in the order of mote_body_position. */
static inline void deform_coordinate(const double *block, const double row[3],
                                     double translation, const double *weights, uint32_t padded,
                                     double out[MOTE_LANES])
{
    const double *phi = block + 3 * MOTE_LANES;
    double lane[MOTE_LANES][MOTE_LANES] = {{0}}; /* [lane of the sum][vertex] */
    for (uint32_t j = 0; j < padded; j += MOTE_LANES) {
        for (uint32_t l = 0; l < MOTE_LANES; ++l) {
            const double w = weights[j + l];
            MOTE_LANE_LOOP
            for (uint32_t v = 0; v < MOTE_LANES; ++v)
                lane[l][v] += phi[(j + l) * MOTE_LANES + v] * w;
        }
    }
    MOTE_LANE_LOOP
    for (uint32_t v = 0; v < MOTE_LANES; ++v) {
        const double sum = ((lane[0][v] + lane[4][v]) + (lane[2][v] + lane[6][v])) +
                           ((lane[1][v] + lane[5][v]) + (lane[3][v] + lane[7][v]));
        const double rigid = row[0] * block[v] + row[1] * block[MOTE_LANES + v] +
                             row[2] * block[2 * MOTE_LANES + v] + translation;
        out[v] = padded > 0 ? rigid + sum : rigid;
    }
}

MOTE_CLONES
void mote_deform_all(const mote_deform *deform, const mote_body_state *state, mote_vec3 *world)
{
    const uint32_t count = deform->body->mesh->vertex_count;
    const uint32_t padded = deform->body->field->padded;
    const mote_pose *pose = &state->pose;
    const mote_weights *w = &state->weights;
    for (uint32_t b = 0; b < deform->blocks; ++b) {
        const double *block = deform->table + b * deform->stride;
        double x[MOTE_LANES];
        double y[MOTE_LANES];
        double z[MOTE_LANES];
        deform_coordinate(block, pose->rotation.m[0], pose->translation.x, w->x, padded, x);
        deform_coordinate(block, pose->rotation.m[1], pose->translation.y, w->y, padded, y);
        deform_coordinate(block, pose->rotation.m[2], pose->translation.z, w->z, padded, z);
        const uint32_t first = b * MOTE_LANES;
        const uint32_t used = count - first < MOTE_LANES ? count - first : MOTE_LANES;
        for (uint32_t v = 0; v < used; ++v)
            world[first + v] = mote_vec3_make(x[v], y[v], z[v]);
    }
}

size_t mote_deform_bytes(const mote_deform *deform)
{
    return sizeof *deform + deform->blocks * deform->stride * sizeof(double);
}
