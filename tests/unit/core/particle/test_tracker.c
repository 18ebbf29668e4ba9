/* The method `particle` through the interface, against all pairs of triangles. */
#include "core/particle/tracker_state.h"
#include "datasets/letter.h"
#include "harness/base/heap_count.h"
#include "tests/support/shapes.h"
#include "tests/support/methods.h"
#include "tests/support/test.h"
#include "tests/support/truth.h"

#include <stddef.h>

static void tracker_init(method_run *u, const scene *s, mote_ask ask, double tolerance,
                         const char *parameters)
{
    method_run_init(u, "particle", parameters, scene_setup(s, ask, tolerance, NULL));
}

/* A smooth motion: both bodies turn, body 1 approaches and recedes, the shapes oscillate. */
static const mote_frame *smooth_frame(scene *s, double apart)
{
    const double time = 0.02 * (double)s->frame.number++;
    for (int b = 0; b < 2; ++b) {
        mote_body_state *state = &s->frame.body[b];
        const double c = cos(time + b), d = sin(time + b);
        const double e = cos(0.7 * time), f = sin(0.7 * time);
        state->pose.rotation = (mote_mat3){{{c, -d, 0}, {d * e, c * e, -f}, {d * f, c * f, e}}};
        state->pose.translation = mote_vec3_make(
            b * (apart + 0.2 * sin(1.3 * time)) * s->length, 0.1 * b * cos(time), 0);
        for (uint32_t j = 0; j < s->field[b]->count; ++j) {
            for (int k = 0; k < 3; ++k)
                s->weights[b][k][j] = 0.05 * s->length * sin(time + 2 * j + k);
        }
        state->weights = (mote_weights){s->weights[b][0], s->weights[b][1], s->weights[b][2],
                                        s->field[b]->count, s->field[b]->padded};
        mote_deform_all(s->deform[b], state, s->world[b]);
        state->vertices = s->world[b];
        state->shape_changed = state->pose_changed = true;
    }
    return &s->frame;
}

/* Checks what every answer promises, whatever the search found. */
static void assert_answer(const scene *s, const mote_answer *a, double truth)
{
    assert_true(a->has_distance && a->has_witness && a->has_contact);
    assert_true(a->distance >= truth - 1e-12 * s->length);
    assert_true(a->contact == (a->distance <= 0));
    const double apart = mote_length(mote_sub(a->witness[1], a->witness[0]));
    assert_true(fabs(apart - a->distance) <= 1e-12 * s->length);
    for (int b = 0; b < 2; ++b)
        assert_true(scene_point_distance(s, b, a->witness[b]) <= 1e-12 * s->length);
}

/* Runs frames and returns the share of exact ones. */
static double run(scene *s, const char *parameters, int frames, bool smooth)
{
    method_run u;
    int exact = 0;
    tracker_init(&u, s, MOTE_ASK_DISTANCE, 0, parameters);
    for (int i = 0; i < frames; ++i) {
        const mote_frame *frame = smooth ? smooth_frame(s, 0.6) : scene_next(s, 1.2, false);
        const mote_answer a = method_run_ask(&u, frame);
        const double truth = scene_truth(s);
        assert_answer(s, &a, truth);
        exact += a.distance <= truth + 1e-9 * s->length;
    }
    method_run_free(&u);
    return exact / (double)frames;
}

static double run_tori(const char *parameters, int frames, bool deforming, bool smooth)
{
    scene s;
    scene_init(&s, 18, 10, 1, deforming);
    const double rate = run(&s, parameters, frames, smooth);
    scene_free(&s);
    return rate;
}

TEST(query_smooth_motion_nearly_always_exact)
{
    assert_true(run_tori("n=8", 80, true, true) >= 0.98);
    assert_true(run_tori("n=8,positions=given", 80, true, true) >= 0.98);
    assert_true(run_tori("n=8", 80, false, true) >= 0.98);
}

TEST(query_teleports_mostly_exact)
{
    assert_true(run_tori("n=16", 80, true, false) >= 0.9);
    assert_true(run_tori("n=16,positions=given", 80, true, false) >= 0.9);
}

