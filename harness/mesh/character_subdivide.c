#include "harness/mesh/character.h"

#include "harness/base/memory.h"
#include "harness/mesh/character_parts.h"

#include <stdlib.h>
#include <string.h>

/* Midpoints keyed by the two ends of their edge: an open-addressing table. */
typedef struct midpoints {
    uint64_t *ends; /* larger vertex in the upper half, smaller in the lower; 0, which no edge
                       has: free */
    uint32_t *vertex;
    size_t slots; /* a power of two */
} midpoints;

/* The character being made: its vertices, and whether they fit. */
typedef struct finer {
    const mote_character *from;
    mote_character to;
    midpoints table;
    double *xyz;
    uint32_t *indices;
    size_t vertex_count;
} finer;

/* The mean of two sparse lists of weights: keys ascend in both. */
static void mean_weights(finer *f, uint32_t a, uint32_t b)
{
    const mote_character *c = f->from;
    uint32_t i = c->start[a], k = c->start[b];
    while (i < c->start[a + 1] || k < c->start[b + 1]) {
        const uint32_t own = i < c->start[a + 1] ? c->bone[i] : UINT32_MAX;
        const uint32_t other = k < c->start[b + 1] ? c->bone[k] : UINT32_MAX;
        const size_t at = f->to.bone_count;
        MOTE_RIG_GROW(&f->to, bone, 1);
        MOTE_RIG_GROW(&f->to, weight, 1);
        f->to.bone[at] = (uint16_t)(own < other ? own : other);
        f->to.weight[at] = (own <= other ? c->weight[i++] : 0) / 2;
        f->to.weight[at] += (other <= own ? c->weight[k++] : 0) / 2;
    }
}

static void mean_shifts(finer *f, uint32_t a, uint32_t b)
{
    const mote_character *c = f->from;
    const mote_vec3 none = {0, 0, 0};
    uint32_t i = c->shift_start[a], k = c->shift_start[b];
    while (i < c->shift_start[a + 1] || k < c->shift_start[b + 1]) {
        const uint32_t own = i < c->shift_start[a + 1] ? c->target[i] : UINT32_MAX;
        const uint32_t other = k < c->shift_start[b + 1] ? c->target[k] : UINT32_MAX;
        const size_t at = f->to.target_count;
        MOTE_RIG_GROW(&f->to, target, 1);
        MOTE_RIG_GROW(&f->to, shift, 1);
        f->to.target[at] = own < other ? own : other;
        f->to.shift[at] = mote_scale(
            mote_add(own <= other ? c->shift[i++] : none, other <= own ? c->shift[k++] : none),
            0.5);
    }
}

/* Appends the midpoint of two vertices; of a vertex and itself, a copy. */
static void add_vertex(finer *f, uint32_t a, uint32_t b)
{
    const mote_vec3 p = f->from->mesh->positions[a], q = f->from->mesh->positions[b];
    double *at = f->xyz + 3 * f->vertex_count++;
    at[0] = p.x / 2 + q.x / 2;
    at[1] = p.y / 2 + q.y / 2;
    at[2] = p.z / 2 + q.z / 2;
    mean_weights(f, a, b);
    mean_shifts(f, a, b);
    MOTE_RIG_GROW(&f->to, start, 1);
    MOTE_RIG_GROW(&f->to, shift_start, 1);
    f->to.start[f->vertex_count] = (uint32_t)f->to.bone_count;
    f->to.shift_start[f->vertex_count] = (uint32_t)f->to.target_count;
}

static uint32_t midpoint(finer *f, uint32_t a, uint32_t b)
{
    const uint64_t ends = a < b ? (uint64_t)b << 32 | a : (uint64_t)a << 32 | b;
    midpoints *t = &f->table;
    size_t slot = (size_t)((ends * 0x9e3779b97f4a7c15u) >> 20) & (t->slots - 1);
    while (t->ends[slot] != 0 && t->ends[slot] != ends)
        slot = (slot + 1) & (t->slots - 1);
    if (t->ends[slot] == 0) {
        t->ends[slot] = ends;
        t->vertex[slot] = (uint32_t)f->vertex_count;
        add_vertex(f, a, b);
    }
    return t->vertex[slot];
}

static void start_finer(const mote_character *from, finer *f)
{
    const mote_mesh *mesh = from->mesh;
    *f = (finer){.from = from};
    for (f->table.slots = 64; f->table.slots < 2 * (size_t)mesh->edge_count;)
        f->table.slots *= 2;
    f->table.ends = mote_allocate(f->table.slots, sizeof *f->table.ends);
    f->table.vertex = mote_allocate(f->table.slots, sizeof *f->table.vertex);
    f->xyz = mote_allocate(3 * ((size_t)mesh->vertex_count + mesh->edge_count), sizeof *f->xyz);
    f->indices = mote_allocate(12 * (size_t)mesh->triangle_count, sizeof *f->indices);
    MOTE_RIG_GROW(&f->to, start, 1);
    MOTE_RIG_GROW(&f->to, shift_start, 1);
    MOTE_RIG_GROW(&f->to, target, 0);
    MOTE_RIG_GROW(&f->to, shift, 0);
    for (uint32_t v = 0; v < mesh->vertex_count; ++v)
        add_vertex(f, v, v);
}

static void cut_triangles(finer *f)
{
    uint32_t *next = f->indices;
    for (uint32_t t = 0; t < f->from->mesh->triangle_count; ++t) {
        const uint32_t *c = f->from->mesh->triangles[t];
        const uint32_t ab = midpoint(f, c[0], c[1]), bc = midpoint(f, c[1], c[2]),
                       ca = midpoint(f, c[2], c[0]);
        const uint32_t four[12] = {c[0], ab, ca, ab, c[1], bc, ca, bc, c[2], ab, bc, ca};
        memcpy(next, four, sizeof four);
        next += 12;
    }
}

static mote_status subdivide_once(mote_character *c)
{
    finer f;
    const size_t triangles = 4 * (size_t)c->mesh->triangle_count;
    if (triangles >= (size_t)1 << 31)
        return mote_fail(MOTE_EINVAL, "2^31 triangles or more; subdivide less often");
    start_finer(c, &f);
    cut_triangles(&f);
    mote_mesh *mesh = NULL;
    const mote_status status =
        mote_mesh_create(f.xyz, f.vertex_count, f.indices, triangles, &mesh);
    free(f.table.ends);
    free(f.table.vertex);
    free(f.xyz);
    free(f.indices);
    if (status == MOTE_OK) {
        mote_mesh_destroy(c->mesh);
        c->mesh = mesh;
        mote_character_set_arrays(c, &f.to);
    } else {
        mote_character_free_arrays(&f.to);
    }
    return status;
}

mote_status mote_character_subdivide(mote_character *character, uint32_t times)
{
    mote_status status = MOTE_OK;
    for (uint32_t k = 0; k < times && status == MOTE_OK; ++k)
        status = subdivide_once(character);
    return status;
}
