#include "harness/summary/front.h"
#include "harness/base/record.h"

#include <stdlib.h>
#include <string.h>

static const mote_summary_row *row_of(const mote_fronts *fronts, size_t family)
{
    return &fronts->summary->rows[fronts->items[family].first];
}

static bool same_place(const mote_summary_row *a, const mote_summary_row *b)
{
    return mote_stored_by_scene(a->first, b->first) == 0 &&
           mote_stored_by_frames(a->first, b->first) == 0;
}

static void print_speed(const mote_front_speed *speed, FILE *out)
{
    char text[64] = "-";
    if (speed->interval.low == speed->interval.low)
        (void)snprintf(text, sizeof text, "%.3g [%.3g, %.3g]", speed->faster,
                       speed->interval.low, speed->interval.high);
    else if (speed->faster == speed->faster)
        (void)snprintf(text, sizeof text, "%.3g", speed->faster);
    (void)fprintf(out, " %22s", text);
}

/* What tells this place from another one of its scenario and caches. */
static void print_apart(const mote_summary *summary, const mote_stored_cell *cell, FILE *out)
{
    bool frames = false;
    for (size_t i = 0; i < summary->count; ++i)
        frames = frames || (mote_stored_by_scene(summary->rows[i].first, cell) == 0 &&
                            mote_stored_by_frames(summary->rows[i].first, cell) != 0);
    if (frames)
        (void)fprintf(out, ", frames %u-%u", cell->first, cell->last);
    if (mote_summary_machines_differ(summary))
        (void)fprintf(out, ", on %s", cell->machine);
}

static void print_place(const mote_fronts *fronts, size_t first, int width, FILE *out)
{
    const mote_summary_row *place = row_of(fronts, first);
    (void)fprintf(out, "\n%s, caches %s", place->first->scenario, place->first->cache);
    print_apart(fronts->summary, place->first, out);
    (void)fprintf(
        out,
        ": how many times faster than the best FCL at an error (99th percentile) of at "
        "most\n%-*s %22s",
        width, "", "exact");
    for (size_t k = 1; k < MOTE_FRONT_LEVELS; ++k)
        (void)fprintf(out, " %20g L", mote_front_levels[k]);
    (void)fprintf(out, "\n");
    for (size_t i = first; i < fronts->count && same_place(place, row_of(fronts, i)); ++i) {
        (void)fprintf(out, "%-*s", width, fronts->items[i].title);
        for (size_t k = 0; k < MOTE_FRONT_LEVELS; ++k)
            print_speed(&fronts->items[i].speed[k], out);
        (void)fprintf(out, "\n");
    }
}

/* Whom a row dominates, when it is the fastest that does. */
static void print_dominated(const mote_fronts *fronts, size_t dominator, FILE *out)
{
    const mote_summary_row *rows = fronts->summary->rows;
    bool any = false;
    for (size_t i = 0; i < fronts->summary->count; ++i) {
        if (fronts->dominator[i] != dominator)
            continue;
        (void)fprintf(out, "%s %s (%.3g times slower)", any ? "," : "", rows[i].label,
                      rows[i].total.median / rows[dominator].total.median);
        any = true;
    }
}

static void print_dominators(const mote_fronts *fronts, const mote_summary_row *place,
                             FILE *out)
{
    const mote_summary *summary = fronts->summary;
    for (size_t i = 0; i < summary->count; ++i) {
        bool dominates = false;
        for (size_t k = 0; k < summary->count && same_place(place, &summary->rows[i]); ++k)
            dominates = dominates || fronts->dominator[k] == i;
        if (!dominates)
            continue;
        (void)fprintf(out, "%s is faster, and no less exact, than:", summary->rows[i].label);
        print_dominated(fronts, i, out);
        (void)fprintf(out, "\n");
    }
}

void mote_fronts_print(const mote_fronts *fronts, FILE *out)
{
    int width = 6;
    for (size_t i = 0; i < fronts->count; ++i) {
        int length = (int)strlen(fronts->items[i].title);
        width = length > width ? length : width;
    }
    for (size_t i = 0; i < fronts->count; ++i) {
        if (i > 0 && same_place(row_of(fronts, i - 1), row_of(fronts, i)))
            continue;
        bool has_fcl = false;
        for (size_t k = i;
             k < fronts->count && same_place(row_of(fronts, i), row_of(fronts, k)); ++k)
            has_fcl = has_fcl || fronts->items[k].speed[MOTE_FRONT_LEVELS - 1].faster ==
                                     fronts->items[k].speed[MOTE_FRONT_LEVELS - 1].faster;
        if (has_fcl)
            print_place(fronts, i, width, out);
        print_dominators(fronts, row_of(fronts, i), out);
    }
}

