#include "harness/run/memory_pass.h"

#include "core/base/clones.h"
#include "harness/base/clock.h"
#include "harness/base/memory.h"
#include "harness/base/statistics.h"

#include <stdint.h>
#include <stdlib.h>

#define EVICT_BYTES ((size_t)32 << 20)
#define CACHE_LINE 64

/* Passes of which the median is taken. */
#define PASSES 11

/* Sums that do not wait for each other. */
#define LANES 32

volatile unsigned char *mote_evict_create(void)
{
    return mote_allocate(EVICT_BYTES, 1);
}

void mote_evict(volatile unsigned char *bytes)
{
    for (size_t i = 0; i < EVICT_BYTES; i += CACHE_LINE)
        bytes[i] = (unsigned char)(bytes[i] + 1);
}

/* count is a multiple of LANES. */
MOTE_CLONES
static double read_once(const double *numbers, size_t count)
{
    double sum[LANES] = {0};
    for (size_t i = 0; i < count; i += LANES) {
        MOTE_LANE_LOOP
        for (size_t l = 0; l < LANES; ++l)
            sum[l] += numbers[i + l];
    }
    double all = 0;
    for (size_t l = 0; l < LANES; ++l)
        all += sum[l];
    return all;
}

double mote_read_pass_ns(size_t vertices, volatile unsigned char *evict)
{
    const size_t count = (3 * vertices + LANES - 1) / LANES * LANES;
    double *numbers = mote_allocate(count, sizeof *numbers);
    for (size_t i = 0; i < count; ++i)
        numbers[i] = 1;
    const uint64_t clock = mote_clock_cost_ns();
    double spent[PASSES];
    volatile double sum = read_once(numbers, count);
    for (size_t k = 0; k < PASSES; ++k) {
        if (evict)
            mote_evict(evict);
        const uint64_t from = mote_clock_ns();
        sum = read_once(numbers, count);
        const uint64_t took = mote_clock_ns() - from;
        spent[k] = took > clock ? (double)(took - clock) : 0;
    }
    (void)sum;
    free(numbers);
    return mote_statistics_median(spent, PASSES);
}
