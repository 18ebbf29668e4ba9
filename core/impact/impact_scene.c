#include "core/impact/impact_scene.h"

#include "core/body/path_place.h"
#include "core/certificate/pair_list.h"
#include "core/impact/impact_swept.h"
#include "core/stream/stream_boxes.h"

#include <stdlib.h>
#include <string.h>

/* A pair whose boxes come near each other. */
typedef struct near_pair {
    uint32_t body[2];
} near_pair;

struct mote_impact_scene {
    mote_impact_options options;
    mote_body *shapes; /* [shape_count] */
    uint32_t shape_count, body_count;
    uint32_t *shape_of;                /* [body_count] */
    mote_impact_search **searches;     /* [shapes][shapes], of the lower shape first */
    const mote_impact_groups **groups; /* of the shapes that have bodies */
    mote_scene_box *boxes;             /* [body_count] of a question */
    uint32_t *order; /* the bodies by the low ends of their boxes, kept from query to query */
    near_pair *near;
    size_t near_count, near_room;
};

static mote_status allocate(mote_impact_scene *s, const mote_body *const *shapes,
                            const uint32_t *shape_of)
{
    const size_t n = s->shape_count, bodies = s->body_count;
    s->shapes = calloc(n, sizeof *s->shapes);
    s->searches = calloc(n * n, sizeof(mote_impact_search *));
    s->groups = calloc(n, sizeof(const mote_impact_groups *));
    s->shape_of = malloc(bodies * sizeof *s->shape_of);
    s->boxes = calloc(bodies, sizeof *s->boxes);
    s->order = malloc(bodies * sizeof *s->order);
    if (!s->shapes || !s->searches || !s->groups || !s->shape_of || !s->boxes || !s->order)
        return mote_fail(MOTE_ENOMEM, "no memory for the impacts of %u bodies", s->body_count);
    for (size_t i = 0; i < n; ++i)
        s->shapes[i] = *shapes[i];
    memcpy(s->shape_of, shape_of, bodies * sizeof *shape_of);
    for (uint32_t i = 0; i < s->body_count; ++i)
        s->order[i] = i;
    return MOTE_OK;
}

/* The search for two bodies, by their shapes. */
static mote_impact_search **search_of(mote_impact_scene *s, uint32_t a, uint32_t b)
{
    const uint32_t low = a < b ? a : b, high = a < b ? b : a;
    return &s->searches[(size_t)low * s->shape_count + high];
}

static mote_status make_search(mote_impact_scene *s, uint32_t a, uint32_t b)
{
    mote_impact_search **search = search_of(s, a, b);
    if (*search)
        return MOTE_OK;
    const uint32_t low = a < b ? a : b, high = a < b ? b : a;
    const mote_body *const pair[2] = {&s->shapes[low], &s->shapes[high]};
    const mote_status status = mote_impact_create(pair, &s->options, search);
    if (status != MOTE_OK)
        return mote_fail(status, "shapes %u and %u: %s", low, high, mote_error_text());
    s->groups[low] = &(*search)->groups[0];
    s->groups[high] = &(*search)->groups[1];
    return MOTE_OK;
}

/* Searches for the shapes of all pairs of bodies: of any two shapes that have bodies, and of
   two bodies of one shape. */
static mote_status make_searches(mote_impact_scene *s)
{
    bool *has_body = calloc(s->shape_count, sizeof *has_body); /* one before body i */
    if (!has_body)
        return mote_fail(MOTE_ENOMEM, "no memory for %u shapes", s->shape_count);
    mote_status status = MOTE_OK;
    for (uint32_t i = 0; i < s->body_count; ++i) {
        for (uint32_t a = 0; a < s->shape_count && status == MOTE_OK; ++a) {
            if (has_body[a])
                status = make_search(s, a, s->shape_of[i]);
        }
        has_body[s->shape_of[i]] = true;
    }
    free(has_body);
    return status;
}

