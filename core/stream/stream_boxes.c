/* Margins. An extent is exact, the difference from the origin is rounded once in double
   precision and scale is a power of two, so that each number of a box is the nearest float of a
   value with a relative error of 2^-53: it is wrong by at most (2^-24 + 2^-52) of itself. */
#include "core/stream/stream_boxes.h"

#include "core/base/clones.h"

#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>

#define WIDTH MOTE_STREAM_WIDTH
#define RUN MOTE_STREAM_RUN

/* Bodies of fewer triangles are passed over by one thread: waking another takes some 10 us. */
#define WORTH_THREADS 100000

/* Blocks of 2,048 triangles that a thread works on at a time. */
#define GRAIN 4

MOTE_INLINE void put_box(const mote_stream_body *body, mote_stream_block *block, size_t lane,
                         const double low[3], const double high[3])
{
    const double origin[3] = {body->origin.x, body->origin.y, body->origin.z};
    for (size_t k = 0; k < 3; ++k) {
        block->low[k][lane] = (float)((low[k] - origin[k]) * body->scale);
        block->high[k][lane] = (float)((high[k] - origin[k]) * body->scale);
    }
}

MOTE_INLINE void empty_lane(mote_stream_block *block, size_t lane)
{
    for (size_t k = 0; k < 3; ++k) {
        block->low[k][lane] = HUGE_VALF;
        block->high[k][lane] = -HUGE_VALF;
    }
}

#define SCALAR double
#define OF(name) name##_double
#include "core/stream/stream_extent.h"
#undef SCALAR
#undef OF
#define SCALAR float
#define OF(name) name##_float
#include "core/stream/stream_extent.h"
#undef SCALAR
#undef OF

mote_status mote_stream_body_init(mote_stream_body *body, const mote_stream_tree *tree)
{
    *body = (mote_stream_body){.tree = tree};
    body->blocks = aligned_alloc(64, tree->first_block[tree->height] * sizeof *body->blocks);
    if (!body->blocks)
        return mote_fail(MOTE_ENOMEM, "no memory for the boxes of %u triangles",
                         tree->mesh->triangle_count);
    return MOTE_OK;
}

void mote_stream_body_free(mote_stream_body *body)
{
    free(body->blocks);
    body->blocks = NULL;
}

size_t mote_stream_body_bytes(const mote_stream_body *body)
{
    return body->tree->first_block[body->tree->height] * sizeof *body->blocks;
}

mote_status mote_stream_check(const mote_positions *positions, int number)
{
    const size_t size = positions->single ? sizeof(float) : sizeof(double);
    if (!positions->data)
        return mote_fail(MOTE_EINVAL,
                         "body %d has no positions; give those of all vertices in each frame",
                         number);
    if (positions->stride < 3 * size || positions->stride % size ||
        (uintptr_t)positions->data % size)
        return mote_fail(
            MOTE_EINVAL,
            "body %d has a stride of %zu bytes, or positions that are not aligned; "
            "give a multiple of %zu, and at least %zu",
            number, positions->stride, size, 3 * size);
    return MOTE_OK;
}

mote_status mote_stream_finite(mote_stream_body *body, int number)
{
    const uint32_t count = body->tree->mesh->vertex_count;
    const mote_positions *from = &body->positions;
    body->checked = body->checked ||
                    (from->single ? sums_up_float(from, count) : sums_up_double(from, count));
    for (uint32_t v = 0; !body->checked && v < count; ++v) {
        const mote_vec3 p = mote_position_at(from, v);
        if (!(isfinite(p.x) && isfinite(p.y) && isfinite(p.z)))
            return mote_fail(MOTE_EINVAL,
                             "body %d: vertex %u is at %g, %g, %g; positions must be finite",
                             number, v, p.x, p.y, p.z);
    }
    body->checked = true;
    return MOTE_OK;
}

/* A pass that several threads share. */
typedef struct shared_pass {
    const mote_stream_body *body;
    atomic_bool doubtful; /* a sum was not finite */
} shared_pass;

static bool box_range(const mote_stream_body *body, size_t first, size_t end)
{
    const mote_positions *p = &body->positions;
    if (p->single)
        return p->stride == 3 * sizeof(float) ? box_packed_float(body, first, end)
                                              : box_strided_float(body, first, end);
    return p->stride == 3 * sizeof(double) ? box_packed_double(body, first, end)
                                           : box_strided_double(body, first, end);
}

static void box_shared_range(void *context, uint32_t worker, size_t first, size_t end)
{
    (void)worker;
    shared_pass *pass = context;
    if (!box_range(pass->body, first, end))
        atomic_store_explicit(&pass->doubtful, true, memory_order_relaxed);
}

/* The box around the boxes of a block, along axis k. */
MOTE_INLINE void enclose(const mote_stream_block *restrict block, size_t k, float *low,
                         float *high)
{
    float least[WIDTH], most[WIDTH];
    MOTE_LANE_LOOP
    for (size_t l = 0; l < WIDTH; ++l) {
        least[l] = block->low[k][l];
        most[l] = block->high[k][l];
    }
    for (size_t width = WIDTH / 2; width > 0; width /= 2) {
        for (size_t l = 0; l < width; ++l) {
            least[l] = least[l + width] < least[l] ? least[l + width] : least[l];
            most[l] = most[l + width] > most[l] ? most[l + width] : most[l];
        }
    }
    *low = least[0];
    *high = most[0];
}

/* The boxes of the levels above the groups. */
MOTE_CLONES
static void box_upper_levels(mote_stream_body *body)
{
    const mote_stream_tree *tree = body->tree;
    for (uint32_t level = tree->height - 1; level > 0; --level) {
        const mote_stream_block *from = &body->blocks[tree->first_block[level]];
        mote_stream_block *to = &body->blocks[tree->first_block[level - 1]];
        const uint32_t nodes = tree->first_block[level + 1] - tree->first_block[level];
        for (uint32_t i = 0; i < nodes; ++i) {
            for (size_t k = 0; k < 3; ++k)
                enclose(&from[i], k, &to[i / WIDTH].low[k][i % WIDTH],
                        &to[i / WIDTH].high[k][i % WIDTH]);
        }
        for (uint32_t i = nodes; i % WIDTH; ++i)
            empty_lane(&to[i / WIDTH], i % WIDTH);
    }
    for (size_t k = 0; k < 3; ++k)
        enclose(body->blocks, k, &body->root.low[k], &body->root.high[k]);
}

mote_status mote_stream_pass(mote_stream_body *body, mote_vec3 origin, double scale,
                             mote_pool *pool, int number)
{
    const mote_stream_tree *tree = body->tree;
    const size_t blocks = (size_t)(tree->groups - 1) / WIDTH + 1;
    body->placed = false;
    body->origin = origin;
    body->scale = scale;
    bool finite;
    if (pool && tree->mesh->triangle_count >= WORTH_THREADS) {
        shared_pass pass = {.body = body};
        mote_pool_run(pool, box_shared_range, &pass, blocks, GRAIN);
        finite = !atomic_load_explicit(&pass.doubtful, memory_order_relaxed);
    } else {
        finite = box_range(body, 0, blocks);
    }
    mote_status status = finite ? MOTE_OK : mote_stream_finite(body, number);
    if (status != MOTE_OK)
        return status;
    box_upper_levels(body);
    body->placed = body->checked = true;
    return MOTE_OK;
}
