/* Making and freeing a field, and the simplest kind: the one that never deforms. */
#include "core/body/field_kinds.h"

#include <stdlib.h>

static mote_status check_count(const mote_field_kind *kind, uint32_t count)
{
    const bool sums = kind->sparse || (kind->displacement && kind->displacement_single);
    const uint32_t most = !sums          ? MOTE_FIELD_SUMMED
                          : kind->bounds ? MOTE_FIELD_MAX_BOUNDED
                                         : MOTE_FIELD_MAX;
    if (count <= most)
        return MOTE_OK;
    return mote_fail(MOTE_EINVAL, "a field of kind %s has at most %u basis functions, not %u",
                     kind->name, most, count);
}

mote_status mote_field_allocate(const mote_field_kind *kind, uint32_t count, mote_field **field)
{
    mote_status status = check_count(kind, count);
    if (status != MOTE_OK)
        return status;
    mote_field *made = calloc(1, sizeof *made);
    if (!made)
        return mote_fail(MOTE_ENOMEM, "no memory for a field");
    made->kind = kind;
    made->count = count;
    made->padded = (count + MOTE_LANES - 1) / MOTE_LANES * MOTE_LANES;
    made->most = count;
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

static const mote_field_kind given_kind = {.name = "given",
                                           .basis = no_basis,
                                           .gradient = no_gradient,
                                           .given = true,
                                           .destroy = free_plain};

mote_status mote_field_create_given(mote_field **field)
{
    return mote_field_allocate(&given_kind, 0, field);
}

void mote_field_destroy(mote_field *field)
{
    if (field)
        field->kind->destroy(field);
}
