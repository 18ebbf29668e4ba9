/* gnuplot: its input text, and drawing a figure with it. */
#ifndef MOTE_HARNESS_GNUPLOT_H
#define MOTE_HARNESS_GNUPLOT_H

#include "harness/base/file.h"

/* Runs plots/draw.gp, which loads plots/SCRIPT.gp, in folder (NULL: the current one), which
   holds BASE.dat. All text reaches gnuplot as arguments that are never executed. formats: "svg
   png pdf", or "gif". MOTE_EIO if gnuplot is missing or fails. */
mote_status mote_gnuplot_draw(const char *folder, const char *script, const char *base,
                              const char *heading, const char *footer, const char *formats);

/* Appends text in quotes. Characters that would end the string or the line are replaced by
   similar ones. */
void mote_gnuplot_quote(mote_text *text, const char *string);

/* Starts a data block with a title, after two empty lines unless it is the first. */
void mote_gnuplot_block(mote_text *text, const char *title);

#endif
