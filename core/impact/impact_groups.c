/* Groups of a body's vertices: the parts of its tree a few levels below the root. */
#include "core/impact/impact_state.h"
#include "core/skin/skin.h"

#include <stdlib.h>

/* Groups times basis functions, at most: a table of 0.5 MB. */
#define TABLE_MOST 65536

typedef struct collection {
    const mote_cert_tree *tree;
    const mote_body *body;
    uint32_t *vertices; /* [tree->leaf_vertex_count] of the current group */
    uint32_t count;
    uint32_t *functions; /* [field->most] */
    double *phi;         /* [field->padded] */
} collection;

/* Lists the vertices below a child of a block: a block, or the leaf ~child. */
static void collect(collection *c, int32_t child)
{
    if (child < 0) {
        const mote_cert_leaf *leaf = &c->tree->leaves[~child];
        for (uint32_t i = 0; i < leaf->vertex_count; ++i)
            c->vertices[c->count++] = c->tree->leaf_vertices[leaf->first_vertex + i];
        return;
    }
    const mote_cert_block *block = &c->tree->blocks[child];
    for (uint32_t l = 0; l < block->children; ++l)
        collect(c, block->child[l]);
}

/* Children of blocks that together hold the whole body: opens the first block in the list again
   and again as long as there is room. Returns how many there are. */
static uint32_t list_parts(const mote_cert_tree *tree, uint32_t most,
                           int32_t parts[MOTE_IMPACT_GROUPS])
{
    uint32_t count = 1;
    parts[0] = 0;
    for (;;) {
        uint32_t first = 0;
        while (first < count && parts[first] < 0)
            ++first;
        if (first == count)
            return count;
        const mote_cert_block *block = &tree->blocks[parts[first]];
        if (count - 1 + block->children > most)
            return count;
        for (uint32_t i = first; i + 1 < count; ++i)
            parts[i] = parts[i + 1];
        --count;
        for (uint32_t l = 0; l < block->children; ++l)
            parts[count++] = block->child[l];
    }
}

static void raise_to(double *most, double value)
{
    const double size = fabs(value) * (1 + 0x1p-50);
    if (size > *most)
        *most = size;
}

/* Enters the functions at a vertex into the table of group g. */
static void enter_functions(collection *c, uint32_t vertex, mote_impact_groups *groups,
                            uint32_t g)
{
    const mote_field *field = c->body->field;
    const mote_mesh *mesh = c->body->mesh;
    if (field->kind->sparse) {
        const uint32_t n = field->kind->sparse(field, mesh, vertex, c->functions, c->phi);
        for (uint32_t i = 0; i < n; ++i) {
            if (groups->most)
                raise_to(&groups->most[(size_t)c->functions[i] * groups->padded + g],
                         c->phi[i]);
            raise_to(&groups->most_of_all[c->functions[i]], c->phi[i]);
        }
        return;
    }
    if (!field->kind->basis)
        return;
    field->kind->basis(field, mesh, vertex, c->phi);
    for (uint32_t j = 0; j < field->count; ++j) {
        raise_to(&groups->most[(size_t)j * groups->padded + g], c->phi[j]);
        raise_to(&groups->most_of_all[j], c->phi[j]);
    }
}

static void measure_group(collection *c, mote_impact_groups *groups, uint32_t g)
{
    const mote_vec3 *x = c->body->mesh->positions;
    mote_vec3 low = x[c->vertices[0]], high = low;
    for (uint32_t i = 0; i < c->count; ++i) {
        const mote_vec3 p = x[c->vertices[i]];
        low = mote_vec3_make(fmin(low.x, p.x), fmin(low.y, p.y), fmin(low.z, p.z));
        high = mote_vec3_make(fmax(high.x, p.x), fmax(high.y, p.y), fmax(high.z, p.z));
    }
    const mote_vec3 middle = mote_add(mote_scale(low, 0.5), mote_scale(high, 0.5));
    double radius = 0;
    for (uint32_t i = 0; i < c->count; ++i) {
        const mote_vec3 p = x[c->vertices[i]];
        radius = fmax(radius, mote_length(mote_sub(p, middle)));
        groups->size = fmax(groups->size, mote_length(p));
        if (c->body->field->count > 0)
            enter_functions(c, c->vertices[i], groups, g);
    }
    if (groups->bones)
        mote_impact_bones_add(groups->bones, g, groups->padded, c->vertices, c->count);
    groups->middle[g] = middle;
    groups->radius[g] = radius * (1 + 0x1p-48);
}

static mote_status allocate(collection *c, mote_impact_groups *groups, size_t *bytes)
{
    const mote_field *field = c->body->field;
    const mote_skin *skin = mote_field_skin(field);
    const size_t table = skin ? 0 : (size_t)field->count * groups->padded;
    if (skin) {
        const mote_status status = mote_impact_bones_create(skin, groups->count, groups->padded,
                                                            &groups->bones, bytes);
        if (status != MOTE_OK)
            return status;
    } else {
        groups->most = calloc(table + 1, sizeof *groups->most);
    }
    groups->middle = calloc(groups->count, sizeof *groups->middle);
    groups->radius = calloc(groups->count, sizeof *groups->radius);
    groups->most_of_all = calloc((size_t)field->count + 1, sizeof *groups->most_of_all);
    c->vertices = malloc(c->tree->leaf_vertex_count * sizeof *c->vertices);
    c->functions = malloc(((size_t)field->most + 1) * sizeof *c->functions);
    c->phi = malloc(((size_t)field->padded + 1) * sizeof *c->phi);
    *bytes += groups->count * (sizeof *groups->middle + sizeof *groups->radius) +
              (table + field->count + 2) * sizeof *groups->most;
    if (!groups->middle || !groups->radius || (!skin && !groups->most) ||
        !groups->most_of_all || !c->vertices || !c->functions || !c->phi)
        return mote_fail(MOTE_ENOMEM, "no memory for the groups of a body's vertices");
    return MOTE_OK;
}

mote_status mote_impact_groups_create(const mote_body *body, const mote_cert_tree *tree,
                                      mote_impact_groups *groups, size_t *bytes)
{
    const mote_field *field = body->field;
    const uint32_t room = TABLE_MOST / (field->count + 1);
    const uint32_t most = room < 1 ? 1 : room < MOTE_IMPACT_GROUPS ? room : MOTE_IMPACT_GROUPS;
    int32_t parts[MOTE_IMPACT_GROUPS] = {0};
    collection c = {.tree = tree, .body = body};
    groups->count = list_parts(tree, most, parts);
    groups->padded = (groups->count + MOTE_LANES - 1) / MOTE_LANES * MOTE_LANES;
    const mote_status status = allocate(&c, groups, bytes);
    for (uint32_t g = 0; g < groups->count && status == MOTE_OK; ++g) {
        c.count = 0;
        collect(&c, parts[g]);
        measure_group(&c, groups, g);
    }
    free(c.vertices);
    free(c.functions);
    free(c.phi);
    return status;
}

void mote_impact_groups_destroy(mote_impact_groups *groups)
{
    mote_impact_bones_destroy(groups->bones);
    free(groups->middle);
    free(groups->radius);
    free(groups->most);
    free(groups->most_of_all);
}
