/* A bout: one process of each program; they take turns measuring the same frames on one
   core. */
#ifndef MOTE_HARNESS_BOUT_H
#define MOTE_HARNESS_BOUT_H

#include "harness/race/racer.h"
#include "harness/run/cell.h"

enum { MOTE_RACE_A, MOTE_RACE_B, MOTE_RACE_SIDES };

#define MOTE_RACE_COUNTS 24 /* different counts that a program may send */

/* A count's sum over the frames. */
typedef struct mote_race_count {
    char name[32];
    double sum[MOTE_RACE_SIDES];
} mote_race_count;

/* What both programs are asked to measure. */
typedef struct mote_race_cell {
    const char *scenario, *method; /* as on the command line; borrowed */
    uint32_t first, last;          /* frames; last 0: to the scenario's end */
    mote_cache cache;
    uint64_t seed; /* for the method */
} mote_race_cell;

/* What a program says of the scenario of a cell. */
typedef struct mote_race_scene {
    uint64_t fingerprint, faces; /* 0 unless they were asked for */
    char ask[16];  /* "": a program that does not say what follows, or the faces */
    uint32_t step; /* frames that a question about impacts spans; 0: of others */
    double tolerance;
} mote_race_scene;

/* Whether and why one side did not finish a cell. */
typedef struct mote_race_side {
    bool refused, failed; /* it did not open the cell; it crashed, took too long or could not
                             answer about a frame */
    char reason[400];
} mote_race_side;

/* The result of a bout for a cell. */
typedef struct mote_bout_result {
    mote_race_side side[MOTE_RACE_SIDES];
    bool same_scene;       /* both sides have the same frames and faces, if checked, and are
                              asked the same */
    mote_race_scene scene; /* as one of them says, which says more */
    double log_ratio;      /* of times: see harness/race/paired.h */
    double total_ns[2];    /* per frame */
    uint32_t frames, passes, blocks;
    mote_race_count counts[MOTE_RACE_COUNTS]; /* of the first pass */
    size_t count_count;
    double worst;         /* the largest difference of two answers, in L, or of two times of
                             impact, as a part of the question's; 0: equal bits */
    uint32_t worst_frame; /* frame of that difference */
} mote_bout_result;

typedef struct mote_bout_options {
    const char *program[MOTE_RACE_SIDES];
    int core;
    double timeout;      /* per answer, seconds */
    bool check_scene;    /* compare the scenarios' fingerprints and faces */
    mote_random *random; /* for orders and layouts */
} mote_bout_options;

typedef struct mote_bout {
    mote_bout_options options;
    mote_racer racer[MOTE_RACE_SIDES];
    size_t cells[MOTE_RACE_SIDES]; /* number of cells opened */
} mote_bout;

/* Starts both processes. Errors as mote_racer_start. End it with mote_bout_stop, even after a
   failure. */
mote_status mote_bout_start(const mote_bout_options *options, mote_bout *bout);

/* Measures a cell by both sides in turn. A failure of a side is part of the result; it ends the
   bout after the other side's turn at the same frames. MOTE_EIO if a signal asked to stop. */
mote_status mote_bout_run(mote_bout *bout, const mote_race_cell *cell,
                          mote_bout_result *result);
void mote_bout_stop(mote_bout *bout);

#endif
