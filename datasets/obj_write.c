#include "datasets/obj_write.h"

#include <errno.h>
#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static mote_status check_positions(const mote_vec3 *positions, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        if (!isfinite(positions[i].x) || !isfinite(positions[i].y) || !isfinite(positions[i].z))
            return mote_fail(
                MOTE_EINVAL,
                "obj: vertex %u is not finite; an OBJ file can hold finite numbers only", i);
    return MOTE_OK;
}

static bool write_body(FILE *file, const mote_vec3 *positions, const mote_mesh *mesh)
{
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        if (fprintf(file, "v %.17g %.17g %.17g\n", positions[i].x, positions[i].y,
                    positions[i].z) < 0)
            return false;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        const uint32_t *v = mesh->triangles[t];
        if (fprintf(file, "f %u %u %u\n", v[0] + 1, v[1] + 1, v[2] + 1) < 0)
            return false;
    }
    return fflush(file) == 0;
}

/* Writes a decimal point, whatever the locale of the calling program. */
static bool write_in_c_locale(FILE *file, const mote_vec3 *positions, const mote_mesh *mesh)
{
    const locale_t plain = newlocale(LC_NUMERIC_MASK, "C", (locale_t)0);
    if (plain == (locale_t)0)
        return false;
    const locale_t before = uselocale(plain);
    const bool written = write_body(file, positions, mesh);
    const int error = errno;
    uselocale(before);
    freelocale(plain);
    errno = error;
    return written;
}

static mote_status write_partial(const char *path, const char *partial,
                                 const mote_vec3 *positions, const mote_mesh *mesh)
{
    FILE *file = fopen(partial, "w");
    if (!file)
        return mote_fail(MOTE_EIO,
                         "%s: cannot be created: %s; name a file in a folder that exists "
                         "and can be written",
                         path, strerror(errno));
    bool written = write_in_c_locale(file, positions, mesh) && fsync(fileno(file)) == 0;
    int error = errno;
    if (fclose(file) != 0 && written) {
        written = false;
        error = errno;
    }
    if (written && rename(partial, path) != 0) {
        written = false;
        error = errno;
    }
    if (written)
        return MOTE_OK;
    (void)remove(partial);
    return mote_fail(MOTE_EIO, "%s: cannot be written: %s", path, strerror(error));
}

mote_status mote_obj_print(FILE *file, const mote_vec3 *positions, const mote_mesh *mesh)
{
    const mote_vec3 *points = positions ? positions : mesh->positions;
    const mote_status status = check_positions(points, mesh->vertex_count);
    if (status != MOTE_OK || write_in_c_locale(file, points, mesh))
        return status;
    return mote_fail(MOTE_EIO, "cannot be written: %s", strerror(errno));
}

mote_status mote_obj_write(const char *path, const mote_vec3 *positions, const mote_mesh *mesh)
{
    const mote_vec3 *points = positions ? positions : mesh->positions;
    const mote_status status = check_positions(points, mesh->vertex_count);
    if (status != MOTE_OK)
        return status;
    const size_t size = strlen(path) + sizeof "..partial" + 3 * sizeof(long);
    char *partial = malloc(size);
    if (!partial)
        return mote_fail(MOTE_ENOMEM, "obj: no memory for a file name of %zu bytes", size);
    (void)snprintf(partial, size, "%s.%ld.partial", path, (long)getpid());
    const mote_status written = write_partial(path, partial, points, mesh);
    free(partial);
    return written;
}
