/* A library whose methods and fields have the shape that the variable MOTE_SHAPE names; for
   test_plugin_shapes. It lists its items itself. */
#define MOTE_IN_TREE
#include <mote/field_maker.h>
#include <mote/method.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define ITEMS 65
#define LONG_TEXT 500
#define MARK "asked" /* a file with a byte for each time */

static char long_text[LONG_TEXT + 1];
static mote_parameter parameters[MOTE_PARAMETERS_MAX + 1];
static mote_method methods[ITEMS];
static mote_field_maker fields[ITEMS];
static mote_plugin_item items[ITEMS];
static const mote_plugin_item *listed[ITEMS];
static char names[ITEMS][16];

static const char *shape;

static int is(const char *name)
{
    return strcmp(shape, name) == 0;
}

static mote_status update(void *state, const mote_frame *frame)
{
    (void)state;
    if (frame->number >= 2 && is("update-lacks-memory"))
        return mote_fail(MOTE_ENOMEM, "no memory for the update");
    return is("update-fails") && frame->number >= 2
               ? mote_fail(MOTE_ENUMERIC, "the update fails")
               : MOTE_OK;
}

static mote_status query(void *state, const mote_frame *frame, mote_answer *answer)
{
    (void)state;
    if (frame->number >= 2 && is("query-refuses"))
        return mote_fail(MOTE_EUNSUPPORTED, "the query refuses");
    if (frame->number >= 2 && is("query-fails"))
        return mote_fail(MOTE_EINVAL, "the query fails");
    answer->has_distance = !is("query-silent");
    answer->distance = is("query-negative") ? -1 : 1;
    return MOTE_OK;
}

static mote_status create(const mote_mesh *mesh, const double *values, mote_field **field)
{
    (void)mesh;
    (void)values;
    (void)field;
    return mote_fail(MOTE_EUNSUPPORTED, "no such field today");
}

/* Sound items: the first are methods, the last is a field. */
static void make_items(size_t count, size_t field_count)
{
    static const mote_parameter sound[] = {
        {"length", MOTE_PARAMETER_REAL, 0.5, 8, NULL, "2.5", "a length"},
        {"kind_2", MOTE_PARAMETER_CHOICE, 0, 0, "one|two", "two", "a kind"},
    };
    memcpy(parameters, sound, sizeof sound);
    memset(long_text, 'x', LONG_TEXT);
    for (size_t i = 0; i < count; ++i) {
        const int field = i + field_count >= count;
        (void)snprintf(names[i], sizeof names[i], "shaped-%zu", i + 1);
        methods[i].name = fields[i].name = names[i];
        methods[i].summary = fields[i].summary = "one line";
        methods[i].parameters = fields[i].parameters = parameters;
        methods[i].parameter_count = fields[i].parameter_count = 2;
        methods[i].update = update;
        methods[i].query = query;
        fields[i].create = create;
        items[i].contract = MOTE_CONTRACT;
        items[i].kind = field ? MOTE_PLUGIN_FIELD : MOTE_PLUGIN_METHOD;
        items[i].size = (uint32_t)(field ? MOTE_FIELD_SIZES : MOTE_METHOD_SIZES);
        items[i].item = field ? (const void *)&fields[i] : (const void *)&methods[i];
        listed[i] = &items[i];
    }
}

static void shape_texts(void)
{
    if (is("name-missing"))
        methods[0].name = NULL;
    if (is("name-empty"))
        methods[0].name = "";
    if (is("name-digit"))
        methods[0].name = "1-name";
    if (is("name-long"))
        methods[0].name = long_text;
    if (is("name-mark"))
        methods[0].name = "a_name";
    if (is("field-name"))
        fields[1].name = "A";
    if (is("summary-missing"))
        methods[0].summary = NULL;
    if (is("summary-empty"))
        methods[0].summary = "";
    if (is("summary-long"))
        methods[0].summary = long_text;
    if (is("summary-bytes"))
        methods[0].summary = "\xff";
}

static void shape_parameters(void)
{
    if (is("key"))
        parameters[0].key = "Length";
    if (is("kind"))
        parameters[0].kind = (mote_parameter_kind)7;
    if (is("choices-missing"))
        parameters[1].choices = NULL;
    if (is("minimum"))
        parameters[0].minimum = -1;
    if (is("help"))
        parameters[0].help = "two\twords";
    if (is("fallback-missing"))
        parameters[0].fallback = NULL;
    if (is("parameters-many"))
        methods[0].parameter_count = MOTE_PARAMETERS_MAX + 1;
    if (is("parameters-missing"))
        methods[0].parameters = NULL;
}

static void shape_items(void)
{
    if (is("item-missing"))
        items[0].item = NULL;
    if (is("item-kind"))
        items[1].kind = 3;
    if (is("field-create"))
        fields[1].create = NULL;
    if (is("field-size"))
        items[1].size = 8;
}

/* How often it has been asked before, by any process in this folder. */
static size_t times_asked(void)
{
    FILE *file = fopen(MARK, "a");
    if (!file)
        return 0;
    (void)fseek(file, 0, SEEK_END);
    const long times = ftell(file);
    (void)fputc('.', file);
    (void)fclose(file);
    return (size_t)times;
}

/* Other names for each time that it is asked: it can be opened again and again. */
static void number_items(size_t asked)
{
    for (size_t i = 0; i < 2; ++i)
        (void)snprintf(names[i], sizeof names[i], "shaped-%zu-%zu", i + 1, asked + 1);
}

/* Other items than when it was first asked. */
static void change_items(size_t *count)
{
    if (is("later-fewer"))
        *count = 1;
    if (is("later-kind"))
        items[1] = items[0];
    if (is("later-size"))
        items[1].size = 8;
    if (is("later-name"))
        fields[1].name = "another";
    if (is("later-parameters"))
        methods[0].parameter_count = fields[1].parameter_count = 1;
}

MOTE_PLUGIN_DECLARE __attribute__((visibility("default"))) const mote_plugin_item *const *
mote_plugin_items(size_t *count);

const mote_plugin_item *const *mote_plugin_items(size_t *count)
{
    const char *named = getenv("MOTE_SHAPE");
    shape = named ? named : "sound";
    *count = is("items-many") ? ITEMS : is("methods-17") ? 17 : is("fields-17") ? 17 : 2;
    make_items(*count, is("methods-17") ? 0 : is("fields-17") ? 17 : 1);
    shape_texts();
    shape_parameters();
    shape_items();
    if (is("items-none"))
        *count = 0;
    if (is("numbered"))
        number_items(times_asked());
    if (strncmp(shape, "later-", strlen("later-")) == 0 && times_asked() > 0)
        change_items(count);
    return is("items-missing") || (is("once") && times_asked() > 0) ? NULL : listed;
}
