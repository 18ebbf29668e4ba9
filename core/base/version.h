/* Which version of libmote a program runs with. */
#ifndef MOTE_CORE_VERSION_H
#define MOTE_CORE_VERSION_H

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

/* "MAJOR.MINOR.PATCH". Never NULL. A program that finds the library by itself, as the module
   for Python does, refuses another major version than its own. */
const char *mote_version(void);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
