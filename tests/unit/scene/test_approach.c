/* The stopping point of an approach against a closed form, and what is refused. */
#include "harness/scene/approach.h"

#include "harness/base/file.h"
#include "tests/support/diamond.h"
#include "tests/support/folder.h"
#include "tests/support/test.h"

#include <stddef.h>

#include <math.h>

/* Two boxes, |x| <= 2, 1.1 <= |y| <= 2.1, |z| <= 1: a gate that a diamond slides through at a
   distance of 0.1. */
#define BOX(low, high, a, b, c, d, e, f, g, h)                                                 \
    "v -2 " low " -1\nv 2 " low " -1\nv 2 " high " -1\nv -2 " high " -1\n"                     \
    "v -2 " low " 1\nv 2 " low " 1\nv 2 " high " 1\nv -2 " high " 1\n"                         \
    "f " a " " d " " c " " b "\nf " e " " f " " g " " h "\nf " a " " b " " f " " e "\n"        \
    "f " b " " c " " g " " f "\nf " c " " d " " h " " g "\nf " d " " a " " e " " h "\n"
#define GATE                                                                                   \
    BOX("1.1", "2.1", "1", "2", "3", "4", "5", "6", "7", "8")                                  \
    BOX("-2.1", "-1.1", "9", "10", "11", "12", "13", "14", "15", "16")
#define SCENE                                                                                  \
    "{\"purpose\": \"a test\", \"frames\": 2, \"ask\": \"distance\", \"bodies\": ["            \
    "{\"file\": \"gate.obj\"}, {\"file\": \"diamond.obj\", \"motion\": ["                      \
    "{\"frame\": 1, \"position\": [5, 0, 0]}]}]}\n"

static mote_scenario *scenario;

static int load(void)
{
    file_put("gate.obj", GATE);
    file_put("diamond.obj", DIAMOND);
    file_put("s.json", SCENE);
    return mote_scenario_load("s.json", &scenario) == MOTE_OK ? 0 : -1;
}

static int clean(void)
{
    mote_scenario_destroy(scenario);
    return 0;
}

TEST_GROUP(load, clean);

/* Approaches along x to an absolute distance. */
static mote_status come(double distance, mote_vec3 *place)
{
    static const uint32_t frames[] = {1};
    const double gap = distance / scenario->length;
    const mote_approach_plan plan = {
        .direction = mote_vec3_make(1, 0, 0), .frames = frames, .gaps = &gap, .count = 1};
    return mote_approach_solve(scenario, &plan, place);
}

/* The inner edge of a box at (2, 1.1), against the side of the diamond from (c - 1, 0) to (c,
   1): sqrt(2) times their distance is c - 2 + 0.1. */
TEST(approach_stops_at_the_first_place_with_the_wished_distance)
{
    static const double distances[] = {0.15, 0.3, 0.5};
    for (size_t i = 0; i < ROWS_OF(distances); ++i) {
        mote_vec3 place;
        assert_int_equal(come(distances[i], &place), MOTE_OK);
        const double expected = sqrt(2) * distances[i] + 1.9;
        assert_true(place.y == 0 && place.z == 0);
        assert_true(place.x >= expected - 1e-12);
        assert_true(place.x <= expected + sqrt(2) * 1e-4 * scenario->length);
    }
}

TEST(approach_that_slides_by_or_passes_is_refused_with_the_frame)
{
    static const struct {
        double below; /* the gate's 0.1, in L */
        const char *says;
    } cases[] = {{1.5e-4, "frame 1: the bodies slide along each other"},
                 {3e-2, "frame 1: the bodies pass each other"}};
    for (size_t i = 0; i < ROWS_OF(cases); ++i) {
        mote_vec3 place;
        assert_int_equal(come(0.1 - cases[i].below * scenario->length, &place), MOTE_EINVAL);
        if (!strstr(mote_error_text(), cases[i].says))
            fail_msg("not \"%s\" but \"%s\"", cases[i].says, mote_error_text());
    }
}
