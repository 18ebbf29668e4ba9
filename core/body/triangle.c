/* Every candidate is a pair of feasible points, so that no candidate can be below the distance
   by more than rounding. Three kinds are enough: edge with edge (clamped, which includes
   vertices), vertex with the inside of a face, and an edge that pierces a face. A general pair
   is decided by the side of each triangle's plane on which the other one lies; pairs that
   rounding could decide wrongly go to a slower search of all candidates, each refined by its
   own residual. Where products of six lengths may leave the range of doubles, a pair is
   doubtful; if its coordinates are all that small or some that large, it is scaled first. */
#include "core/body/triangle.h"

#include "core/base/clones.h"
#include "core/body/triangle_scale.h"

#include <float.h>
#include <stdbool.h>
#include <stdint.h>

/* The relative rounding error of one operation. */
#define ROUNDING 0x1p-53

/* A height n.w over a plane n = e1 x e2 is wrong by less than this times |e1| |e2| |w|. */
#define HEIGHT_ERROR (8 * ROUNDING)

/* Distances below this times the longest edge are contacts. */
#define CONTACT_ERROR (4 * ROUNDING)

/* Below this squared sine of the corner a plane is left to the slower search. */
#define FLAT_SINE_SQUARED (1.0 / 64)

/* Products of six lengths that are not much larger may have lost bits: they decide nothing. */
#define LEAST_PRODUCT 0x1p-800

/* No product overflows where the squared edges add up to no more than MOST_EDGES; from
   LEAST_EDGES on, none that a doubtful pair needs has lost bits. */
#define LEAST_EDGES 0x1p-100
#define MOST_EDGES 0x1p200

/* One candidate: the two points and their difference p - q, which is more accurate than they
 * are. */
typedef struct candidate {
    double squared;
    mote_vec3 p, q, difference;
} candidate;

/* A triangle o, o + e1, o + e2 with its normal n = e1 x e2. */
typedef struct face {
    mote_vec3 o, e1, e2, n;
    double nn;            /* |n|^2 */
    double ee;            /* |e1|^2 |e2|^2 */
    double squared_edges; /* |e1|^2 + |e2|^2 */
} face;

typedef enum side_kind { SIDE_CLEAR, SIDE_ONE, SIDE_BOTH, SIDE_DOUBTFUL } side_kind;

/* On which side of the plane of one triangle the vertices of the other lie. */
typedef struct side {
    side_kind kind;
    int lowest;  /* the vertex nearest to the plane, if all are on one side */
    double h[3]; /* n . (vertex - o) */
} side;

/* Half of x + |x| is max(x, 0) exactly; two nested choices would become four compares a lane.
 */
static inline double clamp01(double x)
{
    double positive = 0.5 * (x + fabs(x));
    return positive < 1 ? positive : 1;
}

/* x / y where y > 0, else 0. */
static inline double ratio(double x, double y)
{
    return y > 0 ? x / y : 0;
}

static double max2(double x, double y)
{
    return x > y ? x : y;
}

static void set(mote_vec3 *to, mote_vec3 value)
{
    if (to)
        *to = value;
}

/* The point of the segment o, o + d nearest to o + w, as its parameter. */
static double project_segment(mote_vec3 d, mote_vec3 w)
{
    return clamp01(ratio(mote_dot(d, w), mote_dot(d, d)));
}

/* The coordinates of w along e1 and e2, after projection on the plane. Cross products lose less
   than products of dot products: an error that is inversely proportional to the corner's sine,
   not to its square. */
static void project_plane(const face *f, mote_vec3 w, double *u, double *v)
{
    double inverse = f->nn > 0 ? 1 / f->nn : 0;
    *u = mote_dot(mote_cross(w, f->e2), f->n) * inverse;
    *v = mote_dot(mote_cross(f->e1, w), f->n) * inverse;
}

