/* Whether two triangles touch, in exact integer arithmetic (GMP): the judge of the oracle. */
#ifndef MOTE_TESTS_ORACLE_EXACT_H
#define MOTE_TESTS_ORACLE_EXACT_H

#include "core/base/vec3.h"

#include <stdbool.h>

/* Numbers that are reused from pair to pair; one for each thread. */
typedef struct exact exact;

/* NULL when memory ran out. */
exact *exact_create(void);
void exact_destroy(exact *e); /* NULL is allowed */

typedef struct exact_verdict {
    bool touch; /* the closed triangles have a point in common */
    bool solid; /* their edges span space: only then can one be inside the other's surface */
} exact_verdict;

/* By the separating axis theorem for the difference of two convex polytopes of any dimension.
   No rounding anywhere. Coordinates are finite. About 10 us. */
exact_verdict exact_triangles(exact *e, const mote_vec3 s[3], const mote_vec3 t[3]);

#endif
