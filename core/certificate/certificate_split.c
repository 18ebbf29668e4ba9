/* Splitting triangles, at rest alone or with sample poses.

   A body that is only known at rest is halved across its main axis. With sample poses there are
   more ways to halve it, across axes of any pose, and parts need not be halves as long as their
   leaves hold them. What is best is judged as trees for ray tracing are: by the surfaces of the
   boxes around both parts, each times the triangles in it, here added up over all poses, as in
   core/body/sample_split.h, whose trees may be as uneven as they like. A split that joins limbs
   in any pose where they are apart pays for it there. All ways are tried on few triangles, the
   best of them on more. */
#include "core/certificate/certificate_split.h"
#include "core/certificate/certificate_box.h"

#include <assert.h>
#include <float.h>

static void swap_items(mote_cert_item *a, mote_cert_item *b)
{
    const mote_cert_item c = *a;
    *a = *b;
    *b = c;
}

static float middle_key(const mote_cert_item *items, size_t low, size_t high)
{
    const float a = items[low].key;
    const float b = items[low + (high - low) / 2].key;
    const float c = items[high].key;
    const float least = a < b ? a : b;
    const float most = a < b ? b : a;
    return c < least ? least : c > most ? most : c;
}

/* Moves the k least keys of items[0 .. count - 1] to the front (Hoare's selection). */
static void select_least(mote_cert_item *items, size_t count, size_t k)
{
    size_t low = 0;
    size_t high = count - 1;
    while (low < high) {
        const float pivot = middle_key(items, low, high);
        size_t i = low;
        size_t end = high + 1; /* one past the last that may be below the pivot */
        while (i < end) {
            while (items[i].key < pivot)
                ++i;
            while (pivot < items[end - 1].key)
                --end;
            if (i < end)
                swap_items(&items[i++], &items[--end]);
        }
        if (k < end)
            high = end - 1;
        else if (k >= i)
            low = i;
        else
            break;
    }
}

/* The main axis of the centres of a range of triangles in one pose. */
static mote_vec3 main_axis(const mote_cert_item *items, uint32_t count,
                           const float (*centres)[3])
{
    double mean[3] = {0};
    double m[6] = {0};
    const float *base = centres[items[0].triangle];
    for (uint32_t i = 0; i < count; ++i) {
        const float *c = centres[items[i].triangle];
        const double x = (double)(c[0] - base[0]);
        const double y = (double)(c[1] - base[1]);
        const double z = (double)(c[2] - base[2]);
        mean[0] += x;
        mean[1] += y;
        mean[2] += z;
        m[0] += x * x;
        m[1] += x * y;
        m[2] += x * z;
        m[3] += y * y;
        m[4] += y * z;
        m[5] += z * z;
    }
    const double n = 1 / (double)count;
    double a[3][3];
    a[0][0] = m[0] - mean[0] * mean[0] * n;
    a[0][1] = a[1][0] = m[1] - mean[0] * mean[1] * n;
    a[0][2] = a[2][0] = m[2] - mean[0] * mean[2] * n;
    a[1][1] = m[3] - mean[1] * mean[1] * n;
    a[1][2] = a[2][1] = m[4] - mean[1] * mean[2] * n;
    a[2][2] = m[5] - mean[2] * mean[2] * n;
    mote_vec3 axes[3];
    mote_cert_principal_axes(a, axes);
    return axes[0];
}

/* Sorts items around `half` along an axis of one pose. */
static void halve_along(const float (*centres)[3], mote_vec3 axis, mote_cert_item *items,
                        uint32_t count, uint32_t half)
{
    const float x = (float)axis.x;
    const float y = (float)axis.y;
    const float z = (float)axis.z;
    for (uint32_t i = 0; i < count; ++i) {
        const float *c = centres[items[i].triangle];
        items[i].key = c[0] * x + c[1] * y + c[2] * z;
    }
    select_least(items, count, half);
}

