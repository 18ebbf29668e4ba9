#include "harness/figure/particle_places.h"

#include "harness/base/memory.h"
#include "harness/base/statistics.h"
#include "harness/engine/engine.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Whether both are MOTE_NONE, or have the same bits. */
static bool same_answer(const mote_answer *answer, const mote_stored_cell *cell, size_t k)
{
    const double length = mote_stored_number(cell, "length");
    if (!answer->has_distance)
        return cell->error[k] != cell->error[k];
    const double error = (answer->distance - cell->truth[k]) / length;
    return memcmp(&error, &cell->error[k], sizeof error) == 0;
}

/* Stores the particles of both bodies after the answer of row k; false: too many. */
static bool keep(const mote_engine *engine, mote_particle_places *places, size_t k)
{
    for (size_t i = 0; i < 2; ++i) {
        mote_vec3 *here = places->at + (2 * k + i) * MOTE_PARTICLE_PLACES_MAX;
        const size_t count =
            mote_engine_particles(engine, (int)i, here, MOTE_PARTICLE_PLACES_MAX);
        if (count > MOTE_PARTICLE_PLACES_MAX)
            return false;
        places->count = count > places->count ? count : places->count;
        for (size_t j = count; j < MOTE_PARTICLE_PLACES_MAX; ++j)
            here[j] = mote_vec3_make(MOTE_NONE, MOTE_NONE, MOTE_NONE);
    }
    return true;
}

/* Removes the unused room. */
static void close_up(mote_particle_places *places)
{
    for (size_t k = 0; k < 2 * places->rows; ++k)
        memmove(places->at + k * places->count, places->at + k * MOTE_PARTICLE_PLACES_MAX,
                places->count * sizeof *places->at);
}

/* Answers the frames again; sets `why` if the particles cannot be shown. */
static mote_status answer_again(const mote_scenario *scenario, const mote_stored_cell *cell,
                                mote_engine *engine, mote_particle_places *places)
{
    mote_frame_buffer *buffer = mote_frame_buffer_create(scenario);
    mote_status status = MOTE_OK;
    uint32_t previous = 0;
    for (size_t k = 0; k < places->rows && status == MOTE_OK && !places->why[0]; ++k) {
        mote_answer answer = {0};
        status = mote_engine_answer(
            engine, mote_scenario_frame(scenario, buffer, cell->frame[k], previous), &answer);
        previous = cell->frame[k];
        const char *why = NULL;
        if (status == MOTE_OK && !same_answer(&answer, cell, k))
            why = "not shown, as this build does not give the stored answers";
        else if (status == MOTE_OK && !keep(engine, places, k))
            why = "more than a picture shows";
        if (why)
            (void)snprintf(places->why, sizeof places->why, "%s", why);
    }
    mote_frame_buffer_destroy(buffer);
    return status;
}

mote_status mote_particle_places_find(const mote_scenario *scenario, const char *label,
                                      const mote_stored_cell *cell, size_t rows,
                                      mote_particle_places *places)
{
    mote_method_choice choice;
    mote_engine *engine = NULL;
    memset(places, 0, sizeof *places);
    places->rows = rows;
    if (mote_method_choice_read(label, &choice) != MOTE_OK || !choice.method->particles ||
        rows == 0)
        return MOTE_OK;
    places->at = mote_allocate(rows * 2 * MOTE_PARTICLE_PLACES_MAX, sizeof *places->at);
    mote_status status =
        mote_engine_open_two(&scenario->body[0], &scenario->body[1], &choice, scenario->ask,
                             scenario->tolerance, cell->replicate_seed, &engine);
    if (status == MOTE_OK)
        status = answer_again(scenario, cell, engine, places);
    mote_engine_destroy(engine);
    if (status != MOTE_OK)
        (void)snprintf(places->why, sizeof places->why, "%s", mote_error_text());
    if (!places->why[0]) {
        close_up(places);
        return MOTE_OK;
    }
    free(places->at);
    places->at = NULL;
    places->count = 0;
    return status == MOTE_ENOMEM ? status : MOTE_OK;
}
