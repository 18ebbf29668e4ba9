#include "harness/race/history_page.h"

#include "harness/base/data.h"
#include "harness/base/escape.h"
#include "harness/base/memory.h"
#include "harness/base/record.h"
#include "harness/race/race_files.h"
#include "harness/summary/history.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define STYLE_LIMIT ((size_t)1 << 16)

/* Of a chart, in pixels. */
#define WIDE 500.0
#define HIGH 150.0
#define LEFT 46.0
#define EDGE 14.0

/* The state of a page being written. */
typedef struct page {
    mote_history history;
    mote_race_files races;
    mote_text text;
} page;

/* The position of values on a chart: a logarithmic axis around 1. */
typedef struct scale {
    size_t places; /* from left to right */
    double top;    /* the logarithm at the upper edge; its negative at the lower edge */
} scale;

static double x_of(const scale *s, size_t place)
{
    const double step = (WIDE - LEFT - 2 * EDGE) / (double)(s->places > 1 ? s->places - 1 : 1);
    return LEFT + EDGE + step * (double)place;
}

static double y_of(const scale *s, double ratio)
{
    return 0.5 * HIGH - log(ratio) / s->top * (0.5 * HIGH - EDGE);
}

/* At least 5 % in either direction, so that noise looks like noise. */
static void make_room_for(scale *s, double ratio)
{
    if (ratio > 0 && isfinite(ratio))
        s->top = fmax(s->top, 1.05 * fabs(log(ratio)));
}

static void begin_chart(mote_text *text, const scale *s)
{
    const double edge = expm1(s->top / 1.05);
    const double lines[] = {1, 1 + edge, 1 / (1 + edge)};
    mote_text_add(text, "<figure><svg viewBox=\"0 0 %g %g\" width=\"%g\" height=\"%g\">\n",
                  WIDE, HIGH, WIDE, HIGH);
    for (size_t i = 0; i < sizeof lines / sizeof lines[0]; ++i) {
        const double y = y_of(s, lines[i]);
        mote_text_add(text,
                      "<line class=\"grid\" x1=\"%g\" y1=\"%.1f\" x2=\"%g\" y2=\"%.1f\"/>"
                      "<text x=\"0\" y=\"%.1f\">%.3g</text>\n",
                      LEFT, y, WIDE, y, y + 4, lines[i]);
    }
}

static void end_chart(mote_text *text, const char *caption)
{
    mote_text_add(text, "</svg><figcaption>%s</figcaption></figure>\n", caption);
}

/* The accepted references of a row; every point links to its line of the table. */
static void add_references(page *p, const mote_history_point *start)
{
    scale s = {.places = p->history.references, .top = log(1.05)};
    mote_text *text = &p->text, path = {.data = NULL};
    for (size_t i = 0; i < p->history.count; ++i) {
        const mote_history_point *here = &p->history.points[i];
        if (mote_history_same_series(here, start))
            make_room_for(&s, here->relative_time);
    }
    begin_chart(text, &s);
    for (size_t i = 0; i < p->history.count; ++i) {
        const mote_history_point *here = &p->history.points[i];
        if (mote_history_same_series(here, start))
            mote_text_add(&path, " %.1f,%.1f", x_of(&s, here->reference),
                          y_of(&s, here->relative_time));
    }
    mote_text_add(text, "<polyline class=\"path\" points=\"%s\"/>\n", path.data + 1);
    free(path.data);
    for (size_t i = 0; i < p->history.count; ++i) {
        const mote_history_point *here = &p->history.points[i];
        if (!mote_history_same_series(here, start))
            continue;
        mote_text_add(text,
                      "<a href=\"#reference-%u\"><circle class=\"point%s\" cx=\"%.1f\" "
                      "cy=\"%.1f\" r=\"%d\"><title>%.4g times the first%s, ",
                      here->reference + 1, here->changed ? " changed" : "",
                      x_of(&s, here->reference), y_of(&s, here->relative_time),
                      here->changed ? 6 : 4, here->relative_time,
                      here->changed ? ", a change point" : "");
        mote_escape_html(text, here->commit[0] ? here->commit : "no commit");
        mote_text_add(text, ": ");
        mote_escape_html(text, here->why);
        mote_text_add(text, "</title></circle></a>\n");
    }
    end_chart(text, start->relative ? "accepted references: time against fcl-aabb, relative to "
                                      "the first; large points are change points"
                                    : "accepted references: time relative to the first; large "
                                      "points are change points");
}

