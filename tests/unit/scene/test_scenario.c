#include "core/body/deform.h"
#include "harness/base/file.h"
#include "harness/base/json_read.h"
#include "harness/scene/motion.h"
#include "harness/scene/scenario.h"
#include "harness/scene/spread.h"
#include "tests/support/folder.h"
#include "tests/support/test.h"

#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define FILE_NAME "s.json"

static const char good_text[] =
    "{\n"
    "  \"purpose\": \"a test\",\n"
    "  \"frames\": 40,\n"
    "  \"warmup\": [1, 5],\n"
    "  \"active\": [10, 40],\n"
    "  \"ask\": \"distance\",\n"
    "  \"tolerance\": 0.01,\n"
    "  \"bodies\": [\n"
    "    {\"letter\": \"M\", \"triangles\": 600,\n"
    "     \"field\": {\"count\": 14, \"support\": 0.4,\n"
    "                \"displacement\": {\"random\": {\"seed\": 5, \"amplitude\": 0.05,\n"
    "                                              \"periods\": [20, 60]}}},\n"
    "     \"motion\": [{\"frame\": 1, \"axis\": [0, 0, 1], \"degrees\": 0},\n"
    "                {\"frame\": 40, \"axis\": [0, 0, 1], \"degrees\": 60}]},\n"
    "    {\"letter\": \"V\", \"triangles\": 500,\n"
    "     \"motion\": [{\"frame\": 1, \"position\": [2, 0, 0]},\n"
    "                {\"frame\": 20, \"position\": [1, 0, 0]}]}\n"
    "  ]\n"
    "}\n";

/* Writes good_text with the first `from` replaced. */
static void write_changed(const char *from, const char *to)
{
    const char *at = strstr(good_text, from);
    assert_non_null(at);
    char *text =
        mote_format("%.*s%s%s", (int)(at - good_text), good_text, to, at + strlen(from));
    assert_non_null(text);
    file_put(FILE_NAME, text);
    free(text);
}

static mote_scenario *load_good(void)
{
    mote_scenario *scenario = NULL;
    file_put(FILE_NAME, good_text);
    assert_int_equal(mote_scenario_load(FILE_NAME, &scenario), MOTE_OK);
    return scenario;
}

TEST(mote_scenario_load_good_file_reads_every_part)
{
    mote_scenario *s = load_good();
    assert_string_equal(s->name, "s");
    assert_string_equal(s->purpose, "a test");
    assert_int_equal(s->frames, 40);
    assert_int_equal(s->warmup.first, 1);
    assert_int_equal(s->active.last, 40);
    assert_int_equal(s->ask, MOTE_ASK_DISTANCE);
    assert_int_equal(s->body[0].mesh->triangle_count, 600);
    assert_int_equal(s->body[1].mesh->triangle_count, 500);
    assert_int_equal(s->body[0].field->count, 14);
    assert_int_equal(s->body[1].field->count, 0);
    assert_true(s->length == fmax(s->body[0].mesh->diagonal, s->body[1].mesh->diagonal));
    assert_true(s->tolerance == 0.01 * s->length);
    mote_scenario_destroy(s);
}

/* Control points are vertices here, so the deformed vertex shows its control vector. */
TEST(mote_scenario_frame_control_points_are_displaced_exactly)
{
    mote_scenario *s = load_good();
    const mote_mesh *mesh = s->body[0].mesh;
    mote_vec3 points[14], wished[14];
    assert_int_equal(mote_spread(mesh, 14, points), MOTE_OK);
    mote_frame_buffer *buffer;
    buffer = mote_frame_buffer_create(s);
    double largest = 0;
    for (uint32_t number = 1; number <= 40; number += 13) {
        const mote_frame *frame = mote_scenario_frame(s, buffer, number, 0);
        const mote_body_state *body = &frame->body[0];
        mote_motion_displacements(&s->motion->body[0], number, wished);
        for (int j = 0; j < 14; ++j) {
            uint32_t v = 0;
            while (mote_distance_squared(mesh->positions[v], points[j]) > 0)
                ++v;
            const mote_vec3 world = mote_body_position(&s->body[0], body, v);
            const mote_vec3 expected =
                mote_pose_apply(&body->pose, mote_add(points[j], wished[j]));
            assert_true(mote_length(mote_sub(world, expected)) < 1e-10 * s->length);
            largest = fmax(largest, mote_length(wished[j]));
        }
    }
    assert_true(largest > 0.01 * s->length && largest <= 0.05 * s->length);
    mote_frame_buffer_destroy(buffer);
    mote_scenario_destroy(s);
}

