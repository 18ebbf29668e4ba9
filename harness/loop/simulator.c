#include "harness/loop/simulator.h"

#include "harness/loop/between.h"
#include "harness/base/memory.h"
#include "harness/scene/motion.h"

#include <stdlib.h>
#include <string.h>

/* Makes a simulator with the bodies of the subject. */
static mote_simulator *new_simulator(const mote_subject *subject,
                                     const mote_method_choice *choice,
                                     const mote_simulation_options *options)
{
    const mote_engine_setup bodies = mote_subject_engine(subject);
    const uint32_t count = bodies.count, shape_count = bodies.shape_count;
    mote_simulator *made = mote_allocate(1, sizeof *made);
    made->choice = *choice;
    made->options = *options;
    made->gravity = mote_scale(options->gravity, bodies.length);
    made->frames = mote_subject_facts_of(subject).frames;
    made->shapes = mote_copy(bodies.shapes, shape_count * sizeof(const mote_body *));
    made->shape_of = mote_copy(bodies.shape_of, count * sizeof *made->shape_of);
    made->masses = mote_allocate(shape_count, sizeof *made->masses);
    made->start = mote_allocate(count, sizeof *made->start);
    made->deform = mote_allocate(shape_count, sizeof(mote_deform *));
    made->penetrations =
        mote_allocate((size_t)shape_count * shape_count, sizeof(mote_penetration *));
    made->bodies = (mote_simulated){.name = mote_subject_facts_of(subject).name,
                                    .length = bodies.length,
                                    .count = count,
                                    .shape_count = shape_count,
                                    .shapes = made->shapes,
                                    .shape_of = made->shape_of};
    if (subject->bodies) {
        made->bodies.path = subject->bodies->path;
        made->room = subject->bodies->room;
    } else {
        made->bodies.path = subject->scenario->path;
        made->room = (mote_vec3){HUGE_VAL, HUGE_VAL, HUGE_VAL};
    }
    return made;
}

/* Computes the masses of all shapes; makes room for the vertices of the largest. */
static mote_status weigh_shapes(mote_simulator *s, bool many)
{
    uint32_t most = 0;
    for (uint32_t k = 0; k < s->bodies.shape_count; ++k) {
        const mote_mesh *mesh = s->shapes[k]->mesh;
        if (mesh->open_edge_count > 0)
            return mote_fail(MOTE_EINVAL,
                             "%s: %s %u cannot respond to a collision: its mesh is open (%u "
                             "edges have one face), so that it has no volume and no mass; give "
                             "a mesh without open edges, which `mote mesh FILE` counts, or "
                             "measure the scenario with `mote run`",
                             s->bodies.path, many ? "shape" : "body", k + 1,
                             mesh->open_edge_count);
        const mote_status status = mote_mass_of_mesh(mesh, s->options.density, &s->masses[k]);
        if (status != MOTE_OK)
            return mote_fail(status, "%s: %s %u cannot respond to a collision: %s",
                             s->bodies.path, many ? "shape" : "body", k + 1, mote_error_text());
        most = mesh->vertex_count > most ? mesh->vertex_count : most;
    }
    for (int i = 0; i < 2; ++i)
        s->world[i] = mote_allocate(most, sizeof(mote_vec3));
    return MOTE_OK;
}

static mote_quaternion turn_at(const mote_body_motion *motion, double place)
{
    double q[4] = {1, 0, 0, 0};
    if (motion->rotation)
        mote_curve_evaluate(motion->rotation, place, q);
    return mote_quaternion_normalise((mote_quaternion){q[0], q[1], q[2], q[3]});
}

/* The state of a moving body: velocity is that of the point `middle`, in the world. */
static mote_rigid_state state_of(const mote_mass *mass, const mote_pose *pose,
                                 mote_quaternion turn, mote_vec3 middle, mote_vec3 velocity,
                                 mote_vec3 spin)
{
    mote_rigid_state state = {.centre = mote_pose_apply(pose, mass->centre), .turn = turn};
    state.velocity = mote_add(velocity, mote_cross(spin, mote_sub(state.centre, middle)));
    state.angular_momentum = mote_rigid_angular_momentum(mass, &state, spin);
    return state;
}

