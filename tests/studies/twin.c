#include "tests/studies/twin.h"

/* Corners and faces of a mesh under construction. */
typedef struct draft {
    mote_vec3 *corner;
    uint32_t (*face)[3];
    uint32_t corners, faces;
} draft;

static draft draft_of(const mote_mesh *mesh, uint32_t more_corners, uint32_t faces)
{
    draft d = {.corners = mesh->vertex_count, .faces = mesh->triangle_count};
    d.corner = malloc((d.corners + more_corners) * sizeof *d.corner);
    d.face = malloc(faces * sizeof *d.face);
    need(d.corner && d.face);
    memcpy(d.corner, mesh->positions, d.corners * sizeof *d.corner);
    memcpy(d.face, mesh->triangles, d.faces * sizeof *d.face);
    return d;
}

/* The vertex in the middle of an edge: the one already made for it, or a new one. ends lists
   the edges of the new vertices. */
static uint32_t middle(draft *d, uint32_t (*ends)[2], uint32_t first, uint32_t a, uint32_t b)
{
    const uint32_t low = a < b ? a : b, high = a < b ? b : a;
    for (uint32_t v = first; v < d->corners; ++v) {
        if (ends[v - first][0] == low && ends[v - first][1] == high)
            return v;
    }
    ends[d->corners - first][0] = low;
    ends[d->corners - first][1] = high;
    d->corner[d->corners] = mote_scale(mote_add(d->corner[low], d->corner[high]), 0.5);
    return d->corners++;
}

static draft draft_refined(const mote_mesh *mesh)
{
    draft d = draft_of(mesh, mesh->edge_count, 4 * mesh->triangle_count);
    const uint32_t first = d.corners;
    uint32_t(*ends)[2] = malloc(mesh->edge_count * sizeof *ends);
    need(ends != NULL);
    for (uint32_t t = 0; t < mesh->triangle_count; ++t) {
        const uint32_t *f = mesh->triangles[t];
        const uint32_t ab = middle(&d, ends, first, f[0], f[1]);
        const uint32_t bc = middle(&d, ends, first, f[1], f[2]);
        const uint32_t ca = middle(&d, ends, first, f[2], f[0]);
        const uint32_t four[4][3] = {
            {f[0], ab, ca}, {ab, f[1], bc}, {ca, bc, f[2]}, {ab, bc, ca}};
        memcpy(d.face[4 * t], four, sizeof four);
    }
    d.faces = 4 * mesh->triangle_count;
    free(ends);
    return d;
}

static void draft_flip(draft *d, scene *dice)
{
    for (uint32_t t = 0; t < d->faces; ++t) {
        if (scene_random(dice, 0, 1) < 0.5)
            continue;
        const uint32_t corner = d->face[t][0];
        d->face[t][0] = d->face[t][1];
        d->face[t][1] = corner;
    }
}

/* A random permutation of count elements: order[i] is the new place of i. */
static uint32_t *random_order(uint32_t count, scene *dice)
{
    uint32_t *order = malloc(count * sizeof *order);
    need(order != NULL);
    for (uint32_t i = 0; i < count; ++i)
        order[i] = i;
    for (uint32_t i = count; i > 1; --i) {
        const uint32_t j = (uint32_t)scene_random(dice, 0, i);
        const uint32_t kept = order[i - 1];
        order[i - 1] = order[j];
        order[j] = kept;
    }
    return order;
}

static void draft_permute(draft *d, scene *dice)
{
    uint32_t *place = random_order(d->corners, dice), *turn = random_order(d->faces, dice);
    mote_vec3 *corner = malloc(d->corners * sizeof *corner);
    uint32_t(*face)[3] = malloc(d->faces * sizeof *face);
    need(corner && face);
    for (uint32_t v = 0; v < d->corners; ++v)
        corner[place[v]] = d->corner[v];
    for (uint32_t t = 0; t < d->faces; ++t) {
        const uint32_t start = (uint32_t)scene_random(dice, 0, 3);
        for (uint32_t k = 0; k < 3; ++k)
            face[turn[t]][k] = place[d->face[t][(start + k) % 3]];
    }
    free(d->corner);
    free(d->face);
    free(place);
    free(turn);
    d->corner = corner;
    d->face = face;
}

