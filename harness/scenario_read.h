/* The parts of a scenario file, one reader each; used by scenario_read.c only. */
#ifndef MOTE_HARNESS_SCENARIO_READ_H
#define MOTE_HARNESS_SCENARIO_READ_H

#include "harness/json_read.h"
#include "harness/motion.h"
#include "harness/scenario.h"

/* A scenario's frames at most. */
#define MOTE_FRAMES_MAX 1000000

/* Reads a body's mesh: {"letter", "triangles"}. */
mote_status mote_scenario_read_mesh(const mote_json *body, mote_mesh **mesh);

/* Reads "field" (absent: static) of a body whose mesh is known: the field, and the displacement
   of its control points into motion. On failure, what was made stays in *field and *motion for
   the caller to free. */
mote_status mote_scenario_read_field(const mote_json *body, const mote_mesh *mesh,
                                     mote_field **field, mote_body_motion *motion);

/* Reads "motion" (absent: at rest at the origin). length: L of the pair. */
mote_status mote_scenario_read_motion(const mote_json *body, const mote_mesh *mesh,
                                      double length, uint32_t frames, mote_body_motion *motion);

#endif
