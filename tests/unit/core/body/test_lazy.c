/* Lazy positions: the same bits as full evaluation, discarded with the frame, growing
   tables. */
#include "core/body/lazy.h"

#include "tests/support/bodies.h"
#include "tests/support/test.h"

static void init_lazy(mote_lazy *lazy, const mote_body *body, uint32_t expected, bool single)
{
    const mote_status status = single ? mote_lazy_init_single(lazy, body, expected)
                                      : mote_lazy_init(lazy, body, expected);
    if (status != MOTE_OK)
        fail_msg("%s", mote_error_text());
}

static void expect_same(mote_lazy *lazy, const mote_body *body, const mote_body_state *state,
                        uint32_t vertex)
{
    const mote_vec3 got = mote_lazy_position(lazy, vertex);
    const mote_vec3 expected = mote_body_position(body, state, vertex);
    assert_memory_equal(&got, &expected, sizeof got);
}

TEST(position_is_evaluated_once_a_frame)
{
    uint64_t seed = 1;
    test_body b;
    test_body_init(&b, solid_to_mesh(solid_icosphere(2)), 14, &seed);
    for (int single = 0; single <= 1; ++single) {
        mote_lazy lazy;
        init_lazy(&lazy, &b.body, 200, single);
        for (uint64_t frame = 1; frame <= 5; ++frame) {
            const mote_body_state state = test_body_state(&b, 1, &seed);
            mote_lazy_begin(&lazy, &state, false);
            for (int pass = 0; pass < 3; ++pass) {
                for (uint32_t v = 0; v < 50; ++v)
                    (void)mote_lazy_position(&lazy, 3 * v);
            }
            assert_int_equal(lazy.evaluated, 50 * frame);
            assert_int_equal(lazy.filled, 50);
        }
        mote_lazy_free(&lazy);
    }
    test_body_free(&b);
}

TEST(position_after_begin_is_never_stale)
{
    uint64_t seed = 2;
    test_body b;
    test_body_init(&b, solid_to_mesh(solid_icosphere(2)), 14, &seed);
    mote_lazy lazy;
    init_lazy(&lazy, &b.body, 0, false);
    for (int frame = 0; frame < 200; ++frame) {
        const mote_body_state state = test_body_state(&b, 1, &seed);
        mote_lazy_begin(&lazy, &state, false);
        for (int k = 0; k < 60; ++k)
            expect_same(&lazy, &b.body, &state,
                        (uint32_t)(random_bits(&seed) % b.mesh->vertex_count));
    }
    mote_lazy_free(&lazy);
    test_body_free(&b);
}

/* The stamp is a counter of 32 bits: a value stored 2^32 frames ago must not come back. */
TEST(position_after_the_stamp_wraps_is_not_stale)
{
    uint64_t seed = 3;
    test_body b;
    test_body_init(&b, solid_to_mesh(solid_icosphere(1)), 8, &seed);
    for (int single = 0; single <= 1; ++single) {
        mote_lazy lazy;
        init_lazy(&lazy, &b.body, 42, single);
        mote_body_state state = test_body_state(&b, 1, &seed);
        mote_lazy_begin(&lazy, &state, false);
        const mote_vec3 old = mote_lazy_position(&lazy, 7); /* stamp 1 */
        lazy.stamp = UINT32_MAX - 1;
        for (int frame = 0; frame < 4; ++frame) {
            state = test_body_state(&b, 1, &seed);
            mote_lazy_begin(&lazy, &state, false);
            assert_true(lazy.stamp != 0);
            const uint64_t before = lazy.evaluated;
            const mote_vec3 got = mote_lazy_position(&lazy, 7);
            assert_int_equal(lazy.evaluated, before + 1);
            assert_true(memcmp(&got, &old, sizeof got) != 0);
            if (!single)
                expect_same(&lazy, &b.body, &state, 7);
        }
        mote_lazy_free(&lazy);
    }
    test_body_free(&b);
}

