#include "harness/race/bout.h"

#include "harness/base/memory.h"
#include "harness/base/options.h"
#include "harness/process/child.h"
#include "harness/race/paired.h"
#include "harness/race/protocol.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Approximate duration of a block (a pass may be shorter): long enough to refill the caches
   after the other process's turn (1 MiB from the last level: 0.2 ms), short compared with
   changes of the machine. */
#define BLOCK_NS 4e6
/* Passes over the frames continue for this long, both sides together ... (0.4 s of passes made
   the values of pairs of processes no more alike: docs/benchmarking.md) */
#define CELL_NS 0.1e9
/* ... within these bounds. */
#define PASSES_LEAST 3
#define PASSES_MOST 61

/* The state of a cell during measurement. */
typedef struct contest {
    mote_bout *bout;
    mote_bout_result *result;
    uint32_t first, frames;
    uint32_t block;                 /* frames in a block */
    double length;                  /* L */
    double *times[MOTE_RACE_SIDES]; /* [passes][frames] */
    uint64_t hash[MOTE_RACE_SIDES]; /* of the last block's answers */
    double spent[MOTE_RACE_SIDES];  /* ns, in the last pass */
    size_t turn;                    /* number of blocks so far */
    int leader;                     /* the side that began the last pair of blocks */
} contest;

mote_status mote_bout_start(const mote_bout_options *options, mote_bout *bout)
{
    mote_status status = MOTE_OK;
    *bout = (mote_bout){.options = *options};
    for (int side = 0; status == MOTE_OK && side < MOTE_RACE_SIDES; ++side)
        status = mote_racer_start(options->program[side], options->core, options->timeout,
                                  options->random, &bout->racer[side]);
    for (int side = 0; status == MOTE_OK && side < MOTE_RACE_SIDES; ++side)
        status = mote_racer_greet(&bout->racer[side]);
    return status;
}

void mote_bout_stop(mote_bout *bout)
{
    for (int side = 0; side < MOTE_RACE_SIDES; ++side)
        mote_racer_stop(&bout->racer[side]);
}

/* Records why a side cannot continue: it failed. A request to stop is passed on. */
static mote_status note(mote_status status, mote_race_side *side)
{
    if (status == MOTE_OK || mote_child_stop_asked())
        return status;
    side->failed = true;
    (void)snprintf(side->reason, sizeof side->reason, "%s", mote_error_text());
    return MOTE_OK;
}

/* The same of opening a cell, which a side may refuse. Of what it has opened, "no" is a
   failure. */
static mote_status note_opening(mote_status status, mote_race_side *side)
{
    const mote_status noted = note(status, side);
    side->refused = side->failed && status == MOTE_EUNSUPPORTED;
    side->failed = side->failed && !side->refused;
    return noted;
}

static bool is_over(const mote_bout_result *result)
{
    for (int side = 0; side < MOTE_RACE_SIDES; ++side) {
        if (result->side[side].refused || result->side[side].failed)
            return true;
    }
    return false;
}

/* The next field of an answer, terminated in place; NULL if there is none. */
static char *next_field(char **rest, char separator)
{
    char *field = *rest;
    char *end = field ? strchr(field, separator) : NULL;
    if (end)
        *end = '\0';
    *rest = end ? end + 1 : NULL;
    return field;
}

static mote_status unreadable(mote_racer *racer)
{
    const char *program = racer->program;
    mote_racer_stop(racer);
    return mote_fail(MOTE_EIO, "%s: an answer that cannot be read", program);
}

static mote_status ask_to_open(const contest *c, const mote_race_cell *cell, int side)
{
    return mote_racer_send(&c->bout->racer[side], "cell\t%s\t%u\t%u\t%s\t%" PRIu64 "\t%d\t%s",
                           cell->scenario, cell->first, cell->last,
                           mote_cache_names[cell->cache], cell->seed,
                           c->bout->options.check_scene, cell->method);
}

/* Reads "FACES ASK STEP TOLERANCE", which older programs do not send. */
static bool read_question(char *rest, mote_race_scene *scene)
{
    const char *fields[4], *faces;
    uint64_t step = 0;
    char *end = NULL;
    for (int k = 0; k < 4; ++k)
        fields[k] = next_field(&rest, '\t');
    faces = fields[0];
    if (!faces)
        return true;
    scene->faces = strtoull(faces, &end, 16);
    if (*end != '\0' || !fields[3] || strlen(fields[1]) >= sizeof scene->ask ||
        !mote_read_unsigned(fields[2], 0, UINT32_MAX, &step) ||
        !mote_read_real(fields[3], -HUGE_VAL, HUGE_VAL, &scene->tolerance))
        return false;
    (void)snprintf(scene->ask, sizeof scene->ask, "%s", fields[1]);
    scene->step = (uint32_t)step;
    return true;
}

