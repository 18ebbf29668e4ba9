/* The method particle-paper through the interface: scale, rigid motion, seeds, components, tiny
   and open meshes, bad n. */
#include "core/method/method.h"

#include "tests/support/particle_scene.h"
#include "tests/support/methods.h"
#include "tests/support/test.h"

typedef struct paper_run {
    const mote_method *method;
    double values[MOTE_PARAMETERS_MAX];
    mote_setup setup;
    void *state;
} paper_run;

/* The status of creating the method with these parameters for the scene. */
static mote_status try_run(paper_run *r, const particle_scene *s, const char *parameters)
{
    memset(r, 0, sizeof *r);
    r->method = method_with("particle-paper", parameters, r->values);
    r->setup = (mote_setup){.body = {s->bodies[0], s->bodies[1]},
                            .length = s->length,
                            .ask = MOTE_ASK_DISTANCE,
                            .seed = 1,
                            .values = r->values};
    return r->method->create(&r->setup, &r->state);
}

static void start_run(paper_run *r, const particle_scene *s, const char *parameters)
{
    if (try_run(r, s, parameters) != MOTE_OK)
        fail_msg("%s: %s", parameters, mote_error_text());
}

static mote_answer ask(paper_run *r, const particle_scene *s)
{
    mote_answer answer;
    memset(&answer, 0, sizeof answer);
    if (r->method->update)
        assert_int_equal(r->method->update(r->state, &s->frame), MOTE_OK);
    assert_int_equal(r->method->query(r->state, &s->frame, &answer), MOTE_OK);
    assert_true(answer.has_distance && answer.has_witness && answer.has_contact);
    return answer;
}

static const char *const variants[] = {
    "n=5,refine=always",
    "n=8,refine=near,start=fps",
    "n=9,refine=no,reff=0",
    "n=9,refine=no,reff=inf",
    "n=16,move=surface,refine=no",
    "n=7,law=inverse,refine=always",
    "n=7,law=inverse-square,reff=0.4",
    "n=6,attract_a=inverse,repel_b=inverse-square",
    "n=12,coherent=no",
    "n=20,far_cache=0.1",
    "n=6,precision=single",
};
enum { VARIANTS = sizeof variants / sizeof *variants };

static void expect_scaled(mote_vec3 got, mote_vec3 expected, double unit)
{
    assert_true(got.x == expected.x * unit && got.y == expected.y * unit &&
                got.z == expected.z * unit);
}

TEST(answers_scaled_by_powers_of_two_keep_their_bits)
{
    for (int v = 0; v < VARIANTS; ++v) {
        for (int k = -40; k <= 40; k += v == 0 ? 1 : 16) {
            particle_scene s[2];
            paper_run r[2];
            for (int i = 0; i < 2; ++i) {
                scene_open(&s[i], solid_icosphere(2), solid_torus(12, 7), 6,
                           i ? ldexp(1, k) : 1);
                start_run(&r[i], &s[i], variants[v]);
            }
            for (int f = 0; f < 3; ++f) {
                mote_answer a[2];
                for (int i = 0; i < 2; ++i) {
                    scene_next(&s[i], 2 - 0.3 * f);
                    a[i] = ask(&r[i], &s[i]);
                }
                assert_true(a[1].distance == ldexp(a[0].distance, k));
                expect_scaled(a[1].witness[0], a[0].witness[0], ldexp(1, k));
                expect_scaled(a[1].witness[1], a[0].witness[1], ldexp(1, k));
                assert_int_equal(a[1].contact, a[0].contact);
                assert_memory_equal(&a[1].counters, &a[0].counters, sizeof a[0].counters);
            }
            for (int i = 0; i < 2; ++i) {
                r[i].method->destroy(r[i].state);
                scene_close(&s[i]);
            }
        }
    }
}

