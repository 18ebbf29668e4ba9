#include "harness/summary/row_label.h"

#include "harness/base/file.h"
#include "harness/base/memory.h"
#include "harness/base/method_choice.h"
#include "harness/base/record.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The parameter with a key, of the method or of scenes, with its default; NULL if this build
   has none. */
static const mote_parameter *find_parameter(const mote_method *method, const char *key,
                                            double *fallback)
{
    const mote_parameter *tables[] = {method ? method->parameters : NULL,
                                      mote_scene_parameters};
    const size_t counts[] = {method ? method->parameter_count : 0, MOTE_SCENE_KEYS};
    for (int t = 0; t < 2; ++t) {
        double values[MOTE_PARAMETERS_MAX];
        mote_parameters_default(tables[t], counts[t], values);
        for (size_t i = 0; i < counts[t]; ++i) {
            if (strcmp(tables[t][i].key, key) == 0) {
                *fallback = values[i];
                return &tables[t][i];
            }
        }
    }
    return NULL;
}

char *mote_row_value(const mote_method *method, const char *key, const json_t *value,
                     bool *usual)
{
    char text[64], usual_text[64];
    double fallback;
    const mote_parameter *parameter = find_parameter(method, key, &fallback);
    *usual = false;
    /* A choice is stored by name; a number need not be a valid choice. */
    if (parameter && json_is_number(value) && parameter->kind != MOTE_PARAMETER_CHOICE)
        (void)mote_parameter_text(parameter, json_number_value(value), text, sizeof text);
    else if (parameter && json_is_string(value))
        (void)snprintf(text, sizeof text, "%s", json_string_value(value));
    else if (json_is_string(value))
        return mote_duplicate(json_string_value(value));
    else if (json_is_real(value))
        return mote_format("%.15g", json_real_value(value));
    else
        return json_dumps(value, JSON_ENCODE_ANY);
    (void)mote_parameter_text(parameter, fallback, usual_text, sizeof usual_text);
    *usual = strcmp(text, usual_text) == 0;
    return mote_format("%s", text);
}

char *mote_row_label(const mote_stored_cell *cell)
{
    mote_text text = {0};
    mote_text_add(&text, "%s", cell->method);
    const mote_method *method = mote_method_find(cell->method);
    const char *key;
    json_t *value;
    char separator = ':';
    MOTE_EACH_MEMBER(key, value, cell->parameters)
    {
        bool usual;
        char *shown = mote_row_value(method, key, value, &usual);
        if (!usual) {
            mote_text_add(&text, "%c%s=%s", separator, key, shown);
            separator = ',';
        }
        free(shown);
    }
    return text.data;
}
