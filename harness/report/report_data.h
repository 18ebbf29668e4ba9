/* The report as the page reads it: one JSON object, from which plots/page/ makes every table.
 */
#ifndef MOTE_HARNESS_REPORT_DATA_H
#define MOTE_HARNESS_REPORT_DATA_H

#include "harness/report/report.h"

/* {"scenarios": [[name, purpose]], "commands": [[when, command]], "machine": [[key, value]],
    "damaged": [text], "missing": [text], "noise_floor", "machines_differ",
    "columns": [as mote_column_json, with "path": [key...], and "extra": whether the column is
                shown with all columns only],
    "blocks": [{"first", "end", "right", "fastest"}]: rows first .. end - 1 are one table,
    "rows": [a row of summary.json, with "notes": [text] and "cells": [[replicate, id,
   status]]], "claims", "requirements": as their files, "claims_folder", "figures": [{"file",
   "title", "caption", "animation", "drawing": packed SVG}], "defects": Markdown}. What the run
   does not have is left out. MOTE_EIO when a figure cannot be read. The caller decrefs *data.
 */
mote_status mote_report_data(const mote_report *report, json_t **data);

#endif
