/* Where the weights of a field that are not displacements stand. */
#ifndef MOTE_CORE_FIELD_AXES_H
#define MOTE_CORE_FIELD_AXES_H

#include "core/body/field.h"

/* How many weights are vectors, which turn with the body; numbers, which come after them, do
   not. */
static inline uint32_t mote_field_vectors(const mote_field *field)
{
    return field->count - field->numbers;
}

/* Of a field with numbers: the first of the three weights before them, which are the columns of
   the pose's rotation, and so the axes themselves to one who turns with the body. */
static inline uint32_t mote_field_first_axis(const mote_field *field)
{
    return mote_field_vectors(field) - 3;
}

#endif
