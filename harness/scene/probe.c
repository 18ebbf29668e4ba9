#include "harness/scene/probe.h"

#include "harness/base/memory.h"

#include "core/body/deform.h"

#include <math.h>
#include <stdlib.h>

struct mote_probe {
    mote_body body[2];
    mote_method_choice choice;
    mote_traits traits;
    void *state;
    mote_deform *deform[2];
    mote_vec3 *world[2];
    mote_frame frame; /* the last frame: the particles are where it has put them */
};

static mote_status build(mote_probe *probe, mote_ask ask, double tolerance, uint64_t seed)
{
    const mote_method *method = probe->choice.method;
    mote_setup setup = {.body = {&probe->body[0], &probe->body[1]},
                        .length =
                            fmax(probe->body[0].mesh->diagonal, probe->body[1].mesh->diagonal),
                        .ask = ask,
                        .tolerance = tolerance,
                        .seed = seed,
                        .values = probe->choice.values};
    probe->traits = mote_method_traits(method, probe->choice.values);
    for (int i = 0; i < 2; ++i) {
        probe->world[i] =
            mote_allocate(probe->body[i].mesh->vertex_count, sizeof *probe->world[i]);
        mote_status status = mote_deform_create(&probe->body[i], &probe->deform[i]);
        if (status != MOTE_OK)
            return status;
    }
    return mote_method_create(method, &setup, &probe->state);
}

mote_status mote_probe_create(const mote_body *a, const mote_body *b,
                              const mote_method_choice *choice, mote_ask ask, double tolerance,
                              uint64_t seed, mote_probe **probe)
{
    mote_probe *made = mote_allocate(1, sizeof *made);
    made->body[0] = *a;
    made->body[1] = *b;
    made->choice = *choice;
    mote_status status = build(made, ask, tolerance, seed);
    if (status == MOTE_OK)
        *probe = made;
    else
        mote_probe_destroy(made);
    return status;
}

mote_status mote_probe_create_distance(const mote_body *bodies, const char *method,
                                       mote_probe **probe)
{
    mote_method_choice choice;
    mote_status status = mote_method_choice_read(method, &choice);
    if (status == MOTE_OK)
        status =
            mote_probe_create(&bodies[0], &bodies[1], &choice, MOTE_ASK_DISTANCE, 0, 0, probe);
    return status;
}

void mote_probe_destroy(mote_probe *probe)
{
    if (!probe)
        return;
    if (probe->state)
        mote_method_destroy(probe->choice.method, probe->state);
    for (int i = 0; i < 2; ++i) {
        mote_deform_destroy(probe->deform[i]);
        free(probe->world[i]);
    }
    free(probe);
}

size_t mote_probe_particles(const mote_probe *probe, int i, mote_vec3 *positions,
                            size_t capacity)
{
    const mote_method *method = probe->choice.method;
    return method->particles ? method->particles(probe->state, i, positions, capacity) : 0;
}

const mote_vec3 *mote_probe_vertices(mote_probe *probe, const mote_frame *frame, int i)
{
    mote_deform_all(probe->deform[i], &frame->body[i], probe->world[i]);
    return probe->world[i];
}

mote_status mote_probe_answer(mote_probe *probe, const mote_frame *frame, mote_answer *answer)
{
    const mote_method *method = probe->choice.method;
    mote_frame *full = &probe->frame;
    *full = *frame;
    if (probe->traits.needs_vertices || probe->traits.given_vertices) {
        for (int i = 0; i < 2; ++i)
            full->body[i].vertices = mote_probe_vertices(probe, frame, i);
    }
    mote_answer given = {0};
    mote_status status = method->update ? method->update(probe->state, full) : MOTE_OK;
    if (status == MOTE_OK)
        status = method->query(probe->state, full, &given);
    if (status == MOTE_OK)
        *answer = given;
    return status;
}
