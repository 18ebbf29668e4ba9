/* A scenario: two bodies, their motion and deformation, and what is asked of each frame. */
#ifndef MOTE_HARNESS_SCENARIO_H
#define MOTE_HARNESS_SCENARIO_H

#include "core/method/method.h"

typedef struct mote_interval {
    uint32_t first, last; /* frames, inclusive, from 1; 0, 0 when the scenario names none */
} mote_interval;

typedef struct mote_scenario {
    char *name;    /* "ww" */
    char *purpose; /* one sentence */
    char *path;    /* the file it came from, or the name of a pair */
    mote_body body[2];
    uint32_t frames;
    mote_interval warmup, active;
    mote_ask ask;
    double tolerance;           /* absolute: the file's times L of the pair */
    double length;              /* L of the pair */
    struct mote_motion *motion; /* poses and weights over frames; opaque */
} mote_scenario;

/* A scenario that is made of two mesh files: "pair:A.obj:B.obj" is 1,000 frames of approach,
   touches from between frames 100 and 200 on, in 10 to 20 % of frames, and parting, both
   deforming. B comes along X,Y,Z where the name ends in ":X,Y,Z", or else along a direction
   that is searched for. */
#define MOTE_PAIR_PREFIX "pair:"

/* The name of that scenario; direction: "X,Y,Z" or NULL. The caller
   frees it. */
char *mote_scenario_pair_name(const char *a, const char *b, const char *direction);

/* Loads a built-in scenario by name (datasets/scenarios/NAME.json) or a file by path (when it
   contains '/' or ends in ".json"), or makes one of two meshes (MOTE_PAIR_PREFIX). Generates or
   reads its meshes. Errors (MOTE_EINVAL, MOTE_EIO) carry "FILE:LINE:COLUMN: what is wrong; what
   would be right". The caller destroys *scenario. */
mote_status mote_scenario_load(const char *name_or_path, mote_scenario **scenario);
void mote_scenario_destroy(mote_scenario *scenario); /* NULL is allowed */

/* A frame's state with the memory behind its weights. */
typedef struct mote_frame_buffer mote_frame_buffer;
mote_frame_buffer *mote_frame_buffer_create(const mote_scenario *scenario);
void mote_frame_buffer_destroy(mote_frame_buffer *buffer); /* NULL is allowed */

/* Poses and weights of frame number (1 .. frames), and the vertices of a body whose positions
   are given (its file's "positions"); vertices are NULL else. NULL, with mote_error_status and
   mote_error_text, where these positions cannot be read; never in a scenario without them.
   Where they are the frame's file is read, now. shape_changed and
   pose_changed compare with frame previous, the one that the method was given last (0: none, so
   everything changed). The frame lives in the buffer until the next call. */
const mote_frame *mote_scenario_frame(const mote_scenario *scenario, mote_frame_buffer *buffer,
                                      uint32_t number, uint32_t previous);

/* The state between frames: place 1 .. frames, any real number, where place k is frame k.
   Number 0; everything changed. NULL likewise. */
const mote_frame *mote_scenario_frame_at(const mote_scenario *scenario,
                                         mote_frame_buffer *buffer, double place);

/* Velocity of the middle of body i's box (absolute, a frame) and its angular velocity (radians
   a frame, world axes) at frame 1: as the file says ("velocity", "spin"), or what leads from
   frame 1 to frame 2 where it says nothing; zero where there is no frame 2. */
void mote_scenario_velocity(const mote_scenario *scenario, int i, mote_vec3 *velocity,
                            mote_vec3 *spin);

/* 64-bit FNV-1a hash over the bits of every frame's deformed vertices of both bodies, frame by
   frame, body by body, x y z, in little-endian order. Errors of mote_scenario_frame, so that
   whatever positions a scenario names have been read once, and were right, when this is known.
 */
mote_status mote_scenario_fingerprint(const mote_scenario *scenario, uint64_t *fingerprint);

#endif
