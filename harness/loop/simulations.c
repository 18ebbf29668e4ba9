#define _DEFAULT_SOURCE /* scandir */
#include "harness/loop/simulations.h"

#include "harness/base/file.h"
#include "harness/base/json_print.h"
#include "harness/base/memory.h"
#include "harness/base/record.h"
#include "harness/loop/simulate_print.h"
#include "harness/process/manifest.h"

#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#define FOLDER "simulations"

/* A fixed seed, so the same data give the same intervals. */
#define INTERVAL_SEED 1

static void copy_key(const json_t *from, const char *key, json_t *to)
{
    (void)json_object_set(to, key, json_object_get(from, key));
}

json_t *mote_simulation_question(const json_t *stored)
{
    static const char *const keys[] = {"scenario",   "fingerprint", "faces",   "method",
                                       "parameters", "steps_asked", "density", "restitution",
                                       "tolerance",  "time_step",   "gravity", "alone"};
    json_t *question = json_object();
    for (size_t k = 0; k < sizeof keys / sizeof keys[0]; ++k)
        copy_key(stored, keys[k], question);
    const json_int_t within = json_integer_value(json_object_get(stored, "within"));
    (void)json_object_set_new(question, "within", json_integer(within)); /* older files: 0 */
    const json_int_t seed = json_integer_value(json_object_get(stored, "seed"));
    const json_int_t replicate = json_integer_value(json_object_get(stored, "replicate"));
    (void)json_object_set_new(question, "seed", json_integer(seed - replicate + 1));
    return question;
}

bool mote_simulation_same_question(const json_t *a, const json_t *b)
{
    static const char faces[] = "faces";
    if (!json_object_get(a, faces) == !json_object_get(b, faces))
        return json_equal(a, b);
    json_t *left = json_deep_copy(a), *right = json_deep_copy(b);
    (void)json_object_del(left, faces);
    (void)json_object_del(right, faces);
    const bool same = json_equal(left, right);
    json_decref(left);
    json_decref(right);
    return same;
}

bool mote_simulations_exist(const char *directory)
{
    return mote_record_exists(directory, FOLDER);
}

mote_status mote_simulations_make(const char *directory)
{
    char *folder = mote_format("%s/" FOLDER, directory);
    const mote_status status = mote_directory_make(folder);
    free(folder);
    return status;
}

/* The row of a stored simulation, added if there is none yet. */
static mote_simulations_row *row_of(const json_t *stored, mote_simulations *list)
{
    json_t *question = mote_simulation_question(stored), *origin = json_object();
    copy_key(stored, "program", origin);
    copy_key(stored, "machine", origin);
    for (size_t i = 0; i < list->count; ++i) {
        mote_simulations_row *row = &list->rows[i];
        if (!json_equal(row->question, question) || !json_equal(row->origin, origin))
            continue;
        json_decref(question);
        json_decref(origin);
        return row;
    }
    list->rows = mote_resize(list->rows, list->count + 1, sizeof *list->rows);
    mote_simulations_row *row = &list->rows[list->count++];
    *row = (mote_simulations_row){.question = question, .origin = origin};
    row->scenario = mote_text_at(question, "scenario");
    row->method = mote_text_at(question, "method");
    row->alone = json_is_true(json_object_get(question, "alone"));
    return row;
}

static void add_replicate(const json_t *stored, const mote_simulation_result *result,
                          mote_simulations_row *row)
{
    row->replicates = mote_resize(row->replicates, row->done + 1, sizeof *row->replicates);
    const json_int_t number = json_integer_value(json_object_get(stored, "replicate"));
    row->replicates[row->done++] =
        (mote_simulation_replicate){.number = (uint32_t)number, .result = *result};
}

/* Adds a stored simulation to its row. */
static void add_stored(const json_t *stored, mote_simulations *list)
{
    const char *status = mote_text_at(stored, "status"),
               *reason = mote_text_at(stored, "reason");
    mote_simulation_result result;
    const bool whole = mote_simulation_read(stored, &result);
    if (!json_is_object(stored) || status[0] == '\0' || (strcmp(status, "ok") == 0 && !whole))
        return;
    mote_simulations_row *row = row_of(stored, list);
    row->bodies = (uint32_t)json_integer_value(json_object_get(stored, "bodies"));
    if (whole) {
        add_replicate(stored, &result, row);
    } else if (strcmp(status, "unsupported") == 0) {
        free(row->unsupported);
        row->unsupported = mote_duplicate(reason);
    } else {
        ++row->failed;
    }
}

