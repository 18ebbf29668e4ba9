/* Streamed queries against all pairs of triangles, and their promises about the input. */
#include "harness/base/heap_count.h"
#include "tests/support/certificate_scene.h"
#include "tests/support/stream_scene.h"
#include "tests/support/truth.h"

#include <stdio.h>

static void check_streamed(const scene *s, mote_stream *stream, double truth)
{
    const mote_stream_frame frame = positions_of(s);
    const mote_certificate_answer a = stream_answer(stream, &frame, -1);
    check_bracket(s, &a, truth);
    assert_true(a.distance <= truth + 1e-12 * s->length);
    assert_true(a.lower >= truth - 1e-12 * s->length);
    assert_true(truth > 0 || a.distance <= 0);
}

TEST(query_any_deformation_equals_all_pairs)
{
    static const double shakes[] = {0, 0.002, 0.05};
    for (size_t i = 0; i < ROWS_OF(shakes); ++i) {
        scene s;
        scene_init(&s, 25, 11, 2.5, true);
        mote_stream *stream = stream_of(&s, NULL);
        int contacts = 0;
        for (int k = 0; k < 30; ++k) {
            if (k % 4)
                scene_step(&s);
            else
                scene_next(&s, k % 3 ? 1.4 : 0.8, false);
            shake(&s, shakes[i]);
            const double truth = scene_truth(&s);
            contacts += !(truth > 0);
            check_streamed(&s, stream, truth);
        }
        assert_in_range(contacts, 1, 29);
        mote_stream_destroy(stream);
        scene_free(&s);
    }
    mote_stream_destroy(NULL);
}

/* A sheet of 2 * n * n triangles on the outside of a body, each vertex at a height above a
   vertex of it: draped, so that no plane separates most pairs of leaves. */
static mote_mesh *make_sheet(uint32_t n)
{
    double *xyz = malloc((size_t)3 * (n + 1) * (n + 1) * sizeof *xyz);
    uint32_t(*faces)[3] = malloc((size_t)2 * n * n * sizeof *faces);
    need(xyz && faces);
    for (uint32_t i = 0; i <= n; ++i) {
        for (uint32_t j = 0; j <= n; ++j) {
            double *p = xyz + (size_t)3 * (i * (n + 1) + j);
            p[0] = 1.0 * i / n - 0.5;
            p[1] = 1.0 * j / n - 0.5;
            p[2] = 0;
        }
    }
    for (uint32_t i = 0; i < n; ++i) {
        for (uint32_t j = 0; j < n; ++j) {
            const uint32_t a = i * (n + 1) + j, c = a + n + 1;
            const uint32_t two[2][3] = {{a, c, a + 1}, {a + 1, c, c + 1}};
            memcpy(faces[2 * (i * n + j)], two, sizeof two);
        }
    }
    mote_mesh *mesh = NULL;
    need(mote_mesh_create(xyz, (n + 1) * (n + 1), &faces[0][0], 2 * n * n, &mesh) == MOTE_OK);
    free(xyz);
    free(faces);
    return mesh;
}

/* Height of a body with waves and a ridge, and of a sheet that lies on it. */
static double ground(double x, double y)
{
    return 0.06 * sin(9 * x) * cos(7 * y) - 0.5 * fabs(x);
}

/* The pairs of leaves that touch each other in thousands of places within rounding are decided
   face by face: the way of a cloth at rest. */
TEST(query_sheet_at_rest_on_a_body_equals_all_pairs)
{
    static const double gaps[] = {0.004, 1e-6, 0.02};
    for (size_t i = 0; i < ROWS_OF(gaps); ++i) {
        scene s;
        scene_init_meshes(&s, make_sheet(22), make_sheet(19), false);
        mote_stream *stream = stream_of(&s, NULL);
        uint64_t leaf_pairs = 0;
        for (int k = 0; k < 6; ++k) {
            (void)scene_next(&s, 0, false);
            for (int b = 0; b < 2; ++b) {
                for (uint32_t v = 0; v < s.mesh[b]->vertex_count; ++v) {
                    const mote_vec3 p = s.mesh[b]->positions[v];
                    const double settled = k % 2 ? 0 : scene_random(&s, -1e-5, 1e-5);
                    s.world[b][v] = mote_vec3_make(
                        p.x, p.y, ground(p.x, p.y) + (b == 0 ? gaps[i] + settled : 0));
                }
            }
            const double truth = scene_truth(&s);
            check_streamed(&s, stream, truth);
            const mote_stream_frame frame = positions_of(&s);
            leaf_pairs += stream_answer(stream, &frame, -1).counters.leaf_pairs;
        }
        assert_true(i == 1 || leaf_pairs > 6 * 30);
        mote_stream_destroy(stream);
        scene_free(&s);
    }
}

