#include "core/batch/crowd.h"

#include "core/base/pool.h"
#include "core/certificate/scene.h"

#include <stdlib.h>
#include <string.h>

/* A body along the axis of the sweep. */
typedef struct sweep_entry {
    double low;
    uint32_t body;
} sweep_entry;

struct mote_crowd {
    mote_scene *scene;
    mote_body *shapes;  /* [shape_count] */
    mote_field *still;  /* of shapes without a field */
    uint32_t *shape_of; /* [body_count] */
    uint32_t body_count;
    double *room;            /* weights of all bodies */
    size_t *room_of;         /* [body_count] */
    mote_body_state *states; /* [body_count] */
    mote_scene_box *bounds;
    sweep_entry *sweep;
    uint32_t (*pairs)[2]; /* [pair_room] */
    size_t pair_count, pair_room;
};

void mote_crowd_destroy(mote_crowd *crowd)
{
    if (!crowd)
        return;
    mote_scene_destroy(crowd->scene);
    mote_field_destroy(crowd->still);
    free(crowd->shapes);
    free(crowd->shape_of);
    free(crowd->room);
    free(crowd->room_of);
    free(crowd->states);
    free(crowd->bounds);
    free(crowd->sweep);
    free(crowd->pairs);
    free(crowd);
}

static mote_status check_counts(size_t shape_count, const uint32_t *shape_of, size_t body_count,
                                const mote_crowd_options *options)
{
    if (shape_count < 1 || shape_count > UINT32_MAX / 2 || body_count < 1 ||
        body_count > UINT32_MAX / 2)
        return mote_fail(MOTE_EINVAL,
                         "a scene has 1 to 2^31 - 1 shapes and bodies, not %zu and %zu",
                         shape_count, body_count);
    for (size_t i = 0; i < body_count; ++i) {
        if (shape_of[i] >= shape_count)
            return mote_fail(MOTE_EINVAL, "body %zu has shape %u of %zu, counted from 0", i,
                             shape_of[i], shape_count);
    }
    if (options->threads < 1 || options->threads > MOTE_POOL_MAX)
        return mote_fail(MOTE_EINVAL, "threads: %zu; 1 to %u are possible", options->threads,
                         MOTE_POOL_MAX);
    return MOTE_OK;
}

static mote_status set_shapes(mote_crowd *crowd, const mote_mesh *const *meshes,
                              const mote_field *const *fields, size_t shape_count)
{
    mote_status status = mote_field_create_static(&crowd->still);
    for (size_t i = 0; i < shape_count && status == MOTE_OK; ++i) {
        crowd->shapes[i] =
            (mote_body){.mesh = meshes[i], .field = fields[i] ? fields[i] : crowd->still};
        if (mote_body_is_given(&crowd->shapes[i]))
            status = mote_fail(MOTE_EINVAL,
                               "shape %zu has no field; a scene of bodies whose "
                               "positions are given is a mote_stream_scene",
                               i);
    }
    return status;
}

static mote_status build_scene(mote_crowd *crowd, size_t shape_count,
                               const mote_crowd_options *options)
{
    const mote_body **list = malloc(shape_count * sizeof(const mote_body *));
    if (!list)
        return mote_fail(MOTE_ENOMEM, "no memory for %zu shapes", shape_count);
    for (size_t i = 0; i < shape_count; ++i)
        list[i] = &crowd->shapes[i];
    const mote_scene_options plan = {.ask = options->contact ? MOTE_ASK_CONTACT
                                                             : MOTE_ASK_DISTANCE,
                                     .tolerance = options->tolerance,
                                     .threads = (uint32_t)options->threads};
    mote_status status = mote_scene_create(list, (uint32_t)shape_count, crowd->shape_of,
                                           crowd->body_count, &plan, &crowd->scene);
    free(list);
    return status;
}

