#include "tests/studies/soak_shrink.h"

#include "tests/studies/soak_case.h"

/* A failing scenario being shrunk. */
typedef struct shrink {
    json_t *scenario;
    const char *path;
    soak_plant plant;
    soak_verdict verdict;
    bool lost; /* a file could not be written */
} shrink;

static bool still_fails(shrink *s, const soak_plant *plant)
{
    if (soak_case_write(s->scenario, s->path) != MOTE_OK) {
        s->lost = true;
        return false;
    }
    soak_verdict verdict;
    const mote_status status = soak_judge(s->path, plant, true, &verdict);
    if (!soak_failed(status, &verdict))
        return false;
    s->verdict = verdict;
    s->plant = *plant;
    return true;
}

/* Tries the scenario with object[key] = value (stolen; NULL: without the key); keeps the change
   only if it still fails. */
static bool try_set(shrink *s, json_t *object, const char *key, json_t *value)
{
    json_t *before = json_incref(json_object_get(object, key));
    if (value)
        json_object_set_new(object, key, value);
    else
        json_object_del(object, key);
    const soak_plant plant = s->plant;
    const bool kept = still_fails(s, &plant);
    if (!kept)
        json_object_set(object, key, before);
    json_decref(before);
    return kept;
}

/* Tries to keep only frames first to last of the current ones. */
static bool try_frames(shrink *s, uint32_t first, uint32_t last)
{
    json_t *before = json_copy(s->scenario);
    const double pace = json_number_value(json_object_get(s->scenario, "pace"));
    const double start = json_number_value(json_object_get(s->scenario, "start"));
    json_object_set_new(s->scenario, "start", json_real(start + (first - 1.0) * pace));
    json_object_set_new(s->scenario, "frames", json_integer(last - first + 1));
    soak_plant plant = s->plant;
    plant.frame = plant.frame >= first ? plant.frame - first + 1 : 0;
    const bool kept = still_fails(s, &plant);
    if (!kept)
        json_object_update(s->scenario, before);
    json_decref(before);
    return kept;
}

/* Removes everything after the failure, and as much as possible before it. */
static void shrink_frames(shrink *s)
{
    const uint32_t last = s->verdict.failed_frame;
    if (last == 0)
        return; /* it crashed or hung, at an unknown frame */
    try_frames(s, 1, last);
    for (uint32_t kept = 1; kept < last; kept *= 2) {
        if (try_frames(s, last - kept + 1, last))
            return;
    }
}

static void shrink_body(shrink *s, json_t *body)
{
    try_set(s, body, "field", NULL);
    try_set(s, body, "motion", NULL);
    try_set(s, body, "scale", NULL);
    for (int64_t half = json_integer_value(json_object_get(body, "triangles")) / 4; half >= 200;
         half /= 2) {
        if (!try_set(s, body, "triangles", json_integer(2 * half)))
            break;
    }
}

mote_status soak_shrink(json_t *scenario, const char *path, soak_plant *plant,
                        soak_verdict *verdict)
{
    shrink s = {scenario, path, *plant, *verdict, false};
    shrink_frames(&s);
    json_t *bodies = json_object_get(scenario, "bodies");
    for (size_t b = 0; b < json_array_size(bodies); ++b)
        shrink_body(&s, json_array_get(bodies, b));
    shrink_frames(&s);
    *plant = s.plant;
    *verdict = s.verdict;
    mote_status status = soak_case_write(scenario, path);
    return s.lost ? MOTE_EIO : status;
}
