#include "harness/run/bodies_engine.h"
#include "harness/base/options.h"

#include <stdio.h>
#include <string.h>

#define TEXT_SIZE sizeof((mote_bodies_choice *)0)->text

/* Takes "key=value" (length characters) if it is ours: 1; 0: it is not; -1: a bad value. */
static int take_key(mote_bodies_choice *c, const char *text, size_t length)
{
    char word[TEXT_SIZE];
    uint64_t number = 0;
    (void)snprintf(word, sizeof word, "%.*s", (int)length, text);
    if (strcmp(word, "refit=near") == 0 || strcmp(word, "refit=every") == 0) {
        c->refit = strcmp(word, "refit=every") == 0 ? MOTE_REFIT_EVERY : MOTE_REFIT_NEAR;
        return 1;
    }
    if (strncmp(word, "refit=", 6) == 0) {
        (void)mote_fail(MOTE_EINVAL, "%s: refit is near or every", c->text);
        return -1;
    }
    const bool threads = strncmp(word, "threads=", 8) == 0;
    if (!threads && strncmp(word, "ahead=", 6) != 0)
        return 0;
    if (!mote_read_unsigned(strchr(word, '=') + 1, threads ? 1 : 0, threads ? 256 : 64,
                            &number)) {
        (void)mote_fail(MOTE_EINVAL, "%s: %s is a whole number from %s", c->text,
                        threads ? "threads" : "ahead", threads ? "1 to 256" : "0 to 64");
        return -1;
    }
    *(threads ? &c->threads : &c->ahead) = (uint32_t)number;
    return 1;
}

/* Takes our keys; rest: the method's name and its own keys. */
static mote_status split(mote_bodies_choice *c, bool *has_refit, char *rest)
{
    const char *colon = strchr(c->text, ':');
    const size_t name = colon ? (size_t)(colon - c->text) : strlen(c->text);
    size_t used = name;
    memcpy(rest, c->text, name);
    for (const char *key = colon ? colon + 1 : ""; *key != '\0';) {
        const size_t length = strcspn(key, ",");
        const int taken = take_key(c, key, length);
        if (taken < 0)
            return MOTE_EINVAL;
        *has_refit = *has_refit || (taken && strncmp(key, "refit=", 6) == 0);
        if (!taken) {
            rest[used] = used == name ? ':' : ',';
            memcpy(rest + used + 1, key, length);
            used += length + 1;
        }
        key += length;
        key += *key == ',';
    }
    rest[used] = '\0';
    return MOTE_OK;
}

static bool is_one_of(const char *name, const char *const *names, size_t count)
{
    for (size_t i = 0; i < count; ++i) {
        if (strcmp(name, names[i]) == 0)
            return true;
    }
    return false;
}

static mote_status check(const mote_bodies_choice *c, bool has_refit, bool own_keys)
{
    static const char *const forms[] = {"certified", "fcl-aabb", "aabb-tree", "particle",
                                        "particle-paper"};
    const char *name = c->method.method->name;
    const bool trees = is_one_of(name, forms + 1, 2);
    const bool particles = is_one_of(name, forms + 3, 2);
    if (!is_one_of(name, forms, 5))
        return mote_fail(MOTE_EUNSUPPORTED,
                         "%s has no form for several bodies; certified, fcl-aabb, aabb-tree, "
                         "particle and particle-paper have",
                         name);
    if (has_refit && !trees)
        return mote_fail(MOTE_EUNSUPPORTED,
                         "%s: only fcl-aabb and aabb-tree have refit=", c->text);
    if (trees && c->threads > 1)
        return mote_fail(MOTE_EUNSUPPORTED,
                         "%s: threads= is for certified, particle and particle-paper", c->text);
    if (own_keys && !particles)
        return mote_fail(MOTE_EUNSUPPORTED, "%s: of several bodies %s takes only %s", c->text,
                         name, trees ? "refit= and ahead=" : "threads= and ahead=");
    return MOTE_OK;
}

mote_status mote_bodies_choice_read(const char *text, mote_bodies_choice *choice)
{
    mote_bodies_choice read = {.threads = 1};
    char rest[TEXT_SIZE + 1];
    bool has_refit = false;
    if (strlen(text) >= sizeof read.text)
        return mote_fail(MOTE_EINVAL, "%.40s...: longer than %zu characters; shorten it", text,
                         sizeof read.text - 1);
    memcpy(read.text, text, strlen(text) + 1);
    mote_status status = split(&read, &has_refit, rest);
    if (status == MOTE_OK)
        status = mote_method_choice_read(rest, &read.method);
    if (status == MOTE_OK)
        status = check(&read, has_refit, strchr(rest, ':') != NULL);
    if (status == MOTE_OK)
        *choice = read;
    return status;
}
