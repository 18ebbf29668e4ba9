/* Triangles, segments and points whose coordinates are so small or so large that products of
   their lengths leave the range of doubles: they are measured times a power of two, which keeps
   their bits. Used by triangle.c alone. */
#ifndef MOTE_CORE_TRIANGLE_SCALE_H
#define MOTE_CORE_TRIANGLE_SCALE_H

#include "core/base/vec3.h"

/* The power of two to scale two sets of points by; 0: they are measured as they are, also where
   all are 0 or one is not finite. */
int mote_triangle_power(const mote_vec3 *a, int a_count, const mote_vec3 *b, int b_count);

void mote_scale_points(const mote_vec3 *points, int count, int power, mote_vec3 *to);

/* The point and the squared distance before they were scaled. to may be NULL. A squared
   distance too small for a double is the least, since 0 means a contact. */
void mote_unscale_point(mote_vec3 point, int power, mote_vec3 *to);
double mote_unscaled_squared(double squared, int power);

#endif
