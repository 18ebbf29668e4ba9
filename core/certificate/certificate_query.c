/* One certified query: a first upper bound, then the proof that nothing is nearer, started
   again whenever something is. */
#include "core/certificate/certificate_state.h"
#include "core/body/triangle.h"

#include <float.h>
#include <string.h>

mote_certificate_options mote_default_certificate_options(double length)
{
    return (mote_certificate_options){.length = length,
                                      .seed = MOTE_CERT_SEED_WITNESS,
                                      .budget = UINT64_MAX,
                                      .width = MOTE_CERT_WIDTH,
                                      .linear_fits = true,
                                      .plane = true,
                                      .directions = true,
                                      .restarts = 6,
                                      .threads = 1};
}

/* Where the last faces have moved apart by more than this part of L, others are looked for in
   the trees: sliding from that far away takes longer (on the scenario jump 73 us a query
   instead of 28). */
#define LEAP 0.1

/* A distance is promised to 1e-12 L; three times the noise is given up. */
#define PROMISED (1e-12 / 3)

/* To be proven: nothing is nearer than the limit. Pairs whose bound is at least the limit are
   skipped, so that the distance is proven to 1e-13 of itself. */
void mote_cert_set_best(mote_certificate *c, double squared)
{
    c->best.squared = squared;
    c->upper = sqrt(squared);
    double limit = (c->upper - c->slack) * c->scale * (1 - 1e-13);
    /* Where coordinates are so large that rounding hides more than is promised of a distance,
       no pair within it of the best is skipped. */
    if (c->enough < 0 && !(c->slack > 0) && c->noise > PROMISED * c->options.length * c->scale)
        limit = c->upper * c->scale + 4 * c->noise;
    if (c->enough >= 0) {
        /* just above the tolerance, so that a pair exactly at the tolerance is found */
        const double enough = c->enough * c->scale * (1 + 1e-13) + 4 * c->noise;
        limit = enough < limit ? enough : limit;
    }
    /* Where the bodies nearly touch, no bound may depend on rounding: all pairs that might
       touch are measured, so that contact is found whatever the query started from. */
    if (limit > 0 && limit < 8 * c->noise)
        limit = 8 * c->noise;
    c->limit = limit;
    c->need = (float)limit * (1 + 0x1p-22F) + 0x1p-60F;
    if (!(limit > 0) || c->upper <= c->enough)
        c->done = true;
}

/* A position of the first faces. A contact question of rigid bodies mostly ends with these, and
   keeping them would take longer than evaluating them does. */
static mote_vec3 first_position(mote_certificate *c, int s, uint32_t vertex)
{
    mote_cert_side *side = &c->side[s];
    if (c->enough < 0 || side->tree->body->field->count > 0)
        return mote_lazy_position(&side->lazy, vertex);
    ++c->counters.positions;
    return mote_body_position(side->tree->body, side->lazy.state, vertex);
}

/* Measures two faces, which become the best pair. */
static void measure_first(mote_certificate *c, const uint32_t (*first)[3])
{
    mote_vec3 t[2][3];
    for (int s = 0; s < 2; ++s) {
        memcpy(c->best.triangle[s], first[s], sizeof c->best.triangle[s]);
        for (int k = 0; k < 3; ++k)
            t[s][k] = first_position(c, s, first[s][k]);
    }
    ++c->counters.triangle_tests;
    c->best.squared =
        mote_triangle_triangle(t[0], t[1], &c->best.witness[0], &c->best.witness[1]);
}

/* Slides the best pair downhill; true when it comes nearer. Anything nearer that this misses is
   found by the traversal, which is rare: checking all faces around first takes longer. */
static bool slide_best(mote_certificate *c)
{
    mote_lazy *const lazy[2] = {&c->side[0].lazy, &c->side[1].lazy};
    const double enough = c->enough > 0 ? c->enough * c->enough : 0;
    const double before = c->best.squared;
    mote_refine_slide(lazy, enough, &c->best);
    c->counters.triangle_tests += c->best.triangle_tests;
    ++c->counters.refined;
    return c->best.squared < before;
}

