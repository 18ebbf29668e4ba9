/* Characters read by assimp: nodes, bones, weights and morph targets. */
#include "harness/mesh/character_parts.h"
#include "harness/mesh/mesh_assimp.h"

#include "harness/base/hash.h"
#include "harness/base/memory.h"

#include <assimp/cimport.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A vertex's weight for a bone, or its displacement by a morph target. */
typedef struct influence {
    uint32_t vertex, of;
    double weight;
    mote_vec3 shift;
} influence;

typedef struct influences {
    influence *list;
    size_t count, capacity;
} influences;

typedef struct reader {
    const char *path;
    const struct aiScene *scene;
    mote_gltf *gltf;             /* NULL: another format */
    const struct aiNode **nodes; /* as numbered in the rig */
    size_t node_capacity;
    mote_node_name *names; /* [nodes], sorted */
    mote_affine *globals;  /* [nodes] as stored */
    mote_affine stand;     /* moves skinned meshes to where their bones put them: see
                              find_stand */
    bool *is_added;        /* [meshes] with bones; several nodes may refer to one mesh */
    uint32_t *slots;       /* a hash table of bones; a power of two, MOTE_RIG_NONE: free */
    size_t slot_count;
    influences weights, shifts;
    mote_character_draft *draft;
} reader;

/* The number in a glTF file of a node by its name, or -1: the root of several nodes. */
static int64_t gltf_number(const reader *r, const char *name)
{
    char *end = NULL;
    const unsigned long number = r->gltf ? strtoul(name, &end, 10) : 0;
    return end && end != name && *end == '\0' ? (int64_t)number : -1;
}

/* The name of a node in the file; the caller frees it. */
static char *own_name(const reader *r, const char *name)
{
    const int64_t number = gltf_number(r, name);
    return number < 0 ? mote_duplicate(name) : mote_gltf_node_name(r->gltf, (size_t)number);
}

static mote_status add_node(reader *r, const struct aiNode *node, uint32_t parent, int depth)
{
    mote_rig *rig = &r->draft->made.rig;
    const uint32_t own = (uint32_t)rig->nodes_count;
    if (depth > MOTE_ASSIMP_DEPTH_MAX)
        return mote_assimp_too_deep(r->path);
    r->nodes = mote_reserve(r->nodes, (size_t)own + 1, &r->node_capacity,
                            sizeof(const struct aiNode *));
    r->nodes[own] = node;
    MOTE_RIG_GROW(rig, nodes, 1);
    char *name = own_name(r, node->mName.data);
    rig->nodes[own] = (mote_rig_node){parent, mote_rig_add_name(rig, name),
                                      mote_assimp_affine(&node->mTransformation)};
    free(name);
    mote_status status = MOTE_OK;
    for (unsigned i = 0; i < node->mNumChildren && status == MOTE_OK; ++i)
        status = add_node(r, node->mChildren[i], own, depth + 1);
    return status;
}

static int compare_names(const void *a, const void *b)
{
    const mote_node_name *p = a, *q = b;
    const int order = strcmp(p->name, q->name);
    return order ? order : (p->node > q->node) - (p->node < q->node);
}

static void sort_names(reader *r)
{
    const size_t count = r->draft->made.rig.nodes_count;
    r->names = mote_allocate(count, sizeof *r->names);
    for (size_t n = 0; n < count; ++n)
        r->names[n] = (mote_node_name){r->nodes[n]->mName.data, (uint32_t)n};
    qsort(r->names, count, sizeof *r->names, compare_names);
}

uint32_t mote_node_find(const mote_node_name *names, size_t count, const char *name)
{
    size_t low = 0, high = count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (strcmp(names[middle].name, name) < 0)
            low = middle + 1;
        else
            high = middle;
    }
    return low < count && strcmp(names[low].name, name) == 0 ? names[low].node : MOTE_RIG_NONE;
}

static mote_status node_of_bone(const reader *r, const struct aiBone *bone, uint32_t *node)
{
    char said[MOTE_SAID_MAX];
    *node = mote_node_find(r->names, r->draft->made.rig.nodes_count, bone->mName.data);
    if (*node != MOTE_RIG_NONE)
        return MOTE_OK;
    char *name = own_name(r, bone->mName.data);
    const mote_status status =
        mote_fail(MOTE_EINVAL, "%s: bone %.60s is not a node%s; give each bone a node", r->path,
                  mote_assimp_line(name, said), r->gltf ? " of the scene" : "");
    free(name);
    return status;
}

