/* Makes the n-th start of a thread fail (--wrap, as in failing.h). */
#ifndef MOTE_TESTS_FAILING_THREADS_H
#define MOTE_TESTS_FAILING_THREADS_H

#include "tests/faults/failing.h"

#include <errno.h>
#include <pthread.h>

/* Threads that are started before one fails; negative: none fails. */
static long threads_left = -1;

int __real_pthread_create(pthread_t *thread, const pthread_attr_t *attributes,
                          void *(*run)(void *), void *argument);
int __wrap_pthread_create(pthread_t *thread, const pthread_attr_t *attributes,
                          void *(*run)(void *), void *argument);

int __wrap_pthread_create(pthread_t *thread, const pthread_attr_t *attributes,
                          void *(*run)(void *), void *argument)
{
    return is_due(&threads_left) ? EAGAIN
                                 : __real_pthread_create(thread, attributes, run, argument);
}

#endif
