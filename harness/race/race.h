/* A race of two programs: both measure the same cells in turn, in separate processes on one
   core, until it is known which is faster.

   Frames are measured in blocks, and the first side is random (harness/race/bout.h). A pair of
   processes gives one logarithm per cell, of b's time over a's; further pairs follow, each with
   new layouts of environment, stack and heap. The interval over the values of units is exact
   without assumptions about the noise (harness/race/paired.h).

   The units. Where both sides have several builds that differ in link order, the k-th build of
   A is paired with the k-th of B, and these pairs of builds are the units: each is measured
   once before any is measured again, in random order. The order of linking changes times by
   about a per cent, so a comparison of the sources is known only as well as so many orders show
   it, however many processes are run. The same number stands for the same order on both sides
   (harness/scripts/relink.sh), so that most of its effect cancels out where the sources are
   nearly the same. Where a side has one program, each pair of processes is a unit: then these
   programs are compared with the layouts that they have. If the other side has several, they
   take turns.

   Repeated looks inflate false alarms, so they are counted: a race looks at most
   MOTE_RACE_LOOKS times, and each look at each cell is granted MOTE_RACE_ALPHA / (looks *
   cells). All intervals that a race shows hold simultaneously with a probability of 1 -
   MOTE_RACE_ALPHA. */
#ifndef MOTE_HARNESS_RACE_H
#define MOTE_HARNESS_RACE_H

#include "harness/race/bout.h"
#include "harness/race/paired.h"

/* The probability that a race of two equal programs calls any row faster or slower. */
#define MOTE_RACE_ALPHA 0.01
#define MOTE_RACE_LOOKS 6
/* Answers are equal up to this share of L, as everywhere (an exact answer). */
#define MOTE_RACE_EXACT 1e-9
#define MOTE_RACE_BUILDS 64

/* The builds of a side: one program, or several of the same sources. MOTE_PAIRED_MAX at
   most. */
typedef struct mote_race_builds {
    char *path[MOTE_RACE_BUILDS];
    size_t count;
} mote_race_builds;

/* Finds the program with this name, or all programs in the folder with this name (containing a
   slash), sorted. MOTE_EIO if there is none. Free with mote_race_builds_free. */
mote_status mote_race_builds_find(const char *path, mote_race_builds *builds);
void mote_race_builds_free(mote_race_builds *builds);

typedef struct mote_race_options {
    const mote_race_builds *builds[MOTE_RACE_SIDES];
    const mote_race_cell *cells;
    size_t cell_count;  /* at most MOTE_RACE_CELLS */
    double until;       /* a cell is done when its ratio is known within this share */
    double real;        /* the smallest change that counts, a share */
    double budget;      /* seconds in total; 0: none */
    double timeout;     /* per answer, seconds */
    uint64_t seed;      /* for orders and layouts */
    bool allow_changes; /* different answers are reported but not judged */
} mote_race_options;

typedef enum mote_race_state {
    MOTE_RACE_MEASURED,
    MOTE_RACE_LEFT_OUT, /* missing on one side, or the scenarios differ */
    MOTE_RACE_FAILED    /* a side crashed, took too long or could not answer about a frame */
} mote_race_state;
extern const char *const mote_race_state_names[];

/* The results for a cell. */
typedef struct mote_race_row {
    const mote_race_cell *cell;
    char *name; /* "ww/certified/hot"; "ww@1-9/certified/hot" if the race also has it over
                   other frames */
    mote_race_state state;
    char reason[900]; /* why it was not measured */
    mote_paired_sample sample;
    size_t pairs;   /* of processes */
    size_t units;   /* values of the last look */
    uint32_t looks; /* so far */
    uint64_t blocks;
    double seconds; /* spent on it */
    double spread;  /* standard deviation of the units' values */
    double ratio;   /* b / a, MOTE_NONE before the first look */
    mote_confidence interval;
    double total_ns[MOTE_RACE_SIDES]; /* per frame, in the first pair */
    mote_verdict verdict;
    mote_race_count counts[MOTE_RACE_COUNTS]; /* sums over the frames of a pass */
    size_t count_count;
    uint32_t frames;                      /* 0: not measured */
    mote_race_scene scene;                /* what they were asked */
    bool counted;                         /* whether a count differs */
    bool missing[2];                      /* whether a side lacks this cell, or failed in it */
    double worst;                         /* largest difference of answers, as a share of L */
    uint32_t worst_frame;                 /* frame of that difference */
    double instructions[MOTE_RACE_SIDES]; /* per frame; MOTE_NONE: not counted */
    char *uncounted;                      /* why there is no such count; NULL: not asked for */
    char *what;                           /* what explains the verdict */
} mote_race_row;

typedef struct mote_race {
    mote_race_row *rows;
    size_t count;
    size_t pairs;
    double seconds;
    bool worse, undecided; /* a row is worse; undecided, out of time, or missing in B alone */
} mote_race;

/* The pairs of processes at the look after one at so many: half as many again, MOTE_PAIRED_MAX
   at most. The first look comes as soon as there is an interval. */
size_t mote_race_next_look(size_t pairs);

/* Whether a row makes the race worse: B is slower, answers otherwise, or fails where A does
   not. */
bool mote_race_is_worse(const mote_race_options *options, const mote_race_row *row);

/* What a row was asked (mote_history_asked); "" if it was not measured. The caller frees it. */
char *mote_race_asked(const mote_race_row *row);

/* The number of pairs of builds that are units; 1: each pair of processes is one. */
size_t mote_race_build_pairs(const mote_race_options *options);

/* Runs a race. MOTE_EINVAL if there are several pairs of builds, but too few for an interval of
   so many cells (mote_paired_least). MOTE_EIO and MOTE_EINVAL if a program cannot race at all
   (see mote_racer_start), if no cell can be measured, and if a signal asked to stop; all
   processes have then ended. The caller frees *race with mote_race_free. */
mote_status mote_race_run(const mote_race_options *options, mote_race *race);
void mote_race_free(mote_race *race);

/* The verdict for a ratio: faster or slower if the interval excludes 1 and the change is at
   least `real`; same if the interval lies within real + until of 1. */
mote_verdict mote_race_verdict(double ratio, mote_confidence interval, double real,
                               double until);

#endif
