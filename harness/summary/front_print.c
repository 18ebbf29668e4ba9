#include "harness/summary/front.h"
#include "harness/base/escape.h"
#include "harness/base/memory.h"
#include "harness/base/record.h"
#include "harness/summary/column.h"
#include "harness/summary/dominance.h"

#include <stdlib.h>
#include <string.h>

static const mote_summary_row *row_of(const mote_fronts *fronts, size_t family)
{
    return &fronts->summary->rows[fronts->items[family].first];
}

static void print_ratio(const mote_front_ratio *ratio, FILE *out)
{
    char text[64] = "-";
    if (ratio->interval.low == ratio->interval.low)
        (void)snprintf(text, sizeof text, "%.3g [%.3g, %.3g]", ratio->faster,
                       ratio->interval.low, ratio->interval.high);
    else if (ratio->faster == ratio->faster)
        (void)snprintf(text, sizeof text, "%.3g", ratio->faster);
    (void)fprintf(out, " %22s", text);
}

/* Prints what distinguishes this block from others of the same scenario and caches. */
static void print_apart(const mote_summary *summary, const mote_summary_row *row, FILE *out)
{
    bool frames = false;
    for (size_t i = 0; i < summary->count; ++i)
        frames = frames || (mote_summary_by_scene(&summary->rows[i], row) == 0 &&
                            mote_summary_by_frames(&summary->rows[i], row) != 0);
    const uint32_t first = row->frame_range[0];
    const uint32_t last = row->bodies > 0 && row->frames > 0 ? first + (uint32_t)row->frames - 1
                                                             : row->frame_range[1];
    if (frames)
        (void)fprintf(out, ", frames %u-%u", first, last);
    if (mote_summary_machines_differ(summary))
        (void)fprintf(out, ", on %s", row->machine);
}

/* Whether a rival of a kind stands in the block of a family. */
static bool has_rival(const mote_fronts *fronts, size_t first, mote_rival rival)
{
    for (size_t i = first;
         i < fronts->count && mote_summary_same_block(row_of(fronts, first), row_of(fronts, i));
         ++i) {
        if (fronts->items[i].speed[MOTE_FRONT_LEVELS - 1].to[rival].rival != SIZE_MAX)
            return true;
    }
    return false;
}

/* Whether the best engine is an FCL for every family of a block, at every level. */
static bool same_rivals(const mote_fronts *fronts, size_t first)
{
    for (size_t i = first;
         i < fronts->count && mote_summary_same_block(row_of(fronts, first), row_of(fronts, i));
         ++i) {
        for (size_t k = 0; k < MOTE_FRONT_LEVELS; ++k) {
            const mote_front_ratio *to = fronts->items[i].speed[k].to;
            if (to[MOTE_RIVAL_FCL].rival != to[MOTE_RIVAL_ENGINE].rival)
                return false;
        }
    }
    return true;
}

/* The line that names the rivals of a family, once if they are the same at every level. */
static void print_rivals(const mote_fronts *fronts, size_t family, mote_rival rival, FILE *out)
{
    const mote_front_speed *speed = fronts->items[family].speed;
    size_t last = 0;
    for (size_t k = 1; k < MOTE_FRONT_LEVELS; ++k)
        last =
            speed[k].to[rival].rival == speed[0].to[rival].rival ? last : MOTE_FRONT_LEVELS - 1;
    (void)fprintf(out, "than%s:", last > 0 ? ", level by level" : "");
    for (size_t k = 0; k <= last; ++k) {
        const size_t row = speed[k].to[rival].rival;
        (void)fprintf(out, "%s %s", k ? "," : "",
                      row == SIZE_MAX ? "-" : fronts->summary->rows[row].label);
    }
    (void)fprintf(out, "\n");
}

static void print_place(const mote_fronts *fronts, size_t first, mote_rival rival, int width,
                        FILE *out)
{
    static const char *const names[MOTE_RIVALS] = {
        [MOTE_RIVAL_FCL] = "best FCL", [MOTE_RIVAL_ENGINE] = "best engine of others"};
    const mote_summary_row *place = row_of(fronts, first);
    (void)fprintf(out, "\n%s, caches %s", place->scene, place->cache);
    print_apart(fronts->summary, place, out);
    (void)fprintf(out,
                  ": how many times faster than the %s at an error (99th percentile) of at "
                  "most\n%-*s %22s",
                  names[rival], width, "", "exact");
    for (size_t k = 1; k < MOTE_FRONT_LEVELS; ++k)
        (void)fprintf(out, " %20g L", mote_front_levels[k]);
    (void)fprintf(out, "\n");
    size_t named = first;
    for (size_t i = first;
         i < fronts->count && mote_summary_same_block(place, row_of(fronts, i)); ++i) {
        if (row_of(fronts, named)->given && !row_of(fronts, i)->given)
            named = i;
        (void)fprintf(out, "%-*s", width, fronts->items[i].title);
        for (size_t k = 0; k < MOTE_FRONT_LEVELS; ++k)
            print_ratio(&fronts->items[i].speed[k].to[rival], out);
        (void)fprintf(out, "\n");
    }
    /* With positions given, rivals may be others; those are in speed.csv. */
    print_rivals(fronts, named, rival, out);
}

