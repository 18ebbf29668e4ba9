#include "harness/summary/stored.h"

#include "harness/run/cell_table.h"
#include "harness/run/plan.h"
#include "harness/base/memory.h"
#include "harness/base/record.h"
#include "harness/base/statistics.h"
#include "harness/process/manifest.h"

#include <dirent.h>
#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define FILE_LIMIT ((size_t)1 << 30)
#define BYTES_MAX (((json_int_t)1 << 62) - 1)
#define FRAME_LAST 4294967295.0

#define NAME_TEXT(name) #name,
const char *const mote_stored_count_names[MOTE_STORED_COUNTS] = {
    MOTE_COUNTERS(NAME_TEXT) MOTE_COUNTERS_MORE(NAME_TEXT) "allocations"};
#undef NAME_TEXT

/* The type of a frame's field, and the meaning of an empty one. */
typedef enum field_kind {
    FIELD_NUMBER, /* of the frame: uint32_t */
    FIELD_TIME,   /* double; empty: 0 */
    FIELD_FIGURE, /* double; empty: MOTE_NONE */
    FIELD_ANSWER  /* signed char: 1, 0; empty: -1 */
} field_kind;
static const size_t field_sizes[] = {sizeof(uint32_t), sizeof(double), sizeof(double),
                                     sizeof(signed char)};

/* The columns that every cell has, and the arrays that they are read into. */
static const struct frame_column {
    const char *name;
    size_t array; /* offset of the pointer in mote_stored_cell */
    field_kind kind;
} frame_columns[] = {
    {"frame", offsetof(mote_stored_cell, frame), FIELD_NUMBER},
    {"deform_ns", offsetof(mote_stored_cell, deform_ns), FIELD_TIME},
    {"update_ns", offsetof(mote_stored_cell, update_ns), FIELD_TIME},
    {"query_ns", offsetof(mote_stored_cell, query_ns), FIELD_TIME},
    {"truth", offsetof(mote_stored_cell, truth), FIELD_FIGURE},
    {"error", offsetof(mote_stored_cell, error), FIELD_FIGURE},
    {"contact", offsetof(mote_stored_cell, contact), FIELD_ANSWER},
    {"contact_truth", offsetof(mote_stored_cell, contact_truth), FIELD_ANSWER},
};
enum { FRAME_COLUMNS = sizeof frame_columns / sizeof frame_columns[0] };

static void *array_of(const mote_stored_cell *cell, int column)
{
    void *array;
    memcpy(&array, (const char *)cell + frame_columns[column].array, sizeof array);
    return array;
}

static void free_cell(mote_stored_cell *cell)
{
    json_decref(cell->json);
    free(cell->group);
    for (int k = 0; k < FRAME_COLUMNS; ++k)
        free(array_of(cell, k));
    free(cell->total_ns);
    for (int k = 0; k < MOTE_SCENE_COLUMN_COUNT; ++k)
        free(cell->scene[k]);
    for (int k = 0; k < MOTE_IMPACT_COLUMN_COUNT; ++k)
        free(cell->impact[k]);
}

void mote_stored_free(mote_stored *stored)
{
    for (size_t i = 0; i < stored->count; ++i)
        free_cell(&stored->cells[i]);
    free(stored->cells);
    mote_stored none = {0};
    *stored = none;
}

bool mote_stored_ran(const mote_stored_cell *cell)
{
    return cell->status == MOTE_CELL_OK && cell->frames > 0;
}

bool mote_stored_common(const mote_stored_cell *a, size_t *i, const mote_stored_cell *b,
                        size_t *k)
{
    while (*i < a->frames && *k < b->frames && a->frame[*i] != b->frame[*k]) {
        if (a->frame[*i] < b->frame[*k])
            ++*i;
        else
            ++*k;
    }
    return *i < a->frames && *k < b->frames;
}

bool mote_stored_is_of(const mote_stored_cell *cell, uint64_t fingerprint, uint64_t faces)
{
    char text[20];
    (void)snprintf(text, sizeof text, "%016" PRIx64, fingerprint);
    if (strcmp(text, cell->fingerprint) != 0)
        return false;
    (void)snprintf(text, sizeof text, "%016" PRIx64, faces);
    return cell->faces[0] == '\0' || strcmp(text, cell->faces) == 0;
}

