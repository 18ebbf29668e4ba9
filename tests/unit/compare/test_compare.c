/* Comparisons of summaries that the test writes itself; other files of a run are compared in
   test_compare_beside.c. */
#include "tests/support/folder.h"
#include "tests/support/test.h"
#include "tests/support/two_runs.h"

#include <math.h>

TEST(compare_of_unchanged_runs_is_same)
{
    mote_comparison c = compare_with(&usual);
    assert_int_equal(c.changes[0].verdict, MOTE_VERDICT_SAME);
    assert_false(c.worse || c.undecided || c.changes[0].better);
    assert_true(fabs(c.changes[0].ratio - 1) < 0.01);
    assert_true(fabs(c.floor - 0.02) < 1e-12);
    mote_comparison_free(&c);
}

TEST(compare_with_ten_percent_more_time_is_slower)
{
    figures slow = usual;
    slow.ratio /= 1.1;
    mote_comparison c = compare_with(&slow);
    assert_int_equal(c.changes[0].verdict, MOTE_VERDICT_SLOWER);
    assert_true(c.worse);
    assert_true(fabs(c.changes[0].ratio - 1.1) < 0.01);
    assert_string_equal(c.changes[0].what.data, "cost per count changed");
    mote_comparison_free(&c);
}

TEST(compare_with_noise_is_undecided)
{
    figures noisy = usual;
    noisy.jitter = 0.1;
    mote_comparison c = compare_with(&noisy);
    assert_int_equal(c.changes[0].verdict, MOTE_VERDICT_UNDECIDED);
    assert_true(c.undecided && !c.worse);
    mote_comparison_free(&c);
}

TEST(compare_with_one_more_count_is_worse)
{
    figures more = usual;
    more.box_tests += 1;
    mote_comparison c = compare_with(&more);
    assert_true(c.worse);
    assert_int_equal(c.changes[0].verdict, MOTE_VERDICT_SAME);
    assert_non_null(strstr(c.changes[0].what.data, "box_tests"));
    mote_comparison_free(&c);
}

TEST(compare_with_fewer_counts_is_better)
{
    figures less = usual;
    less.box_tests -= 1;
    mote_comparison c = compare_with(&less);
    assert_true(c.changes[0].better && !c.worse);
    mote_comparison_free(&c);
}