TEST(query_switches_answers_on_surfaces)
{
    static const char *const choices[] = {
        "n=0",
        "n=1",
        "n=8,forces=on",
        "n=8,forces=on,reseed=off",
        "n=8,reseed=off",
        "n=8,leap=off",
        "n=8,descend=off",
        "n=8,start=random",
        "n=8,track=0,refine=1,launch=0",
        "n=8,forces=on,positions=given",
        "n=150,launch=150,track=64,refine=64",
    };
    for (size_t i = 0; i < sizeof choices / sizeof choices[0]; ++i) {
        run_tori(choices[i], 8, true, true);
        run_tori(choices[i], 8, true, false);
    }
}

/* A query after a jump must not rely on outdated positions: a tracker that comes from elsewhere
   finds what a new one finds. */
TEST(query_after_teleport_as_good_as_new)
{
    scene s;
    scene_init(&s, 24, 12, 1, true);
    method_run old;
    tracker_init(&old, &s, MOTE_ASK_DISTANCE, 0, "n=8,refine=64,track=64");
    for (int jump = 0; jump < 60; ++jump) {
        for (int i = 0; i < 5; ++i)
            method_run_ask(&old, smooth_frame(&s, 0.6));
        method_run fresh;
        tracker_init(&fresh, &s, MOTE_ASK_DISTANCE, 0, "n=8,refine=64,track=64");
        const mote_frame *frame = scene_next(&s, 1.2, false);
        const mote_answer a = method_run_ask(&old, frame);
        const mote_answer b = method_run_ask(&fresh, frame);
        assert_true(a.distance <= b.distance + 1e-12 * s.length);
        assert_true(a.distance == 0 || a.counters.launches >= 16);
        method_run_free(&fresh);
    }
    method_run_free(&old);
    scene_free(&s);
}

/* Bodies so far apart that no double holds the square of their distance, and positions that are
   no numbers, are refused, and what follows is answered as if they had not been. */
TEST(query_without_a_distance_is_refused_and_forgotten)
{
    static const double far[] = {1e200, HUGE_VAL, (double)NAN};
    for (size_t i = 0; i < ROWS_OF(far); ++i) {
        scene s;
        scene_init(&s, 24, 12, 1, true);
        method_run u;
        int exact = 0;
        test_row("%g away", far[i]);
        tracker_init(&u, &s, MOTE_ASK_DISTANCE, 0, "n=8");
        for (int k = 0; k < 120; ++k) {
            mote_frame frame = *smooth_frame(&s, 0.5);
            if (k == 20) {
                mote_answer answer = {0};
                frame.body[1].pose.translation.x += far[i];
                assert_int_equal(u.method->query(u.state, &frame, &answer), MOTE_EINVAL);
                assert_non_null(strstr(mote_error_text(), "too far apart"));
                assert_false(answer.has_distance || answer.has_contact);
                continue;
            }
            const mote_answer a = method_run_ask(&u, &frame);
            exact += fabs(a.distance - scene_truth(&s)) <= 1e-12 * s.length;
        }
        assert_true(exact >= 117);
        method_run_free(&u);
        scene_free(&s);
    }
}

TEST(query_same_frames_same_bits)
{
    mote_answer answers[2][40];
    for (int round = 0; round < 2; ++round) {
        scene s;
        scene_init(&s, 24, 12, 1, true);
        method_run u;
        tracker_init(&u, &s, MOTE_ASK_DISTANCE, 0, "n=8");
        for (int i = 0; i < 40; ++i)
            answers[round][i] =
                method_run_ask(&u, i % 7 ? smooth_frame(&s, 0.5) : scene_next(&s, 1, false));
        method_run_free(&u);
        scene_free(&s);
    }
    assert_memory_equal(answers[0], answers[1], sizeof answers[0]);
}