double mote_stored_number(const mote_stored_cell *cell, const char *key)
{
    return mote_number_at(cell->json, key);
}

static void make_arrays(mote_stored_cell *cell, size_t frames)
{
    for (int k = 0; k < FRAME_COLUMNS; ++k) {
        void *array = mote_allocate(frames, field_sizes[frame_columns[k].kind]);
        memcpy((char *)cell + frame_columns[k].array, &array, sizeof array);
    }
    cell->total_ns = mote_allocate(frames, sizeof *cell->total_ns);
    for (int k = 0; k < MOTE_SCENE_COLUMN_COUNT && cell->bodies > 0; ++k)
        cell->scene[k] = mote_allocate(frames, sizeof *cell->scene[k]);
    for (int k = 0; k < MOTE_IMPACT_COLUMN_COUNT && cell->step > 0; ++k) {
        cell->impact[k] = mote_allocate(frames, sizeof *cell->impact[k]);
        for (size_t i = 0; i < frames; ++i)
            cell->impact[k][i] = MOTE_NONE; /* a cell may lack the column */
    }
}

static int find_column(const char *name, size_t length)
{
    for (int k = 0; k < FRAME_COLUMNS; ++k) {
        if (mote_cell_is_name(frame_columns[k].name, name, length))
            return k;
    }
    for (int k = 0; k < MOTE_STORED_COUNTS; ++k) {
        if (mote_cell_is_name(mote_stored_count_names[k], name, length))
            return FRAME_COLUMNS + k;
    }
    for (int k = 0; k < MOTE_SCENE_COLUMN_COUNT; ++k) {
        if (mote_cell_is_name(mote_scene_column_names[k], name, length))
            return FRAME_COLUMNS + MOTE_STORED_COUNTS + k;
    }
    for (int k = 0; k < MOTE_IMPACT_COLUMN_COUNT; ++k) {
        if (mote_cell_is_name(mote_impact_column_names[k], name, length))
            return FRAME_COLUMNS + MOTE_STORED_COUNTS + MOTE_SCENE_COLUMN_COUNT + k;
    }
    return -1;
}

/* False if a column that every cell has is missing. */
static bool map_columns(const char *header, mote_cell_columns *columns)
{
    unsigned found = 0;
    if (!mote_cell_read_header(header, find_column, columns))
        return false;
    for (size_t k = 0; k < columns->count; ++k) {
        if (columns->index[k] >= 0 && columns->index[k] < FRAME_COLUMNS)
            found |= 1u << columns->index[k];
    }
    return found == (1u << FRAME_COLUMNS) - 1;
}

static void put_field(const mote_stored_cell *cell, size_t row, int column, double value)
{
    const bool none = value != value;
    void *array = array_of(cell, column);
    switch (frame_columns[column].kind) {
    case FIELD_NUMBER:
        ((uint32_t *)array)[row] = value >= 1 && value <= FRAME_LAST ? (uint32_t)value : 0;
        break;
    case FIELD_ANSWER:
        ((signed char *)array)[row] = none ? -1 : value > 0;
        break;
    default:
        ((double *)array)[row] = none && frame_columns[column].kind == FIELD_TIME ? 0 : value;
        break;
    }
}

/* The position of a row in a cell's arrays. */
typedef struct frame_row {
    mote_stored_cell *cell;
    size_t row;
} frame_row;

/* Stores the value of one field, MOTE_NONE if empty. */
static void put_value(void *context, int index, double value)
{
    const frame_row *to = context;
    mote_stored_cell *cell = to->cell;
    const bool none = value != value;
    const int count = index - FRAME_COLUMNS, scene = count - MOTE_STORED_COUNTS;
    const int impact = scene - MOTE_SCENE_COLUMN_COUNT;
    if (index < FRAME_COLUMNS) {
        put_field(cell, to->row, index, value);
    } else if (impact >= 0) {
        if (cell->impact[impact])
            cell->impact[impact][to->row] = value;
    } else if (scene >= 0 && cell->scene[scene]) {
        cell->scene[scene][to->row] = none ? 0 : value;
    } else if (scene < 0 && !none) {
        cell->counts[count].sum += value;
        cell->counts[count].max = fmax(cell->counts[count].max, value);
    }
}