static void start_pair(mote_simulator *s, const mote_scenario *scenario)
{
    for (int i = 0; i < 2; ++i) {
        const mote_body_motion *motion = &scenario->motion->body[i];
        const mote_pose pose = mote_motion_pose(motion, scenario->motion->start);
        mote_vec3 velocity, spin;
        mote_scenario_velocity(scenario, i, &velocity, &spin);
        s->start[i] = state_of(&s->masses[i], &pose, turn_at(motion, scenario->motion->start),
                               mote_pose_apply(&pose, motion->centre), velocity, spin);
    }
}

static void start_scene(mote_simulator *s, const mote_bodies *bodies)
{
    for (uint32_t i = 0; i < bodies->count; ++i) {
        const mote_bodies_path *path = &bodies->paths[i];
        const mote_pose pose = mote_bodies_pose(bodies, i, 1);
        const mote_vec3 spin = mote_scale(path->axis, path->spin * 0.017453292519943295);
        s->start[i] = state_of(&s->masses[s->shape_of[i]], &pose, mote_bodies_turn(bodies, i),
                               path->place, path->velocity, spin);
    }
}

mote_status mote_simulator_create(const mote_subject *subject, const mote_method_choice *choice,
                                  const mote_simulation_options *options,
                                  mote_simulator **simulator)
{
    mote_status status = mote_simulation_options_check(options);
    if (status == MOTE_OK && subject->bodies)
        status = mote_engine_check_choice(choice);
    if (status == MOTE_OK && options->within == MOTE_STEPS_CONTINUOUS &&
        strcmp(choice->method->name, "certified") != 0)
        status = mote_fail(MOTE_EUNSUPPORTED,
                           "%s does not find impacts between the ends of steps; choose "
                           "certified, or sampled steps",
                           choice->text);
    if (status != MOTE_OK)
        return status;
    status = mote_stage_refuse_given(subject); /* a cloth, rather than: is open */
    if (status != MOTE_OK)
        return status;
    mote_simulator *made = new_simulator(subject, choice, options);
    status = weigh_shapes(made, subject->bodies != NULL);
    if (status == MOTE_OK && subject->bodies)
        start_scene(made, subject->bodies);
    else if (status == MOTE_OK)
        start_pair(made, subject->scenario);
    if (status == MOTE_OK)
        status = mote_stage_create(subject, choice, &made->options, made->masses, &made->stage);
    if (status == MOTE_OK)
        status = mote_between_create(made, &made->between);
    if (status == MOTE_OK)
        *simulator = made;
    else
        mote_simulator_destroy(made);
    return status;
}

void mote_simulator_destroy(mote_simulator *simulator)
{
    if (!simulator)
        return;
    const size_t shapes = simulator->bodies.shape_count;
    mote_between_destroy(simulator->between);
    mote_stage_destroy(simulator->stage);
    for (size_t k = 0; k < shapes; ++k)
        mote_deform_destroy(simulator->deform[k]);
    for (size_t k = 0; k < shapes * shapes; ++k)
        mote_penetration_destroy(simulator->penetrations[k]);
    free(simulator->deform);
    free(simulator->penetrations);
    free(simulator->world[0]);
    free(simulator->world[1]);
    free(simulator->start);
    free(simulator->masses);
    free(simulator->shape_of);
    free(simulator->shapes);
    free(simulator);
}

mote_simulated mote_simulator_bodies(const mote_simulator *simulator)
{
    return simulator->bodies;
}

const mote_mass *mote_simulator_masses(const mote_simulator *simulator)
{
    return simulator->masses;
}

mote_simulation_start mote_simulation_start_of(const mote_simulator *simulator)
{
    const double steps = ceil((simulator->frames - 1.0) / simulator->options.time_step);
    return (mote_simulation_start){
        .states = simulator->start,
        .first = 1,
        .steps = (uint32_t)fmin(fmax(steps, 1), MOTE_SIMULATION_STEPS_MAX),
        .seed = 1};
}
