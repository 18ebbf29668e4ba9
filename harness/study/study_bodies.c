#include "harness/study/study_bodies.h"

#include "harness/base/escape.h"
#include "harness/base/memory.h"
#include "harness/base/record.h"
#include "harness/figure/figures.h"
#include "harness/summary/column.h"
#include "harness/summary/screen.h"
#include "harness/summary/summary_json.h"
#include "harness/run/run.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A scene of letters: every body a W, or four shapes in turn. */
typedef struct scene {
    const char *density; /* near pairs per body */
    uint32_t count;
    uint32_t frames[2]; /* number measured by every method: in the full study, in the quick
                           one */
    bool four;
} scene;

static const scene scenes[] = {
    {"0.1", 10, {200, 60}, false}, {"1", 10, {200, 30}, false}, {"4", 10, {200, 15}, false},
    {"0.1", 100, {60, 12}, false}, {"1", 100, {60, 8}, false},  {"4", 100, {60, 4}, false},
    {"0.1", 1000, {12, 4}, false}, {"1", 1000, {8, 3}, false},  {"4", 1000, {8, 2}, false},
    {"0.1", 10000, {12, 4}, true}, {"1", 10000, {12, 4}, true}, {"4", 10000, {12, 3}, true}};

/* The first baseline: FCL's manager with every body refitted. */
#define FIRST_CONTROL "fcl-aabb:refit=every"

/* The first one is ours. */
static const char *const every_way[] = {"certified", FIRST_CONTROL,  "fcl-aabb",
                                        "aabb-tree", "particle:n=8", "particle-paper:n=5"};
static const char *const threaded[] = {"certified:ahead=3", "certified:threads=2",
                                       "certified:threads=2,ahead=3"};

/* Processes of each own way in the full study: their times are compared with each other. */
enum { OWN_REPLICATES = 3 };

/* Characters: crowd, in boxes of other sizes, by the exact methods, which come first in
   every_way. */
static const char *const crowd_densities[] = {"0.1", "1", "4"};
static const uint32_t crowd_frames[2] = {40, 4}; /* as in scene */
enum { CROWDS = 3, EXACT_WAYS = 4 };

/* Seconds between two progress lines off a terminal. */
#define PROGRESS_PAUSE 10

/* The shortest and the longest period of a deformation, in frames. */
#define PERIODS "250, 600"

/* Requirements. */
#define LEAST_RATIO 20.0
#define MOST_BYTES 1073741824.0

typedef struct study {
    const char *directory;
    bool quick;
    int argc; /* the command line, for the manifest */
    char **argv;
    mote_summary summary, characters;
} study;

/* periods: of the deformation, "shortest, longest", in frames. */
static void add_shape(mote_text *text, char letter, unsigned triangles, unsigned seed,
                      const char *periods)
{
    mote_text_add(
        text,
        "%s\n      {\"letter\": \"%c\", \"triangles\": %u, \"field\": {\"count\": 14, "
        "\"support\": 0.5,\n       \"displacement\": {\"random\": {\"seed\": %u, "
        "\"amplitude\": 0.05, \"periods\": [%s]}}}}",
        seed > 1 ? "," : "", letter, triangles, seed, periods);
}

/* Writes the scenario of a scene; the caller frees *path. */
static mote_status write_scene(const study *s, const scene *of, char **path)
{
    mote_text text = {0};
    mote_text_add(&text,
                  "{\"purpose\": \"Several bodies: %u letters, %s near pairs each.\", "
                  "\"frames\": 200, \"ask\": \"distance\",\n  \"bodies\": {\"count\": %u, "
                  "\"near_pairs\": %s, \"near\": 0.1, \"speed\": 0.004, \"spin\": 0.5,\n"
                  "    \"shapes\": [",
                  of->count, of->density, of->count, of->density);
    add_shape(&text, 'W', 11920, 1, PERIODS);
    if (of->four) {
        add_shape(&text, 'T', 1380, 2, PERIODS);
        add_shape(&text, 'M', 2968, 3, PERIODS);
        add_shape(&text, 'V', 1764, 4, PERIODS);
    }
    mote_text_add(&text, "]}}\n");
    char *name = mote_format("scenarios/%s-%u-%s.json", of->four ? "letters" : "w", of->count,
                             of->density);
    *path = mote_format("%s/%s", s->directory, name);
    const mote_status status = mote_record_text(s->directory, name, &text);
    free(name);
    return status;
}

