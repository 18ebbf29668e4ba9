#include "harness/loop/flight.h"

#include "core/body/path_place.h"
#include "harness/base/memory.h"
#include "harness/loop/reach.h"

#include <stdlib.h>
#include <string.h>

/* Rotations by more than this in a piece, in radians, are arcs; others are cubics, with the
   angular velocities at both ends. */
#define ARC_LEAST 0.5

typedef struct flown {
    const mote_field *field;
    uint32_t padded;
    mote_path_piece *pieces; /* [room] */
    double *controls;        /* [room][4][3][padded] */
    mote_rigid_state *ends;  /* [room + 1] */
    double *now, *rate; /* [3][padded]: where the next flight begins, in the body's axes, and
                           its change a frame */
    double *slope;      /* the change a frame where a piece begins */
    double *key[3];     /* the same behind, at and before the end of a piece */
    double *world;      /* of the body as it is shown */
    double radius;      /* greatest distance of a rest vertex from the centre of mass */
    double *sizes;      /* of the basis functions, or NULL */
    mote_vec3 *own[2];  /* [count] weights in the body's axes, as it was and as it is shown */
    mote_body_state previous;
    double *previous_world;
} flown;

struct mote_flight {
    const mote_simulator *simulator;
    uint32_t count, room;
    double duration;
    flown *bodies;          /* [count] */
    mote_path *paths;       /* [count] */
    mote_body_state *shown; /* [count] */
    double **wanted;        /* [count] where the scenario's weights are written */
};

static void make_body(mote_flight *f, uint32_t i)
{
    const mote_simulator *s = f->simulator;
    const mote_body *shape = s->shapes[s->shape_of[i]];
    const mote_vec3 centre = s->masses[s->shape_of[i]].centre;
    flown *b = &f->bodies[i];
    b->field = shape->field;
    b->padded = shape->field->padded;
    const size_t numbers = 3 * (size_t)b->padded + 1;
    b->pieces = mote_allocate(f->room, sizeof *b->pieces);
    b->controls = mote_allocate(4 * numbers * f->room, sizeof(double));
    b->ends = mote_allocate((size_t)f->room + 1, sizeof *b->ends);
    double **const arrays[] = {&b->now,    &b->rate,   &b->slope, &b->key[0],
                               &b->key[1], &b->key[2], &b->world, &b->previous_world};
    for (size_t k = 0; k < sizeof arrays / sizeof arrays[0]; ++k)
        *arrays[k] = mote_allocate(numbers, sizeof(double));
    for (uint32_t v = 0; v < shape->mesh->vertex_count; ++v)
        b->radius = fmax(b->radius, mote_distance_squared(shape->mesh->positions[v], centre));
    b->radius = sqrt(b->radius);
    if (f->count == 2) /* nobody asks how far many bodies have moved */
        b->sizes = mote_reach_sizes(shape);
    for (int k = 0; k < 2; ++k)
        b->own[k] = mote_allocate((size_t)b->padded + 1, sizeof *b->own[k]);
    f->paths[i] = (mote_path){.pivot = centre, .pieces = b->pieces};
}

mote_flight *mote_flight_create(const mote_simulator *simulator, double longest)
{
    mote_flight *made = mote_allocate(1, sizeof *made);
    made->simulator = simulator;
    made->count = simulator->bodies.count;
    made->room = (uint32_t)ceil(longest) + 1;
    made->bodies = mote_allocate(made->count, sizeof *made->bodies);
    made->paths = mote_allocate(made->count, sizeof *made->paths);
    made->shown = mote_allocate(made->count, sizeof *made->shown);
    made->wanted = mote_allocate(made->count, sizeof(double *));
    for (uint32_t i = 0; i < made->count; ++i)
        make_body(made, i);
    return made;
}

