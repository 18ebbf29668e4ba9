/* Comparisons of summaries that the test writes itself. */
#include "harness/compare.h"
#include "harness/record.h"
#include "tests/program.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <sys/stat.h>

static char base[] = "/tmp/mote-test-compare-XXXXXX";
static char old_run[64], new_run[64], said[64];

static int make_base(void **state)
{
    (void)state;
    if (!mkdtemp(base))
        return -1;
    (void)snprintf(old_run, sizeof old_run, "%s/old", base);
    (void)snprintf(new_run, sizeof new_run, "%s/new", base);
    (void)snprintf(said, sizeof said, "%s/said", base);
    return mkdir(old_run, 0777) || mkdir(new_run, 0777);
}

static int remove_base(void **state)
{
    (void)state;
    return program_remove(base);
}

/* A run of one method, five replicates. */
typedef struct figures {
    double ratio;     /* of fcl-aabb's time to this one's, about */
    double jitter;    /* how much replicates differ, a share */
    double box_tests; /* a replicate */
    double heap, missed, p99;
} figures;

static const figures usual = {100, 0.002, 5000, 1e6, 2, 1e-3};

static json_t *one_process(const figures *f, int replicate, double sign)
{
    double wobble = 1 + sign * f->jitter * ((replicate * 7) % 5 - 2);
    return json_pack("{s:i, s:f, s:f, s:{s:f}}", "replicate", replicate, "median_ns",
                     1e6 / f->ratio * wobble, "ratio", f->ratio / wobble, "counters",
                     "box_tests", f->box_tests);
}

/* sign: the two runs of a pair wobble differently. */
static void write_run(const char *directory, const figures *f, double sign)
{
    json_t *processes = json_array();
    for (int r = 1; r <= 5; ++r)
        assert_int_equal(json_array_append_new(processes, one_process(f, r, sign)), 0);
    json_t *row =
        json_pack("{s:s, s:s, s:s, s:{s:i}, s:s, s:s, s:i, s:i, s:i, s:s, s:{s:s}, s:f, s:f, "
                  "s:f, s:f, s:o,"
                  " s:{s:f, s:f, s:f, s:f}}",
                  "scenario", "ww", "fingerprint", "0123456789abcdef", "method",
                  "particle-paper", "parameters", "n", 5, "cache", "hot", "label",
                  "particle-paper:n=5", "stride", 1, "seed", 0, "frames", 100, "status", "ok",
                  "ratio", "to", "fcl-aabb", "heap_live_bytes", f->heap, "heap_peak_bytes",
                  f->heap, "missed", f->missed, "false_contacts", 0.0, "processes", processes,
                  "error", "median", 1e-4, "p99", f->p99, "max", 1e-2, "exact_rate", 0.5);
    assert_non_null(row);
    json_t *summary =
        json_pack("{s:i, s:f, s:[o]}", "schema", 1, "noise_floor", 0.004, "rows", row);
    assert_int_equal(mote_record_json(directory, "summary.json", summary), MOTE_OK);
}

static mote_comparison compare_with(const figures *fresh)
{
    mote_comparison c;
    write_run(old_run, &usual, 1);
    write_run(new_run, fresh, -1);
    assert_int_equal(mote_compare(old_run, new_run, 0.02, &c), MOTE_OK);
    assert_int_equal(c.count, 1);
    return c;
}

static void compare_of_unchanged_runs_is_same(void **state)
{
    (void)state;
    mote_comparison c = compare_with(&usual);
    assert_int_equal(c.changes[0].verdict, MOTE_VERDICT_SAME);
    assert_false(c.worse || c.undecided || c.changes[0].better);
    assert_true(fabs(c.changes[0].ratio - 1) < 0.01);
    assert_true(fabs(c.floor - 0.02) < 1e-12);
    mote_comparison_free(&c);
}

static void compare_with_ten_percent_more_time_is_slower(void **state)
{
    (void)state;
    figures slow = usual;
    slow.ratio /= 1.1;
    mote_comparison c = compare_with(&slow);
    assert_int_equal(c.changes[0].verdict, MOTE_VERDICT_SLOWER);
    assert_true(c.worse);
    assert_true(fabs(c.changes[0].ratio - 1.1) < 0.01);
    assert_string_equal(c.changes[0].what.data, "cost per count changed");
    mote_comparison_free(&c);
}

static void compare_with_noise_is_undecided(void **state)
{
    (void)state;
    figures noisy = usual;
    noisy.jitter = 0.1;
    mote_comparison c = compare_with(&noisy);
    assert_int_equal(c.changes[0].verdict, MOTE_VERDICT_UNDECIDED);
    assert_true(c.undecided && !c.worse);
    mote_comparison_free(&c);
}

