/* Any text as an OBJ file, up to the rings and measures of its mesh; and as an OFF
   file, and as the text of a PLY or STL file. */
#include "core/body/mesh.h"
#include "harness/mesh/mesh_soup.h"
#include "tests/fuzz/fuzz.h"

#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char *text = malloc(size + 1);
    if (!text)
        return 0;
    memcpy(text, data, size);
    text[size] = '\0';
    mote_soup soup = {0};
    mote_mesh *mesh = NULL;
    (void)mote_soup_check_text("any.ply", text, size);
    (void)mote_soup_check_text("any.stl", text, size);
    mote_soup off = {0};
    (void)mote_soup_read_off("any.off", text, size, &off);
    mote_soup_free(&off);
    if (mote_soup_read_obj("any.obj", text, &soup) == MOTE_OK &&
        mote_soup_weld(&soup) == MOTE_OK && mote_soup_compact(&soup) == MOTE_OK &&
        mote_mesh_create(soup.xyz, soup.vertex_count, soup.indices, soup.triangle_count,
                         &mesh) == MOTE_OK) {
        (void)mote_mesh_euler(mesh);
        (void)mote_mesh_smallest_angle(mesh);
    }
    mote_mesh_destroy(mesh);
    mote_soup_free(&soup);
    free(text);
    return 0;
}
