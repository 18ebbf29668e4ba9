/* The streamed query (stream.h) over many frames in one call: see batch.h. */
#ifndef MOTE_CORE_STREAM_BATCH_H
#define MOTE_CORE_STREAM_BATCH_H

#include "core/batch/batch_run.h"

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

/* Where the vertices of a body are in each frame; as mote_positions, of the first frame. Every
   member is 8 bytes long. */
typedef struct mote_batch_positions {
    const void *data;
    size_t stride;     /* bytes from a vertex to the next one */
    size_t single;     /* 1: float, 0: double */
    size_t frame_step; /* bytes from a frame to the next one, a multiple of a number's size,
                          which is not checked; 0: the body never moves */
} mote_batch_positions;

typedef struct mote_stream_batch mote_stream_batch;

/* For two bodies of which only positions are known. The meshes are borrowed. Samples in the
   options are not read. MOTE_EINVAL: slack out of range; MOTE_ENOMEM. Cost as
   mote_stream_create. The caller destroys *batch; one thread at a time may use it. */
mote_status mote_stream_batch_create(const mote_mesh *const meshes[2],
                                     const mote_batch_options *options,
                                     mote_stream_batch **batch);

/* NULL is allowed. The meshes need not exist any more. */
void mote_stream_batch_destroy(mote_stream_batch *batch);

/* Bytes of heap held now. */
size_t mote_stream_batch_bytes(const mote_stream_batch *batch);

/* Answers for all frames. Where `stretch` is 0 they are those of mote_stream_query, bit for
   bit. MOTE_EINVAL, naming the first bad frame, counted from 0: as mote_stream_query; threads
   out of range, a tolerance that is NaN. No frame's answer is valid then. MOTE_ENOMEM. */
mote_status mote_stream_batch_query(mote_stream_batch *batch,
                                    const mote_batch_positions positions[2],
                                    const mote_batch_run *run);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
