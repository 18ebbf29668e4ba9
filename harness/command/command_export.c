/* mote export SCENARIO --frame K --out DIR [--method ...]: a frame for other programs. */
#include "core/body/deform.h"
#include "datasets/obj_write.h"
#include "harness/command/answer_json.h"
#include "harness/command/command.h"
#include "harness/base/method_choice.h"
#include "harness/base/options.h"
#include "harness/base/file.h"
#include "harness/base/json_print.h"
#include "harness/base/memory.h"
#include "harness/engine/engine.h"
#include "harness/scene/scenario.h"

#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>

#define METHODS_MAX 64
#define DIGITS 17

typedef struct request {
    const char *scenario, *directory;
    uint64_t frame;
    mote_method_choice *choices; /* [count] */
    size_t count;
} request;

/* A method that keeps state is given the frames before, as in a run; the others only this
   one. */
static mote_status answer_frame(const mote_scenario *scenario, mote_engine *probe,
                                const mote_method_choice *choice, uint32_t last,
                                mote_answer *answer)
{
    mote_frame_buffer *buffer = mote_frame_buffer_create(scenario);
    mote_status status = MOTE_OK;
    const uint32_t first =
        mote_method_traits(choice->method, choice->values).keeps_state ? 1 : last;
    for (uint32_t k = first; k <= last && status == MOTE_OK; ++k) {
        const mote_frame *frame =
            mote_scenario_frame(scenario, buffer, k, k == first ? 0 : k - 1);
        status = mote_engine_answer(probe, frame, answer);
    }
    mote_frame_buffer_destroy(buffer);
    return status;
}

static mote_status ask_method(const mote_scenario *scenario, const mote_method_choice *choice,
                              mote_ask ask, uint32_t frame, mote_answer *answer)
{
    mote_engine *probe = NULL;
    mote_status status = mote_engine_open_two(&scenario->body[0], &scenario->body[1], choice,
                                              ask, scenario->tolerance, 1, &probe);
    if (status == MOTE_OK)
        status = answer_frame(scenario, probe, choice, frame, answer);
    mote_engine_destroy(probe);
    return status;
}

/* One method's row: its distance, or its contact where it gives no distance, or why it
   cannot answer. */
static mote_status add_answer(const mote_scenario *scenario, const mote_method_choice *choice,
                              uint32_t frame, json_t *answers)
{
    mote_answer answer = {0};
    mote_status status = ask_method(scenario, choice, MOTE_ASK_DISTANCE, frame, &answer);
    if (status == MOTE_EUNSUPPORTED)
        status = ask_method(scenario, choice, MOTE_ASK_CONTACT, frame, &answer);
    json_t *row = NULL;
    if (status == MOTE_OK)
        row = mote_answer_json(&answer);
    else if (status == MOTE_EUNSUPPORTED)
        row = json_pack("{s:s}", "unsupported", mote_error_text());
    else
        return mote_fail(status, "%s: %s", choice->text, mote_error_text());
    (void)json_object_set_new(answers, choice->text, row);
    return MOTE_OK;
}

static mote_status find_answers(const mote_scenario *scenario, const request *wish,
                                mote_text *text)
{
    json_t *answers = json_object();
    mote_status status = MOTE_OK;
    for (size_t i = 0; i < wish->count && status == MOTE_OK; ++i)
        status = add_answer(scenario, &wish->choices[i], (uint32_t)wish->frame, answers);
    if (status == MOTE_OK)
        mote_json_print(answers, DIGITS, text);
    json_decref(answers);
    return status;
}

static mote_status write_mesh(const mote_body *body, const mote_body_state *state,
                              const char *directory, char name)
{
    mote_deform *deform = NULL;
    char *path = mote_format("%s/%c.obj", directory, name);
    mote_vec3 *world = mote_allocate(body->mesh->vertex_count, sizeof *world);
    mote_status status = mote_deform_create(body, &deform);
    if (status == MOTE_OK) {
        mote_deform_all(deform, state, world);
        status = mote_obj_write(path, world, body->mesh);
    }
    mote_deform_destroy(deform);
    free(world);
    free(path);
    return status;
}

