/* How the method certified answers impacts: by mote_impact_query. Of its parameters, those of
   single distances have no meaning here. */
#include "core/impact/impact.h"
#include "core/method/impact_method.h"

#include <stdlib.h>

typedef struct impact_state {
    mote_impact_search *search;
    double tolerance;
} impact_state;

static void destroy(void *state)
{
    impact_state *s = state;
    if (!s)
        return;
    mote_impact_destroy(s->search);
    free(s);
}

static mote_status create(const mote_setup *setup, uint32_t pieces, void **state)
{
    mote_impact_options options = mote_default_impact_options(setup->length);
    options.pieces = pieces;
    impact_state *made = calloc(1, sizeof *made);
    if (!made)
        return mote_fail(MOTE_ENOMEM, "no memory for impacts of certified");
    made->tolerance = setup->tolerance;
    const mote_status status = mote_impact_create(setup->body, &options, &made->search);
    if (status == MOTE_OK)
        *state = made;
    else
        destroy(made);
    return status;
}

static mote_status query(void *state, const mote_path *const path[2],
                         mote_impact_answer *answer)
{
    impact_state *s = state;
    const mote_impact_question question = {
        .path = {path[0], path[1]}, .end = 1, .tolerance = s->tolerance};
    mote_impact_found found;
    const mote_status status = mote_impact_query(s->search, &question, &found);
    if (status != MOTE_OK)
        return status;
    *answer = (mote_impact_answer){.answered = found.outcome == MOTE_IMPACT_NONE ||
                                               found.outcome == MOTE_IMPACT_FOUND,
                                   .impact = found.outcome == MOTE_IMPACT_FOUND,
                                   .from = found.from,
                                   .to = found.to,
                                   .has_witness = found.outcome == MOTE_IMPACT_FOUND,
                                   .witness = {found.witness[0], found.witness[1]},
                                   .iterations = found.iterations,
                                   .counters = found.counters};
    return MOTE_OK;
}

MOTE_IMPACT(certified) = {
    .method = "certified", .create = create, .destroy = destroy, .query = query};
