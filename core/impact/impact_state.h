/* The state of a search for an impact: what impact*.c share. */
#ifndef MOTE_CORE_IMPACT_STATE_H
#define MOTE_CORE_IMPACT_STATE_H

#include "core/body/path_place.h"
#include "core/certificate/certificate.h"
#include "core/certificate/certificate_tree.h"
#include "core/impact/impact.h"
#include "core/impact/impact_bones.h"
#include "core/impact/impact_lines.h"
#include "core/impact/impact_sweep.h"

/* The parts of a body for which speeds are bounded, at most. */
#define MOTE_IMPACT_GROUPS 64

/* The vertices of a body in groups that lie together at rest. Of each group are known a ball
   around it at rest and, for each basis function, the largest absolute value at its vertices;
   of a skin, its bones instead. */
typedef struct mote_impact_groups {
    uint32_t count, padded;   /* padded to a multiple of MOTE_LANES, with empty groups */
    mote_vec3 *middle;        /* [count] */
    double *radius;           /* [count] */
    double *most;             /* [functions][padded], not of a skin */
    double *most_of_all;      /* [functions] over all groups */
    mote_impact_bones *bones; /* of a skin, else NULL */
    double size;              /* of the rest coordinates: the largest length of a vertex */
} mote_impact_groups;

/* How a body moves and deforms in a piece, by the piece's local time: bounds for each vertex
   and all times in it, without the motion of the pivot. */
typedef struct mote_impact_motion {
    double speed, acceleration;
    double noise; /* of a position: rounding, and what pieces may miss each other by */
    double turn;  /* of the angular velocity, in radians */
} mote_impact_motion;

/* The same of both bodies together, the motion of the pivots included. */
typedef struct mote_impact_rate {
    bool known;
    double speed, acceleration; /* of one body's points as the other body's see them */
    double noise, turn;
    double kink; /* how much the speeds of points change at once where the piece begins */
} mote_impact_rate;

struct mote_impact_search {
    mote_impact_options options;
    mote_body body[2];
    mote_field *own_field[2]; /* of a body of which only positions are given, else NULL */
    mote_lines *lines[2];     /* the same */
    mote_certificate *certificate;
    mote_impact_groups groups[2];
    double *weights[2];      /* [3 * padded] of the frame */
    double *amounts;         /* [3][functions] of a piece */
    double *sums;            /* [3][groups] of a piece */
    mote_impact_rate *rates; /* [options.pieces] of the question's pieces */
    mote_frame frame;
    mote_sweep sweep;
    uint32_t wait;     /* steps by speeds alone before the next sweep */
    double *speeds[2]; /* [3 * padded] weights of the sweep's states */
    const mote_impact_question *question;
    mote_certificate_answer at; /* the last certified answer */
    mote_impact_found found;
    size_t bytes; /* without the certificate's */
};

/* impact_groups.c */

/* MOTE_ENOMEM. */
mote_status mote_impact_groups_create(const mote_body *body, const mote_cert_tree *tree,
                                      mote_impact_groups *groups, size_t *bytes);
void mote_impact_groups_destroy(mote_impact_groups *groups);

/* impact_rate.c */

/* Bounds of piece k of the question's paths, computed when they are first asked for. */
const mote_impact_rate *mote_impact_rate_of(mote_impact_search *search, uint32_t k);

/* impact_step.c */

/* The time up to which a sweep shows the bodies to be apart after the last answer, of `time`;
   at most end. */
double mote_impact_swept_until(mote_impact_search *search, double time);

/* impact_create.c */

/* Where body i is on its path, and its velocity times factor. */
void mote_impact_state(mote_impact_search *search, int i, double time, double *weights,
                       mote_body_state *state);
void mote_impact_velocity(mote_impact_search *search, int i, mote_place at, double factor,
                          double *weights, mote_body_state *state);

/* impact_check.c */

/* MOTE_EINVAL for whatever is wrong with a question. */
mote_status mote_impact_check(const mote_impact_search *search,
                              const mote_impact_question *question);

#endif
