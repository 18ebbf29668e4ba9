#include "harness/race/race_child.h"

#include "harness/base/hash.h"
#include "harness/base/memory.h"
#include "harness/base/options.h"
#include "harness/base/statistics.h"
#include "harness/base/file.h"
#include "harness/process/child.h"
#include "harness/race/protocol.h"
#include "harness/run/cell_process.h"
#include "harness/run/measure.h"

#include <inttypes.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <unistd.h>

/* The largest offset of a stack or a heap, in bytes. */
#define OFFSET_MAX ((uint64_t)1 << 20)
/* Stack bytes per recursion step. */
#define STEP_BYTES 64

typedef struct scene {
    char *name;
    mote_subject subject;
} scene;

/* The answers of a frame. */
typedef struct told {
    mote_answer answer;
    uint64_t contacts; /* of more than two bodies: a hash of the pairs in contact */
    double values[2];  /* of an impact: from and to; of more than two bodies: see sum_near */
} told;

/* A built cell, with the answers of the frames that it ran last. */
typedef struct entrant {
    mote_cell cell;
    mote_method_choice choice;
    mote_measurement *measurement;
    uint32_t previous;
    told answers[MOTE_RACE_BLOCK_FRAMES];
    uint32_t count;
} entrant;

typedef struct server {
    scene scenes[MOTE_RACE_CELLS];
    size_t scene_count;
    entrant *entrants[MOTE_RACE_CELLS];
    size_t entrant_count;
    int core; /* to be pinned to before frames are measured; -1: none, or done */
    mote_text reply;
} server;

/* Splits a line in place at its tabs; returns the number of fields. */
static size_t split(char *line, char **fields, size_t most)
{
    size_t count = 0;
    for (char *field = line; field; ++count) {
        char *tab = strchr(field, '\t');
        if (tab)
            *tab = '\0';
        if (count < most)
            fields[count] = field;
        field = tab ? tab + 1 : NULL;
    }
    return count;
}

/* Loads a scenario once, without its fingerprint, which takes longer than everything else. */
static mote_status find_scene(server *s, const char *name, scene **found)
{
    for (size_t i = 0; i < s->scene_count; ++i) {
        *found = &s->scenes[i];
        if (strcmp(s->scenes[i].name, name) == 0)
            return MOTE_OK;
    }
    scene *fresh = &s->scenes[s->scene_count];
    const mote_status status = mote_subject_open(name, &fresh->subject);
    if (status != MOTE_OK) {
        mote_subject_free(&fresh->subject);
        return status;
    }
    fresh->name = mote_duplicate(name);
    ++s->scene_count;
    *found = fresh;
    return MOTE_OK;
}

static mote_status read_cell(char *fields[8], entrant *e)
{
    uint64_t first, last, seed;
    if (!mote_read_unsigned(fields[2], 1, UINT32_MAX, &first) ||
        !mote_read_unsigned(fields[3], 0, UINT32_MAX, &last) ||
        !mote_read_unsigned(fields[5], 0, MOTE_SEED_MAX, &seed))
        return mote_fail(MOTE_EINVAL, "cell: frames or seed are not numbers");
    const bool evict = strcmp(fields[4], mote_cache_names[MOTE_CACHE_EVICT]) == 0;
    e->cell = (mote_cell){.choice = &e->choice,
                          .replicate = 1,
                          .first = (uint32_t)first,
                          .last = (uint32_t)last,
                          .stride_asked = 1,
                          .stride = 1,
                          .seed = seed,
                          .fixed_seed = true,
                          .cache = evict ? MOTE_CACHE_EVICT : MOTE_CACHE_HOT,
                          .jobs = 1};
    const mote_status status = mote_scene_choice_read(fields[7], &e->choice);
    const double *keys = e->choice.scene;
    if (status == MOTE_OK && (keys[MOTE_SCENE_THREADS] > 1 || keys[MOTE_SCENE_AHEAD] > 0))
        return mote_fail(MOTE_EUNSUPPORTED,
                         "%s: a race has one core; leave threads and ahead out", fields[7]);
    return status;
}

