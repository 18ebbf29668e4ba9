/* The time of impact of bodies of which only positions are known, every vertex going straight:
   closed forms, the roots of the cubics of two triangles, and what may not be asked. */
#include "core/impact/impact_state.h"

#include "harness/base/heap_count.h"
#include "tests/unit/core/impact/impact_ask.h"

static const impact_kind arrays[2] = {IMPACT_ARRAYS, IMPACT_ARRAYS};

static void check_close(double a, double b, double tolerance)
{
    if (!(fabs(a - b) <= tolerance))
        fail_msg("%.17g and %.17g differ by more than %g", a, b, tolerance);
}

static mote_impact_found ask(impact_scene *s, double tolerance)
{
    return impact_ask(s, impact_question(s, tolerance));
}

static void check_none(const mote_impact_found *found)
{
    assert_int_equal(found->outcome, MOTE_IMPACT_NONE);
    assert_true(found->from >= 1);
}

static mote_mesh *triangle_mesh(void)
{
    static const double xyz[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    static const uint32_t face[] = {0, 1, 2};
    mote_mesh *mesh = NULL;
    need(mote_mesh_create(xyz, 3, face, 1, &mesh) == MOTE_OK);
    return mesh;
}

static void two_triangles(impact_scene *s)
{
    impact_scene_init_kinds(s, triangle_mesh(), triangle_mesh(), arrays, 1, 10);
}

/* Where a triangle of body i is in frame k. */
static void put(impact_scene *s, int i, int k, const double corner[3][3])
{
    for (int v = 0; v < 3; ++v)
        s->of[i].frame[k][v] = mote_vec3_make(corner[v][0], corner[v][1], corner[v][2]);
}

/* The face z = 0 stands; a tip comes down from z = 2 to -1, and is at the tolerance above it at
   (2 - tolerance) / 3. */
TEST(mote_impact_query_point_into_a_face)
{
    static const double floor_at[3][3] = {{-5, -5, 0}, {5, -5, 0}, {0, 5, 0}};
    static const double above[3][3] = {{0.1, 0.2, 2}, {0, 0, 4}, {1, 0, 4}};
    static const double below[3][3] = {{0.3, -0.1, -1}, {0, 0, 1}, {1, 0, 1}};
    static const double tolerances[] = {0, 1e-6, 0.25};
    impact_scene s;
    two_triangles(&s);
    put(&s, 0, 0, floor_at);
    put(&s, 0, 1, floor_at);
    put(&s, 1, 0, above);
    put(&s, 1, 1, below);
    for (int i = 0; i < 3; ++i) {
        const double tolerance = tolerances[i], time = (2 - tolerance) / 3;
        const mote_impact_found found = ask(&s, tolerance);
        impact_check_found(&found, time);
        assert_true(found.distance <= tolerance);
        check_close(found.normal.z, 1, 1e-6);
        check_close(found.witness[1].x, 0.1 + 0.2 * time, 1e-5);
        check_close(found.witness[1].y, 0.2 - 0.3 * time, 1e-5);
    }
    impact_scene_free(&s);
}

/* The edge along x at z = 0 and one along y that sinks from z = 1 to z = -1 while it turns: its
   ends sink at different times, z = 1 - 2 t + 0.4 t (y + 1), which is 0 at y = 0.2 at t = 1 /
   1.52. */
TEST(mote_impact_query_edge_over_edge)
{
    static const double still[3][3] = {{-1, 0.2, 0}, {1, 0.2, 0}, {0, 0.2, -3}};
    static const double above[3][3] = {{0, -1, 1}, {0, 1, 1}, {0, 0, 5}};
    static const double below[3][3] = {{0, -1, -1}, {0, 1, -0.2}, {0, 0, 5}};
    impact_scene s;
    two_triangles(&s);
    put(&s, 0, 0, still);
    put(&s, 0, 1, still);
    put(&s, 1, 0, above);
    put(&s, 1, 1, below);
    const mote_impact_found found = ask(&s, 0);
    impact_check_found(&found, 1 / 1.52);
    check_close(found.witness[0].x, 0, 1e-5);
    check_close(found.witness[0].y, 0.2, 1e-5);
    impact_scene_free(&s);
}

/* a + b t + c t^2 + d t^3 */
typedef struct cubic {
    double c[4];
} cubic;

static double value_of(const cubic *p, double t)
{
    return p->c[0] + t * (p->c[1] + t * (p->c[2] + t * p->c[3]));
}

/* A point that goes straight. */
typedef struct mover {
    mote_vec3 p, d;
} mover;

static mote_vec3 at_time(const mover *m, double t)
{
    return mote_add_scaled(m->p, t, m->d);
}

static mover between(const mover *a, const mover *b)
{
    return (mover){mote_sub(b->p, a->p), mote_sub(b->d, a->d)};
}

/* The volume that three moving vectors span. */
static cubic volume(mover a, mover b, mover c)
{
    const mote_vec3 pp = mote_cross(b.p, c.p), dd = mote_cross(b.d, c.d);
    const mote_vec3 pd = mote_add(mote_cross(b.p, c.d), mote_cross(b.d, c.p));
    return (cubic){{mote_dot(a.p, pp), mote_dot(a.d, pp) + mote_dot(a.p, pd),
                    mote_dot(a.d, pd) + mote_dot(a.p, dd), mote_dot(a.d, dd)}};
}

/* Roots in 0 .. 1, between the ends and the cubic's extremes. */
static int roots_of(const cubic *p, double root[3])
{
    double ends[4] = {0, 1, 1, 1};
    int count = 1, found = 0;
    const double a = 3 * p->c[3], b = 2 * p->c[2], c = p->c[1];
    const double square = b * b - 4 * a * c;
    if (square > 0) {
        const double q = -0.5 * (b + copysign(sqrt(square), b));
        const double first = fmin(q / a, c / q), second = fmax(q / a, c / q);
        if (first > 0 && first < 1)
            ends[count++] = first;
        if (second > 0 && second < 1)
            ends[count++] = second;
    }
    ends[count] = 1;
    for (int i = 0; i < count; ++i) {
        double low = ends[i], high = ends[i + 1];
        if (value_of(p, low) * value_of(p, high) > 0)
            continue;
        for (int k = 0; k < 60; ++k) {
            const double middle = 0.5 * (low + high);
            *(value_of(p, low) * value_of(p, middle) > 0 ? &low : &high) = middle;
        }
        root[found++] = high;
    }
    return found;
}

/* The first time at which four points lie in a plane and `meet` says that they touch. */
static double first_root(const mover m[4], bool (*meet)(const mote_vec3 at[4]))
{
    const cubic p = volume(between(&m[0], &m[1]), between(&m[0], &m[2]), between(&m[0], &m[3]));
    double root[3], first = 2;
    const int count = roots_of(&p, root);
    for (int i = 0; i < count; ++i) {
        mote_vec3 at[4];
        for (int k = 0; k < 4; ++k)
            at[k] = at_time(&m[k], root[i]);
        if (root[i] < first && meet(at))
            first = root[i];
    }
    return first;
}

/* The point 0 in the triangle of the others, and the segments 0 1 and 2 3. */
static bool point_in_face(const mote_vec3 at[4])
{
    return mote_point_triangle(at[0], &at[1], NULL) < 1e-18;
}

static bool edges_cross(const mote_vec3 at[4])
{
    return mote_segment_segment(&at[0], &at[2], NULL, NULL) < 1e-18;
}

/* The first impact of two triangles, from the 15 cubics. */
static double first_impact(const mover t[2][3])
{
    double first = 2;
    for (int s = 0; s < 2; ++s) {
        for (int k = 0; k < 3; ++k) {
            const mover m[4] = {t[s][k], t[1 - s][0], t[1 - s][1], t[1 - s][2]};
            first = fmin(first, first_root(m, point_in_face));
        }
    }
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            const mover m[4] = {t[0][i], t[0][(i + 1) % 3], t[1][j], t[1][(j + 1) % 3]};
            first = fmin(first, first_root(m, edges_cross));
        }
    }
    return first;
}

