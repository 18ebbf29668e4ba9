#include "harness/loop/bodies_simulate.h"

#include "core/body/deform.h"
#include "harness/run/measure.h"
#include "harness/loop/penetration.h"

#include <stdlib.h>
#include <string.h>

/* The last witnesses of a near pair that was apart. */
typedef struct normal {
    uint32_t body[2];
    bool known;
    mote_vec3 witness[2];
} normal;

typedef struct simulation {
    mote_bodies bodies; /* the scenario with the tolerance of contact; borrows all of it */
    const mote_simulation_options *options;
    uint64_t seed; /* of the method */
    mote_vec3 gravity;
    mote_mass mass[MOTE_BODIES_SHAPES_MAX];
    mote_deform *deform[MOTE_BODIES_SHAPES_MAX];
    mote_penetration **penetration; /* [shapes][shapes], made when first asked for */
    mote_vec3 *world[2];
    mote_bodies_engine *method, *truth;
    mote_bodies_frame frame;
    mote_rigid_state *states; /* [count] */
    double *start_height;     /* [count]: potential of the start, (g, centre) */
    normal *normals, *spare;  /* of the near pairs, ascending */
    size_t normal_count, normal_room;
    double lost;          /* energy, in impacts */
    mote_vec3 from_walls; /* momentum */
    mote_bodies_simulation result;
} simulation;

static uint32_t shape_of(const simulation *s, uint32_t i)
{
    return s->bodies.shape_of[i];
}

static mote_status weigh_shapes(simulation *s)
{
    mote_status status = MOTE_OK;
    uint32_t most = 1;
    for (uint32_t k = 0; k < s->bodies.shape_count && status == MOTE_OK; ++k) {
        const mote_body *body = &s->bodies.shapes[k].body;
        most = body->mesh->vertex_count > most ? body->mesh->vertex_count : most;
        status = mote_mass_of_mesh(body->mesh, s->options->density, &s->mass[k]);
        if (status != MOTE_OK)
            return mote_fail(status, "%s: shape %u cannot respond to a collision: %s",
                             s->bodies.path, k + 1, mote_error_text());
        status = mote_deform_create(body, &s->deform[k]);
    }
    const size_t pairs = (size_t)s->bodies.shape_count * s->bodies.shape_count;
    s->penetration = calloc(pairs + 1, sizeof(mote_penetration *));
    for (int b = 0; b < 2; ++b)
        s->world[b] = malloc(most * sizeof(mote_vec3));
    if (status == MOTE_OK && (!s->penetration || !s->world[0] || !s->world[1]))
        status = mote_fail(MOTE_ENOMEM, "no memory for a simulation");
    return status;
}

/* Bodies where their paths begin, as they move there. */
static mote_status start_bodies(simulation *s)
{
    const uint32_t count = s->bodies.count;
    s->states = calloc(count, sizeof *s->states);
    s->start_height = calloc(count, sizeof *s->start_height);
    if (!s->states || !s->start_height)
        return mote_fail(MOTE_ENOMEM, "no memory for %u bodies", count);
    for (uint32_t i = 0; i < count; ++i) {
        const mote_bodies_path *path = &s->bodies.paths[i];
        const mote_mass *mass = &s->mass[shape_of(s, i)];
        const mote_pose pose = mote_bodies_pose(&s->bodies, i, 1);
        const mote_vec3 spin = mote_scale(path->axis, path->spin * 0.017453292519943295);
        mote_rigid_state *state = &s->states[i];
        state->centre = mote_pose_apply(&pose, mass->centre);
        state->turn =
            mote_quaternion_normalise(mote_quaternion_about(path->axis, path->degrees));
        state->velocity =
            mote_add(path->velocity, mote_cross(spin, mote_sub(state->centre, path->place)));
        state->angular_momentum = mote_rigid_angular_momentum(mass, state, spin);
        s->start_height[i] = mote_dot(s->gravity, state->centre);
    }
    return MOTE_OK;
}