static json_t *speeds_json(const mote_front *front)
{
    json_t *list = json_array();
    for (size_t k = 0; k < MOTE_FRONT_LEVELS; ++k) {
        const mote_front_speed *speed = &front->speed[k];
        (void)json_array_append_new(
            list, json_pack("{s:f, s:o, s:o, s:o, s:o}", "error", mote_front_levels[k],
                            "total_ns", mote_json_number(speed->time_ns), "faster",
                            mote_json_number(speed->faster), "ci_low",
                            mote_json_number(speed->interval.low), "ci_high",
                            mote_json_number(speed->interval.high)));
    }
    return list;
}

json_t *mote_fronts_json(const mote_fronts *fronts)
{
    json_t *list = json_array();
    for (size_t i = 0; list && i < fronts->count; ++i) {
        const mote_summary_row *row = row_of(fronts, i);
        json_t *front = json_pack("{s:s, s:s, s:s, s:o}", "scenario", row->first->scenario,
                                  "cache", row->first->cache, "family", fronts->items[i].title,
                                  "speed", speeds_json(&fronts->items[i]));
        if (json_array_append_new(list, front) != 0) {
            json_decref(list);
            return NULL;
        }
    }
    return list;
}

static void add_number(mote_text *text, double value)
{
    if (value == value)
        mote_text_add(text, ",%.17g", value);
    else
        mote_text_add(text, ",");
}

/* A quoted field; quotes inside are doubled. */
static void add_quoted(mote_text *text, const char *value)
{
    mote_text_add(text, "\"");
    for (; *value; ++value)
        mote_text_add(text, "%s%c", *value == '"' ? "\"" : "", *value);
    mote_text_add(text, "\"");
}

/* A field, quoted where it has to be. */
static void add_plain(mote_text *text, const char *value)
{
    if (value[strcspn(value, ",\"\n\r")])
        add_quoted(text, value);
    else
        mote_text_add(text, "%s", value);
}

static void add_row(const mote_fronts *fronts, size_t index, mote_text *text)
{
    const mote_summary_row *rows = fronts->summary->rows, *row = &rows[index];
    char title[256];
    if (row->status != MOTE_CELL_OK || row->jobs > 1 || row->error.p99 != row->error.p99)
        return;
    mote_front_title(row, title, sizeof title);
    add_plain(text, row->first->scenario);
    mote_text_add(text, ",");
    add_plain(text, row->first->cache);
    mote_text_add(text, ",");
    add_quoted(text, title);
    mote_text_add(text, ",");
    add_quoted(text, row->label);
    const double numbers[] = {row->n, row->error.p99, row->total.median, row->total.low,
                              row->total.high};
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; ++i)
        add_number(text, numbers[i]);
    size_t by = fronts->dominator[index];
    mote_text_add(text, ",");
    add_quoted(text, by == SIZE_MAX ? "" : rows[by].label);
    mote_text_add(text, "\n");
}

static void add_speed(const mote_fronts *fronts, size_t index, size_t level, mote_text *text)
{
    const mote_summary_row *row = row_of(fronts, index);
    const mote_front_speed *speed = &fronts->items[index].speed[level];
    add_plain(text, row->first->scenario);
    mote_text_add(text, ",");
    add_plain(text, row->first->cache);
    mote_text_add(text, ",");
    add_quoted(text, fronts->items[index].title);
    mote_text_add(text, ",%g", mote_front_levels[level]);
    add_number(text, speed->time_ns);
    add_number(text, speed->faster);
    add_number(text, speed->interval.low);
    add_number(text, speed->interval.high);
    mote_text_add(text, "\n");
}

mote_status mote_fronts_write(const mote_fronts *fronts, const char *directory)
{
    mote_text rows = {0}, speeds = {0};
    mote_text_add(&rows, "scenario,cache,family,label,n,error_p99,total_ns,total_ci_low,"
                         "total_ci_high,dominated_by\n");
    for (size_t i = 0; i < fronts->summary->count; ++i)
        add_row(fronts, i, &rows);
    mote_text_add(&speeds, "scenario,cache,family,error,total_ns,faster,ci_low,ci_high\n");
    for (size_t i = 0; i < fronts->count; ++i) {
        for (size_t k = 0; k < MOTE_FRONT_LEVELS; ++k)
            add_speed(fronts, i, k, &speeds);
    }
    mote_status status = mote_record_text(directory, "fronts.csv", &rows);
    mote_status second = mote_record_text(directory, "speed.csv", &speeds);
    return status == MOTE_OK ? second : status;
}
