/* Reads the field of a body and the displacement of its control points. */
#include "harness/scene/scenario_read.h"

#include "core/body/field_maker.h"
#include "harness/base/file.h"
#include "harness/base/memory.h"
#include "harness/scene/spread.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define AMPLITUDE_MAX 1e3 /* of L */

static mote_status read_centres(const mote_json *node, const mote_mesh *mesh,
                                mote_vec3 *centres, uint32_t *count)
{
    mote_json given = mote_json_member(node, "centres");
    mote_json number = mote_json_member(node, "count");
    if (!given.value == !number.value)
        return mote_json_fail(node, "needs either centres or count, not %s",
                              given.value ? "both" : "neither");
    if (number.value) {
        int64_t wanted = 0;
        mote_status status = mote_json_integer(&number, 1, MOTE_CONTROLS_MAX, &wanted);
        if (status == MOTE_OK)
            status = mote_json_blame(&number, mote_spread(mesh, (uint32_t)wanted, centres));
        *count = (uint32_t)wanted;
        return status;
    }
    size_t size = 0;
    mote_status status = mote_json_array(&given, 1, MOTE_CONTROLS_MAX, &size);
    const mote_vec3 centre = mote_mesh_centre(mesh);
    for (size_t i = 0; i < size && status == MOTE_OK; ++i) {
        mote_json element = mote_json_element(&given, i);
        mote_vec3 point;
        status = mote_json_vec3(&element, -1e3, 1e3, &point);
        if (status == MOTE_OK)
            centres[i] = mote_add_scaled(centre, mesh->diagonal, point);
    }
    *count = (uint32_t)size;
    return status;
}

static mote_status read_sine(const mote_json *node, double length, uint32_t control_count,
                             mote_wave *wave)
{
    int64_t control = 0;
    mote_vec3 amplitude = {0, 0, 0};
    mote_json key = mote_json_member(node, "control");
    mote_status status = mote_json_object(node, "control|amplitude|period|phase");
    if (status == MOTE_OK)
        status = mote_json_integer(&key, 1, control_count, &control);
    key = mote_json_member(node, "amplitude");
    if (status == MOTE_OK)
        status = mote_json_vec3(&key, -AMPLITUDE_MAX, AMPLITUDE_MAX, &amplitude);
    key = mote_json_member(node, "period");
    if (status == MOTE_OK)
        status = mote_json_real(&key, 1, 1e9, &wave->period);
    key = mote_json_member(node, "phase");
    if (status == MOTE_OK && key.value)
        status = mote_json_real(&key, -1e3, 1e3, &wave->phase);
    wave->control = status == MOTE_OK ? (uint32_t)control - 1 : 0;
    wave->amplitude = mote_scale(amplitude, length);
    return status;
}

static mote_status read_sines(const mote_json *node, double length, mote_body_motion *motion)
{
    size_t count;
    mote_status status = mote_json_array(node, 1, 64 * (size_t)MOTE_CONTROLS_MAX, &count);
    if (status != MOTE_OK)
        return status;
    motion->waves = mote_allocate(count, sizeof *motion->waves);
    for (size_t i = 0; i < count && status == MOTE_OK; ++i) {
        mote_json element = mote_json_element(node, i);
        status = read_sine(&element, length, motion->control_count, &motion->waves[i]);
    }
    motion->wave_count = (uint32_t)count;
    return status;
}

static mote_status read_random(const mote_json *node, double length, mote_body_motion *motion)
{
    int64_t seed = 0, terms = 2;
    double amplitude = 0, periods[2] = {0, 0};
    mote_status status = mote_json_object(node, "seed|amplitude|periods|terms");
    mote_json key = mote_json_member(node, "seed");
    if (status == MOTE_OK)
        status = mote_json_integer(&key, 0, INT64_MAX, &seed);
    key = mote_json_member(node, "amplitude");
    if (status == MOTE_OK)
        status = mote_json_real(&key, 0, AMPLITUDE_MAX, &amplitude);
    key = mote_json_member(node, "terms");
    if (status == MOTE_OK && key.value)
        status = mote_json_integer(&key, 1, 64, &terms);
    key = mote_json_member(node, "periods");
    if (status == MOTE_OK)
        status = mote_json_reals(&key, 2, 1, 1e9, periods);
    if (status == MOTE_OK && periods[0] > periods[1])
        status = mote_json_fail(&key, "%g is above %g; give the shorter first", periods[0],
                                periods[1]);
    if (status != MOTE_OK)
        return status;
    const uint32_t count = motion->control_count * (uint32_t)terms;
    motion->waves = mote_allocate(count, sizeof *motion->waves);
    motion->wave_count = count;
    mote_waves_draw((uint64_t)seed, motion->control_count, (uint32_t)terms, amplitude * length,
                    periods[0], periods[1], motion->waves);
    return MOTE_OK;
}

