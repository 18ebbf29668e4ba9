/* The joints to which the vertices of a glTF file are bound (glTF 2.0, section 3.7.3). */
#include "harness/gltf/gltf_file.h"

#include "harness/base/file.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A primitive of a mesh that a skin moves. */
typedef struct skinned {
    mote_gltf *gltf;
    int64_t mesh, skin;
    size_t joints; /* of the skin */
    const json_t *attributes;
} skinned;

static mote_status wrong(const skinned *s, const char *what, const char *right)
{
    return mote_fail(MOTE_EINVAL, "%s: meshes[%lld]: %s; %s", s->gltf->path, (long long)s->mesh,
                     what, right);
}

/* The number of the accessor of attribute NAME_set, or -1. */
static int64_t accessor_of(const skinned *s, const char *name, size_t set)
{
    char *key = mote_format("%s_%zu", name, set);
    const int64_t index = mote_gltf_whole(s->attributes, key);
    free(key);
    return mote_gltf_entry(s->gltf, "accessors", index) ? index : -1;
}

static int64_t whole_of(const skinned *s, int64_t accessor, const char *key)
{
    return mote_gltf_whole(mote_gltf_entry(s->gltf, "accessors", accessor), key);
}

/* How many sets of joints and weights a primitive has. assimp crashes where one of them is
   missing, finds no weights where there are others than joints, and takes joints of all sets to
   have the type of the first. */
static mote_status count_sets(const skinned *s, size_t *sets)
{
    size_t given = 0;
    const char *name;
    json_t *value;
    json_object_foreach((json_t *)(uintptr_t)s->attributes, name, value)
    {
        given += strncmp(name, "JOINTS_", 7) == 0 || strncmp(name, "WEIGHTS_", 8) == 0;
    }
    const int64_t first = accessor_of(s, "JOINTS", 0);
    for (*sets = 0; 2 * *sets < given; ++*sets) {
        const int64_t joints = accessor_of(s, "JOINTS", *sets);
        const int64_t weights = accessor_of(s, "WEIGHTS", *sets);
        if (joints < 0 || weights < 0)
            return wrong(s, "its JOINTS and WEIGHTS are not pairs of accessors from 0 on",
                         "give JOINTS_0 and WEIGHTS_0, and so on");
        if (whole_of(s, joints, "count") != whole_of(s, weights, "count"))
            return wrong(s, "its JOINTS and WEIGHTS are not equally many",
                         "give four of each for each vertex");
        if (whole_of(s, joints, "componentType") != whole_of(s, first, "componentType"))
            return wrong(s, "its sets of JOINTS are of several types",
                         "write all of them with 8 or all with 16 bits");
    }
    return MOTE_OK;
}

/* Whether the numbers are in a buffer as they are, and not compressed or sparse. */
static bool is_plain(const skinned *s, int64_t accessor)
{
    const json_t *entry = mote_gltf_entry(s->gltf, "accessors", accessor);
    return json_object_get(entry, "bufferView") && !json_object_get(entry, "sparse");
}

/* assimp leaves out weights that are not above 0, and those of the vertex that are left would
   take their place. */
static mote_status check_weights(const skinned *s, size_t set, const mote_gltf_numbers *weights)
{
    for (size_t i = 0; i < 4 * weights->count; ++i) {
        if (!isfinite(weights->values[i]) || weights->values[i] < 0)
            return mote_fail(MOTE_EINVAL,
                             "%s: meshes[%lld]: WEIGHTS_%zu (accessors[%lld]) has the weight "
                             "%g at vertex %zu; give a finite one that is not negative",
                             s->gltf->path, (long long)s->mesh, set,
                             (long long)accessor_of(s, "WEIGHTS", set), weights->values[i],
                             i / 4);
    }
    return MOTE_OK;
}

static mote_status check_range(const skinned *s, size_t set, const mote_gltf_numbers *joints,
                               const mote_gltf_numbers *weights)
{
    for (size_t i = 0; i < 4 * joints->count; ++i) {
        if (weights->values[i] > 0 && joints->values[i] >= (double)s->joints)
            return mote_fail(MOTE_EINVAL,
                             "%s: meshes[%lld]: JOINTS_%zu (accessors[%lld]) has joint %.0f of "
                             "%zu of skins[%lld] at vertex %zu; use 0 to %zu",
                             s->gltf->path, (long long)s->mesh, set,
                             (long long)accessor_of(s, "JOINTS", set), joints->values[i],
                             s->joints, (long long)s->skin, i / 4,
                             s->joints > 0 ? s->joints - 1 : 0);
    }
    return MOTE_OK;
}

static mote_status check_set(const skinned *s, size_t set)
{
    mote_gltf_numbers joints = {0}, weights = {0};
    const int64_t from[2] = {accessor_of(s, "JOINTS", set), accessor_of(s, "WEIGHTS", set)};
    if (!is_plain(s, from[0]) || !is_plain(s, from[1]))
        return MOTE_OK;
    mote_status status = mote_gltf_read(s->gltf, "JOINTS", from[0], 4, false, &joints);
    if (status == MOTE_OK)
        status = mote_gltf_read(s->gltf, "WEIGHTS", from[1], 4, true, &weights);
    if (status == MOTE_OK)
        status = check_weights(s, set, &weights);
    if (status == MOTE_OK)
        status = check_range(s, set, &joints, &weights);
    free(joints.values);
    free(weights.values);
    return status;
}

static mote_status check_node(mote_gltf *gltf, const json_t *node)
{
    skinned s = {.gltf = gltf,
                 .mesh = mote_gltf_whole(node, "mesh"),
                 .skin = mote_gltf_whole(node, "skin")};
    const json_t *skin = mote_gltf_entry(gltf, "skins", s.skin);
    const json_t *parts =
        json_object_get(mote_gltf_entry(gltf, "meshes", s.mesh), "primitives");
    mote_status status = MOTE_OK;
    s.joints = json_array_size(json_object_get(skin, "joints"));
    for (size_t p = 0; skin && p < json_array_size(parts) && status == MOTE_OK; ++p) {
        size_t sets = 0;
        s.attributes = json_object_get(json_array_get(parts, p), "attributes");
        status = count_sets(&s, &sets);
        for (size_t set = 0; set < sets && status == MOTE_OK; ++set)
            status = check_set(&s, set);
    }
    return status;
}

mote_status mote_gltf_check_joints(mote_gltf *gltf)
{
    const json_t *nodes = json_object_get(gltf->root, "nodes");
    mote_status status = MOTE_OK;
    for (size_t n = 0; n < json_array_size(nodes) && status == MOTE_OK; ++n)
        status = check_node(gltf, json_array_get(nodes, n));
    return status;
}
