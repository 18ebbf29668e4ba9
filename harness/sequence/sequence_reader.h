/* Reads a sequence frame by frame in a separate process that cannot change files and that
   returns positions in shared memory. Between reads it sleeps. */
#ifndef MOTE_HARNESS_SEQUENCE_READER_H
#define MOTE_HARNESS_SEQUENCE_READER_H

#include "harness/sequence/sequence.h"

typedef struct mote_sequence_reader mote_sequence_reader;

/* The sequence is borrowed. The process starts at the first frame, and again if a child of the
   owner reads. */
mote_sequence_reader *mote_sequence_reader_create(const mote_sequence *sequence);
void mote_sequence_reader_destroy(mote_sequence_reader *reader); /* NULL is allowed */

/* Writes positions[vertex_count] of a frame, 1 .. frames, scaled. MOTE_EINVAL with the frame,
   the file and the reason: faces or number of vertices different from the first frame's, a
   coordinate that is not finite or too large, a file that ends early. MOTE_EIO: a file cannot
   be read, or reading it crashed or took too long. One thread at a time; no allocation in this
   process after the first frame. */
mote_status mote_sequence_read(mote_sequence_reader *reader, uint32_t frame,
                               mote_vec3 *positions);

#endif
