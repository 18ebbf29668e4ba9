/* Libraries that mote refuses: compiled once for each WRONG; for test_plugin. */
#include <mote/method.h>

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#ifndef WRONG
#error "compile with -DWRONG=..."
#endif

/* What is wrong, by number: see test_plugin. */
enum {
    VERSION = 1,
    NAME,
    TAKEN,
    SUMMARY,
    NO_QUERY,
    FALLBACK,
    RANGE,
    ABORTS,
    HANGS,
    LONE_CREATE,
    SIZES
};

static const mote_parameter parameters[] = {{"n", MOTE_PARAMETER_INTEGER,
                                             WRONG == RANGE ? 9 : 1, 8, NULL,
                                             WRONG == FALLBACK ? "9" : "8", "a number"}};

static mote_status query(void *state, const mote_frame *frame, mote_answer *answer)
{
    (void)state;
    (void)frame;
    answer->has_distance = true;
    return MOTE_OK;
}

static mote_status create(const mote_setup *setup, void **state)
{
    (void)setup;
    *state = NULL;
    return MOTE_OK;
}

__attribute__((constructor)) static void begin(void)
{
    if (WRONG == ABORTS)
        abort();
    while (WRONG == HANGS)
        (void)pause();
}

#if WRONG == 1
#undef MOTE_CONTRACT
#define MOTE_CONTRACT 7
#endif
#if WRONG == 11
#undef MOTE_METHOD_SIZES
#define MOTE_METHOD_SIZES 8
#endif
MOTE_METHOD(wrong) = {
    .name = WRONG == NAME    ? "Not a name"
            : WRONG == TAKEN ? "certified"
                             : "plugin-wrong",
    .summary = WRONG == SUMMARY ? "two\nlines" : "one line",
    .parameters = parameters,
    .parameter_count = 1,
    .create = WRONG == LONE_CREATE ? create : NULL,
    .query = WRONG == NO_QUERY ? NULL : query,
};
