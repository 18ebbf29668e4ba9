/* Meshes read by assimp: PLY, STL, glTF and the other formats that it knows. */
#include "harness/mesh/mesh_assimp.h"

#include "harness/base/file.h"
#include "harness/base/memory.h"

#include <assimp/cimport.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *mote_assimp_line(const char *text, char said[MOTE_SAID_MAX])
{
    (void)snprintf(said, MOTE_SAID_MAX, "%.*s", MOTE_SAID_MAX - 1, text);
    size_t length = strlen(said);
    while (length > 0 && strchr(" .,\r\n", said[length - 1]))
        said[--length] = '\0';
    for (char *at = said; *at; ++at)
        *at = (unsigned char)*at < ' ' ? ' ' : *at;
    return said;
}

const char *mote_assimp_of_mesh(const struct aiMesh *mesh, char text[MOTE_SAID_MAX])
{
    char name[MOTE_SAID_MAX];
    (void)mote_assimp_line(mesh->mName.data, name);
    (void)snprintf(text, MOTE_SAID_MAX, "%s%.60s", name[0] ? " of mesh " : "", name);
    return text;
}

mote_affine mote_assimp_affine(const struct aiMatrix4x4 *m)
{
    return (mote_affine){{{(double)m->a1, (double)m->a2, (double)m->a3, (double)m->a4},
                          {(double)m->b1, (double)m->b2, (double)m->b3, (double)m->b4},
                          {(double)m->c1, (double)m->c2, (double)m->c3, (double)m->c4}}};
}

static mote_status add_vertices(const char *path, const struct aiMesh *mesh,
                                const mote_affine *place, mote_soup *soup)
{
    mote_status status = MOTE_OK;
    for (unsigned v = 0; v < mesh->mNumVertices && status == MOTE_OK; ++v) {
        const mote_vec3 at = mote_affine_apply(
            place, mote_vec3_make((double)mesh->mVertices[v].x, (double)mesh->mVertices[v].y,
                                  (double)mesh->mVertices[v].z));
        char name[MOTE_SAID_MAX];
        if (!isfinite(at.x) || !isfinite(at.y) || !isfinite(at.z))
            return mote_fail(MOTE_EINVAL, "%s: vertex %u%s is not finite; give finite numbers",
                             path, v, mote_assimp_of_mesh(mesh, name));
        status = mote_soup_add_vertex(soup, at.x, at.y, at.z);
    }
    return status;
}

/* corners: room for the face's corners, whose vertices begin at number base in the soup. */
static mote_status add_face(const char *path, const struct aiMesh *mesh, unsigned f,
                            uint32_t base, uint32_t *corners, mote_soup *soup)
{
    const struct aiFace *face = &mesh->mFaces[f];
    for (unsigned i = 0; i < face->mNumIndices; ++i) {
        if (face->mIndices[i] >= mesh->mNumVertices)
            return mote_fail(MOTE_EINVAL, "%s: face %u has vertex %u of %u; use 0 to %u", path,
                             f, face->mIndices[i], mesh->mNumVertices, mesh->mNumVertices - 1);
        corners[i] = base + face->mIndices[i];
    }
    if (face->mNumIndices == 3) {
        mote_soup_add_triangle(soup, corners[0], corners[1], corners[2]);
        return MOTE_OK;
    }
    const mote_status status = mote_soup_add_polygon(soup, corners, face->mNumIndices);
    char name[MOTE_SAID_MAX];
    return status == MOTE_OK ? status
                             : mote_fail(status, "%s: face %u%s: %s", path, f,
                                         mote_assimp_of_mesh(mesh, name), mote_error_text());
}

static mote_status add_faces(const char *path, const struct aiMesh *mesh, uint32_t base,
                             mote_soup *soup)
{
    size_t most = 0;
    for (unsigned f = 0; f < mesh->mNumFaces; ++f)
        most = mesh->mFaces[f].mNumIndices > most ? mesh->mFaces[f].mNumIndices : most;
    uint32_t *corners = mote_allocate(most, sizeof *corners);
    mote_status status = MOTE_OK;
    for (unsigned f = 0; f < mesh->mNumFaces && status == MOTE_OK; ++f) {
        if (mesh->mFaces[f].mNumIndices >= 3) /* skip points and lines */
            status = add_face(path, mesh, f, base, corners, soup);
    }
    free(corners);
    return status;
}

mote_status mote_assimp_add_mesh(const char *path, const struct aiMesh *mesh,
                                 const mote_affine *place, mote_soup *soup)
{
    const uint32_t base = (uint32_t)soup->vertex_count;
    const mote_status status = add_vertices(path, mesh, place, soup);
    return status == MOTE_OK ? add_faces(path, mesh, base, soup) : status;
}

mote_status mote_assimp_too_deep(const char *path)
{
    return mote_fail(MOTE_EINVAL, "%s: nodes nested deeper than %d; flatten them", path,
                     MOTE_ASSIMP_DEPTH_MAX);
}

static mote_status add_node(const char *path, const struct aiScene *scene,
                            const struct aiNode *node, const mote_affine *parent, int depth,
                            mote_soup *soup)
{
    const mote_affine local = mote_assimp_affine(&node->mTransformation);
    const mote_affine place = mote_affine_multiply(parent, &local);
    mote_status status = depth > MOTE_ASSIMP_DEPTH_MAX ? mote_assimp_too_deep(path) : MOTE_OK;
    for (unsigned i = 0; i < node->mNumMeshes && status == MOTE_OK; ++i)
        status = mote_assimp_add_mesh(path, scene->mMeshes[node->mMeshes[i]], &place, soup);
    for (unsigned i = 0; i < node->mNumChildren && status == MOTE_OK; ++i)
        status = add_node(path, scene, node->mChildren[i], &place, depth + 1, soup);
    return status;
}

