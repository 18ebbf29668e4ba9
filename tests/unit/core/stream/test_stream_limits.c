/* Streamed queries at the ends of numbers: of stamps, of floats, of distances and of what is
   known from the frame before. */
#include "tests/support/certificate_scene.h"
#include "tests/support/own_stream.h"
#include "tests/support/truth.h"

#include <stdio.h>

/* The numbers that tell what belongs to a query begin again after 2^32: nothing of an old one
   is then taken for what is new. */
TEST(stream_stamps_that_begin_again_do_not_bring_old_boxes_back)
{
    static const uint32_t stamps[] = {0, UINT32_MAX}, aims[] = {0, UINT32_MAX};
    for (int k = 0; k < 4; ++k) {
        static own_query used, fresh;
        scene s;
        test_row("stamp %u, aim %u", stamps[k % 2], aims[k / 2]);
        scene_init(&s, 30, 12, 1, true);
        for (int i = 0; i < 5; ++i) {
            own_init(&used, &s);
            own_init(&fresh, &s);
            scene_next(&s, 1.4, false);
            (void)own_ask(&used, &s);
            assert_int_equal(used.search.stamp, 1);
            used.search.stamp = stamps[k % 2] ? stamps[k % 2] : 1;
            used.search.aim = fresh.search.aim = aims[k / 2];
            scene_next(&s, 1.4, false);
            const mote_certificate_answer a = own_ask(&used, &s), b = own_ask(&fresh, &s);
            check_same_answer(&a, &b);
            assert_memory_equal(&a.counters, &b.counters, sizeof a.counters);
            assert_int_equal(used.search.stamp, stamps[k % 2] ? 1 : 2);
            assert_true(used.search.aim != 0 || !(a.distance > 0));
            assert_true(fabs(a.distance - scene_truth(&s)) <= 1e-12 * s.length);
            own_free(&used);
            own_free(&fresh);
        }
        scene_free(&s);
    }
}

/* A flat sheet of 2 n n triangles. */
static mote_mesh *flat_sheet(uint32_t n)
{
    const uint32_t count = (n + 1) * (n + 1);
    double *xyz = calloc((size_t)3 * count, sizeof *xyz);
    uint32_t(*faces)[3] = malloc((size_t)2 * n * n * sizeof *faces);
    mote_mesh *mesh = NULL;
    need(xyz && faces);
    for (uint32_t v = 0; v < count; ++v) {
        xyz[3 * v] = (double)(v / (n + 1)) / n;
        xyz[3 * v + 1] = (double)(v % (n + 1)) / n;
    }
    for (uint32_t i = 0; i < n * n; ++i) {
        const uint32_t a = i / n * (n + 1) + i % n, c = a + n + 1;
        const uint32_t two[2][3] = {{a, c, a + 1}, {a + 1, c, c + 1}};
        memcpy(faces[2 * i], two, sizeof two);
    }
    need(mote_mesh_create(xyz, count, &faces[0][0], 2 * n * n, &mesh) == MOTE_OK);
    free(xyz);
    free(faces);
    return mesh;
}

/* Parallel sheets, each pair of faces of which is as near as every other, down to where boxes
   show nothing. Coordinates are multiples of 1/8, so that no distance is rounded. */
TEST(query_sheets_that_nearly_touch_are_as_far_apart_as_they_are)
{
    static const double gaps[] = {1e-3, 1e-9, 1e-15, 0};
    scene s;
    scene_init_meshes(&s, flat_sheet(8), flat_sheet(4), false);
    for (size_t i = 0; i < ROWS_OF(gaps); ++i) {
        for (int threads = 1; threads <= 3; threads += 2) { /* too little for three */
            mote_stream_options options = mote_default_stream_options(s.length);
            options.threads = (uint32_t)threads;
            mote_stream *stream = stream_of(&s, &options);
            test_row("gap %g, %d threads", gaps[i], threads);
            (void)scene_next(&s, 0, false);
            for (int b = 0; b < 2; ++b) {
                for (uint32_t v = 0; v < s.mesh[b]->vertex_count; ++v) {
                    s.world[b][v] = s.mesh[b]->positions[v];
                    s.world[b][v].z = b * gaps[i];
                }
            }
            for (int k = 0; k < 2; ++k) {
                const mote_stream_frame frame = positions_of(&s);
                const mote_certificate_answer a = stream_answer(stream, &frame, -1);
                assert_true(fabs(a.distance - gaps[i]) <= 1e-12 * gaps[i]);
                assert_true(a.lower <= gaps[i] && a.lower >= gaps[i] - 1e-12);
            }
            mote_stream_destroy(stream);
        }
    }
    scene_free(&s);
}

/* Positions so small, as measured by L, that boxes and directions show nothing: every pair of
   faces is measured. */
