/* A scene as JSON: small numbers as they are, arrays in base 64, lowest byte first. World
   points have 16 bits a coordinate, on a grid over all that is shown; 65535: there is no point.
 */
#include "harness/base/escape.h"
#include "harness/base/json_print.h"
#include "harness/report/replay.h"

#include "core/base/quaternion.h"

#include <math.h>
#include <stdlib.h>
#include <stdio.h>
#include <string.h>

#define GRID_MOST 65534.0
#define GRID_NONE 65535u

/* value = low + step * number */
typedef struct grid {
    mote_vec3 low;
    double step;
} grid;

static mote_status no_memory(void)
{
    return mote_fail(MOTE_ENOMEM, "no memory for a replay");
}

static void include(mote_vec3 *low, mote_vec3 *high, mote_vec3 p)
{
    if (!(p.x - p.x == 0))
        return;
    *low = mote_vec3_make(fmin(low->x, p.x), fmin(low->y, p.y), fmin(low->z, p.z));
    *high = mote_vec3_make(fmax(high->x, p.x), fmax(high->y, p.y), fmax(high->z, p.z));
}

static grid make_grid(mote_vec3 low, mote_vec3 high)
{
    const mote_vec3 size = mote_sub(high, low);
    const double most = fmax(size.x, fmax(size.y, size.z));
    grid g = {low, most > 0 ? most / GRID_MOST : 1};
    return g;
}

static grid grid_over(const mote_vec3 *points, size_t count)
{
    mote_vec3 low = {HUGE_VAL, HUGE_VAL, HUGE_VAL};
    mote_vec3 high = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    for (size_t i = 0; i < count; ++i)
        include(&low, &high, points[i]);
    return make_grid(low, high);
}

/* Over every point of the scene that is not a vertex. */
static grid scene_grid(const mote_replay_scene *scene)
{
    mote_vec3 low = {HUGE_VAL, HUGE_VAL, HUGE_VAL};
    mote_vec3 high = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    const size_t frames = scene->last - scene->first + 1;
    for (size_t k = 0; k < 2 * frames; ++k)
        include(&low, &high, scene->pair[k]);
    for (size_t t = 0; t < scene->count; ++t) {
        const mote_replay_track *track = &scene->tracks[t];
        for (size_t k = 0; k < 2 * track->rows; ++k)
            include(&low, &high, track->pair[k]);
        for (size_t k = 0; k < track->rows * 2 * track->particles; ++k)
            include(&low, &high, track->place[k]);
    }
    if (!(low.x <= high.x))
        low = high = mote_vec3_make(0, 0, 0);
    return make_grid(low, high);
}

static uint16_t place_on(double low, double step, double value)
{
    return (uint16_t)fmax(0, fmin(GRID_MOST, floor((value - low) / step + 0.5)));
}

/* "KEY": "BASE64" of points on a grid. */
static mote_status add_points(mote_text *text, const char *key, const grid *g,
                              const mote_vec3 *points, size_t count)
{
    uint16_t *places = malloc((3 * count + 1) * sizeof *places);
    if (!places)
        return no_memory();
    for (size_t i = 0; i < count; ++i) {
        const mote_vec3 p = points[i];
        uint16_t *here = places + 3 * i;
        here[0] = here[1] = here[2] = GRID_NONE;
        if (!(p.x - p.x == 0))
            continue;
        here[0] = place_on(g->low.x, g->step, p.x);
        here[1] = place_on(g->low.y, g->step, p.y);
        here[2] = place_on(g->low.z, g->step, p.z);
    }
    mote_text_add(text, "\"%s\": \"", key);
    mote_base64(text, places, 3 * count * sizeof *places);
    mote_text_add(text, "\"");
    free(places);
    return MOTE_OK;
}

static void add_bytes(mote_text *text, const char *key, const void *data, size_t size)
{
    mote_text_add(text, "\"%s\": \"", key);
    mote_base64(text, data, size);
    mote_text_add(text, "\"");
}

static void add_grid(mote_text *text, const grid *g)
{
    mote_text_add(text, "\"low\": [%.17g, %.17g, %.17g], \"step\": %.17g", g->low.x, g->low.y,
                  g->low.z, g->step);
}

