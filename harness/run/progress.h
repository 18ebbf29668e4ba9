/* How far a run is, on stderr: one line that moves where that is a terminal, and lines
 * elsewhere. */
#ifndef MOTE_HARNESS_PROGRESS_H
#define MOTE_HARNESS_PROGRESS_H

#include "harness/base/file.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct mote_progress {
    bool terminal;
    double pause; /* elsewhere, seconds between two lines; 0: a line for each cell */
    double last;  /* when a line was printed, or the progress begun */
    bool drawn;   /* a moving line stands on the terminal */
} mote_progress;

mote_progress mote_progress_begin(double pause);

/* What is going on. On a terminal it takes the place of the last such line, cut to the
   terminal's width; elsewhere it is printed when the pause is over, and never without one. */
void mote_progress_say(mote_progress *progress, const char *text);

/* Whether mote_progress_say would print: on a terminal at most once a second. */
bool mote_progress_is_due(const mote_progress *progress);

/* A cell has ended: a line of its own elsewhere, unless there is a pause. */
void mote_progress_cell(mote_progress *progress, const char *text);

/* A line that stays, wherever it is printed. */
void mote_progress_keep(mote_progress *progress, const char *text);

/* Takes the moving line away. */
void mote_progress_end(mote_progress *progress);

#endif
