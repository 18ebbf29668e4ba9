/* The child process that reads files; used by the importers only. */
#ifndef MOTE_HARNESS_IMPORT_CHILD_H
#define MOTE_HARNESS_IMPORT_CHILD_H

#include "harness/process/child.h"

/* Runs work, whose context is the path, in a child process that changes no files; its limits of
   time and memory follow from the file's size. MOTE_EIO: there is no such file, or the child
   crashed or took too long; MOTE_EINVAL: it is not a regular file, or too large. *output is
   what the child sent, freed by the caller. */
mote_status mote_import_run_child(const char *path, mote_child_work work, char **output,
                                  size_t *size);

/* Call it first in the child: it discards what libraries print and restores the default action
   of crash signals. */
void mote_import_begin_child(void);

/* Whether --strict was given (mesh_import.h). */
bool mote_import_is_strict(void);

#endif
