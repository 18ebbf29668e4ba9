#include "core/base/parameter.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The index of text among "a|b|c", or -1. */
static int choice_index(const char *choices, const char *text, size_t length)
{
    int index = 0;
    for (const char *at = choices; at; ++index) {
        const char *end = strchr(at, '|');
        const size_t size = end ? (size_t)(end - at) : strlen(at);
        if (size == length && memcmp(at, text, length) == 0)
            return index;
        at = end ? end + 1 : NULL;
    }
    return -1;
}

static void range_text(const mote_parameter *p, char *buffer, size_t size)
{
    if (p->kind == MOTE_PARAMETER_CHOICE)
        (void)snprintf(buffer, size, "one of %s", p->choices);
    else
        (void)snprintf(buffer, size, "%s from %.15g to %.15g%s",
                       p->kind == MOTE_PARAMETER_INTEGER ? "a whole number" : "a number",
                       p->minimum, p->maximum, p->choices ? ", or auto" : "");
}

static mote_status bad_value(const mote_parameter *p, const char *text, size_t length)
{
    char range[512];
    range_text(p, range, sizeof range);
    return mote_fail(MOTE_EINVAL, "%s=%.*s is not valid; %s must be %s", p->key, (int)length,
                     text, p->key, range);
}

/* strtod reads the locale's decimal point; the program never leaves the C locale. */
static mote_status parse_value(const mote_parameter *p, const char *text, size_t length,
                               double *value)
{
    char copy[64];
    if (length == 0 || length >= sizeof copy)
        return bad_value(p, text, length);
    memcpy(copy, text, length);
    copy[length] = '\0';
    if (p->kind == MOTE_PARAMETER_CHOICE) {
        const int index = choice_index(p->choices, copy, length);
        *value = index;
        return index >= 0 ? MOTE_OK : bad_value(p, text, length);
    }
    if (p->choices && strcmp(copy, "auto") == 0) {
        *value = MOTE_AUTO;
        return MOTE_OK;
    }
    char *end = NULL;
    const double number = strtod(copy, &end);
    if (*end != '\0' || strpbrk(copy, " \t\n\r\v\f") || !(number >= p->minimum) ||
        !(number <= p->maximum))
        return bad_value(p, text, length);
    if (isinf(number) && strcmp(copy, "inf") != 0)
        return bad_value(p, text, length);
    if (p->kind == MOTE_PARAMETER_INTEGER &&
        !(fabs(number) <= 0x1p53 && number == floor(number)))
        return bad_value(p, text, length);
    *value = number;
    return MOTE_OK;
}

void mote_parameters_default(const mote_parameter *table, size_t count, double *values)
{
    for (size_t i = 0; i < count; ++i) {
        values[i] = 0;
        (void)parse_value(&table[i], table[i].fallback, strlen(table[i].fallback), &values[i]);
    }
}

static mote_status unknown_key(const mote_parameter *table, size_t count, const char *key,
                               size_t length)
{
    char known[768] = "";
    size_t used = 0;
    for (size_t i = 0; i < count && used < sizeof known; ++i)
        used += (size_t)snprintf(known + used, sizeof known - used, "%s%s", i ? ", " : "",
                                 table[i].key);
    if (count == 0)
        return mote_fail(MOTE_EINVAL, "unknown key \"%.*s\"; nothing can be set here",
                         (int)length, key);
    return mote_fail(MOTE_EINVAL, "unknown key \"%.*s\"; the keys are %s", (int)length, key,
                     known);
}

static mote_status find_key(const mote_parameter *table, size_t count, const char *key,
                            size_t length, size_t *index)
{
    for (size_t i = 0; i < count; ++i) {
        if (strlen(table[i].key) == length && memcmp(table[i].key, key, length) == 0) {
            *index = i;
            return MOTE_OK;
        }
    }
    return unknown_key(table, count, key, length);
}

/* One "key=value" of the given length. */
static mote_status parse_item(const mote_parameter *table, size_t count, const char *item,
                              size_t length, bool *seen, double *values)
{
    const char *equals = memchr(item, '=', length);
    if (!equals)
        return mote_fail(MOTE_EINVAL, "\"%.*s\" is not of the form key=value", (int)length,
                         item);
    size_t index = 0;
    mote_status status = find_key(table, count, item, (size_t)(equals - item), &index);
    if (status != MOTE_OK)
        return status;
    if (seen[index])
        return mote_fail(MOTE_EINVAL, "%s is given twice; give it once", table[index].key);
    seen[index] = true;
    const char *value = equals + 1;
    return parse_value(&table[index], value, length - (size_t)(value - item), &values[index]);
}

mote_status mote_parameters_parse(const mote_parameter *table, size_t count, const char *text,
                                  double *values)
{
    double read[MOTE_PARAMETERS_MAX];
    bool seen[MOTE_PARAMETERS_MAX] = {false};
    memcpy(read, values, count * sizeof *values);
    for (const char *at = *text ? text : NULL; at;) {
        const char *comma = strchr(at, ',');
        const size_t length = comma ? (size_t)(comma - at) : strlen(at);
        const mote_status status = parse_item(table, count, at, length, seen, read);
        if (status != MOTE_OK)
            return status;
        at = comma ? comma + 1 : NULL;
    }
    memcpy(values, read, count * sizeof *values);
    return MOTE_OK;
}

static void choice_text(const char *choices, double value, char *buffer, size_t size)
{
    const char *at = choices;
    for (int skip = (int)value; skip > 0; --skip)
        at = strchr(at, '|') + 1;
    const size_t length = strcspn(at, "|");
    (void)snprintf(buffer, size, "%.*s", (int)length, at);
}

const char *mote_parameter_text(const mote_parameter *parameter, double value, char *buffer,
                                size_t size)
{
    if (parameter->kind == MOTE_PARAMETER_CHOICE) {
        choice_text(parameter->choices, value, buffer, size);
        return buffer;
    }
    if (parameter->choices && value == MOTE_AUTO) {
        (void)snprintf(buffer, size, "auto");
        return buffer;
    }
    if (value == floor(value) && fabs(value) < 1e15) { /* 10, where %g says 1e+01 */
        (void)snprintf(buffer, size, "%.0f", value);
        return buffer;
    }
    for (int digits = 1; digits <= 17; ++digits) {
        (void)snprintf(buffer, size, "%.*g", digits, value);
        if (strtod(buffer, NULL) == value)
            break;
    }
    return buffer;
}
