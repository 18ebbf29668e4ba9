#include "core/batch/stretches.h"

#include "core/base/pool.h"

#include <stdatomic.h>

/* A run in progress. */
typedef struct progress {
    const mote_batch_run *run;
    bool exact;
    mote_stretch_answer answer;
    void *batch;
    atomic_size_t failed; /* the first frame that has failed so far; SIZE_MAX: none */
} progress;

mote_status mote_stretches_check(const mote_batch_run *run)
{
    if (run->threads < 1 || run->threads > MOTE_POOL_MAX)
        return mote_fail(MOTE_EINVAL, "threads: %zu; 1 to %u are possible", run->threads,
                         MOTE_POOL_MAX);
    if (isnan(run->tolerance))
        return mote_fail(MOTE_EINVAL, "tolerance: it must be a number");
    return MOTE_OK;
}

static size_t stretch_count(const mote_batch_run *run)
{
    if (run->stretch == 0 || run->frames == 0)
        return run->frames > 0;
    return (run->frames - 1) / run->stretch + 1;
}

uint32_t mote_stretches_threads(const mote_batch_run *run)
{
    const size_t count = stretch_count(run);
    const size_t threads = count < run->threads ? count : run->threads;
    return threads > 1 ? (uint32_t)threads : 1;
}

/* The contact that a bracket shows: 1, 0, or -1 where it is not decided. */
static int8_t decide(const mote_certificate_answer *bracket, double tolerance, bool exact)
{
    const bool asked = tolerance >= 0;
    mote_answer answer = {.has_distance = false};
    mote_certificate_report(bracket, asked ? MOTE_ASK_CONTACT : MOTE_ASK_DISTANCE,
                            asked ? tolerance : 0, exact, &answer);
    return answer.has_contact ? answer.contact : -1;
}

static void write_answer(const progress *p, size_t frame,
                         const mote_certificate_answer *bracket)
{
    const mote_batch_run *run = p->run;
    if (run->distance)
        run->distance[frame] = bracket->distance;
    if (run->lower)
        run->lower[frame] = bracket->lower;
    if (run->contact)
        run->contact[frame] = decide(bracket, run->tolerance, p->exact);
    if (!run->witness)
        return;
    for (size_t b = 0; b < 2; ++b) {
        double *to = run->witness + 6 * frame + 3 * b;
        to[0] = bracket->witness[b].x;
        to[1] = bracket->witness[b].y;
        to[2] = bracket->witness[b].z;
    }
}

static void note_failure(progress *p, size_t frame)
{
    size_t first = atomic_load(&p->failed);
    while (frame < first && !atomic_compare_exchange_weak(&p->failed, &first, frame))
        ;
}

static void answer_stretch(progress *p, uint32_t worker, size_t stretch)
{
    const mote_batch_run *run = p->run;
    const size_t first = stretch * run->stretch;
    const size_t length = run->stretch > 0 ? run->stretch : run->frames;
    const size_t end = length < run->frames - first ? first + length : run->frames;
    for (size_t frame = first; frame < end && frame < atomic_load(&p->failed); ++frame) {
        mote_certificate_answer bracket;
        const bool fresh = run->stretch > 0 && frame == first;
        if (p->answer(p->batch, worker, frame, fresh, run->tolerance, &bracket) == MOTE_OK)
            write_answer(p, frame, &bracket);
        else
            note_failure(p, frame);
    }
}

static void answer_stretches(void *context, uint32_t worker, size_t first, size_t end)
{
    for (size_t stretch = first; stretch < end; ++stretch)
        answer_stretch(context, worker, stretch);
}

/* Why a frame failed, which another thread may have found. */
static mote_status explain(const progress *p, size_t frame)
{
    mote_certificate_answer bracket;
    const mote_status status =
        p->answer(p->batch, 0, frame, p->run->stretch > 0, p->run->tolerance, &bracket);
    if (status == MOTE_OK)
        return mote_fail(MOTE_EINVAL, "frame %zu: its numbers changed while they were read",
                         frame);
    return mote_fail(status, "frame %zu, %s", frame, mote_error_text());
}

mote_status mote_stretches_run(const mote_batch_run *run, bool exact,
                               mote_stretch_answer answer, void *batch)
{
    progress p = {.run = run, .exact = exact, .answer = answer, .batch = batch};
    const uint32_t threads = mote_stretches_threads(run);
    atomic_init(&p.failed, SIZE_MAX);
    if (threads == 1) {
        answer_stretches(&p, 0, 0, stretch_count(run));
    } else {
        mote_pool *pool;
        mote_status status = mote_pool_create(threads, &pool);
        if (status != MOTE_OK)
            return status;
        mote_pool_run(pool, answer_stretches, &p, stretch_count(run), 1);
        mote_pool_destroy(pool);
    }
    const size_t failed = atomic_load(&p.failed);
    return failed == SIZE_MAX ? MOTE_OK : explain(&p, failed);
}
