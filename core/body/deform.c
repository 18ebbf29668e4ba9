#include "core/body/deform.h"

#include <stdlib.h>
#include <string.h>

/* Vertices are kept in blocks of MOTE_LANES, padded with copies of the last one. A block is
   x[LANES], y[LANES], z[LANES] at rest, then phi_j[LANES] for each of the tabulated basis
   functions. Those of a sparse field are not tabulated, since almost all would be 0, nor those
   of a field without any: such displacements are evaluated. */
struct mote_deform {
    const mote_body *body;
    uint32_t blocks;
    uint32_t tabulated; /* basis functions in the table: padded, or 0 */
    size_t stride;      /* doubles in a block */
    double *table;      /* [blocks][stride]; NULL, with no blocks, where positions are given */
};

/* Whether displacements are evaluated rather than summed over a table. */
static bool evaluated(const mote_field *field)
{
    return field->kind->sparse || !field->kind->basis;
}

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
        if (deform->tabulated == 0)
            continue;
        field->kind->basis(field, mesh, vertex, phi);
        for (uint32_t j = 0; j < deform->tabulated; ++j)
            out[(3 + j) * MOTE_LANES + lane] = phi[j];
    }
}

mote_status mote_deform_create(const mote_body *body, mote_deform **deform)
{
    mote_deform *made = calloc(1, sizeof *made);
    if (!made)
        return mote_fail(MOTE_ENOMEM, "no memory to deform a body");
    made->body = body;
    if (mote_body_is_given(body)) {
        *deform = made;
        return MOTE_OK;
    }
    made->blocks = (body->mesh->vertex_count + MOTE_LANES - 1) / MOTE_LANES;
    made->tabulated = evaluated(body->field) ? 0 : body->field->padded;
    made->stride = (size_t)MOTE_LANES * (3 + made->tabulated);
    /* The stride is a multiple of 64 bytes, so that every row is aligned. */
    made->table = aligned_alloc(64, made->blocks * made->stride * sizeof(double));
    double *phi = malloc(((size_t)made->tabulated + 1) * sizeof *phi);
    if (!made->table || !phi) {
        free(phi);
        mote_deform_destroy(made);
        return mote_fail(MOTE_ENOMEM, "no memory for the basis values of %u vertices",
                         body->mesh->vertex_count);
    }
    for (uint32_t block = 0; block < made->blocks; ++block)
        fill_block(made, block, phi);
    free(phi);
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

/* The displacements of a block's vertices. The lanes of each vertex's sum are kept apart, and
   added in the order of mote_lane_sum. */
MOTE_INLINE void sum_block(const double *phi, const mote_weights *weights, uint32_t padded,
                           double sum[3][MOTE_LANES])
{
    double lane[3][MOTE_LANES][MOTE_LANES]; /* [coordinate][lane of the sum][vertex] */
    for (size_t l = 0; l < MOTE_LANES; ++l) {
        double x[MOTE_LANES] = {0};
        double y[MOTE_LANES] = {0};
        double z[MOTE_LANES] = {0};
        for (size_t j = l; j < padded; j += MOTE_LANES) {
            const double wx = weights->x[j];
            const double wy = weights->y[j];
            const double wz = weights->z[j];
            MOTE_LANE_LOOP
            for (size_t v = 0; v < MOTE_LANES; ++v) {
                const double value = phi[j * MOTE_LANES + v];
                x[v] += value * wx;
                y[v] += value * wy;
                z[v] += value * wz;
            }
        }
        memcpy(lane[0][l], x, sizeof x);
        memcpy(lane[1][l], y, sizeof y);
        memcpy(lane[2][l], z, sizeof z);
    }
    for (int c = 0; c < 3; ++c) {
        MOTE_LANE_LOOP
        for (size_t v = 0; v < MOTE_LANES; ++v)
            sum[c][v] = ((lane[c][0][v] + lane[c][4][v]) + (lane[c][2][v] + lane[c][6][v])) +
                        ((lane[c][1][v] + lane[c][5][v]) + (lane[c][3][v] + lane[c][7][v]));
    }
}

/* The same without a table. */
static void evaluate_block(const mote_deform *deform, uint32_t block,
                           const mote_weights *weights, double sum[3][MOTE_LANES])
{
    const mote_mesh *mesh = deform->body->mesh;
    const mote_field *field = deform->body->field;
    uint32_t vertices[MOTE_LANES];
    for (uint32_t l = 0; l < MOTE_LANES; ++l) {
        const uint32_t v = block * MOTE_LANES + l;
        vertices[l] = v < mesh->vertex_count ? v : mesh->vertex_count - 1;
    }
    if (field->kind->group) {
        field->kind->group(field, mesh, vertices, weights, sum);
        return;
    }
    for (size_t l = 0; l < MOTE_LANES; ++l) {
        const mote_vec3 d = mote_field_displacement(field, mesh, vertices[l], weights);
        sum[0][l] = d.x;
        sum[1][l] = d.y;
        sum[2][l] = d.z;
    }
}

/* The rotation and translation of a block's vertices, as mote_pose_apply does it. */
MOTE_INLINE void move_block(const double *rest, const mote_pose *pose,
                            double world[3][MOTE_LANES])
{
    const double translation[3] = {pose->translation.x, pose->translation.y,
                                   pose->translation.z};
    for (int c = 0; c < 3; ++c) {
        const double *row = pose->rotation.m[c];
        MOTE_LANE_LOOP
        for (size_t v = 0; v < MOTE_LANES; ++v)
            world[c][v] = row[0] * rest[v] + row[1] * rest[MOTE_LANES + v] +
                          row[2] * rest[2 * MOTE_LANES + v] + translation[c];
    }
}

MOTE_CLONES
void mote_deform_all(const mote_deform *deform, const mote_body_state *state, mote_vec3 *world)
{
    const uint32_t count = deform->body->mesh->vertex_count;
    const uint32_t padded = deform->tabulated;
    const bool evaluate = evaluated(deform->body->field);
    if (mote_body_is_given(deform->body)) {
        memcpy(world, state->vertices, count * sizeof *world);
        return;
    }
    for (uint32_t b = 0; b < deform->blocks; ++b) {
        const double *block = deform->table + b * deform->stride;
        double p[3][MOTE_LANES];
        move_block(block, &state->pose, p);
        if (padded > 0 || evaluate) {
            double sum[3][MOTE_LANES];
            if (evaluate)
                evaluate_block(deform, b, &state->weights, sum);
            else
                sum_block(block + 3 * MOTE_LANES, &state->weights, padded, sum);
            for (int c = 0; c < 3; ++c) {
                MOTE_LANE_LOOP
                for (size_t v = 0; v < MOTE_LANES; ++v)
                    p[c][v] += sum[c][v];
            }
        }
        const uint32_t first = b * MOTE_LANES;
        const uint32_t used = count - first < MOTE_LANES ? count - first : MOTE_LANES;
        for (size_t v = 0; v < used; ++v)
            world[first + v] = mote_vec3_make(p[0][v], p[1][v], p[2][v]);
    }
}

size_t mote_deform_bytes(const mote_deform *deform)
{
    return sizeof *deform + deform->blocks * deform->stride * sizeof(double);
}
