#include "core/particle/far_cache.h"

#include <math.h>
#include <stdlib.h>

typedef struct expansion {
    double travelled; /* the cache's odometer when it was computed; negative: never */
    mote_vec3 centre;
    double slope[3], curve[6];
    uint32_t near_count[2]; /* of the same and of the other type */
} expansion;

struct mote_far_cache {
    size_t count;
    double allowed, near_squared, inverse_length;
    double travelled, step_longest; /* no particle moved further, before and in this step */
    expansion *expansions;          /* [2 bodies][count] */
    uint32_t *near_index;           /* [2 bodies][count][2 types][count] */
    double *near_place[2][3];       /* of the same and of the other type, [count] each */
};

mote_status mote_far_cache_create(uint32_t count, double part, double near_distance,
                                  double length, mote_far_cache **cache)
{
    const size_t n = count;
    mote_far_cache *made = calloc(1, sizeof *made);
    if (!made)
        return mote_fail(MOTE_ENOMEM, "no memory for a cache of forces");
    made->count = n;
    /* Two particles that have each moved by this much may have changed their distance by twice
       as much. */
    made->allowed = 0.5 * part * near_distance;
    made->near_squared = near_distance / length * (near_distance / length);
    made->inverse_length = 1 / length;
    made->expansions = malloc(2 * n * sizeof *made->expansions);
    made->near_index = malloc(4 * n * n * sizeof *made->near_index);
    made->near_place[0][0] = malloc(6 * n * sizeof(double));
    if (!made->expansions || !made->near_index || !made->near_place[0][0]) {
        mote_far_cache_destroy(made);
        return mote_fail(MOTE_ENOMEM, "no memory to cache the forces of %u particles", count);
    }
    for (size_t k = 1; k < 6; ++k)
        made->near_place[k / 3][k % 3] = made->near_place[0][0] + k * n;
    mote_far_cache_reset(made);
    *cache = made;
    return MOTE_OK;
}

void mote_far_cache_destroy(mote_far_cache *cache)
{
    if (!cache)
        return;
    free(cache->expansions);
    free(cache->near_index);
    free(cache->near_place[0][0]);
    free(cache);
}

void mote_far_cache_reset(mote_far_cache *cache)
{
    cache->travelled = cache->step_longest = 0;
    for (size_t i = 0; i < 2 * cache->count; ++i)
        cache->expansions[i].travelled = -1;
}

void mote_far_cache_step(mote_far_cache *cache)
{
    cache->travelled += cache->step_longest;
    cache->step_longest = 0;
}

void mote_far_cache_moved(mote_far_cache *cache, double distance)
{
    cache->step_longest = fmax(cache->step_longest, distance);
}

/* Sums over distant particles in lanes: gradient, then second derivatives. */
enum { SUMS = 9 };

/* Vectors e from MOTE_LANES particles to the moved one. */
typedef struct pair_lanes {
    double x[MOTE_LANES], y[MOTE_LANES], z[MOTE_LANES], squared[MOTE_LANES];
} pair_lanes;

MOTE_INLINE void load_pairs(const double *x, const double *y, const double *z, mote_vec3 centre,
                            double scale, pair_lanes *e)
{
    MOTE_LANE_LOOP
    for (size_t l = 0; l < MOTE_LANES; ++l) {
        e->x[l] = (centre.x - x[l]) * scale;
        e->y[l] = (centre.y - y[l]) * scale;
        e->z[l] = (centre.z - z[l]) * scale;
        e->squared[l] = e->x[l] * e->x[l] + e->y[l] * e->y[l] + e->z[l] * e->z[l];
    }
}

/* The last, partly filled lanes: unused ones repeat the moved particle, which is never distant.
 */
static void load_last_pairs(const mote_sources *sources, size_t first, mote_vec3 centre,
                            double scale, pair_lanes *e)
{
    double place[3][MOTE_LANES];
    for (size_t l = 0; l < MOTE_LANES; ++l) {
        const bool used = first + l < sources->count;
        place[0][l] = used ? sources->x[first + l] : centre.x;
        place[1][l] = used ? sources->y[first + l] : centre.y;
        place[2][l] = used ? sources->z[first + l] : centre.z;
    }
    load_pairs(place[0], place[1], place[2], centre, scale, e);
}

/* Adds the lanes with weight 1 or -1 (0: left out): a pair's potential has the gradient -a e
   and the second derivative -a I + b e e^T. */
