/* The history as a self-contained page: for each row a chart of the accepted references and one
   of the races, with each point linked to its commit and reason. */
#ifndef MOTE_HARNESS_HISTORY_PAGE_H
#define MOTE_HARNESS_HISTORY_PAGE_H

#include "core/base/status.h"

/* Writes the page of a history file (harness/summary/history.h) and of the races in a folder
   (NAME.json written by `mote race --out`, in the order of their dates; "last.json" is skipped,
   and the folder may be missing). Errors as mote_history_read; MOTE_EINVAL for a race that
   cannot be read, and if there is neither a reference nor a race. */
mote_status mote_history_page(const char *file, const char *races, const char *page);

#endif
