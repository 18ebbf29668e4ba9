#include "harness/mesh/mesh_split.h"

#include "harness/base/memory.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define NONE UINT32_MAX
/* For this many rounds, only the edges that need it are opened completely; then all are. */
#define ROUNDS_MAX 8
/* Lines listed for an edge. */
#define LINES_TOLD 6

/* A face at an edge of more than two. */
typedef struct wing {
    uint32_t face;
    uint32_t partner; /* another wing of the edge, from 0; NONE: the face is open here */
    bool forward;     /* goes from the edge's first end to its second */
    double angle;     /* about the edge */
} wing;

typedef struct heavy_edge {
    uint32_t end[2];     /* the smaller vertex first */
    uint32_t first_wing; /* in wings */
    uint32_t wing_count;
} heavy_edge;

/* Corner 3 f + k is vertex k of face f. */
typedef struct splitter {
    mote_soup *soup;
    uint32_t *first_corner; /* [v + 1] start of a vertex's corners in corner_of */
    uint32_t *corner_of;    /* [3 t] */
    uint32_t *mark;         /* [v] one per neighbour, while a vertex is processed */
    uint32_t *parent;       /* [3 t] union-find over the corners of a vertex that stay
                               together */
    uint32_t *vertex;       /* [3 t] final vertex of each corner */
    uint64_t *scratch;      /* [wing_count] */
    heavy_edge *edges;
    wing *wings;
    size_t edge_count, edge_capacity, wing_count, wing_capacity;
    uint32_t vertex_count; /* at the end */
} splitter;

static void splitter_free(splitter *s)
{
    free(s->first_corner);
    free(s->corner_of);
    free(s->mark);
    free(s->parent);
    free(s->vertex);
    free(s->scratch);
    free(s->edges);
    free(s->wings);
}

static void splitter_create(mote_soup *soup, splitter *s)
{
    const size_t v = soup->vertex_count, corners = 3 * soup->triangle_count;
    *s = (splitter){.soup = soup, .vertex_count = (uint32_t)v};
    s->first_corner = mote_allocate(v + 1, sizeof *s->first_corner);
    s->corner_of = mote_allocate(corners, sizeof *s->corner_of);
    s->mark = mote_allocate(v, sizeof *s->mark);
    for (size_t c = 0; c < corners; ++c)
        ++s->first_corner[soup->indices[c]];
    uint32_t sum = 0;
    for (size_t i = 0; i <= v; ++i) {
        sum += s->first_corner[i];
        s->first_corner[i] = sum;
    }
    for (size_t c = corners; c-- > 0;)
        s->corner_of[--s->first_corner[soup->indices[c]]] = (uint32_t)c;
}

/* The other two vertices of a corner's face, in winding order. */
static void neighbours_of(const splitter *s, uint32_t corner, uint32_t others[2])
{
    const uint32_t face = corner / 3, k = corner % 3;
    others[0] = s->soup->indices[3 * face + (k + 1) % 3];
    others[1] = s->soup->indices[3 * face + (k + 2) % 3];
}

static void add_wing(splitter *s, uint32_t face, bool forward)
{
    s->wings = mote_reserve(s->wings, s->wing_count + 1, &s->wing_capacity, sizeof *s->wings);
    s->wings[s->wing_count++] = (wing){face, NONE, forward, 0};
}

/* Adds the edge from a to the larger vertex b, with all of its faces. */
static void add_edge(splitter *s, uint32_t a, uint32_t b)
{
    s->edges = mote_reserve(s->edges, s->edge_count + 1, &s->edge_capacity, sizeof *s->edges);
    heavy_edge *edge = &s->edges[s->edge_count++];
    *edge = (heavy_edge){{a, b}, (uint32_t)s->wing_count, 0};
    for (uint32_t i = s->first_corner[a]; i < s->first_corner[a + 1]; ++i) {
        uint32_t others[2];
        neighbours_of(s, s->corner_of[i], others);
        if (others[0] == b || others[1] == b)
            add_wing(s, s->corner_of[i] / 3, others[0] == b);
    }
    edge->wing_count = (uint32_t)s->wing_count - edge->first_wing;
}

/* Adds the edges of more than two faces from v to larger vertices. mark is 0 before and
   after. */
