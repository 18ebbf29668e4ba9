/* mote approach SCENARIO --gaps FRAME:GAP,... -o FILE.json: finds the positions of body 1 that
   give the gaps. */
#include "harness/base/curve.h"
#include "harness/base/memory.h"
#include "harness/base/options.h"
#include "harness/base/record.h"
#include "harness/command/command.h"
#include "harness/run/scenario_save.h"
#include "harness/scene/approach.h"
#include "harness/scene/scenario_read.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define DIGITS 15 /* of a number in the file, so that 0.1 is written 0.1 */

#define GAPS_MAX 1024

typedef struct request {
    const char *scenario, *output;
    uint32_t frame[GAPS_MAX]; /* ascending */
    double gap[GAPS_MAX];
    uint32_t gaps;
    double direction[3];
    uint64_t every;
} request;

/* Reads "FRAME:GAP,FRAME:GAP". MOTE_EINVAL with what is wrong. */
static mote_status read_gaps(const char *text, request *wish)
{
    wish->gaps = 0;
    for (const char *from = text;;) {
        char *end;
        const bool is_number = from[0] >= '0' && from[0] <= '9';
        const unsigned long frame = is_number ? strtoul(from, &end, 10) : 0;
        const uint32_t count = wish->gaps;
        if (frame < 1 || frame > MOTE_FRAMES_MAX || *end != ':' || count == GAPS_MAX)
            return mote_fail(
                MOTE_EINVAL,
                "%.20s: write FRAME:GAP,FRAME:GAP, at most %d of them, frames from "
                "1 to %d, gaps in L",
                from, GAPS_MAX, MOTE_FRAMES_MAX);
        if (count > 0 && frame <= wish->frame[count - 1])
            return mote_fail(MOTE_EINVAL,
                             "frame %lu comes after frame %u; give them in ascending order",
                             frame, wish->frame[count - 1]);
        from = end + 1;
        const double gap = strtod(from, &end);
        if (end == from || (*end != ',' && *end != '\0') || !(gap > -1 && gap < 1e3))
            return mote_fail(MOTE_EINVAL, "%.20s: not a gap; give -1 to 1000, in L", from);
        wish->frame[count] = (uint32_t)frame;
        wish->gap[count] = gap;
        ++wish->gaps;
        if (*end == '\0')
            return MOTE_OK;
        from = end + 1;
    }
}

/* The gaps as a curve over the frames of a scenario. */
static mote_status make_curve(const request *wish, const mote_scenario *scenario,
                              mote_curve **curve)
{
    if (wish->frame[wish->gaps - 1] > scenario->frames)
        return mote_fail(MOTE_EINVAL, "--gaps: frame %u: %s has frames 1-%u; name some of them",
                         wish->frame[wish->gaps - 1], scenario->name, scenario->frames);
    return mote_curve_create(wish->frame, wish->gap, wish->gaps, 1, curve);
}

/* Lists frames 1, 1 + every, ..., the last, and each with a requested gap, in order. */
static uint32_t list_frames(uint32_t frames, uint32_t every, const mote_curve *wished,
                            uint32_t *list)
{
    uint32_t count = 0, next = 0;
    for (uint32_t frame = 1;; frame = frame + every < frames ? frame + every : frames) {
        for (; next < wished->count && wished->frames[next] < frame; ++next)
            list[count++] = wished->frames[next];
        next += next < wished->count && wished->frames[next] == frame;
        list[count++] = frame;
        if (frame == frames)
            return count;
    }
}

/* Replaces body 1's keys: removes their positions, then adds the positions found. */
static mote_status replace_positions(json_t *root, const mote_scenario *scenario,
                                     const uint32_t *frames, const mote_vec3 *positions,
                                     uint32_t count)
{
    json_t *body = json_array_get(json_object_get(root, "bodies"), 1);
    if (!body || json_object_get(root, "pace") || json_object_get(root, "start"))
        return mote_fail(MOTE_EINVAL,
                         "%s: start and pace cannot be kept with new positions; name a "
                         "scenario without them",
                         scenario->path);
    json_t *keys = json_array();
    size_t index;
    json_t *key;
    MOTE_EACH(index, key, json_object_get(body, "motion"))
    {
        (void)json_object_del(key, "position");
        if (json_object_size(key) > 1)
            (void)json_array_append(keys, key);
    }
    for (uint32_t k = 0; k < count; ++k) {
        const mote_vec3 p = mote_scale(positions[k], 1 / scenario->length);
        (void)json_array_append_new(
            keys, json_pack("{s:i, s:[f,f,f]}", "frame", frames[k], "position", p.x, p.y, p.z));
    }
    (void)json_object_set_new(body, "motion", keys);
    return MOTE_OK;
}