MOTE_INLINE void add_pairs(const pair_lanes *e, mote_law law, const double weight[MOTE_LANES],
                           double sum[SUMS][MOTE_LANES])
{
    MOTE_LANE_LOOP
    for (size_t l = 0; l < MOTE_LANES; ++l) {
        const double inverse = 1 / (weight[l] != 0 ? e->squared[l] : 1);
        const double inverse_cube = inverse * sqrt(inverse);
        const double log_a = inverse;
        const double square_a = 2 * inverse * inverse;
        const double other_a = law == MOTE_LAW_INVERSE ? inverse_cube : square_a;
        const double factor = law == MOTE_LAW_LOG ? 2 : law == MOTE_LAW_INVERSE ? 3 : 4;
        const double a = weight[l] * (law == MOTE_LAW_LOG ? log_a : other_a);
        const double b = factor * a * inverse;
        sum[0][l] -= a * e->x[l];
        sum[1][l] -= a * e->y[l];
        sum[2][l] -= a * e->z[l];
        sum[3][l] += b * e->x[l] * e->x[l] - a;
        sum[4][l] += b * e->y[l] * e->y[l] - a;
        sum[5][l] += b * e->z[l] * e->z[l] - a;
        sum[6][l] += b * e->x[l] * e->y[l];
        sum[7][l] += b * e->y[l] * e->z[l];
        sum[8][l] += b * e->z[l] * e->x[l];
    }
}

MOTE_CLONES
static void expand_type(const mote_far_cache *cache, const mote_sources *sources, int type,
                        double effective_radius_squared, expansion *far, uint32_t *near_index)
{
    double sum[SUMS][MOTE_LANES] = {{0}};
    const double sign = type == 0 ? 1 : -1;
    const size_t count = sources->count;
    for (size_t first = 0; first < count; first += MOTE_LANES) {
        pair_lanes e;
        double weight[MOTE_LANES];
        if (first + MOTE_LANES <= count)
            load_pairs(sources->x + first, sources->y + first, sources->z + first, far->centre,
                       cache->inverse_length, &e);
        else
            load_last_pairs(sources, first, far->centre, cache->inverse_length, &e);
        MOTE_LANE_LOOP
        for (size_t l = 0; l < MOTE_LANES; ++l) {
            const double reached = e.squared[l] < effective_radius_squared ? sign : 0;
            weight[l] = e.squared[l] < cache->near_squared ? 0 : reached;
        }
        add_pairs(&e, sources->law, weight, sum);
        for (size_t j = first; j < first + MOTE_LANES && j < count; ++j) {
            if (e.squared[j - first] < cache->near_squared && j != sources->skip)
                near_index[far->near_count[type]++] = (uint32_t)j;
        }
    }
    for (int k = 0; k < 3; ++k)
        far->slope[k] += mote_lane_sum(sum[k]);
    for (int k = 0; k < 6; ++k)
        far->curve[k] += mote_lane_sum(sum[3 + k]);
}

static mote_sources near_sources(const mote_far_cache *cache, const mote_sources *sources,
                                 int type, const uint32_t *near_index, uint32_t near_count)
{
    double *const *place = cache->near_place[type];
    for (uint32_t k = 0; k < near_count; ++k) {
        place[0][k] = sources->x[near_index[k]];
        place[1][k] = sources->y[near_index[k]];
        place[2][k] = sources->z[near_index[k]];
    }
    const mote_sources near_ones = {place[0],   place[1],   place[2],
                                    near_count, near_count, sources->law};
    return near_ones;
}

void mote_far_cache_split(mote_far_cache *cache, int b, uint32_t index, mote_vec3 here,
                          const mote_sources *same, const mote_sources *other,
                          double effective_radius_squared, mote_far_split *split)
{
    const size_t n = cache->count;
    const size_t row = (size_t)b * n + index;
    expansion *far = &cache->expansions[row];
    uint32_t *near_index = cache->near_index + 2 * n * row;
    const double travelled = cache->travelled + cache->step_longest;
    if (far->travelled < 0 || travelled - far->travelled > cache->allowed) {
        *far = (expansion){.travelled = travelled, .centre = here};
        expand_type(cache, same, 0, HUGE_VAL, far, near_index);
        expand_type(cache, other, 1, effective_radius_squared, far, near_index + n);
    }
    split->same = near_sources(cache, same, 0, near_index, far->near_count[0]);
    split->other = near_sources(cache, other, 1, near_index + n, far->near_count[1]);
    split->centre = far->centre;
    for (int k = 0; k < 3; ++k)
        split->slope[k] = far->slope[k];
    for (int k = 0; k < 6; ++k)
        split->curve[k] = far->curve[k];
}

void mote_far_cache_add(const mote_far_split *split, const mote_candidates *candidates,
                        double length, mote_potentials *potentials)
{
    const bool ratio = split->same.law == MOTE_LAW_LOG && split->other.law == MOTE_LAW_LOG;
    const double inverse = 1 / length;
    const double *g = split->slope;
    const double *h = split->curve;
    for (int l = 0; l < MOTE_LANES; ++l) {
        const double x = (candidates->x[l] - split->centre.x) * inverse;
        const double y = (candidates->y[l] - split->centre.y) * inverse;
        const double z = (candidates->z[l] - split->centre.z) * inverse;
        const double far = g[0] * x + g[1] * y + g[2] * z +
                           0.5 * (h[0] * x * x + h[1] * y * y + h[2] * z * z) + h[3] * x * y +
                           h[4] * y * z + h[5] * z * x;
        const double near_part =
            ratio
                ? 0.5 * (0.6931471805599453 * potentials->major[l] + log(potentials->minor[l]))
                : potentials->major[l];
        potentials->major[l] = near_part + far;
        potentials->minor[l] = 0;
    }
}
