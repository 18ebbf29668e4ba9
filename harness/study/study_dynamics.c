#include "harness/study/study_dynamics.h"

#include "harness/figure/figure.h"
#include "harness/base/hash.h"
#include "harness/run/measure.h"
#include "harness/base/record.h"
#include "harness/process/crew.h"

#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef struct study {
    const char *directory;
    char program[20]; /* hash of the program, in hexadecimal */
    char commit[64];  /* of this program's sources, or "" */
    bool quick;
    bool keep;      /* also accept rows measured by another build of the program */
    bool particles; /* whether rows of them are measured */
    int lock;       /* a file with a byte for each row, locked while the row is measured */
    mote_dynamics_row *rows;
    size_t count;
    mote_scenario *scenario; /* loaded last */
} study;

/* "rows/ww-particle-paper-n-3-law-log.json"; the caller frees it. */
static char *row_name(const mote_dynamics_row *row)
{
    char label[MOTE_DYNAMICS_LABEL];
    mote_dynamics_label(row, label);
    char *name = mote_format("rows/%s-%s.json", row->scene, label);
    for (char *c = name + strlen("rows/"); *c; ++c) {
        if (!isalnum((unsigned char)*c) && *c != '.')
            *c = '-';
    }
    return name;
}

/* True if the row is stored and was measured by this build of the program or, with keep, by
   any. */
static bool recall(const study *s, mote_dynamics_row *row)
{
    char *name = row_name(row);
    char *path = mote_format("%s/%s", s->directory, name);
    json_t *object = NULL;
    bool there = access(path, F_OK) == 0 &&
                 mote_record_read_json(s->directory, name, &object) == MOTE_OK;
    const char *program = json_string_value(json_object_get(object, "program"));
    const char *measured = json_string_value(json_object_get(object, "measured"));
    const char *commit = json_string_value(json_object_get(object, "commit"));
    there = there && program && measured && commit &&
            (s->keep || strcmp(program, s->program) == 0) &&
            json_integer_value(json_object_get(object, "wanted")) == (json_int_t)row->wanted;
    mote_approaches sum;
    there = there && mote_approaches_read(object, &sum);
    if (there) {
        row->sum = sum;
        (void)snprintf(row->measured, sizeof row->measured, "%s", measured);
        (void)snprintf(row->commit, sizeof row->commit, "%s", commit);
    }
    json_decref(object);
    free(path);
    free(name);
    return there;
}

static mote_status store(const study *s, const mote_dynamics_row *row)
{
    char *name = row_name(row);
    json_t *object = mote_dynamics_row_json(row);
    (void)json_object_set_new(object, "program", json_string(s->program));
    (void)json_object_set_new(object, "commit", json_string(s->commit));
    (void)json_object_set_new(object, "wanted", json_integer(row->wanted));
    const mote_status status = mote_record_json(s->directory, name, object);
    free(name);
    return status;
}

static mote_status load(study *s, const char *scene)
{
    if (s->scenario && strcmp(s->scenario->name, scene) == 0)
        return MOTE_OK;
    mote_scenario_destroy(s->scenario);
    s->scenario = NULL;
    return mote_scenario_load(scene, &s->scenario);
}

static mote_status measure(study *s, mote_dynamics_row *row)
{
    const uint64_t start = mote_clock_ns();
    mote_clock_date(row->measured);
    (void)snprintf(row->commit, sizeof row->commit, "%s", s->commit);
    char label[MOTE_DYNAMICS_LABEL];
    mote_dynamics_label(row, label);
    mote_status status = load(s, row->scene);
    if (status == MOTE_OK)
        status = mote_approaches_simulate(
            s->scenario,
            &(mote_approaches_plan){row->method, row->wanted, row->step, row->within},
            &row->sum);
    if (status == MOTE_OK)
        status = store(s, row);
    if (status == MOTE_OK)
        (void)fprintf(stderr, "dynamics: %s, %s: %u passes of %u, %.1f s\n", row->scene, label,
                      (unsigned)row->sum.passes_through, (unsigned)row->sum.approaches,
                      (double)(mote_clock_ns() - start) * 1e-9);
    return status;
}