void mote_flight_destroy(mote_flight *flight)
{
    if (!flight)
        return;
    for (uint32_t i = 0; i < flight->count; ++i) {
        flown *b = &flight->bodies[i];
        double *const arrays[] = {b->now,    b->rate,  b->slope,          b->key[0],  b->key[1],
                                  b->key[2], b->world, b->previous_world, b->controls};
        for (size_t k = 0; k < sizeof arrays / sizeof arrays[0]; ++k)
            free(arrays[k]);
        free(b->sizes);
        free(b->own[0]);
        free(b->own[1]);
        free(b->pieces);
        free(b->ends);
    }
    free(flight->bodies);
    free(flight->paths);
    free(flight->shown);
    free(flight->wanted);
    free(flight);
}

uint32_t mote_flight_pieces_max(const mote_flight *flight)
{
    return flight->room;
}

/* Sets key[k] of all bodies to the scenario's weights. */
static void weigh(mote_flight *f, int k, double place)
{
    for (uint32_t i = 0; i < f->count; ++i)
        f->wanted[i] = f->bodies[i].key[k];
    mote_stage_weigh(f->simulator->stage, place, f->wanted);
}

void mote_flight_restart(mote_flight *flight)
{
    weigh(flight, 0, 0);
    weigh(flight, 2, 0.5);
    for (uint32_t i = 0; i < flight->count; ++i) {
        flown *b = &flight->bodies[i];
        for (size_t j = 0; j < 3 * (size_t)b->padded; ++j) {
            b->now[j] = b->key[0][j];
            b->rate[j] = 2 * (b->key[2][j] - b->key[0][j]);
        }
    }
}

/* The control point beside q towards a turn by the angular velocity in a third of `step`. */
static mote_quaternion beside(mote_quaternion q, mote_vec3 angular_velocity, double step)
{
    const mote_vec3 w = mote_scale(angular_velocity, step / 6);
    const mote_quaternion d = mote_quaternion_multiply((mote_quaternion){0, w.x, w.y, w.z}, q);
    return (mote_quaternion){q.w + d.w, q.x + d.x, q.y + d.y, q.z + d.z};
}

/* The rotation from a to b as a vector. */
static mote_vec3 spin_between(mote_quaternion a, mote_quaternion b)
{
    const mote_quaternion back = {a.w, -a.x, -a.y, -a.z};
    const mote_quaternion d = mote_quaternion_multiply(b, back);
    const mote_vec3 axis = {d.x, d.y, d.z};
    const double length = mote_length(axis);
    return length > 0 ? mote_scale(axis, 2 * atan2(length, d.w) / length) : axis;
}

static mote_status plan_body(mote_flight *f, uint32_t i, const mote_rigid_state *state,
                             uint32_t count, double step)
{
    const mote_simulator *s = f->simulator;
    const mote_mass *mass = &s->masses[s->shape_of[i]];
    flown *b = &f->bodies[i];
    bool spins = false;
    mote_status status = MOTE_OK;
    b->ends[0] = *state;
    for (uint32_t k = 0; k < count && status == MOTE_OK; ++k) {
        b->ends[k + 1] = b->ends[k];
        status = mote_rigid_step(mass, s->gravity, step, &b->ends[k + 1]);
        spins = spins || !(step * mote_length(mote_rigid_angular_velocity(mass, &b->ends[k])) <=
                           ARC_LEAST);
    }
    for (uint32_t k = 0; k < count && status == MOTE_OK; ++k) {
        const mote_rigid_state *from = &b->ends[k], *to = &b->ends[k + 1];
        mote_path_piece *piece = &b->pieces[k];
        *piece = (mote_path_piece){.spins = spins};
        mote_path_hermite(from->centre, mote_scale(from->velocity, step), to->centre,
                          mote_scale(to->velocity, step), piece->centre);
        piece->turn[0] = from->turn;
        piece->turn[1] = beside(from->turn, mote_rigid_angular_velocity(mass, from), step);
        piece->turn[2] = beside(to->turn, mote_rigid_angular_velocity(mass, to), -step);
        piece->turn[3] = to->turn;
        if (spins)
            piece->spin = spin_between(from->turn, to->turn);
        if (b->padded > 0)
            piece->weights = b->controls + 12 * (size_t)b->padded * k;
    }
    f->paths[i].count = count;
    return status;
}

