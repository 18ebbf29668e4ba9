#include "harness/run/plan.h"

#include "harness/base/file.h"
#include "harness/base/memory.h"
#include "harness/base/options.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

void mote_choices_free(mote_choices *choices)
{
    free(choices->items);
    mote_choices none = {0};
    *choices = none;
}

static bool same_choice(const mote_method_choice *a, const mote_method_choice *b)
{
    if (a->method != b->method)
        return false;
    for (size_t i = 0; i < a->method->parameter_count; ++i) {
        if (a->values[i] < b->values[i] || a->values[i] > b->values[i])
            return false;
    }
    for (int k = 0; k < MOTE_SCENE_KEYS; ++k) {
        if (a->scene[k] < b->scene[k] || a->scene[k] > b->scene[k])
            return false;
    }
    return true;
}

static mote_status add_one(mote_choices *choices, const char *text)
{
    mote_method_choice choice;
    mote_status status = mote_scene_choice_read(text, &choice);
    if (status != MOTE_OK)
        return status;
    for (size_t i = 0; i < choices->count; ++i) {
        if (same_choice(&choices->items[i], &choice))
            return MOTE_OK;
    }
    if (choices->count == MOTE_CHOICES_MAX)
        return mote_fail(MOTE_EINVAL, "more than %d configurations; split the run",
                         MOTE_CHOICES_MAX);
    choices->items = mote_reserve(choices->items, choices->count + 1, &choices->capacity,
                                  sizeof *choices->items);
    choices->items[choices->count++] = choice;
    return MOTE_OK;
}

static bool has_parameter_n(const char *text)
{
    char name[64];
    size_t length = strcspn(text, ":");
    if (length >= sizeof name)
        return false;
    memcpy(name, text, length);
    name[length] = '\0';
    const mote_method *method = mote_method_find(name);
    for (size_t i = 0; method && i < method->parameter_count; ++i) {
        if (strcmp(method->parameters[i].key, "n") == 0)
            return true;
    }
    return false;
}

static bool sets_n(const char *text)
{
    const char *colon = strchr(text, ':');
    return colon && (strncmp(colon, ":n=", 3) == 0 || strstr(colon, ",n=") != NULL);
}

/* Reads the first part of a list of numbers of particles; *list is then at the next part, or
   NULL after the last. */
static mote_status next_particles(const char **list, uint64_t *first, uint64_t *last)
{
    const size_t length = strcspn(*list, ",");
    char *range = mote_format("%.*s", (int)length, *list);
    mote_status status = mote_read_range(range, UINT32_MAX, first, last);
    free(range);
    if (status == MOTE_OK && *last - *first >= MOTE_CHOICES_MAX)
        status = mote_fail(MOTE_EINVAL, "more than %d particle counts", MOTE_CHOICES_MAX);
    *list = (*list)[length] ? *list + length + 1 : NULL;
    return status == MOTE_OK
               ? MOTE_OK
               : mote_fail(status, "%s; particles are numbers and ranges: 1,2,4-8",
                           mote_error_text());
}

mote_status mote_particles_check(const char *particles)
{
    uint64_t first, last;
    mote_status status = MOTE_OK;
    while (particles && status == MOTE_OK)
        status = next_particles(&particles, &first, &last);
    return status;
}

static mote_status add_with_particles(mote_choices *choices, const char *text,
                                      const char *particles)
{
    mote_status status = MOTE_OK;
    while (particles && status == MOTE_OK) {
        uint64_t first = 1, last = 0;
        status = next_particles(&particles, &first, &last);
        for (uint64_t n = first; status == MOTE_OK && n <= last; ++n) {
            char *full = mote_format("%s%cn=%" PRIu64, text, strchr(text, ':') ? ',' : ':', n);
            status = add_one(choices, full);
            free(full);
        }
    }
    return status;
}

mote_status mote_choices_add(mote_choices *choices, const char *text, const char *particles)
{
    const char *bar = strchr(text, '|');
    if (!bar) {
        if (particles && has_parameter_n(text) && !sets_n(text))
            return add_with_particles(choices, text, particles);
        return add_one(choices, text);
    }
    /* Expands the first list; the recursion expands the others. */
    const char *start = bar;
    while (start > text && start[-1] != '=' && start[-1] != ',' && start[-1] != ':')
        --start;
    const char *end = bar + strcspn(bar, ",");
    for (const char *item = start; item <= end;) {
        size_t length = strcspn(item, "|,");
        char *one =
            mote_format("%.*s%.*s%s", (int)(start - text), text, (int)length, item, end);
        mote_status status = mote_choices_add(choices, one, particles);
        free(one);
        if (status != MOTE_OK)
            return status;
        item += length + 1;
    }
    return MOTE_OK;
}

