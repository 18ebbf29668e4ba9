/* How skins and morph targets are created, and what they refuse. */
#include "core/certificate/certificate_tree.h"
#include "core/skin/skin.h"
#include "tests/support/shapes.h"
#include "tests/support/test.h"

#include <float.h>

static void expect_error(const mote_mesh *mesh, uint32_t bones, const uint32_t *start,
                         const uint16_t *bone, const double *weight, const char *text)
{
    mote_field mark;
    mote_field *field = &mark;
    assert_int_equal(mote_field_create_skin(mesh, bones, start, bone, weight, &field),
                     MOTE_EINVAL);
    assert_string_equal(mote_error_text(), text);
    assert_ptr_equal(field, &mark);
}

TEST(create_skin_with_bad_input_says_what)
{
    mote_mesh *mesh = make_torus(3, 3, 1);
    uint32_t start[10];
    uint16_t bone[9] = {0, 1, 0, 1, 0, 1, 0, 1, 0};
    double weight[9] = {1, 1, 1, 1, 1, 1, 1, 1, 1};
    assert_int_equal(mesh->vertex_count, 9);
    for (uint32_t v = 0; v < 10; ++v)
        start[v] = v;
    expect_error(mesh, 0, start, bone, weight, "a skin has 1 to 65535 bones, not 0");
    expect_error(mesh, 65536, start, bone, weight, "a skin has 1 to 65535 bones, not 65536");
    expect_error(mesh, 1, start, bone, weight, "vertex 1 follows bone 1 of 1, counted from 0");
    weight[2] = -0.5;
    expect_error(mesh, 2, start, bone, weight,
                 "vertex 2 has the weight -0.5; it must be finite and not negative");
    weight[2] = HUGE_VAL;
    expect_error(mesh, 2, start, bone, weight,
                 "vertex 2 has the weight inf; it must be finite and not negative");
    weight[2] = 0;
    expect_error(mesh, 2, start, bone, weight,
                 "the weights of vertex 2 add up to 0; their sum must be positive and finite");
    weight[2] = 1;
    start[1] = 2;
    weight[0] = weight[1] = 1e308;
    expect_error(mesh, 2, start, bone, weight,
                 "the weights of vertex 0 add up to inf; their sum must be positive and "
                 "finite");
    weight[0] = weight[1] = 1;
    start[1] = 1;
    start[4] = 3;
    expect_error(mesh, 2, start, bone, weight, "vertex 3 has no bone; it needs at least one");
    start[4] = 4;
    start[0] = 1;
    expect_error(mesh, 2, start, bone, weight, "the weights of vertex 0 start at 1, not at 0");
    mote_mesh_destroy(mesh);
}

/* Several weights of a bone are added up, tiny ones are dropped, and the sum is exactly 1. */
TEST(weights_are_merged_and_normalised)
{
    mote_mesh *mesh = make_torus(3, 3, 1);
    uint32_t start[10];
    uint16_t bone[36];
    double weight[36];
    for (uint32_t v = 0; v < 9; ++v) {
        const uint16_t b[4] = {7, 2, 7, 5};
        const double w[4] = {0.2, 0.4, 0.3, 1e-9};
        start[v] = 4 * v;
        memcpy(bone + 4 * v, b, sizeof b);
        memcpy(weight + 4 * v, w, sizeof w);
    }
    start[9] = 36;
    mote_field *field = NULL;
    assert_int_equal(mote_field_create_skin(mesh, 8, start, bone, weight, &field), MOTE_OK);
    const mote_skin *skin = mote_field_skin(field);
    assert_true(fabs(skin->off - 0.1) < 1e-8);
    assert_int_equal(skin->most, 2);
    assert_int_equal(skin->start[9], 18);
    assert_int_equal(skin->bone[16], 2);
    assert_int_equal(skin->bone[17], 7);
    assert_true(fabs((double)skin->weight[16] - 4 / 9.0) < 1e-6);
    assert_true((double)skin->weight[16] + (double)skin->weight[17] == 1.0);
    assert_int_equal(field->count, 32);
    assert_int_equal(field->most, 8);
    assert_int_equal(field->bytes,
                     sizeof *field + sizeof *skin + 10 * sizeof(uint32_t) + 18 * 6);
    assert_string_equal(field->kind->name, "skin");
    mote_field_destroy(field);
    mote_field *still = NULL;
    assert_int_equal(mote_field_create_static(&still), MOTE_OK);
    assert_null(mote_field_skin(still));
    mote_field_destroy(still);
    mote_mesh_destroy(mesh);
}

/* The field of targets alone. */
static mote_field *morphs_of(const mote_mesh *mesh, const mote_morph_targets *targets)
{
    mote_field *field = NULL;
    assert_int_equal(mote_field_create_morphs(mesh, 0, NULL, NULL, NULL, targets, &field),
                     MOTE_OK);
    return field;
}