/* A string of JSON that cannot end a script element. */
static void add_string(mote_text *text, const char *key, const char *value)
{
    json_t *string = json_string(value);
    char *dump = mote_json_text(string, JSON_ENCODE_ANY);
    mote_text_add(text, "\"%s\": ", key);
    if (dump)
        mote_escape_script(text, dump);
    else
        text->failed = 1;
    free(dump);
    json_decref(string);
}

/* The mesh at rest and the centres of its field. */
static mote_status add_mesh(mote_text *text, const mote_body *body)
{
    const mote_mesh *mesh = body->mesh;
    const mote_field *field = body->field;
    const grid g = grid_over(mesh->positions, mesh->vertex_count);
    uint16_t *corners = malloc(3 * (size_t)mesh->triangle_count * sizeof *corners);
    double *centres = malloc((3 * (size_t)field->count + 1) * sizeof *centres);
    mote_status status = corners && centres ? MOTE_OK : no_memory();
    if (status == MOTE_OK) {
        for (size_t t = 0; t < mesh->triangle_count; ++t) {
            for (size_t k = 0; k < 3; ++k)
                corners[3 * t + k] = (uint16_t)mesh->triangles[t][k];
        }
        for (size_t j = 0; j < field->count; ++j) {
            centres[3 * j] = field->centre_x[j];
            centres[3 * j + 1] = field->centre_y[j];
            centres[3 * j + 2] = field->centre_z[j];
        }
        add_grid(text, &g);
        mote_text_add(text, ", ");
        status = add_points(text, "vertices", &g, mesh->positions, mesh->vertex_count);
    }
    if (status == MOTE_OK) {
        mote_text_add(text, ",\n");
        add_bytes(text, "triangles", corners, 3 * mesh->triangle_count * sizeof *corners);
        mote_text_add(text, ",\n\"support\": %.17g, ", field->support);
        add_bytes(text, "centres", centres, 3 * field->count * sizeof *centres);
    }
    free(corners);
    free(centres);
    return status;
}

/* Poses as 12 floats (rows of the rotation, translation) and weights in rest axes, as signed
   16 bits of the largest. */
static mote_status add_motion(mote_text *text, const mote_replay_scene *scene, int i)
{
    const size_t frames = scene->last - scene->first + 1;
    const size_t width = 3 * (size_t)scene->scenario->body[i].field->count;
    mote_frame_buffer *buffer = NULL;
    float *poses = malloc(12 * frames * sizeof *poses);
    double *weights = malloc((width * frames + 1) * sizeof *weights);
    int16_t *shares = malloc((width * frames + 1) * sizeof *shares);
    mote_status status = poses && weights && shares ? MOTE_OK : no_memory();
    if (status == MOTE_OK)
        status = mote_frame_buffer_create(scene->scenario, &buffer);
    double most = 0;
    for (size_t k = 0; k < frames && status == MOTE_OK; ++k) {
        const mote_frame *frame =
            mote_scenario_frame(scene->scenario, buffer, scene->first + (uint32_t)k, 0);
        const mote_body_state *state = &frame->body[i];
        for (size_t c = 0; c < 9; ++c)
            poses[12 * k + c] = (float)state->pose.rotation.m[c / 3][c % 3];
        poses[12 * k + 9] = (float)state->pose.translation.x;
        poses[12 * k + 10] = (float)state->pose.translation.y;
        poses[12 * k + 11] = (float)state->pose.translation.z;
        for (size_t j = 0; j < width / 3; ++j) {
            const mote_vec3 w = mote_rotate_back(
                &state->pose.rotation,
                mote_vec3_make(state->weights.x[j], state->weights.y[j], state->weights.z[j]));
            const double part[3] = {w.x, w.y, w.z};
            for (size_t c = 0; c < 3; ++c) {
                weights[width * k + 3 * j + c] = part[c];
                most = fmax(most, fabs(part[c]));
            }
        }
    }
    if (status == MOTE_OK) {
        const double step = most > 0 ? most / 32767 : 1;
        for (size_t k = 0; k < width * frames; ++k)
            shares[k] = (int16_t)floor(weights[k] / step + 0.5);
        add_bytes(text, "poses", poses, 12 * frames * sizeof *poses);
        mote_text_add(text, ",\n\"weightStep\": %.17g, ", step);
        add_bytes(text, "weights", shares, width * frames * sizeof *shares);
    }
    mote_frame_buffer_destroy(buffer);
    free(poses);
    free(weights);
    free(shares);
    return status;
}

