#include "harness/scene/bodies_place.h"

#include "harness/base/memory.h"

#include "baselines/broad_phase.h"
#include "core/base/random.h"
#include "harness/engine/box_grid.h"
#include "harness/engine/probe.h"

#include <stdlib.h>
#include <string.h>

/* Minimum distance of surfaces at frame 1, in L. */
#define CLEARANCE 0.01

/* Positions tried for a body before the box counts as full. */
#define TRIES 3000

/* The number of frames in which near pairs are counted, and the relative deviation allowed from
   the requested number. */
#define SAMPLES 33
#define NEAR_SHARE 0.1

typedef struct placing {
    mote_bodies *bodies;
    const mote_bodies_wish *wish;
    mote_random random;
    mote_vec3 *fractions; /* [count], of room, -1 .. 1 */
    mote_probe *probe;
    mote_broad_phase *broad;
    mote_bodies_frame frame;
    mote_scene_box *boxes; /* [count] */
    mote_box_grid *placed; /* the bodies whose places are settled */
} placing;

static void draw_path(placing *p, uint32_t i)
{
    mote_bodies_path *path = &p->bodies->paths[i];
    const double length = p->bodies->length;
    mote_vec3 *u = &p->fractions[i];
    u->x = 2 * mote_random_unit(&p->random) - 1;
    u->y = 2 * mote_random_unit(&p->random) - 1;
    u->z = 2 * mote_random_unit(&p->random) - 1;
    path->velocity = mote_scale(mote_random_direction(&p->random), p->wish->speed * length);
    path->axis = mote_random_direction(&p->random);
    path->degrees = 360 * mote_random_unit(&p->random);
    path->spin = p->wish->spin;
    /* Keyed deformations end with the last key, positions with the last frame, and clips that
       do not loop with the clip, so their bodies have no time offset. */
    const double time = floor(1e6 * mote_random_unit(&p->random));
    const mote_body_motion *motion = &p->bodies->shapes[p->bodies->shape_of[i]].motion;
    const bool ends =
        motion->keyed || motion->sequence || (motion->player && !motion->player->loop);
    path->time = ends ? 0 : time;
}

static void place_body(placing *p, uint32_t i)
{
    const mote_vec3 *u = &p->fractions[i], *room = &p->bodies->room;
    if (p->wish->places)
        p->bodies->paths[i].place = p->wish->places[i];
    else
        p->bodies->paths[i].place =
            mote_vec3_make(u->x * room->x, u->y * room->y, u->z * room->z);
}

/* Sets the box with these half edges, and the room in it for the bodies' middles. */
static void set_room(mote_bodies *b, mote_vec3 half)
{
    double radius = 0;
    for (uint32_t s = 0; s < b->shape_count; ++s)
        radius = fmax(radius, b->shapes[s].radius);
    b->box = half;
    b->room = mote_sub(half, mote_vec3_make(radius, radius, radius));
}

static void set_box(placing *p, mote_vec3 half)
{
    const mote_bodies *b = p->bodies;
    set_room(p->bodies, half);
    for (uint32_t i = 0; i < b->count; ++i)
        place_body(p, i);
}

/* Counts the near pairs of a frame by the bounds of the bodies. */
static mote_status count_near(placing *p, double number, size_t *count)
{
    const uint32_t(*pairs)[2];
    mote_status status = mote_bodies_frame_set(p->bodies, number, &p->frame);
    if (status == MOTE_OK)
        status = mote_probe_all(p->probe, p->frame.states, p->boxes);
    if (status == MOTE_OK)
        status = mote_broad_phase_pairs(p->broad, p->boxes, p->bodies->near, &pairs, count);
    return status;
}

/* Near pairs per body, averaged over frames spread evenly; over fewer frames if there are many
   bodies. */
