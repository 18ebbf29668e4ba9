#define _DEFAULT_SOURCE /* realpath */
#include "harness/scene/scenario_move.h"

#include "datasets/obj_write.h"
#include "harness/base/data.h"
#include "harness/base/file.h"
#include "harness/mesh/character.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* The largest character file that is copied. */
#define CHARACTER_BYTES ((size_t)1 << 32)

/* The folder of a file, with links resolved and without a final '/'; the caller frees it. */
static mote_status folder_of(const char *file, char **folder)
{
    const char *slash = strrchr(file, '/');
    char *name = slash ? mote_format("%.*s/", (int)(slash - file), file) : mote_format(".");
    *folder = realpath(name, NULL);
    mote_status status = MOTE_OK;
    if (!*folder)
        status = mote_fail(MOTE_EIO, "%s: %s; name an existing folder", name, strerror(errno));
    else if (strcmp(*folder, "/") == 0)
        **folder = '\0';
    free(name);
    return status;
}

/* The path relative to folder, or NULL if it does not lie in it. */
static const char *below(const char *folder, const char *path)
{
    const size_t length = strlen(folder);
    return strncmp(folder, path, length) == 0 && path[length] == '/' ? path + length + 1 : NULL;
}

/* Writes the mesh beside `to`; *name is its name relative to that folder. */
static mote_status copy_mesh(const char *mesh_path, const char *to, size_t body, char **name)
{
    const size_t ending = mote_name_ends(to, ".json") ? strlen(".json") : 0;
    mote_mesh *mesh = NULL;
    char *path = mote_format("%.*s-body%zu.obj", (int)(strlen(to) - ending), to, body);
    mote_status status = mote_mesh_import(mesh_path, &mesh, NULL);
    if (status == MOTE_OK)
        status = mote_obj_write(path, NULL, mesh);
    mote_mesh_destroy(mesh);
    if (status == MOTE_OK) {
        const char *slash = strrchr(path, '/');
        *name = mote_format("%s", slash ? slash + 1 : path);
    }
    free(path);
    return status;
}

/* Copies the file of a character beside `to` and reads the copy as a check: a format may keep
   parts of it in other files. */
static mote_status copy_character(const char *old, const char *to, size_t body, char **name)
{
    const size_t ending = mote_name_ends(to, ".json") ? strlen(".json") : 0;
    const char *dot = strrchr(old, '.');
    char *path = mote_format("%.*s-body%zu%s", (int)(strlen(to) - ending), to, body,
                             dot && !strchr(dot, '/') ? dot : "");
    char *data = NULL;
    size_t size = 0;
    mote_character *copy = NULL;
    mote_status status = mote_file_read(old, CHARACTER_BYTES, &data, &size);
    if (status == MOTE_OK)
        status = mote_file_write(path, data, size);
    if (status == MOTE_OK && mote_character_import_file(path, &copy, NULL) != MOTE_OK) {
        (void)unlink(path);
        status = mote_fail(MOTE_EIO,
                           "%s: cannot be copied alone (%s); give it in one file, as GLB, or "
                           "write to its folder",
                           old, mote_error_text());
    }
    mote_character_destroy(copy);
    if (status == MOTE_OK) {
        const char *slash = strrchr(path, '/');
        *name = mote_format("%s", slash ? slash + 1 : path);
    }
    free(path);
    free(data);
    return status;
}

/* *name: the name in a scenario at `to` of the file at path (of body number `body`). */
static mote_status new_name(const char *path, const char *key, const char *to, size_t body,
                            char **name)
{
    char *folder = NULL, *datasets = mote_format("%s/datasets", mote_data_directory());
    char *known = realpath(datasets, NULL);
    char *whole = realpath(path, NULL);
    mote_status status = MOTE_OK;
    *name = NULL;
    if (!whole)
        status = mote_fail(MOTE_EIO, "%s: %s", path, strerror(errno));
    else
        status = folder_of(to, &folder);
    if (status == MOTE_OK) {
        const char *inside = below(folder, whole);
        if (mote_path_is_stream(to) || (known && below(known, whole)))
            *name = mote_format("%s", whole);
        else if (inside)
            *name = mote_format("%s", inside);
        else
            status = strcmp(key, "file") == 0 ? copy_mesh(whole, to, body, name)
                                              : copy_character(whole, to, body, name);
    }
    free(folder);
    free(datasets);
    free(known);
    free(whole);
    return status;
}

/* Whether both files are in one folder, so names stay as they are. */
static bool same_folder(const mote_json_file *file, const char *to)
{
    char *from_folder = NULL, *to_folder = NULL;
    const bool same = !file->own && !mote_path_is_stream(to) &&
                      folder_of(file->path, &from_folder) == MOTE_OK &&
                      folder_of(to, &to_folder) == MOTE_OK &&
                      strcmp(from_folder, to_folder) == 0;
    free(from_folder);
    free(to_folder);
    return same;
}

/* key: "file" or "character". */
static mote_status move_file(const mote_json_file *file, json_t *body, const char *key,
                             size_t number, const char *to)
{
    const char *old = json_string_value(json_object_get(body, key));
    char *path = file->own ? mote_format("%s", old) : mote_path_beside(file->path, old);
    char *name = NULL;
    mote_status status = new_name(path, key, to, number, &name);
    if (status == MOTE_OK && json_object_set_new(body, key, json_string(name)) != 0)
        status = mote_fail(MOTE_EINVAL, "%s: not UTF-8; rename it", name);
    free(path);
    free(name);
    return status;
}

/* Moves the files that bodies name with a key. Bodies that share one with the first still do
   afterwards. */
static mote_status move_files(const mote_json_file *file, json_t *bodies, const char *key,
                              const char *to)
{
    json_t *first = json_array_get(bodies, 0);
    json_t *first_file = json_deep_copy(json_object_get(first, key));
    mote_status status = MOTE_OK;
    for (size_t i = 0; i < json_array_size(bodies) && status == MOTE_OK; ++i) {
        json_t *body = json_array_get(bodies, i);
        json_t *named = json_object_get(body, key);
        if (i > 0 && named && json_equal(named, first_file))
            (void)json_object_set(body, key, json_object_get(first, key));
        else if (json_is_string(named))
            status = move_file(file, body, key, i, to);
    }
    json_decref(first_file);
    return status;
}

mote_status mote_scenario_move(mote_json_file *file, const char *to)
{
    json_t *bodies = json_object_get(file->root, "bodies");
    if (json_is_object(bodies)) /* for more than two, the shapes name the meshes */
        bodies = json_object_get(bodies, "shapes");
    if (same_folder(file, to))
        return MOTE_OK;
    const mote_status status = move_files(file, bodies, "file", to);
    return status == MOTE_OK ? move_files(file, bodies, "character", to) : status;
}
