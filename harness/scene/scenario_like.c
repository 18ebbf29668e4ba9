/* Merges a scenario with the one it is "like": its keys replace the other's, key by key and
   body by body, and null removes a key (RFC 7396, except that arrays of bodies are merged body
   by body). */
#include "harness/scene/scenario_read.h"

#include "harness/scene/catalog.h"
#include "harness/base/file.h"
#include "harness/scene/fence.h"

#include <stdlib.h>
#include <string.h>

static json_t *merge(const json_t *base, const json_t *over, bool element_wise);

static json_t *merge_objects(const json_t *base, const json_t *over)
{
    json_t *result = json_is_object(base) ? json_deep_copy(base) : json_object();
    void *walk = json_object_iter((json_t *)(uintptr_t)over);
    for (; walk; walk = json_object_iter_next((json_t *)(uintptr_t)over, walk)) {
        const char *key = json_object_iter_key(walk);
        const json_t *value = json_object_iter_value(walk);
        if (json_typeof(value) == JSON_NULL)
            (void)json_object_del(result, key);
        else
            (void)json_object_set_new(
                result, key,
                merge(json_object_get(result, key), value, strcmp(key, "bodies") == 0));
    }
    return result;
}

static json_t *merge(const json_t *base, const json_t *over, bool element_wise)
{
    if (json_typeof(over) == JSON_OBJECT)
        return merge_objects(base, over);
    if (!element_wise || json_typeof(over) != JSON_ARRAY)
        return json_deep_copy(over);
    json_t *result = json_array();
    for (size_t i = 0; i < json_array_size(over); ++i)
        (void)json_array_append_new(
            result, merge(json_array_get(base, i), json_array_get(over, i), false));
    return result;
}

static char *base_path(const char *path, const char *name)
{
    return mote_name_ends(name, ".json") ? mote_path_beside(path, name)
                                         : mote_catalog_path(name);
}

/* Rewrites a name relative to the folder of the file at path so that it includes path. False
   for a path that is not UTF-8. */
static bool move_name(json_t *object, const char *key, const char *path)
{
    const char *name = json_string_value(json_object_get(object, key));
    if (!name)
        return true;
    char *moved = mote_path_beside(path, name);
    const bool set = json_object_set_new(object, key, json_string(moved)) == 0;
    free(moved);
    return set;
}

/* Rewrites the names of meshes, positions and poses, which are relative to the file that
   contains them. path: of the other scenario, absolute or relative to this one's folder. */
static bool move_files(json_t *root, const char *path)
{
    json_t *bodies = json_object_get(root, "bodies");
    json_t *list = json_is_object(bodies) ? json_object_get(bodies, "shapes") : bodies;
    bool moved = move_name(bodies, "poses", path);
    static const char *const keys[] = {"file", "positions", "character"};
    for (size_t i = 0; i < json_array_size(list); ++i) {
        for (size_t k = 0; k < sizeof keys / sizeof keys[0] && moved; ++k)
            moved = move_name(json_array_get(list, i), keys[k], path);
    }
    return moved;
}

static mote_status open_base(const mote_json_file *file, const char *name, mote_json_file *base)
{
    char *path = base_path(file->path, name);
    mote_status status = mote_fence_check(file->path, path);
    if (status == MOTE_OK)
        status = mote_json_open(path, base);
    if (status == MOTE_OK &&
        !move_files(base->root, mote_name_ends(name, ".json") ? name : path)) {
        mote_json_close(base);
        status = mote_fail(MOTE_EINVAL, "%s: its path is not UTF-8; rename the folder", path);
    }
    free(path);
    return status;
}

mote_status mote_scenario_merge_like(mote_json_file *file)
{
    mote_json root = mote_json_root(file);
    mote_json like = mote_json_member(&root, "like");
    if (!like.value)
        return MOTE_OK;
    const char *name;
    mote_status status = mote_json_string(&like, &name);
    if (status != MOTE_OK)
        return status;
    mote_json_file base;
    status = open_base(file, name, &base);
    if (status != MOTE_OK)
        return mote_json_blame(&like, status);
    const mote_json other = mote_json_root(&base);
    if (!json_is_object(base.root)) {
        status =
            mote_json_blame(&like, mote_json_refuse(&other, "an object, which a scenario is"));
    } else if (json_object_get(base.root, "like")) {
        status =
            mote_json_fail(&like, "%s is like another one itself; name one that is not", name);
    } else {
        json_t *merged = merge_objects(base.root, file->root);
        (void)json_object_del(merged, "like");
        json_decref(file->root);
        file->root = merged;
    }
    mote_json_close(&base);
    return status;
}
