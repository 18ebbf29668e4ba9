/* Reading a sequence frame by frame in one process of its own, which can change no files, and
   which hands positions over in shared memory. It waits, and takes no time, while nothing is
   read. */
#ifndef MOTE_HARNESS_SEQUENCE_READER_H
#define MOTE_HARNESS_SEQUENCE_READER_H

#include "harness/sequence/sequence.h"

typedef struct mote_sequence_reader mote_sequence_reader;

/* The sequence is borrowed. The process is started at the first frame, and again in a child of
   the process that read so far. */
mote_sequence_reader *mote_sequence_reader_create(const mote_sequence *sequence);
void mote_sequence_reader_destroy(mote_sequence_reader *reader); /* NULL is allowed */

/* Writes positions[vertex_count] of a frame, 1 .. frames, scaled. MOTE_EINVAL with the frame,
   the file and the reason: other faces or another number of vertices than those of the first
   frame, a coordinate that is not finite or too large, a file that ends early. MOTE_EIO: a file
   cannot be read, or reading it crashed or took too long. One thread at a time; no allocation
   in this process once a frame has been read. */
mote_status mote_sequence_read(mote_sequence_reader *reader, uint32_t frame,
                               mote_vec3 *positions);

#endif