static mote_status add_bodies(mote_text *text, const mote_replay_scene *scene)
{
    mote_text_add(text, "\"bodies\": [");
    mote_status status = MOTE_OK;
    for (int i = 0; i < 2 && status == MOTE_OK; ++i) {
        mote_text_add(text, "%s{", i ? ",\n" : "");
        status = add_mesh(text, &scene->scenario->body[i]);
        mote_text_add(text, ",\n");
        if (status == MOTE_OK)
            status = add_motion(text, scene, i);
        mote_text_add(text, "}");
    }
    mote_text_add(text, "],\n");
    return status;
}

static mote_status add_track(mote_text *text, const grid *g, const mote_replay_track *track)
{
    const mote_stored_cell *cell = track->cell;
    mote_text_add(text, "{");
    add_string(text, "label", track->row->label);
    mote_text_add(text, ", ");
    add_string(text, "cell", cell->id);
    if (track->row->n == track->row->n)
        mote_text_add(text, ", \"n\": %.0f", track->row->n);
    mote_text_add(text, ", \"first\": %u, \"stride\": %u, \"replicate\": %u,\n", cell->frame[0],
                  cell->stride, cell->replicate);
    add_bytes(text, "distance", track->distance, track->rows * sizeof *track->distance);
    mote_text_add(text, ",\n");
    add_bytes(text, "contact", cell->contact, track->rows);
    mote_text_add(text, ",\n");
    return add_points(text, "pair", g, track->pair, 2 * track->rows);
}

/* The first track with the same particles as track t, t itself if there is none before. */
static size_t same_particles(const mote_replay_scene *scene, size_t t)
{
    const mote_replay_track *track = &scene->tracks[t];
    for (size_t k = 0; k < t; ++k) {
        const mote_replay_track *other = &scene->tracks[k];
        if (other->particles == track->particles && other->rows == track->rows &&
            memcmp(other->place, track->place,
                   track->rows * 2 * track->particles * sizeof *track->place) == 0)
            return k;
    }
    return t;
}

/* Base-64 bytes of the particles of a track. */
static size_t particle_bytes(const mote_replay_track *track)
{
    return track->rows * 2 * track->particles * 8;
}

/* Answers first: they are the results. Then particles, few first, while they fit. kept[t]: the
   particles of track t are written. */
static void choose_particles(const mote_replay_scene *scene, size_t room, bool *kept)
{
    for (size_t t = 0; t < scene->count; ++t)
        kept[t] = false;
    for (size_t round = 0; round < scene->count; ++round) {
        size_t best = SIZE_MAX;
        for (size_t t = 0; t < scene->count; ++t) {
            const mote_replay_track *track = &scene->tracks[t];
            if (track->particles == 0 || kept[t] || same_particles(scene, t) != t)
                continue;
            if (best == SIZE_MAX || track->particles < scene->tracks[best].particles)
                best = t;
        }
        if (best == SIZE_MAX || particle_bytes(&scene->tracks[best]) > room)
            return;
        kept[best] = true;
        room -= particle_bytes(&scene->tracks[best]);
    }
}

static mote_status add_note(json_t *notes, const char *label, const char *what)
{
    char *note = mote_format("%s: %s", label, what);
    int added = note ? json_array_append_new(notes, json_string(note)) : -1;
    free(note);
    return added == 0 ? MOTE_OK : no_memory();
}

/* The tracks, each first in a text of its own, so that what does not fit can be left out. Track
   t names its particles by the first track that has the same. */
