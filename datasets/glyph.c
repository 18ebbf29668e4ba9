#include "datasets/glyph.h"

#include <math.h>
#include <stdbool.h>

/* Design units: capitals are 1 high, from centre line to centre line. */
#define HALF_WIDTH 0.11
#define HALF_DEPTH 0.11
#define ROUNDING 0.07
#define BLEND 0.1

#define SINE_120 0.86602540378443865
#define SINE_135 0.70710678118654752

/* A line from (x0, y0) to (x1, y1) when radius is 0; else an arc about (x0, y0), see
   mote_stroke, with the middle direction (x1, y1). */
typedef struct design_stroke {
    double x0, y0, x1, y1;
    double radius, sine, cosine;
    bool continues;
} design_stroke;

typedef struct design {
    char letter;
    unsigned holes;
    design_stroke strokes[MOTE_GLYPH_STROKES]; /* unused ones are all 0 */
} design;

/* clang-format off */
/* One stroke: a line, an arc, or either of them continuing the stroke before it. */
#define LINE(x0, y0, x1, y1) {x0, y0, x1, y1, 0, 0, 0, false}
#define ARC(x0, y0, x1, y1, radius, sine, cosine) {x0, y0, x1, y1, radius, sine, cosine, false}
#define THEN_LINE(x0, y0, x1, y1) {x0, y0, x1, y1, 0, 0, 0, true}
#define THEN_ARC(x0, y0, x1, y1, radius, sine, cosine) {x0, y0, x1, y1, radius, sine, cosine, true}

static const design designs[] = {
    {'A', 1, {LINE(-0.5, 0, 0, 1), LINE(0, 1, 0.5, 0), LINE(-0.36, 0.26, 0.36, 0.26)}},
    {'B',
     2,
     {LINE(-0.3, 0, -0.3, 1),
      LINE(-0.3, 1, 0.05, 1),
      THEN_ARC(0.05, 0.75, 1, 0, 0.25, 1, 0),
      THEN_LINE(0.05, 0.5, -0.3, 0.5),
      ARC(0.05, 0.25, 1, 0, 0.25, 1, 0),
      THEN_LINE(0.05, 0, -0.3, 0)}},
    {'C', 0, {ARC(0, 0.5, -1, 0, 0.5, SINE_135, -SINE_135)}},
    {'D',
     1,
     {LINE(-0.4, 0, -0.4, 1),
      LINE(-0.4, 1, -0.1, 1),
      THEN_ARC(-0.1, 0.5, 1, 0, 0.5, 1, 0),
      THEN_LINE(-0.1, 0, -0.4, 0)}},
    {'E',
     0,
     {LINE(-0.3, 0, -0.3, 1), LINE(-0.3, 1, 0.35, 1), LINE(-0.3, 0.5, 0.25, 0.5), LINE(-0.3, 0, 0.35, 0)}},
    {'F', 0, {LINE(-0.3, 0, -0.3, 1), LINE(-0.3, 1, 0.35, 1), LINE(-0.3, 0.5, 0.25, 0.5)}},
    {'G',
     0,
     {ARC(0, 0.5, -1, 0, 0.5, SINE_135, -SINE_135),
      LINE(0.5 * SINE_135, 0.5 - 0.5 * SINE_135, 0.5 * SINE_135, 0.45),
      LINE(0.5 * SINE_135, 0.45, 0.1, 0.45)}},
    {'H', 0, {LINE(-0.4, 0, -0.4, 1), LINE(-0.3, 0.5, 0.3, 0.5), LINE(0.4, 0, 0.4, 1)}},
    {'I', 0, {LINE(0, 0, 0, 1)}},
    {'J', 0, {LINE(0.28, 1, 0.28, 0.28), THEN_ARC(0, 0.28, 0, -1, 0.28, 1, 0)}},
    {'K', 0, {LINE(-0.3, 0, -0.3, 1), LINE(-0.25, 0.42, 0.38, 1), LINE(-0.05, 0.6, 0.4, 0)}},
    {'L', 0, {LINE(-0.3, 1, -0.3, 0), LINE(-0.3, 0, 0.35, 0)}},
    {'M', 0, {LINE(-0.5, 0, -0.5, 1), LINE(-0.5, 1, 0, 0.25), LINE(0, 0.25, 0.5, 1), LINE(0.5, 1, 0.5, 0)}},
    {'N', 0, {LINE(-0.45, 0, -0.45, 1), LINE(-0.45, 1, 0.45, 0), LINE(0.45, 0, 0.45, 1)}},
    {'O', 1, {ARC(0, 0.5, 1, 0, 0.5, 0, -1)}},
    {'P',
     1,
     {LINE(-0.3, 0, -0.3, 1),
      LINE(-0.3, 1, 0.05, 1),
      THEN_ARC(0.05, 0.72, 1, 0, 0.28, 1, 0),
      THEN_LINE(0.05, 0.44, -0.3, 0.44)}},
    {'Q', 1, {ARC(0, 0.5, 1, 0, 0.5, 0, -1), LINE(0.2, 0.25, 0.5, -0.1)}},
    {'R',
     1,
     {LINE(-0.3, 0, -0.3, 1),
      LINE(-0.3, 1, 0.05, 1),
      THEN_ARC(0.05, 0.72, 1, 0, 0.28, 1, 0),
      THEN_LINE(0.05, 0.44, -0.3, 0.44),
      LINE(0.02, 0.44, 0.35, 0)}},
    {'S',
     0,
     {ARC(0, 0.75, -SINE_120, 0.5, 0.25, SINE_120, -0.5),
      THEN_ARC(0, 0.25, SINE_120, -0.5, 0.25, SINE_120, -0.5)}},
    {'T', 0, {LINE(-0.42, 1, 0.42, 1), LINE(0, 0.9, 0, 0)}},
    {'U',
     0,
     {LINE(-0.38, 1, -0.38, 0.38),
      THEN_ARC(0, 0.38, 0, -1, 0.38, 1, 0),
      THEN_LINE(0.38, 0.38, 0.38, 1)}},
    {'V', 0, {LINE(-0.45, 1, 0, 0), LINE(0, 0, 0.45, 1)}},
    {'W', 0, {LINE(-0.75, 1, -0.4, 0), LINE(-0.4, 0, 0, 0.85), LINE(0, 0.85, 0.4, 0), LINE(0.4, 0, 0.75, 1)}},
    {'X', 0, {LINE(-0.4, 0, 0.4, 1), LINE(-0.4, 1, 0.4, 0)}},
    {'Y', 0, {LINE(-0.42, 1, 0, 0.45), LINE(0, 0.45, 0.42, 1), LINE(0, 0.45, 0, 0)}},
    {'Z', 0, {LINE(-0.38, 1, 0.38, 1), LINE(0.38, 1, -0.38, 0), LINE(-0.38, 0, 0.38, 0)}},
};
/* clang-format on */

