#include "harness/mesh/uri.h"

#include "harness/base/file.h"
#include "harness/base/memory.h"

#include <ctype.h>
#include <stdlib.h>
#include <unistd.h>

/* The byte that %41 and the like at `at` stands for; 0 if none does. */
static char escaped(const char *at)
{
    if (at[0] != '%' || !isxdigit((unsigned char)at[1]) || !isxdigit((unsigned char)at[2]))
        return '\0';
    const char digits[] = {at[1], at[2], '\0'};
    return (char)strtoul(digits, NULL, 16);
}

char *mote_uri_decode(const char *uri)
{
    char *decoded = mote_duplicate(uri), *to = decoded;
    for (const char *at = uri; *at; ++at) {
        const char byte = escaped(at);
        *to++ = byte ? byte : *at;
        at += byte ? 2 : 0;
    }
    *to = '\0';
    return decoded;
}

char *mote_uri_path(const char *file, const char *uri)
{
    char *written = mote_path_beside(file, uri);
    if (access(written, F_OK) == 0)
        return written;
    free(written);
    char *decoded = mote_uri_decode(uri);
    char *path = mote_path_beside(file, decoded);
    free(decoded);
    return path;
}
