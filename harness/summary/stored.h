/* The cells of a run directory, read back: what summaries, comparisons and claims are made
 * from. */
#ifndef MOTE_HARNESS_STORED_H
#define MOTE_HARNESS_STORED_H

#include "core/method/method.h"
#include "harness/run/cell.h"
#include "harness/base/file.h"

/* A count and its sum and largest value over the frames of a cell. */
typedef struct mote_stored_count {
    double sum, max;
} mote_stored_count;

/* One more for each name. NOLINTNEXTLINE(bugprone-macro-parentheses) */
#define MOTE_STORED_ONE(name) +1
enum {
    MOTE_STORED_COUNTS = 1 MOTE_COUNTERS(MOTE_STORED_ONE) MOTE_COUNTERS_MORE(MOTE_STORED_ONE)
};
#undef MOTE_STORED_ONE

/* "steps", "moves", ..., "allocations" at the end. */
extern const char *const mote_stored_count_names[MOTE_STORED_COUNTS];

/* One cell. Frame arrays are [frames]; NULL and 0 where status is not "ok". */
typedef struct mote_stored_cell {
    json_t *json; /* the whole cell file */
    char *group;  /* equal for the replicates of one configuration on one scene */
    const char *id, *scenario, *fingerprint, *method, *cache; /* inside json */
    const char *machine, *ask;                                /* likewise; "" if not stored */
    json_t *parameters;                                       /* likewise */
    mote_cell_status status;
    uint32_t replicate, stride;
    uint64_t seed;           /* the run's */
    uint64_t replicate_seed; /* the seed of this process: mote_replicate_seed */
    uint32_t jobs;           /* cells that ran at the same time; 1: times are comparable */
    uint32_t first, last;    /* of the frames asked for; 0 where the cell has no such number */
    uint32_t active_first, active_last; /* 0, 0 when the scenario names none */
    size_t frames;
    uint32_t *frame; /* numbers, rising */
    double *deform_ns, *update_ns, *query_ns;
    double *total_ns; /* their sum */
    double *error;    /* signed, in L; MOTE_NONE without an answer */
    double *truth;
    signed char *contact; /* 1, 0, or -1 without an answer */
    signed char *contact_truth;
    double *scene[MOTE_SCENE_COLUMN_COUNT]; /* of more than two bodies; else NULL */
    uint32_t bodies;                        /* of these; 0: two */
    mote_stored_count counts[MOTE_STORED_COUNTS];
} mote_stored_cell;

typedef struct mote_stored {
    mote_stored_cell *cells; /* sorted by group, then replicate */
    size_t count;
    size_t left_out; /* measured by another program than the manifest's */
} mote_stored;

/* Reads directory/cells. Cells of another program than the one that manifest.json names are
   counted and left out. MOTE_EIO without a run there, MOTE_EINVAL with file and line when a
   file is not what mote wrote; unless damaged is given, to which such a file is a line, and the
   others are read. The caller frees *stored. */
mote_status mote_stored_read(const char *directory, mote_text *damaged, mote_stored *stored);
void mote_stored_free(mote_stored *stored);

/* Whether a cell has frames: it ended well. */
bool mote_stored_ran(const mote_stored_cell *cell);

/* Moves *i in a and *k in b on to the next frame that both have, where they are or further;
   false: there is none. for (size_t i = 0, k = 0; mote_stored_common(a, &i, b, &k); ++i, ++k)
 */
bool mote_stored_common(const mote_stored_cell *a, size_t *i, const mote_stored_cell *b,
                        size_t *k);

/* A number of a cell's file, or MOTE_NONE where it is null or missing. Bytes are whole, below
   2^62. */
double mote_stored_number(const mote_stored_cell *cell, const char *key);

#endif
