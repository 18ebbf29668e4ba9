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

char *mote_race_row_key(const char *name, const char *asked)
{
    char *copy = mote_duplicate(name), *keys[KEYS_MAX];
    mote_text key = {.data = NULL};
    char *colon = strchr(copy, ':'), *slash = strrchr(copy, '/');
    const bool has_keys = colon && slash && slash > colon;
    size_t count = 0;
    if (has_keys)
        *slash = *colon = '\0';
    for (char *k = has_keys ? colon + 1 : NULL; k && count < KEYS_MAX; ++count) {
        keys[count] = k;
        k += strcspn(k, ",;");
        k = *k ? (*k = '\0', k + 1) : NULL;
    }
    if (count > 0)
        qsort(keys, count, sizeof keys[0], by_text);
    mote_text_add(&key, "%s", copy);
    for (size_t i = 0; i < count; ++i)
        mote_text_add(&key, "%c%s", i ? ',' : ':', keys[i]);
    if (has_keys)
        mote_text_add(&key, "/%s", slash + 1);
    if (asked[0])
        mote_text_add(&key, " %s", asked);
    free(copy);
    return key.data;
}

/* The name of a row, without the frames that it may have in it. The caller frees it. */
static char *name_of(const json_t *row)
{
    const char *scenario = mote_text_at(row, "scenario"), *method = mote_text_at(row, "method"),
               *cache = mote_text_at(row, "cache");
    return scenario[0] && method[0] && cache[0]
               ? mote_format("%s/%s/%s", scenario, method, cache)
               : mote_duplicate(mote_text_at(row, "name"));
}

static char *key_of(const json_t *row, const char *asked)
{
    char *name = name_of(row), *key = mote_race_row_key(name, asked);
    free(name);
    return key;
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

/* Adds the name of a row, unless another row has its key; keys [name_count]. */
static void list_name(mote_race_files *files, const json_t *row, size_t *capacity, char ***keys,
                      size_t *key_capacity)
{
    const char *asked = mote_text_at(row, "asked");
    char *key = key_of(row, asked);
    const size_t count = files->name_count;
    for (size_t k = 0; k < count; ++k) {
        if (strcmp((*keys)[k], key) == 0) {
            free(key);
            return;
        }
    }
    files->names = mote_reserve(files->names, count + 1, capacity, sizeof *files->names);
    *keys = mote_reserve(*keys, count + 1, key_capacity, sizeof **keys);
    (*keys)[count] = key;
    files->names[count] = (mote_race_name){name_of(row), asked};
    ++files->name_count;
}

/* Lists the names of all rows, the first of those with one key. */
static void list_names(mote_race_files *files)
{
    size_t capacity = 0, key_capacity = 0, i;
    char **keys = NULL;
    const json_t *row;
    for (size_t r = 0; r < files->count; ++r) {
        MOTE_EACH(i, row, json_object_get(files->races[r].json, "rows"))
        list_name(files, row, &capacity, &keys, &key_capacity);
    }
    for (size_t k = 0; k < files->name_count; ++k)
        free(keys[k]);
    free(keys);
}

void mote_race_files_complete(mote_race_files *files, const char *name, const char *asked)
{
    char *wanted = mote_race_row_key(name, "");
    size_t i;
    json_t *row;
    for (size_t r = 0; r < files->count; ++r) {
        MOTE_EACH(i, row, json_object_get(files->races[r].json, "rows"))
        {
            char *own = key_of(row, "");
            if (strcmp(own, wanted) == 0 && mote_text_at(row, "asked")[0] == '\0')
                (void)json_object_set_new(row, "asked", json_string(asked));
            free(own);
        }
    }
    for (size_t k = 0; k < files->name_count; ++k) {
        char *own = mote_race_row_key(files->names[k].name, "");
        if (strcmp(own, wanted) == 0 && files->names[k].asked[0] == '\0')
            files->names[k].asked = asked;
        free(own);
    }
    free(wanted);
}

/* Completes rows from others of their name. */
static void complete_rows(mote_race_files *files)
{
    size_t i;
    const json_t *row;
    for (size_t r = 0; r < files->count; ++r) {
        MOTE_EACH(i, row, json_object_get(files->races[r].json, "rows"))
        {
            const char *asked = mote_text_at(row, "asked");
            char *name = name_of(row);
            if (asked[0])
                mote_race_files_complete(files, name, asked);
            free(name);
        }
    }
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
    complete_rows(files);
    list_names(files);
    return status;
}

void mote_race_files_free(mote_race_files *files)
{
    for (size_t i = 0; i < files->count; ++i)
        json_decref(files->races[i].json);
    for (size_t k = 0; k < files->name_count; ++k)
        free(files->names[k].name);
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
        char *own = key_of(row, mote_text_at(row, "asked"));
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
