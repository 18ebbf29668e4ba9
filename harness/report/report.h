/* The report of a run: the commands, the machine, the table, the figures, the claims and the
   baselines' known defects, as a page (report.html) and as plain text (report.md). Made from
   stored results without measuring; missing parts are named. */
#ifndef MOTE_HARNESS_REPORT_H
#define MOTE_HARNESS_REPORT_H

#include "harness/base/file.h"
#include "harness/loop/simulations.h"
#include "harness/summary/summary.h"

#include <jansson.h>

/* A drawn figure of the run. */
typedef struct mote_report_figure {
    char *file;     /* "figures/front-ww.svg", relative to the run */
    char *title;    /* its subject, in a few words */
    char *caption;  /* "" if there is none */
    bool animation; /* an animated GIF: linked, not shown */
} mote_report_figure;

/* The contents of a report. It owns everything but the directory; parts that the run lacks are
   NULL. */
typedef struct mote_report {
    const char *directory; /* borrowed */
    char *name;            /* the last part of the directory's path */
    json_t *manifest;      /* manifest.json */
    mote_summary summary;  /* made from the cells, otherwise read from summary.json */
    bool has_summary, has_cells;
    size_t *order; /* [rows of summary], display order: see mote_report_sort */
    mote_simulations simulations;
    json_t *claims, *requirements;
    char *claims_folder; /* their folder, relative to the run: "" or "../claims/" */
    mote_report_figure *figures;
    size_t figure_count;
    char *defects;   /* Markdown: the known defects of the baselines */
    json_t *damaged; /* texts: the files that exist but cannot be read */
    json_t *missing; /* texts: what is missing, and which command adds it */
} mote_report;

/* Gathers the contents of a run's directory. MOTE_EIO if there is nothing to report: no such
   directory, or nothing of a run in it. The caller frees *report. */
mote_status mote_report_gather(const char *directory, mote_report *report);
void mote_report_free(mote_report *report);

/* Fills in figures from directory/figures; adds to missing the commands that measure more
   figures. Part of mote_report_gather. */
void mote_report_figures(mote_report *report);

/* The page and the plain text. Write `text` with mote_record_text. */
mote_status mote_report_html(const mote_report *report, mote_text *text);
void mote_report_markdown(const mote_report *report, mote_text *text);

/* Writes directory/report.html and directory/report.md. */
mote_status mote_report_write(const char *directory);

#endif