TEST(mote_scenario_frame_changes_are_told_against_the_previous)
{
    mote_scenario *s = load_good();
    mote_frame_buffer *buffer;
    buffer = mote_frame_buffer_create(s);
    const mote_frame *frame = mote_scenario_frame(s, buffer, 30, 0);
    assert_true(frame->body[1].shape_changed && frame->body[1].pose_changed);
    frame = mote_scenario_frame(s, buffer, 30, 25);
    assert_true(frame->body[0].shape_changed && frame->body[0].pose_changed);
    /* Body 1 is rigid, and does not move from frame 20 on. */
    assert_false(frame->body[1].shape_changed || frame->body[1].pose_changed);
    frame = mote_scenario_frame(s, buffer, 12, 11);
    assert_false(frame->body[1].shape_changed);
    assert_true(frame->body[1].pose_changed);
    frame = mote_scenario_frame(s, buffer, 12, 12);
    assert_false(frame->body[0].shape_changed || frame->body[0].pose_changed);
    mote_frame_buffer_destroy(buffer);
    mote_scenario_destroy(s);
}

/* 60 degrees in 39 frames, starting slowly along the curve: the same as from two frames'
   matrices. */
TEST(mote_scenario_velocity_absent_follows_from_frames_1_and_2)
{
    mote_scenario *s = load_good();
    mote_frame_buffer *buffer;
    buffer = mote_frame_buffer_create(s);
    mote_vec3 velocity, spin;
    mote_scenario_velocity(s, 0, &velocity, &spin);
    const mote_mat3 one = mote_scenario_frame(s, buffer, 1, 0)->body[0].pose.rotation;
    const mote_mat3 two = mote_scenario_frame(s, buffer, 2, 0)->body[0].pose.rotation;
    const mote_vec3 x = {1, 0, 0};
    const double angle = acos(mote_dot(mote_rotate(&one, x), mote_rotate(&two, x)));
    assert_true(angle > 0 && fabs(spin.z - angle) < 1e-8);
    assert_true(spin.x == 0 && spin.y == 0 && mote_length(velocity) < 1e-15);
    mote_scenario_velocity(s, 1, &velocity, &spin);
    assert_true(velocity.x < 0 && mote_length(spin) == 0);
    mote_frame_buffer_destroy(buffer);
    mote_scenario_destroy(s);
    write_changed("\"triangles\": 500,",
                  "\"triangles\": 500, \"velocity\": [0, 0.5, 0], \"spin\": [0, 0, 90],");
    assert_int_equal(mote_scenario_load(FILE_NAME, &s), MOTE_OK);
    mote_scenario_velocity(s, 1, &velocity, &spin);
    assert_true(velocity.y == 0.5 * s->length && fabs(spin.z - acos(0.0)) < 1e-15);
    mote_scenario_destroy(s);
}

/* The sine of half a turn tells no axis. */
TEST(mote_scenario_velocity_of_half_a_turn_is_about_its_axis)
{
    static const double axes[][3] = {{1, 0, 0},  {0, 1, 0}, {0, 0, 1},   {1, 2, 2},
                                     {-3, 4, 0}, {1, 1, 1}, {-2, -3, 6}, {0, 1, -1}};
    static const double degrees[] = {180, 179.99999, 150, 100, -180, -135};
    for (size_t i = 0; i < ROWS_OF(axes) * ROWS_OF(degrees); ++i) {
        const double *a = axes[i / ROWS_OF(degrees)], turn = degrees[i % ROWS_OF(degrees)];
        const double radians = turn / 57.29577951308232;
        char motion[200];
        mote_scenario *s = NULL;
        mote_vec3 velocity, spin;
        (void)snprintf(motion, sizeof motion,
                       "{\"frame\": 2, \"axis\": [%g, %g, %g], \"degrees\": %.17g}", a[0], a[1],
                       a[2], turn);
        test_row("%s", motion);
        write_changed("{\"frame\": 40, \"axis\": [0, 0, 1], \"degrees\": 60}", motion);
        assert_int_equal(mote_scenario_load(FILE_NAME, &s), MOTE_OK);
        mote_scenario_velocity(s, 0, &velocity, &spin);
        mote_scenario_destroy(s);
        const mote_vec3 axis = mote_vec3_make(a[0], a[1], a[2]);
        const mote_vec3 wanted = mote_scale(axis, radians / mote_length(axis));
        /* Half a turn is the same both ways. */
        const double off = mote_length(mote_sub(spin, wanted));
        const double other = mote_length(mote_add(spin, wanted));
        if (!(off < 1e-7 || (fabs(turn) == 180 && other < 1e-7)))
            fail_msg("%g %g %g", spin.x, spin.y, spin.z);
    }
}

