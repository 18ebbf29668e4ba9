#include "tests/studies/readers_compare.h"

#include "core/body/triangle.h"
#include "harness/base/memory.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>

/* assimp's parsing of a number is off by a few units in the last place of a float. */
#define ROUNDING ldexp(8, -24)
#define SLICES 1024

void surface_add(surface *s, mote_vec3 a, mote_vec3 b, mote_vec3 c)
{
    s->at = mote_reserve(s->at, 3 * (s->count + 1), &s->capacity, sizeof *s->at);
    mote_vec3 *t = s->at + 3 * s->count++;
    t[0] = a;
    t[1] = b;
    t[2] = c;
}

void surface_free(surface *s)
{
    free(s->at);
    *s = (surface){0};
}

typedef struct box {
    mote_vec3 low, high;
} box;

static box box_of(const mote_vec3 *at, size_t count)
{
    box b = {at[0], at[0]};
    for (size_t i = 1; i < count; ++i) {
        b.low = mote_vec3_make(fmin(b.low.x, at[i].x), fmin(b.low.y, at[i].y),
                               fmin(b.low.z, at[i].z));
        b.high = mote_vec3_make(fmax(b.high.x, at[i].x), fmax(b.high.y, at[i].y),
                                fmax(b.high.z, at[i].z));
    }
    return b;
}

static bool is_near(const box *b, mote_vec3 p, double reach)
{
    return p.x >= b->low.x - reach && p.x <= b->high.x + reach && p.y >= b->low.y - reach &&
           p.y <= b->high.y + reach && p.z >= b->low.z - reach && p.z <= b->high.z + reach;
}

/* Triangles in slices of equal width along the first axis; each is in all slices that it
   touches. */
typedef struct slices {
    const surface *of;
    box *boxes;
    size_t first[SLICES + 1];
    uint32_t *items;
    double low, width, reach;
} slices;

static size_t slice_at(const slices *s, double x)
{
    const double at = (x - s->low) / s->width;
    return at <= 0 ? 0 : at >= SLICES - 1 ? SLICES - 1 : (size_t)at;
}

static void slices_create(const surface *of, double reach, slices *s)
{
    const box whole = box_of(of->at, 3 * of->count);
    *s = (slices){.of = of, .reach = reach, .low = whole.low.x};
    s->width = fmax((whole.high.x - whole.low.x) / SLICES, 1e-300);
    s->boxes = mote_allocate(of->count, sizeof *s->boxes);
    size_t count[SLICES + 1] = {0};
    for (size_t t = 0; t < of->count; ++t) {
        s->boxes[t] = box_of(of->at + 3 * t, 3);
        for (size_t i = slice_at(s, s->boxes[t].low.x - reach);
             i <= slice_at(s, s->boxes[t].high.x + reach); ++i)
            ++count[i];
    }
    for (size_t i = 0; i < SLICES; ++i)
        s->first[i + 1] = s->first[i] + count[i];
    s->items = mote_allocate(s->first[SLICES], sizeof *s->items);
    for (size_t t = of->count; t-- > 0;) {
        for (size_t i = slice_at(s, s->boxes[t].low.x - reach);
             i <= slice_at(s, s->boxes[t].high.x + reach); ++i)
            s->items[s->first[i] + --count[i]] = (uint32_t)t;
    }
}

static void slices_free(slices *s)
{
    free(s->boxes);
    free(s->items);
}

static double distance_from(const surface *s, size_t triangle, mote_vec3 p)
{
    mote_vec3 closest;
    return sqrt(mote_point_triangle(p, s->at + 3 * triangle, &closest));
}

/* The distance of any triangle within reach; of the nearest triangle if none is. */
static double distance_of_point(const slices *s, mote_vec3 p)
{
    const size_t slice = slice_at(s, p.x);
    for (size_t i = s->first[slice]; i < s->first[slice + 1]; ++i) {
        if (!is_near(&s->boxes[s->items[i]], p, s->reach))
            continue;
        const double distance = distance_from(s->of, s->items[i], p);
        if (distance <= s->reach)
            return distance;
    }
    double least = HUGE_VAL;
    for (size_t t = 0; t < s->of->count; ++t)
        least = fmin(least, distance_from(s->of, t, p));
    return least;
}

