/* Reads a scenario file of several bodies. */
#include "harness/scene/bodies_place.h"
#include "harness/scene/bodies_poses.h"
#include "harness/base/file.h"
#include "harness/base/memory.h"
#include "harness/scene/fence.h"
#include "harness/scene/scenario_read.h"
#include "harness/scene/spread.h"

#include <stdlib.h>
#include <string.h>

/* The largest position or speed that a file may give, in L. */
#define FAR 1e6

/* Reads mesh and field, or mesh and positions of at least so many frames. */
static mote_status read_body(const mote_json *node, uint32_t frames, mote_bodies_shape *shape)
{
    const bool given = mote_json_member(node, "positions").value;
    mote_mesh *mesh = NULL;
    mote_field *field = NULL;
    mote_character *character = NULL;
    mote_status status =
        given ? mote_scenario_read_positions(node, frames, &mesh, &shape->motion.sequence)
              : mote_scenario_read_mesh(node, &mesh, &character);
    shape->body.mesh = mesh;
    if (status == MOTE_OK)
        status = given
                     ? mote_field_create_given(&field)
                     : mote_scenario_read_field(node, mesh, character, &field, &shape->motion);
    shape->body.field = field;
    return status;
}

static mote_status read_shape(const mote_json *node, uint32_t frames, mote_bodies_shape *shape)
{
    mote_status status = mote_scenario_check_body(
        node, "letter|triangles|file|positions|scale|field|" MOTE_CHARACTER_KEYS);
    if (status == MOTE_OK)
        status = read_body(node, frames, shape);
    const mote_mesh *mesh = shape->body.mesh;
    mote_player *player = shape->motion.player;
    if (status == MOTE_OK && player)
        mote_scenario_set_samples(player, 1, 1 + mote_player_frames(player), &shape->body);
    if (status != MOTE_OK)
        return status;
    shape->motion.centre = mote_mesh_centre(mesh);
    for (uint32_t v = 0; v < mesh->vertex_count; ++v)
        shape->radius = fmax(shape->radius,
                             mote_distance_squared(mesh->positions[v], shape->motion.centre));
    shape->radius = sqrt(shape->radius);
    return MOTE_OK;
}

static mote_status read_shapes(const mote_json *node, mote_bodies *bodies)
{
    mote_json key = mote_json_member(node, "shapes");
    size_t count;
    mote_status status = mote_json_array(&key, 1, MOTE_BODIES_SHAPES_MAX, &count);
    if (status != MOTE_OK)
        return status;
    bodies->shapes = mote_allocate(count, sizeof *bodies->shapes);
    bodies->shape_count = (uint32_t)count;
    for (uint32_t s = 0; s < count && status == MOTE_OK; ++s) {
        mote_json element = mote_json_element(&key, s);
        status = read_shape(&element, bodies->frames, &bodies->shapes[s]);
        if (status == MOTE_OK)
            bodies->length = fmax(bodies->length, bodies->shapes[s].body.mesh->diagonal);
    }
    return status;
}

static mote_status read_count(const mote_json *node, mote_bodies *bodies)
{
    mote_json key = mote_json_member(node, "count");
    int64_t count = 0;
    mote_status status = mote_json_integer(&key, 1, MOTE_BODIES_MAX, &count);
    if (status != MOTE_OK)
        return status;
    bodies->count = (uint32_t)count;
    bodies->shape_of = mote_allocate(bodies->count, sizeof *bodies->shape_of);
    bodies->paths = mote_allocate(bodies->count, sizeof *bodies->paths);
    for (uint32_t i = 0; i < bodies->count; ++i)
        bodies->shape_of[i] = i % bodies->shape_count;
    return MOTE_OK;
}

static mote_status read_places(const mote_json *node, const mote_bodies *bodies,
                               mote_bodies_wish *wish)
{
    mote_json key = mote_json_member(node, "places");
    if (!key.value)
        return MOTE_OK;
    size_t count;
    mote_status status = mote_json_array(&key, bodies->count, bodies->count, &count);
    if (status != MOTE_OK)
        return status;
    if (wish->near_pairs > 0)
        return mote_json_fail(&key, "places go with a box, not with near_pairs");
    wish->places = mote_allocate(count, sizeof *wish->places);
    for (size_t i = 0; i < count && status == MOTE_OK; ++i) {
        mote_json element = mote_json_element(&key, i);
        status = mote_json_vec3(&element, -FAR, FAR, &wish->places[i]);
        wish->places[i] = mote_scale(wish->places[i], bodies->length);
    }
    return status;
}

static mote_status read_box(const mote_json *node, mote_bodies_wish *wish)
{
    mote_json box = mote_json_member(node, "box");
    mote_json pairs = mote_json_member(node, "near_pairs");
    if (!box.value == !pairs.value)
        return mote_json_fail(node, "needs either box or near_pairs, not %s",
                              box.value ? "both" : "neither");
    if (pairs.value)
        return mote_json_real(&pairs, 1e-6, 1e6, &wish->near_pairs);
    return mote_json_number_or_vec3(&box, 1e-6, FAR, &wish->box);
}

static mote_status read_optional(const mote_json *node, const char *name, double maximum,
                                 double *value)
{
    mote_json key = mote_json_member(node, name);
    return key.value ? mote_json_real(&key, 0, maximum, value) : MOTE_OK;
}

