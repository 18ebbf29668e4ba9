/* What a pair of bodies keeps from one certified query to the next. */
#ifndef MOTE_CORE_CERTIFICATE_MEMORY_H
#define MOTE_CORE_CERTIFICATE_MEMORY_H

#include <stdbool.h>
#include <stdint.h>

/* Zeroed before a pair's first query. */
typedef struct mote_cert_memory {
    uint32_t last[2][3]; /* faces of the last query's witnesses */
    double leap;         /* if these faces are now farther apart, the bodies have leapt */
    bool has_last;
    bool steady; /* the last query ended at the faces that it began with; the next one is likely
                    to do so too and does not refine them first */
    bool saddle; /* steady, and the plane is crossed next to the faces, but descending from them
                    comes no nearer */
    bool has_direction;
    float direction[3];  /* the last that separated two leaves */
    bool parted;         /* the last query, a contact question, showed the bodies to be apart */
    bool parted_at_rest; /* the boxes around both bodies at rest showed it, or may */
    uint8_t rest_pause;  /* so many queries do not ask these boxes */
    float parting[3];    /* along this direction, from body 0 to body 1, or one near it */
} mote_cert_memory;

#endif
