/* How aabb-tree answers impacts: conservative advancement, as Mirtich described it (1996). At a
   time the trees are refitted and the exact distance is measured; no point can cover it before
   a time that follows from a bound of the speeds, and so on. Bounds of speeds are those of
   core/impact, by vertices in groups; directions are not looked at. */
#include "core/body/deform.h"
#include "core/body/path_place.h"
#include "core/impact/impact_state.h"
#include "core/method/impact_method.h"

#include <stdlib.h>

extern const mote_method mote_method_aabb_tree;

/* As the certified query: the bracket's width as a part of the time, and the moments after
   which it gives up. */
#define RESOLUTION 1e-6
#define MOMENTS_MAX 10000

/* What a distance may be wrong by, as a part of it. */
#define ROUNDING 1e-12

typedef struct advance {
    mote_setup setup;
    mote_impact_search *rates; /* for its bounds of speeds alone */
    void *trees;
    mote_deform *deform[2];
    mote_vec3 *world[2];
    double *weights[2];
    mote_frame frame;
    mote_impact_question question;
    double distance; /* at the last moment */
    mote_impact_answer *answer;
} advance;

static void destroy(void *state)
{
    advance *a = state;
    if (!a)
        return;
    mote_impact_destroy(a->rates);
    mote_method_aabb_tree.destroy(a->trees);
    for (int i = 0; i < 2; ++i) {
        mote_deform_destroy(a->deform[i]);
        free(a->world[i]);
        free(a->weights[i]);
    }
    free(a);
}

static mote_status build(advance *a, const mote_setup *setup, uint32_t pieces)
{
    mote_impact_options options = mote_default_impact_options(setup->length);
    options.pieces = pieces;
    mote_setup distance = *setup;
    distance.ask = MOTE_ASK_DISTANCE;
    mote_status status = mote_impact_create(setup->body, &options, &a->rates);
    if (status == MOTE_OK)
        status = mote_method_create(&mote_method_aabb_tree, &distance, &a->trees);
    for (int i = 0; i < 2 && status == MOTE_OK; ++i) {
        const mote_body *body = setup->body[i];
        a->world[i] = calloc(body->mesh->vertex_count, sizeof(mote_vec3));
        a->weights[i] = calloc(3 * (size_t)body->field->padded + 1, sizeof(double));
        if (!a->world[i] || !a->weights[i])
            return mote_fail(MOTE_ENOMEM, "no memory for impacts of aabb-tree");
        status = mote_deform_create(body, &a->deform[i]);
    }
    return status;
}

static mote_status create(const mote_setup *setup, uint32_t pieces, void **state)
{
    advance *made = calloc(1, sizeof *made);
    if (!made)
        return mote_fail(MOTE_ENOMEM, "no memory for impacts of aabb-tree");
    made->setup = *setup;
    const mote_status status = build(made, setup, pieces);
    if (status == MOTE_OK)
        *state = made;
    else
        destroy(made);
    return status;
}

/* Measures the distance at a time; *touch: whether it is at most the tolerance. */
static mote_status look_at(advance *a, double time, bool *touch)
{
    mote_answer at = {.has_distance = false};
    for (int i = 0; i < 2; ++i) {
        mote_body_state *body = &a->frame.body[i];
        mote_path_state(a->question.path[i], a->setup.body[i], time, a->weights[i], body);
        mote_deform_all(a->deform[i], body, a->world[i]);
        body->vertices = a->world[i];
    }
    ++a->frame.number;
    ++a->answer->iterations;
    mote_status status = mote_method_aabb_tree.update(a->trees, &a->frame);
    if (status == MOTE_OK)
        status = mote_method_aabb_tree.query(a->trees, &a->frame, &at);
    if (status != MOTE_OK)
        return status;
    a->answer->counters.box_tests += at.counters.box_tests;
    a->answer->counters.triangle_tests += at.counters.triangle_tests;
    a->distance = at.distance;
    *touch = at.distance <= a->setup.tolerance;
    if (*touch) {
        a->answer->has_witness = true;
        a->answer->witness[0] = at.witness[0];
        a->answer->witness[1] = at.witness[1];
    }
    return MOTE_OK;
}

