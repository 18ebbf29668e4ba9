/* What is known of a field of linear modes beyond its functions. Private to the core. */
#ifndef MOTE_CORE_MODES_H
#define MOTE_CORE_MODES_H

#include "core/body/field.h"

/* The largest coordinate of each mode's displacements, by its absolute value, [count / 3]; NULL
   for a field of another kind. */
const double *mote_modes_largest(const mote_field *field);

#endif
