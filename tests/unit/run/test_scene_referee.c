/* Brute force as the judge of crowds: true answers pass, planted wrong ones are named. */
#include "harness/run/scene_check.h"
#include "harness/run/scene_referee.h"
#include "tests/support/bar.h"
#include "tests/support/test.h"

#define FRAMES 30
#define PAIRS_MAX 1000

static mote_subject subject;
static mote_subject_frame frame;
static mote_engine *engine;

/* The near pairs of a frame, with certified's answers, as a copy. */
static size_t ask(uint32_t number, mote_near_pair *pairs)
{
    mote_engine_cost cost;
    size_t count;
    assert_int_equal(mote_subject_frame_set(&subject, number, 0, &frame), MOTE_OK);
    mote_engine_show(engine, frame.states);
    assert_int_equal(mote_engine_ask(engine, &cost), MOTE_OK);
    const mote_near_pair *found = mote_engine_pairs(engine, &count);
    assert_in_range(count, 1, PAIRS_MAX);
    memcpy(pairs, found, count * sizeof *pairs);
    return count;
}

static mote_status judge(uint32_t number, const mote_near_pair *pairs, size_t count)
{
    uint32_t checked = 0;
    const mote_status status =
        mote_scene_referee_judge(&subject, number, frame.states, pairs, count, &checked);
    assert_in_range(checked, count > 0, 2);
    return status;
}

/* Characters with bones, and letters, that meet in a box. */
TEST(mote_scene_referee_agrees_with_true_answers)
{
    mote_near_pair pairs[PAIRS_MAX];
    uint32_t wanted = 0;
    size_t contacts = 0, others = 0;
    for (uint32_t k = 1; k <= FRAMES; ++k) {
        const size_t count = ask(k, pairs);
        wanted += mote_scene_referee_wants(&subject, k);
        if (judge(k, pairs, count) != MOTE_OK)
            fail_msg("%s", mote_error_text());
        for (size_t i = 0; i < count; ++i) {
            contacts += pairs[i].answer.contact;
            others += !pairs[i].answer.contact;
        }
    }
    assert_int_equal(wanted, 24);
    assert_true(contacts > 10 && others > 100);
}

/* The error names one of these pairs, its bodies counted from 1. */
static void check_names(const mote_near_pair *pairs, size_t count)
{
    unsigned a = 0, b = 0;
    const char *names = strstr(mote_error_text(), "bodies ");
    assert_non_null(names);
    assert_int_equal(sscanf(names, "bodies %u and %u", &a, &b), 2);
    const uint32_t low = (a < b ? a : b) - 1, high = (a < b ? b : a) - 1;
    for (size_t i = 0; i < count; ++i) {
        if (pairs[i].body[0] == low && pairs[i].body[1] == high)
            return;
    }
    fail_msg("%s", mote_error_text());
}

TEST(mote_scene_referee_finds_wrong_distances_and_contacts)
{
    mote_near_pair pairs[PAIRS_MAX];
    const size_t count = ask(7, pairs);
    for (size_t i = 0; i < count; ++i)
        pairs[i].answer.distance += 1e-9 * subject.bodies->length;
    assert_int_equal(judge(7, pairs, count), MOTE_ENUMERIC);
    assert_non_null(strstr(mote_error_text(), "crowd.json: frame 7: bodies "));
    assert_int_equal(judge(7, pairs, 1), MOTE_ENUMERIC);
    check_names(&pairs[0], 1);
    for (size_t i = 0; i < count; ++i) {
        pairs[i].answer.has_distance = false;
        pairs[i].answer.contact = !pairs[i].answer.contact;
    }
    assert_int_equal(judge(7, pairs, count), MOTE_ENUMERIC);
    assert_non_null(strstr(mote_error_text(), "contact: brute force"));
    assert_int_equal(judge(7, pairs, 1), MOTE_ENUMERIC);
    check_names(&pairs[0], 1);
}

/* A pair whose contact is told wrongly; within rounding of the tolerance either is right. */
static void judge_contact(uint32_t number, mote_near_pair pair)
{
    const double tolerance = subject.bodies->tolerance;
    const bool contact = pair.answer.distance <= 0;
    pair.answer.has_distance = false;
    pair.answer.contact = !contact;
    subject.bodies->tolerance = 1e-3 * subject.bodies->length;
    assert_int_equal(judge(number, &pair, 1), MOTE_ENUMERIC);
    assert_non_null(strstr(mote_error_text(),
                           contact ? "apart, which is contact" : "apart, which is no contact"));
    subject.bodies->tolerance = pair.answer.distance;
    if (judge(number, &pair, 1) != MOTE_OK)
        assert_non_null(strstr(mote_error_text(), "not among the near pairs"));
    subject.bodies->tolerance = tolerance;
}

TEST(mote_scene_referee_names_wrong_contacts_either_way)
{
    mote_near_pair pairs[PAIRS_MAX];
    bool seen[2] = {false, false};
    for (uint32_t k = 1; k <= FRAMES; ++k) {
        const size_t count = ask(k, pairs);
        for (size_t i = 0; i < count; ++i) {
            const double distance = pairs[i].answer.distance;
            if (seen[distance > 0] ||
                (distance > 0 && distance < 0.01 * subject.bodies->length))
                continue;
            seen[distance > 0] = true;
            judge_contact(k, pairs[i]);
        }
    }
    assert_true(seen[0] && seen[1]);
}

/* Without any pair the frame's body has lost its neighbours, in frames in which it has one. */
TEST(mote_scene_referee_finds_pairs_that_are_missing)
{
    mote_near_pair pairs[PAIRS_MAX];
    int found = 0;
    for (uint32_t k = 1; k <= FRAMES; ++k) {
        const size_t count = ask(k, pairs);
        if (judge(k, pairs, 0) == MOTE_OK)
            continue;
        ++found;
        assert_non_null(strstr(mote_error_text(), "not among the near pairs"));
        check_names(pairs, count);
    }
    assert_in_range(found, 5, FRAMES);
}

TEST(mote_scene_check_tells_how_many_pairs_brute_force_confirmed)
{
    mote_scene_facts facts;
    assert_int_equal(mote_scene_check(&subject, &facts), MOTE_OK);
    assert_in_range(facts.checked, 24, 48);
}

static int load(void)
{
    mote_method_choice choice;
    bar_write("bar.x", bar_default());
    file_put("crowd.json",
             "{\"purpose\": \"a test\", \"frames\": 30, \"ask\": \"distance\", \"bodies\": {"
             "\"count\": 40, \"box\": 7.5, \"near\": 0.3, \"speed\": 0.05, \"spin\": 3, "
             "\"shapes\": [{\"character\": \"bar.x\", \"subdivide\": 1}, "
             "{\"letter\": \"T\", \"triangles\": 400}]}}\n");
    if (mote_subject_load("crowd.json", &subject) != MOTE_OK ||
        mote_scene_choice_read("certified", &choice) != MOTE_OK) {
        (void)fprintf(stderr, "%s\n", mote_error_text());
        return -1;
    }
    const mote_engine_setup setup = mote_subject_engine(&subject);
    frame = mote_subject_frame_create(&subject, 0);
    return mote_engine_create(&setup, &choice, &engine) == MOTE_OK &&
                   mote_engine_build(engine) == MOTE_OK
               ? 0
               : -1;
}

static int unload(void)
{
    mote_engine_destroy(engine);
    mote_subject_frame_free(&frame);
    mote_subject_free(&subject);
    return 0;
}

TEST_GROUP(load, unload);
