/* The extents of groups of vertices, for one type of number: included by stream_boxes.c once
   with SCALAR and OF(name) defined for float, once for double. Coordinates are compared as they
   are, so that an extent is exact. A sum over everything that was read is finite only if all of
   it is; where sums overflow, the caller looks at each number. */

/* Extents of each coordinate of RUN vertices side by side. */
typedef struct OF(run_extent) {
    SCALAR low[3 * RUN], high[3 * RUN], sum[RUN];
} OF(run_extent);

/* Of four vertices side by side; the fourth number of each is not one of its coordinates. */
typedef struct OF(single_extent) {
    SCALAR low[4][4], high[4][4], sum[4][4];
} OF(single_extent);

typedef struct OF(extent) {
    SCALAR low[3], high[3], sum[RUN];
} OF(extent);

MOTE_INLINE void OF(widen)(SCALAR *restrict low, SCALAR *restrict high,
                           const SCALAR *restrict p)
{
    MOTE_LANE_LOOP
    for (size_t k = 0; k < RUN; ++k) {
        low[k] = p[k] < low[k] ? p[k] : low[k];
        high[k] = p[k] > high[k] ? p[k] : high[k];
    }
}

/* In three parts: as one loop the extents would stay in memory. */
MOTE_INLINE void OF(widen_run)(OF(run_extent) *restrict e, const SCALAR *restrict p)
{
    OF(widen)(e->low, e->high, p);
    OF(widen)(e->low + RUN, e->high + RUN, p + RUN);
    OF(widen)(e->low + 2 * RUN, e->high + 2 * RUN, p + 2 * RUN);
    MOTE_LANE_LOOP
    for (size_t k = 0; k < RUN; ++k)
        e->sum[k] += (p[k] + p[k + RUN]) + p[k + 2 * RUN];
}

/* A run of vertices that are apart in memory. */
MOTE_INLINE void OF(widen_far_run)(OF(run_extent) *restrict e, const char *restrict at,
                                   size_t stride)
{
    SCALAR run[3 * RUN];
    for (size_t v = 0; v < RUN; ++v) {
        const SCALAR *p = (const SCALAR *)(const void *)(at + v * stride);
        for (size_t k = 0; k < 3; ++k)
            run[3 * v + k] = p[k];
    }
    OF(widen_run)(e, run);
}

MOTE_INLINE void OF(widen_single)(OF(single_extent) *restrict e, size_t lane,
                                  const SCALAR *restrict p)
{
    MOTE_LANE_LOOP
    for (size_t k = 0; k < 4; ++k) {
        e->low[lane][k] = p[k] < e->low[lane][k] ? p[k] : e->low[lane][k];
        e->high[lane][k] = p[k] > e->high[lane][k] ? p[k] : e->high[lane][k];
        e->sum[lane][k] += p[k];
    }
}

/* The first `count` of twice as many lows and highs become the extents of both halves. */
MOTE_INLINE void OF(fold)(SCALAR *restrict low, SCALAR *restrict high, size_t count)
{
    MOTE_LANE_LOOP
    for (size_t k = 0; k < count; ++k) {
        low[k] = low[k + count] < low[k] ? low[k + count] : low[k];
        high[k] = high[k + count] > high[k] ? high[k + count] : high[k];
    }
}

MOTE_INLINE void OF(add_to)(OF(extent) * e, const SCALAR *low, const SCALAR *high)
{
    for (size_t k = 0; k < 3; ++k) {
        e->low[k] = low[k] < e->low[k] ? low[k] : e->low[k];
        e->high[k] = high[k] > e->high[k] ? high[k] : e->high[k];
    }
}

MOTE_INLINE void OF(extent_of_runs)(const mote_stream_tree *tree, uint32_t group,
                                    const char *base, size_t stride, OF(extent) * whole)
{
    OF(run_extent) e;
    for (size_t k = 0; k < 3 * RUN; ++k) {
        e.low[k] = (SCALAR)HUGE_VAL;
        e.high[k] = -(SCALAR)HUGE_VAL;
    }
    for (size_t k = 0; k < RUN; ++k)
        e.sum[k] = 0;
    const uint32_t *end = tree->runs + tree->run_start[group + 1];
    for (const uint32_t *r = tree->runs + tree->run_start[group]; r < end; ++r) {
        const char *at = base + *r * stride;
        if (stride == 3 * sizeof(SCALAR))
            OF(widen_run)(&e, (const SCALAR *)(const void *)at);
        else
            OF(widen_far_run)(&e, at, stride);
    }
    OF(fold)(e.low, e.high, 12);
    OF(fold)(e.low, e.high, 6);
    OF(fold)(e.low, e.high, 3);
    OF(add_to)(whole, e.low, e.high);
    MOTE_LANE_LOOP
    for (size_t k = 0; k < RUN; ++k)
        whole->sum[k] += e.sum[k];
}

