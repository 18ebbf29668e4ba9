#include "tests/support/peers/ccd_triangle.h"

#include <ccd/ccd.h>

/* The corner that is farthest along a direction. */
static void support(const void *object, const ccd_vec3_t *direction, ccd_vec3_t *farthest)
{
    const mote_vec3 *t = object;
    mote_vec3 d = mote_vec3_make(direction->v[0], direction->v[1], direction->v[2]),
              best = t[0];
    for (int k = 1; k < 3; k++)
        best = mote_dot(d, t[k]) > mote_dot(d, best) ? t[k] : best;
    farthest->v[0] = best.x;
    farthest->v[1] = best.y;
    farthest->v[2] = best.z;
}

bool mote_ccd_triangles_touch(const mote_vec3 s[3], const mote_vec3 t[3])
{
    ccd_t ccd;
    CCD_INIT(&ccd);
    ccd.support1 = support;
    ccd.support2 = support;
    ccd.max_iterations = 1000;
    return ccdGJKIntersect(s, t, &ccd) != 0;
}
