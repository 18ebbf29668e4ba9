/* Kinds of fields that a scenario can name ({"kind": "stretch", ...}), in addition to CSRBF.

   A kind is one constant descriptor in one file, defined as
       MOTE_FIELD(stretch) = {.name = "stretch", ...};
   at the start of a line; the build finds it by that line (cmake/MoteRegistry.cmake). */
#ifndef MOTE_CORE_FIELD_MAKER_H
#define MOTE_CORE_FIELD_MAKER_H

#include "core/body/field.h"
#include "core/base/parameter.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct mote_field_maker {
    const char *name;    /* as in a scenario */
    const char *summary; /* one line: what basis function j is, and the unit of its weight */
    const mote_parameter *parameters; /* further keys in a scenario, or NULL */
    size_t parameter_count;

    /* Makes the field of a mesh (borrowed for the call). values: one a parameter, in the
       table's order. In a scenario the displacement of control j, a length, is the weight of
       basis function j. The caller destroys *field. */
    mote_status (*create)(const mote_mesh *mesh, const double *values, mote_field **field);
} mote_field_maker;

#if defined(__cplusplus)
#define MOTE_FIELD(id)                                                                         \
    extern "C" const mote_field_maker mote_field_maker_##id;                                   \
    const mote_field_maker mote_field_maker_##id
#else
#define MOTE_FIELD(id)                                                                         \
    extern const mote_field_maker mote_field_maker_##id;                                       \
    const mote_field_maker mote_field_maker_##id
#endif

/* All of them, ended by NULL; written by the build. */
extern const mote_field_maker *const mote_field_makers[];

/* The one of that name, or NULL. */
const mote_field_maker *mote_field_maker_find(const char *name);

#ifdef __cplusplus
}
#endif
#endif
