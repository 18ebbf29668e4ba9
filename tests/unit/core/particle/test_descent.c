/* Walks over pairs of deforming tori: where they end, and that they only approach. */
#include "core/particle/descent.h"
#include "tests/support/shapes.h"
#include "tests/support/test.h"

#include <stddef.h>

typedef struct walk_scene {
    scene s;
    mote_levels *levels[2];
    mote_lazy lazy[2];
    mote_ground ground[2];
} walk_scene;

static void walk_scene_init(walk_scene *w, bool deforming)
{
    scene_init(&w->s, 60, 24, 1, deforming);
    for (int b = 0; b < 2; ++b) {
        assert_int_equal(mote_levels_create(w->s.mesh[b], &w->levels[b]), MOTE_OK);
        assert_int_equal(mote_lazy_init(&w->lazy[b], &w->s.body[b], 64), MOTE_OK);
    }
}

static void walk_scene_next(walk_scene *w, bool given)
{
    const mote_frame *frame = scene_next(&w->s, 1.2, false);
    for (int b = 0; b < 2; ++b) {
        mote_lazy_begin(&w->lazy[b], &frame->body[b], given);
        w->ground[b] = mote_ground_of(&w->lazy[b], w->levels[b]);
    }
}

static void walk_scene_free(walk_scene *w)
{
    for (int b = 0; b < 2; ++b) {
        mote_levels_destroy(w->levels[b]);
        mote_lazy_free(&w->lazy[b]);
    }
    scene_free(&w->s);
}

/* Places at random nodes of levels, or vertices. */
static void random_places(walk_scene *w, const int level[2], mote_walker at[2])
{
    for (int b = 0; b < 2; ++b) {
        const uint32_t count = level[b] == MOTE_MESH_LEVEL
                                   ? w->s.mesh[b]->vertex_count
                                   : w->levels[b]->level[level[b]].count;
        at[b] =
            mote_walker_at(&w->ground[b], level[b], (uint32_t)scene_random(&w->s, 0, count));
    }
}

static void assert_same_point(mote_vec3 a, mote_vec3 b)
{
    assert_true(a.x == b.x && a.y == b.y && a.z == b.z);
}

static void assert_places(const walk_scene *w, const mote_walker at[2], double squared)
{
    for (int b = 0; b < 2; ++b) {
        assert_int_equal(at[b].node, at[b].vertex);
        assert_same_point(at[b].world, w->s.world[b][at[b].vertex]);
    }
    assert_true(squared == mote_distance_squared(at[0].world, at[1].world));
}

/* No neighbour on the mesh is nearer, up to rounding. */
static void assert_local_minimum(const walk_scene *w, const mote_walker at[2], double squared)
{
    for (int b = 0; b < 2; ++b) {
        const mote_mesh *mesh = w->s.mesh[b];
        const uint32_t v = at[b].vertex;
        for (uint32_t k = mesh->ring_start[v]; k < mesh->ring_start[v + 1]; ++k) {
            const mote_vec3 p = w->s.world[b][MOTE_RING_VERTEX(mesh->ring[k])];
            assert_true(mote_distance_squared(p, at[1 - b].world) >= squared * (1 - 1e-12));
        }
    }
}

static void check_descents(bool deforming, bool given)
{
    walk_scene w;
    walk_scene_init(&w, deforming);
    for (int frame = 0; frame < 20; ++frame) {
        walk_scene_next(&w, given);
        for (int trial = 0; trial < 20; ++trial) {
            const int level[2] = {trial % 3 - 1, (trial + 1) % 3 - 1};
            mote_walker at[2];
            uint64_t moves = 0;
            random_places(&w, level, at);
            const double before = mote_distance_squared(at[0].world, at[1].world);
            double least;
            const double squared =
                mote_descend(w.ground, level, at, HUGE_VAL, NULL, &least, &moves);
            assert_true(squared <= before && least <= sqrt(squared));
            assert_true((squared < before) == (moves > 0));
            assert_places(&w, at, squared);
            assert_local_minimum(&w, at, squared);
        }
    }
    walk_scene_free(&w);
}

TEST(descend_static_local_minimum)
{
    check_descents(false, false);
}

TEST(descend_given_local_minimum)
{
    check_descents(true, true);
}

TEST(descend_deforming_local_minimum)
{
    check_descents(true, false);
}

