#include "harness/run/measure.h"

#include "core/base/frame_queue.h"
#include "harness/base/clock.h"
#include "harness/base/memory.h"
#include "harness/run/memory_pass.h"
#include "harness/scene/sample_poses.h"

#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>

/* The most frames by which the motion thread may run ahead of the queries. */
#define AHEAD_MAX 64

/* The state of a running cell. */
struct mote_measurement {
    const mote_cell *cell;
    mote_engine *engine;
    mote_sample_poses *samples;           /* NULL: the method does not build with samples */
    mote_body body[2];                    /* two bodies: the scenario's, with samples */
    uint32_t ahead;                       /* 0: motion and queries alternate in one thread */
    mote_subject_frame frames[AHEAD_MAX]; /* [ahead], at least 1 */
    uint64_t motion_ns[AHEAD_MAX];        /* of each frame in the queue */
    mote_frame_queue *queue;
    mote_status moved; /* result of the motion thread */
    char moved_text[512];
    volatile unsigned char *evict; /* NULL: caches stay hot */
    size_t rows;                   /* number to measure */
    uint64_t began;                /* when the first frame began */
    const mote_cell_pairs *pairs;  /* or NULL */
    mote_cell_result *result;
};

typedef mote_measurement session;

/* Gives two bodies sample poses if the method builds with them. */
static mote_status add_samples(session *s, mote_engine_setup *setup)
{
    const mote_method_choice *choice = s->cell->choice;
    const mote_scenario *scenario = s->cell->subject->scenario;
    if (!scenario || !mote_method_traits(choice->method, choice->values).samples)
        return MOTE_OK;
    const mote_status status = mote_sample_poses_create(scenario, &s->samples);
    if (status != MOTE_OK)
        return status;
    mote_sample_poses_bodies(s->samples, scenario, s->body);
    setup->shapes[0] = &s->body[0];
    setup->shapes[1] = &s->body[1];
    return MOTE_OK;
}

/* Prepares everything that is charged to no method. */
static mote_status prepare(session *s)
{
    const mote_cell *cell = s->cell;
    mote_cell_result *result = s->result;
    mote_engine_setup setup = mote_subject_engine(cell->subject);
    setup.step = cell->step;
    setup.seed = mote_replicate_seed(cell->seed, cell->fixed_seed, cell->replicate);
    setup.clock_ns = mote_clock_cost_ns();
    s->ahead = (uint32_t)cell->choice->scene[MOTE_SCENE_AHEAD];
    mote_status status = add_samples(s, &setup);
    if (status == MOTE_OK)
        status = mote_engine_create(&setup, cell->choice, &s->engine);
    if (status != MOTE_OK)
        return status;
    result->rows = mote_allocate(s->rows, sizeof *result->rows);
    result->clock_ns = setup.clock_ns;
    result->overhead_ns = mote_engine_overhead_ns(setup.clock_ns);
    if (cell->cache == MOTE_CACHE_EVICT)
        s->evict = mote_evict_create();
    for (uint32_t i = 0; i < (s->ahead ? s->ahead : 1); ++i)
        s->frames[i] = mote_subject_frame_create(cell->subject, cell->step);
    return MOTE_OK;
}

/* Builds everything that the method needs; time and bytes are measured. */
static mote_status build(session *s)
{
    const uint64_t start = mote_clock_ns();
    const mote_status status = mote_engine_build(s->engine);
    s->result->build_ns = mote_clock_ns() - start;
    if (status == MOTE_OK)
        s->result->deform_bytes = mote_engine_deform_bytes(s->engine);
    return status;
}

/* The frame of a row (from 0). */
static uint32_t number_of(const session *s, size_t row)
{
    return s->cell->first + (uint32_t)row * s->cell->stride;
}

/* The frame's answer is that of the closest near pair; if there is none, `near` is a lower
   bound, since all pairs are farther apart. */
static mote_answer closest_answer(const mote_bodies *bodies, const mote_engine_cost *cost,
                                  const mote_near_pair *pairs, size_t count)
{
    mote_answer all = {.has_contact = true, .contact = cost->contacts > 0};
    const mote_near_pair *closest = NULL;
    all.has_lower = bodies->ask == MOTE_ASK_DISTANCE;
    all.lower = bodies->near;
    for (size_t k = 0; k < count; ++k) {
        const mote_answer *a = &pairs[k].answer;
        all.has_lower = all.has_lower && a->has_lower;
        all.lower = fmin(all.lower, a->lower);
        if (a->has_distance && (!closest || a->distance < closest->answer.distance))
            closest = &pairs[k];
    }
    if (closest && closest->answer.distance <= bodies->near) {
        all.has_distance = true;
        all.distance = closest->answer.distance;
        all.has_witness = closest->answer.has_witness;
        all.witness[0] = closest->answer.witness[0];
        all.witness[1] = closest->answer.witness[1];
    }
    all.counters = cost->counters;
    return all;
}

