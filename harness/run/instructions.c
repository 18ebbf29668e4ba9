#include "harness/run/instructions.h"

#include "harness/run/measure.h"
#include "harness/run/own_words.h"
#include "harness/base/record.h"
#include "harness/process/stop.h"
#include "harness/process/manifest.h"
#include "harness/process/spawn.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define FILE_LIMIT ((size_t)1 << 28)

bool mote_instructions_possible(void)
{
    static const char *const argv[] = {"valgrind", "--version", NULL};
    char text[64];
    return mote_spawn(argv, NULL, text, sizeof text) == MOTE_OK;
}

/* callgrind counts only one thread. */
static mote_status check_threads(const mote_method_choice *choice)
{
    if (choice->scene[MOTE_SCENE_THREADS] > 1 || choice->scene[MOTE_SCENE_AHEAD] > 0)
        return mote_fail(MOTE_EUNSUPPORTED,
                         "%s: instructions are counted in one thread; leave out threads= and "
                         "ahead=",
                         choice->text);
    return MOTE_OK;
}

/* The cell in which the method answers about these frames. */
static mote_cell cell_of(const mote_subject *subject, const mote_method_choice *choice,
                         uint32_t first, uint32_t last)
{
    const uint32_t step = mote_subject_step(subject);
    return (mote_cell){.subject = subject,
                       .choice = choice,
                       .replicate = 1,
                       .first = first,
                       .last = last,
                       .step = step,
                       .stride = step ? step : 1,
                       .seed = 1};
}

/* Sets how many questions there are within the frames. */
static mote_status check_frames(const char *scenario, const mote_subject *subject,
                                uint32_t first, uint32_t last, uint32_t *questions)
{
    const uint32_t frames = mote_subject_facts_of(subject).frames;
    const mote_cell cell = cell_of(subject, NULL, first, last);
    if (last > frames)
        return mote_fail(MOTE_EINVAL, "frames %u-%u: outside %s; it has frames 1-%u", first,
                         last, scenario, frames);
    *questions = mote_cell_rows(&cell);
    if (*questions == 0)
        return mote_fail(MOTE_EINVAL, "frames %u-%u: %s asks for impacts within %u frames",
                         first, last, scenario, cell.step);
    return MOTE_OK;
}

mote_status mote_instructions_run(const char *scenario, uint32_t first, uint32_t last,
                                  const mote_method_choice *choice)
{
    mote_subject subject = {0};
    uint32_t questions;
    mote_status status = check_threads(choice);
    if (status == MOTE_OK)
        status = mote_subject_open(scenario, &subject);
    if (status == MOTE_OK)
        status = check_frames(scenario, &subject, first, last, &questions);
    if (status == MOTE_OK) {
        const mote_cell cell = cell_of(&subject, choice, first, last);
        mote_cell_result result;
        status = mote_measure_cell(&cell, 0, &result);
        if (status == MOTE_OK)
            mote_cell_result_free(&result);
    }
    mote_subject_free(&subject);
    return status;
}

/* A count that was asked for. */
typedef struct request {
    const char *scenario; /* as on the command line */
    uint32_t first, last;
    const char *directory;
    mote_subject subject;
    uint32_t questions; /* within the frames */
} request;

/* Refuses a scenario, frames or a method before anything is written. */
static mote_status check_input(request *r, const mote_choices *choices)
{
    mote_status status = mote_subject_open(r->scenario, &r->subject);
    if (status == MOTE_OK)
        status = check_frames(r->scenario, &r->subject, r->first, r->last, &r->questions);
    for (size_t i = 0; i < choices->count && status == MOTE_OK; ++i)
        status = check_threads(&choices->items[i]);
    return status == MOTE_OK ? mote_subject_identify(&r->subject) : status;
}

/* The number after "totals:" in callgrind's output. */
static mote_status read_totals(const char *path, json_int_t *count)
{
    char *text = NULL;
    size_t size = 0;
    mote_status status = mote_file_read(path, FILE_LIMIT, &text, &size);
    const char *line = status == MOTE_OK ? strstr(text, "\ntotals:") : NULL;
    *count = line ? strtoll(line + strlen("\ntotals:"), NULL, 10) : 0;
    free(text);
    if (status == MOTE_OK && *count <= 0)
        status =
            mote_fail(MOTE_EIO, "%s: has no line of totals; is it written by callgrind?", path);
    return status;
}

