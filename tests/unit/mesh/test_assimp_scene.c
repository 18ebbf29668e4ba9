/* What is made of the structures that assimp fills, some of which no file of a format that we
   test makes it fill: channels without keys, names without nodes, numbers that are not finite,
   indices out of range. */
#include "harness/mesh/character_parts.h"
#include "harness/mesh/mesh_assimp.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static void set_name(struct aiString *to, const char *name)
{
    to->length = (ai_uint32)snprintf(to->data, sizeof to->data, "%s", name);
}

/* Nodes Arm and Head, at (1, 2, 3) and turned by a quarter about x; each has a morph target,
   Head two. */
static mote_rig make_rig(void)
{
    static const mote_affine places[2] = {{{{1, 0, 0, 1}, {0, 1, 0, 2}, {0, 0, 1, 3}}},
                                          {{{2, 0, 0, 0}, {0, 0, -2, 0}, {0, 2, 0, 0}}}};
    static const char *const names[2] = {"Arm", "Head"};
    mote_rig rig = {0};
    MOTE_RIG_GROW(&rig, nodes, 2);
    MOTE_RIG_GROW(&rig, targets, 3);
    for (uint32_t n = 0; n < 2; ++n)
        rig.nodes[n] =
            (mote_rig_node){MOTE_RIG_NONE, mote_rig_add_name(&rig, names[n]), places[n]};
    rig.targets[1] = (mote_rig_target){.node = 1, .number = 0};
    rig.targets[2] = (mote_rig_target){.node = 1, .number = 1};
    return rig;
}

static const mote_node_name names[] = {{"Arm", 0}, {"Head", 1}};

static void read_clip(struct aiAnimation *animation, mote_rig *rig)
{
    struct aiAnimation *list[] = {animation};
    const struct aiScene scene = {.mNumAnimations = 1, .mAnimations = list};
    set_name(&animation->mName, "Clip");
    *rig = make_rig();
    mote_character_read_clips(&scene, names, rig);
    assert_int_equal(rig->clips_count, 1);
    assert_string_equal(rig->names + rig->clips[0].name, "Clip");
}

TEST(clip_of_a_channel_without_keys_stays_at_the_node_s_own_map)
{
    struct aiNodeAnim channel = {.mNumPositionKeys = 0};
    struct aiNodeAnim *channels[] = {&channel};
    struct aiAnimation animation = {.mNumChannels = 1, .mChannels = channels};
    for (uint32_t n = 0; n < 2; ++n) {
        mote_rig rig;
        mote_affine globals[2];
        set_name(&channel.mNodeName, names[n].name);
        read_clip(&animation, &rig);
        assert_int_equal(rig.channels_count, 1);
        assert_int_equal(rig.channels[0].node, n);
        assert_int_equal(rig.channels[0].position.count, 1);
        assert_int_equal(rig.channels[0].rotation.count, 1);
        assert_int_equal(rig.channels[0].scale.count, 1);
        mote_rig_globals(&rig, 0, 0.5, globals);
        for (int k = 0; k < 12; ++k)
            assert_true(fabs(globals[n].m[k / 4][k % 4] - rig.nodes[n].rest.m[k / 4][k % 4]) <
                        1e-6);
        mote_rig_free(&rig);
    }
}

/* Of two channels for a node the first counts; one for an unknown node moves nothing. */
TEST(clip_takes_the_first_channel_of_each_known_node)
{
    struct aiVectorKey keys[2][1] = {{{.mTime = 0, .mValue = {5, 0, 0}}},
                                     {{.mTime = 0, .mValue = {7, 0, 0}}}};
    struct aiNodeAnim made[3] = {{.mNumPositionKeys = 1, .mPositionKeys = keys[0]},
                                 {.mNumPositionKeys = 1, .mPositionKeys = keys[1]},
                                 {.mNumPositionKeys = 1, .mPositionKeys = keys[1]}};
    struct aiNodeAnim *channels[] = {&made[2], &made[0], &made[1]};
    struct aiAnimation animation = {.mNumChannels = 3, .mChannels = channels};
    mote_rig rig;
    set_name(&made[0].mNodeName, "Head");
    set_name(&made[1].mNodeName, "Head");
    set_name(&made[2].mNodeName, "Tail");
    read_clip(&animation, &rig);
    assert_int_equal(rig.channels_count, 1);
    assert_int_equal(rig.channels[0].node, 1);
    assert_true(rig.values[rig.channels[0].position.value] == 5);
    mote_rig_free(&rig);
}

