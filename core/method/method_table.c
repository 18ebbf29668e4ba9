#include "core/method/impact_method.h"

#include <string.h>

#define ADDED_MAX 64

static const mote_method *added[ADDED_MAX];
static size_t added_count;

const mote_method *mote_method_at(size_t index)
{
    size_t built_in = 0;
    while (mote_methods[built_in])
        ++built_in;
    if (index < built_in)
        return mote_methods[index];
    return index - built_in < added_count ? added[index - built_in] : NULL;
}

const mote_method *mote_method_find(const char *name)
{
    const mote_method *method;
    for (size_t i = 0; (method = mote_method_at(i)) && strcmp(method->name, name) != 0;)
        ++i;
    return method;
}

mote_status mote_method_add(const mote_method *method)
{
    if (mote_method_find(method->name))
        return mote_fail(MOTE_EINVAL, "%s: there is a method of that name", method->name);
    if (added_count == ADDED_MAX)
        return mote_fail(MOTE_EINVAL, "%s: more than %d methods added", method->name,
                         ADDED_MAX);
    added[added_count++] = method;
    return MOTE_OK;
}

const mote_impact_method *mote_impact_method_find(const char *name)
{
    for (size_t i = 0; mote_impact_methods[i]; ++i) {
        if (strcmp(mote_impact_methods[i]->method, name) == 0)
            return mote_impact_methods[i];
    }
    return NULL;
}
