/* ccd-convex: libccd on the convex parts of both bodies.

   Each part is replaced by the convex hull of its vertices, so the answer is approximate: it
   can be too small where a part is not quite convex, and with support=climb a climb may end
   early. Pairs of parts are visited in order of the distance of their centres. A pair that is
   not separated along the line of centres goes to libccd's GJK (contact) and, on request, to
   its EPA (penetration). libccd has no distance function: pairs that are apart are measured by
   our own GJK on the same support points (baselines/gjk.h). libccd's thresholds are absolute,
   so support points are scaled to unit size by a power of two. Its iterations are limited; its
   MPR, which ignores such a limit, is not used. */
#include "baselines/convex_part.h"
#include "baselines/gjk.h"
#include "baselines/input.h"

#include <ccd/ccd.h>
#include <stdlib.h>

enum { SUPPORT, PENETRATION, ITERATIONS, POSITIONS, PARAMETER_COUNT };

static const mote_parameter parameters[PARAMETER_COUNT] = {
    [SUPPORT] = {"support", MOTE_PARAMETER_CHOICE, 0, 0, "climb|scan", "climb",
                 "support points by hill-climbing over neighbours, or from all of a part's "
                 "vertices"},
    [PENETRATION] = {"penetration", MOTE_PARAMETER_CHOICE, 0, 0, "no|yes", "no",
                     "measure the penetration of intersecting parts by libccd's EPA"},
    [ITERATIONS] = {"iterations", MOTE_PARAMETER_INTEGER, 1, 1e6, NULL, "100",
                    "iterations of GJK and EPA at most, a pair of parts"},
    [POSITIONS] = {"positions", MOTE_PARAMETER_CHOICE, 0, 0, "deform|given", "deform",
                   "deform: pay for deforming all vertices; given: they come free of charge"},
};

/* A pair of parts; centres apart by distance_squared in this frame. */
typedef struct part_pair {
    uint32_t part[2];
    double distance_squared;
} part_pair;

typedef struct ccd_state {
    mote_convex_parts *parts[2];
    uint32_t vertex_count[2];
    part_pair *pairs;
    size_t pair_count;
    double scale;     /* brings L into [1, 2): a power of two */
    double tolerance; /* scaled */
    mote_ask ask;
    bool scan, penetration;
    unsigned iterations;
} ccd_state;

/* One part in one frame, as libccd and our GJK see it. */
typedef struct convex {
    const mote_convex_part *part;
    const mote_vec3 *positions;
    double scale;
    bool scan;
} convex;

static mote_vec3 support_point(const convex *c, mote_vec3 direction)
{
    uint32_t v = mote_convex_part_support(c->part, c->positions, direction, c->scan);
    return mote_scale(c->positions[v], c->scale);
}

static void ccd_support(const void *object, const ccd_vec3_t *direction, ccd_vec3_t *point)
{
    mote_vec3 p = support_point(
        object, mote_vec3_make(direction->v[0], direction->v[1], direction->v[2]));
    ccdVec3Set(point, p.x, p.y, p.z);
}

static mote_gjk_point gjk_support(void *context, mote_vec3 direction)
{
    const convex *both = context;
    return (mote_gjk_point){support_point(&both[0], direction),
                            support_point(&both[1], mote_scale(direction, -1))};
}

static mote_traits traits(const double *values)
{
    bool given = values[POSITIONS] > 0;
    return (mote_traits){.needs_vertices = !given, .given_vertices = given, .hulls = true};
}

static void destroy(void *state)
{
    ccd_state *s = state;
    if (!s)
        return;
    for (int b = 0; b < 2; ++b)
        mote_convex_parts_destroy(s->parts[b]);
    free(s->pairs);
    free(s);
}

static mote_status build(ccd_state *s, const mote_setup *setup)
{
    for (int b = 0; b < 2; ++b) {
        mote_status status = mote_convex_parts_create(setup->body[b]->mesh, &s->parts[b]);
        if (status != MOTE_OK)
            return status;
        s->vertex_count[b] = setup->body[b]->mesh->vertex_count;
    }
    const uint32_t columns = s->parts[1]->count;
    s->pair_count = (size_t)s->parts[0]->count * columns;
    s->pairs = calloc(s->pair_count, sizeof *s->pairs);
    if (!s->pairs)
        return mote_fail(MOTE_ENOMEM, "no memory for %zu pairs of parts", s->pair_count);
    for (size_t k = 0; k < s->pair_count; ++k) {
        s->pairs[k].part[0] = (uint32_t)(k / columns);
        s->pairs[k].part[1] = (uint32_t)(k % columns);
    }
    return MOTE_OK;
}

static mote_status create(const mote_setup *setup, void **state)
{
    mote_status status = mote_input_check(setup);
    if (status != MOTE_OK)
        return status;
    ccd_state *s = calloc(1, sizeof *s);
    if (!s)
        return mote_fail(MOTE_ENOMEM, "no memory for ccd-convex");
    s->scale = ldexp(1, -ilogb(setup->length));
    s->tolerance = setup->tolerance * s->scale;
    s->ask = setup->ask;
    s->scan = setup->values[SUPPORT] > 0;
    s->penetration = setup->values[PENETRATION] > 0;
    s->iterations = (unsigned)setup->values[ITERATIONS];
    status = build(s, setup);
    if (status == MOTE_OK)
        *state = s;
    else
        destroy(s);
    return status;
}

