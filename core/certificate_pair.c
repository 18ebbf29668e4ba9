/* Two leaves: directions that keep them apart, then their triangles. */
#include "core/certificate_state.h"
#include "core/triangle.h"

/* Whether the gap along a unit direction, or one a little shorter, is at least the limit. */
static bool separates(const mote_certificate *c, const mote_cert_points *const points[2],
                      mote_vec3 direction)
{
    double range[2][2];
    mote_cert_range(points[0], direction, c->origin, range[0]);
    mote_cert_range(points[1], direction, c->origin, range[1]);
    return (range[1][0] - range[0][1]) * c->scale >= c->limit;
}

/* Puts a direction that separated first, and those before `place` behind it. */
static void remember(mote_certificate *c, mote_vec3 direction, uint32_t place)
{
    for (uint32_t i = place; i > 0; --i)
        c->direction[i] = c->direction[i - 1];
    c->direction[0] = direction;
}

static void remember_new(mote_certificate *c, mote_vec3 direction)
{
    if (c->direction_count < MOTE_CERT_DIRECTIONS)
        ++c->direction_count;
    remember(c, direction, c->direction_count - 1);
}

/* One box in double precision. */
typedef struct box {
    mote_vec3 centre, axis[3];
    double inverse[3]; /* 1 / |axis|^2 */
} box;

static mote_vec3 lane_vector(const float v[3][MOTE_CERT_WIDTH], size_t lane)
{
    return mote_vec3_make((double)v[0][lane], (double)v[1][lane], (double)v[2][lane]);
}

static void take_box(const mote_cert_node *node, size_t lane, box *b)
{
    b->centre = lane_vector(node->centre, lane);
    for (int k = 0; k < 3; ++k) {
        b->axis[k] = lane_vector(node->axis[k], lane);
        b->inverse[k] = 1 / (mote_length_squared(b->axis[k]) + 1e-60);
    }
}

/* A point of the box near x: the nearest where the axes are orthogonal. */
static mote_vec3 clamp_to(const box *b, mote_vec3 x)
{
    const mote_vec3 d = mote_sub(x, b->centre);
    mote_vec3 p = b->centre;
    for (int k = 0; k < 3; ++k) {
        const double z = mote_dot(d, b->axis[k]) * b->inverse[k];
        p = mote_add_scaled(p, z < -1 ? -1 : z > 1 ? 1 : z, b->axis[k]);
    }
    return p;
}

/* The direction between near points of two boxes. */
static bool box_direction(const box *a, const box *b, mote_vec3 *direction)
{
    mote_vec3 q = clamp_to(b, a->centre);
    mote_vec3 p = clamp_to(a, q);
    q = clamp_to(b, p);
    p = clamp_to(a, q);
    const mote_vec3 d = mote_sub(q, p);
    const double length = mote_length(d);
    if (!(length > 0))
        return false;
    *direction = mote_scale(d, 1 / length);
    return true;
}

/* The thin direction of box `lane`, from body 0 to body 1. */
static bool normal_direction(const mote_cert_node *node, size_t lane, mote_vec3 towards,
                             mote_vec3 *direction)
{
    const mote_vec3 n = lane_vector(node->normal, lane);
    const double length = mote_length(n);
    if (!(length > 0))
        return false;
    *direction = mote_scale(n, (mote_dot(n, towards) < 0 ? -1 : 1) / length);
    return true;
}

static bool separated(mote_certificate *c, const mote_cert_points *const points[2],
                      const mote_cert_node *const nodes[2], const size_t lanes[2])
{
    for (uint32_t i = 0; i < c->direction_count; ++i) {
        if (separates(c, points, c->direction[i])) {
            if (i > 0)
                remember(c, c->direction[i], i);
            return true;
        }
    }
    box a, b;
    take_box(nodes[0], lanes[0], &a);
    take_box(nodes[1], lanes[1], &b);
    mote_vec3 direction;
    if (box_direction(&a, &b, &direction) && separates(c, points, direction)) {
        remember_new(c, direction);
        return true;
    }
    const mote_vec3 towards = mote_sub(b.centre, a.centre);
    for (int s = 0; s < 2; ++s) {
        if (normal_direction(nodes[s], lanes[s], towards, &direction) &&
            separates(c, points, direction)) {
            remember_new(c, direction);
            return true;
        }
    }
    return false;
}

/* A leaf's triangle with what rules it out cheaply. */
typedef struct face {
    mote_vec3 corner[3];
    mote_vec3 low, high;   /* bounding box */
    double reach;          /* towards the other body, in the trees' units */
    const uint8_t *places; /* of its corners in the leaf */
} face;

static double least(double a, double b, double c)
{
    const double d = a < b ? a : b;
    return c < d ? c : d;
}

static double most(double a, double b, double c)
{
    const double d = a > b ? a : b;
    return c > d ? c : d;
}