static void put_random(impact_scene *s, mover t[2][3])
{
    for (int i = 0; i < 2; ++i) {
        const mote_vec3 shift = impact_vector(&s->random, 2),
                        step = mote_add(mote_scale(shift, -2), impact_vector(&s->random, 0.5));
        for (int k = 0; k < 3; ++k) {
            const mote_vec3 p = mote_add(shift, impact_vector(&s->random, 1));
            const mote_vec3 q = mote_add(mote_add(shift, step), impact_vector(&s->random, 1));
            t[i][k] = (mover){p, mote_sub(q, p)};
            s->of[i].frame[0][k] = p;
            s->of[i].frame[1][k] = q;
        }
    }
}

TEST(mote_impact_query_two_triangles_meet_at_the_roots_of_their_cubics)
{
    impact_scene s;
    two_triangles(&s);
    int impacts = 0;
    for (int i = 0; i < 3000; ++i) {
        mover t[2][3];
        put_random(&s, t);
        if (!(impact_distance(&s, 0) > 1e-6))
            continue; /* they begin within each other */
        const double first = first_impact((const mover(*)[3])t);
        const mote_impact_found found = ask(&s, 0);
        if (first > 1) {
            assert_int_not_equal(found.outcome, MOTE_IMPACT_FOUND);
            assert_int_not_equal(found.outcome, MOTE_IMPACT_UNDECIDED);
            continue;
        }
        ++impacts;
        assert_int_equal(found.outcome, MOTE_IMPACT_FOUND);
        if (!(found.from <= first + 1e-9 && first <= found.to + 1e-9))
            fail_msg("pair %d: %.12g is not within %.12g .. %.12g", i, first, found.from,
                     found.to);
    }
    assert_true(impacts > 500 && impacts < 2500);
    impact_scene_free(&s);
}

