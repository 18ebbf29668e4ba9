#include "harness/loop/film.h"

#include "core/body/deform.h"
#include "harness/base/memory.h"
#include "harness/base/record.h"
#include "harness/process/gnuplot.h"
#include "harness/process/stop.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define PARTICLES_MAX 256

/* The viewing direction, before it is made perpendicular to the line between the bodies. */
static const mote_vec3 front = {0.35, 0.45, 1};

struct mote_film {
    mote_simulated bodies;
    char *method, *path, *folder;
    uint32_t every; /* steps per picture */
    uint32_t pictures;
    bool contact;                /* reported in the previous step */
    mote_deform **deform;        /* of the shapes */
    mote_vec3 **world;           /* vertices of the bodies */
    mote_vec3 right, up, toward; /* axes of the picture, the last toward the viewer */
    double box[4];               /* low x, high x, low y, high y over all pictures, divided by
                                    L */
};

static const mote_body *shape_of(const mote_film *film, uint32_t i)
{
    return film->bodies.shapes[film->bodies.shape_of[i]];
}

static mote_status make_bodies(mote_film *film)
{
    const mote_simulated *bodies = &film->bodies;
    mote_status status = MOTE_OK;
    film->deform = mote_allocate(bodies->shape_count, sizeof(mote_deform *));
    film->world = mote_allocate(bodies->count, sizeof(mote_vec3 *));
    for (uint32_t i = 0; i < bodies->count; ++i)
        film->world[i] =
            mote_allocate(shape_of(film, i)->mesh->vertex_count, sizeof(mote_vec3));
    for (uint32_t k = 0; k < bodies->shape_count && status == MOTE_OK; ++k)
        status = mote_deform_create(bodies->shapes[k], &film->deform[k]);
    return status;
}

