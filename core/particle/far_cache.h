/* Caching the influence of distant particles (paper 3.5): "the influence of distant particles
   remains almost constant". What the particles beyond a near distance do to one particle is
   kept as a second-order expansion of their potential (a linear one would have no minimum
   inside a neighbourhood), until any particle may have moved by more than a set part of that
   distance. */
#ifndef MOTE_CORE_FAR_CACHE_H
#define MOTE_CORE_FAR_CACHE_H

#include "core/particle/potential.h"
#include "core/base/status.h"
#include "core/base/vec3.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct mote_far_cache mote_far_cache;

/* What acts on one particle: the near particles, and the expansion of the others about a
 * centre. */
typedef struct mote_far_split {
    mote_sources same, other; /* the near ones; own no memory */
    mote_vec3 centre;
    double slope[3], curve[6]; /* gradient; second derivatives xx yy zz xy yz zx; units of L */
} mote_far_split;

/* For count particles a body. part (> 0): how far particles may move, over near_distance,
   before an expansion is computed anew. near_distance (absolute): nearer ones are never cached.
   length: L. Memory: about 16 * count^2 bytes. */
mote_status mote_far_cache_create(uint32_t count, double part, double near_distance,
                                  double length, mote_far_cache **cache);

/* NULL is allowed. */
void mote_far_cache_destroy(mote_far_cache *cache);

/* Forgets everything. */
void mote_far_cache_reset(mote_far_cache *cache);

/* Starts a step, in which each particle moves at most once. */
void mote_far_cache_step(mote_far_cache *cache);

/* Some particle has moved by this distance in this step. */
void mote_far_cache_moved(mote_far_cache *cache, double distance);

/* Splits what acts on particle index of body b at place here. same->skip is the particle
   itself. effective_radius_squared as in mote_potential. The result is valid until the next
   split. No allocation. Cost O(near particles), O(count) when the expansion is computed anew.
 */
void mote_far_cache_split(mote_far_cache *cache, int b, uint32_t index, mote_vec3 here,
                          const mote_sources *same, const mote_sources *other,
                          double effective_radius_squared, mote_far_split *split);

/* Turns potentials of the near particles at the candidates into potentials of all, up to a
   constant. */
void mote_far_cache_add(const mote_far_split *split, const mote_candidates *candidates,
                        double length, mote_potentials *potentials);

#ifdef __cplusplus
}
#endif
#endif
