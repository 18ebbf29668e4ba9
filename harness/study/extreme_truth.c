/* The exact distance between two small bodies: every pair of triangles in 113 bits. */
#include "harness/study/extreme.h"

#include "harness/base/memory.h"
#include "baselines/wide_triangle.h"

#include <stdlib.h>

/* Boxes in doubles, rounded outwards. */
typedef struct wide_box {
    double low[3], high[3];
} wide_box;

typedef struct wide_body {
    const mote_mesh *mesh;
    wide3 *world;    /* [vertex_count] */
    wide_box *boxes; /* [triangle_count] */
} wide_body;

/* The square root to full precision: two Newton steps from the square root in double
   precision. */
static wide square_root(wide x)
{
    if (!(x > 0))
        return 0;
    wide y = (wide)sqrt((double)x);
    y = (y + x / y) / 2;
    return (y + x / y) / 2;
}

static wide wendland(wide r)
{
    if (r >= 1)
        return 0;
    const wide s = (1 - r) * (1 - r);
    return s * s * (4 * r + 1);
}

/* The world position defined in core/body/body.h, without rounding. */
static wide3 position(const mote_body *body, const mote_body_state *state, uint32_t vertex)
{
    const wide3 x = wide_from(body->mesh->positions[vertex]);
    const mote_field *field = body->field;
    wide3 p = wide_from(state->pose.translation);
    const double(*m)[3] = state->pose.rotation.m;
    p.x += (wide)m[0][0] * x.x + (wide)m[0][1] * x.y + (wide)m[0][2] * x.z;
    p.y += (wide)m[1][0] * x.x + (wide)m[1][1] * x.y + (wide)m[1][2] * x.z;
    p.z += (wide)m[2][0] * x.x + (wide)m[2][1] * x.y + (wide)m[2][2] * x.z;
    for (uint32_t j = 0; j < field->count; ++j) {
        const wide3 c = {(wide)field->centre_x[j], (wide)field->centre_y[j],
                         (wide)field->centre_z[j]};
        const wide3 d = wide_sub(x, c);
        const wide phi = wendland(square_root(wide_dot(d, d)) / (wide)field->support);
        const wide3 w = {(wide)state->weights.x[j], (wide)state->weights.y[j],
                         (wide)state->weights.z[j]};
        p = wide_along(p, phi, w);
    }
    return p;
}

static wide_box box_of(const wide_body *body, const uint32_t *t)
{
    wide_box box = {{HUGE_VAL, HUGE_VAL, HUGE_VAL}, {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}};
    for (int k = 0; k < 3; ++k) {
        const wide3 p = body->world[t[k]];
        const double at[3] = {(double)p.x, (double)p.y, (double)p.z};
        for (int axis = 0; axis < 3; ++axis) {
            box.low[axis] = fmin(box.low[axis], nextafter(at[axis], -HUGE_VAL));
            box.high[axis] = fmax(box.high[axis], nextafter(at[axis], HUGE_VAL));
        }
    }
    return box;
}

/* A lower bound of the squared distance between two boxes. */
static double box_gap(const wide_box *a, const wide_box *b)
{
    double sum = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double gap =
            fmax(fmax(a->low[axis] - b->high[axis], b->low[axis] - a->high[axis]), 0);
        sum += gap * gap;
    }
    return sum * (1 - 0x1p-50);
}

/* The squared distance between two vertices that are near each other. */
static wide first_bound(const wide_body body[2])
{
    const wide3 *world[2] = {body[0].world, body[1].world};
    uint32_t best[2] = {0, 0};
    double least = HUGE_VAL;
    for (uint32_t i = 0; i < body[0].mesh->vertex_count; ++i) {
        for (uint32_t j = 0; j < body[1].mesh->vertex_count; ++j) {
            const double x = (double)(world[0][i].x - world[1][j].x);
            const double y = (double)(world[0][i].y - world[1][j].y);
            const double z = (double)(world[0][i].z - world[1][j].z);
            const double squared = x * x + y * y + z * z;
            if (squared < least) {
                least = squared;
                best[0] = i;
                best[1] = j;
            }
        }
    }
    const wide3 d = wide_sub(world[0][best[0]], world[1][best[1]]);
    return wide_dot(d, d);
}

