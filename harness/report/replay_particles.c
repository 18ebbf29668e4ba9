/* Where a method's particles were: cells do not store it, so the method is asked once more. */
#include "harness/scene/probe.h"
#include "harness/report/replay.h"

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

/* Keeps the particles of both bodies after the answer of row k; false: too many. */
static bool keep(const mote_probe *probe, mote_replay_track *track, size_t k)
{
    for (size_t i = 0; i < 2; ++i) {
        mote_vec3 *here = track->place + (2 * k + i) * PARTICLES_MAX;
        size_t count = mote_probe_particles(probe, (int)i, here, PARTICLES_MAX);
        if (count > PARTICLES_MAX)
            return false;
        track->particles = count > track->particles ? count : track->particles;
        for (size_t j = count; j < PARTICLES_MAX; ++j)
            here[j] = mote_vec3_make(MOTE_NONE, MOTE_NONE, MOTE_NONE);
    }
    return true;
}

/* Takes out the places that no frame uses. */
static void close_up(mote_replay_track *track)
{
    for (size_t k = 0; k < 2 * track->rows; ++k)
        memmove(track->place + k * track->particles, track->place + k * PARTICLES_MAX,
                track->particles * sizeof *track->place);
}

/* Answers all frames of the track again. *why: what went wrong, or NULL. */
static mote_status answer_again(const mote_replay_scene *scene, mote_probe *probe,
                                mote_replay_track *track, const char **why)
{
    mote_frame_buffer *buffer = NULL;
    mote_status status = mote_frame_buffer_create(scene->scenario, &buffer);
    uint32_t previous = 0;
    *why = NULL;
    track->place = malloc(track->rows * 2 * PARTICLES_MAX * sizeof *track->place);
    if (status == MOTE_OK && !track->place)
        status = mote_fail(MOTE_ENOMEM, "no memory for particles");
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
    if (status == MOTE_OK && !*why)
        close_up(track);
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
    mote_status status = mote_probe_create(
        &scene->scenario->body[0], &scene->scenario->body[1], &choice, scene->scenario->ask,
        scene->scenario->tolerance, track->cell->replicate_seed, &probe);
    if (status == MOTE_OK)
        status = answer_again(scene, probe, track, &why);
    mote_probe_destroy(probe);
    if (status == MOTE_OK && !why)
        return MOTE_OK;
    free(track->place);
    track->place = NULL;
    track->particles = 0;
    if (status == MOTE_ENOMEM)
        return status;
    return note(scene, label, why ? why : mote_error_text());
}
