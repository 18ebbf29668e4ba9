/* Boxes near a box, as a grid finds them, against a look at every one. */
#include "harness/engine/box_grid.h"

#include "core/base/random.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#define BOXES 1500

static bool are_near(const mote_scene_box *a, const mote_scene_box *b, double near)
{
    return a->low.x - b->high.x <= near && b->low.x - a->high.x <= near &&
           a->low.y - b->high.y <= near && b->low.y - a->high.y <= near &&
           a->low.z - b->high.z <= near && b->low.z - a->high.z <= near;
}

/* A box of edges up to `size` around a place in a cube of edge 2 about `middle`. */
static mote_scene_box draw(mote_random *random, double middle, double size)
{
    double at[3], half[3];
    for (int axis = 0; axis < 3; ++axis) {
        at[axis] = middle + 2 * mote_random_unit(random) - 1;
        half[axis] = 0.5 * size * mote_random_unit(random);
    }
    return (mote_scene_box){mote_vec3_make(at[0] - half[0], at[1] - half[1], at[2] - half[2]),
                            mote_vec3_make(at[0] + half[0], at[1] + half[1], at[2] + half[2])};
}

/* Adds every other box and asks about the rest. Returns how many were found. */
static size_t check(const mote_scene_box *boxes, double near)
{
    mote_box_grid *grid = mote_box_grid_create(boxes, BOXES);
    size_t sum = 0;
    for (uint32_t i = 0; i < BOXES; ++i) {
        size_t count, expected = 0;
        const uint32_t *found = mote_box_grid_near(grid, &boxes[i], near, &count);
        for (uint32_t j = 0; j < i; j += 2) {
            if (!are_near(&boxes[i], &boxes[j], near))
                continue;
            assert_true(expected < count && found[expected] == j);
            ++expected;
        }
        assert_int_equal(count, expected);
        sum += count;
        if (i % 2 == 0)
            mote_box_grid_add(grid, i);
    }
    mote_box_grid_destroy(grid);
    return sum;
}

TEST(box_grid_finds_what_a_look_at_every_box_finds)
{
    static const struct {
        const char *what;
        double middle, sizes[3]; /* which alternate */
        double near;
        bool meets;
    } rows[] = {
        {"alike", 0, {0.2, 0.2, 0.2}, 0, true},
        {"alike and near", 0, {0.2, 0.2, 0.2}, 0.1, true},
        {"of many sizes", 0, {1e-3, 0.3, 0.03}, 0.01, true},
        {"one in three is as large as all", 0, {0.01, 4, 0.01}, 0, true},
        {"far from the origin", 1e9, {0.2, 0.02, 0.2}, 0.01, true},
        {"in a point", 0, {0, 0, 0}, 0.05, true},
        {"smaller than the last bit of their places", 1e20, {0, 1e-3, 1}, 0, true},
        {"in points that do not meet", 0, {0, 0, 0}, 0, false},
    };
    mote_scene_box *boxes = calloc(BOXES, sizeof *boxes);
    assert_non_null(boxes);
    for (size_t r = 0; r < ROWS_OF(rows); ++r) {
        mote_random random = {r + 1};
        test_row("%s", rows[r].what);
        for (uint32_t i = 0; i < BOXES; ++i)
            boxes[i] = draw(&random, rows[r].middle, rows[r].sizes[i % 3]);
        assert_true((check(boxes, rows[r].near) > 0) == rows[r].meets);
    }
    free(boxes);
}

TEST(box_grid_destroy_accepts_null)
{
    mote_box_grid_destroy(NULL);
}
