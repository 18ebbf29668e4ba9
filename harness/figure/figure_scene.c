#include "harness/figure/figure_scene.h"

#include "core/body/deform.h"
#include "harness/base/memory.h"

#include <stdlib.h>
#include <string.h>

/* Candidate viewing directions: their number, and the largest sine of the angles by which they
   are too steep or look along the line between the bodies. */
#define DIRECTIONS 400
#define GOLDEN 2.399963229728653
#define STEEP 0.7
#define ACROSS 0.3

/* This many visible points count as much as a visible surface of area L * L / 2. */
#define AREA 4

/* A surface hides a point only if it is at least this far in front of it, in L: particles lie
   on surfaces. */
#define BEFORE 0.005

mote_status mote_figure_scene_open(const mote_summary_row *row, mote_figure_scene *scene)
{
    const char *name = row->scenario;
    uint64_t fingerprint;
    memset(scene, 0, sizeof *scene);
    mote_status status = mote_scenario_load(name, &scene->scenario);
    if (status == MOTE_OK)
        status = mote_scenario_fingerprint(scene->scenario, &fingerprint);
    if (status == MOTE_OK) {
        const mote_stored_cell *cell = row->first;
        const uint32_t last = cell->frames > 0 ? cell->frame[cell->frames - 1] : 0;
        if (!mote_stored_is_of(cell, fingerprint, mote_scenario_faces(scene->scenario)) ||
            last > scene->scenario->frames)
            status =
                mote_fail(MOTE_EINVAL, "%s: other frames or faces than those measured", name);
    }
    for (int i = 0; i < 2 && status == MOTE_OK; ++i) {
        if (mote_body_is_given(&scene->scenario->body[i]))
            status = mote_fail(MOTE_EUNSUPPORTED,
                               "%s: the figure shows control points, and of "
                               "body %d only positions are given",
                               name, i);
    }
    if (status == MOTE_OK)
        scene->buffer = mote_frame_buffer_create(scene->scenario);
    for (int i = 0; i < 2 && status == MOTE_OK; ++i) {
        const mote_body *body = &scene->scenario->body[i];
        scene->world[i] = mote_allocate(body->mesh->vertex_count, sizeof(mote_vec3));
        status = mote_deform_create(body, &scene->deform[i]);
    }
    return status;
}

void mote_figure_scene_close(mote_figure_scene *scene)
{
    for (int i = 0; i < 2; ++i) {
        mote_deform_destroy(scene->deform[i]);
        free(scene->world[i]);
    }
    mote_frame_buffer_destroy(scene->buffer);
    mote_scenario_destroy(scene->scenario);
}

void mote_figure_scene_show(mote_figure_scene *scene, uint32_t frame)
{
    scene->frame = mote_scenario_frame(scene->scenario, scene->buffer, frame, 0);
    for (int i = 0; i < 2; ++i)
        mote_deform_all(scene->deform[i], &scene->frame->body[i], scene->world[i]);
}

mote_vec3 mote_figure_see(const mote_figure_camera *camera, mote_vec3 point)
{
    const mote_vec3 p = mote_sub(point, camera->centre);
    return mote_scale(mote_vec3_make(mote_dot(p, camera->right), mote_dot(p, camera->up),
                                     mote_dot(p, camera->toward)),
                      camera->scale);
}

static const mote_mesh *mesh_of(const mote_figure_scene *scene, int i)
{
    return scene->scenario->body[i].mesh;
}

/* A triangle's corners in the picture; returns twice its area there, > 0 if it faces the
   camera. */
static double see_triangle(const mote_figure_scene *scene, const mote_figure_camera *camera,
                           int i, uint32_t triangle, mote_vec3 corner[3])
{
    for (int k = 0; k < 3; ++k)
        corner[k] =
            mote_figure_see(camera, scene->world[i][mesh_of(scene, i)->triangles[triangle][k]]);
    return (corner[1].x - corner[0].x) * (corner[2].y - corner[0].y) -
           (corner[1].y - corner[0].y) * (corner[2].x - corner[0].x);
}

/* How far the triangle is in front of p if it covers p; otherwise -infinity. */
static double covers(const mote_vec3 corner[3], double area, mote_vec3 p)
{
    double depth = 0;
    for (int k = 0; k < 3; ++k) {
        const mote_vec3 a = corner[(k + 1) % 3], b = corner[(k + 2) % 3];
        const double share = ((b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x)) / area;
        if (share < 0)
            return -HUGE_VAL;
        depth += share * corner[k].z;
    }
    return depth - p.z;
}

bool mote_figure_hidden(const mote_figure_scene *scene, const mote_figure_camera *camera,
                        mote_vec3 point)
{
    const mote_vec3 p = mote_figure_see(camera, point);
    const double before = BEFORE * scene->scenario->length * camera->scale;
    for (int i = 0; i < 2; ++i) {
        for (uint32_t t = 0; t < mesh_of(scene, i)->triangle_count; ++t) {
            mote_vec3 corner[3];
            const double area = see_triangle(scene, camera, i, t, corner);
            if (area > 0 && covers(corner, area, p) > before)
                return true;
        }
    }
    return false;
}

static double seen_area(const mote_figure_scene *scene, const mote_figure_camera *camera)
{
    double sum = 0;
    for (int i = 0; i < 2; ++i) {
        for (uint32_t t = 0; t < mesh_of(scene, i)->triangle_count; ++t) {
            mote_vec3 corner[3];
            const double area = see_triangle(scene, camera, i, t, corner);
            sum += area > 0 ? area : 0;
        }
    }
    return sum;
}

