#include "core/particle/site.h"

static mote_site edge_site(uint32_t a, uint32_t b)
{
    const mote_site site = {a < b ? a : b, a < b ? b : a, a < b ? b : a};
    return site;
}

static mote_site face_site(uint32_t a, uint32_t b, uint32_t c)
{
    const uint32_t low = a < b ? (a < c ? a : c) : (b < c ? b : c);
    const uint32_t high = a > b ? (a > c ? a : c) : (b > c ? b : c);
    const mote_site site = {low, a ^ b ^ c ^ low ^ high, high};
    return site;
}

mote_vec3 mote_site_position(mote_lazy *lazy, mote_site site)
{
    const mote_vec3 a = mote_lazy_position(lazy, site.a);
    if (site.b == site.a)
        return a;
    const mote_vec3 b = mote_lazy_position(lazy, site.b);
    if (site.c == site.b)
        return mote_scale(mote_add(a, b), 0.5);
    const mote_vec3 c = mote_lazy_position(lazy, site.c);
    return mote_scale(mote_add(mote_add(a, b), c), 1.0 / 3.0);
}

/* The entry after k of a ring of entries first .. end - 1, or UINT32_MAX when no face joins
 * them. */
static uint32_t next_entry(const mote_mesh *mesh, uint32_t first, uint32_t end, uint32_t k)
{
    if (mesh->ring[k] & MOTE_RING_END)
        return UINT32_MAX;
    return k + 1 == end ? first : k + 1;
}

static void visit_around_vertex(const mote_mesh *mesh, uint32_t v, mote_site_visitor *visit,
                                void *context)
{
    const uint32_t first = mesh->ring_start[v];
    const uint32_t end = mesh->ring_start[v + 1];
    uint32_t fan = first; /* where the current fan begins */
    for (uint32_t k = first; k < end; ++k) {
        const uint32_t u = MOTE_RING_VERTEX(mesh->ring[k]);
        const uint32_t next = next_entry(mesh, first, end, k);
        /* The end of a closed fan among several repeats its first neighbour. */
        const bool repeated = next == UINT32_MAX && u == mesh->ring[fan];
        if (!repeated) {
            visit(context, mote_site_vertex(u));
            visit(context, edge_site(v, u));
        }
        if (next == UINT32_MAX) {
            fan = k + 1;
            continue;
        }
        const uint32_t w = MOTE_RING_VERTEX(mesh->ring[next]);
        visit(context, edge_site(u, w));
        visit(context, face_site(v, u, w));
    }
}

static void visit_beside_edge(uint32_t u, uint32_t v, uint32_t w, mote_site_visitor *visit,
                              void *context)
{
    visit(context, mote_site_vertex(w));
    visit(context, edge_site(u, w));
    visit(context, edge_site(v, w));
    visit(context, face_site(u, v, w));
}

static void visit_around_edge(const mote_mesh *mesh, uint32_t u, uint32_t v,
                              mote_site_visitor *visit, void *context)
{
    visit(context, mote_site_vertex(u));
    visit(context, mote_site_vertex(v));
    const uint32_t first = mesh->ring_start[u];
    const uint32_t end = mesh->ring_start[u + 1];
    for (uint32_t k = first; k < end; ++k) {
        const uint32_t next = next_entry(mesh, first, end, k);
        if (next == UINT32_MAX)
            continue;
        const uint32_t from = MOTE_RING_VERTEX(mesh->ring[k]);
        const uint32_t to = MOTE_RING_VERTEX(mesh->ring[next]);
        if (from == v)
            visit_beside_edge(u, v, to, visit, context);
        else if (to == v)
            visit_beside_edge(u, v, from, visit, context);
    }
}

static void visit_around_face(mote_site site, mote_site_visitor *visit, void *context)
{
    visit(context, mote_site_vertex(site.a));
    visit(context, mote_site_vertex(site.b));
    visit(context, mote_site_vertex(site.c));
    visit(context, edge_site(site.a, site.b));
    visit(context, edge_site(site.a, site.c));
    visit(context, edge_site(site.b, site.c));
}

void mote_site_neighbours(const mote_mesh *mesh, mote_site site, mote_site_visitor *visit,
                          void *context)
{
    if (site.a == site.b)
        visit_around_vertex(mesh, site.a, visit, context);
    else if (site.b == site.c)
        visit_around_edge(mesh, site.a, site.b, visit, context);
    else
        visit_around_face(site, visit, context);
}
