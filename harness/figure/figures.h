/* The figures of a run: data files in DIR/figures, drawn by gnuplot from plots/NAME.gp. Nothing is
   timed. Figures are made from what the run stored, and three also from what its scenarios
   give again: the deformed vertices of a frame (1, 2), where particles stood, which are shown
   only while the method answers as stored to the bit (1), and which of 100 letters touch (15, of
   a coarse scenario made for the picture). The same cells give the same data and, but for PDF's
   date, the same drawings. */
#ifndef MOTE_HARNESS_FIGURES_H
#define MOTE_HARNESS_FIGURES_H

#include "core/base/status.h"

#include <stddef.h>

/* Draws what can be drawn of the run in a directory: SVG, PNG and PDF (the animation: GIF) in
   directory/figures, and figures.json: "figures", a list of {number, name, scenario, title,
   caption, run, data, files}, "missing", lines, and "not_drawn", {number, name, command}: the
   command that measures what such a figure needs. Prints the files' names to stdout, and a
   line for what is missing (cells that cannot be read, figures whose rows the run has not, and
   why) to stderr. *drawn is the number of figures. MOTE_EIO when gnuplot is missing or refuses.
 */
mote_status mote_figures_draw(const char *directory, size_t *drawn);

/* Draws directory/figures/NAME.dat by plots/SCRIPT.gp beside it. MOTE_EIO as above. */
mote_status mote_figures_plot(const char *directory, const char *name, const char *script);

#endif
