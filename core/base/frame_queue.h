/* A bounded queue of frames between two threads (paper section 4): one moves and deforms the
   bodies, the other queries them. The queue hands out indices into an array of frames that the
   caller owns; each frame belongs to one of the two threads at a time. */
#ifndef MOTE_CORE_FRAME_QUEUE_H
#define MOTE_CORE_FRAME_QUEUE_H

#include "core/base/status.h"

#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct mote_frame_queue mote_frame_queue;

/* places: the number of frames, at least 1; with 1 the threads take turns. MOTE_EINVAL,
   MOTE_ENOMEM. */
mote_status mote_frame_queue_create(size_t places, mote_frame_queue **queue);

/* No thread may be in a call. NULL is allowed. */
void mote_frame_queue_destroy(mote_frame_queue *queue);

/* The writer: waits until a place is free. False: the reader has cancelled. */
bool mote_frame_queue_reserve(mote_frame_queue *queue, size_t *place);

/* The writer: the place last reserved is written. */
void mote_frame_queue_commit(mote_frame_queue *queue);

/* The writer: there are no more frames. */
void mote_frame_queue_close(mote_frame_queue *queue);

/* The reader: waits for the next frame, in the order of writing. False: there are no more. */
bool mote_frame_queue_take(mote_frame_queue *queue, size_t *place);

/* The reader: the place last taken may be written again. */
void mote_frame_queue_release(mote_frame_queue *queue);

/* The reader: wants no more frames. */
void mote_frame_queue_cancel(mote_frame_queue *queue);

#ifdef __cplusplus
}
#endif
#endif
