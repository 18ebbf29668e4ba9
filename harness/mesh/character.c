#include "harness/mesh/character.h"

#include "harness/base/file.h"
#include "harness/base/memory.h"
#include "harness/mesh/character_parts.h"
#include "harness/mesh/import_child.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void mote_character_free_arrays(mote_character *character)
{
#define FREE(type, name)                                                                       \
    free(character->name);                                                                     \
    character->name = NULL;                                                                    \
    character->name##_count = character->name##_capacity = 0;
    MOTE_CHARACTER_ARRAYS(FREE)
#undef FREE
}

void mote_character_set_arrays(mote_character *character, mote_character *from)
{
    mote_character_free_arrays(character);
#define MOVE(type, name)                                                                       \
    character->name = from->name;                                                              \
    character->name##_count = from->name##_count;                                              \
    character->name##_capacity = from->name##_capacity;                                        \
    from->name = NULL;                                                                         \
    from->name##_count = from->name##_capacity = 0;
    MOTE_CHARACTER_ARRAYS(MOVE)
#undef MOVE
}

void mote_character_draft_free(mote_character_draft *draft)
{
    mote_soup_free(&draft->soup);
    mote_character_free_arrays(&draft->made);
    mote_rig_free(&draft->made.rig);
}

void mote_character_destroy(mote_character *character)
{
    if (!character)
        return;
    mote_mesh_destroy(character->mesh);
    mote_character_free_arrays(character);
    mote_rig_free(&character->rig);
    free(character);
}

static mote_status import_in_child(void *context, int output)
{
    mote_character_draft draft;
    memset(&draft, 0, sizeof draft);
    mote_import_begin_child();
    mote_status status = mote_character_read_assimp(context, &draft);
    if (status == MOTE_OK)
        status = mote_character_weld(context, &draft);
    if (status == MOTE_OK)
        status = mote_character_send(output, &draft);
    mote_character_draft_free(&draft);
    return status;
}

mote_status mote_character_make(const char *path, const mote_character_draft *draft,
                                mote_character **character)
{
    const mote_soup *soup = &draft->soup;
    mote_mesh *mesh = NULL;
    mote_status status = mote_character_check_rig(path, &draft->made.rig);
    if (status != MOTE_OK)
        return status;
    status = mote_mesh_create(soup->xyz, soup->vertex_count, soup->indices,
                              soup->triangle_count, &mesh);
    if (status != MOTE_OK)
        return mote_fail(status, "%s: %s", path, mote_error_text());
    *character = mote_copy(&draft->made, sizeof draft->made);
    (*character)->mesh = mesh;
    (*character)->scale = mote_vec3_make(1, 1, 1);
    return MOTE_OK;
}

mote_status mote_character_import_file(const char *path, mote_character **character,
                                       mote_character_import *import)
{
    static const char *const still[] = {".obj", ".off", ".ply", ".stl"};
    for (size_t i = 0; i < sizeof still / sizeof still[0]; ++i) {
        if (mote_name_ends(path, still[i]))
            return mote_fail(MOTE_EUNSUPPORTED,
                             "%s: no bones, morph targets or clips in this format; give glTF, "
                             "FBX, COLLADA or X, or name it as \"file\"",
                             path);
    }
    char *output = NULL;
    size_t size = 0;
    mote_character_draft draft;
    mote_status status = mote_import_run_child(path, import_in_child, &output, &size);
    if (status == MOTE_OK)
        status = mote_character_receive(path, output, size, &draft);
    free(output);
    if (status != MOTE_OK)
        return status;
    if (mote_import_is_strict())
        status = mote_import_refuse_split(path, &draft.import.mesh);
    if (status == MOTE_OK)
        status = mote_character_make(path, &draft, character);
    if (status == MOTE_OK) {
        mote_soup_free(&draft.soup); /* the character now owns everything else */
        if (import)
            *import = draft.import;
    } else {
        mote_character_draft_free(&draft);
    }
    return status;
}

/* "1 run (2.5 s), 2 walk (1 s)" */
static char *list_clips(const mote_rig *rig)
{
    mote_text text = {0};
    for (size_t k = 0; k < rig->clips_count; ++k) {
        const char *name = rig->names + rig->clips[k].name;
        mote_text_add(&text, "%s%zu%s%s (%.4g s)", k ? ", " : "", k + 1, *name ? " " : "", name,
                      rig->clips[k].seconds);
    }
    return text.data;
}

