/* Included before every C file by `make lint`: the analyzer looks at one file at a time, and
   has to be told that mote_fail returns the status that it is given. */
#ifndef __cplusplus
#include "core/base/status.h"
#define mote_fail(status, ...) ((void)mote_fail((status), __VA_ARGS__), (status))
#endif
