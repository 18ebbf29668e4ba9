#include "harness/loop/reach.h"

#include "harness/base/memory.h"

#include <stdlib.h>

double *mote_reach_sizes(const mote_body *body)
{
    const mote_field *field = body->field;
    if (field->count > 0 && !field->kind->basis)
        return NULL;
    double *sizes = mote_allocate((size_t)field->count + 1, sizeof *sizes);
    double *phi = mote_allocate((size_t)field->padded + 1, sizeof *phi);
    for (uint32_t v = 0; v < body->mesh->vertex_count && field->count > 0; ++v) {
        field->kind->basis(field, body->mesh, v, phi);
        for (uint32_t j = 0; j < field->count; ++j)
            sizes[j] = fmax(sizes[j], fabs(phi[j]));
    }
    free(phi);
    return sizes;
}

mote_reach mote_reach_of(const mote_field *field, const double *sizes, const mote_vec3 *then,
                         const mote_vec3 *now)
{
    if (!sizes)
        return (mote_reach){HUGE_VAL, HUGE_VAL};
    mote_reach sum = {0, 0};
    for (uint32_t j = 0; j < field->count; ++j) {
        sum.shape += sizes[j] * mote_length(then[j]);
        sum.change += sizes[j] * mote_length(mote_sub(now[j], then[j]));
    }
    return sum;
}