static mote_status add_ways(const char *const *texts, size_t count, mote_choices *ways)
{
    mote_status status = MOTE_OK;
    for (size_t i = 0; i < count && status == MOTE_OK; ++i)
        status = mote_choices_add(ways, texts[i], NULL);
    return status;
}

/* Measures the first `last` frames (0: all) of the scenario at path into a directory, in so
   many processes a way. */
static mote_status measure(const study *s, const char *directory, const char *path,
                           const mote_choices *ways, uint32_t last, uint32_t replicates)
{
    mote_run_outcome outcome;
    const char *const scenarios[] = {path};
    const mote_run_options options = {.scenarios = scenarios,
                                      .scenario_count = 1,
                                      .choices = ways,
                                      .plan = {.replicates = replicates,
                                               .first = last ? 1 : 0,
                                               .last = last,
                                               .seed = 1,
                                               .contacts_only = true},
                                      .directory = directory,
                                      .timeout = 1800,
                                      .progress = PROGRESS_PAUSE,
                                      .argc = s->argc,
                                      .argv = s->argv};
    return mote_run(&options, &outcome);
}

static mote_status measure_scene(const study *s, const scene *of)
{
    mote_choices own = {0}, others = {0};
    char *path = NULL;
    const uint32_t frames = of->frames[s->quick];
    mote_status status = add_ways(every_way, 1, &own);
    if (status == MOTE_OK && of->count >= 100)
        status = add_ways(threaded, 3, &own);
    if (status == MOTE_OK && !of->four)
        status = add_ways(every_way + 1, 5, &others);
    if (status == MOTE_OK)
        status = write_scene(s, of, &path);
    if (status == MOTE_OK)
        status = measure(s, s->directory, path, &own, frames, s->quick ? 1 : OWN_REPLICATES);
    if (status == MOTE_OK && !of->four)
        status = measure(s, s->directory, path, &others, frames, 1);
    mote_choices_free(&own);
    mote_choices_free(&others);
    free(path);
    return status;
}

/* Measures the built-in scenario letters, with few enough triangles for gnuplot, in a separate
   run, DIRECTORY/film: figure 15 shows which letters are in contact. */
static mote_status measure_film(const study *s)
{
    static const char letters[] = "WTMV";
    mote_text text = {0};
    mote_choices ways = {0};
    mote_text_add(&text, "{\"purpose\": \"letters with few triangles, for pictures\", "
                         "\"like\": \"letters\",\n \"bodies\": {\"shapes\": [");
    for (unsigned k = 0; letters[k]; ++k)
        add_shape(&text, letters[k], 500, k + 1, "60, 200");
    mote_text_add(&text, "]}}\n");
    char *folder = mote_format("%s/film", s->directory);
    char *path = mote_format("%s/letters.json", folder);
    mote_status status = mote_directory_make(folder);
    if (status == MOTE_OK)
        status = mote_record_text(folder, "letters.json", &text);
    if (status == MOTE_OK)
        status = add_ways(every_way, 1, &ways);
    if (status == MOTE_OK)
        status = measure(s, folder, path, &ways, 0, 1);
    mote_choices_free(&ways);
    free(text.data);
    free(folder);
    free(path);
    return status;
}