static mote_status export_frame(const mote_scenario *scenario, const request *wish)
{
    if (wish->frame > scenario->frames)
        return mote_fail(MOTE_EINVAL, "--frame %llu: %s has frames 1-%u; name one of them",
                         (unsigned long long)wish->frame, scenario->name, scenario->frames);
    mote_frame_buffer *buffer = mote_frame_buffer_create(scenario);
    mote_text text = {0};
    char *path = mote_format("%s/answers.json", wish->directory);
    /* All answers are computed before the first file is written. */
    mote_status status = find_answers(scenario, wish, &text);
    if (status == MOTE_OK)
        status = mote_directory_make(wish->directory);
    if (status == MOTE_OK) {
        const mote_frame *frame =
            mote_scenario_frame(scenario, buffer, (uint32_t)wish->frame, 0);
        for (int i = 0; i < 2 && status == MOTE_OK; ++i)
            status = write_mesh(&scenario->body[i], &frame->body[i], wish->directory, "AB"[i]);
    }
    if (status == MOTE_OK)
        status = mote_file_write(path, text.data, text.size);
    mote_frame_buffer_destroy(buffer);
    free(text.data);
    free(path);
    return status;
}

static int export_request(const request *wish)
{
    mote_scenario *scenario;
    if (mote_scenario_load(wish->scenario, &scenario) != MOTE_OK)
        return mote_command_fail();
    mote_status status = export_frame(scenario, wish);
    mote_scenario_destroy(scenario);
    if (status != MOTE_OK)
        return mote_command_fail();
    (void)printf("%s/A.obj, B.obj, answers.json: frame %llu of %s\n", wish->directory,
                 (unsigned long long)wish->frame, wish->scenario);
    return mote_command_finish(MOTE_EXIT_DONE);
}

const mote_option mote_options_export[] = {
    {"frame", "K", "the frame, counted from 1; no default"},
    {"out", "DIR", "where A.obj, B.obj and answers.json go; no default"},
    {"method", "NAME[:key=value,...]",
     "a method to ask; may be given up to 64 times (default: fcl-aabb)"},
    {NULL, NULL, NULL}};

/* Reads the command line into wish; MOTE_EXIT_DONE when it is complete. */
static int read_request(int argc, char **argv, request *wish)
{
    mote_option_reader reader = mote_option_begin(mote_options_export, argc, argv);
    const char *value;
    for (int option; (option = mote_option_next(&reader, &value)) != MOTE_OPTION_END;) {
        if (option == MOTE_OPTION_ERROR)
            return MOTE_EXIT_USAGE;
        if (option == MOTE_OPTION_PLAIN && wish->scenario)
            return mote_command_usage("export", "%s: one scenario at a time", value);
        if (option == MOTE_OPTION_PLAIN)
            wish->scenario = value;
        else if (option == 0 && !mote_read_unsigned(value, 1, UINT32_MAX, &wish->frame))
            return mote_command_usage("export", "--frame %s: give a number from 1", value);
        else if (option == 1)
            wish->directory = value;
        else if (option == 2 && wish->count == METHODS_MAX)
            return mote_command_usage("export", "at most %d methods", METHODS_MAX);
        else if (option == 2 &&
                 mote_method_choice_read(value, &wish->choices[wish->count++]) != MOTE_OK)
            return mote_command_fail();
    }
    if (!wish->scenario || !wish->directory || wish->frame == 0)
        return mote_command_usage("export", "something is missing; write `mote export SCENARIO "
                                            "--frame K --out DIR`");
    if (wish->count == 0 && mote_method_choice_read("fcl-aabb", wish->choices) == MOTE_OK)
        wish->count = 1;
    return MOTE_EXIT_DONE;
}

int mote_command_export(int argc, char **argv)
{
    request wish = {.choices = mote_allocate(METHODS_MAX, sizeof *wish.choices)};
    int code = read_request(argc, argv, &wish);
    if (code == MOTE_EXIT_DONE)
        code = export_request(&wish);
    free(wish.choices);
    return code;
}
