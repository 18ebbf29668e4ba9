/* Triangles whose vertices move on straight lines: how long they stay apart (impact_sweep.h).
 */
#ifndef MOTE_CORE_IMPACT_LEAF_H
#define MOTE_CORE_IMPACT_LEAF_H

#include "core/certificate/certificate_side.h"

/* A triangle: at the part s of the step its vertices are at p + s d. */
typedef struct mote_moving_triangle {
    mote_vec3 p[3], d[3];
} mote_moving_triangle;

/* A leaf of a tree with the motion of its vertices, coordinate by coordinate, filled up with
   copies of the last; and of its triangles the balls around their vertices, and how far they
   come along a direction. */
typedef struct mote_moving_leaf {
    uint64_t stamp; /* of the sweep that it was evaluated in */
    int32_t number;
    uint32_t vertices, triangles;
    const uint8_t (*corners)[3]; /* [triangles] */
    double part;                 /* what follows holds up to this part of the step */
    double p[3][MOTE_CERT_LEAF_VERTICES], d[3][MOTE_CERT_LEAF_VERTICES];
    double middle[3][MOTE_CERT_LEAF_TRIANGLES], moved[3][MOTE_CERT_LEAF_TRIANGLES];
    double radius[MOTE_CERT_LEAF_TRIANGLES]; /* what the vertices' own motion adds, included */
    double along[MOTE_CERT_LEAF_TRIANGLES];
    double reach; /* the largest of these */
} mote_moving_leaf;

/* Distances that are to stay above tolerance + bend s^2. apart: of length 1, the direction that
   showed it last; it usually does again, for less than a tenth of a triangle test. */
typedef struct mote_leaf_question {
    double tolerance, bend;
    mote_vec3 apart;
} mote_leaf_question;

/* Evaluates a leaf's vertices; facing: the direction of along. */
void mote_moving_leaf_load(mote_cert_side *side, mote_lazy *moved, int32_t leaf,
                           mote_vec3 facing, double part, mote_moving_leaf *out);

/* The part up to which two triangles are shown to stay apart, at most `part`. */
double mote_moving_triangles(const mote_moving_triangle *a, const mote_moving_triangle *b,
                             mote_leaf_question *question, double part, uint64_t *tests);

/* The same of all pairs of two leaves' triangles, which face each other. */
double mote_moving_leaves(const mote_moving_leaf *first, const mote_moving_leaf *second,
                          mote_leaf_question *question, double part, uint64_t *tests);

#endif
