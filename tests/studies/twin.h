/* A scene changed in a way that must not change its distance, or only by a known factor: the
   twin of a scene of shapes.h, kept in step with it frame by frame. */
#ifndef MOTE_TESTS_TWIN_H
#define MOTE_TESTS_TWIN_H

#include "tests/support/shapes.h"

/* What differs; zero means no change. */
typedef struct twin_change {
    int exponent;  /* everything is 2^exponent times as large */
    bool swap;     /* bodies 0 and 1 change places */
    bool permute;  /* vertices and faces in another order */
    bool flip;     /* half of the faces wound the other way */
    bool move;     /* both bodies moved by one rigid motion, another one each frame */
    bool refine;   /* each face cut into four at the middles of its edges: static fields only */
    uint64_t seed; /* of the order, the faces and the motions */
} twin_change;

/* Makes the twin of base, which must not have a frame yet. Free with scene_free. */
void twin_init(const scene *base, const twin_change *change, scene *twin);

/* Gives the twin the current frame of base. */
void twin_follow(const scene *base, const twin_change *change, scene *twin);

#endif
