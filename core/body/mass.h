/* Mass, centre of mass and inertia of the solid that a closed mesh bounds at rest, with uniform
   density: exact integrals over tetrahedra that share one corner. */
#ifndef MOTE_CORE_MASS_H
#define MOTE_CORE_MASS_H

#include "core/body/mesh.h"

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

/* Units follow from the mesh's length and the density. */
typedef struct mote_mass {
    double volume;
    double mass;       /* > 0 */
    mote_vec3 centre;  /* of mass, rest coordinates */
    mote_vec3 inertia; /* principal moments about the centre, ascending, each > 0 */
    mote_mat3 axes; /* columns: the principal axes in rest coordinates, a rotation; not unique
                       where moments are equal */
} mote_mass;

/* density: mass per volume, > 0 and finite. Faces must be wound consistently on each
   component. A mesh whose faces all point inwards is accepted as if they pointed outwards; a
   component inside another one and wound the other way is a cavity. MOTE_EINVAL with the
   reason: an open mesh, inconsistent winding at an edge, no volume (flat, or components that
   cancel), a bad density, a mesh so large or small that a result is not a positive normal
   number; MOTE_ENUMERIC, where the principal axes of such a mesh cannot be found; MOTE_ENOMEM.
   Not by two threads at a time, since GSL's error handler is off meanwhile. Rounding errors:
   about 1e-15 of the moments of the tetrahedra about the middle of the mesh's box. Cost O(t log
   t). */
mote_status mote_mass_of_mesh(const mote_mesh *mesh, double density, mote_mass *mass);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