static mote_status verify(void *context, const mote_scenario *scenario)
{
    const mote_curve *wished = context;
    return mote_approach_verify(scenario, wished->frames, wished->values, wished->count);
}

static mote_status write_result(const request *wish, const mote_scenario *scenario,
                                const mote_curve *wished, const mote_approach_plan *plan,
                                const mote_vec3 *positions)
{
    mote_json_file file;
    mote_status status = mote_scenario_open(scenario->path, &file);
    if (status != MOTE_OK)
        return status;
    status = replace_positions(file.root, scenario, plan->frames, positions, plan->count);
    if (status == MOTE_OK)
        status =
            mote_scenario_save(&file, DIGITS, verify, (void *)(uintptr_t)wished, wish->output);
    mote_json_close(&file);
    return status;
}

static mote_status approach(const request *wish, const mote_scenario *scenario)
{
    mote_curve *wished = NULL;
    mote_status status = make_curve(wish, scenario, &wished);
    if (status != MOTE_OK)
        return status;
    const size_t most = scenario->frames / wish->every + 2 + wished->count;
    uint32_t *frames = mote_allocate(most, sizeof *frames);
    double *gaps = mote_allocate(most, sizeof *gaps);
    mote_vec3 *positions = mote_allocate(most, sizeof *positions);
    const uint32_t count = list_frames(scenario->frames, (uint32_t)wish->every, wished, frames);
    for (uint32_t k = 0; k < count; ++k)
        mote_curve_evaluate(wished, frames[k], &gaps[k]);
    const double *u = wish->direction;
    const mote_approach_plan plan = {.direction = mote_vec3_make(u[0], u[1], u[2]),
                                     .frames = frames,
                                     .gaps = gaps,
                                     .count = count};
    status = mote_approach_solve(scenario, &plan, positions);
    if (status == MOTE_OK)
        status = write_result(wish, scenario, wished, &plan, positions);
    free(frames);
    free(gaps);
    free(positions);
    mote_curve_destroy(wished);
    return status;
}

const mote_option mote_options_approach[] = {
    {"gaps", "FRAME:GAP,...",
     "the distance at each frame, in L; below 0: how far body 1 is pushed on from "
     "contact; no default"},
    {"every", "FRAMES",
     "the number of frames between two key poses, besides those of --gaps (default: 16)"},
    {"direction", "X,Y,Z", "where body 1 lies as seen from body 0 (default: 1,0,0)"},
    {"-o", "FILE",
     "the scenario file to write; meshes outside of its folder are copied beside it; no "
     "default"},
    {NULL, NULL, NULL}};

int mote_command_approach(int argc, char **argv)
{
    mote_option_reader reader = mote_option_begin(mote_options_approach, argc, argv);
    request wish = {.direction = {1, 0, 0}, .every = 16};
    const char *value;
    for (int option; (option = mote_option_next(&reader, &value)) != MOTE_OPTION_END;) {
        bool good = option != MOTE_OPTION_ERROR;
        if (option == MOTE_OPTION_PLAIN && wish.scenario)
            return mote_command_usage("approach", "%s: one scenario at a time", value);
        if (option == MOTE_OPTION_PLAIN)
            wish.scenario = value;
        else if (option == 0 && read_gaps(value, &wish) != MOTE_OK)
            return mote_command_usage("approach", "--gaps %s", mote_error_text());
        else if (option == 1 && !mote_read_unsigned(value, 1, 100000, &wish.every))
            return mote_command_usage(
                "approach", "--every %s: give a whole number of frames from 1 to 100000",
                value);
        else if (option == 2 && !mote_read_direction(value, wish.direction))
            return mote_command_usage("approach", "--direction %s: give x,y,z, not all 0",
                                      value);
        else if (option == 3)
            wish.output = value;
        if (!good)
            return MOTE_EXIT_USAGE;
    }
    if (!wish.scenario || wish.gaps == 0 || !wish.output)
        return mote_command_usage("approach", "something is missing; write `mote approach "
                                              "SCENARIO --gaps 1:0.5,100:-0.01 -o FILE.json`");
    mote_scenario *scenario;
    if (mote_scenario_load(wish.scenario, &scenario) != MOTE_OK)
        return mote_command_fail();
    mote_status status = approach(&wish, scenario);
    mote_scenario_destroy(scenario);
    if (status == MOTE_OK)
        return mote_command_finish(MOTE_EXIT_DONE);
    const int code = mote_command_fail();
    /* The bodies were placed, so a gap other than requested is a failed check. */
    return status == MOTE_ENUMERIC ? MOTE_EXIT_CHECK_FAILED : code;
}