static const float (*centres_of(const mote_cert_poses *poses, uint32_t pose))[3]
{
    return (const float(*)[3])poses->centres + pose * poses->triangles;
}

/* Triangles that stand for a range while ways to split it are compared: at most COARSE for all
   ways, at most FINE for the best BEST of them. With 128 for FINE, queries of characters of
   15,000 to 20,000 triangles take 9 to 15 % longer; with a quarter of the triangles for all
   ways 3 to 6 %. */
enum { COARSE = 128, FINE = 512, BEST = 6 };

/* Steps of the place of a split to either side of the middle. */
enum { STEPS = 4, PLACES = 2 * STEPS + 1 };

/* One way to split: across an axis in one pose, so that `half` triangles are in the first part.
 */
typedef struct way {
    double cost;
    mote_vec3 axis;
    uint32_t pose, half;
} way;

/* What is split, as some of its triangles show it. */
typedef struct probes {
    mote_cert_item items[FINE];
    uint32_t count;
    uint32_t half[PLACES]; /* ascending: triangles in the first part */
    uint32_t cut[PLACES];  /* the same of the probes, not 0 and less than count */
    uint32_t places;       /* at least 1 */
} probes;

/* Evenly spread over a range. */
static void choose(const mote_cert_item *items, uint32_t count, uint32_t most, probes *p)
{
    p->count = count < most ? count : most;
    for (uint32_t i = 0; i < p->count; ++i)
        p->items[i] = items[(uint64_t)i * count / p->count];
}

/* How few and how many triangles a part may have. */
typedef struct limits {
    uint32_t least, most;
} limits;

/* The middle, and places beside it up to where a part is as small or as large as it may be. */
static void choose_places(uint32_t count, limits part, bool middle_only, probes *p)
{
    const uint32_t middle = count / 2;
    const uint32_t room = part.most > count - middle ? part.most - (count - middle) : 0;
    p->places = 0;
    for (int step = middle_only ? 0 : -STEPS; step <= (middle_only ? 0 : STEPS); ++step) {
        const int64_t beside = (int64_t)room * step / STEPS;
        const uint32_t half = (uint32_t)((int64_t)middle + beside);
        const uint32_t cut = (uint32_t)((uint64_t)half * p->count / count);
        const bool same = p->places > 0 && cut == p->cut[p->places - 1];
        if (same || cut < 1 || half < part.least || half > count - part.least)
            continue;
        p->half[p->places] = half;
        p->cut[p->places++] = cut;
    }
}

typedef struct extent {
    float low[3], high[3];
} extent;

static extent around(const float (*centres)[3], const mote_cert_item *items, uint32_t count)
{
    extent e = {{FLT_MAX, FLT_MAX, FLT_MAX}, {-FLT_MAX, -FLT_MAX, -FLT_MAX}};
    for (uint32_t i = 0; i < count; ++i) {
        const float *c = centres[items[i].triangle];
        for (int k = 0; k < 3; ++k) {
            e.low[k] = c[k] < e.low[k] ? c[k] : e.low[k];
            e.high[k] = c[k] > e.high[k] ? c[k] : e.high[k];
        }
    }
    return e;
}

static extent both(extent a, extent b)
{
    for (int k = 0; k < 3; ++k) {
        a.low[k] = b.low[k] < a.low[k] ? b.low[k] : a.low[k];
        a.high[k] = b.high[k] > a.high[k] ? b.high[k] : a.high[k];
    }
    return a;
}

static double surface(extent e)
{
    const double x = (double)(e.high[0] - e.low[0]);
    const double y = (double)(e.high[1] - e.low[1]);
    const double z = (double)(e.high[2] - e.low[2]);
    return x * y + y * z + z * x;
}

/* Adds for each place what both parts cost in one pose. The probes are in order around each of
   the places. */
