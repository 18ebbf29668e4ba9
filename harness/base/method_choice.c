#include "harness/base/method_choice.h"

#include <stdio.h>
#include <string.h>

static mote_status unknown_method(const char *name)
{
    char known[512];
    size_t used = 0;
    known[0] = '\0';
    for (size_t i = 0; mote_methods[i] && used < sizeof known; ++i) {
        int put = snprintf(known + used, sizeof known - used, "%s%s", i ? ", " : "",
                           mote_methods[i]->name);
        used += put > 0 ? (size_t)put : 0;
    }
    return mote_fail(MOTE_EINVAL, "unknown method %s; known are: %s", name, known);
}

mote_status mote_method_choice_read(const char *text, mote_method_choice *choice)
{
    mote_method_choice read = {0};
    if (strlen(text) >= sizeof read.text)
        return mote_fail(MOTE_EINVAL, "%.40s...: longer than %zu characters; shorten it", text,
                         sizeof read.text - 1);
    memcpy(read.text, text, strlen(text) + 1);
    char name[sizeof read.text];
    memcpy(name, text, strlen(text) + 1);
    char *colon = strchr(name, ':');
    if (colon)
        *colon = '\0';
    read.method = mote_method_find(name);
    if (!read.method)
        return unknown_method(name);
    const mote_method *method = read.method;
    mote_parameters_default(method->parameters, method->parameter_count, read.values);
    if (colon) {
        mote_status status = mote_parameters_parse(method->parameters, method->parameter_count,
                                                   colon + 1, read.values);
        if (status != MOTE_OK)
            return mote_fail(status, "%s: %s", text, mote_error_text());
    }
    *choice = read;
    return MOTE_OK;
}
