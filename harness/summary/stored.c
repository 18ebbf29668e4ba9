#include "harness/summary/stored.h"

#include "harness/run/plan.h"
#include "harness/base/memory.h"
#include "harness/base/record.h"
#include "harness/base/statistics.h"

#include <dirent.h>
#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define FILE_LIMIT ((size_t)1 << 30)
#define BYTES_MAX (((json_int_t)1 << 62) - 1)
#define COLUMNS_MAX 64
#define FRAME_LAST 4294967295.0

#define NAME_TEXT(name) #name,
const char *const mote_stored_count_names[MOTE_STORED_COUNTS] = {
    MOTE_COUNTERS(NAME_TEXT) MOTE_COUNTERS_MORE(NAME_TEXT) "allocations"};
#undef NAME_TEXT

/* The columns that are read, by position in this list. */
enum {
    COLUMN_FRAME,
    COLUMN_DEFORM,
    COLUMN_UPDATE,
    COLUMN_QUERY,
    COLUMN_TRUTH,
    COLUMN_ERROR,
    COLUMN_CONTACT,
    COLUMN_CONTACT_TRUTH,
    COLUMN_COUNTS
};
static const char *const column_names[COLUMN_COUNTS] = {"frame",    "deform_ns",    "update_ns",
                                                        "query_ns", "truth",        "error",
                                                        "contact",  "contact_truth"};

static void free_cell(mote_stored_cell *cell)
{
    json_decref(cell->json);
    free(cell->group);
    free(cell->frame);
    free(cell->deform_ns);
    free(cell->update_ns);
    free(cell->query_ns);
    free(cell->total_ns);
    free(cell->error);
    free(cell->truth);
    free(cell->contact);
    free(cell->contact_truth);
    for (int k = 0; k < MOTE_SCENE_COLUMN_COUNT; ++k)
        free(cell->scene[k]);
}

void mote_stored_free(mote_stored *stored)
{
    for (size_t i = 0; i < stored->count; ++i)
        free_cell(&stored->cells[i]);
    free(stored->cells);
    mote_stored none = {0};
    *stored = none;
}

double mote_stored_number(const mote_stored_cell *cell, const char *key)
{
    const json_t *value = json_object_get(cell->json, key);
    return json_is_number(value) ? json_number_value(value) : MOTE_NONE;
}

static void make_arrays(mote_stored_cell *cell, size_t frames)
{
    cell->frame = mote_allocate(frames, sizeof *cell->frame);
    cell->deform_ns = mote_allocate(frames, sizeof *cell->deform_ns);
    cell->update_ns = mote_allocate(frames, sizeof *cell->update_ns);
    cell->query_ns = mote_allocate(frames, sizeof *cell->query_ns);
    cell->total_ns = mote_allocate(frames, sizeof *cell->total_ns);
    cell->error = mote_allocate(frames, sizeof *cell->error);
    cell->truth = mote_allocate(frames, sizeof *cell->truth);
    cell->contact = mote_allocate(frames, sizeof *cell->contact);
    cell->contact_truth = mote_allocate(frames, sizeof *cell->contact_truth);
    for (int k = 0; k < MOTE_SCENE_COLUMN_COUNT && cell->bodies > 0; ++k)
        cell->scene[k] = mote_allocate(frames, sizeof *cell->scene[k]);
}

/* Which column of the file holds each column and count that is read; false when one is missing.
 */
typedef struct column_map {
    int column[COLUMNS_MAX]; /* file column -> our index, -1: not read */
    size_t count;
} column_map;

static int find_column(const char *name, size_t length)
{
    for (int k = 0; k < COLUMN_COUNTS; ++k) {
        if (strlen(column_names[k]) == length && memcmp(column_names[k], name, length) == 0)
            return k;
    }
    for (int k = 0; k < MOTE_STORED_COUNTS; ++k) {
        const char *count = mote_stored_count_names[k];
        if (strlen(count) == length && memcmp(count, name, length) == 0)
            return COLUMN_COUNTS + k;
    }
    for (int k = 0; k < MOTE_SCENE_COLUMN_COUNT; ++k) {
        const char *column = mote_scene_column_names[k];
        if (strlen(column) == length && memcmp(column, name, length) == 0)
            return COLUMN_COUNTS + MOTE_STORED_COUNTS + k;
    }
    return -1;
}

static bool map_columns(const char *header, column_map *map)
{
    unsigned found = 0;
    map->count = 0;
    for (const char *name = header;; ++name) {
        size_t length = strcspn(name, ",\n");
        if (map->count == COLUMNS_MAX)
            return false;
        int index = find_column(name, length);
        map->column[map->count++] = index;
        if (index >= 0 && index < COLUMN_COUNTS)
            found |= 1u << index;
        name += length;
        if (*name != ',')
            break;
    }
    return found == (1u << COLUMN_COUNTS) - 1;
}

