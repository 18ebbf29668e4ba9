#include "harness/study/study_bodies.h"

#include "harness/run/bodies_run.h"
#include "harness/figure/figures.h"
#include "harness/base/record.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Rows at most: scenes times ways to ask. */
#define ROWS_MAX 256
#define WAYS_MAX 16

/* Letters: every body a W, or four shapes in turn. */
typedef struct scene {
    const char *density; /* near pairs a body */
    uint32_t count;
    uint32_t steps[2]; /* of every way to ask: in full, quick */
    bool four;
} scene;

static const scene scenes[] = {
    {"0.1", 10, {200, 60}, false}, {"1", 10, {200, 30}, false}, {"4", 10, {200, 15}, false},
    {"0.1", 100, {60, 12}, false}, {"1", 100, {60, 8}, false},  {"4", 100, {60, 4}, false},
    {"0.1", 1000, {12, 4}, false}, {"1", 1000, {8, 3}, false},  {"4", 1000, {8, 2}, false},
    {"0.1", 10000, {12, 4}, true}, {"1", 10000, {12, 4}, true}, {"4", 10000, {12, 3}, true}};

/* The first control: FCL's manager, every body refitted. */
#define FIRST_CONTROL "fcl-aabb:refit=every"

static const char *const every_way[] = {"certified", FIRST_CONTROL,  "fcl-aabb",
                                        "aabb-tree", "particle:n=8", "particle-paper:n=5"};
static const char *const own_ways[] = {"certified"};
static const char *const threaded[] = {"certified:ahead=3", "certified:threads=2",
                                       "certified:threads=2,ahead=3"};

/* What must hold. */
#define LEAST_RATIO 20.0
#define MOST_BYTES ((int64_t)1 << 30)

typedef struct study {
    const char *directory;
    bool quick;
    mote_bodies_row rows[ROWS_MAX];
    const scene *scene_of[ROWS_MAX];
    size_t count;
} study;

static void add_shape(mote_text *text, char letter, unsigned triangles, unsigned seed)
{
    mote_text_add(
        text,
        "%s\n      {\"letter\": \"%c\", \"triangles\": %u, \"field\": {\"count\": 14, "
        "\"support\": 0.5,\n       \"displacement\": {\"random\": {\"seed\": %u, "
        "\"amplitude\": 0.05, \"periods\": [250, 600]}}}}",
        seed > 1 ? "," : "", letter, triangles, seed);
}

/* Writes a scene's scenario; *path is to be freed. */
static mote_status write_scene(const study *s, const scene *of, char **path)
{
    mote_text text = {0};
    mote_text_add(&text,
                  "{\"purpose\": \"Several bodies: %u letters, %s near pairs each.\", "
                  "\"frames\": 200, \"ask\": \"distance\",\n  \"bodies\": {\"count\": %u, "
                  "\"near_pairs\": %s, \"near\": 0.1, \"speed\": 0.004, \"spin\": 0.5,\n"
                  "    \"shapes\": [",
                  of->count, of->density, of->count, of->density);
    add_shape(&text, 'W', 11920, 1);
    if (of->four) {
        add_shape(&text, 'T', 1380, 2);
        add_shape(&text, 'M', 2968, 3);
        add_shape(&text, 'V', 1764, 4);
    }
    mote_text_add(&text, "]}}\n");
    char *name = mote_format("scenarios/%s-%u-%s.json", of->four ? "letters" : "w", of->count,
                             of->density);
    *path = name ? mote_format("%s/%s", s->directory, name) : NULL;
    mote_status status = *path ? mote_record_text(s->directory, name, &text)
                               : mote_fail(MOTE_ENOMEM, "no memory for a scenario");
    free(name);
    free(text.data);
    return status;
}

static mote_status read_ways(const char *const *texts, size_t count, mote_bodies_choice *ways,
                             size_t *total)
{
    mote_status status = MOTE_OK;
    for (size_t i = 0; i < count && status == MOTE_OK; ++i)
        status = mote_bodies_choice_read(texts[i], &ways[(*total)++]);
    return status;
}

