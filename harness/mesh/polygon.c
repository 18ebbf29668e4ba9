#include "harness/mesh/polygon.h"

#include "harness/base/memory.h"
#include "harness/mesh/orientation.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

/* A polygon thinner than this fraction of its length counts as a line. */
#define THIN 1e-6
/* So does one thinner than this fraction of its largest coordinate. Coordinates that went
   through 32-bit floats, as those of most files of text did, are off by 2^-24 of it, in each of
   three directions: edges twice sqrt(3) of that apart may cross, and then seem as far apart
   again. */
#define ROUNDED (7 * 0x1p-24)
/* A quadrilateral no thicker than this fraction of its length is flat. */
#define FLAT 1e-3
/* A projection in which the polygon covers less than this fraction of its area in the best
   projection is edge-on and mostly rounding. */
#define EDGE_ON 1e-3

typedef enum ear_state { EAR_UNKNOWN, EAR_YES, EAR_NO } ear_state;

typedef struct span {
    double low, high; /* of an edge, in the projection's first coordinate */
    uint32_t edge;    /* number of its first corner */
} span;

/* The part of a polygon that remains while corners are cut off; corners are numbered from 0. */
typedef struct outline {
    double (*at)[2]; /* projected; counterclockwise after orient() */
    uint32_t *next, *previous;
    uint32_t *obstacle; /* corners whose inner angle was 180 degrees or more at first */
    unsigned char *ear; /* ear_state */
    span *spans;
    uint32_t count, left, obstacle_count;
    uint32_t (*triangles)[3]; /* cut off so far */
    uint32_t triangle_count;
} outline;

static void outline_free(outline *o)
{
    free(o->at);
    free(o->next);
    free(o->previous);
    free(o->obstacle);
    free(o->ear);
    free(o->spans);
}

static void outline_create(size_t count, outline *o)
{
    o->count = (uint32_t)count;
    o->at = mote_allocate(count, sizeof *o->at);
    o->next = mote_allocate(count, sizeof *o->next);
    o->previous = mote_allocate(count, sizeof *o->previous);
    o->obstacle = mote_allocate(count, sizeof *o->obstacle);
    o->ear = mote_allocate(count, sizeof *o->ear);
    o->spans = mote_allocate(count, sizeof *o->spans);
}

/* Starts with the whole polygon: the coordinates u and v of xyz, times unit. */
static void outline_begin(outline *o, const double *xyz, double unit, int u, int v)
{
    for (uint32_t i = 0; i < o->count; ++i) {
        o->at[i][0] = xyz[3 * (size_t)i + (size_t)u] * unit;
        o->at[i][1] = xyz[3 * (size_t)i + (size_t)v] * unit;
        o->next[i] = i + 1 < o->count ? i + 1 : 0;
        o->previous[i] = i > 0 ? i - 1 : o->count - 1;
        o->ear[i] = EAR_UNKNOWN;
    }
    o->left = o->count;
    o->triangle_count = 0;
}

static int turn_at(const outline *o, uint32_t i)
{
    return mote_orientation(o->at[o->previous[i]], o->at[i], o->at[o->next[i]]);
}

static void cut(outline *o, uint32_t i)
{
    const uint32_t before = o->previous[i], after = o->next[i];
    uint32_t *triangle = o->triangles[o->triangle_count++];
    triangle[0] = before;
    triangle[1] = i;
    triangle[2] = after;
    o->next[before] = after;
    o->previous[after] = before;
    o->ear[before] = o->ear[after] = EAR_UNKNOWN;
    --o->left;
}

/* Whether the outline runs to corner i and back along the same line, or corner i repeats a
   neighbour. */
static bool is_spike(const outline *o, uint32_t i)
{
    if (turn_at(o, i) != 0)
        return false;
    const double *before = o->at[o->previous[i]], *at = o->at[i], *after = o->at[o->next[i]];
    const int k = before[0] != at[0] || after[0] != at[0] ? 0 : 1;
    return before[k] == at[k] || after[k] == at[k] || (before[k] < at[k]) == (after[k] < at[k]);
}

/* Cuts off the parts without area, and returns a corner of the rest, which may have fewer than
   three. */
