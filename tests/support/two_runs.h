/* Two runs of one method, base and new, which a test writes itself and compares. */
#ifndef MOTE_TESTS_TWO_RUNS_H
#define MOTE_TESTS_TWO_RUNS_H

#include "harness/compare/compare.h"
#include "harness/base/record.h"
#include "tests/support/mote.h"
#include "tests/support/test.h"

#include <stddef.h>
#include <stdint.h>

#include <sys/stat.h>

static inline int make_runs(void)
{
    return mkdir("old", 0777) || mkdir("new", 0777);
}

TEST_GROUP(make_runs, NULL);

/* Does not sync as mote_record_json does; takes ownership of object. */
static inline void put(const char *directory, const char *name, json_t *object)
{
    char path[96];
    (void)snprintf(path, sizeof path, "%s/%s", directory, name);
    assert_non_null(object);
    assert_int_equal(json_dump_file(object, path, 0), 0);
    json_decref(object);
}

/* A run of one method, five replicates. */
typedef struct figures {
    double ratio;     /* of fcl-aabb's time to this one's, roughly */
    double jitter;    /* by what share replicates differ */
    double box_tests; /* of one replicate */
    double heap, missed, p99;
} figures;

static const figures usual = {100, 0.002, 5000, 1e6, 2, 1e-3};

static inline json_t *one_process(const figures *f, int replicate, double sign)
{
    double wobble = 1 + sign * f->jitter * ((replicate * 7) % 5 - 2);
    return json_pack("{s:i, s:f, s:f, s:{s:f}}", "replicate", replicate, "median_ns",
                     1e6 / f->ratio * wobble, "ratio", f->ratio / wobble, "counters",
                     "box_tests", f->box_tests);
}

/* sign: makes the two runs of a pair vary differently. */
static inline void write_run(const char *directory, const figures *f, double sign)
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

static inline mote_comparison compare_with(const figures *fresh)
{
    mote_comparison c;
    write_run("old", &usual, 1);
    write_run("new", fresh, -1);
    assert_int_equal(mote_compare("old", "new", 0.02, &c), MOTE_OK);
    assert_int_equal(c.count, 1);
    return c;
}

/* Writes what a run on a processor leaves beside its summary. */
static inline void write_beside(const char *directory, const char *processor,
                                double instructions)
{
    json_t *row = json_pack("{s:s, s:s, s:{s:i}, s:f}", "scenario", "ww", "method",
                            "particle-paper", "parameters", "n", 5, "per_frame", instructions);
    put(directory, "instructions.json", json_pack("{s:i, s:[o]}", "schema", 1, "rows", row));
    put(directory, "manifest.json",
        json_pack("{s:s, s:s}", "processor", processor, "compiler", "GNU 12"));
}

static inline void remove_beside(void)
{
    assert_int_equal(system("rm old/[im]*.json new/[im]*.json"), 0);
}

/* Puts the members of an object, written with ' for ", into a row of a run's file. */
static inline void change_row_at(const char *directory, const char *name, size_t at,
                                 const char *members)
{
    char plain[1024];
    json_t *summary = NULL;
    (void)snprintf(plain, sizeof plain, "%s", members);
    for (char *c = plain; *c; ++c)
        *c = *c == '\'' ? '"' : *c;
    json_t *change = json_loads(plain, 0, NULL);
    assert_non_null(change);
    assert_int_equal(mote_record_read_json(directory, name, &summary), MOTE_OK);
    json_t *row = json_array_get(json_object_get(summary, "rows"), at);
    assert_int_equal(json_object_update_recursive(row, change), 0);
    json_decref(change);
    put(directory, name, summary);
}

/* The same of the first row. */
static inline void change_row(const char *directory, const char *name, const char *members)
{
    change_row_at(directory, name, 0, members);
}

/* Adds a row like the first one, but for these members, to a run, before its own. */
static inline void add_row(const char *directory, const char *members)
{
    json_t *summary = NULL;
    assert_int_equal(mote_record_read_json(directory, "summary.json", &summary), MOTE_OK);
    json_t *rows = json_object_get(summary, "rows");
    assert_int_equal(json_array_insert_new(rows, 0, json_deep_copy(json_array_get(rows, 0))),
                     0);
    put(directory, "summary.json", summary);
    change_row(directory, "summary.json", members);
}

/* Runs mote compare OLD NEW OPTIONS, which must end with this status and print this text. */
static inline void expect(const char *options, int status, const char *says)
{
    mote_expect(status, says, "compare old new %s", options);
}

#endif
