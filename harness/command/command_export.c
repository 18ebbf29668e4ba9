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
#include "harness/run/subject.h"

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

/* A method that keeps state is given all earlier frames, as in a run; others only this one.
 *answer is set for two bodies; answers for more are in the engine. */
static mote_status ask_frames(const mote_subject *subject, mote_engine *engine,
                              const mote_method_choice *choice, uint32_t last,
                              mote_answer *answer)
{
    mote_subject_frame frame = mote_subject_frame_create(subject, 0);
    mote_status status = MOTE_OK;
    const uint32_t first =
        mote_method_traits(choice->method, choice->values).keeps_state ? 1 : last;
    for (uint32_t k = first; k <= last && status == MOTE_OK; ++k) {
        mote_engine_cost cost;
        status = mote_subject_frame_set(subject, k, k == first ? 0 : k - 1, &frame);
        if (status != MOTE_OK)
            break;
        if (subject->bodies) {
            mote_engine_show(engine, frame.states);
            status = mote_engine_ask(engine, &cost);
        } else {
            const mote_frame two = {.number = k, .body = {frame.states[0], frame.states[1]}};
            status = mote_engine_answer(engine, &two, answer);
        }
    }
    mote_subject_frame_free(&frame);
    return status;
}

/* {"near_pairs": [{"bodies": [1, 7], "distance": ...}, ...]} */
static json_t *pairs_json(const mote_engine *engine)
{
    size_t count;
    const mote_near_pair *pairs = mote_engine_pairs(engine, &count);
    json_t *rows = json_array();
    for (size_t k = 0; k < count; ++k) {
        json_t *row = json_pack("{s:[I,I]}", "bodies", (json_int_t)pairs[k].body[0] + 1,
                                (json_int_t)pairs[k].body[1] + 1);
        json_t *answer = mote_answer_json(&pairs[k].answer);
        (void)json_object_update(row, answer);
        json_decref(answer);
        (void)json_array_append_new(rows, row);
    }
    return json_pack("{s:o}", "near_pairs", rows);
}

static mote_status ask_method(const mote_subject *subject, const mote_method_choice *choice,
                              mote_ask ask, uint32_t frame, json_t **row)
{
    mote_engine *engine = NULL;
    mote_engine_setup setup = mote_subject_engine(subject);
    mote_answer answer = {0};
    setup.ask = ask;
    setup.seed = 1;
    mote_status status = mote_engine_create(&setup, choice, &engine);
    if (status == MOTE_OK)
        status = mote_engine_build(engine);
    if (status == MOTE_OK)
        status = ask_frames(subject, engine, choice, frame, &answer);
    if (status == MOTE_OK)
        *row = subject->bodies ? pairs_json(engine) : mote_answer_json(&answer);
    mote_engine_destroy(engine);
    return status;
}

/* Adds one method's row: its distance; its contact if it gives no distance; or why it cannot
   answer. */
static mote_status add_answer(const mote_subject *subject, const mote_method_choice *choice,
                              uint32_t frame, json_t *answers)
{
    json_t *row = NULL;
    mote_status status = ask_method(subject, choice, MOTE_ASK_DISTANCE, frame, &row);
    if (status == MOTE_EUNSUPPORTED)
        status = ask_method(subject, choice, MOTE_ASK_CONTACT, frame, &row);
    if (status == MOTE_EUNSUPPORTED)
        row = json_pack("{s:s}", "unsupported", mote_error_text());
    else if (status != MOTE_OK)
        return mote_fail(status, "%s: %s", choice->text, mote_error_text());
    (void)json_object_set_new(answers, choice->text, row);
    return MOTE_OK;
}

static mote_status find_answers(const mote_subject *subject, const request *wish,
                                mote_text *text)
{
    json_t *answers = json_object();
    mote_status status = MOTE_OK;
    for (size_t i = 0; i < wish->count && status == MOTE_OK; ++i)
        status = add_answer(subject, &wish->choices[i], (uint32_t)wish->frame, answers);
    if (status == MOTE_OK)
        mote_json_print(answers, DIGITS, text);
    json_decref(answers);
    return status;
}

/* "DIR/A.obj" and "DIR/B.obj" for two bodies, "DIR/body-7.obj" for more; the caller frees
   it. */