/* Turns and moves the whole frame: poses and weights. */
static void move_frame(particle_scene *s, const mote_mat3 *turn, mote_vec3 shift)
{
    const mote_pose whole = {*turn, shift};
    for (int b = 0; b < 2; ++b) {
        mote_body_state *state = &s->frame.body[b];
        mote_mat3 product;
        for (int c = 0; c < 3; ++c) {
            const mote_vec3 column = mote_rotate(
                turn, mote_vec3_make(state->pose.rotation.m[0][c], state->pose.rotation.m[1][c],
                                     state->pose.rotation.m[2][c]));
            product.m[0][c] = column.x;
            product.m[1][c] = column.y;
            product.m[2][c] = column.z;
        }
        state->pose.rotation = product;
        state->pose.translation = mote_pose_apply(&whole, state->pose.translation);
        double(*w)[MOTE_FIELD_SUMMED] = s->b[b].weights;
        for (uint32_t j = 0; j < s->b[b].field->count; ++j) {
            const mote_vec3 turned =
                mote_rotate(turn, mote_vec3_make(w[0][j], w[1][j], w[2][j]));
            w[0][j] = turned.x;
            w[1][j] = turned.y;
            w[2][j] = turned.z;
        }
    }
}

/* These frames have no ties: potentials of different places differ by far more than
   rounding. */
TEST(answers_after_a_rigid_motion_agree_to_1e_12)
{
    for (int v = 0; v < VARIANTS - 1; ++v) { /* the last one rounds to floats */
        particle_scene s[2];
        paper_run r[2];
        for (int i = 0; i < 2; ++i) {
            scene_open(&s[i], solid_icosphere(2), solid_torus(12, 7), 6, 1);
            start_run(&r[i], &s[i], variants[v]);
        }
        uint64_t seed = 9;
        for (int f = 0; f < 10; ++f) {
            mote_answer a[2];
            for (int i = 0; i < 2; ++i) {
                scene_next(&s[i], 2 - 0.1 * f);
                const mote_mat3 turn = random_rotation_matrix(&seed);
                if (i)
                    move_frame(&s[i], &turn, random_vec3(&seed, 3));
                a[i] = ask(&r[i], &s[i]);
            }
            assert_close(a[1].distance, a[0].distance, 1e-12 * s[0].length);
            assert_int_equal(a[1].counters.moves, a[0].counters.moves);
        }
        for (int i = 0; i < 2; ++i) {
            r[i].method->destroy(r[i].state);
            scene_close(&s[i]);
        }
    }
}

TEST(answers_with_one_seed_are_identical)
{
    particle_scene s;
    scene_open(&s, solid_icosphere(3), solid_torus(20, 12), 14, 1);
    int differing = 0;
    for (int v = 0; v < VARIANTS; ++v) {
        paper_run a;
        paper_run b;
        paper_run c;
        start_run(&a, &s, variants[v]);
        start_run(&b, &s, variants[v]);
        start_run(&c, &s, variants[v]);
        c.method->destroy(c.state);
        c.setup.seed = 2;
        assert_int_equal(c.method->create(&c.setup, &c.state), MOTE_OK);
        for (int f = 0; f < 5; ++f) {
            scene_next(&s, 2);
            const mote_answer first = ask(&a, &s);
            const mote_answer second = ask(&b, &s);
            const mote_answer other = ask(&c, &s);
            assert_memory_equal(&first, &second, sizeof first);
            differing += memcmp(&first.counters, &other.counters, sizeof other.counters) != 0;
        }
        a.method->destroy(a.state);
        b.method->destroy(b.state);
        c.method->destroy(c.state);
    }
    assert_true(differing > 0);
    scene_close(&s);
}

TEST(distance_is_at_least_the_truth_and_between_its_witnesses)
{
    particle_scene s;
    scene_open(&s, solid_icosphere(1), solid_torus(9, 6), 6, 1);
    for (int v = 0; v + 1 < VARIANTS; ++v) { /* floats may be too small by their rounding */
        paper_run r;
        start_run(&r, &s, variants[v]);
        for (int f = 0; f < 8; ++f) {
            scene_next(&s, 1 + 0.2 * f);
            const mote_answer a = ask(&r, &s);
            assert_true(a.distance >= scene_truth(&s) - 1e-14 * s.length);
            assert_close(mote_length(mote_sub(a.witness[0], a.witness[1])), a.distance,
                         1e-14 * s.length);
        }
        r.method->destroy(r.state);
    }
    scene_close(&s);
}