static mote_status near_pairs(placing *p, double *mean)
{
    const mote_bodies *b = p->bodies;
    uint32_t samples = 1 + 20000 / b->count;
    samples = samples > SAMPLES ? SAMPLES : samples;
    samples = samples > b->frames ? b->frames : samples;
    double sum = 0;
    for (uint32_t k = 0; k < samples; ++k) {
        size_t count = 0;
        const double place = samples > 1 ? (double)k / (samples - 1) : 0;
        mote_status status = count_near(p, 1 + floor(place * (b->frames - 1)), &count);
        if (status != MOTE_OK)
            return status;
        sum += (double)count;
    }
    *mean = sum / samples / b->count;
    return MOTE_OK;
}

static mote_status not_reached(const placing *p, double found)
{
    return mote_fail(MOTE_EINVAL,
                     "%u bodies have %.3g near pairs each in the box that comes nearest to the "
                     "%g asked for; ask for a number that they can have, or give the box",
                     p->bodies->count, found, p->wish->near_pairs);
}

/* Finds the cube with the requested number of near pairs, by bisection of its edge. */
static mote_status find_box(placing *p)
{
    mote_bodies *b = p->bodies;
    double radius = 0, found = 0;
    for (uint32_t s = 0; s < b->shape_count; ++s)
        radius = fmax(radius, b->shapes[s].radius);
    double low = 0, high = b->length * (1 + cbrt((double)b->count) * 16);
    mote_status status = MOTE_OK;
    for (int k = 0; k < 30 && status == MOTE_OK; ++k) {
        const double room = (low + high) / 2;
        const double half = room + radius;
        set_box(p, mote_vec3_make(half, half, half));
        status = near_pairs(p, &found);
        if (fabs(found - p->wish->near_pairs) <= NEAR_SHARE / 4 * p->wish->near_pairs)
            break;
        if (found > p->wish->near_pairs)
            low = room;
        else
            high = room;
    }
    b->near_pairs = found;
    if (status == MOTE_OK &&
        !(fabs(found - p->wish->near_pairs) <= NEAR_SHARE * p->wish->near_pairs))
        return not_reached(p, found);
    return status;
}

/* The first body below i that is too close to body i; i: none. */
static mote_status find_overlap(placing *p, uint32_t i, uint32_t *other, double *distance)
{
    const double clearance = CLEARANCE * p->bodies->length;
    size_t count;
    const uint32_t *near = mote_box_grid_near(p->placed, &p->boxes[i], clearance, &count);
    for (size_t k = 0; k < count; ++k) {
        bool too_near;
        mote_status status =
            mote_probe_pair(p->probe, p->frame.states, near[k], i, &too_near, distance);
        if (status != MOTE_OK)
            return status;
        if (too_near) {
            *other = near[k];
            return MOTE_OK;
        }
    }
    *other = i;
    return MOTE_OK;
}

static mote_status set_body(placing *p, uint32_t i)
{
    const mote_pose pose = mote_bodies_pose(p->bodies, i, 1);
    const mote_status status = mote_bodies_deform(p->bodies, i, 1, &pose, &p->frame);
    return status == MOTE_OK ? mote_probe_one(p->probe, p->frame.states, i, p->boxes) : status;
}

/* Draws new positions for bodies that overlap those before them. */
static mote_status separate(placing *p)
{
    const mote_bodies *b = p->bodies;
    uint32_t other = 0;
    double distance = 0;
    mote_status status = mote_bodies_frame_set(b, 1, &p->frame);
    if (status == MOTE_OK)
        status = mote_probe_all(p->probe, p->frame.states, p->boxes);
    for (uint32_t i = 0; i < b->count && status == MOTE_OK; ++i) {
        status = set_body(p, i);
        for (uint32_t tries = 0; status == MOTE_OK; ++tries) {
            status = find_overlap(p, i, &other, &distance);
            if (status != MOTE_OK || other == i)
                break;
            if (p->wish->places)
                return mote_fail(MOTE_EINVAL,
                                 "bodies %u and %u are %.3g L apart at frame 1; start them at "
                                 "least %g L apart",
                                 other + 1, i + 1, distance / b->length, CLEARANCE);
            if (tries == TRIES)
                return mote_fail(MOTE_EINVAL,
                                 "the box, %.3g by %.3g by %.3g L, holds %u of the %u bodies "
                                 "without overlap; give it more room, or have fewer bodies",
                                 2 * b->box.x / b->length, 2 * b->box.y / b->length,
                                 2 * b->box.z / b->length, i, b->count);
            draw_path(p, i);
            place_body(p, i);
            status = set_body(p, i);
        }
        if (status == MOTE_OK)
            mote_box_grid_add(p->placed, i);
    }
    return status;
}

