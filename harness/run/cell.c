#include "harness/run/cell.h"

#include "harness/base/hash.h"
#include "harness/process/manifest.h"
#include "harness/base/record.h"

#include <ctype.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *const mote_cache_names[] = {"hot", "evict"};
const char *const mote_cell_status_names[] = {"ok", "crashed", "timeout", "unsupported"};

#define NAME_TEXT(name) #name,
const char *const mote_scene_column_names[MOTE_SCENE_COLUMN_COUNT] = {
    MOTE_SCENE_COLUMNS(NAME_TEXT)};
const char *const mote_impact_column_names[MOTE_IMPACT_COLUMN_COUNT] = {
    MOTE_IMPACT_COLUMNS(NAME_TEXT)};
#undef NAME_TEXT

uint32_t mote_cell_rows(const mote_cell *cell)
{
    const uint32_t frames = cell->last - cell->first;
    return frames >= cell->step ? (frames - cell->step) / cell->stride + 1 : 0;
}

/* A name made fit for a file name. */
static void plain(const char *name, char *out, size_t size)
{
    size_t used = 0;
    for (; *name && used + 1 < size; ++name)
        out[used++] = isalnum((unsigned char)*name) || *name == '-' ? *name : '_';
    out[used] = '\0';
}

/* "key=value," for every parameter of a table. */
static void describe_values(const mote_parameter *table, size_t count, const double *values,
                            mote_text *text)
{
    for (size_t i = 0; i < count; ++i) {
        char value[64];
        mote_text_add(text, "%s=%s,", table[i].key,
                      mote_parameter_text(&table[i], values[i], value, sizeof value));
    }
}

void mote_cell_name(mote_cell *cell, uint64_t program)
{
    const mote_subject_facts facts = mote_subject_facts_of(cell->subject);
    const mote_method *asked = cell->choice->method;
    mote_text text = {0};
    mote_text_add(&text, "%016" PRIx64 " %016" PRIx64 " %d %.17g %s ",
                  cell->subject->fingerprint, cell->subject->faces, (int)facts.ask,
                  facts.tolerance, asked->name);
    describe_values(asked->parameters, asked->parameter_count, cell->choice->values, &text);
    if (cell->subject->bodies)
        describe_values(mote_scene_parameters, MOTE_SCENE_KEYS, cell->choice->scene, &text);
    mote_text_add(&text, " %u %u %u %u %" PRIu64 " %d %016" PRIx64, cell->replicate,
                  cell->first, cell->last, cell->stride_asked, cell->seed, (int)cell->cache,
                  program);
    if (facts.active.first > 0)
        mote_text_add(&text, " active %u-%u", facts.active.first, facts.active.last);
    if (cell->step > 0)
        mote_text_add(&text, " step %u", cell->step);
    if (cell->jobs > 1)
        mote_text_add(&text, " jobs");
    if (cell->fixed_seed)
        mote_text_add(&text, " fixed seed");
    if (cell->contacts_only)
        mote_text_add(&text, " contacts only");
    char name[20], method[28];
    plain(facts.name, name, sizeof name);
    plain(asked->name, method, sizeof method);
    (void)snprintf(cell->id, sizeof cell->id, "%s-%s-r%u-%016" PRIx64, name, method,
                   cell->replicate, mote_hash_text(text.data));
    free(text.data);
}

static json_t *parameter_json(const mote_parameter *parameter, double value)
{
    char text[64];
    (void)mote_parameter_text(parameter, value, text, sizeof text);
    char *end;
    double number = strtod(text, &end);
    if (parameter->kind == MOTE_PARAMETER_CHOICE || end == text || *end != '\0' ||
        number - number != 0)
        return json_string(text);
    if (parameter->kind == MOTE_PARAMETER_INTEGER)
        return json_integer((json_int_t)number);
    return json_real(number);
}