/* An independent FNV-1a over explicit bytes. */
TEST(mote_scenario_fingerprint_matches_a_hash_of_written_bytes)
{
    mote_scenario *s = load_good();
    uint64_t fingerprint, again, hash = 14695981039346656037u;
    assert_int_equal(mote_scenario_fingerprint(s, &fingerprint), MOTE_OK);
    assert_int_equal(mote_scenario_fingerprint(s, &again), MOTE_OK);
    assert_true(fingerprint == again);
    mote_frame_buffer *buffer;
    buffer = mote_frame_buffer_create(s);
    for (uint32_t number = 1; number <= s->frames; ++number) {
        const mote_frame *frame = mote_scenario_frame(s, buffer, number, number - 1);
        for (int i = 0; i < 2; ++i) {
            for (uint32_t v = 0; v < s->body[i].mesh->vertex_count; ++v) {
                const mote_vec3 p = mote_body_position(&s->body[i], &frame->body[i], v);
                unsigned char bytes[24];
                memcpy(bytes, &p, sizeof bytes); /* little-endian, as the machine */
                for (int b = 0; b < 24; ++b)
                    hash = (hash ^ bytes[b]) * 1099511628211u;
            }
        }
    }
    assert_true(hash == fingerprint);
    mote_frame_buffer_destroy(buffer);
    mote_scenario_destroy(s);
}

typedef struct bad_case {
    const char *from, *to; /* change of good_text */
    const char *place;     /* start of the message, after the file's name */
    const char *what;      /* part of it */
} bad_case;

/* A field of body 1, in line 15, with this displacement. */
#define FIELD(displacement)                                                                    \
    "\"triangles\": 500",                                                                      \
        "\"triangles\": 500, \"field\": {\"centres\": [[0, 0, 0], [0.2, 0, 0]], \"support\": " \
        "0.5, \"displacement\": " displacement "}",                                            \
        ":15: bodies[1].field.displacement"
#define SINE(keys) FIELD("{\"sines\": [{" keys "}, {}]}")
#define SINE_GOOD "\"control\": 2, \"amplitude\": [0, 0, 0.1]"
#define KEYS(first) FIELD("{\"keyframes\": [{" first "}, {\"frame\": 9}]}")
#define RANDOM(keys) FIELD("{\"random\": {" keys "}}")
#define TURN(frame, degrees)                                                                   \
    "{\"frame\": " frame ", \"axis\": [0, 0, 1], \"degrees\": " degrees "}, "
#define POSE(keys) "{\"frame\": 20, \"position\": [1, 0, 0]}", "{" keys "}"

