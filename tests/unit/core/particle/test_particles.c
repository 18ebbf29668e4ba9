/* The paper's particle system: every move against an independent evaluation of the potential in
   long double, the energy, and the invariants of a query. */
#include "tests/support/particle_scene.h"
#include "tests/support/test.h"

enum { MOST = 64 };

/* Where all particles are: sites and places. */
typedef struct snapshot {
    uint32_t count;
    mote_site site[2][MOST];
    mote_vec3 place[2][MOST];
} snapshot;

static void take_snapshot(snapshot *s, const mote_particles *particles)
{
    s->count = mote_particles_count(particles);
    assert_true(s->count <= MOST);
    for (int b = 0; b < 2; ++b) {
        for (uint32_t i = 0; i < s->count; ++i) {
            s->site[b][i] = mote_particles_site(particles, b, i);
            s->place[b][i] = mote_particles_position(particles, b, i);
        }
    }
}

static long double pair_potential(mote_law law, mote_vec3 p, mote_vec3 q, double length,
                                  double reach)
{
    const long double x = ((long double)p.x - q.x) / length;
    const long double y = ((long double)p.y - q.y) / length;
    const long double z = ((long double)p.z - q.z) / length;
    const long double square = fminl(x * x + y * y + z * z, (long double)reach * reach);
    return law == MOTE_LAW_LOG       ? -0.5L * logl(square)
           : law == MOTE_LAW_INVERSE ? 1 / sqrtl(square)
                                     : 1 / square;
}

/* The potential of particle i of body b if it were at place. */
static long double potential_at(const snapshot *s, const mote_particles_options *o,
                                double length, int b, uint32_t i, mote_vec3 place)
{
    long double sum = 0;
    for (uint32_t j = 0; j < s->count; ++j) {
        if (j != i)
            sum += pair_potential(o->repel[b], place, s->place[b][j], length, HUGE_VAL);
        if (o->effective_radius > 0)
            sum -= pair_potential(o->attract[b], place, s->place[1 - b][j], length,
                                  o->effective_radius);
    }
    return sum;
}

/* The energy of all pairs, for particles that all follow one law. */
static long double total_energy(const snapshot *s, const mote_particles_options *o,
                                double length)
{
    long double sum = 0;
    for (uint32_t i = 0; i < s->count; ++i) {
        for (uint32_t j = 0; j < s->count; ++j) {
            for (int b = 0; b < 2 && j < i; ++b)
                sum += pair_potential(o->repel[0], s->place[b][i], s->place[b][j], length,
                                      HUGE_VAL);
            if (o->effective_radius > 0)
                sum -= pair_potential(o->repel[0], s->place[0][i], s->place[1][j], length,
                                      o->effective_radius);
        }
    }
    return sum;
}

typedef struct site_list {
    uint32_t count;
    mote_site site[256];
} site_list;

static void add_site(site_list *list, uint32_t a, uint32_t b, uint32_t c, mote_site except)
{
    uint32_t v[3] = {a, b, c};
    for (int k = 0; k < 3; ++k) { /* bubble sort of three */
        const int m = k % 2;
        if (v[m] > v[m + 1]) {
            const uint32_t swap = v[m];
            v[m] = v[m + 1];
            v[m + 1] = swap;
        }
    }
    mote_site site = {v[0], v[1], v[2]};
    if (site.a == site.b)
        site.b = site.c; /* an edge is (a, b, b) */
    if (mote_site_equal(site, except))
        return;
    for (uint32_t i = 0; i < list->count; ++i) {
        if (mote_site_equal(list->site[i], site))
            return;
    }
    assert_true(list->count < 256);
    list->site[list->count++] = site;
}

static bool face_has(const uint32_t t[3], uint32_t v)
{
    return t[0] == v || t[1] == v || t[2] == v;
}

/* Every other site of the faces that contain this one, found by a search through all faces. */
static void neighbours_by_faces(const mote_mesh *mesh, mote_site site, bool surface,
                                site_list *list)
{
    list->count = 0;
    for (uint32_t f = 0; f < mesh->triangle_count; ++f) {
        const uint32_t *t = mesh->triangles[f];
        if (!face_has(t, site.a) || !face_has(t, site.b) || !face_has(t, site.c))
            continue;
        for (int k = 0; k < 3; ++k) {
            add_site(list, t[k], t[k], t[k], site);
            if (surface)
                add_site(list, t[k], t[(k + 1) % 3], t[k], site);
        }
        if (surface)
            add_site(list, t[0], t[1], t[2], site);
    }
}

