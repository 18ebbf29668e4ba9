/* Everything is measured along the line between the two current witnesses: the height of a
   point is how far it lies beyond its own body's witness, towards the other's. A pair of faces
   can only be nearer than the distance d of the witnesses if their heights add up to more than
   0, which rejects nearly all faces before any of them is looked at closely. */
#include "core/particle/refine.h"

#include "core/body/triangle.h"

#include <math.h>
#include <string.h>

/* A pair counts as nearer only if it is by more than this part of the distance. */
#define MARGIN 1e-12

/* A height may be wrong by this part of the witnesses' coordinates: faces that touch are not
   rejected by it. */
#define ROUNDING 0x1p-50

/* Alternate projection continues while it reduces the squared distance by this part. */
#define WORTHWHILE 0.5

/* Far more rounds than any search needs on a mesh of millions; a limit in case of rounding. */
#define ROUNDS_MAX 10000

/* A search from two vertices may gain this many times what their rings alone can. With n = 8
   on ww and comb, 1 and 4 give as many exact frames, with 6 % fewer and 4 % more positions on
   comb. */
#define SLIDE_MAX 2

#define NONE UINT32_MAX

/* Faces kept at a time; longer lists are processed in pieces. */
#define LIST_MAX 32

typedef struct search {
    mote_lazy *const *lazy;
    mote_refined *best;
    double worth_squared; /* pairs of faces that are not nearer than this are ignored */
    double enough_squared;
    /* Set by aim: */
    double distance;
    mote_vec3 origin[2], toward[2]; /* the witness of each side, the unit vector to the other */
    mote_vec3 across[2];            /* unit vectors at right angles to it and each other */
    double rounding;                /* of a height */
    uint32_t checked[2]; /* vertices whose rings have been measured against each other with no
                            nearer pair; NONE: there are none */
    double slack; /* faces with heights that sum up to no more than this are not nearer */
} search;

/* Walks over the faces around up to three vertices, each once. */
typedef struct face_cursor {
    const mote_mesh *mesh;
    const uint32_t *centres;
    uint32_t count, index; /* of centres */
    uint32_t k;            /* ring entry */
    bool opened;           /* the centre's own position is known */
    bool carried;          /* corner 2 of the last face is corner 1 of this one */
    uint32_t vertex[3];
    mote_vec3 corner[3];
    double height[3];
} face_cursor;

/* A face with its height and, once it was chosen, the box of its shadow: where it is across the
   line of the witnesses. */
typedef struct listed_face {
    mote_vec3 corner[3];
    uint32_t vertex[3];
    double height;
    bool measured; /* with those of the other side that are marked too */
    bool boxed;
    double low[2], high[2]; /* of its shadow along the line of the witnesses */
    double blur;            /* how wrong they, and the height, may be */
} listed_face;

typedef struct face_list {
    listed_face face[LIST_MAX];
    uint32_t count;
    double height; /* the largest */
    uint32_t chosen[LIST_MAX], chosen_count;
} face_list;

static double max2(double x, double y)
{
    return x > y ? x : y;
}

static double min2(double x, double y)
{
    return x < y ? x : y;
}

static bool done(const search *s)
{
    return s->best->squared <= s->enough_squared;
}

/* A unit vector at right angles to another. */
static mote_vec3 perpendicular(mote_vec3 u)
{
    const mote_vec3 v =
        fabs(u.x) < fabs(u.y) ? mote_vec3_make(0, -u.z, u.y) : mote_vec3_make(u.z, 0, -u.x);
    return mote_scale(v, 1 / mote_length(v));
}

static void aim(search *s)
{
    const mote_refined *best = s->best;
    s->distance = sqrt(best->squared);
    const mote_vec3 u =
        mote_scale(mote_sub(best->witness[1], best->witness[0]), 1 / s->distance);
    s->origin[0] = best->witness[0];
    s->origin[1] = best->witness[1];
    s->toward[0] = u;
    s->toward[1] = mote_scale(u, -1);
    s->across[0] = perpendicular(u);
    s->across[1] = mote_cross(u, s->across[0]);
    s->rounding = ROUNDING * (mote_largest_coordinate(s->origin[0]) +
                              mote_largest_coordinate(s->origin[1]));
    s->slack = MARGIN * s->distance - s->rounding;
}

