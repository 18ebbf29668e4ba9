#include "core/body/field_maker.h"

#include <string.h>

#define ADDED_MAX 64

static const mote_field_maker *added[ADDED_MAX];
static size_t added_count;

const mote_field_maker *mote_field_maker_at(size_t index)
{
    size_t built_in = 0;
    while (mote_field_makers[built_in])
        ++built_in;
    if (index < built_in)
        return mote_field_makers[index];
    return index - built_in < added_count ? added[index - built_in] : NULL;
}

const mote_field_maker *mote_field_maker_find(const char *name)
{
    const mote_field_maker *maker;
    for (size_t i = 0; (maker = mote_field_maker_at(i)) && strcmp(maker->name, name) != 0;)
        ++i;
    return maker;
}

mote_status mote_field_maker_add(const mote_field_maker *maker)
{
    if (mote_field_maker_find(maker->name))
        return mote_fail(MOTE_EINVAL, "%s: there is a kind of field of that name", maker->name);
    if (added_count == ADDED_MAX)
        return mote_fail(MOTE_EINVAL, "%s: more than %d kinds of fields added", maker->name,
                         ADDED_MAX);
    added[added_count++] = maker;
    return MOTE_OK;
}
