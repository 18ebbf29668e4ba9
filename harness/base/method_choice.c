#include "harness/base/method_choice.h"

#include <stdio.h>
#include <string.h>

const mote_parameter mote_scene_parameters[MOTE_SCENE_KEYS] = {
    {"refit", MOTE_PARAMETER_CHOICE, 0, 0, "near|every", "near",
     "bodies whose hierarchies are refitted: those of near pairs, or every one"},
    {"threads", MOTE_PARAMETER_INTEGER, 1, 256, NULL, "1", "that near pairs are shared out to"},
    {"ahead", MOTE_PARAMETER_INTEGER, 0, 64, NULL, "0",
     "frames that a thread of its own moves and deforms ahead"},
};

static mote_status unknown_method(const char *name)
{
    char known[512];
    size_t used = 0;
    known[0] = '\0';
    const mote_method *method;
    for (size_t i = 0; (method = mote_method_at(i)) && used < sizeof known; ++i) {
        int put =
            snprintf(known + used, sizeof known - used, "%s%s", i ? ", " : "", method->name);
        used += put > 0 ? (size_t)put : 0;
    }
    return mote_fail(MOTE_EINVAL, "unknown method %s; known are: %s", name, known);
}

/* Copies the text and splits it: name becomes the method's name; *keys becomes the text after
   the colon, or NULL. */
static mote_status begin(const char *text, mote_method_choice *choice,
                         char name[sizeof choice->text], char **keys)
{
    if (strlen(text) >= sizeof choice->text)
        return mote_fail(MOTE_EINVAL, "%.40s...: longer than %zu characters; shorten it", text,
                         sizeof choice->text - 1);
    memcpy(choice->text, text, strlen(text) + 1);
    memcpy(name, text, strlen(text) + 1);
    *keys = strchr(name, ':');
    if (*keys)
        *(*keys)++ = '\0';
    choice->method = mote_method_find(name);
    if (!choice->method)
        return unknown_method(name);
    mote_parameters_default(choice->method->parameters, choice->method->parameter_count,
                            choice->values);
    mote_parameters_default(mote_scene_parameters, MOTE_SCENE_KEYS, choice->scene);
    return MOTE_OK;
}

static mote_status parse(const mote_parameter *table, size_t count, const char *keys,
                         const char *text, double *values)
{
    const mote_status status = mote_parameters_parse(table, count, keys, values);
    return status == MOTE_OK ? status : mote_fail(status, "%s: %s", text, mote_error_text());
}

/* Which of mote_scene_parameters the text "key=value,..." begins with; MOTE_SCENE_KEYS:
   none. */
static int scene_key(const char *text)
{
    int k = 0;
    for (; k < MOTE_SCENE_KEYS; ++k) {
        const size_t length = strlen(mote_scene_parameters[k].key);
        if (strncmp(text, mote_scene_parameters[k].key, length) == 0 && text[length] == '=')
            break;
    }
    return k;
}

/* Moves the scene keys from keys to scene; both are "key=value,..." texts afterwards. */
static void split_keys(char *keys, char *scene, mote_method_choice *choice)
{
    char *own = keys, *other = scene;
    for (const char *key = keys; *key;) {
        const size_t length = strcspn(key, ",");
        const size_t step = length + (key[length] == ',');
        const int k = scene_key(key);
        char **to = k < MOTE_SCENE_KEYS ? &other : &own;
        const char *start = k < MOTE_SCENE_KEYS ? scene : keys;
        if (k < MOTE_SCENE_KEYS)
            choice->gives[k] = true;
        if (*to > start)
            *(*to)++ = ',';
        memmove(*to, key, length);
        *to += length;
        key += step;
    }
    *own = *other = '\0';
}

mote_status mote_method_choice_read(const char *text, mote_method_choice *choice)
{
    mote_method_choice read = {0};
    char name[sizeof read.text], *keys;
    mote_status status = begin(text, &read, name, &keys);
    if (status == MOTE_OK && keys)
        status = parse(read.method->parameters, read.method->parameter_count, keys, text,
                       read.values);
    if (status == MOTE_OK)
        *choice = read;
    return status;
}

mote_status mote_scene_choice_read(const char *text, mote_method_choice *choice)
{
    mote_method_choice read = {0};
    char name[sizeof read.text], scene[sizeof read.text] = "", *keys;
    mote_status status = begin(text, &read, name, &keys);
    if (status == MOTE_OK && keys)
        split_keys(keys, scene, &read);
    if (status == MOTE_OK && keys && (keys[0] || !scene[0]))
        status = parse(read.method->parameters, read.method->parameter_count, keys, text,
                       read.values);
    if (status == MOTE_OK)
        status = parse(mote_scene_parameters, MOTE_SCENE_KEYS, scene, text, read.scene);
    if (status == MOTE_OK)
        *choice = read;
    return status;
}

bool mote_method_choice_is_of_scenes(const mote_method_choice *choice)
{
    for (int k = 0; k < MOTE_SCENE_KEYS; ++k) {
        if (choice->gives[k])
            return true;
    }
    return false;
}
