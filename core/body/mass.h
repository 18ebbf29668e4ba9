/* Mass, centre and inertia of the solid that a closed mesh bounds, by exact integrals over its
   tetrahedra with one common corner, at rest and of even density. */
#ifndef MOTE_CORE_MASS_H
#define MOTE_CORE_MASS_H

#include "core/body/mesh.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Units follow from the mesh's length and the density. */
typedef struct mote_mass {
    double volume;
    double mass;       /* > 0 */
    mote_vec3 centre;  /* of mass, rest coordinates */
    mote_vec3 inertia; /* central main moments, rising, each > 0 */
    mote_mat3 axes;    /* columns: the main axes in rest coordinates, a rotation; where moments
                          are equal, any axes that fit */
} mote_mass;

/* density: mass a volume, > 0 and finite. Faces must be wound one way on each component; all
   inside out counts as all outside out, and a component inside another one that is wound the
   other way is a cavity. MOTE_EINVAL with the reason: an open mesh, faces of one edge wound
   differently, no volume (flat, or components that cancel), a bad density, a mesh so large or
   small that a figure is not a positive finite number. Errors: some 1e-15 of the moments of the
   tetrahedra about the middle of the mesh's box. Cost O(t log t). */
mote_status mote_mass_of_mesh(const mote_mesh *mesh, double density, mote_mass *mass);

#ifdef __cplusplus
}
#endif
#endif