TEST(contact_question_as_the_distance_says)
{
    scene s;
    scene_init(&s, 120, 40, 1, true);
    const double tolerance = 0.02 * s.length;
    method_run distance, contact;
    tracker_init(&distance, &s, MOTE_ASK_DISTANCE, tolerance, "n=8,launch=8");
    tracker_init(&contact, &s, MOTE_ASK_CONTACT, tolerance, "n=8,launch=8");
    int contacts = 0;
    uint64_t checks[2] = {0}; /* exact checks in frames without contact */
    for (int i = 0; i < 200; ++i) {
        const mote_frame *frame = smooth_frame(&s, 0.7);
        const mote_answer a = method_run_ask(&distance, frame);
        const mote_answer b = method_run_ask(&contact, frame);
        assert_true(b.has_contact && !b.has_distance && !b.has_witness);
        assert_true(b.contact == a.contact);
        contacts += b.contact;
        if (!b.contact) {
            checks[0] += a.counters.refined;
            checks[1] += b.counters.refined;
        }
    }
    assert_in_range(contacts, 20, 180);
    assert_true(2 * checks[1] < checks[0]);
    method_run_free(&distance);
    method_run_free(&contact);
    scene_free(&s);
}

/* Without a tolerance the bodies have to meet, after a leap as well as in the frame in which
   they first do. */
TEST(contact_question_without_tolerance_as_the_distance_says)
{
    for (int leaps = 0; leaps < 2; ++leaps) {
        scene s;
        scene_init(&s, 40, 16, 1, true);
        method_run distance, contact;
        tracker_init(&distance, &s, MOTE_ASK_DISTANCE, 0, "n=8,launch=8");
        tracker_init(&contact, &s, MOTE_ASK_CONTACT, 0, "n=8,launch=8");
        int contacts = 0, apart = 0;
        for (int i = 0; i < 200; ++i) {
            const mote_frame *frame =
                leaps ? scene_next(&s, 1.2, false) : smooth_frame(&s, 0.6);
            const mote_answer a = method_run_ask(&distance, frame);
            const mote_answer b = method_run_ask(&contact, frame);
            test_row("frame %d, leaps: %d", i, leaps);
            assert_int_equal(b.contact, a.contact);
            contacts += a.contact;
            apart += !a.contact;
        }
        assert_true(contacts >= 20 && apart >= 20);
        method_run_free(&distance);
        method_run_free(&contact);
        scene_free(&s);
    }
}

/* A roof with its ridge along (x, y, 0), the rest below it (up -1) or above it. */
static mote_mesh *make_roof(double x, double y, double up)
{
    const double xyz[18] = {-x,    -y,    0,  x,      y,      0,  -x - y, -y + x, up,
                            x - y, y + x, up, -x + y, -y - x, up, x + y,  y - x,  up};
    static const uint32_t faces[8][3] = {{0, 1, 3}, {0, 3, 2}, {0, 4, 5}, {0, 5, 1},
                                         {2, 3, 5}, {2, 5, 4}, {0, 2, 4}, {1, 5, 3}};
    mote_mesh *mesh = NULL;
    assert_int_equal(mote_mesh_create(xyz, 6, &faces[0][0], 8, &mesh), MOTE_OK);
    return mesh;
}

/* Two ridges that cross, neither at right angles nor near a vertex, at a gap of the tolerance,
   which no number is rounded in, and with one bit more between them. */
TEST(contact_question_at_the_tolerance_is_a_contact)
{
    static const double tolerances[] = {0, 0.5, 0x1p-20};
    for (size_t i = 0; i < ROWS_OF(tolerances); ++i) {
        scene s;
        scene_init_meshes(&s, make_roof(0, 1, -1), make_roof(1, 1, 1), false);
        method_run u;
        tracker_init(&u, &s, MOTE_ASK_CONTACT, tolerances[i], "n=6");
        for (int k = 0; k < 12; ++k) {
            const bool beyond = k % 3 == 2;
            (void)scene_next(&s, 1, true);
            for (int b = 0; b < 2; ++b)
                s.frame.body[b].pose =
                    (mote_pose){.rotation = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}};
            s.frame.body[1].pose.translation =
                mote_vec3_make(0, k % 2 ? 0.25 : 0, tolerances[i] + (beyond ? 0x1p-40 : 0));
            test_row("tolerance %g, frame %d", tolerances[i], k);
            assert_int_equal(method_run_ask(&u, &s.frame).contact, !beyond);
        }
        method_run_free(&u);
        scene_free(&s);
    }
}

TEST(query_warm_no_allocation)
{
    scene s;
    scene_init(&s, 60, 24, 1, true);
    method_run u;
    tracker_init(&u, &s, MOTE_ASK_DISTANCE, 0, "n=8");
    uint64_t before = 0;
    for (int i = 0; i < 300; ++i) {
        const mote_frame *frame = smooth_frame(&s, 0.5);
        if (i == 50)
            before = mote_heap_read().allocations;
        method_run_ask(&u, frame);
    }
    if (mote_heap_read().counted)
        assert_true(mote_heap_read().allocations == before);
    method_run_free(&u);
    scene_free(&s);
}