static mote_status check_frames(const mote_plan_options *options, const mote_subject *subject)
{
    const mote_subject_facts facts = mote_subject_facts_of(subject);
    if (options->last > facts.frames)
        return mote_fail(MOTE_EINVAL, "frames %u-%u: outside %s; it has frames 1-%u",
                         options->first, options->last, facts.name, facts.frames);
    if (options->last > 0 && mote_subject_asks_impacts(subject)) {
        const uint32_t longest = options->step_count ? options->steps[options->step_count - 1]
                                                     : subject->scenario->step;
        if (options->last - options->first < longest)
            return mote_fail(
                MOTE_EINVAL,
                "frames %u-%u: no impact is asked for within them, as a step of %s is "
                "%u frames",
                options->first, options->last, facts.name, longest);
    }
    return MOTE_OK;
}

/* The configurations that a subject is asked of. */
static const mote_choices *choices_for(const mote_plan_options *options,
                                       const mote_subject *subject, const mote_choices *choices,
                                       const mote_choices *scene_choices)
{
    if (subject->bodies)
        return scene_choices;
    return options->impact_choices && mote_subject_asks_impacts(subject)
               ? options->impact_choices
               : choices;
}

/* How many times a subject is asked: once with each step. */
static uint32_t step_count(const mote_plan_options *options, const mote_subject *subject)
{
    return options->step_count > 0 && mote_subject_asks_impacts(subject) ? options->step_count
                                                                         : 1;
}

static uint32_t step_of(const mote_plan_options *options, const mote_subject *subject,
                        uint32_t k)
{
    return options->step_count > 0 && mote_subject_asks_impacts(subject)
               ? options->steps[k]
               : mote_subject_step(subject);
}

/* The cells of one scenario, step and replicate. */
static void add_group(const mote_plan_options *options, const mote_subject *subject,
                      uint32_t step, uint32_t replicate, const mote_choices *choices,
                      mote_plan *plan)
{
    const uint32_t frames = mote_subject_facts_of(subject).frames;
    for (size_t k = 0; k < choices->count; ++k) {
        mote_cell cell = {
            .subject = subject,
            .choice = &choices->items[(k + replicate - 1) % choices->count],
            .replicate = replicate,
            .first = options->last ? options->first : 1,
            .last = options->last ? options->last : frames,
            .step = step,
            .stride_asked = options->stride,
            .stride = 1,
            .seed = options->seed,
            .cache = options->cache,
            .jobs = options->jobs,
            .fixed_seed = options->fixed_seed,
            .budget = options->budget,
            .contacts_only = options->contacts_only,
        };
        mote_cell_name(&cell, options->program);
        plan->cells[plan->count++] = cell;
    }
}

mote_status mote_plan_make(const mote_plan_options *options, const mote_subject *subjects,
                           size_t subject_count, const mote_choices *choices,
                           const mote_choices *scene_choices, mote_plan *plan)
{
    size_t count = 0;
    for (size_t s = 0; s < subject_count; ++s) {
        const mote_status status = check_frames(options, &subjects[s]);
        if (status != MOTE_OK)
            return status;
        count += (size_t)options->replicates * step_count(options, &subjects[s]) *
                 choices_for(options, &subjects[s], choices, scene_choices)->count;
    }
    if (count > MOTE_CHOICES_MAX)
        return mote_fail(MOTE_EINVAL,
                         "%zu cells; at most %d in one run, use --shard or split it", count,
                         MOTE_CHOICES_MAX);
    mote_plan made = {.cells = mote_allocate(count, sizeof *made.cells)};
    for (uint32_t replicate = 1; replicate <= options->replicates; ++replicate) {
        for (size_t s = 0; s < subject_count; ++s) {
            for (uint32_t k = 0; k < step_count(options, &subjects[s]); ++k)
                add_group(options, &subjects[s], step_of(options, &subjects[s], k), replicate,
                          choices_for(options, &subjects[s], choices, scene_choices), &made);
        }
    }
    *plan = made;
    return MOTE_OK;
}

bool mote_cell_needs_every_frame(const mote_cell *cell)
{
    return cell->step == 0 &&
           (cell->subject->bodies ||
            mote_method_traits(cell->choice->method, cell->choice->values).keeps_state);
}

/* Whether two cells have one name among those that need every frame. */
static bool same_name(const mote_cell *a, const mote_cell *b)
{
    const bool many = a->subject->bodies != NULL;
    return many ? a->subject == b->subject : !b->subject->bodies && a->choice == b->choice;
}

void mote_plan_unstrided(const mote_plan *plan, mote_text *names)
{
    for (size_t i = 0; i < plan->count && plan->cells[i].replicate == 1; ++i) {
        const mote_cell *cell = &plan->cells[i];
        bool told = cell->stride_asked <= 1 || !mote_cell_needs_every_frame(cell);
        for (size_t k = 0; k < i && !told; ++k)
            told = mote_cell_needs_every_frame(&plan->cells[k]) &&
                   same_name(cell, &plan->cells[k]);
        if (!told)
            mote_text_add(names, "%s%s%s", names->size ? ", " : "",
                          cell->subject->bodies ? "all methods on " : "",
                          cell->subject->bodies ? mote_subject_facts_of(cell->subject).name
                                                : cell->choice->text);
    }
}
