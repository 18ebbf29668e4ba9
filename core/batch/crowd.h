/* Scenes of many bodies (scene.h) from plain arrays, with the search for near pairs. */
#ifndef MOTE_CORE_CROWD_H
#define MOTE_CORE_CROWD_H

#include "core/batch/controls.h"

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

/* Every member is 8 bytes long. */
typedef struct mote_crowd_options {
    double tolerance; /* absolute, >= 0: contact is distance <= tolerance */
    uint64_t contact; /* 1: only contacts are asked for, which takes less time; 0: distances */
    size_t threads;   /* 1 .. 256 */
} mote_crowd_options;

typedef struct mote_crowd mote_crowd;

/* Makes bodies[body_count], each of the shape shape_of[i] < shape_count, which is meshes[shape]
   with fields[shape] (NULL: it never deforms); these are borrowed, the rest is copied. options
   NULL: tolerance 0, distances, one thread. MOTE_EINVAL: no shape or body, a shape that does
   not exist, a field whose positions are given, options out of range,
   and as mote_certificate_create; MOTE_ENOMEM. Cost as mote_scene_create. The caller destroys
   *crowd; one thread at a time may use it. A child process made by fork must not use it if it
   has two threads or more: they are not there. */
mote_status mote_crowd_create(const mote_mesh *const *meshes, const mote_field *const *fields,
                              size_t shape_count, const uint32_t *shape_of, size_t body_count,
                              const mote_crowd_options *options, mote_crowd **crowd);

/* NULL is allowed. The meshes and fields need not exist any more. */
void mote_crowd_destroy(mote_crowd *crowd);

/* L: the largest rest L of the shapes. */
double mote_crowd_length(const mote_crowd *crowd);

/* One step: finds the pairs of bodies of which boxes around them and around their parts are at
   most `within` >= 0 apart (infinity: all pairs), and answers for each; *count says how many.
   Every pair of bodies at most `within` apart is among them. The steps in controls[body_count]
   are not read: each has the numbers of this step. Pairs that were also in the last step
   continue from their state. MOTE_EINVAL, naming the body: as mote_controls_read; within is
   negative or NaN. MOTE_ENOMEM. Cost: 1 us a body, the queries, and a sort and sweep along one
   axis. */
mote_status mote_crowd_step(mote_crowd *crowd, const mote_controls *controls, double within,
                            size_t *count);

/* Copies what the last step found; each may be NULL. pairs[count][2]: i < j, ascending;
   distance and lower[count]; witness[count][2][3]; contact[count], 1 or 0, or -1 where
   coordinates from 2.8e17 L on leave it undecided (scene.h). With contacts asked for, distance
   is an upper bound. */
void mote_crowd_pairs(const mote_crowd *crowd, uint32_t *pairs, double *distance, double *lower,
                      double *witness, int8_t *contact);

/* Copies the boxes of the last step, bounds[body_count][2][3]: lowest and highest corner. */
void mote_crowd_bounds(const mote_crowd *crowd, double *bounds);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
