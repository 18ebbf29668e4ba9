/* Facts listed by both forms of a report: the machine and the commands. */
#ifndef MOTE_HARNESS_REPORT_FACTS_H
#define MOTE_HARNESS_REPORT_FACTS_H

#include "harness/report/report.h"

/* Lines "key: value" about the machine and the program, as [[key, value], ...]; empty without a
   manifest. NULL if memory ran out; the caller decrefs. */
json_t *mote_report_machine(const mote_report *report);

/* The commands that measured into the run: ["2026-11-21T13:29:53Z", "mote run ..."], quoted for
   a shell where needed. NULL when memory ran out; the caller decrefs. */
json_t *mote_report_commands(const mote_report *report);

/* The scenarios of the run with their purposes, "" if not built in: [[name, purpose], ...].
   NULL if memory ran out; the caller decrefs. */
json_t *mote_report_scenarios(const mote_report *report);

/* One line: "176 cells of 2 scenarios, commit 9c079316, 2026-11-21". The caller frees it. */
char *mote_report_subtitle(const mote_report *report);

#endif