/* Puts the value of one field, MOTE_NONE when empty, where it belongs. */
static void put_value(mote_stored_cell *cell, size_t row, int index, double value)
{
    bool none = value != value;
    switch (index) {
    case COLUMN_FRAME:
        cell->frame[row] = value >= 1 && value <= FRAME_LAST ? (uint32_t)value : 0;
        return;
    case COLUMN_DEFORM:
        cell->deform_ns[row] = none ? 0 : value;
        return;
    case COLUMN_UPDATE:
        cell->update_ns[row] = none ? 0 : value;
        return;
    case COLUMN_QUERY:
        cell->query_ns[row] = none ? 0 : value;
        return;
    case COLUMN_TRUTH:
        cell->truth[row] = value;
        return;
    case COLUMN_ERROR:
        cell->error[row] = value;
        return;
    case COLUMN_CONTACT:
        cell->contact[row] = none ? -1 : value > 0;
        return;
    case COLUMN_CONTACT_TRUTH:
        cell->contact_truth[row] = none ? -1 : value > 0;
        return;
    default:
        break;
    }
    if (index >= COLUMN_COUNTS + MOTE_STORED_COUNTS) {
        double *column = cell->scene[index - COLUMN_COUNTS - MOTE_STORED_COUNTS];
        if (column)
            column[row] = none ? 0 : value;
        return;
    }
    mote_stored_count *count = &cell->counts[index - COLUMN_COUNTS];
    if (!none) {
        count->sum += value;
        count->max = value > count->max ? value : count->max;
    }
}

/* Reads one line into a row; NULL when it is not one. */
static const char *read_row(const char *line, const column_map *map, mote_stored_cell *cell,
                            size_t row)
{
    for (size_t k = 0; k < map->count; ++k) {
        char *end;
        double value = MOTE_NONE;
        if (*line != ',' && *line != '\n') {
            value = strtod(line, &end);
            if (end == line || value - value != 0)
                return NULL;
            line = end;
        }
        if (*line != (k + 1 < map->count ? ',' : '\n'))
            return NULL;
        ++line;
        if (map->column[k] >= 0)
            put_value(cell, row, map->column[k], value);
    }
    cell->total_ns[row] = cell->deform_ns[row] + cell->update_ns[row] + cell->query_ns[row];
    return line;
}

static mote_status read_frames(const char *path, const char *text, mote_stored_cell *cell)
{
    column_map map;
    size_t lines = 0;
    for (const char *p = text; *p; ++p)
        lines += *p == '\n' ? 1 : 0;
    if (lines == 0 || !map_columns(text, &map))
        return mote_fail(MOTE_EINVAL, "%s:1: not the header of a cell that mote wrote", path);
    make_arrays(cell, lines - 1);
    const char *line = strchr(text, '\n') + 1;
    for (size_t row = 0; row + 1 < lines; ++row) {
        line = read_row(line, &map, cell, row);
        if (!line || cell->frame[row] <= (row > 0 ? cell->frame[row - 1] : 0))
            return mote_fail(MOTE_EINVAL, "%s:%zu: not a frame's row; expected %zu fields",
                             path, row + 2, map.count);
        cell->frames = row + 1;
    }
    return MOTE_OK;
}

/* A key that is equal for the replicates of one configuration, and sorts by scenario, caches
   and method. */
static char *group_name(const mote_stored_cell *cell)
{
    char *parameters = json_dumps(cell->parameters, JSON_COMPACT | JSON_SORT_KEYS);
    char *frames = json_dumps(json_object_get(cell->json, "frames"), JSON_COMPACT);
    char *group =
        mote_format("%s %s %s %s %s %s %s %.17g stride %u seed %" PRIu64 " on %s%s%s",
                    cell->scenario, cell->cache, cell->method, parameters, cell->fingerprint,
                    frames, cell->ask, mote_stored_number(cell, "tolerance"), cell->stride,
                    cell->seed, cell->machine, cell->jobs > 1 ? " jobs" : "",
                    json_is_true(json_object_get(cell->json, "fixed_seed")) ? " fixed" : "");
    free(parameters);
    free(frames);
    return group;
}

static bool read_status(const char *text, mote_cell_status *status)
{
    for (int k = 0; k < MOTE_CELL_STATUSES; ++k) {
        if (strcmp(text, mote_cell_status_names[k]) == 0) {
            *status = (mote_cell_status)k;
            return true;
        }
    }
    return false;
}

