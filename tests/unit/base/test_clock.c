/* A run measures while the wall clock is set back and forth by years
   (tests/support/clock_steps.c): its times come from a steady clock, its records are valid, and
   it does not measure again. */
#define _DEFAULT_SOURCE /* setenv */
#include "harness/base/record.h"
#include "tests/support/mote.h"
#include "tests/support/run_files.h"
#include "tests/support/test.h"

#include <stddef.h>

#include <time.h>

enum { FRAMES = 40, CELLS = 6, TIMES = 3 /* columns: deform, update, query */ };

#define SWEEP                                                                                  \
    "run tt --frames 1-40 --stride 1 --replicates 3 --method aabb-tree "                       \
    "--method particle-paper:n=2 --out"

static double steady_seconds(void)
{
    struct timespec now;
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* Runs mote WHAT run under the unsteady clock; *seconds: how long it took. */
static int run(const char *what, double *seconds)
{
    assert_int_equal(setenv("LD_PRELOAD", MOTE_CLOCK_STEPS, 1), 0);
    /* The library is loaded before AddressSanitizer, which would object. */
    assert_int_equal(setenv("ASAN_OPTIONS", "verify_asan_link_order=0", 1), 0);
    const double from = steady_seconds();
    const int status = mote("%s run", what);
    *seconds = steady_seconds() - from;
    assert_int_equal(unsetenv("LD_PRELOAD"), 0);
    return status;
}

/* The sum of all times of a cell in ns; none may exceed the duration of the whole run. */
static double sum_of_times(const char *csv, double seconds)
{
    double sum = 0;
    int rows = 0;
    for (const char *row = strchr(csv, '\n') + 1; *row; row = strchr(row, '\n') + 1, ++rows) {
        const char *at = row;
        for (int k = 0; k < TIMES; ++k) {
            at = strchr(at, ',') + 1;
            const double ns = strtod(at, NULL);
            assert_true(ns >= 0 && ns <= seconds * 1e9);
            sum += ns;
        }
    }
    assert_int_equal(rows, FRAMES);
    return sum;
}

static double number(const json_t *object, const char *name)
{
    const json_t *member = json_object_get(object, name);
    assert_true(json_is_number(member));
    return json_number_value(member);
}

TEST(run_while_the_clock_is_set_has_steady_times)
{
    double seconds, sum = 0;
    assert_int_equal(run(SWEEP, &seconds), 0);
    run_files finished = {0};
    const char *wrong = run_files_check("run", FRAMES, &finished);
    if (wrong)
        fail_msg("%s", wrong);
    assert_int_equal(finished.count, CELLS);
    for (size_t i = 0; i < finished.count; ++i) {
        sum += sum_of_times(finished.items[i].csv, seconds);
        json_t *cell = json_loads(finished.items[i].json, 0, NULL);
        assert_string_equal(json_string_value(json_object_get(cell, "status")), "ok");
        const double build_ns = number(cell, "build_ns"), wall = number(cell, "wall_seconds");
        assert_true(build_ns > 0 && build_ns <= seconds * 1e9);
        assert_true(wall > 0 && wall <= seconds);
        json_decref(cell);
    }
    assert_true(sum > 0 && sum <= seconds * 1e9);
    /* A resumed run measures nothing again, whatever the dates. */
    assert_int_equal(run(SWEEP, &seconds), 0);
    assert_null(run_files_check("run", FRAMES, &finished));
    assert_int_equal(finished.count, CELLS);
    run_files_free(&finished);
    assert_int_equal(run("summarize", &seconds), 0);
    assert_int_equal(run("report", &seconds), 0);
}

/* The dates are those of the manipulated clock, and well formed. */
TEST(run_while_the_clock_is_set_writes_the_dates_it_reads)
{
    json_t *manifest = NULL;
    assert_int_equal(mote_record_read_json("run", "manifest.json", &manifest), MOTE_OK);
    const json_t *sessions = json_object_get(manifest, "sessions");
    assert_int_equal(json_array_size(sessions), 2);
    const time_t now = time(NULL);
    struct tm utc;
    assert_non_null(gmtime_r(&now, &utc));
    for (size_t i = 0; i < 2; ++i) {
        const char *started =
            json_string_value(json_object_get(json_array_get(sessions, i), "started"));
        int year, month, day, hour, minute, second, end = 0;
        assert_int_equal(sscanf(started, "%d-%2d-%2dT%2d:%2d:%2dZ%n", &year, &month, &day,
                                &hour, &minute, &second, &end),
                         6);
        assert_int_equal(end, strlen(started));
        assert_true(year != utc.tm_year + 1900);
    }
    json_decref(manifest);
}