/* All of body i in frame k as at rest, moved. */
static void put_rest(impact_scene *s, int i, int k, mote_vec3 shift)
{
    impact_body *b = &s->of[i];
    for (uint32_t v = 0; v < b->mesh->vertex_count; ++v)
        b->frame[k][v] = mote_add(b->mesh->positions[v], shift);
}

/* Boxes of length 2 and 1: faces at 1 and 4.5 - 10 t, in one piece or more, far from the
   origin, in double and in single precision. */
TEST(mote_impact_query_boxes_of_arrays_meet_when_they_must)
{
    static const double far[] = {0, 1e4};
    for (int c = 0; c < 6; ++c) {
        impact_scene s;
        impact_scene_init_kinds(&s, impact_box(2, 2, 2), impact_box(1, 1, 1), arrays, 1,
                                c % 3 ? 10 : 0);
        const uint32_t pieces = 1 + (uint32_t)c % 3 * 2;
        const mote_vec3 o = {far[c / 3], -far[c / 3], far[c / 3]};
        s.of[0].path.count = s.of[1].path.count = pieces;
        for (uint32_t k = 0; k <= pieces; ++k) {
            put_rest(&s, 0, (int)k, o);
            put_rest(&s, 1, (int)k, mote_add(o, mote_vec3_make(5 - 10.0 * k / pieces, 0.1, 0)));
        }
        const mote_impact_found found = ask(&s, 0.1);
        impact_check_found(&found, 0.34);
        check_close(found.normal.x, 1, 1e-9);
        check_close(found.witness[0].x, o.x + 1, 2e-5);
        const mote_impact_found touch = ask(&s, 0);
        impact_check_found(&touch, 0.35);
        impact_scene_free(&s);
    }
}

TEST(mote_impact_query_arrays_still_touching_and_leaving)
{
    impact_scene s;
    impact_scene_init_kinds(&s, impact_box(1, 1, 1), impact_box(1, 1, 1), arrays, 1, 10);
    for (int k = 0; k < 2; ++k) {
        put_rest(&s, 0, k, mote_vec3_make(0, 0, 0));
        put_rest(&s, 1, k, mote_vec3_make(2, 0, 0));
    }
    const mote_impact_found apart = ask(&s, 0.5), touching = ask(&s, 1);
    check_none(&apart);
    assert_int_equal(apart.iterations, 1);
    impact_check_found(&touching, 0);
    check_close(touching.to, 0, 0);
    put_rest(&s, 1, 1, mote_vec3_make(5, 0, 0)); /* it leaves */
    const mote_impact_found leaving = ask(&s, 0.999), started = ask(&s, 1);
    check_none(&leaving);
    impact_check_found(&started, 0);
    put_rest(&s, 1, 0, mote_vec3_make(0.5, 0, 0));
    const mote_impact_found within = ask(&s, 0);
    impact_check_found(&within, 0);
    assert_true(!(mote_length(within.normal) > 0));
    impact_scene_free(&s);
}

