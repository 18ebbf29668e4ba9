#include "harness/mesh/track.h"

#include <math.h>
#include <string.h>

/* The position of a time among the keys. */
typedef struct place {
    uint32_t before, after; /* keys; equal where the value is constant */
    double part, step;      /* fraction of the way, 0 .. 1; seconds from key to key */
} place;

static place find(const mote_track *track, double seconds)
{
    uint32_t low = 0, high = track->count; /* times[low] <= seconds < times[high] */
    if (!(seconds >= track->times[0]))
        return (place){0, 0, 0, 0};
    while (high - low > 1) {
        const uint32_t middle = low + (high - low) / 2;
        if (track->times[middle] <= seconds)
            low = middle;
        else
            high = middle;
    }
    if (high == track->count || track->mode == MOTE_TRACK_STEP)
        return (place){low, low, 0, 0};
    const double step = track->times[high] - track->times[low];
    return (place){low, high, (seconds - track->times[low]) / step, step};
}

/* The value (which = 0), arriving tangent (-1) or leaving tangent (1) of a key. */
static const double *key_value(const mote_track *track, uint32_t width, uint32_t key, int which)
{
    const size_t at =
        track->mode == MOTE_TRACK_CUBIC ? (size_t)3 * key + (size_t)(1 + which) : (size_t)key;
    return track->values + at * width;
}

static void cubic(const mote_track *track, uint32_t width, const place *p, double *value)
{
    const double *from = key_value(track, width, p->before, 0);
    const double *leaving = key_value(track, width, p->before, 1);
    const double *to = key_value(track, width, p->after, 0);
    const double *arriving = key_value(track, width, p->after, -1);
    const double s = p->part, s2 = s * s, s3 = s2 * s;
    for (uint32_t c = 0; c < width; ++c)
        value[c] = (2 * s3 - 3 * s2 + 1) * from[c] + (3 * s2 - 2 * s3) * to[c] +
                   p->step * ((s3 - 2 * s2 + s) * leaving[c] + (s3 - s2) * arriving[c]);
}

void mote_track_evaluate(const mote_track *track, uint32_t width, double seconds, double *value)
{
    const place p = find(track, seconds);
    const double *from = key_value(track, width, p.before, 0);
    const double *to = key_value(track, width, p.after, 0);
    if (p.before == p.after) {
        memcpy(value, from, width * sizeof *value);
    } else if (track->mode == MOTE_TRACK_CUBIC) {
        cubic(track, width, &p, value);
    } else {
        for (uint32_t c = 0; c < width; ++c)
            value[c] = from[c] + p.part * (to[c] - from[c]);
    }
}

static double dot(const double a[4], const double b[4])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
}

/* Scales q to length 1; false if its length is 0. */
static int normalise(double q[4])
{
    const double length = sqrt(dot(q, q));
    if (!(length > 1e-100) || !isfinite(length))
        return 0;
    for (int c = 0; c < 4; ++c)
        q[c] /= length;
    return 1;
}

/* sin(t a) / sin(a) for cos(a) = x from 0.7 to 1 and t from 0 to 1: the series in powers of
   x - 1 (Eberly, A fast and accurate algorithm for computing SLERP, 2011). Each term is below
   0.15 of the one before. */
static double sine_ratio(double t, double x)
{
    double term = t, sum = t;
    for (int i = 1; i < 30 && fabs(term) > 1e-18; ++i) {
        term *= (t * t - (double)i * i) / (i * (2 * i + 1.0)) * (x - 1);
        sum += term;
    }
    return sum;
}

/* Interpolates along the great circle from a to b, both of length 1, at most a quarter turn
   apart. */
static void slerp(const double a[4], const double b[4], double part, double value[4])
{
    double middle[4];
    for (int c = 0; c < 4; ++c)
        middle[c] = a[c] + b[c];
    (void)normalise(middle);
    const double *from = part < 0.5 ? a : middle;
    const double *to = part < 0.5 ? middle : b;
    const double t = part < 0.5 ? 2 * part : 2 * part - 1;
    const double x = fmin(dot(from, to), 1);
    for (int c = 0; c < 4; ++c)
        value[c] = sine_ratio(1 - t, x) * from[c] + sine_ratio(t, x) * to[c];
}

void mote_track_rotation(const mote_track *track, double seconds, double value[4])
{
    const place p = find(track, seconds);
    double from[4], to[4];
    memcpy(from, key_value(track, 4, p.before, 0), sizeof from);
    memcpy(to, key_value(track, 4, p.after, 0), sizeof to);
    (void)normalise(from);
    (void)normalise(to);
    if (p.before == p.after) {
        memcpy(value, from, sizeof from);
    } else if (track->mode == MOTE_TRACK_CUBIC) {
        cubic(track, 4, &p, value);
    } else {
        const double sign = dot(from, to) < 0 ? -1 : 1; /* q and -q are the same rotation */
        for (int c = 0; c < 4; ++c)
            to[c] *= sign;
        slerp(from, to, p.part, value);
    }
    if (!normalise(value))
        memcpy(value, from, sizeof from);
}
