/* Several bodies: time of a frame over their number (15), and letters in a box, moving. */
#include "harness/figure/figure.h"

#include "core/body/deform.h"
#include "harness/run/bodies_engine.h"
#include "harness/base/hash.h"
#include "harness/base/record.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Panels and lines of plots/bodies.gp, which relies on their number and order. */
static const double densities[] = {0.1, 1, 4};
static const char *const methods[] = {"certified",    "fcl-aabb:refit=every",
                                      "fcl-aabb",     "aabb-tree",
                                      "particle:n=8", "particle-paper:n=5"};
static const char *const titles[] = {"certified",    "FCL, every body",
                                     "FCL, near",    "aabb-tree, near",
                                     "particle n=8", "particle-paper n=5"};

static bool has_scenes(const json_t *root)
{
    size_t i;
    const json_t *row;
    MOTE_EACH(i, row, json_object_get(root, "rows"))
    {
        if (json_object_get(row, "bodies"))
            return true;
    }
    return false;
}

/* Reads summary.json of the run where it has more than two bodies, else of ../bodies; false,
   with a text in missing, where there is none. */
static bool read_rows(const mote_figure_run *run, mote_figure *figure, json_t **root)
{
    static const char *const names[] = {"summary.json", "../bodies/summary.json"};
    for (size_t k = 0; k < 2; ++k) {
        char *path = mote_format("%s/%s", run->directory, names[k]);
        const bool there = path && access(path, F_OK) == 0;
        free(path);
        if (!there)
            continue;
        if (mote_record_read_json(run->directory, names[k], root) != MOTE_OK) {
            mote_text_add(&figure->missing, "%s", mote_error_text());
            return false;
        }
        if (has_scenes(*root))
            return true;
        json_decref(*root);
        *root = NULL;
    }
    mote_text_add(&figure->missing, "rows of more than two bodies in summary.json, here or in "
                                    "../bodies; `make bodies` measures them");
    return false;
}

static double number_of(const json_t *row, const char *key)
{
    const json_t *value = json_object_get(row, key);
    return json_is_number(value) ? json_number_value(value) : (double)NAN;
}

static bool has_text(const json_t *row, const char *key, const char *text)
{
    const char *value = json_string_value(json_object_get(row, key));
    return value && strcmp(value, text) == 0;
}

/* Whether a row is that of a method (its label), on bodies with a density, and ended well. */
static bool is_row(const json_t *row, const char *method, double density)
{
    return has_text(row, "status", "ok") && has_text(row, "label", method) &&
           fabs(number_of(row, "near_pairs_wanted") - density) < 1e-9;
}

/* Mean over all frames but the first. */
static double mean_of(const json_t *row)
{
    return number_of(json_object_get(row, "active_total_ns"), "mean");
}

/* A line: N, mean of a frame in us, MB of the process. */
static void add_line(const json_t *rows, size_t d, size_t m, mote_text *text)
{
    size_t i, count = 0;
    const json_t *row;
    mote_gnuplot_block(text, titles[m]);
    MOTE_EACH(i, row, rows)
    {
        if (!is_row(row, methods[m], densities[d]))
            continue;
        ++count;
        mote_text_add(text, "%.0f %.6g %.6g\n", number_of(row, "bodies"), mean_of(row) / 1e3,
                      number_of(row, "rss_peak_bytes") / 1e6);
    }
    if (count == 0)
        mote_text_add(text, "NaN NaN NaN\n");
}

/* The time of the first control over that of certified, for 1,000 bodies. */
static void add_ratios(const json_t *rows, mote_text *caption)
{
    for (size_t d = 0; d < sizeof densities / sizeof densities[0]; ++d) {
        double means[2] = {(double)NAN, (double)NAN};
        size_t i;
        const json_t *row;
        MOTE_EACH(i, row, rows)
        {
            for (int m = 0; m < 2; ++m) {
                if (is_row(row, methods[m], densities[d]) &&
                    fabs(number_of(row, "bodies") - 1000) < 0.5)
                    means[m] = mean_of(row);
            }
        }
        const double ratio = means[1] / means[0];
        if (!isnan(ratio))
            mote_text_add(
                caption,
                " Of 1,000 with %g near pairs each a certified frame takes one %.0fth "
                "of the time of FCL with every body refitted.",
                densities[d], ratio);
    }
}

mote_status mote_figure_bodies(const mote_figure_run *run, const char *scenario,
                               mote_figure *figure)
{
    json_t *root = NULL;
    (void)scenario;
    if (!read_rows(run, figure, &root))
        return MOTE_OK;
    const json_t *rows = json_object_get(root, "rows");
    for (size_t d = 0; d < 3; ++d) {
        for (size_t m = 0; m < 6; ++m)
            add_line(rows, d, m, &figure->data);
    }
    mote_text_add(&figure->caption,
                  "Time of a frame over the number of bodies, all deforming, with 0.1, 1 and 4 "
                  "near pairs a body: letters W of 11,920 triangles; at 10,000, which only "
                  "certified ran, letters of four shapes. Points: means over the frames but "
                  "the first, which finds all pairs anew.");
    add_ratios(rows, &figure->caption);
    json_decref(root);
    return MOTE_OK;
}