static void expect_morphs_error(const mote_mesh *mesh, uint32_t bones, const uint32_t *start,
                                const uint16_t *bone, const double *weight,
                                const mote_morph_targets *targets, const char *text)
{
    mote_field mark;
    mote_field *field = &mark;
    assert_int_equal(
        mote_field_create_morphs(mesh, bones, start, bone, weight, targets, &field),
        MOTE_EINVAL);
    assert_string_equal(mote_error_text(), text);
    assert_ptr_equal(field, &mark);
}

/* Targets with one error each. */
typedef struct bad_targets {
    uint32_t count, start[3], vertex[3];
    mote_vec3 move[3];
    const char *text;
} bad_targets;

static const bad_targets bad[] = {
    {0, {0, 0, 0}, {0}, {{0, 0, 0}}, "there are 1 to 65535 morph targets, not 0"},
    {65536, {0, 0, 0}, {0}, {{0, 0, 0}}, "there are 1 to 65535 morph targets, not 65536"},
    {1, {1, 2, 0}, {0}, {{0, 0, 0}}, "morph target 0 starts at 1, not at 0"},
    {2, {0, 3, 2}, {0, 1, 2}, {{0, 0, 0}}, "morph target 1 ends at 2, before its start at 3"},
    {2,
     {0, 1, 2},
     {0, 9, 0},
     {{0, 0, 0}},
     "morph target 1 moves vertex 9 of 9, counted from 0"},
    {2,
     {0, 1, 2},
     {10, 0, 0},
     {{0, 0, 0}},
     "morph target 0 moves vertex 10 of 9, counted from 0"},
    {1, {0, 2, 0}, {3, 3, 0}, {{0, 0, 0}}, "morph target 0 names vertex 3 twice"},
    {1,
     {0, 1, 0},
     {5, 0, 0},
     {{0, HUGE_VAL, 0}},
     "morph target 0 moves vertex 5 by (0, inf, 0); it must be finite"},
    {1,
     {0, 1, 0},
     {5, 0, 0},
     {{0, 0, -HUGE_VAL}},
     "morph target 0 moves vertex 5 by (0, 0, -inf); it must be finite"},
};

TEST(create_morphs_with_bad_input_says_what)
{
    mote_mesh *mesh = make_torus(3, 3, 1);
    for (size_t i = 0; i < ROWS_OF(bad); ++i) {
        const mote_morph_targets targets = {bad[i].count, bad[i].start, bad[i].vertex,
                                            bad[i].move};
        test_row("%s", bad[i].text);
        expect_morphs_error(mesh, 0, NULL, NULL, NULL, &targets, bad[i].text);
    }
    mote_mesh_destroy(mesh);
}

TEST(create_morphs_with_bad_bones_says_what)
{
    mote_mesh *mesh = make_torus(3, 3, 1);
    uint32_t start[10];
    uint16_t bone[9] = {0};
    double weight[9] = {1, 1, 1, 1, -1, 1, 1, 1, 1};
    for (uint32_t v = 0; v < 10; ++v)
        start[v] = v;
    static const uint32_t first[2] = {0, 1}, vertex[1] = {2};
    static const mote_vec3 move[1] = {{1, 0, 0}};
    const mote_morph_targets targets = {1, first, vertex, move};
    for (uint32_t bones = 1; bones < 3; ++bones)
        expect_morphs_error(mesh, bones, start, bone, weight, &targets,
                            "vertex 4 has the weight -1; it must be finite and not negative");
    mote_mesh_destroy(mesh);
}

/* Displacements are sorted by vertex, zeros are dropped, and sizes are powers of two, or 0. */
TEST(targets_are_ordered_by_vertex)
{
    mote_mesh *mesh = make_torus(3, 3, 1);
    static const uint32_t start[4] = {0, 3, 3, 5}, vertex[5] = {7, 2, 4, 2, 8};
    static const mote_vec3 move[5] = {
        {3, 0, 0}, {0, -1, 0}, {0, 0, 0}, {1e-9, 0, 3e-10}, {0, 0, 0}};
    const mote_morph_targets targets = {3, start, vertex, move};
    mote_field *field = morphs_of(mesh, &targets);
    const mote_skin *skin = mote_field_skin(field);
    assert_non_null(skin);
    assert_int_equal(skin->bones, 1);
    assert_int_equal(skin->most, 1);
    const mote_morph *morph = &skin->morph;
    assert_int_equal(morph->start[9], 3);
    assert_int_equal(morph->most, 2);
    assert_int_equal(morph->start[2], 0);
    assert_int_equal(morph->start[3], 2);
    assert_int_equal(morph->target[0], 0);
    assert_int_equal(morph->target[1], 2);
    assert_true(morph->size[0] == 2.0);
    assert_true(morph->size[1] == 0.0); /* it moves nothing */
    assert_true((double)morph->move[0][1] == -0.5);
    assert_true((double)morph->move[2][0] == 1.5);
    assert_true(fabs((double)morph->move[1][2] * morph->size[2] - 3e-10) < 1e-16);
    assert_string_equal(field->kind->name, "morphs");
    assert_int_equal(field->count, 4 + 3 + 3);
    mote_field_destroy(field);
    mote_mesh_destroy(mesh);
}

