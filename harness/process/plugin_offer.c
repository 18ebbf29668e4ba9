#include "harness/process/plugin_offer.h"

#include "core/body/field_maker.h"
#include "core/method/method.h"
#include "harness/process/child.h"

#include <dlfcn.h>
#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define ITEMS_MAX 64  /* per library */
#define NAME_MOST 48  /* characters of a name, which becomes part of file names */
#define TEXT_MOST 400 /* characters of a summary or a help */

static const char lower[] = "abcdefghijklmnopqrstuvwxyz";

mote_status mote_plugin_load(const char *path, const mote_plugin_item *const **items,
                             size_t *count)
{
    void *library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    if (!library)
        return mote_fail(MOTE_EINVAL, "cannot be loaded: %s", dlerror());
    mote_plugin_items_type list;
    void *symbol = dlsym(library, "mote_plugin_items");
    /* ISO C has no conversion from a data pointer to a function pointer. */
    memcpy(&list, &symbol, sizeof list);
    *items = list ? list(count) : NULL;
    if (!*items || *count == 0)
        return mote_fail(MOTE_EINVAL, "no method and no field in it; define one with "
                                      "MOTE_METHOD or MOTE_FIELD");
    if (*count > ITEMS_MAX)
        return mote_fail(MOTE_EINVAL, "%zu methods and fields; at most %d", *count, ITEMS_MAX);
    for (size_t i = 0; i < *count; ++i) {
        if ((*items)[i]->contract != MOTE_CONTRACT)
            return mote_fail(MOTE_EINVAL,
                             "built for version %u of the contract of methods; this mote has "
                             "version %d: compile it again with this mote's headers",
                             (*items)[i]->contract, MOTE_CONTRACT);
    }
    return MOTE_OK;
}

/* Whether the structs have the same size in the library as here. */
static bool same_sizes(const mote_plugin_item *item)
{
    return item->size ==
           (item->kind == MOTE_PLUGIN_METHOD ? MOTE_METHOD_SIZES : MOTE_FIELD_SIZES);
}

/* Whether text is a letter and then letters, digits and marks of `more`. */
static bool is_name(const char *text, const char *more)
{
    if (!text || !text[0] || !strchr(lower, text[0]) || strlen(text) > NAME_MOST)
        return false;
    for (; *text; ++text) {
        if (!strchr(lower, *text) && !strchr("0123456789", *text) && !strchr(more, *text))
            return false;
    }
    return true;
}

static bool is_line(const char *text)
{
    return text && text[0] && strlen(text) <= TEXT_MOST && !strpbrk(text, "\t\n\r\v\f");
}

static mote_status check_parameter(const char *name, const mote_parameter *p)
{
    if (!is_name(p->key, "_"))
        return mote_fail(MOTE_EINVAL,
                         "%s: the key of a parameter is a lower-case letter, then letters, "
                         "digits and _, %d at most",
                         name, NAME_MOST);
    if (p->kind != MOTE_PARAMETER_INTEGER && p->kind != MOTE_PARAMETER_REAL &&
        p->kind != MOTE_PARAMETER_CHOICE)
        return mote_fail(MOTE_EINVAL, "%s: parameter %s is of an unknown kind", name, p->key);
    if (p->kind == MOTE_PARAMETER_CHOICE && !is_line(p->choices))
        return mote_fail(MOTE_EINVAL, "%s: parameter %s is a choice without choices", name,
                         p->key);
    if (p->kind != MOTE_PARAMETER_CHOICE && !(p->minimum >= 0 && p->minimum <= p->maximum))
        return mote_fail(MOTE_EINVAL,
                         "%s: parameter %s ranges from %g to %g; 0 <= minimum <= maximum", name,
                         p->key, p->minimum, p->maximum);
    if (!is_line(p->help) || !p->fallback)
        return mote_fail(MOTE_EINVAL, "%s: parameter %s needs a default and a line of help",
                         name, p->key);
    double value = 0;
    char text[128];
    (void)snprintf(text, sizeof text, "%s=%s", p->key, p->fallback);
    if (mote_parameters_parse(p, 1, text, &value) != MOTE_OK) {
        char why[256];
        (void)snprintf(why, sizeof why, "%s", mote_error_text());
        return mote_fail(MOTE_EINVAL, "%s: the default of a parameter: %s", name, why);
    }
    return MOTE_OK;
}