/* A node's map as stored, or the identity if it is singular: a mesh with bones does not depend
   on it, and one without bones then stays as it is in the file. *back is the map's inverse. */
static mote_affine home_of(const reader *r, uint32_t node, mote_affine *back)
{
    if (mote_affine_invert(&r->globals[node], back))
        return r->globals[node];
    return *back = mote_affine_identity();
}

/* The bone with the largest total weight, and the node of its mesh. */
static const struct aiBone *heaviest_bone(const reader *r, uint32_t *home)
{
    const struct aiBone *heaviest = NULL;
    double most = 0;
    for (uint32_t n = 0; n < r->draft->made.rig.nodes_count; ++n) {
        for (unsigned i = 0; i < r->nodes[n]->mNumMeshes; ++i) {
            const struct aiMesh *mesh = r->scene->mMeshes[r->nodes[n]->mMeshes[i]];
            for (unsigned b = 0; b < mesh->mNumBones; ++b) {
                double sum = 0;
                for (unsigned k = 0; k < mesh->mBones[b]->mNumWeights; ++k)
                    sum += (double)mesh->mBones[b]->mWeights[k].mWeight;
                if (sum > most) {
                    most = sum;
                    heaviest = mesh->mBones[b];
                    *home = n;
                }
            }
        }
    }
    return heaviest;
}

/* If the linear part is closer to the identity than this, a mesh already stands in place. */
#define STANDS 0.01

/* Vertices of a mesh with bones are where the bones put them, whatever its node says: a file
   may store them in centimetres and the bones in metres. The rest pose should have the size of
   the later poses. So if the map by which the heaviest bone moves the mesh, with nodes as
   stored, is not close to the identity, it is applied to all meshes with bones. There is one
   map for all of them so that coincident vertices stay coincident. */
static mote_status find_stand(reader *r)
{
    uint32_t home = 0, node = 0;
    r->stand = mote_affine_identity();
    const struct aiBone *bone = heaviest_bone(r, &home);
    if (!bone)
        return MOTE_OK;
    mote_status status = node_of_bone(r, bone, &node);
    if (status != MOTE_OK)
        return status;
    mote_affine back;
    (void)home_of(r, home, &back);
    const mote_affine bind = mote_assimp_affine(&bone->mOffsetMatrix);
    const mote_affine moved = mote_affine_multiply(&r->globals[node], &bind);
    const mote_affine map = mote_affine_multiply(&moved, &back);
    double off = 0;
    for (int k = 0; k < 9; ++k)
        off = fmax(off, fabs(map.m[k / 3][k % 3] - (k % 4 == 0 ? 1 : 0)));
    if (off > STANDS && mote_affine_is_finite(&map) && mote_affine_invert(&map, &back))
        r->stand = map;
    return MOTE_OK;
}

/* Finds the bone with this node and bind matrix, or adds it. */
static mote_status find_bone(reader *r, uint32_t node, const mote_affine *bind, uint32_t *bone)
{
    mote_rig *rig = &r->draft->made.rig;
    uint64_t hash = mote_hash_word(MOTE_HASH_START, node);
    for (int k = 0; k < 12; ++k)
        hash = mote_hash_double(hash, bind->m[k / 4][k % 4]);
    size_t slot = hash & (r->slot_count - 1);
    for (; r->slots[slot] != MOTE_RIG_NONE; slot = (slot + 1) & (r->slot_count - 1)) {
        const mote_rig_bone *other = &rig->bones[r->slots[slot]];
        *bone = r->slots[slot];
        if (other->node == node && memcmp(&other->bind, bind, sizeof *bind) == 0)
            return MOTE_OK;
    }
    *bone = (uint32_t)rig->bones_count;
    if (*bone > UINT16_MAX - 1)
        return mote_fail(MOTE_EINVAL, "%s: more than %d bones; give fewer", r->path,
                         UINT16_MAX);
    r->slots[slot] = *bone;
    MOTE_RIG_GROW(rig, bones, 1);
    rig->bones[*bone] = (mote_rig_bone){node, *bind};
    return MOTE_OK;
}

