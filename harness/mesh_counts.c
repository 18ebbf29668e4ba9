/* Before assimp sees a file: whether the counts that it declares can be in it. assimp believes
   them, and loops or allocates for minutes. */
#include "harness/mesh_soup.h"

#include <stdlib.h>
#include <string.h>

/* "element NAME COUNT" lines up to a line end_header, without which assimp reads for ever; an
   element takes a byte at least. */
static mote_status check_ply(const char *path, const char *text, size_t size)
{
    const char *end = strstr(text, "\nend_header");
    if (!end || !strchr("\r\n", end[strlen("\nend_header")]))
        return mote_fail(MOTE_EINVAL, "%s: a header without a line end_header; add it", path);
    for (const char *at = strstr(text, "element "); at && at < end;
         at = strstr(at + 1, "element ")) {
        const char *name = at + strlen("element ");
        name += strspn(name, " \t");
        const char *number = name + strcspn(name, " \t\r\n");
        const unsigned long long count = strtoull(number, NULL, 10);
        if (count > size)
            return mote_fail(MOTE_EINVAL,
                             "%s: declares %llu elements, which %zu bytes cannot hold; give "
                             "the number that follows",
                             path, count, size);
    }
    return MOTE_OK;
}

mote_status mote_soup_check_counts(const char *path, const char *text, size_t size)
{
    const char *ending = strrchr(path, '.');
    if (!ending)
        return MOTE_OK;
    if (strcmp(ending, ".ply") == 0 || strcmp(ending, ".PLY") == 0)
        return check_ply(path, text, size);
    return MOTE_OK;
}
