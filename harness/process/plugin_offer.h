/* The code that loads a shared library with methods or fields, runs it and reports what it
   offers. See plugin.h. */
#ifndef MOTE_HARNESS_PLUGIN_OFFER_H
#define MOTE_HARNESS_PLUGIN_OFFER_H

#include "core/base/plugin.h"
#include "core/base/status.h"

#include <jansson.h>
#include <stddef.h>

/* Loads the library into this process for good. The library owns items[count]. MOTE_EINVAL with
   a text without the path: not a shared library, not one for mote, or built for another version
   of the contract. */
mote_status mote_plugin_load(const char *path, const mote_plugin_item *const **items,
                             size_t *count);

/* Checks items[count] and describes them: {"methods": [...], "fields": [...]}, each item being
   {"item": index, "name", "summary", "parameters": [{"key", "kind", "minimum", "maximum",
   "choices", "fallback", "help"}...]}, with numbers as text since some are infinite. The caller
   decrefs *offer. MOTE_EINVAL: one of them is no valid method or field. */
mote_status mote_plugin_describe(const mote_plugin_item *const *items, size_t count,
                                 json_t **offer);

/* Work for mote_child_run; context is the path. Loads the library and sends the description of
   its items as JSON. Errors of both functions above. */
mote_status mote_plugin_offer(void *context, int output);

#endif
