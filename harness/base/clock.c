#include "harness/base/clock.h"

#include "harness/base/statistics.h"

#include <time.h>

/* The cost of a reading is the median of this many. */
#define READINGS 1001

uint64_t mote_clock_ns(void)
{
    struct timespec now;
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return (uint64_t)now.tv_sec * 1000000000u + (uint64_t)now.tv_nsec;
}

double mote_clock_seconds(void)
{
    return 1e-9 * (double)mote_clock_ns();
}

uint64_t mote_clock_cost_ns(void)
{
    double costs[READINGS];
    for (size_t i = 0; i < READINGS; ++i) {
        uint64_t start = mote_clock_ns();
        costs[i] = (double)(mote_clock_ns() - start);
    }
    return (uint64_t)mote_statistics_median(costs, READINGS);
}

void mote_clock_date(char date[MOTE_CLOCK_DATE])
{
    const time_t now = time(NULL);
    struct tm utc = {0};
    (void)gmtime_r(&now, &utc); /* fails only where a year does not fit in an int */
    (void)strftime(date, MOTE_CLOCK_DATE, "%Y-%m-%dT%H:%M:%SZ", &utc);
}
