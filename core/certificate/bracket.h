/* Parameters of methods that answer with a bracket, lower <= distance <= upper, and may stop
   before the two meet. */
#ifndef MOTE_CORE_BRACKET_H
#define MOTE_CORE_BRACKET_H

#include "core/base/parameter.h"

#include <math.h>

/* Entries of a table of parameters. */
#define MOTE_PARAMETER_SLACK                                                                   \
    {                                                                                          \
        .key = "slack", .kind = MOTE_PARAMETER_REAL, .minimum = 0, .maximum = 1,               \
        .fallback = "0", .help = "stop when upper - lower <= slack L, and return both bounds"  \
    }
#define MOTE_PARAMETER_BUDGET                                                                  \
    {                                                                                          \
        .key = "budget", .kind = MOTE_PARAMETER_REAL, .minimum = 0, .maximum = HUGE_VAL,       \
        .fallback = "inf", .help = "stop after this many box tests, and return both bounds"    \
    }

/* The number of box tests that a value of budget allows; infinity: any number. */
static inline uint64_t mote_budget_of(double value)
{
    return value < 0x1p63 ? (uint64_t)value : UINT64_MAX;
}

#endif