/* A length or a time that is not finite does not count. */
TEST(clip_is_as_long_as_it_says_or_as_its_last_key)
{
    static const struct {
        double ticks, duration, last; /* of the keys, in ticks */
        double seconds;
    } rows[] = {
        {10, 20, 5, 2},         {10, 0, 5, 0.5},    {10, -1, 5, 0.5},  {10, NAN, 5, 0.5},
        {10, INFINITY, 5, 0.5}, {0, 50, 5, 2},      {-3, 50, 5, 2},    {NAN, 50, 5, 2},
        {INFINITY, 50, 5, 2},   {1e-320, 50, 5, 0}, {10, 0, 0.5, 0.1}, {10, 0, INFINITY, 0.1},
        {10, 0, NAN, 0.1},
    };
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        struct aiQuatKey keys[2] = {{.mTime = 1, .mValue = {1, 0, 0, 0}},
                                    {.mTime = rows[i].last, .mValue = {1, 0, 0, 0}}};
        struct aiNodeAnim channel = {.mNumRotationKeys = 2, .mRotationKeys = keys};
        struct aiNodeAnim *channels[] = {&channel};
        struct aiAnimation animation = {.mNumChannels = 1,
                                        .mChannels = channels,
                                        .mTicksPerSecond = rows[i].ticks,
                                        .mDuration = rows[i].duration};
        mote_rig rig;
        test_row("%zu", i);
        set_name(&channel.mNodeName, "Arm");
        read_clip(&animation, &rig);
        assert_true(fabs(rig.clips[0].seconds - rows[i].seconds) < 1e-15);
        mote_rig_free(&rig);
    }
}

/* A channel of weights names a node, or a node with a star and a number. */
TEST(clip_takes_weights_of_the_node_s_targets)
{
    static const struct {
        const char *name;
        unsigned keys;
        size_t morphs; /* made */
    } rows[] = {{"Head", 2, 2}, {"Head*0", 2, 2}, {"Arm*3", 2, 1}, {"Tail*0", 2, 0},
                {"Tail", 2, 0}, {"Head", 0, 0},   {"*", 2, 0},     {"Head*1*0", 2, 0}};
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        unsigned numbers[2] = {1, 0};
        double amounts[2] = {0.25, 0.75}, later[1] = {0.5};
        struct aiMeshMorphKey keys[2] = {
            {.mTime = 0, .mValues = numbers, .mWeights = amounts, .mNumValuesAndWeights = 2},
            {.mTime = 25, .mValues = numbers, .mWeights = later, .mNumValuesAndWeights = 1}};
        struct aiMeshMorphAnim made[2] = {{.mNumKeys = rows[i].keys, .mKeys = keys},
                                          {.mNumKeys = rows[i].keys, .mKeys = keys}};
        struct aiMeshMorphAnim *channels[] = {&made[0], &made[1]};
        struct aiAnimation animation = {.mNumMorphMeshChannels = 2,
                                        .mMorphMeshChannels = channels};
        mote_rig rig;
        test_row("%s", rows[i].name);
        set_name(&made[0].mName, rows[i].name);
        set_name(&made[1].mName, rows[i].name); /* the second one changes nothing */
        read_clip(&animation, &rig);
        assert_int_equal(rig.morphs_count, rows[i].morphs);
        if (rows[i].morphs == 2) {
            const double *first = rig.values + rig.morphs[0].weight.value,
                         *second = rig.values + rig.morphs[1].weight.value;
            assert_int_equal(rig.morphs[0].target, 1);
            /* The later key does not name it, and so is none of its keys. */
            assert_int_equal(rig.morphs[0].weight.count, 1);
            assert_int_equal(rig.morphs[1].weight.count, 2);
            assert_true(first[0] == 0.75);
            assert_true(second[0] == 0.25 && second[1] == 0.5);
            assert_true(rig.clips[0].seconds == 1); /* 25 ticks */
        }
        mote_rig_free(&rig);
    }
}

/* Keys as of an FBX file: target 0 at 0 and 2 s, target 1 at 0, 1 and 2 s, and none of Arm's
   target. */