/* Separate triangles: leaves with the largest possible number of vertices, and trees of one
   leaf, of one group, and of more. */
TEST(query_separate_triangles_equals_all_pairs)
{
    static const uint32_t counts[] = {1, 31, 33, 257, 600};
    for (size_t i = 0; i < ROWS_OF(counts); ++i) {
        const uint32_t vertices = 3 * counts[i];
        double *xyz = malloc(3 * vertices * sizeof *xyz);
        uint32_t *faces = malloc(vertices * sizeof *faces);
        need(xyz && faces);
        for (uint32_t v = 0; v < vertices; ++v) {
            xyz[3 * v] = 0.1 * (v / 3) + 0.07 * (v % 3 == 1);
            xyz[3 * v + 1] = 0.09 * (v % 3 == 2);
            xyz[3 * v + 2] = sin(1.0 * (v / 3));
            faces[v] = vertices - 1 - v;
        }
        mote_mesh *mesh = NULL;
        assert_int_equal(mote_mesh_create(xyz, vertices, faces, counts[i], &mesh), MOTE_OK);
        free(xyz);
        free(faces);
        scene s;
        scene_init_meshes(&s, mesh, make_torus(9, 6, 1), false);
        mote_stream *stream = stream_of(&s, NULL);
        for (int k = 0; k < 15; ++k) {
            test_row("%u triangles, frame %d", counts[i], k);
            scene_next(&s, 0.5, false);
            shake(&s, 0.01);
            check_streamed(&s, stream, scene_truth(&s));
        }
        mote_stream_destroy(stream);
        scene_free(&s);
    }
}

/* Every layout gives the same answers as the same numbers in an array of vectors, and nothing
   after the last vertex is read (under AddressSanitizer). */
TEST(query_any_layout_gives_the_same_bits)
{
    static const size_t strides[] = {3, 4, 5, 3, 4, 7};
    scene s;
    scene_init(&s, 40, 15, 1, true);
    mote_stream *streams[7];
    for (size_t i = 0; i < 7; ++i)
        streams[i] = stream_of(&s, NULL);
    for (int k = 0; k < 12; ++k) {
        scene_next(&s, 1.3, false);
        for (int b = 0; b < 2; ++b) { /* as floats: the same numbers in all layouts */
            for (uint32_t v = 0; v < s.mesh[b]->vertex_count; ++v)
                s.world[b][v] = mote_as_floats(s.world[b][v]);
        }
        const mote_stream_frame plain = positions_of(&s);
        const mote_certificate_answer expected = stream_answer(streams[6], &plain, -1);
        assert_true(fabs(expected.distance - scene_truth(&s)) <= 1e-12 * s.length);
        for (size_t i = 0; i < ROWS_OF(strides); ++i) {
            const bool single = i >= 3;
            mote_stream_frame frame = {.unchanged = {false, false}};
            void *data[2];
            test_row("frame %d, stride %zu, single %d", k, strides[i], single);
            for (int b = 0; b < 2; ++b) {
                data[b] = spread_out(s.world[b], s.mesh[b]->vertex_count, strides[i], single);
                frame.positions[b] = (mote_positions){
                    .data = data[b],
                    .stride = strides[i] * (single ? sizeof(float) : sizeof(double)),
                    .single = single};
            }
            const mote_certificate_answer a = stream_answer(streams[i], &frame, -1);
            check_same_answer(&expected, &a);
            free(data[0]);
            free(data[1]);
        }
    }
    for (size_t i = 0; i < 7; ++i)
        mote_stream_destroy(streams[i]);
    scene_free(&s);
}