/* A bar of half length 5 goes from pointing along x to pointing along y, with a box within
   reach of where its tip would be on an arc; straight, the tip (5 - 5 t, 5 t) passes x + y = 5.
 */
TEST(mote_impact_query_box_within_reach_of_a_tip)
{
    static const double offsets[] = {3.2, 2.4};
    for (int k = 0; k < 2; ++k) {
        impact_scene s;
        impact_scene_init_kinds(&s, impact_box(10, 0.02, 0.02), impact_box(0.1, 0.1, 0.1),
                                arrays, 1, 10);
        put_rest(&s, 0, 0, mote_vec3_make(0, 0, 0));
        for (uint32_t v = 0; v < 8; ++v) {
            const mote_vec3 p = s.of[0].mesh->positions[v];
            s.of[0].frame[1][v] = mote_vec3_make(-p.y, p.x, p.z);
        }
        for (int f = 0; f < 2; ++f)
            put_rest(&s, 1, f, mote_vec3_make(offsets[k], offsets[k], 0));
        const mote_impact_found found = ask(&s, 0);
        if (k == 0)
            check_none(&found);
        else
            assert_int_equal(found.outcome, MOTE_IMPACT_FOUND);
        impact_scene_free(&s);
    }
}

/* A rigid box spins and falls on a plate of positions that rises. */
TEST(mote_impact_query_arrays_against_a_path)
{
    for (int first = 0; first < 2; ++first) {
        const impact_kind kinds[2] = {first ? IMPACT_ARRAYS : IMPACT_RIGID,
                                      first ? IMPACT_RIGID : IMPACT_ARRAYS};
        mote_mesh *plate = impact_box(8, 8, 1), *box = impact_box(1, 1, 1);
        impact_scene s;
        impact_scene_init_kinds(&s, first ? plate : box, first ? box : plate, kinds, 1, 10);
        const int p = 1 - first;
        put_rest(&s, p, 0, mote_vec3_make(0, 0, -0.5)); /* its top goes from 0 to 1 */
        put_rest(&s, p, 1, mote_vec3_make(0, 0, 0.5));
        mote_path_piece *piece = &s.of[first].piece[0];
        mote_path_line(mote_vec3_make(0, 0, 4), mote_vec3_make(0, 0, 0), piece->centre);
        piece->spins = true;
        piece->spin = mote_vec3_make(0, 0, 30);     /* its lower face stays level */
        const mote_impact_found found = ask(&s, 0); /* 3.5 - 4 t = t */
        impact_check_found(&found, 0.7);
        check_close(fabs(found.normal.z), 1, 1e-9);
        impact_scene_free(&s);
    }
}

/* Arrays in single precision, inside larger records. */
TEST(mote_impact_query_arrays_of_floats_in_records)
{
    impact_scene s;
    impact_scene_init_kinds(&s, impact_box(1, 1, 1), impact_box(1, 1, 1), arrays, 1, 10);
    float records[2][8][5];
    for (int k = 0; k < 2; ++k) {
        put_rest(&s, 0, k, mote_vec3_make(0, 0, 0));
        for (uint32_t v = 0; v < 8; ++v) {
            const mote_vec3 p = s.of[1].mesh->positions[v];
            records[k][v][0] = (float)p.x + (k ? -3.0F : 5.0F);
            records[k][v][1] = (float)p.y;
            records[k][v][2] = (float)p.z;
        }
        s.of[1].positions[k] = (mote_positions){
            .data = records[k], .stride = sizeof records[k][0], .single = true};
    }
    const mote_impact_found found = ask(&s, 0); /* 4.5 - 8 t = 0.5 */
    impact_check_found(&found, 0.5);
    impact_scene_free(&s);
}

static void check_refused(impact_scene *s, const char *part)
{
    const mote_impact_question question = impact_question(s, 0.1);
    mote_impact_found found;
    assert_int_equal(mote_impact_query(s->search, &question, &found), MOTE_EINVAL);
    if (!strstr(mote_error_text(), part))
        fail_msg("\"%s\" does not say \"%s\"", mote_error_text(), part);
}

