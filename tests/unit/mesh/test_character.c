#include "core/skin/skin.h"
#include "harness/mesh/character.h"
#include "harness/mesh/character_parts.h"
#include "tests/support/bar.h"
#include "tests/support/test.h"

#include <fcntl.h>
#include <float.h>
#include <math.h>
#include <unistd.h>

static mote_character *import(const char *path, mote_character_import *facts)
{
    mote_character *made = NULL;
    if (mote_character_import_file(path, &made, facts) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    return made;
}

/* The position of a vertex moved by the bones, as the sum of the definition. */
static mote_vec3 skinned(const mote_character *c, const mote_character_pose *pose, uint32_t v)
{
    mote_vec3 at = {0, 0, 0}, x = c->mesh->positions[v];
    for (uint32_t i = c->shift_start[v]; i < c->shift_start[v + 1]; ++i)
        x = mote_add_scaled(x, pose->morphs[c->target[i]], c->shift[i]);
    for (uint32_t i = c->start[v]; i < c->start[v + 1]; ++i)
        at = mote_add_scaled(at, c->weight[i],
                             mote_affine_apply(&pose->matrices[c->bone[i]], x));
    return at;
}

static void check_place(const mote_character *c, const mote_character_pose *pose,
                        mote_vec3 rest, mote_vec3 wanted)
{
    for (uint32_t v = 0; v < c->mesh->vertex_count; ++v) {
        if (mote_distance_squared(c->mesh->positions[v], rest) > 1e-12)
            continue;
        const mote_vec3 got = skinned(c, pose, v);
        if (mote_distance_squared(got, wanted) > 1e-12)
            fail_msg("(%g, %g, %g) goes to (%g, %g, %g)", rest.x, rest.y, rest.z, got.x, got.y,
                     got.z);
        return;
    }
    fail_msg("no vertex at (%g, %g, %g)", rest.x, rest.y, rest.z);
}

TEST(mote_character_bends_as_its_bones_say)
{
    mote_character_import facts;
    bar_write("bar.x", bar_default());
    mote_character *c = import("bar.x", &facts);
    assert_int_equal(c->mesh->vertex_count, BAR_VERTICES);
    assert_int_equal(c->mesh->triangle_count, BAR_TRIANGLES);
    assert_int_equal(c->mesh->open_edge_count, 0);
    assert_int_equal(c->rig.bones_count, 2);
    assert_int_equal(c->rig.clips_count, 2);
    assert_true(c->rig.clips[0].seconds == 1);
    assert_true(facts.off == 0 && facts.apart == 0 && facts.meshes == 1);
    mote_character_pose pose = mote_character_pose_create(c);
    mote_character_pose_set(c, MOTE_RIG_NONE, 0, &pose);
    for (uint32_t v = 0; v < BAR_VERTICES; ++v)
        check_place(c, &pose, c->mesh->positions[v], c->mesh->positions[v]);
    /* After a second the end points up or down, because files of this format have another
       handedness. */
    mote_character_pose_set(c, 0, 1, &pose);
    const double up = skinned(c, &pose, 8).y > 0 ? 1 : -1;
    check_place(c, &pose, (mote_vec3){0, 0.25, 0.25}, (mote_vec3){0, 0.25, 0.25});
    check_place(c, &pose, (mote_vec3){2, 0.25, 0.25}, (mote_vec3){1 - up * 0.25, up, 0.25});
    check_place(c, &pose, (mote_vec3){1, 0.25, 0.25},
                (mote_vec3){1 - up * 0.125, 0.125, 0.25}); /* half of both */
    /* Half way the angle is half as large. */
    mote_character_pose_set(c, 0, 0.5, &pose);
    const double s = sqrt(0.5);
    check_place(c, &pose, (mote_vec3){2, 0.25, 0.25},
                (mote_vec3){1 + s - up * s * 0.25, up * s + s * 0.25, 0.25});
    mote_character_pose_free(&pose);
    mote_character_destroy(c);
}

/* The core's field gives the same positions. */
TEST(mote_character_is_a_skin_of_the_core)
{
    bar_write("bar.x", bar_default());
    mote_character *c = import("bar.x", NULL);
    mote_field *field = NULL;
    assert_int_equal(mote_field_create_skin(c->mesh, (uint32_t)c->rig.bones_count, c->start,
                                            c->bone, c->weight, &field),
                     MOTE_OK);
    mote_character_pose pose = mote_character_pose_create(c);
    mote_character_pose_set(c, 0, 0.7, &pose);
    double x[8], y[8], z[8];
    mote_body_state state = {.weights = {x, y, z, field->count, field->padded}};
    state.pose.rotation = (mote_mat3){{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    assert_int_equal(field->padded, 8);
    mote_skin_weights(field, (const double(*)[3][4])pose.matrices, &state.pose.rotation, x, y,
                      z);
    const mote_body body = {.mesh = c->mesh, .field = field};
    for (uint32_t v = 0; v < c->mesh->vertex_count; ++v)
        assert_true(mote_distance_squared(mote_body_position(&body, &state, v),
                                          skinned(c, &pose, v)) < 1e-28);
    mote_character_pose_free(&pose);
    mote_field_destroy(field);
    mote_character_destroy(c);
}

TEST(mote_character_scaled_moves_as_before_in_its_scale)
{
    bar_write("bar.x", bar_default());
    mote_character *c = import("bar.x", NULL), *scaled = import("bar.x", NULL);
    const mote_vec3 factor = {3, 0.5, 7};
    assert_int_equal(mote_character_scale(scaled, factor), MOTE_OK);
    mote_character_pose pose = mote_character_pose_create(c);
    for (uint32_t v = 0; v < BAR_VERTICES; ++v) {
        mote_character_pose_set(c, 0, 0.3, &pose);
        const mote_vec3 p = skinned(c, &pose, v);
        mote_character_pose_set(scaled, 0, 0.3, &pose);
        const mote_vec3 q = skinned(scaled, &pose, v);
        const mote_vec3 wanted = {p.x * factor.x, p.y * factor.y, p.z * factor.z};
        assert_true(mote_distance_squared(q, wanted) < 1e-24);
    }
    mote_character_pose_free(&pose);
    mote_character_destroy(c);
    mote_character_destroy(scaled);
}

TEST(mote_character_weights_are_normalised_and_it_says_by_how_much)
{
    mote_character_import facts;
    bar_text part = bar_default();
    part.upper_weights = "0.75,0.5,0.5,0.5,0.5,1.0,1.0,1.0";
    bar_write("bar.x", part);
    mote_character *c = import("bar.x", &facts);
    assert_true(fabs(facts.off - 0.5) < 1e-7);
    /* At two vertices, which have 11 of the 60 corners, the weights do not sum to 1. */
    assert_int_equal(facts.given, 60);
    assert_int_equal(facts.off_count, 11);
    for (uint32_t v = 0; v < c->mesh->vertex_count; ++v) {
        double sum = 0;
        for (uint32_t i = c->start[v]; i < c->start[v + 1]; ++i)
            sum += c->weight[i];
        assert_true(fabs(sum - 1) < 1e-15);
    }
    mote_character_destroy(c);
}

TEST(mote_character_clips_are_found_by_name_and_number)
{
    uint32_t clip = 9;
    bar_write("bar.x", bar_default());
    mote_character *c = import("bar.x", NULL);
    assert_int_equal(mote_character_find_clip(c, "Still", &clip), MOTE_OK);
    assert_int_equal(clip, 1);
    assert_int_equal(mote_character_find_clip(c, "1", &clip), MOTE_OK);
    assert_int_equal(clip, 0);
    assert_int_equal(mote_character_find_clip(c, "Run", &clip), MOTE_EINVAL);
    assert_string_equal(mote_error_text(), "no clip Run; it has 1 Bend (1 s), 2 Still (0 s)");
    assert_int_equal(mote_character_find_clip(c, "3", &clip), MOTE_EINVAL);
    assert_int_equal(mote_character_clip_numbered(c, 2, &clip), MOTE_OK);
    assert_int_equal(clip, 1);
    assert_int_equal(mote_character_clip_numbered(c, 0, &clip), MOTE_EINVAL);
    assert_string_equal(mote_error_text(), "no clip 0; it has 1 Bend (1 s), 2 Still (0 s)");
    assert_int_equal(mote_character_clip_numbered(c, 3, &clip), MOTE_EINVAL);
    assert_true(mote_rig_clip_time(&c->rig.clips[0], 2.25, 1) == 0.25);
    assert_true(mote_rig_clip_time(&c->rig.clips[0], -0.25, 1) == 0.75);
    assert_true(mote_rig_clip_time(&c->rig.clips[0], 2.25, 0) == 1);
    assert_true(mote_rig_clip_time(&c->rig.clips[0], -3, 0) == 0);
    assert_true(mote_rig_clip_time(&c->rig.clips[1], 5, 1) == 0);
    mote_character_destroy(c);
}

static void check_refusal(bar_text part, const char *said)
{
    mote_character *c = NULL;
    bar_write("bad.x", part);
    test_row("%s", said);
    assert_int_equal(mote_character_import_file("bad.x", &c, NULL), MOTE_EINVAL);
    if (!strstr(mote_error_text(), said))
        fail_msg("%s", mote_error_text());
}

TEST(mote_character_that_is_wrong_is_refused_with_what_and_where)
{
    bar_text part = bar_default();
    part.upper_weights = "0.5,0.5,0.5,0.5,1.0,1e40,1.0,1.0";
    check_refusal(
        part, "bad.x: the vertex at (2, 0.25, 0.25) has the weight inf for bone Upper; give");
    part = bar_default();
    part.upper = "Other";
    check_refusal(part, "bad.x: bone Upper is not a node; give each bone a node");
    part = bar_default();
    part.rotations = "10;4;1.0,0.0,0.0,0.0;;,0;4;0.7,0.0,0.0,-0.7;;;";
    check_refusal(part,
                  "bad.x: clip 1 (Bend): key 2 of the rotation of Upper is before the one "
                  "before it; give times that ascend");
    part = bar_default();
    part.bind = "1e39,0.0,0.0,1.0";
    check_refusal(part, "bad.x: the matrix of bone Upper is not finite; give finite numbers");
}

/* Replaces each number of a rig by a wrong one. */
TEST(mote_character_check_rig_names_what_is_wrong)
{
    bar_write("bar.x", bar_default());
    mote_character *c = import("bar.x", NULL);
    const mote_rig_channel *upper = &c->rig.channels[c->rig.clips[0].channel];
    const struct {
        double *at;
        double wrong;
        const char *said;
    } rows[] = {
        {&c->rig.nodes[0].rest.m[0][3], INFINITY, "b.x: the matrix of node Root is not finite"},
        {&c->rig.values[upper->rotation.value + 4], NAN,
         "b.x: clip 1 (Bend): key 2 of the rotation of Upper is not finite; give finite"},
        {&c->rig.values[upper->rotation.value], 0,
         "b.x: clip 1 (Bend): key 1 of the rotation of Upper is not a rotation; give"},
        {&c->rig.times[upper->position.time], -INFINITY,
         "b.x: clip 1 (Bend): key 1 of the position of Upper is not finite"},
        {&c->rig.values[upper->scale.value + 2], NAN, "key 1 of the scale of Upper is not"}};
    assert_int_equal(mote_character_check_rig("b.x", &c->rig), MOTE_OK);
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        const double was = *rows[i].at;
        *rows[i].at = rows[i].wrong;
        test_row("%s", rows[i].said);
        assert_int_equal(mote_character_check_rig("b.x", &c->rig), MOTE_EINVAL);
        if (!strstr(mote_error_text(), rows[i].said))
            fail_msg("%s", mote_error_text());
        *rows[i].at = was;
    }
    mote_character_destroy(c);
}

TEST(mote_character_of_a_file_that_cannot_move_is_unsupported)
{
    mote_character *c = NULL;
    file_put("still.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    assert_int_equal(mote_character_import_file("still.obj", &c, NULL), MOTE_EUNSUPPORTED);
    file_put("still.dxf",
             "0\nSECTION\n2\nENTITIES\n0\n3DFACE\n8\n0\n10\n0\n20\n0\n30\n0\n11\n1\n"
             "21\n0\n31\n0\n12\n0\n22\n1\n32\n0\n13\n0\n23\n1\n33\n0\n0\nENDSEC\n"
             "0\nEOF\n");
    assert_int_equal(mote_character_import_file("still.dxf", &c, NULL), MOTE_EUNSUPPORTED);
    assert_int_equal(mote_character_import_file("none.x", &c, NULL), MOTE_EIO);
    file_put("text.x", "no character");
    assert_int_equal(mote_character_import_file("text.x", &c, NULL), MOTE_EINVAL);
}

/* Two triangles that share an edge whose vertices are duplicated: at one end the copies move
   alike, at the other they do not. */
static void fill_draft(mote_character_draft *draft)
{
    static const double places[6][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0},
                                        {1, 0, 0}, {0, 0, 0}, {0, -1, 0}};
    memset(draft, 0, sizeof *draft);
    for (int v = 0; v < 6; ++v)
        assert_int_equal(
            mote_soup_add_vertex(&draft->soup, places[v][0], places[v][1], places[v][2]),
            MOTE_OK);
    mote_soup_add_triangle(&draft->soup, 0, 1, 2);
    mote_soup_add_triangle(&draft->soup, 3, 4, 5);
    MOTE_RIG_GROW(&draft->made.rig, nodes, 1);
    draft->made.rig.nodes[0].name = mote_rig_add_name(&draft->made.rig, "Joint");
    MOTE_RIG_GROW(&draft->made.rig, bones, 2);
    MOTE_RIG_GROW(&draft->made, start, 7);
    MOTE_RIG_GROW(&draft->made, shift_start, 7);
    MOTE_RIG_GROW(&draft->made, bone, 12);
    MOTE_RIG_GROW(&draft->made, weight, 12);
    MOTE_RIG_GROW(&draft->made, target, 0);
    MOTE_RIG_GROW(&draft->made, shift, 0);
    for (uint32_t v = 0; v < 6; ++v) {
        draft->made.start[v + 1] = 2 * v + 2;
        draft->made.bone[2 * v + 1] = 1;
        draft->made.weight[2 * v] = v == 4 ? 0.75 : 0.5;
        draft->made.weight[2 * v + 1] = v == 4 ? 0.25 : 0.5;
    }
}

TEST(mote_character_keeps_vertices_apart_that_move_differently)
{
    mote_character_draft draft;
    fill_draft(&draft);
    assert_int_equal(mote_character_weld("two.x", &draft), MOTE_OK);
    assert_int_equal(draft.soup.vertex_count, 5);
    assert_int_equal(draft.import.apart, 1);
    assert_true(draft.import.apart_most == 0.25);
    assert_int_equal(draft.made.start_count, 6);
    assert_int_equal(draft.made.start[5], 10);
    mote_character_draft_free(&draft);
}

TEST(mote_character_weights_are_checked)
{
    static const struct {
        double weights[2];
        const char *said;
    } rows[] = {
        {{1, -0.5}, "two.x: the vertex at (1, 0, 0) has the weight -0.5 for bone Joint; give"},
        {{0.5, NAN}, "two.x: the vertex at (1, 0, 0) has the weight "},
        {{0, 0},
         "two.x: the weights of the vertex at (1, 0, 0) add up to 0; give a positive sum"},
        {{DBL_MAX, DBL_MAX},
         "two.x: the weights of the vertex at (1, 0, 0) add up to inf; give"}};
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        mote_character_draft draft;
        test_row("%s", rows[i].said);
        fill_draft(&draft);
        memcpy(draft.made.weight + 6, rows[i].weights, sizeof rows[i].weights);
        assert_int_equal(mote_character_weld("two.x", &draft), MOTE_EINVAL);
        assert_non_null(strstr(mote_error_text(), rows[i].said));
        mote_character_draft_free(&draft);
    }
}

/* The parent accepts what the child sends. A shorter or changed message is refused or accepted
   as another draft, and never read beyond its arrays (with AddressSanitizer). */
TEST(mote_character_take_refuses_what_is_no_draft)
{
    mote_character_draft draft = {0}, taken;
    bar_write("bar.x", bar_default());
    assert_int_equal(mote_character_read_assimp("bar.x", &draft), MOTE_OK);
    assert_int_equal(mote_character_weld("bar.x", &draft), MOTE_OK);
    const int out = open("sent", O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
    assert_true(out >= 0);
    assert_int_equal(mote_character_send(out, &draft), MOTE_OK);
    const off_t size = lseek(out, 0, SEEK_CUR);
    (void)close(out);
    char *sent = malloc((size_t)size);
    FILE *in = fopen("sent", "rb");
    assert_true(sent && in && fread(sent, 1, (size_t)size, in) == (size_t)size);
    (void)fclose(in);
    assert_int_equal(mote_character_receive("bar.x", sent, (size_t)size, &taken), MOTE_OK);
    assert_int_equal(taken.soup.vertex_count, draft.soup.vertex_count);
    assert_int_equal(taken.made.rig.values_count, draft.made.rig.values_count);
    assert_memory_equal(taken.made.rig.names, draft.made.rig.names, draft.made.rig.names_count);
    mote_character_draft_free(&taken);
    for (size_t cut = 0; cut < (size_t)size; cut += 7)
        assert_int_equal(mote_character_receive("bar.x", sent, cut, &taken), MOTE_EIO);
    for (size_t at = 0; at + 4 <= (size_t)size; at += 4) {
        char was[4];
        memcpy(was, sent + at, 4);
        memset(sent + at, 0x7f, 4);
        if (mote_character_receive("bar.x", sent, (size_t)size, &taken) == MOTE_OK) {
            (void)mote_character_check_rig("bar.x", &taken.made.rig);
            mote_character_draft_free(&taken);
        }
        memcpy(sent + at, was, 4);
    }
    free(sent);
    mote_character_draft_free(&draft);
}
