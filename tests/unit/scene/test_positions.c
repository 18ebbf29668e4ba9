/* Scenarios of positions frame by frame: a sheet that sinks onto a box, whose distance is known
   in closed form. */
#include "core/body/deform.h"
#include "core/method/impact_method.h"
#include "core/method/method.h"
#include "harness/process/child.h"
#include "harness/scene/motion.h"
#include "harness/engine/engine.h"
#include "harness/scene/scenario.h"
#include "tests/support/mote.h"
#include "tests/support/sheet.h"
#include "tests/support/test.h"

#include <math.h>

#define FRAMES 40

TEST_EACH(folder_next, NULL);

/* A cube of edge 1 about the origin: the sheet lies 2 - 1/2 above it at frame 1. */
static const char cube[] =
    "v -0.5 -0.5 -0.5\nv 0.5 -0.5 -0.5\nv 0.5 0.5 -0.5\nv -0.5 0.5 -0.5\n"
    "v -0.5 -0.5 0.5\nv 0.5 -0.5 0.5\nv 0.5 0.5 0.5\nv -0.5 0.5 0.5\n"
    "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

static double gap(double frame)
{
    return 1.5 - (frame - 1) / 64;
}

static void write_scenario(const char *sheet, const char *more, int frames)
{
    char *text = mote_format("{\"purpose\": \"p\", \"frames\": %d, \"ask\": \"distance\"%s, "
                             "\"bodies\": [{%s}, {\"file\": \"cube.obj\"}]}",
                             frames, more, sheet);
    file_put("cube.obj", cube);
    file_put("s.json", text);
    free(text);
}

