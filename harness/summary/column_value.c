/* The value of a column in a row: as a number, as a text, in JSON and back. */
#include "harness/summary/column.h"

#include "harness/base/memory.h"
#include "harness/base/record.h"

#include <string.h>

static const void *member(const mote_column *column, const mote_summary_row *row)
{
    return (const char *)row + column->offset;
}

static uint64_t count_of(const mote_column *column, const mote_summary_row *row)
{
    uint32_t narrow = 0;
    uint64_t wide = 0;
    if (column->size == sizeof narrow)
        memcpy(&narrow, member(column, row), sizeof narrow);
    else
        memcpy(&wide, member(column, row), sizeof wide);
    return narrow + wide;
}

static double real_of(const mote_column *column, const mote_summary_row *row)
{
    double value;
    memcpy(&value, member(column, row), sizeof value);
    return value;
}

static bool flag_of(const mote_column *column, const mote_summary_row *row)
{
    bool flag;
    memcpy(&flag, member(column, row), sizeof flag);
    return flag;
}

double mote_column_number(const mote_column *column, const mote_summary_row *row)
{
    switch (column->type) {
    case MOTE_COLUMN_REAL:
    case MOTE_COLUMN_WHOLE:
        return real_of(column, row);
    case MOTE_COLUMN_COUNT:
        return (double)count_of(column, row);
    case MOTE_COLUMN_FLAG:
        return flag_of(column, row);
    default:
        return MOTE_NONE;
    }
}

const char *mote_column_text(const mote_column *column, const mote_summary_row *row)
{
    const char *text = NULL;
    const mote_summary_row *other = NULL;
    if (column->type == MOTE_COLUMN_TEXT)
        memcpy(&text, member(column, row), sizeof text);
    if (column->type == MOTE_COLUMN_ROW)
        memcpy(&other, member(column, row), sizeof(const mote_summary_row *));
    text = other ? other->label : text;
    return text ? text : "";
}

static json_t *counts_json(const uint32_t *counts, size_t size)
{
    json_t *list = json_array();
    for (size_t k = 0; k < size; ++k)
        (void)json_array_append_new(list, json_integer((json_int_t)counts[k]));
    return list;
}

static json_t *numbers_json(const double *numbers, size_t size)
{
    json_t *list = json_array();
    for (size_t k = 0; k < size; ++k)
        (void)json_array_append_new(list, mote_json_number(numbers[k]));
    return list;
}

/* Mean and largest of each count over the frames of all replicates. */
static json_t *counters_json(const mote_summary_row *row)
{
    json_t *object = json_object();
    for (size_t k = 0; k < row->count_count; ++k)
        (void)json_object_set_new(
            object, row->counts[k].name,
            json_pack("{s:f, s:f}", "mean", row->counts[k].mean, "max", row->counts[k].max));
    return object;
}

/* The data for comparisons with another run. */
static json_t *processes_json(const mote_summary_row *row)
{
    json_t *list = json_array();
    for (size_t p = 0; p < row->process_count; ++p) {
        const mote_process *process = &row->processes[p];
        json_t *counts = json_object();
        for (size_t k = 0; k < row->count_count; ++k)
            (void)json_object_set_new(counts, row->counts[k].name, json_real(process->sums[k]));
        (void)json_array_append_new(
            list, json_pack("{s:i, s:o, s:o, s:o}", "replicate", (int)process->replicate,
                            "median_ns", mote_json_number(process->median), "ratio",
                            mote_json_number(process->ratio), "counters", counts));
    }
    return list;
}

json_t *mote_column_write(const mote_column *column, const mote_summary_row *row)
{
    const char *text = mote_column_text(column, row);
    const double number = mote_column_number(column, row);
    json_t *object;
    switch (column->type) {
    case MOTE_COLUMN_TEXT:
    case MOTE_COLUMN_ROW:
        return text[0] ? json_string(text) : NULL;
    case MOTE_COLUMN_REAL:
        return number == number ? mote_json_number(number) : NULL;
    case MOTE_COLUMN_WHOLE:
        return number == number ? json_integer((json_int_t)number) : NULL;
    case MOTE_COLUMN_COUNT:
        return number == 0 && column->optional
                   ? NULL
                   : json_integer((json_int_t)count_of(column, row));
    case MOTE_COLUMN_FLAG:
        return json_boolean(flag_of(column, row));
    case MOTE_COLUMN_COUNTS:
        return counts_json(member(column, row), column->size / sizeof(uint32_t));
    case MOTE_COLUMN_NUMBERS:
        return numbers_json(member(column, row), column->size / sizeof(double));
    case MOTE_COLUMN_COUNTERS:
        return counters_json(row);
    case MOTE_COLUMN_PROCESSES:
        return processes_json(row);
    default:
        memcpy(&object, member(column, row), sizeof(json_t *));
        return json_incref(object);
    }
}

