#include "harness/report/replay.h"

#include "harness/base/memory.h"
#include "harness/report/report_rows.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Whether an argument of a command may be the scenario file NAME.json, or a pair of meshes. */
static bool may_name(const char *word, const char *name)
{
    char *file = mote_format("%s.json", name);
    size_t length = strlen(word), size = strlen(file);
    bool ends = length >= size && strcmp(word + length - size, file) == 0 &&
                (length == size || word[length - size - 1] == '/');
    free(file);
    return ends || strncmp(word, MOTE_PAIR_PREFIX, strlen(MOTE_PAIR_PREFIX)) == 0;
}

/* The value of --direction in a command, or NULL. */
static const char *direction_of(const json_t *words)
{
    static const char option[] = "--direction";
    for (size_t k = 0; k < json_array_size(words); ++k) {
        const char *word = json_string_value(json_array_get(words, k));
        if (!word || strncmp(word, option, sizeof option - 1) != 0)
            continue;
        if (word[sizeof option - 1] == '=')
            return word + sizeof option;
        if (word[sizeof option - 1] == '\0')
            return json_string_value(json_array_get(words, k + 1));
    }
    return NULL;
}

/* The scenario that word k of a command names, as accepted by mote_scenario_load, or NULL; the
   caller frees it. `--pair A B` names one without a file. */
static char *named_by(const json_t *words, size_t k, const char *name)
{
    const char *word = json_string_value(json_array_get(words, k));
    const char *a = json_string_value(json_array_get(words, k + 1));
    const char *b = json_string_value(json_array_get(words, k + 2));
    if (word && a && b && strcmp(word, "--pair") == 0)
        return mote_scenario_pair_name(a, b, direction_of(words));
    return word && may_name(word, name) ? mote_format("%s", word) : NULL;
}

/* Whether a scenario is the one that a cell measured. */
static bool is_measured(const mote_scenario *scenario, const mote_stored_cell *cell)
{
    uint64_t fingerprint = 0;
    for (int i = 0; i < 2; ++i) {
        if (scenario->body[i].mesh->vertex_count > MOTE_REPLAY_VERTICES)
            return false;
    }
    return mote_scenario_fingerprint(scenario, &fingerprint) == MOTE_OK &&
           mote_stored_is_of(cell, fingerprint, mote_scenario_faces(scenario));
}

/* Whether the file that a word names is the scenario of a cell; stores it if so. */
static bool try_word(const char *word, const mote_stored_cell *cell, mote_scenario **scenario)
{
    mote_scenario *loaded = NULL;
    if (mote_scenario_load(word, &loaded) != MOTE_OK)
        return false;
    if (is_measured(loaded, cell)) {
        *scenario = loaded;
        return true;
    }
    mote_scenario_destroy(loaded);
    return false;
}

/* Finds the scenario of a cell by its name, or among those named in the run's commands. */
static mote_status find_scenario(const mote_report *report, const mote_stored_cell *cell,
                                 mote_scenario **scenario)
{
    const json_t *sessions = json_object_get(report->manifest, "sessions");
    const json_t *vertices = json_object_get(cell->json, "vertices");
    if (json_integer_value(json_array_get(vertices, 0)) > MOTE_REPLAY_VERTICES ||
        json_integer_value(json_array_get(vertices, 1)) > MOTE_REPLAY_VERTICES)
        return mote_fail(MOTE_EUNSUPPORTED, "%s: its meshes have more than %u vertices",
                         cell->scenario, MOTE_REPLAY_VERTICES);
    if (try_word(cell->scenario, cell, scenario))
        return MOTE_OK;
    for (size_t i = 0; i < json_array_size(sessions); ++i) {
        const json_t *words = json_object_get(json_array_get(sessions, i), "command");
        for (size_t k = 0; k < json_array_size(words); ++k) {
            char *named = named_by(words, k, cell->scenario);
            const bool found = named && try_word(named, cell, scenario);
            free(named);
            if (found)
                return MOTE_OK;
        }
    }
    return mote_fail(
        MOTE_EUNSUPPORTED,
        "%s: no scenario with the fingerprint of its cells was found; it was moved "
        "or changed",
        cell->scenario);
}

/* Whether the page can show the bodies, and whether the scenario has the frames of the cells,
   whose files may be damaged. */
static mote_status check_scene(const mote_replay_scene *scene)
{
    for (int i = 0; i < 2; ++i) {
        const mote_body *body = &scene->scenario->body[i];
        if (!body->field->centre_x &&
            (size_t)body->field->count * body->mesh->vertex_count > MOTE_REPLAY_BASIS)
            return mote_fail(MOTE_EUNSUPPORTED, "%s: a field is too large for the page",
                             scene->tracks[0].cell->scenario);
    }
    if (scene->last <= scene->scenario->frames)
        return MOTE_OK;
    return mote_fail(MOTE_EUNSUPPORTED, "%s: a cell has frame %u; the scenario has frames 1-%u",
                     scene->tracks[0].cell->scenario, scene->last, scene->scenario->frames);
}