/* --- the animation --------------------------------------------------------------------------
 */

/* Frames from one picture to the next. */
#define PICTURE_STEP 5

/* The built-in letters with so few triangles that gnuplot draws them. */
static const char coarse_form[] =
    "{\"purpose\": \"letters with few triangles, for pictures\", \"like\": \"letters\",\n"
    " \"bodies\": {\"shapes\": [%s]}}\n";

typedef struct film {
    mote_bodies *bodies;
    mote_bodies_engine *engine;
    mote_bodies_frame frame;
    mote_deform *deform[MOTE_BODIES_SHAPES_MAX];
    mote_vec3 *world; /* of one body */
    bool *touches;    /* [count] */
    mote_vec3 right, up, toward;
} film;

static mote_status write_coarse(const char *directory, char **path)
{
    static const char letters[] = "WTMV";
    mote_text shapes = {0}, text = {0};
    for (int k = 0; k < 4; ++k)
        mote_text_add(&shapes,
                      "%s{\"letter\": \"%c\", \"triangles\": 500, \"field\": {\"count\": 12, "
                      "\"support\": 0.5,\n  \"displacement\": {\"random\": {\"seed\": %d, "
                      "\"amplitude\": 0.05, \"periods\": [60, 200]}}}}",
                      k ? ", " : "", letters[k], k + 1);
    if (!shapes.failed)
        mote_text_add(&text, coarse_form, shapes.data);
    free(shapes.data);
    *path = mote_format("%s/figures/letters.json", directory);
    return *path ? mote_record_text(directory, "figures/letters.json", &text)
                 : mote_fail(MOTE_ENOMEM, "no memory for a scenario");
}

static mote_status open_film(const char *path, film *f)
{
    mote_method_choice choice;
    uint32_t most = 1;
    mote_status status = mote_bodies_load(path, &f->bodies);
    if (status == MOTE_OK)
        status = mote_scene_choice_read("certified", &choice);
    if (status == MOTE_OK)
        status = mote_bodies_engine_create(f->bodies, &choice, 1, &f->engine);
    if (status == MOTE_OK)
        status = mote_bodies_frame_create(f->bodies, &f->frame);
    for (uint32_t s = 0; status == MOTE_OK && s < f->bodies->shape_count; ++s) {
        const mote_body *body = &f->bodies->shapes[s].body;
        most = body->mesh->vertex_count > most ? body->mesh->vertex_count : most;
        status = mote_deform_create(body, &f->deform[s]);
    }
    if (status != MOTE_OK)
        return status;
    f->world = malloc(most * sizeof *f->world);
    f->touches = calloc(f->bodies->count, sizeof *f->touches);
    const mote_vec3 toward = {0.35, 0.3, 1};
    const mote_vec3 right = mote_cross(mote_vec3_make(0, 1, 0), toward);
    f->toward = mote_scale(toward, 1 / mote_length(toward));
    f->right = mote_scale(right, 1 / mote_length(right));
    f->up = mote_cross(f->toward, f->right);
    return f->world && f->touches ? MOTE_OK : mote_fail(MOTE_ENOMEM, "no memory for a film");
}

static void close_film(film *f)
{
    for (uint32_t s = 0; f->bodies && s < f->bodies->shape_count; ++s)
        mote_deform_destroy(f->deform[s]);
    mote_bodies_engine_destroy(f->engine);
    mote_bodies_frame_free(&f->frame);
    mote_bodies_destroy(f->bodies);
    free(f->world);
    free(f->touches);
}

/* A point of the picture; the box's corners are within 1 of its middle. */
static void add_point(const film *f, mote_vec3 p, mote_text *text)
{
    const double scale = 1 / mote_length(f->bodies->box);
    mote_text_add(text, "%.4f %.4f %.4f\n", mote_dot(p, f->right) * scale,
                  mote_dot(p, f->up) * scale, mote_dot(p, f->toward) * scale);
}

/* The triangles of body i that face the viewer. */
static void add_body(const film *f, uint32_t i, mote_text *text)
{
    const uint32_t shape = f->bodies->shape_of[i];
    const mote_mesh *mesh = f->bodies->shapes[shape].body.mesh;
    mote_deform_all(f->deform[shape], &f->frame.states[i], f->world);
    for (uint32_t t = 0; t < mesh->triangle_count; ++t) {
        const uint32_t *v = mesh->triangles[t];
        const mote_vec3 normal = mote_cross(mote_sub(f->world[v[1]], f->world[v[0]]),
                                            mote_sub(f->world[v[2]], f->world[v[0]]));
        if (!(mote_dot(normal, f->toward) > 0))
            continue;
        for (int k = 0; k < 3; ++k)
            add_point(f, f->world[v[k]], text);
        mote_text_add(text, "\n");
    }
}

