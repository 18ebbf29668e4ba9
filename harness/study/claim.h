/* A claim of the paper and the values measured for it. The verdict follows only from the values
   and their thresholds. */
#ifndef MOTE_HARNESS_CLAIM_H
#define MOTE_HARNESS_CLAIM_H

#include "harness/base/statistics.h"

#include <jansson.h>

/* A value with its 95 % interval, or MOTE_NONE for both ends. */
typedef struct mote_estimate {
    double value;
    mote_confidence interval;
} mote_estimate;

/* A value without an interval. */
static inline mote_estimate mote_estimate_alone(double value)
{
    return (mote_estimate){value, {MOTE_NONE, MOTE_NONE}};
}

typedef enum mote_bound {
    MOTE_BOUND_NONE, /* reported, but not used for the verdict */
    MOTE_AT_MOST,
    MOTE_AT_LEAST
} mote_bound;

/* One measured value. A threshold is met if the whole interval is on its right side, or,
   without an interval, if the value is. */
typedef struct mote_claim_value {
    char name[112];         /* "n = 3, 95th percentile" */
    mote_estimate estimate; /* value MOTE_NONE: not measured; meets no threshold */
    const char *unit;       /* "L", "us", "" */
    mote_bound bound;
    double holds;  /* threshold for "holds"; MOTE_NONE: not required for it */
    double limits; /* threshold for "holds within limits"; MOTE_NONE: not required for it */
} mote_claim_value;

/* The claim, its place in the paper, and how it was measured: constant text. curve is a file in
   the study's directory, or NULL. */
typedef struct mote_claim {
    const char *id, *section, *claim, *measured, *curve;
    mote_claim_value *values;
    size_t count, capacity;
} mote_claim;

typedef enum mote_claim_verdict {
    MOTE_CLAIM_HOLDS,  /* there are thresholds for "holds", and all are met */
    MOTE_CLAIM_LIMITS, /* otherwise: there are thresholds for "holds within limits", and all are
                          met */
    MOTE_CLAIM_DOES_NOT_HOLD /* anything else */
} mote_claim_verdict;

/* Adds a value; the first one is the headline. name as for printf. */
void mote_claim_add(mote_claim *claim, mote_estimate estimate, const char *unit,
                    const char *format, ...) MOTE_PRINTF(4, 5);

/* Sets the thresholds of the value added last. */
void mote_claim_require(mote_claim *claim, mote_bound bound, double holds, double limits);

/* Whether a value is on the right side of a threshold. */
bool mote_claim_met(const mote_claim_value *value, double threshold);

mote_claim_verdict mote_claim_judge(const mote_claim *claim);

/* An object with id, section, claim, measured, value, interval, unit and threshold of the
   headline, verdict, values (all with their thresholds) and curve. NULL if memory ran out; the
   caller decrefs. */
json_t *mote_claim_json(const mote_claim *claim);

/* Prints lines for a person: the verdict, then a line per value. */
void mote_claim_print(const mote_claim *claim);

/* Frees the values. */
void mote_claim_free(mote_claim *claim);

#endif
