/* Time of impact among several bodies: the earliest impact of any two of them.

   A broad phase bounds each body over the whole interval, with its rotation as the arc that it
   is and its deformation by the control points of its weights, and sweeps over these boxes.
   Only pairs whose boxes come within the tolerance of each other are asked about by
   mote_impact_query; each question ends where the earliest impact so far begins. */
#ifndef MOTE_CORE_IMPACT_SCENE_H
#define MOTE_CORE_IMPACT_SCENE_H

#include "core/certificate/scene.h"
#include "core/impact/impact.h"

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

typedef struct mote_impact_scene mote_impact_scene;

/* Makes the searches for bodies of these shapes (borrowed), one for each two shapes of which
   there are bodies. shape_of[body_count]: the shape of each body, copied. options: of every
   search; length is L of the scene. MOTE_EINVAL: no shape or body, a shape that does not
   exist; else as mote_impact_create, whose memory and time a search takes; MOTE_ENOMEM. The
   caller destroys *scene; one thread at a time may use it. */
mote_status mote_impact_scene_create(const mote_body *const *shapes, uint32_t shape_count,
                                     const uint32_t *shape_of, uint32_t body_count,
                                     const mote_impact_options *options,
                                     mote_impact_scene **scene);

/* NULL is allowed. */
void mote_impact_scene_destroy(mote_impact_scene *scene);

/* Bytes of heap held now. */
size_t mote_impact_scene_bytes(const mote_impact_scene *scene);

/* Boxes of the bodies' paths [body_count] over [begin, end], boxes[body_count]: each contains
   all of its body at all of these times, as mote_path_state and mote_body_position give it.
   MOTE_EINVAL, naming the body: a path without pieces, with more than the options say or with
   another number than the others, pieces where its shape asks for positions or the reverse, a
   number in it that is not finite, positions that cannot be read, times out of order. No
   allocation. Cost O(J) a body, piece and group of vertices, of which there are at most 64; of
   a path of positions O(vertices) a piece. */
mote_status mote_impact_scene_boxes(const mote_impact_scene *scene, const mote_path *paths,
                                    double begin, double end, mote_scene_box *boxes);

/* A pair for which another tolerance holds than for the others. */
typedef struct mote_impact_exception {
    uint32_t body[2]; /* body[0] < body[1] */
    double tolerance; /* >= 0, at most that of the question; below 0: the pair is left out */
} mote_impact_exception;

/* What is asked: which two bodies first come within the tolerance in [begin, end]? */
typedef struct mote_impact_scene_question {
    const mote_path *paths; /* [body_count], all with the same number of pieces */
    double begin, end;      /* 0 <= begin <= end <= 1 */
    double tolerance;       /* >= 0, absolute */
    const mote_impact_exception *exceptions; /* [exception_count]; NULL where there are none */
    size_t exception_count;
} mote_impact_scene_question;

typedef struct mote_impact_scene_found {
    uint32_t body[2];         /* body[0] < body[1]; both 0 where there is no impact */
    mote_impact_found impact; /* of these two. All pairs but those left out are proven to be
                                 apart until impact.from */
    size_t near_pairs;        /* whose boxes come near each other */
    uint32_t iterations;      /* certified queries made, for all of them */
} mote_impact_scene_found;

/* The earliest impact of the scene; of impacts that begin at once, that of the lowest bodies.
   A pair that only grazes, or stays undecided, counts like an impact: it ends what is proven.
   MOTE_EINVAL as mote_impact_scene_boxes and mote_impact_query. Allocates only when more pairs
   are near than ever before; MOTE_ENOMEM. Cost: that of the boxes; sorting them, O(n) where
   they are nearly in the order of the last query, O(n log n) otherwise; and the pairs'. */
mote_status mote_impact_scene_query(mote_impact_scene *scene,
                                    const mote_impact_scene_question *question,
                                    mote_impact_scene_found *found);

/* Asks about one pair, body[0] < body[1], of the question's paths in [begin, end]: as
   mote_impact_query. With begin = end it tells the distance at that time. */
mote_status mote_impact_scene_pair(mote_impact_scene *scene, const mote_path *paths,
                                   const uint32_t body[2], double begin, double end,
                                   double tolerance, mote_impact_found *found);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