typedef enum dropped { DROPPED_NONE, DROPPED_FACES, DROPPED_CORNERS } dropped;

/* assimp drops faces with an index out of range, and corners that make no whole triangle, and
   reports it in its log only. Corners that make no whole line are none of a surface. */
static void note_dropped(const char *message, char *what)
{
    if (strstr(message, "out-of-range"))
        *what = DROPPED_FACES;
    else if (strstr(message, "compatible with the TRIANGLES mode"))
        *what = DROPPED_CORNERS;
}

static mote_status refuse_dropped(const char *path, char what)
{
    if (what == DROPPED_FACES)
        return mote_fail(MOTE_EINVAL,
                         "%s: a face with an index out of range; use those of vertices", path);
    return mote_fail(MOTE_EINVAL,
                     "%s: triangles whose corners cannot be divided by three; give three for "
                     "each triangle",
                     path);
}

static mote_status fail_as_assimp_says(const char *path)
{
    char said[MOTE_SAID_MAX];
    (void)mote_assimp_line(aiGetErrorString(), said);
    if (strncmp(said, "No suitable reader", strlen("No suitable reader")) == 0)
        return mote_fail(
            MOTE_EINVAL,
            "%s: neither its name nor its content is that of a known mesh format; give a "
            "mesh in OBJ, PLY, STL, OFF or glTF",
            path);
    if (strstr(said, "bad_alloc"))
        return mote_fail(MOTE_ENOMEM, "%s: assimp has no memory left", path);
    return mote_fail(
        MOTE_EINVAL,
        "%s: assimp cannot read it (%s); give a mesh in OBJ, PLY, STL, OFF or glTF", path,
        said);
}

/* assimp takes a glTF file of version 1 for a binary one by its name alone. */
static mote_status check_name(const char *path, const mote_gltf *gltf)
{
    const bool says_binary = mote_name_ends(path, ".glb");
    if (gltf->is_binary == says_binary)
        return MOTE_OK;
    return mote_fail(MOTE_EINVAL, "%s: glTF, and %s; give it a name that ends in %s", path,
                     gltf->is_binary ? "binary" : "text", gltf->is_binary ? ".glb" : ".gltf");
}

/* Reads and checks a file that is glTF; *text is NULL for one that is not, or is of version 1.
 */
static mote_status read_gltf(const char *path, bool moves, mote_assimp_file *file, char **text)
{
    size_t size = 0;
    mote_gltf *gltf = &file->gltf;
    mote_status status = mote_file_read(path, MOTE_GLTF_BYTES, &file->data, &size);
    if (status != MOTE_OK || !mote_gltf_is(path, file->data, size))
        return status;
    status = mote_gltf_open(path, file->data, size, gltf);
    if (status == MOTE_OK && !mote_gltf_is_2(gltf)) {
        status = check_name(path, gltf);
        mote_gltf_close(gltf);
        return status;
    }
    if (status == MOTE_OK)
        status = mote_gltf_check(gltf, moves);
    if (status == MOTE_OK && moves)
        status = mote_gltf_check_joints(gltf);
    if (status == MOTE_OK)
        *text = mote_gltf_text(gltf, moves);
    return status;
}

void mote_assimp_close(mote_assimp_file *file)
{
    aiReleaseImport(file->scene);
    mote_gltf_close(&file->gltf);
    free(file->data);
    *file = (mote_assimp_file){0};
}

/* We check that vertices are finite, weld them and triangulate polygons ourselves: assimp makes
   wrong triangles if a face is concave and not flat. */
static mote_status import(const char *path, char *text, mote_assimp_file *file)
{
    char what = DROPPED_NONE;
    const struct aiLogStream log = {note_dropped, &what};
    mote_assimp_files files = {.path = path,
                               .gltf = text ? &file->gltf : NULL,
                               .text = text,
                               .size = text ? strlen(text) : 0};
    struct aiFileIO io = mote_assimp_file_io(&files);
    aiAttachLogStream(&log);
    file->scene = aiImportFileEx(text ? MOTE_ASSIMP_TEXT : path, 0, &io);
    aiDetachLogStream(&log);
    if (!file->scene)
        return files.status != MOTE_OK ? files.status : fail_as_assimp_says(path);
    if (what != DROPPED_NONE)
        return refuse_dropped(path, what);
    return file->scene->mRootNode && file->scene->mNumMeshes > 0
               ? MOTE_OK
               : mote_fail(MOTE_EINVAL, "%s: no mesh in it; give triangles", path);
}

mote_status mote_assimp_open(const char *path, bool moves, mote_assimp_file *file)
{
    char *text = NULL;
    *file = (mote_assimp_file){0};
    mote_status status = read_gltf(path, moves, file, &text);
    if (!file->gltf.is_binary) {
        free(file->data);
        file->data = NULL;
    }
    if (status == MOTE_OK)
        status = import(path, text, file);
    free(text);
    return status;
}

mote_status mote_soup_read_assimp(const char *path, mote_soup *soup)
{
    const mote_affine identity = mote_affine_identity();
    mote_assimp_file file;
    mote_status status = mote_assimp_open(path, false, &file);
    soup->single_precision = true;
    if (status == MOTE_OK)
        status = add_node(path, file.scene, file.scene->mRootNode, &identity, 0, soup);
    if (status == MOTE_OK && soup->triangle_count == 0)
        status = mote_fail(MOTE_EINVAL, "%s: no face in it; give triangles", path);
    mote_assimp_close(&file);
    return status;
}