static void find_edges_at(splitter *s, uint32_t v)
{
    uint32_t others[2];
    for (uint32_t i = s->first_corner[v]; i < s->first_corner[v + 1]; ++i) {
        neighbours_of(s, s->corner_of[i], others);
        for (int k = 0; k < 2; ++k) {
            if (others[k] > v && ++s->mark[others[k]] == 3)
                add_edge(s, v, others[k]);
        }
    }
    for (uint32_t i = s->first_corner[v]; i < s->first_corner[v + 1]; ++i) {
        neighbours_of(s, s->corner_of[i], others);
        s->mark[others[0]] = s->mark[others[1]] = 0;
    }
}

static int compare_edges(const void *a, const void *b)
{
    const heavy_edge *p = a, *q = b;
    const int first = (p->end[0] > q->end[0]) - (p->end[0] < q->end[0]);
    return first ? first : (p->end[1] > q->end[1]) - (p->end[1] < q->end[1]);
}

/* The record of an edge between two vertices, or NULL if it has one or two faces. */
static heavy_edge *edge_between(const splitter *s, uint32_t a, uint32_t b)
{
    const heavy_edge wanted = {{a < b ? a : b, a < b ? b : a}, 0, 0};
    return bsearch(&wanted, s->edges, s->edge_count, sizeof *s->edges, compare_edges);
}

