#define _DEFAULT_SOURCE /* realpath */
#include "harness/process/plugin.h"

#include "core/body/field_maker.h"
#include "core/method/method.h"
#include "harness/base/hash.h"
#include "harness/base/json_read.h"
#include "harness/base/memory.h"
#include "harness/base/record.h"
#include "harness/process/child.h"
#include "harness/process/plugin_offer.h"

#include <assert.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define LIBRARY_BYTES ((size_t)1 << 30) /* largest library file */
#define OFFER_BYTES ((size_t)1 << 22)   /* largest description that a library may give */
#define OFFER_SECONDS 5.0

/* Methods, and fields, of all libraries together. Each slot has its own functions, because the
   contract passes traits and create nothing that identifies the method. */
#define SLOTS(X)                                                                               \
    X(0) X(1) X(2) X(3) X(4) X(5) X(6) X(7) X(8) X(9) X(10) X(11) X(12) X(13) X(14) X(15)
enum { SLOTS_MAX = 16 };

typedef struct library {
    char *path;
    json_t *offer;                        /* see plugin_offer.h */
    const mote_plugin_item *const *items; /* NULL until this process has loaded it */
} library;

/* Represents a method or a field until its library is loaded. */
typedef struct slot {
    library *from;
    size_t item;
    mote_method method;     /* once loaded, a copy of the library's own */
    mote_field_maker field; /* once loaded, the same */
} slot;

static library libraries[MOTE_PLUGINS_MAX];
static size_t library_count;
static slot method_slots[SLOTS_MAX], field_slots[SLOTS_MAX];
static size_t method_count, field_count;
static uint64_t files_hash;

static mote_status blame(const char *path, mote_status status)
{
    char why[800];
    (void)snprintf(why, sizeof why, "%s", mote_error_text());
    return mote_fail(status, "%s: %s", path, why);
}

/* Slots have what a child found in the library. A library that was built again since may have
   other items, or take other parameters, at the same numbers. */
static mote_status check_unchanged(const library *l, const mote_plugin_item *const *items,
                                   size_t count)
{
    json_t *now = NULL;
    const mote_status status = mote_plugin_describe(items, count, &now);
    const bool same = status == MOTE_OK && json_equal(now, l->offer);
    json_decref(now);
    if (status != MOTE_OK || same)
        return status;
    return mote_fail(MOTE_EINVAL, "offers other methods, fields or parameters than when this "
                                  "command began; give the same command again");
}

/* Loads the library of a slot; *item is then the slot's item. */
static mote_status load(const slot *s, const void **item)
{
    library *l = s->from;
    if (!l->items) {
        const mote_plugin_item *const *items;
        size_t count = 0;
        mote_status status = mote_plugin_load(l->path, &items, &count);
        if (status == MOTE_OK)
            status = check_unchanged(l, items, count);
        if (status != MOTE_OK)
            return blame(l->path, status);
        l->items = items;
    }
    *item = l->items[s->item]->item;
    return MOTE_OK;
}

static mote_status create_method(size_t k, const mote_setup *setup, void **state)
{
    slot *s = &method_slots[k];
    const void *item = NULL;
    const mote_status status = load(s, &item);
    if (status != MOTE_OK)
        return status;
    /* From here on the method is called like a built-in one. The table of parameters stays the
       offer's: the values were read by it, and nothing else points to its memory. */
    const mote_parameter *parameters = s->method.parameters;
    s->method = *(const mote_method *)item;
    s->method.parameters = parameters;
    return mote_method_create(&s->method, setup, state);
}

/* Of a method whose library could not be loaded when it was to be created. */
static void destroy_none(void *state)
{
    assert(!state);
    (void)state;
}

typedef struct traits_question {
    const slot *of;
    const double *values;
} traits_question;

