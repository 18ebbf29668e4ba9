/* The child process in which files are read; used by the importers only. */
#ifndef MOTE_HARNESS_IMPORT_CHILD_H
#define MOTE_HARNESS_IMPORT_CHILD_H

#include "harness/process/child.h"

/* Runs work, whose context is the path, in a child process with limits of time and memory that
   follow from the file's size; it changes no files. MOTE_EIO: there is no such file, or the
   child crashed or took too long; MOTE_EINVAL: it is no regular file, or too large. *output is
   what the child put, freed by the caller. */
mote_status mote_import_run_child(const char *path, mote_child_work work, char **output,
                                  size_t *size);

/* To be called first in the child: what a library prints goes nowhere, and a crash is one. */
void mote_import_begin_child(void);

/* Whether --strict was given (mesh_import.h). */
bool mote_import_is_strict(void);

#endif