static mote_status measure_scene(study *s, const scene *of)
{
    mote_bodies_choice ways[WAYS_MAX];
    size_t total = 0;
    char *path = NULL;
    mote_bodies *bodies = NULL;
    mote_status status =
        of->four ? read_ways(own_ways, 1, ways, &total) : read_ways(every_way, 6, ways, &total);
    if (status == MOTE_OK && of->count >= 100)
        status = read_ways(threaded, 3, ways, &total);
    if (status == MOTE_OK)
        status = write_scene(s, of, &path);
    if (status == MOTE_OK)
        status = mote_bodies_load(path, &bodies);
    const mote_bodies_options options = {
        .first = 1, .last = of->steps[s->quick], .timeout = 1800};
    if (status == MOTE_OK)
        status = mote_bodies_run_scenario(bodies, ways, total, 1, &options, s->rows + s->count);
    for (size_t k = 0; k < total && status == MOTE_OK; ++k)
        s->scene_of[s->count++] = of;
    mote_bodies_destroy(bodies);
    free(path);
    return status;
}

/* The row of a way in the same scene; NULL: none that ran. */
static const mote_bodies_row *find(const study *s, const scene *of, const char *method)
{
    for (size_t k = 0; k < s->count; ++k) {
        if (s->scene_of[k] == of && s->rows[k].ok && strcmp(s->rows[k].method, method) == 0)
            return &s->rows[k];
    }
    return NULL;
}

/* Adds a requirement to the list and prints it. */
static void require(json_t *list, const char *name, double measured, double wanted, bool met,
                    bool *all)
{
    (void)printf("%s: %.4g, wanted %.4g: %s\n", name, measured, wanted,
                 met ? "met" : "NOT MET");
    (void)json_array_append_new(list, json_pack("{s:s, s:o, s:f, s:b}", "name", name,
                                                "measured", mote_json_number(measured),
                                                "wanted", wanted, "met", met));
    *all = *all && met;
}

static json_t *requirements(const study *s, bool *met)
{
    json_t *list = json_array();
    size_t differing = 0, failed = 0, unlike = 0;
    int64_t bytes = 0;
    const mote_bodies_row *row = find(s, &scenes[6], "certified");
    const double ratio = row ? row->ratio : (double)NAN;
    for (size_t k = 0; k < s->count; ++k) {
        row = &s->rows[k];
        failed += !row->ok;
        differing += row->exact ? row->missed + row->false_contacts : 0;
        unlike += row->exact && row->ok && row->reference[0] == '\0';
        if (s->scene_of[k]->four && row->rss_peak_bytes > bytes)
            bytes = row->rss_peak_bytes;
    }
    *met = true;
    require(list,
            "1,000 W of 11,920 triangles, 0.1 near pairs a body: time of a step of the first "
            "control over that of certified, at least",
            ratio, LEAST_RATIO, ratio >= LEAST_RATIO, met);
    require(list, "contacts that an exact method has and another one has not, at most",
            (double)differing, 0, differing == 0 && unlike == 0, met);
    require(list, "10,000 letters of 4 shapes: bytes of the process, below", (double)bytes,
            (double)MOST_BYTES, bytes > 0 && bytes < MOST_BYTES, met);
    require(list, "cells that failed, at most", (double)failed, 0, failed == 0, met);
    return list;
}

/* What threads bring: the time of a whole step, motion included, in one thread over theirs. */
static json_t *gains(const study *s)
{
    json_t *list = json_array();
    (void)printf("\n%-8s %10s  %-30s %12s %12s %6s\n", "bodies", "near pairs", "threads",
                 "one, us", "these, us", "gain");
    for (size_t k = 0; k < s->count; ++k) {
        const mote_bodies_row *row = &s->rows[k], *one = find(s, s->scene_of[k], "certified");
        if (!row->ok || !one || (row->threads == 1 && row->ahead == 0))
            continue;
        const double gain = one->wall_ns / row->wall_ns;
        (void)printf("%-8u %10s  %-30s %12.1f %12.1f %6.2f\n", row->bodies,
                     s->scene_of[k]->density, row->method, one->wall_ns / 1e3,
                     row->wall_ns / 1e3, gain);
        (void)json_array_append_new(
            list, json_pack("{s:i, s:f, s:s, s:f, s:f, s:f}", "bodies", (int)row->bodies,
                            "near_pairs", row->density, "method", row->method, "one_ns",
                            one->wall_ns, "wall_ns", row->wall_ns, "gain", gain));
    }
    return list;
}

