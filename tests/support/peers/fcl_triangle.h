/* FCL's distance of two triangles, for comparison with core/body/triangle.h. */
#ifndef MOTE_BASELINES_FCL_TRIANGLE_H
#define MOTE_BASELINES_FCL_TRIANGLE_H

#include "core/base/vec3.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The distance of s and t as FCL 0.7 computes it: 0 where FCL takes them to intersect, and for
   some triangles whose normal (edge cross edge) is shorter than 3.2e-8; NaN if FCL throws. */
double mote_fcl_triangle_distance(const mote_vec3 s[3], const mote_vec3 t[3]);

#ifdef __cplusplus
}
#endif
#endif