/* The byte of the lock file for a row, the same in every study of the directory. Two rows that
   share a byte merely wait for each other. */
static off_t byte_of(const mote_dynamics_row *row)
{
    char name[160], label[MOTE_DYNAMICS_LABEL];
    mote_dynamics_label(row, label);
    (void)snprintf(name, sizeof name, "%s %s", row->scene, label);
    return (off_t)(mote_hash_text(name) & 0x7fffffff);
}

/* Locks or unlocks a row's byte against other processes; false if another process holds it, or
   on an error. */
static bool lock_row(const study *s, const mote_dynamics_row *row, int command, short type)
{
    struct flock lock = {
        .l_type = type, .l_whence = SEEK_SET, .l_start = byte_of(row), .l_len = 1};
    int status;
    do
        status = fcntl(s->lock, command, &lock);
    while (status != 0 && errno == EINTR);
    return status == 0;
}

/* Measures the missing rows; those that another process is measuring are skipped or, with wait,
   waited for. */
static mote_status measure_rows(study *s, bool wait)
{
    mote_status status = MOTE_OK;
    for (size_t i = 0; i < s->count && status == MOTE_OK; ++i) {
        if (!lock_row(s, &s->rows[i], wait ? F_SETLKW : F_SETLK, F_WRLCK)) {
            if (wait)
                status = mote_fail(MOTE_EIO, "%s/rows/lock: %s", s->directory, strerror(errno));
            continue;
        }
        if (!recall(s, &s->rows[i]))
            status = measure(s, &s->rows[i]);
        (void)lock_row(s, &s->rows[i], F_SETLK, F_UNLCK);
    }
    return status;
}

/* The child's task, in its own copy of the parent's memory. */
typedef struct row_task {
    study *study;
    mote_dynamics_row *row;
} row_task;

/* A child's only result is the row's file. */
static mote_status measure_in_child(void *context, int output)
{
    const row_task *task = context;
    (void)output;
    return measure(task->study, task->row);
}

/* Starts a row that is neither stored nor being measured by another process. */
static mote_status start_row(void *context, size_t index, mote_child *child)
{
    study *s = context;
    row_task task = {s, &s->rows[index]};
    if (!lock_row(s, task.row, F_SETLK, F_WRLCK))
        return MOTE_OK;
    const bool there = recall(s, task.row);
    mote_status status = there ? MOTE_OK : load(s, task.row->scene);
    if (!there && status == MOTE_OK)
        status = mote_child_start(measure_in_child, &task, (mote_child_limits){0}, child);
    if (there || status != MOTE_OK)
        (void)lock_row(s, task.row, F_SETLK, F_UNLCK);
    return status;
}

/* If a child fails, its row stays missing and is tried again in this process. */
static mote_status finish_row(void *context, size_t index, mote_child *child, double seconds)
{
    const study *s = context;
    (void)child;
    (void)seconds;
    (void)lock_row(s, &s->rows[index], F_SETLK, F_UNLCK);
    return MOTE_OK;
}

/* Distributes the rows over processes. */
static mote_status measure_by_crew(study *s, uint32_t jobs)
{
    const mote_crew crew = {.tasks = s->count,
                            .places = jobs,
                            .context = s,
                            .start = start_row,
                            .finish = finish_row};
    return mote_crew_run(&crew);
}

static mote_status measure_all(study *s, uint32_t jobs)
{
    char *rows = mote_format("%s/rows", s->directory);
    char *path = mote_format("%s/rows/lock", s->directory);
    mote_status status = mote_directory_make(rows);
    if (status == MOTE_OK) {
        s->lock = open(path, O_RDWR | O_CREAT | O_CLOEXEC, 0644);
        if (s->lock < 0)
            status = mote_fail(MOTE_EIO, "%s: %s", path, strerror(errno));
    }
    if (status == MOTE_OK)
        status = jobs > 1 ? measure_by_crew(s, jobs) : measure_rows(s, false);
    if (status == MOTE_OK)
        status = measure_rows(s, true);
    if (s->lock >= 0)
        (void)close(s->lock);
    free(path);
    free(rows);
    return status;
}

