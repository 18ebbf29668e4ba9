/* Fronts of time against error: known results, and a run that the test writes itself. */
#include "harness/summary/front.h"
#include "harness/summary/summary_json.h"
#include "harness/base/record.h"
#include "tests/support/folder.h"
#include "tests/support/test.h"

#include <stddef.h>
#include <stdint.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void near(double a, double b, double share)
{
    if (!(fabs(a - b) <= share * fabs(b)))
        fail_msg("%.17g is not %.17g", a, b);
}

TEST(front_time_between_two_points_is_interpolated)
{
    /* A line of slope -1/2 in logarithms: 1 ms at 1e-4, 0.1 ms at 1e-2; half-way 10^-0.5. */
    const double times[] = {1e6, 1e5}, errors[] = {1e-4, 1e-2};
    near(mote_front_time(times, errors, 2, 1e-4), 1e6, 1e-12);
    near(mote_front_time(times, errors, 2, 1e-2), 1e5, 1e-12);
    near(mote_front_time(times, errors, 2, 1e-3), pow(10, 5.5), 1e-12);
    near(mote_front_time(times, errors, 2, 1), 1e5, 1e-12);
    assert_true(isnan(mote_front_time(times, errors, 2, 1e-5)));
    assert_true(isnan(mote_front_time(times, errors, 0, 1)));
}

TEST(front_time_of_an_exact_point_is_not_interpolated)
{
    const double times[] = {1e6, 1e3}, errors[] = {0, 1e-2};
    near(mote_front_time(times, errors, 2, 1e-3), 1e6, 1e-12);
    near(mote_front_time(times, errors, 2, 1e-2), 1e3, 1e-12);
}

TEST(front_time_leaves_out_points_that_are_dominated)
{
    /* The second is slower and worse than the first; the third is next on the front. */
    const double times[] = {100, 200, 50}, errors[] = {1e-4, 1e-3, 1e-2};
    near(mote_front_time(times, errors, 3, 1e-3), 100 * pow(0.5, 0.5), 1e-12);
}

TEST(front_time_of_points_in_any_order_takes_the_next)
{
    /* With a worse one last and slower ones between: from 100 at 1e-4 to 50 at 1e-2. */
    const double times[] = {100, 10, 50, 500}, errors[] = {1e-4, 1e-1, 1e-2, 1e-2};
    near(mote_front_time(times, errors, 4, 1e-3), 100 * pow(0.5, 0.5), 1e-12);
    const double turned[] = {100, 50, 10}, wrong[] = {1e-4, 1e-2, 1e-1};
    near(mote_front_time(turned, wrong, 3, 1e-3), 100 * pow(0.5, 0.5), 1e-12);
}

TEST(front_title_leaves_out_n_wherever_it_stands)
{
    static const char *const labels[][2] = {{"p:n=5", "p"},
                                            {"p:n=5,refine=no", "p:refine=no"},
                                            {"p:law=log,n=5", "p:law=log"},
                                            {"p:law=log,n=5,refine=no", "p:law=log,refine=no"},
                                            {"p:law=log", "p:law=log"}};
    for (size_t i = 0; i < ROWS_OF(labels); ++i) {
        char label[64], title[64];
        (void)snprintf(label, sizeof label, "%s", labels[i][0]);
        const mote_summary_row row = {.label = label};
        mote_front_title(&row, title, sizeof title);
        assert_string_equal(title, labels[i][1]);
    }
}

static double first_of(void *context, const size_t *drawn, size_t count)
{
    const double *values = context;
    double sum = 0;
    for (size_t i = 0; i < count; ++i)
        sum += log(values[drawn[i]]);
    return exp(sum / (double)count);
}

TEST(process_interval_of_few_processes_is_students)
{
    double values[] = {1, 2, 4, 8, 16};
    mote_confidence interval = mote_statistics_process_interval(first_of, values, 5, 1);
    /* Logarithms 0..4 times log 2: mean 2, deviation sqrt(2.5); t(4, 0.975) = 2.776445. */
    double half = 2.776445105 * sqrt(2.5) / sqrt(5) * log(2);
    near(interval.low, exp(2 * log(2) - half), 1e-6);
    near(interval.high, exp(2 * log(2) + half), 1e-6);
}