static char *mesh_path(const char *directory, uint32_t count, uint32_t body)
{
    if (count == 2)
        return mote_format("%s/%c.obj", directory, "AB"[body]);
    return mote_format("%s/body-%u.obj", directory, body + 1);
}

static mote_status write_mesh(const mote_body *body, const mote_body_state *state,
                              const char *path)
{
    mote_deform *deform = NULL;
    mote_vec3 *world = mote_allocate(body->mesh->vertex_count, sizeof *world);
    mote_status status = mote_deform_create(body, &deform);
    if (status == MOTE_OK) {
        mote_deform_all(deform, state, world);
        status = mote_obj_write(path, world, body->mesh);
    }
    mote_deform_destroy(deform);
    free(world);
    return status;
}

static mote_status write_meshes(const mote_subject *subject, const request *wish)
{
    const mote_engine_setup setup = mote_subject_engine(subject);
    mote_subject_frame frame = mote_subject_frame_create(subject, 0);
    mote_status status = mote_subject_frame_set(subject, (uint32_t)wish->frame, 0, &frame);
    for (uint32_t i = 0; i < setup.count && status == MOTE_OK; ++i) {
        char *path = mesh_path(wish->directory, setup.count, i);
        status = write_mesh(setup.shapes[setup.shape_of[i]], &frame.states[i], path);
        free(path);
    }
    mote_subject_frame_free(&frame);
    return status;
}

static mote_status export_frame(const mote_subject *subject, const request *wish)
{
    const mote_subject_facts facts = mote_subject_facts_of(subject);
    if (wish->frame > facts.frames)
        return mote_fail(MOTE_EINVAL, "--frame %llu: %s has frames 1-%u; name one of them",
                         (unsigned long long)wish->frame, facts.name, facts.frames);
    mote_text text = {0};
    char *path = mote_format("%s/answers.json", wish->directory);
    /* All answers are computed before the first file is written. */
    mote_status status = find_answers(subject, wish, &text);
    if (status == MOTE_OK)
        status = mote_directory_make(wish->directory);
    if (status == MOTE_OK)
        status = write_meshes(subject, wish);
    if (status == MOTE_OK)
        status = mote_file_write(path, text.data, text.size);
    free(text.data);
    free(path);
    return status;
}

static int export_request(const request *wish)
{
    mote_subject subject = {0};
    mote_status status = mote_subject_open(wish->scenario, &subject);
    if (status == MOTE_OK)
        status = export_frame(&subject, wish);
    const uint32_t count = status == MOTE_OK ? mote_subject_facts_of(&subject).bodies : 0;
    mote_subject_free(&subject);
    if (status != MOTE_OK)
        return mote_command_fail();
    char *meshes = count == 2 ? mote_duplicate("A.obj, B.obj")
                              : mote_format("body-1.obj to body-%u.obj", count);
    (void)printf("%s/%s, answers.json: frame %llu of %s\n", wish->directory, meshes,
                 (unsigned long long)wish->frame, wish->scenario);
    free(meshes);
    return mote_command_finish(MOTE_EXIT_DONE);
}

const mote_option mote_options_export[] = {
    {"frame", "K", "the frame, counted from 1; no default"},
    {"out", "DIR",
     "where A.obj, B.obj (of more than two bodies body-1.obj and so on) and answers.json go; "
     "no "
     "default"},
    {"method", "NAME[:key=value,...]",
     "a method to ask; may be given up to 64 times (default: fcl-aabb)"},
    {NULL, NULL, NULL}};

/* Reads the command line into wish; MOTE_EXIT_DONE if it is complete. */
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
            return mote_command_usage("export", "--frame %s: give a whole number from 1 to %u",
                                      value, UINT32_MAX);
        else if (option == 1)
            wish->directory = value;
        else if (option == 2 && wish->count == METHODS_MAX)
            return mote_command_usage("export", "at most %d methods", METHODS_MAX);
        else if (option == 2 &&
                 mote_scene_choice_read(value, &wish->choices[wish->count++]) != MOTE_OK)
            return mote_command_fail();
    }
    if (!wish->scenario || !wish->directory || wish->frame == 0)
        return mote_command_usage("export", "something is missing; write `mote export SCENARIO "
                                            "--frame K --out DIR`");
    if (wish->count == 0)
        wish->count = mote_method_choice_read("fcl-aabb", wish->choices) == MOTE_OK;
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