static void clamp_to_triangle(double *u, double *v)
{
    *u = clamp01(*u);
    *v = clamp01(*v);
    double sum = *u + *v;
    if (sum > 1) {
        *u /= sum;
        *v /= sum;
    }
}

/* w - u e1 - v e2 */
static mote_vec3 residual(const face *f, mote_vec3 w, double u, double v)
{
    return mote_add_scaled(mote_add_scaled(w, -u, f->e1), -v, f->e2);
}

static mote_vec3 face_point(const face *f, double u, double v)
{
    return mote_add_scaled(mote_add_scaled(f->o, u, f->e1), v, f->e2);
}

static void measure_face(face *f)
{
    double a = mote_length_squared(f->e1), b = mote_length_squared(f->e2);
    f->nn = mote_length_squared(f->n);
    f->ee = a * b;
    f->squared_edges = a + b;
}

static face make_face(const mote_vec3 t[3])
{
    face f = {.o = t[0], .e1 = mote_sub(t[1], t[0]), .e2 = mote_sub(t[2], t[0])};
    f.n = mote_cross(f.e1, f.e2);
    measure_face(&f);
    return f;
}

/* The squared length of the longest edge of s and t. */
static double longest_edge_squared(const mote_vec3 s[3], const mote_vec3 t[3])
{
    double longest = 0;
    for (int i = 0; i < 3; i++) {
        longest = max2(longest, mote_distance_squared(s[i], s[(i + 1) % 3]));
        longest = max2(longest, mote_distance_squared(t[i], t[(i + 1) % 3]));
    }
    return longest;
}

/* Turns a candidate that rounding cannot distinguish from a contact into one. */
static void settle_contact(const mote_vec3 s[3], const mote_vec3 t[3], candidate *c)
{
    if (c->squared > CONTACT_ERROR * CONTACT_ERROR * longest_edge_squared(s, t))
        return;
    c->squared = 0;
    c->p = c->q = mote_add_scaled(c->p, -0.5, c->difference);
}

/* Start, end - start, 1 / |d|^2 (1 where d = 0). */
typedef struct edge {
    mote_vec3 o, d;
    double inverse;
} edge;

static inline edge make_edge(mote_vec3 from, mote_vec3 to)
{
    edge e = {.o = from, .d = mote_sub(to, from)};
    double dd = mote_length_squared(e.d);
    e.inverse = 1 / (dd > 0 ? dd : 1);
    return e;
}

/* The nearest points of two edges, as parameters along each. */
typedef struct nearest {
    double squared, s, t;
} nearest;

/* The nearest points of a and b, without branches. */
static inline nearest edge_pair(const edge *a, const edge *b)
{
    double dx = a->d.x, dy = a->d.y, dz = a->d.z, bx = b->d.x, by = b->d.y, bz = b->d.z;
    double rx = a->o.x - b->o.x, ry = a->o.y - b->o.y, rz = a->o.z - b->o.z;
    double nx = dy * bz - dz * by, ny = dz * bx - dx * bz, nz = dx * by - dy * bx;
    double cx = rz * by - ry * bz, cy = rx * bz - rz * bx, cz = ry * bx - rx * by;
    double nn = nx * nx + ny * ny + nz * nz;
    double rb = rx * bx + ry * by + rz * bz;
    double rd = rx * dx + ry * dy + rz * dz;
    double db = dx * bx + dy * by + dz * bz;
    double s = clamp01((cx * nx + cy * ny + cz * nz) / (nn > 0 ? nn : 1));
    double free_t = (rb + s * db) * b->inverse, t = clamp01(free_t);
    double again = clamp01((t * db - rd) * a->inverse);
    s = ((t == free_t) & (nn > 0)) ? s : again;
    double wx = (rx - t * bx) + s * dx;
    double wy = (ry - t * by) + s * dy;
    double wz = (rz - t * bz) + s * dz;
    nearest r = {wx * wx + wy * wy + wz * wz, s, t};
    return r;
}

