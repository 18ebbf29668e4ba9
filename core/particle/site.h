/* Places on a surface where a particle can be (paper 3.4): vertices; in the generalised form
   edge midpoints and face centroids too. */
#ifndef MOTE_CORE_SITE_H
#define MOTE_CORE_SITE_H

#include "core/body/lazy.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A vertex is (a, a, a), an edge midpoint (a, b, b) with a < b, a face centroid (a, b, c) with
   a < b < c. */
typedef struct mote_site {
    uint32_t a, b, c;
} mote_site;

static inline mote_site mote_site_vertex(uint32_t vertex)
{
    const mote_site site = {vertex, vertex, vertex};
    return site;
}

/* Order by a, then b, then c: decides ties. */
static inline bool mote_site_before(mote_site s, mote_site t)
{
    if (s.a != t.a)
        return s.a < t.a;
    return s.b != t.b ? s.b < t.b : s.c < t.c;
}

static inline bool mote_site_equal(mote_site s, mote_site t)
{
    return s.a == t.a && s.b == t.b && s.c == t.c;
}

/* World position: the vertex, the mean of two or of three vertices. */
mote_vec3 mote_site_position(mote_lazy *lazy, mote_site site);

typedef void mote_site_visitor(void *context, mote_site site);

/* Calls visit for every other site of the faces that contain the site, each once (vertices,
   midpoints and centroids). Cost: the number of faces at its vertices. */
void mote_site_neighbours(const mote_mesh *mesh, mote_site site, mote_site_visitor *visit,
                          void *context);

#ifdef __cplusplus
}
#endif
#endif