/* The largest distance of a point of one surface from the other. */
static double farthest(const surface *from, const surface *to, double reach)
{
    slices s;
    double most = 0;
    slices_create(to, reach, &s);
    for (size_t t = 0; t < from->count; ++t) {
        const mote_vec3 *at = from->at + 3 * t;
        const mote_vec3 sum = mote_add(at[0], mote_add(at[1], at[2]));
        most = fmax(most, distance_of_point(&s, mote_scale(sum, 1.0 / 3)));
        for (int k = 0; k < 3; ++k) {
            const mote_vec3 middle = mote_scale(mote_add(at[k], at[(k + 1) % 3]), 0.5);
            most = fmax(most, distance_of_point(&s, at[k]));
            most = fmax(most, distance_of_point(&s, middle));
        }
    }
    slices_free(&s);
    return most;
}

typedef struct sums {
    double area, volume;
    double area_slope, volume_slope; /* largest change per unit that the corners move */
} sums;

static sums sum_up(const surface *s, mote_vec3 middle)
{
    sums sum = {0};
    for (size_t t = 0; t < s->count; ++t) {
        mote_vec3 p[3];
        for (int k = 0; k < 3; ++k)
            p[k] = mote_sub(s->at[3 * t + (size_t)k], middle);
        sum.area += mote_length(mote_cross(mote_sub(p[1], p[0]), mote_sub(p[2], p[0]))) / 2;
        sum.volume += mote_dot(p[0], mote_cross(p[1], p[2])) / 6;
        for (int k = 0; k < 3; ++k) {
            const mote_vec3 next = p[(k + 1) % 3];
            sum.area_slope += mote_length(mote_sub(next, p[k])) / 2;
            sum.volume_slope += mote_length(mote_cross(p[k], next)) / 6;
        }
    }
    sum.volume_slope += sum.area;
    return sum;
}

static double bounds_apart(const box *a, const box *b)
{
    const mote_vec3 low = mote_sub(a->low, b->low), high = mote_sub(a->high, b->high);
    return fmax(fmax(fmax(fabs(low.x), fabs(low.y)), fabs(low.z)),
                fmax(fmax(fabs(high.x), fabs(high.y)), fabs(high.z)));
}

difference surface_compare(const surface *ours, const surface *theirs, double thickness)
{
    difference d = {0};
    const box a = box_of(ours->at, 3 * ours->count);
    const box b = box_of(theirs->at, 3 * theirs->count);
    const mote_vec3 middle = mote_scale(mote_add(a.low, a.high), 0.5);
    double largest = 0;
    for (size_t i = 0; i < 3 * ours->count; ++i)
        largest = fmax(
            largest, fmax(fabs(ours->at[i].x), fmax(fabs(ours->at[i].y), fabs(ours->at[i].z))));
    const sums our_sums = sum_up(ours, middle), their_sums = sum_up(theirs, middle);
    d.size = mote_length(mote_sub(a.high, a.low));
    d.length_allowed = sqrt(3) * ROUNDING * largest + thickness;
    d.area[0] = our_sums.area;
    d.area[1] = their_sums.area;
    d.area_allowed = 2 * our_sums.area_slope * d.length_allowed;
    d.volume[0] = our_sums.volume;
    d.volume[1] = their_sums.volume;
    d.volume_allowed = our_sums.volume_slope * d.length_allowed;
    d.bounds = bounds_apart(&a, &b);
    d.there = farthest(ours, theirs, d.length_allowed);
    d.back = farthest(theirs, ours, d.length_allowed);
    return d;
}

bool difference_is_rounding(const difference *d)
{
    return fabs(d->area[0] - d->area[1]) <= d->area_allowed &&
           fabs(d->volume[0] - d->volume[1]) <= d->volume_allowed &&
           d->bounds <= d->length_allowed && d->there <= d->length_allowed &&
           d->back <= d->length_allowed;
}
