/* The progress of a run, on stderr: one line that is redrawn on a terminal, separate lines
   elsewhere. */
#ifndef MOTE_HARNESS_PROGRESS_H
#define MOTE_HARNESS_PROGRESS_H

#include "harness/base/file.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct mote_progress {
    bool terminal;
    double pause; /* off a terminal, seconds between two lines; 0: a line for each cell */
    double last;  /* time of the last line, or of the start */
    bool drawn;   /* a moving line is on the terminal */
} mote_progress;

mote_progress mote_progress_begin(double pause);

/* Shows the current activity. On a terminal it replaces the previous such line, cut to the
   terminal's width; elsewhere it is printed when the pause is over, and never if there is no
   pause. */
void mote_progress_say(mote_progress *progress, const char *text);

/* Whether mote_progress_say would print: on a terminal at most once a second. */
bool mote_progress_is_due(const mote_progress *progress);

/* Reports the end of a cell: off a terminal a line, unless there is a pause. */
void mote_progress_cell(mote_progress *progress, const char *text);

/* Prints a line that stays, on a terminal or not. */
void mote_progress_keep(mote_progress *progress, const char *text);

/* Reports the precision that --until-ci reached: the widest interval, as a share of its median,
   after so many replicates. */
void mote_progress_precision(uint32_t replicates, double widest, double share);

/* Removes the moving line. */
void mote_progress_end(mote_progress *progress);

#endif