/* Measures crowds in a separate run, DIRECTORY/characters, since figures compare letters. */
static mote_status measure_characters(const study *s, const char *folder)
{
    mote_choices ways = {0};
    mote_status status = mote_directory_make(folder);
    if (status == MOTE_OK)
        status = add_ways(every_way, EXACT_WAYS, &ways);
    for (int k = 0; k < CROWDS && status == MOTE_OK; ++k) {
        mote_text text = {0};
        mote_text_add(&text,
                      "{\"purpose\": \"Several bodies: 200 bison and people, %s near pairs "
                      "each.\",\n \"like\": \"crowd\", \"bodies\": {\"near_pairs\": %s}}\n",
                      crowd_densities[k], crowd_densities[k]);
        char *name = mote_format("crowd-200-%s.json", crowd_densities[k]);
        char *path = mote_format("%s/%s", folder, name);
        status = mote_record_text(folder, name, &text);
        if (status == MOTE_OK)
            status = measure(s, folder, path, &ways, crowd_frames[s->quick], 1);
        free(name);
        free(path);
    }
    mote_choices_free(&ways);
    return status;
}

/* The scene of a row; NULL if it is of another run. */
static const scene *scene_of(const mote_summary_row *row)
{
    const double wanted = mote_stored_number(row->first, "near_pairs_wanted");
    for (size_t k = 0; k < sizeof scenes / sizeof scenes[0]; ++k) {
        if (row->bodies == scenes[k].count &&
            fabs(wanted - strtod(scenes[k].density, NULL)) < 1e-9)
            return &scenes[k];
    }
    return NULL;
}

/* The row of a method in a scene; NULL if none ran. */
static const mote_summary_row *find(const study *s, const scene *of, const char *label)
{
    for (size_t k = 0; k < s->summary.count; ++k) {
        const mote_summary_row *row = &s->summary.rows[k];
        if (row->finished > 0 && scene_of(row) == of && strcmp(row->label, label) == 0)
            return row;
    }
    return NULL;
}

/* The mean over all frames but the first, in which all pairs are new. */
static double mean_of(const mote_summary_row *row)
{
    return row->active_total.mean;
}

/* The wall time per frame, including motion: the median over processes. */
static double wall_of(const mote_summary_row *row)
{
    double walls[OWN_REPLICATES];
    size_t count = 0;
    for (size_t r = 0; r < row->replicates && count < OWN_REPLICATES; ++r) {
        if (row->cells[r].status == MOTE_CELL_OK)
            walls[count++] = mote_stored_number(&row->cells[r], "frames_wall_ns");
    }
    return mote_statistics_median(walls, count) / (double)row->frames;
}

static bool is_exact(const mote_summary_row *row)
{
    return strncmp(row->method, "particle", strlen("particle")) != 0;
}

/* Adds a requirement to the list and prints it. */
static void require(json_t *list, const char *name, double measured, double wanted, bool met,
                    bool *all)
{
    (void)printf("%s: %.4g, required %.4g: %s\n", name, measured, wanted,
                 met ? "met" : "NOT MET");
    (void)json_array_append_new(list, json_pack("{s:s, s:o, s:f, s:b}", "name", name,
                                                "measured", mote_json_number(measured),
                                                "wanted", wanted, "met", met));
    *all = *all && met;
}

/* What is wrong with the rows of a run. */
typedef struct faults {
    size_t failed, unlike; /* cells; exact rows without one to compare with */
    double differing;      /* contacts of exact methods */
} faults;

static void add_faults(const mote_summary *summary, faults *found)
{
    for (size_t k = 0; k < summary->count; ++k) {
        const mote_summary_row *row = &summary->rows[k];
        found->failed += row->failed;
        if (row->finished > 0 && is_exact(row) && !row->contacts_of)
            ++found->unlike;
        else if (row->finished > 0 && is_exact(row))
            found->differing += row->missed + row->false_contacts;
    }
}

static json_t *requirements(const study *s, bool *met)
{
    json_t *list = json_array();
    faults found = {0};
    double bytes = 0;
    const mote_summary_row *certified = find(s, &scenes[6], "certified");
    const mote_summary_row *control = find(s, &scenes[6], FIRST_CONTROL);
    const double ratio =
        certified && control ? mean_of(control) / mean_of(certified) : (double)NAN;
    for (size_t k = 0; k < s->summary.count; ++k) {
        const mote_summary_row *row = &s->summary.rows[k];
        const scene *of = scene_of(row);
        if (of && of->four)
            bytes = fmax(bytes, row->rss_peak_bytes);
    }
    add_faults(&s->summary, &found);
    add_faults(&s->characters, &found);
    *met = true;
    require(list,
            "1,000 W of 11,920 triangles, 0.1 near pairs a body: time of a frame of the first "
            "control over that of certified, at least",
            ratio, LEAST_RATIO, ratio >= LEAST_RATIO, met);
    require(list, "contacts that an exact method has and another one has not, at most",
            found.differing, 0, !(found.differing > 0) && found.unlike == 0, met);
    require(list, "10,000 letters of 4 shapes: bytes of the process, below", bytes, MOST_BYTES,
            bytes > 0 && bytes < MOST_BYTES, met);
    require(list, "cells that failed, at most", (double)found.failed, 0, found.failed == 0,
            met);
    return list;
}