static void cross(const double a[3], const double b[3], double out[3])
{
    for (int k = 0; k < 3; ++k)
        out[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* The unit vector from vertex a to vertex b; 0 if they are at one place. */
static void direction(const splitter *s, uint32_t a, uint32_t b, double out[3])
{
    const double *from = s->soup->xyz + (size_t)3 * a, *to = s->soup->xyz + (size_t)3 * b;
    double largest = 0;
    for (int k = 0; k < 3; ++k) {
        out[k] = to[k] / 2 - from[k] / 2;
        largest = fmax(largest, fabs(out[k]));
    }
    for (int k = 0; k < 3 && largest > 0; ++k)
        out[k] /= largest;
    const double length = sqrt(dot(out, out));
    for (int k = 0; k < 3 && largest > 0; ++k)
        out[k] /= length;
}

static uint32_t opposite(const splitter *s, const heavy_edge *edge, uint32_t face)
{
    const uint32_t *t = s->soup->indices + (size_t)3 * face;
    for (int k = 0; k < 2; ++k) {
        if (t[k] != edge->end[0] && t[k] != edge->end[1])
            return t[k];
    }
    return t[2];
}

static int compare_wings(const void *a, const void *b)
{
    const wing *p = a, *q = b;
    if (p->angle != q->angle)
        return p->angle < q->angle ? -1 : 1;
    return (p->face > q->face) - (p->face < q->face);
}

/* Sorts the faces about the edge counterclockwise, seen with its second end towards the viewer
   (right-hand rule). */
static void sort_wings(const splitter *s, const heavy_edge *edge)
{
    wing *wings = s->wings + edge->first_wing;
    double along[3], start[3], across[3], third[3];
    direction(s, edge->end[0], edge->end[1], along);
    direction(s, edge->end[0], opposite(s, edge, wings[0].face), start);
    cross(along, start, third);
    cross(third, along, across);
    for (uint32_t i = 0; i < edge->wing_count; ++i) {
        double to[3];
        direction(s, edge->end[0], opposite(s, edge, wings[i].face), to);
        wings[i].angle = atan2(dot(to, third), dot(to, across));
    }
    qsort(wings, edge->wing_count, sizeof *wings, compare_wings);
}

/* Pairs the faces that have the inside between them. The inside begins at the angle of a face
   that runs backward along the edge, and ends at one that runs forward: they match like
   brackets. */
static void pair_wings(const splitter *s, const heavy_edge *edge)
{
    uint64_t *stack = s->scratch; /* '(' without a ')' so far */
    wing *wings = s->wings + edge->first_wing;
    uint32_t depth = 0;
    sort_wings(s, edge);
    for (uint32_t turn = 0; turn < 2 * edge->wing_count; ++turn) {
        const uint32_t i = turn % edge->wing_count;
        if (wings[i].partner != NONE)
            continue;
        if (!wings[i].forward && turn < edge->wing_count) {
            stack[depth++] = i;
        } else if (wings[i].forward && depth > 0) {
            wings[i].partner = (uint32_t)stack[--depth];
            wings[wings[i].partner].partner = i;
        }
    }
}

static uint32_t root_of(splitter *s, uint32_t corner)
{
    while (s->parent[corner] != corner) {
        s->parent[corner] = s->parent[s->parent[corner]];
        corner = s->parent[corner];
    }
    return corner;
}

/* Joins two sets; the smaller root stays the root. */
static void join(splitter *s, uint32_t a, uint32_t b)
{
    a = root_of(s, a);
    b = root_of(s, b);
    s->parent[a > b ? a : b] = a > b ? b : a;
}

static uint32_t corner_at(const splitter *s, uint32_t face, uint32_t v)
{
    const uint32_t *t = s->soup->indices + (size_t)3 * face;
    return 3 * face + (t[0] == v ? 0 : t[1] == v ? 1 : 2);
}

/* Joins the corners at v of the faces that stay together along the edge from v to u; `corner`
   is one of them. For an edge of one or two faces, mark keeps the first corner (+ 1). */
static void join_along(splitter *s, uint32_t v, uint32_t u, uint32_t corner)
{
    const uint32_t before = s->mark[u];
    if (before == NONE)
        return; /* an edge of more faces, already done */
    if (before)
        join(s, before - 1, corner);
    const heavy_edge *edge = before ? NULL : edge_between(s, v, u);
    s->mark[u] = edge ? NONE : corner + 1;
    for (uint32_t i = 0; edge && i < edge->wing_count; ++i) {
        const wing *wings = s->wings + edge->first_wing;
        if (wings[i].partner != NONE && wings[i].partner > i)
            join(s, corner_at(s, wings[i].face, v),
                 corner_at(s, wings[wings[i].partner].face, v));
    }
}

/* Gives each group of corners of v that stay together its own vertex; the first group keeps
   v. */
static void split_vertex(splitter *s, uint32_t v)
{
    const uint32_t begin = s->first_corner[v], end = s->first_corner[v + 1];
    uint32_t others[2];
    for (uint32_t i = begin; i < end; ++i)
        s->parent[s->corner_of[i]] = s->corner_of[i];
    for (uint32_t i = begin; i < end; ++i) {
        neighbours_of(s, s->corner_of[i], others);
        for (int k = 0; k < 2; ++k)
            join_along(s, v, others[k], s->corner_of[i]);
    }
    for (uint32_t i = begin; i < end; ++i) {
        const uint32_t corner = s->corner_of[i], root = root_of(s, corner);
        /* Corners come in the order of their faces, so the root, being the smallest, came
           first. */
        if (root != corner)
            s->vertex[corner] = s->vertex[root];
        else
            s->vertex[corner] = i == begin ? v : s->vertex_count++;
        neighbours_of(s, corner, others);
        s->mark[others[0]] = s->mark[others[1]] = 0;
    }
}

/* Splits the ends of all edges of more than two faces, as currently paired. */
static void split_all(splitter *s)
{
    const size_t corners = 3 * s->soup->triangle_count;
    memcpy(s->vertex, s->soup->indices, corners * sizeof *s->vertex);
    s->vertex_count = (uint32_t)s->soup->vertex_count;
    for (size_t e = 0; e < s->edge_count; ++e) {
        for (int k = 0; k < 2; ++k) {
            const uint32_t v = s->edges[e].end[k], first = s->corner_of[s->first_corner[v]];
            /* Each edge once: after that its first corner has a parent. */
            if (s->parent[first] == NONE)
                split_vertex(s, v);
        }
    }
}

static int compare_keys(const void *a, const void *b)
{
    const uint64_t first = *(const uint64_t *)a, second = *(const uint64_t *)b;
    return (first > second) - (first < second);
}

/* Whether more than two faces still share both ends of an edge. */
static bool is_still_heavy(const splitter *s, const heavy_edge *edge)
{
    const wing *wings = s->wings + edge->first_wing;
    uint64_t *ends = s->scratch;
    for (uint32_t i = 0; i < edge->wing_count; ++i) {
        const uint64_t first = s->vertex[corner_at(s, wings[i].face, edge->end[0])];
        ends[i] = first << 32 | s->vertex[corner_at(s, wings[i].face, edge->end[1])];
    }
    qsort(ends, edge->wing_count, sizeof *ends, compare_keys);
    for (uint32_t i = 2; i < edge->wing_count; ++i) {
        if (ends[i - 2] == ends[i])
            return true;
    }
    return false;
}

static void open_edge(splitter *s, const heavy_edge *edge)
{
    for (uint32_t i = 0; i < edge->wing_count; ++i)
        s->wings[edge->first_wing + i].partner = NONE;
}

/* If the fans of two pairs meet at both ends of their edge, the edge still has more than two
   faces. It is then opened completely, which always helps: every fan of faces at one of its
   ends has at most two ends itself, so at most two faces of the edge share a vertex. */
static void split_until_light(splitter *s)
{
    bool heavy = true;
    for (int round = 0; heavy; ++round) {
        memset(s->parent, 0xff, 3 * s->soup->triangle_count * sizeof *s->parent);
        split_all(s);
        heavy = false;
        for (size_t e = 0; e < s->edge_count; ++e) {
            if (!is_still_heavy(s, &s->edges[e]))
                continue;
            heavy = true;
            open_edge(s, &s->edges[e]);
        }
        for (size_t e = 0; e < s->edge_count && heavy && round >= ROUNDS_MAX; ++e)
            open_edge(s, &s->edges[e]);
    }
}

static void MOTE_PRINTF(3, 4) append(char *text, size_t size, const char *format, ...)
{
    const size_t length = strlen(text);
    va_list arguments;
    va_start(arguments, format);
    (void)vsnprintf(text + length, size - length, format, arguments);
    va_end(arguments);
}

static int compare_lines(const void *a, const void *b)
{
    const uint32_t first = *(const uint32_t *)a, second = *(const uint32_t *)b;
    return (first > second) - (first < second);
}

static void tell_edge(const splitter *s, const heavy_edge *edge, mote_split *split)
{
    const double *a = s->soup->xyz + (size_t)3 * edge->end[0];
    const double *b = s->soup->xyz + (size_t)3 * edge->end[1];
    uint32_t lines[LINES_TOLD], count = 0;
    append(split->where, sizeof split->where,
           "%s(%.6g, %.6g, %.6g) to (%.6g, %.6g, %.6g) with %u faces",
           split->where[0] ? "; " : "", a[0], a[1], a[2], b[0], b[1], b[2], edge->wing_count);
    for (uint32_t i = 0; i < edge->wing_count && count < LINES_TOLD; ++i) {
        lines[count] = s->soup->lines[s->wings[edge->first_wing + i].face];
        count += lines[count] > 0;
    }
    qsort(lines, count, sizeof *lines, compare_lines);
    for (uint32_t i = 0; i < count; ++i)
        append(split->where, sizeof split->where, "%s%u", i ? ", " : " on lines ", lines[i]);
    if (count > 0 && count < edge->wing_count)
        append(split->where, sizeof split->where, ", ...");
}

static void apply(splitter *s, mote_split *split)
{
    mote_soup *soup = s->soup;
    const size_t before = soup->vertex_count;
    for (size_t e = 0; e < s->edge_count && e < MOTE_SPLIT_EDGES_TOLD; ++e)
        tell_edge(s, &s->edges[e], split);
    soup->xyz =
        mote_reserve(soup->xyz, s->vertex_count, &soup->vertex_capacity, 3 * sizeof *soup->xyz);
    if (soup->kind)
        soup->kind = mote_resize(soup->kind, s->vertex_count, sizeof *soup->kind);
    soup->vertex_count = s->vertex_count;
    for (size_t c = 0; c < 3 * soup->triangle_count; ++c) {
        if (s->vertex[c] >= before)
            memcpy(soup->xyz + (size_t)3 * s->vertex[c],
                   soup->xyz + (size_t)3 * soup->indices[c], 3 * sizeof *soup->xyz);
        if (s->vertex[c] >= before && soup->kind)
            soup->kind[s->vertex[c]] = soup->kind[soup->indices[c]];
        soup->indices[c] = s->vertex[c];
    }
    split->edges = s->edge_count;
    split->vertices = s->vertex_count - before;
}

static void split_edges(splitter *s, mote_split *split)
{
    const size_t corners = 3 * s->soup->triangle_count;
    s->parent = mote_allocate(corners, sizeof *s->parent);
    s->vertex = mote_allocate(corners, sizeof *s->vertex);
    s->scratch = mote_allocate(s->wing_count, sizeof *s->scratch);
    qsort(s->edges, s->edge_count, sizeof *s->edges, compare_edges);
    for (size_t e = 0; e < s->edge_count; ++e)
        pair_wings(s, &s->edges[e]);
    split_until_light(s);
    apply(s, split);
}

void mote_soup_split(mote_soup *soup, mote_split *split)
{
    splitter s;
    splitter_create(soup, &s);
    *split = (mote_split){0};
    for (uint32_t v = 0; v < soup->vertex_count; ++v)
        find_edges_at(&s, v);
    if (s.edge_count > 0)
        split_edges(&s, split);
    splitter_free(&s);
}
