/* Figures of the bodies: particles on two letters T (1), M against V deforming (2), and its
   animation. */
#include "harness/base/number_text.h"
#include "harness/figure/figure.h"

#include "harness/figure/figure_scene.h"
#include "harness/base/hash.h"
#include "harness/figure/particle_places.h"
#include "harness/base/record.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Height over width of the pictures; these match plots/fig1.gp and plots/fig2.gp. */
#define PARTICLES_ASPECT 0.62
#define DEFORMED_ASPECT 0.72

/* Figure 1 shows the first frame in which the bodies are this near, in L. */
#define NEAR 0.03

/* The animation has every fifth frame of its scenario. */
#define ANIMATION_STEP 5u

/* The first frame from `from` on whose truth is at most `near` times L, or fallback. */
static uint32_t first_near(const mote_stored_cell *cell, uint32_t from, double near,
                           uint32_t fallback)
{
    for (size_t k = 0; k < cell->frames; ++k) {
        if (cell->frame[k] >= from && cell->truth[k] <= near)
            return cell->frame[k];
    }
    return fallback;
}

/* The exact distance at a frame divided by L, or MOTE_NONE if it was not measured. */
static double truth_at(const mote_summary_row *row, uint32_t frame)
{
    for (size_t k = 0; k < row->first->frames; ++k) {
        if (row->first->frame[k] == frame)
            return row->first->truth[k] / mote_figure_length(row);
    }
    return MOTE_NONE;
}

/* Finds the particles of a row's first process at a frame. points: those of body 0, then of
   body 1; *count on each, or 0 with a reason in missing. */
static mote_status find_particles(const mote_summary_row *row, const mote_figure_scene *scene,
                                  uint32_t frame, mote_vec3 points[2][MOTE_PARTICLE_PLACES_MAX],
                                  size_t *count, mote_text *missing)
{
    mote_particle_places places;
    size_t rows = 0;
    *count = 0;
    while (rows < row->first->frames && row->first->frame[rows] <= frame)
        ++rows;
    const mote_status status =
        mote_particle_places_find(scene->scenario, row->label, row->first, rows, &places);
    if (status == MOTE_OK && places.count == 0)
        mote_text_add(missing, "particles of %s: %s", row->label, places.why);
    *count = places.count;
    for (size_t i = 0; i < 2 && places.count > 0; ++i)
        memcpy(points[i], places.at + (2 * (rows - 1) + i) * places.count,
               places.count * sizeof *places.at);
    free(places.at);
    return status;
}

/* Adds blocks: body A, body B, their particles (x y z, 1 if hidden) by body, the closest
   pair. */
static void add_particles(const mote_figure_scene *scene,
                          mote_vec3 points[2][MOTE_PARTICLE_PLACES_MAX], size_t count,
                          mote_text *text)
{
    mote_vec3 all[2 * MOTE_PARTICLE_PLACES_MAX];
    memcpy(all, points[0], count * sizeof *all);
    memcpy(all + count, points[1], count * sizeof *all);
    mote_figure_camera camera = mote_figure_camera_aim(scene, all, 2 * count);
    mote_figure_box box = {{HUGE_VAL, HUGE_VAL}, {-HUGE_VAL, -HUGE_VAL}};
    mote_figure_box_add(scene, &camera, &box);
    mote_figure_camera_fit(&camera, &box, PARTICLES_ASPECT);
    mote_vec3 closest[2] = {points[0][0], points[1][0]};
    for (int i = 0; i < 2; ++i)
        mote_figure_add_body(scene, &camera, i, text);
    for (int i = 0; i < 2; ++i) {
        mote_text_add(text, "\n\n");
        for (size_t k = 0; k < count; ++k) {
            const mote_vec3 p = mote_figure_see(&camera, points[i][k]);
            mote_text_add(text, "%.4f %.4f %.4f %d\n", p.x, p.y, p.z,
                          mote_figure_hidden(scene, &camera, points[i][k]));
            for (size_t j = 0; j < count; ++j) {
                if (mote_distance_squared(points[0][k], points[1][j]) <
                    mote_distance_squared(closest[0], closest[1])) {
                    closest[0] = points[0][k];
                    closest[1] = points[1][j];
                }
            }
        }
    }
    mote_text_add(text, "\n\n");
    for (int i = 0; i < 2; ++i) {
        const mote_vec3 p = mote_figure_see(&camera, closest[i]);
        mote_text_add(text, "%.4f %.4f %.4f\n", p.x, p.y, p.z);
    }
}

