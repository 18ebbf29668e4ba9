/* What assimp 5.2 reads wrongly in a glTF file without saying so (datasets/defects.md, entry
   22). glTF 2.0, sections 3.6 and 3.7, allow weights and keys as normalised integers;
   KHR_mesh_quantization allows positions. */
#include "harness/gltf/gltf_file.h"

#include <string.h>

typedef struct checker {
    const mote_gltf *gltf;
    const char *list; /* of the file, with the entry being checked, for messages */
    size_t number;
} checker;

/* Extensions without which a mesh has other numbers, or none. For Draco, which is
   read if built in, see check_draco. */
static mote_status check_extensions(const mote_gltf *gltf)
{
    static const struct {
        const char *name, *right;
    } unread[] = {
        {"EXT_meshopt_compression", "uncompress it, as gltf-transform dequantize does"},
        {"KHR_meshopt_compression", "uncompress it, as gltf-transform dequantize does"},
        {"EXT_mesh_gpu_instancing", "give each instance a node"},
    };
    const json_t *required = json_object_get(gltf->root, "extensionsRequired");
    for (size_t i = 0; i < json_array_size(required); ++i) {
        const char *name = json_string_value(json_array_get(required, i));
        for (size_t k = 0; name && k < sizeof unread / sizeof unread[0]; ++k) {
            if (strcmp(name, unread[k].name) == 0)
                return mote_fail(MOTE_EINVAL, "%s: requires %s, which assimp does not read; %s",
                                 gltf->path, name, unread[k].right);
        }
    }
    return MOTE_OK;
}

static const char *component_name(int64_t component)
{
    switch (component) {
    case 5120:
    case 5121:
        return "8-bit integers";
    case 5122:
    case 5123:
        return "16-bit integers";
    case 5125:
        return "32-bit integers";
    default:
        return "numbers of an unknown type";
    }
}

/* The bytes of a component, or 0 where its type is unknown. */
static int64_t component_size(const json_t *object)
{
    static const int64_t bytes[] = {1, 1, 2, 2, 0, 4, 4}; /* of components from 5120 on */
    const int64_t component = mote_gltf_whole(object, "componentType") - 5120;
    return component < 0 || component >= (int64_t)(sizeof bytes / sizeof bytes[0])
               ? 0
               : bytes[component];
}

/* The bytes of an element of an accessor, or 0 where its type is unknown. */
static int64_t element_size(const json_t *accessor)
{
    static const struct {
        const char *type;
        int64_t numbers;
    } types[] = {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4},
                 {"MAT2", 4},   {"MAT3", 9}, {"MAT4", 16}};
    const char *type = json_string_value(json_object_get(accessor, "type"));
    for (size_t t = 0; type && t < sizeof types / sizeof types[0]; ++t) {
        if (strcmp(type, types[t].type) == 0)
            return types[t].numbers * component_size(accessor);
    }
    return 0;
}

/* Whether `count` elements of `size` bytes, `step` apart, lie in so many bytes. */
static bool lie_within(int64_t bytes, int64_t offset, int64_t count, int64_t size, int64_t step)
{
    return offset >= 0 && bytes >= size && offset <= bytes - size &&
           count - 1 <= (bytes - size - offset) / step;
}

/* Elements in a view: of an accessor, or of what one that is sparse replaces. */
typedef struct elements {
    const json_t *where; /* its bufferView and byteOffset */
    const char *what;    /* before "elements" in a message */
    int64_t count, size;
    bool packed; /* whatever stride the view has */
} elements;

/* Checks that elements lie in their view, and that in its buffer. assimp looks at offset and
   length one by one, and so reads what follows. */
