/* The same bits from every compiler, optimisation and instruction set: hashes of the results of
   fixed inputs, committed here and checked by every build (and by portability.sh). The inputs
   and everything hashed use only operations that IEEE 754 rounds exactly. If you change a
   method on purpose, take the new hashes from the failing test once portability.sh agrees on
   them. */
#include "core/certificate/certificate.h"
#include "core/body/deform.h"
#include "core/body/lazy.h"
#include "core/particle/particles.h"
#include "core/particle/refine.h"
#include "core/particle/tracker.h"
#include "core/stream/stream.h"
#include "harness/base/hash.h"

#include "tests/support/bodies.h"
#include "tests/support/test.h"

static void hash_vec3(uint64_t *hash, mote_vec3 v)
{
    *hash = mote_hash_double(*hash, v.x);
    *hash = mote_hash_double(*hash, v.y);
    *hash = mote_hash_double(*hash, v.z);
}

static void hash_answer(uint64_t *hash, const mote_certificate_answer *answer)
{
    *hash = mote_hash_double(*hash, answer->distance);
    *hash = mote_hash_double(*hash, answer->lower);
    hash_vec3(hash, answer->witness[0]);
}

static void expect_hash(uint64_t hash, uint64_t expected)
{
    if (hash != expected)
        print_error("the hash is 0x%016llxu\n", (unsigned long long)hash);
    assert_true(hash == expected);
}

static void hash_gradient(uint64_t *hash, const test_body *b, uint32_t vertex)
{
    mote_vec3 gradient[MOTE_FIELD_SUMMED];
    b->field->kind->gradient(b->field, b->mesh, vertex, gradient);
    for (uint32_t j = 0; j < b->field->padded; ++j)
        hash_vec3(hash, gradient[j]);
}

TEST(deform_of_fixed_bodies_has_the_committed_hash)
{
    const int sizes[] = {0, 1, 9, 14, 16, 256, -1, -3};
    uint64_t seed = 1;
    uint64_t hash = MOTE_HASH_START;
    for (int k = 0; k < 8; ++k) {
        test_body b;
        test_body_init(&b, solid_to_mesh(solid_icosphere(2)), sizes[k], &seed);
        const mote_body_state state = test_body_state(&b, 0.5, &seed);
        mote_deform *deform = NULL;
        assert_int_equal(mote_deform_create(&b.body, &deform), MOTE_OK);
        mote_vec3 *world = malloc(b.mesh->vertex_count * sizeof *world);
        assert_non_null(world);
        mote_deform_all(deform, &state, world);
        for (uint32_t v = 0; v < b.mesh->vertex_count; ++v) {
            hash_vec3(&hash, world[v]);
            hash_vec3(&hash, mote_field_displacement(b.field, b.mesh, v, &state.weights));
        }
        hash_gradient(&hash, &b, 17);
        hash = mote_hash_double(hash, b.mesh->diagonal);
        hash = mote_hash_double(hash, b.mesh->mean_edge);
        free(world);
        mote_deform_destroy(deform);
        test_body_free(&b);
    }
    expect_hash(hash, 0xd4f00f555e840a95u);
}

TEST(single_positions_of_fixed_bodies_have_the_committed_hash)
{
    const int sizes[] = {0, 14, -3};
    uint64_t seed = 2;
    uint64_t hash = MOTE_HASH_START;
    for (int k = 0; k < 3; ++k) {
        test_body b;
        test_body_init(&b, solid_to_mesh(solid_icosphere(2)), sizes[k], &seed);
        const mote_body_state state = test_body_state(&b, 0.5, &seed);
        mote_lazy lazy;
        assert_int_equal(mote_lazy_init_single(&lazy, &b.body, 10), MOTE_OK);
        mote_lazy_begin(&lazy, &state, false);
        for (uint32_t v = 0; v < b.mesh->vertex_count; ++v)
            hash_vec3(&hash, mote_lazy_position(&lazy, v));
        mote_lazy_free(&lazy);
        test_body_free(&b);
    }
    expect_hash(hash, 0x09686fcd97f22045u);
}

