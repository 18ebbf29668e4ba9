/* Runs the frames of a batch: stretch by stretch, by several threads. */
#ifndef MOTE_CORE_STRETCHES_H
#define MOTE_CORE_STRETCHES_H

#include "core/batch/batch_run.h"
#include "core/certificate/certificate.h"

/* Answers one frame of a batch. worker: 0 .. threads - 1, which answers one frame at a time.
   fresh: nothing is known of the frame before. */
typedef mote_status (*mote_stretch_answer)(void *batch, uint32_t worker, size_t frame,
                                           bool fresh, double tolerance,
                                           mote_certificate_answer *answer);

/* MOTE_EINVAL where threads or tolerance are out of range. */
mote_status mote_stretches_check(const mote_batch_run *run);

/* Threads that a run needs: no more than it has stretches. */
uint32_t mote_stretches_threads(const mote_batch_run *run);

/* Answers for all frames and writes what the run asks for. exact: there is no slack. Fails as
   `answer` does on the calling thread for the first frame that fails, with its number before
   the text; MOTE_EINVAL, MOTE_ENOMEM where threads cannot be started. */
mote_status mote_stretches_run(const mote_batch_run *run, bool exact,
                               mote_stretch_answer answer, void *batch);

#endif
