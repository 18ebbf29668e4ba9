/* Words whose bits are flags. */
#ifndef MOTE_CORE_BITS_H
#define MOTE_CORE_BITS_H

#include <stddef.h>
#include <stdint.h>

/* The place of the lowest bit; bits is not 0. */
static inline size_t mote_lowest_bit(uint32_t bits)
{
#if defined(__GNUC__)
    return (size_t)__builtin_ctz(bits);
#else
    size_t place = 0;
    while (!(bits >> place & 1))
        ++place;
    return place;
#endif
}

#endif
