/* Asks when two bodies meet, and checks answers: for tests whose exact answer is known. */
#ifndef MOTE_TESTS_IMPACT_ASK_H
#define MOTE_TESTS_IMPACT_ASK_H

#include "tests/support/impact_scene.h"
#include "tests/support/test.h"

static inline mote_impact_found impact_ask(impact_scene *s, mote_impact_question question)
{
    mote_impact_found found;
    if (mote_impact_query(s->search, &question, &found) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    assert_true(question.begin <= found.from && found.from <= found.to &&
                found.to <= question.end);
    return found;
}

static inline void impact_check_found(const mote_impact_found *found, double time)
{
    assert_int_equal(found->outcome, MOTE_IMPACT_FOUND);
    if (!(found->from <= time + 1e-12 && time - 1e-12 <= found->to))
        fail_msg("%.17g is not within %.17g .. %.17g", time, found->from, found->to);
    assert_true(found->to - found->from <= 1.0001e-6);
}

#endif
