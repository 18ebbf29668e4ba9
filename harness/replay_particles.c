/* Where a method's particles were: cells do not store it, so the method is asked once more. */
#include "harness/probe.h"
#include "harness/replay.h"

#include <stdlib.h>
#include <string.h>

/* More particles than this on a body are not shown. */
#define PARTICLES_MAX 64

static mote_status note(mote_replay_scene *scene, const char *label, const char *why)
{
    char *text = mote_format("particles of %s: %s", label, why);
    int added = text ? json_array_append_new(scene->notes, json_string(text)) : -1;
    free(text);
    return added == 0 ? MOTE_OK : mote_fail(MOTE_ENOMEM, "no memory for a note");
}

/* Both none, or the same bits. */
static bool same_answer(const mote_answer *answer, double stored)
{
    if (!answer->has_distance)
        return stored != stored;
    return memcmp(&answer->distance, &stored, sizeof stored) == 0;
}

/* Keeps the particles of both bodies after the answer of row k; false: not two equal numbers,
   or too many. */
static bool keep(const mote_probe *probe, mote_replay_track *track, size_t k)
{
    mote_vec3 places[2][PARTICLES_MAX];
    size_t a = mote_probe_particles(probe, 0, places[0], PARTICLES_MAX);
    size_t b = mote_probe_particles(probe, 1, places[1], PARTICLES_MAX);
    if (k == 0 && a <= PARTICLES_MAX)
        track->particles = a;
    if (a != track->particles || b != track->particles || a == 0)
        return false;
    if (k == 0)
        track->place = malloc(track->rows * 2 * a * sizeof *track->place);
    if (!track->place)
        return false;
    mote_vec3 *here = track->place + k * 2 * a;
    memcpy(here, places[0], a * sizeof *here);
    memcpy(here + a, places[1], a * sizeof *here);
    return true;
}

/* Answers all frames of the track again. *why: what went wrong, or NULL. */
static mote_status answer_again(const mote_replay_scene *scene, mote_probe *probe,
                                mote_replay_track *track, const char **why)
{
    mote_frame_buffer *buffer = NULL;
    mote_status status = mote_frame_buffer_create(scene->scenario, &buffer);
    uint32_t previous = 0;
    *why = NULL;
    for (size_t k = 0; k < track->rows && status == MOTE_OK && !*why; ++k) {
        const uint32_t number = track->cell->frame[k];
        mote_answer answer;
        status = mote_probe_answer(
            probe, mote_scenario_frame(scene->scenario, buffer, number, previous), &answer);
        previous = number;
        if (status == MOTE_OK && !same_answer(&answer, track->distance[k]))
            *why = "not shown, as this build does not give the stored answers";
        else if (status == MOTE_OK && !keep(probe, track, k))
            *why = "more than a picture shows";
    }
    mote_frame_buffer_destroy(buffer);
    return status;
}

mote_status mote_replay_particles(mote_replay_scene *scene, mote_replay_track *track)
{
    mote_method_choice choice;
    mote_probe *probe = NULL;
    const char *why = NULL;
    const char *label = track->row->label;
    if (mote_method_choice_read(label, &choice) != MOTE_OK || !choice.method->particles ||
        track->rows == 0)
        return MOTE_OK;
    const double seed = mote_stored_number(track->cell, "seed") + track->cell->replicate - 1;
    mote_status status = mote_probe_create(&scene->scenario->body[0], &scene->scenario->body[1],
                                           &choice, scene->scenario->ask,
                                           scene->scenario->tolerance, (uint64_t)seed, &probe);
    if (status == MOTE_OK)
        status = answer_again(scene, probe, track, &why);
    mote_probe_destroy(probe);
    if (status == MOTE_OK && !why)
        return MOTE_OK;
    free(track->place);
    track->place = NULL;
    track->particles = 0;
    return note(scene, label, why ? why : mote_error_text());
}