static void take_face(const mote_cert_points *points, face *f)
{
    for (int k = 0; k < 3; ++k)
        f->corner[k] = mote_cert_point(points, f->places[k]);
    const mote_vec3 *x = f->corner;
    f->low = mote_vec3_make(least(x[0].x, x[1].x, x[2].x), least(x[0].y, x[1].y, x[2].y),
                            least(x[0].z, x[1].z, x[2].z));
    f->high = mote_vec3_make(most(x[0].x, x[1].x, x[2].x), most(x[0].y, x[1].y, x[2].y),
                             most(x[0].z, x[1].z, x[2].z));
}

/* The faces of a leaf that reach far enough to be nearer to the other leaf than the limit. */
static uint32_t near_faces(const mote_certificate *c, int s,
                           const mote_cert_points *const points[2],
                           face faces[MOTE_CERT_LEAF_TRIANGLES])
{
    const mote_cert_side *side = &c->side[s];
    const mote_cert_leaf *leaf = &side->tree->leaves[points[s]->leaf];
    const mote_vec3 direction = mote_scale(side->facing, c->scale);
    double along[MOTE_CERT_LEAF_VERTICES];
    for (uint32_t i = 0; i < leaf->vertex_count; ++i)
        along[i] = mote_dot(mote_sub(mote_cert_point(points[s], i), c->origin), direction);
    uint32_t count = 0;
    for (uint32_t i = 0; i < leaf->triangle_count; ++i) {
        const uint8_t *places = side->tree->corners[leaf->first_corner + i];
        const double reach = most(along[places[0]], along[places[1]], along[places[2]]);
        if (-(reach + points[1 - s]->reach) >= c->limit)
            continue;
        faces[count].reach = reach;
        faces[count].places = places;
        take_face(points[s], &faces[count++]);
    }
    return count;
}

static inline double gap(double low_a, double high_a, double low_b, double high_b)
{
    const double g = low_b - high_a > low_a - high_b ? low_b - high_a : low_a - high_b;
    return g > 0 ? g : 0;
}

/* Squared distance of the bounding boxes. */
static double box_gap_squared(const face *s, const face *t)
{
    const double x = gap(s->low.x, s->high.x, t->low.x, t->high.x);
    const double y = gap(s->low.y, s->high.y, t->low.y, t->high.y);
    const double z = gap(s->low.z, s->high.z, t->low.z, t->high.z);
    return x * x + y * y + z * z;
}

static void corners_of(const mote_cert_tree *tree, const mote_cert_points *points,
                       const face *f, uint32_t vertices[3])
{
    const mote_cert_leaf *leaf = &tree->leaves[points->leaf];
    for (int k = 0; k < 3; ++k)
        vertices[k] = tree->leaf_vertices[leaf->first_vertex + f->places[k]];
}

/* Measures two triangles unless they are far; true when they are nearer than any before. */
static bool measure(mote_certificate *c, const mote_cert_points *const points[2], const face *s,
                    const face *t)
{
    if (-(s->reach + t->reach) >= c->limit)
        return false;
    const double limit = c->limit / c->scale;
    const double squared_limit = limit * limit;
    if (box_gap_squared(s, t) >= squared_limit)
        return false;
    mote_vec3 p, q;
    ++c->counters.triangle_tests;
    const double squared =
        mote_triangle_triangle_below(s->corner, t->corner, squared_limit, &p, &q);
    if (!(squared < squared_limit && squared < c->best.squared))
        return false;
    c->best.witness[0] = p;
    c->best.witness[1] = q;
    corners_of(c->side[0].tree, points[0], s, c->best.triangle[0]);
    corners_of(c->side[1].tree, points[1], t, c->best.triangle[1]);
    mote_cert_set_best(c, squared);
    return true;
}

/* Measures all pairs of triangles of two leaves; true when the upper bound improved. */
static bool measure_all(mote_certificate *c, const mote_cert_points *const points[2])
{
    face faces[2][MOTE_CERT_LEAF_TRIANGLES];
    const uint32_t count0 = near_faces(c, 0, points, faces[0]);
    const uint32_t count1 = count0 > 0 ? near_faces(c, 1, points, faces[1]) : 0;
    bool improved = false;
    for (uint32_t i = 0; i < count0; ++i) {
        for (uint32_t k = 0; k < count1 && !c->done; ++k)
            improved = measure(c, points, &faces[0][i], &faces[1][k]) || improved;
    }
    return improved;
}

void mote_cert_leaf_pair(mote_certificate *c, const mote_cert_points *points[2],
                         const mote_cert_node *const nodes[2], const size_t lanes[2])
{
    ++c->counters.leaf_pairs;
    if (-(points[0]->reach + points[1]->reach) >= c->limit)
        return;
    if (c->options.directions && separated(c, points, nodes, lanes))
        return;
    if (measure_all(c, points) && c->restarts < c->options.restarts) {
        c->improved = true;
        c->done = true;
    }
}
