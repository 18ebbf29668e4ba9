/* On which side of a line a point of the plane lies, without rounding errors. */
#ifndef MOTE_HARNESS_ORIENTATION_H
#define MOTE_HARNESS_ORIENTATION_H

/* The sign of the area of triangle a, b, c: 1 counterclockwise, -1 clockwise, 0 if exactly
   collinear. Coordinates must be 0 or of absolute value from 2^-480 to 2^500: their products
   are then exact as sums of two doubles. Costs a few multiplications; if rounding could decide,
   about 100 additions. Method: Shewchuk, Adaptive precision floating-point arithmetic and fast
   robust geometric predicates, 1997. */
int mote_orientation(const double a[2], const double b[2], const double c[2]);

#endif
