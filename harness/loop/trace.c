#include "harness/loop/trace.h"

#include "harness/base/file.h"
#include "harness/base/json_print.h"
#include "harness/base/memory.h"
#include "harness/run/scenario_save.h"
#include "harness/scene/bodies_poses.h"
#include "harness/scene/motion.h"
#include "harness/scene/scenario_move.h"
#include "harness/scene/scenario_read.h"

#include <stdlib.h>
#include <string.h>

/* The key poses of body i. */
static json_t *motion_json(const mote_scenario *scenario, const mote_mass *mass,
                           const mote_rigid_state *states, uint32_t count, int i)
{
    json_t *keys = json_array();
    for (uint32_t k = 0; k < count; ++k) {
        const mote_rigid_state *state = &states[(size_t)2 * k + (size_t)i];
        const mote_pose pose = mote_rigid_pose(mass, state);
        const mote_vec3 middle = mote_pose_apply(&pose, scenario->motion->body[i].centre);
        const mote_vec3 p = mote_scale(middle, 1 / scenario->length);
        const mote_quaternion q = state->turn;
        (void)json_array_append_new(keys, json_pack("{s:I, s:[f,f,f], s:[f,f,f,f]}", "frame",
                                                    (json_int_t)k + 1, "position", p.x, p.y,
                                                    p.z, "quaternion", q.w, q.x, q.y, q.z));
    }
    return keys;
}

static mote_status rewrite(json_t *root, const mote_scenario *scenario, const mote_mass mass[2],
                           const mote_rigid_state *states, uint32_t count)
{
    (void)json_object_del(root, "warmup");
    (void)json_object_set_new(root, "frames", json_integer(count));
    (void)json_object_set_new(root, "ask", json_string("distance"));
    char *purpose = mote_format("A simulated run of %s, recorded.", scenario->name);
    (void)json_object_set_new(root, "purpose", json_string(purpose));
    free(purpose);
    mote_status status = MOTE_OK;
    /* Keys are at frames here, and the deformation follows the path. */
    if (scenario->motion->start != 1 || scenario->motion->pace != 1)
        status = mote_fail(MOTE_EINVAL,
                           "%s: start and pace other than 1 cannot be recorded with the motion "
                           "of a simulation; use the scenario that it is like",
                           scenario->path);
    for (int i = 0; i < 2 && status == MOTE_OK; ++i) {
        json_t *body = json_array_get(json_object_get(root, "bodies"), (size_t)i);
        (void)json_object_del(body, "velocity");
        (void)json_object_del(body, "spin");
        (void)json_object_set_new(body, "motion",
                                  motion_json(scenario, &mass[i], states, count, i));
    }
    return status;
}

/* The deformation of a scenario advances by one frame per frame and never reverses. */
static mote_status check_deformation(const mote_scenario *scenario, uint32_t count,
                                     double time_step)
{
    const bool deforms = scenario->body[0].field->count + scenario->body[1].field->count > 0;
    if (!deforms || (time_step == 1 && count <= scenario->frames))
        return MOTE_OK;
    return mote_fail(MOTE_EINVAL,
                     "%s: bodies that deform can be recorded with a time step of 1 and for at "
                     "most %u steps only, not %g and %u",
                     scenario->path, scenario->frames - 1, time_step, count - 1);
}

static mote_status write_pair(const mote_scenario *scenario, const mote_mass mass[2],
                              const mote_rigid_state *states, uint32_t count,
                              const mote_simulation_options *options, const char *path)
{
    mote_json_file file;
    mote_status status = check_deformation(scenario, count, options->time_step);
    if (status == MOTE_OK)
        status = mote_scenario_open(scenario->path, &file);
    if (status != MOTE_OK)
        return status;
    (void)json_object_set_new(file.root, "tolerance", json_real(options->tolerance));
    status = rewrite(file.root, scenario, mass, states, count);
    if (status == MOTE_OK)
        status = mote_scenario_save(&file, 17, NULL, NULL, path);
    mote_json_close(&file);
    return status;
}