static void add_costs(const float (*centres)[3], const probes *p, double cost[PLACES])
{
    extent part[PLACES + 1];
    uint32_t begin = 0;
    for (uint32_t i = 0; i <= p->places; ++i) {
        const uint32_t end = i < p->places ? p->cut[i] : p->count;
        part[i] = around(centres, p->items + begin, end - begin);
        begin = end;
    }
    extent before = part[0];
    for (uint32_t i = 0; i < p->places; ++i) {
        cost[i] += surface(before) * p->cut[i];
        before = both(before, part[i + 1]);
    }
    extent after = part[p->places];
    for (uint32_t i = p->places; i-- > 0;) {
        cost[i] += surface(after) * (p->count - p->cut[i]);
        after = both(after, part[i]);
    }
}

/* The best place for a way's axis. */
static void place_best(const mote_cert_poses *poses, probes *p, way *w)
{
    double cost[PLACES] = {0};
    uint32_t end = p->count, best = 0;
    assert(p->places > 0);
    halve_along(centres_of(poses, w->pose), w->axis, p->items, end, p->cut[p->places - 1]);
    for (uint32_t i = p->places; i-- > 0;) {
        select_least(p->items, end, p->cut[i]);
        end = p->cut[i];
    }
    for (uint32_t pose = 0; pose < poses->count; ++pose)
        add_costs(centres_of(poses, pose), p, cost);
    for (uint32_t i = 1; i < p->places; ++i)
        best = cost[i] < cost[best] ? i : best;
    w->cost = cost[best];
    w->half = p->half[best];
}

/* Puts a way among the best ones, which are in ascending order of their cost. */
static void keep_best(way best[BEST], uint32_t *count, const way *w)
{
    uint32_t i = *count < BEST ? (*count)++ : BEST;
    for (; i > 0 && w->cost < best[i - 1].cost; --i) {
        if (i < BEST)
            best[i] = best[i - 1];
    }
    if (i < BEST)
        best[i] = *w;
}

/* Tries the main axis and the coordinates' axes in each pose; returns how many ways are kept.
 */
static uint32_t find_ways(const mote_cert_poses *poses, const mote_cert_item *items,
                          uint32_t count, limits part, way best[BEST])
{
    probes p;
    uint32_t kept = 0;
    choose(items, count, COARSE, &p);
    choose_places(count, part, true, &p);
    for (uint32_t pose = 0; pose < poses->count; ++pose) {
        const mote_vec3 axes[4] = {main_axis(p.items, p.count, centres_of(poses, pose)),
                                   {1, 0, 0},
                                   {0, 1, 0},
                                   {0, 0, 1}};
        for (int k = 0; k < 4; ++k) {
            way w = {.axis = axes[k], .pose = pose};
            place_best(poses, &p, &w);
            keep_best(best, &kept, &w);
        }
    }
    return kept;
}

static uint32_t split_posed(const mote_cert_poses *poses, mote_cert_item *items, uint32_t count,
                            limits part)
{
    way ways[BEST];
    probes p;
    const uint32_t kept = find_ways(poses, items, count, part, ways);
    way best = {.cost = HUGE_VAL, .axis = {1, 0, 0}, .half = count / 2};
    choose(items, count, FINE, &p);
    choose_places(count, part, false, &p);
    for (uint32_t i = 0; i < kept; ++i) {
        place_best(poses, &p, &ways[i]);
        if (ways[i].cost < best.cost)
            best = ways[i];
    }
    halve_along(centres_of(poses, best.pose), best.axis, items, count, best.half);
    return best.half;
}

uint32_t mote_cert_split(const mote_cert_poses *poses, mote_cert_item *items, uint32_t count,
                         uint32_t least, uint32_t most)
{
    if (poses->count > 1)
        return split_posed(poses, items, count, (limits){least, most});
    const mote_vec3 axis = main_axis(items, count, centres_of(poses, 0));
    halve_along(centres_of(poses, 0), axis, items, count, count / 2);
    return count / 2;
}
