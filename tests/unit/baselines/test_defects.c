/* The libraries' known defects (datasets/defects.md). A test here passes while the library
   shows the defect. When it fails, the library has been fixed, and the adapter's workaround can
   go. */
#include "tests/support/peers/ccd_triangle.h"
#include "tests/support/peers/fcl_defects.h"
#include "tests/support/peers/fcl_triangle.h"
#include "tests/support/peers/hacd_defects.h"
#include "baselines/wide_triangle.h"
#include "core/body/deform.h"
#include "harness/scene/scenario.h"
#include "tests/support/shapes.h"
#include "tests/support/methods.h"
#include "tests/support/test.h"

#include <ccd/ccd.h>
#include <float.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#define MENDED "the library no longer shows this defect; see datasets/defects.md"

static void *create(const char *name, const char *options, const scene *s, mote_ask ask)
{
    double values[MOTE_PARAMETERS_MAX];
    const mote_method *m = method_with(name, options, values);
    mote_setup setup = scene_setup(s, ask, 0, values);
    void *state = NULL;
    assert_int_equal(m->create(&setup, &state), MOTE_OK);
    return state;
}

static mote_answer answer(const char *name, void *state, const mote_frame *frame)
{
    return method_answer(mote_method_find(name), state, frame);
}

/* In how many of `frames` random poses without deformation is a method wrong? For a contact
   question, a missed contact is wrong; *contacts is how many there were. */
static int count_wrong(const char *name, const char *options, mote_ask ask, int frames,
                       int *contacts)
{
    scene s;
    scene_init(&s, 14, 9, 1, true);
    void *tested = create(name, options, &s, ask);
    void *truth = create("fcl-aabb", "", &s, MOTE_ASK_DISTANCE);
    int wrong = 0;
    *contacts = 0;
    for (int f = 0; f < frames; ++f) {
        mote_frame frame = *scene_next(&s, ask == MOTE_ASK_CONTACT ? 0.9 : 1.3, true);
        for (int b = 0; b < 2; ++b) {
            memset(s.weights[b], 0, sizeof s.weights[b]);
            mote_deform_all(s.deform[b], &frame.body[b], s.world[b]);
            frame.body[b].shape_changed = true;
        }
        mote_answer a = answer(name, tested, &frame);
        double expected = answer("fcl-aabb", truth, &frame).distance;
        *contacts += expected == 0;
        if (ask == MOTE_ASK_CONTACT)
            wrong += expected == 0 && !a.contact;
        else
            wrong += fabs(a.distance - expected) > 1e-9 * s.length;
    }
    mote_method_find(name)->destroy(tested);
    mote_method_find("fcl-aabb")->destroy(truth);
    scene_free(&s);
    return wrong;
}

static void expect_wrong(const char *name, mote_ask ask, const char *what)
{
    int contacts, frames = 40;
    int wrong = count_wrong(name, "update=refit-bottom-up", ask, frames, &contacts);
    print_message("%s, refitted bottom-up: %d of %d %s\n", name, wrong,
                  ask == MOTE_ASK_CONTACT ? contacts : frames, what);
    if (wrong == 0)
        fail_msg(MENDED);
    assert_int_equal(count_wrong(name, "update=refit-top-down", ask, frames, &contacts), 0);
}

TEST(fcl_refit_bottom_up_of_rss_gives_wrong_distances)
{
    expect_wrong("fcl-rss", MOTE_ASK_DISTANCE, "distances are wrong");
    expect_wrong("fcl-obbrss", MOTE_ASK_DISTANCE, "distances are wrong");
}

TEST(fcl_refit_bottom_up_of_rss_misses_contacts)
{
    expect_wrong("fcl-rss", MOTE_ASK_CONTACT, "contacts are missed");
}

TEST(fcl_sum_of_rss_has_skew_axes)
{
    double cosine = mote_fcl_rss_sum_cosine();
    print_message("largest cosine between axes of a sum: %.3f\n", cosine);
    if (cosine < 1e-9)
        fail_msg(MENDED);
}

/* Of random pairs of triangles of a size, apart by at least a tenth of it: how many does FCL
   take for intersecting, and how many does libccd? */
static void count_false_contacts(double size, int wrong[2])
{
    scene s = {.random = 5};
    wrong[0] = wrong[1] = 0;
    for (int i = 0; i < 2000; ++i) {
        mote_vec3 t[2][3];
        for (int k = 0; k < 6; ++k) {
            t[k / 3][k % 3] =
                mote_vec3_make(scene_random(&s, -size, size), scene_random(&s, -size, size),
                               scene_random(&s, -size, size));
        }
        if (mote_triangle_triangle(t[0], t[1], NULL, NULL) < 0.01 * size * size)
            continue;
        wrong[0] += mote_fcl_triangle_distance(t[0], t[1]) == 0;
        wrong[1] += mote_ccd_triangles_touch(t[0], t[1]);
    }
}

