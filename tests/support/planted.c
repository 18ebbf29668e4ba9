#include "tests/support/planted.h"

#include "harness/study/dynamics.h"
#include "harness/figure/figures.h"
#include "harness/base/hash.h"
#include "harness/base/record.h"
#include "harness/run/run.h"
#include "harness/summary/summary.h"

#include "core/body/csrbf_fit.h"
#include "core/particle/particles.h"
#include "core/parts/parts.h"
#include "datasets/letter.h"
#include "harness/scene/spread.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

plants planted;

static void need(bool condition)
{
    if (!condition)
        abort();
}

static mote_status due(const char *function)
{
    return ++planted.calls == planted.failing ? mote_fail(MOTE_EIO, "planted in %s", function)
                                              : MOTE_OK;
}

/* Wraps NAME: fails when its turn has come (planted.failing), otherwise calls the real
   function. Arguments as declared and as passed. */
#define SEAM(name, declared, passed)                                                           \
    mote_status __real_##name declared;                                                        \
    mote_status __wrap_##name declared;                                                        \
    mote_status __wrap_##name declared                                                         \
    {                                                                                          \
        const mote_status status = due(#name);                                                 \
        return status == MOTE_OK ? __real_##name passed : status;                              \
    }

SEAM(mote_letter_create, (char letter, size_t count, mote_mesh **mesh), (letter, count, mesh))
SEAM(mote_spread, (const mote_mesh *mesh, uint32_t count, mote_vec3 *points),
     (mesh, count, points))
SEAM(mote_csrbf_fit_create, (const mote_field *field, mote_csrbf_fit **fit, double *condition),
     (field, fit, condition))
SEAM(mote_csrbf_fit_solve,
     (const mote_csrbf_fit *fit, const mote_vec3 *displacements, mote_vec3 *weights),
     (fit, displacements, weights))
mote_status __real_mote_record_json(const char *directory, const char *name, json_t *object);
mote_status __real_mote_record_text(const char *directory, const char *name, mote_text *text);

/* Begins a function that replaces NAME; its body follows. */
#define PLANT(name, ...)                                                                       \
    mote_status __wrap_##name(__VA_ARGS__);                                                    \
    mote_status __wrap_##name(__VA_ARGS__)

/* Takes ownership of its arguments, as the real function does. */
PLANT(mote_record_json, const char *directory, const char *name, json_t *object)
{
    const mote_status status = due("mote_record_json");
    if (status == MOTE_OK)
        return __real_mote_record_json(directory, name, object);
    json_decref(object);
    return status;
}

PLANT(mote_record_text, const char *directory, const char *name, mote_text *text)
{
    const mote_status status = due("mote_record_text");
    if (status == MOTE_OK)
        return __real_mote_record_text(directory, name, text);
    free(text->data);
    *text = (mote_text){0};
    return status;
}

PLANT(mote_figures_plot, const char *directory, const char *name, const char *script)
{
    (void)directory;
    (void)name;
    (void)script;
    return due("mote_figures_plot");
}

PLANT(mote_statistics_exponent, const double *x, const double *y, size_t count,
      double *exponent, mote_confidence *interval)
{
    need(count >= 4 && x[0] > 0 && y[0] > 0);
    for (size_t i = 1; i < count; ++i)
        need(x[i] > x[i - 1]); /* a point a size */
    *exponent = planted.exponent;
    *interval = (mote_confidence){planted.exponent - 0.01, planted.exponent + 0.01};
    return due("mote_statistics_exponent");
}

PLANT(mote_figures_draw, const char *directory, mote_figures *result)
{
    (void)directory;
    *result = (mote_figures){.drawn = 1};
    return due("mote_figures_draw");
}

/* Replaces every scene by two letters of a few hundred triangles. */
mote_status __real_mote_scenario_load(const char *name, mote_scenario **scenario);

PLANT(mote_scenario_load, const char *name, mote_scenario **scenario)
{
    mote_status status = due("mote_scenario_load");
    if (status != MOTE_OK)
        return status;
    const char *slash = strrchr(name, '/'), *digits = strrchr(name, '-');
    char *stem = mote_format("%.*s", (int)strcspn(slash ? slash + 1 : name, "."),
                             slash ? slash + 1 : name);
    char *path = mote_format("%s/%s.json", planted.folder, stem);
    const double wished = digits ? fmax(0, log10(fmax(1, strtod(digits + 1, NULL)))) : 0;
    mote_text text = {0};
    mote_text_add(
        &text,
        "{\"purpose\": \"planted\", \"frames\": 2000, \"ask\": \"distance\", "
        "\"bodies\": [{\"letter\": \"T\", \"triangles\": %d}, {\"letter\": \"T\", "
        "\"triangles\": 400, \"motion\": [{\"frame\": 1, \"position\": [2, 0, 0]}]}]}",
        400 + 10 * (int)(4 * wished));
    need(mote_file_write(path, text.data, text.size) == MOTE_OK);
    status = __real_mote_scenario_load(path, scenario); /* loads the letters */
    free(text.data);
    free(path);
    free(stem);
    return status;
}

/* Contact in 10 of 100 frames; near contact in 20. */
static double distance_at(uint32_t frame)
{
    const uint32_t k = frame % 100;
    return k < 10 ? 0 : (k < 30 ? 0.05 : 0.5);
}

PLANT(mote_truth_load_or_compute, const mote_scenario *scenario, const char *directory,
      mote_truth **truth)
{
    (void)directory;
    const mote_status status = due("mote_truth_load_or_compute");
    if (status != MOTE_OK)
        return status;
    *truth = mote_truth_allocate(scenario->frames);
    for (uint32_t k = 0; k < scenario->frames; ++k) {
        (*truth)->distance[k] = distance_at(k + 1) * scenario->length;
        (*truth)->witness_a[k] = (*truth)->witness_b[k] = mote_vec3_make(0, 0, 0);
    }
    mote_truth_set_contacts(scenario, *truth);
    return MOTE_OK;
}

PLANT(mote_measure_cell, const mote_cell *cell, size_t limit, mote_cell_result *result)
{
    (void)limit;
    const mote_status status = due("mote_measure_cell");
    if (status != MOTE_OK)
        return status;
    const double length = cell->subject->scenario->length;
    /* Times vary by a few per cent from seed to seed and method to method. */
    const uint64_t mixed = mote_hash_text(cell->choice->text) + cell->seed * 7919;
    const double waver = 1 + 0.03 * sin((double)(mixed % 1000));
    const double ns = planted.ours_ns * (planted.slowdown ? planted.slowdown(cell) : 1);
    const bool seen = planted.contact_seen && cell->seed > planted.blind;
    *result = (mote_cell_result){.rows = calloc(cell->last, sizeof *result->rows)};
    need(result->rows != NULL);
    for (uint32_t f = cell->first; f <= cell->last; f += cell->stride) {
        mote_cell_row *row = &result->rows[result->row_count++];
        row->frame = f;
        row->query_ns = (uint64_t)(ns * waver + f % 7);
        row->answer.distance = (distance_at(f) + planted.error) * length;
        row->answer.contact = seen && distance_at(f) == 0;
        row->answer.witness[0] = row->answer.witness[1] =
            mote_vec3_make(planted.error * length, 0, 0);
        row->answer.counters.steps = (uint64_t)(1000 * waver) + f % 5;
    }
    return MOTE_OK;
}

PLANT(mote_parts_create, const mote_mesh *mesh, const mote_vec3 *positions, mote_parts **parts)
{
    (void)positions;
    const mote_status status = due("mote_parts_create");
    if (status != MOTE_OK)
        return status;
    *parts = calloc(1, sizeof **parts);
    need(*parts != NULL);
    **parts = (mote_parts){.count = 3, .vertex_count = mesh->vertex_count};
    return MOTE_OK;
}

PLANT(mote_approaches_simulate, const mote_scenario *scenario, const mote_approaches_plan *plan,
      mote_approaches *sum)
{
    (void)scenario;
    const mote_status status = due("mote_approaches_simulate");
    ++planted.simulated;
    if (status == MOTE_OK)
        *sum = (mote_approaches){.trials = plan->wanted,
                                 .approaches = plan->wanted,
                                 .passes_through = strstr(plan->method, "paper")
                                                       ? planted.passes
                                                       : planted.others_pass,
                                 .steps = 100 * plan->wanted};
    return status;
}

/* A cell of several bodies that a run was asked to measure. */
typedef struct scene_cell {
    char label[256], scenario[64];
    unsigned bodies;
    double density;
    bool fails;
} scene_cell;

/* The cells of all runs of a study; from scene_first on, those since the last summary. Rows of
   summaries point to them. */
static scene_cell scene_cells[128];
static size_t scene_count, scene_first;

static void plant_scene(const mote_run_options *options, const char *label, size_t k)
{
    const char *name = strrchr(options->scenarios[0], '/') + 1; /* w-1000-0.1.json */
    if (k == 0 && strcmp(name, "w-10-0.1.json") == 0)
        scene_count = scene_first = 0; /* a new study; the one before may have failed */
    need(scene_count < sizeof scene_cells / sizeof scene_cells[0]);
    scene_cell *cell = &scene_cells[scene_count++];
    *cell = (scene_cell){.fails = planted.bodies_failed || (planted.body_failed && k == 1)};
    need(sscanf(strchr(name, '-'), "-%u-%lf", &cell->bodies, &cell->density) == 2);
    (void)snprintf(cell->label, sizeof cell->label, "%s", label);
    (void)snprintf(cell->scenario, sizeof cell->scenario, "%s", name);
}

PLANT(mote_run, const mote_run_options *options, mote_run_outcome *outcome)
{
    /* The film covers all frames and is in no table. */
    const bool scene = options->plan.contacts_only && options->plan.last > 0;
    for (size_t k = 0; scene && k < options->choices->count; ++k)
        plant_scene(options, options->choices->items[k].text, k);
    *outcome =
        (mote_run_outcome){.cells = 1, .failed = planted.body_failed ? 1 : 0, .started = true};
    return due("mote_run");
}

/* The rows for the claims about hierarchies, three replicates each. */
enum { TIMED_FRAMES = 20, REPLICATES = 3 };
static const struct {
    const char *scenario, *cache, *label, *method;
    uint32_t frames[2];
} timed[PLANTED_ROWS] = {{"ww", "hot", "particle-paper:n=5", "particle-paper", {0}},
                         {"ww", "hot", "fcl-aabb", "fcl-aabb", {0}},
                         {"ww", "hot", "fcl-aabb:queue=64,seed=previous", "fcl-aabb", {0}},
                         {"ww", "hot", "fcl-obbrss", "fcl-obbrss", {0}},
                         {"ww", "evict", "particle-paper:n=5", "particle-paper", {0}},
                         {"ww", "evict", "fcl-aabb", "fcl-aabb", {0}},
                         {"ww", "evict", "fcl-aabb:queue=64,seed=previous", "fcl-aabb", {0}},
                         {"tt", "hot", "particle-paper:n=3", "particle-paper", {0}},
                         {"tt", "hot", "fcl-aabb", "fcl-aabb", {0}},
                         {"tt", "hot", "fcl-obbrss:update=none", "fcl-obbrss", {0}},
                         {"ww", "hot", "certified", "certified", {1201, 1400}},
                         {"ww", "hot", "fcl-aabb:seed=previous", "fcl-aabb", {1201, 1400}},
                         {"mv", "hot", "certified", "certified", {301, 500}},
                         {"mv", "hot", "coal-aabb:seed=previous", "coal-aabb", {301, 500}},
                         {"tt-distance", "hot", "certified", "certified", {201, 400}},
                         {"tt-distance", "hot", "fcl-rss:update=none", "fcl-rss", {201, 400}},
                         {"ww-contact", "hot", "certified", "certified", {1201, 1400}},
                         {"ww-contact", "hot", "ode", "ode", {1201, 1400}},
                         {"mv-contact", "hot", "certified", "certified", {301, 500}},
                         {"mv-contact", "hot", "bullet-gimpact", "bullet-gimpact", {301, 500}},
                         {"tt", "hot", "certified", "certified", {201, 400}},
                         {"tt", "hot", "fcl-obb:update=none", "fcl-obb", {201, 400}}};
enum { TIMED = PLANTED_ROWS };

static void plant_cell(size_t row, size_t replicate, mote_stored_cell *cell)
{
    static uint32_t frames[TIMED_FRAMES];
    static double times[2][3][TIMED_FRAMES]; /* particles, trees; total, refit, query */
    const bool tree = mote_summary_engine_name(timed[row].method);
    for (uint32_t k = 0; k < TIMED_FRAMES; ++k) {
        frames[k] = k + 1;
        times[tree][0][k] = planted.ours_ns * (tree ? planted.trees_ratio : 1) + k;
        times[tree][1][k] = tree ? 0.9 * times[tree][0][k] : 0;
        times[tree][2][k] = times[tree][0][k] - times[tree][1][k];
    }
    *cell = (mote_stored_cell){.json = json_pack("{s:i, s:i}", "heap_live_bytes",
                                                 tree ? 1000000 : 10000, "deform_bytes", 0),
                               .scenario = timed[row].scenario,
                               .cache = timed[row].cache,
                               .status = MOTE_CELL_OK,
                               .replicate = (uint32_t)replicate + 1,
                               .active_first = 5,
                               .active_last = 15,
                               .frames = TIMED_FRAMES,
                               .frame = frames,
                               .deform_ns = times[0][1],
                               .update_ns = times[tree][1],
                               .query_ns = times[tree][2],
                               .total_ns = times[tree][0]};
}

/* Four frames of several bodies. */
static void plant_scene_row(const scene_cell *of, const mote_summary_row *first,
                            mote_stored_cell *cell, mote_summary_row *row)
{
    static double times[4] = {4e6, 1e6, 1e6, 1e6};
    const bool ours = strncmp(of->label, "particle", 8) == 0;
    const bool control = strcmp(of->label, "fcl-aabb:refit=every") == 0;
    const char *ahead = strstr(of->label, "ahead=");
    *cell = (mote_stored_cell){
        .json = json_pack("{s:f, s:f}", "near_pairs_wanted", of->density, "frames_wall_ns",
                          4e6 / (1 + (ahead ? strtod(ahead + 6, NULL) : 0))),
        .scenario = of->scenario,
        .fingerprint = "",
        .faces = "",
        .cache = "hot",
        .machine = "",
        .ask = "distance",
        .method =
            ours ? "particle" : (strncmp(of->label, "cert", 4) ? "fcl-aabb" : "certified"),
        .status = of->fails ? MOTE_CELL_CRASHED : MOTE_CELL_OK,
        .bodies = of->bodies,
        .frames = of->fails ? 0 : 4};
    for (int k = 0; k < MOTE_SCENE_COLUMN_COUNT; ++k)
        cell->scene[k] = times;
    *row = (mote_summary_row){.cells = cell,
                              .replicates = 1,
                              .finished = of->fails ? 0 : 1,
                              .failed = of->fails || planted.replicate_failed ? 1 : 0,
                              .first = cell,
                              .status = cell->status,
                              .scenario = cell->scenario,
                              .scene = (char *)(uintptr_t)of->scenario,
                              .fingerprint = cell->fingerprint,
                              .faces = cell->faces,
                              .cache = cell->cache,
                              .machine = cell->machine,
                              .ask = cell->ask,
                              .method = cell->method,
                              .ending = mote_cell_status_names[cell->status],
                              .reason = "",
                              .bodies = of->bodies,
                              .near_pairs_wanted = of->density,
                              .label = (char *)(uintptr_t)of->label,
                              .frames = cell->frames,
                              .active_total = {.mean = control ? 1e6 * planted.ratio : 1e6},
                              .contacts_of = planted.body_alone || of->fails ? NULL : first,
                              .missed = planted.body_missed && !ours ? 1 : 0,
                              .rss_peak_bytes = (double)planted.body_bytes};
}

static void plant_scene_rows(mote_summary *summary)
{
    const size_t count = scene_count - scene_first;
    *summary = (mote_summary){.rows = calloc(count, sizeof *summary->rows), .count = count};
    summary->stored.cells = calloc(count, sizeof *summary->stored.cells);
    summary->stored.count = count;
    need(summary->rows && summary->stored.cells);
    for (size_t i = 0; i < count; ++i)
        plant_scene_row(&scene_cells[scene_first + i], summary->rows, &summary->stored.cells[i],
                        &summary->rows[i]);
    scene_first = scene_count;
}

PLANT(mote_summary_write, const mote_summary *summary, const char *directory)
{
    (void)summary;
    (void)directory;
    return due("mote_summary_write");
}

PLANT(mote_summary_make, const char *directory, mote_summary *summary)
{
    (void)directory;
    const mote_status status = due("mote_summary_make");
    const bool of_scenes = scene_count > scene_first;
    if (status == MOTE_OK && of_scenes)
        plant_scene_rows(summary);
    if (status != MOTE_OK || of_scenes)
        return status;
    *summary =
        (mote_summary){.rows = calloc(TIMED, sizeof *summary->rows), .count = planted.rows};
    summary->stored.cells = calloc(TIMED * REPLICATES, sizeof *summary->stored.cells);
    summary->stored.count = (size_t)TIMED * REPLICATES;
    need(summary->rows && summary->stored.cells);
    for (size_t i = 0; i < TIMED; ++i) {
        mote_stored_cell *cells = &summary->stored.cells[i * REPLICATES];
        for (size_t r = 0; r < REPLICATES; ++r)
            plant_cell(i, r, &cells[r]);
        summary->rows[i] =
            (mote_summary_row){.cells = cells,
                               .replicates = REPLICATES,
                               .first = &cells[0],
                               .status = MOTE_CELL_OK,
                               .scenario = timed[i].scenario,
                               .cache = timed[i].cache,
                               .label = (char *)(uintptr_t)timed[i].label,
                               .method = timed[i].method,
                               .frame_range = {timed[i].frames[0], timed[i].frames[1]},
                               .fingerprint = "",
                               .faces = "",
                               .machine = "",
                               .ask = "",
                               .times_comparable = true};
    }
    return MOTE_OK;
}

void __wrap_mote_summary_free(mote_summary *summary);
void __wrap_mote_summary_free(mote_summary *summary)
{
    for (size_t i = 0; i < summary->stored.count; ++i)
        json_decref(summary->stored.cells[i].json);
    free(summary->stored.cells);
    free(summary->rows);
}

void __wrap_mote_extreme_measure(mote_extreme *e);
void __wrap_mote_extreme_measure(mote_extreme *e)
{
    for (int f = 0; f < MOTE_EXTREME_FRAMES; ++f)
        e->truth[f] = e->unrounded[f] = 0.1 * e->length;
}

PLANT(mote_extreme_set_gap, mote_extreme_recipe *recipe, uint32_t frame, double gap)
{
    recipe->place[1][frame].x += gap;
    return due("mote_extreme_set_gap");
}

PLANT(mote_extreme_run, const mote_extreme *e, const char *method, mote_extreme_cell *cell)
{
    (void)e;
    const bool ours = strcmp(method, "certified") == 0;
    *cell = (mote_extreme_cell){.verdict = ours ? planted.ours_verdict : planted.others_verdict,
                                .error = ours ? 1e-3 : 0,
                                .frame = ours ? 2 : 0};
    if (cell->verdict > MOTE_EXTREME_RIGHT)
        (void)snprintf(cell->reason, sizeof cell->reason, "planted, as %s",
                       mote_extreme_verdicts[cell->verdict]);
    return due("mote_extreme_run");
}

/* Queries come to rest in the fifth step. */
void __wrap_mote_particles_relax(mote_particles *particles, double stop_distance,
                                 mote_counters *counters);
void __wrap_mote_particles_relax(mote_particles *particles, double stop_distance,
                                 mote_counters *counters)
{
    static int step;
    (void)stop_distance;
    if (step < 4)
        counters->moves +=
            (uint64_t)llround(planted.moving * 2 * mote_particles_count(particles));
    step = (step + 1) % 5;
}

void plant_good(void)
{
    scene_count = 0;
    planted = (plants){.folder = planted.folder,
                       .exponent = 0.05,
                       .moving = 0.1,
                       .contact_seen = true,
                       .ours_ns = 1e4,
                       .trees_ratio = 1000,
                       .rows = PLANTED_ROWS,
                       .ratio = 25,
                       .body_bytes = 1 << 20,
                       .ours_verdict = MOTE_EXTREME_RIGHT,
                       .others_verdict = MOTE_EXTREME_RIGHT};
}
