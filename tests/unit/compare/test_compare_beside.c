/* Comparisons with other files of a run: instructions, and a manifest that names the processor
   and the compiler. */
#include "harness/summary/summary_json.h"
#include "harness/base/file.h"
#include "tests/support/mote.h"
#include "tests/support/stored_cells.h"
#include "tests/support/two_runs.h"

#include <unistd.h>

static mote_comparison compare_beside(const figures *fresh, const char *processor,
                                      double instructions)
{
    mote_comparison c;
    write_run("old", &usual, 1);
    write_run("new", fresh, -1);
    write_beside("old", "one", 1000);
    write_beside("new", processor, instructions);
    assert_int_equal(mote_compare("old", "new", 0.02, &c), MOTE_OK);
    remove_beside();
    return c;
}

/* Without them any two rows would be the same, and the verdict "undecided". */
TEST(compare_of_rows_that_are_not_named_says_what_is_missing)
{
    static const char *const rows[][2] = {
        {"{}", "row 1 has no scenario"},
        {"{\"scenario\": \"s\"}", "row 1 has no method"},
        {"{\"scenario\": \"s\", \"method\": \"m\"}", "row 1 has no fingerprint"}};
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        char *text = mote_format("{\"schema\": 1, \"rows\": [%s]}\n", rows[i][0]);
        file_put("unnamed.json", text);
        free(text);
        mote_expect(4, rows[i][1], "compare unnamed.json unnamed.json");
    }
}

