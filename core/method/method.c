#include "core/method/method.h"

#include <stdlib.h>

mote_traits mote_method_traits(const mote_method *method, const double *values)
{
    const mote_traits none = {0};
    return method->traits ? method->traits(values) : none;
}

mote_status mote_method_create(const mote_method *method, const mote_setup *setup, void **state)
{
    const mote_traits traits = mote_method_traits(method, setup->values);
    for (int b = 0; b < 2 && traits.needs_field; ++b) {
        if (mote_body_is_given(setup->body[b]))
            return mote_fail(MOTE_EUNSUPPORTED,
                             "%s needs a field, and of body %d only positions are known; use a "
                             "method that works on positions, such as stream or aabb-tree",
                             method->name, b);
    }
    if (method->create)
        return method->create(setup, state);
    mote_setup *kept = malloc(sizeof *kept);
    if (!kept)
        return mote_fail(MOTE_ENOMEM, "no memory for the setup of %s", method->name);
    *kept = *setup;
    *state = kept;
    return MOTE_OK;
}

void mote_method_destroy(const mote_method *method, void *state)
{
    if (method->create)
        method->destroy(state);
    else
        free(state);
}