static const bad_case bad_cases[] = {
    {FIELD("3"), "is 3; give an object"},
    {FIELD("{}"), "exactly one"},
    {FIELD("{\"sines\": [], \"random\": {}}"), "exactly one"},
    {FIELD("{\"sines\": 3}"), "array of 1 to"},
    {SINE("\"speed\": 1"), "unknown key; known here are control"},
    {SINE("\"control\": 3"), "1 to 2"},
    {SINE("\"control\": 0"), "1 to 2"},
    {SINE("\"control\": 2, \"amplitude\": 1"), "array of 3"},
    {SINE(SINE_GOOD ", \"period\": 0"), "out of range"},
    {SINE(SINE_GOOD ", \"period\": 30, \"phase\": \"x\""), "phase: is a string; give a number"},
    {SINE(SINE_GOOD ", \"period\": 30, \"phase\": 0.5"), "control: is missing"},
    {RANDOM("\"speed\": 1"), "unknown key; known here are seed"},
    {RANDOM("\"seed\": 1, \"amplitude\": -1"), "out of range"},
    {RANDOM("\"seed\": 1, \"amplitude\": 1, \"terms\": 65"), "1 to 64"},
    {RANDOM("\"seed\": 1, \"amplitude\": 1, \"terms\": 3"), "periods: is missing"},
    {FIELD("{\"keyframes\": {}}"), "array of 1 to"},
    {KEYS("\"speed\": 1"), "unknown key; known here are frame"},
    {KEYS("\"frame\": 0"), "out of range"},
    {KEYS("\"frame\": 1, \"vectors\": [[0, 0, 0]]"), "array of 2"},
    {KEYS("\"frame\": 1, \"vectors\": [[0, 0], [0, 0, 0]]"), "array of 3"},
    {KEYS("\"frame\": 1, \"vectors\": [[0, 0, 0], [0, 0, 1e9]]"), "out of range"},
    {"\"count\": 14, ", "", ":10: bodies[0].field: ", "neither"},
    {"\"count\": 14", "\"centres\": [[0, 0, \"x\"], [1, 1, 1]]",
     ":10: bodies[0].field.centres[0][2]: ", "is a string"},
    {"\"count\": 14", "\"centres\": []", ":10: bodies[0].field.centres: ", "array of 1 to"},
    {"\"count\": 14", "\"count\": 14, \"kind\": \"csrbf\", \"mass\": 1",
     ":10: bodies[0].field.mass: ", "unknown key"},
    {POSE("\"frame\": 20, \"quaternion\": [1, 0, 0, 0], \"degrees\": 3"),
     ":17: bodies[1].motion[1]: ", "has two rotations"},
    {POSE("\"frame\": 20, \"quaternion\": [1, 0, 0, 0], \"axis\": [1, 0, 0]"),
     ":17: bodies[1].motion[1]: ", "has two rotations"},
    {POSE("\"frame\": 20, \"quaternion\": [1, 0, 0]"),
     ":17: bodies[1].motion[1].quaternion: ", "array of 4"},
    {POSE("\"frame\": 20, \"axis\": [1, 0, 0]"),
     ":17: bodies[1].motion[1].degrees: ", "is missing"},
    {POSE("\"frame\": 20, \"speed\": 1"), ":17: bodies[1].motion[1].speed: ", "unknown key"},
    {"\"motion\": [{\"frame\": 1, \"position\": [2, 0, 0]}", "\"motion\": [3",
     ":16: bodies[1].motion[0]: ", "is 3; give an object"},
    /* Short steps beside a long one: the curve overshoots through the origin. */
    {"\"degrees\": 0}",
     "\"degrees\": 90}, " TURN("2", "0")
         TURN("12", "180") "{\"frame\": 13, \"axis\": [0, 0, 1], \"degrees\": 90}",
     ":13: bodies[0].motion: ", "frame 7: rotations too far apart"},
    {"\"triangles\": 500,", "\"triangles\": 500, \"velocity\": 3, \"spin\": [0, 0, 1],",
     ":15: bodies[1].velocity: ", "array of 3"},
    {"\"triangles\": 500,", "\"triangles\": 500, \"velocity\": [0, 0, 1], \"spin\": 3,",
     ":15: bodies[1].spin: ", "array of 3"},
    {"\"triangles\": 500,\n     \"motion\": [", "\"triangles\": 500, \"motion\": 3, \"x\": [",
     ":15: bodies[1].x: ", "unknown key"},
    {"\"letter\": \"V\", \"triangles\": 500,\n     \"motion\": [",
     "\"letter\": \"V\", \"triangles\": 500, \"motion\": {}, \"spin\": [",
     ":15: bodies[1].spin: ", "array of 3"},
    {"\"letter\": \"V\", ", "", ":15: bodies[1]: ", "neither"},
    {"\"letter\": \"V\"", "\"letter\": \"V\", \"file\": \"a.obj\"", ":15: bodies[1]: ", "both"},
    {"\"letter\": \"V\"", "\"letter\": 3", ":15: bodies[1].letter: ", "is 3; give a string"},
    {"\"letter\": \"V\", \"triangles\": 500", "\"file\": 3",
     ":15: bodies[1].file: ", "is 3; give a string"},
    {"\"letter\": \"V\"", "\"letter\": \"V\", \"scale\": [1, 0, 1]",
     ":15: bodies[1].scale[1]: ", "out of range"},
    {"\"letter\": \"V\"", "\"letter\": \"V\", \"scale\": \"big\"",
     ":15: bodies[1].scale: ", "array of 3"},
    {"\"active\": [10, 40]", "\"active\": [\"x\", 40]", ":5: active[0]: ", "whole number"},
    {"\"active\": [10, 40]", "\"active\": [10]", ":5: active: ", "array of 2"},
    {"\"ask\": \"distance\"", "\"ask\": 3", ":6: ask: ", "is 3; give a string"},
    {"\"frames\": 40", "\"frames\": 40, \"start\": 0.5", ":3: start: ", "out of range"},
    {"\"frames\": 40", "\"frames\": 40, \"pace\": 0", ":3: pace: ", "out of range"},
    {"\"purpose\": \"a test\"", "\"purpose\": \"\"",
     ":2: purpose: ", "is an empty string; give one that is not empty"},
    {"\"frames\": 40", "\"frames\": 40,\n \"fps\": 3", ":4: fps: ", "unknown key"},
    {"\"frames\": 40", "\"frames\": 0", ":3: frames: ", "out of range"},
    {"\"frames\": 40", "\"frames\": 1e9", ":3: frames: ", "out of range"},
    {"\"frames\": 40", "\"frames\": 40.5", ":3: frames: ", "is 40.5; give a whole number"},
    {"\"frames\": 40", "\"frames\": 40, \"frames\": 41", ":3:", "uplicate"},
    {"\"active\": [10, 40]", "\"active\": [10, 41]", ":5: active[1]: ", "1 to 40"},
    {"\"active\": [10, 40]", "\"active\": [40, 10]", ":5: active: ", "empty"},
    {"\"distance\"", "\"speed\"", ":6: ask: ", "neither distance, contact nor impact"},
    {"0.01,", "-1,", ":7: tolerance: ", "out of range"},
    {"0.01,", "1e999,", ":7:", "overflow"},
    {"0.01,", "NaN,", ":7:", "token"},
    {"\"letter\": \"M\"", "\"letter\": \"?\"", ":9: bodies[0].letter: ", "letter"},
    {"\"letter\": \"M\"", "\"letter\": \"MM\"", ":9: bodies[0].letter: ", "not one letter"},
    {"600", "601", ":9: bodies[0].letter: ", "odd"},
    {"600", "-600", ":9: bodies[0].triangles: ", "out of range"},
    {"\"count\": 14", "\"count\": 14, \"centres\": [[0,0,0]]",
     ":10: bodies[0].field: ", "both"},
    {"\"count\": 14", "\"count\": 0", ":10: bodies[0].field.count: ", "1 to"},
    {"\"support\": 0.4", "\"support\": 0", ":10: bodies[0].field.support: ", "out of range"},
    {"\"count\": 14", "\"centres\": [[0,0,0],[0,0,0]]", ":10: bodies[0].field: ", "singular"},
    {"\"seed\": 5, ", "", ":11: bodies[0].field.displacement.random", "seed"},
    {"[20, 60]", "[60, 20]", ":12: bodies[0].field.displacement.random.periods: ", "shorter"},
    {"\"axis\": [0, 0, 1]", "\"axis\": [0, 0, 0]", ":13: bodies[0].motion[0].axis: ", "zero"},
    {"\"axis\": [0, 0, 1], \"degrees\": 0", "\"degrees\": 0",
     ":13: bodies[0].motion[0].axis: ", "missing"},
    {"{\"frame\": 40, \"axis\"", "{\"frame\": 1, \"axis\"",
     ":13: bodies[0].motion: ", "ascending"},
    {"\"frame\": 20, ", "\"frame\": 0, ", ":17: bodies[1].motion[1].frame: ", "out of range"},
    {"[1, 0, 0]", "[1, 0]", ":17: bodies[1].motion[1].position: ", "array of 3"},
    {"[1, 0, 0]", "[1, 0, \"x\"]", ":17: bodies[1].motion[1].position[2]: ", "is a string"},
    {"\"position\": [1, 0, 0]", "\"quaternion\": [1, 1, 0, 0]",
     ":17: bodies[1].motion[1].quaternion: ", "length"},
    {", \"position\": [1, 0, 0]", "", ":17: bodies[1].motion[1]: ", "sets nothing"},
    {"  ]\n}", "  ]\n", ":20:", "near end of file"},
};

