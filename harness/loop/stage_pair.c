#include "harness/loop/stage.h"

#include "harness/base/memory.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

typedef struct pair_stage {
    const mote_scenario *scenario;
    mote_method_choice choice;
    const mote_simulation_options *options;
    const mote_mass *masses;
    mote_engine *truth, *method;
    mote_frame_buffer *buffer;
    mote_frame frame;   /* the one that is shown */
    uint32_t first;     /* frame whose deformation is shown first */
    double radius[2];   /* greatest distance of a rest vertex from the centre of mass */
    double *weights[2]; /* those of the frame, in world axes: x, y, z, [3][padded] */
    double *still[2];   /* the same in rest axes, [count][3] */
    double *before[2];  /* those of the frame before */
    mote_rigid_state state[2], previous[2]; /* of this frame, of the frame before */
    double lower;                           /* of the true distance, proven */
    mote_near_pair said, known;             /* answers of the method, of the truth */
} pair_stage;

static void pair_destroy(void *state)
{
    pair_stage *s = state;
    if (!s)
        return;
    for (int i = 0; i < 2; ++i) {
        free(s->weights[i]);
        free(s->still[i]);
        free(s->before[i]);
    }
    mote_engine_destroy(s->truth);
    mote_engine_destroy(s->method);
    mote_frame_buffer_destroy(s->buffer);
    free(s);
}

static double tolerance_of(const pair_stage *s)
{
    return s->options->tolerance * s->scenario->length;
}

static mote_status create_probe(pair_stage *s, const mote_method_choice *choice, uint64_t seed,
                                mote_engine **probe)
{
    return mote_engine_open_two(&s->scenario->body[0], &s->scenario->body[1], choice,
                                MOTE_ASK_DISTANCE, tolerance_of(s), seed, probe);
}

static void measure_body(pair_stage *s, int i)
{
    const mote_mesh *mesh = s->scenario->body[i].mesh;
    for (uint32_t v = 0; v < mesh->vertex_count; ++v)
        s->radius[i] =
            fmax(s->radius[i], mote_distance_squared(mesh->positions[v], s->masses[i].centre));
    s->radius[i] = sqrt(s->radius[i]);
    const size_t numbers = (size_t)3 * s->scenario->body[i].field->padded;
    s->weights[i] = mote_allocate(numbers, sizeof(double));
    s->still[i] = mote_allocate(numbers, sizeof(double));
    s->before[i] = mote_allocate(numbers, sizeof(double));
}

mote_status mote_stage_pair_create(const mote_scenario *scenario,
                                   const mote_method_choice *choice,
                                   const mote_simulation_options *options,
                                   const mote_mass *masses, void **state)
{
    pair_stage *made = mote_allocate(1, sizeof *made);
    made->scenario = scenario;
    made->choice = *choice;
    made->options = options;
    made->masses = masses;
    made->said.body[1] = made->known.body[1] = 1;
    for (int i = 0; i < 2; ++i)
        measure_body(made, i);
    mote_method_choice exact;
    made->buffer = mote_frame_buffer_create(scenario);
    mote_status status = mote_method_choice_read(mote_simulation_exact_method(choice), &exact);
    if (status == MOTE_OK)
        status = create_probe(made, &exact, 1, &made->truth);
    if (status == MOTE_OK)
        *state = made;
    else
        pair_destroy(made);
    return status;
}

static mote_status pair_restart(void *state, const mote_simulation_start *start)
{
    pair_stage *s = state;
    mote_engine_destroy(s->method);
    s->method = NULL;
    s->first = start->first;
    s->lower = 0;
    return create_probe(s, &s->choice, start->seed, &s->method);
}

/* The frame whose deformation step k shows: forwards, then backwards, and so on. */
static double shown_place(const pair_stage *s, uint32_t k)
{
    if (s->scenario->frames == 1)
        return 1;
    const double last = s->scenario->frames - 1.0;
    const double place = fmod(s->first - 1.0 + k * s->options->time_step, 2 * last);
    return 1 + (place <= last ? place : 2 * last - place);
}

