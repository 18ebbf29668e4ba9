/* Two readings of one surface. */
#ifndef MOTE_TESTS_READERS_COMPARE_H
#define MOTE_TESTS_READERS_COMPARE_H

#include "core/base/vec3.h"

#include <stdbool.h>
#include <stddef.h>

/* Triangles, three places each. */
typedef struct surface {
    mote_vec3 *at; /* [3 * count] */
    size_t count, capacity;
} surface;

void surface_add(surface *s, mote_vec3 a, mote_vec3 b, mote_vec3 c);
void surface_free(surface *s);

/* Differences of a surface from another, and how large they may be after coordinates went
   through 32-bit floats and with faces as thick as given. */
typedef struct difference {
    double size; /* L, the diagonal of the first surface's box */
    double area[2], area_allowed;
    double volume[2], volume_allowed; /* signed, seen from the middle of the first box */
    double bounds;                    /* of any of the six */
    double there, back;               /* farthest point of one from the other */
    double length_allowed;            /* for bounds and distances */
} difference;

/* Compares at the corners, edge midpoints and centroid of every triangle. Both surfaces have
   triangles. */
difference surface_compare(const surface *ours, const surface *theirs, double thickness);

bool difference_is_rounding(const difference *d);

#endif