static void add_influence(influences *to, influence one)
{
    to->list = mote_reserve(to->list, to->count + 1, &to->capacity, sizeof *to->list);
    to->list[to->count++] = one;
}

/* Whether a bone has a weight that is not 0; assimp gives a weight of 0 to bones without any.
 */
static bool moves_any(const struct aiBone *bone)
{
    for (unsigned k = 0; k < bone->mNumWeights; ++k) {
        if (bone->mWeights[k].mWeight != 0)
            return true;
    }
    return false;
}

/* Adds the weights of the mesh's vertices, whose numbers begin at base. back: from rest
   coordinates to those of the mesh. */
static mote_status add_weights(reader *r, const struct aiMesh *mesh, uint32_t base,
                               const mote_affine *back)
{
    const mote_rig *rig = &r->draft->made.rig;
    mote_status status = MOTE_OK;
    for (unsigned b = 0; b < mesh->mNumBones && status == MOTE_OK; ++b) {
        const struct aiBone *bone = mesh->mBones[b];
        const mote_affine offset = mote_assimp_affine(&bone->mOffsetMatrix);
        const mote_affine bind = mote_affine_multiply(&offset, back);
        uint32_t node = 0, own = 0;
        if (!moves_any(bone))
            continue;
        status = node_of_bone(r, bone, &node);
        if (status == MOTE_OK)
            status = find_bone(r, node, &bind, &own);
        for (unsigned k = 0; k < bone->mNumWeights && status == MOTE_OK; ++k) {
            const struct aiVertexWeight *w = &bone->mWeights[k];
            if (w->mVertexId >= mesh->mNumVertices)
                return mote_fail(MOTE_EINVAL, "%s: bone %s moves vertex %u of %u; use 0 to %u",
                                 r->path, rig->names + rig->nodes[node].name, w->mVertexId,
                                 mesh->mNumVertices, mesh->mNumVertices - 1);
            add_influence(&r->weights, (influence){.vertex = base + w->mVertexId,
                                                   .of = own,
                                                   .weight = (double)w->mWeight});
        }
    }
    return status;
}

/* Binds vertices that no bone moves to their node. */
static mote_status follow_node(reader *r, const struct aiMesh *mesh, uint32_t base,
                               uint32_t node, const mote_affine *back, size_t first)
{
    bool *moved = mote_allocate(mesh->mNumVertices, sizeof *moved);
    for (size_t i = first; i < r->weights.count; ++i) {
        if (r->weights.list[i].weight != 0)
            moved[r->weights.list[i].vertex - base] = true;
    }
    mote_status status = MOTE_OK;
    uint32_t bone = MOTE_RIG_NONE;
    for (uint32_t v = 0; v < mesh->mNumVertices && status == MOTE_OK; ++v) {
        if (moved[v])
            continue;
        if (bone == MOTE_RIG_NONE)
            status = find_bone(r, node, back, &bone);
        r->draft->import.unweighted += mesh->mNumBones > 0;
        add_influence(&r->weights, (influence){.vertex = base + v, .of = bone, .weight = 1});
    }
    free(moved);
    return status;
}

/* The weight of a target at rest. In glTF a node's own takes the place of its mesh's, which is
   all that assimp reads. Of other formats assimp does not tell it: it says 1 of all targets of
   FBX, and of those of COLLADA whose weight is 0. */
static double weight_at_rest(const reader *r, uint32_t node, const struct aiAnimMesh *to,
                             unsigned target)
{
    if (!r->gltf)
        return 0;
    const int64_t number = gltf_number(r, r->nodes[node]->mName.data);
    const json_t *entry = number < 0 ? NULL : mote_gltf_entry(r->gltf, "nodes", number);
    const json_t *own = json_array_get(json_object_get(entry, "weights"), target);
    return (double)(json_is_number(own) ? (float)json_number_value(own) : to->mWeight);
}

/* Adds the morph targets of a mesh. assimp gives positions, and with all weights 0 they are the
   mesh's own. */
