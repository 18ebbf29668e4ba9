/* Cells of more than two bodies: failures, budgets, names. */
#include "harness/run/cell_process.h"
#include "harness/run/measure.h"
#include "harness/run/plan.h"

#include "harness/base/file.h"
#include "tests/support/measured_cell.h"
#include "tests/support/folder.h"
#include "tests/support/test.h"

#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static mote_subject subject;

static mote_method_choice choice_of(const char *text)
{
    mote_method_choice choice;
    if (mote_scene_choice_read(text, &choice) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    return choice;
}

static mote_cell cell_of(const mote_method_choice *choice)
{
    mote_cell cell = {.subject = &subject,
                      .choice = choice,
                      .replicate = 1,
                      .first = 1,
                      .last = 40,
                      .stride = 1};
    mote_cell_name(&cell, 7);
    return cell;
}

/* Checks how a cell's process ended. */
static void expect_end(const char *method, double timeout, mote_cell_status status,
                       const char *reason)
{
    const mote_method_choice choice = choice_of(method);
    const mote_cell cell = cell_of(&choice);
    const mote_process_options options = {.directory = ".", .timeout = timeout, .core = -1};
    mote_cell_end end = {.status = MOTE_CELL_OK};
    if (measure_cell(&cell, &options, &end) != MOTE_OK)
        fail_msg("%s: %s", method, mote_error_text());
    assert_int_equal(end.status, status);
    if (!strstr(end.reason, reason))
        fail_msg("not \"%s\": %s", reason, end.reason);
    static const char *const kinds[] = {"json", "csv", "pairs.csv"};
    for (int k = 0; k < 3; ++k) {
        char *path = mote_format("cells/%s.%s", cell.id, kinds[k]);
        assert_int_equal(access(path, F_OK), k == 0 || status == MOTE_CELL_OK ? 0 : -1);
        free(path);
    }
}

TEST(measure_cell_ends_that_are_not_good_are_results)
{
    expect_end("certified", 0, MOTE_CELL_OK, "");
    expect_end("particle:n=2,positions=given", 0, MOTE_CELL_UNSUPPORTED,
               "leave out positions=given");
    expect_end("particle-paper", 0, MOTE_CELL_UNSUPPORTED, "give n=");
    expect_end("particle-paper:n=90000", 0, MOTE_CELL_CRASHED, "n=90000 is not");
    /* 40 frames of 60 bodies take longer than a microsecond. */
    expect_end("certified:ahead=1", 1e-6, MOTE_CELL_TIMEOUT, "ended after 1e-06 s");
    /* The process crashes, because its mesh does not exist. */
    void (*const caught)(int) = signal(SIGSEGV, SIG_DFL);
    mote_body *body = &subject.bodies->shapes[0].body;
    const mote_mesh *mesh = body->mesh;
    mote_mesh cut = *mesh;
    cut.triangles = NULL;
    cut.positions = NULL;
    body->mesh = &cut;
    expect_end("aabb-tree", 0, MOTE_CELL_CRASHED, "ended ");
    body->mesh = mesh;
    (void)signal(SIGSEGV, caught);
}

TEST(mote_plan_make_of_frames_beyond_the_last_is_refused)
{
    mote_choices choices = {0};
    mote_plan plan = {.count = 77};
    const mote_plan_options beyond = {.replicates = 1, .first = 30, .last = 41};
    assert_int_equal(mote_choices_add(&choices, "certified", NULL), MOTE_OK);
    assert_int_equal(mote_plan_make(&beyond, &subject, 1, &choices, &choices, &plan),
                     MOTE_EINVAL);
    assert_non_null(strstr(mote_error_text(), "frames 30-41"));
    assert_non_null(strstr(mote_error_text(), "1-40"));
    assert_int_equal(plan.count, 77);
    mote_choices_free(&choices);
}

/* A budget that is spent at once leaves the minimum number of frames. */
TEST(mote_measure_cell_over_budget_asks_about_the_least_frames)
{
    static const char *const methods[] = {"certified", "certified:ahead=2"};
    for (int k = 0; k < 2; ++k) {
        const mote_method_choice choice = choice_of(methods[k]);
        mote_cell cell = cell_of(&choice);
        mote_cell_result result;
        cell.first = 3;
        cell.budget = 1e-9;
        assert_int_equal(mote_measure_cell(&cell, 0, &result), MOTE_OK);
        assert_int_equal(result.row_count, MOTE_CELL_LEAST_FRAMES);
        assert_int_equal(result.rows[0].frame, 3);
        mote_cell_result_free(&result);
        cell.first = 39;
        cell.budget = 1e9;
        assert_int_equal(mote_measure_cell(&cell, 0, &result), MOTE_OK);
        assert_int_equal(result.row_count, 2);
        mote_cell_result_free(&result);
    }
}

/* Times of a frame are summed over pairs, and the closest pair gives the answer. */
TEST(mote_measure_cell_sums_up_the_near_pairs)
{
    const mote_method_choice choice = choice_of("certified");
    const mote_cell cell = cell_of(&choice);
    mote_cell_result result;
    double closest = HUGE_VAL;
    assert_int_equal(mote_measure_cell(&cell, 0, &result), MOTE_OK);
    assert_int_equal(result.row_count, 40);
    for (size_t k = 0; k < result.row_count; ++k) {
        const mote_cell_row *row = &result.rows[k];
        assert_true(row->query_ns >= row->scene.bounds_ns + row->scene.broad_ns);
        assert_true(row->scene.new_pairs <= row->scene.near_pairs);
        assert_true(k > 0 || row->scene.new_pairs == row->scene.near_pairs);
        assert_true(row->answer.has_contact && row->answer.has_lower);
        assert_int_equal(row->answer.contact, row->scene.pair_contacts > 0);
        if (row->answer.has_distance)
            assert_true(row->answer.lower <= row->answer.distance &&
                        row->answer.distance <= subject.bodies->near);
        else
            assert_true(row->answer.lower <= subject.bodies->near);
        closest = fmin(closest, row->answer.has_distance ? row->answer.distance : HUGE_VAL);
    }
    assert_true(closest < subject.bodies->near);
    assert_true(result.frames_wall_ns > 0);
    mote_cell_result_free(&result);
}

/* File names: other than plain characters become a dash or underscore, and the hash
   distinguishes choices. */
TEST(mote_cell_name_of_many_bodies_is_plain)
{
    mote_bodies named = *subject.bodies;
    char text[] = "AZaz09.@[`{/: ~";
    named.name = text;
    const mote_subject other = {.bodies = &named, .fingerprint = 1};
    const mote_method_choice choices[] = {choice_of("certified:ahead=2"),
                                          choice_of("certified:ahead=3")};
    char ids[2][MOTE_CELL_ID_SIZE];
    for (int k = 0; k < 2; ++k) {
        mote_cell cell = cell_of(&choices[k]);
        cell.subject = &other;
        cell.replicate = 7;
        mote_cell_name(&cell, 7);
        memcpy(ids[k], cell.id, sizeof ids[k]);
    }
    static const char first[] = "AZaz09_________-certified-r7-";
    if (strncmp(ids[0], first, strlen(first)) != 0)
        fail_msg("%s", ids[0]);
    assert_string_not_equal(ids[0], ids[1]);
}

/* Another path, deformation or shape gives another fingerprint. */
TEST(mote_bodies_fingerprint_tells_scenes_apart)
{
    uint64_t before, after;
    mote_bodies *b = subject.bodies;
    assert_int_equal(mote_bodies_fingerprint(b, &before), MOTE_OK);
    assert_true(before == subject.fingerprint);
    double *const numbers[] = {&b->paths[3].place.y, &b->paths[59].spin, &b->paths[7].time,
                               &b->near, &b->room.z};
    for (size_t k = 0; k < sizeof numbers / sizeof numbers[0]; ++k) {
        const double kept = *numbers[k];
        *numbers[k] = kept + 1e-9;
        assert_int_equal(mote_bodies_fingerprint(b, &after), MOTE_OK);
        assert_true(after != before);
        *numbers[k] = kept;
    }
    mote_vec3 *vertex = &((mote_mesh *)(uintptr_t)b->shapes[0].body.mesh)->positions[5];
    const mote_vec3 kept = *vertex;
    vertex->x += 1e-9;
    assert_int_equal(mote_bodies_fingerprint(b, &after), MOTE_OK);
    assert_true(after != before);
    *vertex = kept;
}

static int load_bodies(void)
{
    static const char text[] =
        "{\"purpose\": \"a test\", \"frames\": 40, \"ask\": \"distance\", \"bodies\": {"
        "\"count\": 60, \"box\": 8, \"shapes\": [{\"letter\": \"T\", \"triangles\": 400}]}}\n";
    file_put("b.json", text);
    return mote_subject_load("b.json", &subject) == MOTE_OK &&
                   mote_directory_make("cells") == MOTE_OK
               ? 0
               : -1;
}

static int free_bodies(void)
{
    mote_subject_free(&subject);
    return 0;
}

TEST_GROUP(load_bodies, free_bodies);
