#include "harness/base/json_read.h"

#include "harness/base/file.h"
#include "harness/base/memory.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Up to here a double holds every whole number. */
#define WHOLE_MAX 0x1p53

mote_status mote_json_parse(const char *path, const char *text, size_t size, const char *advice,
                            json_t **root)
{
    json_error_t error;
    json_t *parsed = json_loadb(text, size, JSON_REJECT_DUPLICATES, &error);
    if (!parsed)
        return mote_fail(MOTE_EINVAL, "%s:%d:%d: %s; %s", path, error.line, error.column,
                         error.text, advice);
    *root = parsed;
    return MOTE_OK;
}

mote_status mote_json_open(const char *path, mote_json_file *file)
{
    mote_json_file opened = {0};
    size_t size = 0;
    mote_status status = mote_file_read(path, MOTE_JSON_LIMIT, &opened.text, &size);
    if (status != MOTE_OK)
        return status;
    const size_t mark = (size_t)(mote_skip_mark(opened.text) - opened.text);
    size -= mark;
    memmove(opened.text, opened.text + mark, size + 1);
    status = mote_json_parse(path, opened.text, size, "correct the JSON there", &opened.root);
    if (status != MOTE_OK) {
        mote_json_close(&opened);
        return status;
    }
    opened.path = mote_duplicate(path);
    *file = opened;
    return MOTE_OK;
}

void mote_json_close(mote_json_file *file)
{
    json_decref(file->root);
    free(file->text);
    free(file->path);
    *file = (mote_json_file){0};
}

mote_json mote_json_root(const mote_json_file *file)
{
    mote_json node = {file, file->root, ""};
    return node;
}

mote_status mote_json_fail(const mote_json *node, const char *format, ...)
{
    char text[640];
    va_list arguments;
    va_start(arguments, format);
    (void)vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    return mote_fail(MOTE_EINVAL, "%s:%d: %s%s%s", node->file->path,
                     mote_json_line(node->file->text, node->path), node->path,
                     node->path[0] ? ": " : "", text);
}

/* Whether an error text begins with a place in the file. */
static bool is_placed(const mote_json_file *file, const char *text)
{
    const size_t length = strlen(file->path);
    return strncmp(text, file->path, length) == 0 && text[length] == ':' &&
           strspn(text + length + 1, "0123456789") > 0;
}

mote_status mote_json_blame(const mote_json *node, mote_status status)
{
    if (status == MOTE_OK || status == MOTE_ENOMEM || is_placed(node->file, mote_error_text()))
        return status;
    return mote_json_fail(node, "%s", mote_error_text());
}

mote_json mote_json_member(const mote_json *object, const char *key)
{
    mote_json node = {object->file, json_object_get(object->value, key), ""};
    (void)snprintf(node.path, sizeof node.path, "%.120s%s%.36s", object->path,
                   object->path[0] ? "." : "", key);
    return node;
}

mote_json mote_json_element(const mote_json *array, size_t index)
{
    mote_json node = {array->file, json_array_get(array->value, index), ""};
    (void)snprintf(node.path, sizeof node.path, "%.130s[%zu]", array->path, index);
    return node;
}

static bool is_known(const char *known, const char *key)
{
    size_t length = strlen(key);
    if (strchr(key, '|'))
        return false;
    for (const char *word = known; word; word = strchr(word, '|')) {
        if (*word == '|')
            ++word;
        if (strncmp(word, key, length) == 0 && (word[length] == '|' || word[length] == '\0'))
            return true;
    }
    return false;
}

/* What a value is, in the words of a message. */
static const char *kind_of(const mote_json *node, char text[48])
{
    if (!node->value)
        return "is missing";
    switch (json_typeof(node->value)) {
    case JSON_OBJECT:
        return "is an object";
    case JSON_ARRAY:
        (void)snprintf(text, 48, "is an array of %zu", json_array_size(node->value));
        return text;
    case JSON_STRING:
        return json_string_length(node->value) > 0 ? "is a string" : "is an empty string";
    case JSON_INTEGER:
    case JSON_REAL:
        (void)snprintf(text, 48, "is %.15g", json_number_value(node->value));
        return text;
    case JSON_NULL:
        return "is null";
    default:
        return json_is_true(node->value) ? "is true" : "is false";
    }
}

mote_status mote_json_refuse(const mote_json *node, const char *right)
{
    char kind[48];
    return mote_json_fail(node, "%s; give %s", kind_of(node, kind), right);
}