mote_status mote_film_create(const mote_simulator *simulator, const char *method,
                             uint32_t steps, const char *path, mote_film **film)
{
    const mote_simulated bodies = mote_simulator_bodies(simulator);
    if (bodies.count < 2)
        return mote_fail(MOTE_EINVAL, "a film is of two bodies or more; %s has one",
                         bodies.name);
    mote_film *made = mote_allocate(1, sizeof *made);
    made->bodies = bodies;
    made->method = mote_duplicate(method);
    made->path = mote_duplicate(path);
    made->folder = mote_path_is_stream(path)
                       ? mote_format("/tmp/mote.%ld.frames", (long)getpid())
                       : mote_format("%s.frames", path);
    made->every = steps / MOTE_FILM_PICTURES + 1;
    made->box[0] = made->box[2] = HUGE_VAL;
    made->box[1] = made->box[3] = -HUGE_VAL;
    mote_child_heed_signals(); /* the folder must not outlive this process */
    mote_status status = make_bodies(made);
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

/* Removes the pictures and their folder. */
static void remove_folder(const mote_film *film)
{
    static const char *const others[] = {"film.dat", "film.gif"};
    for (uint32_t k = 0; k < film->pictures + 2; ++k) {
        char *file = k < film->pictures
                         ? picture_file(film, k)
                         : mote_format("%s/%s", film->folder, others[k - film->pictures]);
        (void)unlink(file);
        free(file);
    }
    (void)rmdir(film->folder);
}

void mote_film_destroy(mote_film *film)
{
    if (!film)
        return;
    remove_folder(film);
    for (uint32_t k = 0; k < film->bodies.shape_count; ++k)
        mote_deform_destroy(film->deform[k]);
    for (uint32_t i = 0; i < film->bodies.count; ++i)
        free(film->world[i]);
    free(film->deform);
    free(film->world);
    free(film->method);
    free(film->path);
    free(film->folder);
    free(film);
}

static mote_vec3 middle_of(const mote_film *film, uint32_t i)
{
    const uint32_t count = shape_of(film, i)->mesh->vertex_count;
    mote_vec3 sum = {0, 0, 0};
    for (uint32_t v = 0; v < count; ++v)
        sum = mote_add_scaled(sum, 1.0 / count, film->world[i][v]);
    return sum;
}

/* Sets the view: from the front; for two bodies, perpendicular to the line between them in the
   first picture. y is up. */
static void aim(mote_film *film)
{
    const mote_vec3 line = mote_sub(middle_of(film, 1), middle_of(film, 0));
    const double square = mote_length_squared(line);
    mote_vec3 toward = front;
    if (film->bodies.count == 2 && square > 0)
        toward = mote_add_scaled(front, -mote_dot(front, line) / square, line);
    if (!(mote_length(mote_cross(mote_vec3_make(0, 1, 0), toward)) > 0.1 * mote_length(front)))
        toward = front;
    const mote_vec3 right = mote_cross(mote_vec3_make(0, 1, 0), toward);
    film->toward = mote_scale(toward, 1 / mote_length(toward));
    film->right = mote_scale(right, 1 / mote_length(right));
    film->up = mote_cross(film->toward, film->right);
}

/* Projects a point to picture coordinates, divided by L. */
static mote_vec3 see(const mote_film *film, mote_vec3 p)
{
    return mote_scale(mote_vec3_make(mote_dot(p, film->right), mote_dot(p, film->up),
                                     mote_dot(p, film->toward)),
                      1 / film->bodies.length);
}

static void add_point(const mote_film *film, mote_vec3 p, mote_text *text)
{
    const mote_vec3 q = see(film, p);
    mote_text_add(text, "%.4f %.4f %.4f\n", q.x, q.y, q.z);
}

/* Adds the front-facing triangles of body i. */
static void add_body(mote_film *film, uint32_t i, mote_text *text)
{
    const mote_mesh *mesh = shape_of(film, i)->mesh;
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
    for (uint32_t v = 0; v < mesh->vertex_count; ++v) {
        const mote_vec3 p = see(film, world[v]);
        film->box[0] = fmin(film->box[0], p.x);
        film->box[1] = fmax(film->box[1], p.x);
        film->box[2] = fmin(film->box[2], p.y);
        film->box[3] = fmax(film->box[3], p.y);
    }
}

/* Adds a block of every other body, from the first or the second on. */
static void add_bodies(mote_film *film, uint32_t first, mote_text *text)
{
    for (uint32_t i = first; i < film->bodies.count; i += 2)
        add_body(film, i, text);
    mote_text_add(text, "\n");
}

/* Adds a point that is not drawn: blocks must not be empty. */
static void add_nothing(mote_text *text)
{
    mote_text_add(text, "NaN NaN NaN\n");
}

/* Adds a block of the particles of body i of two. */
static void add_particles(const mote_film *film, const mote_simulation_view *view, int i,
                          mote_text *text)
{
    mote_vec3 positions[PARTICLES_MAX];
    size_t count = 0;
    if (view->method)
        count = mote_engine_particles(view->method, i, positions, PARTICLES_MAX);
    count = count < PARTICLES_MAX ? count : PARTICLES_MAX;
    for (size_t k = 0; k < count; ++k)
        add_point(film, positions[k], text);
    if (count == 0)
        add_nothing(text);
    mote_text_add(text, "\n\n");
}

/* Adds a block of the closest points: for two bodies always, for many where a contact is
   reported. */
static void add_closest(const mote_film *film, const mote_simulation_view *view,
                        mote_text *text)
{
    size_t shown = 0;
    for (size_t k = 0; k < view->said_count; ++k) {
        const mote_answer *answer = &view->said[k].answer;
        if (!answer->has_witness || (film->bodies.count > 2 && !answer->contact))
            continue;
        if (shown++ > 0)
            mote_text_add(text, "\n"); /* a separate line for each pair */
        for (int i = 0; i < 2; ++i)
            add_point(film, answer->witness[i], text);
    }
    if (shown == 0)
        add_nothing(text);
    mote_text_add(text, "\n\n");
}

mote_status mote_film_watch(void *film, const mote_simulation_view *view)
{
    mote_film *f = film;
    if (mote_child_stop_asked())
        return mote_child_stopped(f->path);
    const bool begins = view->contact && !f->contact;
    f->contact = view->contact;
    if ((view->step % f->every != 0 && !begins) || f->pictures == 2 * MOTE_FILM_PICTURES)
        return MOTE_OK;
    mote_text text = {0};
    for (uint32_t i = 0; i < f->bodies.count; ++i)
        mote_deform_all(f->deform[f->bodies.shape_of[i]], &view->states[i], f->world[i]);
    if (f->pictures == 0)
        aim(f);
    add_bodies(f, 0, &text);
    add_bodies(f, 1, &text);
    for (int i = 0; i < 2; ++i)
        add_particles(f, view, i, &text);
    add_closest(f, view, &text);
    mote_text_add(&text, "%d %d %u\n", view->contact, view->truth, view->step);
    char *file = picture_file(f, f->pictures);
    const mote_status status = mote_file_write(file, text.data, text.size);
    free(file);
    free(text.data);
    f->pictures += status == MOTE_OK;
    return status;
}

/* Writes the number of pictures and their common box. */
static mote_status write_index(const mote_film *film)
{
    mote_text text = {0};
    mote_text_add(&text, "%u %.4f %.4f %.4f %.4f\n", film->pictures, film->box[0], film->box[1],
                  film->box[2], film->box[3]);
    return mote_record_text(film->folder, "film.dat", &text);
}

mote_status mote_film_draw(const mote_film *film)
{
    char *heading = mote_format("%s, %s", film->bodies.name, film->method);
    char *made = mote_format("%s/film.gif", film->folder);
    char *picture = NULL;
    size_t size = 0;
    mote_status status = write_index(film);
    if (status == MOTE_OK)
        status = mote_gnuplot_draw(film->folder, "simulation", "film", heading, "", "gif");
    if (status == MOTE_OK)
        status = mote_file_read(made, SIZE_MAX, &picture, &size);
    if (status == MOTE_OK)
        status = mote_file_write(film->path, picture, size);
    free(picture);
    free(heading);
    free(made);
    return status;
}
