#include "harness/run/measure.h"

#include "core/body/deform.h"
#include "harness/base/memory.h"
#include "harness/base/statistics.h"
#include "harness/run/measure_scene.h"

#include <stdlib.h>
#include <sys/resource.h>

#define EVICT_BYTES ((size_t)32 << 20)
#define CACHE_LINE 64

/* How many empty calls the overhead is measured with: the median of batches. */
#define BATCHES 21
#define BATCH 100

/* What a cell holds while it runs. */
struct mote_measurement {
    const mote_cell *cell;
    mote_scene_session *scene; /* of more than two bodies; what follows is then not used but
                                  evict and clock_ns */
    mote_traits traits;
    void *state; /* the method's */
    mote_frame_buffer *buffer;
    mote_deform *deform[2];
    mote_vec3 *vertices[2];
    volatile unsigned char *evict; /* NULL when caches stay hot */
    uint64_t clock_ns;
};

typedef mote_measurement session;

static mote_status make_vertices(session *s)
{
    for (int side = 0; side < 2; ++side) {
        const mote_body *body = &s->cell->subject->scenario->body[side];
        s->vertices[side] = mote_allocate(body->mesh->vertex_count, sizeof(mote_vec3));
        mote_status status = mote_deform_create(body, &s->deform[side]);
        if (status != MOTE_OK)
            return status;
    }
    return MOTE_OK;
}

static int64_t vertices_bytes(const session *s)
{
    size_t bytes = 0;
    for (int side = 0; side < 2; ++side)
        bytes += mote_deform_bytes(s->deform[side]) +
                 s->cell->subject->scenario->body[side].mesh->vertex_count * sizeof(mote_vec3);
    return (int64_t)bytes;
}

/* Keys of scenes have no effect on two bodies, so a result must not list them. */
static mote_status check_keys(const mote_cell *cell)
{
    if (!mote_method_choice_is_of_scenes(cell->choice))
        return MOTE_OK;
    return mote_fail(
        MOTE_EINVAL,
        "%s: refit, threads and ahead are keys for more than two bodies; leave them "
        "out",
        cell->choice->text);
}

static mote_status build_scene(session *s, mote_cell_result *result)
{
    const uint64_t start = mote_clock_ns();
    mote_status status = mote_scene_session_create(s->cell, &s->scene);
    result->build_ns = mote_clock_ns() - start;
    return status;
}

/* Builds everything that the method needs, timed, with its bytes counted. */
static mote_status build_pair(session *s, mote_cell_result *result)
{
    const mote_cell *cell = s->cell;
    const mote_scenario *scenario = cell->subject->scenario;
    mote_setup setup = {.body = {&scenario->body[0], &scenario->body[1]},
                        .length = scenario->length,
                        .ask = scenario->ask,
                        .tolerance = scenario->tolerance,
                        .seed =
                            mote_replicate_seed(cell->seed, cell->fixed_seed, cell->replicate),
                        .values = cell->choice->values};
    uint64_t start = mote_clock_ns();
    if (s->traits.needs_vertices && !s->traits.given_vertices) {
        mote_status status = make_vertices(s);
        if (status != MOTE_OK)
            return status;
        result->deform_bytes = vertices_bytes(s);
    }
    mote_status status = mote_method_create(cell->choice->method, &setup, &s->state);
    result->build_ns = mote_clock_ns() - start;
    return status;
}

/* Drives what a method uses out of the caches. */
static void walk(void *context)
{
    volatile unsigned char *bytes = context;
    for (size_t i = 0; i < EVICT_BYTES; i += CACHE_LINE)
        bytes[i] = (unsigned char)(bytes[i] + 1);
}

static void deform(const session *s, mote_frame *frame)
{
    for (int side = 0; side < 2; ++side) {
        mote_body_state *body = &frame->body[side];
        if (body->shape_changed || body->pose_changed)
            mote_deform_all(s->deform[side], body, s->vertices[side]);
        body->vertices = s->vertices[side];
    }
}

static uint64_t elapsed(const session *s, uint64_t start, uint64_t end)
{
    uint64_t ns = end - start;
    return ns > s->clock_ns ? ns - s->clock_ns : 0;
}

