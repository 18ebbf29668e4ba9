/* stretch: the body is stretched and sheared as a whole. Basis function j is coordinate j (x,
   y, z) relative to the middle of the box at rest, in units of L, so that the three weights are
   the columns of a matrix, times L. */
#include "core/body/field_kinds.h"
#include "core/body/field_maker.h"

#include <stdlib.h>
#include <string.h>

static void stretch_basis(const mote_field *field, const mote_mesh *mesh, uint32_t vertex,
                          double *phi)
{
    const mote_vec3 middle = mote_scale(mote_add(mesh->low, mesh->high), 0.5);
    const mote_vec3 x = mote_sub(mesh->positions[vertex], middle);
    memset(phi, 0, field->padded * sizeof *phi);
    phi[0] = x.x / mesh->diagonal;
    phi[1] = x.y / mesh->diagonal;
    phi[2] = x.z / mesh->diagonal;
}

static void stretch_gradient(const mote_field *field, const mote_mesh *mesh, uint32_t vertex,
                             mote_vec3 *gradient)
{
    const double slope = 1 / mesh->diagonal;
    (void)vertex;
    memset(gradient, 0, field->padded * sizeof *gradient);
    gradient[0].x = gradient[1].y = gradient[2].z = slope;
}

static void stretch_destroy(mote_field *field)
{
    free(field);
}

static const mote_field_kind stretch_kind = {.name = "stretch",
                                             .basis = stretch_basis,
                                             .gradient = stretch_gradient,
                                             .destroy = stretch_destroy};

static mote_status stretch_create(const mote_mesh *mesh, const double *values,
                                  mote_field **field)
{
    (void)mesh, (void)values;
    return mote_field_allocate(&stretch_kind, 3, field);
}

MOTE_FIELD(stretch) = {.name = "stretch",
                       .summary = "stretch and shear of the whole body: a weight for x, y, z",
                       .create = stretch_create};