/* Finds a near pair of faces by the trees alone, and slides it downhill. */
static void find_anew(mote_certificate *c, const mote_frame *frame)
{
    uint32_t vertex[2], face[2][3];
    const mote_vec3 middle = mote_scale(
        mote_add(frame->body[0].pose.translation, frame->body[1].pose.translation), 0.5);
    for (int s = 0; s < 2; ++s)
        mote_cert_side_begin(&c->side[s], &frame->body[s], middle);
    mote_cert_descend(c, vertex);
    for (int s = 0; s < 2; ++s) {
        /* the first two entries of a ring are always joined: no fan is without a face */
        const mote_mesh *mesh = c->side[s].tree->body->mesh;
        const uint32_t *ring = &mesh->ring[mesh->ring_start[vertex[s]]];
        face[s][0] = vertex[s];
        face[s][1] = MOTE_RING_VERTEX(ring[0]);
        face[s][2] = MOTE_RING_VERTEX(ring[1]);
    }
    measure_first(c, (const uint32_t(*)[3])face);
    (void)slide_best(c);
}

/* The first upper bound: from faces that may be near, or found in the trees. */
static void find_seed(mote_certificate *c, const mote_frame *frame, const uint32_t (*first)[3])
{
    const bool witness = c->options.seed == MOTE_CERT_SEED_WITNESS;
    for (int s = 0; s < 2; ++s)
        mote_lazy_begin(&c->side[s].lazy, &frame->body[s], false);
    if (!first && c->memory.has_last && c->options.seed != MOTE_CERT_SEED_NONE)
        first = (const uint32_t(*)[3])c->memory.last;
    if (first)
        measure_first(c, first);
    const bool leapt = first == (const uint32_t(*)[3])c->memory.last && witness &&
                       c->best.squared > c->memory.leap * c->memory.leap;
    if (!first || leapt)
        find_anew(c, frame);
    else if (witness && !c->memory.steady)
        (void)slide_best(c);
    else
        c->unrefined = witness && !c->memory.saddle;
}

/* Whether two faces, given by their vertices in any order, are the same. */
static bool same_face(const uint32_t a[3], const uint32_t b[3])
{
    for (int k = 0; k < 3; ++k) {
        if (a[k] != b[0] && a[k] != b[1] && a[k] != b[2])
            return false;
    }
    return true;
}

/* From witness 0 to witness 1, as a unit vector. Far from the world's origin witnesses are
   rounded by more than their distance may be: where nothing is left of it, any direction does.
 */
static mote_vec3 across(const mote_vec3 witness[2])
{
    const mote_vec3 gap = mote_sub(witness[1], witness[0]);
    const double inverse = 1 / mote_length(gap);
    return inverse < HUGE_VAL ? mote_scale(gap, inverse) : mote_vec3_make(1, 0, 0);
}

/* Sets two parallel planes across the gap, the limit apart: body 0 should lie behind the first,
   body 1 behind the second. The second follows from the first, not from its witness, so that
   they are the limit apart however witnesses are rounded. */
static void set_plane(mote_certificate *c)
{
    const mote_vec3 u = across(c->best.witness);
    const double spare = 0.5 * (c->upper * c->scale - c->limit);
    const double at = mote_dot(mote_sub(c->best.witness[0], c->origin), u) * c->scale + spare;
    mote_cert_side_face(&c->side[0], u, at);
    mote_cert_side_face(&c->side[1], mote_scale(u, -1), -c->limit - at);
    ++c->generation;
}

/* Whether both bodies are clear of the plane. A pair that was only measured is refined once its
   plane is crossed, which does not happen as long as it stays the nearest. */
static bool plane_clears(mote_certificate *c)
{
    while (!c->done) {
        const bool clear0 = mote_cert_plane_pass(c, 0);
        const bool clear1 = !c->crossed && mote_cert_plane_pass(c, 1);
        if (!c->crossed)
            return clear0 && clear1;
        c->crossed = c->unrefined = false;
        c->memory.saddle = !slide_best(c);
        if (c->memory.saddle)
            continue;
        mote_cert_set_best(c, c->best.squared);
        if (!c->done)
            set_plane(c);
    }
    return false;
}

