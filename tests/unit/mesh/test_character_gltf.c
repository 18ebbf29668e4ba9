/* Step and cubic keys of glTF files, and weights of morph targets. */
#include "harness/mesh/character.h"
#include "tests/support/folder.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdint.h>

#define KEYS 3

/* A triangle with one morph target, then times, then cubic translations, rotations and weights
   of the polynomials below with their derivatives. */
typedef struct buffer {
    float corners[9], raised[9];
    float times[KEYS], places[KEYS][3][3], turns[KEYS][3][4], amounts[KEYS][3];
} buffer;

static const double times[KEYS] = {0, 0.5, 2};

static double place_at(double t)
{
    return t * t * t - t + 2;
}

static double amount_at(double t)
{
    return 0.25 * t * t;
}

static buffer make_buffer(void)
{
    buffer b = {.corners = {0, 0, 0, 1, 0, 0, 0, 1, 0}, .raised = {0, 0, 3, 0, 0, 3, 0, 0, 3}};
    for (int k = 0; k < KEYS; ++k) {
        const double t = times[k];
        b.times[k] = (float)t;
        b.places[k][1][0] = (float)place_at(t);
        b.places[k][0][0] = b.places[k][2][0] = (float)(3 * t * t - 1);
        b.turns[k][1][2] = (float)sin(t); /* z, then w: about z by twice the time */
        b.turns[k][1][3] = (float)cos(t);
        b.turns[k][0][2] = b.turns[k][2][2] = (float)cos(t);
        b.turns[k][0][3] = b.turns[k][2][3] = (float)-sin(t);
        b.amounts[k][1] = (float)amount_at(t);
        b.amounts[k][0] = b.amounts[k][2] = (float)(0.5 * t);
    }
    return b;
}

#define VIEW(from, to)                                                                         \
    "{\"buffer\": 0, \"byteOffset\": %d, \"byteLength\": %d}", (int)offsetof(buffer, from),    \
        (int)(offsetof(buffer, to) - offsetof(buffer, from))

static void write_file(const char *mode, int keys, const char *uri)
{
    const buffer b = make_buffer();
    FILE *f = fopen("a.gltf", "w");
    assert_non_null(f);
    file_write("a.bin", &b, sizeof b);
    fprintf(f,
            "{\"asset\": {\"version\": \"2.0\"}, \"scene\": 0, \"scenes\": [{\"nodes\": [0]}],"
            "\"nodes\": [{\"name\": \"Part\", \"mesh\": 0}], \"meshes\": [{\"primitives\": ["
            "{\"attributes\": {\"POSITION\": 0}, \"targets\": [{\"POSITION\": 1}]}]}],"
            "\"buffers\": [{\"uri\": \"%s\", \"byteLength\": %d}], \"bufferViews\": [",
            uri, (int)sizeof b);
    fprintf(f, VIEW(corners, raised));
    fprintf(f, ", " VIEW(raised, times));
    fprintf(f, ", " VIEW(times, places));
    fprintf(f, ", " VIEW(places, turns));
    fprintf(f, ", " VIEW(turns, amounts));
    fprintf(f, ", {\"buffer\": 0, \"byteOffset\": %d, \"byteLength\": %d}], \"accessors\": [",
            (int)offsetof(buffer, amounts), (int)sizeof b.amounts);
    static const char *const types[] = {"VEC3", "VEC3", "SCALAR", "VEC3", "VEC4", "SCALAR"};
    const int counts[] = {3, 3, KEYS, keys, keys, keys};
    for (int a = 0; a < 6; ++a)
        fprintf(
            f,
            "%s{\"bufferView\": %d, \"componentType\": 5126, \"count\": %d, \"type\": \"%s\""
            ", \"min\": [0, 0, 0], \"max\": [1, 1, 0]}",
            a ? ", " : "", a, counts[a], types[a]);
    fprintf(f, "], \"animations\": [{\"name\": \"Move\", \"channels\": [");
    static const char *const paths[] = {"translation", "rotation", "weights"};
    for (int c = 0; c < 3; ++c)
        fprintf(f, "%s{\"sampler\": %d, \"target\": {\"node\": 0, \"path\": \"%s\"}}",
                c ? ", " : "", c, paths[c]);
    fprintf(f, "], \"samplers\": [");
    for (int c = 0; c < 3; ++c)
        fprintf(f, "%s{\"input\": 2, \"output\": %d, \"interpolation\": \"%s\"}", c ? ", " : "",
                3 + c, mode);
    fprintf(f, "]}]}");
    (void)fclose(f);
}

