/* Calls of C++ libraries by functions with C linkage, which no exception may leave. */
#ifndef MOTE_BASELINES_GUARD_HPP
#define MOTE_BASELINES_GUARD_HPP

#include "core/base/status.h"

#include <exception>
#include <new>

/* Runs body, which returns a status, and turns what it throws into one: MOTE_ENOMEM for
   std::bad_alloc, MOTE_ENUMERIC for anything else. library: its name, for messages. */
template <class Body> mote_status mote_guard(const char *library, Body &&body) noexcept
{
    try {
        return body();
    } catch (const std::bad_alloc &) {
        return mote_fail(MOTE_ENOMEM, "%s ran out of memory", library);
    } catch (const std::exception &error) {
        return mote_fail(MOTE_ENUMERIC, "%s: %s", library, error.what());
    } catch (...) {
        return mote_fail(MOTE_ENUMERIC, "%s threw an unknown exception", library);
    }
}

#endif
