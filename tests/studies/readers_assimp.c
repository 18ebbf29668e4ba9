#include "tests/studies/readers_assimp.h"

#include "harness/base/memory.h"

#include <assimp/cimport.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Receives each face of three or more corners; at[size] are its positions. */
typedef void (*take_face)(void *context, const mote_vec3 *at, unsigned size);

static mote_vec3 place(const struct aiMatrix4x4 *m, const struct aiVector3D *v)
{
    const double x = (double)v->x, y = (double)v->y, z = (double)v->z;
    return mote_vec3_make(
        (double)m->a1 * x + (double)m->a2 * y + (double)m->a3 * z + (double)m->a4,
        (double)m->b1 * x + (double)m->b2 * y + (double)m->b3 * z + (double)m->b4,
        (double)m->c1 * x + (double)m->c2 * y + (double)m->c3 * z + (double)m->c4);
}

static void walk_mesh(const struct aiMesh *mesh, const struct aiMatrix4x4 *m, take_face take,
                      void *context)
{
    size_t capacity = 0;
    mote_vec3 *at = NULL;
    for (unsigned f = 0; f < mesh->mNumFaces; ++f) {
        const struct aiFace *face = &mesh->mFaces[f];
        bool known = face->mNumIndices >= 3;
        at = mote_reserve(at, face->mNumIndices, &capacity, sizeof *at);
        for (unsigned i = 0; i < face->mNumIndices && known; ++i) {
            known = face->mIndices[i] < mesh->mNumVertices;
            if (known)
                at[i] = place(m, &mesh->mVertices[face->mIndices[i]]);
        }
        if (known)
            take(context, at, face->mNumIndices);
    }
    free(at);
}

static void walk_node(const struct aiScene *scene, const struct aiNode *node,
                      const struct aiMatrix4x4 *parent, take_face take, void *context)
{
    struct aiMatrix4x4 m = *parent;
    aiMultiplyMatrix4(&m, &node->mTransformation);
    for (unsigned i = 0; i < node->mNumMeshes; ++i)
        walk_mesh(scene->mMeshes[node->mMeshes[i]], &m, take, context);
    for (unsigned i = 0; i < node->mNumChildren; ++i)
        walk_node(scene, node->mChildren[i], &m, take, context);
}

static void walk_file(const char *path, unsigned flags, take_face take, void *context,
                      char *said, size_t size)
{
    struct aiMatrix4x4 identity;
    said[0] = '\0';
    aiIdentityMatrix4(&identity);
    const struct aiScene *scene = aiImportFile(path, flags);
    if (scene && scene->mRootNode)
        walk_node(scene, scene->mRootNode, &identity, take, context);
    else
        (void)snprintf(said, size, "%s", aiGetErrorString());
    if (scene)
        aiReleaseImport(scene);
}

static void add_triangle(void *context, const mote_vec3 *at, unsigned size)
{
    if (size == 3)
        surface_add(context, at[0], at[1], at[2]);
}

void surface_read_assimp(const char *path, surface *s, char *said, size_t size)
{
    *s = (surface){0};
    walk_file(path, aiProcess_Triangulate, add_triangle, s, said, size);
}

static void add_polygon(void *context, const mote_vec3 *at, unsigned size)
{
    polygons *p = context;
    p->at = mote_reserve(p->at, p->vertex_count + size, &p->vertex_capacity, sizeof *p->at);
    p->corners = mote_reserve(p->corners, p->corner_count + size, &p->corner_capacity,
                              sizeof *p->corners);
    p->first = mote_reserve(p->first, p->face_count + 2, &p->face_capacity, sizeof *p->first);
    p->first[p->face_count++] = p->corner_count;
    for (unsigned i = 0; i < size; ++i) {
        p->corners[p->corner_count++] = (uint32_t)p->vertex_count;
        p->at[p->vertex_count++] = at[i];
    }
    p->first[p->face_count] = p->corner_count;
}

void polygons_read(const char *path, polygons *p, char *said, size_t size)
{
    *p = (polygons){0};
    walk_file(path, 0, add_polygon, p, said, size);
}

void polygons_free(polygons *p)
{
    free(p->at);
    free(p->corners);
    free(p->first);
    *p = (polygons){0};
}

/* Twice the area along each axis, seen from the first corner. */
static mote_vec3 newell(const polygons *p, size_t face)
{
    const uint32_t *corner = p->corners + p->first[face];
    const size_t size = p->first[face + 1] - p->first[face];
    mote_vec3 sum = mote_vec3_make(0, 0, 0);
    for (size_t i = 1; i + 1 < size; ++i)
        sum = mote_add(sum, mote_cross(mote_sub(p->at[corner[i]], p->at[corner[0]]),
                                       mote_sub(p->at[corner[i + 1]], p->at[corner[0]])));
    return sum;
}

static double thickness_of(const polygons *p, size_t face, mote_vec3 normal)
{
    const mote_vec3 first = p->at[p->corners[p->first[face]]];
    const double length = mote_length(normal);
    double low = 0, high = 0;
    for (size_t i = p->first[face]; i < p->first[face + 1] && length > 0; ++i) {
        const double height = mote_dot(mote_sub(p->at[p->corners[i]], first), normal) / length;
        low = fmin(low, height);
        high = fmax(high, height);
    }
    return high - low;
}

double polygons_area(const polygons *p, double *thickness)
{
    double area = 0;
    *thickness = 0;
    for (size_t f = 0; f < p->face_count; ++f) {
        const mote_vec3 normal = newell(p, f);
        area += mote_length(normal) / 2;
        if (p->first[f + 1] - p->first[f] > 3)
            *thickness = fmax(*thickness, 2 * thickness_of(p, f, normal));
    }
    return area;
}

void surface_of_fans(const polygons *p, surface *s)
{
    *s = (surface){0};
    for (size_t f = 0; f < p->face_count; ++f) {
        const uint32_t *corner = p->corners + p->first[f];
        for (size_t i = 1; i + 1 < p->first[f + 1] - p->first[f]; ++i)
            surface_add(s, p->at[corner[0]], p->at[corner[i]], p->at[corner[i + 1]]);
    }
}