static mote_vec3 place_of(const particle_scene *s, int b, mote_site site)
{
    const mote_vec3 p = scene_vertex(s, b, site.a);
    const mote_vec3 q = scene_vertex(s, b, site.b);
    const mote_vec3 r = scene_vertex(s, b, site.c);
    if (site.b == site.c)
        return mote_scale(mote_add(p, q), 0.5);
    return mote_scale(mote_add(mote_add(p, q), r), 1.0 / 3);
}

static void check_no_two_share_a_site(const snapshot *s)
{
    for (int b = 0; b < 2; ++b) {
        for (uint32_t i = 0; i < s->count; ++i) {
            for (uint32_t j = 0; j < i; ++j)
                assert_false(mote_site_equal(s->site[b][i], s->site[b][j]));
        }
    }
}

/* Follows one sweep, whose moves are known from its start and end: each particle moves at most
   once, after those before it. Returns the number of moves. */
static uint32_t check_sweep(const particle_scene *s, const mote_particles_options *o,
                            snapshot *now, const snapshot *after, bool one_law)
{
    uint32_t moves = 0;
    for (int b = 0; b < 2; ++b) {
        for (uint32_t i = 0; i < now->count; ++i) {
            const mote_site chosen = after->site[b][i];
            const long double here = potential_at(now, o, s->length, b, i, now->place[b][i]);
            const long double there = potential_at(now, o, s->length, b, i, after->place[b][i]);
            const bool moved = !mote_site_equal(chosen, now->site[b][i]);
            bool known = !moved;
            long double least = here;
            site_list list;
            neighbours_by_faces(s->b[b].mesh, now->site[b][i], o->surface, &list);
            for (uint32_t k = 0; k < list.count; ++k) {
                const mote_vec3 place = place_of(s, b, list.site[k]);
                least = fminl(least, potential_at(now, o, s->length, b, i, place));
                known |= mote_site_equal(list.site[k], chosen);
            }
            assert_true(known);
            const long double slack = 1e-13L * (now->count + fabsl(least));
            assert_true(there <= least + slack);
            assert_true(!moved || there < here);
            const long double before = one_law ? total_energy(now, o, s->length) : 0;
            now->site[b][i] = chosen;
            now->place[b][i] = after->place[b][i];
            if (one_law && moved)
                assert_true(total_energy(now, o, s->length) < before);
            moves += moved;
        }
    }
    return moves;
}

/* Relaxes frame after frame, one step at a time, and checks each step. Returns the moves. */
static uint64_t follow_moves(particle_scene *s, mote_particles_options *o, int frames,
                             bool one_law)
{
    o->nmax = 1;
    mote_particles *particles = scene_particles(s, o);
    uint64_t all_moves = 0;
    for (int f = 0; f < frames; ++f) {
        scene_next(s, 2.3);
        mote_particles_begin(particles, &s->frame, false);
        for (int step = 0; step < 30; ++step) {
            snapshot before;
            snapshot after;
            mote_counters counters = {0};
            take_snapshot(&before, particles);
            mote_particles_relax(particles, -1, &counters);
            take_snapshot(&after, particles);
            check_no_two_share_a_site(&after);
            const uint32_t moves = check_sweep(s, o, &before, &after, one_law);
            assert_int_equal(counters.steps, 1);
            assert_int_equal(counters.moves, moves);
            assert_int_equal(counters.ended_nmin, moves == 0);
            assert_int_equal(counters.ended_nmax, moves != 0);
            all_moves += moves;
            if (moves == 0)
                break;
        }
    }
    mote_particles_destroy(particles);
    return all_moves;
}

TEST(relax_moves_to_the_lowest_neighbour_and_energy_falls)
{
    const uint32_t counts[] = {1, 2, 5, 16, 40};
    const double reaches[] = {1, INFINITY, 0.3, 0};
    for (int k = 0; k < 20; ++k) {
        particle_scene s;
        scene_open(&s, solid_icosphere(2), solid_torus(12, 7), 6, 1);
        mote_particles_options o = mote_default_particles_options();
        o.count = counts[k % 5];
        o.effective_radius = reaches[k / 5];
        o.start = k % 2 ? MOTE_START_RANDOM : MOTE_START_FARTHEST;
        const uint64_t moves = follow_moves(&s, &o, 3, true);
        assert_true(moves > o.count || o.effective_radius < 1);
        assert_true(moves == 0 || o.count > 1 || o.effective_radius > 0);
        scene_close(&s);
    }
}

