/* The side of a shared library with methods or fields that runs its code: loading it and
   telling what it offers. See plugin.h. */
#ifndef MOTE_HARNESS_PLUGIN_OFFER_H
#define MOTE_HARNESS_PLUGIN_OFFER_H

#include "core/base/plugin.h"
#include "core/base/status.h"

#include <stddef.h>

/* Loads the library into this process for good. items[count] are its own. MOTE_EINVAL with a
   text without the path: no shared library, none of mote's, or one of another version of the
   contract. */
mote_status mote_plugin_load(const char *path, const mote_plugin_item *const **items,
                             size_t *count);

/* For mote_child_run, context being the path: loads the library, checks all of its items and
   puts {"methods": [...], "fields": [...]} as JSON, each {"item": index, "name", "summary",
   "parameters": [{"key", "kind", "minimum", "maximum", "choices", "fallback", "help"}...]}, the
   numbers as text since some are infinite. MOTE_EINVAL likewise. */
mote_status mote_plugin_offer(void *context, int output);

#endif
