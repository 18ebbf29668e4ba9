/* What becomes of the processes of several bodies, and rows of what they measured: contacts
   against a reference, ends that were not good. */
#include "harness/run/bodies_row.h"

#include "harness/run/bodies_record.h"
#include "harness/base/file.h"
#include "tests/support/test.h"

#include <signal.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define FILE_NAME "test_bodies_row.json"

static mote_bodies *bodies;

static mote_bodies_choice choice_of(const char *text)
{
    mote_bodies_choice choice;
    if (mote_bodies_choice_read(text, &choice) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    return choice;
}

/* Contacts (frame, a, b) that are missed or false count up to the last common step. */
TEST(mote_bodies_row_compare_counts_contacts_by_frame_and_pair)
{
    static const struct {
        mote_bodies_contact mine[3], theirs[3];
        size_t mine_count, theirs_count, missed, wrong;
    } cases[] = {
        {{{1, 0, 1}}, {{1, 0, 1}}, 1, 1, 0, 0},
        {{{1, 0, 1}}, {{1, 0, 2}}, 1, 1, 1, 1},
        {{{1, 0, 2}}, {{1, 0, 1}}, 1, 1, 1, 1},
        {{{1, 1, 2}}, {{1, 0, 2}}, 1, 1, 1, 1},
        {{{1, 0, 2}}, {{1, 1, 2}}, 1, 1, 1, 1},
        {{{1, 0, 1}}, {{2, 0, 1}}, 1, 1, 1, 1},
        {{{0, 0, 0}}, {{1, 0, 1}, {2, 0, 1}}, 0, 2, 2, 0},
        {{{1, 0, 1}, {2, 0, 1}}, {{0, 0, 0}}, 2, 0, 0, 2},
        {{{1, 0, 1}, {2, 0, 1}, {3, 0, 1}}, {{2, 0, 1}, {3, 0, 2}}, 3, 2, 0, 1},
        {{{1, 0, 1}, {2, 0, 3}}, {{1, 0, 1}, {1, 0, 2}, {2, 0, 3}}, 2, 3, 1, 0},
    };
    mote_bodies_timed mine[3] = {{.frame = 1, .total_ns = 10},
                                 {.frame = 2, .total_ns = 20},
                                 {.frame = 3, .total_ns = 30}};
    mote_bodies_timed theirs[2] = {{.frame = 1, .total_ns = 90}, {.frame = 2, .total_ns = 80}};
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; ++k) {
        mote_bodies_contact a[3], b[3];
        memcpy(a, cases[k].mine, sizeof a);
        memcpy(b, cases[k].theirs, sizeof b);
        const mote_bodies_result result = {.steps = mine,
                                           .step_count = 3,
                                           .contacts = a,
                                           .contact_count = cases[k].mine_count};
        const mote_bodies_result other = {.steps = theirs,
                                          .step_count = 2,
                                          .contacts = b,
                                          .contact_count = cases[k].theirs_count};
        mote_bodies_row row = {.ok = true, .steps = 3};
        const mote_bodies_row reference = {.ok = true, .steps = 2, .method = "exact"};
        mote_bodies_row_compare(&row, &result, &reference, &other);
        assert_string_equal(row.reference, "exact");
        assert_int_equal(row.common, 2);
        if (row.missed != cases[k].missed || row.false_contacts != cases[k].wrong)
            fail_msg("case %zu: %zu missed, %zu false", k, row.missed, row.false_contacts);
        assert_true(row.ratio == 4); /* of the second step: 80 over 20 */
    }
}

TEST(mote_bodies_row_compare_without_steps_of_both_compares_nothing)
{
    const mote_bodies_result nothing = {.step_count = 0};
    for (int k = 0; k < 4; ++k) {
        mote_bodies_row row = {.ok = k != 0, .steps = k != 1};
        const mote_bodies_row reference = {.ok = k != 2, .steps = k != 3, .method = "exact"};
        mote_bodies_row_compare(&row, &nothing, &reference, &nothing);
        assert_string_equal(row.reference, "");
        assert_int_equal(row.common, 0);
    }
}

/* A cell that ended before its first step: nothing is a number. */
TEST(mote_bodies_row_make_without_steps_has_no_times)
{
    const mote_bodies_choice choice = choice_of("certified");
    const mote_bodies_result result = {.status = MOTE_CELL_TIMEOUT, .reason = "out of time"};
    mote_bodies_row row;
    mote_bodies_row_make(bodies, &choice, 1, &result, &row);
    assert_false(row.ok);
    assert_true(isnan(row.step_ns) && isnan(row.step_p95_ns) && isnan(row.query_ns));
    assert_int_equal(row.heap_live_bytes, -1);
    json_t *root = mote_bodies_rows_json(&row, 1);
    const json_t *object = json_array_get(json_object_get(root, "rows"), 0);
    assert_string_equal(json_string_value(json_object_get(object, "status")), "timeout");
    assert_string_equal(json_string_value(json_object_get(object, "reason")), "out of time");
    static const char *const none[] = {"step_ns", "step_mean_ns", "step_p95_ns",
                                       "wall_ns", "reference",    "missed",
                                       "ratio",   "near_pairs"};
    for (size_t k = 0; k < sizeof none / sizeof none[0]; ++k)
        assert_true(json_is_null(json_object_get(object, none[k])));
    json_decref(root);
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    assert_non_null(out);
    mote_bodies_rows_print(&row, 1, out);
    assert_int_equal(fclose(out), 0);
    assert_non_null(strstr(text, "timeout: out of time\n"));
    free(text);
}

