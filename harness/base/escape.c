#include "harness/base/escape.h"

#include <stdbool.h>
#include <string.h>

static bool is_control(char c)
{
    return (unsigned char)c < 0x20 || c == 0x7f;
}

/* The entity for a character, or NULL. */
static const char *entity(char c)
{
    switch (c) {
    case '&':
        return "&amp;";
    case '<':
        return "&lt;";
    case '>':
        return "&gt;";
    case '"':
        return "&quot;";
    case '\'':
        return "&#39;";
    default:
        return NULL;
    }
}

/* The length of the part that needs no escape: up to the next of `special` or control
   character. */
static size_t plain_length(const char *value, const char *special)
{
    size_t length = 0;
    while (value[length] && !is_control(value[length]) && !strchr(special, value[length]))
        ++length;
    return length;
}

void mote_escape_html(mote_text *text, const char *value)
{
    while (value && *value) {
        size_t length = plain_length(value, "&<>\"'");
        mote_text_add(text, "%.*s", (int)length, value);
        value += length;
        if (*value == '\0')
            break;
        const char *name = entity(*value);
        bool kept = *value == '\n' || *value == '\t';
        mote_text_add(text, "%s", name ? name : kept ? (*value == '\n' ? "\n" : "\t") : " ");
        ++value;
    }
}

void mote_escape_markdown(mote_text *text, const char *value)
{
    while (value && *value) {
        size_t length = plain_length(value, "&<>\\`*_[]|~#!");
        mote_text_add(text, "%.*s", (int)length, value);
        value += length;
        if (*value == '\0')
            break;
        if (is_control(*value))
            mote_text_add(text, " ");
        else if (strchr("&<>", *value))
            mote_text_add(text, "%s", entity(*value));
        else
            mote_text_add(text, "\\%c", *value);
        ++value;
    }
}

void mote_escape_path(mote_text *text, const char *path)
{
    static const char plain[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz"
                                "0123456789-_./";
    while (*path) {
        size_t length = strspn(path, plain);
        mote_text_add(text, "%.*s", (int)length, path);
        path += length;
        if (*path)
            mote_text_add(text, "%%%02X", (unsigned)(unsigned char)*path++);
    }
}

void mote_escape_script(mote_text *text, const char *json)
{
    while (*json) {
        size_t length = strcspn(json, "<");
        mote_text_add(text, "%.*s", (int)length, json);
        json += length;
        if (*json) {
            mote_text_add(text, "\\u003c");
            ++json;
        }
    }
}

void mote_escape_csv(mote_text *text, const char *value, bool quoted)
{
    if (!value)
        return;
    if (!quoted && value[strcspn(value, ",\"\n\r")] == '\0') {
        mote_text_add(text, "%s", value);
        return;
    }
    mote_text_add(text, "\"");
    for (; *value; ++value)
        mote_text_add(text, "%s%c", *value == '"' ? "\"" : "", *value);
    mote_text_add(text, "\"");
}

void mote_csv_number(mote_text *text, double value)
{
    if (value == value)
        mote_text_add(text, "%.17g", value);
}

void mote_base64(mote_text *text, const void *data, size_t size)
{
    static const char digits[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const unsigned char *bytes = data;
    char line[4 * 256 + 1];
    size_t used = 0;
    for (size_t i = 0; i < size; i += 3) {
        unsigned long group = (unsigned long)bytes[i] << 16;
        group |= i + 1 < size ? (unsigned long)bytes[i + 1] << 8 : 0;
        group |= i + 2 < size ? (unsigned long)bytes[i + 2] : 0;
        line[used++] = digits[group >> 18];
        line[used++] = digits[group >> 12 & 63];
        line[used++] = i + 1 < size ? digits[group >> 6 & 63] : '=';
        line[used++] = i + 2 < size ? digits[group & 63] : '=';
        if (used == sizeof line - 1 || i + 3 >= size) {
            line[used] = '\0';
            mote_text_add(text, "%s", line);
            used = 0;
        }
    }
}
