/* Many deforming bodies of a few shapes in random places, for tests. */
#ifndef MOTE_TESTS_CROWD_H
#define MOTE_TESTS_CROWD_H

#include "core/certificate/scene.h"
#include "core/body/triangle.h"
#include "datasets/letter.h"

#include "tests/support/bodies.h"

#define CROWD_MAX 40
#define CROWD_SHAPES 3

typedef struct crowd {
    test_body shapes[CROWD_SHAPES]; /* a W with CSRBF, a T with modes, a rigid V */
    const mote_body *shape[CROWD_SHAPES];
    uint32_t shape_of[CROWD_MAX], count;
    double weights[CROWD_MAX][3][MOTE_FIELD_SUMMED];
    mote_body_state states[CROWD_MAX];
    uint64_t random;
} crowd;

/* Creates count bodies of `triangles` each, their middles within side / 2 of the origin. */
static inline void crowd_init(crowd *c, uint32_t count, size_t triangles, double side)
{
    static const char letters[] = "WTV";
    static const int functions[] = {9, -3, 0};
    memset(c, 0, sizeof *c);
    c->random = 11;
    c->count = count;
    for (int i = 0; i < CROWD_SHAPES; ++i) {
        mote_mesh *mesh = NULL;
        assert_int_equal(mote_letter_create(letters[i], triangles, &mesh), MOTE_OK);
        test_body_init(&c->shapes[i], mesh, functions[i], &c->random);
        c->shape[i] = &c->shapes[i].body;
    }
    for (uint32_t i = 0; i < count; ++i) {
        const uint32_t shape = c->shape_of[i] = i % CROWD_SHAPES;
        c->states[i] = test_body_state(&c->shapes[shape], 0.1, &c->random);
        c->states[i].pose.translation = random_vec3(&c->random, side / 2);
        memcpy(c->weights[i], c->shapes[shape].weights, sizeof c->weights[i]);
        c->states[i].weights.x = c->weights[i][0];
        c->states[i].weights.y = c->weights[i][1];
        c->states[i].weights.z = c->weights[i][2];
    }
}

static inline void crowd_free(crowd *c)
{
    for (int i = 0; i < CROWD_SHAPES; ++i)
        test_body_free(&c->shapes[i]);
}

/* Changes every pose and weight by at most `size`. */
static inline void crowd_move(crowd *c, double size)
{
    for (uint32_t i = 0; i < c->count; ++i) {
        mote_vec3 *t = &c->states[i].pose.translation;
        *t = mote_add(*t, random_vec3(&c->random, size));
        for (uint32_t j = 0; j < c->states[i].weights.count; ++j) {
            for (int k = 0; k < 3; ++k)
                c->weights[i][k][j] += random_between(&c->random, -size, size);
        }
    }
}

static inline mote_scene *crowd_scene(const crowd *c, const mote_scene_options *options)
{
    mote_scene *scene = NULL;
    if (mote_scene_create(c->shape, CROWD_SHAPES, c->shape_of, c->count, options, &scene) !=
        MOTE_OK)
        fail_msg("%s", mote_error_text());
    return scene;
}

/* A crowd made by crowd_init, in a scene with the usual options. */
static inline mote_scene *crowd_open(crowd *c, uint32_t count, size_t triangles, double side)
{
    const mote_scene_options options = mote_default_scene_options();
    crowd_init(c, count, triangles, side);
    return crowd_scene(c, &options);
}

static inline void crowd_close(crowd *c, mote_scene *scene)
{
    mote_scene_destroy(scene);
    crowd_free(c);
}

/* All pairs of bodies, ascending; returns how many. */
static inline size_t crowd_pairs(const crowd *c, uint32_t (*pairs)[2])
{
    size_t count = 0;
    for (uint32_t i = 0; i < c->count; ++i) {
        for (uint32_t j = i + 1; j < c->count; ++j) {
            pairs[count][0] = i;
            pairs[count++][1] = j;
        }
    }
    return count;
}

/* All world vertices of a body; the caller frees them. */
static inline mote_vec3 *crowd_vertices(const crowd *c, uint32_t i)
{
    const mote_body *body = c->shape[c->shape_of[i]];
    mote_vec3 *world = malloc(body->mesh->vertex_count * sizeof *world);
    assert_non_null(world);
    for (uint32_t v = 0; v < body->mesh->vertex_count; ++v)
        world[v] = mote_body_position(body, &c->states[i], v);
    return world;
}

/* The distance of two bodies by all pairs of triangles. */
static inline double crowd_distance(const crowd *c, uint32_t i, uint32_t j)
{
    const mote_mesh *a = c->shape[c->shape_of[i]]->mesh, *b = c->shape[c->shape_of[j]]->mesh;
    mote_vec3 *p = crowd_vertices(c, i), *q = crowd_vertices(c, j);
    double best = HUGE_VAL;
    for (uint32_t f = 0; f < a->triangle_count; ++f) {
        const uint32_t *s = a->triangles[f];
        const mote_vec3 first[3] = {p[s[0]], p[s[1]], p[s[2]]};
        for (uint32_t g = 0; g < b->triangle_count; ++g) {
            const uint32_t *t = b->triangles[g];
            const mote_vec3 second[3] = {q[t[0]], q[t[1]], q[t[2]]};
            mote_vec3 x, y;
            best = fmin(best, mote_triangle_triangle_below(first, second, best, &x, &y));
        }
    }
    free(p);
    free(q);
    return sqrt(best);
}

/* Checks an answer against all pairs of triangles, to an error. */
static inline void crowd_expect(const crowd *c, const mote_scene_pair *a, double tolerance,
                                double error)
{
    const double truth = crowd_distance(c, a->body[0], a->body[1]);
    assert_close(a->distance, truth, error);
    assert_true(a->lower <= truth && a->lower >= truth - error);
    assert_int_equal(a->contact, truth <= tolerance);
    assert_close(sqrt(mote_distance_squared(a->witness[0], a->witness[1])), truth, error);
}

#endif
