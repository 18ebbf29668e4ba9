/* What the study of the closed loop measures, and how it is reported. */
#ifndef MOTE_HARNESS_DYNAMICS_H
#define MOTE_HARNESS_DYNAMICS_H

#include "harness/loop/approaches.h"
#include "harness/study/claim.h"

/* One method on one scene. */
typedef struct mote_dynamics_row {
    const char *scene;
    const char *law;     /* of the paper's particles; NULL for other methods */
    char method[64];     /* as on the command line */
    uint32_t n;          /* particles a body; 0 for methods without */
    uint32_t wanted;     /* how many approaches should come to a contact */
    bool exact;          /* an exact method: must let nothing pass through */
    bool paper;          /* of a scene of the paper */
    mote_approaches sum; /* what was measured */
    char measured[32];   /* when: "2026-01-31T12:00:00Z" */
    char commit[64];     /* commit of the sources; "" where unknown */
} mote_dynamics_row;

/* How much is measured. */
typedef struct mote_dynamics_size {
    bool quick;          /* the scenes of the paper with 100 approaches a row (FCL: 20); else
                            1,000 there, 200 for FCL, with other laws and on other scenes */
    uint32_t approaches; /* unless 0: this many for every row */
    const char *scene;   /* unless NULL: this scene only */
} mote_dynamics_size;

/* Every row of the study, scene by scene; the caller frees *rows. MOTE_EINVAL for a scene that
   is not in the study. */
mote_status mote_dynamics_plan(const mote_dynamics_size *size, mote_dynamics_row **rows,
                               size_t *count);

/* Fills in what the paper claims, and adds a row's figure to it: rows with 3 to 5 particles
   and the printed law on the paper's scenes decide, others are only reported. */
void mote_dynamics_claim(mote_claim *claim);
void mote_dynamics_claim_add(mote_claim *claim, const mote_dynamics_row *row);

/* Checks what a measured row must show: NULL, or what it does not. */
const char *mote_dynamics_failure(const mote_dynamics_row *row);

/* The table for a person. */
void mote_dynamics_print(const mote_dynamics_row *rows, size_t count);

/* An object a row; the caller decrefs. */
json_t *mote_dynamics_row_json(const mote_dynamics_row *row);

/* Writes directory/dynamics.csv (a line a row) and directory/figures/, drawn. */
mote_status mote_dynamics_csv(const mote_dynamics_row *rows, size_t count,
                              const char *directory);
mote_status mote_dynamics_figure(const mote_dynamics_row *rows, size_t count,
                                 const char *directory);

#endif