/* Makes each vertex bad in turn, also in frames of contact. The next frame is answered as if
   nothing had happened. */
TEST(query_position_that_is_not_finite_is_refused)
{
    static const double bad[] = {NAN, HUGE_VAL, -HUGE_VAL};
    scene s;
    scene_init(&s, 14, 9, 1, true);
    mote_stream *stream = stream_of(&s, NULL);
    int contacts = 0, refused = 0;
    for (int k = 0; k < 12; ++k) {
        scene_next(&s, k % 2 ? 0.2 : 1.5, false);
        const double truth = scene_truth(&s);
        contacts += !(truth > 0);
        for (uint32_t i = 0; i < 2 * s.mesh[0]->vertex_count; ++i) {
            mote_vec3 *at = &s.world[i % 2][i / 2];
            const mote_vec3 kept = *at;
            double *number = i % 3 == 0 ? &at->x : i % 3 == 1 ? &at->y : &at->z;
            *number = bad[(i + (uint32_t)k) % 3];
            const mote_stream_frame frame = positions_of(&s);
            mote_certificate_answer a;
            assert_int_equal(mote_stream_query(stream, &frame, -1, &a), MOTE_EINVAL);
            char expected[64];
            (void)snprintf(expected, sizeof expected, "body %u: vertex %u is at", i % 2, i / 2);
            assert_non_null(strstr(mote_error_text(), expected));
            *at = kept;
            ++refused;
        }
        check_streamed(&s, stream, truth);
    }
    assert_in_range(contacts, 2, 10);
    assert_true(refused > 1000);
    mote_stream_destroy(stream);
    scene_free(&s);
}

TEST(query_bad_layout_is_refused)
{
    scene s;
    scene_init(&s, 8, 6, 1, false);
    mote_stream *stream = stream_of(&s, NULL);
    scene_next(&s, 1.5, false);
    const mote_stream_frame good = positions_of(&s);
    mote_certificate_answer a;
    mote_stream_frame frame = good;
    frame.positions[1].data = NULL;
    assert_int_equal(mote_stream_query(stream, &frame, -1, &a), MOTE_EINVAL);
    assert_non_null(strstr(mote_error_text(), "body 1 has no positions"));
    static const size_t strides[] = {0, 16, 20, 28};
    for (size_t i = 0; i < ROWS_OF(strides); ++i) {
        frame = good;
        frame.positions[0].stride = strides[i];
        assert_int_equal(mote_stream_query(stream, &frame, -1, &a), MOTE_EINVAL);
        assert_non_null(strstr(mote_error_text(), "body 0 has a stride of"));
    }
    frame = good;
    frame.positions[0].data = (const char *)good.positions[0].data + 4;
    assert_int_equal(mote_stream_query(stream, &frame, -1, &a), MOTE_EINVAL);
    check_streamed(&s, stream, scene_truth(&s));
    mote_stream_destroy(stream);
    scene_free(&s);
}

/* Positions that are large in the meshes' unit, small, or far away: if positions and L are
   multiplied by a power of two, the answer is multiplied by it, with the same bits. */
TEST(query_positions_times_a_power_of_two_give_the_same_bits)
{
    scene s;
    scene_init(&s, 14, 9, 1, true);
    static const int powers[] = {-60, -7, 3, 80};
    for (size_t i = 0; i < ROWS_OF(powers); ++i) {
        mote_stream_options options = mote_default_stream_options(ldexp(s.length, powers[i]));
        mote_stream *plain = stream_of(&s, NULL), *scaled = stream_of(&s, &options);
        for (int k = 0; k < 10; ++k) {
            scene_next(&s, 1.4, false);
            mote_stream_frame frame = positions_of(&s);
            const mote_certificate_answer a = stream_answer(plain, &frame, -1);
            for (int b = 0; b < 2; ++b) {
                for (uint32_t v = 0; v < s.mesh[b]->vertex_count; ++v)
                    s.world[b][v] = mote_scale(s.world[b][v], ldexp(1, powers[i]));
            }
            const mote_certificate_answer c = stream_answer(scaled, &frame, -1);
            assert_true(c.distance == ldexp(a.distance, powers[i]));
            assert_true(c.lower == ldexp(a.lower, powers[i]));
            assert_int_equal(a.counters.box_tests, c.counters.box_tests);
        }
        mote_stream_destroy(plain);
        mote_stream_destroy(scaled);
    }
    scene_free(&s);
}

