/* Bodies of every kind of field with random states, for tests. */
#ifndef MOTE_TESTS_BODIES_H
#define MOTE_TESTS_BODIES_H

#include "core/body/body.h"

#include "tests/support/solids.h"

typedef struct test_body {
    mote_mesh *mesh;
    mote_field *field;
    mote_body body;
    double weights[3][MOTE_FIELD_SUMMED];
} test_body;

/* Takes the mesh. count: CSRBF centres near the mesh (support: half of L), or, when negative,
   -count linear modes; 0 is a static field. */
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

#endif