/* Runs `mote instructions SCENARIO --frames A-B --method TEXT --inside` under callgrind. */
static mote_status count_one(const char *scenario, const char *frames, const char *method,
                             const char *directory, json_int_t *count)
{
    char program[512];
    ssize_t length = readlink("/proc/self/exe", program, sizeof program - 1);
    char *out = mote_format("%s/callgrind.%ld.out", directory, (long)getpid());
    char *option = mote_format("--callgrind-out-file=%s", out);
    mote_status status =
        length > 0 ? MOTE_OK
                   : mote_fail(MOTE_EIO, "the path of this program's own file is not known");
    if (status == MOTE_OK && !mote_child_stop_asked()) {
        program[length] = '\0';
        enum { BEFORE = 6, WORDS = 7 };
        const char *const words[WORDS] = {"instructions", scenario, "--frames", frames,
                                          "--method",     method,   "--inside"};
        const char *argv[BEFORE + WORDS + MOTE_OWN_WORDS_MAX + 1] = {
            "valgrind", "--tool=callgrind",         "--quiet",
            option,     "--toggle-collect=timed_*", program};
        argv[mote_own_words_add(words, WORDS, argv, BEFORE)] = NULL;
        status = mote_spawn(argv, NULL, NULL, 0);
    }
    if (mote_child_stop_asked())
        status = mote_child_stopped(directory);
    if (status == MOTE_OK)
        status = read_totals(out, count);
    (void)unlink(out);
    free(option);
    free(out);
    return status;
}

static bool same_row(const json_t *a, const json_t *b)
{
    static const char *const keys[] = {"scenario", "fingerprint", "faces",      "ask",
                                       "step",     "method",      "parameters", "frames"};
    for (size_t i = 0; i < sizeof keys / sizeof keys[0]; ++i) {
        if (!json_equal(json_object_get(a, keys[i]), json_object_get(b, keys[i])))
            return false;
    }
    return true;
}

/* Replaces the row with the same configuration, or appends this one; takes ownership. */
static void put_row(json_t *rows, json_t *row)
{
    for (size_t i = 0; i < json_array_size(rows); ++i) {
        if (same_row(json_array_get(rows, i), row)) {
            (void)json_array_set_new(rows, i, row);
            return;
        }
    }
    (void)json_array_append_new(rows, row);
}

/* The stored rows, which this program counted; an empty array if there are none. */
static json_t *read_rows(const char *directory, const char *program)
{
    json_t *object = NULL, *rows = NULL;
    if (mote_record_read_json(directory, "instructions.json", &object) == MOTE_OK &&
        strcmp(mote_text_at(object, "program"), program) == 0)
        rows = json_incref(json_object_get(object, "rows"));
    json_decref(object);
    if (json_is_array(rows))
        return rows;
    json_decref(rows);
    return json_array();
}

static json_t *row_json(const request *r, const mote_method_choice *choice, json_int_t count)
{
    char fingerprint[20], faces[20];
    (void)snprintf(fingerprint, sizeof fingerprint, "%016" PRIx64, r->subject.fingerprint);
    (void)snprintf(faces, sizeof faces, "%016" PRIx64, r->subject.faces);
    const mote_subject_facts facts = mote_subject_facts_of(&r->subject);
    return json_pack("{s:s, s:s, s:s, s:s, s:i, s:s, s:s, s:o, s:[i,i], s:I, s:f}", "scenario",
                     facts.name, "fingerprint", fingerprint, "faces", faces, "ask",
                     mote_ask_names[facts.ask], "step", (int)mote_subject_step(&r->subject),
                     "method", choice->method->name, "label", choice->text, "parameters",
                     mote_choice_json(choice, r->subject.bodies != NULL), "frames",
                     (int)r->first, (int)r->last, "instructions", count, "per_frame",
                     (double)count / r->questions);
}

/* Counts one method and writes the file with its row, so that a later failure loses nothing. */
static mote_status count_and_keep(const request *r, const mote_method_choice *choice,
                                  const char *program, json_t *rows)
{
    char frames[32];
    json_int_t count = 0;
    (void)snprintf(frames, sizeof frames, "%u-%u", r->first, r->last);
    const mote_status status =
        count_one(r->scenario, frames, choice->text, r->directory, &count);
    if (status != MOTE_OK)
        return status;
    (void)printf("%-40s %14.0f instructions a frame\n", choice->text,
                 (double)count / r->questions);
    (void)fflush(stdout);
    put_row(rows, row_json(r, choice, count));
    return mote_record_json(
        r->directory, "instructions.json",
        json_pack("{s:i, s:s, s:O}", "schema", 1, "program", program, "rows", rows));
}

mote_status mote_instructions_count(const char *scenario, uint32_t first, uint32_t last,
                                    const mote_choices *choices, const char *directory)
{
    request r = {.scenario = scenario, .first = first, .last = last, .directory = directory};
    char program[20] = "";
    uint64_t hash = 0;
    mote_status status = check_input(&r, choices);
    if (status == MOTE_OK)
        status = mote_program_hash(&hash);
    if (status == MOTE_OK)
        status = mote_directory_make(directory);
    mote_child_heed_signals(); /* callgrind's file must not outlive this process */
    (void)snprintf(program, sizeof program, "%016" PRIx64, hash);
    json_t *rows = status == MOTE_OK ? read_rows(directory, program) : NULL;
    for (size_t i = 0; i < choices->count && status == MOTE_OK; ++i)
        status = count_and_keep(&r, &choices->items[i], program, rows);
    json_decref(rows);
    mote_subject_free(&r.subject);
    return status;
}
