/* Random approaches of two bodies in the closed loop, and how often a method lets the bodies
   pass through each other. */
#ifndef MOTE_HARNESS_APPROACHES_H
#define MOTE_HARNESS_APPROACHES_H

#include "harness/loop/simulate.h"
#include "harness/base/statistics.h"

#include <jansson.h>

/* How approaches are drawn; lengths in L, speeds in L per frame. One body flies past or into
   the other one, both rotating and deforming. */
#define MOTE_APPROACH_SEED 0x64796e616d69u
#define MOTE_APPROACH_SLOWEST 0.002
#define MOTE_APPROACH_FASTEST 0.02 /* log-uniform */
#define MOTE_APPROACH_DEGREES 2.0  /* per frame, at most, about any axis */
#define MOTE_APPROACH_ASIDE 0.35   /* aim off the other's centre of mass, at most */
#define MOTE_APPROACH_CLEAR 0.2    /* between the bodies' spheres at the start */
#define MOTE_APPROACH_APART 0.06   /* ends this far apart and separating */
#define MOTE_APPROACH_STEPS 2000u  /* at most */

/* Sums over the approaches of one method on one scene, X(name). A trial is a simulated
   approach; it counts as an approach if it came to a contact in truth. */
#define MOTE_APPROACHES_COUNTS(X)                                                              \
    X(trials)                                                                                  \
    X(approaches)                                                                              \
    X(passes_through)      /* approaches with a run of contacts that was never reported */     \
    X(deep_passes_through) /* of those, with a vertex inside the other body at the time */     \
    X(intersecting)        /* approaches in which the surfaces intersected at some time */     \
    X(contact_runs)        /* runs of contacts; an approach may have several */                \
    X(contact_runs_passed)                                                                     \
    X(steps)                                                                                   \
    X(contact_steps)                                                                           \
    X(missed_steps)                                                                            \
    X(false_steps)                                                                             \
    X(responses)                                                                               \
    X(impacts)        /* found between the ends of steps */                                    \
    X(floor_pushes)   /* of these, answered by a push */                                       \
    X(floor_unproven) /* flights for which nothing was proven */                               \
    X(truth_asked)                                                                             \
    X(delay_sum) /* steps to the first report, over the reported runs */                       \
    X(delay_max)

/* Values: lengths in L, drifts relative, each the largest over all approaches; query_ns is the
   mean per step. Depth is measured until a contact is reported. */
#define MOTE_APPROACHES_FIGURES(X)                                                             \
    X(max_penetration_unreported)                                                              \
    X(max_penetration_passes)                                                                  \
    X(energy_drift)                                                                            \
    X(momentum_drift)                                                                          \
    X(angular_momentum_drift)                                                                  \
    X(query_ns)

#define MOTE_APPROACHES_COUNT(name) uint64_t name;
#define MOTE_APPROACHES_FIGURE(name) double name;
typedef struct mote_approaches {
    MOTE_APPROACHES_COUNTS(MOTE_APPROACHES_COUNT)
    MOTE_APPROACHES_FIGURES(MOTE_APPROACHES_FIGURE)
} mote_approaches;
#undef MOTE_APPROACHES_COUNT
#undef MOTE_APPROACHES_FIGURE

/* What is simulated. */
typedef struct mote_approaches_plan {
    const char *method; /* as on the command line */
    uint32_t wanted;
    double step; /* frames, and what happens within them */
    mote_simulation_steps within;
} mote_approaches_plan;

/* Draws approach number index (from 0), the same for every method: masses[2] are the bodies'.
   states receives the start, and the result borrows it. */
mote_simulation_start mote_approach_draw(const mote_scenario *scenario, const mote_mass *masses,
                                         uint32_t index, mote_rigid_state states[2]);

/* Simulates approaches 0, 1, ... until `wanted` of them came to a contact, or 4 * wanted were
   tried. */
mote_status mote_approaches_simulate(mote_scenario *scenario, const mote_approaches_plan *plan,
                                     mote_approaches *sum);

/* passes_through / approaches, and its exact binomial interval; MOTE_NONE without approaches.
 */
double mote_approaches_share(const mote_approaches *sum);
mote_confidence mote_approaches_interval(const mote_approaches *sum);

/* Steps from the beginning of a contact to its first report, averaged over the reported
   ones. */
double mote_approaches_delay(const mote_approaches *sum);

/* An object with every count and value, and back; false if one is missing or impossible: a
   negative count, or more passes than approaches. */
json_t *mote_approaches_json(const mote_approaches *sum);
bool mote_approaches_read(const json_t *object, mote_approaches *sum);

#endif