static mote_status update(void *state, const mote_frame *frame)
{
    const ccd_state *s = state;
    for (int b = 0; b < 2; ++b) {
        mote_status status =
            mote_input_check_vertices(frame->body[b].vertices, s->vertex_count[b], b);
        if (status != MOTE_OK)
            return status;
    }
    return MOTE_OK;
}

static int compare_pairs(const void *left, const void *right)
{
    const part_pair *a = left, *b = right;
    if (a->distance_squared != b->distance_squared)
        return a->distance_squared < b->distance_squared ? -1 : 1;
    if (a->part[0] != b->part[0])
        return a->part[0] < b->part[0] ? -1 : 1;
    return a->part[1] < b->part[1] ? -1 : 1;
}

static void sort_pairs(ccd_state *s, const mote_frame *frame)
{
    for (size_t k = 0; k < s->pair_count; ++k) {
        mote_vec3 centre[2];
        for (int b = 0; b < 2; ++b)
            centre[b] = mote_convex_part_centre(&s->parts[b]->part[s->pairs[k].part[b]],
                                                frame->body[b].vertices);
        s->pairs[k].distance_squared = mote_distance_squared(centre[0], centre[1]);
    }
    qsort(s->pairs, s->pair_count, sizeof *s->pairs, compare_pairs);
}

/* For boxes that meet face to face, EPA fails with a direction of NaN when it starts along an
   axis, as it does by default. */
static void skew_direction(const void *first, const void *second, ccd_vec3_t *direction)
{
    (void)first;
    (void)second;
    ccdVec3Set(direction, 0.8, 0.5, 0.3);
}

/* Keeps the deepest penetration and a point in the middle of it. */
static void measure_penetration(const convex both[2], const ccd_t *settings,
                                mote_answer *answer)
{
    ccd_t ccd = *settings;
    ccd.first_dir = skew_direction;
    ccd_real_t depth;
    ccd_vec3_t direction, position;
    if (ccdGJKPenetration(&both[0], &both[1], &ccd, &depth, &direction, &position) != 0)
        return;
    if (!isfinite(depth) || !isfinite(direction.v[0]) || !isfinite(position.v[0]))
        return;
    depth /= both[0].scale;
    if (answer->has_penetration && depth <= answer->penetration)
        return;
    answer->has_penetration = answer->has_witness = true;
    answer->penetration = depth;
    answer->witness[0] = answer->witness[1] = mote_scale(
        mote_vec3_make(position.v[0], position.v[1], position.v[2]), 1 / both[0].scale);
}

/* Lowers *best (scaled) by one pair of parts; 0 where libccd finds them to intersect. */
static void measure_pair(const ccd_state *s, const convex both[2], double *best,
                         mote_answer *answer)
{
    mote_vec3 start = mote_sub(mote_convex_part_centre(both[1].part, both[1].positions),
                               mote_convex_part_centre(both[0].part, both[0].positions));
    double length = mote_length(start);
    start = length > 0 ? mote_scale(start, 1 / length) : mote_vec3_make(1, 0, 0);
    convex context[2] = {both[0], both[1]};
    mote_gjk_point end = gjk_support(context, start);
    double gap = mote_dot(start, mote_sub(end.b, end.a));
    if (gap > 0 && gap >= *best)
        return;
    ccd_t ccd;
    CCD_INIT(&ccd);
    ccd.support1 = ccd.support2 = ccd_support;
    ccd.max_iterations = s->iterations;
    ccd.epa_tolerance = 1e-6; /* at the default, 1e-4, a depth of 0.04 came out as 0.008 */
    if (gap <= 0 && ccdGJKIntersect(&both[0], &both[1], &ccd)) {
        *best = 0;
        if (s->penetration)
            measure_penetration(both, &ccd, answer);
        return;
    }
    if (*best == 0 || (s->ask == MOTE_ASK_CONTACT && s->tolerance == 0))
        return;
    mote_gjk_result apart =
        mote_gjk_distance(gjk_support, context, start, *best, s->iterations);
    if (apart.distance >= *best)
        return;
    *best = apart.distance;
    answer->has_witness = true;
    for (int b = 0; b < 2; ++b)
        answer->witness[b] = mote_scale(apart.witness[b], 1 / s->scale);
}

static mote_status query(void *state, const mote_frame *frame, mote_answer *answer)
{
    ccd_state *s = state;
    sort_pairs(s, frame);
    double best = HUGE_VAL;
    bool contact_only = s->ask == MOTE_ASK_CONTACT;
    for (size_t k = 0; k < s->pair_count; ++k) {
        convex both[2];
        for (int b = 0; b < 2; ++b)
            both[b] = (convex){&s->parts[b]->part[s->pairs[k].part[b]], frame->body[b].vertices,
                               s->scale, s->scan};
        answer->counters.box_tests++;
        measure_pair(s, both, &best, answer);
        bool known = best == 0 || (contact_only && best <= s->tolerance);
        if (known && !s->penetration)
            break;
    }
    answer->has_contact = true;
    answer->contact = best <= s->tolerance;
    answer->has_distance = !contact_only;
    if (contact_only || (best == 0 && !answer->has_penetration))
        answer->has_witness = false;
    answer->distance = contact_only ? 0 : best / s->scale;
    return MOTE_OK;
}

MOTE_METHOD(ccd_convex) = {
    .name = "ccd-convex",
    .summary =
        "libccd on convex parts (HACD): contact, penetration; distance by our GJK; approximate",
    .parameters = parameters,
    .parameter_count = PARAMETER_COUNT,
    .traits = traits,
    .create = create,
    .destroy = destroy,
    .update = update,
    .query = query,
};