/* What is left of the distance for the bodies to cover in piece k. */
static double gap_in(const advance *a, uint32_t k)
{
    const mote_impact_rate *rate = mote_impact_rate_of(a->rates, k);
    return a->distance * (1 - ROUNDING) - a->setup.tolerance - 2 * rate->noise -
           0x1p-48 * a->question.path[0]->count * rate->speed;
}

/* The time before which the bodies cannot touch, as the last distance, of `time`, shows. */
static double safe_until(const advance *a, double time)
{
    const uint32_t count = a->question.path[0]->count;
    mote_place at = mote_path_place(a->question.path[0], time);
    double gap = gap_in(a, at.piece);
    for (; at.piece < count; ++at.piece, at.u = 0) {
        const double speed = mote_impact_rate_of(a->rates, at.piece)->speed;
        const double needed = speed * (1 - at.u);
        if (!(gap > 0))
            return time;
        if (needed >= gap)
            return fmin((at.piece + (at.u + gap / speed)) / count, 1);
        gap -= needed;
    }
    return 1;
}

/* The same backwards: the time after which they did not touch. */
static double safe_since(const advance *a, double time)
{
    const uint32_t count = a->question.path[0]->count;
    mote_place at = mote_path_place(a->question.path[0], time);
    double gap = gap_in(a, at.piece);
    for (;; --at.piece, at.u = 1) {
        const double speed = mote_impact_rate_of(a->rates, at.piece)->speed;
        const double needed = speed * at.u;
        if (!(gap > 0))
            return time;
        if (needed >= gap)
            return fmax((at.piece + (at.u - gap / speed)) / count, 0);
        gap -= needed;
        if (at.piece == 0)
            return 0;
    }
}

static void found(advance *a, double from, double to)
{
    a->answer->answered = a->answer->impact = true;
    a->answer->from = from;
    a->answer->to = to;
}

/* Where steps are shorter than half of the bracket: looks ahead by its width. Sets *time to the
   moment of the last distance, up to which all is shown to be safe. */
static mote_status look_ahead(advance *a, double reached, double *time)
{
    bool touch;
    const double ahead = fmin(reached + RESOLUTION, 1);
    mote_status status = look_at(a, ahead, &touch);
    if (status == MOTE_OK && touch)
        found(a, reached, ahead);
    *time = ahead;
    if (status != MOTE_OK || touch || safe_since(a, ahead) <= reached)
        return status;
    *time = reached;
    status = look_at(a, reached, &touch);
    if (status == MOTE_OK && touch)
        found(a, reached, reached);
    return status;
}

static mote_status search(advance *a)
{
    double time = 0;
    bool touch;
    mote_status status = look_at(a, time, &touch);
    if (status == MOTE_OK && touch)
        found(a, 0, 0);
    while (status == MOTE_OK && !a->answer->answered) {
        const double reached = safe_until(a, time);
        if (reached >= 1) {
            a->answer->answered = true;
            a->answer->from = a->answer->to = 1;
        } else if (!(reached > time) || a->answer->iterations >= MOMENTS_MAX) {
            return MOTE_OK; /* grazing, or too many: not answered */
        } else if (reached - time < 0.5 * RESOLUTION) {
            status = look_ahead(a, reached, &time);
        } else {
            time = reached;
            status = look_at(a, time, &touch);
            if (status == MOTE_OK && touch)
                found(a, time, time);
        }
    }
    return status;
}

static mote_status query(void *state, const mote_path *const path[2],
                         mote_impact_answer *answer)
{
    advance *a = state;
    a->question = (mote_impact_question){
        .path = {path[0], path[1]}, .end = 1, .tolerance = a->setup.tolerance};
    mote_status status = mote_impact_check(a->rates, &a->question);
    if (status != MOTE_OK)
        return status;
    a->rates->question = &a->question;
    for (uint32_t k = 0; k < path[0]->count; ++k)
        a->rates->rates[k].known = false;
    a->answer = answer;
    return search(a);
}

MOTE_IMPACT(aabb_tree) = {
    .method = "aabb-tree", .create = create, .destroy = destroy, .query = query};
