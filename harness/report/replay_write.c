/* A scene as JSON: single numbers directly; arrays as packed texts that again contain JSON. */

#include "harness/base/memory.h"
#include "harness/report/packed.h"
#include "harness/report/replay.h"
#include "harness/report/replay_series.h"
#include "harness/report/replay_skin.h"

#include "core/base/quaternion.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Step size of a rotation's entries, and of translations divided by L. */
#define POSE_STEP 1e-6

/* Errors in L below this are rounding and written as 0: they are invisible in a picture. */
#define ERROR_LEAST 1e-12

/* {...} with the members in a text, packed; members are freed. */
static json_t *packed_object(mote_text *members)
{
    mote_text whole = {0}, packed = {0};
    mote_text_add(&whole, "{%s}", members->data ? members->data : "");
    mote_packed_add(&packed, whole.data, whole.size);
    json_t *object = json_stringn(packed.data, packed.size);
    free(members->data);
    free(whole.data);
    free(packed.data);
    return object;
}

/* The grid of all points of the scene that are not vertices. */
static mote_replay_grid scene_grid(const mote_replay_scene *scene)
{
    mote_replay_box box = mote_replay_box_none();
    mote_replay_box_include(&box, scene->pair, 2 * (size_t)(scene->last - scene->first + 1));
    for (size_t t = 0; t < scene->count; ++t) {
        const mote_replay_track *track = &scene->tracks[t];
        mote_replay_box_include(&box, track->pair, 2 * track->rows);
        mote_replay_box_include(&box, track->place, track->rows * 2 * track->particles);
    }
    return mote_replay_box_grid(&box);
}

static void add_numbers(mote_text *text, const char *key, const double *values, size_t count)
{
    mote_text_add(text, "\"%s\": [", key);
    for (size_t i = 0; i < count; ++i)
        mote_text_add(text, isfinite(values[i]) ? "%s%.17g" : "%snull", i > 0 ? "," : "",
                      values[i]);
    mote_text_add(text, "]");
}

static int32_t in_steps(double value, double step)
{
    return (int32_t)floor(value / step + 0.5);
}

/* Scales values to signed 16 bits by the largest: returns the step size; steps[count] are the
   results. */
static double largest_in_16_bits(const double *values, size_t count, int32_t *steps)
{
    double most = 0;
    for (size_t k = 0; k < count; ++k)
        most = fmax(most, fabs(values[k]));
    const double step = most > 0 ? most / 32767 : 1;
    for (size_t k = 0; k < count; ++k)
        steps[k] = in_steps(values[k], step);
    return step;
}

/* Adds the basis functions of a field of a kind that the page does not know, vertex by
   vertex. */
static void add_basis(mote_text *text, const mote_body *body)
{
    const mote_field *field = body->field;
    const size_t width = field->count, vertices = body->mesh->vertex_count;
    double *phi = mote_allocate(field->padded, sizeof *phi);
    double *values = mote_allocate(width * vertices, sizeof *values);
    int32_t *steps = mote_allocate(width * vertices, sizeof *steps);
    for (size_t i = 0; i < vertices; ++i) {
        field->kind->basis(field, body->mesh, (uint32_t)i, phi);
        memcpy(values + i * width, phi, width * sizeof *values);
    }
    mote_text_add(text, "\"functions\": %zu, \"basisStep\": %.17g, ", width,
                  largest_in_16_bits(values, width * vertices, steps));
    mote_replay_add_series(text, "basis", steps, width * vertices);
    free(phi);
    free(values);
    free(steps);
}

/* Adds what the page deforms a body by: its skin, or the data of a field's basis functions,
   such as the centres of CSRBFs. */
static void add_field(mote_text *text, const mote_body *body)
{
    const mote_field *field = body->field;
    if (mote_replay_has_skin(body)) {
        mote_replay_add_skin(text, body);
        return;
    }
    if (field->count > 0 && !field->centre_x) {
        add_basis(text, body);
        return;
    }
    mote_text_add(text, "\"support\": %.17g, ", field->support);
    add_numbers(text, "centreX", field->centre_x, field->count);
    mote_text_add(text, ", ");
    add_numbers(text, "centreY", field->centre_y, field->count);
    mote_text_add(text, ", ");
    add_numbers(text, "centreZ", field->centre_z, field->count);
}

