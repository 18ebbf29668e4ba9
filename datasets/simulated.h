/* Bodies that a small simulation of ours deforms, frame by frame. A method is told their
   positions only, and no field. The letter that they fall on lies flat about the origin (its
   strokes in the xy-plane); gravity pulls along -z. Lengths are in L of that letter. */
#ifndef MOTE_DATASETS_SIMULATED_H
#define MOTE_DATASETS_SIMULATED_H

#include "core/body/mesh.h"

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

#define MOTE_SIMULATED_MIN_TRIANGLES 800
#define MOTE_SIMULATED_MAX_TRIANGLES 20000000

/* The letter that lies there. */
#define MOTE_SIMULATED_LETTER 'W'

/* The same bits on every machine and compiler: no operation but + - * / and square roots, in a
   fixed order, in one thread. */
typedef struct mote_simulated_body {
    const char *name;    /* as on the command line */
    const char *summary; /* one line */

    /* Makes a body of about triangle_count triangles, MOTE_SIMULATED_MIN_TRIANGLES ..
       MOTE_SIMULATED_MAX_TRIANGLES, as it is at frame 1. MOTE_EINVAL, MOTE_ENOMEM. The caller
       destroys both; the mesh must outlive the state. */
    mote_status (*create)(size_t triangle_count, mote_mesh **mesh, void **state);
    void (*destroy)(void *state); /* NULL is allowed */

    /* Moves on by one frame, and writes positions[vertex_count]. No allocation. */
    void (*step)(void *state, mote_vec3 *positions);
} mote_simulated_body;

extern const mote_simulated_body mote_simulated_cloth, mote_simulated_banner,
    mote_simulated_jelly;

/* All of them, ended by NULL; the one of that name, or NULL. */
extern const mote_simulated_body *const mote_simulated_list[];
const mote_simulated_body *mote_simulated_find(const char *name);

/* MOTE_EINVAL where the number of triangles is out of range. */
mote_status mote_simulated_check(const mote_simulated_body *kind, size_t triangle_count);

#ifdef __cplusplus
}
#endif
#endif
