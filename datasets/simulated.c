#include "datasets/simulated.h"

#include <string.h>

const mote_simulated_body *const mote_simulated_list[] = {
    &mote_simulated_cloth, &mote_simulated_banner, &mote_simulated_jelly, NULL};

const mote_simulated_body *mote_simulated_find(const char *name)
{
    for (size_t i = 0; mote_simulated_list[i]; ++i) {
        if (strcmp(mote_simulated_list[i]->name, name) == 0)
            return mote_simulated_list[i];
    }
    return NULL;
}

mote_status mote_simulated_check(const mote_simulated_body *kind, size_t triangle_count)
{
    if (triangle_count >= MOTE_SIMULATED_MIN_TRIANGLES &&
        triangle_count <= MOTE_SIMULATED_MAX_TRIANGLES)
        return MOTE_OK;
    return mote_fail(MOTE_EINVAL, "%s: %zu triangles is out of range; give %d to %d",
                     kind->name, triangle_count, MOTE_SIMULATED_MIN_TRIANGLES,
                     MOTE_SIMULATED_MAX_TRIANGLES);
}
