/* Concave polygons whose area, outline and distance from a point are known in closed form. */
#ifndef MOTE_TESTS_POLYGONS_H
#define MOTE_TESTS_POLYGONS_H

#include <stddef.h>

#define POLYGON_CORNERS_MAX 16

typedef struct polygon_shape {
    const char *name;
    size_t count;
    double area, length;               /* of its inside, of its outline */
    double dot[2];                     /* a point in its plane, outside, in a notch */
    double distance;                   /* of the dot from it */
    double at[POLYGON_CORNERS_MAX][2]; /* counterclockwise */
} polygon_shape;

/* The star's side lengths and its dot's distance contain square roots of 5. */
#define ROOT_5 2.23606797749978969641

static const polygon_shape polygon_shapes[] = {
    {"L", 6, 3, 8, {1.5, 1.5}, 0.5, {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}},
    {"U",
     8,
     5,
     12,
     {1.5, 1.5},
     0.5,
     {{0, 0}, {3, 0}, {3, 2}, {2, 2}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}},
    {"T with corners on its straight top and foot",
     11,
     5,
     12,
     {0.5, 1.5},
     0.5,
     {{1, 0},
      {1.5, 0},
      {2, 0},
      {2, 2},
      {3, 2},
      {3, 3},
      {2, 3},
      {1, 3},
      {0, 3},
      {0, 2},
      {1, 2}}},
    {"star",
     8,
     12,
     8 * ROOT_5,
     {2, 2},
     3 / ROOT_5,
     {{3, 0}, {1, 1}, {0, 3}, {-1, 1}, {-3, 0}, {-1, -1}, {0, -3}, {1, -1}}},
    {"spiral",
     16,
     31,
     64,
     {3, 3.5},
     0.5,
     {{0, 0},
      {7, 0},
      {7, 7},
      {0, 7},
      {0, 2},
      {5, 2},
      {5, 5},
      {2, 5},
      {2, 4},
      {4, 4},
      {4, 3},
      {1, 3},
      {1, 6},
      {6, 6},
      {6, 1},
      {0, 1}}},
};
static const size_t polygon_shape_count = sizeof polygon_shapes / sizeof polygon_shapes[0];

/* Corner i of the shape when it is written from corner `start` on. `start` runs to
   2 * count - 1; from `count` on the direction is the opposite. */
static inline const double *polygon_corner(const polygon_shape *shape, size_t start, size_t i)
{
    const size_t n = shape->count;
    return start < n ? shape->at[(start + i) % n] : shape->at[(start + n - i) % n];
}

#endif
