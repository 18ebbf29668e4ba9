#include "harness/run/cell_process.h"
#include "harness/base/record.h"
#include "tests/support/folder.h"
#include "tests/support/measured_cell.h"
#include "tests/support/mote.h"
#include "tests/support/program.h"
#include "tests/support/test.h"

#include <stddef.h>

#include <dirent.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <time.h>

#define COLUMNS                                                                                \
    "frame,deform_ns,update_ns,query_ns,distance,lower,truth,error,contact,contact_truth,"     \
    "ax,ay,az,bx,by,bz,steps,moves,positions,box_tests,triangle_tests,allocations"

/* Each test's folder shares the truth of all others, which is computed once. */
static int next_directory(void)
{
    char truth[160];
    (void)snprintf(truth, sizeof truth, "%s/truth", folder_path());
    (void)mkdir(truth, 0777);
    return folder_next() || symlink(truth, "truth");
}

TEST_EACH(next_directory, NULL);

/* mote run ARGUMENTS into the test's folder. */
static int run(const char *arguments)
{
    return mote("run %s --out .", arguments);
}

static int count_cells(const char *ending)
{
    return folder_count("cells", ending);
}

static json_t *read_json(const char *name)
{
    json_t *object = NULL;
    assert_int_equal(mote_record_read_json(".", name, &object), MOTE_OK);
    return object;
}

#define TWO_METHODS "--method particle-paper:n=2 --method fcl-aabb"

TEST(run_of_two_methods_leaves_a_cell_each_replicate)
{
    assert_int_equal(run("tt --frames 3-12 --replicates 2 " TWO_METHODS), 0);
    assert_int_equal(count_cells(".json"), 4);
    assert_int_equal(count_cells(".csv"), 4);
    assert_int_equal(count_cells(".part"), 0);
    json_t *manifest = read_json("manifest.json");
    static const char *const keys[] = {"commit",    "dirty",     "compiler", "flags",
                                       "libraries", "processor", "kernel",   "seed",
                                       "sessions",  "huge_pages"};
    for (size_t i = 0; i < sizeof keys / sizeof keys[0]; ++i)
        assert_non_null(json_object_get(manifest, keys[i]));
    json_decref(manifest);
}

/* Whether a list of libraries, "fcl 0.7.0, ccd 2.0", has the version of one. */
static bool has_version(const char *libraries, const char *library)
{
    char *name = mote_format(", %s ", library);
    const char *at = strstr(libraries, name);
    const bool known = at && strspn(at + strlen(name), "0123456789") > 0;
    free(name);
    return known;
}

/* Those without a file of pkg-config, too, and those of optional methods where they are. */
TEST(run_manifest_names_the_versions_of_libraries)
{
    static const char *const always[] = {"ccd",     "assimp", "gsl",
                                         "jansson", "hacd",   "meshoptimizer"};
    static const struct {
        const char *library, *method;
    } optional[] = {{"embree", "embree-contact"},
                    {"ode", "ode"},
                    {"bullet", "bullet-gimpact"},
                    {"coal", "coal-aabb"}};
    assert_int_equal(run("tt --frames 1-2 --replicates 1 --method aabb-tree --no-summary"), 0);
    json_t *manifest = read_json("manifest.json");
    const char *libraries = mote_text_at(manifest, "libraries");
    for (size_t i = 0; i < ROWS_OF(always); ++i) {
        if (!has_version(libraries, always[i]))
            fail_msg("no version of %s: %s", always[i], libraries);
    }
    for (size_t i = 0; i < ROWS_OF(optional); ++i) {
        const bool built = mote_method_find(optional[i].method) != NULL;
        if (has_version(libraries, optional[i].library) != built)
            fail_msg("%s: %s", optional[i].library, libraries);
    }
    json_decref(manifest);
}

