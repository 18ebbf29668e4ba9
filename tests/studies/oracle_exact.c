#include "tests/studies/oracle_exact.h"

#include <gmp.h>
#include <limits.h>
#include <stdlib.h>

typedef struct vector {
    mpz_t x[3];
} vector;

struct exact {
    vector corner[6]; /* of s, then of t: coordinates times one power of two */
    vector edge[6];
    vector normal, axis;
    mpz_t product, height, low[2], high[2];
};

static void vector_init(vector *v)
{
    for (int k = 0; k < 3; k++)
        mpz_init(v->x[k]);
}

static void vector_clear(vector *v)
{
    for (int k = 0; k < 3; k++)
        mpz_clear(v->x[k]);
}

exact *exact_create(void)
{
    exact *e = malloc(sizeof *e);
    if (!e)
        return NULL;
    for (int i = 0; i < 6; i++) {
        vector_init(&e->corner[i]);
        vector_init(&e->edge[i]);
    }
    vector_init(&e->normal);
    vector_init(&e->axis);
    mpz_inits(e->product, e->height, e->low[0], e->low[1], e->high[0], e->high[1], NULL);
    return e;
}

void exact_destroy(exact *e)
{
    if (!e)
        return;
    for (int i = 0; i < 6; i++) {
        vector_clear(&e->corner[i]);
        vector_clear(&e->edge[i]);
    }
    vector_clear(&e->normal);
    vector_clear(&e->axis);
    mpz_clears(e->product, e->height, e->low[0], e->low[1], e->high[0], e->high[1], NULL);
    free(e);
}

static double coordinate(const mote_vec3 *v, int k)
{
    return k == 0 ? v->x : k == 1 ? v->y : v->z;
}

/* Converts all coordinates to integers times 2^exponent, with the smallest exponent among
   them. */
static void take_corners(exact *e, const mote_vec3 *corner[6])
{
    int smallest = INT_MAX, exponent;
    for (int i = 0; i < 18; i++) {
        double x = coordinate(corner[i / 3], i % 3);
        frexp(x, &exponent);
        smallest = x != 0 && exponent < smallest ? exponent : smallest;
    }
    for (int i = 0; i < 18; i++) {
        mpz_t *to = &e->corner[i / 3].x[i % 3];
        double mantissa = frexp(coordinate(corner[i / 3], i % 3), &exponent);
        mpz_set_d(*to, ldexp(mantissa, 53));
        if (mantissa != 0)
            mpz_mul_2exp(*to, *to, (mp_bitcnt_t)(exponent - smallest));
    }
    for (int i = 0; i < 6; i++) {
        const vector *from = &e->corner[i],
                     *next = &e->corner[i < 3 ? (i + 1) % 3 : 3 + (i - 2) % 3];
        for (int k = 0; k < 3; k++)
            mpz_sub(e->edge[i].x[k], next->x[k], from->x[k]);
    }
}

static void cross(vector *to, const vector *a, const vector *b)
{
    for (int k = 0; k < 3; k++) {
        mpz_mul(to->x[k], a->x[(k + 1) % 3], b->x[(k + 2) % 3]);
        mpz_submul(to->x[k], a->x[(k + 2) % 3], b->x[(k + 1) % 3]);
    }
}

static void dot(mpz_t to, const vector *a, const vector *b)
{
    mpz_mul(to, a->x[0], b->x[0]);
    mpz_addmul(to, a->x[1], b->x[1]);
    mpz_addmul(to, a->x[2], b->x[2]);
}

static bool is_zero(const vector *v)
{
    return mpz_sgn(v->x[0]) == 0 && mpz_sgn(v->x[1]) == 0 && mpz_sgn(v->x[2]) == 0;
}

/* True if the triangles' projections onto the axis do not meet. */
static bool separates(exact *e, const vector *axis)
{
    for (int i = 0; i < 6; i++) {
        dot(e->height, axis, &e->corner[i]);
        int side = i / 3;
        if (i % 3 == 0 || mpz_cmp(e->height, e->low[side]) < 0)
            mpz_set(e->low[side], e->height);
        if (i % 3 == 0 || mpz_cmp(e->height, e->high[side]) > 0)
            mpz_set(e->high[side], e->height);
    }
    return mpz_cmp(e->low[0], e->high[1]) > 0 || mpz_cmp(e->low[1], e->high[0]) > 0;
}

/* Returns the number of dimensions that the edges span (2 stands for 2 and 3). *line: the first
   nonzero edge; e->normal: its cross product with an edge that is not parallel to it. */
static int span(exact *e, const vector **line)
{
    *line = NULL;
    for (int i = 0; i < 6; i++) {
        if (is_zero(&e->edge[i]))
            continue;
        if (!*line) {
            *line = &e->edge[i];
            continue;
        }
        cross(&e->normal, *line, &e->edge[i]);
        if (!is_zero(&e->normal))
            return 2;
    }
    return *line ? 1 : 0;
}

static bool is_solid(exact *e)
{
    for (int i = 0; i < 6; i++) {
        dot(e->product, &e->normal, &e->edge[i]);
        if (mpz_sgn(e->product) != 0)
            return true;
    }
    return false;
}

/* Three dimensions: the axes are both triangles' normals and the cross products of their
   edges. */
static bool apart_in_space(exact *e)
{
    for (int i = 0; i < 6; i += 3) {
        cross(&e->axis, &e->edge[i], &e->edge[i + 1]);
        if (separates(e, &e->axis))
            return true;
    }
    for (int i = 0; i < 9; i++) {
        cross(&e->axis, &e->edge[i / 3], &e->edge[3 + i % 3]);
        if (separates(e, &e->axis))
            return true;
    }
    return false;
}

/* Two dimensions: the normal of the plane, and the normals of the edges within it. */
static bool apart_in_plane(exact *e)
{
    if (separates(e, &e->normal))
        return true;
    for (int i = 0; i < 6; i++) {
        cross(&e->axis, &e->normal, &e->edge[i]);
        if (separates(e, &e->axis))
            return true;
    }
    return false;
}

/* One dimension: axes across the line (three that span all directions across it), then along
   it. */
static bool apart_on_line(exact *e, const vector *line)
{
    for (int k = 0; k < 3; k++) {
        mpz_set_ui(e->axis.x[k], 0);
        mpz_set(e->axis.x[(k + 1) % 3], line->x[(k + 2) % 3]);
        mpz_neg(e->axis.x[(k + 2) % 3], line->x[(k + 1) % 3]);
        if (separates(e, &e->axis))
            return true;
    }
    return separates(e, line);
}

exact_verdict exact_triangles(exact *e, const mote_vec3 s[3], const mote_vec3 t[3])
{
    const mote_vec3 *corner[6] = {&s[0], &s[1], &s[2], &t[0], &t[1], &t[2]};
    take_corners(e, corner);
    const vector *line;
    int dimensions = span(e, &line);
    exact_verdict verdict = {.solid = dimensions == 2 && is_solid(e)};
    if (verdict.solid)
        verdict.touch = !apart_in_space(e);
    else if (dimensions == 2)
        verdict.touch = !apart_in_plane(e);
    else if (dimensions == 1)
        verdict.touch = !apart_on_line(e, line);
    else
        verdict.touch = s[0].x == t[0].x && s[0].y == t[0].y && s[0].z == t[0].z;
    return verdict;
}
