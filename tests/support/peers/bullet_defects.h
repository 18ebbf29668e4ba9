/* Known defects of Bullet 3.24 (datasets/defects.md). Used by tests only. */
#ifndef MOTE_TESTS_BULLET_DEFECTS_H
#define MOTE_TESTS_BULLET_DEFECTS_H

#ifdef __cplusplus
extern "C" {
#endif

/* The number of contacts of two crossing triangles of side `size`, as GImpact meshes built
   around the origin, moved by x along every axis and refitted. */
int mote_bullet_contacts_after_a_move(float size, float x);

#ifdef __cplusplus
}
#endif
#endif