static mote_status add_targets(reader *r, const struct aiMesh *mesh, uint32_t base,
                               uint32_t node, const mote_affine *place)
{
    mote_rig *rig = &r->draft->made.rig;
    for (unsigned t = 0; t < mesh->mNumAnimMeshes; ++t) {
        const struct aiAnimMesh *to = mesh->mAnimMeshes[t];
        const uint32_t own = (uint32_t)rig->targets_count;
        char said[MOTE_SAID_MAX];
        if (to->mVertices && to->mNumVertices != mesh->mNumVertices)
            return mote_fail(MOTE_EINVAL,
                             "%s: morph target %.60s has %u vertices and its mesh %u; give it "
                             "as many",
                             r->path, mote_assimp_line(to->mName.data, said), to->mNumVertices,
                             mesh->mNumVertices);
        MOTE_RIG_GROW(rig, targets, 1);
        rig->targets[own] = (mote_rig_target){mote_rig_add_name(rig, to->mName.data), node, t,
                                              weight_at_rest(r, node, to, t)};
        for (uint32_t v = 0; to->mVertices && v < mesh->mNumVertices; ++v) {
            const struct aiVector3D *a = &mesh->mVertices[v], *b = &to->mVertices[v];
            const mote_vec3 shift = {(double)b->x - (double)a->x, (double)b->y - (double)a->y,
                                     (double)b->z - (double)a->z};
            if (shift.x != 0 || shift.y != 0 || shift.z != 0)
                add_influence(&r->shifts, (influence){.vertex = base + v,
                                                      .of = own,
                                                      .shift = mote_affine_turn(place, shift)});
        }
    }
    return MOTE_OK;
}

static mote_status add_mesh(reader *r, uint32_t node, unsigned number)
{
    const struct aiMesh *mesh = r->scene->mMeshes[number];
    const uint32_t base = (uint32_t)r->draft->soup.vertex_count;
    const size_t first = r->weights.count;
    mote_affine back, place = home_of(r, node, &back);
    if (mesh->mNumBones > 0 && r->is_added[number])
        return MOTE_OK;
    r->is_added[number] = true;
    if (mesh->mNumBones > 0) {
        place = mote_affine_multiply(&r->stand, &place);
        if (!mote_affine_invert(&place, &back))
            place = back = mote_affine_identity();
    }
    mote_status status = mote_assimp_add_mesh(r->path, mesh, &place, &r->draft->soup);
    if (status == MOTE_OK)
        status = add_weights(r, mesh, base, &back);
    if (status == MOTE_OK)
        status = follow_node(r, mesh, base, node, &back, first);
    if (status == MOTE_OK)
        status = add_targets(r, mesh, base, node, &place);
    ++r->draft->import.meshes;
    return status;
}

static mote_status add_meshes(reader *r)
{
    mote_status status = MOTE_OK;
    for (uint32_t n = 0; n < r->draft->made.rig.nodes_count && status == MOTE_OK; ++n) {
        for (unsigned i = 0; i < r->nodes[n]->mNumMeshes && status == MOTE_OK; ++i)
            status = add_mesh(r, n, r->nodes[n]->mMeshes[i]);
    }
    if (status == MOTE_OK && r->draft->soup.triangle_count == 0)
        status = mote_fail(MOTE_EINVAL, "%s: no face in it; give triangles", r->path);
    return status;
}

static int compare_influences(const void *a, const void *b)
{
    const influence *p = a, *q = b;
    const int order = (p->vertex > q->vertex) - (p->vertex < q->vertex);
    return order ? order : (p->of > q->of) - (p->of < q->of);
}

/* start[v]: the index of the first of the sorted influences that belongs to vertex v or a later
   one. */
static void index_influences(influences *from, size_t vertices, uint32_t *start)
{
    size_t at = 0;
    if (from->count > 0)
        qsort(from->list, from->count, sizeof *from->list, compare_influences);
    for (size_t v = 0; v <= vertices; ++v) {
        while (at < from->count && from->list[at].vertex < v)
            ++at;
        start[v] = (uint32_t)at;
    }
}