TEST(compare_with_more_instructions_is_worse)
{
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

TEST(compare_explains_a_slower_time)
{
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

TEST(compare_on_another_processor_is_wide_for_times_and_exact_for_counts)
{
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

TEST(compare_of_another_compiler_or_without_a_manifest_judges_no_instructions)
{
    write_run("old", &usual, 1);
    write_run("new", &usual, -1);
    write_beside("old", "one", 1000);
    write_beside("new", "one", 1100);
    put("new", "manifest.json",
        json_pack("{s:s, s:s}", "processor", "one", "compiler", "Clang 14"));
    expect("", 0, "instructions (another processor or compiler) 1000 to 1100");
    /* Unknown values do not differ. */
    assert_int_equal(unlink("new/manifest.json"), 0);
    expect("", 1, "WORSE : instructions 1000 to 1100");
    assert_int_equal(unlink("new/instructions.json"), 0);
    expect("--format json", 0, "\"instructions_compared\": false");
    write_beside("new", "one", 1100);
    remove_beside();
}

/* `mote run mv --step 10` asks for impacts: a count of distances on mv says nothing of it. */
TEST(compare_of_instructions_is_of_what_was_asked)
{
    static const struct {
        const char *row, *counted;
        int status;
        const char *says;
    } cases[] = {
        {"{'ask': 'impact', 'step': 10}", "{}", 0, "same or better"},
        {"{'ask': 'impact', 'step': 10}", "{'ask': 'distance', 'step': 0}", 0,
         "same or better"},
        {"{'ask': 'impact', 'step': 10}", "{'ask': 'impact', 'step': 5}", 0, "same or better"},
        {"{'ask': 'impact', 'step': 10}", "{'ask': 'impact', 'step': 10}", 1,
         "instructions 1000 to 1100"},
        {"{'ask': 'distance'}", "{'ask': 'contact', 'step': 0}", 0, "same or better"},
        {"{'ask': 'distance'}", "{'ask': 'distance', 'step': 0}", 1,
         "instructions 1000 to 1100"},
        {"{'ask': 'distance'}", "{}", 1, "instructions 1000 to 1100"}};
    static const char *const runs[] = {"old", "new"};
    for (size_t i = 0; i < ROWS_OF(cases); ++i) {
        test_row("%s, counted %s", cases[i].row, cases[i].counted);
        for (size_t k = 0; k < ROWS_OF(runs); ++k) {
            write_run(runs[k], &usual, k == 0 ? 1 : -1);
            write_beside(runs[k], "one", k == 0 ? 1000 : 1100);
            change_row(runs[k], "summary.json", cases[i].row);
            change_row(runs[k], "instructions.json", cases[i].counted);
        }
        expect("", cases[i].status, cases[i].says);
    }
    remove_beside();
}

/* A count that only one run has, or over other frames, is not compared, and this is
   reported. */
TEST(compare_of_instructions_of_other_frames_or_scenes_is_undecided)
{
    static const struct {
        const char *old_members, *new_members;
        int status;
        const char *says;
    } cases[] = {{"{'frames': [1, 9]}", "{'frames': [1, 9]}", 1, "instructions 1000 to 1100"},
                 {"{'frames': [1, 9]}", "{'frames': [2, 9]}", 3, "not counted over the same"},
                 {"{'frames': [1, 9]}", "{}", 3, "not counted over the same"},
                 {"{}", "{'frames': [2, 9]}", 3, "not counted over the same"},
                 {"{}", "{'per_frame': null}", 3, "not counted over the same"},
                 {"{}", "{'fingerprint': 'other'}", 3, "not counted over the same"},
                 {"{'faces': 'a'}", "{'faces': 'b'}", 1, "instructions 1000 to 1100"},
                 {"{'fingerprint': '0123456789abcdef'}", "{}", 1, "instructions 1000 to 1100"},
                 {"{'per_frame': null}", "{}", 0, "same or better"}};
    for (size_t i = 0; i < ROWS_OF(cases); ++i) {
        write_run("old", &usual, 1);
        write_run("new", &usual, -1);
        write_beside("old", "one", 1000);
        write_beside("new", "one", 1100);
        change_row("old", "instructions.json", cases[i].old_members);
        change_row("new", "instructions.json", cases[i].new_members);
        expect("", cases[i].status, cases[i].says);
    }
    remove_beside();
}

/* A damaged file is not treated as a missing one: nothing would be compared. */
TEST(compare_of_damaged_files_beside_the_summary_is_bad_input)
{
    static const char *const names[] = {"instructions.json", "manifest.json"};
    for (size_t i = 0; i < 4; ++i) {
        char path[96];
        write_run("old", &usual, 1);
        write_run("new", &usual, -1);
        write_beside("old", "one", 1000);
        write_beside("new", "one", 1100);
        (void)snprintf(path, sizeof path, "%s/%s", i % 2 ? "new" : "old", names[i / 2]);
        assert_int_equal(truncate(path, 20), 0);
        expect("", 4, names[i / 2]);
    }
    remove_beside();
}

/* A run may be named by its summary. */
TEST(compare_of_summaries_by_name_is_that_of_their_runs)
{
    write_run("old", &usual, 1);
    write_run("new", &usual, -1);
    write_beside("old", "one", 1000);
    write_beside("new", "one", 1100);
    static const char says[] = "instructions 1000 to 1100";
    mote_expect(1, says, "compare old/summary.json new/summary.json");
    assert_int_equal(chdir("old"), 0);
    mote_expect(1, says, "compare summary.json ../new");
    assert_int_equal(chdir(".."), 0);
    remove_beside();
}

/* A summary.json from before the cells were measured again is out of date. */
TEST(compare_reads_the_cells_and_not_a_stale_summary)
{
    static const char rows[] = "1,0,0,5,0.5,0,0,0,7\n2,0,0,6,0.5,0,0,0,7\n";
    static const char more[] = "1,0,0,5,0.5,0,0,0,7\n2,0,0,6,0.5,0.25,0,0,9\n";
    static const char *const runs[] = {"stale", "stale/summary.json"};
    static const char *const both[] = {"fresh", "stale"};
    for (int k = 0; k < 2; ++k) {
        stored_cell_put(both[k], (stored_cell){.rows = rows});
        mote_summary summary;
        assert_int_equal(mote_summary_make(both[k], &summary), MOTE_OK);
        assert_int_equal(mote_summary_write(&summary, both[k]), MOTE_OK);
        mote_summary_free(&summary);
    }
    stored_cell_put("stale", (stored_cell){.rows = more});
    for (size_t k = 0; k < 2; ++k) {
        mote_comparison c;
        assert_int_equal(mote_compare("fresh", runs[k], 0.02, &c), MOTE_OK);
        assert_true(c.worse && c.changes[0].counted);
        assert_non_null(strstr(c.changes[0].what.data, "max 0 to 0.25"));
        mote_comparison_free(&c);
    }
    /* Under another name the file is a summary of its own. */
    assert_int_equal(rename("stale/summary.json", "stale/kept.json"), 0);
    mote_comparison c;
    assert_int_equal(mote_compare("stale/kept.json", "stale", 0.02, &c), MOTE_OK);
    assert_true(c.worse);
    mote_comparison_free(&c);
}

/* Four frames of a replicate whose errors and misses are those of its number; replicates count
   differently, as their random numbers do. */
static void put_replicate(const char *directory, int replicate, const char *more)
{
    char rows[256];
    (void)snprintf(rows, sizeof rows,
                   "1,0,0,5,0.5,0,0,0,%d\n2,0,0,6,0.5,%g,0,0,7\n3,0,0,6,0,0,%d,1,7\n"
                   "4,0,0,6,0,0,1,1,7\n",
                   10 + replicate, 0.01 * replicate, replicate < 3);
    stored_cell_put(directory, (stored_cell){.method = "particle",
                                             .rows = rows,
                                             .replicate = replicate,
                                             .more = more});
}

static void put_summary(const char *directory)
{
    mote_summary summary;
    assert_int_equal(mote_summary_make(directory, &summary), MOTE_OK);
    assert_int_equal(mote_summary_write(&summary, directory), MOTE_OK);
    mote_summary_free(&summary);
}

/* A run with more replicates has larger errors, and is no worse for that. */
TEST(compare_of_answers_is_over_the_replicates_that_both_have)
{
    assert_int_equal(folder_next(), 0);
    for (int replicate = 1; replicate <= 3; ++replicate) {
        if (replicate < 3)
            put_replicate("few", replicate, "");
        put_replicate("many", replicate, "");
        if (replicate == 3)
            put_replicate("third", replicate, "");
    }
    static const char *const runs[] = {"few", "many", "third"};
    for (size_t k = 0; k < ROWS_OF(runs); ++k)
        put_summary(runs[k]);
    static const struct {
        const char *base, *fresh;
        const char *says; /* of the answers; NULL: they are the same */
    } rows[] = {
        {"few", "many", NULL},
        {"many", "few", NULL},
        {"few/kept.json", "many", NULL},
        {"many", "few/kept.json", NULL},
        {"few", "third", "other replicates: errors are not compared; no replicate in common"},
        /* These have no replicates by themselves. */
        {"many/kept.json", "few", "other replicates: errors are not compared"},
        {"few/kept.json", "many/kept.json", "other replicates: errors are not compared"},
    };
    assert_int_equal(system("cp few/summary.json few/kept.json; cp many/summary.json "
                            "many/kept.json"),
                     0);
    for (size_t k = 0; k < ROWS_OF(rows); ++k) {
        mote_comparison c;
        test_row("%s, %s", rows[k].base, rows[k].fresh);
        assert_int_equal(mote_compare(rows[k].base, rows[k].fresh, 0.02, &c), MOTE_OK);
        const char *what = c.changes[0].what.size ? c.changes[0].what.data : "";
        assert_false(c.worse || c.changes[0].better);
        assert_true(c.changes[0].unknown == (rows[k].says != NULL));
        if (rows[k].says ? !strstr(what, rows[k].says)
                         : strstr(what, "max") || strstr(what, "missed"))
            fail_msg("%s", what);
        mote_comparison_free(&c);
    }
    /* A change in a replicate that both have is one. */
    put_replicate("many", 2, ", \"x\": 1");
    file_put("many/cells/particle-2.csv", STORED_COLUMNS "1,0,0,5,0.5,0,0,0,12\n"
                                                         "2,0,0,6,0.5,0.5,0,0,7\n"
                                                         "3,0,0,6,0,0,1,1,7\n"
                                                         "4,0,0,6,0,0,0,1,7\n");
    mote_expect(1, "max 0.02 to 0.5", "compare few many");
    assert_non_null(strstr(said, "missed 0 to 0.5"));
}

/* Of more than two bodies, contacts are those of a file. */
TEST(compare_of_pairs_is_over_the_replicates_that_both_have)
{
#define PAIRS "frame,body_a,body_b,steps,distance,lower,contact,ax\n"
    static const char bodies[] = ", \"bodies\": 3", both[] = PAIRS "1,1,2,1,0,0,1,1\n";
    assert_int_equal(folder_next(), 0);
    for (int replicate = 1; replicate <= 3; ++replicate) {
        for (int k = 0; k < 2; ++k) {
            char path[64];
            const char *directory = k ? "many" : "few";
            if (k == 0 && replicate == 3)
                continue;
            put_replicate(directory, replicate, bodies);
            (void)snprintf(path, sizeof path, "%s/cells/particle-%d.pairs.csv", directory,
                           replicate);
            file_put(path, replicate < 3 ? both : PAIRS);
            if (replicate > 1)
                continue;
            stored_cell_put(directory,
                            (stored_cell){.rows = "1,0,0,5,,,1,,7\n", .more = bodies});
            (void)snprintf(path, sizeof path, "%s/cells/fcl-aabb-1.pairs.csv", directory);
            file_put(path, both);
        }
    }
    assert_true(mote("compare few many") != 1);
    assert_null(strstr(said, "missed"));
    assert_true(mote("compare many few") != 1);
    assert_null(strstr(said, "missed"));
    file_put("many/cells/particle-2.pairs.csv", PAIRS);
    mote_expect(1, "missed 0 to 0.5", "compare few many");
}
