/* Signals that ask this program to stop. */
#ifndef MOTE_HARNESS_STOP_H
#define MOTE_HARNESS_STOP_H

#include "core/base/status.h"

#include <stdbool.h>

/* From now on SIGINT and SIGTERM only ask to stop: functions that wait for children, or for
   other programs, then end them. A write beyond the file size limit fails with an error instead
   of a signal. */
void mote_child_heed_signals(void);
bool mote_child_stop_asked(void);

/* The signal that asked to stop, or 0. */
int mote_child_stop_signal(void);

/* MOTE_EIO: stopped by a signal. The command has to make the file, or folder, at path again;
   NULL: it goes on where it was stopped. */
mote_status mote_child_stopped(const char *path);

#endif
