/* Certified mode: the exact distance of two deforming bodies, and a proof of it, from two rest
   trees that are deformed node by node (docs/architecture.md; after the BD-Tree of James and
   Pai, 2004).

   A query keeps an upper bound, the nearest pair of points found so far, and shows that nothing
   is nearer: first by a plane across the gap, since parts of the bodies on their own sides of
   it are far enough apart, then by traversing both trees for the parts that cross it. Whatever
   decides the answer is computed in double precision from the positions that
   mote_body_position gives; single precision only rules out pairs that are far apart, with
   proven margins. */
#ifndef MOTE_CORE_CERTIFICATE_H
#define MOTE_CORE_CERTIFICATE_H

#include "core/method/method.h"

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

typedef struct mote_certificate mote_certificate;

/* Where a query's first upper bound comes from. */
typedef enum mote_cert_seed {
    MOTE_CERT_SEED_NONE,   /* from the trees alone: no state is kept between queries */
    MOTE_CERT_SEED_PAIR,   /* the last query's pair of faces, measured where they are now */
    MOTE_CERT_SEED_WITNESS /* the same, slid downhill over the faces around; from the trees
                              where the two have leapt apart */
} mote_cert_seed;

typedef struct mote_certificate_options {
    double length; /* > 0: L of the pair */
    mote_cert_seed seed;
    double slack;    /* >= 0: a query stops when upper - lower <= slack * length */
    uint64_t budget; /* box tests after which a query stops and returns its bracket */
    /* Each of these can be switched off, to measure what it contributes: */
    uint32_t width;    /* children of a block: 2, 4 or 8 */
    bool linear_fits;  /* boxes follow the gradient of the field, not only its mean */
    bool plane;        /* the plane pass */
    bool directions;   /* leaf pairs are tested along directions before their triangles */
    uint32_t restarts; /* the traversal starts again at most this often after an improvement */
    uint32_t threads;  /* 2 or more: the two trees are built side by side, by two threads */
} mote_certificate_options;

/* The defaults: a start from the last witnesses, no slack, no limit of box tests, nothing
   switched off, one thread. length > 0: L of the pair. */
mote_certificate_options mote_default_certificate_options(double length);

/* Builds both trees: O(t log t), about 0.5 s a million triangles, the same bits with any number
   of threads. MOTE_EUNSUPPORTED for a body of which only positions are given; MOTE_EINVAL for a
   skin of a mesh with another number of vertices or another middle of its box; MOTE_ENOMEM,
   also where a second thread cannot be started. options are not checked; change the defaults
   only within their ranges. The bodies are borrowed; a change of their fields or rest meshes
   needs a new certificate. The caller destroys *certificate; one thread at a time may use it.
 */
mote_status mote_certificate_create(const mote_body *const body[2],
                                    const mote_certificate_options *options,
                                    mote_certificate **certificate);

/* NULL is allowed. */
void mote_certificate_destroy(mote_certificate *certificate);

/* Bytes of heap held. */
size_t mote_certificate_bytes(const mote_certificate *certificate);

typedef struct mote_certificate_answer {
    double distance;      /* of the witnesses: an upper bound, exact unless stopped early */
    double lower;         /* proven: 0 <= lower <= distance */
    mote_vec3 witness[2]; /* world points on the surfaces */
    bool stopped;         /* by the budget, or where coordinates leave the range of floats */
    mote_counters counters;
} mote_certificate_answer;

/* Answers one frame, whose numbers must be finite; they are not checked. first (may be NULL):
   vertices of a pair of faces to start from, where the caller knows a good one; it changes the
   time only. enough: a contact question's tolerance, so that the query ends when distance <=
   enough or lower > enough; negative for the distance. Where
   coordinates of both bodies add up to 2.8e17 L or more, the nearest pair is not searched for:
   the answer is a bracket. A distance whose square no double holds, from 1e154 on, is infinite,
   and has no witnesses. No allocation. */
void mote_certificate_query(mote_certificate *certificate, const mote_frame *frame,
                            const uint32_t (*first)[3], double enough,
                            mote_certificate_answer *answer);

/* Writes what a proven bracket says about the question of a setup to a method's answer, and
   adds its counters. decides: no slack was allowed, so that an answer that the budget did not
   stop decides contact. */
void mote_certificate_report(const mote_certificate_answer *bracket, mote_ask ask,
                             double tolerance, bool decides, mote_answer *answer);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
