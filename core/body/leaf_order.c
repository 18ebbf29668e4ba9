#include "core/body/leaf_order.h"

#include <stdbool.h>
#include <stdlib.h>

/* Data that only building needs. */
typedef struct builder {
    const mote_mesh *mesh;
    uint32_t leaf;       /* triangles of a leaf */
    uint32_t *order;     /* [triangle_count] */
    mote_vec3 *centroid; /* [poses][triangle_count], times three */
    uint32_t poses;      /* rest and the body's samples */
} builder;

static double coordinate(mote_vec3 v, int axis)
{
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

/* A direction to split along: centroids in one pose, and an axis. */
typedef struct direction {
    const mote_vec3 *centroid;
    int axis;
} direction;

/* The pose and the axis in which the centroids of a range of triangles have the largest extent.
 */
static direction longest_axis(const builder *b, uint32_t first, uint32_t end)
{
    direction best = {b->centroid, 0};
    double longest = -1;
    for (uint32_t i = 0; i < 3 * b->poses; i++) {
        const direction d = {b->centroid + (size_t)(i / 3) * b->mesh->triangle_count,
                             (int)(i % 3)};
        double low = HUGE_VAL, high = -HUGE_VAL;
        for (uint32_t k = first; k < end; k++) {
            double x = coordinate(d.centroid[b->order[k]], d.axis);
            low = x < low ? x : low;
            high = x > high ? x : high;
        }
        if (high - low > longest) {
            longest = high - low;
            best = d;
        }
    }
    return best;
}

static double median_of_three(double a, double b, double c)
{
    double low = a < b ? a : b, high = a < b ? b : a;
    return c < low ? low : c > high ? high : c;
}

/* Reorders the triangles first .. end - 1 so that along the axis none before `middle` is above
   one from `middle` on (Hoare's selection). */
static void select_middle(const builder *b, direction d, uint32_t first, uint32_t end,
                          uint32_t middle)
{
    const mote_vec3 *centroid = d.centroid;
    const int axis = d.axis;
    uint32_t *order = b->order;
    int64_t low = first, high = (int64_t)end - 1;
    while (low < high) {
        double pivot = median_of_three(coordinate(centroid[order[low]], axis),
                                       coordinate(centroid[order[(low + high) / 2]], axis),
                                       coordinate(centroid[order[high]], axis));
        int64_t i = low, j = high;
        while (i <= j) {
            while (coordinate(centroid[order[i]], axis) < pivot)
                i++;
            while (coordinate(centroid[order[j]], axis) > pivot)
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
   last may have fewer), by halving along the longest axis down to single leaves. */
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
    select_middle(b, longest_axis(b, from, end), from, end, from + left * b->leaf);
    arrange(b, first, left, unit);
    arrange(b, first + left, count - left, unit);
}

/* The centroids in one pose, times three. */
static void place_centroids(const builder *b, const mote_body *body, uint32_t pose)
{
    const mote_mesh *mesh = b->mesh;
    mote_vec3 *centroid = b->centroid + (size_t)pose * mesh->triangle_count;
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        const uint32_t *t = mesh->triangles[i];
        centroid[i] = mote_add(
            mote_add(mote_body_sample(body, pose, t[0]), mote_body_sample(body, pose, t[1])),
            mote_body_sample(body, pose, t[2]));
    }
}

mote_status mote_leaf_order(const mote_body *body, uint32_t leaf, uint32_t *order)
{
    const mote_mesh *mesh = body->mesh;
    builder b = {.mesh = mesh, .leaf = leaf, .order = order, .poses = 1 + body->sample_count};
    b.centroid = malloc((size_t)b.poses * mesh->triangle_count * sizeof *b.centroid);
    if (!b.centroid)
        return mote_fail(MOTE_ENOMEM, "no memory for the order of %u triangles",
                         mesh->triangle_count);
    for (uint32_t pose = 0; pose < b.poses; pose++)
        place_centroids(&b, body, pose);
    for (uint32_t i = 0; i < mesh->triangle_count; i++)
        order[i] = i;
    const uint32_t leaves = (uint32_t)(((uint64_t)mesh->triangle_count + leaf - 1) / leaf);
    uint32_t unit = 1;
    while (unit < (leaves + MOTE_LEAF_ORDER_WIDTH - 1) / MOTE_LEAF_ORDER_WIDTH)
        unit *= MOTE_LEAF_ORDER_WIDTH;
    arrange(&b, 0, leaves, unit);
    free(b.centroid);
    return MOTE_OK;
}
