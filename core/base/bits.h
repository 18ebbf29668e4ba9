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

/* The same of a word of 64 bits. */
static inline size_t mote_lowest_bit_of_64(uint64_t bits)
{
#if defined(__GNUC__)
    return (size_t)__builtin_ctzll(bits);
#else
    const uint32_t low = (uint32_t)bits;
    return low ? mote_lowest_bit(low) : 32 + mote_lowest_bit((uint32_t)(bits >> 32));
#endif
}

#endif