static uint32_t cut_spikes(outline *o)
{
    uint32_t at = 1, checked = 0;
    while (o->left >= 3 && checked < o->left) {
        if (is_spike(o, at)) {
            cut(o, at);
            at = o->previous[at];
            checked = checked > 2 ? checked - 2 : 0; /* both neighbours have changed */
        } else {
            at = o->next[at];
            ++checked;
        }
    }
    return at;
}

static bool is_between(double value, double a, double b)
{
    return (a <= value && value <= b) || (b <= value && value <= a);
}

/* Whether p, which is on the line through a and b, lies on the segment. */
static bool is_on_segment(const double p[2], const double a[2], const double b[2])
{
    return is_between(p[0], a[0], b[0]) && is_between(p[1], a[1], b[1]);
}

/* Whether two segments have a point in common. The second coordinates decide most cases: the
   edges compared overlap in the first. */
static bool segments_meet(const double a[2], const double b[2], const double c[2],
                          const double d[2])
{
    if ((a[1] < c[1] && a[1] < d[1] && b[1] < c[1] && b[1] < d[1]) ||
        (a[1] > c[1] && a[1] > d[1] && b[1] > c[1] && b[1] > d[1]))
        return false;
    const int ac = mote_orientation(a, b, c), ad = mote_orientation(a, b, d);
    const int ca = mote_orientation(c, d, a), cb = mote_orientation(c, d, b);
    if (ac * ad < 0 && ca * cb < 0)
        return true;
    return (ac == 0 && is_on_segment(c, a, b)) || (ad == 0 && is_on_segment(d, a, b)) ||
           (ca == 0 && is_on_segment(a, c, d)) || (cb == 0 && is_on_segment(b, c, d));
}

/* Successive edges meet only at their common corner, since spikes have been removed. */
static bool edges_clash(const outline *o, uint32_t i, uint32_t j)
{
    if (o->next[i] == j || o->next[j] == i)
        return false;
    return segments_meet(o->at[i], o->at[o->next[i]], o->at[j], o->at[o->next[j]]);
}

static int compare_spans(const void *a, const void *b)
{
    const double first = ((const span *)a)->low, second = ((const span *)b)->low;
    return (first > second) - (first < second);
}

/* Whether two edges meet that are not neighbours; clash: their first corners. */
static bool find_clash(outline *o, uint32_t start, uint32_t clash[2])
{
    uint32_t corner = start;
    for (uint32_t i = 0; i < o->left; ++i, corner = o->next[corner]) {
        const double a = o->at[corner][0], b = o->at[o->next[corner]][0];
        o->spans[i] = (span){fmin(a, b), fmax(a, b), corner};
    }
    qsort(o->spans, o->left, sizeof *o->spans, compare_spans);
    for (uint32_t i = 0; i < o->left; ++i) {
        for (uint32_t j = i + 1; j < o->left && o->spans[j].low <= o->spans[i].high; ++j) {
            if (!edges_clash(o, o->spans[i].edge, o->spans[j].edge))
                continue;
            clash[0] = o->spans[i].edge;
            clash[1] = o->spans[j].edge;
            return true;
        }
    }
    return false;
}

/* Makes a simple outline counterclockwise, mirroring it if necessary: its orientation is that
   of the turn at its leftmost corner (the lowest of these). Lists the obstacles. */
static void orient(outline *o, uint32_t start)
{
    uint32_t lowest = start, corner = start;
    for (uint32_t i = 0; i < o->left; ++i, corner = o->next[corner]) {
        const double *at = o->at[corner], *best = o->at[lowest];
        if (at[0] < best[0] || (at[0] == best[0] && at[1] < best[1]))
            lowest = corner;
    }
    if (turn_at(o, lowest) < 0) {
        for (uint32_t i = 0; i < o->count; ++i)
            o->at[i][0] = -o->at[i][0];
    }
    o->obstacle_count = 0;
    for (uint32_t i = 0; i < o->left; ++i, corner = o->next[corner]) {
        if (turn_at(o, corner) <= 0)
            o->obstacle[o->obstacle_count++] = corner;
    }
}

/* Whether the triangle at corner i is inside and the diagonal opposite to i meets nothing.
   Checking the obstacles is enough: a left-turning corner can be in the way only if an obstacle
   is, too. */