TEST(compare_with_more_bytes_errors_or_misses_is_worse)
{
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

/* A significant change is not reported if such runs could not tell it from noise four times in
   five. */
TEST(compare_below_the_smallest_change_is_undecided)
{
    figures slow = usual;
    slow.ratio /= 1.1;
    write_run("old", &usual, 1);
    write_run("new", &slow, -1);
    json_t *summary = NULL;
    assert_int_equal(mote_record_read_json("old", "summary.json", &summary), MOTE_OK);
    json_t *row = json_array_get(json_object_get(summary, "rows"), 0);
    assert_int_equal(json_object_set_new(row, "smallest_change", json_real(0.15)), 0);
    put("old", "summary.json", summary);
    mote_comparison c;
    assert_int_equal(mote_compare("old", "new", 0.02, &c), MOTE_OK);
    assert_int_equal(c.changes[0].verdict, MOTE_VERDICT_UNDECIDED);
    assert_true(c.undecided && !c.worse);
    mote_comparison_free(&c);
}

/* Times of cells that ran at the same time are not compared. */
TEST(compare_of_times_measured_with_jobs_is_refused)
{
    figures slow = usual;
    slow.ratio /= 2;
    write_run("old", &usual, 1);
    write_run("new", &slow, -1);
    json_t *summary = NULL;
    assert_int_equal(mote_record_read_json("new", "summary.json", &summary), MOTE_OK);
    json_t *row = json_array_get(json_object_get(summary, "rows"), 0);
    assert_int_equal(json_object_set_new(row, "times_comparable", json_false()), 0);
    put("new", "summary.json", summary);
    mote_comparison c;
    assert_int_equal(mote_compare("old", "new", 0.02, &c), MOTE_OK);
    assert_false(c.worse);
    assert_true(isnan(c.changes[0].ratio));
    assert_non_null(strstr(c.changes[0].what.data, "not comparable"));
    mote_comparison_free(&c);
}

static int exit_status(const figures *fresh, const char *options)
{
    write_run("old", &usual, 1);
    write_run("new", fresh, -1);
    return mote("compare old new %s", options);
}

TEST(compare_command_tells_by_its_exit_status)
{
    figures slow = usual, noisy = usual;
    slow.ratio /= 1.1;
    noisy.jitter = 0.1;
    assert_int_equal(exit_status(&usual, ""), 0);
    assert_int_equal(exit_status(&slow, ""), 1);
    assert_int_equal(exit_status(&slow, "--floor 0.2"), 0);
    assert_int_equal(exit_status(&noisy, "--format json"), 3);
    json_t *object = json_loads(said, 0, NULL);
    assert_non_null(object);
    assert_string_equal(json_string_value(json_object_get(object, "verdict")), "undecided");
    json_decref(object);
}

TEST(compare_of_what_is_no_run_is_bad_input)
{
    mote_expect(4, "", "compare /no/such/run /no/such/run");
    mote_expect(2, "", "compare one");
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

TEST(compare_of_changed_rows_says_what_is_worse_better_or_unknown)
{
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
        {"{'replicates_failed': 0}", "{'replicates_failed': 1}", 1, "failed replicates 0 to 1"},
        {"{}", "{'replicates_failed': 2}", 1, "WORSE : failed replicates 0 to 2"},
        {"{'replicates_failed': 2}", "{'replicates_failed': 1}", 0, "failed replicates 2 to 1"},
        {"{'replicates_failed': 1}", "{'replicates_failed': 1}", 0, "same or better"},
        {"{'missed': 1}", "{'missed': null}", 1, "WORSE : missed 1 to unknown"},
        {"{'missed': null}", "{'missed': 1}", 0, "missed unknown to 1\n"},
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
    for (size_t i = 0; i < ROWS_OF(cases); ++i) {
        write_run("old", &usual, 1);
        write_run("new", &usual, -1);
        change_row("old", "summary.json", cases[i].old_members);
        change_row("new", "summary.json", cases[i].new_members);
        expect("", cases[i].status, cases[i].says);
    }
}

/* A row of FCL that others' ratios are to. */
#define FCL(parameters, label)                                                                 \
    "{'method': 'fcl-aabb', 'parameters': {" parameters "}, 'label': '" label "', "            \
    "'ratio': {'to': '" label "'}, 'missed': 0}"

/* Ratios to another configuration of fcl-aabb say nothing about the row: its times are compared
   as they are, on one machine. */
TEST(compare_of_ratios_to_other_configurations_compares_times)
{
    static const char same[] = "'queue': '2'", other[] = "'queue': '64'";
    static const struct {
        const char *parameters, *label;
        bool differs;
    } rows[] = {{same, "fcl-aabb", false}, {other, "fcl-aabb:queue=64", true}};
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        figures slow = usual;
        char members[512];
        slow.ratio /= 2; /* twice the time */
        test_row("%s", rows[i].label);
        write_run("old", &usual, 1);
        write_run("new", &slow, -1);
        add_row("old", FCL("'queue': '2'", "fcl-aabb"));
        (void)snprintf(members, sizeof members, FCL("%s", "%s"), rows[i].parameters,
                       rows[i].label, rows[i].label);
        add_row("new", members);
        (void)snprintf(
            members, sizeof members,
            "{'ratio': {'to': '%s'}, 'processes': [" PROCESS(1, 200, 20000) ", " PROCESS(
                2, 201, 20100) ", " PROCESS(3, 200,
                                            20050) ", " PROCESS(4, 201,
                                                                20000) ", " PROCESS(5, 200,
                                                                                    20100) "]}",
            rows[i].label);
        change_row_at("new", "summary.json", 1,
                      members); /* a faster FCL makes it look twice as fast */
        if (rows[i].differs)
            expect("", 1, "ratios are to fcl-aabb and to fcl-aabb:queue=64: times as they are");
        else
            expect("", 0, "faster");
        write_beside("old", "one", 1000);
        write_beside("new", "two", 1000);
        if (rows[i].differs)
            expect("", 3,
                   "ratios are to fcl-aabb and to fcl-aabb:queue=64: no time to compare");
        else
            expect("", 0, "better");
        remove_beside();
    }
}

TEST(compare_of_rows_without_a_partner_is_undecided)
{
    write_run("old", &usual, 1);
    write_run("new", &usual, -1);
    add_row("new", "{'frames': 50}");
    expect("", 0, "without a partner: 0 rows of BASE, 1 of NEW\nsame or better");
    add_row("old", "{'seed': 7}");
    expect("", 3, "without a partner: 1 rows of BASE, 1 of NEW\nundecided");
    expect("--format json", 3, "\"only_base\": 1");
    write_beside("old", "one", 1000);
    write_beside("new", "one", 1100);
    expect("", 1, "WORSE : instructions 1000 to 1100 (+10 %)");
    /* Rows of instructions that match nothing compared, or contain nothing. */
    static const char *const members[] = {"{'scenario': 'tt'}", "{'method': 'certified'}",
                                          "{'parameters': {'n': 6}}", "{'per_frame': null}"};
    for (size_t i = 0; i < ROWS_OF(members); ++i) {
        write_beside("old", "one", 1000);
        write_beside("new", "one", 1100);
        change_row(i % 2 ? "old" : "new", "instructions.json", members[i]);
        expect("", 3, "undecided");
    }
    remove_beside();
}

/* The fastest of each group of replicates is faster where groups are larger, as if the method
   had changed; processes are compared one by one. */
TEST(compare_of_unequal_replicates_compares_those_that_both_have)
{
    write_run("old", &usual, 1);
    write_run("new", &usual, -1);
    change_row("old", "summary.json", "{'quiet': {'ratio': [100, 100.1, 100, 100.1, 100]}}");
    change_row("new", "summary.json", "{'quiet': {'ratio': [120, 120.1, 120, 120.1, 120]}}");
    expect("", 0, "faster");
    json_t *summary = NULL;
    assert_int_equal(mote_record_read_json("new", "summary.json", &summary), MOTE_OK);
    json_t *row = json_array_get(json_object_get(summary, "rows"), 0);
    json_t *processes = json_object_get(row, "processes");
    assert_int_equal(json_array_append_new(processes, one_process(&usual, 6, 1)), 0);
    put("new", "summary.json", summary);
    expect("", 0, "same");
    assert_null(strstr(said, "faster"));
    mote_expect(0, "same", "compare new old");
    assert_null(strstr(said, "slower"));
}

/* A run from before a parameter was added had the default. */
TEST(compare_of_rows_with_a_parameter_that_is_new_finds_the_default)
{
    static const struct {
        const char *parameters; /* of the new run */
        int status;
    } cases[] = {{"'build': 'rest'", 0}, {"'threads': 1", 0},       {"'threads': 1.0", 0},
                 {"'threads': 2", 4},    {"'build': 'samples'", 4}, {"'build': 3", 4},
                 {"'never': 'rest'", 4}};
    for (size_t i = 0; i < ROWS_OF(cases); ++i) {
        char members[128];
        write_run("old", &usual, 1);
        write_run("new", &usual, -1);
        change_row("old", "summary.json",
                   "{'method': 'aabb-tree', 'parameters': {'seed': 'none'}}");
        (void)snprintf(members, sizeof members,
                       "{'method': 'aabb-tree', 'parameters': {'seed': 'none', %s}}",
                       cases[i].parameters);
        change_row("new", "summary.json", members);
        const char *text = cases[i].status ? "no configuration in common" : "same or better";
        expect("", cases[i].status, text);
        mote_expect(cases[i].status, text, "compare new old"); /* in the opposite order */
    }
}

/* Of one configuration on three machines, the row of the same machine is compared, or else the
   first. */
TEST(compare_prefers_the_row_of_the_same_machine)
{
    write_run("old", &usual, 1);
    write_run("new", &usual, -1);
    change_row("new", "summary.json", "{'machine': 'third', 'missed': 4}");
    add_row("new", "{'machine': 'second', 'missed': 5}");
    add_row("new", "{'machine': 'first', 'missed': 6}");
    change_row("old", "summary.json", "{'machine': 'second'}");
    expect("", 1, "missed 2 to 5");
    change_row("old", "summary.json", "{'machine': 'none of them'}");
    expect("", 1, "missed 2 to 6");
}

/* Two rows of the base match one row of the new run, which therefore has a partner. */
TEST(compare_of_several_machines_with_one_counts_rows_without_a_partner)
{
    write_run("old", &usual, 1);
    write_run("new", &usual, -1);
    add_row("old", "{'machine': 'second'}");
    add_row("old", "{'machine': 'third'}");
    expect("--format json", 0, "\"only_new\": 0");
    add_row("new", "{'frames': 50}");
    expect("", 0, "without a partner: 0 rows of BASE, 1 of NEW\n");
}

/* On another machine only ratios are compared; a wider noise floor still applies. */
TEST(compare_on_another_machine_without_ratios_knows_no_time)
{
    write_run("old", &usual, 1);
    write_run("new", &usual, -1);
    change_row("old", "summary.json", NO_RATIO);
    change_row("new", "summary.json", NO_RATIO_SLOWER);
    write_beside("old", "one", 1000);
    write_beside("new", "two", 1000);
    expect("", 0, "the processors differ: times only as ratios to fcl-aabb");
    expect("", 0, "an effect counts from 50.0 % on");
    expect("--floor 0.75", 0, "an effect counts from 75.0 % on");
    expect("--format=json", 0, "\"ratio\": null");
    expect("--format=json", 0, "\"other_machine\": true");
    remove_beside();
}

/* One worse row is enough. */
TEST(compare_of_two_rows_is_worse_when_the_first_is)
{
    write_run("old", &usual, 1);
    write_run("new", &usual, -1);
    add_row("old", "{'frames': 50}");
    add_row("new", "{'frames': 50, 'missed': 3}");
    expect("", 1, "p corrected over 2 rows");
    expect("--format json", 1, "\"verdict\": \"worse\"");
}

TEST(compare_of_what_has_no_rows_is_bad_input)
{
    static const char *const summaries[] = {"{\"schema\": 1}\n", "{\"rows\": 5}\n", "[]\n"};
    for (size_t i = 0; i < ROWS_OF(summaries); ++i) {
        for (int which = 0; which < 2; ++which) {
            write_run("old", &usual, 1);
            write_run("new", &usual, -1);
            file_put(which ? "new/summary.json" : "old/summary.json", summaries[i]);
            expect("", 4, "no rows; name a run, or its summary.json");
        }
    }
    write_run("old", &usual, 1);
    write_run("new", &usual, -1);
    change_row("new", "summary.json", "{'seed': 9}");
    expect("", 4, "the two runs have no configuration in common");
}
