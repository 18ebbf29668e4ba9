#include "harness/mesh/mesh_soup.h"

#include "harness/base/memory.h"
#include "harness/mesh/polygon.h"

#include <stdlib.h>
#include <string.h>

#define VERTICES_MAX ((size_t)1 << 31)

mote_status mote_soup_add_vertex(mote_soup *soup, double x, double y, double z)
{
    if (soup->vertex_count + 1 >= VERTICES_MAX)
        return mote_fail(MOTE_EINVAL, "2^31 vertices or more; give fewer");
    soup->xyz = mote_reserve(soup->xyz, soup->vertex_count + 1, &soup->vertex_capacity,
                             3 * sizeof *soup->xyz);
    double *at = soup->xyz + 3 * soup->vertex_count++;
    at[0] = x;
    at[1] = y;
    at[2] = z;
    return MOTE_OK;
}

void mote_soup_add_triangle(mote_soup *soup, uint32_t a, uint32_t b, uint32_t c)
{
    const size_t count = soup->triangle_count + 1;
    soup->indices =
        mote_reserve(soup->indices, count, &soup->index_capacity, 3 * sizeof *soup->indices);
    soup->lines = mote_reserve(soup->lines, count, &soup->line_capacity, sizeof *soup->lines);
    soup->lines[soup->triangle_count] = soup->line;
    uint32_t *at = soup->indices + 3 * soup->triangle_count++;
    at[0] = a;
    at[1] = b;
    at[2] = c;
}

static int compare_corners(const void *a, const void *b)
{
    const uint32_t first = *(const uint32_t *)a, second = *(const uint32_t *)b;
    return (first > second) - (first < second);
}

/* Exporters write a vertex twice in a row where they made two of one: the triangles there
   collapse. A vertex at two places of a face joins two faces, or a hole. */
static mote_status check_corners(const uint32_t *corners, size_t count, uint32_t *sorted)
{
    size_t kept = 0;
    for (size_t i = 0; i < count; ++i) {
        if (corners[i] != corners[i + 1 < count ? i + 1 : 0])
            sorted[kept++] = corners[i];
    }
    qsort(sorted, kept, sizeof *sorted, compare_corners);
    for (size_t i = 1; i < kept; ++i) {
        if (sorted[i - 1] == sorted[i])
            return mote_fail(MOTE_EINVAL,
                             "a face with a vertex twice; give different ones, or triangles "
                             "where a face has a hole");
    }
    return MOTE_OK;
}

/* places: room for the corners' coordinates; triangles: room for three numbers per corner. */
static mote_status add_polygon(mote_soup *soup, const uint32_t *corners, size_t count,
                               double *places, uint32_t (*triangles)[3])
{
    mote_status status = check_corners(corners, count, triangles[0]);
    for (size_t i = 0; i < count; ++i)
        memcpy(places + 3 * i, soup->xyz + (size_t)3 * corners[i], 3 * sizeof *places);
    if (status == MOTE_OK)
        status = mote_polygon_triangulate(places, count, triangles);
    for (size_t i = 0; i + 2 < count && status == MOTE_OK; ++i)
        mote_soup_add_triangle(soup, corners[triangles[i][0]], corners[triangles[i][1]],
                               corners[triangles[i][2]]);
    return status;
}

mote_status mote_soup_add_polygon(mote_soup *soup, const uint32_t *corners, size_t count)
{
    double *places = mote_allocate(3 * count, sizeof *places);
    uint32_t(*triangles)[3] = mote_allocate(count, sizeof *triangles);
    const mote_status status = add_polygon(soup, corners, count, places, triangles);
    free(places);
    free(triangles);
    return status;
}

void mote_soup_free(mote_soup *soup)
{
    free(soup->xyz);
    free(soup->indices);
    free(soup->lines);
    free(soup->kind);
    *soup = (mote_soup){0};
}

static uint64_t hash_place(const double xyz[3])
{
    uint64_t hash = 0;
    for (int i = 0; i < 3; ++i) {
        const double value = xyz[i] + 0.0; /* -0 becomes 0 */
        uint64_t bits;
        memcpy(&bits, &value, sizeof bits);
        hash = (hash ^ bits) * 0x9e3779b97f4a7c15u;
        hash ^= hash >> 29;
    }
    return hash;
}