/* cell SCENARIO FIRST LAST CACHE SEED PRINT METHOD; LAST 0: the scenario's last frame. */
static mote_status open_cell(server *s, char *fields[8])
{
    scene *of = NULL;
    if (s->entrant_count == MOTE_RACE_CELLS)
        return mote_fail(MOTE_EINVAL, "more than %d cells; race fewer", MOTE_RACE_CELLS);
    mote_status status = find_scene(s, fields[1], &of);
    if (status != MOTE_OK)
        return status;
    entrant *e = mote_allocate(1, sizeof *e);
    status = read_cell(fields, e);
    const mote_subject_facts facts = mote_subject_facts_of(&of->subject);
    e->cell.step = mote_subject_step(&of->subject);
    const uint32_t frames = facts.frames - e->cell.step; /* in which a question begins */
    e->cell.last = e->cell.last == 0 ? frames : e->cell.last;
    e->cell.subject = &of->subject;
    if (status == MOTE_OK && (e->cell.last > frames || e->cell.first > e->cell.last))
        status = mote_fail(MOTE_EINVAL, "frames %u-%u: outside %s; it has frames 1-%u%s",
                           e->cell.first, e->cell.last, fields[1], frames,
                           e->cell.step ? " from which it asks" : "");
    if (status == MOTE_OK && fields[6][0] == '1' && of->subject.fingerprint == 0)
        status = mote_subject_identify(&of->subject);
    if (status == MOTE_OK)
        status = mote_measurement_open(&e->cell, &e->measurement);
    if (status != MOTE_OK) {
        free(e);
        return status;
    }
    s->entrants[s->entrant_count++] = e;
    mote_text_add(&s->reply, "ok\t%016" PRIx64 "\t%.17g\t%u\t%016" PRIx64 "\t%s\t%u\t%.17g",
                  of->subject.fingerprint, facts.length, e->cell.last, of->subject.faces,
                  mote_ask_names[facts.ask], e->cell.step, facts.tolerance);
    return MOTE_OK;
}

static uint64_t hash_pair(uint64_t hash, const mote_near_pair *pair)
{
    return mote_hash_word(mote_hash_word(hash, pair->body[0]), pair->body[1]);
}

/* How far within `near` the pairs are, in L, added up. Each has a factor of its own, from 1 to
   2, so that differences of two pairs do not cancel out. A pair just at `near` adds next to
   nothing, so it does not matter whether it was found. */
static double sum_near(const mote_bodies *bodies, const mote_near_pair *pairs, size_t count)
{
    double sum = 0;
    for (size_t k = 0; k < count; ++k) {
        const mote_answer *answer = &pairs[k].answer;
        const double within = bodies->near - answer->distance;
        const uint64_t drawn = hash_pair(MOTE_HASH_START, &pairs[k]) >> 11;
        if (answer->has_distance && within > 0)
            sum += within / bodies->length * (1 + ldexp((double)drawn, -53));
    }
    return sum;
}

static uint64_t hash_contacts(const mote_near_pair *pairs, size_t count)
{
    uint64_t hash = MOTE_HASH_START;
    for (size_t k = 0; k < count; ++k) {
        if (pairs[k].answer.contact)
            hash = hash_pair(hash, &pairs[k]);
    }
    return hash;
}

/* What there is to tell about a frame. */
static told tell(const entrant *e, const mote_cell_row *row)
{
    told t = {.answer = row->answer, .values = {MOTE_NONE, MOTE_NONE}};
    const mote_bodies *bodies = e->cell.subject->bodies;
    if (bodies) {
        size_t count;
        const mote_near_pair *pairs = mote_measurement_pairs(e->measurement, &count);
        t.contacts = hash_contacts(pairs, count);
        t.values[0] = sum_near(bodies, pairs, count);
    } else if (row->impact.answered && row->impact.impact) {
        t.values[0] = row->impact.from;
        t.values[1] = row->impact.to;
    }
    return t;
}

static uint64_t hash_told(uint64_t hash, const told *t)
{
    const mote_answer *answer = &t->answer;
    hash = mote_hash_word(hash, answer->has_distance);
    hash = mote_hash_double(hash, answer->has_distance ? answer->distance : 0);
    hash = mote_hash_word(hash, answer->has_contact ? 1 + (uint64_t)answer->contact : 0);
    hash = mote_hash_word(hash, t->contacts);
    for (int k = 0; k < 2; ++k)
        hash = mote_hash_double(hash, t->values[k] == t->values[k] ? t->values[k] : -1);
    return hash;
}

