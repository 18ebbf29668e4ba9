/* Small deforming scenes from formulas, with the distance by brute force, for tests. */
#ifndef MOTE_TESTS_SHAPES_H
#define MOTE_TESTS_SHAPES_H

#include "core/body/deform.h"
#include "core/method/method.h"
#include "core/body/triangle.h"

#include <stdlib.h>
#include <string.h>

typedef struct scene {
    mote_mesh *mesh[2];
    mote_field *field[2];
    mote_deform *deform[2];
    mote_body body[2];
    double weights[2][3][MOTE_FIELD_SUMMED];
    mote_vec3 *world[2];
    mote_frame frame;
    double length;
    uint64_t random;
} scene;

/* Ends the test if a scene cannot be made. */
static inline void need(bool condition)
{
    if (!condition)
        abort();
}

/* A number in [low, high), from a fixed sequence. */
static inline double scene_random(scene *s, double low, double high)
{
    s->random = s->random * 6364136223846793005u + 1442695040888963407u;
    return low + (high - low) * (double)(s->random >> 11) * 0x1p-53;
}

/* A torus with a bumpy tube, of 2 * across * around triangles, L about 3.2 * size. */
static inline mote_mesh *make_torus(uint32_t across, uint32_t around, double size)
{
    uint32_t vertices = across * around;
    double *xyz = malloc(3 * vertices * sizeof *xyz);
    uint32_t(*faces)[3] = malloc(2 * vertices * sizeof *faces);
    need(xyz && faces);
    for (uint32_t i = 0; i < across; ++i) {
        for (uint32_t j = 0; j < around; ++j) {
            double u = 6.283185307179586 * i / across, v = 6.283185307179586 * j / around;
            double tube = 0.3 + 0.06 * cos(3 * u) * sin(2 * v);
            double *p = xyz + 3 * (i * around + j);
            p[0] = size * (1 + tube * cos(v)) * cos(u);
            p[1] = size * (1 + tube * cos(v)) * sin(u);
            p[2] = size * tube * sin(v);
            uint32_t a = i * around + j, b = (i + 1) % across * around + j;
            uint32_t c = i * around + (j + 1) % around;
            uint32_t d = (i + 1) % across * around + (j + 1) % around;
            uint32_t two[2][3] = {{a, b, d}, {a, d, c}};
            memcpy(faces[2 * a], two, sizeof two);
        }
    }
    mote_mesh *mesh = NULL;
    need(mote_mesh_create(xyz, vertices, &faces[0][0], 2 * vertices, &mesh) == MOTE_OK);
    free(xyz);
    free(faces);
    return mesh;
}

/* Makes a scene of two bodies and takes ownership of their meshes; deforming ones have six
   centres. */
static inline void scene_init_meshes(scene *s, mote_mesh *first, mote_mesh *second,
                                     bool deforming)
{
    *s = (scene){.mesh = {first, second}, .random = 7};
    s->length = fmax(first->diagonal, second->diagonal);
    double size = s->length / 3.2;
    for (int b = 0; b < 2; ++b) {
        mote_vec3 centre[6];
        for (int j = 0; j < 6; ++j)
            centre[j] = mote_vec3_make(size * cos(1.0 * j), size * sin(1.0 * j),
                                       size * (j % 2 ? 0.3 : -0.3));
        mote_status status = deforming
                                 ? mote_field_create_csrbf(centre, 6, 0.9 * size, &s->field[b])
                                 : mote_field_create_static(&s->field[b]);
        need(status == MOTE_OK);
        s->body[b] = (mote_body){.mesh = s->mesh[b], .field = s->field[b]};
        need(mote_deform_create(&s->body[b], &s->deform[b]) == MOTE_OK);
        s->world[b] = malloc(s->mesh[b]->vertex_count * sizeof *s->world[b]);
        need(s->world[b]);
    }
}

/* Two tori of about 2 * across * around triangles. */
static inline void scene_init(scene *s, uint32_t across, uint32_t around, double size,
                              bool deforming)
{
    scene_init_meshes(s, make_torus(across, around, size), make_torus(across + 1, around, size),
                      deforming);
}

static inline void scene_free(scene *s)
{
    for (int b = 0; b < 2; ++b) {
        free(s->world[b]);
        mote_deform_destroy(s->deform[b]);
        mote_field_destroy(s->field[b]);
        mote_mesh_destroy(s->mesh[b]);
    }
}

