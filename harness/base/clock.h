/* The clock for all time measurements. */
#ifndef MOTE_HARNESS_CLOCK_H
#define MOTE_HARNESS_CLOCK_H

#include <stdint.h>

/* Monotonic, nanoseconds. */
uint64_t mote_clock_ns(void);

/* How much reading the clock adds to a measured time: the median of many readings. */
uint64_t mote_clock_cost_ns(void);

#endif