TEST(process_interval_of_many_processes_is_near_the_normal_one)
{
    double values[100];
    for (size_t i = 0; i < 100; ++i)
        values[i] = exp((double)i / 100);
    mote_confidence interval = mote_statistics_process_interval(first_of, values, 100, 1);
    /* Mean 0.495, standard error 0.2887 / sqrt(100): 1.96 of them to each side. */
    assert_true(fabs(log(interval.low) - (0.495 - 1.96 * 0.02887)) < 0.01);
    assert_true(fabs(log(interval.high) - (0.495 + 1.96 * 0.02887)) < 0.01);
}

static const char *scenario = "s";
static int wrong_contacts; /* 1: bodies that are apart are said to touch */

/* Writes a cell of 20 frames that all take `ns` and are off by `error`. */
static void write_cell(const char *method, const char *label, double n, int replicate,
                       double ns, double error)
{
    char id[64], name[96];
    mote_text text = {0};
    (void)snprintf(id, sizeof id, "%s-%d", label, replicate);
    json_t *parameters = json_object();
    if (n > 0)
        (void)json_object_set_new(parameters, "n", json_integer((json_int_t)n));
    json_t *cell = json_pack(
        "{s:i, s:s, s:s, s:s, s:s, s:s, s:o, s:i, s:[i,i], s:i, s:i, s:s, s:[i,i], s:[i,i], "
        "s:[i,i]}",
        "schema", 1, "id", id, "status", "ok", "scenario", scenario, "fingerprint",
        "0123456789abcdef", "method", method, "parameters", parameters, "replicate", replicate,
        "frames", 1, 20, "stride", 1, "seed", 0, "cache", "hot", "triangles", 10, 10,
        "vertices", 7, 7, "active", 1, 20);
    mote_text_add(&text,
                  "frame,deform_ns,update_ns,query_ns,truth,error,contact,contact_truth\n");
    for (int k = 1; k <= 20; ++k)
        mote_text_add(&text, "%d,0,0,%.0f,1,%.17g,%d,0\n", k, ns * (1 + 0.01 * replicate),
                      error, wrong_contacts);
    (void)snprintf(name, sizeof name, "cells/%s.csv", id);
    assert_int_equal(mote_record_text(".", name, &text), MOTE_OK);
    (void)snprintf(name, sizeof name, "cells/%s.json", id);
    assert_int_equal(mote_record_json(".", name, cell), MOTE_OK);
}

static int write_run(void)
{
    if (mote_directory_make("cells") != MOTE_OK)
        return -1;
    for (int r = 1; r <= 5; ++r) {
        write_cell("fcl-aabb", "a", 0, r, 1e6, 0);
        write_cell("fcl-obb", "b", 0, r, 2e6, 0);
        write_cell("ours", "c", 5, r, 1e4, 0.9e-2);
        write_cell("ours", "d", 16, r, 1e5, 0.9e-4);
        write_cell("other", "e", 5, r, 3e4, 0.9e-1);
    }
    return 0;
}

TEST_GROUP(write_run, NULL);

static const mote_front *find_front(const mote_fronts *fronts, const char *title)
{
    for (size_t i = 0; i < fronts->count; ++i) {
        if (strcmp(fronts->items[i].title, title) == 0)
            return &fronts->items[i];
    }
    fail_msg("no family %s", title);
    return NULL;
}