static mote_status write_csv(const study *s)
{
    mote_text text = {0};
    mote_text_add(
        &text,
        "scenario,method,bodies,near_pairs_a_body,steps,step_mean_ns,step_ns,step_p95_ns,"
        "bounds_ns,deform_ns,update_ns,broad_ns,query_ns,motion_ns,wall_ns,"
        "heap_live_bytes,heap_peak_bytes,rss_peak_bytes,contacts,missed,"
        "false_contacts,ratio,status\n");
    for (size_t k = 0; k < s->count; ++k) {
        const mote_bodies_row *r = &s->rows[k];
        mote_text_add(&text, "%s,\"%s\",%u,", r->scenario, r->method, r->bodies);
        if (r->ok)
            mote_text_add(
                &text,
                "%.6g,%zu,%.0f,%.0f,%.0f,%.0f,%.0f,%.0f,%.0f,%.0f,%.0f,%.0f,%lld,%lld,"
                "%lld,%zu,",
                r->near_pairs, r->steps, r->step_mean_ns, r->step_ns, r->step_p95_ns,
                r->bounds_ns, r->deform_ns, r->update_ns, r->broad_ns, r->query_ns,
                r->motion_ns, r->wall_ns, (long long)r->heap_live_bytes,
                (long long)r->heap_peak_bytes, (long long)r->rss_peak_bytes, r->contacts);
        else
            mote_text_add(&text, ",,,,,,,,,,,,,,,,");
        if (r->ok && r->reference[0])
            mote_text_add(&text, "%zu,%zu,", r->missed, r->false_contacts);
        else
            mote_text_add(&text, ",,");
        if (r->ok && !isnan(r->ratio))
            mote_text_add(&text, "%.6g", r->ratio);
        mote_text_add(&text, ",%s\n", mote_cell_status_names[r->status]);
    }
    return mote_record_text(s->directory, "bodies.csv", &text);
}

static mote_status report(const study *s, bool *met)
{
    mote_bodies_rows_print(s->rows, s->count, stdout);
    json_t *gained = gains(s);
    (void)printf("\n");
    json_t *required = requirements(s, met);
    json_t *root = mote_bodies_rows_json(s->rows, s->count);
    (void)json_object_set_new(root, "profile", json_string(s->quick ? "quick" : "full"));
    (void)json_object_set_new(root, "gains", gained);
    (void)json_object_set_new(root, "requirements", required);
    (void)json_object_set_new(root, "met", json_boolean(*met));
    mote_status status = mote_record_json(s->directory, "bodies.json", root);
    return status == MOTE_OK ? write_csv(s) : status;
}

mote_status mote_study_bodies(const char *directory, bool quick, bool *met)
{
    study *s = calloc(1, sizeof *s);
    char *folder = mote_format("%s/scenarios", directory);
    size_t drawn;
    mote_status status = s && folder ? mote_directory_make(folder)
                                     : mote_fail(MOTE_ENOMEM, "no memory for a study");
    free(folder);
    if (s) {
        s->directory = directory;
        s->quick = quick;
    }
    for (size_t k = 0; k < sizeof scenes / sizeof scenes[0] && status == MOTE_OK; ++k)
        status = measure_scene(s, &scenes[k]);
    if (status == MOTE_OK)
        status = report(s, met);
    if (status == MOTE_OK)
        status = mote_figures_draw(directory, &drawn);
    free(s);
    return status;
}