static int by_number(const void *a, const void *b)
{
    const uint32_t first = ((const mote_simulation_replicate *)a)->number,
                   second = ((const mote_simulation_replicate *)b)->number;
    return (first > second) - (first < second);
}

/* The figures over all replicates, which are added in the order of their numbers. */
static void combine(mote_simulations_row *row)
{
    double *ns = mote_allocate(row->done, sizeof *ns);
    mote_replicate *each = mote_allocate(row->done, sizeof *each);
    if (row->done > 0)
        qsort(row->replicates, row->done, sizeof *row->replicates, by_number);
    for (uint32_t r = 0; r < row->done; ++r) {
        mote_simulation_add(&row->sum, &row->replicates[r].result);
        ns[r] = row->replicates[r].result.query_ns;
        each[r] = (mote_replicate){&ns[r], 1};
    }
    row->interval = mote_statistics_median_interval(each, row->done, true, INTERVAL_SEED);
    row->query_ns = row->done > 0 ? mote_statistics_median(ns, row->done) : MOTE_NONE;
    free(each);
    free(ns);
}

static int by_name(const void *a, const void *b)
{
    const mote_simulations_row *first = a, *second = b;
    const int order = strcmp(first->scenario, second->scenario);
    return order != 0 ? order : strcmp(first->method, second->method);
}

static int is_json(const struct dirent *entry)
{
    return mote_name_ends(entry->d_name, ".json");
}

/* Calls visit for each stored simulation of a directory, in the order of file names. */
static mote_status visit_files(const char *directory,
                               mote_status (*visit)(void *context, const char *name),
                               void *context)
{
    struct dirent **files;
    char *folder = mote_format("%s/" FOLDER, directory);
    const int count = scandir(folder, &files, is_json, alphasort);
    mote_status status = MOTE_OK;
    if (count < 0)
        status = mote_fail(MOTE_EIO, "%s: %s; name a directory of `mote simulate --out`",
                           folder, strerror(errno));
    free(folder);
    for (int i = 0; i < count; ++i) {
        char *name = mote_format(FOLDER "/%s", files[i]->d_name);
        if (status == MOTE_OK)
            status = visit(context, name);
        free(name);
        free(files[i]);
    }
    if (count >= 0)
        free(files);
    return status;
}

typedef struct reading {
    const char *directory, *program;
    mote_simulations *list;
} reading;

static mote_status read_file(void *context, const char *name)
{
    const reading *r = context;
    json_t *stored = NULL;
    const bool read = mote_record_read_json(r->directory, name, &stored) == MOTE_OK;
    if (read && r->program[0] && strcmp(mote_text_at(stored, "program"), r->program) != 0)
        ++r->list->left_out;
    else if (read)
        add_stored(stored, r->list);
    json_decref(stored);
    return MOTE_OK;
}

mote_status mote_simulations_read_of(const char *directory, const char *program,
                                     mote_simulations *list)
{
    reading r = {directory, program, list};
    const mote_status status = visit_files(directory, read_file, &r);
    for (size_t i = 0; i < list->count; ++i)
        combine(&list->rows[i]);
    if (list->count > 0)
        qsort(list->rows, list->count, sizeof *list->rows, by_name);
    return status;
}

mote_status mote_simulations_read(const char *directory, mote_simulations *list)
{
    char program[MOTE_PROGRAM_SIZE];
    mote_manifest_program(directory, program);
    return mote_simulations_read_of(directory, program, list);
}

void mote_simulations_free(mote_simulations *list)
{
    for (size_t i = 0; i < list->count; ++i) {
        json_decref(list->rows[i].question);
        json_decref(list->rows[i].origin);
        free(list->rows[i].replicates);
        free(list->rows[i].unsupported);
    }
    free(list->rows);
    *list = (mote_simulations){0};
}

