/* What a query knows of one body: its pose and weights converted, and the blocks of its tree
   that have been deformed. */
#ifndef MOTE_CORE_CERTIFICATE_SIDE_H
#define MOTE_CORE_CERTIFICATE_SIDE_H

#include "core/body/lazy.h"
#include "core/certificate/certificate_tree.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A block deformed for this frame, relative to the query's origin, in the trees' units. The
   plane pass needs reach, extent and clear only, which take a fifth of the time of the boxes.
 */
typedef struct mote_cert_node {
    float centre[3][MOTE_CERT_WIDTH];
    float axis[3][3][MOTE_CERT_WIDTH]; /* half axes [axis][coordinate][child] */
    float width[3][MOTE_CERT_WIDTH];   /* half widths of the box to be added, margin included */
    float low[3][MOTE_CERT_WIDTH];     /* ends of the children along the coordinates' axes, */
    float high[3][MOTE_CERT_WIDTH];    /* width included; only where `spans` says so */
    float size[MOTE_CERT_WIDTH];       /* squares of the two longest half axes, added up */
    float reach[MOTE_CERT_WIDTH];      /* the box's largest coordinate towards the other body */
    float extent[MOTE_CERT_WIDTH];     /* reach minus the smallest such coordinate */
    /* reach = middle + sum |slant| + loose: the parts of the box along the plane's normal */
    float middle[MOTE_CERT_WIDTH];
    float slant[3][MOTE_CERT_WIDTH]; /* of the half axes */
    float loose[MOTE_CERT_WIDTH];    /* half width of the box to be added */
    float leaf_margin;              /* for sums over a vertex's coordinates in its leaf's box */
    int32_t child[MOTE_CERT_WIDTH]; /* index of the deformed child; -1: not deformed yet */
    const mote_cert_block *block;
    bool boxes;          /* centre .. size have been computed */
    bool spans;          /* low and high too */
    bool aligned;        /* low and high are the boxes: they say all that there is to say */
    uint32_t wide;       /* bit l: leaf l's width is worth measuring (mote_cert_narrow) */
    uint32_t unmeasured; /* bit l: low and high of leaf l are those of its box */
    uint32_t clear;      /* bit l: child l is wholly on its own side of the plane */
    uint32_t crossing;   /* bit l: child l crosses the plane by so little that it is worth
                            opening */
    uint32_t generation; /* the plane that reach, extent and clear belong to */
} mote_cert_node;

/* Approximate positions of a leaf's vertices at this frame, relative to the query's origin, in
   the trees' units: by the linear fit of the field, or by the field in single precision. In
   each coordinate a vertex is within `width` of its position here, rounding included. */
typedef struct mote_cert_hull {
    float x[3][MOTE_CERT_LEAF_VERTICES]; /* filled up with copies of the last */
    float width[3];
    uint32_t groups; /* of MOTE_CERT_WIDTH vertices */
    const mote_cert_leaf *leaf;
} mote_cert_hull;

/* Hulls of leaves kept during a query, each at its leaf's number modulo this. */
#define MOTE_CERT_HULLS 16

/* One body of a query. Its coordinate "towards the other body" is along u on body 0 and along
   -u on body 1, where u points from witness 0 to witness 1: the two bodies are then treated
   alike, and the gap between two boxes along u is -(reach + reach). */
typedef struct mote_cert_side {
    mote_cert_tree *tree;
    mote_lazy lazy;
    const mote_body_state *state;
    float rotation[3][3];
    float translation[3];
    void *frame; /* what the tree's bounds keep of the frame [frame_bytes], aligned to 64 */
    size_t frame_bytes;
    /* mote_cert_bounds.project of the tree, which is called for every block */
    void (*project)(const struct mote_cert_side *, const mote_cert_block *, mote_cert_node *);
    mote_vec3 exact_translation; /* relative to the origin, in the trees' units */
    double exact;                /* rounding error of positions in double precision */
    double bound;                /* bound on every coordinate that occurs */
    double noise;                /* rounding error of exact coordinates along a direction */
    double world;                /* size of the coordinates that pose and origin add up to */
    float margin_unit;           /* of a box's margin, as the tree's bounds make it up */
    float margin_base;
    float leaf_margin;  /* the same of mote_cert_node.leaf_margin */
    float reach_margin; /* for a reach that was computed in double precision */
    mote_vec3 facing;   /* u or -u */
    float facing_f[3];  /* the same in the rest mesh's axes */
    float facing_world[3];
    float shift;      /* translation along facing */
    double threshold; /* the plane, as a coordinate towards the other body */
    float threshold_f;
    mote_cert_hull hulls[MOTE_CERT_HULLS]; /* with the field evaluated */
    mote_cert_node *nodes;                 /* [node_room]; the root is the first */
    uint32_t node_room, node_count;
    /* the last result of mote_cert_leaf_reach: its leaf, direction and value */
    const mote_cert_leaf *reached;
    uint32_t reached_stamp;
    float reached_at;
} mote_cert_side;

#ifdef __cplusplus
}
#endif
#endif
