#include "harness/run/scene_check.h"

#include "harness/run/scene_referee.h"

static mote_status ask_frames(const mote_subject *subject, mote_engine *engine,
                              mote_subject_frame *frame, mote_scene_facts *facts)
{
    const uint32_t frames = subject->bodies->frames;
    mote_status status = MOTE_OK;
    for (uint32_t k = 1; k <= frames && status == MOTE_OK; ++k) {
        mote_engine_cost cost;
        status = mote_subject_frame_set(subject, k, k - 1, frame);
        if (status != MOTE_OK)
            break;
        mote_engine_show(engine, frame->states);
        status = mote_engine_ask(engine, &cost);
        if (status != MOTE_OK)
            break;
        if (mote_scene_referee_wants(subject, k)) {
            size_t count;
            const mote_near_pair *pairs = mote_engine_pairs(engine, &count);
            status = mote_scene_referee_judge(subject, k, frame->states, pairs, count,
                                              &facts->checked);
        }
        facts->near_pairs += (double)cost.pairs / frames;
        facts->pair_contacts += cost.contacts;
        facts->contacts += cost.contacts > 0;
    }
    return status;
}

mote_status mote_scene_check(const mote_subject *subject, mote_scene_facts *facts)
{
    mote_scene_facts made = {0};
    mote_method_choice exact;
    mote_engine *engine = NULL;
    mote_subject_frame frame = mote_subject_frame_create(subject, 0);
    const mote_engine_setup setup = mote_subject_engine(subject);
    const char *name = mote_bodies_any_given(subject->bodies) ? "stream" : "certified";
    mote_status status = mote_scene_choice_read(name, &exact);
    if (status == MOTE_OK)
        status = mote_engine_create(&setup, &exact, &engine);
    if (status == MOTE_OK)
        status = mote_engine_build(engine);
    if (status == MOTE_OK)
        status = ask_frames(subject, engine, &frame, &made);
    mote_engine_destroy(engine);
    mote_subject_frame_free(&frame);
    if (status == MOTE_OK)
        *facts = made;
    return status;
}
