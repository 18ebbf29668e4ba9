/* Compares two runs, from their cells, or from summary.json if there are none: counts, bytes
   and accuracy directly, times as ratios with intervals. */
#ifndef MOTE_HARNESS_COMPARE_H
#define MOTE_HARNESS_COMPARE_H

#include "harness/base/file.h"
#include "harness/base/statistics.h"
#include "harness/loop/simulations.h"

#include <jansson.h>

/* How much the relative cost of two methods may differ between two kinds of processors. */
#define MOTE_OTHER_MACHINE_FLOOR 0.5

/* A row that both runs have. */
typedef struct mote_change {
    char *name;   /* "ww/particle-paper:n=5/hot": scene, label and caches; or
                     "ww/certified/simulated" */
    double ratio; /* time new / base; relative to fcl-aabb within each run if both have it */
    mote_confidence interval; /* of the ratio: t over groups of quiet times where both rows have
                                 the same replicates, otherwise over those that both have */
    double p;                 /* for no change, corrected by Holm over all rows */
    mote_verdict verdict;     /* of the time */
    double smallest_change;   /* smallest detectable change, a share; MOTE_NONE: unknown */
    bool is_reference;        /* fcl-aabb itself: its time says nothing about our methods */
    bool worse;     /* slower, more counted, more bytes, less accurate, or no longer known */
    bool better;    /* faster, less counted, fewer bytes, more accurate, and nothing worse */
    bool counted;   /* a count changed */
    bool executed;  /* instructions changed */
    bool unknown;   /* something that the base has cannot be compared: undecided */
    mote_text what; /* "counts changed: positions +5.7 %; cost per count unchanged" */
} mote_change;

typedef struct mote_comparison {
    mote_change *changes;
    size_t count;
    double floor;               /* the smallest effect on time that counts, a share */
    bool other_machine;         /* the processors differ, so the floor is wide */
    bool instructions;          /* both runs counted them */
    size_t only_base, only_new; /* rows without a partner */
    bool worse, undecided;      /* of any row; also undecided if the base has more rows */
} mote_comparison;

/* A share by which equal counts may differ. */
#define MOTE_EXACT_SHARE 1e-9

/* Notes that something in the base cannot be compared, which makes the row undecided. */
void mote_change_unknown(mote_change *change, const char *what);

/* Compares a value of which less is better, equal within a share, and notes a difference. A
   value that only the base has is worse, one that only the new run has is neither. */
void mote_change_figure(mote_change *change, const char *name, double base, double fresh,
                        double share);

/* Sets the ratio of times new / base, its interval and p from the logarithms of paired times.
 */
void mote_change_times(mote_change *change, const double *logs, size_t count);

/* Compares the simulations of two directories: what methods missed and how deep bodies went,
   over the replicates that both have, and times where no other simulation ran beside them.
   Appends to comparison->changes. */
void mote_compare_simulations(const mote_simulations *base, const mote_simulations *fresh,
                              mote_comparison *comparison);

/* Compares directories (or summary.json files). floor: a share, a minimum that the noise floors
   of both runs can raise. A time is slower only if its ratio is beyond the floor and beyond the
   smallest change that the rows can detect. If manifest.json names another processor, times are
   compared only as ratios to fcl-aabb, from MOTE_OTHER_MACHINE_FLOOR on. Where these are to
   different configurations of fcl-aabb, times are compared as they are, on one machine. Counts,
   bytes, accuracy and the number of failed replicates are compared directly, and so are
   simulations; accuracy and counts over the replicates that both rows have, and a row is
   undecided where a summary.json does not have these alone. Rows are the same as
   mote_compared_partner says.
   Instructions (instructions.json of both) may grow by 1 %; with another processor or compiler
   they are reported but not judged. MOTE_EIO or MOTE_EINVAL if a summary, or an existing
   manifest.json or instructions.json, cannot be read; MOTE_EINVAL if the runs have no row in
   common. The caller frees *comparison. */
mote_status mote_compare(const char *base, const char *new_run, double floor,
                         mote_comparison *comparison);
void mote_comparison_free(mote_comparison *comparison);

#endif
