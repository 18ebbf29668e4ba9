/* The queries of certificate.h and stream.h over many frames in one call, from plain arrays:
   for other languages, which need none of the structs of a frame, and for recorded motion.

   Frames are cut into stretches. The first query of a stretch starts from nothing, and each
   other one from the answer before it. Threads share the stretches. So answers depend only on
   the frames and on where they are cut, and are the same bits for any number of threads. */
#ifndef MOTE_CORE_BATCH_H
#define MOTE_CORE_BATCH_H

#include "core/batch/batch_run.h"

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

typedef struct mote_batch mote_batch;

/* For two bodies whose fields are known (certificate.h). meshes and fields are borrowed; two
   bodies of the same mesh and field share a tree where neither has samples. L is the larger of
   the two rest L. Samples are copied. A body whose field is NULL never deforms. MOTE_EINVAL:
   slack or a sample out of range, a field whose positions are given, and as
   mote_certificate_create; MOTE_ENOMEM. Whether linear modes belong to the mesh is not checked.
   Cost as mote_certificate_create. The caller destroys *batch; one thread at a time may use it.
 */
mote_status mote_batch_create(const mote_mesh *const meshes[2],
                              const mote_field *const fields[2],
                              const mote_batch_options *options, mote_batch **batch);

/* NULL is allowed. The meshes and fields need not exist any more. */
void mote_batch_destroy(mote_batch *batch);

/* Bytes of heap held now: trees, and what queries of as many threads as were ever asked for
   need. */
size_t mote_batch_bytes(const mote_batch *batch);

/* Answers for all frames. Where `stretch` is 0 they are those of mote_certificate_query, bit
   for bit. MOTE_EINVAL, naming the first bad frame, counted from 0, and the body: as
   mote_controls_read; threads out of range, a tolerance that is NaN. No frame's answer is valid
   then. MOTE_ENOMEM. Allocates to start threads, and where there are more of them than ever
   before. Cost: the queries, and about 0.1 us a frame. */
mote_status mote_batch_query(mote_batch *batch, const mote_controls controls[2],
                             const mote_batch_run *run);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