TEST(growth_keeps_values_and_counts)
{
    uint64_t seed = 4;
    test_body b;
    test_body_init(&b, solid_to_mesh(solid_icosphere(3)), 9, &seed);
    const uint32_t n = b.mesh->vertex_count;
    for (int single = 0; single <= 1; ++single) {
        mote_lazy lazy;
        init_lazy(&lazy, &b.body, 1, single);
        assert_int_equal(lazy.mask, 15);
        const mote_body_state state = test_body_state(&b, 1, &seed);
        mote_lazy_begin(&lazy, &state, false);
        mote_vec3 *first = malloc(n * sizeof *first);
        assert_non_null(first);
        /* In random order: hashes of consecutive numbers hardly ever collide. */
        uint32_t *order = malloc(n * sizeof *order);
        assert_non_null(order);
        for (uint32_t i = 0; i < n; ++i) {
            const uint32_t j = (uint32_t)(random_bits(&seed) % (i + 1));
            order[i] = order[j];
            order[j] = i;
        }
        for (uint32_t i = 0; i < n; ++i) {
            first[order[i]] = mote_lazy_position(&lazy, order[i]);
            assert_int_equal(lazy.filled, i + 1);
            assert_true(lazy.filled <= (lazy.mask + 1) / 2);
        }
        assert_int_equal(lazy.evaluated, n);
        for (uint32_t v = n; v-- > 0;) {
            const mote_vec3 again = mote_lazy_position(&lazy, v);
            assert_memory_equal(&again, &first[v], sizeof again);
        }
        assert_int_equal(lazy.evaluated, n);
        assert_int_equal(lazy.mask, 2047); /* twice 642, to a power of two */
        free(order);
        free(first);
        mote_lazy_free(&lazy);
    }
    test_body_free(&b);
}

/* A fixed table gives the same positions, and evaluates again what does not fit. */
TEST(fixed_table_keeps_its_size_and_the_values)
{
    uint64_t seed = 4;
    test_body b;
    test_body_init(&b, solid_to_mesh(solid_icosphere(3)), 9, &seed);
    for (int single = 0; single <= 1; ++single) {
        mote_lazy grown, fixed;
        init_lazy(&grown, &b.body, 1, single);
        init_lazy(&fixed, &b.body, 1, single);
        fixed.fixed = true;
        const mote_body_state state = test_body_state(&b, 1, &seed);
        mote_lazy_begin(&grown, &state, false);
        mote_lazy_begin(&fixed, &state, false);
        for (uint32_t v = 0; v < 2 * b.mesh->vertex_count; ++v) {
            const mote_vec3 x = mote_lazy_position(&grown, v / 2);
            const mote_vec3 y = mote_lazy_position(&fixed, v / 2);
            assert_memory_equal(&x, &y, sizeof x);
        }
        assert_int_equal(fixed.mask, 15);
        assert_int_equal(fixed.filled, 8);
        assert_int_equal(fixed.evaluated, 2 * b.mesh->vertex_count - 8);
        mote_lazy_free(&grown);
        mote_lazy_free(&fixed);
    }
    test_body_free(&b);
}

/* A table grown in one frame still discards its values in the next. */
TEST(growth_then_begin_evaluates_anew)
{
    uint64_t seed = 5;
    test_body b;
    test_body_init(&b, solid_to_mesh(solid_icosphere(2)), 9, &seed);
    mote_lazy lazy;
    init_lazy(&lazy, &b.body, 1, false);
    for (int frame = 0; frame < 3; ++frame) {
        const mote_body_state state = test_body_state(&b, 1, &seed);
        mote_lazy_begin(&lazy, &state, false);
        assert_int_equal(lazy.filled, 0);
        for (uint32_t v = 0; v < b.mesh->vertex_count; ++v)
            expect_same(&lazy, &b.body, &state, v);
    }
    assert_int_equal(lazy.evaluated, 3 * b.mesh->vertex_count);
    mote_lazy_free(&lazy);
    test_body_free(&b);
}

TEST(init_expecting_more_than_the_mesh_is_sized_by_the_mesh)
{
    uint64_t seed = 6;
    test_body b;
    test_body_init(&b, solid_to_mesh(solid_icosphere(1)), 0, &seed);
    const uint32_t expected[] = {42, 43, 1u << 31, UINT32_MAX};
    for (int k = 0; k < 4; ++k) {
        mote_lazy lazy;
        init_lazy(&lazy, &b.body, expected[k], false);
        assert_int_equal(lazy.mask, 127);
        mote_lazy_free(&lazy);
    }
    test_body_free(&b);
}

