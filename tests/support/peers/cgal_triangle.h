/* The distance of two triangles by CGAL with an exact kernel: an oracle that shares no code and
   no algorithm with ours. */
#ifndef MOTE_TESTS_CGAL_TRIANGLE_H
#define MOTE_TESTS_CGAL_TRIANGLE_H

#include "core/base/vec3.h"

#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct cgal_verdict {
    bool degenerate; /* an area is exactly 0: CGAL is not asked, the rest is 0 */
    bool touch;      /* CGAL::do_intersect */
    double parts; /* 0 where they touch, or the least of nine edge distances and six distances
                     of corners from triangles; exact except for the final root */
    double whole; /* CGAL::squared_distance of the two triangles, also exact but for the root */
} cgal_verdict;

/* Coordinates are finite. About 100 us. */
cgal_verdict cgal_triangles(const mote_vec3 s[3], const mote_vec3 t[3]);

#ifdef __cplusplus
}
#endif
#endif