/* Adds the mesh at rest and its field or skin. */
static void add_mesh(mote_text *text, const mote_body *body)
{
    const mote_mesh *mesh = body->mesh;
    const size_t corner_count = 3 * (size_t)mesh->triangle_count;
    mote_replay_box box = mote_replay_box_none();
    int32_t *corners = mote_allocate(corner_count, sizeof *corners);
    for (size_t k = 0; k < corner_count; ++k)
        corners[k] = (int32_t)mesh->triangles[k / 3][k % 3];
    mote_replay_box_include(&box, mesh->positions, mesh->vertex_count);
    const mote_replay_grid grid = mote_replay_box_grid(&box);
    mote_replay_add_grid(text, &grid);
    mote_text_add(text, ", ");
    mote_replay_add_points(text, "vertices", &grid, mesh->positions, mesh->vertex_count, 1,
                           NULL);
    mote_text_add(text, ", ");
    mote_replay_difference(corners, corner_count, 3);
    mote_replay_add_series(text, "triangles", corners, corner_count);
    free(corners);
    mote_text_add(text, ", ");
    add_field(text, body);
}

/* The rows of a pose's rotation and its translation divided by L, in steps. */
static void pose_steps(const mote_pose *pose, double length, int32_t steps[12])
{
    const double translation[3] = {pose->translation.x, pose->translation.y,
                                   pose->translation.z};
    for (size_t c = 0; c < 9; ++c)
        steps[c] = in_steps(pose->rotation.m[c / 3][c % 3], POSE_STEP);
    for (size_t c = 0; c < 3; ++c)
        steps[9 + c] = in_steps(translation[c] / length, POSE_STEP);
}

/* The weights of a frame in rest axes. */
static void weights_in_rest_axes(const mote_body_state *state, size_t count, double *weights)
{
    for (size_t j = 0; j < count; ++j) {
        const mote_vec3 w = mote_rotate_back(
            &state->pose.rotation,
            mote_vec3_make(state->weights.x[j], state->weights.y[j], state->weights.z[j]));
        weights[3 * j] = w.x;
        weights[3 * j + 1] = w.y;
        weights[3 * j + 2] = w.z;
    }
}

/* Appends second differences: those of smooth motion are small. */
static void add_smooth(mote_text *text, const char *key, int32_t *values, size_t count,
                       size_t columns)
{
    mote_replay_difference(values, count, columns);
    mote_replay_difference(values, count, columns);
    mote_replay_add_series(text, key, values, count);
}

/* Adds weights scaled to signed 16 bits by the largest. */
static void add_weights(mote_text *text, const double *weights, size_t frames, size_t width)
{
    int32_t *shares = mote_allocate(width * frames, sizeof *shares);
    mote_text_add(text, "\"weightStep\": %.17g, ",
                  largest_in_16_bits(weights, width * frames, shares));
    add_smooth(text, "weights", shares, width * frames, width);
    free(shares);
}

static mote_status add_motion(mote_text *text, const mote_replay_scene *scene, int i)
{
    const mote_scenario *scenario = scene->scenario;
    const mote_replay_keys *keys = &scene->keys[i];
    const mote_field *field = keys->field ? keys->field : scenario->body[i].field;
    const bool has_skin = mote_replay_has_skin(&scenario->body[i]);
    const size_t frames = scene->last - scene->first + 1;
    const size_t width = has_skin ? 0 : 3 * (size_t)field->count;
    mote_status status = MOTE_OK;
    mote_frame_buffer *buffer = mote_frame_buffer_create(scenario);
    int32_t *poses = mote_allocate(12 * frames, sizeof *poses);
    double *weights = mote_allocate(width * frames, sizeof *weights);
    for (size_t k = 0; k < frames && status == MOTE_OK; ++k) {
        const uint32_t number = scene->first + (uint32_t)k;
        const mote_frame *frame = mote_scenario_frame(scenario, buffer, number, 0);
        if (!frame) {
            status = mote_error_status();
            break;
        }
        pose_steps(&frame->body[i].pose, scenario->length, poses + 12 * k);
        if (keys->field)
            mote_replay_keys_weights(keys, number, weights + width * k);
        else
            weights_in_rest_axes(&frame->body[i], width / 3, weights + width * k);
    }
    mote_text_add(text, "\"poseStep\": %.17g, ", POSE_STEP);
    add_smooth(text, "poses", poses, 12 * frames, 12);
    mote_text_add(text, ", ");
    if (has_skin)
        mote_replay_add_skin_motion(text, scenario, i, scene->first, scene->last);
    else
        add_weights(text, weights, frames, width);
    mote_frame_buffer_destroy(buffer);
    free(poses);
    free(weights);
    return status;
}

