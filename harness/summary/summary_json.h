/* Writes a summary into the files of a run's directory, and reads a summary.json. */
#ifndef MOTE_HARNESS_SUMMARY_JSON_H
#define MOTE_HARNESS_SUMMARY_JSON_H

#include "harness/summary/summary.h"

/* A row as in summary.json: every column (column.h). The caller decrefs it. */
json_t *mote_summary_row_json(const mote_summary_row *row);

/* The summary as in summary.json. The caller decrefs it. */
json_t *mote_summary_json(const mote_summary *summary);

/* Writes directory/summary.json, summary.csv (mote_table_csv), and fronts.csv and speed.csv
   (harness/summary/front.h). */
mote_status mote_summary_write(const mote_summary *summary, const char *directory);

/* Reads the rows of directory/name, a summary.json, possibly of an older build. They have no
   cells; values missing from the file are "", MOTE_NONE, 0 or true. MOTE_EIO or MOTE_EINVAL,
   with the file, if it cannot be read or has no list of rows. The caller frees *summary. */
mote_status mote_summary_read(const char *directory, const char *name, mote_summary *summary);

#endif
