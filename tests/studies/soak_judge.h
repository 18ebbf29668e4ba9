/* Judges methods' answers on a scenario against the truth, frame by frame. */
#ifndef MOTE_TESTS_SOAK_JUDGE_H
#define MOTE_TESTS_SOAK_JUDGE_H

#include "core/base/status.h"

#include <stdbool.h>
#include <stdint.h>

/* Exact methods first. The last of them is the truth; where one differs, other arithmetic
   judges it in turn. SOAK_BOUNDED is the one that may stop early, with a bracket. */
enum { SOAK_BOUNDED = 4, SOAK_EXACT = 6, SOAK_METHODS = 9, SOAK_DECADES = 18 };
extern const char *const soak_methods[SOAK_METHODS];

typedef struct soak_tally {
    uint64_t queries;
    uint64_t wrong;    /* exact methods: distance not within 1e-12 L, or lower bound not within
                          1e-12 of what its rounding is proportional to; all: NaN, negative, below
                          the truth */
    uint64_t violated; /* a proven lower bound above the truth */
    uint64_t missed, false_contacts;
    uint64_t decades[SOAK_DECADES]; /* errors over L: [0] below 1e-16, [k] below 10^(k - 16) */
    double largest;                 /* error over L */
    double loosest;                 /* truth less lower bound, over L; of certified only */
} soak_tally;

typedef struct soak_verdict {
    uint32_t frames;       /* judged; up to the first failure when stopped there */
    uint32_t failed_frame; /* the first with a failure, 0: none */
    uint32_t settled;      /* frames that 113 bits had to settle */
    soak_tally tally[SOAK_METHODS];
} soak_verdict;

/* Wrong answers to plant, which must be found, at a frame: certified's distance is altered by
   1e-9, and certified:seed=none has no lower bound but 0. Frame 0: none. */
typedef struct soak_plant {
    uint32_t frame;
} soak_plant;

/* Judges every frame of a scenario file in a process of its own; with stop, until the first
   failure. MOTE_EINVAL when the file is refused; MOTE_EIO when a method crashed or hung. */
mote_status soak_judge(const char *path, const soak_plant *plant, bool stop,
                       soak_verdict *verdict);

static inline bool soak_failed(mote_status status, const soak_verdict *verdict)
{
    return status == MOTE_EIO || (status == MOTE_OK && verdict->failed_frame > 0);
}

#endif
