#include "harness/summary/column_docs.h"

#include <stdlib.h>
#include <string.h>

#define COUNTERS                                                                               \
    "{\"type\": \"object\", \"additionalProperties\": {\"type\": \"object\", \"properties\": " \
    "{\"mean\": {\"type\": \"number\"}, \"max\": {\"type\": \"number\"}}, \"required\": "      \
    "[\"mean\", \"max\"]}}"

#define PROCESSES                                                                              \
    "{\"type\": \"array\", \"items\": {\"type\": \"object\", \"properties\": {\"replicate\": " \
    "{\"type\": \"integer\"}, \"median_ns\": {\"type\": [\"number\", \"null\"]}, \"ratio\": "  \
    "{\"type\": [\"number\", \"null\"]}, \"counters\": {\"type\": \"object\", "                \
    "\"additionalProperties\": {\"type\": \"number\"}}}, \"required\": [\"replicate\", "       \
    "\"median_ns\", \"ratio\", \"counters\"]}}"

/* A list of as many numbers as the member holds. */
static json_t *list_schema(size_t count, json_t *item)
{
    return json_pack("{s:s, s:o, s:i, s:i}", "type", "array", "items", item, "minItems",
                     (int)count, "maxItems", (int)count);
}

/* The schema of a column's value by its type; null represents a missing number. */
static json_t *type_schema(const mote_column *column)
{
    if (column->schema)
        return json_loads(column->schema, 0, NULL);
    switch (column->type) {
    case MOTE_COLUMN_TEXT:
    case MOTE_COLUMN_ROW:
        return json_pack("{s:s}", "type", "string");
    case MOTE_COLUMN_WHOLE:
        return json_pack("{s:[s,s]}", "type", "integer", "null");
    case MOTE_COLUMN_REAL:
        return json_pack("{s:[s,s]}", "type", "number", "null");
    case MOTE_COLUMN_COUNT:
        return json_pack("{s:s, s:i}", "type", "integer", "minimum", 0);
    case MOTE_COLUMN_FLAG:
        return json_pack("{s:s}", "type", "boolean");
    case MOTE_COLUMN_COUNTS:
        return list_schema(column->size / sizeof(uint32_t),
                           json_pack("{s:s, s:i}", "type", "integer", "minimum", 0));
    case MOTE_COLUMN_NUMBERS:
        return list_schema(column->size / sizeof(double),
                           json_pack("{s:[s,s]}", "type", "number", "null"));
    case MOTE_COLUMN_COUNTERS:
        return json_loads(COUNTERS, 0, NULL);
    case MOTE_COLUMN_PROCESSES:
        return json_loads(PROCESSES, 0, NULL);
    default:
        return json_object();
    }
}

static json_t *value_schema(const mote_column *column)
{
    json_t *schema = type_schema(column);
    char *says = column->meaning ? mote_format("%s%s%s", column->meaning,
                                               column->unit[0] ? "; in " : "", column->unit)
                                 : NULL;
    if (says)
        (void)json_object_set_new(schema, "description", json_string(says));
    free(says);
    return schema;
}

/* Adds a member to an object's schema; it is required unless it may be omitted. */
static void add_member(json_t *schema, const char *key, json_t *member, bool required)
{
    (void)json_object_set_new(json_object_get(schema, "properties"), key, member);
    if (required)
        (void)json_array_append_new(json_object_get(schema, "required"), json_string(key));
}

/* The schema of the object that contains a column, made for its first column. An object that
   begins with an optional member is null without it. */
static json_t *object_schema(json_t *row, const mote_column *column)
{
    json_t *properties = json_object_get(row, "properties");
    json_t *object = json_object_get(properties, column->object);
    if (object)
        return object;
    object = column->optional
                 ? json_pack("{s:[s,s], s:{}, s:[]}", "type", "object", "null", "properties",
                             "required")
                 : json_pack("{s:s, s:{}, s:[]}", "type", "object", "properties", "required");
    add_member(row, column->object, object, true);
    return object;
}

json_t *mote_columns_schema(void)
{
    json_t *row = json_pack("{s:s, s:{}, s:[]}", "type", "object", "properties", "required");
    for (size_t i = 0; i < mote_column_count; ++i) {
        const mote_column *column = &mote_columns[i];
        if (column->object)
            add_member(object_schema(row, column), column->key, value_schema(column), true);
        else
            add_member(row, column->key, value_schema(column),
                       !column->optional && !column->of_scenes);
    }
    return row;
}

static const char *show_name(mote_number_show show)
{
    static const struct {
        mote_number_show show;
        const char *name;
    } names[] = {{mote_show_time, "time"},       {mote_show_ratio, "ratio"},
                 {mote_show_percent, "percent"}, {mote_show_error, "error"},
                 {mote_show_count, "count"},     {mote_show_bytes, "bytes"}};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; ++i) {
        if (names[i].show == show)
            return names[i].name;
    }
    return NULL;
}

/* Times are also compared, by separate rules. */
static json_t *less_is_better(const mote_column *column)
{
    if (column->rule.name)
        return json_boolean(!column->rule.complement);
    if (strcmp(column->unit, "ns") == 0)
        return json_true();
    return column->show == mote_show_ratio ? json_false() : json_null();
}

json_t *mote_column_json(const mote_column *column)
{
    return json_pack(
        "{s:s?, s:s, s:s?, s:s, s:s?, s:s?, s:s?, s:s?, s:s?, s:b, s:i, s:i, s:i, s:o}",
        "object", column->object, "key", column->key, "csv", column->csv, "unit", column->unit,
        "meaning", column->meaning, "group", column->group, "head", column->head, "brief",
        column->brief, "show", show_name(column->show), "interval", column->interval, "table",
        column->place[MOTE_VIEW_TABLE], "report", column->place[MOTE_VIEW_REPORT], "screen",
        column->place[MOTE_VIEW_SCREEN], "less_is_better", less_is_better(column));
}

static void add_name(const mote_column *column, mote_text *text)
{
    mote_text_add(text, "`%s%s%s`", column->object ? column->object : "",
                  column->object ? "." : "", column->key);
}

void mote_columns_markdown(mote_text *text)
{
    mote_text_add(text, "| column | unit | meaning |\n| --- | --- | --- |\n");
    for (size_t i = 0; i < mote_column_count; ++i) {
        const mote_column *column = &mote_columns[i];
        if (!column->meaning)
            continue;
        mote_text_add(text, "| ");
        add_name(column, text);
        /* Members without their own meaning are listed with the one before them. */
        for (size_t k = i + 1; k < mote_column_count && !mote_columns[k].meaning; ++k)
            mote_text_add(text, ", `.%s`", mote_columns[k].key);
        mote_text_add(text, " | %s | %s |\n", column->unit, column->meaning);
    }
}
