#include "harness/run/scene_check.h"

#include "harness/run/bodies_engine.h"

static mote_status ask_frames(const mote_bodies *bodies, mote_bodies_engine *engine,
                              mote_bodies_frame *frame, mote_scene_facts *facts)
{
    mote_status status = MOTE_OK;
    for (uint32_t k = 1; k <= bodies->frames && status == MOTE_OK; ++k) {
        mote_bodies_step step;
        mote_bodies_frame_set(bodies, k, frame);
        status = mote_bodies_engine_step(engine, frame->states, &step);
        if (status != MOTE_OK)
            break;
        facts->near_pairs += (double)step.pairs / bodies->frames;
        facts->pair_contacts += step.contacts;
        facts->contacts += step.contacts > 0;
    }
    return status;
}

mote_status mote_scene_check(const mote_bodies *bodies, mote_scene_facts *facts)
{
    mote_scene_facts made = {0};
    mote_method_choice exact;
    mote_bodies_engine *engine = NULL;
    mote_bodies_frame frame = mote_bodies_frame_create(bodies);
    mote_status status = mote_bodies_fingerprint(bodies, &made.fingerprint);
    if (status == MOTE_OK)
        status = mote_scene_choice_read("certified", &exact);
    if (status == MOTE_OK)
        status = mote_bodies_engine_create(bodies, &exact, 1, &engine);
    if (status == MOTE_OK)
        status = ask_frames(bodies, engine, &frame, &made);
    mote_bodies_engine_destroy(engine);
    mote_bodies_frame_free(&frame);
    if (status == MOTE_OK)
        *facts = made;
    return status;
}
