/* Contact questions in a row: the direction that parted two bodies is tried again, on the roots
   of their trees. Every answer is compared with all pairs of triangles. */
#include "tests/support/certificate_scene.h"
#include "tests/support/test.h"
#include "tests/support/truth.h"

#define PATHS 12
#define STEPS 40

typedef struct tally {
    int apart, contacts;
    int quick; /* answered without any inner block or leaf */
} tally;

/* Turns body 1 a little about the z axis. */
static void turn_body(scene *s, double angle)
{
    const double c = cos(angle), d = sin(angle);
    mote_mat3 *r = &s->frame.body[1].pose.rotation;
    const mote_mat3 old = *r;
    for (int k = 0; k < 3; ++k) {
        r->m[0][k] = c * old.m[0][k] - d * old.m[1][k];
        r->m[1][k] = d * old.m[0][k] + c * old.m[1][k];
    }
}

/* Asks for contact along a path that comes and goes. enough: the tolerance, over L. */
static void walk(scene *s, mote_certificate *c, double enough, tally *sum)
{
    scene_next(s, 1.5, false);
    for (int k = 0; k < STEPS; ++k) {
        turn_body(s, 0.02);
        s->frame.body[1].pose.translation.x += 0.02 * cos(0.2 * k) * s->length;
        scene_step(s);
        const double truth = scene_truth(s);
        mote_certificate_answer a;
        mote_certificate_query(c, &s->frame, NULL, enough * s->length, &a);
        check_bracket(s, &a, truth);
        const bool contact = truth <= enough * s->length;
        assert_int_equal(a.distance <= enough * s->length, contact);
        assert_int_equal(a.lower > enough * s->length, !contact);
        sum->apart += !contact;
        sum->contacts += contact;
        sum->quick += a.counters.blocks <= 2 && a.counters.positions == 2 &&
                      a.counters.triangle_tests == 0;
    }
}

static void check_paths(bool deforming, mote_cert_seed seed, tally *sum)
{
    const double tolerances[3] = {0, 0.03, 0.3};
    for (int p = 0; p < PATHS; ++p) {
        scene s;
        scene_init(&s, 18, 9, p % 2 ? 1 : 1e6, deforming);
        mote_certificate_options options = mote_default_certificate_options(s.length);
        options.seed = seed;
        mote_certificate *c = certificate_of(&s, &options);
        walk(&s, c, tolerances[p % 3], sum);
        mote_certificate_destroy(c);
        scene_free(&s);
    }
}

TEST(contact_of_rigid_bodies_on_a_path_is_that_of_all_pairs)
{
    tally sum = {0, 0, 0};
    check_paths(false, MOTE_CERT_SEED_WITNESS, &sum);
    assert_in_range(sum.contacts, 20, PATHS * STEPS - 50);
    assert_in_range(sum.quick, sum.apart / 3, sum.apart);
}

TEST(contact_of_deforming_bodies_on_a_path_is_that_of_all_pairs)
{
    tally sum = {0, 0, 0};
    check_paths(true, MOTE_CERT_SEED_WITNESS, &sum);
    assert_in_range(sum.contacts, 20, PATHS * STEPS - 50);
    assert_in_range(sum.quick, sum.apart / 3, sum.apart);
}

/* No state is kept: no direction is remembered. */
TEST(contact_without_a_seed_looks_for_a_pair_every_time)
{
    tally sum = {0, 0, 0};
    check_paths(true, MOTE_CERT_SEED_NONE, &sum);
    assert_int_equal(sum.quick, 0);
}

/* A remembered direction is of no use after a leap to the other side of the other body. */
TEST(contact_after_a_leap_is_that_of_all_pairs)
{
    scene s;
    scene_init(&s, 18, 9, 1, true);
    mote_certificate *c = certificate_of(&s, NULL);
    for (int k = 0; k < 60; ++k) {
        scene_next(&s, 1.2, false);
        s.frame.body[1].pose.translation.x *= k % 2 ? -1 : 1;
        mote_deform_all(s.deform[1], &s.frame.body[1], s.world[1]);
        const double truth = scene_truth(&s);
        mote_certificate_answer a;
        mote_certificate_query(c, &s.frame, NULL, 0, &a);
        check_bracket(&s, &a, truth);
        assert_int_equal(a.distance > 0, truth > 0);
        assert_int_equal(a.lower > 0, truth > 0);
    }
    mote_certificate_destroy(c);
    scene_free(&s);
}

/* One rigid body circles another in steps of 80 degrees: no direction parts them twice, but a
   turned one does, so that the boxes at rest are enough. */
TEST(contact_of_a_rigid_body_that_circles_is_denied_without_any_block)
{
    scene s;
    scene_init(&s, 18, 9, 1, false);
    mote_certificate *c = certificate_of(&s, NULL);
    scene_next(&s, 4, false);
    for (int k = 0; k < 50; ++k) {
        const double angle = 1.4 * k;
        s.frame.body[1].pose.translation =
            mote_vec3_make(4 * s.length * cos(angle), 4 * s.length * sin(angle), 0);
        scene_step(&s);
        mote_certificate_answer a;
        mote_certificate_query(c, &s.frame, NULL, 0, &a);
        test_row("step %d", k);
        check_bracket(&s, &a, scene_truth(&s));
        assert_true(a.lower > 0);
        assert_true(k == 0 || a.counters.blocks == 0);
    }
    mote_certificate_destroy(c);
    scene_free(&s);
}

/* Places body 1 along x, in the frame and in the world. */
static void place_at(scene *s, double x)
{
    s->frame.body[1].pose.translation = mote_vec3_make(x * s->length, 0, 0);
    mote_deform_all(s->deform[1], &s->frame.body[1], s->world[1]);
}

/* On the other side, so far away that a float cannot hold it, no direction is found; and so far
   that a double cannot hold its square, none is kept. The bracket is true all the same. */
TEST(contact_after_a_leap_beyond_floats_is_denied)
{
    static const double places[] = {2, -1e45, 3, -1e160, 1e170, 2};
    for (int deforming = 0; deforming < 2; ++deforming) {
        scene s;
        scene_init(&s, 18, 9, 1, deforming);
        mote_certificate *c = certificate_of(&s, NULL);
        scene_next(&s, 1, false);
        for (size_t k = 0; k < ROWS_OF(places); ++k) {
            place_at(&s, places[k]);
            ++s.frame.number;
            mote_certificate_answer a;
            mote_certificate_query(c, &s.frame, NULL, 0, &a);
            test_row("%d at %g", deforming, places[k]);
            assert_true(a.lower > 0 && a.lower <= fabs(places[k]) * s.length);
            assert_true(a.distance >= 0.5 * fabs(places[k]) * s.length);
        }
        mote_certificate_destroy(c);
        scene_free(&s);
    }
}
