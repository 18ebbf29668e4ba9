/* A scenario: two bodies, their motion and deformation, and the question for each frame. */
#ifndef MOTE_HARNESS_SCENARIO_H
#define MOTE_HARNESS_SCENARIO_H

#include "core/method/method.h"

typedef struct mote_interval {
    uint32_t first, last; /* frames, inclusive, from 1; 0, 0 if the scenario names none */
} mote_interval;

typedef struct mote_scenario {
    char *name;    /* "ww" */
    char *purpose; /* one sentence */
    char *path;    /* the file it came from, or the name of a pair */
    mote_body body[2];
    uint32_t frames;
    mote_interval warmup, active;
    mote_ask ask;
    uint32_t step;              /* frames that a question about impacts spans; 0: of others */
    double tolerance;           /* absolute: the file's times L of the pair */
    double length;              /* L of the pair */
    struct mote_motion *motion; /* poses and weights over frames; opaque */
} mote_scenario;

/* The words of a file's "ask", in the order of mote_ask; NULL behind the last. */
extern const char *const mote_ask_names[];

/* Asks for impacts from now on, `step` frames at a time, whatever the file asks. MOTE_EINVAL
   with the scenario's name for a step that is not 1 .. frames - 1; MOTE_EUNSUPPORTED for a body
   of which the path between two frames is not known (mote_scenario_path_create). */
mote_status mote_scenario_ask_impacts(mote_scenario *scenario, uint32_t step);

/* A scenario made from two mesh files: "pair:A.obj:B.obj" has 1,000 frames of approach,
   contacts (the first between frames 100 and 200, in 10 to 20 % of the frames) and separation,
   with both bodies deforming. B comes along X,Y,Z if the name ends in ":X,Y,Z"; otherwise a
   direction is searched for. */
#define MOTE_PAIR_PREFIX "pair:"

/* The name of such a scenario; direction: "X,Y,Z" or NULL. The caller frees it. */
char *mote_scenario_pair_name(const char *a, const char *b, const char *direction);

/* Loads a built-in scenario by name (datasets/scenarios/NAME.json) or a file by path (if it
   contains '/' or ends in ".json"), or makes one from two meshes (MOTE_PAIR_PREFIX). Generates
   or reads its meshes. Errors (MOTE_EINVAL, MOTE_EIO) carry "FILE:LINE:COLUMN: what is wrong;
   what would be right". The caller destroys *scenario. */
mote_status mote_scenario_load(const char *name_or_path, mote_scenario **scenario);
void mote_scenario_destroy(mote_scenario *scenario); /* NULL is allowed */

/* A frame's state and the memory for its weights. */
typedef struct mote_frame_buffer mote_frame_buffer;
mote_frame_buffer *mote_frame_buffer_create(const mote_scenario *scenario);
void mote_frame_buffer_destroy(mote_frame_buffer *buffer); /* NULL is allowed */

/* Poses and weights of frame number (1 .. frames); vertices only of a body whose positions are
   given (its file's "positions", read in this call), otherwise NULL. Returns NULL, with
   mote_error_status and mote_error_text, if positions cannot be read; never without them.
   shape_changed and pose_changed compare with frame previous, the last one given to the method
   (0: none, so everything changed). The frame is valid until the next call. */
const mote_frame *mote_scenario_frame(const mote_scenario *scenario, mote_frame_buffer *buffer,
                                      uint32_t number, uint32_t previous);

/* The state between frames: place 1 .. frames, any real number; place k is frame k. Its number
   is 0 and everything counts as changed. NULL as above. */
const mote_frame *mote_scenario_frame_at(const mote_scenario *scenario,
                                         mote_frame_buffer *buffer, double place);

/* Velocity of the middle of body i's box (absolute, per frame) and its angular velocity
   (radians per frame, world axes) at frame 1: from the file ("velocity", "spin"), otherwise
   those that lead from frame 1 to frame 2; zero if there is no frame 2. */
void mote_scenario_velocity(const mote_scenario *scenario, int i, mote_vec3 *velocity,
                            mote_vec3 *spin);

/* 64-bit FNV-1a hash over the bits of every frame's deformed vertices of both bodies, frame by
   frame, body by body, x y z, in little-endian order. Errors of mote_scenario_frame: success
   means that all positions the scenario names were read and valid. */
mote_status mote_scenario_fingerprint(const mote_scenario *scenario, uint64_t *fingerprint);

/* 64-bit FNV-1a hash over the triangles of both bodies (harness/mesh/faces.h). With the
   fingerprint it identifies what is measured. */
uint64_t mote_scenario_faces(const mote_scenario *scenario);

#endif