static mote_status refuse_clip(const mote_rig *rig, const char *asked)
{
    if (rig->clips_count == 0)
        return mote_fail(MOTE_EINVAL, "no clips in it, so that nothing moves; give a file with "
                                      "an animation, or name it as \"file\"");
    char *known = list_clips(rig);
    const mote_status status = mote_fail(MOTE_EINVAL, "no clip %.80s; it has %s", asked, known);
    free(known);
    return status;
}

mote_status mote_character_clip_numbered(const mote_character *character, int64_t number,
                                         uint32_t *clip)
{
    char asked[24];
    if (number >= 1 && (uint64_t)number <= character->rig.clips_count) {
        *clip = (uint32_t)number - 1;
        return MOTE_OK;
    }
    (void)snprintf(asked, sizeof asked, "%lld", (long long)number);
    return refuse_clip(&character->rig, asked);
}

mote_status mote_character_find_clip(const mote_character *character, const char *name,
                                     uint32_t *clip)
{
    const mote_rig *rig = &character->rig;
    for (size_t k = 0; k < rig->clips_count; ++k) {
        if (strcmp(rig->names + rig->clips[k].name, name) == 0) {
            *clip = (uint32_t)k;
            return MOTE_OK;
        }
    }
    char *end;
    const long number = strtol(name, &end, 10);
    return end != name && *end == '\0' ? mote_character_clip_numbered(character, number, clip)
                                       : refuse_clip(rig, name);
}

mote_status mote_character_scale(mote_character *character, mote_vec3 factor)
{
    mote_mesh *old = character->mesh, *scaled = NULL;
    double *xyz = mote_allocate((size_t)3 * old->vertex_count, sizeof *xyz);
    for (size_t v = 0; v < old->vertex_count; ++v) {
        xyz[3 * v] = old->positions[v].x * factor.x;
        xyz[3 * v + 1] = old->positions[v].y * factor.y;
        xyz[3 * v + 2] = old->positions[v].z * factor.z;
    }
    const mote_status status = mote_mesh_create(xyz, old->vertex_count, &old->triangles[0][0],
                                                old->triangle_count, &scaled);
    free(xyz);
    if (status != MOTE_OK)
        return status;
    mote_mesh_destroy(old);
    character->mesh = scaled;
    for (size_t i = 0; i < character->shift_count; ++i) {
        mote_vec3 *s = &character->shift[i];
        *s = mote_vec3_make(s->x * factor.x, s->y * factor.y, s->z * factor.z);
    }
    mote_vec3 *all = &character->scale;
    *all = mote_vec3_make(all->x * factor.x, all->y * factor.y, all->z * factor.z);
    return MOTE_OK;
}

mote_character_pose mote_character_pose_create(const mote_character *character)
{
    const mote_rig *rig = &character->rig;
    return (mote_character_pose){
        .globals = mote_allocate(rig->nodes_count, sizeof(mote_affine)),
        .matrices = mote_allocate(rig->bones_count, sizeof(mote_affine)),
        .morphs = mote_allocate(rig->targets_count, sizeof(double))};
}

void mote_character_pose_free(mote_character_pose *pose)
{
    free(pose->globals);
    free(pose->matrices);
    free(pose->morphs);
    *pose = (mote_character_pose){0};
}

void mote_character_pose_set(const mote_character *character, uint32_t clip, double seconds,
                             mote_character_pose *pose)
{
    const mote_rig *rig = &character->rig;
    const double s[3] = {character->scale.x, character->scale.y, character->scale.z};
    mote_rig_globals(rig, clip, seconds, pose->globals);
    mote_rig_matrices(rig, pose->globals, pose->matrices);
    mote_rig_morph_weights(rig, clip, seconds, pose->morphs);
    for (size_t b = 0; b < rig->bones_count; ++b) {
        double(*m)[4] = pose->matrices[b].m;
        for (int r = 0; r < 3; ++r) { /* the scale, after the bones, after its inverse */
            for (int c = 0; c < 3; ++c)
                m[r][c] = s[r] == s[c] ? m[r][c] : m[r][c] * s[r] / s[c];
            m[r][3] *= s[r];
        }
    }
}