static json_t *row_json(const mote_simulations_row *row)
{
    json_t *object = NULL;
    if (row->done > 0) {
        object = mote_simulation_json(row->scenario, row->bodies, row->method, &row->sum);
        (void)json_object_set_new(object, "query_ns", mote_json_number(row->query_ns));
        (void)json_object_set_new(object, "query_ns_low", mote_json_number(row->interval.low));
        (void)json_object_set_new(object, "query_ns_high",
                                  mote_json_number(row->interval.high));
    } else {
        object = json_pack("{s:s, s:s, s:I}", "scenario", row->scenario, "method", row->method,
                           "bodies", (json_int_t)row->bodies);
    }
    copy_key(row->question, "fingerprint", object);
    copy_key(row->question, "faces", object);
    if (row->unsupported)
        (void)json_object_set_new(object, "unsupported", json_string(row->unsupported));
    (void)json_object_set_new(object, "replicates", json_integer(row->done));
    (void)json_object_set_new(object, "replicates_failed", json_integer(row->failed));
    return object;
}

json_t *mote_simulations_json(const mote_simulations *list)
{
    json_t *rows = json_array();
    json_t *root = json_pack("{s:i, s:I}", "schema", 1, "simulations_left_out",
                             (json_int_t)list->left_out);
    bool one = list->count > 0;
    for (size_t i = 0; i < list->count; ++i) {
        one = one && strcmp(list->rows[i].scenario, list->rows[0].scenario) == 0;
        (void)json_array_append_new(rows, row_json(&list->rows[i]));
    }
    if (one) {
        copy_key(json_array_get(rows, 0), "scenario", root);
        copy_key(json_array_get(rows, 0), "fingerprint", root);
        copy_key(json_array_get(rows, 0), "faces", root);
        copy_key(json_array_get(rows, 0), "bodies", root);
    }
    (void)json_object_set_new(root, "rows", rows);
    return root;
}

mote_status mote_simulations_write(const mote_simulations *list, const char *directory)
{
    return mote_record_json(directory, FOLDER ".json", mote_simulations_json(list));
}

typedef struct copying {
    const char *from, *to;
    size_t *copied, *present;
} copying;

static mote_status copy_file(void *context, const char *name)
{
    const copying *c = context;
    if (!mote_record_is_wanted(c->from, c->to, name)) {
        ++*c->present;
        return MOTE_OK;
    }
    const mote_status status = mote_record_copy(c->from, c->to, name);
    *c->copied += status == MOTE_OK;
    return status;
}

mote_status mote_simulations_copy(const char *from, const char *to, size_t *copied,
                                  size_t *present)
{
    copying c = {from, to, copied, present};
    mote_status status = mote_simulations_make(to);
    if (status == MOTE_OK)
        status = visit_files(from, copy_file, &c);
    if (status != MOTE_OK)
        return status;
    mote_simulations list = {0};
    status = mote_simulations_read(to, &list);
    if (status == MOTE_OK)
        status = mote_simulations_write(&list, to);
    mote_simulations_free(&list);
    return status;
}

void mote_simulations_print(const mote_simulations *list, FILE *out)
{
    for (size_t i = 0; i < list->count; ++i) {
        const mote_simulations_row *row = &list->rows[i];
        if (row->done == 0) {
            (void)fprintf(out, "%s, %s: %s%s\n", row->scenario, row->method,
                          row->unsupported ? "unsupported: " : "every replicate failed",
                          row->unsupported ? row->unsupported : "");
            continue;
        }
        mote_simulation_print(row->scenario, row->bodies, row->method, &row->sum, out);
        (void)fprintf(out, "replicates %u, failed %u; median time a step %.3g us", row->done,
                      row->failed, row->query_ns / 1e3);
        if (!isnan(row->interval.low))
            (void)fprintf(out, " (%.3g to %.3g)", row->interval.low / 1e3,
                          row->interval.high / 1e3);
        (void)fprintf(out, "\n");
    }
    if (list->left_out > 0)
        (void)fprintf(out, "%zu simulations are of another build and are left out\n",
                      list->left_out);
}