/* Reads one line into a row; NULL if it is not valid. */
static const char *read_row(const char *line, const mote_cell_columns *columns,
                            mote_stored_cell *cell, size_t row)
{
    frame_row to = {cell, row};
    line = mote_cell_read_line(line, columns, put_value, &to);
    cell->total_ns[row] = cell->deform_ns[row] + cell->update_ns[row] + cell->query_ns[row];
    return line;
}

static mote_status read_frames(const char *path, const char *text, mote_stored_cell *cell)
{
    mote_cell_columns columns;
    size_t lines = 0;
    for (const char *p = text; *p; ++p)
        lines += *p == '\n' ? 1 : 0;
    if (lines == 0 || !map_columns(text, &columns))
        return mote_fail(MOTE_EINVAL, "%s:1: not the header of a cell that mote wrote", path);
    make_arrays(cell, lines - 1);
    const char *line = strchr(text, '\n') + 1;
    for (size_t row = 0; row + 1 < lines; ++row) {
        line = read_row(line, &columns, cell, row);
        if (!line || cell->frame[row] <= (row > 0 ? cell->frame[row - 1] : 0))
            return mote_fail(MOTE_EINVAL, "%s:%zu: not a frame's row; expected %zu fields",
                             path, row + 2, columns.count);
        cell->frames = row + 1;
    }
    return MOTE_OK;
}

/* A key that is equal for the replicates of one configuration and sorts by scenario, caches and
   method. */
static char *group_name(const mote_stored_cell *cell)
{
    char *parameters = json_dumps(cell->parameters, JSON_COMPACT | JSON_SORT_KEYS);
    char *frames = json_dumps(json_object_get(cell->json, "frames"), JSON_COMPACT);
    char *group =
        mote_format("%s %s %s %s %s %s %s %s %.17g step %u stride %u seed %" PRIu64
                    " active %u-%u on %s%s%s",
                    cell->scenario, cell->cache, cell->method, parameters, cell->fingerprint,
                    cell->faces, frames, cell->ask, mote_stored_number(cell, "tolerance"),
                    cell->step, cell->stride, cell->seed, cell->active_first, cell->active_last,
                    cell->machine, cell->jobs > 1 ? " jobs" : "",
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

/* Whether bytes are whole numbers, or null if they were not counted. */
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

/* Fills in the fields that point into cell->json. */
static mote_status read_fields(const char *name, mote_stored_cell *cell)
{
    const char *status;
    json_int_t seed;
    int replicate, stride, first, last, jobs = 1, fixed = 0;
    json_t *shown[3]; /* only needed by a summary's row */
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
    cell->faces = mote_text_at(cell->json, "faces");
    cell->machine = mote_text_at(cell->json, "machine");
    cell->ask = mote_text_at(cell->json, "ask");
    cell->step = frame_number(json_object_get(cell->json, "step"));
    cell->read_ns = mote_stored_number(cell, "read_ns");
    const json_int_t bodies = json_integer_value(json_object_get(cell->json, "bodies"));
    cell->bodies = bodies > 0 && bodies <= MOTE_BODIES_MAX ? (uint32_t)bodies : 0;
    cell->group = group_name(cell);
    return MOTE_OK;
}

/* A file cut at the end of a line looks complete; cells of older builds do not store the number
   of rows. */
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

/* *wanted: whether it was measured by this program ("": any). */
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
        *wanted =
            program[0] == '\0' || strcmp(mote_text_at(cell->json, "program"), program) == 0;
    }
    if (status == MOTE_OK && *wanted && cell->status == MOTE_CELL_OK)
        status = read_csv(directory, cell);
    free(name);
    return status;
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

/* Adds a cell file. If it cannot be read, that is an error or, with damaged, a line there. */
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
    char program[MOTE_PROGRAM_SIZE];
    mote_manifest_program(directory, program);
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
