/* The built-in letters: closed triangle meshes of any even number of triangles. */
#ifndef MOTE_DATASETS_LETTER_H
#define MOTE_DATASETS_LETTER_H

#include "core/body/mesh.h"
#include "core/base/status.h"

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

#define MOTE_LETTER_MIN_TRIANGLES 400
#define MOTE_LETTER_MAX_TRIANGLES 20000000

/* Makes a capital letter, 'A' to 'Z', of exactly triangle_count triangles, upright in the
   xy-plane, centred at the origin, with a bounding-box diagonal of about 1: one closed,
   manifold component, wound outward, no angle below 10 degrees, no two vertices at one place,
   every vertex on the implicit surface. The Euler characteristic is 2; 0 for A, D, O, P, Q, R,
   and -2 for B. The same bits on every machine and compiler. MOTE_EINVAL: another character, a
   count that is odd or outside MOTE_LETTER_MIN_TRIANGLES .. MOTE_LETTER_MAX_TRIANGLES.
   MOTE_ENUMERIC: one of these properties could not be reached (never seen so far). MOTE_ENOMEM.
   Cost O(triangle_count), about 5 microseconds and 110 bytes a triangle. The caller destroys
   *mesh. */
mote_status mote_letter_create(char letter, size_t triangle_count, mote_mesh **mesh);

#ifdef __cplusplus
}
#endif
#endif
