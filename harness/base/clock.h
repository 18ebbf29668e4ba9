/* The clock for all time measurements. */
#ifndef MOTE_HARNESS_CLOCK_H
#define MOTE_HARNESS_CLOCK_H

#include <stdint.h>

/* Monotonic, nanoseconds. */
uint64_t mote_clock_ns(void);

/* The same in seconds: for deadlines and what a person reads. */
double mote_clock_seconds(void);

/* How much reading the clock adds to a measured time: the median of many readings. */
uint64_t mote_clock_cost_ns(void);

/* The date and the time now, in UTC: "2026-01-31T12:34:56Z". */
#define MOTE_CLOCK_DATE 32
void mote_clock_date(char date[MOTE_CLOCK_DATE]);

#endif