/* The path of some CSV file of the run. */
static void find_csv(char *path, size_t size)
{
    DIR *folder = opendir("cells");
    assert_non_null(folder);
    path[0] = '\0';
    for (const struct dirent *entry = readdir(folder); entry; entry = readdir(folder)) {
        if (strstr(entry->d_name, ".csv"))
            (void)snprintf(path, size, "cells/%s", entry->d_name);
    }
    (void)closedir(folder);
    assert_true(path[0] != '\0');
}

/* The JSON file of the cell whose name has this part. */
static void find_cell(const char *part, char *path, size_t size)
{
    DIR *folder = opendir("cells");
    assert_non_null(folder);
    path[0] = '\0';
    for (const struct dirent *entry = readdir(folder); entry; entry = readdir(folder)) {
        if (strstr(entry->d_name, part) && strstr(entry->d_name, ".json"))
            (void)snprintf(path, size, "cells/%s", entry->d_name);
    }
    (void)closedir(folder);
    assert_true(path[0] != '\0');
}

static int count_fields(const char *line)
{
    int count = 1;
    for (; *line && *line != '\n'; ++line)
        count += *line == ',' ? 1 : 0;
    return count;
}

TEST(run_writes_rows_with_the_columns_of_the_contract)
{
    assert_int_equal(run("mv --frames 3-12 --replicates 1 --stride 1 --method fcl-aabb"), 0);
    char path[512];
    find_csv(path, sizeof path);
    char *text = file_text(path);
    assert_memory_equal(text, COLUMNS, strlen(COLUMNS));
    int fields = count_fields(text), rows = 0;
    for (const char *line = strchr(text, '\n') + 1; *line; line = strchr(line, '\n') + 1) {
        assert_int_equal(count_fields(line), fields);
        assert_int_equal(atoi(line), 3 + rows);
        ++rows;
    }
    assert_int_equal(rows, 10);
    assert_null(strstr(said, "nan"));
    assert_null(strstr(said, "inf"));
    free(text);
}

/* A cell stores the active interval, so one of another interval is another cell, and rows say
   which they are of. */
TEST(run_of_another_active_interval_is_another_cell)
{
    static const char line[] =
        "run s.json --frames 3-12 --replicates 1 --method fcl-aabb --out .";
    static const char *const intervals[] = {"140, 600", "4, 8", "5, 8"};
    for (size_t i = 0; i < ROWS_OF(intervals); ++i) {
        char text[128];
        (void)snprintf(text, sizeof text,
                       "{\"purpose\": \"tt\", \"like\": \"tt\", \"active\": [%s]}\n",
                       intervals[i]);
        file_put("s.json", text);
        mote_expect(0, "plan: 1 cells, 0 of them done", "%s", line);
        mote_expect(0, "plan: 1 cells, 1 of them done", "%s", line);
    }
    mote_expect(0, "s (active 4-8)", "summarize .");
    assert_non_null(strstr(said, "s (active 5-8)"));
    json_t *summary = read_json("summary.json");
    assert_int_equal(json_array_size(json_object_get(summary, "rows")), 3);
    json_decref(summary);
}

TEST(run_summary_has_a_row_a_configuration)
{
    assert_int_equal(run("mv --frames 3-12 --replicates 2 --stride 1 " TWO_METHODS), 0);
    json_t *summary = read_json("summary.json");
    assert_int_equal(json_integer_value(json_object_get(summary, "schema")), 1);
    const json_t *rows = json_object_get(summary, "rows");
    assert_int_equal(json_array_size(rows), 2);
    const json_t *aabb = json_array_get(rows, 0), *particle = json_array_get(rows, 1);
    assert_string_equal(json_string_value(json_object_get(aabb, "method")), "fcl-aabb");
    assert_int_equal(json_integer_value(json_object_get(aabb, "frames")), 10);
    assert_int_equal(json_integer_value(json_object_get(aabb, "replicates")), 2);
    const json_t *error = json_object_get(aabb, "error");
    assert_true(json_number_value(json_object_get(error, "max")) <= 1e-12);
    assert_true(json_number_value(json_object_get(error, "exact_rate")) >= 1);
    const json_t *ratio = json_object_get(particle, "ratio");
    assert_string_equal(json_string_value(json_object_get(ratio, "to")), "fcl-aabb");
    assert_true(json_number_value(json_object_get(ratio, "value")) > 1);
    const json_t *total = json_object_get(particle, "total_ns");
    double low = json_number_value(json_object_get(total, "ci_low"));
    double median = json_number_value(json_object_get(total, "median"));
    double high = json_number_value(json_object_get(total, "ci_high"));
    assert_true(0 < low && low <= high && median > 0);
    json_decref(summary);
}

