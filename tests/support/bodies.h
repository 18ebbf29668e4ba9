/* Bodies of every kind of field with random states, for tests. */
#ifndef MOTE_TESTS_BODIES_H
#define MOTE_TESTS_BODIES_H

#include "core/skin/skin.h"

#include "tests/support/solids.h"

typedef struct test_body {
    mote_mesh *mesh;
    mote_field *field;
    mote_body body;
    double weights[3][MOTE_FIELD_SUMMED];
} test_body;

/* Takes ownership of the mesh. count: CSRBF centres near the mesh (support: half of L), or,
   when negative, -count linear modes; 0 is a static field. */
static inline void test_body_init(test_body *b, mote_mesh *mesh, int count, uint64_t *seed)
{
    b->mesh = mesh;
    mote_status status = MOTE_OK;
    const double half = 0.5 * mesh->diagonal;
    if (count > 0) {
        mote_vec3 centres[MOTE_FIELD_SUMMED];
        for (int j = 0; j < count; ++j) {
            const uint32_t v = (uint32_t)(random_bits(seed) % mesh->vertex_count);
            centres[j] = mote_add(mesh->positions[v], random_vec3(seed, 0.2 * half));
        }
        status = mote_field_create_csrbf(centres, (uint32_t)count, half, &b->field);
    } else if (count < 0) {
        const size_t size = (size_t)-count * mesh->vertex_count;
        mote_vec3 *modes = malloc(size * sizeof *modes);
        assert_non_null(modes);
        for (size_t i = 0; i < size; ++i)
            modes[i] = random_vec3(seed, 0.1 * half);
        status =
            mote_field_create_modes(modes, (uint32_t)-count, mesh->vertex_count, &b->field);
        free(modes);
    } else {
        status = mote_field_create_static(&b->field);
    }
    if (status != MOTE_OK)
        fail_msg("%s", mote_error_text());
    b->body = (mote_body){.mesh = b->mesh, .field = b->field};
}

static inline void test_body_free(test_body *b)
{
    mote_field_destroy(b->field);
    mote_mesh_destroy(b->mesh);
}

/* A random pose and random weights up to size; the weights live in b until the next call. */
static inline mote_body_state test_body_state(test_body *b, double size, uint64_t *seed)
{
    memset(b->weights, 0, sizeof b->weights);
    for (uint32_t j = 0; j < b->field->count; ++j) {
        for (int c = 0; c < 3; ++c)
            b->weights[c][j] = random_between(seed, -size, size);
    }
    mote_body_state state = {.shape_changed = true, .pose_changed = true};
    state.pose.rotation = random_rotation_matrix(seed);
    state.pose.translation = random_vec3(seed, size);
    state.weights = (mote_weights){b->weights[0], b->weights[1], b->weights[2], b->field->count,
                                   b->field->padded};
    return state;
}

/* Skins. Their numbers use only arithmetic that every machine rounds alike. */
enum { SKIN_EACH = 3, SKIN_BONES_MOST = 16, SKIN_TARGETS_MOST = 8 };

/* Displacements of targets, each of a third of the vertices. */
static inline void skin_body_targets(const mote_mesh *mesh, uint32_t count, uint64_t *seed,
                                     uint32_t *start, uint32_t *vertex, mote_vec3 *move)
{
    uint32_t end = 0;
    for (uint32_t k = 0; k < count; ++k) {
        start[k] = end;
        for (uint32_t v = k % 3; v < mesh->vertex_count; v += 3) {
            vertex[end] = v;
            move[end++] = random_vec3(seed, 0.05 * mesh->diagonal);
        }
    }
    start[count] = end;
}

/* Takes ownership of the mesh. bones may be 0 if there are targets; both stay below the enum's
   limits. */
static inline void skin_body_init(test_body *b, mote_mesh *mesh, uint32_t bones,
                                  uint32_t targets, uint64_t *seed)
{
    const uint32_t n = mesh->vertex_count;
    uint32_t *start = malloc((n + 1) * sizeof *start);
    uint16_t *bone = malloc(SKIN_EACH * n * sizeof *bone);
    double *weight = malloc(SKIN_EACH * n * sizeof *weight);
    uint32_t *vertex = malloc((targets + 1) * n * sizeof *vertex);
    mote_vec3 *move = malloc((targets + 1) * n * sizeof *move);
    uint32_t begin[SKIN_TARGETS_MOST + 1];
    if (!start || !bone || !weight || !vertex || !move)
        fail_msg("no memory");
    for (uint32_t i = 0; i < SKIN_EACH * n; ++i) {
        start[i / SKIN_EACH] = i / SKIN_EACH * SKIN_EACH;
        bone[i] = (uint16_t)(bones ? random_bits(seed) % bones : 0);
        weight[i] = random_between(seed, 0.1, 1);
    }
    start[n] = SKIN_EACH * n;
    skin_body_targets(mesh, targets, seed, begin, vertex, move);
    const mote_morph_targets all = {targets, begin, vertex, move};
    const mote_status status =
        targets ? mote_field_create_morphs(mesh, bones, start, bone, weight, &all, &b->field)
                : mote_field_create_skin(mesh, bones, start, bone, weight, &b->field);
    if (status != MOTE_OK)
        fail_msg("%s", mote_error_text());
    free(start);
    free(bone);
    free(weight);
    free(vertex);
    free(move);
    b->mesh = mesh;
    b->body = (mote_body){.mesh = mesh, .field = b->field};
}

/* A random pose, bones that are off rest by up to size, and amounts up to 1. */
static inline mote_body_state skin_body_state(test_body *b, double size, uint64_t *seed)
{
    double matrices[SKIN_BONES_MOST][3][4];
    double amounts[SKIN_TARGETS_MOST];
    for (int i = 0; i < SKIN_BONES_MOST * 12; ++i) {
        const int r = i / 4 % 3, c = i % 4;
        matrices[i / 12][r][c] = (r == c ? 1 : 0) + random_between(seed, -size, size);
    }
    for (int k = 0; k < SKIN_TARGETS_MOST; ++k)
        amounts[k] = random_between(seed, -1, 1);
    mote_body_state state = test_body_state(b, size, seed);
    mote_morph_weights(b->field, (const double(*)[3][4])matrices, amounts, &state.pose.rotation,
                       b->weights[0], b->weights[1], b->weights[2]);
    return state;
}

#endif
