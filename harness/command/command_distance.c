/* mote distance A.obj B.obj [--method ...] [--json] [--strict]: one query on two files, without
   moving them. */
#include "harness/base/memory.h"
#include "harness/command/answer_json.h"
#include "harness/command/command.h"
#include "harness/base/method_choice.h"
#include "harness/base/options.h"
#include "harness/mesh/mesh_import.h"
#include "harness/engine/engine.h"
#include "harness/base/record.h"

#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>

#define METHODS_MAX 64

typedef struct request {
    const char *path[2];
    mote_method_choice *choices; /* [count] */
    size_t count;
    bool json;
} request;

typedef struct pair {
    mote_mesh *mesh[2];
    mote_import import[2];
    mote_field *still;
    mote_body body[2];
} pair;

static mote_status ask(const pair *bodies, const mote_method_choice *choice,
                       mote_answer *answer)
{
    static const mote_mat3 identity = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    mote_body_state state = {
        .pose = {identity, {0, 0, 0}}, .shape_changed = true, .pose_changed = true};
    const mote_frame frame = {1, {state, state}};
    mote_engine *engine = NULL;
    mote_status status = mote_engine_open_two(&bodies->body[0], &bodies->body[1], choice,
                                              MOTE_ASK_DISTANCE, 0, 1, &engine);
    if (status == MOTE_EUNSUPPORTED)
        status = mote_engine_open_two(&bodies->body[0], &bodies->body[1], choice,
                                      MOTE_ASK_CONTACT, 0, 1, &engine);
    if (status == MOTE_OK)
        status = mote_engine_answer(engine, &frame, answer);
    mote_engine_destroy(engine);
    return status;
}

static void print_answer(const mote_method_choice *choice, const mote_answer *answer)
{
    (void)printf("%s:", choice->text);
    if (answer->has_distance)
        (void)printf(" distance %.17g", answer->distance);
    if (answer->has_lower)
        (void)printf(", at least %.17g", answer->lower);
    if (answer->has_contact)
        (void)printf("%s%s", answer->has_distance ? ", " : " ",
                     answer->contact ? "contact" : "no contact");
    if (answer->has_witness)
        (void)printf(", at (%.9g, %.9g, %.9g) and (%.9g, %.9g, %.9g)", answer->witness[0].x,
                     answer->witness[0].y, answer->witness[0].z, answer->witness[1].x,
                     answer->witness[1].y, answer->witness[1].z);
    (void)printf("\n");
}

static mote_status answer_all(const request *wish, const pair *bodies, json_t *answers)
{
    for (size_t i = 0; i < wish->count; ++i) {
        const mote_method_choice *choice = &wish->choices[i];
        mote_answer answer = {0};
        mote_status status = ask(bodies, choice, &answer);
        if (status == MOTE_EUNSUPPORTED) {
            if (wish->json)
                (void)json_object_set_new(answers, choice->text,
                                          json_pack("{s:s}", "unsupported", mote_error_text()));
            else
                (void)printf("%s: unsupported: %s\n", choice->text, mote_error_text());
            continue;
        }
        if (status != MOTE_OK)
            return mote_fail(status, "%s: %s", choice->text, mote_error_text());
        if (wish->json)
            (void)json_object_set_new(answers, choice->text, mote_answer_json(&answer));
        else
            print_answer(choice, &answer);
    }
    return MOTE_OK;
}

static mote_status read_pair(const request *wish, pair *bodies)
{
    mote_status status = mote_field_create_static(&bodies->still);
    for (int i = 0; i < 2 && status == MOTE_OK; ++i) {
        status = mote_mesh_import(wish->path[i], &bodies->mesh[i], &bodies->import[i]);
        if (status == MOTE_OK)
            mote_import_tell_split(wish->path[i], &bodies->import[i]);
        bodies->body[i] = (mote_body){.mesh = bodies->mesh[i], .field = bodies->still};
    }
    return status;
}

static int distance(const request *wish)
{
    pair bodies = {0};
    json_t *answers = json_object();
    mote_status status = read_pair(wish, &bodies);
    if (status == MOTE_OK)
        status = answer_all(wish, &bodies, answers);
    if (status == MOTE_OK && wish->json) {
        (void)json_object_set_new(
            answers, "coordinates",
            json_string(bodies.import[0].single_precision || bodies.import[1].single_precision
                            ? "float"
                            : "double"));
        status = mote_json_put(json_incref(answers), JSON_INDENT(2) | JSON_REAL_PRECISION(17),
                               stdout);
    } else if (status == MOTE_OK) {
        for (int i = 0; i < 2; ++i) {
            if (bodies.import[i].single_precision)
                (void)printf("%s was read in 32-bit floats\n", wish->path[i]);
        }
    }
    json_decref(answers);
    mote_mesh_destroy(bodies.mesh[0]);
    mote_mesh_destroy(bodies.mesh[1]);
    mote_field_destroy(bodies.still);
    return status == MOTE_OK ? mote_command_finish(MOTE_EXIT_DONE) : mote_command_fail();
}

const mote_option mote_options_distance[] = {
    {"method", "NAME[:key=value,...]",
     "a method to ask; may be given up to 64 times (default: fcl-aabb)"},
    {"json", NULL, "as JSON (default: as text)"},
    {"strict", NULL, "refuse edges of more than two faces (default: cut them apart)"},
    {NULL, NULL, NULL}};

static int read_request(int argc, char **argv, request *wish)
{
    mote_option_reader reader = mote_option_begin(mote_options_distance, argc, argv);
    const char *value;
    for (int option; (option = mote_option_next(&reader, &value)) != MOTE_OPTION_END;) {
        if (option == MOTE_OPTION_ERROR)
            return MOTE_EXIT_USAGE;
        if (option == 1)
            wish->json = true;
        else if (option == 2)
            mote_mesh_import_strictly();
        else if (option == 0 && wish->count == METHODS_MAX)
            return mote_command_usage("distance", "at most %d methods", METHODS_MAX);
        else if (option == 0) {
            if (mote_method_choice_read(value, &wish->choices[wish->count++]) != MOTE_OK)
                return mote_command_fail();
        } else if (wish->path[1])
            return mote_command_usage("distance", "%s: two files at a time", value);
        else
            wish->path[wish->path[0] ? 1 : 0] = value;
    }
    if (!wish->path[1])
        return mote_command_usage("distance",
                                  "two files are needed; write `mote distance A.obj "
                                  "B.obj`");
    if (wish->count == 0)
        wish->count = mote_method_choice_read("fcl-aabb", wish->choices) == MOTE_OK;
    return MOTE_EXIT_DONE;
}

int mote_command_distance(int argc, char **argv)
{
    request wish = {.choices = mote_allocate(METHODS_MAX, sizeof *wish.choices)};
    int code = read_request(argc, argv, &wish);
    if (code == MOTE_EXIT_DONE)
        code = distance(&wish);
    free(wish.choices);
    return code;
}
