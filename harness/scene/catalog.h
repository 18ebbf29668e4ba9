/* The built-in scenarios: the files of datasets/scenarios and of the folders in it. A scenario
   is named by its file alone, without the folder. */
#ifndef MOTE_HARNESS_CATALOG_H
#define MOTE_HARNESS_CATALOG_H

#include "core/base/status.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct mote_catalog_entry {
    char *name;    /* "ww" */
    char *purpose; /* one sentence */
    bool several;  /* more than two bodies (harness/scene/bodies.h) */
} mote_catalog_entry;

typedef struct mote_catalog {
    mote_catalog_entry *entries; /* sorted by name */
    size_t count;
} mote_catalog;

/* Lists the built-in scenarios without loading their meshes. MOTE_EIO if the folder cannot be
   read, MOTE_EINVAL if a file in it is not a scenario. The caller destroys *catalog. */
mote_status mote_catalog_read(mote_catalog *catalog);
void mote_catalog_free(mote_catalog *catalog);

/* The path of the built-in scenario with a name, or of the file that it would have in
   datasets/scenarios if there is none; the caller frees it. */
char *mote_catalog_path(const char *name);

#endif
