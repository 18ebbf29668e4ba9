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

/* How many times slower another row is: median over common frames and replicates of (the
   other's time / this time). Time is the total, or, for a row with positions given, what is
   left without deformation: nobody is charged for it on either side. A row's ratio to itself is
   1 and has no interval. */
typedef struct mote_ratio {
    const mote_summary_row *to; /* the other row, of the same summary; NULL: there is none */
    double value, low, high;
} mote_ratio;

/* A deterministic count over the frames of all processes. */
typedef struct mote_row_count {
    const char *name;
    double mean, max;
} mote_row_count;

/* A process that ended well. */
typedef struct mote_process {
    uint32_t replicate;
    double median;      /* of the total, nanoseconds */
    double ratio;       /* paired median of (reference's total / this total), as in row.ratio */
    const double *sums; /* [count_count] of the row: each count over the frames, or MOTE_NONE */
} mote_process;

/* Times without the disturbances of a shared machine, as far as replicates allow: of each
   frame the fastest of a group of replicates, then the median over frames. Groups are blocks
   of consecutive replicates; with fewer than MOTE_QUIET_REPLICATES all is MOTE_NONE. */
#define MOTE_QUIET_GROUPS 5
#define MOTE_QUIET_REPLICATES 10
typedef struct mote_quiet {
    double total[MOTE_QUIET_GROUPS]; /* nanoseconds */
    double ratio[MOTE_QUIET_GROUPS]; /* median over frames of (reference's / this) */
} mote_quiet;

/* Errors are in L; MOTE_NONE where no frame has an answer. */
typedef struct mote_error_summary {
    double median, p95, p99, max; /* of the absolute error */
    double min_signed, max_signed;
    double exact_rate;           /* share of frames with absolute error <= 1e-9 */
    double exact_rate_separated; /* the same where truth > 0 */
} mote_error_summary;

#define MOTE_EXACT_ERROR 1e-9

/* Everything that summary.json says of a configuration, and where it comes from. Each member
   from `scenario` on is a column (column.h), by which rows are written and read; texts are ""
   and numbers MOTE_NONE where there is nothing. */
struct mote_summary_row {
    const mote_stored_cell *cells; /* [replicates], in the summary's stored; NULL where the row
                                      was read from a summary.json */
    size_t replicates;             /* of the cells; 0 without cells */
    const mote_stored_cell *first; /* one with status ok, or else one of the row's status */
    mote_cell_status status; /* ok when any replicate is, else the worst: crashed, timeout;
                                MOTE_CELL_STATUSES where a summary.json names none of these */
    bool given;              /* positions=given: its own time leaves deformation out */

    const char *scenario, *fingerprint, *cache, *machine, *ask, *method;
    char *label; /* "particle-paper:n=5": parameters that are not default */
    char *
        scene; /* "ww", or "ww (scene 0123abcd)" where another of that name is in the summary */
    const char *ending, *reason; /* the status as text; why it is not ok */
    const char *accounting;      /* "charged" or "given" */
    const char *told;            /* "field" or "positions"; "" where the cell does not say */
    json_t *parameters;          /* in the cell or the summary.json; borrowed */
    double n, tolerance;         /* the parameter n; the scenario's tolerance */
    uint64_t seed;
    uint32_t frame_range[2]; /* first and last of the frames asked for */
    uint32_t stride, jobs;   /* jobs: cells that ran at the same time */
    uint32_t triangles[2], vertices[2];
    uint32_t bodies, shapes;  /* 0: two bodies */
    double near_pairs_wanted; /* a body, as the scenario asks */
    size_t frames;            /* of one replicate */
    size_t finished, failed;  /* replicates that ended well, and those that did not */
    bool times_comparable;    /* jobs is 1 */
    double smallest_change;   /* mote_statistics_detectable - 1 of its times */