TEST(fronts_of_a_run_say_how_much_faster_at_each_error)
{
    mote_summary summary;
    mote_fronts fronts;
    assert_int_equal(mote_summary_make(".", &summary), MOTE_OK);
    fronts = mote_fronts_make(&summary);
    assert_int_equal(fronts.count, 4);
    const mote_front *ours = find_front(&fronts, "ours");
    assert_true(isnan(ours->speed[0].to[MOTE_RIVAL_FCL].faster)); /* never exact */
    /* At 1e-4 and 1e-3 on the line from 10 times at 0.9e-4 to 100 times at 0.9e-2. */
    near(ours->speed[1].to[MOTE_RIVAL_FCL].faster, 10 * pow(1 / 0.9, 0.5), 1e-3);
    near(ours->speed[2].to[MOTE_RIVAL_FCL].faster, 10 * pow(10 / 0.9, 0.5), 1e-3);
    near(ours->speed[3].to[MOTE_RIVAL_FCL].faster, 100, 1e-3);
    near(ours->speed[4].to[MOTE_RIVAL_FCL].faster, 100, 1e-3);
    assert_true(ours->speed[3].to[MOTE_RIVAL_FCL].interval.low <= 100.1 &&
                ours->speed[3].to[MOTE_RIVAL_FCL].interval.high >= 99.9);
    /* FCL's best is FCL AABB; OBB has half the speed. */
    near(find_front(&fronts, "fcl-aabb")->speed[0].to[MOTE_RIVAL_FCL].faster, 1, 1e-9);
    near(find_front(&fronts, "fcl-obb")->speed[0].to[MOTE_RIVAL_FCL].faster, 0.5, 1e-3);
    assert_true(isnan(find_front(&fronts, "other")->speed[3].to[MOTE_RIVAL_FCL].faster));
    mote_fronts_free(&fronts);
    mote_summary_free(&summary);
}

/* Beside ten replicates of FCL: four of one method, each with a time of its own, and one of
   another, which says nothing about how much its times vary. */
TEST(interval_of_a_row_of_few_replicates_comes_from_its_own)
{
    static const double times[] = {100, 200, 400, 800};
    scenario = "uneven";
    for (int r = 1; r <= 10; ++r)
        write_cell("fcl-aabb", "ua", 0, r, 1e6, 0);
    for (int r = 1; r <= 4; ++r)
        write_cell("few", "ub", 0, r, times[r - 1], 0);
    write_cell("single", "uc", 0, 1, 1e3, 0);
    scenario = "s";
    mote_summary summary;
    assert_int_equal(mote_summary_make(".", &summary), MOTE_OK);
    mote_fronts fronts = mote_fronts_make(&summary);
    const mote_front_ratio few = find_front(&fronts, "few")->speed[0].to[MOTE_RIVAL_FCL];
    /* Student's t on logarithms that are log 2 apart: deviation sqrt(5/3) log 2, and
       t(3, 0.975) = 3.182446. The times are written with three digits and more. */
    const double half = 3.182446305 * sqrt(5.0 / 3) / sqrt(4) * log(2);
    near(few.interval.low, few.faster * exp(-half), 1e-2);
    near(few.interval.high, few.faster * exp(half), 1e-2);
    const mote_front_ratio single = find_front(&fronts, "single")->speed[0].to[MOTE_RIVAL_FCL];
    near(single.faster, 1e3, 0.1);
    assert_true(isnan(single.interval.low) && isnan(single.interval.high));
    mote_fronts_free(&fronts);
    mote_summary_free(&summary);
    assert_int_equal(system("rm cells/u[a-c]-*"), 0);
}

static json_t *first_speed(const json_t *fronts, const char *family)
{
    size_t i;
    json_t *front;
    json_array_foreach(fronts, i, front)
    {
        if (strcmp(json_string_value(json_object_get(front, "family")), family) == 0)
            return json_array_get(json_object_get(front, "speed"), 0);
    }
    fail_msg("no family %s", family);
    return NULL;
}

/* Coal is the best engine; ode, which invents contacts, is not,
   and neither is ours. The best FCL stays beside it. */