/* Each target moves vertex 8 along one axis, and the middle two move vertex 5 as well. */
TEST(targets_along_one_axis_are_kept_and_counted)
{
    mote_mesh *mesh = make_torus(3, 3, 1);
    static const uint32_t start[5] = {0, 1, 3, 5, 6}, vertex[6] = {8, 8, 5, 8, 5, 8};
    static const mote_vec3 move[6] = {{1, 0, 0}, {0, 1, 0},  {0, -1, 0},
                                      {0, 0, 1}, {0, 0, -1}, {-1, 0, 0}};
    const mote_morph_targets targets = {4, start, vertex, move};
    mote_field *field = morphs_of(mesh, &targets);
    const mote_skin *skin = mote_field_skin(field);
    const mote_morph *morph = &skin->morph;
    static const float of_5[2][3] = {{0, -1, 0}, {0, 0, -1}};
    static const float of_8[4][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}};
    assert_int_equal(morph->start[9], 6);
    assert_int_equal(morph->most, 4);
    assert_memory_equal(morph->move[morph->start[5]], of_5, sizeof of_5);
    assert_memory_equal(morph->move[morph->start[8]], of_8, sizeof of_8);
    assert_int_equal(field->most, 4 + 3 + 4);
    const size_t bones = 10 * sizeof(uint32_t) + 9 * 6;
    const size_t moves = 10 * sizeof(uint32_t) + 6 * 14 + 4 * sizeof(double);
    assert_int_equal(field->bytes, sizeof *field + sizeof *skin + bones + moves);
    mote_field_destroy(field);
    mote_mesh_destroy(mesh);
}

/* A skin made for one mesh does not bound another. */
TEST(tree_of_another_mesh_is_refused)
{
    mote_mesh *own = make_torus(4, 3, 1), *other = make_torus(4, 3, 2),
              *more = make_torus(5, 3, 1);
    static const uint32_t start[2] = {0, 1}, vertex[1] = {2};
    static const mote_vec3 move[1] = {{1, 0, 0}};
    const mote_morph_targets targets = {1, start, vertex, move};
    mote_field *field = morphs_of(own, &targets);
    const mote_cert_tree_options options = {.length = 1, .width = 8, .linear_fits = true};
    mote_mesh *const meshes[3] = {own, more, other};
    for (int i = 0; i < 3; ++i) {
        const mote_body body = {.mesh = meshes[i], .field = field};
        mote_cert_tree *tree = NULL;
        assert_int_equal(mote_cert_tree_create(&body, &options, &tree),
                         i == 0 ? MOTE_OK : MOTE_EINVAL);
        mote_cert_tree_destroy(tree);
    }
    assert_string_equal(mote_error_text(),
                        "the skin was made for another mesh than the body's");
    mote_field_destroy(field);
    mote_mesh_destroy(own);
    mote_mesh_destroy(other);
    mote_mesh_destroy(more);
}

/* The largest displacements there are, and weights of bones alone, which move no target. */
TEST(targets_of_any_finite_size_are_kept)
{
    mote_mesh *mesh = make_torus(3, 3, 1);
    static const uint32_t start[2] = {0, 1}, vertex[1] = {2};
    static const mote_vec3 move[1] = {{DBL_MAX, -DBL_MAX, 0.75 * DBL_MAX}};
    const mote_morph_targets targets = {1, start, vertex, move};
    mote_field *field = morphs_of(mesh, &targets);
    const mote_skin *skin = mote_field_skin(field);
    const mote_morph *morph = &skin->morph;
    for (int k = 0; k < 3; ++k) {
        const double wanted = k == 0 ? move[0].x : k == 1 ? move[0].y : move[0].z;
        assert_true(fabs((double)morph->move[0][k] - wanted / morph->size[0]) < 1e-6);
    }
    const mote_mat3 turn = {{{0, -1, 0}, {1, 0, 0}, {0, 0, 1}}};
    double x[16], y[16], z[16];
    assert_true(field->padded <= ROWS_OF(x));
    mote_skin_weights(field, NULL, &turn, x, y, z);
    for (uint32_t j = 0; j < field->count; ++j) {
        const bool column = j >= 4 && j < 7; /* those of the rotation */
        assert_true(x[j] == (column ? turn.m[0][j - 4] : 0));
        assert_true(y[j] == (column ? turn.m[1][j - 4] : 0));
        assert_true(z[j] == (column ? turn.m[2][j - 4] : 0));
    }
    mote_field_destroy(field);
    mote_mesh_destroy(mesh);
}