TEST(walk_one_level_stays_on_it)
{
    walk_scene w;
    walk_scene_init(&w, true);
    for (int frame = 0; frame < 20; ++frame) {
        walk_scene_next(&w, false);
        const int level[2] = {1, 0};
        mote_walker at[2];
        uint64_t moves = 0;
        random_places(&w, level, at);
        mote_walk(w.ground, level, at, &moves);
        for (int b = 0; b < 2; ++b) {
            assert_true(at[b].node < w.levels[b]->level[level[b]].count);
            assert_int_equal(at[b].vertex, w.levels[b]->vertex[at[b].node]);
            assert_same_point(at[b].world, w.s.world[b][at[b].vertex]);
        }
    }
    walk_scene_free(&w);
}

/* A descent that gives up is justified and costs less; any other ends at the same place as a
   full one. */
TEST(descend_not_worth_it_gives_up)
{
    walk_scene w;
    walk_scene_init(&w, true);
    int given_up = 0;
    for (int frame = 0; frame < 100; ++frame) {
        walk_scene_next(&w, false);
        const int level[2] = {(int)w.levels[0]->depth - 1, (int)w.levels[1]->depth - 1};
        mote_walker start[2];
        random_places(&w, level, start);
        const double worth = scene_random(&w.s, 0, 0.5) * w.s.length;
        mote_walker far[2] = {start[0], start[1]}, all[2] = {start[0], start[1]};
        double least[2];
        uint64_t moves[2] = {0, 0};
        const double squared =
            mote_descend(w.ground, level, far, worth, NULL, &least[0], &moves[0]);
        const double ends =
            mote_descend(w.ground, level, all, HUGE_VAL, NULL, &least[1], &moves[1]);
        assert_true(ends < HUGE_VAL);
        if (squared < HUGE_VAL) {
            assert_true(squared == ends && moves[0] == moves[1] && least[0] == least[1]);
            continue;
        }
        ++given_up;
        assert_true(least[0] > worth);
        assert_true(moves[0] <= moves[1]);
    }
    assert_in_range(given_up, 10, 90);
    walk_scene_free(&w);
}

/* A descent over thousands of vertices evaluates about as many positions as it makes moves; it
   evaluates whole rings only at its end. */
TEST(descend_evaluates_few_positions)
{
    walk_scene w;
    walk_scene_init(&w, true);
    uint64_t all_moves = 0;
    uint64_t all_evaluated = 0;
    for (int frame = 0; frame < 50; ++frame) {
        walk_scene_next(&w, false);
        const int level[2] = {(int)w.levels[0]->depth - 1, (int)w.levels[1]->depth - 1};
        mote_walker at[2];
        double least;
        random_places(&w, level, at);
        const uint64_t before = w.lazy[0].evaluated + w.lazy[1].evaluated;
        mote_descend(w.ground, level, at, HUGE_VAL, NULL, &least, &all_moves);
        all_evaluated += w.lazy[0].evaluated + w.lazy[1].evaluated - before;
    }
    assert_true(all_evaluated < 2 * all_moves + 50 * 32);
    walk_scene_free(&w);
}

/* If the end is known, a descent stops beside it after at most as many moves, or reaches it as
   before. */
TEST(descend_beside_known_ends_there)
{
    walk_scene w;
    walk_scene_init(&w, true);
    int joined = 0;
    for (int frame = 0; frame < 100; ++frame) {
        walk_scene_next(&w, false);
        const int level[2] = {(int)w.levels[0]->depth - 1, MOTE_MESH_LEVEL};
        mote_walker start[2];
        random_places(&w, level, start);
        mote_walker all[2] = {start[0], start[1]}, beside[2] = {start[0], start[1]};
        double least;
        uint64_t moves[2] = {0, 0};
        const double ends =
            mote_descend(w.ground, level, all, HUGE_VAL, NULL, &least, &moves[0]);
        const uint32_t known[2] = {all[0].vertex, all[1].vertex};
        const double squared =
            mote_descend(w.ground, level, beside, HUGE_VAL, known, &least, &moves[1]);
        if (squared < HUGE_VAL) {
            assert_true(squared == ends && moves[0] == moves[1]);
            continue;
        }
        ++joined;
        assert_true(moves[1] <= moves[0] && least <= sqrt(ends) + 1e-12 * w.s.length);
        for (int b = 0; b < 2; ++b) /* two edges at most */
            assert_true(mote_length(mote_sub(w.s.mesh[b]->positions[beside[b].vertex],
                                             w.s.mesh[b]->positions[known[b]])) <=
                        6 * w.s.mesh[b]->mean_edge);
        assert_same_point(beside[1].world, start[1].world); /* it did not move */
    }
    assert_in_range(joined, 1, 99);
    walk_scene_free(&w);
}