/* The speedup by threads: the time of a whole frame, including motion, with one thread divided
   by that with several. */
static json_t *gains(const study *s)
{
    json_t *list = json_array();
    (void)printf("\n%-8s %10s  %-30s %12s %12s %6s\n", "bodies", "near pairs", "threads",
                 "one, us", "these, us", "gain");
    for (size_t k = 0; k < s->summary.count; ++k) {
        const mote_summary_row *row = &s->summary.rows[k];
        const scene *of = scene_of(row);
        const mote_summary_row *one = of ? find(s, of, "certified") : NULL;
        if (row->finished == 0 || !one || one == row || strcmp(row->method, "certified") != 0)
            continue;
        const double gain = wall_of(one) / wall_of(row);
        (void)printf("%-8u %10s  %-30s %12.1f %12.1f %6.2f\n", row->bodies, of->density,
                     row->label, wall_of(one) / 1e3, wall_of(row) / 1e3, gain);
        (void)json_array_append_new(
            list, json_pack("{s:i, s:f, s:s, s:f, s:f, s:f}", "bodies", (int)row->bodies,
                            "near_pairs", strtod(of->density, NULL), "method", row->label,
                            "one_ns", wall_of(one), "wall_ns", wall_of(row), "gain", gain));
    }
    return list;
}

/* The median of a column of a row's first cell, over all frames but the first. */
static double cell_median(const mote_summary_row *row, int column)
{
    const mote_stored_cell *cell = row->first;
    double *values = mote_allocate(cell->frames, sizeof *values);
    size_t count = 0;
    for (size_t k = cell->frames > 1 ? 1 : 0; k < cell->frames; ++k)
        values[count++] = cell->scene[column][k];
    const double median = mote_statistics_median(values, count);
    free(values);
    return median;
}

static double bounds_of(const mote_summary_row *row)
{
    return cell_median(row, MOTE_SCENE_COLUMN_bounds_ns);
}

static double broad_of(const mote_summary_row *row)
{
    return cell_median(row, MOTE_SCENE_COLUMN_broad_ns);
}

static double motion_of(const mote_summary_row *row)
{
    return cell_median(row, MOTE_SCENE_COLUMN_motion_ns);
}

static double near_pairs_of(const mote_summary_row *row)
{
    return row->near_pairs / row->bodies;
}

/* The time of the row that a row's contacts are compared with, divided by the row's own. */
static double ratio_of(const mote_summary_row *row)
{
    return row->contacts_of ? mean_of(row->contacts_of) / mean_of(row) : MOTE_NONE;
}

/* The values in bodies.csv: columns of the summary, or values of this study. */
static const struct csv_figure {
    const char *name, *object, *key;
    double (*own)(const mote_summary_row *row);
} csv_figures[] = {{"near_pairs_a_body", .own = near_pairs_of},
                   {"steps", NULL, "frames", NULL},
                   {"step_mean_ns", "active_total_ns", "mean", NULL},
                   {"step_ns", "active_total_ns", "median", NULL},
                   {"step_p95_ns", "active_total_ns", "p95", NULL},
                   {"bounds_ns", .own = bounds_of},
                   {"deform_ns", "deform_ns", "median", NULL},
                   {"update_ns", "update_ns", "median", NULL},
                   {"broad_ns", .own = broad_of},
                   {"query_ns", "query_ns", "median", NULL},
                   {"motion_ns", .own = motion_of},
                   {"wall_ns", .own = wall_of},
                   {"heap_live_bytes", NULL, "heap_live_bytes", NULL},
                   {"heap_peak_bytes", NULL, "heap_peak_bytes", NULL},
                   {"rss_peak_bytes", NULL, "rss_peak_bytes", NULL},
                   {"contacts", NULL, "contacts", NULL},
                   {"missed", NULL, "missed", NULL},
                   {"false_contacts", NULL, "false_contacts", NULL},
                   {"ratio", .own = ratio_of}};
