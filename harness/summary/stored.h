/* Reads the cells of a run directory: the basis of summaries, comparisons and claims. */
#ifndef MOTE_HARNESS_STORED_H
#define MOTE_HARNESS_STORED_H

#include "core/method/method.h"
#include "harness/run/cell.h"
#include "harness/base/file.h"

/* The sum and the largest value of a count over the frames of a cell. */
typedef struct mote_stored_count {
    double sum, max;
} mote_stored_count;

/* Adds one for each name. NOLINTNEXTLINE(bugprone-macro-parentheses) */
#define MOTE_STORED_ONE(name) +1
enum {
    MOTE_STORED_COUNTS = 1 MOTE_COUNTERS(MOTE_STORED_ONE) MOTE_COUNTERS_MORE(MOTE_STORED_ONE)
};
#undef MOTE_STORED_ONE

/* "steps", "moves", ...; "allocations" is last. */
extern const char *const mote_stored_count_names[MOTE_STORED_COUNTS];

/* One cell. Frame arrays are [frames]; NULL and 0 unless status is "ok". */
typedef struct mote_stored_cell {
    json_t *json; /* the whole cell file */
    char *group;  /* equal for the replicates of one configuration on one scene */
    const char *id, *scenario, *fingerprint, *method, *cache; /* inside json */
    const char *faces, *machine, *ask;                        /* inside json; "" if not
                                                                 stored */
    json_t *parameters;                                       /* inside json */
    mote_cell_status status;
    uint32_t replicate, stride;
    uint64_t seed;           /* the run's */
    uint64_t replicate_seed; /* the seed of this process: mote_replicate_seed */
    uint32_t jobs;           /* cells that ran at the same time; 1: times are comparable */
    uint32_t step;           /* frames that a question about impacts spans; 0: of others */
    uint32_t first, last;    /* of the frames requested; 0 if the cell does not store it */
    uint32_t active_first, active_last; /* 0, 0 if the scenario names none */
    size_t frames;
    uint32_t *frame; /* numbers, rising */
    double *deform_ns, *update_ns, *query_ns;
    double *total_ns; /* their sum */
    double read_ns;   /* reading all positions once; 0 for a method that is told the field;
                         MOTE_NONE if the cell does not store it */
    double *error;    /* signed, in L; MOTE_NONE without an answer */
    double *truth;
    signed char *contact; /* 1, 0, or -1 without an answer */
    signed char *contact_truth;
    double *scene[MOTE_SCENE_COLUMN_COUNT];   /* more than two bodies; otherwise NULL */
    double *impact[MOTE_IMPACT_COLUMN_COUNT]; /* of questions about impacts: MOTE_NONE where a
                                                 field is empty; otherwise NULL */
    uint32_t bodies;                          /* if more than two; 0: two bodies */
    mote_stored_count counts[MOTE_STORED_COUNTS];
} mote_stored_cell;

typedef struct mote_stored {
    mote_stored_cell *cells; /* sorted by group, then replicate */
    size_t count;
    size_t left_out; /* measured by a program other than the manifest's */
} mote_stored;

/* Reads directory/cells. Cells of a program other than the one in manifest.json are counted and
   left out. MOTE_EIO if there is no run; MOTE_EINVAL with file and line if mote did not write a
   file, unless damaged is given: it then receives a line for such a file, and the others are
   read. The caller frees *stored. */
mote_status mote_stored_read(const char *directory, mote_text *damaged, mote_stored *stored);
void mote_stored_free(mote_stored *stored);

/* Whether a cell has frames: it ran to its end. */
bool mote_stored_ran(const mote_stored_cell *cell);

/* Advances *i in a and *k in b to the next frame that both have, at or after their positions;
   false if there is none. for (size_t i = 0, k = 0; mote_stored_common(a, &i, b, &k); ++i,
   ++k) */
bool mote_stored_common(const mote_stored_cell *a, size_t *i, const mote_stored_cell *b,
                        size_t *k);

/* Whether a cell measured the scene with these hashes. A cell of an older version does not
   store that of the faces: its vertices decide. */
bool mote_stored_is_of(const mote_stored_cell *cell, uint64_t fingerprint, uint64_t faces);

/* A number in a cell's file, or MOTE_NONE if it is null or missing. Bytes are whole, below
   2^62. */
double mote_stored_number(const mote_stored_cell *cell, const char *key);

#endif
