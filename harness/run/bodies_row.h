/* The rows of a run of several bodies: what was measured, against whose contacts, as JSON and
   as a table. */
#ifndef MOTE_HARNESS_BODIES_ROW_H
#define MOTE_HARNESS_BODIES_ROW_H

#include "harness/run/bodies_measure.h"

#include <jansson.h>
#include <stdio.h>

typedef struct mote_bodies_row {
    char scenario[64];
    uint32_t bodies, shapes;
    size_t triangles; /* of all bodies together */
    double density;   /* near pairs a body that the scenario wishes for; 0: its box is given */
    char method[256];
    bool exact, ok;
    mote_cell_status status;
    char reason[400];
    uint32_t replicate, threads, ahead;
    size_t steps;
    double near_pairs;           /* a body and step */
    double near_total;           /* a step */
    double step_mean_ns;         /* of a step without motion, all but the first */
    double step_ns, step_p95_ns; /* median and 95th of a step without motion */
    double motion_ns, bounds_ns, deform_ns, update_ns, broad_ns, query_ns; /* medians */
    double wall_ns; /* a step, motion and records included */
    double build_ns;
    int64_t heap_live_bytes, heap_peak_bytes, rss_peak_bytes; /* -1: not counted */
    size_t contacts;
    char reference[256]; /* the method whose contacts count as true; empty: none */
    size_t common;       /* steps of both */
    size_t missed, false_contacts;
    double ratio; /* the reference's time over this one's on the steps of both; MOTE_NONE
                     without */
} mote_bodies_row;

/* Sums up a result. */
void mote_bodies_row_make(const mote_bodies *bodies, const mote_bodies_choice *choice,
                          uint32_t replicate, const mote_bodies_result *result,
                          mote_bodies_row *row);

/* Compares contacts with those of the reference on the steps that both made. */
void mote_bodies_row_compare(mote_bodies_row *row, const mote_bodies_result *result,
                             const mote_bodies_row *reference,
                             const mote_bodies_result *reference_result);

/* {"schema": 1, "rows": [...]}; NULL without memory. The caller decrefs. */
json_t *mote_bodies_rows_json(const mote_bodies_row *rows, size_t count);

void mote_bodies_rows_print(const mote_bodies_row *rows, size_t count, FILE *out);

#endif
