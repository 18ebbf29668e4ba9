/* Certified mode at its limits: of precision, boxes tested, room and memory. */
#include "core/certificate/certificate_state.h"
#include "harness/base/heap_count.h"

#include <stddef.h>

#include "tests/support/certificate_scene.h"
#include "tests/support/methods.h"
#include "tests/support/test.h"
#include "tests/support/truth.h"

TEST(query_with_slack_returns_a_bracket)
{
    const double slacks[3] = {1e-6, 1e-3, 0.2};
    scene s;
    scene_init(&s, 18, 9, 1, true);
    mote_certificate *c[3];
    for (int i = 0; i < 3; ++i) {
        mote_certificate_options options = mote_default_certificate_options(s.length);
        options.slack = slacks[i];
        c[i] = certificate_of(&s, &options);
    }
    for (int k = 0; k < 30; ++k) {
        scene_next(&s, 1.4, false);
        const double truth = scene_truth(&s);
        for (int i = 0; i < 3; ++i) {
            mote_certificate_answer a;
            mote_certificate_query(c[i], &s.frame, NULL, -1, &a);
            check_bracket(&s, &a, truth);
            assert_true(a.distance - a.lower <= (slacks[i] + 1e-12) * s.length);
        }
    }
    for (int i = 0; i < 3; ++i)
        mote_certificate_destroy(c[i]);
    scene_free(&s);
}

/* Fourth powers of the distance leave the range of floats. Where floats decide nothing, double
   precision finds the answer. The start is the worst: faces in the order of the mesh. */
TEST(query_far_beyond_the_range_of_floats_finds_the_nearest)
{
    scene s;
    scene_init(&s, 18, 9, 1, true);
    mote_certificate_options options = mote_default_certificate_options(s.length);
    options.seed = MOTE_CERT_SEED_PAIR;
    mote_certificate *c = certificate_of(&s, &options);
    for (int k = 0; k < 12; ++k) {
        const double far = pow(10, 3 + k % 6 * 1.6) * s.length;
        scene_next(&s, 1, false);
        s.frame.body[1].pose.translation =
            mote_vec3_make(scene_random(&s, -1, 1) * far, far, scene_random(&s, -1, 1) * far);
        mote_deform_all(s.deform[1], &s.frame.body[1], s.world[1]);
        const double truth = scene_truth(&s);
        uint32_t first[2][3];
        for (int b = 0; b < 2; ++b)
            memcpy(first[b], s.mesh[b]->triangles[k], sizeof first[b]);
        mote_certificate_answer a;
        mote_certificate_query(c, &s.frame, (const uint32_t(*)[3])first, -1, &a);
        assert_true(fabs(a.distance - truth) <= 1e-13 * truth);
        assert_true(a.lower <= truth);
    }
    mote_certificate_destroy(c);
    scene_free(&s);
}

/* Nor can a double hold the square of the distance: it is infinite then, until the bodies come
   back. A tracker finds no pair there, and certified does without. */
TEST(query_beyond_the_range_of_squares_is_infinite)
{
    static const char *const keys[] = {"", "seed=tracked", "seed=none"};
    for (size_t k = 0; k < ROWS_OF(keys); ++k) {
        scene s;
        scene_init(&s, 18, 9, 1, true);
        method_run u;
        method_run_init(&u, "certified", keys[k], scene_setup(&s, MOTE_ASK_DISTANCE, 0, NULL));
        for (int frame = 0; frame < 3; ++frame) {
            const bool far = frame < 2;
            scene_next(&s, 1, false);
            if (far)
                s.frame.body[1].pose.translation.x = 1e200;
            mote_deform_all(s.deform[1], &s.frame.body[1], s.world[1]);
            const mote_answer a = method_run_ask(&u, &s.frame);
            const double truth = far ? 1e200 : scene_truth(&s);
            test_row("%s, frame %d", keys[k], frame);
            assert_true(a.lower >= 0 && a.lower <= truth * (1 + 1e-12));
            assert_true(far ? isinf(a.distance) && !a.contact
                            : fabs(a.distance - truth) <= 1e-12 * s.length);
        }
        method_run_free(&u);
        scene_free(&s);
    }
}

/* Contact is reported where the bracket shows it, or where nothing ended the query early. */
TEST(report_says_whether_contact_is_decided)
{
    static const struct {
        double lower, distance;
        bool stopped, exact, has_contact, contact;
    } rows[] = {{0.1, 0.5, false, false, true, true}, /* within the tolerance, 1 */
                {1.5, 2, false, false, true, false},  /* beyond it */
                {1.5, 2, true, false, true, false},
                {0.5, 2, false, false, false, false}, /* by the slack alone not decided */
                {0.5, 2, true, true, false, false},   /* nor by a budget */
                {1, 1.0000001, false, true, true, false}};
    for (size_t k = 0; k < ROWS_OF(rows); ++k) {
        for (int ask = 0; ask < 2; ++ask) {
            const mote_certificate_answer bracket = {.lower = rows[k].lower,
                                                     .distance = rows[k].distance,
                                                     .stopped = rows[k].stopped};
            mote_answer a = {.has_distance = false};
            mote_certificate_report(&bracket, ask ? MOTE_ASK_CONTACT : MOTE_ASK_DISTANCE, 1,
                                    rows[k].exact, &a);
            test_row("row %zu, asking for %s", k, ask ? "contact" : "the distance");
            assert_int_equal(a.has_contact, rows[k].has_contact);
            assert_int_equal(a.contact, rows[k].contact);
            assert_int_equal(a.has_distance, !ask);
            assert_int_equal(a.has_witness, !ask || rows[k].contact);
        }
    }
}