/* The timed calls: functions of their own, so that callgrind can count in them alone
   (harness/run/instructions.c). */
__attribute__((noinline)) static void timed_deform(const session *s, mote_frame *frame)
{
    deform(s, frame);
}

__attribute__((noinline)) static mote_status timed_update(const session *s,
                                                          const mote_frame *frame)
{
    return s->cell->choice->method->update(s->state, frame);
}

__attribute__((noinline)) static mote_status
timed_query(const session *s, const mote_frame *frame, mote_answer *answer)
{
    return s->cell->choice->method->query(s->state, frame, answer);
}

static mote_status answer_nothing(void *state, const mote_frame *frame, mote_answer *answer)
{
    (void)state;
    (void)frame;
    (void)answer;
    return MOTE_OK;
}

/* The overhead of clock and bookkeeping that remains in a timed call after the clock's cost is
   subtracted, measured with a method that does nothing. May be below 0. */
static double overhead(uint64_t clock_ns)
{
    const mote_method nothing = {.query = answer_nothing};
    const mote_method_choice choice = {.method = &nothing};
    const mote_cell cell = {.choice = &choice};
    const session s = {.cell = &cell};
    const mote_frame frame = {0};
    double batches[BATCHES];
    for (size_t i = 0; i < BATCHES; ++i) {
        uint64_t sum = 0;
        for (size_t k = 0; k < BATCH; ++k) {
            mote_answer answer;
            uint64_t start = mote_clock_ns();
            (void)timed_query(&s, &frame, &answer);
            sum += mote_clock_ns() - start;
        }
        batches[i] = (double)sum / BATCH - (double)clock_ns;
    }
    return mote_statistics_median(batches, BATCHES);
}

/* Everything that is charged to no method. */
static mote_status prepare(session *s, mote_cell_result *result, size_t rows)
{
    const mote_cell *cell = s->cell;
    s->traits = mote_method_traits(cell->choice->method, cell->choice->values);
    result->rows = mote_allocate(rows, sizeof *result->rows);
    if (cell->cache == MOTE_CACHE_EVICT)
        s->evict = mote_allocate(EVICT_BYTES, 1);
    mote_status status = MOTE_OK;
    if (!cell->subject->bodies)
        s->buffer = mote_frame_buffer_create(cell->subject->scenario);
    if (!cell->subject->bodies && s->traits.given_vertices)
        status = make_vertices(s);
    s->clock_ns = mote_clock_cost_ns();
    result->clock_ns = s->clock_ns;
    result->overhead_ns = overhead(s->clock_ns);
    return status;
}

static mote_status run_frame(session *s, uint32_t number, uint32_t previous, mote_cell_row *row)
{
    const mote_method *method = s->cell->choice->method;
    mote_frame frame =
        *mote_scenario_frame(s->cell->subject->scenario, s->buffer, number, previous);
    mote_status status = MOTE_OK;
    row->frame = number;
    if (s->traits.given_vertices)
        deform(s, &frame);
    if (s->evict)
        walk((void *)(uintptr_t)s->evict);
    if (s->traits.needs_vertices && !s->traits.given_vertices) {
        uint64_t start = mote_clock_ns();
        timed_deform(s, &frame);
        row->deform_ns = elapsed(s, start, mote_clock_ns());
    }
    uint64_t allocations = mote_heap_read().allocations;
    if (method->update) {
        uint64_t start = mote_clock_ns();
        status = timed_update(s, &frame);
        row->update_ns = elapsed(s, start, mote_clock_ns());
    }
    if (status == MOTE_OK) {
        uint64_t start = mote_clock_ns();
        status = timed_query(s, &frame, &row->answer);
        row->query_ns = elapsed(s, start, mote_clock_ns());
    }
    row->allocations = mote_heap_read().allocations - allocations;
    if (!row->answer.has_contact && row->answer.has_distance) {
        row->answer.has_contact = true;
        row->answer.contact = row->answer.distance <= s->cell->subject->scenario->tolerance;
    }
    return status;
}

