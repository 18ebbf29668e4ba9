/* Where a range of triangles is split in two while a rest tree is built. */
#ifndef MOTE_CORE_CERTIFICATE_SPLIT_H
#define MOTE_CORE_CERTIFICATE_SPLIT_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A triangle in the order of the tree; the key is scratch. */
typedef struct mote_cert_item {
    float key;
    uint32_t triangle;
} mote_cert_item;

/* The middles of all triangles in each of some poses; pose 0 is at rest. */
typedef struct mote_cert_poses {
    float (*centres)[3]; /* [count][triangles] */
    uint32_t count;
    size_t triangles;
} mote_cert_poses;

/* Reorders count >= 2 items in two parts that are small at rest or, with more poses, in all of
   them, and returns how many are in the first. Each has `least` items or more (1 .. count / 2),
   and neither more than `most` unless both halves have. Cost O(count poses^2). */
uint32_t mote_cert_split(const mote_cert_poses *poses, mote_cert_item *items, uint32_t count,
                         uint32_t least, uint32_t most);

#ifdef __cplusplus
}
#endif
#endif