/* a, b or c for k = 0, 1, 2; else a. A choice of values, where an index would go through
 * memory. */
static inline mote_vec3 pick(int64_t k, mote_vec3 a, mote_vec3 b, mote_vec3 c)
{
    return mote_vec3_make(k == 1   ? b.x
                          : k == 2 ? c.x
                                   : a.x,
                          k == 1   ? b.y
                          : k == 2 ? c.y
                                   : a.y,
                          k == 1   ? b.z
                          : k == 2 ? c.z
                                   : a.z);
}

/* The best candidate of all nine edge pairs: the edges of t in lanes that compilers vectorise.
   Always inlined, so that every version of its callers has it in its own instruction set. */
__attribute__((always_inline)) static inline void
edge_candidate(const mote_vec3 s[3], const mote_vec3 t[3], candidate *c)
{
    edge a0 = make_edge(s[0], s[1]), a1 = make_edge(s[1], s[2]), a2 = make_edge(s[2], s[0]);
    struct {
        double squared[4], s[4], t[4], edge[4];
    } best;
    for (int64_t k = 0; k < 4; k++) {
        edge b = {.o = pick(k, t[0], t[1], t[2])};
        b.d = mote_sub(pick(k, t[1], t[2], t[0]), b.o);
        double bb = mote_length_squared(b.d);
        b.inverse = 1 / (bb > 0 ? bb : 1);
        nearest r0 = edge_pair(&a0, &b), r1 = edge_pair(&a1, &b), r2 = edge_pair(&a2, &b);
        bool one = r1.squared < r0.squared;
        double squared = one ? r1.squared : r0.squared;
        bool two = r2.squared < squared;
        best.squared[k] = two ? r2.squared : squared;
        best.s[k] = two ? r2.s : (one ? r1.s : r0.s);
        best.t[k] = two ? r2.t : (one ? r1.t : r0.t);
        best.edge[k] = two ? 2.0 : (one ? 1.0 : 0.0);
    }
    int j = best.squared[1] < best.squared[0] ? 1 : 0;
    j = best.squared[2] < best.squared[j] ? 2 : j;
    int i = (int)best.edge[j], i_end = i < 2 ? i + 1 : 0, j_end = j < 2 ? j + 1 : 0;
    mote_vec3 d = mote_sub(s[i_end], s[i]), e = mote_sub(t[j_end], t[j]);
    c->squared = best.squared[j];
    c->p = mote_add_scaled(s[i], best.s[j], d);
    c->q = mote_add_scaled(t[j], best.t[j], e);
    mote_vec3 r = mote_sub(s[i], t[j]);
    c->difference = mote_add_scaled(mote_add_scaled(r, best.s[j], d), -best.t[j], e);
}

/* The product a b as a sum of two doubles: Dekker's, since a fused operation is not everywhere.
 */
static double product_tail(double a, double b, double product)
{
    double as = 0x1.0000002p27 * a, bs = 0x1.0000002p27 * b;
    double ah = as - (as - a), bh = bs - (bs - b);
    double al = a - ah, bl = b - bh;
    return al * bl - (((product - ah * bh) - al * bh) - ah * bl);
}

/* a b - c d, to the rounding of the result even where the products cancel. */
static double difference_of_products(double a, double b, double c, double d)
{
    double ab = a * b, cd = c * d;
    return (ab - cd) + (product_tail(a, b, ab) - product_tail(c, d, cd));
}

static mote_vec3 exact_cross(mote_vec3 a, mote_vec3 b)
{
    return mote_vec3_make(difference_of_products(a.y, b.z, a.z, b.y),
                          difference_of_products(a.z, b.x, a.x, b.z),
                          difference_of_products(a.x, b.y, a.y, b.x));
}

/* A face whose corner is the one with the largest sine, which lies opposite the longest edge,
   with a normal that is right even where the triangle is nearly a segment. */
