#include "harness/gltf/gltf_uri.h"

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

/* A percent sign without two hexadecimal digits stays. */
static char *decode(const char *uri)
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

mote_status mote_gltf_path(const char *file, const char *uri, char **path)
{
    char *decoded = decode(uri);
    char *written = mote_path_beside(file, uri);
    const bool is_there = mote_path_goes_down(uri) && access(written, F_OK) == 0;
    mote_status status = MOTE_OK;
    if (is_there || mote_path_goes_down(decoded))
        *path = is_there ? mote_duplicate(written) : mote_path_beside(file, decoded);
    else
        status = mote_fail(MOTE_EINVAL,
                           "%s: names %.200s, which is not in its folder; put that file beside "
                           "it, or below",
                           file, decoded);
    free(written);
    free(decoded);
    return status;
}
