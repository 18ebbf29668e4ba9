/* The clock that everything is timed with. */
#ifndef MOTE_HARNESS_CLOCK_H
#define MOTE_HARNESS_CLOCK_H

#include <stdint.h>

/* Monotonic, nanoseconds. */
uint64_t mote_clock_ns(void);

/* What a reading of the clock adds to a time that it ends: the median of many. */
uint64_t mote_clock_cost_ns(void);

#endif
