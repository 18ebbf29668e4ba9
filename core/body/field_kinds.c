/* Making and freeing a field, and the simplest kind: the one that never deforms. */
#include "core/body/field_kinds.h"

#include <stdlib.h>

mote_status mote_field_allocate(const mote_field_kind *kind, uint32_t count, mote_field **field)
{
    mote_field *made = calloc(1, sizeof *made);
    if (!made)
        return mote_fail(MOTE_ENOMEM, "no memory for a field");
    made->kind = kind;
    made->count = count;
    made->padded = (count + MOTE_LANES - 1) / MOTE_LANES * MOTE_LANES;
    made->bytes = sizeof *made;
    *field = made;
    return MOTE_OK;
}

static void no_basis(const mote_field *field, const mote_mesh *mesh, uint32_t vertex,
                     double *phi)
{
    (void)field, (void)mesh, (void)vertex, (void)phi;
}

static void no_gradient(const mote_field *field, const mote_mesh *mesh, uint32_t vertex,
                        mote_vec3 *gradient)
{
    (void)field, (void)mesh, (void)vertex, (void)gradient;
}

static void free_plain(mote_field *field)
{
    free(field);
}

static const mote_field_kind static_kind = {
    .name = "static", .basis = no_basis, .gradient = no_gradient, .destroy = free_plain};

mote_status mote_field_create_static(mote_field **field)
{
    return mote_field_allocate(&static_kind, 0, field);
}

void mote_field_destroy(mote_field *field)
{
    if (field)
        field->kind->destroy(field);
}
