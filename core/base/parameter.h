/* The parameters of a method: a table of keys with types, ranges and defaults, and its parser.
 */
#ifndef MOTE_CORE_PARAMETER_H
#define MOTE_CORE_PARAMETER_H

#include "core/base/status.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

typedef enum mote_parameter_kind {
    MOTE_PARAMETER_INTEGER, /* up to 2^53 */
    MOTE_PARAMETER_REAL,    /* the text "inf" is accepted where the maximum is infinite */
    MOTE_PARAMETER_CHOICE   /* one of choices; its value is the index */
} mote_parameter_kind;

/* The value of a number given as "auto", where allowed. */
#define MOTE_AUTO (-1.0)

typedef struct mote_parameter {
    const char *key;
    mote_parameter_kind kind;
    double minimum, maximum; /* numbers: inclusive range; minimum >= 0 */
    const char
        *choices; /* "log|inverse|inverse-square"; for numbers "auto" if allowed, or NULL */
    const char *fallback; /* default, as text; an empty default is never used */
    const char *help;     /* one line: meaning, unit, source */
} mote_parameter;

/* At most this many parameters a method. */
#define MOTE_PARAMETERS_MAX 32

/* Fills values[count] with the defaults. */
void mote_parameters_default(const mote_parameter *table, size_t count, double *values);

/* Reads "key=value,key=value" into values, which are already filled. "" is allowed. MOTE_EINVAL
   with a text that names the key or value and lists what would be right: unknown key, a key
   twice, not a number, out of range, not a choice. values are unchanged on failure. Numbers are
   read by strtod, so call it in the C locale. */
mote_status mote_parameters_parse(const mote_parameter *table, size_t count, const char *text,
                                  double *values);

/* Writes one value as text that is parsed back to the same value: a whole number below 1e15 in
   full, any other number with as few digits as possible. buffer holds size bytes. Returns
   buffer. */
const char *mote_parameter_text(const mote_parameter *parameter, double value, char *buffer,
                                size_t size);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
