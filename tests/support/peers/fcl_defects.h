/* Known defects of FCL 0.7.0, each as the smallest sequence of calls that shows it
   (datasets/defects.md). Used by tests only. */
#ifndef MOTE_BASELINES_FCL_DEFECTS_H
#define MOTE_BASELINES_FCL_DEFECTS_H

#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Joins two rectangle swept spheres with operator+, as a bottom-up refit does. Returns the
   largest cosine between two axes of the sum; they should be orthogonal: 0. */
double mote_fcl_rss_sum_cosine(void);

/* How far a cube of half side 1, turned by `degrees` about (1, -1, 0), sticks out of its sum,
   as an oriented box, with a cube 1 above it along z. Should be 0. */
double mote_fcl_obb_sum_outside(double degrees);

/* How far from a triangle without area, (1, 2, 3) (3, 2, 3) (2, 2, 3), the centre of the
   oriented box lies that is fitted to it. Should be 0. */
double mote_fcl_fit_without_area(void);

/* Of the six pairs of two points and two parallel segments, as triangles, 19 and more apart:
   how many does FCL's test of triangles take for touching? Should be 0. */
int mote_fcl_contacts_without_area(void);

/* Whether two models that are 100 apart, each of a triangle and one without area, collide
   after a bottom-up refit, by oriented boxes. */
bool mote_fcl_far_models_collide(bool bottom_up);

/* fcl::distance of two triangles, one above the other at distance 1, as models of oriented
   boxes; the right answer is 1. The warning that FCL writes to its error stream is discarded.
 */
double mote_fcl_obb_distance(void);

/* memUsage of a model of one triangle; a size in bytes is expected. */
int mote_fcl_memory_usage(void);

/* The status of beginReplaceModel after an update by beginUpdateModel .. endUpdateModel; 0 is
   success. */
int mote_fcl_replace_after_update(void);

/* Whether a model with a NaN among its vertices is built without complaint. */
bool mote_fcl_builds_with_nan(void);

/* How far a body at the origin is from there half way through a linear motion that only turns
   it, made in memory that is not 0: from two poses, or with a reference point at the origin. */
double mote_fcl_turn_moves_by(bool has_point);

#ifdef __cplusplus
}
#endif
#endif
