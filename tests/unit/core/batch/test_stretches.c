/* Running the frames of a batch, whatever answers them: which failure is told, and which frames
   are fresh. */
#include "core/batch/stretches.h"

#include "tests/support/test.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { FRAMES = 8 };

/* Fails the frames that are marked. */
typedef struct answerer {
    bool fails[FRAMES], fresh[FRAMES];
    int asked[FRAMES];
    bool recovers;             /* frames fail only when they are asked first */
    pthread_barrier_t *before; /* passed by the first frame of each thread, or NULL */
    size_t late;               /* the frame that waits for the other one to have failed */
} answerer;

static mote_status answer(void *batch, uint32_t worker, size_t frame, bool fresh,
                          double tolerance, mote_certificate_answer *found)
{
    answerer *a = batch;
    (void)worker;
    assert_true(tolerance < 0);
    const bool again = a->asked[frame]++ > 0;
    a->fresh[frame] = fresh;
    if (a->before && !again)
        (void)pthread_barrier_wait(a->before);
    if (a->before && !again && frame == a->late)
        (void)nanosleep(&(struct timespec){.tv_nsec = 20000000}, NULL);
    *found = (mote_certificate_answer){.distance = (double)frame, .lower = (double)frame};
    if (!a->fails[frame] || (again && a->recovers))
        return MOTE_OK;
    return mote_fail(MOTE_ENUMERIC, "planted in %zu", frame);
}

static mote_batch_run run_of(size_t frames, size_t stretch, size_t threads, double *distance)
{
    return (mote_batch_run){.frames = frames,
                            .stretch = stretch,
                            .threads = threads,
                            .tolerance = -1,
                            .distance = distance};
}

TEST(stretches_begin_with_a_fresh_frame)
{
    for (size_t stretch = 0; stretch <= 3; ++stretch) {
        double distance[FRAMES];
        answerer a = {.fails = {false}};
        const mote_batch_run run = run_of(FRAMES, stretch, 1, distance);
        assert_int_equal(mote_stretches_run(&run, true, answer, &a), MOTE_OK);
        for (size_t f = 0; f < FRAMES; ++f) {
            assert_int_equal(a.asked[f], 1);
            assert_int_equal(a.fresh[f], stretch > 0 && f % stretch == 0);
            assert_true(distance[f] == (double)f);
        }
    }
}

/* The frame is asked a second time for its text, on the calling thread. */
TEST(the_first_failure_is_told_and_nothing_after_it_is_asked)
{
    for (int recovers = 0; recovers < 2; ++recovers) {
        answerer a = {.fails = {[3] = true, [5] = true}, .recovers = recovers};
        const mote_batch_run run = run_of(FRAMES, 0, 1, NULL);
        assert_int_equal(mote_stretches_run(&run, true, answer, &a),
                         recovers ? MOTE_EINVAL : MOTE_ENUMERIC);
        assert_string_equal(mote_error_text(),
                            recovers ? "frame 3: its numbers changed while they were read"
                                     : "frame 3, planted in 3");
        assert_int_equal(a.asked[3], 2);
        assert_int_equal(a.asked[4] + a.asked[5], 0);
    }
}

/* Two threads fail, one after the other, in both orders. */
TEST(the_first_of_failing_frames_is_told_whoever_fails_first)
{
    for (size_t late = 0; late < 2; ++late) {
        pthread_barrier_t barrier;
        answerer a = {.fails = {true, true}, .before = &barrier, .late = late};
        const mote_batch_run run = run_of(2, 1, 2, NULL);
        assert_int_equal(pthread_barrier_init(&barrier, NULL, 2), 0);
        assert_int_equal(mote_stretches_run(&run, true, answer, &a), MOTE_ENUMERIC);
        assert_string_equal(mote_error_text(), "frame 0, planted in 0");
        assert_int_equal(a.asked[1], 1);
        (void)pthread_barrier_destroy(&barrier);
    }
}
