/* The method auto: certified or stream, whichever the counters of the first frames say is
   faster. Certified wins where a field bends a body gently. Where it bends it strongly, boxes
   that are deformed with it are loose, and deforming every vertex and streaming takes less time
   (scenario twist), and where surfaces are parallel, they rule out little (flat). Where no
   field is known, only stream can answer. */
#include "core/body/deform.h"
#include "core/certificate/certificate_shared.h"
#include "core/stream/stream.h"

#include <math.h>
#include <stdlib.h>

enum { P_POSITIONS, P_COUNT };

static const mote_parameter parameters[] = {
    [P_POSITIONS] = {.key = "positions",
                     .kind = MOTE_PARAMETER_CHOICE,
                     .choices = "deform|given",
                     .fallback = "deform",
                     .help = "deform: pay for deforming all vertices where that is chosen; "
                             "given: they come free of charge"},
};

enum { CERTIFIED, STREAM };

/* Frames of which the median is the cost of the method that answers: a leap costs both alike,
   but a mean would count it against the one that answered then. The other is tried when it may
   be faster than most of them, and not before there are as many after a change. */
#define WINDOW 8

/* A method takes over where it takes less than this part of the other one's time. With these
   numbers and those below, no one of 23 scenarios takes more than 1.14 times as long as with
   the better method, also where the costs of stream are 15 % off. */
static const double share[2] = {[CERTIFIED] = 1, [STREAM] = 0.7};

/* Frames after which the last measurement of the method that does not answer is too old. This
   many at first, and twice as many each time that the method is tried in vain, up to the
   longest. */
#define MEMORY 24
#define LONGEST_MEMORY (64 * MEMORY)

typedef struct auto_state {
    mote_setup setup;
    bool given;                    /* positions of all vertices come with each frame */
    bool fixed;                    /* a body has no field: there is no choice */
    mote_certificate *certificate; /* NULL where it is fixed */
    mote_stream *stream;
    mote_deform *deform[2]; /* NULL where positions are given */
    mote_vec3 *vertices[2];
    bool deformed;                /* the last frame was deformed */
    int current;                  /* the method that answers */
    bool trial;                   /* ... for two frames, the second of which is measured */
    bool cold;                    /* the first frame after a change, which is not measured */
    double known[2];              /* cost of each when it was last measured, or a floor */
    double cost[WINDOW];          /* of the last frames, that of frame k at k modulo WINDOW */
    uint32_t frames;              /* measured since the last change */
    uint32_t age;                 /* frames since the other method was measured */
    uint32_t memory;              /* age at which that is too old */
    mote_certificate_answer last; /* of the frame before */
    bool answered;                /* there is one */
} auto_state;

/* Functions that are evaluated for a vertex. */
static double functions_at(const mote_body *body)
{
    return body->field->kind->sparse ? body->field->most : body->field->padded;
}

/* Nanoseconds by counters, fitted to the time of single frames of 21 built-in scenarios of two
   bodies (AVX-512, hot caches). Of their medians, stream's are met to 25 % in 19 and
   certified's in 14; single frames of a scenario scatter by 25 %. Without the pairs of leaves
   that are compared face by face, which are most of the time of flat's slow frames, by 37 %. */
static double certified_cost(const auto_state *s, const mote_counters *c)
{
    const double functions =
        fmax(functions_at(s->setup.body[0]), functions_at(s->setup.body[1]));
    return (60 + 1.7 * functions) * (double)c->blocks + 23.0 * (double)c->rows +
           70.0 * (double)c->leaf_pairs +
           1200.0 * (double)mote_certificate_compared(s->certificate) +
           140.0 * (double)c->triangle_tests + (16 + 2.2 * functions) * (double)c->positions;
}

static double stream_cost(const mote_counters *c)
{
    return 350.0 * (double)c->blocks + 50.0 * (double)c->rows + 130.0 * (double)c->leaf_pairs +
           840.0 * (double)c->triangle_tests + 0.54 * (double)c->positions;
}

/* The same of deforming a body: 0.6 ns a vertex, and 0.3 ns for each function there. */
static double deform_cost(const mote_body *body)
{
    return body->mesh->vertex_count * (0.6 + 0.3 * functions_at(body));
}

static bool has_changed(const mote_body_state *body)
{
    return body->shape_changed || body->pose_changed;
}

/* What a streamed frame costs at least: deforming, a pass and the least query. */
static double floor_of(const auto_state *s, const mote_frame *frame)
{
    double cost = 1500;
    for (int b = 0; b < 2; ++b) {
        const mote_body *body = s->setup.body[b];
        if (!has_changed(&frame->body[b]))
            continue;
        cost += 0.6 * body->mesh->vertex_count;
        if (!s->given)
            cost += deform_cost(body);
    }
    return cost;
}

static mote_traits traits(const double *values)
{
    return (mote_traits){.uses_field = true,
                         .given_vertices = values[P_POSITIONS] > 0,
                         .keeps_state = true,
                         .exact = true};
}

static void destroy(void *state)
{
    auto_state *s = state;
    if (!s)
        return;
    mote_certificate_destroy(s->certificate);
    mote_stream_destroy(s->stream);
    for (int b = 0; b < 2; ++b) {
        mote_deform_destroy(s->deform[b]);
        free(s->vertices[b]);
    }
    free(s);
}

/* What a body needs whose vertices are not given: memory for them, and their deformation. */
static mote_status build_vertices(auto_state *s, int b)
{
    const mote_body *body = s->setup.body[b];
    if (s->given || mote_body_is_given(body))
        return MOTE_OK;
    s->vertices[b] = malloc(body->mesh->vertex_count * sizeof *s->vertices[b]);
    if (!s->vertices[b])
        return mote_fail(MOTE_ENOMEM, "no memory for %u vertices", body->mesh->vertex_count);
    return mote_deform_create(body, &s->deform[b]);
}

