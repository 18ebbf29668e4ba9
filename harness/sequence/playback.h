/* The vertices of a body that has a sequence (harness/sequence/sequence.h) instead of a
   field. */
#ifndef MOTE_HARNESS_PLAYBACK_H
#define MOTE_HARNESS_PLAYBACK_H

#include "core/body/body.h"
#include "harness/sequence/sequence.h"

/* Two frames of the sequence: 48 bytes per vertex. */
typedef struct mote_playback mote_playback;

/* The sequence is borrowed. */
mote_playback *mote_playback_create(const mote_sequence *sequence);
void mote_playback_destroy(mote_playback *playback); /* NULL is allowed */

/* Writes world[vertex_count]: the vertices at a place of the sequence, moved by the pose. Place
   1 is frame 1; between two frames each vertex moves on a straight line; before the first frame
   and after the last it does not move. Errors of mote_sequence_read, after which world is as it
   was. Reads only missing frames: one per call if frames follow each other, none if the place
   stays. */
mote_status mote_playback_at(mote_playback *playback, double place, const mote_pose *pose,
                             mote_vec3 *world);

#endif