static int by_time(const void *a, const void *b)
{
    const mote_summary_row *const *first = a, *const *second = b;
    const double x = (*first)->total.median, y = (*second)->total.median;
    return (x > y) - (x < y);
}

/* Lists the rows of one accounting on the front of a block, fastest first. */
static void print_members(const mote_fronts *fronts, const mote_summary_row *block, bool given,
                          FILE *out)
{
    const mote_summary *summary = fronts->summary;
    const mote_summary_row **members =
        mote_allocate(summary->count, sizeof(const mote_summary_row *));
    size_t count = 0;
    for (size_t i = 0; i < summary->count; ++i) {
        const mote_summary_row *row = &summary->rows[i];
        if (mote_summary_same_block(block, row) && row->on_front && row->given == given)
            members[count++] = row;
    }
    if (count > 0) {
        qsort(members, count, sizeof(const mote_summary_row *), by_time);
        (void)fprintf(out, "front of time against error%s:", given ? ", positions given" : "");
        for (size_t i = 0; i < count; ++i)
            (void)fprintf(out, "%s %s", i ? "," : "", members[i]->label);
        (void)fprintf(out, "\n");
    }
    free(members);
}

void mote_fronts_print(const mote_fronts *fronts, FILE *out)
{
    int width = 6;
    for (size_t i = 0; i < fronts->count; ++i) {
        int length = (int)strlen(fronts->items[i].title);
        width = length > width ? length : width;
    }
    for (size_t i = 0; i < fronts->count; ++i) {
        if (i > 0 && mote_summary_same_block(row_of(fronts, i - 1), row_of(fronts, i)))
            continue;
        const bool engine = has_rival(fronts, i, MOTE_RIVAL_ENGINE);
        if (engine)
            print_place(fronts, i, MOTE_RIVAL_ENGINE, width, out);
        if (has_rival(fronts, i, MOTE_RIVAL_FCL) && !(engine && same_rivals(fronts, i)))
            print_place(fronts, i, MOTE_RIVAL_FCL, width, out);
        print_members(fronts, row_of(fronts, i), false, out);
        print_members(fronts, row_of(fronts, i), true, out);
    }
}

/* The label of a ratio's rival, or "". */
static const char *rival_label(const mote_fronts *fronts, const mote_front_ratio *ratio)
{
    return ratio->rival == SIZE_MAX ? "" : fronts->summary->rows[ratio->rival].label;
}

static json_t *speeds_json(const mote_fronts *fronts, const mote_front *front)
{
    json_t *list = json_array();
    for (size_t k = 0; k < MOTE_FRONT_LEVELS; ++k) {
        const mote_front_speed *speed = &front->speed[k];
        const mote_front_ratio *fcl = &speed->to[MOTE_RIVAL_FCL];
        const mote_front_ratio *engine = &speed->to[MOTE_RIVAL_ENGINE];
        (void)json_array_append_new(
            list, json_pack("{s:f, s:o, s:o, s:o, s:o, s:s, s:o, s:o, s:o}", "error",
                            mote_front_levels[k], "total_ns", mote_json_number(speed->time_ns),
                            "faster", mote_json_number(fcl->faster), "ci_low",
                            mote_json_number(fcl->interval.low), "ci_high",
                            mote_json_number(fcl->interval.high), "engine",
                            rival_label(fronts, engine), "engine_faster",
                            mote_json_number(engine->faster), "engine_ci_low",
                            mote_json_number(engine->interval.low), "engine_ci_high",
                            mote_json_number(engine->interval.high)));
    }
    return list;
}

