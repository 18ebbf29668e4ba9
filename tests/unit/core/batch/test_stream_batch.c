/* Batches of positions: against single streamed queries bit for bit. */
#include "core/batch/stream_batch.h"
#include "core/stream/stream.h"

#include "tests/support/solids.h"
#include "tests/support/test.h"

enum { FRAMES = 40, VERTICES = 162 };

typedef struct two {
    mote_mesh *mesh[2];
    double world[2][FRAMES][VERTICES][3];
    float single[2][FRAMES][VERTICES][5]; /* with something beside each vertex */
    double distance[FRAMES], lower[FRAMES], witness[FRAMES][2][3];
    int8_t contact[FRAMES];
} two;

static two t;

static void two_init(uint64_t seed)
{
    for (int b = 0; b < 2; ++b) {
        t.mesh[b] = solid_to_mesh(solid_icosphere(2));
        assert_int_equal(t.mesh[b]->vertex_count, VERTICES);
        for (int f = 0; f < FRAMES; ++f) {
            for (uint32_t v = 0; v < VERTICES; ++v) {
                const mote_vec3 x = t.mesh[b]->positions[v];
                double *to = t.world[b][f][v];
                to[0] = x.x * (1 + 0.2 * sin(0.1 * f)) + b * (2.6 - 0.02 * f);
                to[1] = x.y + random_between(&seed, 0, 0.01);
                to[2] = x.z + 0.1 * b;
                for (int k = 0; k < 3; ++k)
                    t.single[b][f][v][k] = (float)to[k];
            }
        }
    }
}

static void two_free(void)
{
    for (int b = 0; b < 2; ++b)
        mote_mesh_destroy(t.mesh[b]);
}

