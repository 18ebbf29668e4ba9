/* Keys of one animated quantity over time, and its value between them. The result has the same
   bits on every machine: the square root is the only C library function used. */
#ifndef MOTE_HARNESS_TRACK_H
#define MOTE_HARNESS_TRACK_H

#include <stdint.h>

typedef enum mote_track_mode {
    MOTE_TRACK_LINEAR, /* rotations along the shorter great circle, at constant speed */
    MOTE_TRACK_STEP,   /* the last key's value */
    MOTE_TRACK_CUBIC   /* Hermite pieces with given tangents, as in glTF */
} mote_track_mode;

/* The value is constant before the first key and after the last. */
typedef struct mote_track {
    mote_track_mode mode;
    uint32_t count; /* of keys, >= 1 */
    const double
        *times; /* [count], seconds, non-decreasing; of equal times the later key counts */
    const double *values; /* [count][width]; cubic: [count][3][width], the arriving tangent (per
                             second), the value, the leaving tangent */
} mote_track;

/* The largest width. */
#define MOTE_TRACK_WIDTH 4

/* Writes value[width]; width is 1 to MOTE_TRACK_WIDTH. Numbers are interpolated
   independently. */
void mote_track_evaluate(const mote_track *track, uint32_t width, double seconds,
                         double *value);

/* For keys that are rotations: quaternions w, x, y, z of length > 0. Writes one of length 1;
   where a cubic passes through 0, the value of the previous key. */
void mote_track_rotation(const mote_track *track, double seconds, double value[4]);

#endif