/* Sets up both sides for a frame, around the origin. */
static void begin_sides(mote_certificate *c, const mote_frame *frame)
{
    for (int s = 0; s < 2; ++s)
        mote_cert_side_begin(&c->side[s], &frame->body[s], c->origin);
    c->noise = c->side[0].noise + c->side[1].noise;
}

/* The middle of a body at rest, where its pose places it. */
static mote_vec3 middle_of(const mote_certificate *c, const mote_frame *frame, int s)
{
    return mote_pose_apply(&frame->body[s].pose, c->side[s].tree->origin);
}

/* The point halfway between the middles of both bodies. */
static mote_vec3 between(const mote_certificate *c, const mote_frame *frame)
{
    return mote_scale(mote_add(middle_of(c, frame, 0), middle_of(c, frame, 1)), 0.5);
}

/* Coordinates that add up to less than this have squares and products that are floats. */
#define FARTHEST 0x1p59

/* Where coordinates leave the range of floats, nothing is searched for. What is left to say is
   how far the bodies' middles are apart along an axis, less how far each body reaches from its
   own: the bound of a side that begins there. */
static bool beyond_floats(mote_certificate *c, const mote_frame *frame, double *lower)
{
    if (c->side[0].bound + c->side[1].bound < FARTHEST)
        return false;
    const mote_vec3 middle[2] = {middle_of(c, frame, 0), middle_of(c, frame, 1)};
    double gap = mote_largest_coordinate(mote_sub(middle[1], middle[0])) * c->scale;
    gap *= 1 - 0x1p-40;
    for (int s = 0; s < 2; ++s) {
        mote_cert_side_begin(&c->side[s], &frame->body[s], middle[s]);
        gap -= c->side[s].bound + 0x1p-40 * (c->side[s].world + c->side[s].bound);
    }
    *lower = gap > 0 ? gap / c->scale : 0;
    c->stopped = true;
    return true;
}

/* Proves the limit; lowers the upper bound whenever something nearer is found. */
static void prove(mote_certificate *c)
{
    while (!c->done) {
        c->unvisited = DBL_MAX;
        c->proven = true;
        if (c->upper < HUGE_VAL) { /* else no pair is known, and both sides face each other */
            set_plane(c);
            if (c->options.plane && plane_clears(c))
                return;
        }
        if (!c->done)
            mote_cert_traverse(c);
        c->proven = !c->done;
        if (!c->improved)
            return;
        c->improved = c->done = false;
        ++c->restarts;
        if (slide_best(c))
            mote_cert_set_best(c, c->best.squared);
    }
}

static void begin(mote_certificate *c, double enough)
{
    memset(&c->counters, 0, sizeof c->counters);
    c->compared = 0;
    c->enough = enough;
    c->slack = c->options.slack * c->options.length;
    c->restarts = 0;
    c->done = c->improved = c->stopped = c->proven = false;
    c->unrefined = c->crossed = false;
    if (c->options.seed == MOTE_CERT_SEED_NONE)
        c->memory.has_direction = c->memory.parted = false;
    c->unvisited = DBL_MAX;
}

/* An upper bound where no pair was measured: the distance of a vertex of each body's last
   face. */
static void bound_by_vertices(mote_certificate *c, const mote_frame *frame)
{
    for (int s = 0; s < 2; ++s)
        c->best.witness[s] =
            mote_body_position(c->side[s].tree->body, &frame->body[s], c->best.triangle[s][0]);
    c->best.squared = mote_distance_squared(c->best.witness[0], c->best.witness[1]);
    c->upper = sqrt(c->best.squared);
    c->counters.positions += 2;
}

/* Keeps for the next query the pair of faces that this one ended with. */
static void remember(mote_certificate *c)
{
    mote_cert_memory *memory = &c->memory;
    memory->steady = memory->has_last && same_face(memory->last[0], c->best.triangle[0]) &&
                     same_face(memory->last[1], c->best.triangle[1]);
    memory->saddle = memory->saddle && memory->steady;
    memcpy(memory->last, c->best.triangle, sizeof memory->last);
    memory->has_last = true;
    memory->leap = c->upper + LEAP * c->options.length;
}