TEST(fronts_of_a_run_name_the_best_engine_beside_the_best_fcl)
{
    scenario = "engines";
    for (int r = 1; r <= 5; ++r) {
        write_cell("fcl-aabb", "ea", 0, r, 1e6, 0);
        write_cell("coal-aabb", "eb", 0, r, 5e5, 0);
        write_cell("aabb-tree", "ec", 0, r, 1e5, 0);
        wrong_contacts = 1;
        write_cell("ode", "ed", 0, r, 1e3, 0);
        wrong_contacts = 0;
    }
    scenario = "s";
    mote_summary summary;
    assert_int_equal(mote_summary_make(".", &summary), MOTE_OK);
    mote_fronts fronts = mote_fronts_make(&summary);
    const mote_front_speed *ours = &find_front(&fronts, "aabb-tree")->speed[0];
    near(ours->to[MOTE_RIVAL_FCL].faster, 10, 1e-3);
    near(ours->to[MOTE_RIVAL_ENGINE].faster, 5, 1e-3);
    assert_string_equal(summary.rows[ours->to[MOTE_RIVAL_ENGINE].rival].method, "coal-aabb");
    assert_string_equal(summary.rows[ours->to[MOTE_RIVAL_FCL].rival].method, "fcl-aabb");
    const mote_front_speed *itself = &find_front(&fronts, "coal-aabb")->speed[0];
    assert_true(itself->to[MOTE_RIVAL_ENGINE].faster == 1 &&
                isnan(itself->to[MOTE_RIVAL_ENGINE].interval.low));
    json_t *list = mote_fronts_json(&fronts);
    const json_t *speed = first_speed(list, "aabb-tree");
    assert_string_equal(json_string_value(json_object_get(speed, "engine")), "coal-aabb");
    near(json_number_value(json_object_get(speed, "engine_faster")), 5, 1e-3);
    json_decref(list);
    mote_fronts_free(&fronts);
    mote_summary_free(&summary);
    assert_int_equal(system("rm cells/e[a-d]-*"), 0);
}

TEST(fronts_of_a_run_say_who_dominates_whom)
{
    mote_summary summary;
    mote_fronts fronts;
    assert_int_equal(mote_summary_make(".", &summary), MOTE_OK);
    fronts = mote_fronts_make(&summary);
    for (size_t i = 0; i < summary.count; ++i) {
        const char *method = summary.rows[i].method;
        const mote_summary_row *by = summary.rows[i].dominated_by;
        if (strcmp(method, "fcl-obb") == 0)
            assert_string_equal(by->method, "fcl-aabb");
        else if (strcmp(method, "other") == 0)
            assert_string_equal(by->method, "ours");
        else
            assert_null(by);
    }
    assert_int_equal(mote_fronts_write(&fronts, "."), MOTE_OK);
    mote_fronts_free(&fronts);
    mote_summary_free(&summary);
    char *text = file_text("speed.csv");
    size_t lines = 0;
    for (const char *c = text; *c; ++c)
        lines += *c == '\n' ? 1 : 0;
    free(text);
    assert_int_equal(lines, 1 + 4 * MOTE_FRONT_LEVELS);
}

/* Parameters of a method that this build lacks appear in its label as JSON. */
TEST(fronts_of_odd_names_are_fields_of_their_csv)
{
    static const char *const names[] = {"fronts.csv", "speed.csv"};
    static const char *const lines[] = {
        "\n\"s \"\"1\"\", 2\",hot,\"gone:law=\"\"log\"\"\",\"gone:law=\"\"log\"\"\",,0.125,10",
        "\n\"s \"\"1\"\", 2\",hot,\"gone:law=\"\"log\"\"\",1e-09,,,,,"};
    scenario = "s \"1\", 2";
    write_cell("gone:law=\"log\"", "f", 0, 1, 1e3, 0.125);
    scenario = "s";
    mote_summary summary;
    assert_int_equal(mote_summary_make(".", &summary), MOTE_OK);
    assert_int_equal(mote_summary_write(&summary, "."), MOTE_OK);
    mote_summary_free(&summary);
    for (size_t i = 0; i < 2; ++i) {
        char *text = file_text(names[i]);
        if (!strstr(text, lines[i]))
            fail_msg("no line %s in\n%s", lines[i], text);
        free(text);
    }
}
