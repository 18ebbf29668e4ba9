/* Invented measurements that studies get instead of real ones (--wrap: see
   tests/CMakeLists.txt). The studies' results must follow from them, and any call can be made
   to fail. */
#ifndef MOTE_TESTS_PLANTED_H
#define MOTE_TESTS_PLANTED_H

#include "harness/run/cell.h"
#include "harness/study/extreme.h"

typedef struct plants {
    long calls, failing; /* calls so far that may fail; the one that does, or 0 */
    long simulated;      /* rows of approaches so far */
    const char *folder;  /* where scenarios are written */
    double error;        /* of particles, in L */
    double exponent;     /* of times, over any quantity */
    double moving;       /* share of particles that move in each step but the last */
    double (*slowdown)(const mote_cell *cell); /* a factor on the time of a cell measured in
                                                  this process; NULL: 1 */
    bool contact_seen;                         /* particles saw the contact */
    uint64_t blind;        /* from starts with seeds up to this one they never do */
    double ours_ns;        /* of particles and certified */
    double trees_ratio;    /* how many times as long trees take */
    size_t rows;           /* rows of the run against hierarchies, PLANTED_ROWS at most */
    uint64_t passes;       /* of bodies through each other, with the paper's particles */
    bool others_pass;      /* exact methods let one pass */
    double ratio;          /* of the first control's time over the others', several bodies */
    bool body_missed;      /* an exact method missed a contact of several bodies */
    bool body_failed;      /* a cell of several bodies crashed, and one of the run */
    bool replicate_failed; /* a replicate of each row of several bodies crashed, another did not
                            */
    bool bodies_failed;    /* all cells of several bodies crashed */
    bool body_alone;       /* no exact method to compare contacts with */
    int64_t body_bytes;    /* of each process of several bodies */
    mote_extreme_verdict ours_verdict, others_verdict; /* of certified; of other methods */
} plants;

#define PLANTED_ROWS 22

extern plants planted;

/* Sets values with which every study succeeds; planted.folder stays. */
void plant_good(void);

#endif