/* The races of a row: time of B divided by that of A, with its interval. */
static void add_races(page *p, const char *key)
{
    scale s = {.places = p->races.count, .top = log(1.05)};
    mote_text *text = &p->text;
    for (size_t i = 0; i < p->races.count; ++i) {
        const mote_race_point here = mote_race_files_point(&p->races, i, key);
        make_room_for(&s, here.ratio);
        make_room_for(&s, here.interval.low);
        make_room_for(&s, here.interval.high);
    }
    begin_chart(text, &s);
    for (size_t i = 0; i < p->races.count; ++i) {
        const mote_race_point here = mote_race_files_point(&p->races, i, key);
        const double x = x_of(&s, i);
        if (!(here.ratio > 0))
            continue;
        if (here.interval.low > 0)
            mote_text_add(text,
                          "<line class=\"whisker\" x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" "
                          "y2=\"%.1f\"/>\n",
                          x, y_of(&s, here.interval.low), x, y_of(&s, here.interval.high));
        mote_text_add(text, "<a href=\"#race-%zu\"><circle class=\"point ", i + 1);
        mote_escape_html(text, here.verdict);
        mote_text_add(text, "\" cx=\"%.1f\" cy=\"%.1f\" r=\"4\"><title>%.4g, ", x,
                      y_of(&s, here.ratio), here.ratio);
        mote_escape_html(text, here.verdict);
        mote_text_add(text, ": ");
        mote_escape_html(text, here.what);
        mote_text_add(text, "</title></circle></a>\n");
    }
    end_chart(text, "races: time of B over A, with its interval");
}

/* The name of a row, and what it was asked if that tells it from another of its name. */
static char *title_of(const page *p, const mote_race_name *row, const mote_history_point *start)
{
    char *own = mote_race_row_key(row->name, "");
    bool others = false;
    for (size_t i = 0; i < p->races.name_count; ++i) {
        char *key = mote_race_row_key(p->races.names[i].name, "");
        others = others ||
                 (strcmp(key, own) == 0 && strcmp(p->races.names[i].asked, row->asked) != 0);
        free(key);
    }
    free(own);
    if (!others && start)
        return mote_history_title(&p->history, start);
    return others
               ? mote_format("%s, frames %s", row->name, row->asked[0] ? row->asked : "unknown")
               : mote_duplicate(row->name);
}

static void add_row(page *p, const mote_race_name *row, const mote_history_point *start)
{
    char *key = mote_race_row_key(row->name, row->asked), *title = title_of(p, row, start);
    mote_text_add(&p->text, "<h2>");
    mote_escape_html(&p->text, title);
    free(title);
    mote_text_add(&p->text, "</h2><div class=\"charts\">\n");
    if (start)
        add_references(p, start);
    if (mote_race_files_has(&p->races, key))
        add_races(p, key);
    mote_text_add(&p->text, "</div>\n");
    free(key);
}

/* Whether the history has a series with this key. */
static bool has_reference(const page *p, const char *key)
{
    bool found = false;
    for (size_t i = 0; !found && i < p->history.count; ++i) {
        const mote_history_point *point = &p->history.points[i];
        char *other = mote_race_row_key(point->row, point->asked);
        found = strcmp(other, key) == 0;
        free(other);
    }
    return found;
}

/* Older references and races do not say what their rows were asked: those of the one are taken
   for the same as those of the other. */
static void complete_asked(page *p)
{
    for (size_t i = 0; i < p->history.count; ++i) {
        mote_history_point *point = &p->history.points[i];
        char *key = mote_race_row_key(point->row, "");
        for (size_t k = 0; k < p->races.name_count && point->asked[0] == '\0'; ++k) {
            char *other = mote_race_row_key(p->races.names[k].name, "");
            if (strcmp(key, other) == 0)
                point->asked = p->races.names[k].asked;
            free(other);
        }
        if (point->asked[0])
            mote_race_files_complete(&p->races, point->row, point->asked);
        free(key);
    }
}

