/* Splitting triangles for the certificate's tree. Two clusters are known, and the parts are
   held against them. */
#include "core/certificate/certificate_split.h"
#include "core/certificate/certificate_tree.h"

#include "tests/support/certificate_scene.h"
#include "tests/support/solids.h"
#include "tests/support/test.h"
#include "tests/support/truth.h"

#include <float.h>

enum { TRIANGLES = 1500, POSES = 3 };

static float centres[POSES * TRIANGLES][3];

/* Triangles below `first` are one cluster, the others another. Both are a unit cube; in pose
   `apart` the second one is moved by 5 along y. */
static void place(uint32_t count, uint32_t first, uint32_t apart, mote_cert_item *items)
{
    uint64_t seed = 17 + count + first;
    for (uint32_t pose = 0; pose < POSES; ++pose) {
        for (uint32_t t = 0; t < count; ++t) {
            for (int k = 0; k < 3; ++k)
                centres[(size_t)pose * count + t][k] = (float)random_between(&seed, 0, 1);
            if (pose == apart && t >= first)
                centres[(size_t)pose * count + t][1] += 5;
        }
    }
    for (uint32_t i = 0; i < count; ++i) {
        const uint32_t place = (uint32_t)random_between(&seed, 0, i + 0.999);
        items[i].triangle = items[place].triangle;
        items[place].triangle = i;
    }
}

static mote_cert_poses poses_of(uint32_t count, uint32_t poses)
{
    return (mote_cert_poses){.centres = centres, .count = poses, .triangles = count};
}

static void check_all_there(const mote_cert_item *items, uint32_t count)
{
    static bool seen[TRIANGLES];
    memset(seen, 0, sizeof seen);
    for (uint32_t i = 0; i < count; ++i) {
        assert_true(items[i].triangle < count && !seen[items[i].triangle]);
        seen[items[i].triangle] = true;
    }
}

/* Whether the first part is one of the clusters. */
static bool parts_clusters(const mote_cert_item *items, uint32_t count, uint32_t half,
                           uint32_t first)
{
    const bool low = items[0].triangle < first;
    for (uint32_t i = 0; i < count; ++i) {
        if ((items[i].triangle < first) != (i < half ? low : !low))
            return false;
    }
    return true;
}

TEST(at_rest_alone_triangles_are_halved_across_the_longest_side)
{
    static mote_cert_item items[TRIANGLES];
    for (uint32_t count = 2; count <= 1001; count += 111) {
        place(count, count, POSES, items);
        for (uint32_t t = 0; t < count; ++t)
            centres[t][2] *= 50;
        const mote_cert_poses poses = poses_of(count, 1);
        assert_true(mote_cert_split(&poses, items, count, 1, count) == count / 2);
        check_all_there(items, count);
        float most = -1, least = 100;
        for (uint32_t i = 0; i < count; ++i) {
            const float z = centres[items[i].triangle][2];
            most = i < count / 2 && z > most ? z : most;
            least = i >= count / 2 && z < least ? z : least;
        }
        /* the axis is that of the spread: of a few triangles, some degrees off the long side */
        assert_true(most - least < (count < 200 ? 10 : 2));
    }
}

TEST(clusters_that_part_in_one_pose_are_split)
{
    static mote_cert_item items[TRIANGLES];
    for (uint32_t apart = 0; apart < POSES; ++apart) {
        for (uint32_t count = 60; count <= TRIANGLES; count *= 5) {
            place(count, count / 2, apart, items);
            const mote_cert_poses poses = poses_of(count, POSES);
            const uint32_t half = mote_cert_split(&poses, items, count, 1, count / 2);
            check_all_there(items, count);
            assert_true(half == count / 2);
            assert_true(parts_clusters(items, count, half, count / 2));
        }
    }
}

/* 20 of 64 apart from 44: found where a part of 44 has room, not where it has not. */
TEST(parts_are_as_uneven_as_there_is_room_for)
{
    static mote_cert_item items[TRIANGLES];
    for (uint32_t first = 20; first <= 44; first += 24) {
        const mote_cert_poses poses = poses_of(64, POSES);
        place(64, first, 1, items);
        const uint32_t half = mote_cert_split(&poses, items, 64, 1, 44);
        check_all_there(items, 64);
        assert_true(parts_clusters(items, 64, half, first));
        place(64, first, 1, items);
        const uint32_t less = mote_cert_split(&poses, items, 64, 1, 40);
        check_all_there(items, 64);
        assert_true(less >= 24 && less <= 40);
    }
}

/* The same with what counts at rest alone, the spread of both parts. */
TEST(at_rest_alone_clusters_are_parted_where_there_is_room)
{
    static mote_cert_item items[TRIANGLES];
    const mote_cert_poses poses = poses_of(64, 1);
    for (uint32_t first = 20; first <= 44; first += 24) {
        place(64, first, 0, items);
        const uint32_t half = mote_cert_split(&poses, items, 64, 1, 44);
        check_all_there(items, 64);
        assert_true(parts_clusters(items, 64, half, first));
        place(64, first, 0, items);
        const uint32_t less = mote_cert_split(&poses, items, 64, 1, 40);
        check_all_there(items, 64);
        assert_true(less >= 24 && less <= 40);
    }
}

