#include "core/base/status.h"

#include <stdarg.h>
#include <stdio.h>

static _Thread_local char error_text[1024];
static _Thread_local mote_status error_status;

const char *mote_status_text(mote_status status)
{
    switch (status) {
    case MOTE_OK:
        return "done";
    case MOTE_EINVAL:
        return "invalid input";
    case MOTE_ENOMEM:
        return "out of memory";
    case MOTE_EIO:
        return "input or output failed";
    case MOTE_EUNSUPPORTED:
        return "not supported";
    case MOTE_ENUMERIC:
        return "numerical failure";
    }
    return "unknown status";
}

#undef mote_fail
mote_status mote_fail(mote_status status, const char *format, ...)
{
    /* Formatted into a buffer first, since the old text may be an argument of the new one. */
    char text[sizeof error_text];
    va_list arguments;
    va_start(arguments, format);
    (void)vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    (void)snprintf(error_text, sizeof error_text, "%s", text);
    error_status = status;
    return status;
}

mote_status mote_error_status(void)
{
    return error_status;
}

const char *mote_error_text(void)
{
    return error_text;
}