static void record(const session *s, uint32_t number, uint64_t motion_ns,
                   const mote_engine_cost *cost, mote_cell_row *row)
{
    const mote_bodies *bodies = s->cell->subject->bodies;
    size_t count;
    const mote_near_pair *pairs = mote_engine_pairs(s->engine, &count);
    *row = (mote_cell_row){.frame = number,
                           .deform_ns = cost->deform_ns,
                           .update_ns = cost->update_ns,
                           .query_ns = cost->query_ns,
                           .allocations = cost->allocations,
                           .answer = bodies ? closest_answer(bodies, cost, pairs, count)
                                            : pairs[0].answer,
                           .scene = {.motion_ns = motion_ns,
                                     .bounds_ns = cost->bounds_ns,
                                     .broad_ns = cost->broad_ns,
                                     .near_pairs = cost->pairs,
                                     .new_pairs = cost->fresh,
                                     .pair_contacts = cost->contacts},
                           .impact = *mote_engine_impact(s->engine)};
    if (s->pairs)
        mote_cell_pairs_add(s->pairs, number, pairs, count);
}

static void show_paths(const session *s, const mote_subject_frame *frame)
{
    const mote_path *const paths[] = {mote_scenario_path_of(frame->path, 0),
                                      mote_scenario_path_of(frame->path, 1)};
    mote_engine_show_paths(s->engine, paths);
}

/* Asks about a frame. */
static mote_status ask(session *s, uint32_t number, const mote_subject_frame *frame,
                       uint64_t motion_ns, mote_cell_row *row)
{
    mote_engine_cost cost;
    if (frame->path)
        show_paths(s, frame);
    else
        mote_engine_show(s->engine, frame->states);
    if (s->evict)
        mote_evict(s->evict);
    const mote_status status = mote_engine_ask(s->engine, &cost);
    if (status != MOTE_OK) {
        char text[512];
        (void)snprintf(text, sizeof text, "%s", mote_error_text());
        return mote_fail(status, "frame %u: %s", number, text);
    }
    record(s, number, motion_ns, &cost, row);
    return MOTE_OK;
}

/* Asks about the frame of the next row. */
static mote_status ask_next(session *s, const mote_subject_frame *frame, uint64_t motion_ns)
{
    mote_cell_result *result = s->result;
    const size_t row = result->row_count;
    const mote_status status = ask(s, number_of(s, row), frame, motion_ns, &result->rows[row]);
    result->row_count += status == MOTE_OK;
    return status;
}

static bool is_over(const session *s)
{
    const double spent = (double)(mote_clock_ns() - s->began) * 1e-9;
    return s->result->row_count == s->rows ||
           (s->cell->subject->bodies && s->cell->budget > 0 && spent > s->cell->budget &&
            s->result->row_count >= MOTE_CELL_LEAST_FRAMES);
}

/* Moves the bodies to the frame of a row and measures the time. */
static mote_status move(const session *s, size_t row, mote_subject_frame *frame, uint64_t *ns)
{
    const uint64_t from = mote_clock_ns();
    const mote_status status = mote_subject_frame_set(
        s->cell->subject, number_of(s, row), row > 0 ? number_of(s, row - 1) : 0, frame);
    *ns = mote_clock_ns() - from;
    return status;
}

static mote_status run_in_turn(session *s)
{
    mote_status status = MOTE_OK;
    while (status == MOTE_OK && !is_over(s)) {
        uint64_t motion_ns = 0;
        status = move(s, s->result->row_count, &s->frames[0], &motion_ns);
        if (status == MOTE_OK)
            status = ask_next(s, &s->frames[0], motion_ns);
    }
    return status;
}

static void *move_ahead(void *context)
{
    session *s = context;
    size_t place;
    for (size_t row = 0; row < s->rows && mote_frame_queue_reserve(s->queue, &place); ++row) {
        s->moved = move(s, row, &s->frames[place], &s->motion_ns[place]);
        if (s->moved != MOTE_OK) {
            (void)snprintf(s->moved_text, sizeof s->moved_text, "%s", mote_error_text());
            break;
        }
        mote_frame_queue_commit(s->queue);
    }
    mote_frame_queue_close(s->queue);
    return NULL;
}