enum { CSV_FIGURES = sizeof csv_figures / sizeof csv_figures[0] };

static double value_of(const struct csv_figure *figure, const mote_summary_row *row)
{
    return figure->own ? figure->own(row)
                       : mote_column_number(mote_column_find(figure->object, figure->key), row);
}

static void add_csv_row(const mote_summary_row *row, mote_text *text)
{
    mote_escape_csv(text, row->scenario, false);
    mote_text_add(text, ",");
    mote_escape_csv(text, row->label, true);
    mote_text_add(text, ",%u", row->bodies);
    for (int k = 0; k < CSV_FIGURES; ++k) {
        mote_text_add(text, ",");
        if (row->finished > 0)
            mote_csv_number(text, value_of(&csv_figures[k], row));
    }
    mote_text_add(text, ",%s\n", row->ending);
}

static mote_status write_csv(const study *s)
{
    mote_text text = {0};
    mote_text_add(&text, "scenario,method,bodies");
    for (int k = 0; k < CSV_FIGURES; ++k)
        mote_text_add(&text, ",%s", csv_figures[k].name);
    mote_text_add(&text, ",status\n");
    for (size_t k = 0; k < s->summary.count; ++k)
        add_csv_row(&s->summary.rows[k], &text);
    return mote_record_text(s->directory, "bodies.csv", &text);
}

static mote_status report(const study *s, bool *met)
{
    mote_screen_print(&s->summary, stdout);
    mote_screen_print(&s->characters, stdout);
    json_t *gained = gains(s);
    (void)printf("\n");
    json_t *required = requirements(s, met);
    json_t *root = json_pack("{s:i, s:s, s:o, s:o, s:b}", "schema", 1, "profile",
                             s->quick ? "quick" : "full", "gains", gained, "requirements",
                             required, "met", *met);
    mote_status status = mote_record_json(s->directory, "bodies.json", root);
    if (status == MOTE_OK)
        status = mote_summary_write(&s->summary, s->directory);
    return status == MOTE_OK ? write_csv(s) : status;
}

static mote_status report_with_characters(study *s, bool *met)
{
    char *folder = mote_format("%s/characters", s->directory);
    mote_status status = measure_characters(s, folder);
    if (status == MOTE_OK)
        status = mote_summary_make(folder, &s->characters);
    if (status == MOTE_OK) {
        status = mote_summary_write(&s->characters, folder);
        if (status == MOTE_OK)
            status = report(s, met);
        mote_summary_free(&s->characters);
    }
    free(folder);
    return status;
}

mote_status mote_study_bodies(const char *directory, bool quick, int argc, char **argv,
                              bool *met)
{
    study s = {.directory = directory, .quick = quick, .argc = argc, .argv = argv};
    char *folder = mote_format("%s/scenarios", directory);
    mote_figures figures = {0};
    mote_status status = mote_directory_make(folder);
    free(folder);
    for (size_t k = 0; k < sizeof scenes / sizeof scenes[0] && status == MOTE_OK; ++k)
        status = measure_scene(&s, &scenes[k]);
    if (status == MOTE_OK)
        status = measure_film(&s);
    if (status == MOTE_OK)
        status = mote_summary_make(directory, &s.summary);
    if (status == MOTE_OK) {
        status = report_with_characters(&s, met);
        mote_summary_free(&s.summary);
    }
    if (status == MOTE_OK)
        status = mote_figures_draw(directory, &figures);
    if (figures.notices.data)
        (void)fputs(figures.notices.data, stderr);
    mote_figures_free(&figures);
    return status;
}
