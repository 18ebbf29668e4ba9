/* libccd's contact of two triangles, for comparison with core/body/triangle.h. */
#ifndef MOTE_BASELINES_CCD_TRIANGLE_H
#define MOTE_BASELINES_CCD_TRIANGLE_H

#include "core/base/vec3.h"

#include <stdbool.h>

/* Whether s and t intersect by libccd's GJK, with at most 1,000 iterations (its default is no
   limit). libccd has no distance. Sizes should be near 1: its tolerances are absolute. */
bool mote_ccd_triangles_touch(const mote_vec3 s[3], const mote_vec3 t[3]);

#endif