TEST(fcl_sum_of_oriented_boxes_does_not_contain_them)
{
    assert_true(mote_fcl_obb_sum_outside(-20) < 1e-12);
    if (!(mote_fcl_obb_sum_outside(20) > 0.2))
        fail_msg(MENDED);
}

/* Whether a method says that a scenario's bodies touch in frame 101. */
static bool touches_in_frame_101(const mote_scenario *scenario, const char *name,
                                 const char *options)
{
    double values[MOTE_PARAMETERS_MAX];
    const mote_method *m = method_with(name, options, values);
    const mote_setup setup = {.body = {&scenario->body[0], &scenario->body[1]},
                              .length = scenario->length,
                              .ask = MOTE_ASK_CONTACT,
                              .values = values};
    void *state = NULL;
    assert_int_equal(m->create(&setup, &state), MOTE_OK);
    mote_frame_buffer *buffer = mote_frame_buffer_create(scenario);
    mote_frame frame = *mote_scenario_frame(scenario, buffer, 101, 0);
    mote_vec3 *vertices[2];
    for (int b = 0; b < 2; ++b) {
        mote_deform *deform = NULL;
        assert_int_equal(mote_deform_create(&scenario->body[b], &deform), MOTE_OK);
        vertices[b] = calloc(scenario->body[b].mesh->vertex_count, sizeof *vertices[b]);
        assert_non_null(vertices[b]);
        mote_deform_all(deform, &frame.body[b], vertices[b]);
        frame.body[b].vertices = vertices[b];
        mote_deform_destroy(deform);
    }
    const bool touches = answer(name, state, &frame).contact;
    m->destroy(state);
    mote_frame_buffer_destroy(buffer);
    free(vertices[0]);
    free(vertices[1]);
    return touches;
}

TEST(fcl_fit_of_a_triangle_without_area_is_elsewhere)
{
    const double off = mote_fcl_fit_without_area();
    print_message("centre of the box around a triangle without area: %.3f away\n", off);
    if (off < 1e-9)
        fail_msg(MENDED);
}

TEST(fcl_triangles_without_area_touch_far_away)
{
    const int touching = mote_fcl_contacts_without_area();
    print_message("far pairs without area that touch by FCL: %d of 6\n", touching);
    if (touching == 0)
        fail_msg(MENDED);
}

/* The two together, and on the scenario that has such faces, in a frame in which the bodies
   are apart. */
TEST(fcl_refit_bottom_up_of_faces_without_area_invents_contacts)
{
    static const char *const volumes[] = {"fcl-obb", "fcl-rss", "fcl-obbrss", "fcl-kios"};
    assert_false(mote_fcl_far_models_collide(false));
    if (!mote_fcl_far_models_collide(true))
        fail_msg(MENDED);
    mote_scenario *scenario = NULL;
    assert_int_equal(mote_scenario_load("spider", &scenario), MOTE_OK);
    for (size_t i = 0; i < ROWS_OF(volumes); ++i) {
        assert_false(touches_in_frame_101(scenario, volumes[i], "update=refit-top-down"));
        if (!touches_in_frame_101(scenario, volumes[i], "update=refit-bottom-up"))
            fail_msg(MENDED);
    }
    mote_scenario_destroy(scenario);
}

TEST(fcl_distance_of_small_triangles_is_zero)
{
    int large[2], small[2];
    count_false_contacts(1, large);
    count_false_contacts(1e-6, small);
    print_message("separated pairs at distance 0 by FCL: size 1: %d, size 1e-6: %d\n", large[0],
                  small[0]);
    assert_int_equal(large[0], 0);
    if (small[0] == 0)
        fail_msg(MENDED);
}

/* Triangles with integer coordinates: a corner of one, (2, 2, 1) and (2, 2, 2), lies in the
   other. */
TEST(fcl_distance_of_triangles_that_touch_is_not_zero)
{
    static const mote_vec3 pairs[2][2][3] = {
        {{{3, 3, 1}, {0, 1, 2}, {3, 2, 0}}, {{1, 2, 3}, {1, 1, 2}, {2, 2, 1}}},
        {{{1, 1, 2}, {2, 0, 0}, {2, 2, 2}}, {{1, 3, 3}, {2, 2, 1}, {3, 1, 2}}}};
    for (int i = 0; i < 2; ++i) {
        assert_true(reference_triangle_triangle(pairs[i][0], pairs[i][1]) == 0);
        const double said = mote_fcl_triangle_distance(pairs[i][0], pairs[i][1]);
        print_message("two triangles that touch, by FCL: %.3f apart\n", said);
        if (said == 0)
            fail_msg(MENDED);
    }
}

