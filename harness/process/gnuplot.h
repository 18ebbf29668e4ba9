/* gnuplot: the text that it reads, and a figure drawn by it. */
#ifndef MOTE_HARNESS_GNUPLOT_H
#define MOTE_HARNESS_GNUPLOT_H

#include "harness/base/file.h"

/* Runs plots/draw.gp, which loads plots/SCRIPT.gp, in folder (NULL: this one), where BASE.dat
   is: all text reaches gnuplot as arguments that are never run. formats: "svg png pdf", or
   "gif". MOTE_EIO when gnuplot is missing or refuses. */
mote_status mote_gnuplot_draw(const char *folder, const char *script, const char *base,
                              const char *heading, const char *footer, const char *formats);

/* Appends text in quotes. Characters that would end the string or the line are replaced by
   similar ones. */
void mote_gnuplot_quote(mote_text *text, const char *string);

/* Starts a block below a title, after two empty lines unless it is the first. */
void mote_gnuplot_block(mote_text *text, const char *title);

#endif
