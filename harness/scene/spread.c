#include "harness/scene/spread.h"

#include "harness/base/memory.h"

#include <math.h>
#include <stdlib.h>

mote_vec3 mote_mesh_centre(const mote_mesh *mesh)
{
    return mote_scale(mote_add(mesh->low, mesh->high), 0.5);
}

mote_status mote_spread_apart(const mote_mesh *mesh, uint32_t most, double apart,
                              mote_vec3 *points, uint32_t *count)
{
    double *nearest = mote_allocate(mesh->vertex_count, sizeof *nearest);
    for (uint32_t i = 0; i < mesh->vertex_count; ++i)
        nearest[i] = HUGE_VAL;
    mote_vec3 last = mote_mesh_centre(mesh);
    uint32_t picked = 0;
    while (picked < most) {
        uint32_t farthest = 0;
        double largest = 0;
        for (uint32_t i = 0; i < mesh->vertex_count; ++i) {
            const double square = mote_distance_squared(mesh->positions[i], last);
            /* The middle of the box only ranks the first point; it is not itself a picked
               point. */
            const double rank = picked == 0 ? square : fmin(nearest[i], square);
            if (picked > 0)
                nearest[i] = rank;
            if (rank > largest) {
                largest = rank;
                farthest = i;
            }
        }
        if (largest == 0 || (picked > 0 && largest < apart * apart))
            break;
        points[picked++] = last = mesh->positions[farthest];
    }
    free(nearest);
    *count = picked;
    return picked > 0 ? MOTE_OK : mote_fail(MOTE_EINVAL, "the mesh is a single point");
}

mote_status mote_spread(const mote_mesh *mesh, uint32_t count, mote_vec3 *points)
{
    uint32_t picked = 0;
    mote_status status = mote_spread_apart(mesh, count, 0, points, &picked);
    if (status == MOTE_OK && picked < count)
        status = mote_fail(MOTE_EINVAL, "the mesh has only %u different positions, not %u",
                           picked, count);
    return status;
}