/* Multiplies a frame by a factor; weights and vertices are the caller's. */
static mote_frame scaled_frame(const mote_frame *frame, double factor,
                               double weights[2][3][MOTE_FIELD_SUMMED])
{
    mote_frame made = *frame;
    for (int b = 0; b < 2; ++b) {
        mote_body_state *state = &made.body[b];
        const mote_weights *w = &frame->body[b].weights;
        const double *from[3] = {w->x, w->y, w->z};
        for (int k = 0; k < 3; ++k) {
            for (uint32_t j = 0; j < w->padded; ++j)
                weights[b][k][j] = factor * from[k][j];
        }
        state->pose.translation = mote_scale(state->pose.translation, factor);
        state->weights =
            (mote_weights){weights[b][0], weights[b][1], weights[b][2], w->count, w->padded};
        state->vertices = NULL;
    }
    return made;
}

TEST(query_scaled_by_powers_of_two_same_bits)
{
    for (int exponent = -60; exponent <= 60; exponent += 40) {
        const double factor = ldexp(1, exponent);
        scene s, t;
        scene_init(&s, 24, 12, 1, true);
        scene_init(&t, 24, 12, factor, true);
        method_run u, v;
        tracker_init(&u, &s, MOTE_ASK_DISTANCE, 0, "n=8");
        tracker_init(&v, &t, MOTE_ASK_DISTANCE, 0, "n=8");
        for (int i = 0; i < 40; ++i) {
            double weights[2][3][MOTE_FIELD_SUMMED];
            const mote_frame *frame = i % 9 ? smooth_frame(&s, 0.5) : scene_next(&s, 1, false);
            const mote_frame scaled = scaled_frame(frame, factor, weights);
            const mote_answer a = method_run_ask(&u, frame);
            mote_answer b = method_run_ask(&v, &scaled);
            b.distance /= factor;
            b.witness[0] = mote_scale(b.witness[0], 1 / factor);
            b.witness[1] = mote_scale(b.witness[1], 1 / factor);
            assert_memory_equal(&a, &b, sizeof a);
        }
        method_run_free(&u);
        method_run_free(&v);
        scene_free(&s);
        scene_free(&t);
    }
}

/* What is kept of a minimum that was found in a frame belongs to its vertices, also where an
   exact check moved it to others. */
TEST(minima_kept_after_a_query_have_the_distance_of_their_vertices)
{
    scene s;
    scene_init(&s, 40, 16, 1, true);
    mote_tracker *tracker = NULL;
    const mote_tracker_options options = mote_default_tracker_options();
    const mote_body *const bodies[2] = {&s.body[0], &s.body[1]};
    assert_int_equal(mote_tracker_create(bodies, s.length, &options, &tracker), MOTE_OK);
    int found = 0;
    for (int i = 0; i < 60; ++i) {
        const mote_frame *frame = i % 7 ? smooth_frame(&s, 0.6) : scene_next(&s, 1, false);
        mote_counters counters = {0};
        mote_refined best;
        mote_tracker_query(tracker, frame, false, HUGE_VAL, 0, &counters, &best);
        for (uint32_t k = 0; k < tracker->pair_count; ++k) {
            const mote_pair *pair = &tracker->pair[k];
            if (pair->travelled < tracker->travelled)
                continue;
            const mote_vec3 *a = &s.world[0][pair->vertex[0]],
                            *b = &s.world[1][pair->vertex[1]];
            test_row("frame %d, pair %u", i, k);
            assert_true(fabs(sqrt(pair->squared) - mote_length(mote_sub(*a, *b))) <=
                        1e-13 * s.length);
            for (int c = 0; c < 2; ++c)
                assert_memory_equal(&pair->shape[c], &s.mesh[c]->positions[pair->vertex[c]],
                                    sizeof pair->shape[c]);
            ++found;
        }
    }
    assert_true(found > 20);
    mote_tracker_destroy(tracker);
    scene_free(&s);
}

