/* Writes a summary into the files of a run's directory. */
#ifndef MOTE_HARNESS_SUMMARY_JSON_H
#define MOTE_HARNESS_SUMMARY_JSON_H

#include "harness/summary/summary.h"

/* A row as summary.json holds it: every column (column.h); NULL when memory ran out. */
json_t *mote_summary_row_json(const mote_summary *summary, const mote_summary_row *row);

/* The summary as the object that summary.json holds; NULL when memory ran out. */
json_t *mote_summary_json(const mote_summary *summary);

/* Writes directory/summary.json, summary.csv (mote_table_csv), and fronts.csv and speed.csv
   (harness/summary/front.h). */
mote_status mote_summary_write(const mote_summary *summary, const char *directory);

#endif