static void add_counts(mote_text *reply, const mote_counters *sums)
{
    const char *separator = "\t";
#define ADD_COUNT(name)                                                                        \
    if (sums->name > 0) {                                                                      \
        mote_text_add(reply, "%s" #name "=%" PRIu64, separator, sums->name);                   \
        separator = ",";                                                                       \
    }
    MOTE_COUNTERS(ADD_COUNT)
    MOTE_COUNTERS_MORE(ADD_COUNT)
#undef ADD_COUNT
    if (separator[0] == '\t')
        mote_text_add(reply, "\t-");
}

static void sum_counts(mote_counters *sums, const mote_counters *counters)
{
#define SUM_COUNT(name) sums->name += counters->name;
    MOTE_COUNTERS(SUM_COUNT)
    MOTE_COUNTERS_MORE(SUM_COUNT)
#undef SUM_COUNT
}

/* Runs the frames of a block without anything else in between. */
static mote_status run_frames(entrant *e, uint32_t first, uint32_t count, uint64_t *times,
                              mote_counters *sums, uint64_t *hash)
{
    e->count = 0;
    for (uint32_t k = 0; k < count; ++k) {
        mote_cell_row row;
        const mote_status status =
            mote_measurement_frame(e->measurement, first + k, e->previous, &row);
        if (status != MOTE_OK)
            return mote_fail(MOTE_EIO, "frame %u: the method failed", first + k);
        e->previous = first + k;
        times[k] = row.deform_ns + row.update_ns + row.query_ns;
        e->answers[k] = tell(e, &row);
        e->count = k + 1;
        *hash = hash_told(*hash, &e->answers[k]);
        sum_counts(sums, &row.answer.counters);
    }
    return MOTE_OK;
}

static mote_status find_entrant(const server *s, const char *field, entrant **found)
{
    uint64_t index;
    if (!mote_read_unsigned(field, 0, UINT32_MAX, &index) || index >= s->entrant_count)
        return mote_fail(MOTE_EINVAL, "%s: no such cell", field);
    *found = s->entrants[index];
    return MOTE_OK;
}

/* run CELL FIRST COUNT */
static mote_status run_block(server *s, char *fields[8])
{
    static uint64_t times[MOTE_RACE_BLOCK_FRAMES];
    uint64_t first, count;
    entrant *e = NULL;
    mote_status status = find_entrant(s, fields[1], &e);
    if (status != MOTE_OK)
        return status;
    if (!mote_read_unsigned(fields[2], e->cell.first, e->cell.last, &first) ||
        !mote_read_unsigned(fields[3], 1, MOTE_RACE_BLOCK_FRAMES, &count) ||
        first + count > (uint64_t)e->cell.last + 1)
        return mote_fail(MOTE_EINVAL, "run: frames outside the cell's");
    if (s->core >= 0)
        mote_process_pin(s->core);
    s->core = -1;
    uint64_t hash = MOTE_HASH_START;
    mote_counters sums = {0};
    status = run_frames(e, (uint32_t)first, (uint32_t)count, times, &sums, &hash);
    if (status != MOTE_OK)
        return status;
    mote_text_add(&s->reply, "ok\t%016" PRIx64, hash);
    add_counts(&s->reply, &sums);
    for (uint64_t k = 0; k < count; ++k)
        mote_text_add(&s->reply, "%s%" PRIu64, k ? "," : "\t", times[k]);
    return MOTE_OK;
}

/* answers CELL */
static mote_status tell_answers(server *s, char *fields[8])
{
    entrant *e = NULL;
    const mote_status status = find_entrant(s, fields[1], &e);
    if (status != MOTE_OK)
        return status;
    mote_text_add(&s->reply, "ok");
    for (uint32_t k = 0; k < e->count; ++k) {
        const told *t = &e->answers[k];
        const mote_answer *a = &t->answer;
        mote_text_add(&s->reply, "%s%.17g:%c", k ? "," : "\t",
                      a->has_distance ? a->distance : MOTE_NONE,
                      a->has_contact ? (a->contact ? '1' : '0') : '-');
        if (e->cell.subject->bodies || e->cell.step > 0)
            mote_text_add(&s->reply, ":%016" PRIx64 ":%.17g:%.17g", t->contacts, t->values[0],
                          t->values[1]);
    }
    return MOTE_OK;
}

/* Answers a line; returns false if nobody reads the answer. */
static bool answer_line(server *s, char *line)
{
    static const struct {
        const char *name;
        size_t fields;
        mote_status (*run)(server *s, char *fields[8]);
    } requests[] = {
        {"cell", 8, open_cell}, {"run", 4, run_block}, {"answers", 2, tell_answers}};
    char *fields[8] = {NULL};
    const size_t count = split(line, fields, 8);
    mote_status status = mote_fail(MOTE_EINVAL, "%.40s: no such request", fields[0]);
    s->reply.size = 0;
    for (size_t i = 0; i < sizeof requests / sizeof requests[0]; ++i) {
        if (strcmp(requests[i].name, fields[0]) == 0 && requests[i].fields == count) {
            status = requests[i].run(s, fields);
            break;
        }
    }
    if (status != MOTE_OK) {
        s->reply.size = 0;
        mote_text_add(&s->reply, "no\t%s", mote_error_text());
    }
    for (size_t i = 0; i < s->reply.size; ++i) {
        if (s->reply.data[i] == '\n')
            s->reply.data[i] = ' ';
    }
    mote_text_add(&s->reply, "\n");
    return mote_child_put(STDOUT_FILENO, s->reply.data, s->reply.size) == MOTE_OK;
}

static void free_server(server *s)
{
    for (size_t i = 0; i < s->entrant_count; ++i) {
        mote_measurement_close(s->entrants[i]->measurement);
        free(s->entrants[i]);
    }
    for (size_t i = 0; i < s->scene_count; ++i) {
        free(s->scenes[i].name);
        mote_subject_free(&s->scenes[i].subject);
    }
    free(s->reply.data);
    free(s);
}

static int serve(int core)
{
    static char line[8192];
    server *s = mote_allocate(1, sizeof *s);
    s->core = core;
    char greeting[64];
    const int size =
        snprintf(greeting, sizeof greeting, MOTE_RACE_GREETING "\t%d\n", MOTE_RACE_FORMAT);
    bool heard = mote_child_put(STDOUT_FILENO, greeting, (size_t)size) == MOTE_OK;
    while (heard && fgets(line, sizeof line, stdin)) {
        char *end = strchr(line, '\n');
        if (!end)
            break; /* cut off, or too long for a request */
        *end = '\0';
        heard = answer_line(s, line);
    }
    free_server(s);
    return MOTE_EXIT_DONE;
}

/* Serves with the stack lowered by this many bytes. */
__attribute__((noinline)) static int serve_below(uint64_t bytes, int core)
{
    volatile char step[STEP_BYTES];
    step[0] = 0;
    const int code = bytes < STEP_BYTES ? serve(core) : serve_below(bytes - STEP_BYTES, core);
    return code + step[0];
}

static const mote_option options[] = {
    {"core", "N", NULL}, {"stack", "BYTES", NULL}, {"heap", "BYTES", NULL}, {NULL, NULL, NULL}};

int mote_race_child(int argc, char **argv)
{
    mote_option_reader reader = mote_option_begin(options, argc, argv);
    uint64_t numbers[3] = {0, 0, 0};
    const char *value;
    for (int option; (option = mote_option_next(&reader, &value)) != MOTE_OPTION_END;) {
        if (option == MOTE_OPTION_ERROR)
            return MOTE_EXIT_USAGE;
        if (option == MOTE_OPTION_PLAIN ||
            !mote_read_unsigned(value, 0, OFFSET_MAX, &numbers[option]))
            return mote_command_usage(argv[0], "%s: not a number that `mote race` gives",
                                      value);
    }
    (void)prctl(PR_SET_PDEATHSIG, SIGKILL);
    /* Ctrl-C reaches every process of the terminal; the parent ends its children. */
    (void)signal(SIGINT, SIG_IGN);
    void *below = mote_allocate(1, numbers[2] + 1);
    const int code = serve_below(numbers[1], (int)numbers[0] - 1);
    free(below);
    return code;
}
