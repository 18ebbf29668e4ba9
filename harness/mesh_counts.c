/* Before assimp sees a file: whether the counts that it declares can be in it. assimp believes
   them, and loops or allocates for minutes. */
#include "harness/mesh_soup.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

static mote_status too_many(const char *path, const char *what, unsigned long long count,
                            size_t size)
{
    return mote_fail(MOTE_EINVAL,
                     "%s: declares %llu %s, which %zu bytes cannot hold; give the "
                     "number that follows",
                     path, count, what, size);
}

/* The next word that is no comment, or "" at the end. */
static const char *next_word(const char *at)
{
    for (;;) {
        at += strspn(at, " \t\r\n");
        if (*at != '#')
            return at;
        at += strcspn(at, "\n");
    }
}

/* "OFF", vertices, faces, edges: each vertex and face takes two bytes a number at least. */
static mote_status check_off(const char *path, const char *text, size_t size)
{
    const char *at = next_word(text);
    while (isalpha((unsigned char)*at))
        ++at;
    unsigned long long count[2] = {0, 0};
    for (int i = 0; i < 2; ++i) {
        char *end;
        at = next_word(at);
        count[i] = strtoull(at, &end, 10);
        if (end == at)
            return MOTE_OK; /* assimp says what is wrong */
        at = end;
    }
    if (count[0] > size / 6)
        return too_many(path, "vertices", count[0], size);
    return count[1] > size / 6 ? too_many(path, "faces", count[1], size) : MOTE_OK;
}

/* "element NAME COUNT" lines up to a line end_header, without which assimp reads for ever; an
   element takes a byte at least. */
static mote_status check_ply(const char *path, const char *text, size_t size)
{
    const char *end = strstr(text, "\nend_header");
    if (!end || !strchr("\r\n", end[strlen("\nend_header")]))
        return mote_fail(MOTE_EINVAL, "%s: a header without a line end_header; add it", path);
    for (const char *at = strstr(text, "element "); at && at < end;
         at = strstr(at + 1, "element ")) {
        const char *name = next_word(at + strlen("element "));
        const char *number = name + strcspn(name, " \t\r\n");
        const unsigned long long count = strtoull(number, NULL, 10);
        if (count > size)
            return too_many(path, "elements", count, size);
    }
    return MOTE_OK;
}

mote_status mote_soup_check_counts(const char *path, const char *text, size_t size)
{
    const char *ending = strrchr(path, '.');
    if (!ending)
        return MOTE_OK;
    if (strcmp(ending, ".off") == 0 || strcmp(ending, ".OFF") == 0)
        return check_off(path, text, size);
    if (strcmp(ending, ".ply") == 0 || strcmp(ending, ".PLY") == 0)
        return check_ply(path, text, size);
    return MOTE_OK;
}