TEST(relax_with_each_law_moves_to_the_lowest_neighbour)
{
    for (int k = 0; k < 9; ++k) {
        particle_scene s;
        scene_open(&s, solid_icosphere(2), solid_grid(9, 9), -2, 1);
        mote_particles_options o = mote_default_particles_options();
        o.count = 9;
        for (int b = 0; b < 2; ++b) {
            o.attract[b] = (mote_law)((k + b) % 3);
            o.repel[b] = (mote_law)(k / 3);
        }
        assert_true(follow_moves(&s, &o, 3, false) > 9);
        for (int b = 0; b < 2; ++b)
            o.attract[b] = o.repel[b] = (mote_law)(k % 3);
        assert_true(follow_moves(&s, &o, 3, true) > 9);
        scene_close(&s);
    }
}

TEST(relax_over_the_surface_moves_to_the_lowest_neighbour)
{
    particle_scene s;
    scene_open(&s, solid_icosphere(1), solid_grid(5, 5), 5, 1);
    mote_particles_options o = mote_default_particles_options();
    o.count = 7;
    o.surface = true;
    assert_true(follow_moves(&s, &o, 5, true) > 7);
    scene_close(&s);
}

TEST(relax_on_open_and_bow_tie_meshes_moves_to_the_lowest_neighbour)
{
    for (int surface = 0; surface <= 1; ++surface) {
        particle_scene s;
        solid tie = solid_join(solid_icosphere(1), solid_grid(3, 2), 3);
        solid_weld(&tie, 42, 0);
        scene_open(&s, tie, solid_fan(30, 0), 5, 1);
        mote_particles_options o = mote_default_particles_options();
        o.count = 5;
        o.surface = surface;
        assert_true(follow_moves(&s, &o, 4, true) > 5);
        scene_close(&s);
    }
}

TEST(query_distance_is_never_below_the_truth)
{
    particle_scene s;
    scene_open(&s, solid_icosphere(1), solid_torus(9, 6), 6, 1);
    for (int surface = 0; surface <= 1; ++surface) {
        mote_particles_options o = mote_default_particles_options();
        o.count = 6;
        o.surface = surface;
        mote_particles *particles = scene_particles(&s, &o);
        for (int f = 0; f < 30; ++f) {
            scene_next(&s, 1.5 + 0.05 * f);
            mote_counters counters = {0};
            const double distance = scene_query(&s, particles, &counters);
            assert_true(distance >= scene_truth(&s) - 1e-15 * s.length);
        }
        mote_particles_destroy(particles);
    }
    scene_close(&s);
}

TEST(closest_matches_all_pairs)
{
    particle_scene s;
    scene_open(&s, solid_icosphere(2), solid_icosphere(1), 0, 1);
    const uint32_t counts[] = {1, 7, 8, 9, 42};
    for (int k = 0; k < 5; ++k) {
        mote_particles_options o = mote_default_particles_options();
        o.count = counts[k];
        mote_particles *particles = scene_particles(&s, &o);
        for (int f = 0; f < 10; ++f) {
            scene_next(&s, 1);
            mote_particles_begin(particles, &s.frame, false);
            snapshot now;
            take_snapshot(&now, particles);
            uint32_t pair[2];
            const double got = mote_particles_closest(particles, pair);
            double least = HUGE_VAL;
            for (uint32_t i = 0; i < o.count; ++i) {
                for (uint32_t j = 0; j < o.count; ++j)
                    least =
                        fmin(least, mote_distance_squared(now.place[0][i], now.place[1][j]));
            }
            assert_true(got == least);
            assert_true(mote_distance_squared(now.place[0][pair[0]], now.place[1][pair[1]]) ==
                        least);
        }
        mote_particles_destroy(particles);
    }
    scene_close(&s);
}

