#include "core/body/leaf_order.h"

#include "core/body/sample_split.h"

#include <stdbool.h>
#include <stdlib.h>

/* Data that only building needs. */
typedef struct builder {
    const mote_mesh *mesh;
    uint32_t leaf;                    /* triangles of a leaf */
    uint32_t *order;                  /* [triangle_count] */
    mote_vec3 *centroid;              /* [triangle_count], at rest, times three */
    const mote_sample_boxes *samples; /* NULL: the body has none */
} builder;

/* What the triangles of a range are ordered by. */
typedef struct direction {
    uint32_t pose;
    int axis;
} direction;

static double coordinate(mote_vec3 v, int axis)
{
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

static double key(const builder *b, direction d, uint32_t triangle)
{
    if (b->samples)
        return (double)mote_sample_key(b->samples, d.pose, d.axis, triangle);
    return coordinate(b->centroid[triangle], d.axis);
}

/* The axis along which the centroids of a range of triangles have the largest extent. */
static direction longest_axis(const builder *b, uint32_t first, uint32_t end)
{
    direction best = {0, 0};
    double longest = -1;
    for (int axis = 0; axis < 3; axis++) {
        double low = HUGE_VAL, high = -HUGE_VAL;
        for (uint32_t k = first; k < end; k++) {
            double x = coordinate(b->centroid[b->order[k]], axis);
            low = x < low ? x : low;
            high = x > high ? x : high;
        }
        if (high - low > longest) {
            longest = high - low;
            best.axis = axis;
        }
    }
    return best;
}

/* The direction to split a range along, of which the first `left` triangles become one part. */
static direction choose(const builder *b, uint32_t first, uint32_t end, uint32_t left)
{
    if (!b->samples)
        return longest_axis(b, first, end);
    const mote_sample_split split =
        mote_sample_split_best(b->samples, b->order + first, end - first, left);
    return (direction){split.pose, split.axis};
}

static double median_of_three(double a, double b, double c)
{
    double low = a < b ? a : b, high = a < b ? b : a;
    return c < low ? low : c > high ? high : c;
}

/* Reorders the triangles first .. end - 1 so that along the direction none before `middle` is
   above one from `middle` on (Hoare's selection). */
static void select_middle(const builder *b, direction d, uint32_t first, uint32_t end,
                          uint32_t middle)
{
    uint32_t *order = b->order;
    int64_t low = first, high = (int64_t)end - 1;
    while (low < high) {
        double pivot = median_of_three(
            key(b, d, order[low]), key(b, d, order[(low + high) / 2]), key(b, d, order[high]));
        int64_t i = low, j = high;
        while (i <= j) {
            while (key(b, d, order[i]) < pivot)
                i++;
            while (key(b, d, order[j]) > pivot)
                j--;
            if (i <= j) {
                uint32_t kept = order[i];
                order[i++] = order[j];
                order[j--] = kept;
            }
        }
        if (middle <= j)
            high = j;
        else if (middle >= i)
            low = i;
        else
            return;
    }
}

/* Arranges `count` leaves, starting at leaf `first`, into subtrees of `unit` leaves each (the
   last may have fewer), by halving along a direction down to single leaves. */
static void arrange(const builder *b, uint32_t first, uint32_t count, uint32_t unit)
{
    while (unit > 1 && count <= unit)
        unit /= MOTE_LEAF_ORDER_WIDTH;
    if (count <= unit)
        return;
    uint32_t children = (count + unit - 1) / unit, left = children / 2 * unit;
    const uint64_t triangles = b->mesh->triangle_count;
    const uint64_t past = ((uint64_t)first + count) * b->leaf;
    const uint32_t from = first * b->leaf;
    const uint32_t end = (uint32_t)(past < triangles ? past : triangles);
    const uint32_t on_the_left = left * b->leaf;
    select_middle(b, choose(b, from, end, on_the_left), from, end, from + on_the_left);
    arrange(b, first, left, unit);
    arrange(b, first + left, count - left, unit);
}

/* Orders the triangles, whose centroids are set. */
static void arrange_all(const builder *b)
{
    const uint64_t triangles = b->mesh->triangle_count;
    const uint32_t leaves = (uint32_t)((triangles + b->leaf - 1) / b->leaf);
    uint32_t unit = 1;
    while (unit < (leaves + MOTE_LEAF_ORDER_WIDTH - 1) / MOTE_LEAF_ORDER_WIDTH)
        unit *= MOTE_LEAF_ORDER_WIDTH;
    arrange(b, 0, leaves, unit);
}

mote_status mote_leaf_order(const mote_body *body, uint32_t leaf, uint32_t *order)
{
    const mote_mesh *mesh = body->mesh;
    mote_sample_boxes boxes = {0};
    builder b = {.mesh = mesh, .leaf = leaf, .order = order};
    b.centroid = malloc((size_t)mesh->triangle_count * sizeof *b.centroid);
    if (!b.centroid)
        return mote_fail(MOTE_ENOMEM, "no memory for the order of %u triangles",
                         mesh->triangle_count);
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        const uint32_t *t = mesh->triangles[i];
        b.centroid[i] = mote_add(mote_add(mesh->positions[t[0]], mesh->positions[t[1]]),
                                 mesh->positions[t[2]]);
        order[i] = i;
    }
    mote_status status = MOTE_OK;
    if (body->sample_count > 0) {
        status = mote_sample_boxes_init(&boxes, body);
        b.samples = &boxes;
    }
    if (status == MOTE_OK)
        arrange_all(&b);
    mote_sample_boxes_free(&boxes);
    free(b.centroid);
    return status;
}
