/* Displacements by a kind's own functions or, where it has none, by the sum over its basis. */
#include "core/body/field_kinds.h"

mote_vec3 mote_field_displacement(const mote_field *field, const mote_mesh *mesh,
                                  uint32_t vertex, const mote_weights *weights)
{
    if (field->kind->displacement)
        return field->kind->displacement(field, mesh, vertex, weights);
    return mote_field_sum(field, mesh, vertex, weights);
}

void mote_field_displacement_single(const mote_field *field, const mote_mesh *mesh,
                                    uint32_t vertex, const mote_weights_single *weights,
                                    float displacement[3])
{
    if (field->kind->displacement_single)
        field->kind->displacement_single(field, mesh, vertex, weights, displacement);
    else
        mote_field_sum_single(field, mesh, vertex, weights, displacement);
}