static time_t newest_cell(void)
{
    char path[512];
    struct stat info;
    find_csv(path, sizeof path);
    assert_int_equal(stat(path, &info), 0);
    return info.st_mtime;
}

TEST(run_again_measures_nothing_again)
{
    assert_int_equal(run("tt --frames 1-4 --replicates 1 --method fcl-aabb"), 0);
    time_t before = newest_cell();
    struct timespec pause = {1, 100000000};
    (void)nanosleep(&pause, NULL);
    assert_int_equal(run("tt --frames 1-4 --replicates 1 --method fcl-aabb"), 0);
    assert_non_null(strstr(said, "1 of them done"));
    assert_int_equal(newest_cell(), before);
    assert_int_equal(run("tt --frames 1-5 --replicates 1 --method fcl-aabb"), 0);
    assert_int_equal(count_cells(".json"), 2);
}

TEST(run_with_a_sweep_makes_every_combination)
{
    assert_int_equal(run("tt --frames 1-4 --replicates 1 --particles 1,3-4 --method "
                         "'particle-paper:law=log|inverse,start=random|fps'"),
                     0);
    assert_int_equal(count_cells(".json"), 12);
}

TEST(run_with_jobs_marks_times_as_not_comparable)
{
    assert_int_equal(run("mv --frames 3-12 --replicates 3 --stride 1 --jobs 3 " TWO_METHODS),
                     0);
    assert_non_null(strstr(said, "times not comparable: 3 cells at once"));
    assert_int_equal(count_cells(".json"), 6);
    json_t *summary = read_json("summary.json");
    assert_true(json_is_null(json_object_get(summary, "noise_floor")));
    const json_t *rows = json_object_get(summary, "rows");
    assert_int_equal(json_array_size(rows), 2);
    for (size_t i = 0; i < 2; ++i) {
        const json_t *row = json_array_get(rows, i);
        assert_true(json_is_false(json_object_get(row, "times_comparable")));
        assert_true(json_is_null(json_object_get(row, "ratio")));
        assert_true(json_is_number(json_object_get(json_object_get(row, "error"), "max")));
    }
    json_decref(summary);
    /* When measured one at a time, they are different cells. */
    assert_int_equal(run("mv --frames 3-12 --replicates 3 --stride 1 " TWO_METHODS), 0);
    assert_int_equal(count_cells(".json"), 12);
    summary = read_json("summary.json");
    rows = json_object_get(summary, "rows");
    assert_int_equal(json_array_size(rows), 4);
    size_t ratios = 0;
    for (size_t i = 0; i < 4; ++i)
        ratios += json_is_object(json_object_get(json_array_get(rows, i), "ratio")) ? 1 : 0;
    assert_int_equal(ratios, 2);
    json_decref(summary);
}

/* Half of the widest interval of the summary as a share of the median, and the number of
   replicates. */