/* Whether two sides have the same frames and faces, and are asked the same, as far as both
   say. */
static bool is_same_scene(const mote_race_scene *a, const mote_race_scene *b)
{
    if (a->fingerprint != b->fingerprint)
        return false;
    return !a->ask[0] || !b->ask[0] ||
           (a->faces == b->faces && strcmp(a->ask, b->ask) == 0 && a->step == b->step &&
            !(a->tolerance < b->tolerance) && !(a->tolerance > b->tolerance));
}

/* Waits until a side has opened the cell. */
static mote_status hear_opened(contest *c, const mote_race_cell *cell, int side,
                               mote_race_scene *scene)
{
    mote_racer *racer = &c->bout->racer[side];
    char *answer = NULL;
    uint64_t last = 0;
    const mote_status status = mote_racer_hear(racer, &answer);
    if (status != MOTE_OK)
        return status;
    const char *fingerprint = next_field(&answer, '\t'), *length = next_field(&answer, '\t');
    const char *frame = next_field(&answer, '\t');
    char *end = NULL;
    if (!frame || !mote_read_real(length, 0, HUGE_VAL, &c->length) ||
        !mote_read_unsigned(frame, cell->first, UINT32_MAX, &last))
        return unreadable(racer);
    scene->fingerprint = strtoull(fingerprint, &end, 16);
    if (*end != '\0' || !read_question(answer, scene))
        return unreadable(racer);
    ++c->bout->cells[side]; /* the racer has it, whatever is made of it here */
    const uint32_t frames = (uint32_t)last - cell->first + 1;
    if (c->frames > 0 && c->frames != frames)
        return mote_fail(MOTE_EUNSUPPORTED, "the scenario has another number of frames");
    c->first = cell->first;
    c->frames = frames;
    return MOTE_OK;
}

static bool same_name(const mote_race_count *count, const char *name)
{
    return strcmp(count->name, name) == 0;
}

/* Adds "name=sum" to a side. Counts that are 0 in every frame are not sent. */
static bool add_count(mote_bout_result *result, int side, char *text)
{
    char *value = strchr(text, '=');
    double sum;
    if (!value)
        return false;
    *value = '\0';
    if (!mote_read_real(value + 1, 0, HUGE_VAL, &sum) ||
        strlen(text) >= sizeof result->counts[0].name)
        return false;
    size_t i = 0;
    while (i < result->count_count && !same_name(&result->counts[i], text))
        ++i;
    if (i == MOTE_RACE_COUNTS)
        return false;
    mote_race_count *count = &result->counts[i];
    if (i == result->count_count) {
        *count = (mote_race_count){.sum = {0, 0}};
        (void)snprintf(count->name, sizeof count->name, "%s", text);
        ++result->count_count;
    }
    count->sum[side] += sum;
    return true;
}

static bool add_counts(mote_bout_result *result, int side, char *text)
{
    if (strcmp(text, "-") == 0)
        return true;
    for (char *rest = text, *count; (count = next_field(&rest, ','));) {
        if (!add_count(result, side, count))
            return false;
    }
    return true;
}

/* Reads the times of a block of `count` frames from `at` on; adds their sum to the time
   spent. */
static bool read_times(contest *c, int side, char *text, size_t at, uint32_t count)
{
    char *rest = text;
    for (uint32_t k = 0; k < count; ++k) {
        const char *field = next_field(&rest, ',');
        uint64_t ns;
        if (!field || !mote_read_unsigned(field, 0, UINT64_MAX, &ns))
            return false;
        c->spent[side] += (double)ns;
        c->times[side][at + k] = ns > 0 ? (double)ns : 1;
    }
    return rest == NULL;
}

/* One side's turn: `count` frames of a pass from `offset` on; counted: whether its counts are
   kept. */
