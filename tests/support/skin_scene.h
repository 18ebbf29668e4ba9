/* Two skinned tori in random poses, with or without morph targets. Checks that boxes deformed
   by a certificate contain their vertices. */
#ifndef MOTE_TESTS_SKIN_SCENE_H
#define MOTE_TESTS_SKIN_SCENE_H

#include "core/certificate/certificate_state.h"
#include "core/skin/skin.h"
#include "tests/support/shapes.h"

/* A skinned pair, its bones' matrices and the amounts of its morph targets. */
typedef struct skinned {
    scene s;
    uint32_t bones, targets;
    double (*matrix[2])[3][4]; /* [bones]; one if targets move all */
    double *amounts[2];        /* [targets] */
    double *weights[2];        /* x, y, z */
} skinned;

/* How tori are skinned. */
typedef struct skin_plan {
    uint32_t bones; /* 0: targets alone */
    uint32_t each;  /* bones of a vertex, at most */
    uint32_t targets;
} skin_plan;

/* Weights of a vertex: bones along the torus' angle, blended where they meet, `each` at most.
 */
static inline void weigh(const mote_mesh *mesh, uint32_t vertex, uint32_t bones, uint32_t each,
                         uint16_t *bone, double *weight)
{
    const mote_vec3 x = mesh->positions[vertex];
    const double turn = (atan2(x.y, x.x) / 6.283185307179586 + 0.5) * bones;
    const uint32_t first = (uint32_t)turn;
    for (uint32_t k = 0; k < each; ++k) {
        bone[k] = (uint16_t)((first + k) % bones);
        const double d = 1 - fabs(turn - first - k + 0.3) / each;
        weight[k] = d > 0 ? d * d : 0;
    }
    weight[0] += 1e-3;
    if (vertex % 7 == 0) /* some vertices follow one bone only */
        for (uint32_t k = 1; k < each; ++k)
            weight[k] = 0;
}

/* The displacement of a vertex by target k: a bump on a part of the torus, all of it, or
   nothing. Every third is rough, the second undoes the first, and the last is tiny. */
static inline mote_vec3 target_move(const mote_mesh *mesh, const skin_plan *plan, uint32_t k,
                                    uint32_t vertex)
{
    if (k == 1)
        return mote_scale(target_move(mesh, plan, 0, vertex), -0.7);
    const mote_vec3 x = mesh->positions[vertex];
    const double bump = k % 4 == 2 ? 1 : cos(atan2(x.y, x.x) - 2.1 * k) + 0.4;
    const double size = k + 1 == plan->targets && k > 0 ? 1e-7 : 0.2;
    const double rough = k % 3 == 2 ? 2 : 0.1;
    if (k % 5 == 4 || bump <= 0)
        return mote_vec3_make(0, 0, 0);
    return mote_scale(mote_vec3_make(sin(3.0 * k + x.z), x.x * x.y, cos(2.0 * k)),
                      size * bump * (1 + rough * sin(1e3 * (x.x + x.y))));
}

static inline mote_status morphing(const mote_mesh *mesh, const skin_plan *plan,
                                   const uint32_t *start, const uint16_t *bone,
                                   const double *weight, mote_field **field)
{
    const uint32_t n = mesh->vertex_count;
    uint32_t *begin = malloc((plan->targets + 1) * sizeof *begin);
    uint32_t *vertex = malloc(plan->targets * n * sizeof *vertex);
    mote_vec3 *move = malloc(plan->targets * n * sizeof *move);
    need(begin && vertex && move);
    for (uint32_t k = 0; k < plan->targets; ++k) {
        begin[k] = k * n;
        for (uint32_t v = 0; v < n; ++v) {
            vertex[k * n + v] = n - 1 - v;
            move[k * n + v] = target_move(mesh, plan, k, n - 1 - v);
        }
    }
    begin[plan->targets] = plan->targets * n;
    const mote_morph_targets targets = {plan->targets, begin, vertex, move};
    const mote_status status = mote_field_create_morphs(
        mesh, plan->bones, plan->bones ? start : NULL, plan->bones ? bone : NULL,
        plan->bones ? weight : NULL, &targets, field);
    free(begin);
    free(vertex);
    free(move);
    return status;
}