static mote_status open_engines(simulation *s, const mote_method_choice *choice)
{
    mote_method_choice exact;
    const bool certified = strcmp(choice->method->name, "certified") == 0;
    mote_status status = mote_scene_choice_read(certified ? "aabb-tree" : "certified", &exact);
    if (status == MOTE_OK)
        status = mote_bodies_engine_create(&s->bodies, choice, s->seed, &s->method);
    if (status == MOTE_OK)
        status = mote_bodies_engine_create(&s->bodies, &exact, 1, &s->truth);
    if (status == MOTE_OK)
        status = mote_bodies_frame_create(&s->bodies, &s->frame);
    return status;
}

static void set_frame(simulation *s, uint32_t k)
{
    for (uint32_t i = 0; i < s->bodies.count; ++i) {
        const mote_pose pose = mote_rigid_pose(&s->mass[shape_of(s, i)], &s->states[i]);
        mote_bodies_deform(&s->bodies, i, 1 + k * s->options->time_step, &pose, &s->frame);
    }
}

/* Makes normals those of the near pairs: from this answer where they are apart, else from the
   last one. */
static mote_status update_normals(simulation *s, const mote_bodies_pair *pairs, size_t count)
{
    if (count > s->normal_room) {
        const size_t room = 2 * count + 16;
        normal *normals = realloc(s->normals, room * sizeof *normals);
        s->normals = normals ? normals : s->normals;
        normal *spare = realloc(s->spare, room * sizeof *spare);
        s->spare = spare ? spare : s->spare;
        if (!normals || !spare)
            return mote_fail(MOTE_ENOMEM, "no memory for %zu near pairs", count);
        s->normal_room = room;
    }
    size_t old = 0;
    for (size_t k = 0; k < count; ++k) {
        const mote_answer *a = &pairs[k].answer;
        normal *made = &s->spare[k];
        *made = (normal){.body = {pairs[k].body[0], pairs[k].body[1]}};
        while (old < s->normal_count && mote_pair_order(s->normals[old].body, made->body) < 0)
            ++old;
        if (old < s->normal_count && mote_pair_order(s->normals[old].body, made->body) == 0)
            *made = s->normals[old];
        if (a->has_witness && a->has_distance && a->distance > 0 &&
            mote_distance_squared(a->witness[0], a->witness[1]) > 0) {
            made->known = true;
            memcpy(made->witness, a->witness, sizeof made->witness);
        }
    }
    normal *swapped = s->normals;
    s->normals = s->spare;
    s->spare = swapped;
    s->normal_count = count;
    return MOTE_OK;
}

static mote_status respond(simulation *s, const mote_method_choice *choice,
                           const mote_bodies_pair *pair, const normal *along)
{
    if (!along->known)
        return mote_fail(MOTE_EUNSUPPORTED,
                         "%s reports a contact of bodies %u and %u but has given no witness "
                         "points of them: there is no normal to respond along",
                         choice->text, pair->body[0] + 1, pair->body[1] + 1);
    const mote_mass *mass[2];
    mote_rigid_state *state[2];
    for (int b = 0; b < 2; ++b) {
        mass[b] = &s->mass[shape_of(s, pair->body[b])];
        state[b] = &s->states[pair->body[b]];
    }
    mote_impact impact;
    const mote_vec3 point = mote_scale(mote_add(along->witness[0], along->witness[1]), 0.5);
    mote_status status =
        mote_respond(mass, point, mote_sub(along->witness[1], along->witness[0]),
                     s->options->restitution, state, &impact);
    if (status == MOTE_OK) {
        s->result.responses += impact.approaching;
        s->lost += impact.energy;
    }
    return status;
}

static mote_status depth_of(void *context, const uint32_t body[2], double above, double *depth)
{
    simulation *s = context;
    const uint32_t a = shape_of(s, body[0]), b = shape_of(s, body[1]);
    mote_penetration **place = &s->penetration[(size_t)a * s->bodies.shape_count + b];
    mote_status status = MOTE_OK;
    if (!*place)
        status = mote_penetration_create(s->bodies.shapes[a].body.mesh,
                                         s->bodies.shapes[b].body.mesh, place);
    if (status != MOTE_OK)
        return status;
    mote_deform_all(s->deform[a], &s->frame.states[body[0]], s->world[0]);
    mote_deform_all(s->deform[b], &s->frame.states[body[1]], s->world[1]);
    return mote_penetration_depth(*place, s->world[0], s->world[1], above, depth);
}

