/* Keys of one quantity of an animation over time, and its value between them. The same bits on
   every machine: no function of the C library takes part but the square root. */
#ifndef MOTE_HARNESS_TRACK_H
#define MOTE_HARNESS_TRACK_H

#include <stdint.h>

typedef enum mote_track_mode {
    MOTE_TRACK_LINEAR, /* rotations along the shorter great circle, at constant speed */
    MOTE_TRACK_STEP,   /* the last key's value */
    MOTE_TRACK_CUBIC   /* Hermite pieces with given tangents, as in glTF */
} mote_track_mode;

/* Before the first key and after the last the value stays. */
typedef struct mote_track {
    mote_track_mode mode;
    uint32_t count; /* of keys, >= 1 */
    const double
        *times; /* [count], seconds, not falling; of equal times the later key counts */
    const double *values; /* [count][width]; cubic: [count][3][width], the tangent that arrives
                             (per second), the value, the tangent that leaves */
} mote_track;

/* Widths up to this. */
#define MOTE_TRACK_WIDTH 4

/* Writes value[width]; width is 1 to MOTE_TRACK_WIDTH. Numbers are interpolated one by one. */
void mote_track_evaluate(const mote_track *track, uint32_t width, double seconds,
                         double *value);

/* Keys that are rotations, as quaternions w, x, y, z of a length > 0. Writes one of length 1;
   where a cubic passes through 0, the value of the key before. */
void mote_track_rotation(const mote_track *track, double seconds, double value[4]);

#endif