    mote_time total, deform, update, query, active_total;
    mote_time given_total;  /* nobody is charged for deformation */
    mote_ratio ratio;       /* to fcl-aabb:seed=none,queue=2, or the first fcl-aabb there is, of
                               those that were measured on all of this row's frames */
    mote_ratio ratio_given; /* the same where nobody is charged for deformation */
    mote_ratio ratio_best;  /* to the row of FCL that is the fastest over this row's frames */
    mote_ratio ratio_engine; /* likewise, of all engines of others whose answers are right */
    mote_error_summary error;
    double contacts, missed, false_contacts; /* frames, mean over replicates */
    /* Of more than two bodies contacts are those of pairs and frames; missed and false_contacts
       are against another row's, an exact one's. */
    const mote_summary_row *contacts_of;  /* that row; NULL: there is none */
    double near_pairs;                    /* mean a frame */
    const mote_summary_row *dominated_by; /* the fastest row that is better in all
                                             (dominance.h); NULL: none */
    bool on_front;                        /* measured, and no other row dominates it */
    bool stands_for_method; /* where one row a method is shown it is this one (likewise) */
    double heap_live_bytes, heap_peak_bytes, rss_peak_bytes; /* the largest */
    double heap_bytes_per_vertex;

    mote_row_count *counts; /* [count_count] */
    size_t count_count;
    mote_process *processes; /* [process_count], those that ended well, by replicate */
    size_t process_count;
    double *sums; /* [process_count][count_count], of the processes */
    mote_quiet quiet;
};

/* A row from its cells [replicates], all but the ratios. */
mote_summary_row mote_summary_row_make(const mote_stored_cell *cells, size_t replicates);

/* Which part of a frame's time is compared: all of it, or all but deformation. */
typedef enum mote_part { MOTE_PART_TOTAL, MOTE_PART_GIVEN } mote_part;

/* Median time over the frames first .. last of all replicates; MOTE_NONE without any. */
double mote_summary_median_within(const mote_summary_row *row, uint32_t first, uint32_t last,
                                  mote_part part);

/* The replicate of a number, with frames; NULL: none ended well. */
const mote_stored_cell *mote_summary_replicate(const mote_summary_row *row, uint32_t number);

/* Whether the row's method is one of FCL's. */
bool mote_summary_is_fcl(const mote_summary_row *row);

/* Whether the row's method is an engine that others wrote (FCL, Coal, ODE, Bullet or Embree),
   as they would have it used. */
bool mote_summary_is_engine(const mote_summary_row *row);

/* Whether a row has a time that may be compared with those of other rows. */
bool mote_summary_row_measured(const mote_summary_row *row);

/* Whether a row has no missed and no false contact; and whether, besides, each distance that it
   gives is exact. */
bool mote_summary_contacts_right(const mote_summary_row *row);
bool mote_summary_row_right(const mote_summary_row *row);

/* The order of scenes: by scenario, caches (hot first), machine, fingerprint and question. 0:
   the same frames, asked the same on one machine. What is of two scenes is never compared. */
int mote_summary_by_scene(const mote_summary_row *a, const mote_summary_row *b);

/* Likewise by the frames asked for: what begins earlier first, of these the longer. */
int mote_summary_by_frames(const mote_summary_row *a, const mote_summary_row *b);

/* Whether two rows stand in one block: the same frames, asked the same, on one machine. */
bool mote_summary_same_block(const mote_summary_row *a, const mote_summary_row *b);

/* Frees what the row holds. */
void mote_summary_row_free(mote_summary_row *row);

/* Fills the ratios of the row's processes to other's, replicate by replicate. */
void mote_summary_process_ratios(mote_summary_row *row, const mote_summary_row *other,
                                 mote_part part);

/* The paired ratio of other's time to row's, frame by frame within a replicate; both have
 * status ok. */
void mote_summary_ratio(const mote_summary_row *row, const mote_summary_row *other,
                        mote_part part, mote_ratio *ratio);

#endif