/* Turns the weights of body i from the pose that the scenario shows to the simulated one. */
static void turn_weights(pair_stage *s, int i, const mote_mat3 *shown)
{
    mote_body_state *body = &s->frame.body[i];
    const uint32_t padded = body->weights.padded;
    double *world = s->weights[i], *still = s->before[i];
    s->before[i] = s->still[i];
    s->still[i] = still;
    for (uint32_t j = 0; j < body->weights.count; ++j) {
        const mote_vec3 w = mote_rotate_back(
            shown, mote_vec3_make(body->weights.x[j], body->weights.y[j], body->weights.z[j]));
        const mote_vec3 turned = mote_rotate(&body->pose.rotation, w);
        memcpy(&still[(size_t)3 * j], &w, sizeof w);
        world[j] = turned.x;
        world[padded + j] = turned.y;
        world[2 * padded + j] = turned.z;
    }
    body->weights.x = world;
    body->weights.y = world + padded;
    body->weights.z = world + 2 * (size_t)padded;
}

/* The most that any point of body i has moved since the frame before: by its centre, by the
   turn, and by the deformation, basis functions being at most 1. */
static double moved(const pair_stage *s, int i)
{
    const mote_rigid_state *a = &s->previous[i], *b = &s->state[i];
    const mote_quaternion back = {a->turn.w, -a->turn.x, -a->turn.y, -a->turn.z};
    const mote_quaternion d = mote_quaternion_multiply(b->turn, back);
    const double chord = 2 * sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
    double radius = s->radius[i], shape = 0;
    const mote_vec3 *now = (const mote_vec3 *)(const void *)s->still[i];
    const mote_vec3 *then = (const mote_vec3 *)(const void *)s->before[i];
    for (uint32_t j = 0; j < s->scenario->body[i].field->count; ++j) {
        radius += mote_length(then[j]);
        shape += mote_length(mote_sub(now[j], then[j]));
    }
    return mote_length(mote_sub(b->centre, a->centre)) + chord * radius + shape;
}

static const mote_body_state *pair_show(void *state, uint32_t k, const mote_rigid_state *states)
{
    pair_stage *s = state;
    memcpy(s->previous, s->state, sizeof s->previous);
    memcpy(s->state, states, sizeof s->state);
    s->frame = *mote_scenario_frame_at(s->scenario, s->buffer, shown_place(s, k));
    s->frame.number = (uint64_t)k + 1;
    for (int i = 0; i < 2; ++i) {
        mote_body_state *body = &s->frame.body[i];
        const mote_mat3 shown = body->pose.rotation;
        body->pose = mote_rigid_pose(&s->masses[i], &states[i]);
        body->pose_changed = true;
        body->shape_changed = body->weights.count > 0 || k == 0;
        if (body->weights.count > 0)
            turn_weights(s, i, &shown);
    }
    if (k > 0)
        s->lower = fmax(0, s->lower - moved(s, 0) - moved(s, 1));
    return s->frame.body;
}

/* In processor time of this thread, since simulations run in parallel. */
static double now_ns(void)
{
    struct timespec t;
    (void)clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec * 1e9 + (double)t.tv_nsec;
}

static mote_status pair_ask_method(void *state, mote_stage_pairs *said, double *ns)
{
    pair_stage *s = state;
    mote_answer *answer = &s->said.answer;
    const double from = now_ns();
    const mote_status status = mote_engine_answer(s->method, &s->frame, answer);
    *ns += now_ns() - from;
    if (status != MOTE_OK)
        return status;
    if (!answer->has_contact && !answer->has_distance)
        return mote_fail(MOTE_EUNSUPPORTED, "%s gives neither distance nor contact",
                         s->choice.text);
    if (!answer->has_contact)
        answer->contact = answer->distance <= tolerance_of(s);
    *said = (mote_stage_pairs){&s->said, 1};
    return MOTE_OK;
}

static mote_status pair_ask_truth(void *state, mote_stage_pairs *truth, uint64_t *asked,
                                  double *lower)
{
    pair_stage *s = state;
    mote_status status = MOTE_OK;
    *truth = (mote_stage_pairs){NULL, 0};
    if (s->lower <= MOTE_SIMULATION_NEAR * s->scenario->length) {
        ++*asked;
        status = mote_engine_answer(s->truth, &s->frame, &s->known.answer);
        s->lower = s->known.answer.distance;
        s->known.answer.contact = s->lower <= tolerance_of(s);
        *truth = (mote_stage_pairs){&s->known, 1};
    }
    *lower = s->lower;
    return status;
}

static const mote_engine *pair_probe(const void *state)
{
    return ((const pair_stage *)state)->method;
}

const mote_stage_kind mote_stage_pair = {pair_destroy,    pair_restart,   pair_show,
                                         pair_ask_method, pair_ask_truth, pair_probe};
