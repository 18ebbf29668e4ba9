#include "harness/loop/film.h"

#include "core/body/deform.h"
#include "harness/process/gnuplot.h"
#include "harness/base/record.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define PARTICLES_MAX 256

/* Where the picture is seen from, as far as that is across the line between the bodies. */
static const mote_vec3 front = {0.35, 0.45, 1};

struct mote_film {
    const mote_scenario *scenario;
    char *method, *path, *folder;
    uint32_t every; /* a picture every so many steps */
    uint32_t pictures;
    bool contact; /* reported in the step before */
    mote_deform *deform[2];
    mote_vec3 *world[2];
    mote_vec3 right, up, toward; /* axes of the picture, toward who looks */
    double box[4];               /* low x, high x, low y, high y of all pictures, over L */
};

mote_status mote_film_create(const mote_scenario *scenario, const char *method, uint32_t steps,
                             const char *path, mote_film **film)
{
    mote_film *made = calloc(1, sizeof *made);
    if (!made)
        return mote_fail(MOTE_ENOMEM, "no memory for a film");
    made->scenario = scenario;
    made->method = mote_format("%s", method);
    made->path = mote_format("%s", path);
    made->folder = mote_path_is_stream(path)
                       ? mote_format("/tmp/mote.%ld.frames", (long)getpid())
                       : mote_format("%s.frames", path);
    made->every = steps / MOTE_FILM_PICTURES + 1;
    made->box[0] = made->box[2] = HUGE_VAL;
    made->box[1] = made->box[3] = -HUGE_VAL;
    mote_status status = MOTE_OK;
    if (!made->method || !made->path || !made->folder)
        status = mote_fail(MOTE_ENOMEM, "no memory for a film");
    for (int i = 0; i < 2 && status == MOTE_OK; ++i) {
        made->world[i] = malloc(scenario->body[i].mesh->vertex_count * sizeof(mote_vec3));
        status = made->world[i] ? mote_deform_create(&scenario->body[i], &made->deform[i])
                                : mote_fail(MOTE_ENOMEM, "no memory for a body's vertices");
    }
    if (status == MOTE_OK)
        status = mote_directory_make(made->folder);
    if (status == MOTE_OK)
        *film = made;
    else
        mote_film_destroy(made);
    return status;
}

/* The geometry of a picture; the caller frees it. */
static char *picture_file(const mote_film *film, uint32_t picture)
{
    return mote_format("%s/%03u.dat", film->folder, picture);
}

/* With all that was written to it. */
static void remove_folder(const mote_film *film)
{
    static const char *const others[] = {"film.dat", "film.gif"};
    for (uint32_t k = 0; k < film->pictures + 2; ++k) {
        char *file = k < film->pictures
                         ? picture_file(film, k)
                         : mote_format("%s/%s", film->folder, others[k - film->pictures]);
        if (file)
            (void)unlink(file);
        free(file);
    }
    if (film->folder)
        (void)rmdir(film->folder);
}

void mote_film_destroy(mote_film *film)
{
    if (!film)
        return;
    remove_folder(film);
    for (int i = 0; i < 2; ++i) {
        mote_deform_destroy(film->deform[i]);
        free(film->world[i]);
    }
    free(film->method);
    free(film->path);
    free(film->folder);
    free(film);
}

static mote_vec3 middle_of(const mote_film *film, int i)
{
    const uint32_t count = film->scenario->body[i].mesh->vertex_count;
    mote_vec3 sum = {0, 0, 0};
    for (uint32_t v = 0; v < count; ++v)
        sum = mote_add_scaled(sum, 1.0 / count, film->world[i][v]);
    return sum;
}

/* Looks across the line between the bodies of the first picture, y upwards. */
static void aim(mote_film *film)
{
    const mote_vec3 line = mote_sub(middle_of(film, 1), middle_of(film, 0));
    const double square = mote_length_squared(line);
    mote_vec3 toward = front;
    if (square > 0)
        toward = mote_add_scaled(front, -mote_dot(front, line) / square, line);
    if (!(mote_length(mote_cross(mote_vec3_make(0, 1, 0), toward)) > 0.1 * mote_length(front)))
        toward = front;
    const mote_vec3 right = mote_cross(mote_vec3_make(0, 1, 0), toward);
    film->toward = mote_scale(toward, 1 / mote_length(toward));
    film->right = mote_scale(right, 1 / mote_length(right));
    film->up = mote_cross(film->toward, film->right);
}

/* In the picture, over L. */
static mote_vec3 see(const mote_film *film, mote_vec3 p)
{
    return mote_scale(mote_vec3_make(mote_dot(p, film->right), mote_dot(p, film->up),
                                     mote_dot(p, film->toward)),
                      1 / film->scenario->length);
}