static inline mote_field *skin_of_torus(const mote_mesh *mesh, const skin_plan *plan)
{
    const uint32_t n = mesh->vertex_count;
    const uint32_t each = plan->bones ? plan->each : 1;
    uint32_t *start = malloc((n + 1) * sizeof *start);
    uint16_t *bone = malloc(n * each * sizeof *bone);
    double *weight = malloc(n * each * sizeof *weight);
    need(start && bone && weight);
    for (uint32_t v = 0; v <= n; ++v)
        start[v] = v * each;
    for (uint32_t v = 0; v < n && plan->bones; ++v)
        weigh(mesh, v, plan->bones, each, bone + v * each, weight + v * each);
    mote_field *field = NULL;
    if (plan->targets > 0)
        need(morphing(mesh, plan, start, bone, weight, &field) == MOTE_OK);
    else
        need(mote_field_create_skin(mesh, plan->bones, start, bone, weight, &field) == MOTE_OK);
    free(start);
    free(bone);
    free(weight);
    return field;
}

static inline void skinned_init(skinned *k, uint32_t across, uint32_t around, skin_plan plan)
{
    scene_init(&k->s, across, around, 2.5, false);
    k->bones = plan.bones ? plan.bones : 1;
    k->targets = plan.targets;
    for (int b = 0; b < 2; ++b) {
        mote_deform_destroy(k->s.deform[b]);
        mote_field_destroy(k->s.field[b]);
        k->s.field[b] = skin_of_torus(k->s.mesh[b], &plan);
        k->s.body[b].field = k->s.field[b];
        need(mote_deform_create(&k->s.body[b], &k->s.deform[b]) == MOTE_OK);
        k->matrix[b] = calloc(k->bones, sizeof *k->matrix[b]);
        k->amounts[b] = calloc(k->targets + 1, sizeof *k->amounts[b]);
        k->weights[b] = calloc((size_t)3 * k->s.field[b]->padded, sizeof(double));
        need(k->matrix[b] && k->amounts[b] && k->weights[b]);
    }
}

static inline void skinned_free(skinned *k)
{
    for (int b = 0; b < 2; ++b) {
        free(k->matrix[b]);
        free(k->amounts[b]);
        free(k->weights[b]);
    }
    scene_free(&k->s);
}

/* Any affine matrix: near the identity, scaled, sheared, mirrored, singular, or all zero. */
static inline void random_bone(scene *s, double wild, double m[3][4])
{
    const int sort = (int)scene_random(s, 0, 8);
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c)
            m[r][c] = (r == c ? 1 : 0) + scene_random(s, -wild, wild);
        m[r][3] = scene_random(s, -0.3, 0.3) * wild * s->length;
    }
    for (int c = 0; c < 4 && wild > 0.1; ++c) {
        if (sort == 0)
            m[0][c] = -m[0][c]; /* mirrored */
        else if (sort == 1)
            m[2][c] = m[1][c] + m[0][c]; /* flat */
        else if (sort == 2)
            m[0][c] = m[1][c] = m[2][c] = 0; /* a point */
        else if (sort == 3)
            m[1][c] *= 3; /* stretched */
    }
}

/* The weights of a body, from its matrices and amounts. */
static inline mote_weights skinned_weights(skinned *k, int b, const mote_mat3 *rotation,
                                           double *w)
{
    const mote_field *field = k->s.field[b];
    const uint32_t padded = field->padded;
    mote_morph_weights(field, (const double(*)[3][4])k->matrix[b], k->amounts[b], rotation, w,
                       w + padded, w + 2 * padded);
    return (mote_weights){w, w + padded, w + 2 * padded, field->count, padded};
}

/* Some targets have amount 0, some more than 1, the last far more. Sometimes the two that undo
   each other are large, too. */
static inline void random_amounts(skinned *k, int b, double wild)
{
    for (uint32_t j = 0; j < k->targets; ++j) {
        k->amounts[b][j] = scene_random(&k->s, -0.5, 1.5) * (wild > 1 ? wild : 1);
        if (scene_random(&k->s, 0, 1) < 0.3)
            k->amounts[b][j] = 0;
        if (j + 1 == k->targets && j > 0)
            k->amounts[b][j] *= 1e6;
    }
    if (k->targets > 2 && scene_random(&k->s, 0, 1) < 0.25) {
        k->amounts[b][1] = scene_random(&k->s, 1e3, 1e5);
        k->amounts[b][0] = 0.7 * k->amounts[b][1];
    }
}