static face make_face_carefully(const mote_vec3 t[3])
{
    int corner = 0;
    double longest = -1;
    for (int k = 0; k < 3; k++) {
        double length = mote_distance_squared(t[(k + 1) % 3], t[(k + 2) % 3]);
        if (length > longest) {
            longest = length;
            corner = k;
        }
    }
    face f = {.o = t[corner],
              .e1 = mote_sub(t[(corner + 1) % 3], t[corner]),
              .e2 = mote_sub(t[(corner + 2) % 3], t[corner])};
    f.n = exact_cross(f.e1, f.e2);
    measure_face(&f);
    return f;
}

/* Steps of refinement by the residual; each gains the digits that the corner's sine leaves. */
#define REFINEMENTS 6

/* The point of f nearest to its o + w if that is inside, else some point of f; the difference.
 */
static mote_vec3 drop_carefully(const face *f, mote_vec3 w, double *u, double *v)
{
    mote_vec3 left = w;
    *u = *v = 0;
    for (int k = 0; k < REFINEMENTS; k++) {
        double du, dv;
        project_plane(f, left, &du, &dv);
        *u += du;
        *v += dv;
        left = residual(f, w, *u, *v);
        if (fabs(du) + fabs(dv) <= 4 * ROUNDING)
            break;
    }
    clamp_to_triangle(u, v);
    return residual(f, w, *u, *v);
}

/* Keeps the candidate "point on the face f, and point" if it is the best. */
static void offer(candidate *best, const face *f, double u, double v, mote_vec3 point,
                  mote_vec3 point_minus_face, bool face_is_s)
{
    double squared = mote_length_squared(point_minus_face);
    if (!(squared < best->squared))
        return;
    mote_vec3 on_face = face_point(f, u, v);
    best->squared = squared;
    best->p = face_is_s ? on_face : point;
    best->q = face_is_s ? point : on_face;
    best->difference = mote_scale(point_minus_face, face_is_s ? -1 : 1);
}

/* Where the edge a, a + d meets the plane of f, refined; offered as a candidate. */
static void pierce_carefully(candidate *best, const face *f, mote_vec3 a, mote_vec3 d,
                             bool face_is_s)
{
    mote_vec3 w = mote_sub(a, f->o);
    double slope = mote_dot(f->n, d);
    if (slope == 0)
        return;
    mote_vec3 left = w;
    double x = 0, u = 0, v = 0;
    for (int k = 0; k < REFINEMENTS; k++) {
        double x_old = x, du, dv;
        x = clamp01(x - mote_dot(f->n, left) / slope);
        left = mote_add_scaled(left, x - x_old, d);
        project_plane(f, left, &du, &dv);
        u += du;
        v += dv;
        left = residual(f, mote_add_scaled(w, x, d), u, v);
        if (fabs(x - x_old) + fabs(du) + fabs(dv) <= 4 * ROUNDING)
            break;
    }
    clamp_to_triangle(&u, &v);
    mote_vec3 at = mote_add_scaled(w, x, d);
    offer(best, f, u, v, mote_add_scaled(a, x, d), residual(f, at, u, v), face_is_s);
}

/* All candidates of the face of one triangle against the vertices and edges of the other. */
static void face_candidates(candidate *best, const face *f, const mote_vec3 t[3],
                            bool face_is_s)
{
    if (!(f->nn > 0))
        return;
    for (int k = 0; k < 3; k++) {
        double u, v;
        mote_vec3 left = drop_carefully(f, mote_sub(t[k], f->o), &u, &v);
        offer(best, f, u, v, t[k], left, face_is_s);
        pierce_carefully(best, f, t[k], mote_sub(t[(k + 1) % 3], t[k]), face_is_s);
    }
}

/* The search of all candidates, for pairs that rounding could decide wrongly. */
static void search_carefully(const mote_vec3 s[3], const mote_vec3 t[3], candidate *best)
{
    face fs = make_face_carefully(s), ft = make_face_carefully(t);
    face_candidates(best, &fs, t, true);
    face_candidates(best, &ft, s, false);
}

