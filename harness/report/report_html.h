/* The sections of the page; for report_html*.c. */
#ifndef MOTE_HARNESS_REPORT_HTML_H
#define MOTE_HARNESS_REPORT_HTML_H

#include "harness/report/report.h"

/* Each appends a section, or nothing where the report has nothing for it. */
void mote_report_html_results(const mote_report *report, mote_text *text);
mote_status mote_report_html_replay(const mote_report *report, mote_text *text);
mote_status mote_report_html_figures(const mote_report *report, mote_text *text);
void mote_report_html_claims(const mote_report *report, mote_text *text);
void mote_report_html_cells(const mote_report *report, mote_text *text);

/* Appends "<h2 id=ID>TITLE</h2>" behind the beginning of a section. */
void mote_report_html_section(mote_text *text, const char *id, const char *title);

#endif
