/* Methods by name, as tests ask them. */
#ifndef MOTE_TESTS_METHODS_H
#define MOTE_TESTS_METHODS_H

#include "core/method/method.h"
#include "tests/support/test.h"

/* The method of that name, and in values its parameters: "n=5,seed=1"; "" for the defaults. */
static inline const mote_method *method_with(const char *name, const char *keys,
                                             double values[MOTE_PARAMETERS_MAX])
{
    const mote_method *m = mote_method_find(name);
    if (!m)
        fail_msg("no method %s", name);
    mote_parameters_default(m->parameters, m->parameter_count, values);
    if (mote_parameters_parse(m->parameters, m->parameter_count, keys, values) != MOTE_OK)
        fail_msg("%s:%s: %s", name, keys, mote_error_text());
    return m;
}

#endif
