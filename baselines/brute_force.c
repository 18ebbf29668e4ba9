/* brute-force: every pair of triangles of the two bodies. Only their boxes are compared first,
   many at a time. There is no tree, no order and no state between frames, so that it cannot be
   wrong for the same reasons as the other methods. */
#include "baselines/input.h"
#include "core/base/clones.h"
#include "core/method/method.h"
#include "core/body/triangle.h"

#include <stdlib.h>
#include <string.h>

enum { POSITIONS, PARAMETER_COUNT };

static const mote_parameter parameters[PARAMETER_COUNT] = {
    [POSITIONS] = {"positions", MOTE_PARAMETER_CHOICE, 0, 0, "deform|given", "deform",
                   "deform: pay for deforming all vertices; given: they come free of charge"},
};

/* Boxes of a block that are compared with one box at a time. */
#define BLOCK 64

/* Boxes in floats, in the unit of the pair and relative to the frame's origin. Halves are
   rounded up so far that the rounding of a comparison never makes a gap too large. The boxes
   are padded to whole blocks with such that are infinitely far away. */
typedef struct box_list {
    uint32_t count, blocks;
    float *centre[3], *half[3]; /* [BLOCK * blocks] */
} box_list;

typedef struct brute_state {
    mote_setup setup;
    double scale; /* brings L near 1: a power of two */
    mote_vec3 origin;
    box_list boxes[2];
} brute_state;

/* The best pair so far. */
typedef struct pair_bound {
    double squared;
    mote_vec3 p, q;
} pair_bound;

static mote_traits traits(const double *values)
{
    bool given = values[POSITIONS] > 0;
    return (mote_traits){.needs_vertices = !given, .given_vertices = given, .exact = true};
}

static void destroy(void *state)
{
    brute_state *s = state;
    if (!s)
        return;
    for (int b = 0; b < 2; b++)
        free(s->boxes[b].centre[0]);
    free(s);
}

static mote_status make_boxes(box_list *boxes, uint32_t triangles)
{
    boxes->count = triangles;
    boxes->blocks = (triangles + BLOCK - 1) / BLOCK;
    size_t stride = (size_t)boxes->blocks * BLOCK;
    float *memory = malloc(6 * stride * sizeof *memory);
    if (!memory)
        return mote_fail(MOTE_ENOMEM, "no memory for %u boxes", triangles);
    for (size_t k = 0; k < 3; k++) {
        boxes->centre[k] = memory + 2 * k * stride;
        boxes->half[k] = memory + (2 * k + 1) * stride;
        for (size_t i = triangles; i < stride; i++) {
            boxes->centre[k][i] = 0;
            boxes->half[k][i] = -HUGE_VALF;
        }
    }
    return MOTE_OK;
}

static mote_status create(const mote_setup *setup, void **state)
{
    mote_status status = mote_input_check(setup);
    if (status != MOTE_OK)
        return status;
    brute_state *s = calloc(1, sizeof *s);
    if (!s)
        return mote_fail(MOTE_ENOMEM, "no memory for brute-force");
    s->setup = *setup;
    s->scale = ldexp(1, -ilogb(setup->length));
    for (int b = 0; b < 2 && status == MOTE_OK; b++)
        status = make_boxes(&s->boxes[b], setup->body[b]->mesh->triangle_count);
    if (status != MOTE_OK) {
        destroy(s);
        return status;
    }
    *state = s;
    return MOTE_OK;
}

static inline double smallest(double a, double b, double c)
{
    a = b < a ? b : a;
    return c < a ? c : a;
}

static inline double largest(double a, double b, double c)
{
    a = b > a ? b : a;
    return c > a ? c : a;
}

/* One side of a box: the half covers the rounding of the centre and of every comparison. */
static inline void set_side(box_list *boxes, int k, uint32_t i, double a, double b, double c)
{
    double low = smallest(a, b, c), high = largest(a, b, c);
    float centre = (float)(0.5 * (low + high));
    double half = largest(high - (double)centre, (double)centre - low, 0);
    boxes->centre[k][i] = centre;
    boxes->half[k][i] = (float)(half + 0x1p-21 * (half + fabs((double)centre)));
}

static void corners(const brute_state *s, const mote_frame *frame, int b, uint32_t i,
                    mote_vec3 corner[3])
{
    const uint32_t *t = s->setup.body[b]->mesh->triangles[i];
    for (int k = 0; k < 3; k++)
        corner[k] = frame->body[b].vertices[t[k]];
}

static mote_status update(void *state, const mote_frame *frame)
{
    brute_state *s = state;
    for (int b = 0; b < 2; b++) {
        uint32_t count = s->setup.body[b]->mesh->vertex_count;
        mote_status status = mote_input_check_vertices(frame->body[b].vertices, count, b);
        if (status != MOTE_OK)
            return status;
    }
    s->origin = frame->body[0].vertices[0];
    for (int b = 0; b < 2; b++) {
        for (uint32_t i = 0; i < s->setup.body[b]->mesh->triangle_count; i++) {
            mote_vec3 c[3];
            corners(s, frame, b, i, c);
            for (int k = 0; k < 3; k++)
                c[k] = mote_scale(mote_sub(c[k], s->origin), s->scale);
            set_side(&s->boxes[b], 0, i, c[0].x, c[1].x, c[2].x);
            set_side(&s->boxes[b], 1, i, c[0].y, c[1].y, c[2].y);
            set_side(&s->boxes[b], 2, i, c[0].z, c[1].z, c[2].z);
        }
    }
    return MOTE_OK;
}

