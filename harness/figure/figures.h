/* The figures of a run: data files in DIR/figures, drawn by gnuplot with plots/NAME.gp. Nothing
   is measured: figures are made from stored results. Pictures of bodies (1, 2, the letters of
   15) take deformed vertices from the run's scenarios, whose fingerprints must match the
   measured ones. Particles (1) are found by asking their method again; they are shown only if
   its answers equal the stored ones bit for bit. The same cells give the same data and, except
   for the date in PDFs, the same drawings. */
#ifndef MOTE_HARNESS_FIGURES_H
#define MOTE_HARNESS_FIGURES_H

#include "harness/base/file.h"

#include <jansson.h>

/* The result of drawing a run's figures; none of it is printed. */
typedef struct mote_figures {
    size_t drawn;        /* figures */
    mote_text files;     /* their files, a line each */
    mote_text notices;   /* "mote: ...", a line each: what cannot be read or drawn, and why */
    mote_text elsewhere; /* as mote_figures_elsewhere; empty if everything is drawn */
} mote_figures;

/* Draws what can be drawn of the run in a directory: SVG, PNG and PDF (the animation: GIF) in
   directory/figures, and figures.json: "figures", a list of {number, name, scenario, title,
   caption, run, data, files}, "missing", lines that say which figures are missing or incomplete
   and why, and "not_drawn", {number, name, command}: the command that measures the data of such
   a figure. MOTE_EIO if gnuplot is missing or fails. The caller frees *result, even after an
   error. */
mote_status mote_figures_draw(const char *directory, mote_figures *result);
void mote_figures_free(mote_figures *result);

/* Appends one line, without its end, for the list "not_drawn" of figures.json: "figures that
   other commands measure: 2 (`make bench`), 6, 7 (`make sweep`)"; nothing for an empty list. */
void mote_figures_elsewhere(const json_t *not_drawn, mote_text *text);

/* Draws directory/figures/NAME.dat with plots/SCRIPT.gp, writing beside it. MOTE_EIO as
   above. */
mote_status mote_figures_plot(const char *directory, const char *name, const char *script);

#endif