/* Whether a row is replayed: it has answers, with hot caches. */
static bool is_shown(const mote_summary_row *row)
{
    return row->status == MOTE_CELL_OK && row->first->frames > 0 &&
           strcmp(row->cache, mote_cache_names[MOTE_CACHE_HOT]) == 0 &&
           !strstr(row->label, "positions=given");
}

/* The file of the truth; older versions did not name the faces in it. */
static char *truth_path(const char *directory, const mote_replay_scene *scene,
                        uint64_t fingerprint)
{
    return scene->tracks[0].cell->faces[0]
               ? mote_truth_path(directory, scene->scenario, fingerprint)
               : mote_format("%s/truth/%s-%016" PRIx64 ".csv", directory, scene->scenario->name,
                             fingerprint);
}

/* Reads the truth from the tracks' cells, and its points from the truth's own file if that
   exists. */
static void read_truth(const mote_report *report, mote_replay_scene *scene)
{
    const size_t frames = scene->last - scene->first + 1;
    scene->truth = mote_allocate(frames, sizeof *scene->truth);
    scene->pair = mote_allocate(2 * frames, sizeof *scene->pair);
    for (size_t k = 0; k < frames; ++k) {
        scene->truth[k] = MOTE_NONE;
        scene->pair[2 * k] = scene->pair[2 * k + 1] =
            mote_vec3_make(MOTE_NONE, MOTE_NONE, MOTE_NONE);
    }
    for (size_t t = 0; t < scene->count; ++t) {
        const mote_stored_cell *cell = scene->tracks[t].cell;
        for (size_t k = 0; k < cell->frames; ++k)
            scene->truth[cell->frame[k] - scene->first] = cell->truth[k];
    }
    uint64_t fingerprint = strtoull(scene->tracks[0].cell->fingerprint, NULL, 16);
    mote_truth *truth = NULL;
    char *path = truth_path(report->directory, scene, fingerprint);
    const mote_status status = mote_truth_read(scene->scenario, fingerprint, path, &truth);
    free(path);
    if (status != MOTE_OK) {
        (void)json_array_append_new(
            scene->notes,
            json_string("the true closest points: the run's truth file is missing"));
        return;
    }
    for (size_t k = 0; k < frames; ++k) {
        scene->pair[2 * k] = truth->witness_a[k + scene->first - 1];
        scene->pair[2 * k + 1] = truth->witness_b[k + scene->first - 1];
    }
    mote_truth_destroy(truth);
}

/* Where surfaces intersect, the truth has no points, because many pairs are at distance 0. Any
   pair that a method found there will do. */
static void fill_contacts(mote_replay_scene *scene)
{
    for (size_t t = 0; t < scene->count; ++t) {
        const mote_replay_track *track = &scene->tracks[t];
        for (size_t k = 0; k < track->rows; ++k) {
            mote_vec3 *pair = scene->pair + 2 * (track->cell->frame[k] - scene->first);
            if (track->distance[k] == 0 && track->cell->truth[k] == 0 && pair->x != pair->x) {
                pair[0] = track->pair[2 * k];
                pair[1] = track->pair[2 * k + 1];
            }
        }
    }
}

/* How bad the answers of a cell are: the largest absolute error or, if the method gives no
   distance, the number of wrong contacts. */
static double badness_of(const mote_stored_cell *cell)
{
    double error = MOTE_NONE, wrong = 0;
    for (size_t k = 0; k < cell->frames; ++k) {
        const double here = fabs(cell->error[k]);
        if (here == here && !(error >= here))
            error = here;
        wrong += cell->contact[k] >= 0 && cell->contact[k] != cell->contact_truth[k];
    }
    return error == error ? error : wrong;
}

/* The replicate with the worst answers, the first one on a tie. */
static const mote_stored_cell *worst_cell(const mote_summary_row *row)
{
    const mote_stored_cell *worst = row->first;
    for (size_t r = 0; r < row->replicates; ++r) {
        const mote_stored_cell *cell = &row->cells[r];
        if (cell->status == MOTE_CELL_OK && cell->frames > 0 &&
            badness_of(cell) > badness_of(worst))
            worst = cell;
    }
    return worst;
}

static mote_status add_track(const mote_report *report, const mote_summary_row *row,
                             mote_replay_scene *scene)
{
    scene->tracks = mote_resize(scene->tracks, scene->count + 1, sizeof *scene->tracks);
    mote_replay_track *track = &scene->tracks[scene->count++];
    *track = (mote_replay_track){.row = row, .cell = worst_cell(row)};
    const uint32_t last = track->cell->frame[track->cell->frames - 1];
    if (scene->first == 0 || track->cell->frame[0] < scene->first)
        scene->first = track->cell->frame[0];
    scene->last = last > scene->last ? last : scene->last;
    return mote_replay_read_cell(report->directory, track);
}

/* Makes key frames of bodies with given positions, and a note if there are fewer than
   frames. */