/* Keeps the aim, and restricts the search to faces that could come below a squared distance. */
static void tighten(search *s, double squared)
{
    s->slack = s->distance - (1 - MARGIN) * sqrt(squared) - s->rounding;
}

static double height_of(const search *s, int side, mote_vec3 p)
{
    return mote_dot(mote_sub(p, s->origin[side]), s->toward[side]);
}

static void look_at(const search *s, int side, face_cursor *c, int i, uint32_t vertex)
{
    c->vertex[i] = vertex;
    c->corner[i] = mote_lazy_position(s->lazy[side], vertex);
    c->height[i] = height_of(s, side, c->corner[i]);
}

static face_cursor cursor_at(const search *s, int side, const uint32_t *centres, uint32_t count)
{
    const mote_mesh *mesh = s->lazy[side]->body->mesh;
    return (face_cursor){
        .mesh = mesh, .centres = centres, .count = count, .k = mesh->ring_start[centres[0]]};
}

/* True if the face is around a centre that comes earlier. */
static bool seen_before(const face_cursor *c)
{
    for (uint32_t i = 0; i < c->index; ++i) {
        if (c->vertex[1] == c->centres[i] || c->vertex[2] == c->centres[i])
            return true;
    }
    return false;
}

/* Steps to the next face; false after the last. */
static bool next_face(const search *s, int side, face_cursor *c)
{
    while (c->index < c->count) {
        const uint32_t centre = c->centres[c->index];
        const uint32_t first = c->mesh->ring_start[centre];
        const uint32_t end = c->mesh->ring_start[centre + 1];
        if (!c->opened) {
            look_at(s, side, c, 0, centre);
            c->opened = true;
        }
        while (c->k < end) {
            const uint32_t entry = c->mesh->ring[c->k++];
            const bool joined = !(entry & MOTE_RING_END);
            if (joined && c->carried) {
                c->vertex[1] = c->vertex[2];
                c->corner[1] = c->corner[2];
                c->height[1] = c->height[2];
            } else if (joined) {
                look_at(s, side, c, 1, entry);
            }
            c->carried = joined;
            if (!joined)
                continue;
            const uint32_t next = c->k < end ? c->k : first;
            look_at(s, side, c, 2, MOTE_RING_VERTEX(c->mesh->ring[next]));
            if (c->index == 0 || !seen_before(c))
                return true;
        }
        c->opened = c->carried = false;
        if (++c->index < c->count)
            c->k = c->mesh->ring_start[c->centres[c->index]];
    }
    return false;
}

static double face_height(const face_cursor *c)
{
    return max2(c->height[0], max2(c->height[1], c->height[2]));
}

static void keep_face(mote_refined *best, int side, const uint32_t vertex[3],
                      const mote_vec3 corner[3])
{
    int nearest = 0;
    double least = HUGE_VAL;
    for (int i = 0; i < 3; ++i) {
        const double squared = mote_distance_squared(corner[i], best->witness[side]);
        best->triangle[side][i] = vertex[i];
        if (squared < least) {
            least = squared;
            nearest = i;
        }
    }
    best->vertex[side] = vertex[nearest];
}

/* Moves one side's witness to the point nearest to the other's on the faces around its vertex.
 */
static void approach(search *s, int side)
{
    mote_refined *best = s->best;
    const uint32_t centre = best->vertex[side];
    const mote_vec3 other = best->witness[1 - side];
    aim(s);
    mote_lazy_fetch_rings(s->lazy[side], &centre, 1);
    ++best->rings;
    face_cursor c = cursor_at(s, side, &centre, 1);
    while (next_face(s, side, &c)) {
        if (face_height(&c) <= s->slack)
            continue;
        mote_vec3 closest;
        const double squared = mote_point_triangle(other, c.corner, &closest);
        if (squared < best->squared) {
            best->squared = squared;
            best->witness[side] = closest;
            keep_face(best, side, c.vertex, c.corner);
            tighten(s, squared);
        }
    }
}

static bool same_faces(const mote_refined *a, const mote_refined *b)
{
    return memcmp(a->triangle, b->triangle, sizeof a->triangle) == 0;
}

/* Each round but the last halves the squared distance, so that there are at most 3,200 in the
   range of doubles. Ends as soon as a round stays on its faces: the remaining distance of two
   faces is measured in one step, while alternate projection onto two that intersect would go on
   halving the distance until it is subnormal. */
