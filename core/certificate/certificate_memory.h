/* What a pair of bodies keeps from one certified query to the next. */
#ifndef MOTE_CORE_CERTIFICATE_MEMORY_H
#define MOTE_CORE_CERTIFICATE_MEMORY_H

#include <stdbool.h>
#include <stdint.h>

/* What a pair keeps between queries; zeroed for a pair that was not asked about yet. */
typedef struct mote_cert_memory {
    uint32_t last[2][3]; /* faces of the last query's witnesses */
    double leap;         /* a distance of them that tells of a leap */
    bool has_last;
    bool steady; /* the last query ended at the faces it began with: the next one is likely to,
                    too, so that it is not refined at first */
    bool saddle; /* ... and the plane is crossed next to them, but descending does not help */
    bool has_direction;
    float direction[3]; /* the latest that separated two leaves */
} mote_cert_memory;

#endif