static mote_status run_frames(session *s, size_t rows, mote_cell_result *result)
{
    uint32_t previous = 0;
    for (size_t i = 0; i < rows; ++i) {
        uint32_t number = s->cell->first + (uint32_t)i * s->cell->stride;
        mote_status status = run_frame(s, number, previous, &result->rows[i]);
        if (status != MOTE_OK) {
            char text[512];
            (void)snprintf(text, sizeof text, "%s", mote_error_text());
            return mote_fail(status, "frame %u: %s", number, text);
        }
        previous = number;
        result->row_count = i + 1;
    }
    return MOTE_OK;
}

static void close_session(session *s)
{
    mote_scene_session_destroy(s->scene);
    mote_method_destroy(s->cell->choice->method, s->state);
    for (int side = 0; side < 2; ++side) {
        mote_deform_destroy(s->deform[side]);
        free(s->vertices[side]);
    }
    mote_frame_buffer_destroy(s->buffer);
    free((void *)(uintptr_t)s->evict);
}

static mote_status run(session *s, size_t rows, const mote_cell_pairs *pairs,
                       mote_cell_result *result)
{
    if (!s->scene)
        return run_frames(s, rows, result);
    return mote_scene_session_run(s->scene, rows, s->evict ? walk : NULL,
                                  (void *)(uintptr_t)s->evict, pairs, result);
}

mote_status mote_measure_cell(const mote_cell *cell, size_t frame_limit,
                              mote_cell_result *result)
{
    return mote_measure_cell_and_pairs(cell, frame_limit, NULL, result);
}

mote_status mote_measure_cell_and_pairs(const mote_cell *cell, size_t frame_limit,
                                        const mote_cell_pairs *pairs, mote_cell_result *result)
{
    session s = {.cell = cell};
    mote_cell_result measured = {.core = -1};
    const bool of_scene = cell->subject->bodies != NULL;
    size_t rows = (cell->last - cell->first) / cell->stride + 1;
    if (frame_limit && rows > frame_limit)
        rows = frame_limit;
    mote_status status = of_scene ? MOTE_OK : check_keys(cell);
    if (status == MOTE_OK)
        status = prepare(&s, &measured, rows);
    mote_heap before = mote_heap_read();
    mote_heap_reset_peak();
    if (status == MOTE_OK)
        status = of_scene ? build_scene(&s, &measured) : build_pair(&s, &measured);
    int64_t built = mote_heap_read().live_bytes;
    if (status == MOTE_OK)
        status = run(&s, rows, pairs, &measured);
    mote_heap after = mote_heap_read();
    int64_t live = built > after.live_bytes ? built : after.live_bytes;
    measured.heap_counted = after.counted;
    measured.heap_live_bytes = live - before.live_bytes;
    measured.heap_peak_bytes = after.peak_bytes - before.live_bytes;
    struct rusage usage;
    if (getrusage(RUSAGE_SELF, &usage) == 0)
        measured.rss_peak_bytes = (int64_t)usage.ru_maxrss * 1024;
    close_session(&s);
    if (status == MOTE_OK)
        *result = measured;
    else
        mote_cell_result_free(&measured);
    return status;
}

mote_status mote_measurement_open(const mote_cell *cell, mote_measurement **measurement)
{
    mote_measurement *made = mote_allocate(1, sizeof *made);
    mote_cell_result unused = {.core = -1};
    made->cell = cell;
    mote_status status = check_keys(cell);
    if (status == MOTE_OK)
        status = prepare(made, &unused, 0);
    if (status == MOTE_OK)
        status = build_pair(made, &unused);
    mote_cell_result_free(&unused);
    if (status == MOTE_OK)
        *measurement = made;
    else
        mote_measurement_close(made);
    return status;
}

mote_status mote_measurement_frame(mote_measurement *measurement, uint32_t number,
                                   uint32_t previous, mote_cell_row *row)
{
    *row = (mote_cell_row){0};
    return run_frame(measurement, number, previous, row);
}

void mote_measurement_close(mote_measurement *measurement)
{
    if (measurement)
        close_session(measurement);
    free(measurement);
}

void mote_cell_result_free(mote_cell_result *result)
{
    free(result->rows);
    result->rows = NULL;
    result->row_count = 0;
}
