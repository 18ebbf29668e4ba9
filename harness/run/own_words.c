#include "harness/run/own_words.h"

#include "harness/mesh/import_child.h"

size_t mote_own_words_add(const char *const *words, size_t count, const char **argv,
                          size_t used)
{
    for (size_t k = 0; mote_fence_allowed(k); ++k) {
        argv[used++] = "--allow";
        argv[used++] = mote_fence_allowed(k);
    }
    if (mote_import_is_strict())
        argv[used++] = "--strict";
    for (size_t k = 0; k < count; ++k)
        argv[used++] = words[k];
    for (size_t k = 0; mote_plugin_path(k); ++k) {
        argv[used++] = "--plugin";
        argv[used++] = mote_plugin_path(k);
    }
    return used;
}