/* True if a length that may be wrong by an error is more than another one, all squared: 2,000
   times its error, it is right to 0.05 %, 2e9 times, to 5e-10. False where both are infinite.
 */
static inline bool surely_beyond(double squared, double other, double error_squared)
{
    const bool fine = squared > 4e18 * error_squared;
    return squared * (fine ? 1 - 2e-9 : 0.999) > other && squared > 4e6 * error_squared;
}

/* Sorts the vertices v by the side of f on which they lie. SIDE_CLEAR: all are farther from the
   plane than the bound. SIDE_ONE: all on one side, one being nearest beyond rounding.
   SIDE_BOTH: on both sides beyond rounding. Else SIDE_DOUBTFUL. */
static inline side classify(const face *f, const mote_vec3 v[3], double bound_squared)
{
    side r = {.kind = SIDE_DOUBTFUL};
    double ww = 0;
    for (int k = 0; k < 3; k++) {
        mote_vec3 w = mote_sub(v[k], f->o);
        r.h[k] = mote_dot(f->n, w);
        ww = max2(ww, mote_length_squared(w));
    }
    double error_squared = HEIGHT_ERROR * HEIGHT_ERROR * f->ee * ww + LEAST_PRODUCT;
    double h0 = fabs(r.h[0]), h1 = fabs(r.h[1]), h2 = fabs(r.h[2]);
    bool one = (r.h[0] > 0) == (r.h[1] > 0) && (r.h[0] > 0) == (r.h[2] > 0);
    r.lowest = h0 <= h1 ? (h0 <= h2 ? 0 : 2) : (h1 <= h2 ? 1 : 2);
    double h = fabs(r.h[r.lowest]), hh = h * h;
    if (one && surely_beyond(hh, bound_squared * (f->nn + LEAST_PRODUCT), error_squared)) {
        r.kind = SIDE_CLEAR;
        return r;
    }
    if (hh <= error_squared || f->nn <= FLAT_SINE_SQUARED * f->ee)
        return r;
    double next = r.lowest == 0   ? (h1 < h2 ? h1 : h2)
                  : r.lowest == 1 ? (h0 < h2 ? h0 : h2)
                                  : (h0 < h1 ? h0 : h1);
    if (!one)
        r.kind = SIDE_BOTH;
    else if ((next - h) * (next - h) > 4 * error_squared)
        r.kind = SIDE_ONE;
    return r;
}

/* The candidate point = f->o + w on the inside of f; false if it does not project there. */
static inline bool drop_point(const face *f, mote_vec3 point, mote_vec3 w, bool face_is_s,
                              candidate *c)
{
    double u, v, du, dv;
    project_plane(f, w, &u, &v);
    if (u < 0 || v < 0 || u + v > 1)
        return false;
    project_plane(f, residual(f, w, u, v), &du, &dv);
    u += du;
    v += dv;
    clamp_to_triangle(&u, &v);
    c->squared = HUGE_VAL;
    offer(c, f, u, v, point, residual(f, w, u, v), face_is_s);
    return true;
}

static inline bool drop_vertex(const face *f, mote_vec3 vertex, bool face_is_s, candidate *c)
{
    return drop_point(f, vertex, mote_sub(vertex, f->o), face_is_s, c);
}

/* True if an edge of v, of which there are two that cross the plane, pierces f; c is the point.
 */
static inline bool pierce(const face *f, const mote_vec3 v[3], const double h[3],
                          bool face_is_s, candidate *c)
{
    for (int k = 0; k < 3; k++) {
        int next = k < 2 ? k + 1 : 0;
        if ((h[k] > 0) == (h[next] > 0))
            continue;
        double x = h[k] / (h[k] - h[next]);
        mote_vec3 d = mote_sub(v[next], v[k]);
        /* Not from the point itself, which is rounded where coordinates are large. */
        mote_vec3 w = mote_add_scaled(mote_sub(v[k], f->o), x, d);
        if (drop_point(f, mote_add_scaled(v[k], x, d), w, face_is_s, c))
            return true;
    }
    return false;
}