/* The unit of the positions need not be that of the meshes. */
TEST(query_positions_of_another_size_than_the_mesh_is_exact)
{
    static const double sizes[] = {1e-9, 1e-4, 1e5, 1e12};
    scene s;
    scene_init(&s, 14, 9, 1, true);
    const double length = s.length;
    for (size_t i = 0; i < ROWS_OF(sizes); ++i) {
        mote_stream *stream = stream_of(&s, NULL);
        for (int k = 0; k < 6; ++k) {
            test_row("size %g, frame %d", sizes[i], k);
            scene_next(&s, 1.4, false);
            for (int b = 0; b < 2; ++b) {
                for (uint32_t v = 0; v < s.mesh[b]->vertex_count; ++v)
                    s.world[b][v] = mote_scale(s.world[b][v], sizes[i]);
            }
            s.length = length * fmax(1, sizes[i]);
            check_streamed(&s, stream, scene_truth(&s));
            s.length = length;
        }
        mote_stream_destroy(stream);
    }
    scene_free(&s);
}

TEST(query_positions_too_far_apart_is_refused)
{
    scene s;
    scene_init(&s, 8, 6, 1, false);
    mote_stream *stream = stream_of(&s, NULL);
    mote_certificate_answer a;
    scene_next(&s, 1.5, false);
    s.world[0][3].y = 1e25;
    const mote_stream_frame frame = positions_of(&s);
    assert_int_equal(mote_stream_query(stream, &frame, -1, &a), MOTE_EINVAL);
    assert_non_null(strstr(mote_error_text(), "10^18 times"));
    for (uint32_t v = 0; v < s.mesh[0]->vertex_count; ++v)
        s.world[0][v].x = 1e200;
    assert_int_equal(mote_stream_query(stream, &frame, -1, &a), MOTE_EINVAL);
    assert_non_null(strstr(mote_error_text(), "too far apart"));
    scene_next(&s, 1.5, false);
    check_streamed(&s, stream, scene_truth(&s));
    mote_stream_destroy(stream);
    scene_free(&s);
}

TEST(query_slack_budget_and_contact_bracket_the_truth)
{
    scene s;
    scene_init(&s, 25, 11, 1, true);
    mote_stream_options options[4];
    mote_stream *streams[4];
    int stopped = 0, contacts = 0, wide = 0;
    for (int i = 0; i < 4; ++i)
        options[i] = mote_default_stream_options(s.length);
    options[1].slack = 1e-2;
    options[2].budget = 40;
    options[3].coherent = false;
    for (int i = 0; i < 4; ++i)
        streams[i] = stream_of(&s, &options[i]);
    for (int k = 0; k < 40; ++k) {
        scene_next(&s, 1.4, false);
        shake(&s, 0.002);
        const double truth = scene_truth(&s), tolerance = 0.05 * s.length;
        const mote_stream_frame frame = positions_of(&s);
        for (int i = 0; i < 4; ++i) {
            const mote_certificate_answer a = stream_answer(streams[i], &frame, -1);
            check_bracket(&s, &a, truth);
            const double allowed = (i == 1 ? 1e-2 : 0) * s.length + 1e-12 * s.length;
            assert_true(a.stopped || a.distance - a.lower <= allowed);
            stopped += a.stopped;
            wide += i == 1 && a.distance - a.lower > 1e-6 * s.length;
            const mote_certificate_answer c = stream_answer(streams[i], &frame, tolerance);
            check_bracket(&s, &c, truth);
            if (truth <= tolerance && i != 1 && i != 2)
                assert_true(c.distance <= tolerance);
            if (truth > tolerance && i != 1 && i != 2)
                assert_true(c.lower > tolerance);
            contacts += truth <= tolerance;
        }
    }
    assert_true(stopped > 10 && contacts > 10 && wide > 5);
    for (int i = 0; i < 4; ++i)
        mote_stream_destroy(streams[i]);
    scene_free(&s);
}