/* The squared distance between triangle i of one body and j of the other. */
static wide pair_squared(const wide_body body[2], uint32_t i, uint32_t j)
{
    const uint32_t *s = body[0].mesh->triangles[i], *t = body[1].mesh->triangles[j];
    wide3 a[3], b[3];
    for (int k = 0; k < 3; ++k) {
        a[k] = body[0].world[s[k]];
        b[k] = body[1].world[t[k]];
    }
    for (int k = 0; k < 3; ++k) {
        if (reference_pierces(a[k], a[(k + 1) % 3], b) ||
            reference_pierces(b[k], b[(k + 1) % 3], a))
            return 0;
    }
    return reference_apart(a, b);
}

static double distance(const wide_body body[2])
{
    wide best = first_bound(body);
    for (uint32_t i = 0; i < body[0].mesh->triangle_count; ++i) {
        for (uint32_t j = 0; j < body[1].mesh->triangle_count && best > 0; ++j) {
            if (box_gap(&body[0].boxes[i], &body[1].boxes[j]) > (double)best * (1 + 0x1p-50))
                continue;
            best = wide_min(best, pair_squared(body, i, j));
        }
    }
    return wide_sqrt(best);
}

/* Sets a frame's positions, rounded to doubles as methods get them, or unrounded. */
static void place(const mote_extreme *e, uint32_t frame, bool rounded, wide_body body[2],
                  double *coordinate_max)
{
    for (int b = 0; b < 2; ++b) {
        const mote_body_state *state = &e->frame[frame].body[b];
        for (uint32_t v = 0; v < e->mesh[b]->vertex_count; ++v) {
            const mote_vec3 p = mote_body_position(&e->body[b], state, v);
            *coordinate_max =
                fmax(fmax(*coordinate_max, fabs(p.x)), fmax(fabs(p.y), fabs(p.z)));
            body[b].world[v] = rounded ? wide_from(p) : position(&e->body[b], state, v);
        }
        for (uint32_t t = 0; t < e->mesh[b]->triangle_count; ++t)
            body[b].boxes[t] = box_of(&body[b], e->mesh[b]->triangles[t]);
    }
}

void mote_extreme_measure(mote_extreme *e)
{
    wide_body body[2] = {{.mesh = e->mesh[0]}, {.mesh = e->mesh[1]}};
    for (int b = 0; b < 2; ++b) {
        body[b].world = mote_allocate(e->mesh[b]->vertex_count, sizeof *body[b].world);
        body[b].boxes = mote_allocate(e->mesh[b]->triangle_count, sizeof *body[b].boxes);
    }
    e->coordinate_max = 0;
    for (uint32_t f = 0; f < MOTE_EXTREME_FRAMES; ++f) {
        place(e, f, true, body, &e->coordinate_max);
        e->truth[f] = distance(body);
        place(e, f, false, body, &e->coordinate_max);
        e->unrounded[f] = distance(body);
    }
    for (int b = 0; b < 2; ++b) {
        free(body[b].world);
        free(body[b].boxes);
    }
}

double mote_extreme_surface(const mote_extreme *e, uint32_t frame, int b, mote_vec3 point)
{
    const mote_mesh *mesh = e->mesh[b];
    const mote_body_state *state = &e->frame[frame].body[b];
    wide least = (wide)HUGE_VAL;
    for (uint32_t t = 0; t < mesh->triangle_count; ++t) {
        wide3 corner[3];
        for (int k = 0; k < 3; ++k)
            corner[k] =
                wide_from(mote_body_position(&e->body[b], state, mesh->triangles[t][k]));
        least = wide_min(least, reference_point_triangle(wide_from(point), corner));
    }
    return (double)least;
}