/* The candidate of a pair that has no doubtful side, if a vertex over a face or a pierced face
   decides it; false if the edges have to. A pierced face is not quite a contact yet: rounding
   may have left a distance that the careful search removes. */
static inline bool face_decides(const mote_vec3 s[3], const mote_vec3 t[3], const face *fs,
                                const face *ft, const side *ss, const side *st, candidate *c)
{
    if (ss->kind == SIDE_ONE)
        return drop_vertex(ft, s[ss->lowest], false, c) ||
               (st->kind == SIDE_ONE && drop_vertex(fs, t[st->lowest], true, c));
    if (st->kind == SIDE_ONE)
        return drop_vertex(fs, t[st->lowest], true, c);
    return pierce(ft, s, ss->h, false, c) || pierce(fs, t, st->h, true, c);
}

/* True if the line of centres proves that the triangles are at least the bound apart. */
static inline bool centres_separate(const mote_vec3 s[3], const mote_vec3 t[3],
                                    double bound_squared)
{
    if (!(bound_squared < HUGE_VAL))
        return false;
    mote_vec3 a =
        mote_add(mote_sub(t[0], s[0]), mote_add(mote_sub(t[1], s[1]), mote_sub(t[2], s[2])));
    double high = 0, low = HUGE_VAL, uu = mote_length_squared(a), ww = 0;
    for (int k = 0; k < 3; k++) {
        mote_vec3 v = mote_sub(s[k], s[0]), w = mote_sub(t[k], s[0]);
        double x = mote_dot(a, v), y = mote_dot(a, w);
        high = max2(high, x);
        low = y < low ? y : low;
        ww = max2(ww, mote_length_squared(w));
    }
    double gap = low - high;
    return gap > 0 &&
           surely_beyond(gap * gap, bound_squared * uu, HEIGHT_ERROR * HEIGHT_ERROR * uu * ww);
}

/* Candidates nearer than this times the pair's size are searched carefully: they may be
 * contacts. */
#define NEAR 1e-10

static double triangles_scaled(const mote_vec3 s[3], const mote_vec3 t[3], double bound_squared,
                               int power, mote_vec3 *p, mote_vec3 *q)
{
    mote_vec3 a[3], b[3];
    mote_scale_points(s, 3, power, a);
    mote_scale_points(t, 3, power, b);
    mote_vec3 on_a = a[0], on_b = b[0];
    const double squared =
        mote_unscaled_squared(mote_triangle_triangle(a, b, &on_a, &on_b), power);
    if (squared >= bound_squared && squared > 0)
        return squared;
    mote_unscale_point(on_a, power, p);
    mote_unscale_point(on_b, power, q);
    return squared;
}

MOTE_CLONES
double mote_triangle_triangle_below(const mote_vec3 s[3], const mote_vec3 t[3],
                                    double bound_squared, mote_vec3 *p, mote_vec3 *q)
{
    face ft = make_face(t);
    side ss = classify(&ft, s, bound_squared);
    if (ss.kind == SIDE_CLEAR)
        return bound_squared;
    face fs = make_face(s);
    side st = classify(&fs, t, bound_squared);
    if (st.kind == SIDE_CLEAR)
        return bound_squared;
    double edges_squared = fs.squared_edges + ft.squared_edges;
    bool doubtful = ss.kind == SIDE_DOUBTFUL || st.kind == SIDE_DOUBTFUL;
    const bool odd = edges_squared > MOST_EDGES || (doubtful && edges_squared < LEAST_EDGES);
    if (!odd && centres_separate(s, t, bound_squared))
        return bound_squared;
    candidate c;
    if (doubtful || !face_decides(s, t, &fs, &ft, &ss, &st, &c))
        edge_candidate(s, t, &c);
    if (odd || !(c.squared <= DBL_MAX)) {
        const int power = mote_triangle_power(s, 3, t, 3);
        if (power != 0)
            return triangles_scaled(s, t, bound_squared, power, p, q);
    }
    bool near = c.squared <= NEAR * NEAR * edges_squared;
    if (near)
        settle_contact(s, t, &c);
    if ((doubtful || near) && c.squared > 0) {
        search_carefully(s, t, &c);
        settle_contact(s, t, &c);
    }
    if (c.squared >= bound_squared && c.squared > 0)
        return c.squared;
    set(p, c.p);
    set(q, c.q);
    return c.squared;
}