mote_status mote_figure_particles(const mote_figure_run *run, const char *scenario,
                                  mote_figure *figure)
{
    const mote_summary_row *row =
        mote_figure_row(run->summary, scenario, "particle-paper:n=3,refine=no");
    if (!row)
        row = mote_figure_row(run->summary, scenario, "particle-paper:n=3");
    if (!row) {
        mote_text_add(&figure->missing, "particle-paper:n=3 on %s", scenario);
        return MOTE_OK;
    }
    const uint32_t frame =
        first_near(row->first, 1, NEAR * mote_figure_length(row), row->first->frame[0]);
    mote_figure_scene scene;
    mote_vec3 points[2][MOTE_PARTICLE_PLACES_MAX];
    size_t count = 0;
    mote_status status = mote_figure_scene_open(row, &scene);
    if (status == MOTE_OK)
        status = find_particles(row, &scene, frame, points, &count, &figure->missing);
    if (status == MOTE_OK && count > 0) {
        mote_figure_scene_show(&scene, frame);
        add_particles(&scene, points, count, &figure->data);
        char number[MOTE_NUMBER_TEXT];
        mote_text_add(&figure->caption,
                      "The paper's Figure 1: two letters T of %s triangles with 3 particles on "
                      "each, red on the first and blue on the second, hollow where a surface "
                      "hides them; frame %u of %s, exact distance %.3f L. The line joins the "
                      "closest pair of particles.",
                      mote_show_whole(scene.scenario->body[0].mesh->triangle_count, number),
                      frame, scenario, truth_at(row, frame));
    }
    mote_figure_scene_close(&scene);
    return status;
}

/* Any shown row of the scenario, for its truth. */
static const mote_summary_row *any_row(const mote_summary *summary, const char *scenario)
{
    const mote_summary_row *best = NULL;
    for (size_t i = 0; i < summary->count; ++i) {
        const mote_summary_row *row = &summary->rows[i];
        if (mote_figure_shows(summary, row, scenario) && row->first->frames > 0 &&
            (!best || row->first->frames > best->first->frames))
            best = row;
    }
    return best;
}

/* A camera with all pictures of the animation in its view. */
static mote_figure_camera whole_camera(mote_figure_scene *scene)
{
    mote_figure_scene_show(scene, 1);
    mote_figure_camera camera = mote_figure_camera_aim(scene, NULL, 0);
    mote_figure_box box = {{HUGE_VAL, HUGE_VAL}, {-HUGE_VAL, -HUGE_VAL}};
    for (uint32_t k = 1; k <= scene->scenario->frames; k += ANIMATION_STEP) {
        mote_figure_scene_show(scene, k);
        mote_figure_box_add(scene, &camera, &box);
    }
    mote_figure_camera_fit(&camera, &box, DEFORMED_ASPECT);
    return camera;
}

/* Adds four blocks: body A, body B, their control vectors. */
static void add_frame(mote_figure_scene *scene, const mote_figure_camera *camera,
                      uint32_t frame, mote_text *text)
{
    mote_figure_scene_show(scene, frame);
    for (int i = 0; i < 2; ++i)
        mote_figure_add_body(scene, camera, i, text);
    for (int i = 0; i < 2; ++i)
        mote_figure_add_controls(scene, camera, i, text);
}

/* "frame 229: contact", "frame 1: 0.482 L" */
static void frame_text(const mote_summary_row *row, uint32_t frame, char *text, size_t size)
{
    const double truth = truth_at(row, frame);
    if (truth != truth)
        (void)snprintf(text, size, "frame %u", frame);
    else if (truth > 0)
        (void)snprintf(text, size, "frame %u: %.3f L", frame, truth);
    else
        (void)snprintf(text, size, "frame %u: contact", frame);
}

