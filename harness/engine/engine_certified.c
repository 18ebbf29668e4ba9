/* More than two bodies: the certified scene, which finds near pairs and answers with the same
   trees. */
#include "harness/engine/engine_kind.h"

void mote_engine_copy_answers(mote_engine *e, const mote_scene_pair *from, size_t count)
{
    const bool distance = e->setup.ask == MOTE_ASK_DISTANCE;
    mote_engine_pair_list_make_room(&e->now, count);
    e->now.count = count;
    for (size_t k = 0; k < count; ++k) {
        const mote_scene_pair *p = &from[k];
        e->now.pairs[k] = (mote_near_pair){.body = {p->body[0], p->body[1]},
                                           .steps = p->steps,
                                           .answer = {.has_distance = distance,
                                                      .has_lower = true,
                                                      .has_witness = distance || p->contact,
                                                      .has_contact = p->decided,
                                                      .contact = p->contact,
                                                      .distance = p->distance,
                                                      .lower = p->lower,
                                                      .witness = {p->witness[0], p->witness[1]},
                                                      .counters = p->counters}};
    }
}

/* The scene answers for pairs as well, so every body has to be in it. */
static mote_status certified_create(mote_engine *e)
{
    for (uint32_t k = 0; k < e->setup.shape_count; ++k) {
        if (mote_body_is_given(e->setup.shapes[k]))
            return mote_fail(MOTE_EUNSUPPORTED,
                             "certified needs a field, and of shape %u only positions are "
                             "given; take a method on positions, as stream or aabb-tree",
                             k + 1);
    }
    return MOTE_OK;
}

static mote_status certified_ask(mote_engine *e, mote_engine_cost *cost)
{
    mote_pairs_wanted wanted = {0};
    mote_status status = mote_engine_bound(e, cost);
    if (status == MOTE_OK)
        status = mote_engine_find_near(e, cost, &wanted);
    if (status == MOTE_OK)
        status = mote_scene_query(e->scene, e->states, wanted.pairs, wanted.count);
    if (status != MOTE_OK)
        return status;
    size_t count;
    const mote_scene_pair *answers = mote_scene_pairs(e->scene, &count);
    mote_engine_copy_answers(e, answers, count);
    return MOTE_OK;
}

const mote_engine_kind mote_engine_of_certified = {
    certified_create, mote_engine_build_near, mote_engine_destroy_near, NULL, certified_ask};
