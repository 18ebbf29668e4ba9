/* A known defect of HACD in Bullet 3.24 (datasets/defects.md). Used by tests only. */
#ifndef MOTE_TESTS_HACD_DEFECTS_H
#define MOTE_TESTS_HACD_DEFECTS_H

#ifdef __cplusplus
extern "C" {
#endif

/* Makes the convex hull of five points, three of which lie on a line but for rounding, `times`
   times. A vertex is freed twice in each: call it in a process of its own. */
void mote_hacd_hulls(int times);

#ifdef __cplusplus
}
#endif
#endif
