/* The outline of a deformed body: boxes in world axes around the parts of the body that the
   upper blocks of its tree hold. It is made once a step, however many pairs a body is in, and
   shows of most pairs of bodies whose boxes are near each other that the bodies are not. */
#ifndef MOTE_CORE_CERTIFICATE_OUTLINE_H
#define MOTE_CORE_CERTIFICATE_OUTLINE_H

#include "core/certificate/certificate_shared.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Blocks of an outline, breadth first. Measured: docs/certified.md. */
#define MOTE_CERT_OUTLINE_BLOCKS 9

/* The boxes of a block's children. Where a block has fewer, the others are inside out. */
typedef struct mote_cert_outline_row {
    float low[3][MOTE_CERT_WIDTH], high[3][MOTE_CERT_WIDTH];
    uint8_t below[MOTE_CERT_WIDTH]; /* the row of a child's own children; 0: it is not opened */
    uint32_t children;
} mote_cert_outline_row;

/* Coordinates are relative to the origin, in the tree's units. */
typedef struct mote_cert_outline {
    mote_vec3 origin;                                     /* world */
    double bound;                                         /* of all terms of a coordinate */
    mote_cert_outline_row rows[MOTE_CERT_OUTLINE_BLOCKS]; /* the root's is the first */
} mote_cert_outline;

/* The outline of a body of which pose and weights are finite. Each box contains all vertices of
   its part as mote_body_position rounds them. No allocation; 0.1 us a block with 14 basis
   functions. */
void mote_cert_workspace_outline(mote_certificate *workspace, mote_cert_tree *tree,
                                 const mote_body_state *state, mote_cert_outline *outline);

/* False only where all boxes of a are more than `near` >= 0 (in units of the trees, which have
   one scale) from all of b. The same for b and a. */
bool mote_cert_outlines_near(const mote_cert_outline *a, const mote_cert_outline *b,
                             double scale, double near);

#ifdef __cplusplus
}
#endif
#endif