static void alternate(search *s)
{
    for (int round = 0; !done(s); ++round) {
        const mote_refined before = *s->best;
        approach(s, 1);
        if (!done(s))
            approach(s, 0);
        if (!(s->best->squared < before.squared * (1 - WORTHWHILE)))
            return;
        if (round > 0 && same_faces(&before, s->best))
            return;
    }
}

/* The largest height of a vertex and its ring. */
static double ring_reach(search *s, int side, uint32_t centre)
{
    const mote_mesh *mesh = s->lazy[side]->body->mesh;
    mote_lazy_fetch_rings(s->lazy[side], &centre, 1);
    double height = height_of(s, side, mote_lazy_position(s->lazy[side], centre));
    for (uint32_t k = mesh->ring_start[centre]; k < mesh->ring_start[centre + 1]; ++k) {
        const uint32_t v = MOTE_RING_VERTEX(mesh->ring[k]);
        height = max2(height, height_of(s, side, mote_lazy_position(s->lazy[side], v)));
    }
    ++s->best->rings;
    return height;
}

/* Lists the next faces; false when there are none left. */
static bool fill_list(const search *s, int side, face_cursor *c, face_list *list)
{
    const uint32_t checked = s->checked[side];
    list->count = 0;
    list->height = -HUGE_VAL;
    while (list->count < LIST_MAX && next_face(s, side, c)) {
        listed_face *f = &list->face[list->count++];
        f->height = face_height(c);
        f->boxed = false;
        f->measured =
            c->vertex[0] == checked || c->vertex[1] == checked || c->vertex[2] == checked;
        for (int i = 0; i < 3; ++i) {
            f->corner[i] = c->corner[i];
            f->vertex[i] = c->vertex[i];
        }
        list->height = max2(list->height, f->height);
    }
    return list->count > 0;
}

static void box_face(const search *s, listed_face *f)
{
    double far = 0;
    for (int k = 0; k < 2; ++k) {
        f->low[k] = HUGE_VAL;
        f->high[k] = -HUGE_VAL;
    }
    for (int i = 0; i < 3; ++i) {
        const mote_vec3 p = mote_sub(f->corner[i], s->origin[0]);
        far = max2(far, mote_largest_coordinate(p));
        for (int k = 0; k < 2; ++k) {
            const double x = mote_dot(p, s->across[k]);
            f->low[k] = min2(f->low[k], x);
            f->high[k] = max2(f->high[k], x);
        }
    }
    f->blur = ROUNDING * far + s->rounding;
    f->boxed = true;
}

/* Chooses the faces that are high enough for a partner of the given height. */
static void choose_faces(const search *s, face_list *list, double partner)
{
    list->chosen_count = 0;
    for (uint32_t i = 0; i < list->count; ++i) {
        if (list->face[i].height + partner <= s->slack)
            continue;
        list->chosen[list->chosen_count++] = i;
        if (!list->face[i].boxed)
            box_face(s, &list->face[i]);
    }
}

/* A lower bound of the squared distance of two faces: along the line of the witnesses by their
   heights, across it by their shadows. */
static double gap_squared(const search *s, const listed_face *a, const listed_face *b)
{
    const double blur = a->blur + b->blur;
    const double along = max2(0, s->distance - a->height - b->height - blur);
    double squared = along * along;
    for (int k = 0; k < 2; ++k) {
        const double gap = max2(a->low[k] - b->high[k], b->low[k] - a->high[k]) - blur;
        if (gap > 0)
            squared += gap * gap;
    }
    return squared;
}

static void measure_pair(search *s, const listed_face *a, const listed_face *b)
{
    mote_refined *best = s->best;
    if (a->height + b->height <= s->slack || (a->measured && b->measured))
        return;
    const double bound = min2(best->squared, s->worth_squared) * (1 - MARGIN);
    if (gap_squared(s, a, b) >= bound)
        return;
    mote_vec3 p, q;
    ++best->triangle_tests;
    const double squared = mote_triangle_triangle_below(a->corner, b->corner, bound, &p, &q);
    if (!(squared < bound))
        return;
    best->squared = squared;
    best->witness[0] = p;
    best->witness[1] = q;
    keep_face(best, 0, a->vertex, a->corner);
    keep_face(best, 1, b->vertex, b->corner);
    tighten(s, squared);
}

