/* Two small bodies of any kind of field on random paths, for tests of the time of impact. */
#ifndef MOTE_TESTS_IMPACT_SCENE_H
#define MOTE_TESTS_IMPACT_SCENE_H

#include "core/base/random.h"
#include "core/body/triangle.h"
#include "core/impact/impact.h"
#include "core/skin/skin.h"
#include "core/stream/stream.h"
#include "tests/support/shapes.h"

enum { IMPACT_PIECES = 6, IMPACT_BONES = 5 };

typedef struct impact_body {
    mote_mesh *mesh;
    mote_field *field;
    mote_body body;
    mote_path path;
    mote_path_piece piece[IMPACT_PIECES];
    double *control[IMPACT_PIECES]; /* [4][3][padded] */
    double *weights;                /* of a state */
    mote_vec3 *world;
    mote_vec3 *frame[IMPACT_PIECES + 1]; /* of positions, else NULL */
    mote_positions positions[IMPACT_PIECES + 1];
} impact_body;

typedef struct impact_scene {
    impact_body of[2];
    double length;
    mote_random random;
    mote_impact_search *search;
} impact_scene;

typedef enum impact_kind {
    IMPACT_RIGID,
    IMPACT_CSRBF,
    IMPACT_MODES,
    IMPACT_SKIN,
    IMPACT_MORPHS,       /* targets alone */
    IMPACT_MORPHED_SKIN, /* targets, then bones */
    IMPACT_ARRAYS,
    IMPACT_KINDS
} impact_kind;

static inline double impact_between(mote_random *random, double low, double high)
{
    return low + (high - low) * mote_random_unit(random);
}

static inline mote_vec3 impact_vector(mote_random *random, double size)
{
    return mote_scale(mote_random_direction(random), impact_between(random, 0, size));
}

/* A box of 12 triangles, centred. */
static inline mote_mesh *impact_box(double x, double y, double z)
{
    static const uint32_t faces[12][3] = {{0, 1, 3}, {0, 3, 2}, {4, 6, 7}, {4, 7, 5},
                                          {0, 4, 5}, {0, 5, 1}, {2, 3, 7}, {2, 7, 6},
                                          {0, 2, 6}, {0, 6, 4}, {1, 5, 7}, {1, 7, 3}};
    double xyz[24];
    for (int i = 0; i < 8; ++i) {
        xyz[3 * i] = i & 1 ? x / 2 : -x / 2;
        xyz[3 * i + 1] = i & 2 ? y / 2 : -y / 2;
        xyz[3 * i + 2] = i & 4 ? z / 2 : -z / 2;
    }
    mote_mesh *mesh = NULL;
    need(mote_mesh_create(xyz, 8, &faces[0][0], 12, &mesh) == MOTE_OK);
    return mesh;
}

/* Targets that bend all of the mesh, swell a half of it, and pull one vertex out. */
static inline mote_field *impact_morphs(const mote_mesh *mesh, uint32_t bones,
                                        const uint32_t *bone_start, const uint16_t *bone,
                                        const double *weight)
{
    const uint32_t n = mesh->vertex_count;
    uint32_t *vertex = malloc(3 * n * sizeof *vertex);
    mote_vec3 *move = malloc(3 * n * sizeof *move);
    uint32_t start[4] = {0, n, n, n}, count = 0;
    mote_field *field = NULL;
    need(vertex && move);
    for (uint32_t v = 0; v < n; ++v) {
        const mote_vec3 x = mote_scale(mesh->positions[v], 1 / mesh->diagonal);
        vertex[count] = v;
        move[count++] = mote_vec3_make(0.1, x.x * x.x, sin(5 * x.x));
    }
    for (uint32_t v = 0; v < n; ++v) {
        if (!(mesh->positions[v].x > 0))
            continue;
        vertex[count] = v;
        move[count++] = mote_scale(mesh->positions[v], 1 / mesh->diagonal);
    }
    start[2] = count;
    vertex[count] = n / 2;
    move[count++] = mote_vec3_make(0, 2, 1);
    start[3] = count;
    const mote_morph_targets targets = {3, start, vertex, move};
    need(mote_field_create_morphs(mesh, bones, bone_start, bone, weight, &targets, &field) ==
         MOTE_OK);
    free(vertex);
    free(move);
    return field;
}