static mote_vec3 middle_of(const mote_figure_scene *scene, int i)
{
    mote_vec3 sum = {0, 0, 0};
    const uint32_t count = mesh_of(scene, i)->vertex_count;
    for (uint32_t v = 0; v < count; ++v)
        sum = mote_add(sum, scene->world[i][v]);
    return mote_scale(sum, 1.0 / count);
}

/* Direction number k of DIRECTIONS, spread evenly over the sphere (a spiral). */
static mote_vec3 direction(int k)
{
    const double y = 1 - (2 * k + 1.0) / DIRECTIONS, around = k * GOLDEN;
    const double radius = sqrt(1 - y * y);
    return mote_vec3_make(radius * cos(around), y, radius * sin(around));
}

/* A camera looking along a direction, with the world's y up. */
static mote_figure_camera look_from(mote_vec3 toward)
{
    mote_figure_camera camera = {.toward = toward, .scale = 1};
    const mote_vec3 right = mote_cross(mote_vec3_make(0, 1, 0), toward);
    camera.right = mote_scale(right, 1 / mote_length(right));
    camera.up = mote_cross(toward, camera.right);
    return camera;
}

mote_figure_camera mote_figure_camera_aim(const mote_figure_scene *scene,
                                          const mote_vec3 *points, size_t count)
{
    const mote_vec3 line = mote_sub(middle_of(scene, 1), middle_of(scene, 0));
    const double square = scene->scenario->length * scene->scenario->length;
    mote_figure_camera best = look_from(mote_vec3_make(0, 0, 1));
    double best_seen = -1;
    for (int k = 0; k < DIRECTIONS; ++k) {
        const mote_vec3 toward = direction(k);
        if (fabs(toward.y) > STEEP || fabs(mote_dot(toward, line)) > ACROSS * mote_length(line))
            continue;
        const mote_figure_camera camera = look_from(toward);
        if (mote_dot(camera.right, line) < 0)
            continue; /* the second body must be on the right */
        double seen = AREA * seen_area(scene, &camera) / square;
        for (size_t i = 0; i < count; ++i)
            seen += mote_figure_hidden(scene, &camera, points[i]) ? 0 : 1;
        if (seen > best_seen) {
            best_seen = seen;
            best = camera;
        }
    }
    return best;
}

void mote_figure_box_add(const mote_figure_scene *scene, const mote_figure_camera *camera,
                         mote_figure_box *box)
{
    for (int i = 0; i < 2; ++i) {
        for (uint32_t v = 0; v < mesh_of(scene, i)->vertex_count; ++v) {
            const mote_vec3 p = mote_figure_see(camera, scene->world[i][v]);
            box->low[0] = fmin(box->low[0], p.x);
            box->low[1] = fmin(box->low[1], p.y);
            box->high[0] = fmax(box->high[0], p.x);
            box->high[1] = fmax(box->high[1], p.y);
        }
    }
}

void mote_figure_camera_fit(mote_figure_camera *camera, const mote_figure_box *box,
                            double aspect)
{
    const double x = (box->low[0] + box->high[0]) / 2, y = (box->low[1] + box->high[1]) / 2;
    camera->centre = mote_add_scaled(camera->centre, x / camera->scale, camera->right);
    camera->centre = mote_add_scaled(camera->centre, y / camera->scale, camera->up);
    camera->scale *=
        fmin(2 / (box->high[0] - box->low[0]), 2 * aspect / (box->high[1] - box->low[1]));
}

static void add_corner(mote_vec3 p, mote_text *text)
{
    mote_text_add(text, "%.4f %.4f %.4f\n", p.x, p.y, p.z);
}

void mote_figure_add_body(const mote_figure_scene *scene, const mote_figure_camera *camera,
                          int i, mote_text *text)
{
    if (text->size)
        mote_text_add(text, "\n\n");
    for (uint32_t t = 0; t < mesh_of(scene, i)->triangle_count; ++t) {
        mote_vec3 corner[3];
        if (!(see_triangle(scene, camera, i, t, corner) > 0))
            continue;
        for (int k = 0; k < 4; ++k)
            add_corner(corner[k % 3], text);
        mote_text_add(text, "\n");
    }
}

void mote_figure_add_controls(const mote_figure_scene *scene, const mote_figure_camera *camera,
                              int i, mote_text *text)
{
    const mote_field *field = scene->scenario->body[i].field;
    const mote_body_state *state = &scene->frame->body[i];
    mote_vec3 *centre = mote_allocate((size_t)field->count + 1, sizeof *centre);
    /* The centres as a mesh of points, which is all that a CSRBF's displacement needs. */
    const mote_mesh points = {.vertex_count = field->count, .positions = centre};
    mote_figure_camera direction = *camera;
    direction.centre = mote_vec3_make(0, 0, 0);
    direction.scale *= MOTE_FIGURE_LONGER;
    if (text->size)
        mote_text_add(text, "\n\n");
    for (uint32_t j = 0; j < field->count && field->centre_x; ++j) {
        centre[j] = mote_vec3_make(field->centre_x[j], field->centre_y[j], field->centre_z[j]);
        const mote_vec3 rest =
            mote_figure_see(camera, mote_pose_apply(&state->pose, centre[j]));
        const mote_vec3 moved = mote_figure_see(
            &direction, mote_field_displacement(field, &points, j, &state->weights));
        mote_text_add(text, "%.4f %.4f %.4f %.4f %.4f %.4f\n", rest.x, rest.y, rest.z, moved.x,
                      moved.y, moved.z);
    }
    free(centre);
}
