#include "harness/base/json_print.h"

#include <stdlib.h>
#include <string.h>

#define WIDTH 96

static void print_value(const json_t *value, int digits, size_t indent, size_t before,
                        mote_text *text);

static void print_object(const json_t *object, int digits, size_t indent, mote_text *text)
{
    const char *key;
    const json_t *member;
    size_t left = json_object_size(object);
    mote_text_add(text, "{\n");
    /* The iterator's type casts const away; nothing is changed. */
    for (void *at = json_object_iter((json_t *)(uintptr_t)object); at;
         at = json_object_iter_next((json_t *)(uintptr_t)object, at)) {
        key = json_object_iter_key(at);
        member = json_object_iter_value(at);
        mote_text_add(text, "%*s\"%s\": ", (int)indent + 2, "", key);
        print_value(member, digits, indent + 2, strlen(key) + 4, text);
        mote_text_add(text, "%s\n", --left ? "," : "");
    }
    mote_text_add(text, "%*s}", (int)indent, "");
}

static void print_array(const json_t *array, int digits, size_t indent, mote_text *text)
{
    size_t count = json_array_size(array);
    mote_text_add(text, "[\n");
    for (size_t i = 0; i < count; ++i) {
        mote_text_add(text, "%*s", (int)indent + 2, "");
        print_value(json_array_get(array, i), digits, indent + 2, 0, text);
        mote_text_add(text, "%s\n", i + 1 < count ? "," : "");
    }
    mote_text_add(text, "%*s]", (int)indent, "");
}

/* before: characters already on the line, after the indent. */
static void print_value(const json_t *value, int digits, size_t indent, size_t before,
                        mote_text *text)
{
    const size_t flags =
        JSON_ENCODE_ANY | JSON_REAL_PRECISION((size_t)digits) | JSON_PRESERVE_ORDER;
    char *line = json_dumps(value, flags);
    if (indent + before + strlen(line) < WIDTH || json_is_string(value))
        mote_text_add(text, "%s", line);
    else if (json_is_object(value))
        print_object(value, digits, indent, text);
    else
        print_array(value, digits, indent, text);
    free(line);
}

void mote_json_print(const json_t *value, int digits, mote_text *text)
{
    print_value(value, digits, 0, WIDTH, text);
    mote_text_add(text, "\n");
}
