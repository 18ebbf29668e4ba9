/* Several bodies (paper section 6): certified queries for the near pairs of a scene.

   Bodies of one shape share its rest mesh, its field and one tree; a body of its own is only a
   pose and weights, which the caller keeps. A pair has state only while it is near. Memory
   grows with the shapes and the near pairs, not with the bodies times their triangles.

   A step has four parts: mote_scene_bounds gives a box around each body without touching a
   vertex; the caller finds the pairs whose boxes are near (a broad phase: baselines/
   broad_phase.h wraps FCL's); mote_scene_sift leaves out most of those that are not near; and
   mote_scene_query answers for the others. */
#ifndef MOTE_CORE_SCENE_H
#define MOTE_CORE_SCENE_H

#include "core/method/method.h"

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

typedef struct mote_scene mote_scene;

typedef struct mote_scene_options {
    mote_ask ask;
    double tolerance; /* absolute, >= 0, finite: contact is distance <= tolerance */
    uint32_t threads; /* 1 .. 256, which share the bounds and pairs among them */
} mote_scene_options;

/* The distance, tolerance 0, one thread. */
mote_scene_options mote_default_scene_options(void);

/* A box in world axes. */
typedef struct mote_scene_box {
    mote_vec3 low, high;
} mote_scene_box;

/* Compares pairs of bodies by the first body, then by the second: < 0, 0 or > 0 where a comes
   before b, is the same, or comes after it. */
static inline int mote_pair_order(const uint32_t a[2], const uint32_t b[2])
{
    if (a[0] != b[0])
        return a[0] < b[0] ? -1 : 1;
    return a[1] < b[1] ? -1 : a[1] > b[1];
}

/* The answer for a near pair. */
typedef struct mote_scene_pair {
    uint32_t body[2]; /* body[0] < body[1] */
    uint32_t steps;   /* for how many steps it has been near, up to and including this one */
    bool contact;     /* distance <= tolerance, exactly where that is decided */
    bool decided;     /* always, but where coordinates from 2.8e17 L on (certificate.h) leave a
                         bracket around the tolerance: lower <= tolerance < distance */
    double distance;  /* of the witnesses; with MOTE_ASK_CONTACT, and from there on, an upper
                         bound */
    double lower;     /* proven, <= distance */
    mote_vec3 witness[2]; /* world points on the two bodies */
    mote_counters counters;
} mote_scene_pair;

/* Builds a tree for each of shape_count shapes (borrowed). shape_of[body_count]: the shape
   of each body, copied. MOTE_EINVAL: no shape or body, a shape that does not exist,
   options out of range, and as mote_certificate_create; MOTE_EUNSUPPORTED, as that;
   MOTE_ENOMEM. The caller destroys *scene; one thread at a time may use it, and with two
   threads or more no child process made by fork. Cost: about 0.5 s a million triangles of
   shapes. */
mote_status mote_scene_create(const mote_body *const *shapes, uint32_t shape_count,
                              const uint32_t *shape_of, uint32_t body_count,
                              const mote_scene_options *options, mote_scene **scene);

/* NULL is allowed. */
void mote_scene_destroy(mote_scene *scene);

/* Bytes of heap held now: trees, workspaces, pairs. */
size_t mote_scene_bytes(const mote_scene *scene);

/* L of the scene: the largest rest L of its shapes. */
double mote_scene_length(const mote_scene *scene);

/* Boxes of all bodies, bounds[body_count], from the roots of their trees deformed by states
   [body_count]: each contains all vertices of its body as mote_body_position gives them.
   MOTE_EINVAL, naming the body, where a pose or a weight is not finite, or so large that
   the box is not. No allocation. About
   0.2 us a body. */
mote_status mote_scene_bounds(mote_scene *scene, const mote_body_state *states,
                              mote_scene_box *bounds);

/* The same for body i < body_count alone. */
mote_status mote_scene_bounds_of(mote_scene *scene, uint32_t i, const mote_body_state *state,
                                 mote_scene_box *bounds);

/* Of pairs[count], given as to mote_scene_query, *kept[*kept_count] are those that may be at
   most `near` >= 0 (absolute; infinity: all) apart, in the same order: boxes around the parts
   of a body show of most others, whose boxes are near each other, that they are farther apart.
   Every pair at most `near` apart is among them. States as mote_scene_bounds finds them finite.
   *kept is valid until the next call, and as long as pairs is. MOTE_EINVAL; MOTE_ENOMEM.
   Allocates only when there are more pairs, or bodies in pairs, than ever before. About 1 us
   for each body in a pair and 0.2 us a pair; of letters in a dense box, two pairs in five are
   kept. */
mote_status mote_scene_sift(mote_scene *scene, const mote_body_state *states, double near,
                            const uint32_t (*pairs)[2], size_t count,
                            const uint32_t (**kept)[2], size_t *kept_count);

/* Answers for pairs[count]: i < j in each, ascending by i, then j, each once, else MOTE_EINVAL.
   The states' numbers must be finite; mote_scene_bounds checks them. Pairs that were also in
   the last call continue from their state; the state of others is dropped. Answers are the same
   bits for any number of threads. Allocates only when there are more pairs than ever before; on
   MOTE_ENOMEM all states are kept. */
mote_status mote_scene_query(mote_scene *scene, const mote_body_state *states,
                             const uint32_t (*pairs)[2], size_t count);

/* The pairs of the last query, in its order; valid until the next one. */
const mote_scene_pair *mote_scene_pairs(const mote_scene *scene, size_t *count);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