double mote_triangle_triangle(const mote_vec3 s[3], const mote_vec3 t[3], mote_vec3 *p,
                              mote_vec3 *q)
{
    return mote_triangle_triangle_below(s, t, HUGE_VAL, p, q);
}

static double segments_scaled(const mote_vec3 a[2], const mote_vec3 b[2], int power,
                              mote_vec3 *p, mote_vec3 *q)
{
    mote_vec3 c[2], d[2], on_c, on_d;
    mote_scale_points(a, 2, power, c);
    mote_scale_points(b, 2, power, d);
    const double squared =
        mote_unscaled_squared(mote_segment_segment(c, d, &on_c, &on_d), power);
    mote_unscale_point(on_c, power, p);
    mote_unscale_point(on_d, power, q);
    return squared;
}

MOTE_CLONES
double mote_segment_segment(const mote_vec3 a[2], const mote_vec3 b[2], mote_vec3 *p,
                            mote_vec3 *q)
{
    const int power = mote_triangle_power(a, 2, b, 2);
    if (power != 0)
        return segments_scaled(a, b, power, p, q);
    mote_vec3 s[3] = {a[0], a[1], a[0]}, t[3] = {b[0], b[1], b[0]};
    candidate c;
    edge_candidate(s, t, &c);
    settle_contact(s, t, &c);
    set(p, c.p);
    set(q, c.q);
    return c.squared;
}

static double point_scaled(mote_vec3 p, const mote_vec3 t[3], int power, mote_vec3 *closest)
{
    mote_vec3 point, corner[3], on_t;
    mote_scale_points(&p, 1, power, &point);
    mote_scale_points(t, 3, power, corner);
    const double squared =
        mote_unscaled_squared(mote_point_triangle(point, corner, &on_t), power);
    mote_unscale_point(on_t, power, closest);
    return squared;
}

MOTE_CLONES
double mote_point_triangle(mote_vec3 p, const mote_vec3 t[3], mote_vec3 *closest)
{
    const int power = mote_triangle_power(&p, 1, t, 3);
    if (power != 0)
        return point_scaled(p, t, power, closest);
    face f = make_face(t);
    candidate c = {.squared = HUGE_VAL, .q = t[0]}; /* all, where p is not finite */
    bool flat = f.nn <= FLAT_SINE_SQUARED * f.ee + LEAST_PRODUCT;
    if (!flat && drop_vertex(&f, p, false, &c)) {
        set(closest, c.q);
        return c.squared;
    }
    for (int k = 0; k < 3; k++) {
        mote_vec3 w = mote_sub(p, t[k]), d = mote_sub(t[k < 2 ? k + 1 : 0], t[k]);
        double x = project_segment(d, w),
               squared = mote_length_squared(mote_add_scaled(w, -x, d));
        if (squared < c.squared) {
            c.squared = squared;
            c.q = mote_add_scaled(t[k], x, d);
        }
    }
    if (flat) {
        f = make_face_carefully(t);
        double u, v;
        mote_vec3 left = drop_carefully(&f, mote_sub(p, f.o), &u, &v);
        offer(&c, &f, u, v, p, left, false);
    }
    set(closest, c.q);
    return c.squared;
}
