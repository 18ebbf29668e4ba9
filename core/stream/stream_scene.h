/* Several bodies of which only positions are known: streamed queries for the near pairs of a
   scene.

   Bodies of one shape share its tree. A step has three parts, as for certified scenes
   (scene.h): mote_stream_scene_bounds passes over the positions of all bodies once and gives a
   box around each; the caller finds the pairs whose boxes are near (a broad phase); and
   mote_stream_scene_query answers for these pairs. A body keeps boxes, 0.1 bytes a triangle for
   each level of a hundred triangles and more; a pair has state only while it is near. */
#ifndef MOTE_CORE_STREAM_SCENE_H
#define MOTE_CORE_STREAM_SCENE_H

#include "core/certificate/scene.h"
#include "core/stream/stream.h"

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

typedef struct mote_stream_scene mote_stream_scene;

/* Builds a tree for each of shape_count shapes; their meshes are borrowed, their fields
   are used as by mote_stream_create. shape_of[body_count]: the shape of each body, copied.
   MOTE_EINVAL: no shape or body, a shape that does not exist, options out of range;
   MOTE_ENOMEM. The caller destroys *scene; one thread at a time may use it, and with two
   threads or more no child process made by fork. Cost: about 0.5 s a million triangles of
   shapes. */
mote_status mote_stream_scene_create(const mote_body *const *shapes, uint32_t shape_count,
                                     const uint32_t *shape_of, uint32_t body_count,
                                     const mote_scene_options *options,
                                     mote_stream_scene **scene);

/* NULL is allowed. */
void mote_stream_scene_destroy(mote_stream_scene *scene);

/* Bytes of heap held now: trees, bodies, workspaces, pairs. */
size_t mote_stream_scene_bytes(const mote_stream_scene *scene);

/* Passes over the positions [body_count] of all bodies, which are borrowed until the next call,
   and writes boxes in world axes that contain them, bounds[body_count]. unchanged[body_count]
   (may be NULL: none): bodies whose positions are the same numbers as in the last call. The
   scene's threads share the bodies. MOTE_EINVAL, naming the body: as mote_stream_query. No
   allocation. */
mote_status mote_stream_scene_bounds(mote_stream_scene *scene, const mote_positions *positions,
                                     const bool *unchanged, mote_scene_box *bounds);

/* Answers for pairs[count] of the last bounds: i < j in each, ascending by i, then j, each
   once, else MOTE_EINVAL, also where two bodies are 10^18 times as far apart as the larger of L
   and their distance. Pairs that were also in the last call continue from their state; the
   state of others is dropped. MOTE_EINVAL also before the first bounds. Answers are the same
   bits for any number of threads. Allocates only when there are more pairs than ever before;
   MOTE_ENOMEM. */
mote_status mote_stream_scene_query(mote_stream_scene *scene, const uint32_t (*pairs)[2],
                                    size_t count);

/* The pairs of the last query, in its order; valid until the next one. */
const mote_scene_pair *mote_stream_scene_pairs(const mote_stream_scene *scene, size_t *count);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
