/* A scenario of several bodies: many bodies of a few shapes in a box. The middle of each moves
   in a straight line and is reflected at the walls; the body rotates about an axis and deforms
   as its shape prescribes, with a time offset of its own, so no two bodies look alike.
   Everything follows from a seed. A body takes a few hundred bytes, however many triangles its
   shape has. */
#ifndef MOTE_HARNESS_BODIES_H
#define MOTE_HARNESS_BODIES_H

#include "core/certificate/scene.h"
#include "harness/engine/engine.h"
#include "harness/scene/motion.h"
#include "harness/scene/scenario.h"
#include "harness/sequence/playback.h"

/* The largest numbers of bodies and shapes. */
#define MOTE_BODIES_MAX 1000000
#define MOTE_BODIES_SHAPES_MAX MOTE_ENGINE_SHAPES_MAX

/* A shape with its deformation. */
typedef struct mote_bodies_shape {
    mote_body body;
    mote_body_motion motion; /* of its controls; no position or rotation */
    double radius;           /* from the middle of the box to its farthest vertex at rest */
} mote_bodies_shape;

/* Where a body starts and how it moves. Lengths are absolute. */
typedef struct mote_bodies_path {
    mote_vec3 place;    /* of the middle of the body's box at frame 1 */
    mote_vec3 velocity; /* per frame */
    mote_vec3 axis;     /* of length 1 */
    double degrees;     /* about the axis at frame 1 */
    double spin;        /* per frame */
    double time;        /* time offset: the deformation frame shown at frame 1 */
} mote_bodies_path;

/* A body at a frame of a recorded motion (harness/scene/bodies_poses.h). */
typedef struct mote_bodies_record {
    mote_vec3 middle;     /* of the body's box, absolute */
    mote_quaternion turn; /* of length 1 */
    double deformation;   /* the frame of its shape's deformation */
} mote_bodies_record;

typedef struct mote_bodies {
    char *name, *purpose, *path;
    uint32_t frames;
    mote_ask ask;
    double tolerance; /* absolute */
    double near;      /* absolute; pairs at most this far apart are found */
    double length;    /* L: the largest of the shapes' */
    mote_bodies_shape *shapes;
    uint32_t shape_count;
    uint32_t count;
    uint32_t *shape_of;           /* [count] */
    mote_bodies_path *paths;      /* [count] */
    mote_bodies_record *recorded; /* [frames][count], or NULL: bodies follow their paths */
    mote_vec3 room;               /* half the edges of the box that contains the middles */
    mote_vec3 box;                /* half the edges of the box */
    double near_pairs;            /* per body and frame, as found when the box was made; 0: not
                                     requested */
    double near_pairs_wanted;     /* 0: the box is given */
} mote_bodies;

/* Whether a scenario (a name or path as for mote_scenario_load) has several bodies. False for a
   file that cannot be read; loading it reports why. */
bool mote_bodies_is(const char *name_or_path);

/* Loads a scenario: shapes, then positions without overlap at frame 1. Errors as
   mote_scenario_load; MOTE_EINVAL also if bodies overlap at frame 1, the box cannot hold them,
   or no box gives the requested number of near pairs. The caller destroys *bodies. */
mote_status mote_bodies_load(const char *path, mote_bodies **bodies);
void mote_bodies_destroy(mote_bodies *bodies); /* NULL is allowed */

/* A 64-bit FNV-1a hash that identifies a scene: of every body's path, and at the first, middle
   and last frame of every body's weights and the deformed vertices of the first body of each
   shape; of positions, every frame. Errors of mote_bodies_frame_set: success means that all
   positions the scenario names were read and valid. */
mote_status mote_bodies_fingerprint(const mote_bodies *bodies, uint64_t *fingerprint);

/* The same over the triangles of each shape (harness/mesh/faces.h). */
uint64_t mote_bodies_faces(const mote_bodies *bodies);

/* Whether a shape has positions instead of a field. */
bool mote_bodies_any_given(const mote_bodies *bodies);

/* The bodies of one frame, with memory for their weights, and for the vertices of those that
   have positions instead of a field. */
typedef struct mote_bodies_frame {
    mote_body_state *states; /* [count]; vertices are NULL of a body with a field */
    double *weights;
    mote_vec3 *scratch;
    mote_vec3 *vertices;
    mote_playback **playbacks; /* [shape_count], NULL where a shape has a field */
    uint32_t shape_count;
} mote_bodies_frame;

mote_bodies_frame mote_bodies_frame_create(const mote_bodies *bodies);
void mote_bodies_frame_free(mote_bodies_frame *frame);

/* Sets the poses, and weights or vertices, of all bodies at a frame (1 .. frames). One thread
   at a time, whatever the frame. Errors of mote_sequence_read; none where all shapes have
   fields. A shape's positions are read once for all bodies that show the same of its frames. */
mote_status mote_bodies_frame_set(const mote_bodies *bodies, double number,
                                  mote_bodies_frame *frame);

/* Sets the weights or vertices of one body at a frame, but for another pose: for bodies that
   move freely. Errors as above. */
mote_status mote_bodies_deform(const mote_bodies *bodies, uint32_t i, double number,
                               const mote_pose *pose, mote_bodies_frame *frame);

/* The pose of a body on its path, or the recorded one of the nearest frame. */
mote_pose mote_bodies_pose(const mote_bodies *bodies, uint32_t i, double number);

/* The rotation of a body at frame 1, relative to rest. */
mote_quaternion mote_bodies_turn(const mote_bodies *bodies, uint32_t i);

/* The frame of its shape's deformation that a body shows at a frame. After the last recorded
   frame it advances by one per frame. */
double mote_bodies_deformation(const mote_bodies *bodies, uint32_t i, double number);

#endif
