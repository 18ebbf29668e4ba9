#include "harness/base/curve.h"

#include "harness/base/memory.h"

#include <stdlib.h>
#include <string.h>

/* The slope at key k: that of the parabola through the key and its neighbours. */
static void fit_tangents(mote_curve *curve)
{
    const uint32_t width = curve->width;
    for (uint32_t k = 1; k + 1 < curve->count; ++k) {
        const double before = curve->frames[k] - curve->frames[k - 1];
        const double after = curve->frames[k + 1] - curve->frames[k];
        for (uint32_t i = 0; i < width; ++i) {
            const double *v = curve->values + (size_t)k * width + i;
            const double slope_before = (v[0] - v[-(ptrdiff_t)width]) / before;
            const double slope_after = (v[width] - v[0]) / after;
            curve->tangents[(size_t)k * width + i] =
                (slope_before * after + slope_after * before) / (before + after);
        }
    }
}

mote_status mote_curve_create(const uint32_t *frames, const double *values, uint32_t count,
                              uint32_t width, mote_curve **curve)
{
    for (uint32_t k = 1; k < count; ++k) {
        if (frames[k] <= frames[k - 1])
            return mote_fail(MOTE_EINVAL,
                             "key %u is at frame %u and key %u at %u; give ascending frames",
                             k - 1, frames[k - 1], k, frames[k]);
    }
    mote_curve *made = mote_allocate(1, sizeof *made);
    const size_t size = (size_t)count * width;
    made->count = count;
    made->width = width;
    made->frames = mote_copy(frames, count * sizeof *frames);
    made->values = mote_copy(values, size * sizeof *values);
    made->tangents = mote_allocate(size, sizeof *made->tangents);
    fit_tangents(made);
    *curve = made;
    return MOTE_OK;
}

void mote_curve_destroy(mote_curve *curve)
{
    if (!curve)
        return;
    free(curve->frames);
    free(curve->values);
    free(curve->tangents);
    free(curve);
}

/* The last key at or before a frame that lies strictly between the first and last key. */
static uint32_t find_key(const mote_curve *curve, double frame)
{
    uint32_t low = 0;
    uint32_t high = curve->count - 1;
    while (high - low > 1) {
        const uint32_t middle = low + (high - low) / 2;
        if (curve->frames[middle] <= frame)
            low = middle;
        else
            high = middle;
    }
    return low;
}

void mote_curve_evaluate(const mote_curve *curve, double frame, double *value)
{
    const uint32_t width = curve->width;
    const uint32_t last = curve->count - 1;
    if (frame <= curve->frames[0] || frame >= curve->frames[last]) {
        const uint32_t end = frame <= curve->frames[0] ? 0 : last;
        memcpy(value, curve->values + (size_t)end * width, width * sizeof *value);
        return;
    }
    const uint32_t k = find_key(curve, frame);
    const double step = curve->frames[k + 1] - curve->frames[k];
    const double t = (frame - curve->frames[k]) / step;
    const double u = 1 - t;
    const double *v = curve->values + (size_t)k * width;
    const double *d = curve->tangents + (size_t)k * width;
    for (uint32_t i = 0; i < width; ++i)
        value[i] = v[i] * (u * u * (1 + 2 * t)) + v[width + i] * (t * t * (3 - 2 * t)) +
                   step * (d[i] * (t * u * u) - d[width + i] * (t * t * u));
}