/* Turns a coordinate of the velocity back at a wall. */
static void bounce(simulation *s, double mass, double centre, double room, double *velocity,
                   double *from_walls)
{
    if (!((centre > room && *velocity > 0) || (centre < -room && *velocity < 0)))
        return;
    *from_walls -= 2 * mass * *velocity;
    *velocity = -*velocity;
    ++s->result.bounces;
}

static mote_status move_on(simulation *s)
{
    mote_status status = MOTE_OK;
    const mote_vec3 *room = &s->bodies.room;
    for (uint32_t i = 0; i < s->bodies.count && status == MOTE_OK; ++i) {
        const mote_mass *mass = &s->mass[shape_of(s, i)];
        mote_rigid_state *state = &s->states[i];
        status = mote_rigid_step(mass, s->gravity, s->options->time_step, state);
        bounce(s, mass->mass, state->centre.x, room->x, &state->velocity.x, &s->from_walls.x);
        bounce(s, mass->mass, state->centre.y, room->y, &state->velocity.y, &s->from_walls.y);
        bounce(s, mass->mass, state->centre.z, room->z, &state->velocity.z, &s->from_walls.z);
    }
    return status;
}

/* What should stay as it is, and the sizes that changes are measured by. */
typedef struct invariants {
    double energy, energy_size, momentum_size;
    mote_vec3 momentum;
} invariants;

static invariants invariants_of(const simulation *s, double time)
{
    invariants sum = {.energy = s->lost, .momentum = mote_scale(s->from_walls, -1)};
    for (uint32_t i = 0; i < s->bodies.count; ++i) {
        const mote_mass *mass = &s->mass[shape_of(s, i)];
        const mote_rigid_state *state = &s->states[i];
        const double kinetic = mote_rigid_kinetic_energy(mass, state);
        const double fallen = mote_dot(s->gravity, state->centre) - s->start_height[i];
        sum.energy += kinetic - mass->mass * fallen;
        sum.energy_size += kinetic;
        sum.momentum = mote_add_scaled(sum.momentum, mass->mass,
                                       mote_add_scaled(state->velocity, -time, s->gravity));
        sum.momentum_size += mass->mass * mote_length(state->velocity);
    }
    return sum;
}

static void note_drift(simulation *s, invariants *first, uint32_t k)
{
    const invariants now = invariants_of(s, k * s->options->time_step);
    first->energy_size = fmax(first->energy_size, now.energy_size);
    first->momentum_size = fmax(first->momentum_size, now.momentum_size);
    if (first->energy_size > 0)
        s->result.energy_drift =
            fmax(s->result.energy_drift, fabs(now.energy - first->energy) / first->energy_size);
    if (first->momentum_size > 0)
        s->result.momentum_drift =
            fmax(s->result.momentum_drift,
                 mote_length(mote_sub(now.momentum, first->momentum)) / first->momentum_size);
}

static mote_status starts_apart(const simulation *s, const mote_bodies_pair *truth,
                                size_t count)
{
    for (size_t k = 0; k < count; ++k) {
        if (truth[k].answer.contact)
            return mote_fail(MOTE_EINVAL,
                             "%s: bodies %u and %u start in contact (%g L apart), where no "
                             "normal is known; start them more than the tolerance of %g L "
                             "apart",
                             s->bodies.path, truth[k].body[0] + 1, truth[k].body[1] + 1,
                             truth[k].answer.distance / s->bodies.length,
                             s->options->tolerance);
    }
    return MOTE_OK;
}

