/* Measurements that studies are given instead of real ones (--wrap: see tests/CMakeLists.txt):
   their results must follow from these, and any call may be made to fail. */
#ifndef MOTE_TESTS_PLANTED_H
#define MOTE_TESTS_PLANTED_H

#include "harness/study/extreme.h"

typedef struct plants {
    long calls, failing; /* calls that may fail, so far; the one that does, or 0 */
    long simulated;      /* rows of approaches, so far */
    const char *folder;  /* where scenarios are written */
    double error;        /* of particles, in L */
    double exponent;     /* of times, over anything */
    bool contact_seen;   /* by particles */
    double ours_ns;      /* of particles; of trees, a thousand times as much */
    size_t rows;         /* that the run against hierarchies has, PLANTED_ROWS at most */
    uint64_t passes;     /* through each other, of bodies by the paper's particles */
    bool others_pass;    /* exact methods let one pass */
    double ratio;        /* of the first control's time over others', several bodies */
    bool body_missed;    /* an exact method missed a contact of several bodies */
    bool body_failed;    /* a cell of theirs crashed, and one of the run */
    bool bodies_failed;  /* all of theirs crashed */
    bool body_alone;     /* nothing exact to compare contacts with */
    int64_t body_bytes;  /* of each process of theirs */
    mote_extreme_verdict ours_verdict, others_verdict; /* of certified; of other methods */
} plants;

#define PLANTED_ROWS 10

extern plants planted;

/* Sets values with which every study succeeds; planted.folder stays. */
void plant_good(void);

#endif
