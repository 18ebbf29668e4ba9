#include "harness/sequence/numbered_mesh.h"

#include "harness/base/file.h"
#include "harness/base/memory.h"
#include "harness/mesh/import_child.h"
#include "harness/sequence/frame_file.h"

#include <stdlib.h>
#include <string.h>

#define FILE_LIMIT ((size_t)4 << 30)

typedef struct header {
    uint64_t file_vertices, vertex_count, triangle_count, topology;
    mote_import import;
} header;

/* Reads the triangles, and the hash of the faces they came from. */
static mote_status read_file(const char *path, mote_soup *soup, mote_frame_file *file)
{
    char *data;
    size_t size;
    mote_status status = mote_file_read(path, FILE_LIMIT, &data, &size);
    if (status != MOTE_OK)
        return status;
    if (mote_name_ends(path, ".ply")) {
        status = mote_frame_file_read_ply(path, data, size, file, soup);
    } else {
        status = mote_soup_check_encoding(path, data, size);
        if (status == MOTE_OK)
            status = mote_soup_read_obj(path, data, soup);
        if (status == MOTE_OK)
            status = mote_frame_file_read_obj(path, data, file);
    }
    free(data);
    if (status != MOTE_OK)
        return status;
    mote_soup_drop_collapsed(soup);
    return mote_soup_refuse_collapsed(path, soup);
}

static mote_status put(int output, const header *head, const mote_soup *soup,
                       const uint32_t *file_vertex)
{
    mote_status status = mote_child_put(output, head, sizeof *head);
    if (status == MOTE_OK)
        status = mote_child_put(output, soup->xyz, 3 * soup->vertex_count * sizeof *soup->xyz);
    if (status == MOTE_OK)
        status = mote_child_put(output, soup->indices,
                                3 * soup->triangle_count * sizeof *soup->indices);
    if (status == MOTE_OK)
        status = mote_child_put(output, file_vertex, soup->vertex_count * sizeof *file_vertex);
    return status;
}

static mote_status read_in_child(void *context, int output)
{
    const char *path = context;
    mote_import_begin_child();
    mote_soup soup = {0};
    mote_frame_file file = {0};
    header head;
    memset(&head, 0, sizeof head);
    mote_status status = read_file(path, &soup, &file);
    if (status != MOTE_OK)
        return status;
    const size_t corners = 3 * soup.triangle_count;
    uint32_t *before = mote_copy(soup.indices, corners * sizeof *before);
    mote_soup_compact(&soup);
    mote_soup_split(&soup, &head.import.split);
    /* Both keep the order of the triangles, so each corner shows which vertex it had in the
       file. */
    uint32_t *file_vertex = mote_allocate(soup.vertex_count, sizeof *file_vertex);
    for (size_t c = 0; c < corners; ++c)
        file_vertex[soup.indices[c]] = before[c];
    head.file_vertices = file.count;
    head.topology = file.topology;
    head.vertex_count = soup.vertex_count;
    head.triangle_count = soup.triangle_count;
    head.import.collapsed = soup.collapsed;
    head.import.unused = soup.unused;
    status = put(output, &head, &soup, file_vertex);
    mote_soup_free(&soup);
    free(before);
    free(file_vertex);
    return status;
}

/* Whether the sizes match what the child announced. */
static bool is_whole(const header *head, const uint32_t *file_vertex, size_t size)
{
    const uint64_t vertex_bytes = 3 * sizeof(double) + sizeof(uint32_t);
    const uint64_t triangle_bytes = 3 * sizeof(uint32_t);
    if (head->vertex_count > size / vertex_bytes ||
        head->triangle_count > size / triangle_bytes || head->file_vertices > UINT32_MAX ||
        size != head->vertex_count * vertex_bytes + head->triangle_count * triangle_bytes)
        return false;
    for (uint64_t v = 0; file_vertex && v < head->vertex_count; ++v) {
        if (file_vertex[v] >= head->file_vertices)
            return false;
    }
    return true;
}

static mote_status make(const char *path, const char *data, size_t size,
                        mote_numbered_mesh *made)
{
    header head;
    if (size < sizeof head)
        return mote_fail(MOTE_EIO, "%s: reading it gave no result", path);
    memcpy(&head, data, sizeof head);
    data += sizeof head;
    size -= sizeof head;
    if (!is_whole(&head, NULL, size))
        return mote_fail(MOTE_EIO, "%s: reading it ended early", path);
    head.import.split.where[MOTE_SPLIT_TEXT - 1] = '\0';
    if (mote_import_is_strict() && mote_import_refuse_split(path, &head.import) != MOTE_OK)
        return MOTE_EINVAL;
    double *xyz = mote_copy(data, 3 * head.vertex_count * sizeof *xyz);
    data += 3 * head.vertex_count * sizeof *xyz;
    uint32_t *indices = mote_copy(data, 3 * head.triangle_count * sizeof *indices);
    data += 3 * head.triangle_count * sizeof *indices;
    uint32_t *file_vertex = mote_copy(data, head.vertex_count * sizeof *file_vertex);
    mote_mesh *mesh = NULL;
    mote_status status =
        is_whole(&head, file_vertex, size)
            ? mote_mesh_create(xyz, head.vertex_count, indices, head.triangle_count, &mesh)
            : mote_fail(MOTE_EIO, "vertices that the file does not have");
    free(xyz);
    free(indices);
    if (status != MOTE_OK) {
        free(file_vertex);
        return mote_fail(status, "%s: %s", path, mote_error_text());
    }
    *made = (mote_numbered_mesh){.mesh = mesh,
                                 .file_vertex = file_vertex,
                                 .file_vertices = (uint32_t)head.file_vertices,
                                 .topology = head.topology,
                                 .import = head.import};
    return MOTE_OK;
}

mote_status mote_numbered_mesh_read(const char *path, mote_numbered_mesh *made)
{
    if (!mote_name_ends(path, ".ply") && !mote_name_ends(path, ".obj"))
        return mote_fail(MOTE_EINVAL,
                         "%s: neither OBJ nor PLY; give a mesh with positions frame by "
                         "frame in one of these",
                         path);
    char *output = NULL;
    size_t size = 0;
    mote_status status = mote_import_run_child(path, read_in_child, &output, &size);
    if (status == MOTE_OK)
        status = make(path, output, size, made);
    free(output);
    return status;
}

void mote_numbered_mesh_free(mote_numbered_mesh *made)
{
    mote_mesh_destroy(made->mesh);
    free(made->file_vertex);
    *made = (mote_numbered_mesh){0};
}
