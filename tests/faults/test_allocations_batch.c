/* What is made from plain arrays (core/batch) when memory or threads run out: a status with a
   text, nothing leaked (under AddressSanitizer), and afterwards the same answers as if nothing
   had failed. */
#include "core/batch/batch.h"
#include "core/batch/crowd.h"
#include "core/batch/stream_batch.h"
#include "tests/faults/failing_threads.h"
#include "tests/support/bodies.h"
#include "tests/support/crowd.h"

enum { FRAMES = 6, STRETCH = 2, THREADS = 3, BONES = 2, NUMBERS = 12 * BONES };

/* Two bodies in some frames, as both kinds of batches take them. */
typedef struct work {
    test_body body[2];
    const mote_mesh *mesh[2];
    const mote_field *field[2];
    double pose[FRAMES][3][4], numbers[2][FRAMES][NUMBERS];
    mote_controls controls[2];
    mote_batch_positions positions[2];
    mote_batch_options options;
    double distance[FRAMES]; /* when nothing fails */
} work;

static work w;

/* A skin, and a body whose field is left out where `still`, beside it. */
static void work_init(bool still)
{
    uint64_t seed = 3;
    memset(&w, 0, sizeof w);
    skin_body_init(&w.body[0], solid_to_mesh(solid_icosphere(1)), BONES, 0, &seed);
    test_body_init(&w.body[1], solid_to_mesh(solid_torus(4, 5)), still ? 0 : 2, &seed);
    w.options = mote_default_batch_options();
    for (int f = 0; f < FRAMES; ++f) {
        for (int r = 0; r < 3; ++r)
            w.pose[f][r][r] = 1;
        w.pose[f][0][3] = 4 + 0.1 * f;
        for (int i = 0; i < NUMBERS; ++i) {
            w.numbers[0][f][i] = (i % 12 % 5 == 0) + 0.01 * sin(i + f);
            w.numbers[1][f][i] = 0.1 * cos(i + f);
        }
    }
    for (int b = 0; b < 2; ++b) {
        w.mesh[b] = w.body[b].mesh;
        w.field[b] = b && still ? NULL : w.body[b].field;
        w.controls[b] = (mote_controls){.pose = b ? w.pose[0][0] : NULL,
                                        .weights = w.field[b] ? w.numbers[b][0] : NULL,
                                        .pose_step = 12,
                                        .weights_step = NUMBERS,
                                        .pose_rows = 3};
        w.positions[b] =
            (mote_batch_positions){.data = w.mesh[b]->positions, .stride = sizeof(mote_vec3)};
        w.options.sample_count[b] = 2;
        w.options.samples[b] = w.controls[b];
    }
}

static void work_free(void)
{
    for (int b = 0; b < 2; ++b)
        test_body_free(&w.body[b]);
}

/* How a kind of batch is made and asked. */
typedef struct kind {
    mote_status (*create)(void **batch);
    void (*destroy)(void *batch);
    mote_status (*query)(void *batch, const mote_batch_run *run);
} kind;

static mote_status create_batch(void **batch)
{
    mote_batch *made = NULL;
    const mote_status status = mote_batch_create(w.mesh, w.field, &w.options, &made);
    *batch = made;
    return status;
}

static void destroy_batch(void *batch)
{
    mote_batch_destroy(batch);
}

static mote_status query_batch(void *batch, const mote_batch_run *run)
{
    return mote_batch_query(batch, w.controls, run);
}

static mote_status create_stream_batch(void **batch)
{
    mote_stream_batch *made = NULL;
    const mote_status status = mote_stream_batch_create(w.mesh, &w.options, &made);
    *batch = made;
    return status;
}

static void destroy_stream_batch(void *batch)
{
    mote_stream_batch_destroy(batch);
}

static mote_status query_stream_batch(void *batch, const mote_batch_run *run)
{
    return mote_stream_batch_query(batch, w.positions, run);
}

static const kind controlled = {create_batch, destroy_batch, query_batch};
static const kind streamed = {create_stream_batch, destroy_stream_batch, query_stream_batch};

static mote_status ask(const kind *k, void *batch, double distance[FRAMES])
{
    const mote_batch_run run = {.frames = FRAMES,
                                .stretch = STRETCH,
                                .threads = THREADS,
                                .tolerance = -1,
                                .distance = distance};
    return k->query(batch, &run);
}

/* Makes a batch, asks it, and compares with what it says when nothing fails. */
static mote_status make_and_ask(void *context)
{
    const kind *k = context;
    double distance[FRAMES];
    void *batch = NULL;
    mote_status status = k->create(&batch);
    if (status != MOTE_OK)
        assert_null(batch);
    else if ((status = ask(k, batch, distance)) == MOTE_OK)
        assert_memory_equal(distance, w.distance, sizeof distance);
    k->destroy(batch);
    return status;
}

static mote_status ask_again(const kind *k, void *batch)
{
    double distance[FRAMES];
    const mote_status status = ask(k, batch, distance);
    if (status == MOTE_OK)
        assert_memory_equal(distance, w.distance, sizeof distance);
    return status;
}