static double widest_interval(json_int_t *replicates)
{
    json_t *summary = read_json("summary.json");
    double widest = 0;
    *replicates = 0;
    for (size_t i = 0; i < json_array_size(json_object_get(summary, "rows")); ++i) {
        const json_t *row = json_array_get(json_object_get(summary, "rows"), i);
        const json_t *total = json_object_get(row, "total_ns");
        double half = (json_number_value(json_object_get(total, "ci_high")) -
                       json_number_value(json_object_get(total, "ci_low"))) /
                      2 / json_number_value(json_object_get(total, "median"));
        json_int_t count = json_integer_value(json_object_get(row, "replicates"));
        widest = half > widest ? half : widest;
        *replicates = count > *replicates ? count : *replicates;
    }
    json_decref(summary);
    return widest;
}

#define UNTIL "tt --frames 1-50 --replicates 1 --method aabb-tree --method particle-paper:n=2 "

TEST(run_until_an_interval_is_narrow_adds_replicates)
{
    json_int_t replicates;
    assert_int_equal(run(UNTIL "--until-ci 100% --budget 60"), 0);
    double widest = widest_interval(&replicates);
    assert_true(replicates >= 2 && widest <= 1);
    assert_non_null(strstr(said, "the widest interval is"));
    /* Nothing is narrow enough: one more round, or none if the budget is 0. */
    assert_int_equal(run(UNTIL "--until-ci 0.001% --budget 0"), 0);
    assert_non_null(strstr(said, "the budget ends"));
}

static void refused(const char *arguments, int status, const char *part)
{
    mote_expect(status, part, "run %s --out none", arguments);
    const char *error = strstr(said, "mote: ");
    assert_memory_equal(error ? error : said, "mote: ", 6);
    assert_false(file_exists("none"));
}

TEST(run_with_bad_input_says_what_and_writes_nothing)
{
    refused("no-such-scenario", 4, "no-such-scenario");
    refused("/no/such/file.json", 4, "/no/such/file.json");
    refused("tt --method no-such-method", 4, "no-such-method");
    refused("tt --method particle-paper:no-such-key=1", 4, "no-such-key");
    refused("tt --method particle-paper:n=0", 4, "n");
    refused("tt --method particle-paper:n=100000", 4, "100000");
    refused("tt --particles 0 --method particle-paper", 2, "0");
    refused("tt --particles 1,,2 --method particle-paper", 2, "1,2,4-8");
    refused("tt --frames 9-3", 2, "9-3");
    refused("tt --frames 1-100000", 4, "100000");
}

TEST(run_with_bad_usage_says_what_is_expected)
{
    refused("", 2, "no scenario");
    refused("tt --no-such-option", 2, "--no-such-option");
    refused("tt --replicates 0", 2, "--replicates 0");
    refused("tt --shard 3/2", 2, "--shard 3/2");
    refused("tt --cache cold", 2, "hot|evict");
    refused("tt --stride 0", 2, "--stride 0");
    refused("tt --jobs 0", 2, "--jobs 0");
    refused("tt --jobs 257", 2, "1 to 256");
    refused("tt --until-ci 2", 2, "percentage");
    refused("tt --until-ci 2% --jobs 2", 2, "--until-ci");
}

TEST(run_into_an_impossible_directory_is_bad_input)
{
    mote_expect(4, "/dev/null", "run tt --frames 1-2 --method fcl-aabb --out /dev/null/run");
}

TEST(run_into_a_locked_directory_is_refused)
{
    assert_int_equal(run("tt --frames 1-2 --replicates 1 --method fcl-aabb"), 0);
    int lock = open(".lock", O_RDWR);
    assert_true(lock >= 0);
    assert_int_equal(flock(lock, LOCK_EX | LOCK_NB), 0);
    assert_int_equal(run("tt --frames 1-3 --replicates 1 --method fcl-aabb"), 4);
    assert_non_null(strstr(said, "another run"));
    (void)close(lock);
    assert_int_equal(count_cells(".json"), 1);
}

