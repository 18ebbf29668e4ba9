/* The queries of certificate.h and stream.h over many frames in one call, from plain arrays:
   for other languages, which need none of the structs of a frame, and for recorded motion.

   Frames are cut into stretches. The first query of a stretch starts from nothing, and each
   other one from the answer before it. Stretches are shared among threads, so that answers
   depend on the frames and on where they are cut alone: they are the same bits for any number
   of threads. */
#ifndef MOTE_CORE_BATCH_H
#define MOTE_CORE_BATCH_H

#include "core/batch/batch_run.h"

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

typedef struct mote_batch mote_batch;

/* For two bodies whose fields are known (certificate.h). meshes and fields are borrowed; the
   same ones may be given twice, and have one tree then. L is the larger of the two rest L.
   Samples are copied. A NULL field never deforms. MOTE_EINVAL: slack or a sample out of range,
   a field that has positions given, a skin of another mesh; MOTE_ENOMEM. Modes are taken to be
   of this mesh. Cost as mote_certificate_create. The caller destroys *batch; one thread at a
   time may use it. */
mote_status mote_batch_create(const mote_mesh *const meshes[2],
                              const mote_field *const fields[2],
                              const mote_batch_options *options, mote_batch **batch);

/* NULL is allowed. Does not look at the meshes and fields, which may be gone. */
void mote_batch_destroy(mote_batch *batch);

/* Bytes of heap held now: trees, and what queries of as many threads as were ever asked for
   need. */
size_t mote_batch_bytes(const mote_batch *batch);

/* Answers for all frames. The answers of mote_certificate_query, bit for bit, where `stretch`
   is 0. MOTE_EINVAL, naming the first bad frame, counted from 0, and the body: as
   mote_controls_read; threads out of range, a tolerance that is NaN. The frames' answers are
   not to be used then. MOTE_ENOMEM. Allocates where there are more threads than ever before,
   and for threads. Beside the queries about 0.1 us a frame. */
mote_status mote_batch_query(mote_batch *batch, const mote_controls controls[2],
                             const mote_batch_run *run);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