static mote_bodies_result measure(const char *method, const mote_bodies_options *options)
{
    const mote_bodies_choice choice = choice_of(method);
    mote_bodies_result result = {.step_count = 77};
    if (mote_bodies_measure(bodies, &choice, options, &result) != MOTE_OK)
        fail_msg("%s: %s", method, mote_error_text());
    return result;
}

static void expect_end(mote_bodies_result result, mote_cell_status status, const char *reason)
{
    assert_int_equal(result.status, status);
    if (!strstr(result.reason, reason))
        fail_msg("not \"%s\": %s", reason, result.reason);
    assert_int_equal(result.step_count, 0);
    assert_int_equal(result.contact_count, 0);
    mote_bodies_result_free(&result);
}

TEST(mote_bodies_measure_ends_that_are_not_good_are_results)
{
    const mote_bodies_options all = {.first = 1};
    expect_end(measure("particle:n=2,positions=given", &all), MOTE_CELL_UNSUPPORTED,
               "leave out positions=given");
    expect_end(measure("particle-paper", &all), MOTE_CELL_UNSUPPORTED, "give n=");
    expect_end(measure("particle-paper:n=90000", &all), MOTE_CELL_CRASHED, "n=90000 is not");
    /* 40 frames of 60 bodies take longer than a microsecond. */
    const mote_bodies_options brief = {.first = 1, .timeout = 1e-6};
    expect_end(measure("certified", &brief), MOTE_CELL_TIMEOUT, "out of time");
    /* The process dies of a mesh that is not there. */
    void (*const caught)(int) = signal(SIGSEGV, SIG_DFL);
    const mote_mesh *mesh = bodies->shapes[0].body.mesh;
    bodies->shapes[0].body.mesh = NULL;
    const mote_bodies_result died = measure("aabb-tree", &all);
    bodies->shapes[0].body.mesh = mesh;
    (void)signal(SIGSEGV, caught);
    expect_end(died, MOTE_CELL_CRASHED, "ended ");
}

TEST(mote_bodies_measure_of_frames_beyond_the_last_is_refused)
{
    const mote_bodies_choice choice = choice_of("certified");
    const mote_bodies_options beyond = {.first = 30, .last = 41};
    mote_bodies_result result = {.step_count = 77};
    assert_int_equal(mote_bodies_measure(bodies, &choice, &beyond, &result), MOTE_EINVAL);
    assert_non_null(strstr(mote_error_text(), "frames 30-41; it has 40"));
    assert_int_equal(result.step_count, 77);
}

/* A budget that is spent at once leaves the least number of steps. */
TEST(mote_bodies_measure_over_budget_makes_the_least_steps)
{
    static const char *const methods[] = {"certified", "certified:ahead=2"};
    for (int k = 0; k < 2; ++k) {
        const mote_bodies_options options = {.first = 3, .budget = 1e-9, .least = 4};
        mote_bodies_result result = measure(methods[k], &options);
        assert_int_equal(result.status, MOTE_CELL_OK);
        assert_int_equal(result.step_count, 4);
        assert_int_equal(result.steps[0].frame, 3);
        mote_bodies_result_free(&result);
    }
    const mote_bodies_options ample = {.first = 39, .budget = 1e9, .least = 1};
    mote_bodies_result result = measure("certified", &ample);
    assert_int_equal(result.step_count, 2);
    mote_bodies_result_free(&result);
}

/* Names of files: what is not plain becomes a dash, and the hash tells the choices apart. */
TEST(mote_bodies_cell_name_is_plain)
{
    mote_bodies named = *bodies;
    char text[] = "AZaz09.@[`{/: ~";
    named.name = text;
    const mote_bodies_choice one = choice_of("certified:ahead=2");
    const mote_bodies_choice other = choice_of("certified:ahead=3");
    char *a = mote_bodies_cell_name(&named, &one, 7);
    char *b = mote_bodies_cell_name(&named, &other, 7);
    static const char first[] = "AZaz09.---------certified-ahead-2-";
    assert_int_equal(strncmp(a, first, strlen(first)), 0);
    assert_string_equal(a + strlen(a) - 3, "-r7");
    assert_string_not_equal(a, b);
    free(a);
    free(b);
}

static int load_bodies(void)
{
    static const char text[] =
        "{\"purpose\": \"a test\", \"frames\": 40, \"ask\": \"distance\", \"bodies\": {"
        "\"count\": 60, \"box\": 8, \"shapes\": [{\"letter\": \"T\", \"triangles\": 400}]}}\n";
    return mote_file_write(FILE_NAME, text, strlen(text)) == MOTE_OK &&
                   mote_bodies_load(FILE_NAME, &bodies) == MOTE_OK
               ? 0
               : -1;
}

static int free_bodies(void)
{
    mote_bodies_destroy(bodies);
    return unlink(FILE_NAME);
}

TEST_GROUP(load_bodies, free_bodies);
