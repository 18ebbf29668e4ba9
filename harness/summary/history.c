#include "harness/summary/history.h"

#include "harness/base/options.h"
#include "harness/process/gnuplot.h"
#include "harness/base/hash.h"
#include "harness/base/memory.h"
#include "harness/base/record.h"
#include "harness/summary/column.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define FILE_LIMIT ((size_t)1 << 28)
enum { FIELD_DATE, FIELD_COMMIT, FIELD_WHY, FIELD_ROW, FIELD_TOTAL, FIELD_RATIO };

/* A change below this share does not count. */
#define CHANGE_SHARE 0.05
#define CHANGE_TIMES_USUAL 3

/* Adds a field; characters that would end it become semicolons. */
static void add_plain(mote_text *text, const char *value)
{
    for (; *value; ++value)
        mote_text_add(text, "%c", strchr(",\"\n\r", *value) ? ';' : *value);
}

/* The values of a row, with their columns; without a key, the mean of a count. */
static const struct figure {
    const char *name, *object, *key;
} figures[] = {{"total_ns", "total_ns", "median"}, {"ratio", "ratio", "value"},
               {"positions", NULL, NULL},          {"box_tests", NULL, NULL},
               {"triangle_tests", NULL, NULL},     {"heap_live_bytes", NULL, "heap_live_bytes"},
               {"error_p99", "error", "p99"}};
enum {
    FIGURES = sizeof figures / sizeof figures[0],
    FIELD_ASKED = FIELD_TOTAL + FIGURES, /* the first column that older files do not have */
    FIELDS
};

/* The columns that every history has, without the line's end. */
static void add_header(mote_text *text)
{
    mote_text_add(text, "date,commit,why,row");
    for (int i = 0; i < FIGURES; ++i)
        mote_text_add(text, ",%s", figures[i].name);
}

/* Those that were added later. */
static const char added[] = ",asked";

char *mote_history_asked(const uint32_t frames[2], const char *ask, uint32_t step,
                         double tolerance)
{
    mote_text text = {0};
    mote_text_add(&text, "%s", "");
    if (frames[0] == 0)
        return text.data;
    mote_text_add(&text, "%u-%u %s", frames[0], frames[1], ask[0] ? ask : "anything");
    if (step > 0)
        mote_text_add(&text, " step %u", step);
    if (tolerance > 0)
        mote_text_add(&text, " tolerance %.10g", tolerance);
    return text.data;
}

static double value_of(const struct figure *figure, const mote_summary_row *row)
{
    if (figure->key)
        return mote_column_number(mote_column_find(figure->object, figure->key), row);
    for (size_t k = 0; k < row->count_count; ++k) {
        if (strcmp(row->counts[k].name, figure->name) == 0)
            return row->counts[k].mean;
    }
    return MOTE_NONE;
}

/* columns: of the file, which a later version may have given more. */
static void add_row(mote_text *text, const char *date, const char *commit, const char *why,
                    const mote_summary_row *row, size_t columns)
{
    char *asked = mote_history_asked(row->frame_range, row->ask, row->step, row->tolerance);
    add_plain(text, date);
    mote_text_add(text, ",");
    add_plain(text, commit);
    mote_text_add(text, ",");
    add_plain(text, why);
    mote_text_add(text, ",");
    add_plain(text, row->scenario);
    mote_text_add(text, "/");
    add_plain(text, row->label);
    mote_text_add(text, "/%s", row->cache);
    for (int i = 0; i < FIGURES; ++i) {
        const double value = value_of(&figures[i], row);
        mote_text_add(text, ",");
        if (value == value)
            mote_text_add(text, "%.10g", value);
    }
    mote_text_add(text, ",");
    add_plain(text, asked);
    for (size_t k = FIELDS; k < columns; ++k)
        mote_text_add(text, ",");
    mote_text_add(text, "\n");
    free(asked);
}

/* *columns: how many a file has, FIELD_ASKED at least. */
static mote_status check_header(const char *file, const char *text, size_t *columns)
{
    mote_text header = {0};
    add_header(&header);
    const size_t size = header.size, more = strlen(added);
    const char *rest = strncmp(text, header.data, size) == 0 ? text + size : "";
    free(header.data);
    const bool known =
        strncmp(rest, added, more) == 0 && (rest[more] == ',' || rest[more] == '\n');
    if (rest[0] != '\n' && !known)
        return mote_fail(
            MOTE_EINVAL,
            "%s:1: not the header of a history; name a file that `mote history --add` made",
            file);
    *columns = FIELD_ASKED;
    for (; *rest != '\n' && *rest; ++rest)
        *columns += *rest == ',' ? 1 : 0;
    return MOTE_OK;
}

/* Adds the lines of a file of an older version, with the columns that it lacks. */
static void add_widened(mote_text *text, const char *data)
{
    const char *more = added;
    for (const char *line = data; *line; more = ",") {
        const size_t length = strcspn(line, "\n");
        mote_text_add(text, "%.*s%s\n", (int)length, line, more);
        line += length + (line[length] == '\n' ? 1 : 0);
    }
}