/* A body reported as unchanged is not read again. */
TEST(query_unchanged_body_gives_the_same_answers)
{
    scene s;
    scene_init(&s, 25, 11, 1, true);
    mote_stream *told = stream_of(&s, NULL), *plain = stream_of(&s, NULL);
    scene_next(&s, 1.4, false);
    mote_vec3 *resting = malloc(s.mesh[0]->vertex_count * sizeof *resting);
    need(resting);
    memcpy(resting, s.world[0], s.mesh[0]->vertex_count * sizeof *resting);
    int fewer = 0;
    for (int k = 0; k < 25; ++k) {
        scene_next(&s, k % 5 ? 1.4 : 0.1, false);
        memcpy(s.world[0], resting, s.mesh[0]->vertex_count * sizeof *resting);
        mote_stream_frame frame = positions_of(&s);
        const mote_certificate_answer a = stream_answer(plain, &frame, -1);
        frame.unchanged[0] = k > 0;
        const mote_certificate_answer b = stream_answer(told, &frame, -1);
        assert_true(fabs(a.distance - b.distance) <= 1e-13 * s.length);
        assert_true(fabs(a.distance - scene_truth(&s)) <= 1e-12 * s.length);
        fewer += b.counters.positions < a.counters.positions;
    }
    assert_true(fewer > 10);
    free(resting);
    mote_stream_destroy(told);
    mote_stream_destroy(plain);
    scene_free(&s);
}

/* A body is where a refused frame had it. */
TEST(query_unchanged_after_a_refused_frame_has_the_positions_of_that_frame)
{
    scene s;
    scene_init(&s, 25, 11, 1, true);
    mote_stream *stream = stream_of(&s, NULL);
    for (int k = 0; k < 200; ++k) {
        scene_next(&s, 1.6, false);
        mote_stream_frame frame = positions_of(&s);
        stream_answer(stream, &frame, -1);
        scene_next(&s, 1.6, false);
        frame = positions_of(&s);
        mote_stream_frame wrong = frame;
        wrong.positions[1].stride = 1;
        mote_certificate_answer none;
        assert_int_equal(mote_stream_query(stream, &wrong, -1, &none), MOTE_EINVAL);
        frame.unchanged[0] = true;
        const mote_certificate_answer a = stream_answer(stream, &frame, -1);
        assert_true(fabs(a.distance - scene_truth(&s)) <= 1e-12 * s.length);
    }
    mote_stream_destroy(stream);
    scene_free(&s);
}

TEST(query_any_number_of_threads_gives_the_same_bits)
{
    static const uint32_t threads[] = {1, 2, 3, 7};
    scene s;
    scene_init_meshes(&s, make_torus(330, 160, 1), make_torus(320, 160, 1), true);
    assert_true(s.mesh[0]->triangle_count > 100000 && s.mesh[1]->triangle_count > 100000);
    mote_certificate_answer expected[4] = {{.distance = 0}};
    for (size_t i = 0; i < ROWS_OF(threads); ++i) {
        mote_stream_options options = mote_default_stream_options(s.length);
        options.threads = threads[i];
        mote_stream *stream = stream_of(&s, &options);
        s.random = 3;
        s.frame.number = 0;
        for (int k = 0; k < 4; ++k) {
            scene_next(&s, 1.6, true);
            const mote_stream_frame frame = positions_of(&s);
            const mote_certificate_answer a = stream_answer(stream, &frame, -1);
            if (i == 0)
                expected[k] = a;
            check_same_answer(&expected[k], &a);
            assert_memory_equal(&expected[k].counters, &a.counters, sizeof a.counters);
        }
        s.world[1][51199].z = NAN;
        const mote_stream_frame frame = positions_of(&s);
        mote_certificate_answer a;
        assert_int_equal(mote_stream_query(stream, &frame, -1, &a), MOTE_EINVAL);
        mote_stream_destroy(stream);
    }
    scene_free(&s);
}

