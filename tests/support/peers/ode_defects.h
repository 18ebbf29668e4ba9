/* Known defects of ODE 0.16.2 (datasets/defects.md). Used by tests only. */
#ifndef MOTE_TESTS_ODE_DEFECTS_H
#define MOTE_TESTS_ODE_DEFECTS_H

/* The contacts that ODE finds between two meshes of up to two triangles that cross: body b
   has the first triangles[b] of its two. With one triangle each it crashes. */
int mote_ode_contacts(const int triangles[2]);

#endif
