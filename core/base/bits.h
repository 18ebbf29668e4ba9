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

/* How many bits are set. */
static inline uint32_t mote_bit_count(uint32_t bits)
{
#if defined(__GNUC__)
    return (uint32_t)__builtin_popcount(bits);
#else
    uint32_t count = 0;
    for (; bits; bits &= bits - 1)
        ++count;
    return count;
#endif
}

/* The place of the lowest bit of a word of 64 bits, which is not 0. */
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