static mote_status ask_traits(void *context, int output)
{
    const traits_question *q = context;
    const void *item = NULL;
    mote_status status = load(q->of, &item);
    if (status != MOTE_OK)
        return status;
    const mote_traits traits = mote_method_traits(item, q->values);
    return mote_child_put(output, &traits, sizeof traits);
}

/* Asks a child, since this process has not loaded the library. If that fails, the method's
   cells will report it. */
static mote_traits traits_of(size_t k, const double *values)
{
    traits_question question = {&method_slots[k], values};
    const mote_child_limits limits = {.seconds = OFFER_SECONDS,
                                      .output_bytes = sizeof(mote_traits)};
    mote_traits traits = {0};
    char *output = NULL;
    size_t size = 0;
    if (mote_child_run("traits", ask_traits, &question, limits, &output, &size) == MOTE_OK &&
        size == sizeof traits)
        memcpy(&traits, output, sizeof traits);
    free(output);
    return traits;
}

static mote_status create_field(size_t k, const mote_mesh *mesh, const double *values,
                                mote_field **field)
{
    slot *s = &field_slots[k];
    const void *item = NULL;
    const mote_status status = load(s, &item);
    if (status != MOTE_OK)
        return status;
    return ((const mote_field_maker *)item)->create(mesh, values, field);
}

#define SLOT_FUNCTIONS(k)                                                                      \
    static mote_status create_##k(const mote_setup *setup, void **state)                       \
    {                                                                                          \
        return create_method(k, setup, state);                                                 \
    }                                                                                          \
    static mote_traits traits_##k(const double *values)                                        \
    {                                                                                          \
        return traits_of(k, values);                                                           \
    }                                                                                          \
    static mote_status create_field_##k(const mote_mesh *mesh, const double *values,           \
                                        mote_field **field)                                    \
    {                                                                                          \
        return create_field(k, mesh, values, field);                                           \
    }
SLOTS(SLOT_FUNCTIONS)

static mote_status (*const method_create[])(const mote_setup *, void **) = {
#define ROW(k) create_##k,
    SLOTS(ROW)
#undef ROW
};
static mote_traits (*const method_traits[])(const double *) = {
#define ROW(k) traits_##k,
    SLOTS(ROW)
#undef ROW
};
static mote_status (*const field_create[])(const mote_mesh *, const double *, mote_field **) = {
#define ROW(k) create_field_##k,
    SLOTS(ROW)
#undef ROW
};

static const char *text_of(const json_t *object, const char *key)
{
    return json_string_value(json_object_get(object, key));
}

/* A table that lives as long as the library's offer. */
static mote_parameter *parameters_of(const json_t *row, size_t *count)
{
    const json_t *list = json_object_get(row, "parameters");
    *count = json_array_size(list);
    mote_parameter *table = mote_allocate(*count, sizeof *table);
    for (size_t i = 0; i < *count; ++i) {
        const json_t *p = json_array_get(list, i);
        const char *kind = text_of(p, "kind");
        table[i] = (mote_parameter){
            .key = text_of(p, "key"),
            .kind = strcmp(kind, "integer") == 0 ? MOTE_PARAMETER_INTEGER
                    : strcmp(kind, "real") == 0  ? MOTE_PARAMETER_REAL
                                                 : MOTE_PARAMETER_CHOICE,
            .minimum = strtod(text_of(p, "minimum"), NULL),
            .maximum = strtod(text_of(p, "maximum"), NULL),
            .choices = text_of(p, "choices"),
            .fallback = text_of(p, "fallback"),
            .help = text_of(p, "help"),
        };
    }
    return table;
}

static mote_status add_method(library *from, const json_t *row)
{
    if (method_count == SLOTS_MAX)
        return mote_fail(MOTE_EINVAL, "more than %d methods from libraries", SLOTS_MAX);
    slot *s = &method_slots[method_count];
    s->from = from;
    s->item = (size_t)json_integer_value(json_object_get(row, "item"));
    s->method = (mote_method){.name = text_of(row, "name"),
                              .summary = text_of(row, "summary"),
                              .create = method_create[method_count],
                              .destroy = destroy_none,
                              .traits = method_traits[method_count]};
    s->method.parameters = parameters_of(row, &s->method.parameter_count);
    ++method_count;
    return mote_method_add(&s->method);
}