json_t *mote_fronts_json(const mote_fronts *fronts)
{
    json_t *list = json_array();
    for (size_t i = 0; i < fronts->count; ++i) {
        const mote_summary_row *row = row_of(fronts, i);
        json_t *front =
            json_pack("{s:s, s:s, s:s, s:s, s:s, s:s, s:o}", "scenario", row->scenario,
                      "fingerprint", row->fingerprint, "faces", row->faces, "cache", row->cache,
                      "accounting", row->accounting, "family", fronts->items[i].title, "speed",
                      speeds_json(fronts, &fronts->items[i]));
        (void)json_array_append_new(list, front);
    }
    return list;
}

/* "scenario,cache,family" */
static void add_family(const mote_summary_row *row, const char *title, mote_text *text)
{
    mote_escape_csv(text, row->scenario, false);
    mote_text_add(text, ",");
    mote_escape_csv(text, row->cache, false);
    mote_text_add(text, ",");
    mote_escape_csv(text, title, true);
}

static void add_numbers(const double *numbers, size_t count, mote_text *text)
{
    for (size_t i = 0; i < count; ++i) {
        mote_text_add(text, ",");
        mote_csv_number(text, numbers[i]);
    }
}

/* The numbers of fronts.csv, with their columns. */
static const struct number {
    const char *name, *object, *key;
} row_numbers[] = {{"n", NULL, "n"},
                   {"error_p99", "error", "p99"},
                   {"total_ns", "total_ns", "median"},
                   {"total_ci_low", "total_ns", "ci_low"},
                   {"total_ci_high", "total_ns", "ci_high"}};
enum { ROW_NUMBERS = sizeof row_numbers / sizeof row_numbers[0] };

static void add_row(const mote_summary_row *row, mote_text *text)
{
    double numbers[ROW_NUMBERS];
    char title[MOTE_FRONT_TITLE];
    if (!mote_front_has(row))
        return;
    mote_front_title(row, title, sizeof title);
    add_family(row, title, text);
    mote_text_add(text, ",");
    mote_escape_csv(text, row->label, true);
    for (int k = 0; k < ROW_NUMBERS; ++k)
        numbers[k] = mote_column_number(
            mote_column_find(row_numbers[k].object, row_numbers[k].key), row);
    add_numbers(numbers, ROW_NUMBERS, text);
    mote_text_add(text, ",");
    mote_escape_csv(text, row->dominated_by ? row->dominated_by->label : "", true);
    mote_text_add(text, ",%d,%s,%s\n", row->on_front, row->fingerprint, row->faces);
}

static void add_speed(const mote_fronts *fronts, size_t index, size_t level, mote_text *text)
{
    const mote_summary_row *row = row_of(fronts, index);
    const mote_front_speed *speed = &fronts->items[index].speed[level];
    const mote_front_ratio *fcl = &speed->to[MOTE_RIVAL_FCL];
    const mote_front_ratio *engine = &speed->to[MOTE_RIVAL_ENGINE];
    const double numbers[] = {speed->time_ns, fcl->faster, fcl->interval.low,
                              fcl->interval.high};
    const double others[] = {engine->faster, engine->interval.low, engine->interval.high};
    add_family(row, fronts->items[index].title, text);
    mote_text_add(text, ",%g", mote_front_levels[level]);
    add_numbers(numbers, sizeof numbers / sizeof numbers[0], text);
    mote_text_add(text, ",%s,", row->fingerprint);
    mote_escape_csv(text, rival_label(fronts, engine), true);
    add_numbers(others, sizeof others / sizeof others[0], text);
    mote_text_add(text, ",%s\n", row->faces);
}

mote_status mote_fronts_write(const mote_fronts *fronts, const char *directory)
{
    mote_text rows = {0}, speeds = {0};
    mote_text_add(&rows, "scenario,cache,family,label");
    for (int k = 0; k < ROW_NUMBERS; ++k)
        mote_text_add(&rows, ",%s", row_numbers[k].name);
    mote_text_add(&rows, ",dominated_by,on_front,fingerprint,faces\n");
    for (size_t i = 0; i < fronts->summary->count; ++i)
        add_row(&fronts->summary->rows[i], &rows);
    mote_text_add(&speeds, "scenario,cache,family,error,total_ns,faster,ci_low,ci_high,"
                           "fingerprint,engine,engine_faster,engine_ci_low,engine_ci_high,"
                           "faces\n");
    for (size_t i = 0; i < fronts->count; ++i) {
        for (size_t k = 0; k < MOTE_FRONT_LEVELS; ++k)
            add_speed(fronts, i, k, &speeds);
    }
    mote_status status = mote_record_text(directory, "fronts.csv", &rows);
    mote_status second = mote_record_text(directory, "speed.csv", &speeds);
    return status == MOTE_OK ? second : status;
}