/* A recorded motion shows only frames that its shapes' positions have. */
static mote_status check_recorded(const char *path, const mote_bodies *bodies)
{
    const size_t rows = (size_t)bodies->frames * bodies->count;
    for (size_t r = 0; r < rows; ++r) {
        const mote_bodies_shape *shape = &bodies->shapes[bodies->shape_of[r % bodies->count]];
        const mote_sequence *sequence = shape->motion.sequence;
        const double shown = bodies->recorded[r].deformation;
        if (sequence && !(shown >= 1 && shown <= sequence->frames))
            return mote_fail(MOTE_EINVAL,
                             "%s:%zu: shows frame %g of positions that have the frames 1 to %u",
                             path, r + 2, shown, sequence->frames);
    }
    return MOTE_OK;
}

/* "poses": the file of a recorded motion. */
static mote_status read_poses(const mote_json_file *file, const mote_json *node,
                              mote_bodies *bodies)
{
    mote_json key = mote_json_member(node, "poses");
    const char *name;
    if (!key.value)
        return MOTE_OK;
    if (!mote_json_member(node, "box").value)
        return mote_json_fail(&key, "poses go with a box, not with near_pairs");
    mote_status status = mote_json_string(&key, &name);
    if (status != MOTE_OK)
        return status;
    char *path = mote_path_beside(file->path, name);
    status = mote_fence_check(file->path, path);
    if (status == MOTE_OK)
        status = mote_bodies_poses_read(path, bodies);
    if (status == MOTE_OK)
        status = check_recorded(path, bodies);
    free(path);
    return mote_json_blame(&key, status);
}

static mote_status read_wish(const mote_json *node, mote_bodies *bodies, mote_bodies_wish *wish)
{
    int64_t seed = 1;
    mote_json key = mote_json_member(node, "seed");
    mote_status status = key.value ? mote_json_integer(&key, 0, INT64_MAX, &seed) : MOTE_OK;
    wish->seed = (uint64_t)seed;
    wish->speed = 0.004;
    wish->spin = 0.5;
    double near = 0.1;
    if (status == MOTE_OK)
        status = read_box(node, wish);
    if (status == MOTE_OK)
        status = read_optional(node, "near", 1e3, &near);
    if (status == MOTE_OK)
        status = read_optional(node, "speed", FAR, &wish->speed);
    if (status == MOTE_OK)
        status = read_optional(node, "spin", FAR, &wish->spin);
    if (status == MOTE_OK)
        status = read_places(node, bodies, wish);
    bodies->near = near * bodies->length;
    bodies->near_pairs_wanted = wish->near_pairs;
    if (status == MOTE_OK && bodies->near < bodies->tolerance)
        status = mote_json_fail(node,
                                "near %g is below the tolerance; contacts would be missed; "
                                "give at least the tolerance",
                                near);
    return status;
}

static mote_status read_facts(const mote_json_file *file, mote_bodies *bodies)
{
    mote_json root = mote_json_root(file);
    mote_status status = mote_json_object(&root, "purpose|bodies|frames|ask|step|tolerance");
    mote_scenario facts = {.motion = mote_allocate(1, sizeof *facts.motion)};
    if (status == MOTE_OK)
        status = mote_scenario_read_facts(&root, &facts);
    const mote_json ask = mote_json_member(&root, "ask");
    if (status == MOTE_OK && facts.ask == MOTE_ASK_IMPACT)
        status =
            mote_json_fail(&ask, "impacts are asked of two bodies; of more, ask for contact");
    bodies->frames = facts.frames;
    bodies->ask = facts.ask;
    bodies->tolerance = facts.tolerance;
    bodies->purpose = facts.purpose;
    free(facts.motion);
    bodies->path = mote_duplicate(file->path);
    bodies->name = mote_scenario_name_of(file->path);
    return status;
}

static mote_status read_bodies(const mote_json_file *file, mote_bodies *bodies)
{
    mote_json root = mote_json_root(file);
    mote_json node = mote_json_member(&root, "bodies");
    mote_bodies_wish wish = {0};
    mote_status status = read_facts(file, bodies);
    if (status == MOTE_OK)
        status = mote_json_object(
            &node, "count|seed|shapes|near|near_pairs|box|places|speed|spin|poses");
    if (status == MOTE_OK)
        status = read_shapes(&node, bodies);
    bodies->tolerance *= bodies->length;
    if (status == MOTE_OK)
        status = read_count(&node, bodies);
    if (status == MOTE_OK)
        status = read_wish(&node, bodies, &wish);
    if (status == MOTE_OK)
        status = read_poses(file, &node, bodies);
    if (status == MOTE_OK)
        status = mote_json_blame(&node, mote_bodies_place(bodies, &wish));
    free(wish.places);
    return status;
}

bool mote_bodies_is(const char *name_or_path)
{
    mote_json_file file;
    if (mote_scenario_is_pair(name_or_path) ||
        mote_scenario_open(name_or_path, &file) != MOTE_OK)
        return false;
    const bool is = mote_scenario_of_bodies(&file);
    mote_json_close(&file);
    return is;
}

mote_status mote_bodies_load(const char *path, mote_bodies **bodies)
{
    mote_json_file file;
    mote_status status = mote_scenario_open(path, &file);
    if (status != MOTE_OK)
        return status;
    mote_bodies *made = mote_allocate(1, sizeof *made);
    status = read_bodies(&file, made);
    mote_json_close(&file);
    if (status == MOTE_OK)
        *bodies = made;
    else
        mote_bodies_destroy(made);
    return status;
}
