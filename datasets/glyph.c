#include "datasets/glyph.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

/* Design units: capitals are 1 high, from centre line to centre line. */
#define HALF_WIDTH 0.11
#define HALF_DEPTH 0.11
#define ROUNDING 0.07
#define BLEND 0.1

typedef struct design {
    char letter;
    mote_stroke strokes[MOTE_GLYPH_STROKES]; /* unused ones are all 0 */
} design;

static const design designs[] = {
    {'M', {{-0.5, 0, -0.5, 1}, {-0.5, 1, 0, 0.25}, {0, 0.25, 0.5, 1}, {0.5, 1, 0.5, 0}}},
    {'T', {{-0.42, 1, 0.42, 1}, {0, 0.9, 0, 0}}},
    {'V', {{-0.45, 1, 0, 0}, {0, 0, 0.45, 1}}},
    {'W', {{-0.75, 1, -0.4, 0}, {-0.4, 0, 0, 0.85}, {0, 0.85, 0.4, 0}, {0.4, 0, 0.75, 1}}},
};

static double smaller(double a, double b)
{
    return a < b ? a : b;
}

static double larger(double a, double b)
{
    return a > b ? a : b;
}

static bool stroke_used(const mote_stroke *s)
{
    return s->x0 != s->x1 || s->y0 != s->y1;
}

/* Grows the box by the centre line. */
static void stroke_box(const mote_stroke *s, mote_vec3 *low, mote_vec3 *high)
{
    low->x = smaller(low->x, smaller(s->x0, s->x1));
    low->y = smaller(low->y, smaller(s->y0, s->y1));
    high->x = larger(high->x, larger(s->x0, s->x1));
    high->y = larger(high->y, larger(s->y0, s->y1));
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
        s->x0 = (s->x0 - centre.x) * scale;
        s->y0 = (s->y0 - centre.y) * scale;
        s->x1 = (s->x1 - centre.x) * scale;
        s->y1 = (s->y1 - centre.y) * scale;
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
        if (designs[i].letter != letter)
            continue;
        mote_glyph made = {0};
        memcpy(made.strokes, designs[i].strokes, sizeof made.strokes);
        while (made.stroke_count < MOTE_GLYPH_STROKES &&
               stroke_used(&made.strokes[made.stroke_count]))
            made.stroke_count++;
        glyph_fit(&made);
        *glyph = made;
        return MOTE_OK;
    }
    return mote_fail(
        MOTE_EINVAL,
        "letter: character code %d is not a letter that can be made; use M, T, V or W",
        (int)(unsigned char)letter);
}

/* Distance in the plane to the centre line, and the direction away from it (0 on the line). */
static double stroke_distance(const mote_stroke *s, double x, double y, double direction[2])
{
    const double ex = s->x1 - s->x0;
    const double ey = s->y1 - s->y0;
    const double px = x - s->x0;
    const double py = y - s->y0;
    const double along = (px * ex + py * ey) / (ex * ex + ey * ey);
    const double t = larger(0, smaller(1, along));
    const double dx = px - t * ex;
    const double dy = py - t * ey;
    const double distance = sqrt(dx * dx + dy * dy);
    const double inverse = distance > 0 ? 1 / distance : 0;
    direction[0] = dx * inverse;
    direction[1] = dy * inverse;
    return distance;
}

/* Signed distance in the plane to the joined strokes (less than it near joints), and gradient.
 */
static double plane_distance(const mote_glyph *glyph, double x, double y, double gradient[2])
{
    double d = stroke_distance(&glyph->strokes[0], x, y, gradient);
    for (size_t i = 1; i < glyph->stroke_count; i++) {
        double g[2];
        const double e = stroke_distance(&glyph->strokes[i], x, y, g);
        const double near = larger(glyph->blend - fabs(d - e), 0) / glyph->blend;
        const double weight = d < e ? near / 2 : 1 - near / 2;
        gradient[0] += weight * (g[0] - gradient[0]);
        gradient[1] += weight * (g[1] - gradient[1]);
        d = smaller(d, e) - near * near * glyph->blend / 4;
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

double mote_glyph_reach(const mote_glyph *glyph, double x, double y)
{
    double g[2];
    const double d = plane_distance(glyph, x, y, g);
    if (d >= 0)
        return 0;
    const double r = glyph->rounding;
    const double across = larger(d + r, 0);
    return glyph->half_depth - r + sqrt(r * r - across * across);
}

mote_vec3 mote_glyph_project(const mote_glyph *glyph, mote_vec3 p, int steps)
{
    for (int i = 0; i < steps; i++) {
        mote_vec3 gradient;
        const double f = mote_glyph_field(glyph, p, &gradient);
        const double square = mote_length_squared(gradient);
        if (square > 0)
            p = mote_add_scaled(p, -f / square, gradient);
    }
    return p;
}