static mote_status run_block(contest *c, int side, uint32_t pass, uint32_t offset,
                             uint32_t count, bool counted)
{
    mote_racer *racer = &c->bout->racer[side];
    char *answer = NULL, *end = NULL;
    mote_status status = mote_racer_ask(racer, &answer, "run\t%zu\t%u\t%u",
                                        c->bout->cells[side] - 1, c->first + offset, count);
    if (status != MOTE_OK)
        return status;
    const char *hash = next_field(&answer, '\t');
    char *counts = next_field(&answer, '\t'), *times = next_field(&answer, '\t');
    if (!times || !read_times(c, side, times, (size_t)pass * c->frames + offset, count) ||
        (counted && !add_counts(c->result, side, counts)))
        return unreadable(racer);
    c->hash[side] = strtoull(hash, &end, 16);
    return *end ? unreadable(racer) : MOTE_OK;
}

/* An answer as sent by a racer: "DISTANCE:CONTACT", or "DISTANCE:CONTACT:SET:VALUE:VALUE". */
typedef struct told {
    double distance; /* MOTE_NONE: none */
    char contact;    /* '0', '1', or '-' for none */
    bool more;       /* whether it has what follows */
    uint64_t set;
    double values[2]; /* MOTE_NONE: none */
} told;

/* Reads an answer; false if it is none. */
static bool read_told(const char *field, told *answer)
{
    char *end = NULL;
    *answer = (told){.distance = field ? strtod(field, &end) : MOTE_NONE};
    if (!field || end == field || *end != ':')
        return false;
    answer->contact = end[1];
    answer->more = end[1] && end[2] == ':';
    if (!answer->more)
        return true;
    answer->set = strtoull(end + 3, &end, 16);
    for (int k = 0; k < 2; ++k) {
        const char *value = end + 1;
        if (*end != ':')
            return false;
        answer->values[k] = strtod(value, &end);
        if (end == value)
            return false;
    }
    return *end == '\0';
}

/* Reads the answers of a side's last block. */
static mote_status ask_answers(contest *c, int side, told *answers, uint32_t count)
{
    mote_racer *racer = &c->bout->racer[side];
    char *answer = NULL;
    const mote_status status =
        mote_racer_ask(racer, &answer, "answers\t%zu", c->bout->cells[side] - 1);
    if (status != MOTE_OK)
        return status;
    for (uint32_t k = 0; k < count; ++k) {
        if (!read_told(next_field(&answer, ','), &answers[k]))
            return unreadable(racer);
    }
    return MOTE_OK;
}

/* The difference of two numbers; infinite if only one side gives one. */
static double difference(double a, double b)
{
    if ((a == a) != (b == b))
        return HUGE_VAL;
    return a == a ? fabs(a - b) : 0;
}

/* The difference in L, or of times of impact as a part of the question's; infinite if only one
   side gives a distance, or if they disagree about a contact. */
static double apart(const contest *c, const told *a, const told *b)
{
    if (a->contact != b->contact)
        return HUGE_VAL;
    double most = difference(a->distance, b->distance) / c->length;
    if (!a->more || !b->more)
        return most;
    for (int k = 0; k < 2; ++k)
        most = fmax(most, difference(a->values[k], b->values[k]));
    return a->set == b->set ? most : HUGE_VAL;
}

/* Finds by how much the answers of a block differ, once their bits do. */
static mote_status compare_answers(contest *c, uint32_t offset, uint32_t count)
{
    mote_bout_result *result = c->result;
    told *answers[MOTE_RACE_SIDES];
    mote_status status = MOTE_OK;
    for (int side = 0; side < MOTE_RACE_SIDES; ++side) {
        answers[side] = mote_allocate(count, sizeof *answers[side]);
        if (status == MOTE_OK)
            status = note(ask_answers(c, side, answers[side], count), &result->side[side]);
    }
    for (uint32_t k = 0; status == MOTE_OK && !is_over(result) && k < count; ++k) {
        const double now = apart(c, &answers[MOTE_RACE_A][k], &answers[MOTE_RACE_B][k]);
        if (now > result->worst) {
            result->worst = now;
            result->worst_frame = c->first + offset + k;
        }
    }
    free(answers[MOTE_RACE_A]);
    free(answers[MOTE_RACE_B]);
    return status;
}

/* Both sides' turns at a block, also where the first of them fails: the other may fail as well.
   The first side is drawn at random for every other block and reversed in between: ABBA or
   BAAB. */
