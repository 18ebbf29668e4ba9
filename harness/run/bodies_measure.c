#include "harness/run/bodies_measure.h"

#include "core/base/frame_queue.h"
#include "harness/run/bodies_record.h"
#include "harness/run/cell_process.h"
#include "harness/run/measure.h"
#include "harness/base/statistics.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

/* Frames that one thread moves and the other asks about. */
#define AHEAD_MAX 64

/* What a child does. */
typedef struct session {
    const mote_bodies *bodies;
    const mote_bodies_choice *choice;
    const mote_bodies_options *options;
    uint32_t first, last;
    mote_bodies_engine *engine;
    mote_bodies_frame frames[AHEAD_MAX];
    uint64_t motion_ns[AHEAD_MAX]; /* of each frame that is in the queue */
    mote_frame_queue *queue;
    mote_bodies_record record;
    uint64_t began;
    mote_bodies_result *result;
    size_t step_room, contact_room;
} session;

/* What a child tells before its steps and contacts. */
typedef struct message {
    mote_bodies_result result; /* pointers mean nothing */
} message;

static mote_status grow(void **items, size_t *room, size_t needed, size_t size)
{
    if (needed <= *room)
        return MOTE_OK;
    const size_t wider = needed + needed / 2 + 64;
    void *grown = realloc(*items, wider * size);
    if (!grown)
        return mote_fail(MOTE_ENOMEM, "no memory for %zu records", wider);
    *items = grown;
    *room = wider;
    return MOTE_OK;
}

static mote_status keep(session *s, const mote_bodies_timed *timed)
{
    mote_bodies_result *r = s->result;
    size_t count;
    const mote_bodies_pair *pairs = mote_bodies_engine_pairs(s->engine, &count);
    mote_bodies_record_step(&s->record, timed, pairs, count);
    void *items = r->steps;
    mote_status status =
        grow(&items, &s->step_room, r->step_count + 1, sizeof(mote_bodies_timed));
    r->steps = items;
    if (status != MOTE_OK)
        return status;
    r->steps[r->step_count++] = *timed;
    items = r->contacts;
    status = grow(&items, &s->contact_room, r->contact_count + timed->step.contacts,
                  sizeof(mote_bodies_contact));
    r->contacts = items;
    for (size_t k = 0; k < count && status == MOTE_OK; ++k) {
        if (pairs[k].answer.contact)
            r->contacts[r->contact_count++] =
                (mote_bodies_contact){timed->frame, pairs[k].body[0], pairs[k].body[1]};
    }
    return status;
}

static mote_status ask(session *s, uint32_t number, const mote_bodies_frame *frame,
                       uint64_t motion_ns)
{
    mote_bodies_timed timed = {.frame = number, .motion_ns = motion_ns};
    const uint64_t from = mote_clock_ns();
    mote_status status = mote_bodies_engine_step(s->engine, frame->states, &timed.step);
    timed.total_ns = mote_clock_ns() - from;
    if (status != MOTE_OK)
        return mote_fail(status, "frame %u: %s", number, mote_error_text());
    return keep(s, &timed);
}

static bool is_over(const session *s)
{
    const double passed = (double)(mote_clock_ns() - s->began) * 1e-9;
    return s->options->budget > 0 && passed > s->options->budget &&
           s->result->step_count >= s->options->least;
}

static uint64_t move(session *s, uint32_t number, mote_bodies_frame *frame)
{
    const uint64_t from = mote_clock_ns();
    mote_bodies_frame_set(s->bodies, number, frame);
    return mote_clock_ns() - from;
}

static mote_status run_in_turn(session *s)
{
    mote_status status = MOTE_OK;
    for (uint32_t k = s->first; k <= s->last && status == MOTE_OK && !is_over(s); ++k) {
        const uint64_t motion_ns = move(s, k, &s->frames[0]);
        status = ask(s, k, &s->frames[0], motion_ns);
    }
    return status;
}