/* Adds a table of parameters to an object. */
static void add_parameters(const mote_parameter *table, size_t count, const double *values,
                           json_t *object)
{
    for (size_t i = 0; i < count; ++i)
        (void)json_object_set_new(object, table[i].key, parameter_json(&table[i], values[i]));
}

json_t *mote_choice_json(const mote_method_choice *choice, bool of_scene)
{
    json_t *object = json_object();
    add_parameters(choice->method->parameters, choice->method->parameter_count, choice->values,
                   object);
    if (of_scene)
        add_parameters(mote_scene_parameters, MOTE_SCENE_KEYS, choice->scene, object);
    return object;
}

static json_t *interval_json(uint32_t first, uint32_t last)
{
    return json_pack("[i,i]", (int)first, (int)last);
}

/* The active interval: the scenario's; for more than two bodies, all frames but the first, in
   which every near pair is new. */
static json_t *active_json(const mote_cell *cell, const mote_subject_facts *facts)
{
    if (!cell->subject->bodies)
        return interval_json(facts->active.first, facts->active.last);
    return cell->last > cell->first ? interval_json(cell->first + 1, cell->last)
                                    : interval_json(0, 0);
}

bool mote_cell_told_positions(const mote_cell *cell)
{
    const mote_method_choice *choice = cell->choice;
    const mote_traits traits = mote_method_traits(choice->method, choice->values);
    const mote_engine_setup setup = mote_subject_engine(cell->subject);
    bool field = traits.uses_field || (!traits.needs_vertices && !traits.given_vertices);
    if (cell->subject->bodies && strcmp(choice->method->name, "stream") != 0)
        field = field || (int)choice->scene[MOTE_SCENE_REFIT] != MOTE_REFIT_EVERY;
    for (uint32_t k = 0; k < setup.shape_count; ++k)
        field = field && !mote_body_is_given(setup.shapes[k]);
    return !field;
}

/* The facts known about a cell before it runs; NULL if a name is not UTF-8. */
static json_t *cell_json(const mote_cell *cell, mote_cell_status status, uint64_t program)
{
    const mote_subject_facts facts = mote_subject_facts_of(cell->subject);
    const bool of_scene = cell->subject->bodies != NULL;
    char fingerprint[20], faces[20], hash[20], machine[MOTE_MACHINE_SIZE];
    mote_machine_name(machine, sizeof machine);
    (void)snprintf(fingerprint, sizeof fingerprint, "%016" PRIx64, cell->subject->fingerprint);
    (void)snprintf(faces, sizeof faces, "%016" PRIx64, cell->subject->faces);
    (void)snprintf(hash, sizeof hash, "%016" PRIx64, program);
    json_t *object = json_pack(
        "{s:i, s:s, s:s, s:s, s:s, s:s, s:o*, s:i, s:o*, s:i, s:I, s:s, s:[i,i], s:[i,i], s:f,"
        " s:f, s:s, s:i, s:o*, s:s, s:s, s:i, s:b}",
        "schema", 1, "id", cell->id, "status", mote_cell_status_names[status], "scenario",
        facts.name, "fingerprint", fingerprint, "method", cell->choice->method->name,
        "parameters", mote_choice_json(cell->choice, of_scene), "replicate",
        (int)cell->replicate, "frames", interval_json(cell->first, cell->last), "stride",
        (int)cell->stride, "seed", (json_int_t)cell->seed, "cache",
        mote_cache_names[cell->cache], "triangles", (int)facts.triangles[0],
        (int)facts.triangles[1], "vertices", (int)facts.vertices[0], (int)facts.vertices[1],
        "length", facts.length, "tolerance", facts.tolerance, "ask", mote_ask_names[facts.ask],
        "scenario_frames", (int)facts.frames, "active", active_json(cell, &facts), "program",
        hash, "machine", machine, "jobs", (int)(cell->jobs > 1 ? cell->jobs : 1), "fixed_seed",
        cell->fixed_seed);
    (void)json_object_set_new(
        object, "told", json_string(mote_cell_told_positions(cell) ? "positions" : "field"));
    (void)json_object_set_new(object, "faces", json_string(faces));
    if (cell->step > 0)
        (void)json_object_set_new(object, "step", json_integer(cell->step));
    if (of_scene) {
        (void)json_object_set_new(object, "bodies", json_integer(facts.bodies));
        (void)json_object_set_new(object, "shapes",
                                  json_integer(cell->subject->bodies->shape_count));
        (void)json_object_set_new(object, "vertices_total", json_real(facts.vertices_total));
        (void)json_object_set_new(
            object, "near_pairs_wanted",
            facts.near_pairs_wanted > 0 ? json_real(facts.near_pairs_wanted) : json_null());
    }
    return object;
}

