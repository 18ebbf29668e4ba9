#include "harness/engine/box_grid.h"

#include "harness/base/hash.h"
#include "harness/base/memory.h"

#include <math.h>
#include <stdlib.h>

/* Sides of cells of a level are 2^level. */
typedef struct cell {
    int64_t at[3];
    int level;
} cell;

struct mote_box_grid {
    const mote_scene_box *boxes;
    cell *cells;       /* [count] */
    uint32_t *next;    /* [count]: the next box in the same list, or NONE */
    uint32_t *lists;   /* [list_count]: the last box added of those whose cells share a hash */
    uint32_t *added;   /* [added_count] */
    size_t list_count; /* a power of two */
    size_t added_count;
    int *levels; /* [level_count]: those that have boxes */
    size_t level_count, level_room;
    uint32_t *found; /* by the last question */
    size_t found_count, found_room;
};

#define NONE UINT32_MAX

mote_box_grid *mote_box_grid_create(const mote_scene_box *boxes, uint32_t count)
{
    mote_box_grid *made = mote_allocate(1, sizeof *made);
    made->boxes = boxes;
    made->cells = mote_allocate(count, sizeof *made->cells);
    made->next = mote_allocate(count, sizeof *made->next);
    made->added = mote_allocate(count, sizeof *made->added);
    for (made->list_count = 1; made->list_count < count;)
        made->list_count *= 2;
    made->lists = mote_allocate(made->list_count, sizeof *made->lists);
    for (size_t k = 0; k < made->list_count; ++k)
        made->lists[k] = NONE;
    return made;
}

void mote_box_grid_destroy(mote_box_grid *grid)
{
    if (!grid)
        return;
    free(grid->cells);
    free(grid->next);
    free(grid->lists);
    free(grid->added);
    free(grid->levels);
    free(grid->found);
    free(grid);
}

static int64_t cell_of(double x, int level)
{
    /* Beyond this, where a cell is smaller than the last bit of x, all share the last cell. */
    const double most = 0x1p60;
    return (int64_t)fmax(-most, fmin(most, floor(ldexp(x, -level))));
}

static uint32_t *list_of(const mote_box_grid *grid, const cell *c)
{
    uint64_t hash = mote_hash_word(MOTE_HASH_START, (uint64_t)c->level);
    for (int axis = 0; axis < 3; ++axis)
        hash = mote_hash_word(hash, (uint64_t)c->at[axis]);
    return &grid->lists[(hash ^ hash >> 32) & (grid->list_count - 1)];
}

static mote_vec3 middle_of(const mote_scene_box *box)
{
    return mote_add(mote_scale(box->low, 0.5), mote_scale(box->high, 0.5));
}

/* The level at which a cell is at least as large as a box. */
static int level_of(const mote_scene_box *box)
{
    const mote_vec3 size = mote_sub(box->high, box->low);
    int level;
    (void)frexp(fmax(size.x, fmax(size.y, size.z)), &level);
    return level;
}

static void know_level(mote_box_grid *grid, int level)
{
    for (size_t k = 0; k < grid->level_count; ++k) {
        if (grid->levels[k] == level)
            return;
    }
    grid->levels = mote_reserve(grid->levels, grid->level_count + 1, &grid->level_room,
                                sizeof *grid->levels);
    grid->levels[grid->level_count++] = level;
}

void mote_box_grid_add(mote_box_grid *grid, uint32_t i)
{
    const mote_scene_box *box = &grid->boxes[i];
    const mote_vec3 middle = middle_of(box);
    const int level = level_of(box);
    const cell own = {
        {cell_of(middle.x, level), cell_of(middle.y, level), cell_of(middle.z, level)}, level};
    uint32_t *list = list_of(grid, &own);
    know_level(grid, level);
    grid->cells[i] = own;
    grid->next[i] = *list;
    *list = i;
    grid->added[grid->added_count++] = i;
}

static bool are_near(const mote_scene_box *a, const mote_scene_box *b, double near)
{
    return a->low.x - b->high.x <= near && b->low.x - a->high.x <= near &&
           a->low.y - b->high.y <= near && b->low.y - a->high.y <= near &&
           a->low.z - b->high.z <= near && b->low.z - a->high.z <= near;
}

static void find(mote_box_grid *grid, uint32_t i, const mote_scene_box *box, double near)
{
    if (!are_near(box, &grid->boxes[i], near))
        return;
    grid->found = mote_reserve(grid->found, grid->found_count + 1, &grid->found_room,
                               sizeof *grid->found);
    grid->found[grid->found_count++] = i;
}

/* The cells of a level in which the middles of boxes can be that are near a box. */
typedef struct cells {
    int64_t low[3], high[3];
    int level;
} cells;

static cells cells_near(const mote_scene_box *box, double near, int level)
{
    const double low[3] = {box->low.x, box->low.y, box->low.z};
    const double high[3] = {box->high.x, box->high.y, box->high.z};
    cells c = {.level = level};
    for (int axis = 0; axis < 3; ++axis) {
        const double reach = near + ldexp(0.5, level);
        const double rounding = 1e-9 * (reach + fabs(low[axis]) + fabs(high[axis]));
        c.low[axis] = cell_of(low[axis] - reach - rounding, level);
        c.high[axis] = cell_of(high[axis] + reach + rounding, level);
    }
    return c;
}

static double number_of(const cells *c)
{
    double number = 1;
    for (int axis = 0; axis < 3; ++axis)
        number *= (double)(c->high[axis] - c->low[axis]) + 1;
    return number;
}

static bool same_cell(const cell *a, const cell *b)
{
    return a->level == b->level && a->at[0] == b->at[0] && a->at[1] == b->at[1] &&
           a->at[2] == b->at[2];
}

static void search_cells(mote_box_grid *grid, const cells *c, const mote_scene_box *box,
                         double near)
{
    cell at = {.level = c->level};
    for (at.at[0] = c->low[0]; at.at[0] <= c->high[0]; ++at.at[0]) {
        for (at.at[1] = c->low[1]; at.at[1] <= c->high[1]; ++at.at[1]) {
            for (at.at[2] = c->low[2]; at.at[2] <= c->high[2]; ++at.at[2]) {
                for (uint32_t i = *list_of(grid, &at); i != NONE; i = grid->next[i]) {
                    if (same_cell(&grid->cells[i], &at))
                        find(grid, i, box, near);
                }
            }
        }
    }
}

static int ascending(const void *a, const void *b)
{
    const uint32_t i = *(const uint32_t *)a, j = *(const uint32_t *)b;
    return (i > j) - (i < j);
}

const uint32_t *mote_box_grid_near(mote_box_grid *grid, const mote_scene_box *box, double near,
                                   size_t *count)
{
    double number = 0;
    grid->found_count = 0;
    for (size_t k = 0; k < grid->level_count; ++k) {
        const cells c = cells_near(box, near, grid->levels[k]);
        number += number_of(&c);
    }
    /* A box that is much larger than others has more cells near it than there are boxes. */
    if (number > (double)grid->added_count) {
        for (size_t k = 0; k < grid->added_count; ++k)
            find(grid, grid->added[k], box, near);
    } else {
        for (size_t k = 0; k < grid->level_count; ++k) {
            const cells c = cells_near(box, near, grid->levels[k]);
            search_cells(grid, &c, box, near);
        }
    }
    if (grid->found_count > 1)
        qsort(grid->found, grid->found_count, sizeof *grid->found, ascending);
    *count = grid->found_count;
    return grid->found;
}
