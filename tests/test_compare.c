/* Comparisons of summaries that the test writes itself. */
#include "harness/compare.h"
#include "harness/record.h"
#include "tests/plain_file.h"
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

/* Without the sync of mote_record_json; object is taken over. */
static void put(const char *directory, const char *name, json_t *object)
{
    char path[96];
    (void)snprintf(path, sizeof path, "%s/%s", directory, name);
    assert_non_null(object);
    assert_int_equal(json_dump_file(object, path, 0), 0);
    json_decref(object);
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
    put(directory, "summary.json", summary);
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
    put(directory, "instructions.json", json_pack("{s:i, s:[o]}", "schema", 1, "rows", row));
    put(directory, "manifest.json",
        json_pack("{s:s, s:s}", "processor", processor, "compiler", "GNU 12"));
}

static void remove_beside(void)
{
    char command[256];
    (void)snprintf(command, sizeof command, "rm %s/[im]*.json %s/[im]*.json", old_run, new_run);
    assert_int_equal(system(command), 0);
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
    remove_beside();
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
    put(old_run, "summary.json", summary);
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
    put(new_run, "summary.json", summary);
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

/* Puts the members of an object, written with ', into the first row of a run's file. */
static void change_row(const char *directory, const char *name, const char *members)
{
    char plain[1024];
    json_t *summary = NULL;
    (void)snprintf(plain, sizeof plain, "%s", members);
    for (char *c = plain; *c; ++c)
        *c = *c == '\'' ? '"' : *c;
    json_t *change = json_loads(plain, 0, NULL);
    assert_non_null(change);
    assert_int_equal(mote_record_read_json(directory, name, &summary), MOTE_OK);
    json_t *row = json_array_get(json_object_get(summary, "rows"), 0);
    assert_int_equal(json_object_update_recursive(row, change), 0);
    json_decref(change);
    put(directory, name, summary);
}

/* mote compare OLD NEW OPTIONS: its exit status, and what it must say. */
static void expect(const char *options, int status, const char *says)
{
    char line[256], text[8192];
    (void)snprintf(line, sizeof line, "compare %s %s %s", old_run, new_run, options);
    const int ended = program_wait(program_start(line, said));
    program_read(said, text, sizeof text);
    if (ended != status || !strstr(text, says))
        fail_msg("exit %d, not %d, or not \"%s\":\n%s", ended, status, says, text);
}

#define PROCESS(replicate, ratio, ns)                                                          \
    "{'replicate': " #replicate ", 'ratio': " #ratio ", 'median_ns': " #ns                     \
    ", 'counters': {'box_tests': 5000}}"
#define NO_RATIO                                                                               \
    "{'processes': [" PROCESS(1, null, 100) ", " PROCESS(2, null, 101) ", " PROCESS(           \
        3, null, 100.5) "]}"
#define NO_RATIO_SLOWER                                                                        \
    "{'processes': [" PROCESS(1, null, 150) ", " PROCESS(2, null, 151.5) ", " PROCESS(         \
        3, null, 150.8) "]}"
#define TWO_COUNTS(first)                                                                      \
    "{'processes': [{'replicate': 1, 'counters': {'box_tests': " #first ", 'steps': 3}}]}"
#define QUIET(a, b, c, d, e)                                                                   \
    "{'quiet': {'ratio': [" #a ", " #b ", " #c ", " #d ", " #e "], 'total_ns': [9, 9, 9, "     \
    "9, 9]}}"

static void compare_of_changed_rows_says_what_is_worse_better_or_unknown(void **state)
{
    (void)state;
    static const struct {
        const char *old_members, *new_members;
        int status;
        const char *says;
    } cases[] = {
        {"{'status': 'crashed'}", "{}", 0, "better : status crashed to ok"},
        {"{}", "{'status': 'timeout'}", 1, "WORSE : status ok to timeout"},
        {"{'status': 'crashed'}", "{'status': 'timeout'}", 0, "status crashed to timeout"},
        {"{'status': 'crashed'}", "{'status': 'crashed'}", 0, "same or better"},
        {"{'status': null}", "{}", 0, "better : status  to ok"},
        {"{'label': 'fcl-aabb'}", "{'label': 'fcl-aabb'}", 0, "what times are compared with"},
        {"{'label': 'fcl-aabb'}", "{}", 0, " p "},
        {"{'ratio': null, 'label': null}", "{}", 0, "ww//hot"},
        {"{'times_comparable': false}", "{}", 0, "times not comparable: measured with --jobs"},
        {"{'missed': 0}", "{'missed': 1}", 1, "WORSE : missed 0 to 1\n"},
        {"{'missed': null}", "{'missed': null}", 0, "same or better"},
        {"{'missed': 1}", "{'missed': null}", 1, "WORSE : missed 1 to nan"},
        {"{'missed': null}", "{'missed': 1}", 1, "missed nan to 1"},
        {"{'error': {'p99': 1e-14}}", "{'error': {'p99': 1e-13}}", 0, "same or better"},
        {"{'error': {'p99': 1e-14}}", "{'error': {'p99': 1e-11}}", 1, "p99 1e-14 to 1e-11"},
        {"{'processes': []}", "{}", 0, " - "},
        {NO_RATIO, NO_RATIO, 0, " 1.000 ["},
        {NO_RATIO, NO_RATIO_SLOWER, 1, " 1.500 ["},
        {"{}", NO_RATIO, 0, "better : cost per count changed"},
        {TWO_COUNTS(1), TWO_COUNTS(2), 1, "WORSE : box_tests 1 to 2 (+1e+02 %)\n"},
        {NO_RATIO_SLOWER, NO_RATIO, 0, "better : cost per count changed"},
        {"{'processes': [" PROCESS(1, null, 0) "]}", NO_RATIO, 0, " - "},
        {NO_RATIO, "{'processes': [" PROCESS(1, null, 0) ", " PROCESS(9, 1, 1) "]}", 3,
         " : no time to compare"},
        {"{}", "{'processes': []}", 3,
         "no time to compare; no replicate in common: counts are not compared"},
        {"{}", "{'processes': [], 'heap_live_bytes': 1e5}", 3, " : no time to compare"},
        {"{}", "{'processes': [], 'missed': 9}", 1, "WORSE : no time to compare"},
        {QUIET(10, 10.1, 10, 10.1, 10), "{'processes': []}", 3, "no time to compare"},
        {"{'status': null}", "{'status': null}", 3, "no status"},
        {"{'status': null}", "{'status': 'crashed'}", 3, "status  to crashed"},
        {QUIET(10, 10.1, 10, 10.1, 10), QUIET(5, 5.05, 5, 5.05, 5), 1, " 2.000 ["},
        {QUIET(10, 10.1, 10, 10.1, null), QUIET(5, 5.05, 5, 5.05, 5), 1, " p "},
        {QUIET(10, 10.1, 10, 10.1, 10),
         "{'heap_live_bytes': 2e6, 'quiet': {'ratio': [5, 5.05, 5, 5.05, 5]}}", 1,
         "heap 1e+06 to 2e+06 (+1e+02 %); cost per count changed"}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        write_run(old_run, &usual, 1);
        write_run(new_run, &usual, -1);
        change_row(old_run, "summary.json", cases[i].old_members);
        change_row(new_run, "summary.json", cases[i].new_members);
        expect("", cases[i].status, cases[i].says);
    }
}

/* Gives a run the rows of another one, too, with other frames; they are put first. */
static void add_row(const char *directory, const char *members)
{
    json_t *summary = NULL;
    assert_int_equal(mote_record_read_json(directory, "summary.json", &summary), MOTE_OK);
    json_t *rows = json_object_get(summary, "rows");
    assert_int_equal(json_array_insert_new(rows, 0, json_deep_copy(json_array_get(rows, 0))),
                     0);
    put(directory, "summary.json", summary);
    change_row(directory, "summary.json", members);
}

static void compare_of_rows_without_a_partner_is_undecided(void **state)
{
    (void)state;
    write_run(old_run, &usual, 1);
    write_run(new_run, &usual, -1);
    add_row(new_run, "{'frames': 50}");
    expect("", 0, "without a partner: 0 rows of BASE, 1 of NEW\nsame or better");
    add_row(old_run, "{'seed': 7}");
    expect("", 3, "without a partner: 1 rows of BASE, 1 of NEW\nundecided");
    expect("--format json", 3, "\"only_base\": 1");
    write_beside(old_run, "one", 1000);
    write_beside(new_run, "one", 1100);
    expect("", 1, "WORSE : instructions 1000 to 1100 (+10 %)");
    /* Rows of instructions that are of nothing that is compared, or know nothing. */
    static const char *const members[] = {"{'scenario': 'tt'}", "{'method': 'certified'}",
                                          "{'parameters': {'n': 6}}", "{'per_frame': null}"};
    for (size_t i = 0; i < sizeof members / sizeof members[0]; ++i) {
        write_beside(old_run, "one", 1000);
        write_beside(new_run, "one", 1100);
        change_row(i % 2 ? old_run : new_run, "instructions.json", members[i]);
        expect("", 3, "undecided");
    }
    remove_beside();
}

/* Of one configuration on three machines, that of the same machine is compared, or else the
   first. */
static void compare_prefers_the_row_of_the_same_machine(void **state)
{
    (void)state;
    write_run(old_run, &usual, 1);
    write_run(new_run, &usual, -1);
    change_row(new_run, "summary.json", "{'machine': 'third', 'missed': 4}");
    add_row(new_run, "{'machine': 'second', 'missed': 5}");
    add_row(new_run, "{'machine': 'first', 'missed': 6}");
    change_row(old_run, "summary.json", "{'machine': 'second'}");
    expect("", 1, "missed 2 to 5");
    change_row(old_run, "summary.json", "{'machine': 'none of them'}");
    expect("", 1, "missed 2 to 6");
}

/* Two rows of the base with one partner: no row of the new run is without one. */
static void compare_of_several_machines_with_one_counts_rows_without_a_partner(void **state)
{
    (void)state;
    write_run(old_run, &usual, 1);
    write_run(new_run, &usual, -1);
    add_row(old_run, "{'machine': 'second'}");
    add_row(old_run, "{'machine': 'third'}");
    expect("--format json", 0, "\"only_new\": 0");
    add_row(new_run, "{'frames': 50}");
    expect("", 0, "without a partner: 0 rows of BASE, 1 of NEW\n");
}

/* On another machine only ratios are compared; a floor that is wider still stays. */
static void compare_on_another_machine_without_ratios_knows_no_time(void **state)
{
    (void)state;
    write_run(old_run, &usual, 1);
    write_run(new_run, &usual, -1);
    change_row(old_run, "summary.json", NO_RATIO);
    change_row(new_run, "summary.json", NO_RATIO_SLOWER);
    write_beside(old_run, "one", 1000);
    write_beside(new_run, "two", 1000);
    expect("", 0, "the processors differ: times only as ratios to fcl-aabb");
    expect("", 0, "an effect counts from 50.0 % on");
    expect("--floor 0.75", 0, "an effect counts from 75.0 % on");
    expect("--format=json", 0, "\"ratio\": null");
    expect("--format=json", 0, "\"other_machine\": true");
    remove_beside();
}

static void
compare_of_another_compiler_or_without_a_manifest_judges_no_instructions(void **state)
{
    (void)state;
    char path[96];
    write_run(old_run, &usual, 1);
    write_run(new_run, &usual, -1);
    write_beside(old_run, "one", 1000);
    write_beside(new_run, "one", 1100);
    put(new_run, "manifest.json",
        json_pack("{s:s, s:s}", "processor", "one", "compiler", "Clang 14"));
    expect("", 0, "instructions (another processor or compiler) 1000 to 1100");
    /* What is not known does not differ. */
    (void)snprintf(path, sizeof path, "%s/manifest.json", new_run);
    assert_int_equal(unlink(path), 0);
    expect("", 1, "WORSE : instructions 1000 to 1100");
    (void)snprintf(path, sizeof path, "%s/instructions.json", new_run);
    assert_int_equal(unlink(path), 0);
    expect("--format json", 0, "\"instructions_compared\": false");
    write_beside(new_run, "one", 1100);
    remove_beside();
}

/* What only one run has counted, or over other frames, is not compared, and not passed over. */
static void compare_of_instructions_of_other_frames_is_undecided(void **state)
{
    (void)state;
    static const struct {
        const char *old_members, *new_members;
        int status;
        const char *says;
    } cases[] = {{"{'frames': [1, 9]}", "{'frames': [1, 9]}", 1, "instructions 1000 to 1100"},
                 {"{'frames': [1, 9]}", "{'frames': [2, 9]}", 3, "not counted over the same"},
                 {"{'frames': [1, 9]}", "{}", 3, "not counted over the same"},
                 {"{}", "{'frames': [2, 9]}", 3, "not counted over the same"},
                 {"{}", "{'per_frame': null}", 3, "not counted over the same"},
                 {"{'per_frame': null}", "{}", 0, "same or better"}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        write_run(old_run, &usual, 1);
        write_run(new_run, &usual, -1);
        write_beside(old_run, "one", 1000);
        write_beside(new_run, "one", 1100);
        change_row(old_run, "instructions.json", cases[i].old_members);
        change_row(new_run, "instructions.json", cases[i].new_members);
        expect("", cases[i].status, cases[i].says);
    }
    remove_beside();
}

/* What is there and damaged is not taken for what is not there: nothing would be compared. */
static void compare_of_damaged_files_beside_the_summary_is_bad_input(void **state)
{
    (void)state;
    static const char *const names[] = {"instructions.json", "manifest.json"};
    for (size_t i = 0; i < 4; ++i) {
        char path[96];
        write_run(old_run, &usual, 1);
        write_run(new_run, &usual, -1);
        write_beside(old_run, "one", 1000);
        write_beside(new_run, "one", 1100);
        (void)snprintf(path, sizeof path, "%s/%s", i % 2 ? new_run : old_run, names[i / 2]);
        assert_int_equal(truncate(path, 20), 0);
        expect("", 4, names[i / 2]);
    }
    remove_beside();
}

/* One row that is worse is enough. */
static void compare_of_two_rows_is_worse_when_the_first_is(void **state)
{
    (void)state;
    write_run(old_run, &usual, 1);
    write_run(new_run, &usual, -1);
    add_row(old_run, "{'frames': 50}");
    add_row(new_run, "{'frames': 50, 'missed': 3}");
    expect("", 1, "p corrected over 2 rows");
    expect("--format json", 1, "\"verdict\": \"worse\"");
}

/* A run may be named by its summary. */
static void compare_of_summaries_by_name_is_that_of_their_runs(void **state)
{
    (void)state;
    char line[256], text[4096], here[64];
    write_run(old_run, &usual, 1);
    write_run(new_run, &usual, -1);
    write_beside(old_run, "one", 1000);
    write_beside(new_run, "one", 1100);
    (void)snprintf(line, sizeof line, "compare %s/summary.json %s/summary.json", old_run,
                   new_run);
    assert_int_equal(program_wait(program_start(line, said)), 1);
    program_read(said, text, sizeof text);
    assert_non_null(strstr(text, "instructions 1000 to 1100"));
    assert_non_null(getcwd(here, sizeof here));
    assert_int_equal(chdir(old_run), 0);
    (void)snprintf(line, sizeof line, "compare summary.json %s", new_run);
    assert_int_equal(program_wait(program_start(line, said)), 1);
    program_read(said, text, sizeof text);
    assert_non_null(strstr(text, "instructions 1000 to 1100"));
    assert_int_equal(chdir(here), 0);
    remove_beside();
}

static void compare_of_what_has_no_rows_is_bad_input(void **state)
{
    (void)state;
    static const char *const summaries[] = {"{\"schema\": 1}\n", "{\"rows\": 5}\n", "[]\n"};
    for (size_t i = 0; i < sizeof summaries / sizeof summaries[0]; ++i) {
        for (int which = 0; which < 2; ++which) {
            char path[96];
            write_run(old_run, &usual, 1);
            write_run(new_run, &usual, -1);
            (void)snprintf(path, sizeof path, "%s/summary.json", which ? new_run : old_run);
            assert_true(plain_file_put(path, summaries[i]));
            expect("", 4, "no rows; name a run, or its summary.json");
        }
    }
    write_run(old_run, &usual, 1);
    write_run(new_run, &usual, -1);
    change_row(new_run, "summary.json", "{'seed': 9}");
    expect("", 4, "the two runs have no configuration in common");
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
        cmocka_unit_test(compare_of_two_rows_is_worse_when_the_first_is),
        cmocka_unit_test(
            compare_of_another_compiler_or_without_a_manifest_judges_no_instructions),
        cmocka_unit_test(compare_of_instructions_of_other_frames_is_undecided),
        cmocka_unit_test(compare_of_damaged_files_beside_the_summary_is_bad_input),
        cmocka_unit_test(compare_of_what_has_no_rows_is_bad_input),
        cmocka_unit_test(compare_of_summaries_by_name_is_that_of_their_runs),
        cmocka_unit_test(compare_on_another_machine_without_ratios_knows_no_time),
        cmocka_unit_test(compare_prefers_the_row_of_the_same_machine),
        cmocka_unit_test(compare_of_several_machines_with_one_counts_rows_without_a_partner),
        cmocka_unit_test(compare_of_rows_without_a_partner_is_undecided),
        cmocka_unit_test(compare_of_changed_rows_says_what_is_worse_better_or_unknown),
    };
    return cmocka_run_group_tests(tests, make_base, remove_base);
}