/* The history so far, with its last line terminated, or the header. */
static mote_status begin_text(const char *file, mote_text *text, size_t *columns)
{
    *columns = FIELDS;
    if (access(file, F_OK) != 0) {
        add_header(text);
        mote_text_add(text, "%s\n", added);
        return MOTE_OK;
    }
    char *data = NULL;
    size_t size = 0;
    mote_status status = mote_file_read(file, FILE_LIMIT, &data, &size);
    if (status == MOTE_OK)
        status = check_header(file, data, columns);
    if (status == MOTE_OK && *columns < FIELDS)
        add_widened(text, data);
    else if (status == MOTE_OK)
        mote_text_add(text, "%s%s", data, data[size - 1] == '\n' ? "" : "\n");
    free(data);
    return status;
}

mote_status mote_history_add(const char *file, const char *directory, const char *why)
{
    mote_summary summary;
    json_t *manifest = NULL;
    if (why[0] == '\0')
        return mote_fail(MOTE_EINVAL, "no reason; say why the reference changes");
    mote_status status = mote_record_read_json(directory, "manifest.json", &manifest);
    if (status != MOTE_OK)
        return status;
    status = mote_summary_make(directory, &summary);
    if (status == MOTE_OK) {
        const json_t *sessions = json_object_get(manifest, "sessions");
        const char *date = mote_text_at(json_array_get(sessions, 0), "started");
        mote_text text = {0};
        size_t columns = 0;
        status = begin_text(file, &text, &columns);
        for (size_t i = 0; i < summary.count; ++i) {
            if (summary.rows[i].status == MOTE_CELL_OK)
                add_row(&text, date, mote_text_at(manifest, "commit"), why, &summary.rows[i],
                        columns);
        }
        if (status == MOTE_OK)
            status = mote_file_write(file, text.data, text.size);
        free(text.data);
        mote_summary_free(&summary);
    }
    json_decref(manifest);
    return status;
}

/* Splits a line in place; false unless it has as many fields as the file has columns. A column
   that the file lacks is empty. */
static bool split(char *line, size_t columns, char *fields[FIELDS])
{
    static char none[] = "";
    size_t count = 0;
    fields[FIELD_ASKED] = none;
    for (char *field = line; field; ++count) {
        char *comma = strchr(field, ',');
        if (comma)
            *comma = '\0';
        if (count < FIELDS)
            fields[count] = field;
        field = comma ? comma + 1 : NULL;
    }
    return count == columns;
}

/* Whether a field is empty or a number. */
static bool is_number(const char *field)
{
    double number;
    return field[0] == '\0' || mote_read_real(field, -HUGE_VAL, HUGE_VAL, &number);
}

static mote_status read_points(const char *file, mote_history *p)
{
    const char *last_date = NULL;
    char *text = p->text;
    size_t number = 1, columns = 0;
    char *line = strchr(text, '\n');
    const mote_status status = check_header(file, text, &columns);
    if (status != MOTE_OK)
        return status;
    size_t lines = 0;
    for (const char *c = text; *c; ++c)
        lines += *c == '\n' ? 1 : 0;
    p->points = mote_allocate(lines + 1, sizeof *p->points);
    while (line && line[1] != '\0') {
        char *start = line + 1, *fields[FIELDS];
        ++number;
        line = strchr(start, '\n');
        if (line)
            *line = '\0';
        if (!split(start, columns, fields))
            return mote_fail(MOTE_EINVAL,
                             "%s:%zu: not a line of a history; expected %zu fields", file,
                             number, columns);
        for (int k = FIELD_TOTAL; k < FIELD_ASKED; ++k) {
            if (!is_number(fields[k]))
                return mote_fail(MOTE_EINVAL, "%s:%zu: %s: not a number; correct the line",
                                 file, number, fields[k]);
        }
        if (!last_date || strcmp(fields[FIELD_DATE], last_date) != 0)
            ++p->references;
        last_date = fields[FIELD_DATE];
        double total, ratio;
        bool has_total = mote_read_real(fields[FIELD_TOTAL], 1e-9, 1e18, &total);
        bool has_ratio = mote_read_real(fields[FIELD_RATIO], 1e-12, 1e12, &ratio);
        if (!has_total && !has_ratio)
            continue;
        p->points[p->count++] = (mote_history_point){.date = fields[FIELD_DATE],
                                                     .commit = fields[FIELD_COMMIT],
                                                     .why = fields[FIELD_WHY],
                                                     .row = fields[FIELD_ROW],
                                                     .asked = fields[FIELD_ASKED],
                                                     .time = has_ratio ? 1 / ratio : total,
                                                     .relative = has_ratio,
                                                     .reference = p->references - 1};
    }
    return MOTE_OK;
}

bool mote_history_same_series(const mote_history_point *a, const mote_history_point *b)
{
    return a->relative == b->relative && strcmp(a->row, b->row) == 0 &&
           strcmp(a->asked, b->asked) == 0;
}

