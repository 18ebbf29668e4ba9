/* The order of vertices in which a pass reads memory from start to end. */
#include "core/stream/stream.h"

#include "core/stream/stream_tree.h"

#include <stdlib.h>

mote_status mote_stream_order(const mote_body *body, uint32_t *order)
{
    mote_stream_tree *tree = NULL;
    bool *taken = calloc(body->mesh->vertex_count, sizeof *taken);
    mote_status status = taken
                             ? mote_stream_tree_create(body, &tree)
                             : mote_fail(MOTE_ENOMEM, "no memory for the order of %u vertices",
                                         body->mesh->vertex_count);
    uint32_t next = 0;
    for (size_t i = 0; status == MOTE_OK && i < tree->leaf_start[tree->leaves]; ++i) {
        const uint32_t vertex = tree->leaf_vertices[i];
        if (!taken[vertex])
            order[next++] = vertex;
        taken[vertex] = true;
    }
    mote_stream_tree_destroy(tree);
    free(taken);
    return status;
}
