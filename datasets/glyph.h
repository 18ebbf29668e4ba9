/* Letters as implicit surfaces: strokes of constant width in the xy-plane, joined by a smooth
   minimum and extruded along z with rounded rims. The surface is where the field is 0; the
   field is negative inside and its gradient points outward. Lengths are in units of the
   letter's bounding-box diagonal, and the box is centred at the origin. */
#ifndef MOTE_DATASETS_GLYPH_H
#define MOTE_DATASETS_GLYPH_H

#include "core/base/status.h"
#include "core/base/vec3.h"

#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

#define MOTE_GLYPH_STROKES 6

/* The centre line of a stroke. A line starts at (x, y) and goes along the unit vector (ux, uy)
   for `extent`. An arc has its centre at (x, y), the radius `extent`, and spans to both sides
   of the direction (ux, uy) an angle with the given sine and cosine (0 and -1: a whole circle).
 */
typedef struct mote_stroke {
    double x, y, ux, uy;
    double extent;
    double sine, cosine;
    bool arc;
    bool continues; /* starts where the stroke before it ends, in the same direction */
} mote_stroke;

typedef struct mote_glyph {
    size_t stroke_count; /* 1 .. MOTE_GLYPH_STROKES */
    mote_stroke strokes[MOTE_GLYPH_STROKES];
    unsigned holes;    /* the Euler characteristic of the surface is 2 - 2 * holes */
    double half_width; /* of a stroke, in the plane */
    double half_depth; /* along z */
    double rounding;   /* radius of the rims; below half_width and half_depth */
    double
        blend; /* strokes are joined smoothly where their distances differ by less than this */
    mote_vec3 low, high;
} mote_glyph;

/* Fills *glyph for a capital letter, 'A' to 'Z'. MOTE_EINVAL for any other character, with a
   text that says so. Cost O(1). */
mote_status mote_glyph_make(char letter, mote_glyph *glyph);

/* The field at p, and its gradient, whose length is 1 away from joints and less near them, but
   never 0 near the surface. The field is once differentiable near the surface. */
double mote_glyph_field(const mote_glyph *glyph, mote_vec3 p, mote_vec3 *gradient);

/* Half of the extent along z of the letter's column at (x, y); 0 outside the letter. */
double mote_glyph_half_height(const mote_glyph *glyph, double x, double y);

/* A point of the surface near p, by `steps` (>= 1) of Newton's method along the gradient, which
   is returned as it was before the last step. p should be within the rounding radius of the
   surface. */
mote_vec3 mote_glyph_project(const mote_glyph *glyph, mote_vec3 p, int steps,
                             mote_vec3 *gradient);

#ifdef __cplusplus
}
#endif
#endif