TEST(mote_scenario_load_bad_file_names_line_and_path)
{
    for (size_t i = 0; i < ROWS_OF(bad_cases); ++i) {
        const bad_case *bad = &bad_cases[i];
        write_changed(bad->from, bad->to);
        mote_scenario *scenario = NULL;
        assert_int_equal(mote_scenario_load(FILE_NAME, &scenario), MOTE_EINVAL);
        assert_null(scenario);
        const char *text = mote_error_text();
        char *place = mote_format("%s%s", FILE_NAME, bad->place);
        assert_non_null(place);
        if (strncmp(text, place, strlen(place)) != 0 || !strstr(text, bad->what))
            fail_msg("case %zu: \"%s\" lacks \"%s\" or \"%s\"", i, text, place, bad->what);
        assert_null(strchr(text, '\n'));
        free(place);
    }
}

/* Every prefix of a valid file is refused without a crash. */
TEST(mote_scenario_load_truncated_anywhere_is_refused)
{
    for (size_t size = 0; size + 2 < sizeof good_text; ++size) {
        file_write(FILE_NAME, good_text, size);
        mote_scenario *scenario = NULL;
        assert_int_equal(mote_scenario_load(FILE_NAME, &scenario), MOTE_EINVAL);
        assert_null(scenario);
    }
}

