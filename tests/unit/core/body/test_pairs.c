/* Lists of pairs against a list that is fully sorted. */
#include "core/body/pairs.h"

#include "tests/support/bodies.h"
#include "tests/support/test.h"

static mote_pair pair_at(double squared, double x)
{
    return (mote_pair){.squared = squared,
                       .longest_edge_squared = {1, 1},
                       .shape = {mote_vec3_make(x, 0, 0), mote_vec3_make(0, x, 0)}};
}

TEST(keep_far_from_each_other_sorted)
{
    uint64_t seed = 1;
    mote_pairs pairs = {.count = 0};
    double least = HUGE_VAL;
    for (int i = 0; i < 300; ++i) {
        const mote_pair c = pair_at(random_between(&seed, 1, 9), 10 * i);
        least = fmin(least, c.squared);
        mote_pairs_keep(&pairs, &c);
        assert_int_equal(pairs.count, i < MOTE_PAIRS_MAX ? i + 1 : MOTE_PAIRS_MAX);
        assert_true(pairs.list[0].squared == least);
        for (uint32_t k = 1; k < pairs.count; ++k)
            assert_true(pairs.list[k - 1].squared <= pairs.list[k].squared);
    }
}

TEST(keep_within_a_ring_only_the_nearest)
{
    mote_pairs pairs = {.count = 0};
    const mote_pair first = pair_at(4, 0), farther = pair_at(5, 0.5), nearer = pair_at(3, -0.5);
    const mote_pair other = pair_at(6, 7);
    mote_pairs_keep(&pairs, &first);
    mote_pairs_keep(&pairs, &other);
    mote_pairs_keep(&pairs, &farther);
    assert_int_equal(pairs.count, 2);
    assert_true(pairs.list[0].squared == 4);
    mote_pairs_keep(&pairs, &nearer);
    assert_int_equal(pairs.count, 2);
    assert_true(pairs.list[0].squared == 3 && pairs.list[1].squared == 6);
}

/* A refined pair stays, even if a vertex pair nearby is nearer, and the entries before it stay,
   too. */
TEST(keep_within_a_ring_of_a_refined_one_nothing)
{
    mote_pairs pairs = {.count = 0};
    mote_pair refined = pair_at(4, 0);
    refined.refined = true;
    const mote_pair between = pair_at(2, -0.9), far = pair_at(3, 50);
    const mote_pair both = pair_at(1, -0.1);
    mote_pair beside = pair_at(2, -1.05);
    beside.longest_edge_squared[0] = beside.longest_edge_squared[1] = 4;
    mote_pairs_keep(&pairs, &refined);
    mote_pairs_keep(&pairs, &between);
    assert_int_equal(pairs.count, 1);
    mote_pairs_keep(&pairs, &far);
    mote_pairs_keep(&pairs, &beside); /* more than its ring away from the refined one */
    assert_int_equal(pairs.count, 3);
    mote_pairs_keep(&pairs, &both); /* within the ring of two pairs */
    assert_int_equal(pairs.count, 3);
    assert_true(pairs.list[0].squared == 2 && pairs.list[1].squared == 3);
    assert_true(pairs.list[2].refined);
}

/* Two sheets on top of each other in one mesh: corners coincide, but a walk on one sheet cannot
   reach the other. */
TEST(keep_in_one_place_on_two_sheets_both)
{
    mote_mesh *sheets = solid_to_mesh(solid_join(solid_grid(2, 2), solid_grid(2, 2), 0));
    const uint32_t half = sheets->vertex_count / 2;
    const uint32_t beside = MOTE_RING_VERTEX(sheets->ring[sheets->ring_start[0]]);
    for (int b = 0; b < 2; ++b) { /* whichever body has the sheets */
        mote_pairs pairs = {.mesh = {sheets, sheets}};
        mote_pair first = pair_at(4, 0), second = pair_at(5, 0), third = pair_at(6, 0.1);
        second.vertex[b] = half;
        third.vertex[b] = beside;
        mote_pairs_keep(&pairs, &first);
        mote_pairs_keep(&pairs, &second);
        assert_int_equal(pairs.count, 2);
        mote_pairs_keep(&pairs, &third); /* in the first one's ring */
        assert_int_equal(pairs.count, 2);
        assert_true(pairs.list[0].squared == 4 && pairs.list[1].squared == 5);
    }
    mote_mesh_destroy(sheets);
}
