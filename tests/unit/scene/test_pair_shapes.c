/* The default scenario of two meshes keeps its promise for typical meshes. */
#include "harness/base/file.h"
#include "harness/run/truth.h"
#include "tests/support/folder.h"
#include "tests/support/test.h"

#include <math.h>
#include <sys/stat.h>

/* The box of size x, y, z, two triangles a side. */
static void box_text(double x, double y, double z, mote_text *text)
{
    for (int i = 0; i < 8; ++i)
        mote_text_add(text, "v %.17g %.17g %.17g\n", i & 1 ? x : 0, i & 2 ? y : 0,
                      i & 4 ? z : 0);
    mote_text_add(text, "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n");
}

/* A sphere of 12 by 12; if `half`, only its southern half, open. */
static void sphere_text(double radius, bool half, mote_text *text)
{
    const double pi = 3.14159265358979323846;
    const int rings = half ? 6 : 11, around = 12;
    mote_text_add(text, "v 0 0 %.17g\n", -radius);
    for (int r = 1; r <= rings; ++r) {
        for (int k = 0; k < around; ++k) {
            const double down = pi * r / 12, turn = 2 * pi * k / around;
            mote_text_add(text, "v %.17g %.17g %.17g\n", radius * sin(down) * cos(turn),
                          radius * sin(down) * sin(turn), -radius * cos(down));
        }
    }
    for (int k = 0; k < around; ++k)
        mote_text_add(text, "f 1 %d %d\n", 2 + (k + 1) % around, 2 + k);
    for (int r = 0; r + 1 < rings; ++r) {
        for (int k = 0; k < around; ++k) {
            const int a = 2 + around * r + k, b = 2 + around * r + (k + 1) % around;
            mote_text_add(text, "f %d %d %d\nf %d %d %d\n", a, b, b + around, a, b + around,
                          a + around);
        }
    }
    const int last = 2 + around * (rings - 1);
    if (half)
        return;
    mote_text_add(text, "v 0 0 %.17g\n", radius);
    for (int k = 0; k < around; ++k)
        mote_text_add(text, "f %d %d %d\n", last + around, last + k, last + (k + 1) % around);
}

/* A prism one high over a polygon of corners in the plane. */
static void prism_text(const double (*corners)[2], int count, mote_text *text)
{
    for (int level = 0; level < 2; ++level) {
        for (int k = 0; k < count; ++k)
            mote_text_add(text, "v %g %g %d\n", corners[k][0], corners[k][1], level);
    }
    for (int k = 0; k < count; ++k) {
        const int next = (k + 1) % count;
        mote_text_add(text, "f %d %d %d %d\n", k + 1, next + 1, count + next + 1,
                      count + k + 1);
    }
    mote_text_add(text, "f");
    for (int k = count; k > 0; --k)
        mote_text_add(text, " %d", k);
    mote_text_add(text, "\nf");
    for (int k = 1; k <= count; ++k)
        mote_text_add(text, " %d", count + k);
    mote_text_add(text, "\n");
}

static void put(const char *name, mote_text *text)
{
    char path[128];
    (void)snprintf(path, sizeof path, "%s.obj", name);
    file_write(path, text->data, text->size);
    free(text->data);
    *text = (mote_text){0};
}

/* A "U": the middle of its box is outside. */
static const double u[][2] = {{0, 0},     {3, 0},     {3, 3},   {2.8, 3},
                              {2.8, 0.2}, {0.2, 0.2}, {0.2, 3}, {0, 3}};