TEST(run_out_of_time_is_a_recorded_row)
{
    assert_int_equal(run("tt --replicates 1 --timeout 0.001 --method brute-force"), 5);
    json_t *summary = read_json("summary.json");
    const json_t *row = json_array_get(json_object_get(summary, "rows"), 0);
    assert_string_equal(json_string_value(json_object_get(row, "status")), "timeout");
    json_decref(summary);
    assert_int_equal(count_cells(".csv"), 0);
}

TEST(run_killed_at_any_time_goes_on_without_loss)
{
    const char *arguments = "tt --frames 1-200 --replicates 4 " TWO_METHODS;
    char line[512];
    (void)snprintf(line, sizeof line, "run %s --out .", arguments);
    for (long k = 1; k <= 8; ++k) {
        pid_t pid = program_start(line, "said");
        assert_true(pid > 0); /* kill(-1) would mean every process */
        struct timespec pause = {0, k * 61000000};
        (void)nanosleep(&pause, NULL);
        (void)kill(pid, SIGKILL);
        (void)waitpid(pid, NULL, 0);
    }
    /* A child of the last run lives until the kernel has ended it. */
    struct timespec pause = {0, 200000000};
    (void)nanosleep(&pause, NULL);
    assert_int_equal(run(arguments), 0);
    assert_int_equal(count_cells(".json"), 8);
    assert_int_equal(count_cells(".csv"), 8);
    assert_int_equal(count_cells(".part"), 0);
}

/* Puts the members of an object, written with ' for ", into the only cell of the run. */
static void change_cell(const char *members)
{
    char path[512], plain[256], name[256];
    find_csv(path, sizeof path);
    (void)snprintf(name, sizeof name, "cells%s", strrchr(path, '/'));
    (void)snprintf(name + strlen(name) - 3, 6, "json");
    (void)snprintf(plain, sizeof plain, "%s", members);
    for (char *c = plain; *c; ++c)
        *c = *c == '\'' ? '"' : *c;
    json_t *cell = read_json(name), *change = json_loads(plain, 0, NULL);
    assert_non_null(change);
    assert_int_equal(json_object_update(cell, change), 0);
    json_decref(change);
    assert_int_equal(mote_record_json(".", name, cell), MOTE_OK);
}

/* A stored cell's own status and stride decide whether it is measured again. */
TEST(run_of_a_changed_cell_goes_by_its_status_and_stride)
{
    static const struct {
        const char *members;
        int status;
        const char *says;
    } cases[] = {{"{}", 0, "1 of them done"},
                 {"{'status': null}", 0, "0 of them done"},
                 {"{'stride': 0}", 0, "0 of them done"},
                 {"{'stride': 1e9}", 0, "0 of them done"},
                 {"{'stride': 5000000000}", 0, "0 of them done"},
                 {"{'status': 'timeout'}", 5, "1 of 1 cells failed"},
                 {"{'status': 'crashed'}", 5, "1 of them done"}};
    static const char line[] = "tt --frames 1-2 --replicates 1 --method fcl-aabb";
    assert_int_equal(run(line), 0);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        change_cell(cases[i].members);
        test_row("%s", cases[i].members);
        mote_expect(cases[i].status, cases[i].says, "run %s --out .", line);
    }
    assert_int_equal(run("tt --frames 1-2 --replicates 1 --method fcl-aabb --force"), 0);
    assert_non_null(strstr(said, "0 of them done"));
}

/* With a larger limit it may succeed; with the same one it would fail again. */
TEST(run_with_a_larger_limit_measures_again_what_exceeded_the_old_one)
{
    static const char line[] = "tt --frames 1-2 --replicates 1 --method fcl-aabb --timeout";
    static const struct {
        const char *timeout;
        int status;
        const char *says;
    } cases[] = {{"20", 5, "1 of them done"},
                 {"10", 5, "1 of them done"},
                 {"21", 0, "0 of them done"},
                 {"0.001", 0, "1 of them done"}};
    assert_int_equal(run("tt --frames 1-2 --replicates 1 --method fcl-aabb"), 0);
    change_cell("{'status': 'timeout', 'timeout_seconds': 20}");
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        test_row("%s", cases[i].timeout);
        mote_expect(cases[i].status, cases[i].says, "run %s %s --out .", line,
                    cases[i].timeout);
    }
}