mote_status mote_figure_deformed(const mote_figure_run *run, const char *scenario,
                                 mote_figure *figure)
{
    const mote_summary_row *row = any_row(run->summary, scenario);
    if (!row) {
        mote_text_add(&figure->missing, "a method that ran on %s", scenario);
        return MOTE_OK;
    }
    mote_figure_scene scene;
    mote_status status = mote_figure_scene_open(row, &scene);
    if (status == MOTE_OK) {
        const mote_figure_camera camera = whole_camera(&scene);
        const uint32_t last = scene.scenario->frames;
        const uint32_t contact =
            first_near(row->first, scene.scenario->active.first, 0, last / 2 + 1);
        const uint32_t frames[4] = {1, (1 + contact) / 2, contact, last};
        const mote_body *const body = scene.scenario->body;
        char triangles[2][MOTE_NUMBER_TEXT];
        for (int k = 0; k < 4; ++k)
            add_frame(&scene, &camera, frames[k], &figure->data);
        mote_text_add(&figure->data, "\n\n");
        for (int k = 0; k < 4; ++k) {
            char label[64];
            frame_text(row, frames[k], label, sizeof label);
            mote_gnuplot_quote(&figure->data, label);
            mote_text_add(&figure->data, "\n");
        }
        mote_text_add(
            &figure->caption,
            "The paper's Figure 2: four frames of %s, a letter M of %s triangles whose CSRBF "
            "deformation is defined by %u control vectors, and a letter V of %s triangles with "
            "%u. Arrows show the control vectors at three times their length, from the "
            "control points at rest. The exact distance stands below each frame.",
            scenario, mote_show_whole(body[0].mesh->triangle_count, triangles[0]),
            body[0].field->count, mote_show_whole(body[1].mesh->triangle_count, triangles[1]),
            body[1].field->count);
    }
    mote_figure_scene_close(&scene);
    return status;
}

mote_status mote_figure_frames_begin(const mote_figure_run *run)
{
    char *folder = mote_format("%s/figures/frames", run->directory);
    const mote_status status = mote_directory_make(folder);
    free(folder);
    return status;
}

mote_status mote_figure_frame_write(const mote_figure_run *run, unsigned number,
                                    mote_text *text, uint64_t *hash)
{
    char name[64];
    (void)snprintf(name, sizeof name, "figures/frames/%03u.dat", number);
    *hash = mote_hash_bytes(MOTE_HASH_START, text->data, text->size);
    return mote_record_text(run->directory, name, text);
}

mote_status mote_figure_animation(const mote_figure_run *run, const char *scenario,
                                  mote_figure *figure)
{
    const mote_summary_row *row = any_row(run->summary, scenario);
    if (!row) {
        mote_text_add(&figure->missing, "a method that ran on %s", scenario);
        return MOTE_OK;
    }
    mote_figure_scene scene = {0};
    mote_status status = mote_figure_frames_begin(run);
    if (status == MOTE_OK)
        status = mote_figure_scene_open(row, &scene);
    if (status == MOTE_OK) {
        const mote_figure_camera camera = whole_camera(&scene);
        unsigned number = 0;
        for (uint32_t k = 1; k <= scene.scenario->frames && status == MOTE_OK;
             k += ANIMATION_STEP) {
            char label[64];
            mote_text text = {0};
            uint64_t hash;
            frame_text(row, k, label, sizeof label);
            add_frame(&scene, &camera, k, &text);
            mote_text_add(&text, "\n\n");
            mote_gnuplot_quote(&text, label);
            mote_text_add(&text, "\n");
            status = mote_figure_frame_write(run, number, &text, &hash);
            mote_text_add(&figure->data, "%u %016" PRIx64 "\n", number++, hash);
        }
        mote_text_add(&figure->caption,
                      "The whole of %s, every %uth of its %u frames, seen as in Figure 2.",
                      scenario, ANIMATION_STEP, scene.scenario->frames);
    }
    mote_figure_scene_close(&scene);
    return status;
}

void mote_figure_animation_clear(const char *directory)
{
    char *folder = mote_format("%s/figures/frames", directory);
    bool there = true;
    for (unsigned number = 0; there; ++number) {
        char *name = mote_format("%s/%03u.dat", folder, number);
        there = unlink(name) == 0;
        free(name);
    }
    (void)rmdir(folder);
    free(folder);
}
