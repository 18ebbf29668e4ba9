#include "core/body/sample_split.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

/* Triangles by which a split is judged. With 256, aabb-tree made 3 % fewer box tests on ww and
   FCL's boxes 6 % more, and building took three times as long. */
#define JUDGED 64

/* Neither part has less than this share of the triangles, so that a tree stays shallow. */
#define LEAST_PART 8

void mote_sample_boxes_free(mote_sample_boxes *boxes)
{
    free(boxes->box);
    *boxes = (mote_sample_boxes){0};
}

static float component(mote_vec3 v, int axis)
{
    return (float)(axis == 0 ? v.x : axis == 1 ? v.y : v.z);
}

static void empty(mote_sample_box *box)
{
    for (int k = 0; k < 3; ++k) {
        box->low[k] = HUGE_VALF;
        box->high[k] = -HUGE_VALF;
    }
}

static void add(mote_sample_box *box, const mote_sample_box *other)
{
    for (int k = 0; k < 3; ++k) {
        box->low[k] = other->low[k] < box->low[k] ? other->low[k] : box->low[k];
        box->high[k] = other->high[k] > box->high[k] ? other->high[k] : box->high[k];
    }
}

/* Half of the surface. */
static float area(const mote_sample_box *box)
{
    const float x = box->high[0] - box->low[0], y = box->high[1] - box->low[1],
                z = box->high[2] - box->low[2];
    return x * y + y * z + z * x;
}

/* Places the vertices in pose `place` of the body and boxes the triangles. */
static void box_pose(const mote_body *body, uint32_t place, mote_vec3 *vertices,
                     mote_sample_box *boxes)
{
    const mote_mesh *mesh = body->mesh;
    const mote_vec3 middle = mote_add(mote_scale(mesh->low, 0.5), mote_scale(mesh->high, 0.5));
    for (uint32_t i = 0; i < mesh->vertex_count; ++i)
        vertices[i] =
            mote_scale(mote_sub(mote_body_sample(body, place, i), middle), 1 / mesh->diagonal);
    for (uint32_t t = 0; t < mesh->triangle_count; ++t) {
        empty(&boxes[t]);
        for (int k = 0; k < 3; ++k) {
            const mote_vec3 v = vertices[mesh->triangles[t][k]];
            const mote_sample_box corner = {
                {component(v, 0), component(v, 1), component(v, 2)},
                {component(v, 0), component(v, 1), component(v, 2)}};
            add(&boxes[t], &corner);
        }
    }
}

mote_status mote_sample_boxes_init(mote_sample_boxes *boxes, const mote_body *body)
{
    const uint32_t samples = body->sample_count < MOTE_SAMPLE_POSES_MAX
                                 ? body->sample_count
                                 : MOTE_SAMPLE_POSES_MAX - 1;
    *boxes = (mote_sample_boxes){.poses = 1 + samples, .triangles = body->mesh->triangle_count};
    mote_vec3 *vertices = calloc(body->mesh->vertex_count, sizeof *vertices);
    boxes->box = calloc((size_t)boxes->poses * boxes->triangles, sizeof *boxes->box);
    if (!vertices || !boxes->box) {
        free(vertices);
        return mote_fail(MOTE_ENOMEM, "no memory for %u poses of %u triangles", boxes->poses,
                         boxes->triangles);
    }
    for (uint32_t pose = 0; pose < boxes->poses; ++pose) {
        const uint64_t even = (uint64_t)pose * body->sample_count;
        const uint32_t place = samples > 0 ? (uint32_t)(even / samples) : 0;
        box_pose(body, place, vertices, boxes->box + (size_t)pose * boxes->triangles);
    }
    free(vertices);
    return MOTE_OK;
}

/* A triangle, by the key along which the triangles are sorted. */
typedef struct keyed {
    float key;
    uint32_t triangle;
} keyed;

static int by_key(const void *a, const void *b)
{
    const keyed *x = a, *y = b;
    if (x->key != y->key)
        return x->key < y->key ? -1 : 1;
    return x->triangle < y->triangle ? -1 : x->triangle > y->triangle;
}

/* Adds, for each place between sorted triangles, what the split there costs in one pose: the
   areas of both parts' boxes, times their triangles, by the area of the box of both. */
static void add_costs(const mote_sample_boxes *boxes, uint32_t pose, const keyed *sorted,
                      uint32_t count, float cost[JUDGED])
{
    const mote_sample_box *all = boxes->box + (size_t)pose * boxes->triangles;
    float left[JUDGED];
    mote_sample_box sum;
    empty(&sum);
    for (uint32_t i = 1; i < count; ++i) {
        add(&sum, &all[sorted[i - 1].triangle]);
        left[i] = area(&sum) * (float)i;
    }
    add(&sum, &all[sorted[count - 1].triangle]);
    const float whole = area(&sum), unit = whole > 0 ? 1 / whole : 0;
    empty(&sum);
    for (uint32_t i = count - 1; i > 0; --i) {
        add(&sum, &all[sorted[i].triangle]);
        cost[i] += (left[i] + area(&sum) * (float)(count - i)) * unit;
    }
}

/* What a search over directions has found. */
typedef struct best_split {
    mote_sample_split split;
    float cost;
} best_split;

/* Judges the splits along one direction. Triangles are in `sorted`, in any order. */
static void judge(const mote_sample_boxes *boxes, uint32_t pose, int axis, keyed *sorted,
                  uint32_t count, uint32_t fixed, best_split *best)
{
    float cost[JUDGED] = {0};
    for (uint32_t i = 0; i < count; ++i)
        sorted[i].key = mote_sample_key(boxes, pose, axis, sorted[i].triangle);
    qsort(sorted, count, sizeof *sorted, by_key);
    for (uint32_t p = 0; p < boxes->poses; ++p)
        add_costs(boxes, p, sorted, count, cost);
    const uint32_t least = count / LEAST_PART > 1 ? count / LEAST_PART : 1;
    const uint32_t first = fixed > 0 ? fixed : least;
    const uint32_t last = fixed > 0 ? fixed : count - least;
    for (uint32_t i = first; i <= last; ++i) {
        if (sorted[i - 1].key < sorted[i].key && cost[i] < best->cost)
            *best = (best_split){{pose, axis, sorted[i].key}, cost[i]};
    }
}

mote_sample_split mote_sample_split_best(const mote_sample_boxes *boxes,
                                         const uint32_t *triangles, uint32_t count,
                                         uint32_t left)
{
    assert(count > 0);
    keyed sorted[JUDGED];
    const uint32_t judged = count < JUDGED ? count : JUDGED;
    for (uint32_t i = 0; i < judged; ++i)
        sorted[i].triangle = triangles[(uint64_t)i * count / judged];
    uint32_t fixed = (uint32_t)((uint64_t)left * judged / count);
    if (left > 0 && fixed == 0)
        fixed = 1;
    best_split best = {{0, 0, -HUGE_VALF}, HUGE_VALF};
    for (uint32_t pose = 0; pose < boxes->poses; ++pose) {
        for (int axis = 0; axis < 3; ++axis)
            judge(boxes, pose, axis, sorted, judged, fixed, &best);
    }
    return best.split;
}