TEST(mote_scenario_load_not_a_file_is_refused)
{
    mote_scenario *scenario = NULL;
    assert_int_equal(mote_scenario_load("no/such/file.json", &scenario), MOTE_EIO);
    assert_int_equal(mote_scenario_load("./", &scenario), MOTE_EINVAL);
    assert_int_equal(mote_scenario_load("/dev/zero", &scenario), MOTE_EINVAL);
    assert_int_equal(mkfifo("pipe.json", 0600), 0);
    assert_int_equal(mote_scenario_load("pipe.json", &scenario), MOTE_EINVAL);
    assert_int_equal(mote_scenario_load("ww ww", &scenario), MOTE_EIO);
    assert_non_null(strstr(mote_error_text(), "known are"));
    assert_null(scenario);
}

TEST(mote_json_line_nested_path_is_found)
{
    static const char text[] =
        "{\"a\": \"x]}\\\"{\",\n \"b\": [1, {\"c\": 2,\n\"d\": [\n[], 5]}]}";
    assert_int_equal(mote_json_line(text, "a"), 1);
    assert_int_equal(mote_json_line(text, "b[1].c"), 2);
    assert_int_equal(mote_json_line(text, "b[1].d"), 3);
    assert_int_equal(mote_json_line(text, "b[1].d[1]"), 4);
    assert_int_equal(mote_json_line(text, "b[7].d[1]"), 2);
}

/* The second point is the farthest from the first, by brute force. */
TEST(mote_spread_points_are_far_apart)
{
    mote_scenario *s = load_good();
    const mote_mesh *mesh = s->body[0].mesh;
    mote_vec3 points[6];
    assert_int_equal(mote_spread(mesh, 6, points), MOTE_OK);
    for (int k = 1; k < 6; ++k) {
        double best = 0, own = 1e300;
        for (uint32_t v = 0; v < mesh->vertex_count; ++v) {
            double nearest = 1e300;
            for (int j = 0; j < k; ++j)
                nearest = fmin(nearest, mote_distance_squared(mesh->positions[v], points[j]));
            best = fmax(best, nearest);
        }
        for (int j = 0; j < k; ++j)
            own = fmin(own, mote_distance_squared(points[k], points[j]));
        assert_true(own == best);
    }
    mote_scenario_destroy(s);
}