TEST(query_with_budget_returns_an_honest_bracket)
{
    const uint64_t budgets[5] = {0, 8, 60, 400, 3000};
    scene s;
    scene_init(&s, 24, 12, 1, true);
    for (int i = 0; i < 5; ++i) {
        mote_certificate_options options = mote_default_certificate_options(s.length);
        options.seed = MOTE_CERT_SEED_NONE;
        options.budget = budgets[i];
        options.plane = i % 2;
        mote_certificate *c = certificate_of(&s, &options);
        int stopped = 0;
        for (int k = 0; k < 15; ++k) {
            scene_next(&s, 1.1, false);
            const double truth = scene_truth(&s);
            mote_certificate_answer a;
            mote_certificate_query(c, &s.frame, NULL, -1, &a);
            check_bracket(&s, &a, truth);
            stopped += a.stopped;
            assert_true(a.stopped || a.distance <= truth + 1e-12 * s.length);
        }
        if (budgets[i] <= 8)
            assert_true(stopped > 0);
        mote_certificate_destroy(c);
    }
    scene_free(&s);
}

/* After a leap the search does not start from the new place of the last faces. */
TEST(query_after_a_leap_costs_about_as_much_as_a_cold_one)
{
    scene s;
    scene_init(&s, 60, 30, 1, true);
    mote_certificate_options none = mote_default_certificate_options(s.length);
    none.seed = MOTE_CERT_SEED_NONE;
    mote_certificate *warm = certificate_of(&s, NULL);
    mote_certificate *cold = certificate_of(&s, &none);
    uint64_t positions[2] = {0, 0};
    for (int k = 0; k < 200; ++k) {
        scene_next(&s, 1.3, false);
        mote_certificate_answer a[2];
        mote_certificate_query(warm, &s.frame, NULL, -1, &a[0]);
        mote_certificate_query(cold, &s.frame, NULL, -1, &a[1]);
        assert_true(fabs(a[0].distance - a[1].distance) <= 1e-15 * s.length);
        for (int i = 0; i < 2; ++i)
            positions[i] += a[i].counters.positions;
    }
    assert_true((double)positions[0] < 2 * (double)positions[1]);
    mote_certificate_destroy(warm);
    mote_certificate_destroy(cold);
    scene_free(&s);
}

TEST(query_when_its_rooms_are_full_gives_the_same)
{
    scene s;
    scene_init(&s, 40, 16, 1, true);
    mote_certificate *roomy = certificate_of(&s, NULL);
    mote_certificate *tight = certificate_of(&s, NULL);
    for (int b = 0; b < 2; ++b) {
        tight->side[b].node_room = 1;
        tight->side[b].lazy.limit = 0;
    }
    for (int k = 0; k < 40; ++k) {
        scene_next(&s, 1.1, false);
        mote_certificate_answer a, b;
        mote_certificate_query(roomy, &s.frame, NULL, -1, &a);
        mote_certificate_query(tight, &s.frame, NULL, -1, &b);
        assert_true(fabs(a.distance - b.distance) <= 1e-15 * s.length);
        assert_true(b.counters.blocks >= a.counters.blocks);
    }
    mote_certificate_destroy(roomy);
    mote_certificate_destroy(tight);
    scene_free(&s);
}

TEST(query_from_frame_fifty_on_does_not_allocate)
{
    if (!mote_heap_read().counted)
        skip();
    scene s;
    scene_init(&s, 60, 30, 1, true);
    mote_certificate *c = certificate_of(&s, NULL);
    uint64_t before = 0;
    for (int k = 0; k < 400; ++k) {
        scene_next(&s, 1.3, false);
        if (k == 50)
            before = mote_heap_read().allocations;
        mote_certificate_answer a;
        mote_certificate_query(c, &s.frame, NULL, -1, &a);
    }
    assert_int_equal(mote_heap_read().allocations, before);
    mote_certificate_destroy(c);
    scene_free(&s);
}

TEST(bytes_of_a_large_pair_stay_below_180_a_vertex)
{
    scene s;
    scene_init(&s, 120, 50, 1, true);
    const int64_t before = mote_heap_read().live_bytes;
    mote_certificate *c = certificate_of(&s, NULL);
    const double vertices = s.mesh[0]->vertex_count + s.mesh[1]->vertex_count;
    const double bytes = (double)mote_certificate_bytes(c);
    assert_true(bytes < 180 * vertices);
    assert_true(bytes > 40 * vertices);
    if (mote_heap_read().counted) {
        const double live = (double)(mote_heap_read().live_bytes - before);
        assert_true(fabs(live - bytes) < 0.02 * bytes);
    }
    mote_certificate_destroy(c);
    scene_free(&s);
}