static bool same_place(const double *a, const double *b)
{
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

static bool same_kind(const mote_soup *soup, uint32_t a, uint32_t b)
{
    return !soup->kind || soup->kind[a] == soup->kind[b];
}

/* map[v]: the first vertex with the position and kind of v. slots: a power of two, all
   UINT32_MAX. */
static void find_first(const mote_soup *soup, uint32_t *slots, size_t slot_count, uint32_t *map)
{
    for (uint32_t v = 0; v < soup->vertex_count; ++v) {
        const double *place = soup->xyz + (size_t)3 * v;
        size_t slot = hash_place(place) & (slot_count - 1);
        while (slots[slot] != UINT32_MAX &&
               !(same_kind(soup, slots[slot], v) &&
                 same_place(soup->xyz + (size_t)3 * slots[slot], place)))
            slot = (slot + 1) & (slot_count - 1);
        if (slots[slot] == UINT32_MAX)
            slots[slot] = v;
        map[v] = slots[slot];
    }
}

static void apply_map(mote_soup *soup, const uint32_t *map)
{
    for (uint32_t v = 0; v < soup->vertex_count; ++v)
        soup->welded += map[v] != v;
    for (size_t i = 0; i < 3 * soup->triangle_count; ++i)
        soup->indices[i] = map[soup->indices[i]];
}

void mote_soup_drop_collapsed(mote_soup *soup)
{
    size_t kept = 0;
    for (size_t t = 0; t < soup->triangle_count; ++t) {
        const uint32_t *from = soup->indices + 3 * t;
        if (from[0] == from[1] || from[1] == from[2] || from[2] == from[0])
            continue;
        soup->lines[kept] = soup->lines[t];
        memmove(soup->indices + 3 * kept++, from, 3 * sizeof *from);
    }
    soup->collapsed += soup->triangle_count - kept;
    soup->triangle_count = kept;
}

mote_status mote_soup_refuse_collapsed(const char *path, const mote_soup *soup)
{
    return soup->triangle_count > 0
               ? MOTE_OK
               : mote_fail(MOTE_EINVAL,
                           "%s: each of its %zu faces has two corners at one place; give "
                           "triangles with three places",
                           path, soup->collapsed);
}

void mote_soup_weld(mote_soup *soup)
{
    size_t slot_count = 64;
    while (slot_count < 2 * soup->vertex_count)
        slot_count *= 2;
    uint32_t *slots = mote_allocate(slot_count, sizeof *slots);
    uint32_t *map = mote_allocate(soup->vertex_count, sizeof *map);
    memset(slots, 0xff, slot_count * sizeof *slots);
    find_first(soup, slots, slot_count, map);
    const size_t welded_before = soup->welded;
    apply_map(soup, map);
    mote_soup_drop_collapsed(soup);
    free(slots);
    free(map);
    mote_soup_compact(soup);
    /* Welded vertices are in no face; they count as welded only. */
    soup->unused -= soup->welded - welded_before;
}

void mote_soup_compact(mote_soup *soup)
{
    uint32_t *place = mote_allocate(soup->vertex_count, sizeof *place);
    memset(place, 0xff, soup->vertex_count * sizeof *place);
    for (size_t i = 0; i < 3 * soup->triangle_count; ++i)
        place[soup->indices[i]] = 0;
    uint32_t kept = 0;
    for (size_t v = 0; v < soup->vertex_count; ++v) {
        if (place[v] == UINT32_MAX)
            continue;
        memmove(soup->xyz + (size_t)3 * kept, soup->xyz + 3 * v, 3 * sizeof *soup->xyz);
        if (soup->kind)
            soup->kind[kept] = soup->kind[v];
        place[v] = kept++;
    }
    for (size_t i = 0; i < 3 * soup->triangle_count; ++i)
        soup->indices[i] = place[soup->indices[i]];
    soup->unused += soup->vertex_count - kept;
    soup->vertex_count = kept;
    free(place);
}