/* The proven lower bound. */
static double lower_bound(const mote_certificate *c)
{
    if (!c->proven)
        return 0;
    const double aim = (c->upper - c->slack) * c->scale * (1 - 1e-13);
    double lower = c->unvisited < c->limit ? c->unvisited : c->limit;
    lower = lower < aim ? lower : aim;
    lower = (lower - 3 * c->noise) / c->scale;
    return lower > 0 ? lower : 0;
}

static void write_answer(mote_certificate *c, uint64_t evaluated, double lower,
                         mote_certificate_answer *answer)
{
    answer->distance = c->upper;
    answer->lower = lower;
    answer->witness[0] = c->best.witness[0];
    answer->witness[1] = c->best.witness[1];
    answer->stopped = c->stopped;
    answer->counters = c->counters;
    answer->counters.positions +=
        c->side[0].lazy.evaluated + c->side[1].lazy.evaluated - evaluated;
}

/* Finds a first upper bound and proves from there. Returns the proven lower bound. */
static double search_from_seed(mote_certificate *c, const mote_frame *frame,
                               const uint32_t (*first)[3])
{
    double lower = 0;
    find_seed(c, frame, first);
    c->upper = sqrt(c->best.squared);
    if (c->upper > c->enough) { /* else it is the contact that was asked for */
        c->origin = mote_scale(mote_add(c->best.witness[0], c->best.witness[1]), 0.5);
        begin_sides(c, frame);
        if (!beyond_floats(c, frame, &lower)) {
            mote_cert_set_best(c, c->best.squared);
            prove(c);
            lower = lower_bound(c);
        }
    }
    remember(c);
    mote_cert_remember_parting(c, lower);
    return lower;
}

/* A contact question after one that showed the bodies to be apart. No upper bound is looked for
   first: it would cost more than most of these proofs do, and they do not need one. */
static double search_apart(mote_certificate *c, const mote_frame *frame)
{
    double lower;
    memcpy(c->best.triangle, c->memory.last, sizeof c->best.triangle);
    if (mote_cert_rest_apart(c, frame, &lower)) {
        bound_by_vertices(c, frame);
        return lower;
    }
    c->origin = between(c, frame);
    for (int s = 0; s < 2; ++s)
        mote_lazy_begin(&c->side[s].lazy, &frame->body[s], false);
    begin_sides(c, frame);
    mote_cert_set_best(c, HUGE_VAL);
    if (!beyond_floats(c, frame, &lower) && !mote_cert_still_apart(c, &lower)) {
        prove(c);
        lower = lower_bound(c);
    }
    if (c->upper < HUGE_VAL) {
        remember(c);
        mote_cert_remember_parting(c, lower);
    } else {
        c->memory.parted = lower > c->enough;
        bound_by_vertices(c, frame);
    }
    return lower;
}

void mote_certificate_query(mote_certificate *c, const mote_frame *frame,
                            const uint32_t (*first)[3], double enough,
                            mote_certificate_answer *answer)
{
    const uint64_t evaluated = c->side[0].lazy.evaluated + c->side[1].lazy.evaluated;
    begin(c, enough);
    const bool parted = enough >= 0 && c->memory.parted;
    const double lower = parted ? search_apart(c, frame) : search_from_seed(c, frame, first);
    write_answer(c, evaluated, lower, answer);
}

void mote_certificate_report(const mote_certificate_answer *bracket, mote_ask ask,
                             double tolerance, bool decides, mote_answer *answer)
{
    const bool contact_only = ask == MOTE_ASK_CONTACT;
    answer->distance = bracket->distance;
    answer->lower = bracket->lower;
    answer->witness[0] = bracket->witness[0];
    answer->witness[1] = bracket->witness[1];
    answer->contact = bracket->distance <= tolerance;
    /* A contact question ends before the distance is known. */
    answer->has_distance = !contact_only;
    answer->has_witness = !contact_only || answer->contact;
    answer->has_lower = true;
    /* Where the tolerance lies between the bounds, contact is not decided. */
    answer->has_contact =
        answer->contact || bracket->lower > tolerance || (decides && !bracket->stopped);
    mote_counters *sum = &answer->counters;
#define ADD(name) sum->name += bracket->counters.name;
    MOTE_COUNTERS(ADD)
    MOTE_COUNTERS_MORE(ADD)
#undef ADD
}
