/* Measuring one way of asking about several bodies, in a process of its own. */
#ifndef MOTE_HARNESS_BODIES_MEASURE_H
#define MOTE_HARNESS_BODIES_MEASURE_H

#include "harness/run/bodies_engine.h"
#include "harness/run/cell.h"

typedef struct mote_bodies_options {
    uint32_t first, last;  /* frames, inclusive; 0, 0: all */
    double timeout;        /* seconds of the process; 0: none */
    double budget;         /* seconds after which no further step begins; 0: none */
    uint32_t least;        /* steps that are made even so */
    const char *directory; /* where step and pair records go, or NULL: none */
    uint32_t replicate;    /* from 1: part of the records' names */
} mote_bodies_options;

/* A contact: bodies a < b, from 0. */
typedef struct mote_bodies_contact {
    uint32_t frame, a, b;
} mote_bodies_contact;

typedef struct mote_bodies_timed {
    uint32_t frame;
    uint64_t motion_ns; /* poses and weights; of the other thread with ahead= */
    uint64_t total_ns;  /* all that the step took but motion */
    mote_bodies_step step;
} mote_bodies_timed;

typedef struct mote_bodies_result {
    mote_cell_status status;
    char reason[400]; /* one line; empty when ok */
    uint64_t build_ns;
    uint64_t wall_ns; /* of all steps, motion and records included */
    bool heap_counted;
    int64_t heap_live_bytes, heap_peak_bytes; /* frames and engine; shared meshes left out */
    int64_t rss_peak_bytes;
    mote_bodies_timed *steps; /* [step_count] */
    size_t step_count;
    mote_bodies_contact *contacts; /* [contact_count], ascending */
    size_t contact_count;
} mote_bodies_result;

/* Runs the frames in a child process, pinned to a core unless it has several threads. A method
   that crashes or takes too long is a result with that status. MOTE_EINVAL for frames beyond
   the scenario's; MOTE_EIO when files cannot be written or a signal asked to stop. Free the
   result with mote_bodies_result_free. */
mote_status mote_bodies_measure(const mote_bodies *bodies, const mote_bodies_choice *choice,
                                const mote_bodies_options *options, mote_bodies_result *result);

void mote_bodies_result_free(mote_bodies_result *result);

/* Median of a part of the steps' times, in nanoseconds, without the first step, which finds all
   pairs anew (unless it is the only one). */
typedef uint64_t (*mote_bodies_part)(const mote_bodies_timed *step);
double mote_bodies_median(const mote_bodies_result *result, mote_bodies_part part);

#endif
