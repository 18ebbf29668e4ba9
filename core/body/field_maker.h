/* Kinds of fields that a scenario can name ({"kind": "stretch", ...}), in addition to CSRBF.

   A kind is one constant descriptor in one file, defined as
       MOTE_FIELD(stretch) = {.name = "stretch", ...};
   at the start of a line, and found as a method is (core/method/method.h). */
#ifndef MOTE_CORE_FIELD_MAKER_H
#define MOTE_CORE_FIELD_MAKER_H

#include "core/body/field.h"
#include "core/base/parameter.h"
#include "core/base/plugin.h"

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

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

/* The sizes of the structs that a field and its caller share, which plugin.h compares. */
#define MOTE_FIELD_SIZES                                                                       \
    (sizeof(mote_field_maker) + sizeof(mote_mesh) + sizeof(mote_field) +                       \
     sizeof(mote_field_kind))

#define MOTE_FIELD(id)                                                                         \
    MOTE_PLUGIN_DECLARE const mote_field_maker mote_field_maker_##id;                          \
    MOTE_PLUGIN_ITEM(MOTE_PLUGIN_FIELD, MOTE_FIELD_SIZES, mote_field_maker_##id)               \
    const mote_field_maker mote_field_maker_##id

/* The kinds that are built in, ended by NULL; written by the build. */
extern const mote_field_maker *const mote_field_makers[];

/* Makes one more kind known to the two functions below. It is borrowed until the program ends.
   To be called before another thread uses them. MOTE_EINVAL: its name is taken, or 64 have been
   added. */
mote_status mote_field_maker_add(const mote_field_maker *maker);

/* Kind number index: first those built in, then those added. NULL past the last. */
const mote_field_maker *mote_field_maker_at(size_t index);

/* The one of that name, or NULL. */
const mote_field_maker *mote_field_maker_find(const char *name);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
