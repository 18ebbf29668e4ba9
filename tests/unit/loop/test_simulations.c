/* What `mote simulate --out` keeps works like a run: shards, --until-ci, merge, compare,
   summarize and the report, for two bodies and for many. */
#include "harness/base/record.h"
#include "harness/base/statistics.h"
#include "harness/loop/simulations.h"
#include "tests/support/diamond.h"
#include "tests/support/folder.h"
#include "tests/support/mote.h"
#include "tests/support/test.h"

/* Two diamonds, the second flying at the first. */
static const char two[] =
    "{\"purpose\": \"x\", \"frames\": 40, \"ask\": \"distance\", \"tolerance\": 0.01, "
    "\"bodies\": [{\"file\": \"a.obj\"}, {\"file\": \"a.obj\", \"motion\": [{\"frame\": 1, "
    "\"position\": [2.1, 0.1, 0]}, {\"frame\": 40, \"position\": [0.5, 0.1, 0]}]}]}\n";

static const char many[] =
    "{\"purpose\": \"x\", \"frames\": 20, \"ask\": \"distance\", \"tolerance\": 0.01, "
    "\"bodies\": {\"count\": 12, \"seed\": 2, \"near_pairs\": 2, \"near\": 0.2, "
    "\"speed\": 0.02, \"spin\": 1, \"shapes\": [{\"file\": \"a.obj\"}]}}\n";

#define BOTH "simulate two.json many.json --method certified --method aabb-tree --seed 3"

static int put_files(void)
{
    file_put("a.obj", DIAMOND);
    file_put("two.json", two);
    file_put("many.json", many);
    return 0;
}

TEST_GROUP(put_files, NULL);