/* Bones one after the other along x; every vertex follows the two nearest. */
static inline mote_field *impact_skin(const mote_mesh *mesh, bool morphs)
{
    const uint32_t n = mesh->vertex_count;
    uint32_t *start = malloc((n + 1) * sizeof *start);
    uint16_t *bone = malloc(2 * n * sizeof *bone);
    double *weight = malloc(2 * n * sizeof *weight);
    mote_field *field = NULL;
    if (!start || !bone || !weight)
        abort();
    for (uint32_t v = 0; v < n; ++v) {
        const double along = (mesh->positions[v].x - mesh->low.x) /
                             (mesh->high.x - mesh->low.x) * (IMPACT_BONES - 1.001);
        start[v] = 2 * v;
        bone[2 * v] = (uint16_t)along;
        bone[2 * v + 1] = (uint16_t)(bone[2 * v] + 1);
        weight[2 * v + 1] = along - bone[2 * v];
        weight[2 * v] = 1 - weight[2 * v + 1];
    }
    start[n] = 2 * n;
    if (morphs)
        field = impact_morphs(mesh, IMPACT_BONES, start, bone, weight);
    else
        need(mote_field_create_skin(mesh, IMPACT_BONES, start, bone, weight, &field) ==
             MOTE_OK);
    free(start);
    free(bone);
    free(weight);
    return field;
}

static inline mote_field *impact_field(const mote_mesh *mesh, impact_kind kind,
                                       mote_random *random)
{
    mote_field *field = NULL;
    if (kind == IMPACT_CSRBF) {
        mote_vec3 centre[6];
        for (int j = 0; j < 6; ++j)
            centre[j] = mesh->positions[mote_random_below(random, mesh->vertex_count)];
        need(mote_field_create_csrbf(centre, 6, 0.5 * mesh->diagonal, &field) == MOTE_OK);
    } else if (kind == IMPACT_MODES) {
        mote_vec3 *modes = malloc(2 * mesh->vertex_count * sizeof *modes);
        need(modes);
        for (uint32_t v = 0; v < mesh->vertex_count; ++v) {
            const mote_vec3 x = mote_scale(mesh->positions[v], 1 / mesh->diagonal);
            modes[v] = mote_vec3_make(0, x.x * x.x, 0.3 * x.y);
            modes[mesh->vertex_count + v] = mote_vec3_make(x.z, 0, sin(9 * x.x));
        }
        need(mote_field_create_modes(modes, 2, mesh->vertex_count, &field) == MOTE_OK);
        free(modes);
    } else if (kind == IMPACT_SKIN) {
        field = impact_skin(mesh, false);
    } else if (kind == IMPACT_MORPHS) {
        field = impact_morphs(mesh, 0, NULL, NULL, NULL);
    } else if (kind == IMPACT_MORPHED_SKIN) {
        field = impact_skin(mesh, true);
    } else if (kind == IMPACT_ARRAYS) {
        need(mote_field_create_given(&field) == MOTE_OK);
    } else {
        need(mote_field_create_static(&field) == MOTE_OK);
    }
    return field;
}

/* Takes ownership of the mesh. The path stands still until it is set. */
static inline void impact_body_init(impact_body *b, mote_mesh *mesh, impact_kind kind,
                                    mote_random *random)
{
    *b = (impact_body){.mesh = mesh};
    b->field = impact_field(mesh, kind, random);
    b->body = (mote_body){.mesh = mesh, .field = b->field};
    const size_t padded = b->field->padded;
    b->weights = calloc(3 * padded + 1, sizeof(double));
    b->world = calloc(mesh->vertex_count, sizeof *b->world);
    need(b->weights && b->world);
    for (int k = 0; k < IMPACT_PIECES; ++k) {
        b->control[k] = calloc(12 * padded + 1, sizeof(double));
        need(b->control[k]);
        b->piece[k].turn[0] = b->piece[k].turn[1] = b->piece[k].turn[2] = b->piece[k].turn[3] =
            (mote_quaternion){1, 0, 0, 0};
        b->piece[k].weights = padded > 0 ? b->control[k] : NULL;
        const uint32_t numbers = b->field->numbers;
        for (size_t i = 0; i < 12 && numbers > 0; ++i) /* the body's axes */
            b->control[k][i * padded + b->field->count - numbers - 3 + i % 3] = 1;
    }
    b->path.pieces = b->piece;
    b->path.count = 1;
    if (kind != IMPACT_ARRAYS)
        return;
    for (int k = 0; k <= IMPACT_PIECES; ++k) {
        b->frame[k] = malloc(mesh->vertex_count * sizeof *b->frame[k]);
        need(b->frame[k]);
        memcpy(b->frame[k], mesh->positions, mesh->vertex_count * sizeof *b->frame[k]);
        b->positions[k] = mote_positions_of(b->frame[k]);
    }
    b->path.pieces = NULL;
    b->path.positions = b->positions;
}