static mote_status add_field(library *from, const json_t *row)
{
    if (field_count == SLOTS_MAX)
        return mote_fail(MOTE_EINVAL, "more than %d kinds of fields from libraries", SLOTS_MAX);
    slot *s = &field_slots[field_count];
    s->from = from;
    s->item = (size_t)json_integer_value(json_object_get(row, "item"));
    s->field = (mote_field_maker){.name = text_of(row, "name"),
                                  .summary = text_of(row, "summary"),
                                  .create = field_create[field_count]};
    s->field.parameters = parameters_of(row, &s->field.parameter_count);
    ++field_count;
    return mote_field_maker_add(&s->field);
}

/* Adds the methods and fields of a library's offer. */
static mote_status add_offer(library *l, const char *text, size_t size)
{
    const json_t *row;
    size_t i;
    mote_status status = mote_json_parse("offer", text, size, "a library's offer", &l->offer);
    if (status != MOTE_OK)
        return status;
    MOTE_EACH(i, row, json_object_get(l->offer, "methods"))
    {
        if (status == MOTE_OK)
            status = add_method(l, row);
    }
    MOTE_EACH(i, row, json_object_get(l->offer, "fields"))
    {
        if (status == MOTE_OK)
            status = add_field(l, row);
    }
    return status;
}

mote_status mote_plugin_open(const char *path)
{
    char *data = NULL, *real = realpath(path, NULL);
    size_t size = 0;
    if (!real)
        return mote_fail(MOTE_EINVAL,
                         "%s: there is no such file; --plugin takes a shared library", path);
    mote_status status = mote_file_read(real, LIBRARY_BYTES, &data, &size);
    if (status == MOTE_OK && library_count == MOTE_PLUGINS_MAX)
        status = mote_fail(MOTE_EINVAL, "%s: more than %d libraries", path, MOTE_PLUGINS_MAX);
    if (status != MOTE_OK) {
        free(data);
        free(real);
        return status;
    }
    files_hash = mote_hash_bytes(files_hash ? files_hash : MOTE_HASH_START, data, size);
    free(data);
    library *l = &libraries[library_count++];
    l->path = real;
    const mote_child_limits limits = {.seconds = OFFER_SECONDS, .output_bytes = OFFER_BYTES};
    char *offer = NULL;
    status = mote_child_run("asking it what it offers", mote_plugin_offer, real, limits, &offer,
                            &size);
    if (status == MOTE_OK)
        status = add_offer(l, offer, size);
    free(offer);
    /* The user named the library, so a crash while loading it is bad input, too. */
    return status == MOTE_OK ? MOTE_OK : blame(path, MOTE_EINVAL);
}

const char *mote_plugin_path(size_t index)
{
    return index < library_count ? libraries[index].path : NULL;
}

uint64_t mote_plugin_hash(void)
{
    return files_hash;
}

json_t *mote_plugin_json(void)
{
    json_t *list = json_array();
    for (size_t k = 0; k < library_count; ++k) {
        static const char *const keys[] = {"methods", "fields"};
        json_t *names[2];
        for (int n = 0; n < 2; ++n) {
            const json_t *row;
            size_t i;
            names[n] = json_array();
            MOTE_EACH(i, row, json_object_get(libraries[k].offer, keys[n]))
            (void)json_array_append(names[n], json_object_get(row, "name"));
        }
        (void)json_array_append_new(
            list, json_pack("{s:s, s:i, s:o, s:o}", "file", libraries[k].path, "contract",
                            MOTE_CONTRACT, "methods", names[0], "fields", names[1]));
    }
    return list;
}