/* Lists in near the boxes of a block that are at most as far from box i of a as the bound;
   returns how many there are. gap + |gap| is 2 max(gap, 0), so that four times the squared
   distances are compared. A bound that floats cannot square is infinite: then the boxes that
   pad the last block would be near, too. */
MOTE_CLONES
static uint32_t near_boxes(const box_list *a, uint32_t i, const box_list *b, uint32_t block,
                           float bound_squared, uint32_t near[BLOCK])
{
    float squared[BLOCK];
    size_t start = (size_t)block * BLOCK;
    const float *cx = b->centre[0] + start, *cy = b->centre[1] + start,
                *cz = b->centre[2] + start;
    const float *hx = b->half[0] + start, *hy = b->half[1] + start, *hz = b->half[2] + start;
    float ax = a->centre[0][i], ay = a->centre[1][i], az = a->centre[2][i];
    float ux = a->half[0][i], uy = a->half[1][i], uz = a->half[2][i];
    float limit = 4 * bound_squared;
    int any = 0;
    for (int k = 0; k < BLOCK; k++) {
        float gx = fabsf(cx[k] - ax) - (hx[k] + ux), x = gx + fabsf(gx);
        float gy = fabsf(cy[k] - ay) - (hy[k] + uy), y = gy + fabsf(gy);
        float gz = fabsf(cz[k] - az) - (hz[k] + uz), z = gz + fabsf(gz);
        squared[k] = x * x + y * y + z * z;
        any |= squared[k] <= limit;
    }
    if (!any)
        return 0;
    const uint32_t triangles = b->count - block * BLOCK;
    uint32_t count = 0;
    for (uint32_t k = 0; k < BLOCK && k < triangles; k++) {
        near[count] = k;
        count += squared[k] <= limit;
    }
    return count;
}

/* The vertex of body b nearest to p. */
static mote_vec3 nearest_vertex(const brute_state *s, const mote_frame *frame, int b,
                                mote_vec3 p)
{
    const mote_vec3 *vertices = frame->body[b].vertices;
    mote_vec3 best = vertices[0];
    for (uint32_t i = 1; i < s->setup.body[b]->mesh->vertex_count; i++) {
        if (mote_distance_squared(p, vertices[i]) < mote_distance_squared(p, best))
            best = vertices[i];
    }
    return best;
}

/* A first bound: two vertices, each the nearest to the other. */
static pair_bound first_bound(const brute_state *s, const mote_frame *frame)
{
    mote_vec3 p = frame->body[0].vertices[0], q = nearest_vertex(s, frame, 1, p);
    pair_bound best = {mote_distance_squared(p, q), p, q};
    for (int turn = 0;; turn = 1 - turn) {
        if (turn == 0)
            p = nearest_vertex(s, frame, 0, q);
        else
            q = nearest_vertex(s, frame, 1, p);
        double squared = mote_distance_squared(p, q);
        if (!(squared < best.squared))
            return best;
        best = (pair_bound){squared, p, q};
    }
}

/* The bound in the boxes' unit, rounded up. */
static float float_bound(const brute_state *s, double squared)
{
    double bound = squared * s->scale * s->scale * (1 + 0x1p-20);
    return bound < 1e38 ? (float)bound : HUGE_VALF;
}

/* Measures box i of body 0 against the near boxes of one block of body 1. */
static void measure_block(const brute_state *s, const mote_frame *frame, uint32_t i,
                          uint32_t block, pair_bound *best, mote_counters *counters)
{
    uint32_t near[BLOCK];
    uint32_t count =
        near_boxes(&s->boxes[0], i, &s->boxes[1], block, float_bound(s, best->squared), near);
    counters->box_tests += BLOCK;
    mote_vec3 a[3], b[3], p, q;
    if (count > 0)
        corners(s, frame, 0, i, a);
    for (uint32_t k = 0; k < count; k++) {
        corners(s, frame, 1, block * BLOCK + near[k], b);
        double squared = mote_triangle_triangle_below(a, b, best->squared, &p, &q);
        if (squared < best->squared)
            *best = (pair_bound){squared, p, q};
    }
    counters->triangle_tests += count;
}

static mote_status query(void *state, const mote_frame *frame, mote_answer *answer)
{
    const brute_state *s = state;
    bool contact_only = s->setup.ask == MOTE_ASK_CONTACT;
    double enough = contact_only ? s->setup.tolerance * s->setup.tolerance : 0;
    pair_bound best = first_bound(s, frame);
    if (contact_only && best.squared > enough)
        best.squared = nextafter(enough, HUGE_VAL);
    uint32_t triangles = s->setup.body[0]->mesh->triangle_count;
    for (uint32_t i = 0; i < triangles && best.squared > enough; i++) {
        for (uint32_t block = 0; block < s->boxes[1].blocks && best.squared > enough; block++)
            measure_block(s, frame, i, block, &best, &answer->counters);
    }
    double distance = sqrt(best.squared);
    answer->has_contact = true;
    answer->contact = contact_only ? best.squared <= enough : distance <= s->setup.tolerance;
    if (contact_only)
        return MOTE_OK;
    answer->has_distance = answer->has_witness = true;
    answer->distance = distance;
    answer->witness[0] = best.p;
    answer->witness[1] = best.q;
    return MOTE_OK;
}

MOTE_METHOD(brute_force) = {
    .name = "brute-force",
    .summary = "all pairs of triangles, rejected by their boxes; no tree, no state",
    .parameters = parameters,
    .parameter_count = PARAMETER_COUNT,
    .traits = traits,
    .create = create,
    .destroy = destroy,
    .update = update,
    .query = query,
};