/* The edges of the box: where they begin, then their direction. */
static void add_box(const film *f, mote_text *text)
{
    const mote_vec3 *h = &f->bodies->box;
    const double scale = 1 / mote_length(*h);
    for (unsigned corner = 0; corner < 8; ++corner) {
        const mote_vec3 p = mote_vec3_make(corner & 1 ? h->x : -h->x, corner & 2 ? h->y : -h->y,
                                           corner & 4 ? h->z : -h->z);
        for (unsigned axis = 0; axis < 3; ++axis) {
            const mote_vec3 edge = {axis == 0 ? 2 * h->x : 0, axis == 1 ? 2 * h->y : 0,
                                    axis == 2 ? 2 * h->z : 0};
            if (!(corner >> axis & 1))
                mote_text_add(text, "%.4f %.4f %.4f %.4f %.4f %.4f\n",
                              mote_dot(p, f->right) * scale, mote_dot(p, f->up) * scale,
                              mote_dot(p, f->toward) * scale, mote_dot(edge, f->right) * scale,
                              mote_dot(edge, f->up) * scale, mote_dot(edge, f->toward) * scale);
        }
    }
    mote_text_add(text, "\n\n");
}

/* Blocks: the box, bodies of each of four shapes, bodies in contact, a line of numbers. */
static mote_status add_picture(film *f, uint32_t number, mote_text *text)
{
    const mote_bodies *b = f->bodies;
    mote_bodies_step step;
    size_t count;
    mote_bodies_frame_set(b, number, &f->frame);
    mote_status status = mote_bodies_engine_step(f->engine, f->frame.states, &step);
    if (status != MOTE_OK)
        return status;
    const mote_bodies_pair *pairs = mote_bodies_engine_pairs(f->engine, &count);
    memset(f->touches, 0, b->count * sizeof *f->touches);
    for (size_t k = 0; k < count; ++k) {
        for (int s = 0; s < 2 && pairs[k].answer.contact; ++s)
            f->touches[pairs[k].body[s]] = true;
    }
    add_box(f, text);
    for (uint32_t block = 0; block <= b->shape_count; ++block) {
        bool any = false;
        for (uint32_t i = 0; i < b->count; ++i) {
            if (f->touches[i] ? block < b->shape_count : block != b->shape_of[i])
                continue;
            add_body(f, i, text);
            any = true;
        }
        mote_text_add(text, any ? "\n" : "NaN NaN NaN\n\n\n");
    }
    mote_text_add(text, "%zu %zu %u\n", step.pairs, step.contacts, number);
    return text->failed ? mote_fail(MOTE_ENOMEM, "no memory for a picture") : MOTE_OK;
}

static mote_status draw_film(const mote_figure_run *run, film *f, mote_figure *figure)
{
    mote_status status = MOTE_OK;
    unsigned picture = 0;
    for (uint32_t k = 1; k <= f->bodies->frames && status == MOTE_OK; k += PICTURE_STEP) {
        mote_text text = {0};
        char name[64];
        status = add_picture(f, k, &text);
        (void)snprintf(name, sizeof name, "figures/frames/%03u.dat", picture);
        const uint64_t hash = mote_hash_bytes(MOTE_HASH_START, text.data, text.size);
        if (status == MOTE_OK)
            status = mote_record_text(run->directory, name, &text);
        free(text.data);
        mote_text_add(&figure->data, "%u %016llx\n", picture++, (unsigned long long)hash);
    }
    mote_text_add(&figure->caption,
                  "The scenario letters with 500 triangles each, every %dth of its %u frames; "
                  "dark red: letters in contact, found by the certified scene.",
                  PICTURE_STEP, f->bodies->frames);
    return status;
}

mote_status mote_figure_letters(const mote_figure_run *run, const char *scenario,
                                mote_figure *figure)
{
    json_t *root = NULL;
    (void)scenario;
    if (!read_rows(run, figure, &root))
        return MOTE_OK;
    json_decref(root);
    film f = {.bodies = NULL};
    char *folder = mote_format("%s/figures/frames", run->directory), *path = NULL;
    mote_status status =
        folder ? mote_directory_make(folder) : mote_fail(MOTE_ENOMEM, "no memory for a name");
    if (status == MOTE_OK)
        status = write_coarse(run->directory, &path);
    if (status == MOTE_OK)
        status = open_film(path, &f);
    if (status == MOTE_OK)
        status = draw_film(run, &f, figure);
    close_film(&f);
    free(folder);
    free(path);
    return status;
}
