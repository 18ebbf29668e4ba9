/* Brings a letter's surface to an exact number of well-shaped triangles. Vertices stay on the
   glyph's surface; closedness, manifoldness and the Euler characteristic do not change. */
#ifndef MOTE_DATASETS_REMESH_H
#define MOTE_DATASETS_REMESH_H

#include "datasets/glyph.h"
#include "datasets/surface.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Collapses short edges, shortest first, until triangle_count (even, at most the live count)
   triangles are left, and compacts. MOTE_ENUMERIC when no further edge may be collapsed;
   MOTE_ENOMEM. Cost O(n) for a fixed ratio of the counts. */
mote_status mote_simplify(const mote_glyph *glyph, size_t triangle_count,
                          mote_surface *surface);

/* One sweep of edge flips that enlarge the smallest of the two triangles' angles. */
void mote_relax_flip(mote_surface *surface);

/* One sweep that moves each vertex towards the middle of its neighbours, along the surface. */
void mote_relax_smooth(const mote_glyph *glyph, mote_surface *surface);

/* One sweep over the triangles with an angle below the bound: moves their vertices or flips
   their edges where that enlarges the smallest angle around. Returns how many such triangles it
   found. `sine_square` is the square of the bound's sine. */
size_t mote_relax_worst(const mote_glyph *glyph, double sine_square, mote_surface *surface);

#ifdef __cplusplus
}
#endif
#endif
