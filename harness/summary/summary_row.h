/* One row of a summary: statistics over the replicates of one configuration. */
#ifndef MOTE_HARNESS_SUMMARY_ROW_H
#define MOTE_HARNESS_SUMMARY_ROW_H

#include "harness/base/statistics.h"
#include "harness/summary/stored.h"

typedef struct mote_summary_row mote_summary_row;

/* A time over frames and replicates, in nanoseconds. median, p95 and max are over all frames of
   all replicates; the interval is the median's (mote_statistics_median_interval); sum is the
   mean over replicates of the sum over frames. */
typedef struct mote_time {
    double median, low, high, mean, p95, max, sum;
} mote_time;

/* How many times slower another row is: the median over common frames and replicates of (the
   other's time / this time). The time is the total or, for a row with positions given, the time
   without deformation on both sides. A row's ratio to itself is 1 and has no interval. */
typedef struct mote_ratio {
    const mote_summary_row *to; /* the other row, in the same summary; NULL: none */
    double value, low, high;
} mote_ratio;

/* A deterministic count over the frames of all processes. */
typedef struct mote_row_count {
    const char *name;
    double mean, max;
} mote_row_count;

/* A process that succeeded. */
typedef struct mote_process {
    uint32_t replicate;
    double median;      /* of the total, nanoseconds */
    double ratio;       /* paired median of (reference's total / this total), as in row.ratio */
    const double *sums; /* [count_count] of the row: sum of each count over the frames, or
                           MOTE_NONE */
} mote_process;

/* Times without the disturbances of a shared machine, as far as replicates allow: for each
   frame the fastest of a group of replicates, then the median over frames. Groups are blocks of
   consecutive replicates; below MOTE_QUIET_REPLICATES everything is MOTE_NONE. */
#define MOTE_QUIET_GROUPS 5
#define MOTE_QUIET_REPLICATES 10
typedef struct mote_quiet {
    double total[MOTE_QUIET_GROUPS]; /* nanoseconds */
    double ratio[MOTE_QUIET_GROUPS]; /* median over frames of (reference's / this) */
} mote_quiet;

/* The same over all replicates: for each frame the fastest of them. Comparable only between
   rows of equally many replicates, since the least of more is less. */
typedef struct mote_least {
    double median;      /* over frames, nanoseconds */
    double settled_sum; /* from the MOTE_SETTLED_FROM-th frame measured on, if there are at
                           least MOTE_SETTLED_LEAST; otherwise over all */
} mote_least;

/* Before its 50th frame, a method may still build what it needs. */
#define MOTE_SETTLED_FROM 50
#define MOTE_SETTLED_LEAST 60

/* Errors are in L; MOTE_NONE if no frame has an answer. */
typedef struct mote_error_summary {
    double median, p95, p99, max; /* of the absolute error */
    double min_signed, max_signed;
    double exact_rate;           /* share of frames with absolute error <= 1e-9 */
    double exact_rate_separated; /* the same where truth > 0 */
} mote_error_summary;

#define MOTE_EXACT_ERROR 1e-9

/* Of questions about impacts; MOTE_NONE of others. */
typedef struct mote_impact_summary {
    double undecided; /* mean over replicates */
    double bracket;   /* the widest, as a part of a question's time */
    double delay;     /* the largest distance in time from the first impact, in frames */
    double iterations_median, iterations_p95;
} mote_impact_summary;

/* Everything in summary.json about a configuration, and its origin. Each member from `scenario`
   on is a column (column.h), by which rows are written and read; missing texts are "" and
   missing numbers MOTE_NONE. */
struct mote_summary_row {
    const mote_stored_cell *cells; /* [replicates], in the summary's stored; NULL if the row was
                                      read from a summary.json */
    size_t replicates;             /* of the cells; 0 without cells */
    const mote_stored_cell *first; /* one with status ok, otherwise one with the row's status */
    mote_cell_status status; /* ok if any replicate is, otherwise the worst: crashed, timeout;
                                MOTE_CELL_STATUSES if a summary.json names none of these */
    bool given;              /* positions=given: its own time excludes deformation */

    const char *scenario, *fingerprint, *faces, *cache, *machine, *ask, *method;
    char *label; /* "particle-paper:n=5": parameters that are not default */
    char *
        scene; /* "ww", or "ww (scene 0123abcd)" where another of that name is in the summary */
    const char *ending, *reason; /* the status as text; why it is not ok */
    const char *accounting;      /* "charged" or "given" */
    const char *told;            /* "field" or "positions"; "" if the cell does not store it */
    const char *seeds;           /* "own" or "fixed"; "" if the cell does not store it */
    json_t *parameters;          /* owned by the cell or the summary.json */
    double n, tolerance;         /* the parameter n; the scenario's tolerance */
    uint64_t seed;
    uint32_t frame_range[2]; /* first and last of the frames requested */
    uint32_t active[2];      /* the active interval; 0, 0: none */
    uint32_t stride, jobs;   /* jobs: cells that ran at the same time */
    uint32_t step;           /* frames that a question about impacts spans; 0: of others */
    uint32_t triangles[2], vertices[2];
    uint32_t bodies, shapes;  /* 0: two bodies */
    double near_pairs_wanted; /* per body, as the scenario requests */
    size_t frames;            /* of one replicate */
    size_t finished, failed;  /* replicates that succeeded or not */
    bool times_comparable;    /* jobs is 1 */
    double smallest_change;   /* mote_statistics_detectable - 1 of its times */

