/* The method auto: certified or stream, whichever the counters of the first frames say is
   faster. Certified wins where a field bends a body gently. Where it bends it strongly, boxes
   that are deformed with it are loose, and deforming every vertex and streaming takes less time
   (scenario twist). Where no field is known, only stream can answer. */
#include "core/body/deform.h"
#include "core/certificate/certificate.h"
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

/* Frames of which the median is the cost of a method: a leap costs both alike, but the mean of
   a window would count it against the one that answered then. */
#define WINDOW 8

/* Frames of a trial. Where the other method takes three times as long, trials of eight frames
   were half of what auto lost on scenario twist. */
#define TRIAL 4

/* A method takes over where it takes less than this part of the other one's time. */
#define PREFERRED 0.9

/* Frames between two trials; and those in which what a streamed query needs may be built, so
   that later ones allocate nothing. */
#define PATIENCE 64
#define BUILDING 48

/* Frames after which the last measurement of the method that does not answer is too old. This
   many at first, and twice as many each time that the method is tried in vain. */
#define MEMORY 32
#define LONGEST_MEMORY 1024

typedef struct auto_state {
    mote_setup setup;
    bool given;                    /* positions of all vertices come with each frame */
    bool fixed;                    /* a body has no field: there is no choice */
    mote_certificate *certificate; /* NULL where it is fixed */
    mote_stream *stream;           /* NULL until it is tried */
    mote_deform *deform[2];        /* NULL where positions are given */
    mote_vec3 *vertices[2];
    bool deformed;   /* the last frame was deformed */
    int current;     /* the method that answers */
    bool trial;      /* ... for TRIAL frames */
    double known[2]; /* cost of each when it was last measured; of stream at first a floor */
    double cost[WINDOW]; /* of the window's frames, ascending */
    uint32_t frames;     /* in the window; the first after a change is cold and not counted */
    uint32_t wait;       /* frames until the next trial */
    uint32_t age;        /* frames since the other method was measured */
    uint32_t memory;     /* age at which that is too old */
    uint64_t asked;      /* frames in all */
    mote_certificate_answer last; /* of the frame before */
    bool answered;                /* there is one */
} auto_state;

/* Functions that are evaluated for a vertex. */
static double functions_at(const mote_body *body)
{
    return body->field->kind->sparse ? body->field->most : body->field->padded;
}

/* Nanoseconds by counters, fitted to the logarithm of the time of single frames of the built-in
   scenarios of two bodies below 100,000 triangles (AVX-512, hot caches). Of 32 medians,
   stream's are met to 25 % in 24 and certified's in 20. */
static double certified_cost(const auto_state *s, const mote_counters *c)
{
    const double functions =
        fmax(functions_at(s->setup.body[0]), functions_at(s->setup.body[1]));
    return 100 + (25 + 4 * functions) * (double)c->blocks + 67.0 * (double)c->rows +
           100.0 * (double)c->leaf_pairs + 230.0 * (double)c->triangle_tests +
           (8 + functions) * (double)c->positions;
}

static double stream_cost(const mote_counters *c)
{
    return 100 + 350.0 * (double)c->blocks + 150.0 * (double)c->leaf_pairs +
           700.0 * (double)c->triangle_tests + 0.56 * (double)c->positions;
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
        if (!s->given && !mote_body_is_given(body))
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
    made->wait = WINDOW;
    made->memory = MEMORY;
    const mote_certificate_options options = mote_default_certificate_options(setup->length);
    mote_status status =
        made->fixed ? build_stream(made)
                    : mote_certificate_create(setup->body, &options, &made->certificate);
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
    s->frames = 0;
    s->wait = PATIENCE;
    s->age = 0;
}

/* Decides at the end of a window who answers the next frames. */
static mote_status decide(auto_state *s, double cost)
{
    s->known[s->current] = cost;
    s->frames = 1;
    const int before = s->trial ? 1 - s->current : s->current;
    const int better =
        s->known[1 - before] < PREFERRED * s->known[before] ? 1 - before : before;
    if (s->trial || better == s->current) {
        if (s->trial && better == s->current)
            s->memory = MEMORY;
        else if (s->trial && s->memory < LONGEST_MEMORY)
            s->memory *= 2;
        if (better != s->current)
            change(s, false);
        s->trial = false;
        return MOTE_OK;
    }
    if (s->wait > 0 || (!s->stream && s->asked > BUILDING))
        return MOTE_OK;
    const mote_status status = s->stream ? MOTE_OK : build_stream(s);
    if (status == MOTE_OK)
        change(s, true);
    return status;
}

/* Adds a frame to the window. */
static void add_cost(auto_state *s, double cost)
{
    uint32_t at = s->frames++ - 1;
    for (; at > 0 && s->cost[at - 1] > cost; --at)
        s->cost[at] = s->cost[at - 1];
    s->cost[at] = cost;
}

static mote_status count_frame(auto_state *s, const mote_frame *frame,
                               const mote_counters *counters)
{
    ++s->asked;
    s->wait -= s->wait > 0;
    if (s->age++ >= s->memory || !s->stream)
        s->known[1 - s->current] = s->current == CERTIFIED ? floor_of(s, frame) : 500;
    if (s->frames == 0) {
        s->frames = 1;
        return MOTE_OK;
    }
    double cost = s->current == CERTIFIED ? certified_cost(s, counters) : stream_cost(counters);
    for (int b = 0; b < 2 && s->current == STREAM; ++b) {
        if (s->deform[b] && has_changed(&frame->body[b]))
            cost += deform_cost(s->setup.body[b]);
    }
    add_cost(s, cost);
    const uint32_t count = s->trial ? TRIAL : WINDOW;
    return s->frames > count ? decide(s, 0.5 * (s->cost[count / 2 - 1] + s->cost[count / 2]))
                             : MOTE_OK;
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
        status = count_frame(s, frame, &s->last.counters);
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
