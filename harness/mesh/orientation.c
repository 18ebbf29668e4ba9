#include "harness/mesh/orientation.h"

#include <float.h>
#include <math.h>

/* A sum without rounding: non-overlapping components in increasing magnitude. */
typedef struct exact_sum {
    double part[12];
    int count;
} exact_sum;

static void add(exact_sum *sum, double value)
{
    for (int i = 0; i < sum->count; ++i) {
        const double total = value + sum->part[i];
        const double virtual_part = total - value;
        const double virtual_value = total - virtual_part;
        sum->part[i] = (value - virtual_value) + (sum->part[i] - virtual_part);
        value = total;
    }
    sum->part[sum->count++] = value;
}

/* Adds x * y. */
static void add_product(exact_sum *sum, double x, double y)
{
    const double product = x * y;
    add(sum, fma(x, y, -product));
    add(sum, product);
}

static int sign(double value)
{
    return (value > 0) - (value < 0);
}

static int exact_orientation(const double a[2], const double b[2], const double c[2])
{
    exact_sum sum = {{0}, 0};
    add_product(&sum, a[0], b[1]);
    add_product(&sum, -a[1], b[0]);
    add_product(&sum, b[0], c[1]);
    add_product(&sum, -b[1], c[0]);
    add_product(&sum, c[0], a[1]);
    add_product(&sum, -c[1], a[0]);
    /* The largest nonzero component outweighs all others together. */
    for (int i = sum.count; i-- > 0;) {
        if (sum.part[i] != 0)
            return sign(sum.part[i]);
    }
    return 0;
}

int mote_orientation(const double a[2], const double b[2], const double c[2])
{
    const double left = (a[0] - c[0]) * (b[1] - c[1]);
    const double right = (a[1] - c[1]) * (b[0] - c[0]);
    /* Each side is rounded three times and the difference once: an error below 4 units of
       2^-53. */
    const double bound = 2 * DBL_EPSILON * (fabs(left) + fabs(right));
    const double area = left - right;
    if (fabs(area) > bound && bound > DBL_MIN / DBL_EPSILON)
        return sign(area);
    return exact_orientation(a, b, c);
}