static mote_status read_keyframe(const mote_json *node, double length, uint32_t controls,
                                 uint32_t *frame, double *values)
{
    int64_t number = 0;
    size_t size;
    mote_status status = mote_json_object(node, "frame|vectors");
    mote_json key = mote_json_member(node, "frame");
    if (status == MOTE_OK)
        status = mote_json_integer(&key, 1, MOTE_FRAMES_MAX, &number);
    key = mote_json_member(node, "vectors");
    if (status == MOTE_OK)
        status = mote_json_array(&key, controls, controls, &size);
    for (uint32_t j = 0; j < controls && status == MOTE_OK; ++j) {
        mote_json element = mote_json_element(&key, j);
        status = mote_json_reals(&element, 3, -AMPLITUDE_MAX, AMPLITUDE_MAX, &values[3 * j]);
        for (int axis = 0; axis < 3 && status == MOTE_OK; ++axis)
            values[3 * j + (uint32_t)axis] *= length;
    }
    *frame = (uint32_t)number;
    return status;
}

static mote_status read_keyframes(const mote_json *node, double length,
                                  mote_body_motion *motion)
{
    const uint32_t width = 3 * motion->control_count;
    size_t count;
    mote_status status = mote_json_array(node, 1, 100000, &count);
    if (status != MOTE_OK)
        return status;
    uint32_t *frames = mote_allocate(count, sizeof *frames);
    double *values = mote_allocate(count * width, sizeof *values);
    for (size_t k = 0; k < count && status == MOTE_OK; ++k) {
        mote_json element = mote_json_element(node, k);
        status = read_keyframe(&element, length, motion->control_count, &frames[k],
                               &values[k * width]);
    }
    if (status == MOTE_OK) {
        status = mote_json_blame(
            node, mote_curve_create(frames, values, (uint32_t)count, width, &motion->keyed));
    }
    free(frames);
    free(values);
    return status;
}

static mote_status read_displacement(const mote_json *node, double length,
                                     mote_body_motion *motion)
{
    mote_status status = mote_json_object(node, "sines|random|keyframes");
    if (status != MOTE_OK)
        return status;
    if (json_object_size(node->value) != 1)
        return mote_json_fail(node, "needs exactly one of sines, random, keyframes");
    mote_json sines = mote_json_member(node, "sines");
    mote_json drawn = mote_json_member(node, "random");
    mote_json keyframes = mote_json_member(node, "keyframes");
    if (sines.value)
        return read_sines(&sines, length, motion);
    if (drawn.value)
        return read_random(&drawn, length, motion);
    return read_keyframes(&keyframes, length, motion);
}

static mote_status unknown_kind(const mote_json *node, const char *name)
{
    mote_text known = {0};
    for (size_t i = 0; mote_field_maker_at(i); ++i)
        mote_text_add(&known, ", %s", mote_field_maker_at(i)->name);
    mote_status status = mote_json_fail(node, "unknown kind %s; known are csrbf%s", name,
                                        known.data ? known.data : "");
    free(known.data);
    return status;
}

/* Whether a string is what a parameter takes instead of a number. */
static bool is_word_of(const mote_parameter *p, const char *word)
{
    return p->kind == MOTE_PARAMETER_CHOICE || (p->choices && strcmp(word, "auto") == 0) ||
           (isinf(p->maximum) && strcmp(word, "inf") == 0);
}