static void *move_ahead(void *context)
{
    session *s = context;
    size_t place;
    for (uint32_t k = s->first; k <= s->last && mote_frame_queue_reserve(s->queue, &place);
         ++k) {
        s->motion_ns[place] = move(s, k, &s->frames[place]);
        mote_frame_queue_commit(s->queue);
    }
    mote_frame_queue_close(s->queue);
    return NULL;
}

/* Motion and deformation in a thread of their own, over a bounded queue of frames. */
static mote_status run_ahead(session *s)
{
    pthread_t mover;
    mote_status status = mote_frame_queue_create(s->choice->ahead, &s->queue);
    if (status != MOTE_OK)
        return status;
    if (pthread_create(&mover, NULL, move_ahead, s) != 0) {
        mote_frame_queue_destroy(s->queue);
        return mote_fail(MOTE_ENOMEM, "a thread for motion cannot be started");
    }
    size_t place;
    for (uint32_t k = s->first;
         status == MOTE_OK && !is_over(s) && mote_frame_queue_take(s->queue, &place); ++k) {
        status = ask(s, k, &s->frames[place], s->motion_ns[place]);
        mote_frame_queue_release(s->queue);
    }
    mote_frame_queue_cancel(s->queue);
    (void)pthread_join(mover, NULL);
    mote_frame_queue_destroy(s->queue);
    return status;
}

static mote_status run_session(session *s)
{
    const uint32_t frames = s->choice->ahead > 0 ? s->choice->ahead : 1;
    mote_status status = MOTE_OK;
    const mote_heap before = mote_heap_read();
    mote_heap_reset_peak();
    for (uint32_t i = 0; i < frames && status == MOTE_OK; ++i)
        status = mote_bodies_frame_create(s->bodies, &s->frames[i]);
    s->began = mote_clock_ns();
    if (status == MOTE_OK)
        status = mote_bodies_engine_create(s->bodies, s->choice, &s->engine);
    s->result->build_ns = mote_clock_ns() - s->began;
    if (status == MOTE_OK && s->options->directory) {
        char *name = mote_bodies_cell_name(s->bodies, s->choice, s->options->replicate);
        status = name ? mote_bodies_record_open(s->options->directory, name, &s->record)
                      : mote_fail(MOTE_ENOMEM, "no memory for a name");
        free(name);
    }
    s->began = mote_clock_ns();
    if (status == MOTE_OK)
        status = s->choice->ahead > 0 ? run_ahead(s) : run_in_turn(s);
    s->result->wall_ns = mote_clock_ns() - s->began;
    const mote_heap after = mote_heap_read();
    s->result->heap_counted = after.counted;
    s->result->heap_live_bytes = after.live_bytes - before.live_bytes;
    s->result->heap_peak_bytes = after.peak_bytes - before.live_bytes;
    struct rusage usage;
    if (getrusage(RUSAGE_SELF, &usage) == 0)
        s->result->rss_peak_bytes = (int64_t)usage.ru_maxrss * 1024;
    mote_status closed = mote_bodies_record_close(&s->record, status == MOTE_OK);
    mote_bodies_engine_destroy(s->engine);
    for (uint32_t i = 0; i < frames; ++i)
        mote_bodies_frame_free(&s->frames[i]);
    return status == MOTE_OK ? closed : status;
}

static mote_status work(void *context, int output)
{
    session *s = context;
    if (s->choice->threads == 1 && s->choice->ahead == 0)
        mote_process_pin(mote_process_core());
    mote_status status = run_session(s);
    if (status == MOTE_EIO || status == MOTE_ENOMEM)
        return status;
    mote_bodies_result *r = s->result;
    r->status = MOTE_CELL_OK;
    if (status != MOTE_OK) {
        r->status = status == MOTE_EUNSUPPORTED ? MOTE_CELL_UNSUPPORTED : MOTE_CELL_CRASHED;
        (void)snprintf(r->reason, sizeof r->reason, "%s", mote_error_text());
        r->step_count = r->contact_count = 0;
    }
    const message told = {*r};
    status = mote_child_put(output, &told, sizeof told);
    if (status == MOTE_OK && r->step_count > 0)
        status = mote_child_put(output, r->steps, r->step_count * sizeof *r->steps);
    if (status == MOTE_OK && r->contact_count > 0)
        status = mote_child_put(output, r->contacts, r->contact_count * sizeof *r->contacts);
    return status;
}

