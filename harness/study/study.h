/* Shared by the experiments on claims: scenes with their truth, variants of a scene, and a
   method's answers over a scene for several seeds, measured in this process. */
#ifndef MOTE_HARNESS_STUDY_H
#define MOTE_HARNESS_STUDY_H

#include "harness/run/cell.h"
#include "harness/study/claim.h"
#include "harness/base/file.h"
#include "harness/run/measure.h"
#include "harness/summary/summary.h"

/* The largest numbers of seeds and scenes. */
#define MOTE_STUDY_SEEDS 16
#define MOTE_STUDY_SCENES 40

typedef struct mote_study {
    const char *directory; /* output directory; the run is in directory/claims-run */
    char *run;             /* directory/claims-run */
    bool quick;            /* fewer seeds, frames and sizes */
    size_t seeds;          /* seeds of the initial particle positions, 2 .. MOTE_STUDY_SEEDS */
    mote_subject scenes[MOTE_STUDY_SCENES]; /* loaded so far */
    size_t scene_count;
    mote_summary summary; /* summary of the run against hierarchies, once measured */
    bool summarised;
    bool cell_failed; /* a cell of the run failed, or could not be kept: why the study ended */
} mote_study;

/* Makes the directories. directory is borrowed. Close even after a failure. */
mote_status mote_study_open(const char *directory, bool quick, mote_study *study);
void mote_study_close(mote_study *study);

/* A built-in scenario with its truth, which is stored in the run's directory. Loaded once;
   owned by the study. */
mote_status mote_study_scene(mote_study *study, const char *name, const mote_subject **subject);

/* A variant of a built-in scenario in which both bodies are `letter` ('\0': the letters stay)
   with that many triangles (0: the numbers stay), written to
   DIRECTORY/claims-run/scenarios/NAME.json. with_truth: also computes its truth. */
typedef struct mote_variant {
    const char *base, *name;
    char letter;
    size_t triangles;
    bool with_truth;
} mote_variant;
mote_status mote_study_variant(mote_study *study, const mote_variant *variant,
                               const mote_subject **subject);

/* The frames to run, and the first seed. */
typedef struct mote_tour {
    uint32_t first, last; /* 0, 0: all */
    uint32_t stride;      /* every stride-th frame; 0: each */
    uint64_t seed;
} mote_tour;

/* Runs a method ("particle-paper:n=5") over frames of a scene. Free with
   mote_cell_result_free. */
mote_status mote_study_measure(const mote_subject *subject, const char *method, mote_tour tour,
                               mote_cell_result *result);

/* The results of one seed. Errors in L, rates as shares. */
typedef enum mote_measured {
    MOTE_MEASURED_EXACT,        /* share of frames with absolute error <= MOTE_EXACT_ERROR */
    MOTE_MEASURED_TRACKED,      /* share of frames with absolute error <= MOTE_TRACKED_ERROR */
    MOTE_MEASURED_ERROR_MEDIAN, /* of the absolute error */
    MOTE_MEASURED_ERROR_P95,
    MOTE_MEASURED_ERROR_P99,
    MOTE_MEASURED_CONTACTS,    /* frames with contact */
    MOTE_MEASURED_MISSED,      /* share of the contacts that were missed */
    MOTE_MEASURED_FALSE,       /* share of the other frames in which a contact was reported */
    MOTE_MEASURED_QUERY_US,    /* median time of a query, microseconds */
    MOTE_MEASURED_SUM_US,      /* the sum over all queries */
    MOTE_MEASURED_ALLOCATIONS, /* from frame 50 on */
    MOTE_MEASURED_COUNT
} mote_measured;

#define MOTE_TRACKED_ERROR 0.01

typedef struct mote_sample {
    double of[MOTE_MEASURED_COUNT];
} mote_sample;

/* One sample per seed, seeds tour.seed, tour.seed + 1, ...: samples[count]. The scene must have
   its truth. */
mote_status mote_study_sample(const mote_subject *subject, const char *method, mote_tour tour,
                              size_t count, mote_sample *samples);

/* A mean with Student's t interval. */
mote_estimate mote_estimate_make(const double *values, size_t count);

/* The same for positive values whose ratios matter: geometric mean, and interval of the
   logarithms. */
mote_estimate mote_estimate_ratio(const double *values, size_t count);

/* The exponent e of y ~ x^e, robust; x[sizes], y[sizes][seeds]. What a size deviates from a
   power is shared by its seeds, so a size counts once, by the mean logarithm of its seeds, and
   the interval has sizes - 2 degrees of freedom. MOTE_NONE below four sizes. MOTE_ENUMERIC. */
mote_status mote_estimate_exponent(const double *x, const double *y, size_t sizes, size_t seeds,
                                   mote_estimate *exponent);

/* The mean of one measure over samples. The interval of a share is cut to 0 .. 1. */
mote_estimate mote_sample_estimate(const mote_sample *samples, size_t count,
                                   mote_measured which);

/* Writes DIRECTORY/figures/NAME.dat, frees text, and draws the file with plots/NAME.gp. */
mote_status mote_study_plot(const mote_study *study, const char *name, mote_text *text);

#endif