/* All figures but the times. */
static json_t *rows_of(const char *folder)
{
    json_t *root = NULL;
    size_t i;
    json_t *row;
    if (mote_record_read_json(folder, "simulations.json", &root) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    json_t *rows = json_incref(json_object_get(root, "rows"));
    json_array_foreach(rows, i, row)
    {
        assert_true(json_number_value(json_object_get(row, "query_ns")) > 0);
        (void)json_object_del(row, "query_ns");
        (void)json_object_del(row, "query_ns_low");
        (void)json_object_del(row, "query_ns_high");
    }
    json_decref(root);
    return rows;
}

static void require_same_rows(const char *a, const char *b)
{
    json_t *first = rows_of(a), *second = rows_of(b);
    assert_int_equal(json_array_size(first), 4);
    assert_true(json_equal(first, second));
    json_decref(first);
    json_decref(second);
}

TEST(mote_simulate_shards_merge_to_the_whole)
{
    mote_expect(0, "plan: 4 simulations, 0 of them done", BOTH " --replicates 2 --out whole");
    mote_expect(0, "two certified r1: ok", BOTH " --replicates 2 --out first --shard 1/3");
    assert_null(strstr(said, "many certified"));
    mote_expect(0, "many certified r1: ok", BOTH " --replicates 2 --out second --shard 2/3");
    assert_null(strstr(said, "two certified"));
    mote_expect(0, "", BOTH " --replicates 2 --out third --shard 3/3");
    assert_int_equal(folder_count("third/simulations", ".json"), 0);
    mote_expect(0, "0 cells and 8 simulations copied, 0 were there",
                "merge merged first second third");
    mote_expect(0, "0 cells copied, 8 were there", "merge merged first second");
    require_same_rows("whole", "merged");
    mote_expect(0, "plan: 4 simulations, 4 of them done", BOTH " --replicates 2 --out merged");
    require_same_rows("whole", "merged");
    mote_expect(0, "many/certified/simulated", "compare merged merged");
    assert_non_null(strstr(said, "same or better"));
}

/* Sampled, continuous and whole steps are three experiments. */
TEST(mote_simulate_steps_of_three_kinds_are_three_rows)
{
    static const char *const kinds[] = {"--step 4", "--step 4 --sampled", "--time-step 4"};
    for (size_t k = 0; k < ROWS_OF(kinds); ++k)
        mote_expect(0, "", "simulate two.json --method certified --steps 5 %s --out kinds",
                    kinds[k]);
    json_t *rows = rows_of("kinds");
    assert_int_equal(json_array_size(rows), ROWS_OF(kinds));
    json_decref(rows);
}

TEST(mote_simulate_a_slurm_task_is_a_shard)
{
    assert_int_equal(setenv("SLURM_ARRAY_TASK_ID", "2", 1), 0);
    assert_int_equal(setenv("SLURM_ARRAY_TASK_COUNT", "2", 1), 0);
    mote_expect(0, "shard 2/2", BOTH " --out task");
    assert_null(strstr(said, "two certified"));
    assert_int_equal(setenv("SLURM_ARRAY_TASK_ID", "0", 1), 0);
    mote_expect(2, "--array=1-N", BOTH " --out task");
    mote_expect(0, "2 bodies", "simulate two.json --method certified");
    assert_int_equal(unsetenv("SLURM_ARRAY_TASK_ID"), 0);
    assert_int_equal(unsetenv("SLURM_ARRAY_TASK_COUNT"), 0);
}

/* The intervals that are printed are as narrow as asked for, unless the budget ends. */
TEST(mote_simulate_until_ci_adds_replicates)
{
    mote_expect(0, "the widest interval is", BOTH " --out until --until-ci 90%% --budget 5");
    const bool ended = strstr(said, "the budget ends") != NULL;
    mote_simulations list = {0};
    assert_int_equal(mote_simulations_read("until", &list), MOTE_OK);
    assert_int_equal(list.count, 4);
    for (size_t i = 0; i < list.count; ++i) {
        const mote_simulations_row *row = &list.rows[i];
        assert_true(row->done >= 2);
        const double width = mote_statistics_half_width(row->query_ns, row->interval);
        assert_true(ended || width <= 0.9);
    }
    mote_simulations_free(&list);
    mote_expect(0, "after 1 replicates the widest interval is +-inf %, wider than asked for",
                "simulate two.json --method certified --out spent --until-ci 1%% --budget 0 "
                "--replicates 1 --seed 1");
}

/* Rewrites a count of the first replicate of certified on two.json. */
static void plant(const char *key, int value)
{
    json_t *stored = NULL;
    mote_simulations list = {0};
    assert_int_equal(system("rm -rf worse; cp -r whole worse; "
                            "cd worse/simulations && mv two-certified-r1-* planted.json"),
                     0);
    assert_int_equal(mote_record_read_json("worse/simulations", "planted.json", &stored),
                     MOTE_OK);
    assert_int_equal(json_object_set_new(stored, key, json_integer(value)), 0);
    assert_int_equal(mote_record_json("worse/simulations", "planted.json", stored), MOTE_OK);
    assert_int_equal(mote_simulations_read("worse", &list), MOTE_OK);
    assert_int_equal(list.count, 4);
    mote_simulations_free(&list);
}

TEST(mote_compare_of_simulations_sees_what_is_worse)
{
    static const struct {
        const char *key, *says;
    } row[] = {{"passes_through", "passes through 0 to 7"},
               {"missed_steps", "missed steps 0 to 7"},
               {"false_steps", "false steps 0 to 7"},
               {"max_penetration", "penetration "}};
    mote_expect(0, "", BOTH " --replicates 2 --out whole");
    for (size_t i = 0; i < ROWS_OF(row); ++i) {
        test_row("%s", row[i].key);
        plant(row[i].key, 7);
        mote_expect(1, row[i].says, "compare whole worse");
        assert_non_null(strstr(said, "two/certified/simulated"));
        mote_expect(0, "better", "compare worse whole");
    }
    mote_expect(0, "", "simulate two.json --method certified --out alone --seed 3");
    mote_expect(3, "without a partner: 3 rows of BASE, 0 of NEW", "compare whole alone");
    mote_expect(0, "", "simulate two.json --method certified --out other --seed 4");
    mote_expect(4, "no configuration in common", "compare alone other");
}

/* Rows are of the scenario's name, as those of a run: however its file was named, they are
   found. */
TEST(simulations_are_kept_under_the_name_of_the_scenario)
{
    mote_expect(0, "two certified r1: ok",
                "simulate two.json --method certified --steps 5 --out plain");
    mote_expect(0, "two certified r1: ok",
                "simulate ./plain/../two.json --method certified --steps 5 --out odd");
    assert_int_not_equal(mote("compare plain odd"), 4); /* the verdict depends on times */
    assert_non_null(strstr(said, "two/certified/simulated"));
    assert_null(strstr(said, "without a partner"));
    mote_expect(0, "plan: 1 simulations, 1 of them done",
                "simulate ./two.json --method certified --steps 5 --out plain");
    json_t *rows = rows_of("plain");
    assert_int_equal(json_array_size(rows), 1);
    assert_string_equal(mote_text_at(json_array_get(rows, 0), "scenario"), "two");
    json_decref(rows);
    mote_expect(0, "\"scenario\": \"two\"",
                "simulate ./two.json --method certified --steps 5 --json");
}

TEST(mote_summarize_and_report_show_simulations)
{
    mote_expect(0, "", BOTH " --replicates 2 --out whole");
    mote_expect(0, "many, aabb-tree: 12 bodies", "summarize whole");
    assert_non_null(strstr(said, "replicates 2, failed 0"));
    mote_expect(0, "\"replicates_failed\": 0", "summarize whole --format json");
    mote_expect(2, "of simulations there are table and json", "summarize whole --format csv");
    mote_expect(0, "whole/report.html", "report whole");
    char *page = file_text("whole/report.html"), *text = file_text("whole/report.md");
    assert_non_null(strstr(page, "\"passes_through\""));
    assert_non_null(strstr(text, "| many | aabb-tree | 2 |"));
    free(page);
    free(text);
    /* Cells and simulations in one directory. */
    mote_expect(0, "", "run two.json --method certified --replicates 2 --out whole");
    mote_expect(0, "many, aabb-tree: 12 bodies", "summarize whole");
    assert_non_null(strstr(said, "certified"));
    mote_expect(0, "two/certified/hot", "compare whole whole");
    assert_non_null(strstr(said, "two/certified/simulated"));
    mote_expect(0, "2 cells and 8 simulations copied", "merge again whole");
}

/* One simulation, stored as failed in the merged directory. */
TEST(merge_prefers_a_good_simulation_to_a_failed_one)
{
    mote_expect(0, "", "simulate two.json --method certified --out good");
    mote_expect(0, "0 cells and 1 simulations copied, 0 were there", "merge joined good");
    assert_int_equal(system("sed -i 's/\"status\": \"ok\"/\"status\": \"crashed\"/' "
                            "joined/simulations/*"),
                     0);
    mote_expect(0, "0 cells and 1 simulations copied, 0 were there", "merge joined good");
    assert_int_equal(system("grep -q '\"status\": \"ok\"' joined/simulations/*"), 0);
    mote_expect(0, "0 cells copied, 1 were there", "merge joined good");
}

/* 16 MiB is the largest scenario that is read; a step of two bodies takes about 400 bytes. */
TEST(mote_simulate_writes_no_trace_that_it_could_not_read)
{
    mote_expect(4, "long.json: not written: it would have ",
                "simulate two.json --method aabb-tree --steps 60000 --trace long.json");
    assert_non_null(strstr(said, "at most 16777216 are read; record fewer frames"));
    assert_false(file_exists("long.json"));
    mote_expect(0, "", "simulate two.json --method aabb-tree --steps 100 --trace short.json");
    mote_expect(0, "101 frames", "check short.json");
}

TEST(mote_simulate_refuses_shards_and_until_ci_without_a_directory)
{
    mote_expect(2, "name a directory", BOTH " --shard 1/2");
    mote_expect(2, "name a directory", "simulate two.json --method certified --until-ci 2%%");
    mote_expect(2, "one scenario at a time", "simulate two.json many.json --method certified");
    mote_expect(2, "give I/N", BOTH " --out n --shard 3/2");
    mote_expect(2, "give a percentage", BOTH " --out n --until-ci 2");
    mote_expect(2, "leave out one of them", BOTH " --out n --until-ci 2%% --jobs 2");
    mote_expect(2, "give seconds", BOTH " --out n --budget soon");
}