static mote_status step(simulation *s, const mote_method_choice *choice, uint32_t k)
{
    mote_bodies_step cost = {0};
    size_t said_count, truth_count;
    set_frame(s, k);
    const uint64_t from = mote_clock_ns();
    mote_status status = mote_bodies_engine_step(s->method, s->frame.states, &cost);
    s->result.query_ns += (double)(mote_clock_ns() - from);
    s->result.near_pairs += (double)cost.pairs;
    if (status == MOTE_OK)
        status = mote_bodies_engine_step(s->truth, s->frame.states, &cost);
    if (status != MOTE_OK)
        return status;
    const mote_bodies_pair *said = mote_bodies_engine_pairs(s->method, &said_count);
    const mote_bodies_pair *truth = mote_bodies_engine_pairs(s->truth, &truth_count);
    if (k == 0)
        status = starts_apart(s, truth, truth_count);
    if (status == MOTE_OK)
        status = mote_bodies_book_step(&s->result.book, k, truth, truth_count, said, said_count,
                                       depth_of, s);
    if (status == MOTE_OK)
        status = update_normals(s, said, said_count);
    for (size_t p = 0; p < said_count && status == MOTE_OK; ++p) {
        if (said[p].answer.contact)
            status = respond(s, choice, &said[p], &s->normals[p]);
    }
    return status;
}

static mote_status loop(simulation *s, const mote_method_choice *choice, uint32_t steps)
{
    invariants first = invariants_of(s, 0);
    mote_status status = MOTE_OK;
    for (uint32_t k = 0; status == MOTE_OK; ++k) {
        status = step(s, choice, k);
        s->result.steps = k;
        if (status != MOTE_OK || k == steps)
            break;
        note_drift(s, &first, k);
        status = move_on(s);
    }
    note_drift(s, &first, s->result.steps);
    mote_bodies_book_end(&s->result.book);
    s->result.near_pairs /= s->result.steps + 1.0;
    s->result.query_ns /= s->result.steps + 1.0;
    return status;
}

static void close_simulation(simulation *s)
{
    const uint32_t shapes = s->bodies.shape_count;
    for (uint32_t k = 0; k < shapes; ++k)
        mote_deform_destroy(s->deform[k]);
    for (size_t k = 0; s->penetration && k < (size_t)shapes * shapes; ++k)
        mote_penetration_destroy(s->penetration[k]);
    free(s->penetration);
    free(s->world[0]);
    free(s->world[1]);
    mote_bodies_engine_destroy(s->method);
    mote_bodies_engine_destroy(s->truth);
    mote_bodies_frame_free(&s->frame);
    mote_bodies_book_free(
        &(mote_bodies_book){.touches = s->result.book.touches, .spare = s->result.book.spare});
    s->result.book.touches = s->result.book.spare = NULL;
    free(s->states);
    free(s->start_height);
    free(s->normals);
    free(s->spare);
    free(s);
}

mote_status mote_bodies_simulate(const mote_bodies *bodies, const mote_method_choice *choice,
                                 const mote_simulation_options *options, uint32_t steps,
                                 uint64_t seed, mote_bodies_simulation *result)
{
    mote_status status = mote_simulation_options_check(options);
    if (status != MOTE_OK)
        return status;
    if (options->tolerance * bodies->length > bodies->near)
        return mote_fail(MOTE_EINVAL,
                         "contact tolerance %g L is above near, %g L; contacts would be missed",
                         options->tolerance, bodies->near / bodies->length);
    simulation *s = calloc(1, sizeof *s);
    if (!s)
        return mote_fail(MOTE_ENOMEM, "no memory for a simulation");
    s->bodies = *bodies;
    s->bodies.ask = MOTE_ASK_DISTANCE;
    s->bodies.tolerance = options->tolerance * bodies->length;
    s->options = options;
    s->seed = seed;
    s->gravity = mote_scale(options->gravity, bodies->length);
    status = weigh_shapes(s);
    if (status == MOTE_OK)
        status = start_bodies(s);
    if (status == MOTE_OK)
        status = open_engines(s, choice);
    if (status == MOTE_OK)
        status = loop(s, choice, steps);
    mote_bodies_simulation made = s->result;
    close_simulation(s);
    made.book.touches = made.book.spare = NULL;
    if (status == MOTE_OK)
        *result = made;
    return status;
}
