/* Two leaves as sets of points in single precision: whether a direction separates them, and
   which of their faces may be near. Nothing here knows where the points come from. Lengths are
   relative to the query's origin, in the trees' units.

   Every test is one-sided: what is ruled out is at least `need` apart for any positions within
   `loose` of the points in each coordinate, and loose covers the rounding of the sums here too:
   about 9 u B along a direction of length 1, where u = 2^-24 and B bounds the length of each
   point's vector. */
#ifndef MOTE_CORE_CERTIFICATE_HULLS_H
#define MOTE_CORE_CERTIFICATE_HULLS_H

#include "core/base/bits.h"
#include "core/base/clones.h"
#include "core/certificate/certificate_tree.h"

#include <float.h>
#include <math.h>

/* The largest of eight, in a fixed order. */
MOTE_INLINE float mote_cert_largest(const float x[MOTE_CERT_WIDTH])
{
    float four[4], two[2];
    MOTE_LANE_LOOP
    for (size_t l = 0; l < 4; ++l)
        four[l] = x[l] > x[l + 4] ? x[l] : x[l + 4];
    MOTE_LANE_LOOP
    for (size_t l = 0; l < 2; ++l)
        two[l] = four[l] > four[l + 2] ? four[l] : four[l + 2];
    return two[0] > two[1] ? two[0] : two[1];
}

/* A leaf's points and faces. */
typedef struct mote_cert_points {
    const float *x[3];           /* [groups * MOTE_CERT_WIDTH], filled up with copies */
    uint32_t groups;             /* at least 1 */
    const uint8_t (*corners)[3]; /* [faces]: places of each face's corners in x */
    uint32_t faces;              /* 1 .. MOTE_CERT_LEAF_TRIANGLES */
} mote_cert_points;

/* Points of any leaf, at most: of separate triangles. */
#define MOTE_CERT_POINTS (3 * MOTE_CERT_LEAF_TRIANGLES)

typedef struct mote_cert_hulls {
    mote_cert_points leaf[2];
    float loose[3];   /* by how much a difference of a point of each may be wrong */
    float nearest[3]; /* about the direction from the first to the second at their nearest */
} mote_cert_hulls;

/* Pairs of faces that may be near: bit k of undecided[i] stands for face i of the first leaf
   and face k of the second. */
typedef struct mote_cert_near {
    uint32_t used; /* bit i: undecided[i] is not 0 */
    uint32_t undecided[MOTE_CERT_LEAF_TRIANGLES];
} mote_cert_near;

/* A shorter vector is not used as a direction, since its squared length loses bits as a float,
   and a zero vector separates nothing. Where hulls intersect, the search ends at such vectors.
 */
#define MOTE_CERT_SHORTEST_SQUARED 0x1p-100F

/* Whether a gap along a vector is at least need times its length. False where the squares leave
   the range of floats, from 10^9 L on. */
static inline bool mote_cert_far_enough(float gap, float need, float length_squared)
{
    return gap > 0 && length_squared >= MOTE_CERT_SHORTEST_SQUARED && gap * gap <= FLT_MAX &&
           gap * gap >= need * need * (1 + 0x1p-18F) * length_squared;
}

/* Whether two leaves are `need` apart along a direction. */
bool mote_cert_hulls_along(const mote_cert_hulls *pair, const float direction[3], float need);

/* Searches from pair->nearest for a direction along which two leaves are `need` apart; true
   where it has become one. */
bool mote_cert_hulls_search(mote_cert_hulls *pair, float need);

/* The pairs of faces that may be nearer than `need`. facing points from the first body to the
   second, or is 0. */
void mote_cert_hulls_near(const mote_cert_hulls *pair, float need, const float facing[3],
                          mote_cert_near *near);

/* Drops the pairs that are `need` apart along pair->nearest. */
void mote_cert_hulls_drop(const mote_cert_hulls *pair, float need, mote_cert_near *left);

/* Of the pairs in `left`, those that may be nearer than `need`: each is tested by itself, along
   the normals of its faces too. */
void mote_cert_hulls_test(const mote_cert_hulls *pair, float need, const mote_cert_near *left,
                          mote_cert_near *near);

/* certificate_triangles.c */

/* The largest coordinate of each face of a leaf along a direction. */
typedef struct mote_cert_reaches {
    float reach[MOTE_CERT_LEAF_TRIANGLES]; /* padded with -FLT_MAX */
    float farthest;
    size_t lanes; /* in use: a multiple of 8 */
} mote_cert_reaches;

void mote_cert_reach_faces(const mote_cert_points *leaf, const float direction[3],
                           mote_cert_reaches *reaches);

/* Bit i: face i has a reach above `least`. */
uint32_t mote_cert_reaching(const mote_cert_reaches *reaches, float least);

/* Faces in lanes: twice the width of boxes, since each step of the search for their distance
   waits for the one before. */
#define MOTE_CERT_FACE_LANES 16

typedef struct mote_cert_face_lanes {
    float corner[3][3][MOTE_CERT_FACE_LANES]; /* [corner][coordinate][lane] */
} mote_cert_face_lanes;

/* Loads the corners of count faces of a leaf, 1 to MOTE_CERT_FACE_LANES, given by their
   numbers, and fills up with copies of the first. */
void mote_cert_load_faces(const mote_cert_points *leaf, const uint8_t *faces, uint32_t count,
                          mote_cert_face_lanes *lanes);

/* Which of the lanes in `undecided` are not proven to be at least `need` apart. loose: by how
   much a difference of two corners may be wrong in each coordinate. */
uint32_t mote_cert_near_pairs(const mote_cert_face_lanes *s, const mote_cert_face_lanes *t,
                              uint32_t undecided, float need, const float loose[3]);

/* Likewise, along the normals of both faces: where a corner of one is nearest to the inside of
   the other, as in a sheet that lies on a body, these show their distance exactly. */
uint32_t mote_cert_near_along_normals(const mote_cert_face_lanes *s,
                                      const mote_cert_face_lanes *t, uint32_t undecided,
                                      float need, const float loose[3]);

#endif