TEST(query_with_a_particle_on_every_vertex_never_moves)
{
    particle_scene s;
    scene_open(&s, solid_icosphere(1), solid_icosphere(1), 5, 1);
    mote_particles_options o = mote_default_particles_options();
    o.count = 42;
    mote_particles *particles = scene_particles(&s, &o);
    for (int f = 0; f < 5; ++f) {
        scene_next(&s, 1.9);
        mote_counters counters = {0};
        const double distance = scene_query(&s, particles, &counters);
        assert_int_equal(counters.moves, 0);
        assert_int_equal(counters.steps, 1);
        double least = HUGE_VAL;
        for (uint32_t v = 0; v < 42 * 42; ++v)
            least = fmin(least, mote_distance_squared(scene_vertex(&s, 0, v % 42),
                                                      scene_vertex(&s, 1, v / 42)));
        assert_true(distance == sqrt(least));
    }
    mote_particles_destroy(particles);
    scene_close(&s);
}

/* The number of particles of body 0 on a vertex. */
static int count_on(const snapshot *s, uint32_t vertex)
{
    int count = 0;
    for (uint32_t i = 0; i < s->count; ++i)
        count += s->site[0][i].a == vertex;
    return count;
}

/* Two different vertices in one place, each with a particle: one leaves at the first chance. If
   every vertex is taken, none moves onto another. */
TEST(query_with_coincident_starts_separates_them)
{
    solid sheet = solid_grid(3, 3);
    solid_set_vertex(&sheet, 5, sheet.xyz[18], sheet.xyz[19], sheet.xyz[20]); /* onto 6 */
    particle_scene s;
    scene_open(&s, sheet, solid_icosphere(1), 0, 1);
    mote_particles_options o = mote_default_particles_options();
    o.start = MOTE_START_RANDOM;
    const uint32_t counts[] = {2, 8, 16};
    for (int k = 0; k < 3; ++k) {
        o.count = counts[k];
        int found = 0;
        for (o.seed = 1; o.seed < 1000 && found < 3; ++o.seed) {
            mote_particles *particles = scene_particles(&s, &o);
            scene_next(&s, 2);
            mote_particles_begin(particles, &s.frame, false);
            snapshot now;
            take_snapshot(&now, particles);
            if (count_on(&now, 5) + count_on(&now, 6) == 2) {
                ++found;
                const snapshot before = now;
                mote_counters counters = {0};
                mote_particles_relax(particles, -1, &counters);
                take_snapshot(&now, particles);
                check_no_two_share_a_site(&now);
                if (o.count == 16)
                    assert_memory_equal(now.site[0], before.site[0], 16 * sizeof(mote_site));
                else
                    assert_true(count_on(&now, 5) + count_on(&now, 6) < 2);
            }
            mote_particles_destroy(particles);
        }
        assert_int_equal(found, 3);
    }
    scene_close(&s);
}

/* Without attraction the bodies do not affect each other. */
TEST(relax_without_reach_ignores_the_other_body)
{
    particle_scene s;
    scene_open(&s, solid_icosphere(2), solid_torus(12, 7), 6, 1);
    mote_particles_options o = mote_default_particles_options();
    o.count = 9;
    o.effective_radius = 0;
    snapshot ends[2];
    for (int far = 0; far <= 1; ++far) {
        mote_particles *particles = scene_particles(&s, &o);
        s.seed = 77;
        scene_next(&s, 2);
        s.frame.body[1].pose.translation.y += far ? 1e6 : 0;
        mote_counters counters = {0};
        (void)scene_query(&s, particles, &counters);
        assert_true(counters.moves > 0);
        take_snapshot(&ends[far], particles);
        mote_particles_destroy(particles);
    }
    for (int b = 0; b < 2; ++b)
        assert_memory_equal(ends[0].site[b], ends[1].site[b], 9 * sizeof(mote_site));
    scene_close(&s);
}

TEST(relax_again_in_the_same_frame_moves_nothing)
{
    particle_scene s;
    scene_open(&s, solid_icosphere(2), solid_torus(12, 7), 6, 1);
    mote_particles_options o = mote_default_particles_options();
    o.count = 12;
    o.nmax = 1000;
    mote_particles *particles = scene_particles(&s, &o);
    for (int f = 0; f < 10; ++f) {
        scene_next(&s, 2);
        mote_counters first = {0};
        mote_counters second = {0};
        const double distance = scene_query(&s, particles, &first);
        assert_int_equal(first.ended_nmin, 1);
        assert_true(scene_query(&s, particles, &second) == distance);
        assert_int_equal(second.steps, 1);
        assert_int_equal(second.moves, 0);
    }
    mote_particles_destroy(particles);
    scene_close(&s);
}

