/* How a kind of field bounds what lies in a box of the rest tree, once the field has deformed
   it. The certificate's other files do not know kinds of fields: they ask the tree's bounds.
   Most fields need none of their own: certificate_fitted.h bounds any field by linear fits of
   its basis functions. A kind that knows more about its functions names its own in
   mote_field_kind.bounds.

   While a tree is built, start is called once; then for each block fit for every child in turn
   and store once; then stop. In a query begin is called for each frame, face for each plane,
   and the others for each block or leaf that is looked at. All of these hold for every vertex,
   and include margins for the rounding of their own operations and for that of the positions in
   double precision that mote_body_position gives (docs/architecture.md, "The margins"). None of
   a query's functions allocates. Lengths are relative to the query's origin, in the tree's
   units. */
#ifndef MOTE_CORE_CERTIFICATE_BOUNDS_H
#define MOTE_CORE_CERTIFICATE_BOUNDS_H

#include "core/certificate/certificate_box.h"
#include "core/certificate/certificate_side.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A child of a block that is being built. */
typedef struct mote_cert_part {
    size_t lane;              /* its place in the block */
    const uint32_t *vertices; /* [count], each once */
    size_t count;
    const mote_cert_box *box; /* around them at rest */
    uint32_t leaves;          /* bit l: child l of the block is a leaf */
} mote_cert_part;

typedef struct mote_cert_bounds {
    const char *name;

    /* Sets tree->fixed (one block of fixed_bytes, which the tree frees) if the kind keeps
       anything for the tree as a whole, and makes what fit needs. linear_fits: as in
       mote_cert_tree_options. MOTE_EINVAL where the field was made for another mesh than the
       body's; MOTE_ENOMEM. stop is called only after success. */
    mote_status (*start)(mote_cert_tree *tree, bool linear_fits, void **fitter);

    /* Bounds one child of the block that is being built. */
    void (*fit)(void *fitter, mote_cert_tree *tree, const mote_cert_part *part);

    /* Keeps the bounds of the block's children in the tree (mote_cert_tree_keep), and forgets
       them for the next block. MOTE_ENOMEM. */
    mote_status (*store)(void *fitter, mote_cert_tree *tree, mote_cert_block *block);

    void (*stop)(void *fitter);

    /* Bytes that a side needs for a frame (side->frame, aligned to 64). */
    size_t (*frame_bytes)(const mote_cert_tree *tree);

    /* Converts the frame's weights; sets side->bound, exact and the margins. Pose and
       origin are already set in the side. */
    void (*begin)(mote_cert_side *side);

    /* Converts the weights to their parts along the plane's normal; facing is set in the side.
     */
    void (*face)(mote_cert_side *side);

    /* The boxes of a block along the plane's normal: calls mote_cert_project_lane for each lane
       (certificate_project.h), sets leaf_margin, and calls mote_cert_finish_projection. */
    void (*project)(const mote_cert_side *side, const mote_cert_block *block,
                    mote_cert_node *node);

    /* The boxes of a block: writes centre, axis and width of the node and calls
       mote_cert_finish_boxes. May write low and high too and set spans, then also aligned and
       unmeasured, and wide where `hull` is offered. */
    void (*boxes)(const mote_cert_side *side, const mote_cert_block *block,
                  mote_cert_node *node);

    /* Positions of a leaf's vertices by the field in single precision; hull->leaf and groups
       are set. False where that is not offered. */
    bool (*hull)(const mote_cert_side *side, const mote_cert_node *node, size_t lane,
                 mote_cert_hull *hull);
} mote_cert_bounds;

#ifdef __cplusplus
}
#endif
#endif