/* Adds both bodies with their motion, the truth and its points. */
static mote_status add_bodies(mote_text *text, const mote_replay_scene *scene,
                              const mote_replay_grid *grid)
{
    const size_t frames = scene->last - scene->first + 1;
    mote_status status = MOTE_OK;
    mote_text_add(text, "\"bodies\": [");
    for (int i = 0; i < 2 && status == MOTE_OK; ++i) {
        mote_body body = scene->scenario->body[i];
        if (scene->keys[i].field)
            body.field = scene->keys[i].field;
        mote_text_add(text, "%s{", i ? ", " : "");
        add_mesh(text, &body);
        mote_text_add(text, ", ");
        status = add_motion(text, scene, i);
        mote_text_add(text, "}");
    }
    mote_text_add(text, "], ");
    add_numbers(text, "truth", scene->truth, frames);
    mote_text_add(text, ", ");
    mote_replay_add_points(text, "pair", grid, scene->pair, 2 * frames, 2, NULL);
    return status;
}

/* Adds errors in L with six digits, from which the page computes distances. */
static void add_errors(mote_text *text, const mote_replay_track *track)
{
    mote_text_add(text, "\"error\": [");
    for (size_t k = 0; k < track->rows; ++k) {
        const double error = track->cell->error[k];
        mote_text_add(text, "%s", k > 0 ? "," : "");
        if (error != error)
            mote_text_add(text, "null");
        else
            mote_text_add(text, "%.6g", fabs(error) < ERROR_LEAST ? 0 : error);
    }
    mote_text_add(text, "], \"contact\": [");
    for (size_t k = 0; k < track->rows; ++k)
        mote_text_add(text, k > 0 ? ",%d" : "%d", track->cell->contact[k]);
    mote_text_add(text, "], ");
}

/* The truth's points at the frames that a track answers; the track's own points are stored
   relative to them. */
static mote_vec3 *reference_of(const mote_replay_scene *scene, const mote_replay_track *track)
{
    mote_vec3 *reference = mote_allocate(2 * track->rows, sizeof *reference);
    for (size_t k = 0; k < track->rows; ++k)
        memcpy(reference + 2 * k, scene->pair + 2 * (track->cell->frame[k] - scene->first),
               2 * sizeof *reference);
    return reference;
}

/* A track without its particles. */
static json_t *track_data(const mote_replay_scene *scene, const mote_replay_grid *grid,
                          const mote_replay_track *track)
{
    const mote_stored_cell *cell = track->cell;
    mote_vec3 *reference = reference_of(scene, track);
    mote_text answers = {0};
    add_errors(&answers, track);
    mote_replay_add_points(&answers, "pair", grid, track->pair, 2 * track->rows, 2, reference);
    free(reference);
    json_t *data =
        json_pack("{s:s, s:s, s:i, s:i, s:i, s:I, s:o}", "label", track->row->label, "cell",
                  cell->id, "first", (int)cell->frame[0], "stride", (int)cell->stride,
                  "replicate", (int)cell->replicate, "replicates",
                  (json_int_t)track->row->finished, "answers", packed_object(&answers));
    if (track->row->n == track->row->n)
        (void)json_object_set_new(data, "n", json_real(track->row->n));
    return data;
}

static size_t packed_size(const json_t *object, const char *key)
{
    return json_string_length(json_object_get(object, key));
}

static void add_note(json_t *notes, const char *label, const char *what)
{
    char *note = mote_format("%s: %s", label, what);
    (void)json_array_append_new(notes, json_string(note));
    free(note);
}

/* The first track with the same particles as track t; t itself if no earlier one has. */
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

/* Adds the tracks that fit. Track t refers to its particles by the first track with the same
   ones. */