static inline void impact_body_free(impact_body *b)
{
    for (int k = 0; k < IMPACT_PIECES; ++k)
        free(b->control[k]);
    for (int k = 0; k <= IMPACT_PIECES; ++k)
        free(b->frame[k]);
    free(b->weights);
    free(b->world);
    mote_field_destroy(b->field);
    mote_mesh_destroy(b->mesh);
}

/* Takes ownership of the meshes. patience: see mote_impact_options. */
static inline void impact_scene_init_kinds(impact_scene *s, mote_mesh *a, mote_mesh *b,
                                           const impact_kind kinds[2], uint64_t seed,
                                           uint32_t patience)
{
    *s = (impact_scene){.random = {seed}};
    s->length = fmax(a->diagonal, b->diagonal);
    impact_body_init(&s->of[0], a, kinds[0], &s->random);
    impact_body_init(&s->of[1], b, kinds[1], &s->random);
    const mote_body *const bodies[2] = {&s->of[0].body, &s->of[1].body};
    mote_impact_options options = mote_default_impact_options(s->length);
    options.patience = patience;
    need(mote_impact_create(bodies, &options, &s->search) == MOTE_OK);
}

static inline void impact_scene_init_patient(impact_scene *s, mote_mesh *a, mote_mesh *b,
                                             impact_kind kind, uint64_t seed, uint32_t patience)
{
    impact_scene_init_kinds(s, a, b, (const impact_kind[2]){kind, kind}, seed, patience);
}

static inline void impact_scene_init(impact_scene *s, mote_mesh *a, mote_mesh *b,
                                     impact_kind kind, uint64_t seed)
{
    impact_scene_init_patient(s, a, b, kind, seed, 10);
}

static inline void impact_scene_free(impact_scene *s)
{
    mote_impact_destroy(s->search);
    impact_body_free(&s->of[0]);
    impact_body_free(&s->of[1]);
}

/* A spin at constant speed after a rotation. */
static inline mote_quaternion impact_spun(mote_vec3 spin, mote_quaternion from)
{
    const double angle = mote_length(spin);
    if (!(angle > 0))
        return from;
    const double s = sin(angle / 2) / angle;
    const mote_quaternion q = {cos(angle / 2), s * spin.x, s * spin.y, s * spin.z};
    return mote_quaternion_normalise(mote_quaternion_multiply(q, from));
}

/* What a random path is like. */
typedef struct impact_wild {
    uint32_t pieces;
    mote_vec3 from, to; /* of the pivot */
    double stray;       /* of control points from the straight line */
    double turn;        /* radians in a piece */
    bool spins;
    double weights; /* size of the weights */
} impact_wild;

static inline void impact_piece_random(impact_body *b, uint32_t k, const impact_wild *w,
                                       mote_quaternion *turned, mote_random *random)
{
    mote_path_piece *p = &b->piece[k];
    const double n = w->pieces;
    mote_path_line(mote_add_scaled(w->from, k / n, mote_sub(w->to, w->from)),
                   mote_add_scaled(w->from, (k + 1) / n, mote_sub(w->to, w->from)), p->centre);
    for (int i = 1; i < 4; ++i)
        p->centre[i] = mote_add(p->centre[i], impact_vector(random, w->stray));
    p->turn[0] = *turned;
    p->spins = w->spins;
    if (w->spins) {
        p->spin = mote_scale(mote_random_direction(random), w->turn);
        *turned = impact_spun(p->spin, *turned);
    } else {
        for (int i = 1; i < 4; ++i)
            p->turn[i] = impact_spun(impact_vector(random, fmin(w->turn, 2)), p->turn[i - 1]);
        *turned = p->turn[3];
    }
    if (k > 0)
        p->centre[0] = b->piece[k - 1].centre[3];
    const size_t padded = b->field->padded;
    const uint32_t count = b->field->count, numbers = b->field->numbers;
    for (size_t i = 0; i < 4; ++i) {
        for (size_t c = 0; c < 3; ++c) {
            for (uint32_t j = 0; j < count; ++j) {
                if (numbers > 0 && j + numbers + 3 >= count && (c > 0 || j + numbers < count))
                    continue; /* axes, and numbers but in x */
                b->control[k][(3 * i + c) * padded + j] =
                    i == 0 && k > 0 ? b->control[k - 1][(9 + c) * padded + j]
                                    : impact_between(random, -w->weights, w->weights);
            }
        }
    }
}