mote_status mote_json_object(const mote_json *node, const char *known)
{
    if (!json_is_object(node->value)) {
        char right[300];
        (void)snprintf(right, sizeof right, "an object {...} with keys of %s", known);
        return mote_json_refuse(node, right);
    }
    const char *key;
    json_t *value;
    json_object_foreach(node->value, key, value)
    {
        if (!is_known(known, key)) {
            mote_json member = mote_json_member(node, key);
            return mote_json_fail(&member, "unknown key; known here are %s", known);
        }
    }
    return MOTE_OK;
}

mote_status mote_json_array(const mote_json *node, size_t minimum, size_t maximum, size_t *size)
{
    size_t count = json_array_size(node->value);
    if (!json_is_array(node->value) || count < minimum || count > maximum) {
        char right[80];
        if (minimum == maximum)
            (void)snprintf(right, sizeof right, "an array of %zu", minimum);
        else
            (void)snprintf(right, sizeof right, "an array of %zu to %zu", minimum, maximum);
        return mote_json_refuse(node, right);
    }
    *size = count;
    return MOTE_OK;
}

mote_status mote_json_real(const mote_json *node, double minimum, double maximum, double *value)
{
    const double number = json_number_value(node->value);
    if (!json_is_number(node->value)) {
        char right[80];
        (void)snprintf(right, sizeof right, "a number from %g to %g", minimum, maximum);
        return mote_json_refuse(node, right);
    }
    /* A NaN fails this test. */
    if (!(number >= minimum && number <= maximum))
        return mote_json_fail(node, "%.17g is out of range; give a number from %g to %g",
                              number, minimum, maximum);
    *value = number;
    return MOTE_OK;
}

/* The whole number that a value is, also if it is written as 2.0 or 2e0. */
static bool whole_number(const json_t *value, int64_t *number)
{
    *number = json_integer_value(value);
    if (json_is_integer(value))
        return true;
    const double real = json_real_value(value);
    const bool is_whole = json_is_real(value) && fabs(real) <= WHOLE_MAX && real == floor(real);
    if (is_whole)
        *number = (int64_t)real;
    return is_whole;
}

mote_status mote_json_integer(const mote_json *node, int64_t minimum, int64_t maximum,
                              int64_t *value)
{
    int64_t number;
    if (!whole_number(node->value, &number)) {
        char right[80];
        (void)snprintf(right, sizeof right, "a whole number from %lld to %lld",
                       (long long)minimum, (long long)maximum);
        return mote_json_refuse(node, right);
    }
    if (number < minimum || number > maximum)
        return mote_json_fail(node, "%lld is out of range; give %lld to %lld",
                              (long long)number, (long long)minimum, (long long)maximum);
    *value = number;
    return MOTE_OK;
}

mote_status mote_json_reals(const mote_json *node, size_t count, double minimum, double maximum,
                            double *values)
{
    size_t size;
    mote_status status = mote_json_array(node, count, count, &size);
    for (size_t i = 0; i < count && status == MOTE_OK; ++i) {
        mote_json element = mote_json_element(node, i);
        status = mote_json_real(&element, minimum, maximum, &values[i]);
    }
    return status;
}

mote_status mote_json_vec3(const mote_json *node, double minimum, double maximum,
                           mote_vec3 *value)
{
    double xyz[3] = {0};
    mote_status status = mote_json_reals(node, 3, minimum, maximum, xyz);
    if (status == MOTE_OK)
        *value = mote_vec3_make(xyz[0], xyz[1], xyz[2]);
    return status;
}

mote_status mote_json_number_or_vec3(const mote_json *node, double minimum, double maximum,
                                     mote_vec3 *value)
{
    if (json_is_array(node->value))
        return mote_json_vec3(node, minimum, maximum, value);
    if (!json_is_number(node->value))
        return mote_json_refuse(node, "a number or an array of 3");
    double number = 0;
    const mote_status status = mote_json_real(node, minimum, maximum, &number);
    if (status == MOTE_OK)
        *value = mote_vec3_make(number, number, number);
    return status;
}

mote_status mote_json_boolean(const mote_json *node, bool *value)
{
    if (!json_is_boolean(node->value))
        return mote_json_refuse(node, "true or false");
    *value = json_is_true(node->value);
    return MOTE_OK;
}

mote_status mote_json_string(const mote_json *node, const char **value)
{
    const char *text = json_string_value(node->value);
    if (!text)
        return mote_json_refuse(node, "a string");
    if (!text[0])
        return mote_json_refuse(node, "one that is not empty");
    *value = text;
    return MOTE_OK;
}
