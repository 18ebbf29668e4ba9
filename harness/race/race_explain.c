#include "harness/race/race_explain.h"

#include "harness/base/record.h"
#include "harness/process/spawn.h"
#include "harness/run/own_words.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Number of frames for which instructions are counted. */
#define INSTRUCTION_FRAMES 20
/* Instructions are equal within this share: a few branches depend on addresses. */
#define INSTRUCTIONS_SHARE 0.002

/* The number in FOLDER/instructions.json. */
static mote_status read_count(const char *folder, double *per_frame)
{
    json_t *counted = NULL;
    mote_status status = mote_record_read_json(folder, "instructions.json", &counted);
    const json_t *rows = json_object_get(counted, "rows");
    const json_t *value = json_object_get(json_array_get(rows, 0), "per_frame");
    if (status == MOTE_OK && json_is_number(value))
        *per_frame = json_number_value(value);
    else if (status == MOTE_OK)
        status = mote_fail(MOTE_EINVAL, "%s/instructions.json: has no count", folder);
    json_decref(counted);
    return status;
}

/* Counts the instructions per frame of one program. The last frame is that in which the last
   question ends. */
static mote_status count_one(const char *program, const mote_race_row *row, const char *folder,
                             double *per_frame)
{
    const uint32_t asked = row->frames < INSTRUCTION_FRAMES ? row->frames : INSTRUCTION_FRAMES;
    char *frames =
        mote_format("%u-%u", row->cell->first, row->cell->first + asked - 1 + row->scene.step);
    enum { WORDS = 8 };
    const char *const words[WORDS] = {"instructions", row->cell->scenario, "--frames", frames,
                                      "--method",     row->cell->method,   "--out",    folder};
    const char *argv[1 + WORDS + MOTE_OWN_WORDS_MAX + 1] = {program};
    argv[mote_own_words_add(words, WORDS, argv, 1)] = NULL;
    mote_status status = mote_spawn_quiet(argv, NULL);
    if (status == MOTE_OK)
        status = read_count(folder, per_frame);
    free(frames);
    char *file = mote_format("%s/instructions.json", folder);
    (void)unlink(file);
    free(file);
    return status;
}

/* Counts those of both programs, or keeps why that cannot be. */
static void count_row(const mote_race_options *options, mote_race_row *row, const char *folder)
{
    for (int side = 0; side < MOTE_RACE_SIDES; ++side) {
        const char *program = options->builds[side]->path[0];
        if (count_one(program, row, folder, &row->instructions[side]) != MOTE_OK &&
            !row->uncounted)
            row->uncounted = mote_format("%s: %s", side ? "B" : "A", mote_error_text());
    }
}

static const char *temporary(void)
{
    const char *folder = getenv("TMPDIR");
    return folder && folder[0] ? folder : "/tmp";
}

void mote_race_count_instructions(const mote_race_options *options, mote_race *race)
{
    char *folder = mote_format("%s/mote-race-XXXXXX", temporary());
    const bool made = mkdtemp(folder) != NULL;
    const int error = errno;
    for (size_t i = 0; i < race->count; ++i) {
        mote_race_row *row = &race->rows[i];
        if (row->verdict != MOTE_VERDICT_FASTER && row->verdict != MOTE_VERDICT_SLOWER)
            continue;
        if (made)
            count_row(options, row, folder);
        else
            row->uncounted = mote_format("no folder in %s: %s; TMPDIR may name another",
                                         temporary(), strerror(error));
    }
    if (made)
        (void)rmdir(folder);
    free(folder);
}

static void say_change(mote_text *text, const char *name, double a, double b)
{
    const char *separator = text->size ? "; " : "";
    if (a > 0)
        mote_text_add(text, "%s%s %.6g to %.6g (%+.2g %%)", separator, name, a, b,
                      100 * (b / a - 1));
    else
        mote_text_add(text, "%s%s %.6g to %.6g", separator, name, a, b);
}

static void say_answers(mote_text *text, const mote_race_row *row)
{
    const char *unit = strcmp(row->scene.ask, "impact") == 0 ? "of the question's time" : "L";
    if (row->worst > MOTE_RACE_EXACT && isfinite(row->worst))
        mote_text_add(text, "answers differ by up to %.2g %s, at frame %u", row->worst, unit,
                      row->worst_frame);
    else if (row->worst > MOTE_RACE_EXACT)
        mote_text_add(text, "answers differ: contact or none, at frame %u", row->worst_frame);
    else if (row->worst > 0)
        mote_text_add(text, "answers differ by rounding (%.2g %s)", row->worst, unit);
}

/* Says why the time changed, as far as counts and instructions show it. */
static void say_cause(mote_text *text, const mote_race_row *row)
{
    const double a = row->instructions[MOTE_RACE_A], b = row->instructions[MOTE_RACE_B];
    const char *separator = text->size ? "; " : "";
    const bool known = a > 0 && b > 0;
    if (row->verdict != MOTE_VERDICT_FASTER && row->verdict != MOTE_VERDICT_SLOWER)
        return;
    if (known && fabs(b / a - 1) > INSTRUCTIONS_SHARE)
        mote_text_add(text, "%sinstructions %.6g to %.6g (%+.2g %%), time for each %+.2g %%",
                      separator, a, b, 100 * (b / a - 1), 100 * (row->ratio * a / b - 1));
    else if (known)
        mote_text_add(text,
                      "%stime for the same instructions changed: memory, the layout of code, "
                      "or the clock",
                      separator);
    else
        mote_text_add(text, "%s%s", separator,
                      row->counted ? "the time changed with the counts"
                                   : "counts are the same: time for each of them changed");
    if (row->uncounted)
        mote_text_add(text, "; instructions are not known: %s", row->uncounted);
}

void mote_race_explain(mote_race *race)
{
    for (size_t i = 0; i < race->count; ++i) {
        mote_race_row *row = &race->rows[i];
        mote_text text = {0};
        say_answers(&text, row);
        for (size_t k = 0; k < row->count_count; ++k) {
            const mote_race_count *count = &row->counts[k];
            if (fabs(count->sum[0] - count->sum[1]) > 0.5)
                say_change(&text, count->name, count->sum[0], count->sum[1]);
        }
        say_cause(&text, row);
        mote_text_add(&text, "%s%s", text.size && row->reason[0] ? "; " : "", row->reason);
        free(row->what);
        row->what = text.data;
    }
}