static void compare_with_one_more_count_is_worse(void **state)
{
    (void)state;
    figures more = usual;
    more.box_tests += 1;
    mote_comparison c = compare_with(&more);
    assert_true(c.worse);
    assert_int_equal(c.changes[0].verdict, MOTE_VERDICT_SAME);
    assert_non_null(strstr(c.changes[0].what.data, "box_tests"));
    mote_comparison_free(&c);
}

static void compare_with_fewer_counts_is_better(void **state)
{
    (void)state;
    figures less = usual;
    less.box_tests -= 1;
    mote_comparison c = compare_with(&less);
    assert_true(c.changes[0].better && !c.worse);
    mote_comparison_free(&c);
}

static void compare_with_more_bytes_errors_or_misses_is_worse(void **state)
{
    (void)state;
    figures heap = usual, error = usual, missed = usual, rounding = usual;
    heap.heap *= 1.02;
    error.p99 *= 1.1;
    missed.missed += 1;
    rounding.heap *= 1.005;
    const figures *const all[] = {&heap, &error, &missed};
    for (size_t i = 0; i < 3; ++i) {
        mote_comparison c = compare_with(all[i]);
        assert_true(c.worse);
        mote_comparison_free(&c);
    }
    mote_comparison c = compare_with(&rounding);
    assert_false(c.worse);
    mote_comparison_free(&c);
}

/* What a run on a processor leaves beside its summary. */
static void write_beside(const char *directory, const char *processor, double instructions)
{
    json_t *row = json_pack("{s:s, s:s, s:{s:i}, s:f}", "scenario", "ww", "method",
                            "particle-paper", "parameters", "n", 5, "per_frame", instructions);
    assert_int_equal(mote_record_json(directory, "instructions.json",
                                      json_pack("{s:i, s:[o]}", "schema", 1, "rows", row)),
                     MOTE_OK);
    assert_int_equal(
        mote_record_json(directory, "manifest.json",
                         json_pack("{s:s, s:s}", "processor", processor, "compiler", "GNU 12")),
        MOTE_OK);
}

static mote_comparison compare_beside(const figures *fresh, const char *processor,
                                      double instructions)
{
    mote_comparison c;
    write_run(old_run, &usual, 1);
    write_run(new_run, fresh, -1);
    write_beside(old_run, "one", 1000);
    write_beside(new_run, processor, instructions);
    assert_int_equal(mote_compare(old_run, new_run, 0.02, &c), MOTE_OK);
    char command[256];
    (void)snprintf(command, sizeof command, "rm %s/[im]*.json %s/[im]*.json", old_run, new_run);
    assert_int_equal(system(command), 0);
    return c;
}

static void compare_with_more_instructions_is_worse(void **state)
{
    (void)state;
    mote_comparison c = compare_beside(&usual, "one", 1005);
    assert_false(c.worse); /* within 1 % */
    mote_comparison_free(&c);
    c = compare_beside(&usual, "one", 1020);
    assert_true(c.worse && c.instructions);
    assert_non_null(strstr(c.changes[0].what.data, "instructions 1000 to 1020 (+2 %)"));
    mote_comparison_free(&c);
    c = compare_beside(&usual, "one", 900);
    assert_true(!c.worse && c.changes[0].better);
    mote_comparison_free(&c);
}

static void compare_explains_a_slower_time(void **state)
{
    (void)state;
    figures slow = usual, counted = usual;
    slow.ratio /= 1.2;
    counted.ratio /= 1.2;
    counted.box_tests *= 1.2;
    mote_comparison c = compare_beside(&slow, "one", 1000);
    assert_non_null(strstr(c.changes[0].what.data, "at the same instructions"));
    mote_comparison_free(&c);
    c = compare_beside(&slow, "one", 1200);
    assert_non_null(strstr(c.changes[0].what.data, "counts are the same: more or fewer"));
    mote_comparison_free(&c);
    c = compare_beside(&counted, "one", 1200);
    assert_non_null(strstr(c.changes[0].what.data, "the time changed with the counts"));
    mote_comparison_free(&c);
}

static void compare_on_another_processor_is_wide_for_times_and_exact_for_counts(void **state)
{
    (void)state;
    figures slow = usual, very_slow = usual, more = usual;
    slow.ratio /= 1.3;
    very_slow.ratio /= 1.8;
    more.box_tests += 1;
    mote_comparison c = compare_beside(&slow, "two", 1300);
    assert_true(c.other_machine && !c.worse);
    assert_non_null(strstr(c.changes[0].what.data, "another processor"));
    mote_comparison_free(&c);
    c = compare_beside(&very_slow, "two", 1000);
    assert_true(c.worse);
    assert_int_equal(c.changes[0].verdict, MOTE_VERDICT_SLOWER);
    mote_comparison_free(&c);
    c = compare_beside(&more, "two", 1000);
    assert_true(c.worse);
    mote_comparison_free(&c);
}