static mote_status make_keys(mote_replay_scene *scene)
{
    mote_status status = MOTE_OK;
    for (int i = 0; i < 2 && status == MOTE_OK; ++i) {
        mote_replay_keys *keys = &scene->keys[i];
        const uint32_t frames = scene->last - scene->first + 1;
        status = mote_replay_keys_make(scene->scenario, i, scene->first, scene->last, keys);
        if (status != MOTE_OK || !keys->field || keys->count == frames)
            continue;
        char *note =
            mote_format("body %d is shown as it is in %u of %u frames; between these its "
                        "vertices go straight, and the answers need not lie on it",
                        i, keys->count, frames);
        (void)json_array_append_new(scene->notes, json_string(note));
        free(note);
    }
    return status;
}

mote_status mote_replay_load(const mote_report *report, size_t first, size_t end,
                             mote_replay_scene *scene)
{
    mote_replay_scene made = {.notes = json_array()};
    mote_status status = MOTE_OK;
    if (mote_report_row(report, first)->step > 0)
        status = mote_fail(MOTE_EUNSUPPORTED,
                           "%s: it asks for impacts between frames; what is shown are answers "
                           "about frames",
                           mote_report_row(report, first)->scenario);
    for (size_t i = first; i < end && status == MOTE_OK; ++i) {
        if (is_shown(mote_report_row(report, i)))
            status = add_track(report, mote_report_row(report, i), &made);
    }
    if (status == MOTE_OK && made.count == 0)
        status = mote_fail(MOTE_EUNSUPPORTED, "%s: no answers with hot caches",
                           mote_report_row(report, first)->scenario);
    if (status == MOTE_OK)
        status = find_scenario(report, made.tracks[0].cell, &made.scenario);
    if (status == MOTE_OK)
        status = check_scene(&made);
    if (status == MOTE_OK) {
        read_truth(report, &made);
        fill_contacts(&made);
    }
    if (status == MOTE_OK)
        status = make_keys(&made);
    for (size_t t = 0; t < made.count && status == MOTE_OK; ++t)
        status = mote_replay_particles(&made, &made.tracks[t]);
    if (status == MOTE_OK)
        *scene = made;
    else
        mote_replay_free(&made);
    return status;
}

void mote_replay_free(mote_replay_scene *scene)
{
    for (size_t t = 0; t < scene->count; ++t) {
        free(scene->tracks[t].distance);
        free(scene->tracks[t].pair);
        free(scene->tracks[t].place);
    }
    free(scene->tracks);
    free(scene->truth);
    free(scene->pair);
    json_decref(scene->notes);
    for (int i = 0; i < 2; ++i)
        mote_replay_keys_free(&scene->keys[i]);
    mote_scenario_destroy(scene->scenario);
}

/* Whether this is the first row of a block of hot caches. */
static bool starts_block(const mote_report *report, size_t i)
{
    const mote_summary_row *row = mote_report_row(report, i);
    return strcmp(row->cache, mote_cache_names[MOTE_CACHE_HOT]) == 0 &&
           (i == 0 || !mote_summary_same_block(row, mote_report_row(report, i - 1)));
}

/* The bytes of the page that are left, and for how many scenes. */
typedef struct share {
    size_t bytes, scenes;
} share;

/* Adds the scene of the block that begins at row first. */
static mote_status add_scene(const mote_report *report, size_t first, share *left,
                             json_t *scenes, json_t *notes)
{
    mote_replay_scene scene;
    json_t *data = NULL;
    size_t used = 0;
    mote_status status =
        mote_replay_load(report, first, mote_report_block_end(report, first), &scene);
    if (status == MOTE_OK) {
        const size_t most = MOTE_REPLAY_SCENARIO_BYTES, fair = left->bytes / left->scenes;
        status = mote_replay_write(&scene, fair < most ? fair : most, &data, &used);
        mote_replay_free(&scene);
    }
    left->bytes -= used;
    --left->scenes;
    if (status == MOTE_OK) {
        (void)json_array_append_new(scenes, data);
    } else if (status == MOTE_EUNSUPPORTED) {
        (void)json_array_append_new(notes, json_string(mote_error_text()));
        status = MOTE_OK;
    }
    return status;
}

mote_status mote_replay_json(const mote_report *report, json_t **data)
{
    json_t *scenes = json_array(), *notes = json_array();
    const size_t count = report->has_cells ? report->summary.count : 0;
    share left = {MOTE_REPLAY_PAGE_BYTES, 0};
    mote_status status = MOTE_OK;
    for (size_t i = 0; i < count; ++i)
        left.scenes += starts_block(report, i);
    for (size_t i = 0; i < count && status == MOTE_OK; ++i) {
        if (starts_block(report, i))
            status = add_scene(report, i, &left, scenes, notes);
    }
    if (status == MOTE_OK)
        *data = json_pack("{s:O, s:O}", "scenes", scenes, "notes", notes);
    json_decref(scenes);
    json_decref(notes);
    return status;
}