/* A parameter of a field's kind: a number or, where it takes one, a word. */
static mote_status read_parameter(const mote_json *node, const mote_parameter *p, double *value)
{
    const char *word = json_string_value(node->value);
    if (word ? !is_word_of(p, word) || strchr(word, ',') : !json_is_number(node->value)) {
        char right[300];
        if (p->kind == MOTE_PARAMETER_CHOICE)
            (void)snprintf(right, sizeof right, "one of %s", p->choices);
        else
            (void)snprintf(right, sizeof right, "a number from %.15g to %.15g%s", p->minimum,
                           p->maximum, p->choices ? ", or \"auto\"" : "");
        return mote_json_refuse(node, right);
    }
    char *text = word ? mote_format("%s=%s", p->key, word)
                      : mote_format("%s=%.17g", p->key, json_number_value(node->value));
    const mote_status status = mote_parameters_parse(p, 1, text, value);
    free(text);
    return status == MOTE_EINVAL ? mote_json_fail(node, "%s", mote_error_text()) : status;
}

static mote_status read_parameters(const mote_json *node, const mote_field_maker *maker,
                                   double *values)
{
    mote_text known = {0};
    mote_text_add(&known, "kind|displacement");
    for (size_t i = 0; i < maker->parameter_count; ++i)
        mote_text_add(&known, "|%s", maker->parameters[i].key);
    mote_status status = mote_json_object(node, known.data);
    free(known.data);
    mote_parameters_default(maker->parameters, maker->parameter_count, values);
    for (size_t i = 0; i < maker->parameter_count && status == MOTE_OK; ++i) {
        const mote_json key = mote_json_member(node, maker->parameters[i].key);
        if (key.value)
            status = read_parameter(&key, &maker->parameters[i], &values[i]);
    }
    return status;
}

/* Makes a field of a kind that field_maker.h knows. */
static mote_status read_made(const mote_json *node, const mote_json *kind,
                             const mote_mesh *mesh, mote_field **field)
{
    const char *name = NULL;
    mote_status status = mote_json_string(kind, &name);
    if (status != MOTE_OK)
        return status;
    const mote_field_maker *maker = mote_field_maker_find(name);
    if (!maker)
        return unknown_kind(kind, name);
    double values[MOTE_PARAMETERS_MAX];
    status = read_parameters(node, maker, values);
    return status == MOTE_OK ? mote_json_blame(node, maker->create(mesh, values, field))
                             : status;
}

static mote_status read_csrbf(const mote_json *node, const mote_mesh *mesh, mote_field **field,
                              mote_csrbf_fit **fit)
{
    mote_vec3 centres[MOTE_CONTROLS_MAX];
    uint32_t count = 0;
    double support = 0;
    mote_status status = mote_json_object(node, "kind|centres|count|support|displacement");
    if (status == MOTE_OK)
        status = read_centres(node, mesh, centres, &count);
    mote_json key = mote_json_member(node, "support");
    if (status == MOTE_OK)
        status = mote_json_real(&key, 1e-6, 1e6, &support);
    if (status != MOTE_OK)
        return status;
    status = mote_field_create_csrbf(centres, count, support * mesh->diagonal, field);
    if (status == MOTE_OK)
        status = mote_csrbf_fit_create(*field, fit, NULL);
    return mote_json_blame(node, status);
}

mote_status mote_scenario_read_field(const mote_json *body, const mote_mesh *mesh,
                                     mote_character *character, mote_field **field,
                                     mote_body_motion *motion)
{
    if (character) {
        const mote_status clip = mote_scenario_read_clip(body, mesh, character, field, motion);
        if (!motion->player)
            mote_character_destroy(character);
        return clip;
    }
    mote_json node = mote_json_member(body, "field");
    if (!node.value)
        return mote_field_create_static(field);
    mote_json kind = mote_json_member(&node, "kind");
    const char *name = json_string_value(kind.value);
    mote_status status = kind.value && (!name || strcmp(name, "csrbf") != 0)
                             ? read_made(&node, &kind, mesh, field)
                             : read_csrbf(&node, mesh, field, &motion->fit);
    if (status != MOTE_OK)
        return status;
    motion->control_count = (*field)->count;
    mote_json displacement = mote_json_member(&node, "displacement");
    return read_displacement(&displacement, mesh->diagonal, motion);
}