TEST(mote_impact_query_bad_arrays_are_refused)
{
    impact_scene s;
    const impact_kind mixed[2] = {IMPACT_RIGID, IMPACT_ARRAYS};
    impact_scene_init_kinds(&s, impact_box(1, 1, 1), impact_box(1, 1, 1), mixed, 1, 10);
    static const double bad[] = {NAN, INFINITY, -INFINITY, 1e19};
    mote_vec3 *at = &s.of[1].frame[1][5];
    double *const number[3] = {&at->x, &at->y, &at->z};
    for (int i = 0; i < 12; ++i) {
        *number[i / 4] = bad[i % 4];
        check_refused(&s, "body 1: in frame 1 of its path vertex 5 is at");
        *number[i / 4] = 0;
    }
    const mote_positions kept = s.of[1].positions[0];
    s.of[1].positions[0].data = NULL;
    check_refused(&s, "body 1 has no positions");
    s.of[1].positions[0] = kept;
    s.of[1].positions[0].stride = 20;
    check_refused(&s, "body 1 has a stride of 20 bytes");
    s.of[1].positions[0] = kept;
    s.of[1].path.positions = NULL;
    check_refused(&s, "of body 1 only positions are known");
    s.of[1].path.positions = s.of[1].positions;
    s.of[1].path.count = 2;
    check_refused(&s, "give both as many");
    s.of[1].path.count = 1;
    s.of[0].path.positions = s.of[1].positions;
    check_refused(&s, "body 0 has a field");
    impact_scene_free(&s);
}

/* Frames outside of the interval that is asked about are not read: they may not be there yet.
 */
TEST(mote_impact_query_reads_no_frame_beyond_the_interval)
{
    for (uint32_t patience = 0; patience <= 10; patience += 10) {
        impact_scene s;
        impact_scene_init_kinds(&s, make_torus(9, 5, 1), impact_box(1, 1, 1), arrays, 3,
                                patience);
        const impact_wild still = {.pieces = 2, .from = {0, 0, 0}, .to = {0, 0, 0}};
        const impact_wild w = {
            .pieces = 2, .from = {4, 0, 0}, .to = {2, 3, 0}, .turn = 2, .weights = 0.05};
        impact_path_random(&s.of[0], &still, &s.random);
        impact_path_random(&s.of[1], &w, &s.random);
        mote_impact_question question = impact_question(&s, 0);
        question.end = 0.4;
        for (int i = 0; i < 2; ++i)
            s.of[i].positions[2].data = NULL;
        (void)impact_ask(&s, question);
        for (int i = 0; i < 2; ++i) {
            s.of[i].positions[2].data = s.of[i].frame[2];
            s.of[i].positions[0].data = NULL;
            for (uint32_t v = 0; v < s.of[i].mesh->vertex_count; ++v) { /* near, and leaving */
                s.of[i].frame[1][v] =
                    mote_add(s.of[i].mesh->positions[v], mote_vec3_make(0, 0, 10.0 * i));
                s.of[i].frame[2][v] =
                    mote_add(s.of[i].mesh->positions[v], mote_vec3_make(0, 0, 200.0 * i));
            }
        }
        /* the lowest of the box, just above the highest of the torus */
        const double gap = 10 + s.of[1].mesh->low.z - s.of[0].mesh->high.z - 1e-5;
        for (uint32_t v = 0; v < s.of[1].mesh->vertex_count; ++v)
            s.of[1].frame[1][v].z -= gap;
        question.begin = 0.5;
        question.end = 1;
        const mote_impact_found found = impact_ask(&s, question);
        assert_int_equal(found.outcome, MOTE_IMPACT_NONE);
        impact_scene_free(&s);
    }
}

/* Bodies of several blocks of leaves, that crumple as they move: no sample before the bracket
   is in contact, and at its end all pairs of triangles are. */