/* Sets the control points of piece k between keys 0 and 1, where rates at the end are those of
   the parabola through the keys; the next piece begins there. */
static void plan_weights(flown *b, uint32_t k, double step)
{
    const size_t numbers = 3 * (size_t)b->padded;
    double *w = b->controls + 4 * numbers * k;
    for (size_t j = 0; j < numbers; ++j) {
        const double end_rate = (b->key[2][j] - b->key[0][j]) / (2 * step);
        w[j] = b->key[0][j];
        w[numbers + j] = b->key[0][j] + step / 3 * b->slope[j];
        w[2 * numbers + j] = b->key[1][j] - step / 3 * end_rate;
        w[3 * numbers + j] = b->key[1][j];
        b->slope[j] = end_rate;
    }
    double *first = b->key[0];
    b->key[0] = b->key[1];
    b->key[1] = b->key[2];
    b->key[2] = first;
}

mote_status mote_flight_plan(mote_flight *flight, const mote_rigid_state *states, double now,
                             double duration)
{
    const uint32_t whole = (uint32_t)ceil(duration - 1e-9);
    const uint32_t count = whole > 1 ? whole : 1;
    const double step = duration / count;
    mote_status status = MOTE_OK;
    for (uint32_t i = 0; i < flight->count && status == MOTE_OK; ++i) {
        status = plan_body(flight, i, &states[i], count, step);
        flown *b = &flight->bodies[i];
        memcpy(b->key[0], b->now, 3 * (size_t)b->padded * sizeof(double));
        memcpy(b->slope, b->rate, 3 * (size_t)b->padded * sizeof(double));
    }
    if (status != MOTE_OK)
        return status;
    flight->duration = duration;
    weigh(flight, 1, now + step);
    for (uint32_t k = 0; k < count; ++k) {
        weigh(flight, 2, now + (k + 2) * step);
        for (uint32_t i = 0; i < flight->count; ++i)
            plan_weights(&flight->bodies[i], k, step);
    }
    return MOTE_OK;
}

const mote_path *mote_flight_paths(const mote_flight *flight)
{
    return flight->paths;
}

static bool leaves(double centre, double velocity, double room)
{
    return (centre > room && velocity > 0) || (centre < -room && velocity < 0);
}

double mote_flight_wall(const mote_flight *flight)
{
    const mote_vec3 room = flight->simulator->room;
    uint32_t first = flight->paths[0].count;
    for (uint32_t i = 0; i < flight->count; ++i) {
        for (uint32_t k = 1; k < first; ++k) {
            const mote_rigid_state *s = &flight->bodies[i].ends[k];
            if (leaves(s->centre.x, s->velocity.x, room.x) ||
                leaves(s->centre.y, s->velocity.y, room.y) ||
                leaves(s->centre.z, s->velocity.z, room.z))
                first = k;
        }
    }
    return (double)first / flight->paths[0].count;
}

const mote_body_state *mote_flight_show(mote_flight *flight, double part)
{
    const mote_simulator *s = flight->simulator;
    for (uint32_t i = 0; i < flight->count; ++i) {
        flown *b = &flight->bodies[i];
        double *block = b->previous_world;
        b->previous_world = b->world;
        b->world = block;
        b->previous = flight->shown[i];
        mote_path_state(&flight->paths[i], s->shapes[s->shape_of[i]], part, b->world,
                        &flight->shown[i]);
    }
    return flight->shown;
}

static void turn_back(const mote_body_state *state, mote_vec3 *own)
{
    const mote_weights *w = &state->weights;
    for (uint32_t j = 0; j < w->count; ++j)
        own[j] =
            mote_rotate_back(&state->pose.rotation, mote_vec3_make(w->x[j], w->y[j], w->z[j]));
}

/* The most that any point of body i has moved: by its centre, by rotation, and by deformation.
 */