TEST(given_positions_are_read_and_not_evaluated)
{
    uint64_t seed = 7;
    test_body b;
    test_body_init(&b, solid_to_mesh(solid_triangle()), 3, &seed);
    const mote_vec3 given[3] = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}};
    for (int single = 0; single <= 1; ++single) {
        mote_lazy lazy;
        init_lazy(&lazy, &b.body, 3, single);
        mote_body_state state = test_body_state(&b, 1, &seed);
        state.vertices = given;
        mote_lazy_begin(&lazy, &state, true);
        for (uint32_t v = 0; v < 3; ++v) {
            const mote_vec3 got = mote_lazy_position(&lazy, v);
            assert_memory_equal(&got, &given[v], sizeof got);
        }
        assert_int_equal(lazy.evaluated, 0);
        mote_lazy_begin(&lazy, &state, false); /* present, but not to be used */
        const mote_vec3 got = mote_lazy_position(&lazy, 1);
        assert_true(memcmp(&got, &given[1], sizeof got) != 0);
        assert_int_equal(lazy.evaluated, 1);
        mote_lazy_free(&lazy);
    }
    test_body_free(&b);
}

/* Floats carry 24 bits: a sum of terms up to 3 stays within some 2^-22 of the double. */
TEST(single_positions_stay_near_double)
{
    uint64_t seed = 8;
    const int sizes[] = {0, 14, -4};
    for (int k = 0; k < 3; ++k) {
        test_body b;
        test_body_init(&b, solid_to_mesh(solid_icosphere(2)), sizes[k], &seed);
        mote_lazy lazy;
        init_lazy(&lazy, &b.body, 20, true);
        double furthest = 0;
        for (int frame = 0; frame < 5; ++frame) {
            const mote_body_state state = test_body_state(&b, 0.3, &seed);
            mote_lazy_begin(&lazy, &state, false);
            for (uint32_t v = 0; v < b.mesh->vertex_count; ++v) {
                const mote_vec3 got = mote_lazy_position(&lazy, v);
                const mote_vec3 exact = mote_body_position(&b.body, &state, v);
                furthest = fmax(furthest, mote_length(mote_sub(got, exact)));
            }
        }
        assert_true(furthest < 2e-6);
        assert_true(furthest > 1e-9);
        mote_lazy_free(&lazy);
        test_body_free(&b);
    }
}

/* Fetches vertices that are already known, listed twice, or more than the table holds. */
TEST(fetch_same_bits_as_one_by_one)
{
    const int sizes[] = {0, 1, 7, 8, 9, 14, 40, 256, -1, -4};
    uint64_t seed = 9;
    for (size_t k = 0; k < sizeof sizes / sizeof sizes[0]; ++k) {
        test_body b;
        test_body_init(&b, solid_to_mesh(solid_icosphere(2)), sizes[k], &seed);
        mote_lazy lazy;
        init_lazy(&lazy, &b.body, 1, false);
        for (int frame = 0; frame < 20; ++frame) {
            const mote_body_state state = test_body_state(&b, 1, &seed);
            mote_lazy_begin(&lazy, &state, false);
            uint32_t list[60];
            for (int i = 0; i < 60; ++i)
                list[i] = (uint32_t)(random_bits(&seed) % b.mesh->vertex_count);
            (void)mote_lazy_position(&lazy, list[3]);
            mote_lazy_fetch(&lazy, list, random_bits(&seed) % 40);
            mote_lazy_fetch(&lazy, list + 20, 40);
            mote_lazy_fetch_rings(&lazy, list, 3);
            const uint64_t evaluated = lazy.evaluated;
            for (int i = 20; i < 60; ++i)
                expect_same(&lazy, &b.body, &state, list[i]);
            for (int i = 0; i < 3; ++i) {
                const uint32_t v = list[i];
                expect_same(&lazy, &b.body, &state, v);
                for (uint32_t r = b.mesh->ring_start[v]; r < b.mesh->ring_start[v + 1]; ++r)
                    expect_same(&lazy, &b.body, &state, MOTE_RING_VERTEX(b.mesh->ring[r]));
            }
            assert_int_equal(lazy.evaluated, evaluated);
        }
        mote_lazy_free(&lazy);
        test_body_free(&b);
    }
}