/* 20 of 64 apart from 44: found where a part may be as small as that, not where it may not. */
TEST(parts_have_as_many_triangles_as_they_need)
{
    static mote_cert_item items[TRIANGLES];
    const mote_cert_poses poses = poses_of(64, POSES);
    for (uint32_t least = 20; least <= 32; least += 3) {
        place(64, 20, 1, items);
        const uint32_t half = mote_cert_split(&poses, items, 64, least, 44);
        check_all_there(items, 64);
        assert_true(half >= least && half <= 64 - least);
        assert_int_equal(parts_clusters(items, 64, half, 20), least == 20);
    }
}

/* Separate triangles about the origin, but the first, which is far away. */
static mote_mesh *mesh_with_a_far_triangle(uint32_t count)
{
    uint64_t seed = count;
    double *xyz = malloc(9 * (size_t)count * sizeof *xyz);
    uint32_t *corner = malloc(3 * (size_t)count * sizeof *corner);
    assert_true(xyz && corner);
    for (uint32_t v = 0; v < 3 * count; ++v) {
        const mote_vec3 x = random_vec3(&seed, 1);
        corner[v] = v;
        xyz[3 * v] = x.x + (v < 3 ? 30 : 0);
        xyz[3 * v + 1] = x.y;
        xyz[3 * v + 2] = x.z;
    }
    mote_mesh *mesh = NULL;
    assert_int_equal(mote_mesh_create(xyz, 3 * (size_t)count, corner, count, &mesh), MOTE_OK);
    free(xyz);
    free(corner);
    return mesh;
}

/* A part of one triangle is split once for each level that the tree has below it, unless there
   are enough triangles for all leaves. */
TEST(trees_with_samples_have_no_empty_leaf)
{
    static const uint32_t counts[] = {33, 65, 129, 257, 300, 513};
    static const double still[3 * MOTE_FIELD_SUMMED];
    for (size_t k = 0; k < ROWS_OF(counts); ++k) {
        scene s;
        scene_init_meshes(&s, mesh_with_a_far_triangle(counts[k]), make_torus(9, 6, 1), true);
        const mote_weights sample = {still, still, still, s.field[0]->count,
                                     s.field[0]->padded};
        s.body[0].samples = &sample;
        s.body[0].sample_count = 1;
        const mote_cert_tree_options options = {
            .length = s.length, .width = 8, .linear_fits = true};
        mote_cert_tree *tree = NULL;
        test_row("%u triangles", counts[k]);
        assert_int_equal(mote_cert_tree_create(&s.body[0], &options, &tree), MOTE_OK);
        uint32_t triangles = 0;
        for (uint32_t i = 0; i < tree->leaf_count; ++i) {
            assert_in_range(tree->leaves[i].triangle_count, 1, MOTE_CERT_LEAF_TRIANGLES);
            triangles += tree->leaves[i].triangle_count;
        }
        assert_int_equal(triangles, counts[k]);
        mote_cert_tree_destroy(tree);
        mote_certificate *c = certificate_of(&s, NULL);
        for (int f = 0; f < 3; ++f) {
            scene_next(&s, 1.2, false);
            check_exact(&s, c, scene_truth(&s));
        }
        mote_certificate_destroy(c);
        scene_free(&s);
    }
}

TEST(few_and_equal_triangles_are_halved)
{
    static mote_cert_item items[TRIANGLES];
    for (uint32_t poses = 1; poses <= POSES; poses += POSES - 1) {
        for (uint32_t count = 2; count < 70; ++count) {
            place(count, count, POSES, items);
            memset(centres, 0, sizeof centres);
            const mote_cert_poses p = poses_of(count, poses);
            /* neither half holds `most`: halves, then */
            assert_true(mote_cert_split(&p, items, count, 1, 0) == count / 2);
            check_all_there(items, count);
        }
    }
}

TEST(triangles_that_are_not_finite_are_split_within_bounds)
{
    static const float odd[] = {INFINITY, -INFINITY, NAN, FLT_MAX, -FLT_MAX};
    static mote_cert_item items[TRIANGLES];
    for (uint32_t poses = 1; poses <= POSES; poses += POSES - 1) {
        for (uint32_t count = 2; count < 700; count += count < 70 ? 1 : 97) {
            const uint32_t least = count < 20 ? 1 : count / 4;
            place(count, count, POSES, items);
            for (uint32_t t = 0; t < poses * count; t += 3)
                centres[t][t % 3] = odd[t / 3 % ROWS_OF(odd)];
            const mote_cert_poses p = poses_of(count, poses);
            const uint32_t half = mote_cert_split(&p, items, count, least, count - least);
            assert_true(half >= least && half <= count - least);
            check_all_there(items, count);
        }
    }
}