static void add_tracks(const mote_replay_scene *scene, const mote_replay_grid *grid,
                       size_t *room, json_t *data, json_t *notes)
{
    json_t *tracks = json_array();
    for (size_t t = 0; t < scene->count; ++t) {
        const mote_replay_track *track = &scene->tracks[t];
        json_t *one = track_data(scene, grid, track);
        const size_t size = packed_size(one, "answers");
        if (size > *room) {
            add_note(notes, track->row->label, "left out, to keep the page small");
            json_decref(one);
        } else {
            *room -= size;
            if (track->particles > 0)
                (void)json_object_set_new(one, "particles",
                                          json_integer((json_int_t)same_particles(scene, t)));
            (void)json_array_append_new(tracks, one);
        }
    }
    (void)json_object_set_new(data, "tracks", tracks);
}

/* The particles of a track, packed. */
static json_t *particle_data(const mote_replay_track *track, const mote_replay_grid *grid)
{
    mote_text text = {0};
    mote_text_add(&text, "\"perBody\": %zu, ", track->particles);
    mote_replay_add_points(&text, "places", grid, track->place,
                           track->rows * 2 * track->particles, 2 * track->particles, NULL);
    return packed_object(&text);
}

/* The unfinished track with the fewest particles; count: none. */
static size_t next_particles(const mote_replay_scene *scene, const bool *done)
{
    size_t best = scene->count;
    for (size_t t = 0; t < scene->count; ++t) {
        if (scene->tracks[t].particles > 0 && !done[t] && same_particles(scene, t) == t &&
            (best == scene->count ||
             scene->tracks[t].particles < scene->tracks[best].particles))
            best = t;
    }
    return best;
}

/* Adds particles while they fit, the smallest sets first, keyed by the number of their
   track. */
static void add_particles(const mote_replay_scene *scene, const mote_replay_grid *grid,
                          size_t *room, json_t *data, json_t *notes)
{
    bool *done = mote_allocate(scene->count, sizeof *done);
    json_t *sets = json_object();
    for (size_t t; (t = next_particles(scene, done)) < scene->count;) {
        done[t] = true;
        char key[32];
        (void)snprintf(key, sizeof key, "%zu", t);
        json_t *packed = particle_data(&scene->tracks[t], grid);
        const size_t size = json_string_length(packed);
        if (size > *room) {
            add_note(notes, scene->tracks[t].row->label,
                     "its particles are left out, to keep the page small");
            json_decref(packed);
        } else {
            (void)json_object_set_new(sets, key, packed);
            *room -= size;
        }
    }
    (void)json_object_set_new(data, "particles", sets);
    free(done);
}

/* The scene without its tracks. */
static mote_status begin_scene(const mote_replay_scene *scene, const mote_replay_grid *grid,
                               json_t **data)
{
    const mote_scenario *scenario = scene->scenario;
    mote_text bodies = {0};
    const mote_status status = add_bodies(&bodies, scene, grid);
    json_t *packed = packed_object(&bodies);
    *data =
        json_pack("{s:s, s:f, s:f, s:i, s:i, s:[i, i], s:[f, f, f], s:f, s:o}", "name",
                  scenario->name, "length", scenario->length, "tolerance", scenario->tolerance,
                  "first", (int)scene->first, "last", (int)scene->last, "active",
                  (int)scenario->active.first, (int)scenario->active.last, "low", grid->low.x,
                  grid->low.y, grid->low.z, "step", grid->step, "world", packed);
    return status;
}

mote_status mote_replay_write(const mote_replay_scene *scene, size_t budget, json_t **data,
                              size_t *used)
{
    const mote_replay_grid grid = scene_grid(scene);
    json_t *made = NULL, *notes = json_deep_copy(scene->notes);
    size_t room = budget;
    mote_status status = begin_scene(scene, &grid, &made);
    if (status == MOTE_OK && packed_size(made, "world") > room)
        status =
            mote_fail(MOTE_EUNSUPPORTED, "%s: too large for the page", scene->scenario->name);
    if (status != MOTE_OK) {
        json_decref(made);
        json_decref(notes);
        return status;
    }
    room -= packed_size(made, "world");
    add_tracks(scene, &grid, &room, made, notes);
    add_particles(scene, &grid, &room, made, notes);
    (void)json_object_set_new(made, "notes", notes);
    *used = budget - room;
    *data = made;
    return MOTE_OK;
}