TEST(query_positions_far_below_the_unit_are_exact)
{
    static const double sizes[] = {1e-9, 1e-60, 1e-105, 1e-140};
    scene s;
    scene_init(&s, 14, 9, 1, true);
    for (size_t i = 0; i < ROWS_OF(sizes); ++i) {
        mote_stream *stream = stream_of(&s, NULL);
        const double allowed = 1e-12 * sizes[i] * s.length;
        for (int k = 0; k < 6; ++k) {
            test_row("size %g, frame %d", sizes[i], k);
            scene_next(&s, 1.4, false);
            const double truth = sizes[i] * scene_truth(&s);
            for (int b = 0; b < 2; ++b) {
                for (uint32_t v = 0; v < s.mesh[b]->vertex_count; ++v)
                    s.world[b][v] = mote_scale(s.world[b][v], sizes[i]);
            }
            const mote_stream_frame frame = positions_of(&s);
            const mote_certificate_answer a = stream_answer(stream, &frame, -1);
            assert_true(fabs(a.distance - truth) <= allowed);
            assert_true(a.lower <= truth && a.lower >= truth - allowed);
        }
        mote_stream_destroy(stream);
    }
    scene_free(&s);
}

/* The plane 2 y + x = 4 z through the points of a leaf, its axes turned by `turn`. */
static void put_in_plane(const mote_stream_tree *tree, double size, size_t turn,
                         mote_stream_slot *slot)
{
    memset(slot, 0, sizeof *slot);
    for (size_t i = 0; i < tree->leaf_start[1]; ++i) {
        const mote_vec3 p = tree->mesh->positions[tree->leaf_vertices[i]];
        slot->x[turn][i] = (float)(size * p.x);
        slot->x[(turn + 1) % 3][i] = (float)(size * p.y);
        slot->x[(turn + 2) % 3][i] = (float)(size * (0.25 * p.x + 0.5 * p.y));
    }
}

/* The mean normal of a leaf's faces: that of the sheet, at any size, whichever of its numbers
   is the largest; none where its products leave the range of floats. */
TEST(mote_stream_normal_is_that_of_the_sheet_or_none)
{
    static const double sizes[] = {1, 1e-15, 1e15, 1e-30, 1e30, 1e-23, 0};
    scene s;
    static own_query own;
    scene_init_meshes(&s, flat_sheet(3), flat_sheet(3), false);
    own_init(&own, &s);
    const mote_stream_tree *tree = own.tree[0];
    assert_int_equal(tree->leaves, 1);
    own.search.side[0].body = &own.body[0];
    for (size_t k = 0; k < 3 * ROWS_OF(sizes); ++k) {
        static mote_stream_slot slot;
        const double size = sizes[k / 3];
        put_in_plane(tree, size, k % 3, &slot);
        const float *n = mote_stream_normal(&own.search, 0, &slot);
        const double x = (double)n[k % 3], y = (double)n[(k + 1) % 3],
                     z = (double)n[(k + 2) % 3];
        const double sign = z > 0 ? 1 : -1;
        const bool usable = size > 1e-20 && size < 1e20;
        test_row("size %g, turned %zu times", size, k % 3);
        assert_true(fabs(z - (usable ? sign : 0)) < 1e-5);
        assert_true(fabs(x + (usable ? 0.25 * sign : 0)) < 1e-5);
        assert_true(fabs(y + (usable ? 0.5 * sign : 0)) < 1e-5);
        memset(slot.x, 0, sizeof slot.x); /* it is kept */
        assert_ptr_equal(mote_stream_normal(&own.search, 0, &slot), n);
        assert_int_equal((double)n[(k + 2) % 3] > 0 || (double)n[(k + 2) % 3] < 0, usable);
    }
    own_free(&own);
    scene_free(&s);
}

/* Positions in single precision near the largest floats: their sums are not finite, but each of
   them is. */
TEST(query_floats_of_which_sums_overflow_are_answered)
{
    scene s;
    scene_init(&s, 25, 11, 1, true);
    const double size = 4e37;
    mote_stream_options options = mote_default_stream_options(size * s.length);
    for (int apart = 0; apart < 2; ++apart) {
        mote_stream *stream = stream_of(&s, &options);
        for (int k = 0; k < 5; ++k) {
            mote_stream_frame frame = {.unchanged = {false, false}};
            void *data[2];
            test_row("frame %d", k);
            scene_next(&s, 0.2, false);
            for (int b = 0; b < 2; ++b) {
                const double shift = 3 + apart * b * 2.5;
                for (uint32_t v = 0; v < s.mesh[b]->vertex_count; ++v) {
                    mote_vec3 *p = &s.world[b][v];
                    p->x += shift;
                    *p = mote_as_floats(mote_scale(*p, size));
                }
                data[b] =
                    spread_out(s.world[b], s.mesh[b]->vertex_count, 3 + (size_t)k % 2, true);
                frame.positions[b] =
                    (mote_positions){.data = data[b],
                                     .stride = (3 + (size_t)k % 2) * sizeof(float),
                                     .single = true};
            }
            const mote_certificate_answer a = stream_answer(stream, &frame, -1);
            const double truth = scene_truth(&s);
            assert_true(fabs(a.distance - truth) <= 1e-12 * size * s.length);
            assert_true(a.lower <= truth && a.lower >= truth - 1e-12 * size * s.length);
            free(data[0]);
            free(data[1]);
        }
        mote_stream_destroy(stream);
    }
    scene_free(&s);
}