/* A significant change that such runs cannot tell from noise four times in five is none. */
static void compare_below_the_smallest_change_is_undecided(void **state)
{
    (void)state;
    figures slow = usual;
    slow.ratio /= 1.1;
    write_run(old_run, &usual, 1);
    write_run(new_run, &slow, -1);
    json_t *summary = NULL;
    assert_int_equal(mote_record_read_json(old_run, "summary.json", &summary), MOTE_OK);
    json_t *row = json_array_get(json_object_get(summary, "rows"), 0);
    assert_int_equal(json_object_set_new(row, "smallest_change", json_real(0.15)), 0);
    assert_int_equal(mote_record_json(old_run, "summary.json", summary), MOTE_OK);
    mote_comparison c;
    assert_int_equal(mote_compare(old_run, new_run, 0.02, &c), MOTE_OK);
    assert_int_equal(c.changes[0].verdict, MOTE_VERDICT_UNDECIDED);
    assert_true(c.undecided && !c.worse);
    mote_comparison_free(&c);
}

/* Where cells ran at the same time nothing is said of times. */
static void compare_of_times_measured_with_jobs_is_refused(void **state)
{
    (void)state;
    figures slow = usual;
    slow.ratio /= 2;
    write_run(old_run, &usual, 1);
    write_run(new_run, &slow, -1);
    json_t *summary = NULL;
    assert_int_equal(mote_record_read_json(new_run, "summary.json", &summary), MOTE_OK);
    json_t *row = json_array_get(json_object_get(summary, "rows"), 0);
    assert_int_equal(json_object_set_new(row, "times_comparable", json_false()), 0);
    assert_int_equal(mote_record_json(new_run, "summary.json", summary), MOTE_OK);
    mote_comparison c;
    assert_int_equal(mote_compare(old_run, new_run, 0.02, &c), MOTE_OK);
    assert_false(c.worse);
    assert_true(isnan(c.changes[0].ratio));
    assert_non_null(strstr(c.changes[0].what.data, "not comparable"));
    mote_comparison_free(&c);
}

static int exit_status(const figures *fresh, const char *options)
{
    char line[256];
    write_run(old_run, &usual, 1);
    write_run(new_run, fresh, -1);
    (void)snprintf(line, sizeof line, "compare %s %s %s", old_run, new_run, options);
    return program_wait(program_start(line, said));
}

static void compare_command_tells_by_its_exit_status(void **state)
{
    (void)state;
    figures slow = usual, noisy = usual;
    slow.ratio /= 1.1;
    noisy.jitter = 0.1;
    assert_int_equal(exit_status(&usual, ""), 0);
    assert_int_equal(exit_status(&slow, ""), 1);
    assert_int_equal(exit_status(&slow, "--floor 0.2"), 0);
    assert_int_equal(exit_status(&noisy, "--format json"), 3);
    char text[4096];
    program_read(said, text, sizeof text);
    json_t *object = json_loads(text, 0, NULL);
    assert_non_null(object);
    assert_string_equal(json_string_value(json_object_get(object, "verdict")), "undecided");
    json_decref(object);
}

static void compare_of_what_is_no_run_is_bad_input(void **state)
{
    (void)state;
    assert_int_equal(program_wait(program_start("compare /no/such/run /no/such/run", said)), 4);
    assert_int_equal(program_wait(program_start("compare one", said)), 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(compare_of_unchanged_runs_is_same),
        cmocka_unit_test(compare_with_ten_percent_more_time_is_slower),
        cmocka_unit_test(compare_with_noise_is_undecided),
        cmocka_unit_test(compare_with_one_more_count_is_worse),
        cmocka_unit_test(compare_with_fewer_counts_is_better),
        cmocka_unit_test(compare_with_more_bytes_errors_or_misses_is_worse),
        cmocka_unit_test(compare_with_more_instructions_is_worse),
        cmocka_unit_test(compare_explains_a_slower_time),
        cmocka_unit_test(compare_on_another_processor_is_wide_for_times_and_exact_for_counts),
        cmocka_unit_test(compare_below_the_smallest_change_is_undecided),
        cmocka_unit_test(compare_of_times_measured_with_jobs_is_refused),
        cmocka_unit_test(compare_command_tells_by_its_exit_status),
        cmocka_unit_test(compare_of_what_is_no_run_is_bad_input),
    };
    return cmocka_run_group_tests(tests, make_base, remove_base);
}