mote_status mote_impact_scene_create(const mote_body *const *shapes, uint32_t shape_count,
                                     const uint32_t *shape_of, uint32_t body_count,
                                     const mote_impact_options *options,
                                     mote_impact_scene **scene)
{
    const mote_scene_options plain = mote_default_scene_options();
    mote_status status = mote_scene_refuse_bad(shape_count, shape_of, body_count, &plain);
    if (status != MOTE_OK)
        return status;
    mote_impact_scene *made = calloc(1, sizeof *made);
    if (!made)
        return mote_fail(MOTE_ENOMEM, "no memory for the impacts of %u bodies", body_count);
    made->options = *options;
    made->shape_count = shape_count;
    made->body_count = body_count;
    status = allocate(made, shapes, shape_of);
    if (status == MOTE_OK && body_count == 1)
        status = make_search(made, shape_of[0], shape_of[0]); /* for its box */
    if (status == MOTE_OK)
        status = make_searches(made);
    if (status == MOTE_OK)
        *scene = made;
    else
        mote_impact_scene_destroy(made);
    return status;
}

void mote_impact_scene_destroy(mote_impact_scene *scene)
{
    if (!scene)
        return;
    const size_t n = scene->shape_count;
    for (size_t k = 0; scene->searches && k < n * n; ++k)
        mote_impact_destroy(scene->searches[k]);
    free(scene->searches);
    free(scene->shapes);
    free(scene->groups);
    free(scene->shape_of);
    free(scene->boxes);
    free(scene->order);
    free(scene->near);
    free(scene);
}

size_t mote_impact_scene_bytes(const mote_impact_scene *scene)
{
    const size_t n = scene->shape_count, bodies = scene->body_count;
    size_t bytes = sizeof *scene + n * (sizeof *scene->shapes + sizeof(void *)) +
                   n * n * sizeof(void *) + scene->near_room * sizeof *scene->near +
                   bodies * (2 * sizeof *scene->order + sizeof *scene->boxes);
    for (size_t k = 0; k < n * n; ++k)
        bytes += scene->searches[k] ? mote_impact_bytes(scene->searches[k]) : 0;
    return bytes;
}

static mote_status check_times(double begin, double end)
{
    if (begin >= 0 && begin <= end && end <= 1)
        return MOTE_OK;
    return mote_fail(MOTE_EINVAL,
                     "impacts are looked for from %g to %g; give two times within 0 and 1, the "
                     "earlier first",
                     begin, end);
}

/* A box around piece k of the path of body i. */
static mote_status box_of_piece(const mote_impact_scene *s, const mote_path *path, uint32_t i,
                                uint32_t k, mote_scene_box *box)
{
    const uint32_t shape = s->shape_of[i];
    mote_status status = MOTE_OK;
    if (path->positions) {
        for (uint32_t frame = k; frame <= k + 1 && status == MOTE_OK; ++frame)
            status = mote_stream_check(&path->positions[frame], (int)i);
        if (status == MOTE_OK)
            mote_impact_swept_lines(path, s->shapes[shape].mesh->vertex_count, k, box);
    } else {
        mote_impact_swept_box(s->groups[shape], &s->shapes[shape], path, k, box);
    }
    return status;
}

static mote_status box_of(const mote_impact_scene *s, const mote_path *paths, uint32_t i,
                          double begin, double end, mote_scene_box *box)
{
    const mote_path *path = &paths[i];
    if (path->count < 1 || path->count > s->options.pieces || path->count != paths[0].count)
        return mote_fail(MOTE_EINVAL,
                         "body %u: its path has %u pieces; give all bodies the same number, 1 "
                         "to %u",
                         i, path->count, s->options.pieces);
    const bool given = mote_body_is_given(&s->shapes[s->shape_of[i]]);
    if (given != (path->positions != NULL))
        return mote_fail(MOTE_EINVAL, "body %u: its path is to be one of %s, as its shape says",
                         i, given ? "positions" : "pieces");
    const uint32_t last = mote_path_place(path, end).piece;
    mote_vec3 low = {HUGE_VAL, HUGE_VAL, HUGE_VAL};
    mote_vec3 high = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    for (uint32_t k = mote_path_place(path, begin).piece; k <= last; ++k) {
        mote_scene_box part;
        const mote_status status = box_of_piece(s, path, i, k, &part);
        if (status != MOTE_OK)
            return status;
        const mote_vec3 size = mote_sub(part.high, part.low);
        if (!isfinite(size.x + size.y + size.z))
            return mote_fail(MOTE_EINVAL,
                             "body %u: a number in piece %u of its path is not "
                             "finite",
                             i, k);
        low = mote_vec3_make(fmin(low.x, part.low.x), fmin(low.y, part.low.y),
                             fmin(low.z, part.low.z));
        high = mote_vec3_make(fmax(high.x, part.high.x), fmax(high.y, part.high.y),
                              fmax(high.z, part.high.z));
    }
    *box = (mote_scene_box){low, high};
    return MOTE_OK;
}