/* A position that is not finite, in any layout, in each part of bodies of several blocks. */
TEST(query_position_that_is_not_finite_is_refused_in_any_layout)
{
    static const size_t strides[] = {3, 5, 3, 4};
    scene s;
    scene_init(&s, 90, 50, 1, true); /* 9,000 triangles: 5 blocks */
    scene_next(&s, 1.4, false);
    for (size_t i = 0; i < ROWS_OF(strides); ++i) {
        const bool single = i >= 2;
        const size_t size = single ? sizeof(float) : sizeof(double);
        mote_stream *stream = stream_of(&s, NULL);
        mote_stream_frame frame = {.unchanged = {false, false}};
        char *data[2];
        for (int b = 0; b < 2; ++b) {
            data[b] = spread_out(s.world[b], s.mesh[b]->vertex_count, strides[i], single);
            frame.positions[b] = (mote_positions){
                .data = data[b], .stride = strides[i] * size, .single = single};
        }
        const mote_certificate_answer good = stream_answer(stream, &frame, -1);
        for (uint32_t k = 0; k < 24; ++k) {
            const uint32_t v = (k * s.mesh[k % 2]->vertex_count + 7) / 24;
            char *at = data[k % 2] + v * strides[i] * size, kept[8], expected[64];
            mote_certificate_answer a;
            const double wrong = k % 3 ? (double)NAN : HUGE_VAL;
            const float single_wrong = (float)wrong;
            test_row("stride %zu, single %d, vertex %u", strides[i], single, v);
            memcpy(kept, at, size);
            memcpy(at, single ? (const void *)&single_wrong : (const void *)&wrong, size);
            assert_int_equal(mote_stream_query(stream, &frame, -1, &a), MOTE_EINVAL);
            (void)snprintf(expected, sizeof expected, "body %u: vertex %u is at", k % 2, v);
            assert_non_null(strstr(mote_error_text(), expected));
            memcpy(at, kept, size);
        }
        const mote_certificate_answer again = stream_answer(stream, &frame, -1);
        assert_true(fabs(good.distance - again.distance) <= 1e-13 * s.length);
        mote_stream_destroy(stream);
        free(data[0]);
        free(data[1]);
    }
    scene_free(&s);
}

/* A body that rests is not read again where the other one goes far away, where boxes have
   another scale, comes back, or lies in it. */
TEST(query_unchanged_body_while_the_other_goes_far_away)
{
    static const double away[] = {1.5, 1e3, 1e3, 2e6, 1.5, 0, 0, 1e9, 1.4};
    scene s;
    scene_init(&s, 25, 11, 1, true);
    mote_stream *stream = stream_of(&s, NULL);
    scene_next(&s, 0, false);
    const uint32_t count = s.mesh[1]->vertex_count;
    mote_vec3 *rest = malloc(count * sizeof *rest);
    need(rest);
    memcpy(rest, s.world[1], count * sizeof *rest);
    const double length = s.length;
    for (size_t k = 0; k < ROWS_OF(away); ++k) {
        mote_stream_frame frame = positions_of(&s);
        test_row("frame %zu, %g L away", k, away[k]);
        for (uint32_t v = 0; v < count; ++v)
            s.world[1][v] = mote_add(rest[v], mote_vec3_make(away[k] * length, 0, 0));
        frame.unchanged[0] = k > 0;
        frame.unchanged[1] = k > 0 && !(fabs(away[k] - away[k - 1]) > 0);
        const mote_certificate_answer a = stream_answer(stream, &frame, -1);
        const double truth = scene_truth(&s);
        /* where the unit of the boxes changes, those of the body that rests are made again */
        if (k == 1 || k == 3)
            assert_true(a.counters.positions >= s.mesh[0]->vertex_count + count);
        s.length = length * fmax(1, away[k]);
        check_bracket(&s, &a, truth);
        assert_true(a.distance <= truth + 1e-12 * s.length);
        assert_true(a.lower >= truth - 1e-12 * s.length);
        s.length = length;
    }
    free(rest);
    mote_stream_destroy(stream);
    scene_free(&s);
}
