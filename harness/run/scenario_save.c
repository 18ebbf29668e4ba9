#include "harness/run/scenario_save.h"

#include "harness/base/json_print.h"
#include "harness/run/active.h"
#include "harness/scene/scenario_move.h"
#include "harness/scene/scenario_read.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A file that nothing could read is not written. */
static mote_status check_size(const char *path, size_t size)
{
    if (size <= MOTE_JSON_LIMIT)
        return MOTE_OK;
    return mote_fail(MOTE_EINVAL,
                     "%s: not written: it would have %zu bytes, and of a scenario at most %zu "
                     "are read; record fewer frames",
                     path, size, MOTE_JSON_LIMIT);
}

/* Loads the scenario that file->root describes and that is to be written to `to`. */
static mote_status read_back(const mote_json_file *file, int digits, const char *to,
                             mote_scenario **scenario)
{
    mote_text text = {0};
    mote_json_file again = {.path = file->path, .own = file->own};
    mote_json_print(file->root, digits, &text);
    mote_status status = check_size(to, text.size);
    if (status == MOTE_OK)
        status =
            mote_json_parse(file->path, text.data, text.size, "tell the authors", &again.root);
    again.text = text.data;
    if (status == MOTE_OK)
        status = mote_scenario_read(&again, scenario);
    json_decref(again.root);
    free(text.data);
    return status;
}

/* Puts the "active" interval back that was taken out of root if it still holds, otherwise the
   longest that does. */
static mote_status renew_active(json_t *root, const json_t *active,
                                const mote_scenario *scenario)
{
    const mote_interval old = {(uint32_t)json_integer_value(json_array_get(active, 0)),
                               (uint32_t)json_integer_value(json_array_get(active, 1))};
    mote_truth *truth;
    mote_status status = mote_truth_compute(scenario, &truth);
    if (status != MOTE_OK)
        return status;
    mote_interval now = old;
    if (old.last > scenario->frames || !mote_active_holds(scenario, truth, old))
        now = mote_active_longest(scenario, truth);
    mote_truth_destroy(truth);
    if (now.first > 0)
        (void)json_object_set_new(root, "active",
                                  json_pack("[i,i]", (int)now.first, (int)now.last));
    if (now.first == 0)
        (void)fprintf(stderr,
                      "active %u-%u no longer holds, and no other interval does: left out\n",
                      old.first, old.last);
    else if (now.first != old.first || now.last != old.last)
        (void)fprintf(stderr, "active %u-%u no longer holds: %u-%u instead\n", old.first,
                      old.last, now.first, now.last);
    return MOTE_OK;
}

static mote_status write_text(const json_t *root, int digits, const char *to)
{
    mote_text text = {0};
    mote_json_print(root, digits, &text);
    const mote_status status = mote_file_write(to, text.data, text.size);
    free(text.data);
    return status;
}

mote_status mote_scenario_save(mote_json_file *file, int digits, mote_scenario_verify verify,
                               void *context, const char *to)
{
    mote_scenario *scenario = NULL;
    char *target = mote_path_is_stream(to) ? mote_format("%s", to) : mote_path_follow(to);
    json_t *active = json_incref(json_object_get(file->root, "active"));
    (void)json_object_del(file->root, "active");
    mote_status status =
        target ? read_back(file, digits, to, &scenario)
               : mote_fail(MOTE_EIO, "%s: cannot be written: %s", to, strerror(errno));
    if (status == MOTE_OK && verify)
        status = verify(context, scenario);
    if (status == MOTE_OK && active)
        status = renew_active(file->root, active, scenario);
    if (status == MOTE_OK)
        status = mote_scenario_move(file, target);
    if (status == MOTE_OK)
        status = write_text(file->root, digits, target);
    mote_scenario_destroy(scenario);
    json_decref(active);
    free(target);
    return status;
}