static mote_status check_box(const placing *p)
{
    const mote_bodies *b = p->bodies;
    if (!(b->room.x >= 0 && b->room.y >= 0 && b->room.z >= 0))
        return mote_fail(MOTE_EINVAL,
                         "the box, %.3g by %.3g by %.3g L, is smaller than a body, which turns "
                         "within %.3g L; give a larger one",
                         2 * b->box.x / b->length, 2 * b->box.y / b->length,
                         2 * b->box.z / b->length, 2 * (b->box.x - b->room.x) / b->length);
    for (uint32_t i = 0; i < b->count && p->wish->places; ++i) {
        const mote_vec3 *at = &p->wish->places[i];
        if (fabs(at->x) > b->room.x || fabs(at->y) > b->room.y || fabs(at->z) > b->room.z)
            return mote_fail(MOTE_EINVAL,
                             "body %u does not turn within the box; its middle has room from "
                             "%.3g to %.3g L, %.3g to %.3g L, and %.3g to %.3g L",
                             i + 1, -b->room.x / b->length, b->room.x / b->length,
                             -b->room.y / b->length, b->room.y / b->length,
                             -b->room.z / b->length, b->room.z / b->length);
    }
    return MOTE_OK;
}

static mote_status prepare(placing *p)
{
    mote_bodies *b = p->bodies;
    mote_engine_setup setup = {
        .shape_count = b->shape_count, .shape_of = b->shape_of, .count = b->count};
    for (uint32_t s = 0; s < b->shape_count; ++s)
        setup.shapes[s] = &b->shapes[s].body;
    p->fractions = mote_allocate(b->count, sizeof *p->fractions);
    p->boxes = mote_allocate(b->count, sizeof *p->boxes);
    p->placed = mote_box_grid_create(p->boxes, b->count);
    p->frame = mote_bodies_frame_create(b);
    mote_status status = mote_probe_create(&setup, CLEARANCE * b->length, &p->probe);
    if (status == MOTE_OK)
        status = mote_broad_phase_create(b->count, &p->broad);
    for (uint32_t i = 0; i < b->count && status == MOTE_OK; ++i)
        draw_path(p, i);
    return status;
}

mote_status mote_bodies_place(mote_bodies *bodies, const mote_bodies_wish *wish)
{
    if (bodies->recorded) { /* the recorded positions */
        set_room(bodies, mote_scale(wish->box, bodies->length / 2));
        return MOTE_OK;
    }
    placing p = {.bodies = bodies, .wish = wish, .random = {wish->seed}};
    mote_status status = prepare(&p);
    if (status == MOTE_OK && wish->near_pairs > 0)
        status = find_box(&p);
    else if (status == MOTE_OK)
        set_box(&p, mote_scale(wish->box, bodies->length / 2));
    if (status == MOTE_OK)
        status = check_box(&p);
    if (status == MOTE_OK)
        status = separate(&p);
    mote_bodies_frame_free(&p.frame);
    mote_broad_phase_destroy(p.broad);
    mote_probe_destroy(p.probe);
    mote_box_grid_destroy(p.placed);
    free(p.fractions);
    free(p.boxes);
    return status;
}