TEST(mote_impact_query_arrays_of_many_leaves_agree_with_samples)
{
    int impacts = 0;
    for (int k = 0; k < 6; ++k) {
        impact_scene s;
        impact_scene_init_kinds(&s, make_torus(30, 12, 1), impact_box(1, 0.8, 0.3), arrays,
                                (uint64_t)k, k % 2 ? 0 : 10);
        assert_true(s.search->certificate->side[0].tree->block_count > 2);
        const impact_wild w = {.pieces = 1 + (uint32_t)k % 3,
                               .from = {3, 0.4 * k - 1, 0},
                               .to = {-1, 0.3, 0.5},
                               .stray = 0.3,
                               .turn = 1,
                               .weights = 0.02};
        impact_wild still = w;
        still.from = still.to = (mote_vec3){0, 0, 0};
        impact_path_random(&s.of[0], &still, &s.random);
        impact_path_random(&s.of[1], &w, &s.random);
        const double tolerance = k % 2 ? 0.02 : 0;
        const mote_impact_found found = ask(&s, tolerance);
        for (int i = 0; i < 40; ++i)
            assert_true(impact_distance(&s, i / 40.0 * found.from) > tolerance);
        if (found.outcome == MOTE_IMPACT_FOUND) {
            ++impacts;
            check_close(impact_distance(&s, found.to), found.distance, 1e-12 * s.length);
            assert_true(found.distance <= tolerance);
        }
        impact_scene_free(&s);
    }
    assert_true(impacts > 2);
}

/* The range of a frame's boxes along x: of the children of the root, in the world. */
static void check_frame(const mote_lines_frame *frame, const mote_cert_tree *tree,
                        const mote_vec3 *at)
{
    float low = HUGE_VALF, high = -HUGE_VALF;
    double least = HUGE_VAL, most = -HUGE_VAL;
    for (uint32_t l = 0; l < tree->blocks[0].children; ++l) {
        low = fminf(low, frame->blocks[0].low[0][l]);
        high = fmaxf(high, frame->blocks[0].high[0][l]);
    }
    for (uint32_t v = 0; v < tree->body->mesh->vertex_count; ++v) {
        least = fmin(least, at[v].x);
        most = fmax(most, at[v].x);
    }
    check_close(frame->middle.x + (double)low / tree->scale, least, 1e-6);
    check_close(frame->middle.x + (double)high / tree->scale, most, 1e-6);
}

/* Whichever pieces were looked at before: each vertex is on its straight line, and the boxes
   are those of both ends. */
TEST(mote_lines_state_of_pieces_in_any_order)
{
    static const double times[] = {0.1, 0.5, 0.9, 0.4, 0.05, 0.95, 0.2, 0.6, 0.3, 1};
    impact_scene s;
    impact_scene_init_kinds(&s, make_torus(30, 12, 1), impact_box(1, 1, 1), arrays, 1, 10);
    const impact_wild w = {.pieces = 3, .to = {4, 1, 0}, .turn = 1, .weights = 0.1};
    impact_path_random(&s.of[0], &w, &s.random);
    mote_lines *lines = s.search->lines[0];
    mote_lines_begin(lines);
    for (size_t i = 0; i < ROWS_OF(times); ++i) {
        double weights[3 * MOTE_LANES];
        mote_body_state state;
        test_row("at %g", times[i]);
        mote_lines_state(lines, &s.of[0].path, times[i], weights, &state);
        impact_place(&s.of[0], times[i]);
        for (uint32_t v = 0; v < s.of[0].mesh->vertex_count; ++v) {
            const mote_vec3 p = mote_body_position(&s.search->body[0], &state, v);
            assert_true(mote_length(mote_sub(p, s.of[0].world[v])) < 1e-14);
        }
        const int piece = times[i] < 1 ? (int)(3 * times[i]) : 2;
        for (int k = 0; k < 2; ++k)
            check_frame(&lines->frame[k], lines->tree, s.of[0].frame[piece + k]);
    }
    impact_scene_free(&s);
}

TEST(mote_impact_query_of_arrays_does_not_allocate)
{
    impact_scene s;
    impact_scene_init_kinds(&s, make_torus(9, 5, 1), make_torus(7, 5, 0.7), arrays, 5, 0);
    const impact_wild w = {.pieces = 3, .from = {3, 0, 0}, .to = {-2, 0, 0}, .weights = 0.1};
    const impact_wild still = {.pieces = 3};
    impact_path_random(&s.of[1], &w, &s.random);
    impact_path_random(&s.of[0], &still, &s.random);
    const mote_impact_question question = impact_question(&s, 0.01);
    mote_impact_found found;
    const uint64_t before = mote_heap_read().allocations;
    assert_int_equal(mote_impact_query(s.search, &question, &found), MOTE_OK);
    assert_int_equal(mote_heap_read().allocations, before);
    assert_int_equal(found.outcome, MOTE_IMPACT_FOUND);
    impact_scene_free(&s);
}
