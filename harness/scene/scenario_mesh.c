/* Reads the mesh of a body: a letter or a file, possibly scaled. */
#include "harness/scene/scenario_read.h"

#include "datasets/letter.h"
#include "harness/base/file.h"
#include "harness/base/memory.h"
#include "harness/mesh/mesh_import.h"
#include "harness/scene/fence.h"

#include <stdlib.h>
#include <string.h>

#define SCALE_MIN 1e-15
#define SCALE_MAX 1e15

mote_status mote_scenario_read_triangles(const mote_json *body, int64_t *triangles)
{
    const mote_json key = mote_json_member(body, "triangles");
    return mote_json_integer(&key, MOTE_LETTER_MIN_TRIANGLES, MOTE_LETTER_MAX_TRIANGLES,
                             triangles);
}

static mote_status read_letter(const mote_json *letter, const mote_json *body, mote_mesh **mesh)
{
    const char *name;
    int64_t triangles = 0;
    mote_status status = mote_json_string(letter, &name);
    if (status == MOTE_OK && name[1] != '\0')
        status = mote_json_fail(letter, "%s is not one letter; give one capital", name);
    if (status == MOTE_OK)
        status = mote_scenario_read_triangles(body, &triangles);
    if (status != MOTE_OK)
        return status;
    status = mote_letter_create(name[0], (size_t)triangles, mesh);
    return mote_json_blame(letter, status);
}

mote_status mote_scenario_file_path(const mote_json *file, char **path)
{
    const char *name;
    mote_status status = mote_json_string(file, &name);
    if (status != MOTE_OK)
        return status;
    const bool own = file->file->own;
    char *made = own ? mote_format("%s", name) : mote_path_beside(file->file->path, name);
    status = own ? MOTE_OK : mote_fence_check(file->file->path, made);
    if (status == MOTE_OK)
        *path = made;
    else
        free(made);
    return status;
}

static mote_status read_file(const mote_json *file, mote_mesh **mesh)
{
    char *path = NULL;
    mote_import import;
    mote_status status = mote_scenario_file_path(file, &path);
    if (status == MOTE_OK)
        status = mote_mesh_import(path, mesh, &import);
    if (status == MOTE_OK)
        mote_import_tell_split(path, &import);
    free(path);
    return mote_json_blame(file, status);
}

/* Replaces *mesh with a copy scaled by coordinate. */
static mote_status scale_mesh(mote_vec3 factor, mote_mesh **mesh)
{
    const mote_mesh *old = *mesh;
    double *xyz = mote_allocate((size_t)3 * old->vertex_count, sizeof *xyz);
    for (uint32_t v = 0; v < old->vertex_count; ++v) {
        xyz[3 * (size_t)v] = old->positions[v].x * factor.x;
        xyz[3 * (size_t)v + 1] = old->positions[v].y * factor.y;
        xyz[3 * (size_t)v + 2] = old->positions[v].z * factor.z;
    }
    mote_mesh *scaled;
    const mote_status status = mote_mesh_create(xyz, old->vertex_count, &old->triangles[0][0],
                                                old->triangle_count, &scaled);
    free(xyz);
    if (status != MOTE_OK)
        return status;
    mote_mesh_destroy(*mesh);
    *mesh = scaled;
    return MOTE_OK;
}

mote_status mote_scenario_scale(const mote_json *scale, mote_mesh **mesh, mote_vec3 *factor)
{
    const mote_status status = mote_json_number_or_vec3(scale, SCALE_MIN, SCALE_MAX, factor);
    return status == MOTE_OK ? mote_json_blame(scale, scale_mesh(*factor, mesh)) : status;
}

mote_status mote_scenario_read_plain(const mote_json *body, mote_mesh **mesh)
{
    mote_json letter = mote_json_member(body, "letter");
    mote_json file = mote_json_member(body, "file");
    if (!letter.value == !file.value)
        return mote_json_fail(body, "needs either letter, file or character, not %s",
                              letter.value ? "both" : "neither");
    return file.value ? read_file(&file, mesh) : read_letter(&letter, body, mesh);
}

mote_status mote_scenario_read_mesh(const mote_json *body, mote_mesh **mesh,
                                    mote_character **character)
{
    mote_json scale = mote_json_member(body, "scale");
    mote_vec3 factor = {1, 1, 1};
    mote_mesh *made = NULL;
    mote_character *moving = NULL;
    mote_status status = mote_scenario_read_character(body, &moving);
    if (status == MOTE_OK && !moving)
        status = mote_scenario_read_plain(body, &made);
    if (status == MOTE_OK && scale.value)
        status = mote_json_number_or_vec3(&scale, SCALE_MIN, SCALE_MAX, &factor);
    if (status == MOTE_OK && scale.value)
        status = mote_json_blame(&scale, moving ? mote_character_scale(moving, factor)
                                                : scale_mesh(factor, &made));
    if (status != MOTE_OK) {
        mote_mesh_destroy(made);
        mote_character_destroy(moving);
        return status;
    }
    *character = moving;
    *mesh = moving ? moving->mesh : made;
    if (moving)
        moving->mesh = NULL;
    return MOTE_OK;
}