/* What the child told, into a result of our own. */
static mote_status take(const char *output, size_t size, mote_bodies_result *result)
{
    message told;
    if (size < sizeof told)
        return mote_fail(MOTE_EIO, "a process of several bodies said too little");
    memcpy(&told, output, sizeof told);
    mote_bodies_result made = told.result;
    const size_t steps = made.step_count * sizeof *made.steps;
    const size_t contacts = made.contact_count * sizeof *made.contacts;
    if (size != sizeof told + steps + contacts)
        return mote_fail(MOTE_EIO, "a process of several bodies said too little");
    made.steps = malloc(steps + 1);
    made.contacts = malloc(contacts + 1);
    if (!made.steps || !made.contacts) {
        mote_bodies_result_free(&made);
        return mote_fail(MOTE_ENOMEM, "no memory for the steps of several bodies");
    }
    memcpy(made.steps, output + sizeof told, steps);
    memcpy(made.contacts, output + sizeof told + steps, contacts);
    *result = made;
    return MOTE_OK;
}

/* What became of a child that did not tell. */
static mote_status take_failure(const mote_child *child, mote_bodies_result *result)
{
    *result = (mote_bodies_result){.status = MOTE_CELL_CRASHED};
    if (child->end == MOTE_CHILD_DONE)
        return mote_fail(child->status, "%s", child->text);
    if (child->end == MOTE_CHILD_TIMEOUT)
        result->status = MOTE_CELL_TIMEOUT;
    (void)snprintf(result->reason, sizeof result->reason, "%.399s",
                   child->end == MOTE_CHILD_TIMEOUT ? "out of time" : child->text);
    return MOTE_OK;
}

mote_status mote_bodies_measure(const mote_bodies *bodies, const mote_bodies_choice *choice,
                                const mote_bodies_options *options, mote_bodies_result *result)
{
    mote_bodies_result empty = {.status = MOTE_CELL_OK};
    session s = {.bodies = bodies,
                 .choice = choice,
                 .options = options,
                 .first = options->first ? options->first : 1,
                 .last = options->last ? options->last : bodies->frames,
                 .result = &empty};
    if (s.last > bodies->frames)
        return mote_fail(MOTE_EINVAL, "%s: frames %u-%u; it has %u", bodies->name, s.first,
                         s.last, bodies->frames);
    const mote_child_limits limits = {.seconds = options->timeout,
                                      .output_bytes = (size_t)1 << 30};
    mote_child child = {0};
    size_t index;
    mote_status status = mote_child_start(work, &s, limits, &child);
    if (status == MOTE_OK)
        status = mote_child_wait(&child, 1, &index);
    if (status == MOTE_OK) {
        const bool told = child.end == MOTE_CHILD_DONE && child.status == MOTE_OK;
        status = told ? take(child.output, child.size, result) : take_failure(&child, result);
    }
    mote_child_release(&child);
    return status;
}

void mote_bodies_result_free(mote_bodies_result *result)
{
    free(result->steps);
    free(result->contacts);
    result->steps = NULL;
    result->contacts = NULL;
    result->step_count = result->contact_count = 0;
}

double mote_bodies_median(const mote_bodies_result *result, mote_bodies_part part)
{
    const size_t from = result->step_count > 1 ? 1 : 0;
    double *values = malloc((result->step_count + 1) * sizeof *values);
    if (!values || result->step_count == 0) {
        free(values);
        return MOTE_NONE;
    }
    for (size_t k = from; k < result->step_count; ++k)
        values[k - from] = (double)part(&result->steps[k]);
    const double median = mote_statistics_median(values, result->step_count - from);
    free(values);
    return median;
}
