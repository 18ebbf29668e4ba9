/* The report's data for the page: one JSON object, from which plots/page/ makes every table. */
#ifndef MOTE_HARNESS_REPORT_DATA_H
#define MOTE_HARNESS_REPORT_DATA_H

#include "harness/report/report.h"

/* A column is as in mote_column_json, with "path": [key...] in a row, and "extra": whether it
   is shown only together with all columns. Parts that the run lacks are omitted.

   {"scenarios": [[name, purpose]], "commands": [[when, command]], "machine": [[key, value]],
    "damaged": [text], "missing": [text], "noise_floor",
    "columns": [column], of the tables,
    "time", "error": the columns of a front's axes,
    "best", "engine": the columns of the ratios to the best FCL and to the best engine,
    "ratio", "memory": the columns of the ratio to FCL's AABB tree, and of the peak heap,
    "blocks": [{"heading", "first", "end", "right", "fastest"}]: rows first .. end - 1 are one
              table; the last two are rows to mention first, or null,
    "rows": [a row of summary.json, with "right", "contacts_right" (mote_summary_row_right),
             "notes": [text], "cells": [[replicate, id, status]]],
    "claims", "requirements": as their files, "claims_folder",
    "figures": [{"file", "title", "caption", "animation", "drawing": packed SVG}],
    "defects": Markdown}

   MOTE_EIO if a figure cannot be read. The caller decrefs *data. */
mote_status mote_report_data(const mote_report *report, json_t **data);

/* Sets the parts of this data that come from the rows of report->summary in the order of
   report->order: "columns" to "rows". */
void mote_report_rows_data(const mote_report *report, json_t *data);

#endif