/* The stride of the cells of a configuration is that of a stored one, also for a cell that
   stands before it in the plan: the stored one is of the second replicate, and not the stride
   that a probe of so fast a method suggests. */
TEST(run_goes_on_with_the_stride_of_a_stored_cell_that_comes_later)
{
    static const char line[] = "tt --frames 1-32 --replicates 2 --method aabb-tree";
    char first[320] = "", second[320] = "";
    assert_int_equal(run(line), 0);
    find_cell("-r1-", first, sizeof first);
    find_cell("-r2-", second, sizeof second);
    json_t *cell = read_json(second);
    assert_int_equal(json_integer_value(json_object_get(cell, "stride")), 1);
    assert_int_equal(json_object_set_new(cell, "stride", json_integer(16)), 0);
    assert_int_equal(mote_record_json(".", second, cell), MOTE_OK);
    assert_int_equal(folder_remove(first), 0);
    mote_expect(0, "plan: 2 cells, 1 of them done", "run %s --no-summary --out .", line);
    cell = read_json(first);
    assert_int_equal(json_integer_value(json_object_get(cell, "stride")), 16);
    json_decref(cell);
}

/* A further replicate is expected to take as long as the stored one, which is not tried. */
TEST(run_that_goes_on_keeps_to_its_budget)
{
    static const char line[] = "tt --frames 1-6 --replicates 2 --method fcl-aabb";
    assert_int_equal(run(line), 0);
    assert_int_equal(
        system("sed -i 's/\"wall_seconds\": [^,]*/\"wall_seconds\": 1e4/' cells/*.json"), 0);
    mote_expect(0, "2 of them done", "run %s --until-ci 0.001%% --budget 100 --out .", line);
    assert_non_null(strstr(said, "after 2 replicates the widest interval is"));
    assert_int_equal(count_cells(".json"), 2);
}

/* Whatever else ends in .part is the user's. */
TEST(run_sweeps_what_an_interrupted_write_left_and_nothing_else)
{
    static const char *const left[] = {"manifest.json.12.part",     "summary.json.12.part",
                                       "summary.csv.12.part",       "fronts.csv.7.part",
                                       "speed.csv.4194304.part",    "cells/a.json.12.part",
                                       "cells/a.pairs.csv.12.part", "truth/b.csv.12.part"};
    static const char *const kept[] = {"notes.part",
                                       "film.mp4.12.part",
                                       "a.json.12.part",
                                       "summary.json.part",
                                       "summary.json.x1.part",
                                       "summary.json.12.part.gz",
                                       ".12.part",
                                       "12.part",
                                       "cells/notes",
                                       "cells/notes.part",
                                       "cells/.json.12.part",
                                       "truth/notes.12.part"};
    for (size_t i = 0; i < ROWS_OF(left); ++i)
        file_put(left[i], "part\n");
    for (size_t i = 0; i < ROWS_OF(kept); ++i)
        file_put(kept[i], "kept\n");
    assert_int_equal(run("tt --frames 1-2 --replicates 1 --method fcl-aabb"), 0);
    for (size_t i = 0; i < ROWS_OF(left); ++i) {
        if (file_exists(left[i]))
            fail_msg("%s is left", left[i]);
    }
    for (size_t i = 0; i < ROWS_OF(kept); ++i) {
        if (!file_exists(kept[i]))
            fail_msg("%s is gone", kept[i]);
    }
    assert_int_equal(folder_remove("truth/notes.12.part"), 0);
}