static void write_like(const char *text)
{
    file_put("like.json", text);
}

/* Frame k of one is frame 1 + 3 (k - 1) + 4 of the other; the second body has a path of its
   own. */
TEST(mote_scenario_load_like_takes_what_it_does_not_name)
{
    mote_scenario *base = load_good();
    write_like("{\"purpose\": \"other\", \"like\": \"s.json\", \"frames\": 9, \"start\": 5,"
               " \"pace\": 3, \"warmup\": null, \"active\": [2, 3], \"bodies\": [{},"
               " {\"triangles\": 402, \"scale\": [1, 2, 0.5], \"motion\": null}]}");
    mote_scenario *like;
    assert_int_equal(mote_scenario_load("like.json", &like), MOTE_OK);
    assert_string_equal(like->purpose, "other");
    assert_int_equal(like->warmup.last, 0);
    assert_int_equal(like->active.last, 3);
    assert_int_equal(like->body[0].mesh->triangle_count, 600);
    assert_int_equal(like->body[1].mesh->triangle_count, 402);
    assert_null(like->motion->body[1].position);
    mote_frame_buffer *one, *other;
    one = mote_frame_buffer_create(base);
    other = mote_frame_buffer_create(like);
    for (uint32_t k = 1; k <= 9; ++k) {
        const mote_frame *a = mote_scenario_frame(base, one, 5 + 3 * (k - 1), 0);
        const mote_frame *b = mote_scenario_frame(like, other, k, 0);
        assert_memory_equal(&a->body[0].pose.rotation, &b->body[0].pose.rotation,
                            sizeof(mote_mat3));
        const mote_vec3 p = mote_body_position(&base->body[0], &a->body[0], 77);
        const mote_vec3 q = mote_body_position(&like->body[0], &b->body[0], 77);
        assert_true(mote_length(mote_sub(p, q)) < 1e-14);
    }
    mote_frame_buffer_destroy(one);
    mote_frame_buffer_destroy(other);
    mote_scenario_destroy(base);
    mote_scenario_destroy(like);
}

TEST(mote_scenario_load_like_in_a_circle_or_missing_is_refused)
{
    mote_scenario *scenario = NULL;
    write_like("{\"purpose\": \"x\",\n\"like\": \"like.json\"}");
    assert_int_equal(mote_scenario_load("like.json", &scenario), MOTE_EINVAL);
    assert_non_null(strstr(mote_error_text(), "like.json:2: like: "));
    write_like("{\"purpose\": \"x\",\n\"like\": \"nothing\"}");
    assert_int_equal(mote_scenario_load("like.json", &scenario), MOTE_EINVAL);
    assert_non_null(strstr(mote_error_text(), "nothing.json"));
    assert_null(scenario);
}

