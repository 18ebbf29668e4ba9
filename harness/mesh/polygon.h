/* Triangulating polygons. */
#ifndef MOTE_HARNESS_POLYGON_H
#define MOTE_HARNESS_POLYGON_H

#include "core/base/status.h"

#include <stddef.h>
#include <stdint.h>

/* Triangulates a simple polygon of `count` >= 3 corners, convex or not, by cutting off ears.
   xyz: 3 * count finite coordinates, in order around it. triangles: room for count - 2; they
   hold corner numbers from 0, have the polygon's winding, and share every diagonal. A convex
   polygon becomes a fan from its first corner.

   Works on the projection along the axis nearest to the polygon's (Newell) normal, or along
   another axis if the polygon is simple only there; all decisions are exact. Corners on a
   straight edge, repeated corners and edges that double back are allowed; the triangles there
   have no area either. A polygon thinner than a millionth of its length, or
   than what 32-bit floats of its coordinates resolve, counts as a line.

   MOTE_EINVAL: in every projection the polygon crosses or touches itself; the text names two
   edges, and what would be right. Cost O(n log n + n r) typically, where r is the number of
   corners with an inner angle of 180 degrees or more; O(n^2) at worst.

   Source: Meisters, Polygons have ears, 1975. */
mote_status mote_polygon_triangulate(const double *xyz, size_t count, uint32_t (*triangles)[3]);

#endif