TEST(fcl_distance_of_oriented_boxes_is_missing)
{
    if (mote_fcl_obb_distance() != DBL_MAX)
        fail_msg(MENDED);
}

TEST(fcl_memory_usage_is_a_status)
{
    if (mote_fcl_memory_usage() != 0)
        fail_msg(MENDED);
}

TEST(fcl_replace_after_update_fails)
{
    if (mote_fcl_replace_after_update() == 0)
        fail_msg(MENDED);
}

TEST(fcl_builds_models_of_nan)
{
    if (!mote_fcl_builds_with_nan())
        fail_msg(MENDED);
}

/* Convex sets as a list of points. */
typedef struct points {
    int count;
    double xyz[128][3];
} points;

static void support(const void *object, const ccd_vec3_t *direction, ccd_vec3_t *point)
{
    const points *p = object;
    double best = -DBL_MAX;
    for (int k = 0; k < p->count; ++k) {
        double h = p->xyz[k][0] * direction->v[0] + p->xyz[k][1] * direction->v[1] +
                   p->xyz[k][2] * direction->v[2];
        if (h > best) {
            best = h;
            ccdVec3Set(point, p->xyz[k][0], p->xyz[k][1], p->xyz[k][2]);
        }
    }
}

static void centre(const void *object, ccd_vec3_t *result)
{
    const points *p = object;
    ccdVec3Set(result, 0, 0, 0);
    for (int k = 0; k < p->count; ++k) {
        for (int axis = 0; axis < 3; ++axis)
            result->v[axis] += p->xyz[k][axis];
    }
    for (int axis = 0; axis < 3; ++axis)
        result->v[axis] /= p->count;
}

static ccd_t ccd_settings(void)
{
    ccd_t ccd;
    CCD_INIT(&ccd);
    ccd.support1 = ccd.support2 = support;
    ccd.center1 = ccd.center2 = centre;
    ccd.max_iterations = 100;
    return ccd;
}

/* Whether a heap says so depends on the heap: after enough of them, glibc's and ASan's do. */
TEST(hacd_hull_frees_a_vertex_twice)
{
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        (void)signal(SIGABRT, SIG_DFL);
        (void)signal(SIGSEGV, SIG_DFL);
        (void)close(STDERR_FILENO);
        mote_hacd_hulls(1000);
        _exit(0);
    }
    int status;
    assert_int_equal(waitpid(child, &status, 0), child);
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0)
        fail_msg(MENDED);
}

TEST(ccd_mpr_loops_for_ever)
{
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        const points a = {3, {{3, 1, 0}, {1, 1, 0}, {0, 2, 1}}};
        const points b = {3, {{3, 1, 0}, {1, 1, 0}, {0, 3, 2}}};
        ccd_t ccd = ccd_settings();
        signal(SIGALRM, SIG_DFL);
        alarm(2);
        _exit(ccdMPRIntersect(&a, &b, &ccd) ? 1 : 0);
    }
    int status;
    assert_int_equal(waitpid(child, &status, 0), child);
    if (!WIFSIGNALED(status) || WTERMSIG(status) != SIGALRM)
        fail_msg(MENDED);
}

TEST(ccd_gjk_of_small_triangles_is_wrong)
{
    scene s = {.random = 9};
    int hits = 0, missed = 0;
    for (int i = 0; i < 4000; ++i) {
        mote_vec3 t[2][3], small[2][3];
        for (int k = 0; k < 6; ++k) {
            t[k / 3][k % 3] = mote_vec3_make(scene_random(&s, -1, 1), scene_random(&s, -1, 1),
                                             scene_random(&s, -1, 1));
            small[k / 3][k % 3] = mote_scale(t[k / 3][k % 3], 1e-3);
        }
        if (mote_triangle_triangle(t[0], t[1], NULL, NULL) > 0 ||
            !mote_ccd_triangles_touch(t[0], t[1]))
            continue;
        hits++;
        missed += !mote_ccd_triangles_touch(small[0], small[1]);
    }
    int tiny[2], large[2];
    count_false_contacts(1e-6, tiny);
    count_false_contacts(1, large);
    print_message("libccd at size 1e-3 misses %d of %d hits; at 1e-6 it has %d false ones\n",
                  missed, hits, tiny[1]);
    assert_int_equal(large[1], 0);
    if (missed == 0 || tiny[1] == 0)
        fail_msg(MENDED);
}

