/* Numbers of the replay as text that compresses well: differences of whole numbers. */
#ifndef MOTE_HARNESS_REPLAY_SERIES_H
#define MOTE_HARNESS_REPLAY_SERIES_H

#include "core/base/vec3.h"
#include "harness/base/file.h"

#include <stdint.h>

/* A cubic grid over points: a coordinate is low + step * k, k of 0 .. 65,534. */
typedef struct mote_replay_grid {
    mote_vec3 low;
    double step;
} mote_replay_grid;

/* The grid of a growing box: begin with mote_replay_box_none and include points; points that
   are not finite are ignored. */
typedef struct mote_replay_box {
    mote_vec3 low, high;
} mote_replay_box;

mote_replay_box mote_replay_box_none(void);
void mote_replay_box_include(mote_replay_box *box, const mote_vec3 *points, size_t count);
mote_replay_grid mote_replay_box_grid(const mote_replay_box *box);

/* Appends `"low": [x, y, z], "step": s`. */
void mote_replay_add_grid(mote_text *text, const mote_replay_grid *grid);

/* Replaces each value with its difference from the one `columns` before it; the first ones
   stay. */
void mote_replay_difference(int32_t *values, size_t count, size_t columns);

/* Appends `"KEY": [...]`. */
void mote_replay_add_series(mote_text *text, const char *key, const int32_t *values,
                            size_t count);

/* Appends `"KEY": [...]` of points on a grid: three numbers per point, or one null if it is not
   finite. Each point is stored relative to the same point of the reference if that has one,
   otherwise to the last finite point in its column (a multiple of `columns` before it),
   otherwise to 0. reference may be NULL; columns is 1 .. MOTE_REPLAY_COLUMNS. */
#define MOTE_REPLAY_COLUMNS 128
void mote_replay_add_points(mote_text *text, const char *key, const mote_replay_grid *grid,
                            const mote_vec3 *points, size_t count, size_t columns,
                            const mote_vec3 *reference);

#endif
