/* 100 letters in a box, animated (15): those in contact, as measured by `make bodies`. */
#include "harness/figure/figure.h"

#include "core/body/deform.h"
#include "harness/base/hash.h"
#include "harness/base/memory.h"
#include "harness/base/record.h"
#include "harness/scene/bodies.h"
#include "harness/summary/scene_contacts.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

/* Frames per picture. */
#define PICTURE_STEP 5

typedef struct film {
    char *directory; /* of its run */
    mote_summary summary;
    const mote_stored_cell *cell;
    mote_scene_contacts contacts;
    size_t shown; /* contacts of earlier frames than the picture's */
    mote_bodies *bodies;
    mote_bodies_frame frame;
    mote_deform *deform[MOTE_BODIES_SHAPES_MAX];
    mote_vec3 *world; /* of one body */
    bool *touches;    /* [count] */
    mote_vec3 right, up, toward;
} film;

/* The film's directory: in this run, or in ../bodies; NULL if there is none. */
static char *find_directory(const char *run)
{
    static const char *const places[] = {"film", "../bodies/film"};
    for (size_t k = 0; k < sizeof places / sizeof places[0]; ++k) {
        char *directory = mote_format("%s/%s", run, places[k]);
        if (mote_record_exists(directory, "letters.json"))
            return directory;
        free(directory);
    }
    return NULL;
}

/* Reads the cell, its contacts and its bodies, which must be those that were measured. */
static mote_status read_film(film *f)
{
    char *path = mote_format("%s/letters.json", f->directory);
    uint64_t fingerprint = 0;
    mote_status status = mote_summary_make(f->directory, &f->summary);
    if (status == MOTE_OK && (f->summary.count != 1 || f->summary.rows[0].finished == 0))
        status = mote_fail(MOTE_EINVAL, "%s: not the run of one film", f->directory);
    if (status == MOTE_OK) {
        f->cell = f->summary.rows[0].first;
        status = mote_scene_contacts_read(f->directory, f->cell, &f->contacts);
    }
    if (status == MOTE_OK)
        status = mote_bodies_load(path, &f->bodies);
    if (status == MOTE_OK)
        status = mote_bodies_fingerprint(f->bodies, &fingerprint);
    if (status == MOTE_OK &&
        !mote_stored_is_of(f->cell, fingerprint, mote_bodies_faces(f->bodies)))
        status = mote_fail(MOTE_EINVAL, "%s: other frames or faces than those measured", path);
    free(path);
    return status;
}

static mote_status open_film(film *f)
{
    uint32_t most = 1;
    mote_status status = read_film(f);
    if (status == MOTE_OK)
        f->frame = mote_bodies_frame_create(f->bodies);
    for (uint32_t s = 0; status == MOTE_OK && s < f->bodies->shape_count; ++s) {
        const mote_body *body = &f->bodies->shapes[s].body;
        most = body->mesh->vertex_count > most ? body->mesh->vertex_count : most;
        status = mote_deform_create(body, &f->deform[s]);
    }
    if (status != MOTE_OK)
        return status;
    f->world = mote_allocate(most, sizeof *f->world);
    f->touches = mote_allocate(f->bodies->count, sizeof *f->touches);
    const mote_vec3 toward = {0.35, 0.3, 1};
    const mote_vec3 right = mote_cross(mote_vec3_make(0, 1, 0), toward);
    f->toward = mote_scale(toward, 1 / mote_length(toward));
    f->right = mote_scale(right, 1 / mote_length(right));
    f->up = mote_cross(f->toward, f->right);
    return MOTE_OK;
}

static void close_film(film *f)
{
    for (uint32_t s = 0; f->bodies && s < f->bodies->shape_count; ++s)
        mote_deform_destroy(f->deform[s]);
    mote_bodies_frame_free(&f->frame);
    mote_bodies_destroy(f->bodies);
    mote_summary_free(&f->summary);
    free(f->contacts.list);
    free(f->world);
    free(f->touches);
    free(f->directory);
}

/* A point of the picture; the box's corners are within 1 of its middle. */
static void add_point(const film *f, mote_vec3 p, mote_text *text)
{
    const double scale = 1 / mote_length(f->bodies->box);
    mote_text_add(text, "%.4f %.4f %.4f\n", mote_dot(p, f->right) * scale,
                  mote_dot(p, f->up) * scale, mote_dot(p, f->toward) * scale);
}

/* Adds the front-facing triangles of body i. */
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

/* Adds the edges of the box: start point, then direction. */
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

/* Marks the bodies in contact in a frame; frames ascend from picture to picture. */
static void mark_contacts(film *f, uint32_t frame)
{
    const mote_scene_contacts *all = &f->contacts;
    memset(f->touches, 0, f->bodies->count * sizeof *f->touches);
    for (; f->shown < all->count && all->list[f->shown].frame <= frame; ++f->shown) {
        const mote_scene_contact *contact = &all->list[f->shown];
        for (int s = 0; s < 2 && contact->frame == frame; ++s) {
            if (contact->body[s] <= f->bodies->count)
                f->touches[contact->body[s] - 1] = true;
        }
    }
}

/* The bodies of f->frame in blocks: the box, bodies of each of four shapes, bodies in contact,
   a line of numbers. */
static void add_picture(film *f, size_t row, mote_text *text)
{
    const mote_bodies *b = f->bodies;
    const mote_stored_cell *cell = f->cell;
    mark_contacts(f, cell->frame[row]);
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
    mote_text_add(text, "%.0f %.0f %u\n", cell->scene[MOTE_SCENE_COLUMN_near_pairs][row],
                  cell->scene[MOTE_SCENE_COLUMN_pair_contacts][row], cell->frame[row]);
}

static mote_status draw_film(const mote_figure_run *run, film *f, mote_figure *figure)
{
    mote_status status = MOTE_OK;
    unsigned picture = 0;
    for (size_t k = 0; k < f->cell->frames && status == MOTE_OK; k += PICTURE_STEP) {
        mote_text text = {0};
        uint64_t hash;
        status = mote_bodies_frame_set(f->bodies, f->cell->frame[k], &f->frame);
        if (status != MOTE_OK)
            break;
        add_picture(f, k, &text);
        status = mote_figure_frame_write(run, picture, &text, &hash);
        mote_text_add(&figure->data, "%u %016" PRIx64 "\n", picture++, hash);
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
    (void)scenario;
    film f = {.directory = find_directory(run->directory)};
    if (!f.directory) {
        mote_text_add(&figure->missing,
                      "film/letters.json, here or in ../bodies; `make bodies` measures it");
        return MOTE_OK;
    }
    mote_status status = mote_figure_frames_begin(run);
    if (status == MOTE_OK)
        status = open_film(&f);
    if (status == MOTE_OK)
        status = draw_film(run, &f, figure);
    close_film(&f);
    return status;
}
