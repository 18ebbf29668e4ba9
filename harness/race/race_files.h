/* Races in a folder, as written by `mote race --out`. */
#ifndef MOTE_HARNESS_RACE_FILES_H
#define MOTE_HARNESS_RACE_FILES_H

#include "harness/base/statistics.h"

#include <jansson.h>

typedef struct mote_race_file {
    json_t *json; /* as written by `mote race --out` */
} mote_race_file;

/* A row of one or more races. */
typedef struct mote_race_name {
    char *name;        /* without frames */
    const char *asked; /* what it was asked (mote_history_asked); "": not known */
} mote_race_name;

typedef struct mote_race_files {
    mote_race_file *races; /* [count], by date */
    size_t count;
    mote_race_name *names; /* of all rows, one for each key */
    size_t name_count;
} mote_race_files;

/* Reads all NAME.json of a folder except last.json; none if there is no folder. Rows that do
   not say what they were asked are completed from the first row of their name that
   does.
   MOTE_EINVAL for a file that is not a race. Free with mote_race_files_free, even after a
   failure. */
mote_status mote_race_files_read(const char *folder, mote_race_files *files);
void mote_race_files_free(mote_race_files *files);

/* Identifies a row, whatever the order and separators of its keys:
   "ww/particle-paper:start=fps,n=5/hot" and "ww/particle-paper:n=5;start=fps/hot" are the same
   if they were asked the same. The caller frees it. */
char *mote_race_row_key(const char *name, const char *asked);

/* Takes the rows of a name that do not say what they were asked, as those of older versions,
   for rows that were asked this. `asked` must live as long as the files. */
void mote_race_files_complete(mote_race_files *files, const char *name, const char *asked);

/* Whether any race measured a row. */
bool mote_race_files_has(const mote_race_files *files, const char *key);

/* A row in one race; ratio is MOTE_NONE if the race does not have it. Texts are borrowed. */
typedef struct mote_race_point {
    double ratio;
    mote_confidence interval;
    const char *verdict, *what;
} mote_race_point;
mote_race_point mote_race_files_point(const mote_race_files *files, size_t race,
                                      const char *key);

/* The rows of a race that are faster, slower or worse, as a text that the caller frees. */
char *mote_race_files_changes(const mote_race_files *files, size_t race);

#endif