/* Twenty queries of a particle system on two deforming spheres. */
static uint64_t particles_hash(const mote_particles_options *options)
{
    uint64_t seed = 3;
    uint64_t hash = MOTE_HASH_START;
    test_body b[2];
    test_body_init(&b[0], solid_to_mesh(solid_icosphere(3)), 14, &seed);
    test_body_init(&b[1], solid_to_mesh(solid_icosphere(2)), 9, &seed);
    const mote_body *bodies[2] = {&b[0].body, &b[1].body};
    mote_particles *particles = NULL;
    const double length = fmax(b[0].mesh->diagonal, b[1].mesh->diagonal);
    if (mote_particles_create(bodies, length, options, &particles) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    for (uint64_t number = 1; number <= 20; ++number) {
        mote_frame frame = {.number = number};
        for (int k = 0; k < 2; ++k)
            frame.body[k] = test_body_state(&b[k], 0.2, &seed);
        frame.body[1].pose.translation.x += 2.5;
        mote_counters counters = {0};
        mote_particles_begin(particles, &frame, false);
        mote_particles_relax(particles, -1, &counters);
        uint32_t pair[2];
        hash = mote_hash_double(hash, mote_particles_closest(particles, pair));
        hash = mote_hash_word(hash, counters.moves);
        hash = mote_hash_word(hash, counters.steps);
        for (int k = 0; k < 2; ++k) {
            for (uint32_t i = 0; i < options->count; ++i) {
                const mote_site site = mote_particles_site(particles, k, i);
                hash = mote_hash_word(hash, site.a);
                hash = mote_hash_word(hash, (uint64_t)site.b << 32 | site.c);
            }
        }
    }
    mote_particles_destroy(particles);
    test_body_free(&b[0]);
    test_body_free(&b[1]);
    return hash;
}

TEST(particles_of_fixed_bodies_have_the_committed_hash)
{
    mote_particles_options options = mote_default_particles_options();
    options.count = 9;
    expect_hash(particles_hash(&options), 0x0fc4df54102b2f3au);
    options.start = MOTE_START_RANDOM;
    options.surface = true;
    expect_hash(particles_hash(&options), 0xcc59e751714c7936u);
    options.single = true;
    for (int k = 0; k < 2; ++k) {
        options.attract[k] = MOTE_LAW_INVERSE;
        options.repel[k] = MOTE_LAW_INVERSE_SQUARE;
    }
    expect_hash(particles_hash(&options), 0x5f62ad1cca5c4d3fu);
}

/* The exact check from many pairs of vertices of two deforming spheres that touch. */
TEST(refined_pairs_of_fixed_bodies_have_the_committed_hash)
{
    uint64_t seed = 4;
    uint64_t hash = MOTE_HASH_START;
    test_body b[2];
    mote_lazy lazy[2];
    for (int k = 0; k < 2; ++k) {
        test_body_init(&b[k], solid_to_mesh(solid_icosphere(3 - k)), 14, &seed);
        assert_int_equal(mote_lazy_init(&lazy[k], &b[k].body, 100), MOTE_OK);
    }
    for (uint32_t number = 0; number < 40; ++number) {
        mote_body_state state[2];
        for (int k = 0; k < 2; ++k)
            state[k] = test_body_state(&b[k], 0.2, &seed);
        state[1].pose.translation.x += 2.5 - 0.05 * number;
        for (int k = 0; k < 2; ++k)
            mote_lazy_begin(&lazy[k], &state[k], false);
        mote_lazy *const both[2] = {&lazy[0], &lazy[1]};
        const uint32_t vertices[2] = {number * 13, number * 3};
        mote_refined refined;
        mote_refine_vertices(both, vertices, 0, &refined);
        hash = mote_hash_double(hash, refined.squared);
        hash_vec3(&hash, refined.witness[0]);
        hash_vec3(&hash, refined.witness[1]);
    }
    for (int k = 0; k < 2; ++k) {
        mote_lazy_free(&lazy[k]);
        test_body_free(&b[k]);
    }
    expect_hash(hash, 0x78b1def009c20fe1u);
}

/* Hashes positions of a body computed in the three possible ways. */
static void hash_positions(uint64_t *hash, const test_body *b, const mote_body_state *state)
{
    mote_deform *deform = NULL;
    mote_lazy lazy;
    mote_vec3 *world = malloc(b->mesh->vertex_count * sizeof *world);
    assert_non_null(world);
    assert_int_equal(mote_deform_create(&b->body, &deform), MOTE_OK);
    assert_int_equal(mote_lazy_init_single(&lazy, &b->body, 10), MOTE_OK);
    mote_deform_all(deform, state, world);
    mote_lazy_begin(&lazy, state, false);
    for (uint32_t v = 0; v < b->mesh->vertex_count; ++v) {
        hash_vec3(hash, world[v]);
        hash_vec3(hash, mote_body_position(&b->body, state, v));
        hash_vec3(hash, mote_lazy_position(&lazy, v));
    }
    mote_lazy_free(&lazy);
    mote_deform_destroy(deform);
    free(world);
}

/* The answers to queries of two bodies that come nearer by `step` a frame. Counters are
   included: floats decide which boxes are tested. Of skinned bodies also the positions. */
static void hash_certified(uint64_t *hash, test_body b[2], bool skinned, int frames,
                           double step, uint64_t *seed)
{
    const mote_body *bodies[2] = {&b[0].body, &b[1].body};
    const mote_certificate_options options =
        mote_default_certificate_options(b[0].mesh->diagonal);
    mote_certificate *certificate = NULL;
    if (mote_certificate_create(bodies, &options, &certificate) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    for (int number = 1; number <= frames; ++number) {
        mote_frame frame = {.number = (uint64_t)number};
        for (int k = 0; k < 2; ++k)
            frame.body[k] =
                skinned ? skin_body_state(&b[k], 0.1, seed) : test_body_state(&b[k], 0.1, seed);
        frame.body[1].pose.translation.x += 2.6 - step * number;
        if (skinned && number == 1)
            hash_positions(hash, &b[1], &frame.body[1]);
        mote_certificate_answer answer;
        mote_certificate_query(certificate, &frame, NULL, -1, &answer);
        hash_answer(hash, &answer);
        *hash = mote_hash_word(*hash, answer.counters.blocks);
        *hash = mote_hash_word(*hash, answer.counters.rows);
        if (skinned)
            *hash = mote_hash_word(*hash, answer.counters.leaf_pairs);
        *hash = mote_hash_word(*hash, answer.counters.triangle_tests);
    }
    mote_certificate_destroy(certificate);
    test_body_free(&b[0]);
    test_body_free(&b[1]);
}

TEST(certified_queries_of_fixed_bodies_have_the_committed_hash)
{
    const int sizes[] = {0, 14, -3};
    uint64_t seed = 5;
    uint64_t hash = MOTE_HASH_START;
    for (int size = 0; size < 3; ++size) {
        test_body b[2];
        for (int k = 0; k < 2; ++k)
            test_body_init(&b[k], solid_to_mesh(solid_icosphere(4 - k)), sizes[size], &seed);
        hash_certified(&hash, b, false, 30, 0.04, &seed);
    }
    expect_hash(hash, 0xe993996a087a7235u);
}

/* Skins, skins with morph targets, and targets alone. */
TEST(skins_and_morphs_of_fixed_bodies_have_the_committed_hash)
{
    const uint32_t plans[3][2] = {{16, 0}, {7, 8}, {0, 3}};
    uint64_t seed = 7;
    uint64_t hash = MOTE_HASH_START;
    for (int plan = 0; plan < 3; ++plan) {
        test_body b[2];
        for (int k = 0; k < 2; ++k)
            skin_body_init(&b[k], solid_to_mesh(solid_icosphere(4 - k)), plans[plan][0],
                           plans[plan][1], &seed);
        hash_certified(&hash, b, true, 20, 0.06, &seed);
    }
    expect_hash(hash, 0xc70eb2a36f2574bbu);
}

/* Positions of a fixed body, each displaced at random. */
static mote_vec3 *shaken_positions(const test_body *b, mote_vec3 offset, uint64_t *seed)
{
    mote_vec3 *made = malloc(b->mesh->vertex_count * sizeof *made);
    assert_non_null(made);
    for (uint32_t v = 0; v < b->mesh->vertex_count; ++v)
        made[v] = mote_add(mote_add(b->mesh->positions[v], offset), random_vec3(seed, 0.01));
    return made;
}

TEST(streamed_queries_of_fixed_bodies_have_the_committed_hash)
{
    uint64_t seed = 7;
    uint64_t hash = MOTE_HASH_START;
    test_body b[2];
    for (int k = 0; k < 2; ++k)
        test_body_init(&b[k], solid_to_mesh(solid_icosphere(4 - k)), 0, &seed);
    const mote_body *bodies[2] = {&b[0].body, &b[1].body};
    const mote_stream_options options = mote_default_stream_options(b[0].mesh->diagonal);
    mote_stream *stream = NULL;
    if (mote_stream_create(bodies, &options, &stream) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    for (int number = 1; number <= 40; ++number) {
        mote_vec3 *at[2];
        for (int k = 0; k < 2; ++k)
            at[k] = shaken_positions(&b[k], mote_vec3_make(k * (2.6 - 0.02 * number), 0.1, 0),
                                     &seed);
        const mote_stream_frame frame = {
            .positions = {mote_positions_of(at[0]), mote_positions_of(at[1])}};
        mote_certificate_answer answer;
        assert_int_equal(mote_stream_query(stream, &frame, -1, &answer), MOTE_OK);
        hash_answer(&hash, &answer);
        hash = mote_hash_word(hash, answer.counters.blocks);
        hash = mote_hash_word(hash, answer.counters.box_tests);
        hash = mote_hash_word(hash, answer.counters.leaf_pairs);
        hash = mote_hash_word(hash, answer.counters.triangle_tests);
        free(at[0]);
        free(at[1]);
    }
    mote_stream_destroy(stream);
    test_body_free(&b[0]);
    test_body_free(&b[1]);
    expect_hash(hash, 0x8f33ac27effeb3bdu);
}

/* Tracked queries, counters included, of two bodies that come near, meet and jump. */
TEST(tracked_queries_of_fixed_bodies_have_the_committed_hash)
{
    const int sizes[] = {0, 14, -3};
    uint64_t seed = 6;
    uint64_t hash = MOTE_HASH_START;
    for (int size = 0; size < 3; ++size) {
        test_body b[2];
        for (int k = 0; k < 2; ++k)
            test_body_init(&b[k], solid_to_mesh(solid_icosphere(4 - k)), sizes[size], &seed);
        const mote_body *bodies[2] = {&b[0].body, &b[1].body};
        const mote_tracker_options options = mote_default_tracker_options();
        mote_tracker *tracker = NULL;
        if (mote_tracker_create(bodies, b[0].mesh->diagonal, &options, &tracker) != MOTE_OK)
            fail_msg("%s", mote_error_text());
        mote_frame frame = {.number = 0};
        for (int number = 0; number < 60; ++number) {
            if (number % 20 == 0) {
                for (int k = 0; k < 2; ++k)
                    frame.body[k] = test_body_state(&b[k], 0.1, &seed);
                frame.body[1].pose.translation.x += 2.6;
            }
            frame.body[1].pose.translation.x -= 0.03;
            for (uint32_t j = 0; j < b[0].field->count; ++j)
                b[0].weights[1][j] += random_between(&seed, -0.01, 0.01);
            mote_counters counters = {0};
            mote_refined best;
            mote_tracker_query(tracker, &frame, false, HUGE_VAL, 0, &counters, &best);
            hash = mote_hash_double(hash, best.squared);
            hash_vec3(&hash, best.witness[0]);
            hash_vec3(&hash, best.witness[1]);
            hash = mote_hash_word(hash, counters.positions);
            hash = mote_hash_word(hash, counters.moves);
            hash = mote_hash_word(hash, counters.launches);
        }
        mote_tracker_destroy(tracker);
        test_body_free(&b[0]);
        test_body_free(&b[1]);
    }
    expect_hash(hash, 0x850b688448d7a806u);
}