TEST(create_bad_number_of_threads_is_refused)
{
    scene s;
    scene_init(&s, 8, 6, 1, false);
    const mote_body *const bodies[2] = {&s.body[0], &s.body[1]};
    mote_stream_options options = mote_default_stream_options(s.length);
    mote_stream *stream = NULL;
    options.threads = 0;
    assert_int_equal(mote_stream_create(bodies, &options, &stream), MOTE_EINVAL);
    assert_null(stream);
    scene_free(&s);
}

TEST(query_never_allocates_and_bytes_are_those_of_the_heap)
{
    scene s;
    scene_init(&s, 30, 20, 1, true);
    const int64_t before = mote_heap_read().live_bytes;
    mote_stream *stream = stream_of(&s, NULL);
    const int64_t held = mote_heap_read().live_bytes - before;
    /* A sanitizer counts no heap. */
    if (mote_heap_read().counted)
        assert_true(fabs((double)mote_stream_bytes(stream) - (double)held) <
                    0.05 * (double)held);
    for (int k = 0; k < 60; ++k) {
        scene_next(&s, 1.4, false);
        const mote_stream_frame frame = positions_of(&s);
        const uint64_t allocations = mote_heap_read().allocations;
        (void)stream_answer(stream, &frame, -1);
        assert_int_equal(mote_heap_read().allocations, allocations);
    }
    mote_stream_destroy(stream);
    scene_free(&s);
}

/* The order has every vertex once. A mesh in that order is read in longer runs, with the same
   answer. */
TEST(order_is_a_permutation_that_keeps_the_answer)
{
    scene s;
    scene_init(&s, 60, 30, 1, true);
    const mote_mesh *mesh = s.mesh[0];
    const uint32_t count = mesh->vertex_count;
    uint32_t *order = malloc(count * sizeof *order), *place = calloc(count, sizeof *place);
    double *xyz = malloc(3 * count * sizeof *xyz);
    uint32_t *faces = malloc(3 * mesh->triangle_count * sizeof *faces);
    need(order && place && xyz && faces);
    assert_int_equal(mote_stream_order(&s.body[0], order), MOTE_OK);
    for (uint32_t v = 0; v < count; ++v) {
        assert_in_range(order[v], 0, count - 1);
        assert_int_equal(place[order[v]], 0);
        place[order[v]] = v + 1;
        memcpy(xyz + 3 * v, &mesh->positions[order[v]], 3 * sizeof *xyz);
    }
    for (uint32_t t = 0; t < mesh->triangle_count; ++t) {
        for (uint32_t k = 0; k < 3; ++k)
            faces[3 * t + k] = place[mesh->triangles[t][k]] - 1;
    }
    mote_mesh *ordered = NULL;
    assert_int_equal(mote_mesh_create(xyz, count, faces, mesh->triangle_count, &ordered),
                     MOTE_OK);
    const mote_body shapes[2] = {{.mesh = ordered}, {.mesh = s.mesh[1]}};
    const mote_body *const bodies[2] = {&shapes[0], &shapes[1]};
    const mote_stream_options options = mote_default_stream_options(s.length);
    mote_stream *there = NULL, *here = stream_of(&s, NULL);
    assert_int_equal(mote_stream_create(bodies, &options, &there), MOTE_OK);
    mote_vec3 *moved = malloc(count * sizeof *moved);
    need(moved);
    for (int k = 0; k < 10; ++k) {
        scene_next(&s, 1.4, false);
        mote_stream_frame frame = positions_of(&s);
        const mote_certificate_answer a = stream_answer(here, &frame, -1);
        for (uint32_t v = 0; v < count; ++v)
            moved[v] = s.world[0][order[v]];
        frame.positions[0] = mote_positions_of(moved);
        const mote_certificate_answer b = stream_answer(there, &frame, -1);
        assert_true(fabs(a.distance - b.distance) <= 1e-13 * s.length);
    }
    free(moved);
    free(order);
    free(place);
    free(xyz);
    free(faces);
    mote_stream_destroy(there);
    mote_stream_destroy(here);
    mote_mesh_destroy(ordered);
    scene_free(&s);
}
