/* The simulations that a directory keeps (DIRECTORY/simulations/ID.json), combined over
   replicates: rows for tables, comparisons and the report. */
#ifndef MOTE_HARNESS_SIMULATIONS_H
#define MOTE_HARNESS_SIMULATIONS_H

#include "harness/base/statistics.h"
#include "harness/loop/simulation.h"

#include <jansson.h>
#include <stdio.h>

/* A stored simulation that ended. */
typedef struct mote_simulation_replicate {
    uint32_t number; /* from 1 */
    mote_simulation_result result;
} mote_simulation_replicate;

/* A method on a scenario, under the same options, by one program on one machine. */
typedef struct mote_simulations_row {
    json_t *question;              /* see mote_simulation_question */
    json_t *origin;                /* {"program", "machine"} */
    const char *scenario, *method; /* displayed names, part of question */
    uint32_t bodies;
    mote_simulation_replicate *replicates; /* [done], by their numbers */
    uint32_t done, failed;                 /* the rest are unsupported */
    char *unsupported;                     /* why, or NULL */
    mote_simulation_result sum;            /* see mote_simulation_add */
    double query_ns;          /* median over replicates of the mean time per step */
    mote_confidence interval; /* of it */
    bool alone;               /* no other simulation ran beside it: its time is comparable */
} mote_simulations_row;

/* Zero-initialise. */
typedef struct mote_simulations {
    mote_simulations_row *rows; /* sorted by scenario and method */
    size_t count;
    size_t left_out; /* stored simulations of other programs */
} mote_simulations;

/* What a stored simulation asks, the same for all replicates and programs: scenario, method,
   parameters, options, the seed of the first replicate. The caller decrefs. */
json_t *mote_simulation_question(const json_t *stored);

/* Whether two questions are the same. One that an older version stored does not name its faces,
   and is taken for those of the other. */
bool mote_simulation_same_question(const json_t *a, const json_t *b);

/* Whether a directory keeps simulations. */
bool mote_simulations_exist(const char *directory);

/* Makes the folder for them. Errors of mote_directory_make. */
mote_status mote_simulations_make(const char *directory);

/* Copies the simulations of one directory that the other lacks, or has as failed ones, and
   writes the other's simulations.json; *copied and *present count them. */
mote_status mote_simulations_copy(const char *from, const char *to, size_t *copied,
                                  size_t *present);

/* Reads a directory's simulations; damaged files are left out, since `mote simulate` makes them
   again. Those of a program other than the one in manifest.json are counted and left out.
   MOTE_EIO, with the path, if the directory keeps none. The caller frees *list even after a
   failure. */
mote_status mote_simulations_read(const char *directory, mote_simulations *list);

/* The same of a given program ("": any), while manifest.json is still that of an earlier one.
 */
mote_status mote_simulations_read_of(const char *directory, const char *program,
                                     mote_simulations *list);
void mote_simulations_free(mote_simulations *list);

/* {"schema": 1, "simulations_left_out", "rows": [...]}: a row has the keys of `mote simulate
   --json` and "fingerprint", "faces", "replicates", "replicates_failed", "query_ns_low",
   "query_ns_high"; without a result it has no figures, and "unsupported" if the method cannot
   answer. If all rows are of one scenario, the object has its "scenario", "fingerprint",
   "faces" and "bodies" too. The caller decrefs. */
json_t *mote_simulations_json(const mote_simulations *list);

/* Writes DIRECTORY/simulations.json. */
mote_status mote_simulations_write(const mote_simulations *list, const char *directory);

/* Prints each row's figures and the interval of its time, as lines for people. */
void mote_simulations_print(const mote_simulations *list, FILE *out);

#endif
