/* The exact check in a neighbourhood (paper 3.4, 3.5): from a pair of vertices or triangles to
   the nearest pair of points on the faces around them, downhill, until no face around either
   point comes nearer. A local search: it visits a few rings, never the mesh. */
#ifndef MOTE_CORE_REFINE_H
#define MOTE_CORE_REFINE_H

#include "core/body/lazy.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Index 0 is body 0, index 1 is body 1. */
typedef struct mote_refined {
    double squared;          /* squared distance; 0 where the faces touch or intersect */
    mote_vec3 witness[2];    /* world points, each on its face, |w0 - w1|^2 = squared, to the
                                rounding of their coordinates */
    uint32_t triangle[2][3]; /* the face of each witness, by its vertices; one of the mesh */
    uint32_t vertex[2];      /* the vertex of that face nearest to the witness */
    uint32_t triangle_tests; /* pairs of triangles measured in this call */
    uint32_t rings;          /* rings looked at in this call */
} mote_refined;

/* Refines from one vertex of each body. lazy: the two bodies' positions at the frame; they may
   share a mesh but must be two objects. enough_squared >= 0: stops at the first pair of points
   with a squared distance of at most this (0: only where the surfaces meet); a contact question
   passes its squared tolerance.
   result->squared is at most the squared distance of the two vertices, and no pair of faces,
   one sharing a vertex with triangle[0] and the other with triangle[1], is nearer (to 1e-12
   of the distance, where it exceeds enough_squared). All tolerances are relative: coordinates
   times 2^k give the same bits times 2^k. Any length and shape of ring. Ends, since each step
   comes nearer. No allocation. About 2 microseconds when started in the right ring. */
void mote_refine_vertices(mote_lazy *const lazy[2], const uint32_t vertex[2],
                          double enough_squared, mote_refined *result);

/* The same, but pairs of faces are only looked for that are nearer than worth_squared (>= 0,
   may be infinite): a search that cannot come below it ends early, at a pair of points that is
   then no minimum. False if it ended at once, since the rings of the two vertices do not come
   near enough. For one of several starts, where a nearer pair is known already. */
bool mote_refine_below(mote_lazy *const lazy[2], const uint32_t vertex[2], double worth_squared,
                       double enough_squared, mote_refined *result);

/* The same as mote_refine_vertices from one face of each body (three vertices of a face of the
   mesh, any order): result->squared is at most the squared distance of the two faces. The
   cheapest start when the faces are the last frame's. */
void mote_refine_triangles(mote_lazy *const lazy[2], const uint32_t triangle0[3],
                           const uint32_t triangle1[3], double enough_squared,
                           mote_refined *result);

/* Comes nearer from a pair of faces of the mesh, downhill as far as projection onto the rings
   leads; what it ends at need not be a minimum. *best: squared, witness and triangle of the
   two faces' distance are given, the rest is not; it ends as such a pair again, never farther.
   Takes a fraction of the time of mote_refine_triangles. */
void mote_refine_slide(mote_lazy *const lazy[2], double enough_squared, mote_refined *best);

/* MOTE_EINVAL for a distance that is no number, or infinite: of bodies so far apart that its
   square is no double, or of positions that are not finite. */
mote_status mote_refuse_infinite(double distance);

#ifdef __cplusplus
}
#endif
#endif