TEST(mote_character_of_gltf_has_cubic_keys_with_their_tangents)
{
    mote_character *c = NULL;
    write_file("CUBICSPLINE", 3 * KEYS, "a.bin");
    if (mote_character_import_file("a.gltf", &c, NULL) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    mote_character_pose pose = mote_character_pose_create(c);
    assert_int_equal(c->rig.bones_count, 1);
    assert_int_equal(c->rig.targets_count, 1);
    for (double t = 0; t <= 2; t += 0.0625) {
        mote_character_pose_set(c, 0, t, &pose);
        assert_true(fabs(pose.matrices[0].m[0][3] - place_at(t)) < 1e-6);
        assert_true(fabs(pose.morphs[0] - amount_at(t)) < 1e-6);
    }
    for (int k = 0; k < KEYS; ++k) {
        mote_character_pose_set(c, 0, times[k], &pose);
        assert_true(fabs(pose.matrices[0].m[1][0] - sin(2 * times[k])) < 1e-6);
    }
    mote_character_pose_free(&pose);
    mote_character_destroy(c);
}

TEST(mote_character_of_gltf_has_steps)
{
    mote_character *c = NULL;
    write_file("STEP", KEYS, "a.bin"); /* the first KEYS values of the cubic keys above */
    if (mote_character_import_file("a.gltf", &c, NULL) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    const buffer b = make_buffer();
    mote_character_pose pose = mote_character_pose_create(c);
    mote_character_pose_set(c, 0, 0.49, &pose);
    assert_true(pose.matrices[0].m[0][3] == (double)b.places[0][0][0]);
    mote_character_pose_set(c, 0, 1.99, &pose);
    assert_true(pose.matrices[0].m[0][3] == (double)b.places[0][1][0]);
    mote_character_pose_free(&pose);
    mote_character_destroy(c);
}

/* Linear keys and steps; 1.25 s is half of the way from the second key to the third. */
TEST(mote_character_of_gltf_has_negative_weights)
{
    static const struct {
        const char *mode;
        double at_first, between;
    } rows[] = {{"LINEAR", -0.5, -0.25}, {"STEP", -0.5, -1}};
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        mote_character *c = NULL;
        buffer b = make_buffer();
        b.amounts[0][0] = -0.5F;
        b.amounts[0][1] = -1;
        b.amounts[0][2] = 0.5F;
        test_row("%s", rows[i].mode);
        write_file(rows[i].mode, KEYS, "a.bin");
        file_write("a.bin", &b, sizeof b);
        if (mote_character_import_file("a.gltf", &c, NULL) != MOTE_OK)
            fail_msg("%s", mote_error_text());
        mote_character_pose pose = mote_character_pose_create(c);
        mote_character_pose_set(c, 0, 0, &pose);
        assert_true(pose.morphs[0] == rows[i].at_first);
        mote_character_pose_set(c, 0, 1.25, &pose);
        assert_true(fabs(pose.morphs[0] - rows[i].between) < 1e-6);
        mote_character_pose_free(&pose);
        mote_character_destroy(c);
    }
}

/* Four weights of one target at three times. */
TEST(mote_character_of_gltf_with_weights_left_over_is_refused)
{
    mote_character *c = NULL;
    write_file("LINEAR", KEYS + 1, "a.bin");
    assert_int_equal(mote_character_import_file("a.gltf", &c, NULL), MOTE_EINVAL);
    assert_non_null(strstr(mote_error_text(), "a.gltf: keys of weights that are not equally "));
}

TEST(mote_character_of_gltf_with_bad_cubic_keys_is_refused)
{
    mote_character *c = NULL;
    write_file("CUBICSPLINE", 3 * KEYS - 1, "a.bin");
    assert_int_equal(mote_character_import_file("a.gltf", &c, NULL), MOTE_EINVAL);
    assert_non_null(strstr(mote_error_text(), "a.gltf: "));
}

/* The hand has 25 joints; those of the five tips have no weight, and assimp gives each a weight
   of 0. */
TEST(mote_character_of_gltf_leaves_out_bones_that_move_nothing)
{
    mote_character *c = NULL;
    if (mote_character_import_file(MOTE_SOURCE_DIR "/datasets/characters/hand.glb", &c, NULL) !=
        MOTE_OK)
        fail_msg("%s", mote_error_text());
    assert_int_equal(c->rig.bones_count, 20);
    for (size_t b = 0; b < c->rig.bones_count; ++b)
        assert_null(strstr(c->rig.names + c->rig.nodes[c->rig.bones[b].node].name, "tip"));
    mote_character_destroy(c);
}
