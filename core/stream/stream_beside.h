/* Streamed queries of the same two bodies by several threads, over the same trees. */
#ifndef MOTE_CORE_STREAM_BESIDE_H
#define MOTE_CORE_STREAM_BESIDE_H

#include "core/stream/stream.h"

/* Makes a stream with the options and the trees of `owner`, which must outlive it. MOTE_ENOMEM,
   also where threads cannot be started. The caller destroys *stream. */
mote_status mote_stream_create_beside(const mote_stream *owner, mote_stream **stream);

/* The next query starts from nothing, as the first one does. */
void mote_stream_forget(mote_stream *stream);

#endif
