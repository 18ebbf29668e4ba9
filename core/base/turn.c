#include "core/base/turn.h"

#include <math.h>

/* Taylor series for |x| <= pi / 4: the first omitted term is below 1e-18. */
static double sine_series(double x)
{
    static const double factor[] = {1.0 / 6,   1.0 / 20,  1.0 / 42,  1.0 / 72,
                                    1.0 / 110, 1.0 / 156, 1.0 / 210, 1.0 / 272};
    const double square = x * x;
    double sum = 1;
    for (int i = 7; i >= 0; --i)
        sum = 1 - square * factor[i] * sum;
    return x * sum;
}

static double cosine_series(double x)
{
    static const double factor[] = {1.0 / 2,   1.0 / 12,  1.0 / 30,  1.0 / 56, 1.0 / 90,
                                    1.0 / 132, 1.0 / 182, 1.0 / 240, 1.0 / 306};
    const double square = x * x;
    double sum = 1;
    for (int i = 8; i >= 0; --i)
        sum = 1 - square * factor[i] * sum;
    return sum;
}

void mote_turn(double turns, double *sine, double *cosine)
{
    const double pi = 3.14159265358979323846;
    const double part = turns - floor(turns); /* exact: 0 <= part <= 1 */
    const double quarters = floor(part * 4 + 0.5);
    const double x = (part - quarters / 4) * (2 * pi); /* the difference is exact */
    const double s = sine_series(x);
    const double c = cosine_series(x);
    switch ((int)quarters & 3) {
    case 0:
        *sine = s;
        *cosine = c;
        break;
    case 1:
        *sine = c;
        *cosine = -s;
        break;
    case 2:
        *sine = -s;
        *cosine = -c;
        break;
    default:
        *sine = -c;
        *cosine = s;
        break;
    }
}
