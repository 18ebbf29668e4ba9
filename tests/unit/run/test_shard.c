/* Shards of a run, and merged runs. */
#include "harness/base/record.h"
#include "tests/support/folder.h"
#include "tests/support/mote.h"
#include "tests/support/test.h"

#include <stddef.h>

#include <dirent.h>
#include <stdbool.h>

#define METHODS                                                                                \
    "--replicates 2 --method fcl-aabb --method particle-paper:n=2 --method certified"
#define CONFIGURATIONS 3
#define SCENARIOS 3
#define CELLS (SCENARIOS * CONFIGURATIONS * 2)

/* Three scenarios of a few frames, for which the truth takes no time. */
static int put_scenarios(void)
{
    for (int i = 0; i < SCENARIOS; ++i) {
        char name[32], text[128];
        (void)snprintf(name, sizeof name, "scenario-%d.json", i);
        (void)snprintf(text, sizeof text,
                       "{\"purpose\": \"a test\", \"like\": \"tt\", \"frames\": %d,"
                       " \"warmup\": null, \"active\": null}\n",
                       4 + i);
        file_put(name, text);
    }
    return 0;
}

static int set_task(const char *task, const char *count)
{
    return (task ? setenv("SLURM_ARRAY_TASK_ID", task, 1) : unsetenv("SLURM_ARRAY_TASK_ID")) ||
           (count ? setenv("SLURM_ARRAY_TASK_COUNT", count, 1)
                  : unsetenv("SLURM_ARRAY_TASK_COUNT"));
}

static int clear_task(void)
{
    return set_task(NULL, NULL);
}

TEST_GROUP(put_scenarios, NULL);
TEST_EACH(NULL, clear_task);

/* Runs mote run for all scenarios into a folder. */
static int run(const char *options, const char *name)
{
    return mote("run scenario-[012].json %s " METHODS " --out %s", options, name);
}

/* Reads a cell of a run; index counts from 0 in any order; NULL after the last. */
static json_t *read_cell(const char *name, int index)
{
    char path[512];
    json_t *cell = NULL;
    (void)snprintf(path, sizeof path, "%s/cells", name);
    DIR *folder = opendir(path);
    for (const struct dirent *entry = folder ? readdir(folder) : NULL; entry && !cell;
         entry = readdir(folder)) {
        if (strstr(entry->d_name, ".json") && index-- == 0)
            assert_int_equal(mote_record_read_json(path, entry->d_name, &cell), MOTE_OK);
    }
    if (folder)
        (void)closedir(folder);
    return cell;
}

static int count_cells(const char *name)
{
    int count = 0;
    for (json_t *cell; (cell = read_cell(name, count)) != NULL; ++count)
        json_decref(cell);
    return count;
}

static const char *member(const json_t *object, const char *key)
{
    const char *value = json_string_value(json_object_get(object, key));
    return value ? value : "";
}

TEST(shards_keep_the_methods_of_a_scenario_together)
{
    assert_int_equal(run("--shard 1/2", "first"), 0);
    assert_int_equal(run("--shard 2/2", "second"), 0);
    const int first = count_cells("first"), second = count_cells("second");
    assert_int_equal(first, 2 * CELLS / SCENARIOS);
    assert_int_equal(second, CELLS / SCENARIOS);
    for (int i = 0; i < first; ++i) {
        json_t *cell = read_cell("first", i);
        for (int k = 0; k < second; ++k) {
            json_t *other = read_cell("second", k);
            assert_string_not_equal(member(cell, "scenario"), member(other, "scenario"));
            json_decref(other);
        }
        json_decref(cell);
    }
}

TEST(shard_without_a_scenario_is_an_empty_run)
{
    assert_int_equal(run("--shard 4/4", "none"), 0);
    assert_int_equal(count_cells("none"), 0);
}

TEST(shard_of_an_array_task_is_its_default)
{
    assert_int_equal(set_task("3", "3"), 0);
    assert_int_equal(run("", "task"), 0);
    assert_non_null(strstr(said, "shard 3/3"));
    assert_int_equal(count_cells("task"), CELLS / SCENARIOS);
    json_t *cell = read_cell("task", 0);
    assert_string_equal(member(cell, "scenario"), "scenario-2");
    json_decref(cell);
    assert_int_equal(run("--shard 1/3 --dry-run", "task"), 0);
    assert_non_null(strstr(said, "scenario-0"));
    assert_null(strstr(said, "scenario-2"));
}

