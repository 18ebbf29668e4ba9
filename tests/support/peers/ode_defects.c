#include "tests/support/peers/ode_defects.h"

#include <ode/ode.h>

/* Two squares, each of two triangles, of which the first ones cross as well. */
static const double corners[2][4][3] = {
    {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {4, 4, 0}},
    {{1, 1, -2}, {1, 1, 2}, {2, 1, 2}, {2, 1, -2}},
};
static const dTriIndex indices[2][6] = {{0, 1, 2, 1, 3, 2}, {0, 1, 2, 0, 2, 3}};

int mote_ode_contacts(const int triangles[2])
{
    (void)dInitODE2(0);
    (void)dAllocateODEDataForThread(dAllocateFlagCollisionData);
    dTriMeshDataID data[2];
    dGeomID mesh[2];
    for (int b = 0; b < 2; ++b) {
        data[b] = dGeomTriMeshDataCreate();
        dGeomTriMeshDataBuildDouble(data[b], corners[b], sizeof corners[b][0], 4, indices[b],
                                    3 * triangles[b], 3 * sizeof indices[b][0]);
        mesh[b] = dCreateTriMesh(NULL, data[b], NULL, NULL, NULL);
    }
    dContactGeom contacts[8];
    const int count = dCollide(mesh[0], mesh[1], 8, contacts, sizeof contacts[0]);
    for (int b = 0; b < 2; ++b) {
        dGeomDestroy(mesh[b]);
        dGeomTriMeshDataDestroy(data[b]);
    }
    dCloseODE();
    return count;
}