static void add_real(mote_text *text, bool present, double value)
{
    if (present)
        mote_text_add(text, ",%.17g", value);
    else
        mote_text_add(text, ",");
}

/* Whether there is an impact in a row's question: 1, 0, or -1 without a truth; and when. */
static int true_impact(const mote_cell *cell, const mote_cell_row *row, double *to)
{
    const mote_impact_truth *truth = cell->subject->impacts;
    return truth ? mote_impact_truth_between(truth, row->frame, cell->step, to) : -1;
}

/* 1, 0, or -1 without a truth. */
static int true_contact(const mote_cell *cell, const mote_cell_row *row)
{
    const mote_truth *truth = cell->subject->truth;
    double to;
    if (cell->step > 0)
        return true_impact(cell, row, &to);
    return truth ? truth->contact[row->frame - 1] : -1;
}

static void add_impact(mote_text *text, const mote_cell *cell, const mote_cell_row *row)
{
    const mote_impact_answer *answer = &row->impact;
    const bool impact = answer->answered && answer->impact;
    double to = 0;
    const bool has_truth = true_impact(cell, row, &to) == 1;
    add_real(text, impact, answer->from);
    add_real(text, impact, answer->to);
    add_real(text, has_truth, to);
    mote_text_add(text, ",%u", answer->iterations);
}

static void add_row(mote_text *text, const mote_cell *cell, const mote_cell_row *row)
{
    const mote_answer *answer = &row->answer;
    const mote_truth *truth = cell->subject->truth; /* NULL: more than two bodies, or impacts */
    const double exact = truth ? truth->distance[row->frame - 1] : 0;
    const int contact = true_contact(cell, row);
    mote_text_add(text, "%u,%" PRIu64 ",%" PRIu64 ",%" PRIu64, row->frame, row->deform_ns,
                  row->update_ns, row->query_ns);
    add_real(text, answer->has_distance, answer->distance);
    add_real(text, answer->has_lower, answer->lower);
    add_real(text, truth != NULL, exact);
    add_real(text, truth && answer->has_distance,
             truth ? (answer->distance - exact) / cell->subject->scenario->length : 0);
    if (answer->has_contact)
        mote_text_add(text, ",%d", answer->contact ? 1 : 0);
    else
        mote_text_add(text, ",");
    if (contact >= 0)
        mote_text_add(text, ",%d", contact);
    else
        mote_text_add(text, ",");
    for (int side = 0; side < 2; ++side) {
        add_real(text, answer->has_witness, answer->witness[side].x);
        add_real(text, answer->has_witness, answer->witness[side].y);
        add_real(text, answer->has_witness, answer->witness[side].z);
    }
#define ADD_COUNTER(name) mote_text_add(text, ",%" PRIu64, answer->counters.name);
    MOTE_COUNTERS(ADD_COUNTER)
    mote_text_add(text, ",%" PRIu64, row->allocations);
    MOTE_COUNTERS_MORE(ADD_COUNTER)
#undef ADD_COUNTER
#define ADD_COLUMN(name) mote_text_add(text, ",%" PRIu64, row->scene.name);
    if (cell->subject->bodies) {
        MOTE_SCENE_COLUMNS(ADD_COLUMN)
    }
#undef ADD_COLUMN
    if (cell->step > 0)
        add_impact(text, cell, row);
    mote_text_add(text, "\n");
}

