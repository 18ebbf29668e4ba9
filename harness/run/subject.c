#include "harness/run/subject.h"

#include <assert.h>

mote_status mote_subject_open(const char *name_or_path, mote_subject *subject)
{
    return mote_bodies_is(name_or_path) ? mote_bodies_load(name_or_path, &subject->bodies)
                                        : mote_scenario_load(name_or_path, &subject->scenario);
}

bool mote_subject_asks_impacts(const mote_subject *subject)
{
    return subject->scenario && subject->scenario->ask == MOTE_ASK_IMPACT;
}

uint32_t mote_subject_step(const mote_subject *subject)
{
    return mote_subject_asks_impacts(subject) ? subject->scenario->step : 0;
}

mote_status mote_subject_identify(mote_subject *subject)
{
    subject->faces = subject->bodies ? mote_bodies_faces(subject->bodies)
                                     : mote_scenario_faces(subject->scenario);
    if (subject->bodies)
        return mote_bodies_fingerprint(subject->bodies, &subject->fingerprint);
    mote_status status = mote_scenario_fingerprint(subject->scenario, &subject->fingerprint);
    if (status == MOTE_OK && mote_subject_asks_impacts(subject))
        status = mote_scenario_path_fingerprint(subject->scenario, &subject->fingerprint);
    return status;
}

mote_status mote_subject_load(const char *name_or_path, mote_subject *subject)
{
    const mote_status status = mote_subject_open(name_or_path, subject);
    return status == MOTE_OK ? mote_subject_identify(subject) : status;
}

void mote_subject_free(mote_subject *subject)
{
    mote_truth_destroy(subject->truth);
    mote_impact_truth_destroy(subject->impacts);
    mote_scenario_destroy(subject->scenario);
    mote_bodies_destroy(subject->bodies);
    *subject = (mote_subject){0};
}

static mote_subject_facts facts_of_pair(const mote_scenario *scenario)
{
    mote_subject_facts facts = {.name = scenario->name,
                                .bodies = 2,
                                .frames = scenario->frames,
                                .ask = scenario->ask,
                                .tolerance = scenario->tolerance,
                                .length = scenario->length,
                                .active = scenario->active};
    for (int i = 0; i < 2; ++i) {
        facts.triangles[i] = scenario->body[i].mesh->triangle_count;
        facts.vertices[i] = scenario->body[i].mesh->vertex_count;
        facts.vertices_total += facts.vertices[i];
    }
    return facts;
}

static mote_subject_facts facts_of_bodies(const mote_bodies *bodies)
{
    mote_subject_facts facts = {.name = bodies->name,
                                .bodies = bodies->count,
                                .frames = bodies->frames,
                                .ask = bodies->ask,
                                .tolerance = bodies->tolerance,
                                .length = bodies->length,
                                .near_pairs_wanted = bodies->near_pairs_wanted};
    const mote_mesh *smallest = bodies->shapes[0].body.mesh, *largest = smallest;
    for (uint32_t s = 1; s < bodies->shape_count; ++s) {
        const mote_mesh *mesh = bodies->shapes[s].body.mesh;
        smallest = mesh->triangle_count < smallest->triangle_count ? mesh : smallest;
        largest = mesh->triangle_count > largest->triangle_count ? mesh : largest;
    }
    facts.triangles[0] = smallest->triangle_count;
    facts.triangles[1] = largest->triangle_count;
    facts.vertices[0] = smallest->vertex_count;
    facts.vertices[1] = largest->vertex_count;
    for (uint32_t i = 0; i < bodies->count; ++i)
        facts.vertices_total += bodies->shapes[bodies->shape_of[i]].body.mesh->vertex_count;
    return facts;
}

mote_subject_facts mote_subject_facts_of(const mote_subject *subject)
{
    return subject->bodies ? facts_of_bodies(subject->bodies)
                           : facts_of_pair(subject->scenario);
}

mote_engine_setup mote_subject_engine(const mote_subject *subject)
{
    const mote_bodies *bodies = subject->bodies;
    const mote_scenario *pair = subject->scenario;
    if (!bodies) {
        mote_engine_setup setup = mote_engine_setup_of_two(&pair->body[0], &pair->body[1]);
        setup.length = pair->length;
        setup.ask = pair->ask;
        setup.step = pair->step;
        setup.tolerance = pair->tolerance;
        return setup;
    }
    mote_engine_setup setup = {.shape_count = bodies->shape_count,
                               .shape_of = bodies->shape_of,
                               .count = bodies->count,
                               .length = bodies->length,
                               .ask = bodies->ask,
                               .tolerance = bodies->tolerance,
                               .near = bodies->near};
    for (uint32_t k = 0; k < bodies->shape_count; ++k)
        setup.shapes[k] = &bodies->shapes[k].body;
    return setup;
}

mote_subject_frame mote_subject_frame_create(const mote_subject *subject, uint32_t step)
{
    mote_subject_frame frame = {.pair = NULL};
    if (step > 0) {
        const mote_status status =
            mote_scenario_path_create(subject->scenario, step, &frame.path);
        assert(status == MOTE_OK); /* mote_scenario_ask_impacts has tried it */
        (void)status;
    } else if (subject->bodies) {
        frame.scene = mote_bodies_frame_create(subject->bodies);
    } else {
        frame.pair = mote_frame_buffer_create(subject->scenario);
    }
    return frame;
}

void mote_subject_frame_free(mote_subject_frame *frame)
{
    mote_frame_buffer_destroy(frame->pair);
    mote_bodies_frame_free(&frame->scene);
    mote_scenario_path_destroy(frame->path);
    *frame = (mote_subject_frame){.pair = NULL};
}

mote_status mote_subject_frame_set(const mote_subject *subject, uint32_t number,
                                   uint32_t previous, mote_subject_frame *frame)
{
    if (frame->path) {
        mote_scenario_path_set(frame->path, number);
    } else if (subject->bodies) {
        frame->states = frame->scene.states;
        return mote_bodies_frame_set(subject->bodies, number, &frame->scene);
    } else {
        const mote_frame *shown =
            mote_scenario_frame(subject->scenario, frame->pair, number, previous);
        if (!shown)
            return mote_error_status();
        frame->states = shown->body;
    }
    return MOTE_OK;
}