char *mote_history_title(const mote_history *history, const mote_history_point *point)
{
    for (size_t i = 0; i < history->count; ++i) {
        const mote_history_point *other = &history->points[i];
        if (strcmp(other->row, point->row) == 0 && strcmp(other->asked, point->asked) != 0)
            return mote_format("%s, frames %s", point->row,
                               point->asked[0] ? point->asked : "unknown");
    }
    return mote_format("%s", point->row);
}

bool mote_history_begins_series(const mote_history *history, size_t index)
{
    for (size_t i = 0; i < index; ++i) {
        if (mote_history_same_series(&history->points[i], &history->points[index]))
            return false;
    }
    return true;
}

/* The usual change from one reference to the next in the series that begins with a point;
 *count: the number of changes. */
static double usual_move(const mote_history *h, const mote_history_point *start, size_t *count)
{
    double *moves = mote_allocate(h->count, sizeof *moves);
    double before = MOTE_NONE;
    *count = 0;
    for (size_t i = 0; i < h->count; ++i) {
        if (!mote_history_same_series(&h->points[i], start))
            continue;
        if (before == before)
            moves[(*count)++] = fabs(log(h->points[i].time / before));
        before = h->points[i].time;
    }
    const double usual = *count > 0 ? mote_statistics_median(moves, *count) : 0;
    free(moves);
    return usual;
}

/* Sets the relative times and the change points of the series that begins with a point. */
static void mark_series(mote_history *h, const mote_history_point *start)
{
    size_t count;
    const double usual = usual_move(h, start, &count);
    double before = start->time;
    for (size_t i = 0; i < h->count; ++i) {
        mote_history_point *here = &h->points[i];
        if (!mote_history_same_series(here, start))
            continue;
        const double move = fabs(log(here->time / before));
        here->relative_time = here->time / start->time;
        /* A single change is its own usual size. */
        here->changed =
            move > log(1 + CHANGE_SHARE) && (count < 3 || move > CHANGE_TIMES_USUAL * usual);
        before = here->time;
    }
}

/* What the lines of an older version were asked: the same as the next of their row. */
static void complete_asked(mote_history *h)
{
    for (size_t i = h->count; i-- > 0;) {
        for (size_t k = i + 1; k < h->count && h->points[i].asked[0] == '\0'; ++k) {
            if (strcmp(h->points[k].row, h->points[i].row) == 0)
                h->points[i].asked = h->points[k].asked;
        }
    }
}

mote_status mote_history_read(const char *file, mote_history *history)
{
    size_t size = 0;
    *history = (mote_history){.text = NULL};
    mote_status status = mote_file_read(file, FILE_LIMIT, &history->text, &size);
    if (status == MOTE_OK)
        status = read_points(file, history);
    complete_asked(history);
    for (size_t i = 0; status == MOTE_OK && i < history->count; ++i) {
        if (mote_history_begins_series(history, i))
            mark_series(history, &history->points[i]);
    }
    return status;
}

void mote_history_free(mote_history *history)
{
    free(history->points);
    free(history->text);
    *history = (mote_history){.text = NULL};
}

/* Adds the series that begins with a point, as a block "reference relative-time changed
   commit". */
static void add_series(const mote_history *h, const mote_history_point *start, mote_text *text)
{
    char *title = mote_history_title(h, start);
    mote_gnuplot_block(text, title);
    free(title);
    for (size_t i = 0; i < h->count; ++i) {
        const mote_history_point *here = &h->points[i];
        if (mote_history_same_series(here, start))
            mote_text_add(text, "%u %.10g %d %.10s\n", here->reference + 1, here->relative_time,
                          here->changed ? 1 : 0, here->commit[0] ? here->commit : "-");
    }
}

static mote_status plot(const char *base, const mote_text *series)
{
    char footer[64];
    (void)snprintf(footer, sizeof footer, "data %016" PRIx64,
                   mote_hash_bytes(MOTE_HASH_START, series->data, series->size));
    mote_status status =
        mote_gnuplot_draw(NULL, "history", base, "Accepted references", footer, "svg png");
    if (status == MOTE_OK)
        (void)printf("%s.svg\n%s.png\n", base, base);
    return status;
}

mote_status mote_history_draw(const char *file)
{
    mote_history h;
    mote_text series = {0};
    mote_status status = mote_history_read(file, &h);
    for (size_t i = 0; status == MOTE_OK && i < h.count; ++i) {
        if (mote_history_begins_series(&h, i))
            add_series(&h, &h.points[i], &series);
    }
    const size_t length = strlen(file) - (mote_name_ends(file, ".csv") ? 4 : 0);
    char *base = mote_format("%.*s", (int)length, file);
    char *data = mote_format("%.*s.dat", (int)length, file);
    if (status == MOTE_OK && series.size == 0)
        status = mote_fail(MOTE_EINVAL, "%s: nothing to draw; accept a reference first", file);
    if (status == MOTE_OK)
        status = mote_file_write(data, series.data, series.size);
    if (status == MOTE_OK)
        status = plot(base, &series);
    free(base);
    free(data);
    free(series.data);
    mote_history_free(&h);
    return status;
}