/* Deforms both bodies by their matrices and amounts. */
static inline void skinned_deform(skinned *k)
{
    for (int b = 0; b < 2; ++b) {
        mote_body_state *state = &k->s.frame.body[b];
        state->shape_changed = state->pose_changed = true;
        state->weights = skinned_weights(k, b, &state->pose.rotation, k->weights[b]);
        mote_deform_all(k->s.deform[b], state, k->s.world[b]);
    }
    ++k->s.frame.number;
}

/* Changes the last pose by a small step. */
static inline void step_pose(skinned *k, double size)
{
    scene *s = &k->s;
    for (int b = 0; b < 2; ++b) {
        mote_vec3 *t = &s->frame.body[b].pose.translation;
        t->x += scene_random(s, -size, size) * s->length;
        t->y += scene_random(s, -size, size) * s->length;
        for (uint32_t i = 0; i < k->bones; ++i) {
            for (int e = 0; e < 12; ++e)
                k->matrix[b][i][e / 4][e % 4] += scene_random(s, -size, size);
        }
        for (uint32_t j = 0; j < k->targets; ++j)
            k->amounts[b][j] *= 1 + scene_random(s, -size, size);
    }
    skinned_deform(k);
}

static inline void next_pose(skinned *k, double wild, double reach)
{
    scene *s = &k->s;
    for (int b = 0; b < 2; ++b) {
        mote_body_state *state = &s->frame.body[b];
        state->pose.rotation = random_rotation(s);
        state->pose.translation =
            mote_vec3_make(b * scene_random(s, 0.1, reach) * s->length,
                           scene_random(s, -0.2, 0.2), scene_random(s, -0.2, 0.2));
        for (uint32_t i = 0; i < k->bones; ++i)
            random_bone(s, wild, k->matrix[b][i]);
        random_amounts(k, b, wild);
    }
    skinned_deform(k);
}

/* How much larger than the sum the terms of a position are when targets undo each other. */
static inline double largest_term(const skinned *k)
{
    double most = 1;
    for (int b = 0; b < 2 && k->targets > 2; ++b)
        most = fmax(most, fabs(k->amounts[b][0]));
    return most;
}

static const double wildness[4] = {0.02, 0.3, 1, 3};

static inline mote_vec3 certificate_point(const mote_certificate *c, mote_vec3 world)
{
    return mote_scale(mote_sub(world, c->origin), c->scale);
}

static inline bool in_reach(const scene *s, const mote_certificate *c, int b,
                            const mote_cert_node *node, size_t l, uint32_t vertex)
{
    const mote_vec3 p = certificate_point(c, s->world[b][vertex]);
    return mote_dot(p, c->side[b].facing) <= (double)node->reach[l];
}

/* The node's ends along the coordinates' axes, where it has any. */
static inline bool in_ends(const scene *s, const mote_certificate *c, int b,
                           const mote_cert_node *node, size_t l, uint32_t vertex)
{
    const mote_vec3 p = certificate_point(c, s->world[b][vertex]);
    const double at[3] = {p.x, p.y, p.z};
    bool inside = true;
    for (size_t r = 0; node->spans && r < 3; ++r)
        inside =
            inside && at[r] >= (double)node->low[r][l] && at[r] <= (double)node->high[r][l];
    return inside;
}

/* Checks the box's extent along random directions. */
static inline bool in_box(scene *s, const mote_certificate *c, int b,
                          const mote_cert_node *node, size_t l, uint32_t vertex)
{
    const mote_vec3 p = certificate_point(c, s->world[b][vertex]);
    for (int i = 0; i < 3; ++i) {
        const mote_mat3 turn = random_rotation(s);
        const double *d = turn.m[0];
        double at = 0, half = 0;
        for (int r = 0; r < 3; ++r) {
            at += (double)node->centre[r][l] * d[r];
            half += (double)node->width[r][l] * fabs(d[r]);
        }
        for (int a = 0; a < 3; ++a) {
            double along = 0;
            for (int r = 0; r < 3; ++r)
                along += (double)node->axis[a][r][l] * d[r];
            half += fabs(along);
        }
        const double x = p.x * d[0] + p.y * d[1] + p.z * d[2];
        if (!(x >= at - half && x <= at + half))
            return false;
    }
    return true;
}

#endif
