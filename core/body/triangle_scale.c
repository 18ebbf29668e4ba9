#include "core/body/triangle_scale.h"

#include <float.h>

/* Coordinates are scaled where the largest is not within these powers of two: products of four
   lengths are numbers with all their bits then. */
#define LEAST_POWER (-100)
#define MOST_POWER 100

static double raised(double largest, const mote_vec3 *points, int count)
{
    for (int i = 0; i < count; i++) {
        const double own = mote_largest_coordinate(points[i]);
        largest = own > largest ? own : largest;
    }
    return largest;
}

int mote_triangle_power(const mote_vec3 *a, int a_count, const mote_vec3 *b, int b_count)
{
    const double largest = raised(raised(0, a, a_count), b, b_count);
    const int power = largest > 0 && largest <= DBL_MAX ? ilogb(largest) : 0;
    return power < LEAST_POWER || power > MOST_POWER ? -power : 0;
}

static mote_vec3 scaled(mote_vec3 v, int power)
{
    return mote_vec3_make(ldexp(v.x, power), ldexp(v.y, power), ldexp(v.z, power));
}

void mote_scale_points(const mote_vec3 *points, int count, int power, mote_vec3 *to)
{
    for (int i = 0; i < count; i++)
        to[i] = scaled(points[i], power);
}

double mote_unscaled_squared(double squared, int power)
{
    const double result = ldexp(squared, -2 * power);
    return squared > 0 && !(result > 0) ? DBL_TRUE_MIN : result;
}

void mote_unscale_point(mote_vec3 point, int power, mote_vec3 *to)
{
    if (to)
        *to = scaled(point, -power);
}