TEST(run_whose_lock_cannot_be_opened_says_so)
{
    assert_int_equal(mkdir(".lock", 0777), 0);
    assert_int_equal(run("tt --frames 1-2 --replicates 1 --method fcl-aabb"), 5);
    assert_non_null(strstr(said, ".lock: Is a directory; name a directory that can be writ"));
}

/* The reference gets replicates whatever its interval; failed cells get none. */
TEST(run_until_an_interval_is_narrow_needs_cells_that_end)
{
    assert_int_equal(
        run("tt --replicates 1 --timeout 0.001 --method brute-force --until-ci 50%"), 5);
    assert_non_null(strstr(said, "after 1 replicates the widest interval is +-0 %"));
    static const char line[] = "tt --frames 1-6 --stride 1 --replicates 2 --method fcl-aabb "
                               "--method certified --until-ci 0.001% --budget 0";
    assert_int_equal(run(line), 0);
    assert_non_null(strstr(said, "after 2 replicates the widest interval is"));
    assert_non_null(strstr(said, "wider than asked for: the budget ends"));
    mote_expect(0, "plan: 4 cells, 0 of them done", "run %s --force --out .", line);
}

static mote_traits no_traits(const double *values)
{
    (void)values;
    mote_traits traits = {0};
    return traits;
}

static mote_status create_nothing(const mote_setup *setup, void **made)
{
    (void)setup;
    *made = NULL;
    return MOTE_OK;
}

static void destroy_nothing(void *made)
{
    (void)made;
}

static mote_status die(void *made, const mote_frame *frame, mote_answer *answer)
{
    (void)made;
    (void)frame;
    (void)answer;
    (void)signal(SIGSEGV, SIG_DFL);
    (void)raise(SIGSEGV);
    return MOTE_OK;
}

static mote_status refuse(void *made, const mote_frame *frame, mote_answer *answer)
{
    (void)made;
    (void)frame;
    (void)answer;
    return mote_fail(MOTE_ENUMERIC, "the reason");
}

/* Measures two frames of tt with a query of the test's own; returns how the cell ended. */
static mote_cell_status measure(mote_status (*query)(void *, const mote_frame *, mote_answer *),
                                char *reason, size_t size)
{
    const mote_method method = {.name = "of-a-test",
                                .traits = no_traits,
                                .create = create_nothing,
                                .destroy = destroy_nothing,
                                .query = query};
    mote_method_choice choice = {.method = &method, .text = "of-a-test"};
    mote_subject subject = {0};
    assert_int_equal(mote_directory_make("cells"), MOTE_OK);
    assert_int_equal(mote_scenario_load("tt", &subject.scenario), MOTE_OK);
    assert_int_equal(mote_truth_load_or_compute(subject.scenario, ".", &subject.truth),
                     MOTE_OK);
    mote_cell cell = {.subject = &subject,
                      .choice = &choice,
                      .replicate = 1,
                      .first = 1,
                      .last = 2,
                      .stride = 1};
    mote_cell_name(&cell, 1);
    mote_process_options options = {.directory = ".", .core = -1, .timeout = 60};
    mote_cell_end end;
    assert_int_equal(measure_cell(&cell, &options, &end), MOTE_OK);
    (void)snprintf(reason, size, "%s", end.reason);
    mote_truth_destroy(subject.truth);
    mote_scenario_destroy(subject.scenario);
    return end.status;
}

TEST(cell_of_a_crashing_method_is_recorded_as_crashed)
{
    char reason[400];
    assert_int_equal(measure(die, reason, sizeof reason), MOTE_CELL_CRASHED);
    assert_non_null(strstr(reason, "signal 11"));
    assert_int_equal(count_cells(".json"), 1);
    assert_int_equal(count_cells(".csv"), 0);
}

TEST(cell_of_a_failing_method_keeps_frame_and_reason)
{
    char reason[400];
    assert_int_equal(measure(refuse, reason, sizeof reason), MOTE_CELL_CRASHED);
    assert_string_equal(reason, "frame 1: the reason");
}
