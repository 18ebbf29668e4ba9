#include "harness/engine/engine.h"

#include <string.h>

static bool is_one_of(const char *name, const char *const *names, size_t count)
{
    for (size_t i = 0; i < count; ++i) {
        if (strcmp(name, names[i]) == 0)
            return true;
    }
    return false;
}

/* Whether any of the method's own parameters except `allowed` differs from its default. */
static bool sets_own(const mote_method_choice *choice, const char *allowed)
{
    const mote_method *method = choice->method;
    double values[MOTE_PARAMETERS_MAX];
    mote_parameters_default(method->parameters, method->parameter_count, values);
    for (size_t i = 0; i < method->parameter_count; ++i) {
        if (strcmp(method->parameters[i].key, allowed) != 0 &&
            (choice->values[i] < values[i] || choice->values[i] > values[i]))
            return true;
    }
    return false;
}

mote_status mote_engine_check_choice(const mote_method_choice *choice)
{
    static const char *const forms[] = {"certified", "fcl-aabb",       "aabb-tree",
                                        "particle",  "particle-paper", "stream"};
    const char *name = choice->method->name;
    const bool trees = is_one_of(name, forms + 1, 2);
    const bool particles = is_one_of(name, forms + 3, 2);
    const bool streamed = strcmp(name, "stream") == 0;
    if (!is_one_of(name, forms, 6))
        return mote_fail(MOTE_EUNSUPPORTED,
                         "%s has no form for several bodies; certified, stream, fcl-aabb, "
                         "aabb-tree, particle and particle-paper have",
                         name);
    if (choice->gives[MOTE_SCENE_REFIT] && !trees)
        return mote_fail(MOTE_EUNSUPPORTED,
                         "%s: only fcl-aabb and aabb-tree have refit=", choice->text);
    if (trees && choice->scene[MOTE_SCENE_THREADS] > 1)
        return mote_fail(MOTE_EUNSUPPORTED,
                         "%s: threads= is for certified, stream, particle and particle-paper",
                         choice->text);
    if (!particles && sets_own(choice, streamed ? "positions" : ""))
        return mote_fail(MOTE_EUNSUPPORTED, "%s: with several bodies %s takes only %s",
                         choice->text, name,
                         trees      ? "refit= and ahead="
                         : streamed ? "positions=, threads= and ahead="
                                    : "threads= and ahead=");
    return MOTE_OK;
}