/* Converts the simulation to records of all bodies and frames. */
static mote_bodies_record *make_records(const mote_bodies *bodies, const mote_mass *masses,
                                        const mote_rigid_state *states, uint32_t count,
                                        double time_step)
{
    mote_bodies_record *records = mote_allocate((size_t)count * bodies->count, sizeof *records);
    for (uint32_t k = 0; k < count; ++k) {
        for (uint32_t i = 0; i < bodies->count; ++i) {
            const uint32_t shape = bodies->shape_of[i];
            const size_t r = (size_t)k * bodies->count + i;
            const mote_pose pose = mote_rigid_pose(&masses[shape], &states[r]);
            records[r] = (mote_bodies_record){
                .middle = mote_pose_apply(&pose, bodies->shapes[shape].motion.centre),
                .turn = states[r].turn,
                .deformation = mote_bodies_deformation(bodies, i, 1 + k * time_step)};
        }
    }
    return records;
}

static void rewrite_scene(json_t *root, const mote_bodies *bodies, uint32_t count,
                          double tolerance, const char *poses)
{
    static const char *const replaced[] = {"near_pairs", "places", "seed", "speed", "spin"};
    const mote_vec3 box = mote_scale(bodies->box, 2 / bodies->length);
    json_t *node = json_object_get(root, "bodies");
    char *purpose = mote_format("A simulated run of %s, recorded.", bodies->name);
    (void)json_object_set_new(root, "purpose", json_string(purpose));
    (void)json_object_set_new(root, "frames", json_integer(count));
    (void)json_object_set_new(root, "ask", json_string("distance"));
    (void)json_object_set_new(root, "tolerance", json_real(tolerance));
    for (size_t k = 0; k < sizeof replaced / sizeof replaced[0]; ++k)
        (void)json_object_del(node, replaced[k]);
    (void)json_object_set_new(node, "box", json_pack("[f,f,f]", box.x, box.y, box.z));
    (void)json_object_set_new(node, "poses", json_string(poses));
    free(purpose);
}

static mote_status write_json(const json_t *root, const char *path)
{
    mote_text text = {0};
    mote_json_print(root, 17, &text);
    const mote_status status = mote_file_write(path, text.data, text.size);
    free(text.data);
    return status;
}

static mote_status write_scene(const mote_bodies *bodies, const mote_mass *masses,
                               const mote_rigid_state *states, uint32_t count,
                               const mote_simulation_options *options, const char *path)
{
    mote_json_file file;
    if (mote_path_is_stream(path))
        return mote_fail(MOTE_EINVAL, "%s: poses are written beside the scenario; name a file",
                         path);
    mote_status status = mote_scenario_open(bodies->path, &file);
    if (status != MOTE_OK)
        return status;
    const size_t ending = mote_name_ends(path, ".json") ? strlen(".json") : 0;
    char *poses = mote_format("%.*s.poses.csv", (int)(strlen(path) - ending), path);
    const char *slash = strrchr(poses, '/');
    mote_bodies_record *records =
        make_records(bodies, masses, states, count, options->time_step);
    rewrite_scene(file.root, bodies, count, options->tolerance, slash ? slash + 1 : poses);
    status = mote_bodies_poses_write(poses, bodies, records, count);
    if (status == MOTE_OK)
        status = mote_scenario_move(&file, path);
    if (status == MOTE_OK)
        status = write_json(file.root, path);
    free(records);
    free(poses);
    mote_json_close(&file);
    return status;
}

mote_status mote_trace_write(const mote_subject *subject, const mote_mass *masses,
                             const mote_rigid_state *states, uint32_t count,
                             const mote_simulation_options *options, const char *path)
{
    return subject->bodies
               ? write_scene(subject->bodies, masses, states, count, options, path)
               : write_pair(subject->scenario, masses, states, count, options, path);
}
