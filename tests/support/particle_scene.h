/* Two bodies in random frames, the work of their particles, and the true distance, for
   tests. */
#ifndef MOTE_TESTS_PARTICLE_SCENE_H
#define MOTE_TESTS_PARTICLE_SCENE_H

#include "core/particle/particles.h"
#include "core/body/triangle.h"

#include "tests/support/bodies.h"

typedef struct particle_scene {
    test_body b[2];
    const mote_body *bodies[2];
    double length;
    double unit; /* every length of a frame is multiplied by this */
    uint64_t seed;
    mote_frame frame;
} particle_scene;

/* Takes ownership of both solids, scaled by unit; field: as in test_body_init. */
static inline void scene_open(particle_scene *s, solid first, solid second, int field,
                              double unit)
{
    memset(s, 0, sizeof *s);
    s->seed = 5;
    s->unit = unit;
    solid both[2] = {first, second};
    for (int k = 0; k < 2; ++k) {
        for (size_t i = 0; i < 3 * both[k].vertex_count; ++i)
            both[k].xyz[i] *= unit;
        mote_mesh *mesh = solid_to_mesh(both[k]);
        test_body_init(&s->b[k], mesh, field, &s->seed);
        s->bodies[k] = &s->b[k].body;
    }
    s->length = fmax(s->b[0].mesh->diagonal, s->b[1].mesh->diagonal);
}

static inline void scene_close(particle_scene *s)
{
    test_body_free(&s->b[0]);
    test_body_free(&s->b[1]);
}

/* A new frame: weights up to 0.2, body 1 gap away in x. */
static inline void scene_next(particle_scene *s, double gap)
{
    ++s->frame.number;
    for (int k = 0; k < 2; ++k)
        s->frame.body[k] = test_body_state(&s->b[k], 0.2 * s->unit, &s->seed);
    s->frame.body[1].pose.translation.x += gap * s->unit;
}

static inline mote_particles *scene_particles(const particle_scene *s,
                                              const mote_particles_options *options)
{
    mote_particles *particles = NULL;
    if (mote_particles_create(s->bodies, s->length, options, &particles) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    return particles;
}

static inline mote_vec3 scene_vertex(const particle_scene *s, int body, uint32_t vertex)
{
    return mote_body_position(&s->b[body].body, &s->frame.body[body], vertex);
}

/* The distance of the two surfaces by all pairs of triangles. */
static inline double scene_truth(const particle_scene *s)
{
    double least = HUGE_VAL;
    for (uint32_t f = 0; f < s->b[0].mesh->triangle_count; ++f) {
        mote_vec3 p[3];
        for (int k = 0; k < 3; ++k)
            p[k] = scene_vertex(s, 0, s->b[0].mesh->triangles[f][k]);
        for (uint32_t g = 0; g < s->b[1].mesh->triangle_count; ++g) {
            mote_vec3 q[3];
            for (int k = 0; k < 3; ++k)
                q[k] = scene_vertex(s, 1, s->b[1].mesh->triangles[g][k]);
            least = fmin(least, mote_triangle_triangle(p, q, NULL, NULL));
        }
    }
    return sqrt(least);
}

static inline double scene_query(const particle_scene *s, mote_particles *particles,
                                 mote_counters *counters)
{
    uint32_t pair[2];
    mote_particles_begin(particles, &s->frame, false);
    mote_particles_relax(particles, -1, counters);
    return sqrt(mote_particles_closest(particles, pair));
}

#endif
