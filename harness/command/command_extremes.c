/* mote extremes [--out DIR] [--quick] [--method NAME] [--family NAME]: methods on tiny, huge or
   degenerate numbers. */
#include "harness/command/command.h"
#include "core/method/method.h"
#include "harness/base/file.h"
#include "harness/process/manifest.h"
#include "harness/study/extreme.h"
#include "harness/study/study_extremes.h"

#include <stdio.h>
#include <string.h>

enum { OPTION_OUT, OPTION_QUICK, OPTION_METHOD, OPTION_FAMILY };

const mote_option mote_options_extremes[] = {
    {"out", "DIR", "where the results go (default: results/extremes)"},
    {"quick", NULL, "a smaller study (default: the whole one)"},
    {"method", "NAME",
     "try this method only; its name without parameters (default: every method)"},
    {"family", "NAME",
     "try this kind of extreme only, such as \"touch\" (default: every kind)"},
    {NULL, NULL, NULL}};

typedef struct request {
    const char *directory;
    mote_extremes_wish wish;
} request;

/* MOTE_EXIT_DONE, or an exit status after a line on stderr. */
static int read_arguments(int argc, char **argv, request *q)
{
    mote_option_reader reader = mote_option_begin(mote_options_extremes, argc, argv);
    const char *value;
    for (int option; (option = mote_option_next_named(&reader, &value)) != MOTE_OPTION_END;) {
        if (option == MOTE_OPTION_ERROR)
            return MOTE_EXIT_USAGE;
        if (option == OPTION_OUT)
            q->directory = value;
        else if (option == OPTION_METHOD)
            q->wish.method = value;
        else if (option == OPTION_FAMILY)
            q->wish.family = value;
        else
            q->wish.quick = true;
    }
    return MOTE_EXIT_DONE;
}

static mote_status check_names(const mote_extremes_wish *wish)
{
    if (wish->method && !mote_method_find(wish->method))
        return mote_fail(MOTE_EINVAL, "unknown method %s; `mote list methods` names them",
                         wish->method);
    char known[512] = "";
    for (size_t i = 0, used = 0; wish->family && i < mote_extreme_family_count; ++i) {
        const char *name = mote_extreme_families[i].name;
        if (strcmp(name, wish->family) == 0)
            return MOTE_OK;
        if (used < sizeof known)
            used += (size_t)snprintf(known + used, sizeof known - used, "%s%s", i ? ", " : "",
                                     name);
    }
    return wish->family
               ? mote_fail(MOTE_EINVAL, "unknown family %s; known are: %s", wish->family, known)
               : MOTE_OK;
}

static mote_status study(const request *q, int argc, char **argv, bool *met)
{
    uint64_t program = 0;
    mote_status status = check_names(&q->wish);
    if (status == MOTE_OK)
        status = mote_directory_make(q->directory);
    if (status == MOTE_OK)
        status = mote_program_hash(&program);
    if (status == MOTE_OK)
        status = mote_manifest_write(q->directory, program, 0, argc, argv);
    return status == MOTE_OK ? mote_study_extremes(q->directory, &q->wish, met) : status;
}

int mote_command_extremes(int argc, char **argv)
{
    request q = {.directory = "results/extremes"};
    const int understood = read_arguments(argc, argv, &q);
    if (understood != MOTE_EXIT_DONE)
        return understood;
    bool met = false;
    if (study(&q, argc, argv, &met) != MOTE_OK)
        return mote_command_fail();
    return mote_command_finish(met ? MOTE_EXIT_DONE : MOTE_EXIT_CHECK_FAILED);
}
