#include "core/body/mesh_ring.h"

#include <stdlib.h>
#include <string.h>

/* Working memory for ordering one ring. Each face at the centre joins two of its neighbours, so
   that the faces form chains (open fans) and cycles (closed fans) of neighbours. */
typedef struct ring_scratch {
    uint32_t *first_face; /* [v + 1] start of the faces of a vertex in face_of */
    uint32_t *face_of;    /* [3 t] */
    uint32_t (*link)[2];  /* [v] up to two neighbours joined to a neighbour, or NONE */
    uint32_t *used;       /* [v] faces seen at this neighbour, while a ring is built */
} ring_scratch;

#define NONE UINT32_MAX

static void scratch_free(ring_scratch *s)
{
    free(s->first_face);
    free(s->face_of);
    free(s->link);
    free(s->used);
}

static mote_status scratch_create(ring_scratch *s, const mote_mesh *mesh)
{
    const size_t n = mesh->vertex_count;
    s->first_face = calloc(n + 1, sizeof *s->first_face);
    s->face_of = malloc((size_t)3 * mesh->triangle_count * sizeof *s->face_of);
    s->link = malloc(n * sizeof *s->link);
    s->used = calloc(n, sizeof *s->used);
    if (s->first_face && s->face_of && s->link && s->used)
        return MOTE_OK;
    scratch_free(s);
    return mote_fail(MOTE_ENOMEM, "no memory for the adjacency of %zu vertices", n);
}

/* Sorts the faces by vertex (counting sort, faces in input order at each vertex). */
static mote_status sort_faces(ring_scratch *s, const mote_mesh *mesh)
{
    for (uint32_t f = 0; f < mesh->triangle_count; ++f) {
        for (int k = 0; k < 3; ++k)
            ++s->first_face[mesh->triangles[f][k]];
    }
    uint32_t sum = 0;
    for (uint32_t v = 0; v < mesh->vertex_count; ++v) {
        if (s->first_face[v] == 0)
            return mote_fail(MOTE_EINVAL,
                             "vertex %u belongs to no face; leave it out or use it", v);
        sum += s->first_face[v];
        s->first_face[v] = sum;
    }
    s->first_face[mesh->vertex_count] = sum;
    for (uint32_t f = mesh->triangle_count; f-- > 0;) {
        for (int k = 3; k-- > 0;)
            s->face_of[--s->first_face[mesh->triangles[f][k]]] = f;
    }
    return MOTE_OK;
}

static int corner_of(const uint32_t triangle[3], uint32_t vertex)
{
    return triangle[0] == vertex ? 0 : triangle[1] == vertex ? 1 : 2;
}

static mote_status join(ring_scratch *s, uint32_t centre, uint32_t from, uint32_t to)
{
    if (s->used[from] == 0)
        s->link[from][0] = s->link[from][1] = NONE;
    if (s->used[from] == 2)
        return mote_fail(MOTE_EINVAL,
                         "edge %u-%u has more than two faces (non-manifold); every "
                         "edge may have one or two",
                         centre < from ? centre : from, centre < from ? from : centre);
    s->link[from][s->used[from]++] = to;
    return MOTE_OK;
}

static mote_status link_neighbours(ring_scratch *s, const mote_mesh *mesh, uint32_t v)
{
    for (uint32_t i = s->first_face[v]; i < s->first_face[v + 1]; ++i) {
        const uint32_t *t = mesh->triangles[s->face_of[i]];
        const int k = corner_of(t, v);
        const uint32_t a = t[(k + 1) % 3];
        const uint32_t b = t[(k + 2) % 3];
        mote_status status = join(s, v, a, b);
        if (status == MOTE_OK)
            status = join(s, v, b, a);
        if (status != MOTE_OK)
            return status;
    }
    return MOTE_OK;
}

/* Removes the link from -> to, so that each face is visited once. */
static void unlink_one(ring_scratch *s, uint32_t from, uint32_t to)
{
    const int k = s->link[from][0] == to ? 0 : 1;
    s->link[from][k] = s->link[from][1];
    s->link[from][1] = NONE;
    --s->used[from];
}

/* Walks one fan from start and appends it; the first step goes to link[start][0]. Returns its
   number of entries, the last being the start again when the fan is closed. */
static uint32_t walk_fan(ring_scratch *s, uint32_t start, uint32_t *out)
{
    uint32_t count = 0;
    uint32_t at = start;
    out[count++] = at;
    while (s->used[at] > 0) {
        const uint32_t next = s->link[at][0];
        unlink_one(s, at, next);
        unlink_one(s, next, at);
        at = next;
        out[count++] = at;
    }
    return count;
}

/* Appends the ring of v to out, open fans first; returns its length. */
static uint32_t order_ring(ring_scratch *s, mote_mesh *mesh, uint32_t v, uint32_t *out)
{
    uint32_t count = 0;
    uint32_t fans = 0;
    for (uint32_t wanted = 1; wanted <= 2; ++wanted) {
        for (uint32_t i = s->first_face[v]; i < s->first_face[v + 1]; ++i) {
            const uint32_t *t = mesh->triangles[s->face_of[i]];
            const int k = corner_of(t, v);
            for (int side = 1; side <= 2; ++side) {
                const uint32_t start = t[(k + side) % 3];
                if (s->used[start] != wanted)
                    continue;
                const uint32_t length = walk_fan(s, start, out + count);
                ++fans;
                if (wanted == 1)
                    mesh->open_edge_count += 2;
                if (wanted == 2 && fans == 1 &&
                    length == s->first_face[v + 1] - s->first_face[v] + 1)
                    return length - 1; /* the only fan, closed: the last joins the first */
                count += length;
                out[count - 1] |= MOTE_RING_END;
            }
        }
    }
    return count;
}

mote_status mote_mesh_build_rings(mote_mesh *mesh)
{
    ring_scratch s = {0};
    mote_status status = scratch_create(&s, mesh);
    if (status != MOTE_OK)
        return status;
    status = sort_faces(&s, mesh);
    mesh->ring_start = malloc(((size_t)mesh->vertex_count + 1) * sizeof *mesh->ring_start);
    /* A fan has at most one entry more than faces, and at least one face. */
    mesh->ring = malloc((size_t)6 * mesh->triangle_count * sizeof *mesh->ring);
    if (status == MOTE_OK && (!mesh->ring_start || !mesh->ring))
        status = mote_fail(MOTE_ENOMEM, "no memory for %u one-rings", mesh->vertex_count);
    uint32_t length = 0;
    uint64_t ends = 0; /* edges, each counted at both of its vertices */
    for (uint32_t v = 0; status == MOTE_OK && v < mesh->vertex_count; ++v) {
        mesh->ring_start[v] = length;
        status = link_neighbours(&s, mesh, v);
        if (status == MOTE_OK) {
            const uint32_t open_before = mesh->open_edge_count;
            length += order_ring(&s, mesh, v, mesh->ring + length);
            /* Faces around v plus one for each open fan: its distinct neighbours. */
            ends += s.first_face[v + 1] - s.first_face[v] +
                    (mesh->open_edge_count - open_before) / 2;
        }
    }
    scratch_free(&s);
    if (status != MOTE_OK)
        return status;
    mesh->ring_start[mesh->vertex_count] = length;
    mesh->edge_count = (uint32_t)(ends / 2);
    mesh->open_edge_count /= 2; /* seen from both ends */
    uint32_t *shrunk = realloc(mesh->ring, length * sizeof *shrunk);
    if (shrunk)
        mesh->ring = shrunk;
    return MOTE_OK;
}
