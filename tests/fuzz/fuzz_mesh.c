/* Any text as an OBJ file, up to the rings and measures of its mesh; also as an OFF or PLY file
   and as the text of an STL file. A split soup makes a mesh unless it has no extent. */
#include "core/body/mesh.h"
#include "harness/mesh/mesh_soup.h"
#include "harness/mesh/mesh_split.h"
#include "tests/fuzz/fuzz.h"

#include <stdlib.h>
#include <string.h>

/* Makes a mesh of a soup: as it was read, then split so that no edge has more than two
   faces. */
static void make_mesh(mote_soup *soup)
{
    mote_split split;
    mote_mesh *mesh = NULL;
    mote_soup_compact(soup);
    mote_soup_split(soup, &split);
    if (mote_mesh_create(soup->xyz, soup->vertex_count, soup->indices, soup->triangle_count,
                         &mesh) == MOTE_OK) {
        (void)mote_mesh_euler(mesh);
        (void)mote_mesh_smallest_angle(mesh);
    } else if (strstr(mote_error_text(), "non-manifold")) {
        abort();
    }
    mote_mesh_destroy(mesh);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char *text = malloc(size + 1);
    if (!text)
        return 0;
    memcpy(text, data, size);
    text[size] = '\0';
    mote_soup obj = {0}, off = {0}, ply = {0};
    mote_frame_file file = {0};
    (void)mote_soup_check_text("any.stl", text, size);
    if (mote_soup_read_off("any.off", text, size, &off) == MOTE_OK)
        make_mesh(&off);
    if (mote_frame_file_read_ply("any.ply", text, size, &file, &ply) == MOTE_OK) {
        make_mesh(&ply);
        mote_soup_weld(&ply);
        make_mesh(&ply);
    }
    if (mote_soup_read_obj("any.obj", text, &obj) == MOTE_OK) {
        make_mesh(&obj);
        mote_soup_weld(&obj);
        make_mesh(&obj);
    }
    mote_soup_free(&obj);
    mote_soup_free(&off);
    mote_soup_free(&ply);
    free(text);
    return 0;
}