static bool is_ear(const outline *o, uint32_t i)
{
    const uint32_t before = o->previous[i], after = o->next[i];
    const double *a = o->at[before], *b = o->at[i], *c = o->at[after];
    const double low[2] = {fmin(a[0], fmin(b[0], c[0])), fmin(a[1], fmin(b[1], c[1]))};
    const double high[2] = {fmax(a[0], fmax(b[0], c[0])), fmax(a[1], fmax(b[1], c[1]))};
    if (turn_at(o, i) <= 0)
        return false;
    for (uint32_t k = 0; k < o->obstacle_count; ++k) {
        const uint32_t j = o->obstacle[k];
        const double *p = o->at[j];
        if (p[0] < low[0] || p[0] > high[0] || p[1] < low[1] || p[1] > high[1])
            continue;
        if (j != before && j != i && j != after && mote_orientation(a, b, p) >= 0 &&
            mote_orientation(b, c, p) >= 0 && mote_orientation(c, a, p) >= 0)
            return false;
    }
    return true;
}

/* Cuts off ears until nothing is left; false if it finds none, which cannot happen for a simple
   polygon. A cut affects only whether its two neighbours are ears. */
static bool cut_ears(outline *o, uint32_t start)
{
    uint32_t at = start, refused = 0;
    while (o->left > 3 && refused <= o->left) {
        const uint32_t after = o->next[at];
        if (o->ear[at] == EAR_UNKNOWN)
            o->ear[at] = is_ear(o, at) ? EAR_YES : EAR_NO;
        if (o->ear[at] == EAR_YES)
            cut(o, at);
        refused = o->ear[at] == EAR_YES ? 0 : refused + 1;
        at = after;
    }
    if (o->left == 3)
        cut(o, at);
    return o->left == 2;
}

typedef enum view { VIEW_SIMPLE, VIEW_NO_AREA, VIEW_CLASH } view;

/* Triangulates one projection if possible. */
static view triangulate_view(outline *o, uint32_t clash[2])
{
    const uint32_t start = cut_spikes(o);
    if (o->left < 3)
        return VIEW_NO_AREA;
    if (find_clash(o, start, clash))
        return VIEW_CLASH;
    orient(o, start);
    return cut_ears(o, start) ? VIEW_SIMPLE : VIEW_CLASH;
}

/* The polygon seen along each axis. */
typedef struct areas {
    double net[3];   /* Newell's normal: twice the signed area */
    double total[3]; /* the same with absolute values */
    double best;     /* the largest component */
    double length_squared;
    size_t farthest; /* the corner with this distance from the first */
} areas;

static areas measure_areas(const double *xyz, size_t count, double unit)
{
    areas sum = {{0}, {0}, 0, 0, 0};
    double before[3] = {0};
    for (size_t i = 1; i < count; ++i) {
        double edge[3];
        for (int k = 0; k < 3; ++k)
            edge[k] = xyz[3 * i + (size_t)k] * unit - xyz[k] * unit;
        for (int k = 0; k < 3; ++k) {
            const int u = (k + 1) % 3, v = (k + 2) % 3;
            const double area = before[u] * edge[v] - before[v] * edge[u];
            sum.net[k] += area;
            sum.total[k] += fabs(area);
        }
        const double squared = edge[0] * edge[0] + edge[1] * edge[1] + edge[2] * edge[2];
        if (squared > sum.length_squared) {
            sum.length_squared = squared;
            sum.farthest = i;
        }
        for (int k = 0; k < 3; ++k)
            before[k] = edge[k];
    }
    sum.best = fmax(sum.total[0], fmax(sum.total[1], sum.total[2]));
    return sum;
}

/* Whether no corner is farther from the line through the first corner and the one farthest from
   it than rounding may be. */
static bool is_thin(const double *xyz, size_t count, double unit, const areas *sum)
{
    const double *far = xyz + 3 * sum->farthest;
    double largest = 0, width_squared = 0, along[3];
    for (int k = 0; k < 3; ++k)
        along[k] = far[k] * unit - xyz[k] * unit;
    for (size_t i = 0; i < count; ++i) {
        double edge[3], cross[3];
        for (int k = 0; k < 3; ++k) {
            edge[k] = xyz[3 * i + (size_t)k] * unit - xyz[k] * unit;
            largest = fmax(largest, fabs(xyz[3 * i + (size_t)k] * unit));
        }
        for (int k = 0; k < 3; ++k) {
            const int u = (k + 1) % 3, v = (k + 2) % 3;
            cross[k] = along[u] * edge[v] - along[v] * edge[u];
        }
        width_squared = fmax(width_squared,
                             (cross[0] * cross[0] + cross[1] * cross[1] + cross[2] * cross[2]) /
                                 sum->length_squared);
    }
    return sqrt(width_squared) <= fmax(THIN * sqrt(sum->length_squared), ROUNDED * largest);
}

