/* What the user said before and behind a command about every command: --allow, --strict and
   --plugin. A program of ours that this one starts is told the same. */
#ifndef MOTE_HARNESS_OWN_WORDS_H
#define MOTE_HARNESS_OWN_WORDS_H

#include "harness/process/plugin.h"
#include "harness/scene/fence.h"

#include <stddef.h>

/* At most this many words are added to a command's own. */
#define MOTE_OWN_WORDS_MAX (2 * MOTE_FENCE_FOLDERS_MAX + 1 + 2 * MOTE_PLUGINS_MAX)

/* Appends to argv, which holds `used` words: --allow and --strict, the command's words [count],
   and --plugin. Returns how many it holds then; it must have room for count +
   MOTE_OWN_WORDS_MAX more, and the NULL at its end is the caller's. Words are borrowed. */
size_t mote_own_words_add(const char *const *words, size_t count, const char **argv,
                          size_t used);

#endif
