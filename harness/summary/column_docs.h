/* The list of columns as data for the page, as a schema, and as a table for the documents. */
#ifndef MOTE_HARNESS_COLUMN_DOCS_H
#define MOTE_HARNESS_COLUMN_DOCS_H

#include "harness/base/file.h"
#include "harness/summary/column.h"

/* The JSON schema of a row of summary.json; NULL if memory ran out. results/schema/summary.json
   contains it as $defs.row. */
json_t *mote_columns_schema(void);

/* A column as data: {"object" (or null), "key", "csv" (or null), "unit", "meaning", "group",
   "head", "brief" (or null), "show": "time|ratio|percent|error|count|bytes" (or null),
   "interval", "table", "report", "screen" (its position there, ascending from left to right; 0:
   not shown), "less_is_better" (null if neither is better)}; NULL if memory ran out. */
json_t *mote_column_json(const mote_column *column);

/* The columns as a table in Markdown, contained in results/README.md. */
void mote_columns_markdown(mote_text *text);

#endif
