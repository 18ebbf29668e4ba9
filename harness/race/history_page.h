/* The history as a page that loads nothing: a chart a row of the accepted references and of the
   races, each point linked to its commit and reason. */
#ifndef MOTE_HARNESS_HISTORY_PAGE_H
#define MOTE_HARNESS_HISTORY_PAGE_H

#include "core/base/status.h"

/* Writes the page of a history file (harness/summary/history.h) and of the races in a folder
   (NAME.json as `mote race --out` writes them, in the order of their dates; a name "last.json"
   is passed over, and so is a folder that is not there). The errors of mote_history_read;
   MOTE_EINVAL for a race that cannot be read, and where there is neither a reference nor a
   race. */
mote_status mote_history_page(const char *file, const char *races, const char *page);

#endif
