/* Methods and kinds of fields from shared libraries that users compiled against mote's headers.

   The process that plans a run never loads such a library: a child loads it and reports what it
   offers. A process loads it only where one of its methods is built, which is a cell's process,
   or where a scenario names one of its fields. A method that crashes, hangs or ends its process
   thus costs one cell. */
#ifndef MOTE_HARNESS_PLUGIN_H
#define MOTE_HARNESS_PLUGIN_H

#include "core/base/status.h"

#include <jansson.h>
#include <stddef.h>
#include <stdint.h>

/* Asks a library for its methods and fields and registers them (mote_method_at,
   mote_field_maker_at). path is a file's path, not a name to search for. MOTE_EINVAL with a
   text that begins with the path: not a shared library, not one for mote, built for another
   version of the contract, an invalid method or field, or a name that is taken. */
mote_status mote_plugin_open(const char *path);

/* The files of the open libraries, by number; NULL beyond the last. */
const char *mote_plugin_path(size_t index);

/* At most this many libraries are open. */
#define MOTE_PLUGINS_MAX 16

/* A hash over the files of all open libraries; 0 if none is open. */
uint64_t mote_plugin_hash(void);

/* [{"file", "contract", "methods": [NAME...], "fields": [NAME...]}...]; the caller decrefs. */
json_t *mote_plugin_json(void);

#endif
