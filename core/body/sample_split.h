/* Where to split a set of triangles so that the boxes of both parts stay small in several poses
   of a body: the surface area heuristic, averaged over poses (T-SAH: Bittner and Meister,
   "T-SAH: Animation optimized bounding volume hierarchies", 2015). Trees with build=samples are
   made with it; a tree made at rest is split where triangles lie then, and its boxes grow where
   they part later. */
#ifndef MOTE_CORE_SAMPLE_SPLIT_H
#define MOTE_CORE_SAMPLE_SPLIT_H

#include "core/body/body.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The parameter that methods with such trees have in common. */
#define MOTE_BUILD_CHOICES "rest|samples"
#define MOTE_BUILD_HELP                                                                        \
    "splits of the tree: by the rest pose, or by it and sample poses of the motion (T-SAH)"

/* Poses that are looked at: rest and at most eight samples, evenly drawn from the body's. */
#define MOTE_SAMPLE_POSES_MAX 9

/* Low and high corner of a triangle's box, relative to the middle of the rest box, in rest
   diagonals. */
typedef struct mote_sample_box {
    float low[3], high[3];
} mote_sample_box;

typedef struct mote_sample_boxes {
    uint32_t poses, triangles;
    mote_sample_box *box; /* [poses][triangles] */
} mote_sample_boxes;

/* Boxes of all triangles at rest and in the body's sample poses. MOTE_ENOMEM. Free with
   mote_sample_boxes_free, also after a failure. Cost O(poses * (v J + t)). */
mote_status mote_sample_boxes_init(mote_sample_boxes *boxes, const mote_body *body);
void mote_sample_boxes_free(mote_sample_boxes *boxes);

/* Triangles whose key in `pose` along `axis` is below `at` are on the left. */
typedef struct mote_sample_split {
    uint32_t pose;
    int axis;
    float at;
} mote_sample_split;

/* Twice the middle of a triangle's box: what splits compare. */
static inline float mote_sample_key(const mote_sample_boxes *boxes, uint32_t pose, int axis,
                                    uint32_t triangle)
{
    const mote_sample_box *b = &boxes->box[(size_t)pose * boxes->triangles + triangle];
    return b->low[axis] + b->high[axis];
}

/* The split of least average cost. left: how many of the triangles will go left, so that only
   pose and axis are to be chosen (at is then a guess); 0: any number between an eighth and
   seven eighths. Large sets are judged by some of their triangles. Where no split parts them,
   that of pose 0, axis 0 at -infinity. count >= 2. No allocation. Cost O(poses^2): a whole
   tree of 12,000 triangles takes 0.1 (leaves of eight) to 0.2 s with nine poses. */
mote_sample_split mote_sample_split_best(const mote_sample_boxes *boxes,
                                         const uint32_t *triangles, uint32_t count,
                                         uint32_t left);

#ifdef __cplusplus
}
#endif
#endif
