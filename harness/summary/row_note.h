/* What must be known of a row beside its figures: measured with a stride, several cells at
   once, replicates that failed. */
#ifndef MOTE_HARNESS_ROW_NOTE_H
#define MOTE_HARNESS_ROW_NOTE_H

#include <stdbool.h>

/* The row's columns of these names; MOTE_NONE: not known. */
typedef struct mote_row_facts {
    double stride, jobs, replicates, replicates_failed;
} mote_row_facts;

#define MOTE_ROW_NOTES 3
#define MOTE_ROW_NOTE 96

/* Note i < MOTE_ROW_NOTES: "every 16th frame"; false, and no text, where it does not apply. */
bool mote_row_note(const mote_row_facts *facts, int i, char text[MOTE_ROW_NOTE]);

#endif