/* A batch that had no memory, or no threads, for a query answers the next one. */
static void fail_queries(const kind *k)
{
    static const char *const said[THREADS] = {"only 1 of 3 threads could be started",
                                              "only 2 of 3 threads could be started"};
    void *batch = NULL;
    assert_int_equal(k->create(&batch), MOTE_OK);
    long failures = 0;
    for (bool failed = true; failed; ++failures) {
        allocations_left = failures;
        const mote_status status = ask_again(k, batch);
        failed = allocations_left < 0;
        allocations_left = never;
        assert_int_equal(status, failed ? MOTE_ENOMEM : MOTE_OK);
    }
    assert_true(failures > 3);
    for (int started = 0; said[started]; ++started) {
        threads_left = started;
        assert_int_equal(ask_again(k, batch), MOTE_ENOMEM);
        assert_string_equal(mote_error_text(), said[started]);
        assert_int_equal(threads_left, never);
    }
    assert_int_equal(ask_again(k, batch), MOTE_OK);
    k->destroy(batch);
}

static void fail_kind(const kind *k, const char *what)
{
    void *batch = NULL;
    assert_int_equal(k->create(&batch), MOTE_OK);
    assert_int_equal(ask(k, batch, w.distance), MOTE_OK);
    k->destroy(batch);
    for (int f = 0; f < FRAMES; ++f)
        assert_true(w.distance[f] > 0.1 && w.distance[f] < 6);
    kind context = *k;
    fail_each_allocation(make_and_ask, &context, what);
    fail_queries(k);
}

TEST(batch_when_an_allocation_fails_says_so)
{
    for (int still = 0; still < 2; ++still) {
        work_init(still == 1);
        fail_kind(&controlled, "batch");
        work_free();
    }
}

TEST(stream_batch_when_an_allocation_fails_says_so)
{
    work_init(true);
    /* Body 1 where the first frame's pose has it. */
    mote_vec3 moved[32];
    assert_true(w.mesh[1]->vertex_count <= ROWS_OF(moved));
    for (uint32_t v = 0; v < w.mesh[1]->vertex_count; ++v)
        moved[v] = mote_add(w.mesh[1]->positions[v], mote_vec3_make(4, 0, 0));
    w.positions[1].data = moved;
    fail_kind(&streamed, "batch of positions");
    work_free();
}

/* --- scenes of many bodies ------------------------------------------------------------------
 */

enum { BODIES = 12, PAIRS = BODIES * (BODIES - 1) / 2 };

static crowd many;
static double distances[PAIRS]; /* of all pairs, when nothing fails */

static mote_status create_crowd(mote_crowd **made)
{
    const mote_mesh *meshes[CROWD_SHAPES];
    const mote_field *fields[CROWD_SHAPES];
    for (int k = 0; k < CROWD_SHAPES; ++k) {
        meshes[k] = many.shape[k]->mesh;
        fields[k] = k == 0 ? NULL : many.shape[k]->field;
    }
    const mote_crowd_options options = {.threads = 2};
    return mote_crowd_create(meshes, fields, CROWD_SHAPES, many.shape_of, many.count, &options,
                             made);
}

/* All bodies at rest, each a little farther along the diagonal of space. */
static mote_status step_crowd(mote_crowd *made, double distance[PAIRS])
{
    static double pose[BODIES][3][4];
    mote_controls controls[BODIES];
    for (int i = 0; i < BODIES; ++i) {
        for (int r = 0; r < 3; ++r) {
            pose[i][r][r] = 1;
            pose[i][r][3] = i;
        }
        controls[i] = (mote_controls){.pose = pose[i][0], .pose_rows = 3};
    }
    size_t count = 0;
    const mote_status status = mote_crowd_step(made, controls, 100, &count);
    assert_int_equal(count, status == MOTE_OK ? PAIRS : 0);
    if (status == MOTE_OK)
        mote_crowd_pairs(made, NULL, distance, NULL, NULL, NULL);
    return status;
}

static mote_status step_again(mote_crowd *made)
{
    double distance[PAIRS];
    const mote_status status = step_crowd(made, distance);
    for (int k = 0; status == MOTE_OK && k < PAIRS; ++k)
        assert_true(fabs(distance[k] - distances[k]) <= 1e-12);
    return status;
}

static mote_status make_crowd(void *context)
{
    (void)context;
    mote_crowd *made = NULL;
    mote_status status = create_crowd(&made);
    if (status == MOTE_OK)
        status = step_again(made);
    else
        assert_null(made);
    mote_crowd_destroy(made);
    return status;
}

TEST(crowd_when_an_allocation_fails_says_so)
{
    crowd_init(&many, BODIES, 400, 1);
    mote_crowd *made = NULL;
    assert_int_equal(create_crowd(&made), MOTE_OK);
    assert_int_equal(step_crowd(made, distances), MOTE_OK);
    mote_crowd_destroy(made);
    fail_each_allocation(make_crowd, NULL, "crowd");
    /* A scene that had no memory for a step takes the next one. */
    assert_int_equal(create_crowd(&made), MOTE_OK);
    long failures = 0;
    for (bool failed = true; failed; ++failures) {
        allocations_left = failures;
        const mote_status status = step_again(made);
        failed = allocations_left < 0;
        allocations_left = never;
        if (status != MOTE_OK)
            assert_int_equal(status, MOTE_ENOMEM);
        assert_true(failed || status == MOTE_OK);
    }
    assert_true(failures > 3);
    assert_int_equal(step_again(made), MOTE_OK);
    mote_crowd_destroy(made);
    crowd_free(&many);
}