static mote_stream_batch *batch_of(void)
{
    const mote_batch_options options = mote_default_batch_options();
    mote_stream_batch *batch = NULL;
    if (mote_stream_batch_create((const mote_mesh *const[2]){t.mesh[0], t.mesh[1]}, &options,
                                 &batch) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    return batch;
}

static mote_status run_batch(mote_stream_batch *batch, const mote_batch_positions positions[2],
                             size_t stretch, size_t threads)
{
    const mote_batch_run run = {.frames = FRAMES,
                                .stretch = stretch,
                                .threads = threads,
                                .tolerance = -1,
                                .distance = t.distance,
                                .lower = t.lower,
                                .witness = t.witness[0][0],
                                .contact = t.contact};
    return mote_stream_batch_query(batch, positions, &run);
}

static void doubles(mote_batch_positions positions[2])
{
    for (int b = 0; b < 2; ++b)
        positions[b] = (mote_batch_positions){t.world[b], sizeof t.world[b][0][0], 0,
                                              sizeof t.world[b][0]};
}

/* Each as one query at a time gives it; body 1 stays as in frame 0 where `still`. */
static void expect_single_queries(bool still)
{
    const mote_body body[2] = {{.mesh = t.mesh[0]}, {.mesh = t.mesh[1]}};
    const mote_stream_options options =
        mote_default_stream_options(fmax(t.mesh[0]->diagonal, t.mesh[1]->diagonal));
    mote_stream *stream;
    assert_int_equal(
        mote_stream_create((const mote_body *const[2]){&body[0], &body[1]}, &options, &stream),
        MOTE_OK);
    for (int f = 0; f < FRAMES; ++f) {
        mote_stream_frame frame = {.unchanged = {false, still && f > 0}};
        for (int b = 0; b < 2; ++b)
            frame.positions[b] = (mote_positions){t.world[b][b && still ? 0 : f],
                                                  sizeof t.world[b][0][0], false};
        mote_certificate_answer answer;
        assert_int_equal(mote_stream_query(stream, &frame, -1, &answer), MOTE_OK);
        assert_memory_equal(&answer.distance, &t.distance[f], sizeof(double));
        assert_memory_equal(&answer.lower, &t.lower[f], sizeof(double));
        assert_memory_equal(answer.witness, t.witness[f], sizeof t.witness[f]);
        assert_int_equal(t.contact[f], !(answer.distance > 0));
    }
    mote_stream_destroy(stream);
}

TEST(one_stretch_is_single_queries_one_after_the_other)
{
    two_init(1);
    mote_batch_positions positions[2];
    doubles(positions);
    mote_stream_batch *batch = batch_of();
    assert_int_equal(run_batch(batch, positions, 0, 1), MOTE_OK);
    expect_single_queries(false);
    mote_stream_batch_destroy(batch);
    positions[1].frame_step = 0; /* never moves */
    batch = batch_of();
    assert_int_equal(run_batch(batch, positions, 0, 4), MOTE_OK);
    expect_single_queries(true);
    mote_stream_batch_destroy(batch);
    two_free();
}

TEST(answers_are_the_same_bits_for_any_number_of_threads)
{
    two_init(2);
    mote_batch_positions positions[2];
    doubles(positions);
    mote_stream_batch *batch = batch_of();
    for (int still = 0; still < 2; ++still) {
        positions[1].frame_step = still ? 0 : sizeof t.world[1][0];
        assert_int_equal(run_batch(batch, positions, 7, 1), MOTE_OK);
        static two expected;
        expected = t;
        for (size_t threads = 1; threads <= 4; ++threads) {
            assert_int_equal(run_batch(batch, positions, 0, 1), MOTE_OK);
            assert_int_equal(run_batch(batch, positions, 7, threads), MOTE_OK);
            assert_memory_equal(t.distance, expected.distance, sizeof t.distance);
            assert_memory_equal(t.lower, expected.lower, sizeof t.lower);
            assert_memory_equal(t.witness, expected.witness, sizeof t.witness);
        }
    }
    assert_true(mote_stream_batch_bytes(batch) > 10000);
    mote_mesh_destroy(t.mesh[0]);
    mote_mesh_destroy(t.mesh[1]);
    mote_stream_batch_destroy(batch); /* may look at no mesh */
    mote_stream_batch_destroy(NULL);
}

TEST(floats_in_larger_records_are_near_doubles)
{
    two_init(3);
    mote_batch_positions positions[2];
    doubles(positions);
    mote_stream_batch *batch = batch_of();
    assert_int_equal(run_batch(batch, positions, 8, 2), MOTE_OK);
    static two expected;
    expected = t;
    for (int b = 0; b < 2; ++b)
        positions[b] = (mote_batch_positions){t.single[b], sizeof t.single[b][0][0], 1,
                                              sizeof t.single[b][0]};
    assert_int_equal(run_batch(batch, positions, 8, 2), MOTE_OK);
    for (int f = 0; f < FRAMES; ++f)
        assert_true(fabs(t.distance[f] - expected.distance[f]) < 1e-6);
    mote_stream_batch_destroy(batch);
    two_free();
}

TEST(bad_input_is_named)
{
    two_init(4);
    mote_batch_positions positions[2];
    doubles(positions);
    mote_stream_batch *batch = batch_of();
    t.world[1][23][9][1] = (double)NAN;
    t.world[1][30][9][1] = (double)INFINITY;
    for (size_t threads = 1; threads < 4; ++threads) {
        assert_int_equal(run_batch(batch, positions, threads > 1 ? 5 : 0, threads),
                         MOTE_EINVAL);
        assert_non_null(strstr(mote_error_text(), "frame 23, body 1"));
    }
    assert_int_equal(run_batch(batch, positions, 1, 0), MOTE_EINVAL);
    positions[0].stride = 8;
    assert_int_equal(run_batch(batch, positions, 1, 1), MOTE_EINVAL);
    assert_non_null(strstr(mote_error_text(), "frame 0, body 0"));
    mote_stream_batch_destroy(batch);
    static const double slacks[3] = {HUGE_VAL, -1, NAN};
    for (size_t k = 0; k < ROWS_OF(slacks); ++k) {
        mote_batch_options options = mote_default_batch_options();
        options.slack = slacks[k];
        assert_int_equal(
            mote_stream_batch_create((const mote_mesh *const[2]){t.mesh[0], t.mesh[1]},
                                     &options, &batch),
            MOTE_EINVAL);
        assert_non_null(strstr(mote_error_text(), "it must be finite and not negative"));
    }
    two_free();
}