mote_status mote_impact_scene_boxes(const mote_impact_scene *scene, const mote_path *paths,
                                    double begin, double end, mote_scene_box *boxes)
{
    mote_status status = check_times(begin, end);
    for (uint32_t i = 0; i < scene->body_count && status == MOTE_OK; ++i)
        status = box_of(scene, paths, i, begin, end, &boxes[i]);
    return status;
}

/* Whether body i comes before body j: by the low ends of their boxes along x, by their numbers
   where these are equal. */
static bool comes_before(const mote_impact_scene *s, uint32_t i, uint32_t j)
{
    const double a = s->boxes[i].low.x, b = s->boxes[j].low.x;
    return a < b || (!(a > b) && i < j);
}

/* Sorts by insertion, unless that takes more than so many moves. */
static bool insert_bodies(mote_impact_scene *s, uint64_t moves)
{
    for (uint32_t k = 1; k < s->body_count; ++k) {
        const uint32_t i = s->order[k];
        uint32_t to = k;
        for (; to > 0 && comes_before(s, i, s->order[to - 1]); --to)
            s->order[to] = s->order[to - 1];
        s->order[to] = i;
        if (k - to > moves)
            return false;
        moves -= k - to;
    }
    return true;
}

/* Moves the body at `from` down in a heap of the first count, the last of which is at the top.
 */
static void sift_down(mote_impact_scene *s, uint32_t from, uint32_t count)
{
    const uint32_t i = s->order[from];
    for (uint64_t child; (child = 2 * (uint64_t)from + 1) < count; from = (uint32_t)child) {
        if (child + 1 < count && comes_before(s, s->order[child], s->order[child + 1]))
            ++child;
        if (!comes_before(s, i, s->order[child]))
            break;
        s->order[from] = s->order[child];
    }
    s->order[from] = i;
}

/* Sorts in place, in n log n moves whatever the order is: a query does not allocate. */
static void heap_sort_bodies(mote_impact_scene *s)
{
    for (uint32_t k = s->body_count / 2; k > 0; --k)
        sift_down(s, k - 1, s->body_count);
    for (uint32_t k = s->body_count; k > 1; --k) {
        const uint32_t last = s->order[0];
        s->order[0] = s->order[k - 1];
        s->order[k - 1] = last;
        sift_down(s, 0, k - 1);
    }
}

/* The order of the last query is nearly right, so that insertion takes few moves; not at the
   first query, and after a leap. */
#define MOVES_A_BODY 16

static void sort_bodies(mote_impact_scene *s)
{
    if (!insert_bodies(s, (uint64_t)MOVES_A_BODY * s->body_count))
        heap_sort_bodies(s);
}

/* Whether two boxes are near each other across the direction of the sweep. */
static bool are_near_across(const mote_scene_box *a, const mote_scene_box *b, double tolerance)
{
    return a->low.y - b->high.y <= tolerance && b->low.y - a->high.y <= tolerance &&
           a->low.z - b->high.z <= tolerance && b->low.z - a->high.z <= tolerance;
}

static mote_status add_near(mote_impact_scene *s, uint32_t i, uint32_t j)
{
    if (s->near_count == s->near_room) {
        const size_t room = s->near_room ? 2 * s->near_room : 64;
        near_pair *block = realloc(s->near, room * sizeof *block);
        if (!block)
            return mote_fail(MOTE_ENOMEM, "no memory for %zu near pairs", room);
        s->near = block;
        s->near_room = room;
    }
    s->near[s->near_count++] = (near_pair){{i < j ? i : j, i < j ? j : i}};
    return MOTE_OK;
}