TEST(clip_interpolates_weights_between_the_keys_that_name_their_target)
{
    static const double wanted[][3] = {{0, 1, 0}, {0.5, 1, 0.25}, {1, 1, 0.5}, {2, 1, 0}};
    unsigned both[2] = {0, 1}, one[1] = {1}, other[1] = {7};
    double ends[2] = {1, 0}, middle[1] = {0.5};
    struct aiMeshMorphKey keys[3] = {
        {.mTime = 0, .mValues = both, .mWeights = ends, .mNumValuesAndWeights = 2},
        {.mTime = 25, .mValues = one, .mWeights = middle, .mNumValuesAndWeights = 1},
        {.mTime = 50, .mValues = both, .mWeights = ends, .mNumValuesAndWeights = 2}};
    struct aiMeshMorphKey none = {
        .mTime = 0, .mValues = other, .mWeights = middle, .mNumValuesAndWeights = 1};
    struct aiMeshMorphAnim made[2] = {{.mNumKeys = 3, .mKeys = keys},
                                      {.mNumKeys = 1, .mKeys = &none}};
    struct aiMeshMorphAnim *channels[] = {&made[0], &made[1]};
    struct aiAnimation animation = {.mNumMorphMeshChannels = 2, .mMorphMeshChannels = channels};
    mote_rig rig;
    set_name(&made[0].mName, "Head*0");
    set_name(&made[1].mName, "Arm*0");
    read_clip(&animation, &rig);
    assert_int_equal(rig.morphs_count, 2);
    for (size_t i = 0; i < ROWS_OF(wanted); ++i) {
        double weights[3];
        mote_rig_morph_weights(&rig, 0, wanted[i][0], weights);
        assert_true(weights[1] == wanted[i][1] && weights[2] == wanted[i][2]);
    }
    mote_rig_free(&rig);
}

static mote_status add(struct aiMesh *mesh, mote_soup *soup)
{
    const mote_affine place = mote_affine_identity();
    *soup = (mote_soup){0};
    return mote_assimp_add_mesh("m.x", mesh, &place, soup);
}

TEST(assimp_mesh_of_points_lines_triangles_and_polygons_gives_triangles)
{
    struct aiVector3D at[5] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}};
    unsigned point[] = {4}, line[] = {0, 4}, triangle[] = {0, 1, 4}, square[] = {0, 1, 2, 3};
    struct aiFace faces[] = {{1, point}, {2, line}, {3, triangle}, {4, square}, {0, NULL}};
    struct aiMesh mesh = {.mNumVertices = 5, .mVertices = at, .mNumFaces = 5, .mFaces = faces};
    mote_soup soup;
    assert_int_equal(add(&mesh, &soup), MOTE_OK);
    assert_int_equal(soup.vertex_count, 5);
    assert_int_equal(soup.triangle_count, 3);
    mote_soup_free(&soup);
}

TEST(assimp_mesh_with_a_wrong_number_is_refused_with_its_place)
{
    static const struct {
        struct aiVector3D second;
        unsigned corner;
        const char *name, *says;
    } rows[] = {
        {{NAN, 0, 0}, 2, "Cup", "m.x: vertex 1 of mesh Cup is not finite; give finite numbers"},
        {{0, INFINITY, 0}, 2, "", "m.x: vertex 1 is not finite; give finite numbers"},
        {{0, 0, -INFINITY}, 2, "a\nb. \r\n", "m.x: vertex 1 of mesh a b is not finite"},
        {{1, 0, 0}, 4, "Cup", "m.x: face 0 has vertex 4 of 4; use 0 to 3"},
        {{1, 0, 0}, 0, "Cup", "m.x: face 0 of mesh Cup: a face with a vertex twice; give diff"},
    };
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        struct aiVector3D at[4] = {{0, 0, 0}, rows[i].second, {1, 1, 0}, {0, 1, 0}};
        unsigned square[] = {0, 1, rows[i].corner, 3}, triangle[] = {0, 1, 2};
        struct aiFace faces[] = {{4, square}, {3, triangle}};
        struct aiMesh mesh = {
            .mNumVertices = 4, .mVertices = at, .mNumFaces = 2, .mFaces = faces};
        mote_soup soup;
        test_row("%s", rows[i].says);
        set_name(&mesh.mName, rows[i].name);
        assert_int_equal(add(&mesh, &soup), MOTE_EINVAL);
        if (strncmp(mote_error_text(), rows[i].says, strlen(rows[i].says)) != 0)
            fail_msg("%s", mote_error_text());
        mote_soup_free(&soup);
    }
}
