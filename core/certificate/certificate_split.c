/* Splitting triangles, at rest alone or with sample poses.

   A range can be split across its main axis or a coordinate's, in any pose, and parts need not
   be halves as long as their leaves hold them. Ways are judged as those of trees for ray
   tracing are: by the size of both parts, each times the triangles in it. Ways are tried on a
   sample of the triangles; of many ways (with sample poses) the best are found on a smaller
   one.

   What size is depends on what becomes of the boxes. Those of a body that is only known at rest
   lie along the main axes of what is in them, so a part's size is how far it is spread along
   its own: the sum of three standard deviations. With sample poses it is the surface of a box
   along the coordinates' axes, added up over all poses, as in core/body/sample_split.h, whose
   trees may be as uneven as they like. A split that joins limbs in any pose where they are
   apart pays for it there. Each does worse than the other on the other's bodies: see
   docs/certified.md. */
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

/* Sums over the centres of some triangles, relative to one of them. */
typedef struct moments {
    double count, x[3];
    double xx[6]; /* products of coordinates: 00, 01, 02, 11, 12, 22 */
} moments;

static void add_centre(moments *m, const float c[3], const float base[3])
{
    const double x = (double)(c[0] - base[0]);
    const double y = (double)(c[1] - base[1]);
    const double z = (double)(c[2] - base[2]);
    m->count += 1;
    m->x[0] += x;
    m->x[1] += y;
    m->x[2] += z;
    m->xx[0] += x * x;
    m->xx[1] += x * y;
    m->xx[2] += x * z;
    m->xx[3] += y * y;
    m->xx[4] += y * z;
    m->xx[5] += z * z;
}

/* a + b * part */
static moments plus(const moments *a, const moments *b, double part)
{
    moments sum = {.count = a->count + b->count * part};
    for (int k = 0; k < 3; ++k)
        sum.x[k] = a->x[k] + b->x[k] * part;
    for (int k = 0; k < 6; ++k)
        sum.xx[k] = a->xx[k] + b->xx[k] * part;
    return sum;
}

/* The upper half of the covariance matrix, in the order of moments.xx. */
static void covariance(const moments *m, double a[6])
{
    const double n = 1 / m->count;
    const double x = m->x[0] * n;
    const double y = m->x[1] * n;
    const double z = m->x[2] * n;
    a[0] = m->xx[0] * n - x * x;
    a[1] = m->xx[1] * n - x * y;
    a[2] = m->xx[2] * n - x * z;
    a[3] = m->xx[3] * n - y * y;
    a[4] = m->xx[4] * n - y * z;
    a[5] = m->xx[5] * n - z * z;
}

static double root(double x)
{
    return x > 0 ? sqrt(x) : 0;
}

/* The sum s of the standard deviations along the principal axes, the trace of the square root
   of the covariance matrix. With its trace I1, the sum I2 of its principal minors and its
   determinant I3, s^2 = I1 + 2 sqrt(I2 + 2 s sqrt(I3)). A step of this iteration leaves at most
   a ninth of the error, by the inequality of the means of the three deviations. */
static double spread(const moments *m)
{
    double a[6];
    covariance(m, a);
    const double minor = a[3] * a[5] - a[4] * a[4];
    const double trace = a[0] + a[3] + a[5];
    const double minors = minor + a[0] * a[5] - a[2] * a[2] + a[0] * a[3] - a[1] * a[1];
    const double det =
        a[0] * minor - a[1] * (a[1] * a[5] - a[4] * a[2]) + a[2] * (a[1] * a[4] - a[3] * a[2]);
    const double twice = 2 * root(det);
    double s = root(trace + 2 * root(minors));
    for (int step = 0; step < 2; ++step)
        s = root(trace + 2 * root(minors + twice * s));
    return s;
}

/* The main axis of the centres of a range of triangles in one pose. */
static mote_vec3 main_axis(const mote_cert_item *items, uint32_t count,
                           const float (*centres)[3])
{
    moments m = {0};
    double c[6];
    for (uint32_t i = 0; i < count; ++i)
        add_centre(&m, centres[items[i].triangle], centres[items[0].triangle]);
    covariance(&m, c);
    double a[3][3] = {{c[0], c[1], c[2]}, {c[1], c[3], c[4]}, {c[2], c[4], c[5]}};
    mote_vec3 axes[3];
    mote_cert_principal_axes(a, axes);
    return axes[0];
}