/* Adds rows of the history first, then those that occur only in races. */
static void add_rows(page *p)
{
    for (size_t i = 0; i < p->history.count; ++i) {
        const mote_history_point *start = &p->history.points[i];
        const mote_race_name row = {(char *)(uintptr_t)start->row, start->asked};
        if (mote_history_begins_series(&p->history, i))
            add_row(p, &row, start);
    }
    for (size_t i = 0; i < p->races.name_count; ++i) {
        const mote_race_name *row = &p->races.names[i];
        char *key = mote_race_row_key(row->name, row->asked);
        if (!has_reference(p, key))
            add_row(p, row, NULL);
        free(key);
    }
}

static void add_cell(mote_text *text, const char *value)
{
    mote_text_add(text, "<td>");
    mote_escape_html(text, value);
    mote_text_add(text, "</td>");
}

static void add_reference_table(page *p)
{
    mote_text *text = &p->text;
    unsigned next = 0;
    mote_text_add(text, "<h2 id=\"references\">Accepted references</h2><table>\n"
                        "<tr><th></th><th>date</th><th>commit</th><th>reason</th></tr>\n");
    for (size_t i = 0; i < p->history.count; ++i) {
        const mote_history_point *here = &p->history.points[i];
        if (here->reference < next)
            continue;
        next = here->reference + 1;
        mote_text_add(text, "<tr id=\"reference-%u\"><td>%u</td>", next, next);
        add_cell(text, here->date);
        add_cell(text, here->commit);
        add_cell(text, here->why);
        mote_text_add(text, "</tr>\n");
    }
    mote_text_add(text, "</table>\n");
}

static void add_race_table(page *p)
{
    mote_text *text = &p->text;
    mote_text_add(text, "<h2 id=\"races\">Races</h2><table>\n<tr><th></th><th>date</th><th>A"
                        "</th><th>B</th><th>verdict</th><th>what changed</th></tr>\n");
    for (size_t i = 0; i < p->races.count; ++i) {
        const json_t *race = p->races.races[i].json;
        mote_text_add(text, "<tr id=\"race-%zu\"><td>%zu</td>", i + 1, i + 1);
        add_cell(text, json_string_value(json_object_get(race, "date")));
        add_cell(text, json_string_value(json_object_get(race, "a")));
        add_cell(text, json_string_value(json_object_get(race, "b")));
        add_cell(text, json_string_value(json_object_get(race, "verdict")));
        mote_text_add(text, "<td>");
        char *changes = mote_race_files_changes(&p->races, i);
        mote_escape_html(text, changes);
        free(changes);
        mote_text_add(text, "</td></tr>\n");
    }
    mote_text_add(text, "</table>\n");
}

static mote_status add_page(page *p)
{
    char *style = NULL;
    size_t size;
    const mote_status status =
        mote_data_read("plots/page/history.css", STYLE_LIMIT, &style, &size);
    if (status != MOTE_OK)
        return status;
    mote_text_add(
        &p->text,
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
        "<meta name=\"viewport\" content=\"width=device-width\">\n"
        "<title>mote: history</title><style>\n%s</style></head><body>\n"
        "<h1>History</h1>\n<p>Each point leads to its commit and reason in the tables "
        "at the end; <code>git show COMMIT</code> has the change itself.</p>\n",
        style);
    free(style);
    add_rows(p);
    add_reference_table(p);
    add_race_table(p);
    mote_text_add(&p->text, "</body></html>\n");
    return MOTE_OK;
}

mote_status mote_history_page(const char *file, const char *races, const char *target)
{
    page p = {.text = {.data = NULL}};
    mote_status status = mote_history_read(file, &p.history);
    if (status == MOTE_OK)
        status = mote_race_files_read(races, &p.races);
    if (status == MOTE_OK && p.history.count == 0 && p.races.count == 0)
        status = mote_fail(MOTE_EINVAL, "%s: nothing to draw; accept a reference first", file);
    complete_asked(&p);
    if (status == MOTE_OK)
        status = add_page(&p);
    if (status == MOTE_OK)
        status = mote_file_write(target, p.text.data, p.text.size);
    mote_history_free(&p.history);
    mote_race_files_free(&p.races);
    free(p.text.data);
    return status;
}
