#include "harness/report/replay_series.h"

#include <assert.h>
#include <math.h>
#include <stdbool.h>

#define GRID_MOST 65534.0

mote_replay_box mote_replay_box_none(void)
{
    return (mote_replay_box){{HUGE_VAL, HUGE_VAL, HUGE_VAL}, {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}};
}

static bool is_point(mote_vec3 p)
{
    return isfinite(p.x) && isfinite(p.y) && isfinite(p.z);
}

void mote_replay_box_include(mote_replay_box *box, const mote_vec3 *points, size_t count)
{
    for (size_t i = 0; i < count; ++i) {
        const mote_vec3 p = points[i];
        if (!is_point(p))
            continue;
        box->low =
            mote_vec3_make(fmin(box->low.x, p.x), fmin(box->low.y, p.y), fmin(box->low.z, p.z));
        box->high = mote_vec3_make(fmax(box->high.x, p.x), fmax(box->high.y, p.y),
                                   fmax(box->high.z, p.z));
    }
}

mote_replay_grid mote_replay_box_grid(const mote_replay_box *box)
{
    if (!(box->low.x <= box->high.x))
        return (mote_replay_grid){{0, 0, 0}, 1};
    const mote_vec3 size = mote_sub(box->high, box->low);
    const double most = fmax(size.x, fmax(size.y, size.z));
    return (mote_replay_grid){box->low, most > 0 ? most / GRID_MOST : 1};
}

void mote_replay_add_grid(mote_text *text, const mote_replay_grid *grid)
{
    mote_text_add(text, "\"low\": [%.17g, %.17g, %.17g], \"step\": %.17g", grid->low.x,
                  grid->low.y, grid->low.z, grid->step);
}

void mote_replay_difference(int32_t *values, size_t count, size_t columns)
{
    for (size_t i = count; i-- > columns;)
        values[i] -= values[i - columns];
}

void mote_replay_add_series(mote_text *text, const char *key, const int32_t *values,
                            size_t count)
{
    mote_text_add(text, "\"%s\": [", key);
    for (size_t i = 0; i < count; ++i)
        mote_text_add(text, i > 0 ? ",%d" : "%d", (int)values[i]);
    mote_text_add(text, "]");
}

typedef struct place {
    int32_t at[3];
} place;

static int32_t place_on(double low, double step, double value)
{
    return (int32_t)fmax(0, fmin(GRID_MOST, floor((value - low) / step + 0.5)));
}

static place place_of(const mote_replay_grid *grid, mote_vec3 p)
{
    return (place){{place_on(grid->low.x, grid->step, p.x),
                    place_on(grid->low.y, grid->step, p.y),
                    place_on(grid->low.z, grid->step, p.z)}};
}

void mote_replay_add_points(mote_text *text, const char *key, const mote_replay_grid *grid,
                            const mote_vec3 *points, size_t count, size_t columns,
                            const mote_vec3 *reference)
{
    place last[MOTE_REPLAY_COLUMNS] = {{{0, 0, 0}}};
    assert(columns > 0 && columns <= MOTE_REPLAY_COLUMNS);
    mote_text_add(text, "\"%s\": [", key);
    for (size_t i = 0; i < count; ++i) {
        const char *separator = i > 0 ? "," : "";
        place *before = &last[i % columns];
        if (!is_point(points[i])) {
            mote_text_add(text, "%snull", separator);
            continue;
        }
        const bool referred = reference && is_point(reference[i]);
        const place here = place_of(grid, points[i]);
        const place base = referred ? place_of(grid, reference[i]) : *before;
        mote_text_add(text, "%s%d,%d,%d", separator, (int)(here.at[0] - base.at[0]),
                      (int)(here.at[1] - base.at[1]), (int)(here.at[2] - base.at[2]));
        *before = here;
    }
    mote_text_add(text, "]");
}