/* Gives items their keys: where they lie along an axis of one pose. */
static void measure_along(const float (*centres)[3], mote_vec3 axis, mote_cert_item *items,
                          uint32_t count)
{
    const float x = (float)axis.x;
    const float y = (float)axis.y;
    const float z = (float)axis.z;
    for (uint32_t i = 0; i < count; ++i) {
        const float *c = centres[items[i].triangle];
        items[i].key = c[0] * x + c[1] * y + c[2] * z;
    }
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

/* Adds for each place what the surfaces of both parts cost in one pose. The probes are in order
   around each of the places. */
static void add_surfaces(const float (*centres)[3], const probes *p, double cost[PLACES])
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

/* Brings items[begin .. end - 1], which have their keys, in order around each of some cuts. */
static void select_around(mote_cert_item *items, uint32_t begin, uint32_t end,
                          const uint32_t *cuts, uint32_t count)
{
    if (count == 0)
        return;
    const uint32_t middle = count / 2;
    const uint32_t cut = cuts[middle];
    select_least(items + begin, end - begin, cut - begin);
    select_around(items, begin, cut, cuts, middle);
    select_around(items, cut, end, cuts + middle + 1, count - middle - 1);
}

/* What both parts cost at each place when their surfaces in all poses count. */
static void cost_of_surfaces(const mote_cert_poses *poses, probes *p, double cost[PLACES])
{
    select_around(p->items, 0, p->count, p->cut, p->places);
    for (uint32_t pose = 0; pose < poses->count; ++pose)
        add_surfaces(centres_of(poses, pose), p, cost);
}

/* Slices across the axis, of the same width. */
enum { SLICES = 16 };

static void fill_slices(const float (*centres)[3], const probes *p, moments slices[SLICES])
{
    const float *base = centres[p->items[0].triangle];
    double low = (double)p->items[0].key;
    double high = low;
    for (uint32_t i = 1; i < p->count; ++i) {
        const double key = (double)p->items[i].key;
        low = key < low ? key : low;
        high = key > high ? key : high;
    }
    for (uint32_t i = 0; i < p->count; ++i) {
        const double t = ((double)p->items[i].key - low) / (high - low);
        const int slice = t < 1 ? (int)(t * SLICES) : SLICES - 1; /* the last if not a number */
        add_centre(&slices[slice], centres[p->items[i].triangle], base);
    }
}

/* What both parts cost at each place when it counts how far they are spread at rest. The slice
   in which a place lies is shared by both parts; that saves ordering the probes, which took
   most of the time. */
static void cost_of_spreads(const float (*centres)[3], const probes *p, double cost[PLACES])
{
    moments slices[SLICES] = {0}, all = {0}, before = {0};
    uint32_t next = 0;
    fill_slices(centres, p, slices);
    for (int i = 0; i < SLICES; ++i)
        all = plus(&all, &slices[i], 1);
    for (uint32_t i = 0; i < p->places; ++i) {
        for (; before.count + slices[next].count <= p->cut[i]; ++next)
            before = plus(&before, &slices[next], 1);
        const double share = (p->cut[i] - before.count) / slices[next].count;
        const moments first = plus(&before, &slices[next], share);
        const moments second = plus(&all, &first, -1);
        cost[i] += spread(&first) * first.count + spread(&second) * second.count;
    }
}

/* The best place for a way's axis. */
static void place_best(const mote_cert_poses *poses, probes *p, way *w)
{
    double cost[PLACES] = {0};
    uint32_t best = 0;
    assert(p->places > 0);
    measure_along(centres_of(poses, w->pose), w->axis, p->items, p->count);
    if (poses->count == 1)
        cost_of_spreads(centres_of(poses, 0), p, cost);
    else
        cost_of_surfaces(poses, p, cost);
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

/* Lists or, of more than BEST ways, tries the main axis and the coordinates' axes in each pose;
   returns how many ways are kept. */
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
            if (poses->count > 1)
                place_best(poses, &p, &w);
            keep_best(best, &kept, &w);
        }
    }
    return kept;
}

uint32_t mote_cert_split(const mote_cert_poses *poses, mote_cert_item *items, uint32_t count,
                         uint32_t least, uint32_t most)
{
    const limits part = {least, most};
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
    measure_along(centres_of(poses, best.pose), best.axis, items, count);
    select_least(items, count, best.half);
    return best.half;
}
