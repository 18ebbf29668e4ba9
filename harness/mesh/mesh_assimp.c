/* Meshes read by assimp: PLY, STL, glTF and the other formats that it knows. The only file
   that includes it. */
#include "harness/base/memory.h"
#include "harness/mesh/mesh_soup.h"

#include <assimp/cimport.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SAID_MAX 200

/* What assimp or a file says, fit for one line: no control characters, no full stop at the
   end. */
static const char *one_line(const char *text, char said[SAID_MAX])
{
    (void)snprintf(said, SAID_MAX, "%.*s", SAID_MAX - 1, text);
    size_t length = strlen(said);
    while (length > 0 && strchr(" .,\r\n", said[length - 1]))
        said[--length] = '\0';
    for (char *at = said; *at; ++at)
        *at = (unsigned char)*at < ' ' ? ' ' : *at;
    return said;
}

/* " of mesh NAME", where it has a name. */
static const char *of_mesh(const struct aiMesh *mesh, char text[SAID_MAX])
{
    char name[SAID_MAX];
    (void)one_line(mesh->mName.data, name);
    (void)snprintf(text, SAID_MAX, "%s%.60s", name[0] ? " of mesh " : "", name);
    return text;
}

/* parent * child, in double precision. */
static void multiply(const double parent[12], const struct aiMatrix4x4 *m, double out[12])
{
    const double child[12] = {(double)m->a1, (double)m->a2, (double)m->a3, (double)m->a4,
                              (double)m->b1, (double)m->b2, (double)m->b3, (double)m->b4,
                              (double)m->c1, (double)m->c2, (double)m->c3, (double)m->c4};
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 4; ++c) {
            out[4 * r + c] = parent[4 * r] * child[c] + parent[4 * r + 1] * child[4 + c] +
                             parent[4 * r + 2] * child[8 + c] +
                             (c == 3 ? parent[4 * r + 3] : 0);
        }
    }
}

static mote_status add_vertices(const char *path, const struct aiMesh *mesh, const double m[12],
                                mote_soup *soup)
{
    mote_status status = MOTE_OK;
    for (unsigned v = 0; v < mesh->mNumVertices && status == MOTE_OK; ++v) {
        const double x = (double)mesh->mVertices[v].x;
        const double y = (double)mesh->mVertices[v].y;
        const double z = (double)mesh->mVertices[v].z;
        const double wx = m[0] * x + m[1] * y + m[2] * z + m[3];
        const double wy = m[4] * x + m[5] * y + m[6] * z + m[7];
        const double wz = m[8] * x + m[9] * y + m[10] * z + m[11];
        char name[SAID_MAX];
        if (!isfinite(wx) || !isfinite(wy) || !isfinite(wz))
            return mote_fail(MOTE_EINVAL, "%s: vertex %u%s is not finite; give finite numbers",
                             path, v, of_mesh(mesh, name));
        status = mote_soup_add_vertex(soup, wx, wy, wz);
    }
    return status;
}

/* corners: room for those of the face, whose vertices follow `base` others in the soup. */
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
    char name[SAID_MAX];
    return status == MOTE_OK ? status
                             : mote_fail(status, "%s: face %u%s: %s", path, f,
                                         of_mesh(mesh, name), mote_error_text());
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
        if (mesh->mFaces[f].mNumIndices >= 3) /* no points and lines */
            status = add_face(path, mesh, f, base, corners, soup);
    }
    free(corners);
    return status;
}

/* A file may nest nodes without end; real ones do not go this deep. */
#define DEPTH_MAX 256

static mote_status add_node(const char *path, const struct aiScene *scene,
                            const struct aiNode *node, const double parent[12], int depth,
                            mote_soup *soup)
{
    double m[12];
    multiply(parent, &node->mTransformation, m);
    mote_status status = MOTE_OK;
    if (depth > DEPTH_MAX)
        return mote_fail(MOTE_EINVAL, "%s: nodes nested deeper than %d; flatten them", path,
                         DEPTH_MAX);
    for (unsigned i = 0; i < node->mNumMeshes && status == MOTE_OK; ++i) {
        const struct aiMesh *mesh = scene->mMeshes[node->mMeshes[i]];
        const uint32_t base = (uint32_t)soup->vertex_count;
        status = add_vertices(path, mesh, m, soup);
        if (status == MOTE_OK)
            status = add_faces(path, mesh, base, soup);
    }
    for (unsigned i = 0; i < node->mNumChildren && status == MOTE_OK; ++i)
        status = add_node(path, scene, node->mChildren[i], m, depth + 1, soup);
    return status;
}

/* assimp drops faces with an index out of range and reports them in its log only. */
static void note_dropped(const char *message, char *dropped)
{
    if (strstr(message, "out-of-range") || strstr(message, "dropped"))
        *dropped = 1;
}

static mote_status fail_as_assimp_says(const char *path)
{
    char said[SAID_MAX];
    (void)one_line(aiGetErrorString(), said);
    if (strncmp(said, "No suitable reader", strlen("No suitable reader")) == 0)
        return mote_fail(MOTE_EINVAL,
                         "%s: no mesh format that is known by this name or content; give a "
                         "mesh in OBJ, PLY, STL, OFF or glTF",
                         path);
    return mote_fail(
        MOTE_EINVAL,
        "%s: assimp cannot read it (%s); give a mesh in OBJ, PLY, STL, OFF or glTF", path,
        said);
}

mote_status mote_soup_read_assimp(const char *path, mote_soup *soup)
{
    static const double identity[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    char dropped = 0;
    const struct aiLogStream log = {note_dropped, &dropped};
    aiAttachLogStream(&log);
    /* We weld vertices ourselves, after checking that they are finite, and triangulate
       polygons ourselves: assimp makes wrong triangles where a face is concave and not flat. */
    const struct aiScene *scene = aiImportFile(path, 0);
    aiDetachLogStream(&log);
    if (!scene)
        return fail_as_assimp_says(path);
    mote_status status = MOTE_OK;
    soup->single_precision = true;
    if (dropped)
        status = mote_fail(
            MOTE_EINVAL, "%s: a face with an index out of range; use those of vertices", path);
    else if (!scene->mRootNode || scene->mNumMeshes == 0)
        status = mote_fail(MOTE_EINVAL, "%s: no mesh in it; give triangles", path);
    else
        status = add_node(path, scene, scene->mRootNode, identity, 0, soup);
    if (status == MOTE_OK && soup->triangle_count == 0)
        status = mote_fail(MOTE_EINVAL, "%s: no face in it; give triangles", path);
    aiReleaseImport(scene);
    return status;
}
