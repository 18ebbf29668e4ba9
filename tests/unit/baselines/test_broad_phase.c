/* The broad phase against all pairs of boxes. */
#include "baselines/broad_phase.h"

#include "tests/support/solids.h"
#include "tests/support/test.h"

#define BODIES 300

static bool are_near(const mote_scene_box *a, const mote_scene_box *b, double near)
{
    return a->low.x - b->high.x <= near && b->low.x - a->high.x <= near &&
           a->low.y - b->high.y <= near && b->low.y - a->high.y <= near &&
           a->low.z - b->high.z <= near && b->low.z - a->high.z <= near;
}

/* Numbers with few bits, so that touching boxes touch exactly. */
static mote_vec3 coarse(mote_vec3 v)
{
    return mote_vec3_make(floor(v.x * 64) / 64, floor(v.y * 64) / 64, floor(v.z * 64) / 64);
}

static void check_step(mote_broad_phase *broad, const mote_scene_box *boxes, double near)
{
    const uint32_t(*pairs)[2];
    size_t count = 0, next = 0;
    assert_int_equal(mote_broad_phase_pairs(broad, boxes, near, &pairs, &count), MOTE_OK);
    for (uint32_t i = 0; i < BODIES; ++i) {
        for (uint32_t j = i + 1; j < BODIES; ++j) {
            if (!are_near(&boxes[i], &boxes[j], near))
                continue;
            assert_true(next < count);
            assert_int_equal(pairs[next][0], i);
            assert_int_equal(pairs[next++][1], j);
        }
    }
    assert_int_equal(next, count);
    assert_true(count > 50);
}

TEST(mote_broad_phase_pairs_moving_boxes_equal_all_pairs)
{
    uint64_t random = 3;
    static mote_scene_box boxes[BODIES];
    mote_broad_phase *broad = NULL;
    assert_int_equal(mote_broad_phase_create(BODIES, &broad), MOTE_OK);
    for (int step = 0; step < 20; ++step) {
        for (uint32_t i = 0; i < BODIES; ++i) {
            /* A leap every seventh step, small steps otherwise. */
            const mote_vec3 middle = step % 7 == 0
                                         ? random_vec3(&random, 4)
                                         : mote_add(boxes[i].low, random_vec3(&random, 0.1));
            const mote_vec3 size = mote_vec3_make(random_between(&random, 0, 1),
                                                  random_between(&random, 0, 1), 0.5);
            boxes[i].low = coarse(middle);
            boxes[i].high = mote_add(boxes[i].low, coarse(size));
        }
        check_step(broad, boxes, step % 2 ? 0.25 : 0);
    }
    mote_broad_phase_destroy(broad);
}

TEST(mote_broad_phase_pairs_one_body_has_none)
{
    mote_broad_phase *broad = NULL;
    const mote_scene_box box = {{0, 0, 0}, {1, 1, 1}};
    const uint32_t(*pairs)[2];
    size_t count = 1;
    assert_int_equal(mote_broad_phase_create(1, &broad), MOTE_OK);
    for (int step = 0; step < 3; ++step) {
        assert_int_equal(mote_broad_phase_pairs(broad, &box, 0, &pairs, &count), MOTE_OK);
        assert_int_equal(count, 0);
    }
    mote_broad_phase_destroy(broad);
}

TEST(mote_broad_phase_bad_input_is_refused)
{
    mote_broad_phase *broad = NULL;
    assert_int_equal(mote_broad_phase_create(0, &broad), MOTE_EINVAL);
    assert_null(broad);
    mote_broad_phase_destroy(NULL);
    mote_scene_box boxes[2] = {{{0, 0, 0}, {1, 1, 1}}, {{0, 0, 0}, {1, NAN, 1}}};
    const uint32_t(*pairs)[2];
    size_t count;
    assert_int_equal(mote_broad_phase_create(2, &broad), MOTE_OK);
    assert_int_equal(mote_broad_phase_pairs(broad, boxes, 0, &pairs, &count), MOTE_EINVAL);
    assert_non_null(strstr(mote_error_text(), "box 1"));
    boxes[1].high.y = -1;
    assert_int_equal(mote_broad_phase_pairs(broad, boxes, 0, &pairs, &count), MOTE_EINVAL);
    boxes[1].high.y = INFINITY;
    assert_int_equal(mote_broad_phase_pairs(broad, boxes, 0, &pairs, &count), MOTE_EINVAL);
    mote_broad_phase_destroy(broad);
}
