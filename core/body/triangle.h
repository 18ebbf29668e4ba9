/* Distances between points, segments and triangles: the innermost kernel of every method.

   All functions return a squared distance (the square of the input's unit of length) together
   with a pair of points that attains it, and share these properties:
   - Inputs are finite. Any of them may be degenerate: a triangle may be a segment or a point.
   - The error of the distance is a few units in the last place of the pair's extent (the larger
     of the edges and the separation); a common offset of all coordinates does not increase it.
     The square of the distance between the returned points is the returned value, to the
     rounding of the points' own coordinates.
   - There is no absolute tolerance: coordinates times 2^k give exactly the same points times
     2^k and the same value times 4^k, for magnitudes from 1e-30 to 1e30. The other properties
     hold for all that are finite: a value above the doubles is infinite, one below them but not
     0 is the least double.
   - 0 is returned exactly, with equal points, where two triangles touch or intersect, or their
     distance as computed is at most 2^-51 of their longest edge, which rounding cannot
     distinguish from touching. It has the error stated above, so that of pairs apart by about
     as little some are told to touch.
   - Swapping the arguments changes the result by rounding only. Never NaN. No allocation; any
     thread. An output pointer may be NULL. */
#ifndef MOTE_CORE_TRIANGLE_H
#define MOTE_CORE_TRIANGLE_H

#include "core/base/vec3.h"

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

/* Squared distance from p to the triangle t (its inside included); closest is the nearest
 * point. */
double mote_point_triangle(mote_vec3 p, const mote_vec3 t[3], mote_vec3 *closest);

/* Squared distance between the segments a and b; p is the nearest point on a, q on b. */
double mote_segment_segment(const mote_vec3 a[2], const mote_vec3 b[2], mote_vec3 *p,
                            mote_vec3 *q);

/* Squared distance between the triangles s and t; p is the nearest point on s, q on t. */
double mote_triangle_triangle(const mote_vec3 s[3], const mote_vec3 t[3], mote_vec3 *p,
                              mote_vec3 *q);

/* As mote_triangle_triangle where the distance is below the bound by more than its rounding
   error: of a pair whose distance is that near the bound, the two may differ, which matters
   where both are below 1e-12 of the edges. bound_squared: >= 0, may be infinite. Else it
   returns some value >= bound_squared, which is not the distance, and leaves p and q as they
   are; with a bound of 0, it may set them to a point of contact. A pair that the plane of
   either triangle or the line of centres proves to be far takes less than a quarter of the
   time. */
double mote_triangle_triangle_below(const mote_vec3 s[3], const mote_vec3 t[3],
                                    double bound_squared, mote_vec3 *p, mote_vec3 *q);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif

#endif
