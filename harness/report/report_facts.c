#include "harness/report/report_facts.h"

#include "harness/scene/catalog.h"
#include "harness/base/record.h"
#include "harness/report/report_rows.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void add_pair(json_t *list, const char *key, const char *value)
{
    if (value && value[0])
        (void)json_array_append_new(list, json_pack("[s,s]", key, value));
}

static void add_sources(const mote_report *report, json_t *list)
{
    const char *commit = mote_text_at(report->manifest, "commit");
    const json_t *dirty = json_object_get(report->manifest, "dirty");
    if (!commit[0])
        return;
    char *text = mote_format("%s%s", commit,
                             json_is_true(dirty) ? ", and changes that are in no commit" : "");
    add_pair(list, "commit", text);
    free(text);
}

static void add_number(const mote_report *report, const char *key, json_t *list)
{
    const json_t *value = json_object_get(report->manifest, key);
    char text[32];
    if (!json_is_integer(value))
        return;
    (void)snprintf(text, sizeof text, "%lld", (long long)json_integer_value(value));
    add_pair(list, key, text);
}

json_t *mote_report_machine(const mote_report *report)
{
    static const char *const before[] = {"processor", "memory", "kernel"};
    static const char *const after[] = {"compiler",  "build_type", "flags",
                                        "libraries", "version",    "program"};
    json_t *list = json_array();
    for (size_t i = 0; i < sizeof before / sizeof before[0]; ++i)
        add_pair(list, before[i], mote_text_at(report->manifest, before[i]));
    add_number(report, "cores", list);
    add_sources(report, list);
    add_number(report, "seed", list);
    for (size_t i = 0; i < sizeof after / sizeof after[0]; ++i)
        add_pair(list, after[i], mote_text_at(report->manifest, after[i]));
    return list;
}

/* Adds a word, quoted for a shell. */
static void add_word(mote_text *text, const char *word)
{
    static const char plain[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz"
                                "0123456789-_./,:=+@%";
    mote_text_add(text, " ");
    if (word[0] && word[strspn(word, plain)] == '\0') {
        mote_text_add(text, "%s", word);
        return;
    }
    mote_text_add(text, "'");
    for (; *word; ++word) {
        if (*word == '\'')
            mote_text_add(text, "'\\''");
        else
            mote_text_add(text, "%c", *word);
    }
    mote_text_add(text, "'");
}

static json_t *command(const json_t *session)
{
    size_t i;
    const json_t *word;
    mote_text text = {0};
    mote_text_add(&text, "mote");
    MOTE_EACH(i, word, json_object_get(session, "command"))
    {
        add_word(&text, json_is_string(word) ? json_string_value(word) : "");
    }
    json_t *pair = json_pack("[s,s]", mote_text_at(session, "started"), text.data);
    free(text.data);
    return pair;
}

json_t *mote_report_commands(const mote_report *report)
{
    size_t i;
    const json_t *session;
    json_t *list = json_array();
    MOTE_EACH(i, session, json_object_get(report->manifest, "sessions"))
    {
        (void)json_array_append_new(list, command(session));
    }
    return list;
}

static const char *purpose_of(const mote_catalog *catalog, const char *name)
{
    for (size_t i = 0; i < catalog->count; ++i) {
        if (strcmp(catalog->entries[i].name, name) == 0)
            return catalog->entries[i].purpose;
    }
    return "";
}

json_t *mote_report_scenarios(const mote_report *report)
{
    mote_catalog catalog = {0};
    /* If the built-in scenarios cannot be listed there are no purposes; the names are in the
       rows. */
    if (mote_catalog_read(&catalog) != MOTE_OK)
        catalog.count = 0;
    json_t *list = json_array();
    const char *last = NULL;
    for (size_t i = 0; i < report->summary.count; ++i) {
        const char *name = mote_report_row(report, i)->scenario;
        if (last && strcmp(last, name) == 0)
            continue;
        last = name;
        (void)json_array_append_new(list, json_pack("[s,s]", name, purpose_of(&catalog, name)));
    }
    mote_catalog_free(&catalog);
    return list;
}

char *mote_report_subtitle(const mote_report *report)
{
    mote_text text = {0};
    json_t *scenarios = mote_report_scenarios(report);
    const size_t count = json_array_size(scenarios);
    json_decref(scenarios);
    if (report->has_cells)
        mote_text_add(&text, "%zu cells of ", report->summary.stored.count);
    mote_text_add(&text, "%zu scenario%s", count, count == 1 ? "" : "s");
    const char *commit = mote_text_at(report->manifest, "commit");
    if (commit[0])
        mote_text_add(&text, ", commit %.8s", commit);
    const json_t *sessions = json_object_get(report->manifest, "sessions");
    const json_t *session = json_array_get(sessions, json_array_size(sessions) - 1);
    const char *started = mote_text_at(session, "started");
    if (started[0])
        mote_text_add(&text, ", %.10s", started);
    return text.data;
}
