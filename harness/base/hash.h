/* 64-bit FNV-1a (Fowler, Noll and Vo): tells contents apart, but does not resist forgery.
   Numbers are hashed from their lowest byte up, so every machine gives the same hash. */
#ifndef MOTE_HARNESS_HASH_H
#define MOTE_HARNESS_HASH_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* The hash of no bytes; the start value of every other hash. */
#define MOTE_HASH_START 0xcbf29ce484222325u

static inline uint64_t mote_hash_bytes(uint64_t hash, const void *data, size_t size)
{
    const unsigned char *bytes = data;
    for (size_t i = 0; i < size; ++i)
        hash = (hash ^ bytes[i]) * 0x100000001b3u;
    return hash;
}

/* The hash of the text without its final 0 byte. */
static inline uint64_t mote_hash_text(const char *text)
{
    return mote_hash_bytes(MOTE_HASH_START, text, strlen(text));
}

static inline uint64_t mote_hash_word(uint64_t hash, uint64_t word)
{
    for (int k = 0; k < 8; ++k)
        hash = (hash ^ (word >> (8 * k) & 0xff)) * 0x100000001b3u;
    return hash;
}

static inline uint64_t mote_hash_double(uint64_t hash, double value)
{
    uint64_t word = 0;
    memcpy(&word, &value, sizeof word);
    return mote_hash_word(hash, word);
}

#endif