static int make_meshes(void)
{
    mote_text text = {0};
    box_text(1, 1, 1, &text);
    put("cube", &text);
    box_text(1e-6, 1e-6, 1e-6, &text);
    put("mite", &text);
    box_text(1, 1, 1e-3, &text);
    put("plate", &text);
    box_text(1e100, 1e100, 1e100, &text);
    put("star", &text);
    box_text(1e-100, 1e-100, 1e-100, &text);
    put("atom", &text);
    box_text(1e14, 1e14, 1e14, &text);
    put("moon", &text);
    box_text(1e-2, 1e-2, 2, &text);
    put("rod", &text);
    sphere_text(0.5, false, &text);
    put("sphere", &text);
    sphere_text(0.5, true, &text);
    put("bowl", &text);
    prism_text(u, 8, &text);
    put("u", &text);
    mote_text_add(&text,
                  "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
    put("tetrahedron", &text);
    mote_text_add(&text, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    put("triangle", &text);
    return 0;
}

TEST_GROUP(make_meshes, NULL);

/* The controls' displacements differ from frame to frame. */
static void check_deformation(const mote_scenario *scenario)
{
    mote_frame_buffer *buffer;
    buffer = mote_frame_buffer_create(scenario);
    for (uint32_t k = 2; k <= scenario->frames; ++k) {
        (void)mote_scenario_frame(scenario, buffer, k - 1, 0);
        const mote_frame *frame = mote_scenario_frame(scenario, buffer, k, k - 1);
        assert_true(frame->body[0].shape_changed && frame->body[1].shape_changed);
    }
    mote_frame_buffer_destroy(buffer);
}

/* 1,000 frames, the first contact between frames 100 and 200, contact in 10 to 20 % of frames,
   apart at the end. The truth is from two methods that were not used to make the motion. */
static void check_pair(const char *a, const char *b, const char *direction)
{
    char name[256];
    mote_scenario *scenario;
    mote_truth *truth;
    (void)snprintf(name, sizeof name,
                   "pair:"
                   "%s.obj:"
                   "%s.obj%s",
                   a, b, direction);
    if (mote_scenario_load(name, &scenario) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    assert_int_equal(scenario->frames, 1000);
    check_deformation(scenario);
    if (mote_truth_compute(scenario, &truth) != MOTE_OK)
        fail_msg("%s: %s", name, mote_error_text());
    uint32_t contacts = 0, first = 0;
    for (uint32_t k = 1; k <= truth->frames; ++k) {
        const bool touch = truth->distance[k - 1] == 0;
        contacts += touch;
        first = first == 0 && touch ? k : first;
    }
    if (contacts < 100 || contacts > 200 || first < 100 || first > 200 ||
        !(truth->distance[999] > 0.2 * scenario->length))
        fail_msg("%s: %u contacts from frame %u on, at last %g L apart", name, contacts, first,
                 truth->distance[999] / scenario->length);
    mote_truth_destroy(truth);
    mote_scenario_destroy(scenario);
}

TEST(pair_of_meshes_that_people_have_touches_as_promised)
{
    static const char *const pairs[][2] = {{"cube", "cube"},     {"cube", "sphere"},
                                           {"plate", "plate"},   {"plate", "cube"},
                                           {"rod", "rod"},       {"rod", "sphere"},
                                           {"u", "u"},           {"u", "sphere"},
                                           {"bowl", "bowl"},     {"bowl", "tetrahedron"},
                                           {"u", "rod"},         {"tetrahedron", "tetrahedron"},
                                           {"triangle", "cube"}, {"triangle", "triangle"}};
    for (size_t i = 0; i < ROWS_OF(pairs); ++i)
        check_pair(pairs[i][0], pairs[i][1], "");
}

TEST(pair_of_very_different_sizes_touches_as_promised)
{
    check_pair("cube", "mite", "");
    check_pair("mite", "cube", "");
    check_pair("u", "mite", "");
    check_pair("bowl", "mite", "");
}

/* Checks why bodies of such sizes get no motion. */
static void check_refused(const char *a, const char *b, const char *why)
{
    char name[256];
    mote_scenario *scenario;
    (void)snprintf(name, sizeof name, "pair:%s.obj:%s.obj", a, b);
    assert_int_equal(mote_scenario_load(name, &scenario), MOTE_EINVAL);
    if (!strstr(mote_error_text(), why))
        fail_msg("%s", mote_error_text());
}

TEST(pair_of_sizes_that_arithmetic_cannot_tell_apart_says_so)
{
    check_refused("star", "star", "contacts can be computed from");
    check_refused("atom", "atom", "contacts can be computed from");
    check_refused("cube", "moon", "lost in the rounding of the larger one");
}

TEST(pair_comes_along_a_direction_of_any_length)
{
    check_pair("cube", "cube", ":1e300,0,0");
    check_pair("cube", "cube", ":0,0,-1e-300");
}

TEST(pair_comes_along_the_given_direction)
{
    check_pair("cube", "sphere", ":0,0,-2");
    mote_scenario *scenario;
    mote_frame_buffer *buffer;
    assert_int_equal(mote_scenario_load("pair:cube.obj:sphere.obj:0,0,-2", &scenario), MOTE_OK);
    buffer = mote_frame_buffer_create(scenario);
    const mote_vec3 at =
        mote_scenario_frame(scenario, buffer, 1000, 0)->body[1].pose.translation;
    assert_true(fabs(at.x) < 1e-9 && fabs(at.y) < 1e-9 && at.z < 0);
    mote_frame_buffer_destroy(buffer);
    mote_scenario_destroy(scenario);
}
