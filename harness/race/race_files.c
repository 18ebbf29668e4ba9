#include "harness/race/race_files.h"

#include "harness/base/memory.h"
#include "harness/base/record.h"

#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#define KEYS_MAX 64 /* per method */

static int by_text(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

char *mote_race_row_key(const char *name)
{
    char *copy = mote_duplicate(name), *keys[KEYS_MAX];
    mote_text key = {.data = NULL};
    char *colon = strchr(copy, ':'), *slash = strrchr(copy, '/');
    size_t count = 0;
    if (!colon || !slash || slash < colon)
        return copy;
    *slash = '\0';
    for (char *k = colon + 1; k && count < KEYS_MAX; ++count) {
        keys[count] = k;
        k += strcspn(k, ",;");
        k = *k ? (*k = '\0', k + 1) : NULL;
    }
    qsort(keys, count, sizeof keys[0], by_text);
    *colon = '\0';
    mote_text_add(&key, "%s", copy);
    for (size_t i = 0; i < count; ++i)
        mote_text_add(&key, "%c%s", i ? ',' : ':', keys[i]);
    mote_text_add(&key, "/%s", slash + 1);
    free(copy);
    return key.data;
}

static int by_date(const void *a, const void *b)
{
    return strcmp(mote_text_at(((const mote_race_file *)a)->json, "date"),
                  mote_text_at(((const mote_race_file *)b)->json, "date"));
}

/* Reads a file into the list. */
static mote_status read_race(const char *folder, const char *name, mote_race_files *files,
                             size_t *capacity)
{
    json_t *race = NULL;
    mote_status status = mote_record_read_json(folder, name, &race);
    const json_int_t schema = json_integer_value(json_object_get(race, "schema"));
    if (status == MOTE_OK && (schema != 1 || !json_is_array(json_object_get(race, "rows")) ||
                              !json_is_string(json_object_get(race, "date"))))
        status =
            mote_fail(MOTE_EINVAL, "%s/%s: not a race; keep only what `mote race --out` wrote",
                      folder, name);
    if (status != MOTE_OK) {
        json_decref(race);
        return status;
    }
    files->races = mote_reserve(files->races, files->count + 1, capacity, sizeof *files->races);
    files->races[files->count++].json = race;
    return MOTE_OK;
}

/* Lists the names of all rows, the first of those with one key. */
static void list_names(mote_race_files *files)
{
    size_t capacity = 0, key_capacity = 0, i;
    char **keys = NULL; /* [name_count] */
    const json_t *row;
    for (size_t r = 0; r < files->count; ++r) {
        MOTE_EACH(i, row, json_object_get(files->races[r].json, "rows"))
        {
            const char *name = mote_text_at(row, "name");
            char *key = mote_race_row_key(name);
            size_t k = 0;
            while (k < files->name_count && strcmp(keys[k], key) != 0)
                ++k;
            if (k < files->name_count) {
                free(key);
                continue;
            }
            files->names = mote_reserve(files->names, k + 1, &capacity, sizeof *files->names);
            keys = mote_reserve(keys, k + 1, &key_capacity, sizeof *keys);
            keys[k] = key;
            files->names[files->name_count++] = name;
        }
    }
    for (size_t k = 0; k < files->name_count; ++k)
        free(keys[k]);
    free(keys);
}

mote_status mote_race_files_read(const char *folder, mote_race_files *files)
{
    size_t capacity = 0;
    mote_status status = MOTE_OK;
    *files = (mote_race_files){.races = NULL};
    DIR *entries = opendir(folder);
    if (!entries && errno != ENOENT)
        return mote_fail(MOTE_EIO, "%s: cannot be read: %s", folder, strerror(errno));
    for (const struct dirent *entry;
         entries && status == MOTE_OK && (entry = readdir(entries));) {
        if (mote_name_ends(entry->d_name, ".json") && strcmp(entry->d_name, "last.json") != 0)
            status = read_race(folder, entry->d_name, files, &capacity);
    }
    if (entries)
        (void)closedir(entries);
    if (files->count > 0)
        qsort(files->races, files->count, sizeof files->races[0], by_date);
    list_names(files);
    return status;
}

void mote_race_files_free(mote_race_files *files)
{
    for (size_t i = 0; i < files->count; ++i)
        json_decref(files->races[i].json);
    free(files->races);
    free(files->names);
    *files = (mote_race_files){.races = NULL};
}

bool mote_race_files_has(const mote_race_files *files, const char *key)
{
    for (size_t i = 0; i < files->count; ++i) {
        if (mote_race_files_point(files, i, key).ratio > 0)
            return true;
    }
    return false;
}

mote_race_point mote_race_files_point(const mote_race_files *files, size_t race,
                                      const char *key)
{
    const mote_race_point none = {
        .ratio = MOTE_NONE, .interval = {MOTE_NONE, MOTE_NONE}, .verdict = "", .what = ""};
    size_t i;
    const json_t *row;
    MOTE_EACH(i, row, json_object_get(files->races[race].json, "rows"))
    {
        char *own = mote_race_row_key(mote_text_at(row, "name"));
        const bool found = strcmp(own, key) == 0;
        free(own);
        if (found)
            return (mote_race_point){
                .ratio = mote_number_at(row, "ratio"),
                .interval = {mote_number_at(row, "ci_low"), mote_number_at(row, "ci_high")},
                .verdict = mote_text_at(row, "verdict"),
                .what = mote_text_at(row, "what")};
    }
    return none;
}

char *mote_race_files_changes(const mote_race_files *files, size_t race)
{
    mote_text text = {.data = NULL};
    size_t i;
    const json_t *row;
    mote_text_add(&text, "%s", "");
    MOTE_EACH(i, row, json_object_get(files->races[race].json, "rows"))
    {
        const char *verdict = mote_text_at(row, "verdict");
        if (json_is_true(json_object_get(row, "worse")) || strcmp(verdict, "faster") == 0)
            mote_text_add(&text, "%s%s %s (%.4g)", text.size ? "; " : "",
                          mote_text_at(row, "name"), verdict, mote_number_at(row, "ratio"));
    }
    return text.data;
}
