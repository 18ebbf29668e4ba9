/* What a method says of several bodies' contacts against the truth, run by run: a run is a
   maximal sequence of steps at which a pair touches. */
#ifndef MOTE_HARNESS_BODIES_BOOK_H
#define MOTE_HARNESS_BODIES_BOOK_H

#include "harness/run/bodies_engine.h"

/* A run of contacts that goes on. */
typedef struct mote_bodies_touch {
    uint32_t body[2];
    uint32_t began;
    bool reported;
    double depth; /* its deepest, absolute */
} mote_bodies_touch;

/* All zero to begin with. */
typedef struct mote_bodies_book {
    mote_bodies_touch *touches, *spare; /* ascending; [room] */
    size_t count, room;
    uint64_t contact_steps;         /* pairs and steps at which truth is a contact */
    uint64_t missed_steps;          /* of them the method said none */
    uint64_t false_steps;           /* pairs and steps: the method said contact, truth none */
    uint64_t approaches;            /* runs that ended */
    uint64_t passes;                /* of them the method never said contact: passes through */
    uint64_t deep_passes;           /* of them a vertex of one body was inside the other */
    uint64_t delay_sum, delay_max;  /* steps from a run's begin to its first report */
    double depth_max, depth_passes; /* absolute */
} mote_bodies_book;

/* Deepest vertex of a pair, or `above` where none is deeper. */
typedef mote_status (*mote_bodies_depth)(void *context, const uint32_t body[2], double above,
                                         double *depth);

/* Books step k: pairs of the truth and of the method, both ascending. depth is asked of pairs
   whose surfaces meet. */
mote_status mote_bodies_book_step(mote_bodies_book *book, uint32_t k,
                                  const mote_bodies_pair *truth, size_t truth_count,
                                  const mote_bodies_pair *said, size_t said_count,
                                  mote_bodies_depth depth, void *context);

/* Ends the runs that go on. */
void mote_bodies_book_end(mote_bodies_book *book);

void mote_bodies_book_free(mote_bodies_book *book);

#endif
