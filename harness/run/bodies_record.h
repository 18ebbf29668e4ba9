/* The files of a run of several bodies: a row a step, and a row a near pair and step. */
#ifndef MOTE_HARNESS_BODIES_RECORD_H
#define MOTE_HARNESS_BODIES_RECORD_H

#include "harness/run/bodies_measure.h"

#include <stdio.h>

#define MOTE_BODIES_PART ".part"

typedef struct mote_bodies_record {
    FILE *steps, *pairs; /* NULL: no records */
    char *part[2];       /* their names until they are whole: ended by MOTE_BODIES_PART */
} mote_bodies_record;

/* The name of a cell's files: "SCENARIO-METHOD-rK", other characters than letters, digits and
   dots being '-', ended by a hash of the text; NULL without memory. */
char *mote_bodies_cell_name(const mote_bodies *bodies, const mote_bodies_choice *choice,
                            uint32_t replicate);

/* Opens directory/bodies/NAME.steps.csv and .pairs.csv beside their final names. */
mote_status mote_bodies_record_open(const char *directory, const char *name,
                                    mote_bodies_record *record);

void mote_bodies_record_step(mote_bodies_record *record, const mote_bodies_timed *step,
                             const mote_bodies_pair *pairs, size_t count);

/* Closes the files; whole ones get their names, others are removed. MOTE_EIO when one could not
   be written. */
mote_status mote_bodies_record_close(mote_bodies_record *record, bool whole);

#endif