MOTE_INLINE void OF(extent_of_singles)(const mote_stream_tree *tree, uint32_t group,
                                       const char *base, size_t stride, OF(extent) * whole)
{
    OF(single_extent) e;
    for (size_t l = 0; l < 4; ++l) {
        for (size_t k = 0; k < 4; ++k) {
            e.low[l][k] = (SCALAR)HUGE_VAL;
            e.high[l][k] = -(SCALAR)HUGE_VAL;
            e.sum[l][k] = 0;
        }
    }
    const uint32_t *end = tree->singles + tree->single_start[group + 1];
    for (const uint32_t *v = tree->singles + tree->single_start[group]; v < end; v += 4) {
        OF(widen_single)(&e, 0, (const SCALAR *)(const void *)(base + v[0] * stride));
        OF(widen_single)(&e, 1, (const SCALAR *)(const void *)(base + v[1] * stride));
        OF(widen_single)(&e, 2, (const SCALAR *)(const void *)(base + v[2] * stride));
        OF(widen_single)(&e, 3, (const SCALAR *)(const void *)(base + v[3] * stride));
    }
    OF(fold)(e.low[0], e.high[0], 8);
    OF(fold)(e.low[0], e.high[0], 4);
    OF(add_to)(whole, e.low[0], e.high[0]);
    for (size_t k = 0; k < 3; ++k)
        whole->sum[k] += (e.sum[0][k] + e.sum[1][k]) + (e.sum[2][k] + e.sum[3][k]);
}

/* Writes the boxes of the groups of block `index`; false where a sum is not finite. */
MOTE_INLINE bool OF(box_block)(const mote_stream_body *body, uint32_t index, size_t stride)
{
    const mote_stream_tree *tree = body->tree;
    const char *base = body->positions.data;
    const uint32_t first = index * WIDTH;
    const uint32_t count = tree->groups - first < WIDTH ? tree->groups - first : WIDTH;
    mote_stream_block *block = &body->blocks[tree->first_block[tree->height - 1] + index];
    OF(extent) e = {.sum = {0}};
    for (uint32_t l = 0; l < count; ++l) {
        for (size_t k = 0; k < 3; ++k) {
            e.low[k] = (SCALAR)HUGE_VAL;
            e.high[k] = -(SCALAR)HUGE_VAL;
        }
        OF(extent_of_runs)(tree, first + l, base, stride, &e);
        OF(extent_of_singles)(tree, first + l, base, stride, &e);
        if (tree->last[first + l]) {
            const size_t at = (tree->mesh->vertex_count - 1) * stride;
            const SCALAR *p = (const SCALAR *)(const void *)(base + at);
            OF(add_to)(&e, p, p);
            e.sum[0] += (p[0] + p[1]) + p[2];
        }
        const double low[3] = {(double)e.low[0], (double)e.low[1], (double)e.low[2]};
        const double high[3] = {(double)e.high[0], (double)e.high[1], (double)e.high[2]};
        put_box(body, block, l, low, high);
    }
    for (uint32_t l = count; l < WIDTH; ++l)
        empty_lane(block, l);
    SCALAR sum = 0;
    for (size_t k = 0; k < RUN; ++k)
        sum += e.sum[k];
    return isfinite(sum);
}

/* The same for blocks first .. end - 1. */
MOTE_CLONES
static bool OF(box_packed)(const mote_stream_body *body, size_t first, size_t end)
{
    bool finite = true;
    for (size_t i = first; i < end; ++i)
        finite = OF(box_block)(body, (uint32_t)i, 3 * sizeof(SCALAR)) && finite;
    return finite;
}

MOTE_CLONES
static bool OF(box_strided)(const mote_stream_body *body, size_t first, size_t end)
{
    bool finite = true;
    for (size_t i = first; i < end; ++i)
        finite = OF(box_block)(body, (uint32_t)i, body->positions.stride) && finite;
    return finite;
}

/* Whether every coordinate is finite; false also where their sum overflows. */
MOTE_CLONES
static bool OF(sums_up)(const mote_positions *positions, size_t count)
{
    const char *base = positions->data;
    const size_t stride = positions->stride;
    const bool packed = stride == 3 * sizeof(SCALAR);
    const SCALAR *numbers = positions->data;
    const size_t whole = packed ? 3 * count / (4 * RUN) * (4 * RUN) : 0;
    SCALAR sum[4 * RUN] = {0};
    for (size_t i = 0; i < whole; i += 4 * RUN) {
        MOTE_LANE_LOOP
        for (size_t l = 0; l < 4 * RUN; ++l)
            sum[l] += numbers[i + l];
    }
    for (size_t i = whole; packed && i < 3 * count; ++i)
        sum[0] += numbers[i];
    for (size_t v = 0; !packed && v < count; ++v) {
        const SCALAR *p = (const SCALAR *)(const void *)(base + v * stride);
        sum[v % RUN] += (p[0] + p[1]) + p[2];
    }
    SCALAR all = 0;
    for (size_t l = 0; l < 4 * RUN; ++l)
        all += sum[l];
    return isfinite(all);
}
