/* The number of near pairs that a scenario asks for, and what engines make of them. */
#include "harness/run/subject.h"

#include "baselines/broad_phase.h"
#include "harness/engine/probe.h"
#include "tests/support/diamond.h"
#include "tests/support/folder.h"
#include "tests/support/mote.h"
#include "tests/support/solids.h"
#include "tests/support/test.h"

#include <time.h>

#define FILE_NAME "b.json"

static const char form[] =
    "{\"purpose\": \"a test\", \"frames\": 40, \"ask\": \"distance\",\n"
    " \"bodies\": {\"count\": 40, \"near_pairs\": %s, \"shapes\": [\n"
    "  {\"letter\": \"W\", \"triangles\": 400, \"field\": {\"count\": 6, \"support\": 0.5, "
    "\"displacement\":\n"
    "    {\"random\": {\"seed\": 5, \"amplitude\": 0.05, \"periods\": [40, 90]}}}},\n"
    "  {\"letter\": \"T\", \"triangles\": 400}]}}\n";

static mote_bodies *load(const char *wish)
{
    mote_bodies *b = NULL;
    char *text = mote_format(form, wish);
    file_put(FILE_NAME, text);
    free(text);
    if (mote_bodies_load(FILE_NAME, &b) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    return b;
}

static mote_engine *engine_of(mote_bodies *b)
{
    mote_method_choice choice;
    mote_engine *engine = NULL;
    const mote_engine_setup setup = mote_subject_engine(&(mote_subject){.bodies = b});
    assert_int_equal(mote_scene_choice_read("aabb-tree", &choice), MOTE_OK);
    assert_int_equal(mote_engine_create(&setup, &choice, &engine), MOTE_OK);
    assert_int_equal(mote_engine_build(engine), MOTE_OK);
    return engine;
}

/* Finds the pairs of bodies whose boxes are near. */
typedef struct box_search {
    mote_probe *probe;
    mote_broad_phase *broad;
    mote_scene_box *boxes;
} box_search;

static box_search search_of(mote_bodies *b)
{
    const mote_engine_setup setup = mote_subject_engine(&(mote_subject){.bodies = b});
    box_search made = {.boxes = calloc(b->count, sizeof *made.boxes)};
    assert_int_equal(mote_probe_create(&setup, 0, &made.probe), MOTE_OK);
    assert_int_equal(mote_broad_phase_create(b->count, &made.broad), MOTE_OK);
    return made;
}

static size_t near_boxes(const box_search *search, const mote_bodies *b,
                         const mote_bodies_frame *frame)
{
    const uint32_t(*pairs)[2];
    size_t count;
    assert_int_equal(mote_probe_all(search->probe, frame->states, search->boxes), MOTE_OK);
    assert_int_equal(
        mote_broad_phase_pairs(search->broad, search->boxes, b->near, &pairs, &count), MOTE_OK);
    return count;
}

static void search_free(const box_search *search)
{
    mote_probe_destroy(search->probe);
    mote_broad_phase_destroy(search->broad);
    free(search->boxes);
}

/* Near pairs are wished for by the boxes around whole bodies; engines then leave out some. */
TEST(mote_bodies_load_near_pairs_are_as_wished)
{
    static const char *const wishes[] = {"0.1", "1", "4"};
    for (int k = 0; k < 3; ++k) {
        mote_bodies *b = load(wishes[k]);
        mote_bodies_frame frame = mote_bodies_frame_create(b);
        mote_engine *engine = engine_of(b);
        const box_search search = search_of(b);
        double pairs = 0, asked = 0;
        for (uint32_t f = 1; f <= b->frames; ++f) {
            mote_engine_cost step;
            mote_bodies_frame_set(b, f, &frame);
            mote_engine_show(engine, frame.states);
            assert_int_equal(mote_engine_ask(engine, &step), MOTE_OK);
            if (f == 1)
                assert_int_equal(step.contacts, 0);
            pairs += (double)near_boxes(&search, b, &frame);
            asked += (double)step.pairs;
        }
        const double mean = pairs / b->frames / b->count;
        assert_close(mean / strtod(wishes[k], NULL), 1, 0.3);
        assert_true(asked > 0 && asked < pairs);
        search_free(&search);
        mote_engine_destroy(engine);
        mote_bodies_frame_free(&frame);
        mote_bodies_destroy(b);
    }
}

#define DIAMONDS(bodies)                                                                       \
    "{\"purpose\": \"x\", \"frames\": 2, \"ask\": \"contact\", \"bodies\": {" bodies "}}\n"
/* Its last brace is left out, for further keys. */
#define DEFORMED                                                                               \
    "{\"file\": \"d.obj\", \"field\": {\"count\": 3, \"support\": 0.5, \"displacement\": "     \
    "{\"random\": {\"seed\": 1, \"amplitude\": 0.05, \"periods\": [20, 90]}}}"

static mote_bodies *load_text(const char *text)
{
    mote_bodies *b = NULL;
    file_put("d.obj", DIAMOND);
    file_put("f1.obj", DIAMOND);
    file_put("f2.obj", DIAMOND);
    file_put(FILE_NAME, text);
    if (mote_bodies_load(FILE_NAME, &b) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    return b;
}

/* Bodies that would overlap others get the places that they got when every body was compared
   with all before it: recorded then. */
TEST(mote_bodies_load_places_stay_as_they_were)
{
    static const struct {
        const char *text;
        uint64_t fingerprint;
    } rows[] = {
        {DIAMONDS("\"count\": 300, \"box\": 7, \"shapes\": [{\"file\": \"d.obj\"}, {\"file\": "
                  "\"d.obj\", \"scale\": 0.05}, " DEFORMED ", \"scale\": [1, 0.1, 0.3]}]"),
         0xa049783b7bcce210},
        {DIAMONDS("\"count\": 200, \"box\": 6, \"shapes\": [{\"positions\": \"f1.obj\"}, "
                  "{\"file\": \"d.obj\", \"scale\": 0.1}, " DEFORMED "}]"),
         0x8c60dcb32cdf5ce5},
        {DIAMONDS("\"count\": 150, \"near_pairs\": 2, \"seed\": 9, \"shapes\": [" DEFORMED
                  "}, {\"file\": \"d.obj\", \"scale\": 0.3}]"),
         0x479023949a824be3},
    };
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        uint64_t fingerprint = 0;
        test_row("%s", rows[i].text);
        mote_bodies *b = load_text(rows[i].text);
        assert_int_equal(mote_bodies_fingerprint(b, &fingerprint), MOTE_OK);
        assert_true(fingerprint == rows[i].fingerprint);
        mote_bodies_destroy(b);
    }
}

/* The processor's seconds of placing so many bodies, less of two runs. */
static double seconds_of_placing(const char *shape, uint32_t count)
{
    double least = 1e9;
    char *text = mote_format(DIAMONDS("\"count\": %u, \"box\": %.17g, \"shapes\": [{%s}]"),
                             count, 2 * cbrt(count), shape);
    for (int k = 0; k < 2; ++k) {
        const clock_t from = clock();
        mote_bodies_destroy(load_text(text));
        least = fmin(least, (double)(clock() - from) / CLOCKS_PER_SEC);
    }
    free(text);
    return least;
}

/* Four times as many bodies in four times the room take four times as long, where it was 12
   times for bodies with fields and 14 for those of positions. */
TEST(mote_bodies_load_takes_as_long_a_body_however_many_there_are)
{
    static const struct {
        const char *shape;
        uint32_t few;
    } rows[] = {{"\"file\": \"d.obj\"", 8000}, {"\"positions\": \"f1.obj\"", 2000}};
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        test_row("%s", rows[i].shape);
        const double few = seconds_of_placing(rows[i].shape, rows[i].few);
        const double many = seconds_of_placing(rows[i].shape, 4 * rows[i].few);
        if (!(many < 7.5 * few))
            fail_msg("%u bodies: %g s, %u: %g s", rows[i].few, few, 4 * rows[i].few, many);
    }
}