static void measure_lists(search *s, face_list *a, face_list *b)
{
    if (a->height + b->height <= s->slack)
        return;
    choose_faces(s, a, b->height);
    choose_faces(s, b, a->height);
    for (uint32_t i = 0; i < a->chosen_count; ++i) {
        for (uint32_t j = 0; j < b->chosen_count && !done(s); ++j)
            measure_pair(s, &a->face[a->chosen[i]], &b->face[b->chosen[j]]);
    }
}

/* Measures the faces around the first centres against those around the second; true if a pair
   is nearer than the witnesses were. */
static bool check_rings(search *s, const uint32_t *centres0, const uint32_t *centres1,
                        uint32_t count)
{
    const double before = s->best->squared;
    aim(s);
    if (s->worth_squared < before)
        tighten(s, s->worth_squared);
    mote_lazy_fetch_rings(s->lazy[0], centres0, count);
    mote_lazy_fetch_rings(s->lazy[1], centres1, count);
    s->best->rings += 2 * count;
    face_list list0, list1;
    face_cursor c0 = cursor_at(s, 0, centres0, count);
    while (fill_list(s, 0, &c0, &list0)) {
        face_cursor c1 = cursor_at(s, 1, centres1, count);
        while (fill_list(s, 1, &c1, &list1)) {
            measure_lists(s, &list0, &list1);
            if (done(s))
                return true;
        }
    }
    return s->best->squared < before;
}

/* Measures the rings of the vertices of the two faces. */
static bool check_around(search *s)
{
    uint32_t around[2][3];
    for (int i = 0; i < 3; ++i) {
        around[0][i] = s->best->triangle[0][i];
        around[1][i] = s->best->triangle[1][i];
    }
    return check_rings(s, around[0], around[1], 3);
}

static void descend_by_rounds(search *s)
{
    for (int round = 0; round < ROUNDS_MAX && !done(s); ++round) {
        alternate(s);
        if (done(s))
            return;
        const uint32_t at[2] = {s->best->vertex[0], s->best->vertex[1]};
        s->checked[0] = s->checked[1] = NONE;
        if (check_rings(s, &at[0], &at[1], 1))
            continue;
        s->checked[0] = at[0];
        s->checked[1] = at[1];
        if (!check_around(s))
            return;
    }
}

/* Where the witnesses' coordinates are larger than the faces and their distance by more than
   this factor, they are rounded so much that distances measured from them are not those of the
   faces. */
#define FAR_FROM_ORIGIN 0x1p16

/* Measures the faces themselves, where that can change the result. */
static void measure_far_faces(const search *s)
{
    mote_refined *best = s->best;
    const double far = max2(mote_largest_coordinate(best->witness[0]),
                            mote_largest_coordinate(best->witness[1]));
    const double small = far / FAR_FROM_ORIGIN, small_squared = small * small;
    if (best->squared >= small_squared)
        return;
    mote_vec3 t[2][3];
    for (int side = 0; side < 2; ++side) {
        for (int i = 0; i < 3; ++i)
            t[side][i] = mote_lazy_position(s->lazy[side], best->triangle[side][i]);
        for (int i = 0; i < 3; ++i) {
            if (mote_distance_squared(t[side][i], t[side][(i + 1) % 3]) >= small_squared)
                return;
        }
    }
    ++best->triangle_tests;
    best->squared = mote_triangle_triangle(t[0], t[1], &best->witness[0], &best->witness[1]);
}

static void descend(search *s)
{
    descend_by_rounds(s);
    measure_far_faces(s);
}

void mote_refine_vertices(mote_lazy *const lazy[2], const uint32_t vertex[2],
                          double enough_squared, mote_refined *result)
{
    (void)mote_refine_below(lazy, vertex, HUGE_VAL, enough_squared, result);
}

/* True if the rings of the two vertices are too far apart for a search from there to come below
   worth_squared. */
static bool hopeless(search *s)
{
    if (!(s->worth_squared < s->best->squared))
        return false;
    aim(s);
    const double gain =
        ring_reach(s, 0, s->best->vertex[0]) + ring_reach(s, 1, s->best->vertex[1]);
    return s->distance - SLIDE_MAX * gain > sqrt(s->worth_squared) + s->rounding;
}