/* A cube of side 2 around (0, 0, z). */
static points cube_at(double z)
{
    points p = {.count = 8};
    for (int k = 0; k < 8; ++k) {
        p.xyz[k][0] = k & 1 ? 1 : -1;
        p.xyz[k][1] = k & 2 ? 1 : -1;
        p.xyz[k][2] = z + (k & 4 ? 1 : -1);
    }
    return p;
}

TEST(ccd_epa_of_cubes_has_no_direction)
{
    const points a = cube_at(0), b = cube_at(1.9);
    ccd_t ccd = ccd_settings();
    ccd_real_t depth;
    ccd_vec3_t direction, position;
    assert_int_equal(ccdGJKPenetration(&a, &b, &ccd, &depth, &direction, &position), 0);
    print_message("cubes overlapping by 0.1: depth %g, direction (%g, %g, %g)\n", depth,
                  direction.v[0], direction.v[1], direction.v[2]);
    if (isfinite(direction.v[0]) && depth > 0.09)
        fail_msg(MENDED);
}

/* Points on a sphere of radius 0.5 around (x, 0, 0), turned by an angle about x. */
static points sphere_at(double x, double angle)
{
    points p = {.count = 128};
    for (int k = 0; k < p.count; ++k) {
        double z = 1 - (2 * k + 1.0) / p.count, r = sqrt(1 - z * z), u = 2.399963 * k + angle;
        p.xyz[k][0] = x + 0.5 * z;
        p.xyz[k][1] = 0.5 * r * cos(u);
        p.xyz[k][2] = 0.5 * r * sin(u);
    }
    return p;
}

/* The depth at the default tolerance, 1e-4, against that at 1e-9. The tolerance is on squared
   lengths, so at unit size shallow depths are noise. */
TEST(ccd_epa_at_the_default_tolerance_is_coarse)
{
    int coarse = 0, count = 0;
    double worst = 1;
    for (double x = 0.9; x < 0.99; x += 0.001) {
        const points a = sphere_at(0, 0), b = sphere_at(x, 1);
        ccd_t ccd = ccd_settings();
        ccd_real_t depth[2];
        ccd_vec3_t direction, position;
        for (int k = 0; k < 2; ++k) {
            ccd.epa_tolerance = k == 0 ? 1e-4 : 1e-9;
            depth[k] = 0;
            ccdGJKPenetration(&a, &b, &ccd, &depth[k], &direction, &position);
        }
        if (!(depth[1] > 0.002))
            continue;
        count++;
        coarse += !(fabs(depth[0] - depth[1]) < 0.1 * depth[1]);
        worst = fmin(worst, depth[0] / depth[1]);
    }
    print_message("%d of %d depths are off by over a tenth, one by a factor of %.2g\n", coarse,
                  count, worst);
    if (coarse == 0)
        fail_msg(MENDED);
}

static mote_mesh *one_triangle(const double corners[9])
{
    static const uint32_t face[3] = {0, 1, 2};
    mote_mesh *mesh = NULL;
    assert_int_equal(mote_mesh_create(corners, 3, face, 1, &mesh), MOTE_OK);
    return mesh;
}

TEST(bullet_gimpact_of_triangles_apart_is_a_contact)
{
    static const double first[9] = {-1.25, -0.25, 1.25, -0.5, 0, 2.25, -0.25, 0.25, 2};
    static const double second[9] = {0.25, 0, 1, 0.25, -0.5, 1.5, -0.25, -1, 1.75};
    if (!mote_method_find("bullet-gimpact")) /* skipped if its library is missing */
        skip();
    scene s;
    scene_init_meshes(&s, one_triangle(first), one_triangle(second), false);
    mote_frame frame = {.number = 1};
    for (int b = 0; b < 2; ++b) {
        for (int k = 0; k < 3; ++k)
            frame.body[b].pose.rotation.m[k][k] = 1;
        frame.body[b].shape_changed = frame.body[b].pose_changed = true;
        frame.body[b].vertices = s.mesh[b]->positions;
    }
    assert_true(mote_triangle_triangle(s.mesh[0]->positions, s.mesh[1]->positions, NULL, NULL) >
                0.25 * s.length * s.length);
    void *state = create("bullet-gimpact", "", &s, MOTE_ASK_CONTACT);
    if (!answer("bullet-gimpact", state, &frame).contact)
        fail_msg(MENDED);
    mote_method_destroy(mote_method_find("bullet-gimpact"), state);
    scene_free(&s);
}

TEST(fcl_linear_motion_of_two_poses_reads_what_is_not_set)
{
    if (mote_fcl_turn_moves_by(false) <= 1)
        fail_msg(MENDED);
    assert_true(mote_fcl_turn_moves_by(true) <= 1e-12);
}