TEST(fetch_in_single_precision_evaluates_nothing)
{
    uint64_t seed = 9;
    test_body b;
    test_body_init(&b, solid_to_mesh(solid_icosphere(1)), 5, &seed);
    const mote_body_state state = test_body_state(&b, 1, &seed);
    const uint32_t vertices[3] = {1, 4, 9};
    mote_lazy lazy;
    init_lazy(&lazy, &b.body, 42, true);
    mote_lazy_begin(&lazy, &state, false);
    mote_lazy_fetch(&lazy, vertices, 3);
    mote_lazy_fetch_rings(&lazy, vertices, 3);
    assert_int_equal(lazy.evaluated, 0);
    assert_int_equal(lazy.filled, 0);
    mote_lazy_free(&lazy);
    test_body_free(&b);
}

/* Positions that are given in records of the caller's are fetched as they are read. */
TEST(fetch_of_given_positions_evaluates_nothing)
{
    uint64_t seed = 9;
    test_body b;
    test_body_init(&b, solid_to_mesh(solid_triangle()), 3, &seed);
    const double given[3][4] = {{1, 2, 3, 0}, {4, 5, 6, 0}, {7, 8, 9, 0}};
    const uint32_t vertices[3] = {2, 0, 1};
    for (size_t stride = 3; stride <= 4; ++stride) {
        const mote_positions points = {given, stride * sizeof(double), false};
        mote_lazy lazy;
        init_lazy(&lazy, &b.body, 3, false);
        mote_lazy_begin_points(&lazy, &points);
        mote_lazy_fetch(&lazy, vertices, 3);
        mote_lazy_fetch_rings(&lazy, vertices, 3);
        assert_int_equal(lazy.evaluated, 0);
        assert_int_equal(lazy.filled, 0);
        for (uint32_t v = 0; v < 3; ++v) {
            const mote_vec3 got = mote_lazy_position(&lazy, v);
            const mote_vec3 expected = mote_position_at(&points, v);
            assert_memory_equal(&got, &expected, sizeof got);
        }
        mote_lazy_free(&lazy);
    }
    test_body_free(&b);
}

/* A table of 2^31 entries is the largest; it does not remember more. (No such table is
   allocated: only its first entry is used.) */
TEST(position_in_the_largest_table_is_not_remembered)
{
    uint64_t seed = 9;
    test_body b;
    test_body_init(&b, solid_to_mesh(solid_icosphere(1)), 5, &seed);
    const mote_body_state state = test_body_state(&b, 1, &seed);
    for (int single = 0; single <= 1; ++single) {
        mote_lazy lazy;
        init_lazy(&lazy, &b.body, 42, single);
        mote_lazy_begin(&lazy, &state, false);
        const mote_vec3 expected = mote_lazy_position(&lazy, 0);
        mote_lazy_begin(&lazy, &state, false);
        lazy.shift = 1;
        lazy.filled = lazy.limit = 1u << 30;
        const uint64_t before = lazy.evaluated;
        for (int k = 1; k <= 3; ++k) {
            const mote_vec3 got = mote_lazy_position(&lazy, 0);
            assert_memory_equal(&got, &expected, sizeof got);
            assert_int_equal(lazy.evaluated, before + (uint64_t)k);
        }
        mote_lazy_free(&lazy);
    }
    test_body_free(&b);
}

TEST(fetch_evaluates_each_vertex_once)
{
    uint64_t seed = 10;
    test_body b;
    test_body_init(&b, solid_to_mesh(solid_icosphere(2)), 14, &seed);
    mote_lazy lazy;
    init_lazy(&lazy, &b.body, 1, false);
    const mote_body_state state = test_body_state(&b, 1, &seed);
    uint32_t list[300];
    for (uint32_t i = 0; i < 300; ++i)
        list[i] = i / 3;
    mote_lazy_begin(&lazy, &state, false);
    mote_lazy_fetch(&lazy, list, 300);
    mote_lazy_fetch(&lazy, list, 300);
    assert_int_equal(lazy.evaluated, 100);
    assert_int_equal(lazy.filled, 100);
    mote_lazy_free(&lazy);
    test_body_free(&b);
}
