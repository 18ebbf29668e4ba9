/* For the list in column.c: values that are lists and objects, and the JSON schemas of these.
 */
#ifndef MOTE_HARNESS_COLUMN_VALUE_H
#define MOTE_HARNESS_COLUMN_VALUE_H

#include "harness/summary/summary_row.h"

/* Mean and largest of each count over the frames of all replicates. New references. */
json_t *mote_column_counters(const mote_summary_row *row);

/* Each process that ended well: what comparisons with another run are made from. */
json_t *mote_column_processes(const mote_summary_row *row);

json_t *mote_column_quiet(const mote_summary_row *row);

#define MOTE_COUNTERS_SCHEMA                                                                   \
    "{\"type\": \"object\", \"additionalProperties\": {\"type\": \"object\", \"properties\": " \
    "{\"mean\": {\"type\": \"number\"}, \"max\": {\"type\": \"number\"}}, \"required\": "      \
    "[\"mean\", \"max\"]}}"

#define MOTE_PROCESSES_SCHEMA                                                                  \
    "{\"type\": \"array\", \"items\": {\"type\": \"object\", \"properties\": {\"replicate\": " \
    "{\"type\": \"integer\"}, \"median_ns\": {\"type\": [\"number\", \"null\"]}, \"ratio\": "  \
    "{\"type\": [\"number\", \"null\"]}, \"counters\": {\"type\": \"object\", "                \
    "\"additionalProperties\": {\"type\": \"number\"}}}, \"required\": [\"replicate\", "       \
    "\"median_ns\", \"ratio\", \"counters\"]}}"

#define MOTE_QUIET_SCHEMA                                                                      \
    "{\"type\": \"object\", \"properties\": {\"total_ns\": {\"type\": \"array\", \"items\": "  \
    "{\"type\": [\"number\", \"null\"]}, \"minItems\": 5, \"maxItems\": 5}, \"ratio\": "       \
    "{\"type\": "                                                                              \
    "\"array\", \"items\": {\"type\": [\"number\", \"null\"]}, \"minItems\": 5, "              \
    "\"maxItems\": "                                                                           \
    "5}}, \"required\": [\"total_ns\", \"ratio\"]}"

#endif