/* The axes, starting with the one nearest to the normal. */
static void order_axes(const areas *sum, int axes[3])
{
    for (int k = 0; k < 3; ++k)
        axes[k] = k;
    for (int i = 0; i < 2; ++i) {
        for (int k = 0; k < 2 - i; ++k) {
            if (fabs(sum->net[axes[k]]) >= fabs(sum->net[axes[k + 1]]))
                continue;
            const int other = axes[k];
            axes[k] = axes[k + 1];
            axes[k + 1] = other;
        }
    }
}

/* Whether four corners do not lie in a plane: seen along the line that connects its diagonals,
   the quadrilateral is then convex, hence simple. */
static bool is_skew(const double *xyz, double unit, const areas *sum)
{
    double edge[3][3];
    for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 3; ++k)
            edge[i][k] = xyz[3 * (i + 1) + k] * unit - xyz[k] * unit;
    }
    const double volume = edge[0][0] * (edge[1][1] * edge[2][2] - edge[1][2] * edge[2][1]) +
                          edge[0][1] * (edge[1][2] * edge[2][0] - edge[1][0] * edge[2][2]) +
                          edge[0][2] * (edge[1][0] * edge[2][1] - edge[1][1] * edge[2][0]);
    return fabs(volume) > FLAT * sum->best * sqrt(sum->length_squared);
}

static void fan(size_t count, uint32_t (*triangles)[3])
{
    for (uint32_t i = 0; i + 2 < count; ++i) {
        triangles[i][0] = 0;
        triangles[i][1] = i + 1;
        triangles[i][2] = i + 2;
    }
}

/* The power of two that scales all coordinates into -2 .. 2, where their products neither
   overflow nor vanish. */
static double unit_of(const double *xyz, size_t count)
{
    double largest = 0;
    for (size_t i = 0; i < 3 * count; ++i)
        largest = fmax(largest, fabs(xyz[i]));
    return largest > 0 ? ldexp(1, -ilogb(fmax(largest, DBL_MIN))) : 1;
}

/* Triangulates the first projection that allows it, otherwise one without area; if there is
   neither, gives the clashing edges of the best projection. */
static view triangulate_views(outline *o, const double *xyz, double unit, const areas *sum,
                              uint32_t clash[2])
{
    view seen = VIEW_NO_AREA;
    int axes[3];
    order_axes(sum, axes);
    for (int i = 0; i < 3; ++i) {
        uint32_t edges[2] = {0, 2};
        if (sum->total[axes[i]] < EDGE_ON * sum->best)
            continue;
        outline_begin(o, xyz, unit, (axes[i] + 1) % 3, (axes[i] + 2) % 3);
        const view next = triangulate_view(o, edges);
        if (next == VIEW_SIMPLE)
            return next;
        if (next == VIEW_CLASH && seen == VIEW_NO_AREA) {
            clash[0] = edges[0] < edges[1] ? edges[0] : edges[1];
            clash[1] = edges[0] < edges[1] ? edges[1] : edges[0];
            seen = VIEW_CLASH;
        }
    }
    return seen;
}

mote_status mote_polygon_triangulate(const double *xyz, size_t count, uint32_t (*triangles)[3])
{
    const double unit = unit_of(xyz, count);
    const areas sum = measure_areas(xyz, count, unit);
    if (count == 3 || sum.best == 0) {
        fan(count, triangles);
        return MOTE_OK;
    }
    outline o = {.triangles = triangles};
    uint32_t clash[2];
    outline_create(count, &o);
    const view seen = triangulate_views(&o, xyz, unit, &sum, clash);
    outline_free(&o);
    if (seen != VIEW_CLASH)
        return MOTE_OK;
    if (!is_thin(xyz, count, unit, &sum) && !(count == 4 && is_skew(xyz, unit, &sum)))
        return mote_fail(MOTE_EINVAL,
                         "a face whose edges %u and %u cross or touch; give triangles, or a "
                         "polygon whose edges meet in its corners only",
                         clash[0] + 1, clash[1] + 1);
    fan(count, triangles);
    return MOTE_OK;
}