/* Sweeps along x. A little is added to the tolerance: differences are rounded. */
static mote_status find_near(mote_impact_scene *s, double tolerance)
{
    mote_status status = MOTE_OK;
    s->near_count = 0;
    sort_bodies(s);
    for (uint32_t k = 0; k < s->body_count; ++k) {
        const uint32_t i = s->order[k];
        const double size = fmax(fabs(s->boxes[i].low.x), fabs(s->boxes[i].high.x));
        const double wide = tolerance * (1 + 0x1p-40) + 0x1p-48 * size;
        for (uint32_t l = k + 1; l < s->body_count && status == MOTE_OK; ++l) {
            const uint32_t j = s->order[l];
            if (s->boxes[j].low.x - s->boxes[i].high.x > wide)
                break;
            if (are_near_across(&s->boxes[i], &s->boxes[j], wide))
                status = add_near(s, i, j);
        }
    }
    return status;
}

mote_status mote_impact_scene_pair(mote_impact_scene *scene, const mote_path *paths,
                                   const uint32_t body[2], double begin, double end,
                                   double tolerance, mote_impact_found *found)
{
    if (!(body[0] < body[1] && body[1] < scene->body_count))
        return mote_fail(MOTE_EINVAL,
                         "bodies %u and %u of %u; give two of them, the lower number first",
                         body[0], body[1], scene->body_count);
    const uint32_t a = scene->shape_of[body[0]], b = scene->shape_of[body[1]];
    const bool swap = a > b; /* the search has the lower shape first */
    const mote_impact_question question = {.path = {&paths[body[swap]], &paths[body[!swap]]},
                                           .begin = begin,
                                           .end = end,
                                           .tolerance = tolerance};
    mote_impact_found got;
    const mote_status status = mote_impact_query(*search_of(scene, a, b), &question, &got);
    if (status != MOTE_OK)
        return mote_fail(status, "bodies %u and %u: %s", body[0], body[1], mote_error_text());
    *found = got;
    if (swap) {
        found->witness[0] = got.witness[1];
        found->witness[1] = got.witness[0];
        found->normal = mote_scale(got.normal, -1);
    }
    return MOTE_OK;
}

static double tolerance_of(const mote_impact_scene_question *q, const uint32_t body[2])
{
    for (size_t k = 0; k < q->exception_count; ++k) {
        if (mote_pair_order(q->exceptions[k].body, body) == 0)
            return fmin(q->exceptions[k].tolerance, q->tolerance);
    }
    return q->tolerance;
}

/* Asks about a near pair until the earliest impact so far. */
static mote_status ask_pair(mote_impact_scene *s, const mote_impact_scene_question *q,
                            const uint32_t body[2], mote_impact_scene_found *first)
{
    const double tolerance = tolerance_of(q, body);
    const bool none = first->impact.outcome == MOTE_IMPACT_NONE;
    mote_impact_found found;
    if (tolerance < 0)
        return MOTE_OK;
    const mote_status status = mote_impact_scene_pair(s, q->paths, body, q->begin,
                                                      first->impact.from, tolerance, &found);
    if (status != MOTE_OK)
        return status;
    first->iterations += found.iterations;
    if (found.outcome == MOTE_IMPACT_NONE)
        return MOTE_OK;
    /* no later than the first: that is where the question ended */
    if (none || found.from < first->impact.from || mote_pair_order(body, first->body) < 0) {
        first->impact = found;
        memcpy(first->body, body, sizeof first->body);
    }
    return MOTE_OK;
}

mote_status mote_impact_scene_query(mote_impact_scene *scene,
                                    const mote_impact_scene_question *question,
                                    mote_impact_scene_found *found)
{
    mote_status status = MOTE_OK;
    if (!(question->tolerance >= 0 && question->tolerance < HUGE_VAL))
        status = mote_fail(MOTE_EINVAL, "a tolerance of %g; give a finite number of at least 0",
                           question->tolerance);
    if (status == MOTE_OK)
        status = mote_impact_scene_boxes(scene, question->paths, question->begin, question->end,
                                         scene->boxes);
    if (status == MOTE_OK)
        status = find_near(scene, question->tolerance);
    mote_impact_scene_found first = {.near_pairs = scene->near_count};
    first.impact.outcome = MOTE_IMPACT_NONE;
    first.impact.from = first.impact.to = question->end;
    for (size_t k = 0; k < scene->near_count && status == MOTE_OK; ++k)
        status = ask_pair(scene, question, scene->near[k].body, &first);
    if (status == MOTE_OK)
        *found = first;
    return status;
}