TEST(particles_are_told_with_the_closest_pair_at_the_distance)
{
    particle_scene s;
    paper_run r;
    scene_open(&s, solid_icosphere(2), solid_torus(12, 7), 6, 1);
    start_run(&r, &s, "n=9,refine=no");
    scene_next(&s, 1.2);
    const mote_answer answer = ask(&r, &s);
    mote_vec3 p[2][9] = {{{0, 0, 0}}};
    for (int b = 0; b < 2; ++b) {
        assert_int_equal(r.method->particles(r.state, b, p[b], 4), 9);
        assert_true(mote_distance_squared(p[b][4], (mote_vec3){0, 0, 0}) == 0);
        assert_int_equal(r.method->particles(r.state, b, p[b], 9), 9);
    }
    double least = HUGE_VAL;
    for (int i = 0; i < 9; ++i) {
        for (int j = 0; j < 9; ++j)
            least = fmin(least, sqrt(mote_distance_squared(p[0][i], p[1][j])));
    }
    assert_true(least == answer.distance);
    r.method->destroy(r.state);
    scene_close(&s);
}

TEST(every_component_has_a_particle_that_stays_on_it)
{
    particle_scene s;
    scene_open(
        &s,
        solid_join(solid_icosphere(2), solid_join(solid_triangle(), solid_grid(1, 1), 9), 5),
        solid_join(solid_icosphere(0), solid_icosphere(0), 3), 0, 1);
    assert_int_equal(s.b[0].mesh->component_count, 3);
    for (int k = 0; k < 40; ++k) {
        mote_particles_options o = mote_default_particles_options();
        o.count = 3 + (uint32_t)k % 4;
        o.start = k % 2 ? MOTE_START_RANDOM : MOTE_START_FARTHEST;
        o.seed = (uint64_t)k;
        mote_particles *particles = scene_particles(&s, &o);
        uint32_t label[2][8];
        for (int f = 0; f < 3; ++f) {
            for (int b = 0; b < 2; ++b) {
                uint32_t seen = 0;
                for (uint32_t i = 0; i < o.count; ++i) {
                    const uint32_t at =
                        s.b[b].mesh->component[mote_particles_site(particles, b, i).a];
                    seen |= 1u << at;
                    if (f == 0)
                        label[b][i] = at;
                    assert_int_equal(at, label[b][i]);
                }
                assert_int_equal(seen, (1u << s.b[b].mesh->component_count) - 1);
            }
            mote_counters counters = {0};
            scene_next(&s, 3);
            (void)scene_query(&s, particles, &counters);
        }
        mote_particles_destroy(particles);
    }
    scene_close(&s);
}

/* Two single triangles: a particle on each corner and the exact check give the truth. */
TEST(single_triangles_are_answered_for_every_n)
{
    particle_scene s;
    scene_open(&s, solid_triangle(), solid_triangle(), 0, 1);
    const char *const text[] = {"n=1,refine=always", "n=2,refine=always",
                                "n=3,refine=always", "n=3,refine=no",
                                "n=1,refine=no",     "n=1,move=surface,refine=no"};
    for (int k = 0; k < 6; ++k) {
        paper_run r;
        start_run(&r, &s, text[k]);
        for (int f = 0; f < 20; ++f) {
            scene_next(&s, 0.3 * f);
            const mote_answer a = ask(&r, &s);
            const double truth = scene_truth(&s);
            assert_true(a.distance >= truth - 1e-14);
            if (k < 3) /* the neighbourhood is the whole mesh */
                assert_close(a.distance, truth, 1e-14);
        }
        r.method->destroy(r.state);
    }
    scene_close(&s);
}