static void set_arrays(reader *r)
{
    mote_character *made = &r->draft->made;
    const size_t vertices = r->draft->soup.vertex_count;
    MOTE_RIG_GROW(made, start, vertices + 1);
    MOTE_RIG_GROW(made, shift_start, vertices + 1);
    MOTE_RIG_GROW(made, bone, r->weights.count);
    MOTE_RIG_GROW(made, weight, r->weights.count);
    MOTE_RIG_GROW(made, target, r->shifts.count);
    MOTE_RIG_GROW(made, shift, r->shifts.count);
    index_influences(&r->weights, vertices, made->start);
    index_influences(&r->shifts, vertices, made->shift_start);
    for (size_t i = 0; i < r->weights.count; ++i) {
        made->bone[i] = (uint16_t)r->weights.list[i].of;
        made->weight[i] = r->weights.list[i].weight;
    }
    for (size_t i = 0; i < r->shifts.count; ++i) {
        made->target[i] = r->shifts.list[i].of;
        made->shift[i] = r->shifts.list[i].shift;
    }
}

static void make_slots(reader *r)
{
    size_t bones = 64;
    for (size_t n = 0; n < r->draft->made.rig.nodes_count; ++n) {
        for (unsigned i = 0; i < r->nodes[n]->mNumMeshes; ++i)
            bones += (size_t)r->scene->mMeshes[r->nodes[n]->mMeshes[i]]->mNumBones + 1;
    }
    for (r->slot_count = 64; r->slot_count < 2 * bones;)
        r->slot_count *= 2;
    r->slots = mote_allocate(r->slot_count, sizeof *r->slots);
    memset(r->slots, 0xff, r->slot_count * sizeof *r->slots);
}

/* Sets the keys that assimp does not read. */
static mote_status set_keys(const reader *r)
{
    const size_t count = json_array_size(json_object_get(r->gltf->root, "nodes"));
    mote_rig *rig = &r->draft->made.rig;
    uint32_t *nodes = mote_allocate(count, sizeof *nodes);
    memset(nodes, 0xff, count * sizeof *nodes); /* MOTE_RIG_NONE */
    for (size_t n = rig->nodes_count; n-- > 0;) {
        const int64_t number = gltf_number(r, r->nodes[n]->mName.data);
        if (number >= 0 && (size_t)number < count)
            nodes[number] = (uint32_t)n;
    }
    const mote_status status = mote_character_set_gltf_keys(r->gltf, nodes, rig);
    free(nodes);
    return status;
}

static mote_status read_scene(reader *r)
{
    mote_rig *rig = &r->draft->made.rig;
    mote_status status = add_node(r, r->scene->mRootNode, MOTE_RIG_NONE, 0);
    if (status != MOTE_OK)
        return status;
    sort_names(r);
    make_slots(r);
    r->is_added = mote_allocate(r->scene->mNumMeshes, sizeof *r->is_added);
    r->globals = mote_allocate(rig->nodes_count, sizeof *r->globals);
    mote_rig_globals(rig, MOTE_RIG_NONE, 0, r->globals);
    status = find_stand(r);
    if (status == MOTE_OK)
        status = add_meshes(r);
    if (status == MOTE_OK) {
        mote_character_read_clips(r->scene, r->names, rig);
        set_arrays(r);
    }
    return status == MOTE_OK && r->gltf ? set_keys(r) : status;
}

/* Whether anything in the file can move. */
static bool has_bones(const struct aiScene *scene)
{
    for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
        if (scene->mMeshes[m]->mNumBones > 0 || scene->mMeshes[m]->mNumAnimMeshes > 0)
            return true;
    }
    return false;
}

static mote_status read_moving(reader *r)
{
    if (has_bones(r->scene) || r->scene->mNumAnimations > 0)
        return read_scene(r);
    return mote_fail(MOTE_EUNSUPPORTED,
                     "%s: no bones, morph targets or clips in it: nothing can move; name it as "
                     "\"file\"",
                     r->path);
}

mote_status mote_character_read_assimp(const char *path, mote_character_draft *draft)
{
    mote_assimp_file file;
    mote_status status = mote_assimp_open(path, true, &file);
    reader r = {.path = path,
                .scene = file.scene,
                .gltf = file.gltf.root ? &file.gltf : NULL,
                .draft = draft};
    if (status == MOTE_OK)
        status = read_moving(&r);
    draft->soup.single_precision = true;
    mote_assimp_close(&file);
    free(r.nodes);
    free(r.names);
    free(r.globals);
    free(r.is_added);
    free(r.slots);
    free(r.weights.list);
    free(r.shifts.list);
    return status;
}