static double body_moved(const mote_flight *f, uint32_t i)
{
    const flown *body = &f->bodies[i];
    const mote_body_state *a = &body->previous, *b = &f->shown[i];
    double square = 0;
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) {
            const double d = b->pose.rotation.m[r][c] - a->pose.rotation.m[r][c];
            square += d * d;
        }
    }
    turn_back(a, body->own[0]);
    turn_back(b, body->own[1]);
    const mote_reach reach =
        mote_reach_of(body->field, body->sizes, body->own[0], body->own[1]);
    const mote_vec3 pivot = f->paths[i].pivot;
    const mote_vec3 centre =
        mote_sub(mote_pose_apply(&b->pose, pivot), mote_pose_apply(&a->pose, pivot));
    const double chord = sqrt(square / 2);
    return mote_length(centre) + chord * (body->radius + reach.shape) + reach.change;
}

double mote_flight_moved(const mote_flight *flight)
{
    return body_moved(flight, 0) + body_moved(flight, 1);
}

/* The weights before the amounts of morph targets are the body's axes, however sums of control
   points are rounded. */
static void keep_axes(flown *b)
{
    for (size_t i = 0; i < 9 && b->field->numbers > 0; ++i) {
        const size_t at = i / 3 * b->padded + mote_field_first_axis(b->field) + i % 3;
        b->now[at] = i / 3 == i % 3;
        b->rate[at] = 0;
    }
}

/* The weights at u of a piece, and their change a frame. */
static void keep_weights(flown *b, uint32_t k, double u, double step)
{
    const size_t numbers = 3 * (size_t)b->padded;
    const double *w = b->controls + 4 * numbers * k, v = 1 - u;
    for (size_t j = 0; j < numbers; ++j) {
        const double p = w[j], q = w[numbers + j], r = w[2 * numbers + j],
                     t = w[3 * numbers + j];
        b->now[j] = v * v * v * p + 3 * u * v * v * q + 3 * u * u * v * r + u * u * u * t;
        b->rate[j] = 3 * (v * v * (q - p) + 2 * u * v * (r - q) + u * u * (t - r)) / step;
    }
    keep_axes(b);
}

/* The rotation of a piece at u: the quaternion that is nearest to its matrix's. */
static mote_quaternion turn_at(const mote_path_piece *piece, double u)
{
    const double v = 1 - u;
    if (piece->spins) {
        const double angle = mote_length(piece->spin), half = u * angle / 2;
        const double s = angle > 0 ? sin(half) / angle : 0;
        const mote_quaternion d = {cos(half), s * piece->spin.x, s * piece->spin.y,
                                   s * piece->spin.z};
        return mote_quaternion_normalise(mote_quaternion_multiply(d, piece->turn[0]));
    }
    const double b[4] = {v * v * v, 3 * u * v * v, 3 * u * u * v, u * u * u};
    mote_quaternion q = {0, 0, 0, 0};
    for (int i = 0; i < 4; ++i) {
        const mote_quaternion c = piece->turn[i];
        q = (mote_quaternion){q.w + b[i] * c.w, q.x + b[i] * c.x, q.y + b[i] * c.y,
                              q.z + b[i] * c.z};
    }
    return mote_quaternion_normalise(q);
}

void mote_flight_end(mote_flight *flight, double part, mote_rigid_state *states)
{
    const uint32_t count = flight->paths[0].count;
    const double step = flight->duration / count;
    const mote_place at = mote_path_place(&flight->paths[0], part);
    for (uint32_t i = 0; i < flight->count; ++i) {
        flown *b = &flight->bodies[i];
        const mote_rigid_state *from = &b->ends[at.piece];
        if (part < 1) {
            const double frames = at.u * step;
            const mote_vec3 gravity = flight->simulator->gravity;
            states[i] = *from;
            states[i].velocity = mote_add_scaled(from->velocity, frames, gravity);
            states[i].centre =
                mote_add_scaled(mote_add_scaled(from->centre, frames, from->velocity),
                                frames * frames / 2, gravity);
            states[i].turn = turn_at(&b->pieces[at.piece], at.u);
        } else {
            states[i] = b->ends[count];
        }
        keep_weights(b, at.piece, at.u, step);
    }
}
