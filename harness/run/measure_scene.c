#include "harness/run/measure_scene.h"

#include "core/base/frame_queue.h"
#include "harness/base/memory.h"
#include "harness/run/clock.h"

#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>

/* How many frames one thread may move ahead of the other that queries. */
#define AHEAD_MAX 64

struct mote_scene_session {
    const mote_cell *cell;
    const mote_bodies *bodies;
    mote_bodies_engine *engine;
    uint32_t ahead;                      /* 0: motion and queries take turns in one thread */
    mote_bodies_frame frames[AHEAD_MAX]; /* [ahead], at least 1 */
    uint64_t motion_ns[AHEAD_MAX];       /* of each frame that is in the queue */
    mote_frame_queue *queue;
    uint32_t last;  /* frame of a run */
    uint64_t began; /* when its first frame began */
    void (*between)(void *context);
    void *context;
    const mote_cell_pairs *pairs;
    mote_cell_result *result;
};

mote_status mote_scene_session_create(const mote_cell *cell, mote_scene_session **session)
{
    mote_scene_session *made = mote_allocate(1, sizeof *made);
    made->cell = cell;
    made->bodies = cell->subject->bodies;
    made->ahead = (uint32_t)cell->choice->scene[MOTE_SCENE_AHEAD];
    const uint64_t seed = mote_replicate_seed(cell->seed, cell->fixed_seed, cell->replicate);
    for (uint32_t i = 0; i < (made->ahead ? made->ahead : 1); ++i)
        made->frames[i] = mote_bodies_frame_create(made->bodies);
    const mote_status status =
        mote_bodies_engine_create(made->bodies, cell->choice, seed, &made->engine);
    if (status == MOTE_OK)
        *session = made;
    else
        mote_scene_session_destroy(made);
    return status;
}

void mote_scene_session_destroy(mote_scene_session *session)
{
    if (!session)
        return;
    mote_bodies_engine_destroy(session->engine);
    for (uint32_t i = 0; i < AHEAD_MAX; ++i)
        mote_bodies_frame_free(&session->frames[i]);
    free(session);
}

/* Gives the frame the answer of the closest near pair; where there is none, `near` is a
   lower bound, since all pairs are farther apart. */
static mote_answer sum_up(const mote_bodies *bodies, const mote_bodies_step *step,
                          const mote_bodies_pair *pairs, size_t count)
{
    mote_answer all = {.has_contact = true, .contact = step->contacts > 0};
    const mote_bodies_pair *closest = NULL;
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
    all.counters = step->counters;
    return all;
}

/* Queries a frame. All time that is neither deformation nor refit counts as query, finding
   the near pairs included. */
static mote_status ask(mote_scene_session *s, uint32_t number, const mote_bodies_frame *frame,
                       uint64_t motion_ns)
{
    mote_cell_row *row = &s->result->rows[s->result->row_count];
    mote_bodies_step step;
    if (s->between)
        s->between(s->context);
    const uint64_t from = mote_clock_ns();
    mote_status status = mote_bodies_engine_step(s->engine, frame->states, &step);
    const uint64_t total_ns = mote_clock_ns() - from;
    if (status != MOTE_OK) {
        char text[512];
        (void)snprintf(text, sizeof text, "%s", mote_error_text());
        return mote_fail(status, "frame %u: %s", number, text);
    }
    size_t count;
    const mote_bodies_pair *pairs = mote_bodies_engine_pairs(s->engine, &count);
    *row = (mote_cell_row){.frame = number,
                           .deform_ns = step.deform_ns,
                           .update_ns = step.update_ns,
                           .query_ns = total_ns - step.deform_ns - step.update_ns,
                           .allocations = step.allocations,
                           .answer = sum_up(s->bodies, &step, pairs, count),
                           .scene = {.motion_ns = motion_ns,
                                     .bounds_ns = step.bounds_ns,
                                     .broad_ns = step.broad_ns,
                                     .near_pairs = step.pairs,
                                     .new_pairs = step.fresh,
                                     .pair_contacts = step.contacts}};
    ++s->result->row_count;
    if (s->pairs)
        mote_cell_pairs_add(s->pairs, number, pairs, count);
    return MOTE_OK;
}

static bool is_over(const mote_scene_session *s)
{
    const double spent = (double)(mote_clock_ns() - s->began) * 1e-9;
    return s->cell->budget > 0 && spent > s->cell->budget &&
           s->result->row_count >= MOTE_CELL_LEAST_FRAMES;
}

static uint64_t move(const mote_scene_session *s, uint32_t number, mote_bodies_frame *frame)
{
    const uint64_t from = mote_clock_ns();
    mote_bodies_frame_set(s->bodies, number, frame);
    return mote_clock_ns() - from;
}

static mote_status run_in_turn(mote_scene_session *s)
{
    mote_status status = MOTE_OK;
    for (uint32_t k = s->cell->first; k <= s->last && status == MOTE_OK && !is_over(s); ++k) {
        const uint64_t motion_ns = move(s, k, &s->frames[0]);
        status = ask(s, k, &s->frames[0], motion_ns);
    }
    return status;
}

static void *move_ahead(void *context)
{
    mote_scene_session *s = context;
    size_t place;
    for (uint32_t k = s->cell->first;
         k <= s->last && mote_frame_queue_reserve(s->queue, &place); ++k) {
        s->motion_ns[place] = move(s, k, &s->frames[place]);
        mote_frame_queue_commit(s->queue);
    }
    mote_frame_queue_close(s->queue);
    return NULL;
}

/* Motion and deformation in a thread of their own, over a bounded queue of frames. */
static mote_status run_ahead(mote_scene_session *s)
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
    for (uint32_t k = s->cell->first;
         status == MOTE_OK && !is_over(s) && mote_frame_queue_take(s->queue, &place); ++k) {
        status = ask(s, k, &s->frames[place], s->motion_ns[place]);
        mote_frame_queue_release(s->queue);
    }
    mote_frame_queue_cancel(s->queue);
    (void)pthread_join(mover, NULL);
    mote_frame_queue_destroy(s->queue);
    return status;
}

mote_status mote_scene_session_run(mote_scene_session *session, size_t rows,
                                   void (*between)(void *context), void *context,
                                   const mote_cell_pairs *pairs, mote_cell_result *result)
{
    session->last = session->cell->first + (uint32_t)rows - 1;
    session->between = between;
    session->context = context;
    session->pairs = pairs;
    session->result = result;
    session->began = mote_clock_ns();
    mote_status status = session->ahead > 0 ? run_ahead(session) : run_in_turn(session);
    result->frames_wall_ns = mote_clock_ns() - session->began;
    return status;
}