TEST(query_not_coherent_answers_as_the_first_one)
{
    particle_scene s;
    scene_open(&s, solid_icosphere(2), solid_torus(12, 7), 6, 1);
    mote_particles_options o = mote_default_particles_options();
    o.coherent = false;
    mote_particles *lasting = scene_particles(&s, &o);
    for (int f = 0; f < 10; ++f) {
        scene_next(&s, 2);
        mote_particles *fresh = scene_particles(&s, &o);
        mote_counters counters[2];
        memset(counters, 0, sizeof counters);
        const double a = scene_query(&s, lasting, &counters[0]);
        const double b = scene_query(&s, fresh, &counters[1]);
        assert_true(a == b);
        assert_memory_equal(&counters[0], &counters[1], sizeof counters[0]);
        mote_particles_destroy(fresh);
    }
    mote_particles_destroy(lasting);
    scene_close(&s);
}

TEST(relax_ends_by_nmin_nmax_and_stop_distance)
{
    particle_scene s;
    scene_open(&s, solid_icosphere(3), solid_icosphere(2), 0, 1);
    mote_particles_options o = mote_default_particles_options();
    o.count = 20;
    for (uint32_t nmin = 0; nmin <= 40; nmin += 5) {
        o.nmin = nmin;
        o.nmax = 3 + nmin;
        mote_particles *particles = scene_particles(&s, &o);
        scene_next(&s, 2.5);
        mote_counters counters = {0};
        (void)scene_query(&s, particles, &counters);
        assert_int_equal(counters.ended_nmin + counters.ended_nmax, 1);
        assert_true(counters.steps <= o.nmax);
        assert_true(!counters.ended_nmax || counters.steps == o.nmax);
        assert_true(counters.moves >= (counters.steps - counters.ended_nmin) * nmin);
        mote_particles_destroy(particles);
    }
    o.nmax = 0;
    mote_particles *particles = scene_particles(&s, &o);
    mote_counters none = {0};
    (void)scene_query(&s, particles, &none);
    assert_true(none.steps == 0 && none.moves == 0 && none.ended_nmax == 1);
    mote_particles_destroy(particles);
    o.nmax = 64;
    particles = scene_particles(&s, &o);
    mote_counters stopped = {0};
    mote_particles_begin(particles, &s.frame, false);
    mote_particles_relax(particles, 10 * s.length, &stopped);
    assert_int_equal(stopped.steps, 0);
    mote_particles_destroy(particles);
    scene_close(&s);
}

TEST(query_with_given_positions_evaluates_none)
{
    particle_scene s;
    scene_open(&s, solid_icosphere(2), solid_torus(12, 7), 6, 1);
    mote_particles_options o = mote_default_particles_options();
    mote_particles *lazy = scene_particles(&s, &o);
    mote_particles *given = scene_particles(&s, &o);
    for (int f = 0; f < 10; ++f) {
        mote_vec3 world[2][162];
        scene_next(&s, 2);
        for (int b = 0; b < 2; ++b) {
            for (uint32_t v = 0; v < s.b[b].mesh->vertex_count; ++v)
                world[b][v] = scene_vertex(&s, b, v);
            s.frame.body[b].vertices = world[b];
        }
        mote_counters counters[2];
        memset(counters, 0, sizeof counters);
        const double distance = scene_query(&s, lazy, &counters[0]);
        mote_particles_begin(given, &s.frame, true);
        mote_particles_relax(given, -1, &counters[1]);
        uint32_t pair[2];
        assert_true(sqrt(mote_particles_closest(given, pair)) == distance);
        assert_memory_equal(&counters[0], &counters[1], sizeof counters[0]);
    }
    assert_true(mote_particles_lazy(lazy, 0)->evaluated > 0);
    assert_int_equal(mote_particles_lazy(given, 0)->evaluated, 0);
    assert_int_equal(mote_particles_lazy(given, 1)->evaluated, 0);
    mote_particles_destroy(lazy);
    mote_particles_destroy(given);
    scene_close(&s);
}

TEST(create_without_particles_says_the_range)
{
    particle_scene s;
    scene_open(&s, solid_icosphere(1), solid_icosphere(0), 0, 1);
    mote_particles_options options = mote_default_particles_options();
    options.count = 0;
    mote_particles *particles = NULL;
    assert_int_equal(mote_particles_create(s.bodies, s.length, &options, &particles),
                     MOTE_EINVAL);
    assert_string_equal(mote_error_text(),
                        "n=0 is not valid; body 0 has 42 vertices, so n must be from 1 to 42");
    assert_null(particles);
    scene_close(&s);
}