static mote_status check_elements(const checker *c, elements e)
{
    const int64_t index = mote_gltf_whole(e.where, "bufferView");
    const json_t *view = mote_gltf_entry(c->gltf, "bufferViews", index);
    const int64_t buffer = mote_gltf_whole(view, "buffer");
    const int64_t stride = mote_gltf_whole(view, "byteStride");
    const int64_t length = mote_gltf_whole(view, "byteLength");
    const int64_t bytes =
        mote_gltf_whole(mote_gltf_entry(c->gltf, "buffers", buffer), "byteLength");
    if (!view || e.size == 0 || e.count < 1)
        return MOTE_OK;
    if (!lie_within(length, mote_gltf_whole_or_0(e.where, "byteOffset"), e.count, e.size,
                    stride > 0 && !e.packed ? stride : e.size))
        return mote_fail(MOTE_EINVAL,
                         "%s: %s[%zu]: its %lld %selements do not lie within the byteLength of "
                         "bufferViews[%lld]; give fewer, or all of their bytes",
                         c->gltf->path, c->list, c->number, (long long)e.count, e.what,
                         (long long)index);
    if (bytes > 0 &&
        !lie_within(bytes, mote_gltf_whole_or_0(view, "byteOffset"), 1, length, length))
        return mote_fail(MOTE_EINVAL,
                         "%s: %s[%zu]: bufferViews[%lld] does not lie within the byteLength of "
                         "buffers[%lld]; give all of its bytes",
                         c->gltf->path, c->list, c->number, (long long)index,
                         (long long)buffer);
    return MOTE_OK;
}

/* Of an accessor that is sparse assimp reads the elements of its view as if they had no stride.
 */
static mote_status check_sparse(const checker *c, const json_t *accessor, const json_t *sparse)
{
    const int64_t index = mote_gltf_whole(accessor, "bufferView");
    const json_t *view = mote_gltf_entry(c->gltf, "bufferViews", index);
    const json_t *indices = json_object_get(sparse, "indices");
    const int64_t stride = mote_gltf_whole(view, "byteStride"), size = element_size(accessor);
    const int64_t count = mote_gltf_whole(sparse, "count");
    if (stride > 0 && stride != size)
        return mote_fail(MOTE_EINVAL,
                         "%s: %s[%zu]: sparse, over bufferViews[%lld] with a byteStride, which "
                         "assimp ignores; write it without one of them",
                         c->gltf->path, c->list, c->number, (long long)index);
    const elements indexed = {indices, "sparse ", count, component_size(indices), true};
    const elements values = {json_object_get(sparse, "values"), "sparse ", count, size, true};
    const mote_status status = check_elements(c, indexed);
    return status == MOTE_OK ? check_elements(c, values) : status;
}

static mote_status check_bounds(const checker *c, const json_t *accessor)
{
    const json_t *sparse = json_object_get(accessor, "sparse");
    const elements own = {accessor, "", mote_gltf_whole(accessor, "count"),
                          element_size(accessor), false};
    const mote_status status = sparse ? check_sparse(c, accessor, sparse) : MOTE_OK;
    return status == MOTE_OK ? check_elements(c, own) : status;
}

/* The accessor that a member names, or NULL. */
static const json_t *accessor_of(const checker *c, const json_t *object, const char *member)
{
    return mote_gltf_entry(c->gltf, "accessors", mote_gltf_whole(object, member));
}

/* Checks that an accessor has floats; none passes. what: its name in a message. */
static mote_status check_floats(const checker *c, const json_t *accessor, const char *what)
{
    const int64_t component = mote_gltf_whole(accessor, "componentType");
    if (!accessor || component == MOTE_GLTF_FLOATS)
        return MOTE_OK;
    return mote_fail(
        MOTE_EINVAL,
        "%s: %s[%zu]: %s has %s, which assimp takes for floats; write 32-bit floats%s",
        c->gltf->path, c->list, c->number, what, component_name(component),
        strcmp(c->list, "meshes") == 0 ? ", as gltf-transform dequantize does" : "");
}

/* Checks that an accessor has at least `count` elements of a type (NULL: any); none passes. */
static mote_status check_shape(const checker *c, const json_t *accessor, const char *what,
                               const char *type, int64_t count)
{
    const char *own = json_string_value(json_object_get(accessor, "type"));
    const int64_t own_count = mote_gltf_whole(accessor, "count");
    if (!accessor || (own && (!type || strcmp(own, type) == 0) && own_count >= count))
        return MOTE_OK;
    return mote_fail(
        MOTE_EINVAL, "%s: %s[%zu]: %s has too few elements, or of a wrong type; give %lld%s%s",
        c->gltf->path, c->list, c->number, what, (long long)(count > 0 ? count : own_count),
        type ? " of " : "", type ? type : "");
}