static double smaller(double a, double b)
{
    return a < b ? a : b;
}

static double larger(double a, double b)
{
    return a > b ? a : b;
}

static bool stroke_used(const design_stroke *s)
{
    return s->radius > 0 || s->x0 != s->x1 || s->y0 != s->y1;
}

static mote_stroke make_stroke(const design_stroke *d)
{
    const double dx = d->x1 - d->x0;
    const double dy = d->y1 - d->y0;
    const double length = sqrt(dx * dx + dy * dy);
    mote_stroke s = {d->x0, d->y0, dx / length, dy / length, length, 0, 0, false, d->continues};
    if (d->radius > 0)
        s = (mote_stroke){d->x0,   d->y0,     d->x1, d->y1,       d->radius,
                          d->sine, d->cosine, true,  d->continues};
    return s;
}

static void grow(double x, double y, mote_vec3 *low, mote_vec3 *high)
{
    low->x = smaller(low->x, x);
    low->y = smaller(low->y, y);
    high->x = larger(high->x, x);
    high->y = larger(high->y, y);
}

/* Extends the box by the centre line: its ends, and the extreme points of the circle that an
   arc covers. */
static void stroke_box(const mote_stroke *s, mote_vec3 *low, mote_vec3 *high)
{
    static const double sides[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    if (!s->arc) {
        grow(s->x, s->y, low, high);
        grow(s->x + s->extent * s->ux, s->y + s->extent * s->uy, low, high);
        return;
    }
    for (int side = -1; side <= 1; side += 2) {
        const double dx = s->cosine * s->ux - side * s->sine * s->uy;
        const double dy = s->cosine * s->uy + side * s->sine * s->ux;
        grow(s->x + s->extent * dx, s->y + s->extent * dy, low, high);
    }
    for (size_t k = 0; k < 4; k++)
        if (sides[k][0] * s->ux + sides[k][1] * s->uy >= s->cosine)
            grow(s->x + s->extent * sides[k][0], s->y + s->extent * sides[k][1], low, high);
}

/* From design units to a box of diagonal 1 about the origin. */
static void glyph_fit(mote_glyph *glyph)
{
    mote_vec3 low = {HUGE_VAL, HUGE_VAL, 0};
    mote_vec3 high = {-HUGE_VAL, -HUGE_VAL, 0};
    for (size_t i = 0; i < glyph->stroke_count; i++)
        stroke_box(&glyph->strokes[i], &low, &high);
    low = mote_sub(low, mote_vec3_make(HALF_WIDTH, HALF_WIDTH, HALF_DEPTH));
    high = mote_add(high, mote_vec3_make(HALF_WIDTH, HALF_WIDTH, HALF_DEPTH));
    const mote_vec3 centre = mote_scale(mote_add(low, high), 0.5);
    const double scale = 1 / mote_length(mote_sub(high, low));
    for (size_t i = 0; i < glyph->stroke_count; i++) {
        mote_stroke *s = &glyph->strokes[i];
        s->x = (s->x - centre.x) * scale;
        s->y = (s->y - centre.y) * scale;
        s->extent *= scale;
    }
    glyph->half_width = HALF_WIDTH * scale;
    glyph->half_depth = HALF_DEPTH * scale;
    glyph->rounding = ROUNDING * scale;
    glyph->blend = BLEND * scale;
    glyph->low = mote_scale(mote_sub(low, centre), scale);
    glyph->high = mote_scale(mote_sub(high, centre), scale);
}

mote_status mote_glyph_make(char letter, mote_glyph *glyph)
{
    for (size_t i = 0; i < sizeof designs / sizeof designs[0]; i++) {
        const design *d = &designs[i];
        if (d->letter != letter)
            continue;
        mote_glyph made = {.holes = d->holes};
        for (size_t k = 0; k < MOTE_GLYPH_STROKES && stroke_used(&d->strokes[k]); k++)
            made.strokes[made.stroke_count++] = make_stroke(&d->strokes[k]);
        glyph_fit(&made);
        *glyph = made;
        return MOTE_OK;
    }
    if (letter > ' ' && letter <= '~')
        return mote_fail(MOTE_EINVAL, "letter: '%c' is unknown; use a capital, A to Z", letter);
    return mote_fail(MOTE_EINVAL, "letter: character code %d is unknown; use a capital, A to Z",
                     (int)(unsigned char)letter);
}

/* The vector in the plane from the nearest point of the centre line to (x, y). */
static void from_stroke(const mote_stroke *s, double x, double y, double *dx, double *dy)
{
    const double px = x - s->x;
    const double py = y - s->y;
    const double along = px * s->ux + py * s->uy;
    if (!s->arc) {
        const double t = larger(0, smaller(s->extent, along));
        *dx = px - t * s->ux;
        *dy = py - t * s->uy;
        return;
    }
    const double across = py * s->ux - px * s->uy;
    if (s->cosine * fabs(across) > s->sine * along) {
        /* Outside the arc's angle: its end on this side is nearest. */
        const double sine = across < 0 ? -s->sine : s->sine;
        *dx = px - s->extent * (s->cosine * s->ux - sine * s->uy);
        *dy = py - s->extent * (s->cosine * s->uy + sine * s->ux);
        return;
    }
    const double length = sqrt(px * px + py * py);
    const double share = length > 0 ? 1 - s->extent / length : 1;
    *dx = share * px;
    *dy = share * py;
}

/* Signed distance in the plane to the joined strokes (smaller than the true one near joints),
   and its gradient. A stroke that continues another belongs to the same curve, of which the
   nearest stroke counts. Curves are joined by a quadratic smooth minimum. */
static double plane_distance(const mote_glyph *glyph, double x, double y, double gradient[2])
{
    const double blend = glyph->blend;
    double d = HUGE_VAL;
    size_t i = 0;
    gradient[0] = 0;
    gradient[1] = 0;
    while (i < glyph->stroke_count) {
        double best = HUGE_VAL;
        double bx = 0;
        double by = 0;
        do {
            double dx;
            double dy;
            from_stroke(&glyph->strokes[i++], x, y, &dx, &dy);
            const double square = dx * dx + dy * dy;
            if (square < best) {
                best = square;
                bx = dx;
                by = dy;
            }
        } while (i < glyph->stroke_count && glyph->strokes[i].continues);
        if (best >= (d + blend) * (d + blend))
            continue; /* too far away to contribute */
        const double e = sqrt(best);
        const double inverse = e > 0 ? 1 / e : 0;
        const double near = larger(blend - fabs(d - e), 0) / blend;
        const double weight = d < e ? near / 2 : 1 - near / 2;
        gradient[0] = weight * bx * inverse + (1 - weight) * gradient[0];
        gradient[1] = weight * by * inverse + (1 - weight) * gradient[1];
        d = smaller(d, e) - near * near * blend / 4;
    }
    return d - glyph->half_width;
}

double mote_glyph_field(const mote_glyph *glyph, mote_vec3 p, mote_vec3 *gradient)
{
    double g[2];
    const double side = p.z < 0 ? -1 : 1;
    const double r = glyph->rounding;
    const double across = plane_distance(glyph, p.x, p.y, g) + r;
    const double up = side * p.z - glyph->half_depth + r;
    if (across > 0 && up > 0) {
        const double length = sqrt(across * across + up * up);
        const double s = across / length;
        *gradient = mote_vec3_make(g[0] * s, g[1] * s, side * up / length);
        return length - r;
    }
    if (across > up) {
        *gradient = mote_vec3_make(g[0], g[1], 0);
        return across - r;
    }
    *gradient = mote_vec3_make(0, 0, side);
    return up - r;
}

double mote_glyph_half_height(const mote_glyph *glyph, double x, double y)
{
    double g[2];
    const double d = plane_distance(glyph, x, y, g);
    if (d >= 0)
        return 0;
    const double r = glyph->rounding;
    const double across = larger(d + r, 0);
    return glyph->half_depth - r + sqrt(r * r - across * across);
}

mote_vec3 mote_glyph_project(const mote_glyph *glyph, mote_vec3 p, int steps,
                             mote_vec3 *gradient)
{
    for (int i = 0; i < steps; i++) {
        const double f = mote_glyph_field(glyph, p, gradient);
        const double square = mote_length_squared(*gradient);
        if (square > 0)
            p = mote_add_scaled(p, -f / square, *gradient);
    }
    return p;
}
