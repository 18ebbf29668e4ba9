/* What a row's configuration is called: its method and the parameters that differ from their
   defaults. */
#ifndef MOTE_HARNESS_ROW_LABEL_H
#define MOTE_HARNESS_ROW_LABEL_H

#include "core/method/method.h"
#include "harness/summary/stored.h"

/* "method:key=value,..." with the values that differ from the defaults. The caller frees it. */
char *mote_row_label(const mote_stored_cell *cell);

/* The value of a parameter of a method or of scenes as on the command line, and whether it is
   the default; method: NULL if this build has none of that name, and then nothing of it is a
   default. The caller frees it. */
char *mote_row_value(const mote_method *method, const char *key, const json_t *value,
                     bool *usual);

#endif
