/* mote list methods|scenarios|fields [--json] */
#include "core/body/field_maker.h"
#include "core/method/impact_method.h"
#include "harness/scene/catalog.h"
#include "harness/command/command.h"
#include "harness/base/options.h"
#include "harness/base/record.h"

#include <jansson.h>
#include <stdio.h>
#include <string.h>

static int print_json(json_t *value)
{
    if (mote_json_put(value, JSON_INDENT(2), stdout) != MOTE_OK)
        return mote_command_fail();
    return mote_command_finish(MOTE_EXIT_DONE);
}

static json_t *parameters_json(const mote_parameter *table, size_t count)
{
    static const char *const kinds[] = {"integer", "real", "choice"};
    json_t *list = json_array();
    for (size_t i = 0; i < count; ++i) {
        const mote_parameter *parameter = &table[i];
        json_t *row = json_pack("{s:s, s:s, s:s, s:s}", "key", parameter->key, "kind",
                                kinds[parameter->kind], "default", parameter->fallback, "help",
                                parameter->help);
        if (parameter->choices)
            (void)json_object_set_new(row, "choices", json_string(parameter->choices));
        (void)json_array_append_new(list, row);
    }
    return list;
}

/* Adds a method or a field with its parameters to list, or prints it if list is NULL. */
static void show(json_t *list, const char *name, const char *summary,
                 const mote_parameter *table, size_t count)
{
    if (list) {
        (void)json_array_append_new(list, json_pack("{s:s, s:s, s:o}", "name", name, "summary",
                                                    summary, "parameters",
                                                    parameters_json(table, count)));
        return;
    }
    (void)printf("%s: %s\n", name, summary);
    for (size_t p = 0; p < count; ++p) {
        const mote_parameter *parameter = &table[p];
        (void)printf("    %s=%s  %s%s%s%s\n", parameter->key, parameter->fallback,
                     parameter->help, parameter->choices ? " (" : "",
                     parameter->choices ? parameter->choices : "",
                     parameter->choices ? ")" : "");
    }
}

/* Whether a method, with its defaults, rejects bodies of which only positions are given. */
static bool needs_field(const mote_method *method)
{
    double values[MOTE_PARAMETERS_MAX];
    mote_parameters_default(method->parameters, method->parameter_count, values);
    return mote_method_traits(method, values).needs_field;
}

static int list_methods(bool json)
{
    json_t *list = json ? json_array() : NULL;
    const mote_method *method;
    for (size_t i = 0; (method = mote_method_at(i)); ++i) {
        show(list, method->name, method->summary, method->parameters, method->parameter_count);
        const bool impacts = mote_impact_method_find(method->name) != NULL;
        if (json) {
            json_t *row = json_array_get(list, json_array_size(list) - 1);
            (void)json_object_set_new(row, "needs_field", json_boolean(needs_field(method)));
            (void)json_object_set_new(row, "answers_impacts", json_boolean(impacts));
        } else if (needs_field(method)) {
            (void)printf("    needs a field: no bodies of which only positions are given\n");
        }
        if (!json && impacts)
            (void)printf("    answers impacts\n");
    }
    return json ? print_json(list) : mote_command_finish(MOTE_EXIT_DONE);
}

static int list_fields(bool json)
{
    json_t *list = json ? json_array() : NULL;
    const mote_field_maker *m;
    for (size_t i = 0; (m = mote_field_maker_at(i)); ++i)
        show(list, m->name, m->summary, m->parameters, m->parameter_count);
    return json ? print_json(list) : mote_command_finish(MOTE_EXIT_DONE);
}

static int list_scenarios(bool json)
{
    mote_catalog catalog;
    if (mote_catalog_read(&catalog) != MOTE_OK)
        return mote_command_fail();
    json_t *list = json ? json_array() : NULL;
    for (size_t i = 0; i < catalog.count; ++i) {
        const mote_catalog_entry *entry = &catalog.entries[i];
        if (json)
            (void)json_array_append_new(
                list, json_pack("{s:s, s:s}", "name", entry->name, "purpose", entry->purpose));
        else
            (void)printf("%-12s %s\n", entry->name, entry->purpose);
    }
    mote_catalog_free(&catalog);
    return json ? print_json(list) : mote_command_finish(MOTE_EXIT_DONE);
}

const mote_option mote_options_list[] = {{"json", NULL, "as JSON (default: as text)"},
                                         {NULL, NULL, NULL}};

int mote_command_list(int argc, char **argv)
{
    mote_option_reader reader = mote_option_begin(mote_options_list, argc, argv);
    const char *what = NULL, *value;
    bool json = false;
    for (int option; (option = mote_option_next(&reader, &value)) != MOTE_OPTION_END;) {
        if (option == MOTE_OPTION_ERROR)
            return MOTE_EXIT_USAGE;
        if (option == 0)
            json = true;
        else if (!what)
            what = value;
        else
            return mote_command_usage(
                "list", "%s: one list at a time; methods, scenarios or fields", value);
    }
    if (what && strcmp(what, "methods") == 0)
        return list_methods(json);
    if (what && strcmp(what, "scenarios") == 0)
        return list_scenarios(json);
    if (what && strcmp(what, "fields") == 0)
        return list_fields(json);
    return mote_command_usage("list", "%s; choose fields, methods or scenarios",
                              what ? what : "nothing to list");
}