/* Describes the parts that methods and fields have in common. */
static mote_status describe(size_t item, const char *name, const char *summary,
                            const mote_parameter *table, size_t count, json_t *list)
{
    static const char *const kinds[] = {"integer", "real", "choice"};
    if (!is_name(name, "-"))
        return mote_fail(MOTE_EINVAL,
                         "item %zu: a name is a lower-case letter, then letters, digits and -, "
                         "%d at most",
                         item + 1, NAME_MOST);
    if (!is_line(summary))
        return mote_fail(MOTE_EINVAL, "%s: its summary is not one line of up to %d characters",
                         name, TEXT_MOST);
    if (count > MOTE_PARAMETERS_MAX || (count > 0 && !table))
        return mote_fail(MOTE_EINVAL, "%s: %zu parameters; at most %d, and a table of them",
                         name, count, MOTE_PARAMETERS_MAX);
    json_t *parameters = json_array();
    for (size_t i = 0; i < count; ++i) {
        const mote_parameter *p = &table[i];
        if (check_parameter(name, p) != MOTE_OK)
            return mote_error_status();
        char low[32], high[32];
        (void)snprintf(low, sizeof low, "%.17g", p->minimum);
        (void)snprintf(high, sizeof high, "%.17g", p->maximum);
        (void)json_array_append_new(
            parameters, json_pack("{s:s, s:s, s:s, s:s, s:s?, s:s, s:s}", "key", p->key, "kind",
                                  kinds[p->kind], "minimum", low, "maximum", high, "choices",
                                  p->choices, "fallback", p->fallback, "help", p->help));
    }
    json_t *row = json_pack("{s:I, s:s, s:s, s:o}", "item", (json_int_t)item, "name", name,
                            "summary", summary, "parameters", parameters);
    if (!row)
        return mote_fail(MOTE_EINVAL, "%s: a text of it is not UTF-8", name);
    (void)json_array_append_new(list, row);
    return MOTE_OK;
}

static mote_status describe_method(size_t item, const mote_method *m, json_t *list)
{
    mote_status status =
        describe(item, m->name, m->summary, m->parameters, m->parameter_count, list);
    if (status == MOTE_OK && !m->query)
        status = mote_fail(MOTE_EINVAL, "%s: has no function query", m->name);
    if (status == MOTE_OK && !m->create != !m->destroy)
        status = mote_fail(MOTE_EINVAL, "%s: has one of create and destroy; both or neither",
                           m->name);
    return status;
}

static mote_status describe_field(size_t item, const mote_field_maker *m, json_t *list)
{
    mote_status status =
        describe(item, m->name, m->summary, m->parameters, m->parameter_count, list);
    if (status == MOTE_OK && !m->create)
        status = mote_fail(MOTE_EINVAL, "%s: has no function create", m->name);
    return status;
}

static mote_status describe_item(size_t i, const mote_plugin_item *item, json_t *methods,
                                 json_t *fields)
{
    if (!item->item || (item->kind != MOTE_PLUGIN_METHOD && item->kind != MOTE_PLUGIN_FIELD))
        return mote_fail(MOTE_EINVAL, "item %zu is neither a method nor a field", i + 1);
    if (!same_sizes(item))
        return mote_fail(MOTE_EINVAL,
                         "compiled against headers of another mote with version %d of the "
                         "contract of methods: compile it again with this mote's headers",
                         MOTE_CONTRACT);
    return item->kind == MOTE_PLUGIN_METHOD ? describe_method(i, item->item, methods)
                                            : describe_field(i, item->item, fields);
}

mote_status mote_plugin_describe(const mote_plugin_item *const *items, size_t count,
                                 json_t **offer)
{
    json_t *methods = json_array(), *fields = json_array();
    mote_status status = MOTE_OK;
    for (size_t i = 0; status == MOTE_OK && i < count; ++i)
        status = describe_item(i, items[i], methods, fields);
    json_t *made = json_pack("{s:o, s:o}", "methods", methods, "fields", fields);
    if (status == MOTE_OK)
        *offer = made;
    else
        json_decref(made);
    return status;
}

mote_status mote_plugin_offer(void *context, int output)
{
    const mote_plugin_item *const *items;
    json_t *offer = NULL;
    size_t count;
    mote_status status = mote_plugin_load(context, &items, &count);
    if (status == MOTE_OK)
        status = mote_plugin_describe(items, count, &offer);
    if (status != MOTE_OK)
        return status;
    char *text = json_dumps(offer, JSON_COMPACT);
    status = mote_child_put(output, text, strlen(text));
    free(text);
    json_decref(offer);
    return status;
}