    mote_time total, deform, update, query, active_total;
    mote_time given_total;  /* without deformation */
    mote_time read_total;   /* the same, with a pass over the positions if it is told them */
    mote_ratio ratio;       /* to fcl-aabb:seed=none,queue=2, or the first fcl-aabb, among those
                               measured on all of this row's frames */
    mote_ratio ratio_given; /* the same without deformation */
    mote_ratio ratio_best;  /* to the fastest FCL row over this row's frames */
    mote_ratio ratio_engine; /* likewise, of all engines of others whose answers are right */
    mote_error_summary error;
    mote_impact_summary impact;
    double contacts, missed, false_contacts; /* frames, mean over replicates */
    /* For more than two bodies, contacts count pairs and frames; missed and false_contacts are
       relative to another row, an exact one. */
    const mote_summary_row *contacts_of;  /* that row; NULL: none */
    double near_pairs;                    /* mean per frame */
    const mote_summary_row *dominated_by; /* the fastest row that dominates this one
                                             (dominance.h); NULL: none */
    bool on_front;                        /* measured, and not dominated by any row */
    bool stands_for_method; /* the row shown where a method has only one (dominance.h) */
    double heap_live_bytes, heap_peak_bytes, rss_peak_bytes; /* the largest */
    double heap_bytes_per_vertex;

    mote_row_count *counts; /* [count_count] */
    size_t count_count;
    mote_process *processes; /* [process_count], those that succeeded, by replicate */
    size_t process_count;
    double *sums; /* [process_count][count_count], for processes */
    mote_quiet quiet;
    mote_least least;
};

/* Makes a row from its cells [replicates], without the ratios. */
mote_summary_row mote_summary_row_make(const mote_stored_cell *cells, size_t replicates);

/* Sets a row's errors and contacts from its cells, of which `finished` succeeded. */
void mote_summary_row_answers(mote_summary_row *row);

/* The part of a frame's time that is compared: all of it, or all but deformation. */
typedef enum mote_part { MOTE_PART_TOTAL, MOTE_PART_GIVEN } mote_part;

/* The median time over the frames first .. last of all replicates; MOTE_NONE without any. */
double mote_summary_median_within(const mote_summary_row *row, uint32_t first, uint32_t last,
                                  mote_part part);

/* The successful replicate with a number, or NULL. */
const mote_stored_cell *mote_summary_replicate(const mote_summary_row *row, uint32_t number);

/* Whether the row's method is one of FCL's. */
bool mote_summary_is_fcl(const mote_summary_row *row);

/* Whether a method, or that of a row, is an engine that others wrote (FCL, Coal, ODE, Bullet or
   Embree), as they would have it used. */
bool mote_summary_engine_name(const char *method);
bool mote_summary_is_engine(const mote_summary_row *row);
/* Whether it also gave no wrong answer: an engine that misses contacts or invents them is no
   rival. */
bool mote_summary_is_right_engine(const mote_summary_row *row);

/* Whether a row has a time that may be compared with other rows. */
bool mote_summary_row_measured(const mote_summary_row *row);

/* Whether a row has neither missed nor false contacts; and whether, in addition, every distance
   that it gives is exact. */
bool mote_summary_contacts_right(const mote_summary_row *row);
bool mote_summary_row_right(const mote_summary_row *row);

/* The order by active intervals. Those of more than two bodies follow from the frames, and are
   equal. */
int mote_summary_by_interval(const mote_summary_row *a, const mote_summary_row *b);

/* The order of scenes: by scenario, caches (hot first), machine, fingerprint, faces,
   active interval and question, its step and its tolerance. 0: the same frames and question on
   one machine. Different scenes are never compared. */
int mote_summary_by_scene(const mote_summary_row *a, const mote_summary_row *b);

/* The order of rows by the frames requested: earlier start first, then longer. */
int mote_summary_by_asked_frames(const mote_summary_row *a, const mote_summary_row *b);

/* The same, of many bodies then by the frames measured, more first, since the budget may have
   ended a cell early. */
int mote_summary_by_frames(const mote_summary_row *a, const mote_summary_row *b);

/* Whether two rows are in one block: the same frames and question, on one machine. */
bool mote_summary_same_block(const mote_summary_row *a, const mote_summary_row *b);

/* Frees the row's contents. */
void mote_summary_row_free(mote_summary_row *row);

/* Sets the ratios of the row's processes to other's, replicate by replicate. */
void mote_summary_process_ratios(mote_summary_row *row, const mote_summary_row *other,
                                 mote_part part);

/* The paired ratio of other's time to row's, frame by frame within a replicate; both have
 * status ok. */
void mote_summary_ratio(const mote_summary_row *row, const mote_summary_row *other,
                        mote_part part, mote_ratio *ratio);

#endif