bool mote_refine_below(mote_lazy *const lazy[2], const uint32_t vertex[2], double worth_squared,
                       double enough_squared, mote_refined *result)
{
    *result = (mote_refined){.vertex = {vertex[0], vertex[1]}};
    for (int side = 0; side < 2; ++side) {
        /* The first two entries of a ring are always joined: no fan is without a face. */
        const mote_mesh *mesh = lazy[side]->body->mesh;
        const uint32_t *ring = &mesh->ring[mesh->ring_start[vertex[side]]];
        result->witness[side] = mote_lazy_position(lazy[side], vertex[side]);
        result->triangle[side][0] = vertex[side];
        result->triangle[side][1] = MOTE_RING_VERTEX(ring[0]);
        result->triangle[side][2] = MOTE_RING_VERTEX(ring[1]);
    }
    result->squared = mote_distance_squared(result->witness[0], result->witness[1]);
    search s = {.lazy = lazy,
                .best = result,
                .worth_squared = worth_squared,
                .enough_squared = enough_squared};
    if (hopeless(&s))
        return false;
    descend(&s);
    return true;
}

/* Measures the two faces of the witnesses, replacing the witnesses. */
static void measure_faces(const search *s)
{
    mote_refined *best = s->best;
    mote_vec3 t[2][3];
    uint32_t face[2][3];
    memcpy(face, best->triangle, sizeof face);
    for (int side = 0; side < 2; ++side) {
        for (int i = 0; i < 3; ++i)
            t[side][i] = mote_lazy_position(s->lazy[side], face[side][i]);
    }
    ++best->triangle_tests;
    best->squared = mote_triangle_triangle(t[0], t[1], &best->witness[0], &best->witness[1]);
    for (int side = 0; side < 2; ++side)
        keep_face(best, side, face[side], t[side]);
}

void mote_refine_slide(mote_lazy *const lazy[2], double enough_squared, mote_refined *best)
{
    search s = {.lazy = lazy,
                .best = best,
                .worth_squared = HUGE_VAL,
                .enough_squared = enough_squared};
    best->triangle_tests = best->rings = 0;
    for (int side = 0; side < 2; ++side) {
        uint32_t face[3];
        mote_vec3 corner[3];
        for (int i = 0; i < 3; ++i) {
            face[i] = best->triangle[side][i];
            corner[i] = mote_lazy_position(lazy[side], face[i]);
        }
        keep_face(best, side, face, corner);
    }
    for (bool nearer = true; nearer && !done(&s);) {
        const mote_refined before = *best;
        approach(&s, 1);
        if (!done(&s))
            approach(&s, 0);
        nearer = !same_faces(&before, best);
        if (nearer) {
            measure_faces(&s);
            nearer = best->squared < before.squared;
        }
        if (!nearer) {
            const uint32_t tests = best->triangle_tests, rings = best->rings;
            *best = before;
            best->triangle_tests = tests;
            best->rings = rings;
        }
    }
}

void mote_refine_triangles(mote_lazy *const lazy[2], const uint32_t triangle0[3],
                           const uint32_t triangle1[3], double enough_squared,
                           mote_refined *result)
{
    *result = (mote_refined){.triangle_tests = 1};
    mote_vec3 s0[3], s1[3];
    for (int i = 0; i < 3; ++i) {
        s0[i] = mote_lazy_position(lazy[0], triangle0[i]);
        s1[i] = mote_lazy_position(lazy[1], triangle1[i]);
    }
    result->squared = mote_triangle_triangle(s0, s1, &result->witness[0], &result->witness[1]);
    keep_face(result, 0, triangle0, s0);
    keep_face(result, 1, triangle1, s1);
    search s = {.lazy = lazy,
                .best = result,
                .worth_squared = HUGE_VAL,
                .enough_squared = enough_squared};
    s.checked[0] = s.checked[1] = NONE;
    if (!done(&s) && check_around(&s))
        descend(&s);
}

mote_status mote_refuse_infinite(double distance)
{
    if (isfinite(distance))
        return MOTE_OK;
    return mote_fail(MOTE_EINVAL, "the bodies are too far apart to square their distance, or "
                                  "their positions are not finite");
}
