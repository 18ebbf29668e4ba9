/* What a batch of frames is: see batch.h. */
#ifndef MOTE_CORE_BATCH_RUN_H
#define MOTE_CORE_BATCH_RUN_H

#include "core/batch/controls.h"

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

/* What is asked of which frames, and where the answers go. Every member is 8 bytes long. */
typedef struct mote_batch_run {
    size_t frames; /* 0: nothing happens */
    /* Frames of a stretch; 0: all frames are one stretch, which goes on from the last query of
       this kind, as single queries do one after the other; the calling thread answers it. */
    size_t stretch;
    size_t threads;   /* 1 .. 256; they are started and joined in the call */
    double tolerance; /* of a contact question, absolute; negative: the distance is asked */
    /* Written for each frame; each may be NULL. */
    double *distance; /* [frames], of the witnesses: exact where the distance is asked and
                         neither slack nor budget nor coordinates from 2.8e17 L on
                         (certificate.h) ended the query, else an upper bound */
    double *lower;    /* [frames], proven: 0 <= lower <= distance */
    double *witness;  /* [frames][2][3], world points on the two surfaces */
    int8_t *contact;  /* [frames]: 1: distance <= tolerance, 0: not so, -1: not decided, for
                         the same reasons; where distances are asked for, contact is at the
                         tolerance 0 */
} mote_batch_run;

/* How both kinds of batches are made. Every member is 8 bytes long. */
typedef struct mote_batch_options {
    double slack;    /* >= 0, finite: a query stops when upper - lower <= slack * L */
    uint64_t budget; /* box tests after which a query stops and returns its bracket */
    /* Likely shapes of each body (mote_body.samples), at most 64, of which poses are not read;
       of a body that never deforms they say nothing */
    size_t sample_count[2];
    mote_controls samples[2];
} mote_batch_options;

/* No slack, no limit of box tests, no samples. */
mote_batch_options mote_default_batch_options(void);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
