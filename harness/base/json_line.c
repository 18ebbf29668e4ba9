/* Finds the line of a value in a JSON text. jansson does not keep line numbers, so when an
   error is reported, the text, known to be valid, is searched along the value's path. */
#include "harness/base/json_read.h"

#include <stdlib.h>
#include <string.h>

static const char *skip_space(const char *at)
{
    return at + strspn(at, " \t\r\n");
}

static const char *skip_string(const char *at)
{
    for (++at; *at && *at != '"'; ++at) {
        if (*at == '\\' && at[1])
            ++at;
    }
    return *at ? at + 1 : at;
}

/* Just after the value that begins at `at`. */
static const char *skip_value(const char *at)
{
    if (*at == '"')
        return skip_string(at);
    if (*at != '{' && *at != '[')
        return at + strcspn(at, ",]} \t\r\n");
    int depth = 0;
    while (*at) {
        if (*at == '"') {
            at = skip_string(at);
            continue;
        }
        if (*at == '{' || *at == '[')
            ++depth;
        else if ((*at == '}' || *at == ']') && --depth == 0)
            return at + 1;
        ++at;
    }
    return at;
}

/* The value of a key in the object at `at`, or NULL. */
static const char *find_member(const char *at, const char *key, size_t length)
{
    if (*at != '{')
        return NULL;
    at = skip_space(at + 1);
    while (*at == '"') {
        const char *name = at + 1;
        at = skip_string(at);
        bool same = (size_t)(at - name) == length + 1 && strncmp(name, key, length) == 0;
        at = skip_space(at);
        at = skip_space(*at == ':' ? at + 1 : at);
        if (same)
            return at;
        at = skip_space(skip_value(at));
        if (*at == ',')
            at = skip_space(at + 1);
    }
    return NULL;
}

static const char *find_element(const char *at, unsigned long index)
{
    if (*at != '[')
        return NULL;
    at = skip_space(at + 1);
    for (; index > 0 && *at && *at != ']'; --index) {
        at = skip_space(skip_value(at));
        if (*at == ',')
            at = skip_space(at + 1);
    }
    return *at && *at != ']' ? at : NULL;
}

int mote_json_line(const char *text, const char *path)
{
    const char *found = skip_space(text);
    while (*path) {
        const char *next;
        if (*path == '[') {
            char *end;
            next = find_element(found, strtoul(path + 1, &end, 10));
            path = *end == ']' ? end + 1 : end;
        } else {
            path += *path == '.';
            size_t length = strcspn(path, ".[");
            next = find_member(found, path, length);
            path += length;
        }
        if (!next)
            break;
        found = next;
    }
    int line = 1;
    for (const char *at = text; at < found; ++at)
        line += *at == '\n';
    return line;
}
