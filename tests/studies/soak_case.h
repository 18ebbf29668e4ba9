/* Random scenarios for the soak test: letters, combs, scanned and broken meshes, slivers,
   parallel faces; any field or none; from a smooth path to a leap at every frame. */
#ifndef MOTE_TESTS_SOAK_CASE_H
#define MOTE_TESTS_SOAK_CASE_H

#include "core/base/status.h"

#include <jansson.h>
#include <stdint.h>

/* The scenario of a seed, as its file's JSON; the same on every machine. Mesh paths are
   relative to the folder meshes. The caller drops it; NULL when memory ran out. */
json_t *soak_case_make(uint64_t seed, const char *meshes);

/* Writes it as a scenario file. */
mote_status soak_case_write(const json_t *scenario, const char *path);

#endif