/* Positions of a turned, moved and crumpled body in each frame. */
static inline void impact_frames_random(impact_body *b, const impact_wild *w,
                                        mote_quaternion turned, mote_random *random)
{
    for (uint32_t k = 0; k <= w->pieces; ++k) {
        const mote_mat3 rotation = mote_quaternion_matrix(turned);
        const mote_vec3 at =
            mote_add(mote_add_scaled(w->from, (double)k / w->pieces, mote_sub(w->to, w->from)),
                     impact_vector(random, w->stray));
        for (uint32_t v = 0; v < b->mesh->vertex_count; ++v) {
            const mote_vec3 arm = mote_sub(b->mesh->positions[v], b->path.pivot);
            b->frame[k][v] = mote_add(mote_add(at, mote_rotate(&rotation, arm)),
                                      impact_vector(random, w->weights));
        }
        turned = impact_spun(impact_vector(random, w->turn), turned);
    }
    for (uint32_t k = 1; k <= w->pieces && !(w->turn > 0); ++k) /* still: no other crumples */
        for (uint32_t v = 0; v < b->mesh->vertex_count && !(w->weights > 0); ++v)
            b->frame[k][v] = mote_add(
                b->frame[0][v], mote_scale(mote_sub(w->to, w->from), (double)k / w->pieces));
}

static inline void impact_path_random(impact_body *b, const impact_wild *w, mote_random *random)
{
    mote_quaternion turned =
        impact_spun(impact_vector(random, 3), (mote_quaternion){1, 0, 0, 0});
    b->path.count = w->pieces;
    if (b->path.positions) {
        impact_frames_random(b, w, turned, random);
        return;
    }
    for (uint32_t k = 0; k < w->pieces; ++k)
        impact_piece_random(b, k, w, &turned, random);
}

static inline mote_impact_question impact_question(const impact_scene *s, double tolerance)
{
    return (mote_impact_question){
        .path = {&s->of[0].path, &s->of[1].path}, .end = 1, .tolerance = tolerance};
}

/* The frame at a time. */
static inline void impact_frame(impact_scene *s, double time, mote_frame *frame)
{
    for (int i = 0; i < 2; ++i)
        mote_path_state(&s->of[i].path, &s->of[i].body, time, s->of[i].weights,
                        &frame->body[i]);
    ++frame->number;
}

/* All vertices of a body at a time. */
static inline void impact_place(impact_body *b, double time)
{
    if (b->path.positions) {
        const uint32_t count = b->path.count;
        const uint32_t k = time < 1 ? (uint32_t)(time * count) : count - 1;
        const double u = time * count - k;
        for (uint32_t v = 0; v < b->mesh->vertex_count; ++v)
            b->world[v] =
                mote_add(mote_scale(b->frame[k][v], 1 - u), mote_scale(b->frame[k + 1][v], u));
        return;
    }
    mote_body_state state;
    mote_path_state(&b->path, &b->body, time, b->weights, &state);
    for (uint32_t v = 0; v < b->mesh->vertex_count; ++v)
        b->world[v] = mote_body_position(&b->body, &state, v);
}

/* The distance at a time, by all pairs of triangles. */
static inline double impact_distance(impact_scene *s, double time)
{
    impact_place(&s->of[0], time);
    impact_place(&s->of[1], time);
    double best = HUGE_VAL;
    for (uint32_t a = 0; a < s->of[0].mesh->triangle_count; ++a) {
        for (uint32_t b = 0; b < s->of[1].mesh->triangle_count; ++b) {
            mote_vec3 corner[2][3];
            for (int k = 0; k < 3; ++k) {
                corner[0][k] = s->of[0].world[s->of[0].mesh->triangles[a][k]];
                corner[1][k] = s->of[1].world[s->of[1].mesh->triangles[b][k]];
            }
            best = fmin(best,
                        mote_triangle_triangle_below(corner[0], corner[1], best, NULL, NULL));
        }
    }
    return sqrt(best);
}

#endif
