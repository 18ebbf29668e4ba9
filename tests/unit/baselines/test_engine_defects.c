/* The known defects of Coal, Bullet and ODE (datasets/defects.md). As in test_defects.c, a test
   passes while the library shows the defect; it is skipped if the library was not found. */
#include "core/body/deform.h"
#include "harness/base/memory.h"
#include "harness/scene/scenario.h"
#include "tests/support/peers/bullet_defects.h"
#include "tests/support/peers/coal_defects.h"
#include "tests/support/peers/ode_defects.h"
#include "tests/support/test.h"

#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#define MENDED "the library no longer shows this defect; see datasets/defects.md"

#ifdef MOTE_HAVE_COAL

/* Body 0 of a scenario in frames 1, 1 + step, ...; the caller frees both. */
static mote_vec3 *poses_of(const char *name, uint32_t step, uint32_t count,
                           mote_scenario **scenario)
{
    assert_int_equal(mote_scenario_load(name, scenario), MOTE_OK);
    const mote_body *body = &(*scenario)->body[0];
    mote_deform *deform = NULL;
    assert_int_equal(mote_deform_create(body, &deform), MOTE_OK);
    mote_frame_buffer *buffer = mote_frame_buffer_create(*scenario);
    mote_vec3 *vertices =
        mote_allocate((size_t)count * body->mesh->vertex_count, sizeof *vertices);
    for (uint32_t k = 0; k < count; ++k)
        mote_deform_all(deform,
                        &mote_scenario_frame(*scenario, buffer, 1 + step * k, 0)->body[0],
                        vertices + (size_t)k * body->mesh->vertex_count);
    mote_frame_buffer_destroy(buffer);
    mote_deform_destroy(deform);
    return vertices;
}

TEST(coal_refit_bottom_up_leaves_triangles_outside_of_oriented_boxes)
{
    static const struct {
        coal_volume volume;
        const char *name;
        bool wrong; /* bottom-up */
    } volumes[] = {{COAL_AABB, "AABB", false},
                   {COAL_OBB, "OBB", true},
                   {COAL_RSS, "RSS", false},
                   {COAL_OBBRSS, "OBBRSS", true},
                   {COAL_KIOS, "kIOS", true}};
    mote_scenario *scenario = NULL;
    enum { POSES = 10 };
    mote_vec3 *vertices = poses_of("mv", 60, POSES, &scenario);
    for (size_t i = 0; i < ROWS_OF(volumes); ++i) {
        for (int bottom_up = 1; bottom_up >= 0; --bottom_up) {
            const coal_refit r = mote_coal_refit(volumes[i].volume, bottom_up,
                                                 scenario->body[0].mesh, vertices, POSES);
            print_message("Coal's %s, refitted %s: %ld of %ld volumes do not contain their "
                          "triangles, by up to %.2g L\n",
                          volumes[i].name, bottom_up ? "bottom-up" : "top-down", r.failing,
                          r.volumes, r.worst);
            if (bottom_up && volumes[i].wrong && r.failing == 0)
                fail_msg(MENDED);
            if (bottom_up && !volumes[i].wrong)
                assert_int_equal(r.failing, 0);
        }
    }
    free(vertices);
    mote_scenario_destroy(scenario);
}

/* The fit of swept rectangles to several triangles, which a top-down refit is made of, leaves
   corners outside; RSS and, with it, OBBRSS. A bottom-up refit fits single triangles. */
TEST(coal_fit_of_swept_rectangles_leaves_triangles_outside)
{
    enum { POSES = 190 };
    mote_scenario *scenario = NULL;
    mote_vec3 *vertices = poses_of("twist", 3, POSES, &scenario);
    for (int both = 0; both < 2; ++both) {
        const coal_refit r = mote_coal_refit(both ? COAL_OBBRSS : COAL_RSS, false,
                                             scenario->body[0].mesh, vertices, POSES);
        print_message(
            "Coal's %s, refitted top-down on twist: %ld of %ld volumes do not contain "
            "their triangles, by up to %.2g L\n",
            both ? "OBBRSS" : "RSS", r.failing, r.volumes, r.worst);
        if (r.failing == 0)
            fail_msg(MENDED);
    }
    free(vertices);
    mote_scenario_destroy(scenario);
    if (!(mote_coal_fit_outside() > 0.04))
        fail_msg(MENDED);
}

TEST(coal_sum_of_oriented_boxes_does_not_contain_them)
{
    assert_true(mote_coal_sum_outside(-20) < 1e-12);
    if (!(mote_coal_sum_outside(20) > 0.2))
        fail_msg(MENDED);
}

TEST(coal_bound_of_axis_aligned_boxes_leaves_axes_out)
{
    if (fabs(mote_coal_aabb_bound() - 5) < 1e-12)
        fail_msg(MENDED);
    assert_true(mote_coal_aabb_bound() < 5); /* too low: slow, but not wrong */
}

#else

TEST(coal_was_not_found)
{
    (void)fprintf(stderr, "skipped: Coal was not found when this was built\n");
}

#endif /* MOTE_HAVE_COAL */

#ifdef MOTE_HAVE_BULLET

TEST(bullet_refit_keeps_the_bounds_it_was_built_with)
{
    assert_true(mote_bullet_contacts_after_a_move(1, 0) > 0);
    assert_true(mote_bullet_contacts_after_a_move(1, 0.5F) > 0);
    assert_true(mote_bullet_contacts_after_a_move(16, 8) > 0);
    print_message("GImpact, contacts of two crossing triangles of size 16 moved by 32: %d\n",
                  mote_bullet_contacts_after_a_move(16, 32));
    if (mote_bullet_contacts_after_a_move(16, 32) > 0 ||
        mote_bullet_contacts_after_a_move(1, 6) > 0)
        fail_msg(MENDED);
}

#else

TEST(bullet_was_not_found)
{
    (void)fprintf(stderr, "skipped: Bullet was not found when this was built\n");
}

#endif /* MOTE_HAVE_BULLET */

#ifdef MOTE_HAVE_ODE

TEST(ode_finds_no_contact_of_a_single_triangle)
{
    assert_true(mote_ode_contacts((const int[]){2, 2}) > 0);
    if (mote_ode_contacts((const int[]){1, 2}) > 0 ||
        mote_ode_contacts((const int[]){2, 1}) > 0)
        fail_msg(MENDED);
}

TEST(ode_crashes_on_two_single_triangles)
{
    const pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        (void)signal(SIGSEGV, SIG_DFL);
        (void)close(STDERR_FILENO);
        (void)mote_ode_contacts((const int[]){1, 1});
        _exit(0);
    }
    int status;
    assert_int_equal(waitpid(child, &status, 0), child);
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0)
        fail_msg(MENDED);
}

#else

TEST(ode_was_not_found)
{
    (void)fprintf(stderr, "skipped: ODE was not found when this was built\n");
}

#endif /* MOTE_HAVE_ODE */