static inline mote_mat3 random_rotation(scene *s)
{
    double q[4], norm = 0;
    for (int k = 0; k < 4; ++k) {
        q[k] = scene_random(s, -1, 1);
        norm += q[k] * q[k];
    }
    norm = sqrt(norm);
    double w = q[0] / norm, x = q[1] / norm, y = q[2] / norm, z = q[3] / norm;
    return (mote_mat3){{{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
                        {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
                        {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}}};
}

/* A new frame: random rotations, body 1 up to reach * L away in x, random weights. With
   pose_only the weights stay as they are. */
static inline const mote_frame *scene_next(scene *s, double reach, bool pose_only)
{
    ++s->frame.number;
    for (int b = 0; b < 2; ++b) {
        mote_body_state *state = &s->frame.body[b];
        if (!pose_only || s->frame.number % 2)
            state->pose.rotation = random_rotation(s);
        state->pose.translation =
            mote_vec3_make(b * scene_random(s, 0, reach) * s->length,
                           scene_random(s, -0.1, 0.1) * s->length, 0.3 * s->length);
        state->pose_changed = true;
        state->shape_changed = s->frame.number == 1 || (!pose_only && s->field[b]->count > 0);
        for (uint32_t j = 0; j < s->field[b]->count && state->shape_changed; ++j) {
            for (int k = 0; k < 3; ++k)
                s->weights[b][k][j] = scene_random(s, -0.1, 0.1) * s->length;
        }
        state->weights = (mote_weights){s->weights[b][0], s->weights[b][1], s->weights[b][2],
                                        s->field[b]->count, s->field[b]->padded};
        mote_deform_all(s->deform[b], state, s->world[b]);
        state->vertices = s->world[b];
    }
    return &s->frame;
}

/* Moves both bodies by a small step from the frame before. */
static inline void scene_step(scene *s)
{
    for (int b = 0; b < 2; ++b) {
        mote_body_state *state = &s->frame.body[b];
        const double size = 0.01 * s->length;
        state->pose.translation =
            mote_add(state->pose.translation,
                     mote_vec3_make(scene_random(s, -size, size), scene_random(s, -size, size),
                                    scene_random(s, -size, size)));
        for (uint32_t j = 0; j < s->field[b]->count; ++j) {
            for (int k = 0; k < 3; ++k)
                s->weights[b][k][j] += scene_random(s, -0.2, 0.2) * size;
        }
        mote_deform_all(s->deform[b], state, s->world[b]);
    }
    ++s->frame.number;
}

/* The distance of the frame by all pairs of triangles. */
static inline double scene_distance(const scene *s)
{
    double best = HUGE_VAL;
    for (uint32_t i = 0; i < s->mesh[0]->triangle_count; ++i) {
        for (uint32_t j = 0; j < s->mesh[1]->triangle_count; ++j) {
            mote_vec3 corner[2][3];
            for (int k = 0; k < 3; ++k) {
                corner[0][k] = s->world[0][s->mesh[0]->triangles[i][k]];
                corner[1][k] = s->world[1][s->mesh[1]->triangles[j][k]];
            }
            double d = mote_triangle_triangle_below(corner[0], corner[1], best, NULL, NULL);
            if (d < best)
                best = d;
        }
    }
    return sqrt(best);
}

/* Distance of a point from the surface of body b in the frame. */
static inline double scene_point_distance(const scene *s, int b, mote_vec3 p)
{
    double best = HUGE_VAL;
    for (uint32_t i = 0; i < s->mesh[b]->triangle_count; ++i) {
        mote_vec3 corner[3];
        for (int k = 0; k < 3; ++k)
            corner[k] = s->world[b][s->mesh[b]->triangles[i][k]];
        double d = mote_point_triangle(p, corner, NULL);
        if (d < best)
            best = d;
    }
    return sqrt(best);
}

/* The setup of a method for the scene; values must live as long as it. */
static inline mote_setup scene_setup(const scene *s, mote_ask ask, double tolerance,
                                     const double *values)
{
    return (mote_setup){.body = {&s->body[0], &s->body[1]},
                        .length = s->length,
                        .ask = ask,
                        .tolerance = tolerance,
                        .seed = 1,
                        .values = values};
}

#endif
