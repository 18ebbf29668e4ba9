/* How a method answers the question "ask": "impact": when do two bodies first come within the
   tolerance between two moments (docs/impact.md)?

   It is a descriptor of its own beside that of the method, found by the method's name, so that
   methods that were compiled before there was this question work as before:
       MOTE_IMPACT(certified) = {.method = "certified", ...};
   at the start of a line, in a source of the tree (cmake/MoteRegistry.cmake). */
#ifndef MOTE_CORE_IMPACT_METHOD_H
#define MOTE_CORE_IMPACT_METHOD_H

#include "core/body/path.h"
#include "core/method/method.h"

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

/* An answer; zeroed by the caller before each query. Times are of the paths, 0 .. 1. */
typedef struct mote_impact_answer {
    bool answered;        /* false: the method cannot tell, or has failed on these paths */
    bool impact;          /* at `to` the distance is at most the tolerance */
    double from, to;      /* of an impact: there is none before `from`, as far as the method
                             knows, and there is one at `to`, >= from */
    bool has_witness;     /* of an impact: */
    mote_vec3 witness[2]; /* world points of body 0 and body 1 at `to` */
    uint32_t iterations;  /* moments at which the bodies were looked at */
    mote_counters counters;
} mote_impact_answer;

typedef struct mote_impact_method {
    const char *method; /* its name */
    bool alone;         /* it answers this question and no other */

    /* Builds the state for a pair of bodies, whose paths will have at most `pieces` pieces. Of
       the setup, ask is MOTE_ASK_IMPACT. MOTE_EUNSUPPORTED with a reason when the method cannot
       answer for these bodies or with these values. */
    mote_status (*create)(const mote_setup *setup, uint32_t pieces, void **state);

    /* NULL state is allowed. */
    void (*destroy)(void *state);

    /* Answers for the whole time of two paths, with the same number of pieces; all of it is
       timed as query_ns. Touching at time 0 is an impact there. */
    mote_status (*query)(void *state, const mote_path *const path[2],
                         mote_impact_answer *answer);
} mote_impact_method;

#define MOTE_IMPACT(id)                                                                        \
    MOTE_PLUGIN_DECLARE const mote_impact_method mote_impact_method_##id;                      \
    const mote_impact_method mote_impact_method_##id

/* Those that are built in, ended by NULL; written by the build. */
extern const mote_impact_method *const mote_impact_methods[];

/* How the method of that name answers the question; NULL: it does not. */
const mote_impact_method *mote_impact_method_find(const char *name);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
