/* Time of impact: when two bodies that move and deform first come within a tolerance of each
   other between two moments, with a proof that they did not before (docs/impact.md).

   The query asks the certified distance at chosen times. Where it proves that the bodies are
   apart by more than the tolerance, no point of them can come that near before a time that
   follows from bounds on their speeds: the speed of a vertex follows from the path's control
   points and from bounds of the field's functions, without a vertex being touched. So nothing
   passes through between two samples, however fast the bodies move, turn or deform. */
#ifndef MOTE_CORE_IMPACT_H
#define MOTE_CORE_IMPACT_H

#include "core/body/path.h"
#include "core/method/method.h"

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

typedef struct mote_impact_search mote_impact_search;

typedef struct mote_impact_options {
    double length;       /* > 0: L of the pair */
    double resolution;   /* 1e-12 .. 1: width of the bracket, in the time 0 .. 1, where rounding
                            allows it */
    uint32_t pieces;     /* 1 .. 2^20: the most pieces that a path will have */
    uint32_t iterations; /* >= 1: certified queries after which the search gives up */
    uint32_t patience;   /* steps by speeds alone before the first sweep by directions, which
                            costs as much as ten of them; UINT32_MAX: no sweeps */
} mote_impact_options;

/* A bracket of 1e-6, at most 128 pieces and 10,000 queries, a patience of 10. length > 0: L of
 * the pair. */
mote_impact_options mote_default_impact_options(double length);

/* Makes what queries about two bodies need: trees of both and all memory. Either may be a body
   of which only positions are given; its rest mesh decides how well its tree fits. The bodies
   are borrowed. MOTE_EUNSUPPORTED for a field of your own that is not linear in
   its weights; MOTE_EINVAL for options out of range, for a mode that moves vertices by more
   than 1e100 L or by less than 1e-100 L, and as mote_certificate_create; MOTE_ENOMEM. Cost: as
   mote_certificate_create, and every function of the fields once at every vertex. The caller
   destroys *search; one thread at a time may use it. */
mote_status mote_impact_create(const mote_body *const body[2],
                               const mote_impact_options *options, mote_impact_search **search);

/* NULL is allowed. */
void mote_impact_destroy(mote_impact_search *search);

/* Bytes of heap held. */
size_t mote_impact_bytes(const mote_impact_search *search);

/* What is asked: does the distance become at most the tolerance in [begin, end]? */
typedef struct mote_impact_question {
    const mote_path *path[2]; /* with the same number of pieces; of positions where only those
                                 are known of the body */
    double begin, end;        /* 0 <= begin <= end <= 1 */
    double tolerance;         /* >= 0, absolute */
} mote_impact_question;

typedef enum mote_impact_outcome {
    MOTE_IMPACT_NONE,  /* proven: the distance is above the tolerance in all of [begin, end] */
    MOTE_IMPACT_FOUND, /* at `to` the distance is at most the tolerance. `to` is at most the
                          resolution after `from`, but for the rounding of times, or, where
                          rounding hides the end of the approach, as soon after it as a look
                          finds the bodies to touch */
    MOTE_IMPACT_GRAZING,  /* at `from` the distance is above the tolerance, but by no more than
                             rounding errors, and no look between `from` and `to` finds a touch.
                             `to` is end, or a moment at which the bodies are proven to be apart
                             again: ask again from there about what comes after it */
    MOTE_IMPACT_UNDECIDED /* the iterations are spent; `to` is `from`, where the proof ended */
} mote_impact_outcome;

typedef struct mote_impact_found {
    mote_impact_outcome outcome;
    double from; /* proven: the distance is above the tolerance at all times from begin up to,
                    but not at, this one; `end` where there is no impact */
    double to;   /* >= from */
    double distance;      /* exact, at `to`; of a grazing at `from`, where there is no impact at
                             the last time asked about */
    mote_vec3 witness[2]; /* on the surfaces at that time */
    mote_vec3 normal;     /* of length 1, from body 0 to body 1, at that time; where they touch
                             then, at the last time asked about at which they were apart; 0
                             where they never were */
    uint32_t iterations;  /* certified queries made */
    mote_counters counters;
} mote_impact_found;

/* Answers the question. Touching at begin is an impact with the bracket [begin, begin].
   Rounding hides a distance to the tolerance of some 2^-40 of the sizes of the bodies, their
   rest coordinates and their places: so much is left of a gap where the proof ends. From there
   the search looks ahead: as far as speeds allow, or by an eighth of the time since `from` or
   since the piece began. A touch that is over between two such looks is not seen.
   MOTE_EINVAL, naming the body and the piece: an interval that is not within 0 .. 1 or that is
   reversed, a tolerance below 0 or not finite, paths without pieces, with more than the options
   say, or of different numbers; a number that is not finite; a piece that begins elsewhere than
   the one before ends; quaternions that may pass near 0; a piece that spins from a
   rotation that is not of length 1, or by more than MOTE_PATH_SPIN_MAX; weights of morph
   targets that are not in the body's axes; positions where the body has a field, or none where
   it has not; positions that cannot be read, or that are 10^18 L from the origin. Only the
   pieces within [begin, end] are checked. No allocation. Of a path of positions every vertex of
   each frame is read, and the frames that the search comes to are boxed. */
mote_status mote_impact_query(mote_impact_search *search, const mote_impact_question *question,
                              mote_impact_found *found);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
