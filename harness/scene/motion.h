/* The motion of one body over the frames of a scenario: its pose and its field's weights. */
#ifndef MOTE_HARNESS_MOTION_H
#define MOTE_HARNESS_MOTION_H

#include "core/body/body.h"
#include "core/body/csrbf_fit.h"
#include "core/base/quaternion.h"
#include "harness/base/curve.h"
#include "harness/scene/player.h"
#include "harness/sequence/sequence.h"

/* Rotation by degrees about an axis (any length > 0), right-handed. */
mote_quaternion mote_quaternion_about(mote_vec3 axis, double degrees);

/* One sine of a control point's displacement: amplitude * sin(2 pi (frame / period + phase)).
 */
typedef struct mote_wave {
    uint32_t control;
    mote_vec3 amplitude; /* absolute, rest axes */
    double period;       /* frames, > 0 */
    double phase;        /* turns */
} mote_wave;

/* How one body moves and deforms. Everything is owned. */
typedef struct mote_body_motion {
    mote_vec3 centre;     /* the rest point that position places and that rotation turns
                             about */
    mote_curve *position; /* width 3, absolute; NULL: the centre stays at the origin */
    mote_curve *rotation; /* width 4, quaternions with aligned signs; NULL: none */
    mote_curve *keyed;    /* width 3 J, displacement of each control point; may be NULL */
    mote_wave *waves;     /* added to keyed */
    uint32_t wave_count;
    uint32_t control_count;  /* J; 0: no deformation */
    mote_csrbf_fit *fit;     /* NULL: the displacements are the weights (J is 0, or no CSRBF) */
    mote_player *player;     /* of a character, instead of controls; may be NULL */
    mote_sequence *sequence; /* positions instead of a field; owned, may be NULL */
    bool has_velocity, has_spin;
    mote_vec3 velocity; /* of the centre at frame 1, absolute, per frame */
    mote_vec3 spin;     /* angular, at frame 1, radians per frame, world axes */
} mote_body_motion;

typedef struct mote_motion {
    mote_body_motion body[2];
    double start, pace; /* frame k is at start + (k - 1) * pace on the path */
} mote_motion;

/* Draws waves that displace each of control_count points by at most amplitude (absolute):
   `terms` sines each, of random direction and phase, with periods (frames) drawn log-uniformly
   from [low, high]. The same seed gives the same bits everywhere. waves holds control_count *
   terms. */
void mote_waves_draw(uint64_t seed, uint32_t control_count, uint32_t terms, double amplitude,
                     double low, double high, mote_wave *waves);

/* Chooses the signs of successive quaternions so that a curve through them takes the shorter
   way. */
void mote_quaternions_align(mote_quaternion *keys, uint32_t count);

/* The pose of the body at a frame (any real number). */
mote_pose mote_motion_pose(const mote_body_motion *motion, double frame);

/* Displacements of the control points, rest axes: displacement[control_count]. For a character,
   its weights, one for each function of its field. */
void mote_motion_displacements(const mote_body_motion *motion, double frame,
                               mote_vec3 *displacement);

void mote_body_motion_free(mote_body_motion *motion);

#endif
