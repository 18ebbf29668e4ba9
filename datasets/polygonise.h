/* Surface nets of a letter: one vertex in each grid cell that the surface crosses, one quad
   (two triangles) for each grid edge that it crosses. */
#ifndef MOTE_DATASETS_POLYGONISE_H
#define MOTE_DATASETS_POLYGONISE_H

#include "datasets/glyph.h"
#include "datasets/surface.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Makes a closed surface of at least triangle_count triangles: about that many where the
   letter's strokes are at least six cells wide, otherwise more. Vertices are on the glyph's
   surface, triangles are wound outward. MOTE_ENOMEM. Cost O(triangle_count). The caller clears
   *surface. Source: S. Gibson, Constrained elastic surface nets, 1998. */
mote_status mote_polygonise(const mote_glyph *glyph, size_t triangle_count,
                            mote_surface *surface);

#ifdef __cplusplus
}
#endif
#endif
