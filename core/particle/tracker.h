/* Tracked particles: the paper's idea of tracking the closest features (paper 3.5), with a
   search that is nearly always exact. The minima of the last query are followed, others are
   looked for from seeds spread over the bodies, coarse to fine, and the nearest few are checked
   exactly. A query visits a few hundred vertices whatever the size of the mesh. It is a local
   search: the answer lies on the surfaces and can only be too large. */
#ifndef MOTE_CORE_TRACKER_H
#define MOTE_CORE_TRACKER_H

#include "core/method/method.h"
#include "core/particle/refine.h"

#ifdef __cplusplus
extern "C" {
#endif

#define MOTE_TRACK_MAX 64 /* MOTE_PAIRS_MAX */

typedef struct mote_tracker_options {
    uint32_t count;  /* n, seeds on each body, raised to one for each connected component; 0:
                        none, only the last query's closest pair is followed */
    uint32_t launch; /* seeds of each body that a warm query descends from, besides n in every
                        0.2 L of motion; a cold query: n */
    uint32_t track;  /* minima followed from query to query, 0 .. MOTE_TRACK_MAX */
    uint32_t refine; /* exact checks a query, at least 1 */
    bool farthest;   /* seeds are farthest points; else at random */
    bool descend;    /* descend from seeds; else their own vertices are the candidates */
    bool reseed;     /* launch from the seeds each time; else from where the last launch
                        passed the seeds' level */
    bool leap;       /* also descend from around the nearest pair */
    bool forces;     /* the paper's forces move the seeds before they are launched */
    uint64_t seed;
} mote_tracker_options;

/* n = 8, launch 0, track 8, refine 4, farthest, descend, reseed, leap, no forces, seed 1. */
mote_tracker_options mote_default_tracker_options(void);

typedef struct mote_tracker mote_tracker;

/* bodies and what they point to are borrowed; two bodies of one mesh share what is built for
   it. length: L of the pair. MOTE_EINVAL: an option out of its range, n above the vertices of
   a body. Cost O(v). Memory: about 11 bytes a vertex, and what a query visits. */
mote_status mote_tracker_create(const mote_body *const bodies[2], double length,
                                const mote_tracker_options *options, mote_tracker **tracker);

/* NULL is allowed. */
void mote_tracker_destroy(mote_tracker *tracker);

/* Finds the nearest pair of points at a frame (borrowed for the call). use_given: positions
   come from the frame's vertices, else from the field. Squared distances above worth_squared
   need not be found (infinite: every distance is wanted), and the search stops at
   enough_squared or below: a contact question passes its squared tolerance as both.
   best->squared is infinite, and nothing else of it set, when nothing below worth_squared was
   checked. Adds to counters: positions, moves, steps, triangle_tests, launches, refined. No
   allocation but growth of the tables of positions. */
void mote_tracker_query(mote_tracker *tracker, const mote_frame *frame, bool use_given,
                        double worth_squared, double enough_squared, mote_counters *counters,
                        mote_refined *best);

/* The particles of body 0 or 1 as the last query left them: where the nearest pair and the
   other minima that are followed have their vertices, in the world, nearest first. Returns how
   many there are, at most 1 + track, 0 before a query; writes at most capacity of them. The
   frame's weights, and its vertices if given, must still be there. */
size_t mote_tracker_particles(const mote_tracker *tracker, int body, mote_vec3 *positions,
                              size_t capacity);

#ifdef __cplusplus
}
#endif
#endif
