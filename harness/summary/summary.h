/* The summary of a run: one row a configuration, from its cells alone. */
#ifndef MOTE_HARNESS_SUMMARY_H
#define MOTE_HARNESS_SUMMARY_H

#include "harness/base/statistics.h"
#include "harness/summary/stored.h"

/* A time over frames and replicates, in nanoseconds. median, p95 and max are over all frames of
   all replicates; the interval is the median's (mote_statistics_median_interval); sum is the
   mean over replicates of the sum over frames. */
typedef struct mote_time {
    double median, low, high, mean, p95, max, sum;
} mote_time;

/* How many times slower another row is: median over common frames and replicates of (the
   other's total / this total). */
typedef struct mote_ratio {
    size_t to; /* index of the other row; SIZE_MAX: there is none */
    double value, low, high;
} mote_ratio;

/* One process of a row, in the order of its cells; MOTE_NONE where it did not end well. */
typedef struct mote_process {
    double median; /* of the total, nanoseconds */
    double ratio;  /* paired median of (reference's total / this total), as in row.ratio */
} mote_process;

/* Times with the disturbances of a shared machine taken out as far as replicates allow: of each
   frame the fastest of a group of replicates, then the median over frames. Groups are
   blocks of consecutive replicates; with fewer than MOTE_QUIET_REPLICATES all is MOTE_NONE. */
#define MOTE_QUIET_GROUPS 5
#define MOTE_QUIET_REPLICATES 10
typedef struct mote_quiet {
    double total[MOTE_QUIET_GROUPS]; /* nanoseconds */
    double
        ratio[MOTE_QUIET_GROUPS]; /* median over frames of (reference's / this), or MOTE_NONE */
} mote_quiet;

/* Errors are in L; MOTE_NONE where no frame has an answer. */
typedef struct mote_error_summary {
    double median, p95, p99, max; /* of the absolute error */
    double min_signed, max_signed;
    double exact_rate;           /* share of frames with absolute error <= 1e-9 */
    double exact_rate_separated; /* the same where truth > 0 */
} mote_error_summary;

#define MOTE_EXACT_ERROR 1e-9

/* The times of a row, X(name, JSON key). given leaves deformation out: nobody is charged for
 * it. */
#define MOTE_TIMES(X)                                                                          \
    X(total, "total_ns")                                                                       \
    X(deform, "deform_ns")                                                                     \
    X(update, "update_ns")                                                                     \
    X(query, "query_ns")                                                                       \
    X(active_total, "active_total_ns")                                                         \
    X(given_total, "given_total_ns")

typedef struct mote_summary_row {
    const mote_stored_cell *cells; /* [replicates], in the summary's stored */
    size_t replicates;             /* that ran, whatever their end */
    size_t finished;               /* of these, with status ok; they come first in no order */
    const mote_stored_cell *first; /* one with status ok, or else one of the row's status */
    mote_cell_status status; /* ok when any replicate is, else the worst: crashed, timeout */
    char *label;             /* "particle-paper:n=5": parameters that are not default */
    double n;                /* the parameter n, or MOTE_NONE */
    size_t frames;           /* of one replicate */
    uint32_t
        jobs; /* cells that ran at the same time; with 2 or more no ratio is made of its times
               */
    double smallest_change;  /* mote_statistics_detectable - 1 of its times, or MOTE_NONE */
    mote_process *processes; /* [replicates] */
    mote_quiet quiet;
#define MOTE_TIME_FIELD(name, key) mote_time name;
    MOTE_TIMES(MOTE_TIME_FIELD)
#undef MOTE_TIME_FIELD
    mote_ratio ratio;       /* to fcl-aabb:seed=none,queue=2, or the first fcl-aabb there is, of
                               those that were measured on all of this row's frames */
    mote_ratio ratio_given; /* the same where nobody is charged for deformation */
    mote_ratio ratio_best;  /* to the row of FCL that is the fastest over this row's frames */
    mote_error_summary error;
    double contacts, missed, false_contacts;                 /* frames, mean over replicates */
    double heap_live_bytes, heap_peak_bytes, rss_peak_bytes; /* largest, or MOTE_NONE */
} mote_summary_row;

/* Clock and bookkeeping in a timed call, medians over the cells; MOTE_NONE when not stored. */
typedef struct mote_overhead {
    double clock_ns; /* subtracted from every time */
    double left_ns;  /* what is left then */
    double share;    /* of that, at most, in the fastest median total; a frame has up to three
                        timed    calls, with time 0 where there is none */
} mote_overhead;

typedef struct mote_summary {
    mote_stored stored;
    mote_summary_row *rows; /* by scene (mote_stored_by_scene), frames, method, n */
    size_t count;
    double noise_floor; /* see mote_summary_noise_floor */
    mote_overhead overhead;
    double smallest_change; /* of rows, not exceeded by nine in ten; MOTE_NONE without any */
} mote_summary;

/* Reads a run directory and computes its rows. The caller frees *summary. */
mote_status mote_summary_make(const char *directory, mote_summary *summary);
/* The same of what is whole: a cell that cannot be read is left out, and a line of damaged. */
mote_status mote_summary_make_whole(const char *directory, mote_text *damaged,
                                    mote_summary *summary);
void mote_summary_free(mote_summary *summary);

/* Whether rows were measured on more than one machine. Those of different machines are never
   put into one row nor compared. */
bool mote_summary_machines_differ(const mote_summary *summary);

/* How much rows differ from themselves when nothing changed, as a share (0.03: 3 %), exceeded
   by one row in ten: the first half of the replicates against the second, quiet times
   where there are enough replicates, else medians. MOTE_NONE when no row has two replicates.
   Part of mote_summary_make. */
mote_status mote_summary_noise_floor(const mote_summary_row *rows, size_t count, double *floor);

/* Sets smallest_change of each row, from its quiet times where there are enough replicates,
   else its processes; relative to fcl-aabb where the row has a ratio. *smallest: not exceeded
   by nine rows in ten. Part of mote_summary_make. */
mote_status mote_summary_smallest_change(mote_summary_row *rows, size_t count,
                                         double *smallest);

/* The summary as the object that summary.json holds; NULL when memory ran out. */
json_t *mote_summary_json(const mote_summary *summary);

/* Writes directory/summary.json, and fronts.csv and speed.csv (harness/summary/front.h). */
mote_status mote_summary_write(const mote_summary *summary, const char *directory);

#endif