/* Checks for both. */
static mote_status check_numbers(const checker *c, const json_t *accessor, const char *what,
                                 const char *type, int64_t count)
{
    const mote_status status = check_floats(c, accessor, what);
    return status == MOTE_OK ? check_shape(c, accessor, what, type, count) : status;
}

/* Checks the bones' numbers and weights of as many vertices. */
static mote_status check_influences(const checker *c, json_t *attributes, int64_t vertices)
{
    mote_status status = MOTE_OK;
    const char *name;
    json_t *value;
    json_object_foreach(attributes, name, value)
    {
        const json_t *accessor = accessor_of(c, attributes, name);
        if (status == MOTE_OK && strncmp(name, "WEIGHTS_", strlen("WEIGHTS_")) == 0)
            status = check_numbers(c, accessor, "WEIGHTS", "VEC4", vertices);
        if (status == MOTE_OK && strncmp(name, "JOINTS_", strlen("JOINTS_")) == 0)
            status = check_shape(c, accessor, "JOINTS", "VEC4", vertices);
    }
    return status;
}

static mote_status check_targets(const checker *c, const json_t *targets)
{
    mote_status status = MOTE_OK;
    for (size_t t = 0; t < json_array_size(targets) && status == MOTE_OK; ++t)
        status = check_numbers(c, accessor_of(c, json_array_get(targets, t), "POSITION"),
                               "a target's POSITION", "VEC3", 0);
    return status;
}

static mote_status check_positions(const checker *c, const json_t *primitive)
{
    const json_t *attributes = json_object_get(primitive, "attributes");
    return check_numbers(c, accessor_of(c, attributes, "POSITION"), "POSITION", "VEC3", 0);
}

/* assimp reads the indices of Draco as others than those of 32 bits, and mixes up vertices
   where the file has them uncompressed, too. */
static mote_status check_draco(const checker *c, const json_t *primitive)
{
    static const char name[] = "KHR_draco_mesh_compression";
    const json_t *indices = accessor_of(c, primitive, "indices");
    if (!json_object_get(json_object_get(primitive, "extensions"), name) ||
        mote_gltf_whole(indices, "componentType") != 5125)
        return MOTE_OK;
    return mote_fail(MOTE_EINVAL,
                     "%s: %s[%zu]: %s with indices of 32 bits, which assimp misreads; "
                     "uncompress it, as gltf-transform dequantize does",
                     c->gltf->path, c->list, c->number, name);
}

/* A mesh that does not move is read with its targets, too, and each to the mesh's last vertex.
 */
static mote_status check_target_counts(const checker *c, const json_t *primitive)
{
    const json_t *targets = json_object_get(primitive, "targets");
    const json_t *positions =
        accessor_of(c, json_object_get(primitive, "attributes"), "POSITION");
    const int64_t vertices = mote_gltf_whole(positions, "count");
    mote_status status = MOTE_OK;
    for (size_t t = 0; t < json_array_size(targets) && status == MOTE_OK; ++t)
        status = check_shape(c, accessor_of(c, json_array_get(targets, t), "POSITION"),
                             "a target's POSITION", NULL, vertices);
    return status;
}

/* Checks what moves the vertices of a primitive whose positions have passed. */
static mote_status check_movers(const checker *c, const json_t *primitive)
{
    json_t *attributes = json_object_get(primitive, "attributes");
    const json_t *positions = accessor_of(c, attributes, "POSITION");
    const mote_status status =
        check_influences(c, attributes, mote_gltf_whole(positions, "count"));
    return status == MOTE_OK ? check_targets(c, json_object_get(primitive, "targets")) : status;
}