/* Bytes are whole numbers, null where they were not counted. */
static bool has_bytes_right(const json_t *cell)
{
    static const char *const keys[] = {"heap_live_bytes", "heap_peak_bytes", "deform_bytes",
                                       "rss_peak_bytes"};
    for (size_t k = 0; k < sizeof keys / sizeof keys[0]; ++k) {
        const json_t *bytes = json_object_get(cell, keys[k]);
        const json_int_t count = json_integer_value(bytes);
        if (bytes && !json_is_null(bytes) &&
            (!json_is_integer(bytes) || count < 0 || count > BYTES_MAX))
            return false;
    }
    return true;
}

static uint32_t frame_number(const json_t *value)
{
    const json_int_t number = json_integer_value(value);
    return number >= 1 && number <= UINT32_MAX ? (uint32_t)number : 0;
}

/* Fills the fields that lie in cell->json. */
static mote_status read_fields(const char *name, mote_stored_cell *cell)
{
    const char *status;
    json_int_t seed;
    int replicate, stride, first, last, jobs = 1, fixed = 0;
    json_t *shown[3]; /* that are only there for a summary's row */
    if (json_unpack(cell->json,
                    "{s:s, s:s, s:s, s:s, s:s, s:s, s:o, s:i, s:i, s:[i,i], s?i, s:I, s?b, "
                    "s:o, s:o, s:o}",
                    "id", &cell->id, "status", &status, "scenario", &cell->scenario,
                    "fingerprint", &cell->fingerprint, "method", &cell->method, "cache",
                    &cell->cache, "parameters", &cell->parameters, "replicate", &replicate,
                    "stride", &stride, "active", &first, &last, "jobs", &jobs, "seed", &seed,
                    "fixed_seed", &fixed, "triangles", &shown[0], "vertices", &shown[1],
                    "frames", &shown[2]) != 0 ||
        !read_status(status, &cell->status) || replicate < 1 ||
        replicate > MOTE_REPLICATES_MAX || stride < 1 || jobs < 1 || seed < 0 ||
        (uint64_t)seed > MOTE_SEED_MAX || !has_bytes_right(cell->json))
        return mote_fail(MOTE_EINVAL, "%s: a field of a cell is missing or wrong", name);
    cell->replicate = (uint32_t)replicate;
    cell->stride = (uint32_t)stride;
    cell->jobs = (uint32_t)jobs;
    cell->seed = (uint64_t)seed;
    cell->replicate_seed = mote_replicate_seed(cell->seed, fixed != 0, cell->replicate);
    cell->active_first = (uint32_t)first;
    cell->active_last = (uint32_t)last;
    cell->first = frame_number(json_array_get(shown[2], 0));
    cell->last = frame_number(json_array_get(shown[2], 1));
    const char *machine = json_string_value(json_object_get(cell->json, "machine"));
    cell->machine = machine ? machine : "";
    const char *ask = json_string_value(json_object_get(cell->json, "ask"));
    cell->ask = ask ? ask : "";
    const json_int_t bodies = json_integer_value(json_object_get(cell->json, "bodies"));
    cell->bodies = bodies > 0 && bodies <= MOTE_BODIES_MAX ? (uint32_t)bodies : 0;
    cell->group = group_name(cell);
    return MOTE_OK;
}

/* A file that was cut at the end of a line looks whole; cells of older builds do not store
   the number of rows. */
static mote_status check_rows(const char *path, const mote_stored_cell *cell)
{
    const json_t *rows = json_object_get(cell->json, "rows");
    if (!rows ||
        (json_is_integer(rows) && json_integer_value(rows) == (json_int_t)cell->frames))
        return MOTE_OK;
    return mote_fail(MOTE_EINVAL,
                     "%s: %zu whole rows, not the %lld that were measured; remove the cell and "
                     "run again",
                     path, cell->frames, (long long)json_integer_value(rows));
}

static mote_status read_csv(const char *directory, mote_stored_cell *cell)
{
    char *path = mote_format("%s/cells/%s.csv", directory, cell->id);
    char *text = NULL;
    size_t size = 0;
    mote_status status = mote_file_read(path, FILE_LIMIT, &text, &size);
    if (status == MOTE_OK)
        status = read_frames(path, text, cell);
    if (status == MOTE_OK)
        status = check_rows(path, cell);
    free(text);
    free(path);
    return status;
}

