/* Reads back a page's data: its JSON elements and what is packed in them. */
#ifndef MOTE_TESTS_PAGE_DATA_H
#define MOTE_TESTS_PAGE_DATA_H

#include <jansson.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

#include "tests/support/test.h"

/* The JSON element of this id, or NULL; the caller decrefs it. */
static inline json_t *page_data(const char *page, const char *id)
{
    char start[96];
    (void)snprintf(start, sizeof start, "<script type=\"application/json\" id=\"%s\">", id);
    const char *from = strstr(page, start);
    if (!from)
        return NULL;
    from += strlen(start);
    const char *end = strstr(from, "</script>");
    assert_non_null(end);
    return json_loadb(from, (size_t)(end - from), 0, NULL);
}

/* The bytes of a text in base 64; the caller frees them. */
static inline unsigned char *page_bytes(const char *text, size_t *size)
{
    static const char digits[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    unsigned char *bytes = malloc(strlen(text) + 1);
    assert_non_null(bytes);
    unsigned long bits = 0;
    size_t count = 0, used = 0;
    for (; *text && *text != '='; ++text) {
        const char *digit = strchr(digits, *text);
        assert_non_null(digit);
        bits = bits << 6 | (unsigned long)(digit - digits);
        if (++count % 4 != 1)
            bytes[used++] = (unsigned char)(bits >> (6 - 2 * ((count - 1) % 4)));
    }
    *size = used;
    return bytes;
}

/* The unpacked content of an object's member; the caller frees it. */
static inline char *page_unpack(const json_t *object, const char *key)
{
    const char *text = json_string_value(json_object_get(object, key));
    assert_non_null(text);
    size_t size;
    unsigned char *bytes = page_bytes(text, &size);
    const size_t most = (size_t)64 << 20;
    char *plain = malloc(most);
    assert_non_null(plain);
    z_stream stream = {0};
    stream.next_in = bytes;
    stream.avail_in = (uInt)size;
    stream.next_out = (unsigned char *)plain;
    stream.avail_out = (uInt)most - 1;
    assert_int_equal(inflateInit2(&stream, -15), Z_OK);
    assert_int_equal(inflate(&stream, Z_FINISH), Z_STREAM_END);
    plain[stream.total_out] = '\0';
    (void)inflateEnd(&stream);
    free(bytes);
    return plain;
}

/* The same for packed JSON; the caller decrefs it. */
static inline json_t *page_unpack_json(const json_t *object, const char *key)
{
    char *plain = page_unpack(object, key);
    json_error_t error;
    json_t *root = json_loads(plain, 0, &error);
    if (!root)
        fail_msg("%s: %d: %s", key, error.line, error.text);
    free(plain);
    return root;
}

#endif