/* A whole number that fits into this many bytes, otherwise 0. */
static uint64_t count_in(const json_t *value, size_t size)
{
    const json_int_t count = json_integer_value(value);
    const bool fits = count >= 0 && (size > sizeof(uint32_t) || count <= UINT32_MAX);
    return fits ? (uint64_t)count : 0;
}

/* The count with that name, added if it is new. */
static mote_row_count *count_named(mote_summary_row *row, const char *name)
{
    for (size_t k = 0; k < row->count_count; ++k) {
        if (strcmp(row->counts[k].name, name) == 0)
            return &row->counts[k];
    }
    row->counts = mote_resize(row->counts, row->count_count + 1, sizeof *row->counts);
    row->counts[row->count_count] = (mote_row_count){name, MOTE_NONE, MOTE_NONE};
    return &row->counts[row->count_count++];
}

static void read_counters(const json_t *value, mote_summary_row *row)
{
    const char *name;
    json_t *count;
    MOTE_EACH_MEMBER(name, count, (json_t *)(uintptr_t)value)
    {
        mote_row_count *to = count_named(row, name);
        to->mean = mote_number_at(count, "mean");
        to->max = mote_number_at(count, "max");
    }
}

static void read_processes(const json_t *value, mote_summary_row *row)
{
    const size_t processes = json_array_size(value);
    for (size_t p = 0; p < processes; ++p) {
        const char *name;
        const json_t *sum;
        MOTE_EACH_MEMBER(name, sum, json_object_get(json_array_get(value, p), "counters"))
        {
            (void)sum;
            (void)count_named(row, name);
        }
    }
    row->processes = mote_allocate(processes, sizeof *row->processes);
    row->sums = mote_allocate(processes * row->count_count, sizeof *row->sums);
    row->process_count = processes;
    for (size_t p = 0; p < processes; ++p) {
        const json_t *process = json_array_get(value, p);
        const json_t *counters = json_object_get(process, "counters");
        double *sums = row->sums + p * row->count_count;
        for (size_t k = 0; k < row->count_count; ++k)
            sums[k] = mote_number_at(counters, row->counts[k].name);
        row->processes[p] =
            (mote_process){.replicate = (uint32_t)count_in(
                               json_object_get(process, "replicate"), sizeof(uint32_t)),
                           .median = mote_number_at(process, "median_ns"),
                           .ratio = mote_number_at(process, "ratio"),
                           .sums = sums};
    }
}

void mote_column_read(const mote_column *column, const json_t *value, mote_summary_row *row)
{
    void *to = (char *)row + column->offset;
    const char *text = json_is_string(value) ? json_string_value(value) : "";
    const double number = mote_number_of(value);
    const uint64_t wide = count_in(value, column->size);
    const uint32_t narrow = (uint32_t)wide;
    const bool flag = !json_is_false(value);
    switch (column->type) {
    case MOTE_COLUMN_TEXT:
        memcpy(to, &text, sizeof text);
        break;
    case MOTE_COLUMN_REAL:
    case MOTE_COLUMN_WHOLE:
        memcpy(to, &number, sizeof number);
        break;
    case MOTE_COLUMN_COUNT:
        memcpy(to, column->size == sizeof narrow ? (const void *)&narrow : &wide, column->size);
        break;
    case MOTE_COLUMN_FLAG:
        memcpy(to, &flag, sizeof flag);
        break;
    case MOTE_COLUMN_ROW:
        break;
    case MOTE_COLUMN_COUNTS:
        for (size_t k = 0; k < column->size / sizeof(uint32_t); ++k)
            ((uint32_t *)to)[k] =
                (uint32_t)count_in(json_array_get(value, k), sizeof(uint32_t));
        break;
    case MOTE_COLUMN_NUMBERS:
        for (size_t k = 0; k < column->size / sizeof(double); ++k)
            ((double *)to)[k] = mote_number_of(json_array_get(value, k));
        break;
    case MOTE_COLUMN_COUNTERS:
        read_counters(value, row);
        break;
    case MOTE_COLUMN_PROCESSES:
        read_processes(value, row);
        break;
    case MOTE_COLUMN_OBJECT:
        *(const json_t **)to = value;
    }
}