static mote_status add_tracks(mote_text *text, const grid *g, const mote_replay_scene *scene,
                              size_t budget, json_t *notes)
{
    mote_status status = MOTE_OK;
    const char *separator = "";
    mote_text_add(text, "\"tracks\": [");
    for (size_t t = 0; t < scene->count && status == MOTE_OK; ++t) {
        const mote_replay_track *track = &scene->tracks[t];
        mote_text one = {0};
        status = add_track(&one, g, track);
        if (status == MOTE_OK && text->size + one.size > budget) {
            status = add_note(notes, track->row->label, "left out, to keep the page small");
        } else if (status == MOTE_OK) {
            mote_text_add(text, "%s%s", separator, one.data);
            if (track->particles > 0)
                mote_text_add(text, ",\n\"particles\": %zu", same_particles(scene, t));
            mote_text_add(text, "}");
            separator = ",\n";
        }
        free(one.data);
    }
    mote_text_add(text, "],\n");
    return status;
}

/* The particles of those tracks for which there is room, by the tracks' numbers. */
static mote_status add_particles(mote_text *text, const grid *g, const mote_replay_scene *scene,
                                 size_t room, json_t *notes)
{
    bool *kept = calloc(scene->count + 1, sizeof *kept);
    mote_status status = kept ? MOTE_OK : no_memory();
    const char *separator = "";
    mote_text_add(text, "\"particles\": {");
    if (kept)
        choose_particles(scene, room, kept);
    for (size_t t = 0; t < scene->count && status == MOTE_OK; ++t) {
        const mote_replay_track *track = &scene->tracks[t];
        if (kept[t]) {
            char key[32];
            (void)snprintf(key, sizeof key, "%zu", t);
            mote_text_add(text, "%s", separator);
            status = add_points(text, key, g, track->place, track->rows * 2 * track->particles);
            separator = ",\n";
        } else if (track->particles > 0 && same_particles(scene, t) == t) {
            status = add_note(notes, track->row->label,
                              "its particles are left out, to keep the page small");
        }
    }
    mote_text_add(text, "},\n");
    free(kept);
    return status;
}

static mote_status add_scene(mote_text *text, const mote_replay_scene *scene, size_t budget,
                             json_t *notes)
{
    const grid g = scene_grid(scene);
    const mote_scenario *scenario = scene->scenario;
    mote_text_add(text, "{");
    add_string(text, "name", scenario->name);
    mote_text_add(text,
                  ", \"length\": %.17g, \"tolerance\": %.17g, \"first\": %u, \"last\": %u, "
                  "\"active\": [%u, %u], ",
                  scenario->length, scenario->tolerance, scene->first, scene->last,
                  scenario->active.first, scenario->active.last);
    add_grid(text, &g);
    mote_text_add(text, ",\n");
    mote_status status = add_bodies(text, scene);
    if (status != MOTE_OK)
        return status;
    const size_t frames = scene->last - scene->first + 1;
    add_bytes(text, "truth", scene->truth, frames * sizeof *scene->truth);
    mote_text_add(text, ",\n");
    status = add_points(text, "pair", &g, scene->pair, 2 * frames);
    mote_text_add(text, ",\n");
    if (status == MOTE_OK && text->size > budget)
        return mote_fail(MOTE_EUNSUPPORTED, "%s: too large for the page", scenario->name);
    if (status == MOTE_OK)
        status = add_tracks(text, &g, scene, budget, notes);
    if (status == MOTE_OK)
        status = add_particles(text, &g, scene, budget > text->size ? budget - text->size : 0,
                               notes);
    return status;
}

mote_status mote_replay_write(const mote_replay_scene *scene, size_t budget, mote_text *text)
{
    json_t *notes = json_deep_copy(scene->notes);
    mote_text one = {0};
    mote_status status = notes ? add_scene(&one, scene, budget, notes) : no_memory();
    char *list = status == MOTE_OK ? mote_json_text(notes, JSON_COMPACT) : NULL;
    if (status == MOTE_OK && (!list || one.failed))
        status = no_memory();
    if (status == MOTE_OK) {
        mote_text_add(text, "%s\"notes\": ", one.data);
        mote_escape_script(text, list);
        mote_text_add(text, "}");
    }
    free(list);
    free(one.data);
    json_decref(notes);
    return status;
}