TEST(array_task_that_is_no_shard_is_refused)
{
    static const char *const bad[][2] = {{"0", "4"},   {"5", "4"},  {"-1", "4"}, {"1", "0"},
                                         {"one", "4"}, {"1", "4x"}, {"", "4"},   {"2", NULL},
                                         {NULL, "4"},  {"1.5", "4"}};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; ++i) {
        assert_int_equal(set_task(bad[i][0], bad[i][1]), 0);
        assert_int_equal(run("", "refused"), 2);
        assert_non_null(strstr(said, "SLURM_ARRAY_TASK_ID"));
        assert_non_null(strstr(said, "--array=1-N"));
        assert_int_equal(count_cells("refused"), 0);
    }
    assert_int_equal(run("--shard 1/1 --dry-run", "refused"), 0);
}

static json_t *read_rows(const char *name)
{
    json_t *summary = NULL;
    assert_int_equal(mote_record_read_json(name, "summary.json", &summary), MOTE_OK);
    json_t *rows = json_incref(json_object_get(summary, "rows"));
    json_decref(summary);
    return rows;
}

TEST(merge_of_shards_is_the_whole_run)
{
    assert_int_equal(run("", "whole"), 0);
    mote_expect(0, "", "merge merged first second first");
    assert_int_equal(count_cells("whole"), CELLS);
    assert_int_equal(count_cells("merged"), CELLS);
    json_t *whole = read_rows("whole"), *merged = read_rows("merged");
    assert_int_equal(json_array_size(whole), SCENARIOS * CONFIGURATIONS);
    assert_int_equal(json_array_size(merged), SCENARIOS * CONFIGURATIONS);
    static const char *const same[] = {"scenario", "fingerprint", "method",     "parameters",
                                       "error",    "contacts",    "replicates", "counters"};
    for (size_t i = 0; i < json_array_size(whole); ++i) {
        const json_t *a = json_array_get(whole, i), *b = json_array_get(merged, i);
        for (size_t k = 0; k < sizeof same / sizeof same[0]; ++k)
            assert_true(json_equal(json_object_get(a, same[k]), json_object_get(b, same[k])));
        assert_true(json_is_object(json_object_get(b, "ratio")));
    }
    json_decref(whole);
    json_decref(merged);
    json_t *manifest = NULL; /* one session a shard, though one shard was merged twice */
    assert_int_equal(mote_record_read_json("merged", "manifest.json", &manifest), MOTE_OK);
    assert_int_equal(json_array_size(json_object_get(manifest, "sessions")), 2);
    json_decref(manifest);
    mote_expect(4, "", "merge merged no-such-run");
}

/* Changes the machine in those cells of a run that have this replicate and method; method "":
   any. */
static void move_cells(const char *name, const char *method, int replicate, const char *machine)
{
    char file[256];
    for (int i = 0, count = count_cells(name); i < count; ++i) {
        json_t *cell = read_cell(name, i);
        bool wanted = json_integer_value(json_object_get(cell, "replicate")) == replicate &&
                      (method[0] == '\0' || strcmp(member(cell, "method"), method) == 0);
        (void)snprintf(file, sizeof file, "cells/%s.json", member(cell, "id"));
        (void)json_object_set_new(cell, "machine", json_string(machine));
        if (wanted)
            assert_int_equal(mote_record_json(name, file, json_incref(cell)), MOTE_OK);
        json_decref(cell);
    }
}

/* Replicate 2 was measured elsewhere, and its reference on a third machine. */
TEST(merge_compares_only_within_one_machine)
{
    assert_int_equal(run("--shard 3/3", "here"), 0);
    move_cells("here", "", 2, "there, slow");
    move_cells("here", "fcl-aabb", 2, "elsewhere, slower");
    mote_expect(0, ", on there, slow", "merge machines here");
    json_t *rows = read_rows("machines");
    assert_int_equal(json_array_size(rows), 2 * CONFIGURATIONS);
    int compared = 0;
    for (size_t i = 0; i < json_array_size(rows); ++i) {
        const json_t *row = json_array_get(rows, i);
        assert_int_equal(json_integer_value(json_object_get(row, "replicates")), 1);
        bool has_ratio = json_is_object(json_object_get(row, "ratio"));
        assert_true(has_ratio == (strcmp(member(row, "machine"), "there, slow") != 0));
        compared += has_ratio;
    }
    assert_int_equal(compared, CONFIGURATIONS + 1);
    json_decref(rows);
}