static mote_scenario *load(void)
{
    mote_scenario *s = NULL;
    if (mote_scenario_load("./s.json", &s) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    return s;
}

/* Every vertex at every frame, and the distance that exact methods give, against the closed
   form; frame k shows place 1 + (k - 1) pace. */
static void check_frames(mote_scenario *s, double pace)
{
    mote_frame_buffer *buffer = mote_frame_buffer_create(s);
    mote_engine *tree, *fcl;
    assert_int_equal(mote_engine_open_distance(s->body, "aabb-tree:positions=given", &tree), 0);
    assert_int_equal(mote_engine_open_distance(s->body, "fcl-aabb", &fcl), 0);
    for (uint32_t k = 1; k <= s->frames; ++k) {
        const double place = 1 + (k - 1) * pace;
        const mote_frame *frame = mote_scenario_frame(s, buffer, k, k - 1);
        assert_non_null(frame);
        assert_int_equal(frame->body[0].shape_changed, true);
        assert_null(frame->body[1].vertices);
        for (int v = 0; v < SHEET_VERTICES; ++v) {
            const mote_vec3 p = frame->body[0].vertices[v];
            assert_true(p.x == sheet_at(v, 0, place) && p.y == sheet_at(v, 1, place) &&
                        fabs(p.z - sheet_at(v, 2, place)) <= 1e-15);
        }
        mote_answer answer;
        assert_int_equal(mote_engine_answer(tree, frame, &answer), MOTE_OK);
        assert_true(fabs(answer.distance - gap(place)) <= 1e-14);
        assert_int_equal(mote_engine_answer(fcl, frame, &answer), MOTE_OK);
        assert_true(fabs(answer.distance - gap(place)) <= 1e-14);
    }
    mote_engine_destroy(tree);
    mote_engine_destroy(fcl);
    mote_frame_buffer_destroy(buffer);
}

static void write_sequences(void)
{
    for (int k = 1; k <= FRAMES; ++k) {
        char name[32];
        (void)snprintf(name, sizeof name, "o%d.obj", 8 + k); /* o9, o10: more digits */
        sheet_write_obj(name, k);
        (void)snprintf(name, sizeof name, "a%03d.ply", k);
        sheet_write_ply(name, k, SHEET_ASCII);
        (void)snprintf(name, sizeof name, "l%03d.ply", k);
        sheet_write_ply(name, k, SHEET_LITTLE);
        (void)snprintf(name, sizeof name, "b%03d.PLY", k);
        sheet_write_ply(name, k, SHEET_BIG);
    }
    sheet_write_pc2("l.pc2", FRAMES, false);
    sheet_write_pc2("b.pc2", FRAMES, true);
    sheet_write_mdd("l.mdd", FRAMES, false);
    sheet_write_mdd("b.MDD", FRAMES, true);
}

static const char *const sheets[] = {"\"positions\": \"o9.obj\"",
                                     "\"positions\": \"a001.ply\"",
                                     "\"positions\": \"l001.ply\"",
                                     "\"positions\": \"b001.PLY\"",
                                     "\"file\": \"o9.obj\", \"positions\": \"l.pc2\"",
                                     "\"file\": \"a001.ply\", \"positions\": \"b.pc2\"",
                                     "\"file\": \"o9.obj\", \"positions\": \"l.mdd\"",
                                     "\"file\": \"l001.ply\", \"positions\": \"b.MDD\""};

TEST(positions_of_every_format_give_the_distances_of_the_sheet)
{
    uint64_t first = 0;
    write_sequences();
    for (size_t i = 0; i < ROWS_OF(sheets); ++i) {
        test_row("%s", sheets[i]);
        write_scenario(sheets[i], "", FRAMES);
        mote_scenario *s = load();
        uint64_t fingerprint = 0;
        assert_int_equal(mote_scenario_fingerprint(s, &fingerprint), MOTE_OK);
        first = i == 0 ? fingerprint : first;
        assert_true(fingerprint == first); /* all formats hold the same bits */
        check_frames(s, 1);
        mote_scenario_destroy(s);
    }
}

TEST(positions_between_frames_lie_on_straight_lines)
{
    write_sequences();
    for (size_t i = 0; i < ROWS_OF(sheets); i += 4) {
        write_scenario(sheets[i], ", \"pace\": 0.375", 30);
        mote_scenario *s = load();
        check_frames(s, 0.375);
        mote_scenario_destroy(s);
    }
}

TEST(positions_follow_scale_and_motion)
{
    write_sequences();
    write_scenario(
        "\"positions\": \"o9.obj\", \"scale\": [2, 1, 0.5], \"motion\": [{\"frame\": "
        "1, \"position\": [0, 0, 0], \"axis\": [0, 1, 0], \"degrees\": 90}]",
        "", 3);
    mote_scenario *s = load();
    mote_frame_buffer *buffer = mote_frame_buffer_create(s);
    const mote_frame *frame = mote_scenario_frame(s, buffer, 3, 0);
    const double length = s->length;
    for (int v = 0; v < SHEET_VERTICES; ++v) {
        /* (x, y, z) turns to (z, y, -x); the middle of frame 1 is at z = 1, once scaled. */
        const mote_vec3 p = frame->body[0].vertices[v];
        assert_true(fabs(p.x - (0.5 * sheet_at(v, 2, 3) - 1)) <= 1e-15 * length);
        assert_true(fabs(p.y - sheet_at(v, 1, 3)) <= 1e-15 * length);
        assert_true(fabs(p.z + 2 * sheet_at(v, 0, 3)) <= 1e-15 * length);
    }
    /* Changes are reported: the pose never changes, the shape only when another frame is
       shown. */
    frame = mote_scenario_frame(s, buffer, 3, 3);
    assert_false(frame->body[0].shape_changed || frame->body[0].pose_changed);
    mote_frame_buffer_destroy(buffer);
    mote_scenario_destroy(s);
}

/* Two frames of an unused vertex and an edge of three faces. */
static void write_fan(void)
{
    for (int k = 1; k <= 2; ++k) {
        char name[16], text[256];
        (void)snprintf(name, sizeof name, "n%d.obj", k);
        (void)snprintf(text, sizeof text,
                       "v 9 9 9\nv 0 0 %d\nv 1 0 %d\nv 0 1 %d\nv 0 -1 %d\nv 0.5 0.2 %d\n"
                       "f 2 3 4\nf 2 3 5\nf 2 3 6\n",
                       k, 2 * k, 3 * k, 4 * k, 5 * k);
        file_put(name, text);
    }
    write_scenario("\"positions\": \"n1.obj\"", "", 2);
}

/* The mesh's vertices differ from the file's. */
TEST(positions_find_the_vertices_that_the_mesh_kept)
{
    write_fan();
    mote_scenario *s = load();
    const mote_mesh *mesh = s->body[0].mesh;
    assert_true(mesh->vertex_count > 5); /* split */
    mote_frame_buffer *buffer = mote_frame_buffer_create(s);
    for (uint32_t k = 1; k <= 2; ++k) {
        const mote_frame *frame = mote_scenario_frame(s, buffer, k, 0);
        for (uint32_t v = 0; v < mesh->vertex_count; ++v)
            assert_true(frame->body[0].vertices[v].z == k * mesh->positions[v].z);
    }
    mote_frame_buffer_destroy(buffer);
    mote_scenario_destroy(s);
}

TEST(positions_with_an_edge_of_three_faces_are_strictly_refused)
{
    write_fan();
    mote_expect(0, "1 edge of more than two faces cut apart", "check s.json");
    mote_expect(
        4, "n1.obj: 1 edge of more than two faces (non-manifold): ", "--strict check s.json");
    mote_expect(4, "(non-manifold)", "run --strict s.json --dry-run");
    file_put("n1.obj", "v 0 0 1\nv 1 0 1\nv 0 1 1\nf 1 2 3\n");
    file_put("n2.obj", "v 0 0 2\nv 1 0 2\nv 0 1 2\nf 1 2 3\n");
    mote_expect(0, "2 frames", "--strict check s.json");
}

TEST(positions_of_no_text_or_no_vertex_are_refused_as_such)
{
    static const char ply[] =
        "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\n"
        "property float y\nproperty float z\nelement face 1\nproperty list "
        "uchar int vertex_indices\nend_header\n3 0 1 2\n";
    write_scenario("\"positions\": \"e1.obj\"", "", 1);
    file_put("e1.obj", "");
    mote_expect(4, "e1.obj: an empty file, no face in it; give a mesh", "check s.json");
    file_put("e1.obj", "\xff\xfev");
    mote_expect(4, "e1.obj: a text in UTF-16; save it as UTF-8", "check s.json");
    write_scenario("\"positions\": \"e1.ply\"", "", 1);
    file_put("e1.ply", ply);
    mote_expect(4, "e1.ply:9: declares no vertex; give a mesh", "check s.json");
}

/* A sheet is open, too, but closing it would not help. */
TEST(positions_are_refused_by_the_closed_loop_as_such)
{
    for (int k = 1; k <= 3; ++k) {
        char name[16];
        (void)snprintf(name, sizeof name, "f%d.obj", k);
        sheet_write_obj(name, k);
    }
    write_scenario("\"positions\": \"f1.obj\"", "", 3);
    mote_expect(4, "mote: s.json: a closed loop moves each body as its contacts tell",
                "simulate s.json --method stream --steps 2");
    mote_expect(4, "but of body 1 only positions are given", "simulate s.json --method stream");
}

TEST(positions_of_either_body_are_refused_where_a_motion_is_sought)
{
    static const char *const bodies[] = {
        "{\"positions\": \"f1.obj\"}, {\"file\": \"cube.obj\"}",
        "{\"file\": \"cube.obj\"}, {\"positions\": \"f1.obj\"}"};
    file_put("cube.obj", cube);
    sheet_write_obj("f1.obj", 1);
    for (int k = 0; k < 2; ++k) {
        char text[300], says[200];
        (void)snprintf(
            text, sizeof text,
            "{\"purpose\": \"p\", \"frames\": 1, \"ask\": \"distance\", \"bodies\": [%s]}",
            bodies[k]);
        (void)snprintf(says, sizeof says,
                       "mote: s.json: of body %d positions are given, and a motion is found "
                       "for bodies with a field and rigid ones only; name one mesh as its",
                       k);
        file_put("s.json", text);
        mote_expect(4, says, "approach s.json --gaps 1:0.1 -o x.json");
    }
}

/* Reads the frames backwards in a child process, which must not affect its parent's reads. */
static mote_status read_backwards(void *context, int output)
{
    mote_frame_buffer *buffer = ((void **)context)[1];
    for (uint32_t k = FRAMES; k >= 1; --k) {
        const mote_frame *frame = mote_scenario_frame(((void **)context)[0], buffer, k, 0);
        if (!frame || frame->body[0].vertices[3].z != sheet_at(3, 2, k))
            return mote_fail(MOTE_EIO, "frame %u", k);
    }
    return mote_child_put(output, "", 1);
}

TEST(positions_are_read_in_a_child_and_in_its_parent_at_once)
{
    write_sequences();
    write_scenario(sheets[2], "", FRAMES);
    mote_scenario *s = load();
    void *both[2] = {s, mote_frame_buffer_create(s)};
    mote_child child;
    size_t index;
    assert_non_null(mote_scenario_frame(s, both[1], 1, 0)); /* the buffer's reader runs */
    const mote_child_limits limits = {.seconds = 20, .output_bytes = 1};
    assert_int_equal(mote_child_start(read_backwards, both, limits, &child), MOTE_OK);
    for (uint32_t k = 1; k <= FRAMES; ++k) {
        const mote_frame *frame = mote_scenario_frame(s, both[1], k, 0);
        assert_true(frame && frame->body[0].vertices[3].z == sheet_at(3, 2, k));
    }
    assert_int_equal(mote_child_wait(&child, 1, &index), MOTE_OK);
    assert_string_equal(child.text, "");
    assert_int_equal(child.status, MOTE_OK);
    mote_child_release(&child);
    mote_frame_buffer_destroy(both[1]);
    mote_scenario_destroy(s);
}

TEST(positions_leave_the_methods_that_need_a_field_out)
{
    write_sequences();
    write_scenario(sheets[4], "", FRAMES);
    mote_scenario *s = load();
    assert_true(mote_body_is_given(&s->body[0]) && !mote_body_is_rigid(&s->body[0]));
    for (size_t i = 0; mote_methods[i]; ++i) {
        mote_engine *engine = NULL;
        mote_method_choice choice;
        const mote_impact_method *impact = mote_impact_method_find(mote_methods[i]->name);
        test_row("%s", mote_methods[i]->name);
        if (impact && impact->alone) /* another question */
            continue;
        assert_int_equal(mote_method_choice_read(mote_methods[i]->name, &choice), MOTE_OK);
        const bool needs = mote_method_traits(choice.method, choice.values).needs_field;
        const mote_status status = mote_engine_open_two(&s->body[0], &s->body[1], &choice,
                                                        MOTE_ASK_CONTACT, 0, 1, &engine);
        if (needs)
            assert_non_null(strstr(mote_error_text(), "needs a field"));
        assert_int_equal(status, needs ? MOTE_EUNSUPPORTED : MOTE_OK);
        mote_engine_destroy(engine);
    }
    mote_scenario_destroy(s);
}

TEST(positions_are_run_exported_and_resumed)
{
    write_sequences();
    write_scenario(sheets[0], "", FRAMES);
    mote_expect(0, "40 frames", "check ./s.json");
    mote_expect(0, "needs a field",
                "run ./s.json --method aabb-tree --method particle:n=4 --method certified "
                "--frames 5-20 --replicates 1 --out r");
    mote_expect(0, "3 of them done",
                "run ./s.json --method aabb-tree --method particle:n=4 --method certified "
                "--frames 5-20 --replicates 1 --out r");
    char *summary = file_text("r/summary.json");
    assert_non_null(strstr(summary, "\"told\": \"positions\""));
    assert_null(strstr(summary, "\"told\": \"field\""));
    free(summary);
    mote_expect(0, "told the positions", "summarize r");
    mote_expect(0, "frame 7", "export ./s.json --frame 7 --method fcl-aabb --out e");
    char *text = file_text("e/A.obj");
    assert_non_null(strstr(text, "v -0.5 -0.5 1.90625\n"));
    free(text);
}

TEST(tables_say_what_a_method_was_told)
{
    mote_expect(0, "told the field",
                "run tt --method certified --frames 1-3 --replicates 1 --out f");
    mote_expect(0, "told the positions",
                "run tt --method aabb-tree --frames 1-3 --replicates 1 --out p");
    mote_expect(0, "needs a field: no bodies", "list methods");
    mote_expect(0, "\"needs_field\": true", "list methods --json");
}

TEST(positions_that_no_scenario_may_have_are_refused)
{
    static const struct {
        const char *sheet, *more, *says;
        int frames;
    } rows[] = {
        {"\"positions\": \"o9.obj\"", "", "o49.obj: No such file or directory; it is frame 41",
         FRAMES + 1},
        {"\"positions\": \"o9.obj\"", ", \"start\": 40, \"pace\": 0.5", "frame 41", 2},
        {"\"file\": \"o9.obj\", \"positions\": \"l.pc2\"", "",
         "40 frames, and the scenario shows 41", FRAMES + 1},
        {"\"positions\": \"none.obj\"", "", "no number of at most", FRAMES},
        {"\"positions\": \"x1.stl\"", "", "neither OBJ nor PLY", 1},
        {"\"positions\": \"../out1.obj\"", "", "outside", 1},
        {"\"positions\": \"l.pc2\"", "", "needs either letter, file or character", FRAMES},
        {"\"file\": \"cube.obj\", \"positions\": \"l.pc2\"", "",
         "25 vertices, and the mesh has 8", FRAMES},
        {"\"file\": \"o9.obj\", \"positions\": \"o9.obj\"", "", "bring their own mesh", FRAMES},
        {"\"positions\": \"o9.obj\", \"field\": {\"kind\": \"stretch\"}", "",
         "either a field, a character or positions", FRAMES},
        {"\"positions\": 7", "", "positions", FRAMES},
    };
    write_sequences();
    sheet_write_obj("../out1.obj", 1);
    sheet_write_obj("x1.stl", 1);
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        mote_scenario *s = NULL;
        test_row("%s", rows[i].sheet);
        write_scenario(rows[i].sheet, rows[i].more, rows[i].frames);
        assert_int_equal(mote_scenario_load("./s.json", &s), MOTE_EINVAL);
        if (!strstr(mote_error_text(), rows[i].says) || !strstr(mote_error_text(), "s.json:1"))
            fail_msg("%s", mote_error_text());
    }
}