/* inverseBindMatrices may be left out: see mote_gltf_text. */
static mote_status check_skin(const checker *c, const json_t *skin)
{
    static const char what[] = "inverseBindMatrices";
    const json_t *joints = json_object_get(skin, "joints");
    const json_t *binds = accessor_of(c, skin, what);
    for (size_t k = 0; k < json_array_size(joints); ++k) {
        const json_t *joint = json_array_get(joints, k);
        if (!json_is_integer(joint) ||
            !mote_gltf_entry(c->gltf, "nodes", json_integer_value(joint)))
            return mote_fail(MOTE_EINVAL, "%s: %s[%zu]: joints[%zu] is not a node; name one",
                             c->gltf->path, c->list, c->number, k);
    }
    if (json_object_get(skin, what) && !binds)
        return mote_fail(MOTE_EINVAL, "%s: %s[%zu]: %s is not an accessor; name one of %zu",
                         c->gltf->path, c->list, c->number, what, json_array_size(joints));
    return check_numbers(c, binds, what, "MAT4", (int64_t)json_array_size(joints));
}

static mote_status check_node(const checker *c, const json_t *node)
{
    if (!json_object_get(node, "skin") ||
        (json_is_integer(json_object_get(node, "skin")) &&
         mote_gltf_entry(c->gltf, "skins", mote_gltf_whole(node, "skin"))))
        return MOTE_OK;
    return mote_fail(MOTE_EINVAL, "%s: %s[%zu]: skin is not a skin; name one", c->gltf->path,
                     c->list, c->number);
}

static mote_status check_sampler(const checker *c, const json_t *sampler)
{
    const json_t *times = accessor_of(c, sampler, "input");
    const mote_status status = check_numbers(c, times, "a sampler's input", NULL, 0);
    return status == MOTE_OK
               ? check_numbers(c, accessor_of(c, sampler, "output"), "a sampler's output", NULL,
                               mote_gltf_whole(times, "count"))
               : status;
}

/* Samplers that move no node may have any numbers. */
static mote_status check_animation(const checker *c, const json_t *animation)
{
    const json_t *channels = json_object_get(animation, "channels");
    mote_status status = MOTE_OK;
    for (size_t k = 0; k < json_array_size(channels) && status == MOTE_OK; ++k) {
        const json_t *channel = json_array_get(channels, k);
        if (mote_gltf_moves(c->gltf, channel))
            status = check_sampler(c, mote_gltf_sampler(animation, channel));
    }
    return status;
}

/* Of each entry of a list of the file, or of the parts of each, such as a mesh's primitives. */
typedef struct check {
    const char *list, *parts;
    mote_status (*run)(const checker *c, const json_t *part);
    bool moves; /* only asked of files that move */
} check;

static mote_status check_entry(const checker *c, const check *which, const json_t *entry)
{
    if (!which->parts)
        return which->run(c, entry);
    const json_t *parts = json_object_get(entry, which->parts);
    mote_status status = MOTE_OK;
    for (size_t p = 0; p < json_array_size(parts) && status == MOTE_OK; ++p)
        status = which->run(c, json_array_get(parts, p));
    return status;
}

static mote_status check_list(const mote_gltf *gltf, const check *which)
{
    const json_t *list = json_object_get(gltf->root, which->list);
    checker c = {.gltf = gltf, .list = which->list};
    mote_status status = MOTE_OK;
    for (; c.number < json_array_size(list) && status == MOTE_OK; ++c.number)
        status = check_entry(&c, which, json_array_get(list, c.number));
    return status;
}

mote_status mote_gltf_check(const mote_gltf *gltf, bool moves)
{
    static const check checks[] = {
        {"accessors", NULL, check_bounds, false},
        {"meshes", "primitives", check_draco, false},
        {"meshes", "primitives", check_positions, false},
        {"meshes", "primitives", check_target_counts, false},
        {"meshes", "primitives", check_movers, true},
        {"skins", NULL, check_skin, true},
        {"nodes", NULL, check_node, true},
        {"animations", NULL, check_animation, true},
    };
    mote_status status = check_extensions(gltf);
    for (size_t i = 0; i < sizeof checks / sizeof checks[0] && status == MOTE_OK; ++i) {
        if (moves || !checks[i].moves)
            status = check_list(gltf, &checks[i]);
    }
    return status;
}
