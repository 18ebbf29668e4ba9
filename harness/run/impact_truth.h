/* The truth about impacts: when the two bodies of a scenario come within its tolerance between
   its frames. Of every frame and the next it is known when they first do, so that it holds for
   questions of any number of frames.

   Each such gap is sampled at 1,000 moments by the certified query, as contacts, and the first
   sample in contact is bisected; what lies between samples is looked for by the certified time
   of impact. Every impact of either is checked by another program, our box trees, at the moment
   itself; and that bodies are apart, in the middle of every gap without one. Where no sample is
   in contact and that search leaves open whether there is an impact, since the bodies graze
   each other or it has given up, the truth is undecided: nobody's answer is right or wrong
   there. */
#ifndef MOTE_HARNESS_IMPACT_TRUTH_H
#define MOTE_HARNESS_IMPACT_TRUTH_H

#include "harness/scene/scenario.h"

typedef struct mote_impact_truth {
    uint64_t fingerprint; /* of the scenario and of its bodies' paths */
    uint32_t gaps;        /* frames - 1 */
    double *first;        /* [gaps]: from frame k + 1 on, when they first touch before the next
                             frame or in it, 0 .. 1; NaN: they do not; infinite: undecided */
    uint32_t unsampled;   /* gaps with an impact that no sample has seen */
} mote_impact_truth;

/* Its file, DIR/truth/NAME-FINGERPRINT-FACES-impacts.csv. The caller frees it. */
char *mote_impact_truth_path(const char *directory, const mote_scenario *scenario,
                             uint64_t fingerprint);

/* Reads this file if it exists, is complete and belongs to the scenario and its tolerance;
   otherwise computes it in a child process and writes it. MOTE_ENUMERIC, the text naming the
   frame, if the other program disagrees. Errors as mote_truth_load_or_compute. The caller
   destroys *truth. */
mote_status mote_impact_truth_load_or_compute(const mote_scenario *scenario,
                                              uint64_t fingerprint, const char *directory,
                                              mote_impact_truth **truth);
void mote_impact_truth_destroy(mote_impact_truth *truth); /* NULL is allowed */

/* Whether there is an impact from a frame (1 ..) to the one `step` frames later: 1 with *to,
   when the first is, as a part of this time; 0: there is none; -1: undecided, also where the
   first is undecided and a later one is not. */
int mote_impact_truth_between(const mote_impact_truth *truth, uint32_t frame, uint32_t step,
                              double *to);

#endif