static mote_status record_rows(const mote_cell *cell, const mote_cell_result *result,
                               const char *directory)
{
    mote_text text = {0};
    mote_text_add(&text, "frame,deform_ns,update_ns,query_ns,distance,lower,truth,error,"
                         "contact,contact_truth,ax,ay,az,bx,by,bz");
#define ADD_NAME(name) mote_text_add(&text, "," #name);
    MOTE_COUNTERS(ADD_NAME)
    mote_text_add(&text, ",allocations");
    MOTE_COUNTERS_MORE(ADD_NAME)
    if (cell->subject->bodies) {
        MOTE_SCENE_COLUMNS(ADD_NAME)
    }
    if (cell->step > 0) {
        MOTE_IMPACT_COLUMNS(ADD_NAME)
    }
#undef ADD_NAME
    mote_text_add(&text, "\n");
    for (size_t i = 0; i < result->row_count; ++i)
        add_row(&text, cell, &result->rows[i]);
    char name[MOTE_CELL_ID_SIZE + 16];
    (void)snprintf(name, sizeof name, "cells/%s.csv", cell->id);
    return mote_record_text(directory, name, &text);
}

static json_t *bytes_json(bool counted, int64_t bytes)
{
    return counted ? json_integer(bytes) : json_null();
}

static mote_status record_json(const mote_cell *cell, json_t *object, const char *directory)
{
    char name[MOTE_CELL_ID_SIZE + 16];
    (void)snprintf(name, sizeof name, "cells/%s.json", cell->id);
    return mote_record_json(directory, name, object);
}

mote_status mote_cell_record(const mote_cell *cell, const mote_cell_result *result,
                             uint64_t program, const char *directory)
{
    mote_status status = record_rows(cell, result, directory);
    if (status != MOTE_OK)
        return status;
    json_t *object = cell_json(cell, MOTE_CELL_OK, program);
    json_t *more = json_pack(
        "{s:I, s:I, s:I, s:f, s:o*, s:o*, s:o*, s:I, s:i, s:[f,f], s:[f,f], s:f, s:f}", "rows",
        (json_int_t)result->row_count, "build_ns", (json_int_t)result->build_ns, "clock_ns",
        (json_int_t)result->clock_ns, "overhead_ns", result->overhead_ns, "heap_live_bytes",
        bytes_json(result->heap_counted, result->heap_live_bytes), "heap_peak_bytes",
        bytes_json(result->heap_counted, result->heap_peak_bytes), "deform_bytes",
        json_integer(result->deform_bytes), "rss_peak_bytes",
        (json_int_t)result->rss_peak_bytes, "core", result->core, "load", result->load[0],
        result->load[1], "clock_mhz", result->clock_mhz[0], result->clock_mhz[1],
        "wall_seconds", result->wall_seconds, "read_ns", result->read_ns);
    if (cell->subject->bodies)
        (void)json_object_set_new(more, "frames_wall_ns",
                                  json_integer((json_int_t)result->frames_wall_ns));
    (void)json_object_update(object, more);
    json_decref(more);
    return record_json(cell, object, directory);
}

mote_status mote_cell_record_failure(const mote_cell *cell, const mote_cell_failure *failure,
                                     uint64_t program, const char *directory)
{
    json_t *object = cell_json(cell, failure->status, program);
    if (json_object_set_new(object, "reason", json_string(failure->reason)) != 0) {
        json_decref(object);
        object = NULL;
    }
    if (failure->timeout_seconds > 0)
        (void)json_object_set_new(object, "timeout_seconds",
                                  json_real(failure->timeout_seconds));
    return record_json(cell, object, directory);
}