/* *wanted: measured by this program ("": any). */
static mote_status read_cell(const char *directory, const char *file, const char *program,
                             mote_stored_cell *cell, bool *wanted)
{
    char *name = mote_format("cells/%s", file);
    mote_status status = mote_record_read_json(directory, name, &cell->json);
    if (status == MOTE_OK)
        status = read_fields(name, cell);
    const size_t length = status == MOTE_OK ? strlen(cell->id) : 0;
    if (status == MOTE_OK &&
        (strncmp(file, cell->id, length) != 0 || strcmp(file + length, ".json") != 0))
        status = mote_fail(MOTE_EINVAL, "%s: its id is %s; a cell is named by its id", name,
                           cell->id);
    if (status == MOTE_OK) {
        const char *by = json_string_value(json_object_get(cell->json, "program"));
        *wanted = program[0] == '\0' || (by && strcmp(by, program) == 0);
    }
    if (status == MOTE_OK && *wanted && cell->status == MOTE_CELL_OK)
        status = read_csv(directory, cell);
    free(name);
    return status;
}

/* The program that measured last; "" without a manifest. */
static void manifest_program(const char *directory, char *program, size_t size)
{
    json_t *manifest = NULL;
    program[0] = '\0';
    if (mote_record_read_json(directory, "manifest.json", &manifest) != MOTE_OK)
        return;
    const char *text = json_string_value(json_object_get(manifest, "program"));
    if (text && strlen(text) < size)
        memcpy(program, text, strlen(text) + 1);
    json_decref(manifest);
}

static int by_number(double a, double b)
{
    if (a < b || a > b)
        return a < b ? -1 : 1;
    return (a == a) - (b == b);
}

int mote_stored_by_scene(const mote_stored_cell *a, const mote_stored_cell *b)
{
    int order = strcmp(a->scenario, b->scenario);
    if (order == 0)
        order = strcmp(b->cache, a->cache); /* hot, then evict */
    if (order == 0)
        order = strcmp(a->machine, b->machine);
    if (order == 0)
        order = strcmp(a->fingerprint, b->fingerprint);
    if (order == 0)
        order = strcmp(a->ask, b->ask);
    return order ? order
                 : by_number(mote_stored_number(a, "tolerance"),
                             mote_stored_number(b, "tolerance"));
}

int mote_stored_by_frames(const mote_stored_cell *a, const mote_stored_cell *b)
{
    const int order = (a->first > b->first) - (a->first < b->first);
    return order ? order : (a->last < b->last) - (a->last > b->last);
}

static int by_group(const void *a, const void *b)
{
    const mote_stored_cell *first = a, *second = b;
    int order = strcmp(first->group, second->group);
    if (order != 0)
        return order;
    return first->replicate < second->replicate ? -1 : first->replicate > second->replicate;
}

static bool is_cell_file(const char *name)
{
    return name[0] != '.' && mote_name_ends(name, ".json");
}

/* A file that cannot be read is an error, or, with damaged, a line there. */
static mote_status add_file(const char *directory, const char *file, const char *program,
                            mote_text *damaged, mote_stored *stored)
{
    stored->cells = mote_resize(stored->cells, stored->count + 1, sizeof *stored->cells);
    mote_stored_cell *cell = &stored->cells[stored->count];
    memset(cell, 0, sizeof *cell);
    ++stored->count;
    bool wanted = true;
    mote_status status = read_cell(directory, file, program, cell, &wanted);
    const bool left_out = damaged && status != MOTE_OK;
    if (left_out) {
        mote_text_add(damaged, "mote: %s; left out\n", mote_error_text());
        status = MOTE_OK;
    }
    if (status == MOTE_OK && (!wanted || left_out)) {
        free_cell(cell);
        --stored->count;
        stored->left_out += left_out ? 0 : 1;
    }
    return status;
}

mote_status mote_stored_read(const char *directory, mote_text *damaged, mote_stored *stored)
{
    mote_stored read = {0};
    char program[32];
    manifest_program(directory, program, sizeof program);
    char *path = mote_format("%s/cells", directory);
    DIR *folder = opendir(path);
    mote_status status = folder
                             ? MOTE_OK
                             : mote_fail(MOTE_EIO, "%s/cells: %s; name the directory of a run",
                                         directory, strerror(errno));
    for (const struct dirent *entry = folder ? readdir(folder) : NULL;
         entry && status == MOTE_OK; entry = readdir(folder)) {
        if (is_cell_file(entry->d_name))
            status = add_file(directory, entry->d_name, program, damaged, &read);
    }
    if (folder)
        (void)closedir(folder);
    free(path);
    if (status != MOTE_OK) {
        mote_stored_free(&read);
        return status;
    }
    if (read.count > 0)
        qsort(read.cells, read.count, sizeof *read.cells, by_group);
    *stored = read;
    return MOTE_OK;
}
