/* What C++ code throws, for functions in C that the linker puts in the place of others. */
#ifndef MOTE_TESTS_THROWN_H
#define MOTE_TESTS_THROWN_H

#include <stddef.h>

/* The C++ ABI names of std::bad_alloc, std::length_error and the type info of int, on systems
   whose size_t is an unsigned long. */
extern const char _ZTIi[];
_Noreturn void _ZSt17__throw_bad_allocv(void);
_Noreturn void _ZSt20__throw_length_errorPKc(const char *what);
void *__cxa_allocate_exception(size_t size);
_Noreturn void __cxa_throw(void *thrown, const void *type, void (*destroy)(void *));

#endif
