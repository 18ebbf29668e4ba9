/* The figures of a run: data files in DIR/figures, drawn by gnuplot from plots/NAME.gp. */
#ifndef MOTE_HARNESS_FIGURES_H
#define MOTE_HARNESS_FIGURES_H

#include "harness/summary.h"

/* Writes the data of every figure whose rows are in the summary and draws it as SVG and PNG;
   prints the names of the files to stdout. MOTE_EIO when gnuplot is missing or refuses. */
mote_status mote_figures_draw(const mote_summary *summary, const char *directory);

/* Draws directory/figures/NAME.dat by plots/SCRIPT.gp as SVG and PNG beside it. MOTE_EIO as
   above. */
mote_status mote_figures_plot(const char *directory, const char *name, const char *script);

#endif
