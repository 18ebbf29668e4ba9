/* The state of a certified query: what certificate*.c share. */
#ifndef MOTE_CORE_CERTIFICATE_STATE_H
#define MOTE_CORE_CERTIFICATE_STATE_H

#include "core/certificate/certificate.h"
#include "core/certificate/certificate_hulls.h"
#include "core/certificate/certificate_memory.h"
#include "core/certificate/certificate_side.h"
#include "core/particle/refine.h"

struct mote_certificate {
    mote_certificate_options options;
    double scale; /* of both trees */
    mote_cert_side side[2];
    mote_cert_node *spare; /* [spare_room] by depth, used when node_room is not enough */
    uint32_t spare_room;
    mote_vec3 origin; /* world; the middle of the first witnesses */
    mote_refined best;
    double upper;     /* distance of best */
    double enough;    /* a contact question's tolerance, or negative */
    double slack;     /* absolute */
    double limit;     /* to be proven, in the trees' units: no pair is nearer than this */
    double noise;     /* rounding error of double precision coordinates, in the trees' units */
    float need;       /* limit, rounded up */
    double unvisited; /* smallest bound of the pairs left when the budget was spent */
    uint32_t generation;
    uint32_t restarts;
    bool done;      /* the traversal ends */
    bool improved;  /* ... because the upper bound improved */
    bool stopped;   /* the budget is spent */
    bool proven;    /* all pairs were ruled out, measured, or bounded by `unvisited` */
    bool unrefined; /* best was measured, not refined: the plane pass ends at a crossing */
    bool crossed;   /* the plane pass has ended at a crossing */
    mote_cert_memory memory;
    uint32_t direction_stamp; /* of memory.direction */
    mote_counters counters;
    uint64_t compared; /* pairs of leaves whose faces were compared one by one */
};

/* certificate_deform.c */

/* Converts the frame's pose and weights to the side's units, relative to the query's origin. */
void mote_cert_side_begin(mote_cert_side *side, const mote_body_state *state, mote_vec3 origin);

/* Sets the plane of a side: facing, and threshold as a coordinate along it. */
void mote_cert_side_face(mote_cert_side *side, mote_vec3 facing, double threshold);

/* The root of a side. */
mote_cert_node *mote_cert_root(mote_certificate *c, int s);

/* The deformed block that is child `lane` of a node. depth: of the recursion; it says which
   spare node is used where no node can be kept. */
mote_cert_node *mote_cert_child(mote_certificate *c, int s, mote_cert_node *node, size_t lane,
                                uint32_t depth);

/* Computes the boxes of a node, once a frame. */
void mote_cert_make_boxes(mote_certificate *c, int s, mote_cert_node *node);

/* certificate_leaf.c */

/* Whether leaf `lane` of a node is clear of the plane, by the cheapest test that decides.
 *reach: an upper bound on its coordinate towards the other body. */
bool mote_cert_leaf_clear(mote_certificate *c, int s, const mote_cert_node *node, size_t lane,
                          double *reach);

/* The hull of leaf `lane` of a node whose boxes have been computed, by the linear fit. */
void mote_cert_leaf_hull(const mote_cert_side *side, const mote_cert_node *node, size_t lane,
                         mote_cert_hull *hull);

/* The largest coordinate of that hull's points along a direction, without its width. The last
   result is kept; stamp identifies the direction. */
float mote_cert_leaf_reach(mote_cert_side *side, const mote_cert_node *node, size_t lane,
                           const float direction[3], uint32_t stamp);

/* Measures where the vertices of leaf `lane` are along the coordinates' axes, for a bit of
   node->unmeasured, which it clears; where the leaf is wide, also how far they are from where
   its box places them, and narrows the box to that. Returns whether the box has changed. */
bool mote_cert_narrow(mote_cert_side *side, mote_cert_node *node, size_t lane);

/* Measures child `lane` of a node of side s, and the children `undecided` of one of the other
   side, where these are unmeasured leaves; then as mote_cert_row_spans, and mote_cert_row_boxes
   where a box has changed. */
uint32_t mote_cert_narrow_row(mote_certificate *c, int s, mote_cert_node *node, size_t lane,
                              mote_cert_node *other, uint32_t undecided,
                              float bound[MOTE_CERT_WIDTH]);

/* The hull with the field evaluated in single precision; NULL where the kind of field does not
   offer that. Valid until another leaf of the side is asked for. */
const mote_cert_hull *mote_cert_leaf_near_hull(mote_cert_side *side, const mote_cert_node *node,
                                               size_t lane);

/* The hull that the last function would return if it is still kept, else NULL. */
const mote_cert_hull *mote_cert_leaf_known_hull(mote_cert_side *side,
                                                const mote_cert_node *node, size_t lane);

/* certificate_row.c */

/* The gaps between box `lane` of node d and the boxes of node e along the plane's normal.
   Returns which of them are not proven to be at least `need`. */
uint32_t mote_cert_row_plane(const mote_cert_node *d, size_t lane, const mote_cert_node *e,
                             float need, float bound[MOTE_CERT_WIDTH]);

/* The same for the lanes in `undecided`, by the boxes of both nodes; raises the bounds. */
uint32_t mote_cert_row_boxes(const mote_cert_node *d, size_t lane, const mote_cert_node *e,
                             float need, uint32_t undecided, float bound[MOTE_CERT_WIDTH]);

/* The same by low and high of both nodes, which costs less. */
uint32_t mote_cert_row_spans(const mote_cert_node *d, size_t lane, const mote_cert_node *e,
                             float need, uint32_t undecided, float bound[MOTE_CERT_WIDTH]);

/* certificate_pair.c */

/* Decides about two leaves, children `lanes` of nodes whose boxes have been computed: shows
   that they are far enough apart, or measures their faces and lowers the upper bound. */
void mote_cert_leaf_pair(mote_certificate *c, const mote_cert_node *const nodes[2],
                         const size_t lanes[2]);

/* certificate_search.c */

/* True when a side is wholly clear of the plane. */
bool mote_cert_plane_pass(mote_certificate *c, int s);

/* Traverses both trees for pairs nearer than the limit. */
void mote_cert_traverse(mote_certificate *c);

/* A pair of vertices that are near each other, by the trees alone. */
void mote_cert_descend(mote_certificate *c, uint32_t vertex[2]);

/* The child of a projected node that reaches farthest towards the other body, the first among
   equals; and how far it reaches. */
size_t mote_cert_farthest_child(const mote_cert_node *node);
float mote_cert_farthest_reach(const mote_cert_node *node);

/* certificate_apart.c */

/* For a contact question after one that showed the bodies to be apart: whether they are rigid,
   and the boxes around them at rest are apart along the direction remembered, or one found from
   it, which is then remembered. *lower: proven. */
bool mote_cert_rest_apart(mote_certificate *c, const mote_frame *frame, double *lower);

/* The same question, when that has not answered it, both sides have
   begun and the limit is set: whether the roots of both trees are apart along the direction
   remembered, or one found from it. *lower: proven, in world units; negative where they
   overlap. */
bool mote_cert_still_apart(mote_certificate *c, double *lower);

/* Keeps the direction across the gap of the best pair for the next contact question. lower:
   proven. */
void mote_cert_remember_parting(mote_certificate *c, double lower);

/* certificate_query.c */

/* Sets the upper bound, and from it the limit to be proven. */
void mote_cert_set_best(mote_certificate *c, double squared);

#endif
