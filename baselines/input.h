/* Checks of the input that every adapter makes before it calls a library: none of the wrapped
   libraries rejects all bad input (an empty mesh or an index out of range crashes FCL; NaN is
   accepted silently). */
#ifndef MOTE_BASELINES_INPUT_H
#define MOTE_BASELINES_INPUT_H

#include "core/method/method.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Checks both meshes of a setup and its numbers. MOTE_EINVAL with a text that names the body
   and the vertex or face: fewer than three vertices, no triangle, an index out of range, a face
   with two equal indices, a coordinate that is not finite, a length that is not finite and > 0,
   a tolerance that is not finite and >= 0. Cost O(v + t). */
mote_status mote_input_check(const mote_setup *setup);

/* Checks one frame's world vertices of body 0 or 1: MOTE_EINVAL when they are NULL or one of
   the count positions is not finite; the text names it. Cost O(count), about 1 ns each. */
mote_status mote_input_check_vertices(const mote_vec3 *vertices, uint32_t count, int body);

/* The same check within a pass that reads the vertices anyway: the sum of these numbers is 0
   where all are finite, and NaN where one is not. Only then is mote_input_check_vertices
   called, which says what is wrong. */
static inline double mote_input_zero(mote_vec3 vertex)
{
    return (vertex.x - vertex.x) + (vertex.y - vertex.y) + (vertex.z - vertex.z);
}

/* Checks one pose of body 0 or 1: MOTE_EINVAL unless every number is finite. */
mote_status mote_input_check_pose(const mote_pose *pose, int body);

#ifdef __cplusplus
}
#endif
#endif