static mote_status allocate_bodies(mote_crowd *crowd, const uint32_t *shape_of)
{
    const size_t bodies = crowd->body_count;
    crowd->shape_of = malloc(bodies * sizeof *crowd->shape_of);
    crowd->room_of = malloc(bodies * sizeof *crowd->room_of);
    crowd->states = calloc(bodies, sizeof *crowd->states);
    crowd->bounds = calloc(bodies, sizeof *crowd->bounds);
    crowd->sweep = malloc(bodies * sizeof *crowd->sweep);
    if (!crowd->shape_of || !crowd->room_of || !crowd->states || !crowd->bounds ||
        !crowd->sweep)
        return mote_fail(MOTE_ENOMEM, "no memory for %zu bodies", bodies);
    memcpy(crowd->shape_of, shape_of, bodies * sizeof *shape_of);
    size_t numbers = 0;
    for (size_t i = 0; i < bodies; ++i) {
        crowd->room_of[i] = numbers;
        numbers += (size_t)3 * crowd->shapes[shape_of[i]].field->padded;
    }
    crowd->room = malloc((numbers + 1) * sizeof *crowd->room);
    return crowd->room ? MOTE_OK : mote_fail(MOTE_ENOMEM, "no memory for %zu weights", numbers);
}

mote_status mote_crowd_create(const mote_mesh *const *meshes, const mote_field *const *fields,
                              size_t shape_count, const uint32_t *shape_of, size_t body_count,
                              const mote_crowd_options *options, mote_crowd **crowd)
{
    static const mote_crowd_options defaults = {.threads = 1};
    const mote_crowd_options *chosen = options ? options : &defaults;
    mote_status status = check_counts(shape_count, shape_of, body_count, chosen);
    if (status != MOTE_OK)
        return status;
    mote_crowd *made = calloc(1, sizeof *made);
    if (made)
        made->shapes = calloc(shape_count, sizeof *made->shapes);
    if (!made || !made->shapes) {
        mote_crowd_destroy(made);
        return mote_fail(MOTE_ENOMEM, "no memory for a scene");
    }
    made->body_count = (uint32_t)body_count;
    status = set_shapes(made, meshes, fields, shape_count);
    if (status == MOTE_OK)
        status = allocate_bodies(made, shape_of);
    if (status == MOTE_OK)
        status = build_scene(made, shape_count, chosen);
    if (status == MOTE_OK)
        *crowd = made;
    else
        mote_crowd_destroy(made);
    return status;
}

double mote_crowd_length(const mote_crowd *crowd)
{
    return mote_scene_length(crowd->scene);
}

static mote_status read_states(mote_crowd *crowd, const mote_controls *controls)
{
    const double length = mote_scene_length(crowd->scene);
    for (uint32_t i = 0; i < crowd->body_count; ++i) {
        mote_status status =
            mote_controls_read(&crowd->shapes[crowd->shape_of[i]], &controls[i], 0, length,
                               crowd->room + crowd->room_of[i], &crowd->states[i]);
        if (status != MOTE_OK)
            return mote_fail(status, "body %u: %s", i, mote_error_text());
    }
    return MOTE_OK;
}