TEST(open_and_bow_tie_meshes_are_answered)
{
    particle_scene s;
    solid tie = solid_join(solid_icosphere(1), solid_grid(3, 2), 3);
    solid_weld(&tie, 42, 0);
    scene_open(&s, tie, solid_grid(6, 6), 5, 1);
    for (int v = 0; v + 1 < VARIANTS; ++v) {
        paper_run r;
        start_run(&r, &s, variants[v]);
        for (int f = 0; f < 5; ++f) {
            scene_next(&s, 2 + f);
            assert_true(ask(&r, &s).distance >= scene_truth(&s) - 1e-14 * s.length);
        }
        r.method->destroy(r.state);
    }
    scene_close(&s);
}

TEST(create_with_n_out_of_range_says_the_range)
{
    particle_scene s;
    scene_open(&s, solid_icosphere(1), solid_icosphere(0), 0, 1);
    paper_run r;
    assert_int_equal(try_run(&r, &s, "n=13"), MOTE_EINVAL);
    assert_string_equal(mote_error_text(),
                        "n=13 is not valid; body 1 has 12 vertices, so n must be from 1 to 12");
    assert_null(r.state);
    assert_int_equal(try_run(&r, &s, "n=16777216"), MOTE_EINVAL);
    assert_string_equal(
        mote_error_text(),
        "n=16777216 is not valid; body 0 has 42 vertices, so n must be from 1 to 42");
    start_run(&r, &s, "n=12,refine=no");
    scene_next(&s, 3);
    (void)ask(&r, &s);
    r.method->destroy(r.state);
    r.method->destroy(NULL);
    double n = 7;
    assert_int_equal(mote_parameters_parse(r.method->parameters, 1, "n=0", &n), MOTE_EINVAL);
    assert_non_null(strstr(mote_error_text(), "n must be a whole number from 1 to "));
    scene_close(&s);
}

TEST(create_with_fewer_particles_than_components_is_unsupported)
{
    particle_scene s;
    scene_open(&s, solid_icosphere(1), solid_join(solid_icosphere(0), solid_icosphere(0), 3), 0,
               1);
    paper_run r;
    assert_int_equal(try_run(&r, &s, "n=1"), MOTE_EUNSUPPORTED);
    assert_string_equal(mote_error_text(), "1 particles on a body of 2 connected components; "
                                           "each needs at least one");
    assert_null(r.state);
    scene_close(&s);
}

/* No double holds the square of such a distance. */
TEST(query_of_bodies_too_far_apart_is_refused)
{
    particle_scene s;
    scene_open(&s, solid_icosphere(1), solid_icosphere(0), 0, 1);
    paper_run r;
    start_run(&r, &s, "n=12");
    for (int k = 0; k < 4; ++k) {
        scene_next(&s, k % 2 ? 1e200 : 3);
        mote_answer answer = {0};
        const mote_status status = r.method->query(r.state, &s.frame, &answer);
        assert_int_equal(status, k % 2 ? MOTE_EINVAL : MOTE_OK);
        assert_int_equal(answer.has_distance, k % 2 == 0);
    }
    assert_non_null(strstr(mote_error_text(), "too far apart to square their distance"));
    r.method->destroy(r.state);
    scene_close(&s);
}

/* Positions of larger or smaller bodies are no floats. */
TEST(single_precision_of_lengths_beyond_floats_is_refused)
{
    static const double units[] = {1e-31, 1e-29, 1e29, 1e30, 1e40};
    for (size_t i = 0; i < ROWS_OF(units); ++i) {
        const bool refused = units[i] < 1e-30 || units[i] > 1e29;
        particle_scene s;
        scene_open(&s, solid_icosphere(1), solid_icosphere(0), 0, units[i]);
        paper_run r;
        test_row("L = %g", s.length);
        assert_int_equal(try_run(&r, &s, "n=6,precision=single"),
                         refused ? MOTE_EINVAL : MOTE_OK);
        if (refused)
            assert_non_null(strstr(mote_error_text(), "need an L from 1e-30 to 1e30"));
        r.method->destroy(r.state);
        start_run(&r, &s, "n=6");
        r.method->destroy(r.state);
        scene_close(&s);
    }
}
