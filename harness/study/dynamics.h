/* The rows of the closed-loop study, and how they are reported. */
#ifndef MOTE_HARNESS_DYNAMICS_H
#define MOTE_HARNESS_DYNAMICS_H

#include "harness/base/clock.h"
#include "harness/loop/approaches.h"
#include "harness/study/claim.h"

/* One method on one scene. */
typedef struct mote_dynamics_row {
    const char *scene;
    const char *law; /* of the paper's particles; NULL for other methods */
    char method[64]; /* as on the command line */
    uint32_t n;      /* particles per body; 0 for methods without particles */
    uint32_t wanted; /* number of approaches that should come to a contact */
    double step;     /* frames, and what happens within them */
    mote_simulation_steps within;
    bool exact;                     /* an exact method: must let nothing pass through */
    bool paper;                     /* whether the scene is one of the paper's */
    mote_approaches sum;            /* what was measured */
    char measured[MOTE_CLOCK_DATE]; /* time: "2026-01-31T12:00:00Z" */
    char commit[64];                /* commit of the sources; "" if unknown */
} mote_dynamics_row;

/* A row's name: its method, and what happens within its steps. */
#define MOTE_DYNAMICS_LABEL 96
void mote_dynamics_label(const mote_dynamics_row *row, char label[MOTE_DYNAMICS_LABEL]);

/* The amount to measure. */
typedef struct mote_dynamics_size {
    bool quick;          /* the paper's scenes with 100 approaches per row (FCL: 20); otherwise
                            1,000, 200 for FCL, and further laws and scenes */
    uint32_t approaches; /* this many for every row, unless 0 */
    const char *scene;   /* only this scene, unless NULL */
    double step;         /* only rows of sampled and continuous steps of this many frames, which
                            mote_dynamics_has_step, unless 0 */
} mote_dynamics_size;

/* Whether the study has rows of so many frames a step: 1, 3, 10 or 30. */
bool mote_dynamics_has_step(double frames);

/* Makes every row of the study, scene by scene; the caller frees *rows. MOTE_EINVAL for a scene
   that is not in the study. */
mote_status mote_dynamics_plan(const mote_dynamics_size *size, mote_dynamics_row **rows,
                               size_t *count);

/* The same errors, making nothing. */
mote_status mote_dynamics_check(const mote_dynamics_size *size);

/* Fills in what the paper claims, and adds a row's value to it: rows with 3 to 5 particles and
   the printed law on the paper's scenes decide; others are only reported. */
void mote_dynamics_claim(mote_claim *claim);
void mote_dynamics_claim_add(mote_claim *claim, const mote_dynamics_row *row);

/* Checks a measured row: NULL, or which requirement it fails. */
const char *mote_dynamics_failure(const mote_dynamics_row *row);

/* Prints the table for a person. */
void mote_dynamics_print(const mote_dynamics_row *rows, size_t count);

/* One row as an object; the caller decrefs. */
json_t *mote_dynamics_row_json(const mote_dynamics_row *row);

/* Writes directory/dynamics.csv (one line per row), and draws directory/figures/. */
mote_status mote_dynamics_csv(const mote_dynamics_row *rows, size_t count,
                              const char *directory);
mote_status mote_dynamics_figure(const mote_dynamics_row *rows, size_t count,
                                 const char *directory);

#endif