/* The failures, printed to stderr; the caller decrefs. */
static json_t *failures_of(const study *s)
{
    json_t *failures = json_array();
    for (size_t i = 0; i < s->count; ++i) {
        const mote_dynamics_row *row = &s->rows[i];
        const char *what = mote_dynamics_failure(row);
        char label[MOTE_DYNAMICS_LABEL];
        mote_dynamics_label(row, label);
        if (!what)
            continue;
        (void)json_array_append_new(failures,
                                    json_pack("{s:s, s:s, s:s}", "scenario", row->scene,
                                              "method", label, "what", what));
        (void)fprintf(stderr, "mote: dynamics: %s, %s: %s\n", row->scene, label, what);
    }
    return failures;
}

/* The commit in the directory's manifest, or "". */
static void read_commit(const char *directory, char *commit, size_t size)
{
    json_t *manifest = NULL;
    const char *text = NULL;
    if (mote_record_read_json(directory, "manifest.json", &manifest) == MOTE_OK)
        text = json_string_value(json_object_get(manifest, "commit"));
    (void)snprintf(commit, size, "%s", text ? text : "");
    json_decref(manifest);
}

static mote_status write_json(const study *s, const mote_claim *claim, json_t *failures)
{
    json_t *rows = json_array();
    for (size_t i = 0; i < s->count; ++i)
        (void)json_array_append_new(rows, mote_dynamics_row_json(&s->rows[i]));
    const bool met = json_array_size(failures) == 0;
    json_t *root = json_pack(
        "{s:i, s:s, s:s, s:I, s:{s:[f,f], s:f, s:f, s:f, s:f}, s:o, s:o, s:b, s:o}", "schema",
        1, "profile", s->quick ? "quick" : "full", "commit", s->commit, "seed",
        (json_int_t)MOTE_APPROACH_SEED, "approach", "speed", MOTE_APPROACH_SLOWEST,
        MOTE_APPROACH_FASTEST, "degrees", MOTE_APPROACH_DEGREES, "aside", MOTE_APPROACH_ASIDE,
        "clear", MOTE_APPROACH_CLEAR, "apart", MOTE_APPROACH_APART, "rows", rows, "failures",
        failures, "met", met, "claim", mote_claim_json(claim));
    return mote_record_json(s->directory, "dynamics.json", root);
}

static mote_status report(const study *s, bool *met)
{
    mote_claim claim = {0};
    mote_dynamics_claim(&claim);
    for (size_t i = 0; i < s->count; ++i) {
        if (s->rows[i].paper && (!s->rows[i].law || strcmp(s->rows[i].law, "log") == 0))
            mote_dynamics_claim_add(&claim, &s->rows[i]);
    }
    mote_dynamics_print(s->rows, s->count);
    if (s->particles) {
        (void)printf("\n");
        mote_claim_print(&claim);
    }
    json_t *failures = failures_of(s);
    *met = json_array_size(failures) == 0;
    mote_status status = write_json(s, &claim, failures);
    if (status == MOTE_OK)
        status = mote_dynamics_csv(s->rows, s->count, s->directory);
    if (status == MOTE_OK)
        status = mote_dynamics_figure(s->rows, s->count, s->directory);
    mote_claim_free(&claim);
    return status;
}

mote_status mote_study_dynamics(const char *directory, const mote_dynamics_size *size,
                                uint32_t jobs, uint64_t program, bool keep, bool *met)
{
    study s = {.directory = directory,
               .quick = size->quick,
               .keep = keep,
               .particles = !(size->step > 0),
               .lock = -1};
    read_commit(directory, s.commit, sizeof s.commit);
    (void)snprintf(s.program, sizeof s.program, "%016" PRIx64, program);
    mote_status status = mote_dynamics_plan(size, &s.rows, &s.count);
    if (status == MOTE_OK)
        status = measure_all(&s, jobs);
    if (status == MOTE_OK)
        status = report(&s, met);
    mote_scenario_destroy(s.scenario);
    free(s.rows);
    return status;
}
