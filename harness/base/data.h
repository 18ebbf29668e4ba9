/* Finds the files that the program reads: datasets/ and plots/. */
#ifndef MOTE_HARNESS_DATA_H
#define MOTE_HARNESS_DATA_H

#include "core/base/status.h"

#include <stddef.h>

/* The folder that holds datasets/ and plots/: ../share/mote beside the folder of an installed
   program, otherwise the sources it was built from. Never NULL; valid until the program ends.
   Not thread-safe. */
const char *mote_data_directory(void);

/* mote_file_read of a file in that folder: "plots/page/report.css". */
mote_status mote_data_read(const char *name, size_t limit, char **text, size_t *size);

#endif
