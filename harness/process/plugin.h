/* Methods and kinds of fields from shared libraries that users compiled against mote's headers.

   Such a library is never loaded by the process that plans a run: a child loads it and tells
   what it offers. A process loads it where one of its methods is first built, which is that of
   a cell, or where a scenario names one of its fields. A method that crashes, hangs or ends its
   process thus costs one cell. */
#ifndef MOTE_HARNESS_PLUGIN_H
#define MOTE_HARNESS_PLUGIN_H

#include "core/base/status.h"

#include <jansson.h>
#include <stddef.h>
#include <stdint.h>

/* Asks a library for its methods and fields and makes them known (mote_method_at,
   mote_field_maker_at). path is of a file, not a name to be searched for. MOTE_EINVAL with a
   text that begins with the path: no shared library, none of mote's, built for another version
   of the contract, something wrong with a method or a field, or a name that is taken. */
mote_status mote_plugin_open(const char *path);

/* The files of the libraries that are open, by number; NULL behind the last. */
const char *mote_plugin_path(size_t index);

/* A hash over the files of all libraries that are open; 0: none is. */
uint64_t mote_plugin_hash(void);

/* [{"file", "contract", "methods": [NAME...], "fields": [NAME...]}...]; the caller decrefs. */
json_t *mote_plugin_json(void);

#endif