static double along(mote_vec3 v, int axis)
{
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

/* The axis along which boxes are spread most, compared with their sizes. */
static int widest_axis(const mote_scene_box *bounds, uint32_t count)
{
    int best = 0;
    double widest = -1;
    for (int axis = 0; axis < 3; ++axis) {
        double low = HUGE_VAL, high = -HUGE_VAL, sum = 0;
        for (uint32_t i = 0; i < count; ++i) {
            const double from = along(bounds[i].low, axis), to = along(bounds[i].high, axis);
            low = fmin(low, from);
            high = fmax(high, to);
            sum += to - from;
        }
        const double spread = (high - low) / sum; /* no box is without a size */
        if (spread > widest) {
            widest = spread;
            best = axis;
        }
    }
    return best;
}

static int by_low(const void *a, const void *b)
{
    const sweep_entry *p = a, *q = b;
    if (p->low < q->low || p->low > q->low)
        return p->low < q->low ? -1 : 1;
    return (p->body > q->body) - (p->body < q->body);
}

static int by_bodies(const void *a, const void *b)
{
    return mote_pair_order(a, b);
}

/* The distance of two boxes. */
static double gap(const mote_scene_box *a, const mote_scene_box *b)
{
    const mote_vec3 d = {fmax(0, fmax(a->low.x - b->high.x, b->low.x - a->high.x)),
                         fmax(0, fmax(a->low.y - b->high.y, b->low.y - a->high.y)),
                         fmax(0, fmax(a->low.z - b->high.z, b->low.z - a->high.z))};
    return mote_length(d);
}

static mote_status add_pair(mote_crowd *crowd, uint32_t a, uint32_t b)
{
    if (crowd->pair_count == crowd->pair_room) {
        const size_t room = 2 * crowd->pair_room + 64;
        uint32_t(*grown)[2] = realloc(crowd->pairs, room * sizeof *grown);
        if (!grown)
            return mote_fail(MOTE_ENOMEM, "no memory for %zu pairs", room);
        crowd->pairs = grown;
        crowd->pair_room = room;
    }
    uint32_t *pair = crowd->pairs[crowd->pair_count++];
    pair[0] = a < b ? a : b;
    pair[1] = a < b ? b : a;
    return MOTE_OK;
}

/* Boxes contain their bodies as rounded; the distance of two of them is rounded again. */
static mote_status find_pairs(mote_crowd *crowd, double within)
{
    const uint32_t count = crowd->body_count;
    const mote_scene_box *bounds = crowd->bounds;
    const double limit = within * (1 + 1e-12);
    const int axis = widest_axis(bounds, count);
    for (uint32_t i = 0; i < count; ++i)
        crowd->sweep[i] = (sweep_entry){along(bounds[i].low, axis), i};
    qsort(crowd->sweep, count, sizeof *crowd->sweep, by_low);
    crowd->pair_count = 0;
    for (uint32_t k = 0; k < count; ++k) {
        const uint32_t a = crowd->sweep[k].body;
        const double end = along(bounds[a].high, axis);
        for (uint32_t l = k + 1; l < count && crowd->sweep[l].low - end <= limit; ++l) {
            const uint32_t b = crowd->sweep[l].body;
            if (gap(&bounds[a], &bounds[b]) <= limit && add_pair(crowd, a, b) != MOTE_OK)
                return MOTE_ENOMEM;
        }
    }
    if (crowd->pair_count > 1)
        qsort(crowd->pairs, crowd->pair_count, sizeof *crowd->pairs, by_bodies);
    return MOTE_OK;
}

mote_status mote_crowd_step(mote_crowd *crowd, const mote_controls *controls, double within,
                            size_t *count)
{
    if (!(within >= 0))
        return mote_fail(MOTE_EINVAL, "within: %g; it must not be negative", within);
    mote_status status = read_states(crowd, controls);
    if (status == MOTE_OK)
        status = mote_scene_bounds(crowd->scene, crowd->states, crowd->bounds);
    if (status == MOTE_OK)
        status = find_pairs(crowd, within);
    const uint32_t(*near)[2];
    size_t near_count;
    if (status == MOTE_OK)
        status = mote_scene_sift(crowd->scene, crowd->states, within,
                                 (const uint32_t(*)[2])crowd->pairs, crowd->pair_count, &near,
                                 &near_count);
    if (status == MOTE_OK)
        status = mote_scene_query(crowd->scene, crowd->states, near, near_count);
    if (status == MOTE_OK)
        *count = near_count;
    return status;
}

static void write_point(double *to, mote_vec3 point)
{
    to[0] = point.x;
    to[1] = point.y;
    to[2] = point.z;
}

void mote_crowd_pairs(const mote_crowd *crowd, uint32_t *pairs, double *distance, double *lower,
                      double *witness, int8_t *contact)
{
    size_t count;
    const mote_scene_pair *found = mote_scene_pairs(crowd->scene, &count);
    for (size_t k = 0; k < count; ++k) {
        if (pairs)
            memcpy(pairs + 2 * k, found[k].body, sizeof found[k].body);
        if (distance)
            distance[k] = found[k].distance;
        if (lower)
            lower[k] = found[k].lower;
        if (contact)
            contact[k] = found[k].decided ? found[k].contact : -1;
        for (size_t b = 0; witness && b < 2; ++b)
            write_point(witness + 6 * k + 3 * b, found[k].witness[b]);
    }
}

void mote_crowd_bounds(const mote_crowd *crowd, double *bounds)
{
    for (size_t i = 0; i < crowd->body_count; ++i) {
        write_point(bounds + 6 * i, crowd->bounds[i].low);
        write_point(bounds + 6 * i + 3, crowd->bounds[i].high);
    }
}