/* The particles are vertices of their bodies in the frame. The first pair is as near as the
   closest vertices of the answer's faces, and no more are written than there is room for. */
TEST(particles_after_query_are_vertices_nearest_first)
{
    scene s;
    scene_init(&s, 24, 12, 1, true);
    method_run u;
    tracker_init(&u, &s, MOTE_ASK_DISTANCE, 0, "n=8,track=5");
    mote_vec3 p[2][6], none = mote_vec3_make(7, 7, 7);
    assert_int_equal(u.method->particles(u.state, 0, p[0], 6), 0);
    size_t most = 0;
    for (int i = 0; i < 60; ++i) {
        const mote_answer a = method_run_ask(&u, smooth_frame(&s, 0.6));
        const size_t count = u.method->particles(u.state, 0, p[0], 6);
        assert_in_range(count, 1, 6);
        assert_int_equal(u.method->particles(u.state, 1, p[1], 6), count);
        most = count > most ? count : most;
        mote_vec3 first[2] = {none, none};
        assert_int_equal(u.method->particles(u.state, 0, first, 1), count);
        assert_memory_equal(&first[0], &p[0][0], sizeof none);
        assert_memory_equal(&first[1], &none, sizeof none);
        double before = 0;
        for (size_t k = 0; k < count; ++k) {
            for (int b = 0; b < 2; ++b) {
                uint32_t v = 0;
                while (v < s.mesh[b]->vertex_count &&
                       mote_distance_squared(s.world[b][v], p[b][k]) > 1e-24)
                    ++v;
                assert_true(v < s.mesh[b]->vertex_count);
            }
            const double apart = mote_length(mote_sub(p[0][k], p[1][k]));
            assert_true(apart >= a.distance - 1e-12);
            if (k > 1) /* those that did not walk again keep an earlier distance */
                assert_true(apart >= before - 0.1 * s.length);
            before = apart;
        }
        for (int b = 0; b < 2; ++b) /* on a face of the witness */
            assert_true(mote_length(mote_sub(p[b][0], a.witness[b])) <=
                        2 * s.mesh[b]->mean_edge);
    }
    assert_true(most > 1);
    p[0][0] = none;
    assert_true(u.method->particles(u.state, 0, p[0], 0) >= 1);
    assert_memory_equal(&p[0][0], &none, sizeof none);
    method_run_free(&u);
    scene_free(&s);
}

/* Without seeds there is nothing for forces to move. */
TEST(forces_without_seeds_change_nothing)
{
    scene s;
    scene_init(&s, 24, 12, 1, true);
    method_run with, without;
    tracker_init(&with, &s, MOTE_ASK_DISTANCE, 0, "n=0,forces=on");
    tracker_init(&without, &s, MOTE_ASK_DISTANCE, 0, "n=0");
    for (int i = 0; i < 20; ++i) {
        const mote_frame *frame = smooth_frame(&s, 0.6);
        const mote_answer a = method_run_ask(&with, frame);
        const mote_answer b = method_run_ask(&without, frame);
        assert_true(a.distance == b.distance);
        assert_int_equal(a.counters.positions, b.counters.positions);
        assert_int_equal(a.counters.steps, 0);
    }
    method_run_free(&with);
    method_run_free(&without);
    scene_free(&s);
}

TEST(create_bad_options_rejected)
{
    scene s;
    scene_init(&s, 12, 6, 1, false);
    const mote_body *bodies[2] = {&s.body[0], &s.body[1]};
    mote_tracker *tracker = NULL;
    mote_tracker_options o = mote_default_tracker_options();
    o.count = 73;
    assert_int_equal(mote_tracker_create(bodies, s.length, &o, &tracker), MOTE_EINVAL);
    assert_non_null(strstr(mote_error_text(), "72"));
    o = mote_default_tracker_options();
    o.track = MOTE_TRACK_MAX + 1;
    assert_int_equal(mote_tracker_create(bodies, s.length, &o, &tracker), MOTE_EINVAL);
    o = mote_default_tracker_options();
    o.refine = 0;
    assert_int_equal(mote_tracker_create(bodies, s.length, &o, &tracker), MOTE_EINVAL);
    assert_null(tracker);
    mote_tracker_destroy(NULL);
    scene_free(&s);
}
