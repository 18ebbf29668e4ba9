#include "harness/base/record.h"

#include "harness/base/json_read.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* The largest JSON file of a run, in bytes. */
#define FILE_LIMIT ((size_t)1 << 30)

static mote_status write_at(const char *directory, const char *name, const void *data,
                            size_t size)
{
    char *path = mote_format("%s/%s", directory, name);
    mote_status status = mote_file_write(path, data, size);
    free(path);
    return status;
}

bool mote_record_exists(const char *directory, const char *name)
{
    char *path = mote_format("%s/%s", directory, name);
    const bool there = access(path, F_OK) == 0;
    free(path);
    return there;
}

mote_status mote_record_text(const char *directory, const char *name, mote_text *text)
{
    const mote_status status = write_at(directory, name, text->data, text->size);
    free(text->data);
    mote_text none = {0};
    *text = none;
    return status;
}

mote_status mote_record_json(const char *directory, const char *name, json_t *object)
{
    if (!object)
        return mote_fail(MOTE_EINVAL, "%s/%s: a name in it is not UTF-8; rename what has it",
                         directory, name);
    char *dump = json_dumps(object, MOTE_JSON_FLAGS);
    mote_text text = {0};
    mote_text_add(&text, "%s\n", dump);
    free(dump);
    json_decref(object);
    return mote_record_text(directory, name, &text);
}

mote_status mote_record_read_json(const char *directory, const char *name, json_t **object)
{
    char *path = mote_format("%s/%s", directory, name);
    char *data = NULL;
    size_t size = 0;
    mote_status status = mote_file_read(path, FILE_LIMIT, &data, &size);
    if (status == MOTE_OK)
        status = mote_json_parse(path, data, size, "expected JSON that mote wrote", object);
    free(data);
    free(path);
    return status;
}

static bool is_ok(const char *directory, const char *name)
{
    json_t *object = NULL;
    const bool ok = mote_record_read_json(directory, name, &object) == MOTE_OK &&
                    strcmp(mote_text_at(object, "status"), "ok") == 0;
    json_decref(object);
    return ok;
}

bool mote_record_is_wanted(const char *from, const char *to, const char *name)
{
    return !mote_record_exists(to, name) || (!is_ok(to, name) && is_ok(from, name));
}

json_t *mote_json_number(double value)
{
    return isfinite(value) ? json_real(value) : json_null();
}

double mote_number_of(const json_t *value)
{
    return json_is_number(value) ? json_number_value(value) : (double)NAN;
}

double mote_number_at(const json_t *object, const char *key)
{
    return mote_number_of(json_object_get(object, key));
}

const char *mote_text_at(const json_t *object, const char *key)
{
    const char *text = json_string_value(json_object_get(object, key));
    return text ? text : "";
}

mote_status mote_json_put(json_t *object, size_t flags, FILE *out)
{
    if (!object)
        return mote_fail(MOTE_EINVAL, "a name to be printed is not UTF-8; rename what has it");
    char *text = json_dumps(object, flags);
    json_decref(object);
    (void)fprintf(out, "%s\n", text);
    free(text);
    return MOTE_OK;
}

mote_status mote_record_copy(const char *from, const char *to, const char *name)
{
    char *source = mote_format("%s/%s", from, name), *target = mote_format("%s/%s", to, name);
    char *data = NULL;
    size_t size = 0;
    mote_status status = mote_file_read(source, MOTE_PAIRS_LIMIT, &data, &size);
    if (status == MOTE_OK)
        status = mote_file_write(target, data, size);
    free(data);
    free(source);
    free(target);
    return status;
}
