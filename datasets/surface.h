/* A closed triangle surface whose connectivity can be edited: a corner table. Corner 3 t + k is
   vertex k of triangle t. Used while a letter is made; the finished mesh is a mote_mesh. */
#ifndef MOTE_DATASETS_SURFACE_H
#define MOTE_DATASETS_SURFACE_H

#include "core/base/status.h"
#include "core/base/vec3.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define MOTE_NO_CORNER UINT32_MAX
/* The most neighbours of a vertex that the editing functions allow. */
#define MOTE_MAX_VALENCE 64

typedef struct mote_surface {
    size_t vertex_slots;   /* removed ones included */
    size_t triangle_slots; /* removed ones included */
    size_t live_triangles;
    mote_vec3 *positions; /* [vertex_slots] */
    uint32_t *vertex;     /* [3 * triangle_slots]; MOTE_NO_CORNER in removed triangles */
    uint32_t *opposite;   /* [3 * triangle_slots]; the corner across the edge opposite */
    uint32_t
        *at_vertex; /* [vertex_slots], one corner of each vertex, MOTE_NO_CORNER if removed */
} mote_surface;

static inline uint32_t mote_corner_next(uint32_t corner)
{
    return corner % 3 == 2 ? corner - 2 : corner + 1;
}

static inline uint32_t mote_corner_previous(uint32_t corner)
{
    return corner % 3 == 0 ? corner + 2 : corner - 1;
}

/* The next corner at the same vertex, counter-clockwise seen from outside. */
static inline uint32_t mote_corner_swing(const mote_surface *s, uint32_t corner)
{
    return mote_corner_next(s->opposite[mote_corner_next(corner)]);
}

/* Takes ownership of positions and vertex (both from malloc; freed on failure too) and links
   the corners. Every edge must have two triangles, consistently wound: MOTE_EINVAL otherwise;
   MOTE_ENOMEM. O(n). */
mote_status mote_surface_link(mote_vec3 *positions, size_t vertex_count, uint32_t *vertex,
                              size_t triangle_count, mote_surface *surface);

/* Frees what the surface holds and clears it. */
void mote_surface_clear(mote_surface *surface);

/* Writes the neighbours of v counter-clockwise, and returns how many (MOTE_MAX_VALENCE + 1 when
   there are more than fit). */
size_t mote_surface_ring(const mote_surface *surface, uint32_t v,
                         uint32_t ring[MOTE_MAX_VALENCE]);

/* Whether u and v share an edge. */
bool mote_surface_adjacent(const mote_surface *surface, uint32_t u, uint32_t v);

/* Flips the edge opposite the corner; the two vertices across it must not be adjacent. */
void mote_surface_flip(mote_surface *surface, uint32_t corner);

/* Merges the edge opposite the corner into its first vertex, vertex[next(corner)], which keeps
   its position; removes two triangles. The edge must meet the link condition. */
void mote_surface_collapse(mote_surface *surface, uint32_t corner);

/* Removes the unused slots that collapses left in the arrays; keeps the order. */
mote_status mote_surface_compact(mote_surface *surface);

/* Twice the area times the normal of triangle t. */
mote_vec3 mote_surface_normal(const mote_surface *surface, size_t t);

/* Square of the sine of the smallest angle of a triangle: 3/4 at best, 0 when degenerate. */
double mote_triangle_quality(mote_vec3 a, mote_vec3 b, mote_vec3 c);

#ifdef __cplusplus
}
#endif
#endif