/* Runs motion and deformation in a separate thread, with a bounded queue of frames. */
static mote_status run_ahead(session *s)
{
    pthread_t mover;
    mote_status status = mote_frame_queue_create(s->ahead, &s->queue);
    if (status != MOTE_OK)
        return status;
    if (pthread_create(&mover, NULL, move_ahead, s) != 0) {
        mote_frame_queue_destroy(s->queue);
        return mote_fail(MOTE_ENOMEM, "a thread for motion cannot be started");
    }
    size_t place;
    while (status == MOTE_OK && !is_over(s) && mote_frame_queue_take(s->queue, &place)) {
        status = ask_next(s, &s->frames[place], s->motion_ns[place]);
        mote_frame_queue_release(s->queue);
    }
    mote_frame_queue_cancel(s->queue);
    (void)pthread_join(mover, NULL);
    mote_frame_queue_destroy(s->queue);
    return status == MOTE_OK && s->moved != MOTE_OK ? mote_fail(s->moved, "%s", s->moved_text)
                                                    : status;
}

static mote_status run(session *s)
{
    s->began = mote_clock_ns();
    const mote_status status = s->ahead > 0 ? run_ahead(s) : run_in_turn(s);
    s->result->frames_wall_ns = mote_clock_ns() - s->began;
    return status;
}

static void close_session(session *s)
{
    mote_engine_destroy(s->engine);
    mote_sample_poses_destroy(s->samples);
    for (uint32_t i = 0; i < AHEAD_MAX; ++i)
        mote_subject_frame_free(&s->frames[i]);
    free((void *)(uintptr_t)s->evict);
}

/* Builds and runs the method, measuring its bytes. */
static mote_status build_and_run(session *s)
{
    mote_cell_result *result = s->result;
    const mote_heap before = mote_heap_read();
    mote_heap_reset_peak();
    mote_status status = build(s);
    const int64_t built = mote_heap_read().live_bytes;
    if (status == MOTE_OK)
        status = run(s);
    const mote_heap after = mote_heap_read();
    const int64_t live = built > after.live_bytes ? built : after.live_bytes;
    result->heap_counted = after.counted;
    result->heap_live_bytes = live - before.live_bytes;
    result->heap_peak_bytes = after.peak_bytes - before.live_bytes;
    struct rusage usage;
    if (getrusage(RUSAGE_SELF, &usage) == 0)
        result->rss_peak_bytes = (int64_t)usage.ru_maxrss * 1024;
    return status;
}

mote_status mote_measure_cell(const mote_cell *cell, size_t frame_limit,
                              mote_cell_result *result)
{
    return mote_measure_cell_and_pairs(cell, frame_limit, NULL, result);
}

mote_status mote_measure_cell_and_pairs(const mote_cell *cell, size_t frame_limit,
                                        const mote_cell_pairs *pairs, mote_cell_result *result)
{
    mote_cell_result measured = {.core = -1};
    session s = {
        .cell = cell, .rows = mote_cell_rows(cell), .pairs = pairs, .result = &measured};
    if (frame_limit && s.rows > frame_limit)
        s.rows = frame_limit;
    mote_status status = prepare(&s);
    if (status == MOTE_OK)
        status = build_and_run(&s);
    if (status == MOTE_OK && mote_cell_told_positions(cell)) {
        const mote_subject_facts facts = mote_subject_facts_of(cell->subject);
        measured.read_ns = mote_read_pass_ns((size_t)facts.vertices_total, s.evict);
    }
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
    made->result = &unused;
    mote_status status = prepare(made);
    if (status == MOTE_OK)
        status = build(made);
    mote_cell_result_free(&unused);
    made->result = NULL;
    if (status == MOTE_OK)
        *measurement = made;
    else
        mote_measurement_close(made);
    return status;
}

mote_status mote_measurement_frame(mote_measurement *measurement, uint32_t number,
                                   uint32_t previous, mote_cell_row *row)
{
    mote_subject_frame *frame = &measurement->frames[0];
    const mote_status status =
        mote_subject_frame_set(measurement->cell->subject, number, previous, frame);
    return status == MOTE_OK ? ask(measurement, number, frame, 0, row) : status;
}

const mote_near_pair *mote_measurement_pairs(const mote_measurement *measurement, size_t *count)
{
    return mote_engine_pairs(measurement->engine, count);
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