/* One in our folder, and one in a folder below. */
TEST(mote_scenario_load_like_one_elsewhere_finds_its_meshes)
{
    mote_scenario *like;
    write_like("{\"like\": \"flat\", \"frames\": 2, \"purpose\": \"x\"}");
    assert_int_equal(mote_scenario_load("like.json", &like), MOTE_OK);
    assert_true(like->body[0].mesh->triangle_count > 0);
    mote_scenario_destroy(like);
    static const char mesh[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    assert_int_equal(mote_directory_make("below"), MOTE_OK);
    file_put("below/a.obj", mesh);
    write_like("{\"frames\": 2, \"purpose\": \"x\", \"ask\": \"distance\", \"bodies\": "
               "[{\"file\": \"a.obj\"}, {\"file\": \"a.obj\", \"motion\": [{\"frame\": 1, "
               "\"position\": [0, 0, 1]}]}]}");
    assert_int_equal(rename("like.json", "below/base.json"), 0);
    write_like("{\"like\": \"below/base.json\", \"frames\": 3, \"purpose\": \"y\"}");
    assert_int_equal(mote_scenario_load("like.json", &like), MOTE_OK);
    assert_int_equal(like->body[1].mesh->triangle_count, 1);
    mote_scenario_destroy(like);
}

/* A key given here replaces the other scenario's, whatever that was. */
TEST(mote_scenario_load_like_with_what_does_not_fit_is_refused)
{
    static const struct {
        const char *more, *says;
    } cases[] = {{"\"active\": {\"first\": 2}", "active: is an object; give an array of 2"},
                 {"\"bodies\": [{}]", "bodies: is an array of 1; give an array of 2"},
                 {"\"bodies\": 3", "bodies: is 3; give an array of 2"},
                 {"\"bodies\": [3, {}]", "bodies[0]: is 3; give an object"},
                 {"\"bodies\": null", "bodies: is missing"}};
    mote_scenario *scenario = NULL;
    mote_scenario_destroy(load_good());
    for (size_t k = 0; k < ROWS_OF(cases); ++k) {
        char *text = mote_format("{\"like\": \"s.json\", %s}\n", cases[k].more);
        write_like(text);
        free(text);
        assert_int_equal(mote_scenario_load("like.json", &scenario), MOTE_EINVAL);
        if (!strstr(mote_error_text(), cases[k].says))
            fail_msg("%s: %s", cases[k].more, mote_error_text());
    }
    file_put("list.json", "[]");
    write_like("{\"purpose\": \"x\",\n\"like\": \"list.json\"}");
    assert_int_equal(mote_scenario_load("like.json", &scenario), MOTE_EINVAL);
    assert_non_null(strstr(mote_error_text(),
                           "like.json:2: like: list.json:1: is an array of 0; "
                           "give an object, which a scenario is"));
    write_like("{\"purpose\": \"x\",\n\"like\": \"/proc/self/x.json\"}");
    assert_int_equal(mote_scenario_load("like.json", &scenario), MOTE_EINVAL);
    assert_non_null(strstr(mote_error_text(), "like.json:2: like: /proc/self/x.json"));
    write_like("{\"purpose\": \"x\",\n\"like\": 3}");
    assert_int_equal(mote_scenario_load("like.json", &scenario), MOTE_EINVAL);
    assert_non_null(strstr(mote_error_text(), "like.json:2: like: is 3; give a string"));
    assert_null(scenario);
}

TEST(mote_scenario_load_missing_mesh_file_is_refused)
{
    write_changed("\"letter\": \"M\", \"triangles\": 600", "\"file\": \"none.obj\"");
    mote_scenario *scenario = NULL;
    assert_int_equal(mote_scenario_load(FILE_NAME, &scenario), MOTE_EINVAL);
    assert_non_null(strstr(mote_error_text(), "s.json:9: bodies[0].file: "
                                              "none.obj: "));
    write_changed("\"letter\": \"M\",", "\"letter\": \"M\", \"scale\": 0,");
    assert_int_equal(mote_scenario_load(FILE_NAME, &scenario), MOTE_EINVAL);
    assert_non_null(strstr(mote_error_text(), "bodies[0].scale: "));
    assert_null(scenario);
}

/* The paper's scenarios have the sizes stated in the paper. */
TEST(mote_scenario_load_paper_scenarios_have_the_paper_s_sizes)
{
    static const struct {
        const char *name;
        uint32_t triangles[2], controls[2], frames_at_least;
        mote_ask ask;
    } facts[] = {{"ww", {11920, 11920}, {14, 14}, 1984, MOTE_ASK_DISTANCE},
                 {"tt", {1380, 1380}, {0, 0}, 300, MOTE_ASK_CONTACT},
                 {"mv", {2968, 1764}, {14, 12}, 500, MOTE_ASK_DISTANCE}};
    for (size_t i = 0; i < 3; ++i) {
        mote_scenario *s;
        assert_int_equal(mote_scenario_load(facts[i].name, &s), MOTE_OK);
        for (int b = 0; b < 2; ++b) {
            assert_int_equal(s->body[b].mesh->triangle_count, facts[i].triangles[b]);
            assert_int_equal(s->body[b].field->count, facts[i].controls[b]);
        }
        assert_true(s->frames >= facts[i].frames_at_least);
        assert_int_equal(s->ask, facts[i].ask);
        if (i == 0) {
            assert_int_equal(s->frames, 1984);
            assert_int_equal(s->warmup.last, 49);
            assert_int_equal(s->active.first, 950);
            assert_int_equal(s->active.last, 1984);
        }
        mote_scenario_destroy(s);
    }
}