static mote_status build_stream(auto_state *s)
{
    const mote_stream_options options = mote_default_stream_options(s->setup.length);
    mote_status status = build_vertices(s, 0);
    if (status == MOTE_OK)
        status = build_vertices(s, 1);
    return status == MOTE_OK ? mote_stream_create(s->setup.body, &options, &s->stream) : status;
}

static mote_status create(const mote_setup *setup, void **state)
{
    auto_state *made = calloc(1, sizeof *made);
    if (!made)
        return mote_fail(MOTE_ENOMEM, "no memory for auto");
    made->setup = *setup;
    made->given = setup->values[P_POSITIONS] > 0;
    made->fixed = mote_body_is_given(setup->body[0]) || mote_body_is_given(setup->body[1]);
    made->current = made->fixed ? STREAM : CERTIFIED;
    made->cold = true;
    made->memory = MEMORY;
    made->age = MEMORY; /* stream's cost is a floor at first */
    const mote_certificate_options options = mote_default_certificate_options(setup->length);
    mote_status status = build_stream(made);
    if (status == MOTE_OK && !made->fixed)
        status = mote_certificate_create(setup->body, &options, &made->certificate);
    if (status == MOTE_OK)
        *state = made;
    else
        destroy(made);
    return status;
}

static mote_status ask_stream(auto_state *s, const mote_frame *frame, double enough,
                              mote_certificate_answer *answer)
{
    mote_stream_frame now;
    for (int b = 0; b < 2; ++b) {
        const mote_body_state *body = &frame->body[b];
        now.unchanged[b] = s->deformed && !has_changed(body);
        if (s->deform[b] && !now.unchanged[b])
            mote_deform_all(s->deform[b], body, s->vertices[b]);
        now.positions[b] = mote_positions_of(s->deform[b] ? s->vertices[b] : body->vertices);
    }
    const mote_status status = mote_stream_query(s->stream, &now, enough, answer);
    s->deformed = status == MOTE_OK;
    return status;
}

static void change(auto_state *s, bool trial)
{
    s->current = 1 - s->current;
    s->trial = trial;
    s->deformed = false;
    s->cold = true;
    s->frames = 0;
    s->age = 0;
}

/* Whether most of the last frames cost more than the other method may. */
static bool is_dear(const auto_state *s)
{
    const double least = s->known[1 - s->current] / share[1 - s->current];
    uint32_t above = 0;
    for (size_t i = 0; i < WINDOW; ++i)
        above += s->cost[i] > least;
    return above > WINDOW / 2;
}

static double median_of(const double cost[WINDOW])
{
    double sorted[WINDOW];
    for (size_t i = 0; i < WINDOW; ++i) {
        size_t at = i;
        for (; at > 0 && sorted[at - 1] > cost[i]; --at)
            sorted[at] = sorted[at - 1];
        sorted[at] = cost[i];
    }
    return 0.5 * (sorted[WINDOW / 2 - 1] + sorted[WINDOW / 2]);
}

/* Ends a trial, by what its frame cost. */
static void judge(auto_state *s, double cost)
{
    s->known[s->current] = cost;
    s->trial = false;
    if (cost < share[s->current] * s->known[1 - s->current]) {
        s->memory = MEMORY;
        return;
    }
    if (s->memory < LONGEST_MEMORY)
        s->memory *= 2;
    change(s, false);
}

static void count_frame(auto_state *s, const mote_frame *frame, const mote_counters *counters)
{
    ++s->age;
    if (s->cold) {
        s->cold = false;
        return;
    }
    double cost = s->current == CERTIFIED ? certified_cost(s, counters) : stream_cost(counters);
    for (int b = 0; b < 2 && s->current == STREAM; ++b) {
        if (s->deform[b] && has_changed(&frame->body[b]))
            cost += deform_cost(s->setup.body[b]);
    }
    if (s->trial) {
        judge(s, cost);
        return;
    }
    s->cost[s->frames++ % WINDOW] = cost;
    if (s->frames < WINDOW)
        return;
    if (s->age > s->memory)
        s->known[1 - s->current] = s->current == CERTIFIED ? floor_of(s, frame) : 500;
    if (!is_dear(s))
        return;
    s->known[s->current] = median_of(s->cost);
    change(s, true);
}

static mote_status ask(auto_state *s, const mote_frame *frame)
{
    const double enough = s->setup.ask == MOTE_ASK_CONTACT ? s->setup.tolerance : -1;
    mote_status status = MOTE_OK;
    if (s->current == CERTIFIED)
        mote_certificate_query(s->certificate, frame, NULL, enough, &s->last);
    else
        status = ask_stream(s, frame, enough, &s->last);
    s->answered = status == MOTE_OK;
    if (status == MOTE_OK && !s->fixed)
        count_frame(s, frame, &s->last.counters);
    return status;
}

/* Where nothing has changed, the last answer stands. */
static mote_status query(void *state, const mote_frame *frame, mote_answer *answer)
{
    auto_state *s = state;
    mote_status status = MOTE_OK;
    if (!s->answered || has_changed(&frame->body[0]) || has_changed(&frame->body[1]))
        status = ask(s, frame);
    else
        s->last.counters = (mote_counters){0};
    if (status == MOTE_OK)
        mote_certificate_report(&s->last, s->setup.ask, s->setup.tolerance, true, answer);
    return status;
}

/* Not `auto`, which is a word of C. */
MOTE_METHOD(auto) = {
    .name = "auto",
    .summary = "certified or stream, by the counters of the first frames",
    .parameters = parameters,
    .parameter_count = P_COUNT,
    .traits = traits,
    .create = create,
    .destroy = destroy,
    .query = query,
};