static mote_mesh *changed_mesh(const mote_mesh *mesh, const twin_change *change, scene *dice)
{
    draft d = change->refine ? draft_refined(mesh) : draft_of(mesh, 0, mesh->triangle_count);
    if (change->flip)
        draft_flip(&d, dice);
    if (change->permute)
        draft_permute(&d, dice);
    for (uint32_t v = 0; v < d.corners; ++v)
        d.corner[v] = mote_scale(d.corner[v], ldexp(1, change->exponent));
    mote_mesh *made = NULL;
    need(mote_mesh_create(&d.corner[0].x, d.corners, &d.face[0][0], d.faces, &made) == MOTE_OK);
    free(d.corner);
    free(d.face);
    return made;
}

static mote_field *changed_field(const mote_field *field, double scale)
{
    mote_field *made = NULL;
    if (field->count == 0) {
        need(mote_field_create_static(&made) == MOTE_OK);
        return made;
    }
    mote_vec3 centre[MOTE_FIELD_SUMMED];
    for (uint32_t j = 0; j < field->count; ++j)
        centre[j] = mote_scale(
            mote_vec3_make(field->centre_x[j], field->centre_y[j], field->centre_z[j]), scale);
    need(mote_field_create_csrbf(centre, field->count, scale * field->support, &made) ==
         MOTE_OK);
    return made;
}

void twin_init(const scene *base, const twin_change *change, scene *twin)
{
    const double scale = ldexp(1, change->exponent);
    *twin = (scene){.random = change->seed, .length = scale * base->length};
    for (int b = 0; b < 2; ++b) {
        const int from = change->swap ? 1 - b : b;
        twin->mesh[b] = changed_mesh(base->mesh[from], change, twin);
        twin->field[b] = changed_field(base->field[from], scale);
        twin->body[b] = (mote_body){.mesh = twin->mesh[b], .field = twin->field[b]};
        need(mote_deform_create(&twin->body[b], &twin->deform[b]) == MOTE_OK);
        twin->world[b] = malloc(twin->mesh[b]->vertex_count * sizeof *twin->world[b]);
        need(twin->world[b] != NULL);
    }
}

static mote_mat3 product(const mote_mat3 *a, const mote_mat3 *b)
{
    mote_mat3 c;
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column)
            c.m[row][column] = a->m[row][0] * b->m[0][column] + a->m[row][1] * b->m[1][column] +
                               a->m[row][2] * b->m[2][column];
    }
    return c;
}

void twin_follow(const scene *base, const twin_change *change, scene *twin)
{
    const double scale = ldexp(1, change->exponent), reach = 3 * base->length;
    mote_pose motion = {.rotation = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}};
    if (change->move) {
        motion.rotation = random_rotation(twin);
        motion.translation =
            mote_vec3_make(scene_random(twin, -reach, reach), scene_random(twin, -reach, reach),
                           scene_random(twin, -reach, reach));
    }
    twin->frame.number = base->frame.number;
    for (int b = 0; b < 2; ++b) {
        const int from = change->swap ? 1 - b : b;
        const mote_body_state *was = &base->frame.body[from];
        mote_body_state *state = &twin->frame.body[b];
        *state = *was;
        if (change->move) {
            state->pose.rotation = product(&motion.rotation, &was->pose.rotation);
            state->pose.translation = mote_pose_apply(&motion, was->pose.translation);
            state->pose_changed = state->shape_changed = true;
        }
        state->pose.translation = mote_scale(state->pose.translation, scale);
        for (uint32_t j = 0; j < twin->field[b]->count; ++j) {
            mote_vec3 w =
                mote_vec3_make(was->weights.x[j], was->weights.y[j], was->weights.z[j]);
            w = mote_scale(change->move ? mote_rotate(&motion.rotation, w) : w, scale);
            twin->weights[b][0][j] = w.x;
            twin->weights[b][1][j] = w.y;
            twin->weights[b][2][j] = w.z;
        }
        state->weights =
            (mote_weights){twin->weights[b][0], twin->weights[b][1], twin->weights[b][2],
                           twin->field[b]->count, twin->field[b]->padded};
        mote_deform_all(twin->deform[b], state, twin->world[b]);
        state->vertices = twin->world[b];
    }
}