static mote_status run_turns(contest *c, uint32_t pass, uint32_t offset, bool counted)
{
    const uint32_t left = c->frames - offset;
    const uint32_t count = left < c->block ? left : c->block;
    c->leader =
        c->turn++ % 2 == 0 ? (int)mote_random_below(c->bout->options.random, 2) : 1 - c->leader;
    for (int k = 0; k < MOTE_RACE_SIDES; ++k) {
        const int side = k == 0 ? c->leader : 1 - c->leader;
        const mote_status status =
            note(run_block(c, side, pass, offset, count, counted), &c->result->side[side]);
        if (status != MOTE_OK)
            return status;
    }
    if (is_over(c->result) || c->hash[0] == c->hash[1])
        return MOTE_OK;
    return compare_answers(c, offset, count);
}

static mote_status run_pass(contest *c, uint32_t pass, bool counted)
{
    mote_status status = MOTE_OK;
    c->spent[0] = c->spent[1] = 0;
    for (uint32_t offset = 0; status == MOTE_OK && !is_over(c->result) && offset < c->frames;
         offset += c->block)
        status = run_turns(c, pass, offset, counted);
    return status;
}

/* Sets the length of a block and the number of further passes, from the time of the first
   pass. */
static uint32_t plan_passes(contest *c)
{
    const double both = c->spent[0] + c->spent[1], frame = 0.5 * both / c->frames;
    const double block = ceil(BLOCK_NS / (frame > 1 ? frame : 1));
    const double passes = both > 1 ? floor(CELL_NS / both) : PASSES_MOST;
    c->block = block < c->block ? (uint32_t)block : c->block;
    return passes < PASSES_LEAST  ? PASSES_LEAST
           : passes > PASSES_MOST ? PASSES_MOST
                                  : (uint32_t)passes;
}

static void make_room(contest *c, uint32_t passes)
{
    for (int side = 0; side < MOTE_RACE_SIDES; ++side)
        c->times[side] =
            mote_resize(c->times[side], (size_t)passes * c->frames, sizeof *c->times[side]);
}

/* The first pass warms up and gives the counts; its times are not used. */
static mote_status run_passes(contest *c)
{
    mote_bout_result *result = c->result;
    const uint32_t most =
        c->frames < MOTE_RACE_BLOCK_FRAMES ? c->frames : MOTE_RACE_BLOCK_FRAMES;
    c->block = most;
    make_room(c, 1);
    mote_status status = run_pass(c, 0, true);
    if (status != MOTE_OK || is_over(result))
        return status;
    result->passes = plan_passes(c);
    make_room(c, result->passes);
    c->turn = 0;
    for (uint32_t pass = 0; status == MOTE_OK && !is_over(result) && pass < result->passes;
         ++pass)
        status = run_pass(c, pass, false);
    result->frames = c->frames;
    result->blocks = (uint32_t)c->turn;
    if (status != MOTE_OK || is_over(result))
        return status;
    const mote_bout_times times = {c->times[MOTE_RACE_A], c->times[MOTE_RACE_B], result->passes,
                                   c->frames};
    result->log_ratio = mote_bout_log_ratio(&times, result->total_ns);
    return MOTE_OK;
}

/* Opens the cell on both sides at once: while nothing is measured, they may use every core. A
   side that was asked must be heard. */
static mote_status open_cell(contest *c, const mote_race_cell *cell)
{
    mote_race_scene scene[MOTE_RACE_SIDES] = {{0}, {0}};
    mote_race_side *side = c->result->side;
    mote_status status = MOTE_OK;
    for (int k = 0; status == MOTE_OK && k < MOTE_RACE_SIDES; ++k)
        status = note_opening(ask_to_open(c, cell, k), &side[k]);
    for (int k = 0; status == MOTE_OK && k < MOTE_RACE_SIDES; ++k) {
        if (!side[k].failed)
            status = note_opening(hear_opened(c, cell, k, &scene[k]), &side[k]);
    }
    c->result->same_scene =
        is_over(c->result) || is_same_scene(&scene[MOTE_RACE_A], &scene[MOTE_RACE_B]);
    c->result->scene = scene[scene[MOTE_RACE_A].ask[0] ? MOTE_RACE_A : MOTE_RACE_B];
    return status;
}

mote_status mote_bout_run(mote_bout *bout, const mote_race_cell *cell, mote_bout_result *result)
{
    contest c = {.bout = bout, .result = result};
    *result = (mote_bout_result){0};
    mote_status status = open_cell(&c, cell);
    if (status != MOTE_OK || is_over(result) || !result->same_scene)
        return status;
    status = run_passes(&c);
    free(c.times[MOTE_RACE_A]);
    free(c.times[MOTE_RACE_B]);
    return status;
}