static void add_point(const mote_film *film, mote_vec3 p, mote_text *text)
{
    const mote_vec3 q = see(film, p);
    mote_text_add(text, "%.4f %.4f %.4f\n", q.x, q.y, q.z);
}

/* A block of the triangles of body i that are seen from their outside. */
static void add_body(mote_film *film, int i, mote_text *text)
{
    const mote_mesh *mesh = film->scenario->body[i].mesh;
    const mote_vec3 *world = film->world[i];
    for (uint32_t f = 0; f < mesh->triangle_count; ++f) {
        const uint32_t *t = mesh->triangles[f];
        const mote_vec3 normal =
            mote_cross(mote_sub(world[t[1]], world[t[0]]), mote_sub(world[t[2]], world[t[0]]));
        if (!(mote_dot(normal, film->toward) > 0))
            continue;
        for (int k = 0; k < 3; ++k)
            add_point(film, world[t[k]], text);
        mote_text_add(text, "\n");
    }
    mote_text_add(text, "\n");
    for (uint32_t v = 0; v < mesh->vertex_count; ++v) {
        const mote_vec3 p = see(film, world[v]);
        film->box[0] = fmin(film->box[0], p.x);
        film->box[1] = fmax(film->box[1], p.x);
        film->box[2] = fmin(film->box[2], p.y);
        film->box[3] = fmax(film->box[3], p.y);
    }
}

/* A block of the particles of body i; one point that is not shown where there is none. */
static void add_particles(const mote_film *film, const mote_simulation_view *view, int i,
                          mote_text *text)
{
    mote_vec3 positions[PARTICLES_MAX];
    size_t count = mote_probe_particles(view->method, i, positions, PARTICLES_MAX);
    count = count < PARTICLES_MAX ? count : PARTICLES_MAX;
    for (size_t k = 0; k < count; ++k)
        add_point(film, positions[k], text);
    if (count == 0)
        mote_text_add(text, "NaN NaN NaN\n");
    mote_text_add(text, "\n\n");
}

mote_status mote_film_watch(void *film, const mote_simulation_view *view)
{
    mote_film *f = film;
    const bool begins = view->contact && !f->contact;
    f->contact = view->contact;
    if ((view->step % f->every != 0 && !begins) || f->pictures == 2 * MOTE_FILM_PICTURES)
        return MOTE_OK;
    mote_text text = {0};
    for (int i = 0; i < 2; ++i)
        mote_deform_all(f->deform[i], &view->frame->body[i], f->world[i]);
    if (f->pictures == 0)
        aim(f);
    for (int i = 0; i < 2; ++i)
        add_body(f, i, &text);
    for (int i = 0; i < 2; ++i)
        add_particles(f, view, i, &text);
    const mote_vec3 *pair = view->said->witness;
    for (int i = 0; i < 2 && view->said->has_witness; ++i)
        add_point(f, pair[i], &text);
    if (!view->said->has_witness)
        mote_text_add(&text, "NaN NaN NaN\n");
    mote_text_add(&text, "\n\n%d %d %u\n", view->contact, view->truth, view->step);
    char *file = picture_file(f, f->pictures);
    mote_status status = file && !text.failed
                             ? mote_file_write(file, text.data, text.size)
                             : mote_fail(MOTE_ENOMEM, "no memory for a picture");
    free(file);
    free(text.data);
    f->pictures += status == MOTE_OK;
    return status;
}

/* Where the pictures are: their number, and the box. */
static mote_status write_index(const mote_film *film)
{
    mote_text text = {0};
    mote_text_add(&text, "%u %.4f %.4f %.4f %.4f\n", film->pictures, film->box[0], film->box[1],
                  film->box[2], film->box[3]);
    return mote_record_text(film->folder, "film.dat", &text);
}

mote_status mote_film_draw(const mote_film *film)
{
    char *heading = mote_format("%s, %s", film->scenario->name, film->method);
    char *made = mote_format("%s/film.gif", film->folder);
    mote_status status =
        heading && made ? write_index(film) : mote_fail(MOTE_ENOMEM, "no memory for a film");
    if (status == MOTE_OK)
        status = mote_gnuplot_draw(film->folder, "simulation", "film", heading, "", "gif");
    char *picture = NULL;
    size_t size = 0;
    if (status == MOTE_OK)
        status = mote_file_read(made, SIZE_MAX, &picture, &size);
    if (status == MOTE_OK)
        status = mote_file_write(film->path, picture, size);
    free(picture);
    free(heading);
    free(made);
    return status;
}
