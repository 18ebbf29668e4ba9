/* Potentials of the forces between particles against sums of logarithms and powers in long
   double, also with the distant ones cached. */
#include "core/particle/far_cache.h"
#include "core/particle/potential.h"

#include "tests/support/solids.h"
#include "tests/support/test.h"

enum { MOST = 300 };

typedef struct crowd {
    double x[MOST], y[MOST], z[MOST];
} crowd;

static void draw_crowd(crowd *c, uint32_t count, double size, uint64_t *seed)
{
    for (uint32_t i = 0; i < count; ++i) {
        const mote_vec3 p = random_vec3(seed, size);
        c->x[i] = p.x;
        c->y[i] = p.y;
        c->z[i] = p.z;
    }
}

static mote_sources sources_of(const crowd *c, uint32_t count, uint32_t skip, mote_law law)
{
    return (mote_sources){
        .x = c->x, .y = c->y, .z = c->z, .count = count, .skip = skip, .law = law};
}

static mote_candidates draw_candidates(double size, uint64_t *seed)
{
    mote_candidates c;
    for (int l = 0; l < MOTE_LANES; ++l) {
        const mote_vec3 p = random_vec3(seed, size);
        c.x[l] = p.x;
        c.y[l] = p.y;
        c.z[l] = p.z;
    }
    return c;
}

/* The sum of the pair potentials with the sign of repulsion; squared distances above cut count
   as cut. */
static long double sum_of(const mote_candidates *c, int lane, const mote_sources *s,
                          double length, long double cut)
{
    long double sum = 0;
    for (uint32_t j = 0; j < s->count; ++j) {
        const long double x = (long double)c->x[lane] - s->x[j];
        const long double y = (long double)c->y[lane] - s->y[j];
        const long double z = (long double)c->z[lane] - s->z[j];
        const long double square = fminl((x * x + y * y + z * z) / length / length, cut);
        if (j == s->skip)
            continue;
        sum += s->law == MOTE_LAW_LOG       ? -0.5L * logl(square)
               : s->law == MOTE_LAW_INVERSE ? 1 / sqrtl(square)
                                            : 1 / square;
    }
    return sum;
}

/* The value represented by the two parts. */
static long double value_of(const mote_potentials *p, int lane, bool log_law)
{
    if (!log_law)
        return p->major[lane];
    return 0.5L * (p->major[lane] * logl(2) + logl(p->minor[lane]));
}

TEST(potential_matches_long_double_for_every_pair_of_laws)
{
    uint64_t seed = 1;
    const uint32_t counts[] = {1, 2, 7, 8, 9, 17, MOST};
    const double reaches[] = {INFINITY, 1, 0.2, 0};
    for (int round = 0; round < 7 * 4 * 9; ++round) {
        const uint32_t count = counts[round % 7];
        const double reach = reaches[round / 7 % 4];
        const mote_law repel = (mote_law)(round / 28 % 3);
        const mote_law attract = (mote_law)(round / 84 % 3);
        const double length = 3.7;
        crowd a;
        crowd b;
        draw_crowd(&a, count, 1, &seed);
        draw_crowd(&b, count, 1, &seed);
        const uint32_t skip = (uint32_t)(random_bits(&seed) % (count + 1));
        const mote_sources same = sources_of(&a, count, skip, repel);
        const mote_sources other = sources_of(&b, count, count, attract);
        const mote_candidates c = draw_candidates(1, &seed);
        mote_potentials p;
        mote_potential(&c, &same, &other, 1 / length / length, reach * reach, &p);
        const bool logs = repel == MOTE_LAW_LOG && attract == MOTE_LAW_LOG;
        for (int l = 0; l < MOTE_LANES; ++l) {
            const long double push = sum_of(&c, l, &same, length, INFINITY);
            const long double pull =
                reach > 0 ? sum_of(&c, l, &other, length, (long double)reach * reach) : 0;
            const long double scale = count + fabsl(push) + fabsl(pull);
            assert_close(value_of(&p, l, logs), push - pull, 1e-14L * scale);
        }
    }
}

TEST(potential_is_ordered_as_its_value)
{
    uint64_t seed = 2;
    for (int round = 0; round < 200; ++round) {
        crowd a;
        crowd b;
        draw_crowd(&a, 20, 1, &seed);
        draw_crowd(&b, 20, 1, &seed);
        const mote_sources same = sources_of(&a, 20, 3, MOTE_LAW_LOG);
        const mote_sources other = sources_of(&b, 20, 20, MOTE_LAW_LOG);
        const mote_candidates c = draw_candidates(1, &seed);
        mote_potentials p;
        mote_potential(&c, &same, &other, 0.1, INFINITY, &p);
        for (int i = 0; i < MOTE_LANES; ++i) {
            assert_true(p.minor[i] >= 1 && p.minor[i] < 2);
            for (int j = 0; j < MOTE_LANES; ++j)
                assert_int_equal(mote_potential_below(&p, i, j),
                                 value_of(&p, i, true) < value_of(&p, j, true));
        }
    }
}

/* Hundreds of factors of 1e-10 or 1e10 leave the range of a double many times over. */
TEST(potential_of_hundreds_at_extreme_distances_stays_exact)
{
    uint64_t seed = 3;
    const double sizes[] = {1e-5, 1, 1e5, 1e9};
    for (int k = 0; k < 4; ++k) {
        crowd a;
        crowd b;
        draw_crowd(&a, MOST, sizes[k], &seed);
        draw_crowd(&b, MOST, 1, &seed);
        const mote_sources same = sources_of(&a, MOST, MOST, MOTE_LAW_LOG);
        const mote_sources other = sources_of(&b, MOST, MOST, MOTE_LAW_LOG);
        const mote_candidates c = draw_candidates(sizes[k], &seed);
        mote_potentials p;
        mote_potential(&c, &same, &other, 1, INFINITY, &p);
        for (int l = 0; l < MOTE_LANES; ++l) {
            const long double push = sum_of(&c, l, &same, 1, INFINITY);
            const long double pull = sum_of(&c, l, &other, 1, INFINITY);
            assert_close(value_of(&p, l, true), push - pull,
                         1e-14L * (fabsl(push) + fabsl(pull) + MOST));
        }
    }
}

/* Lane 0 lies on a particle of the same type, 1 on one of the other, 2 on both, 3 on the moved
   particle, the rest on none. */
TEST(potential_on_a_particle_is_infinite)
{
    uint64_t seed = 4;
    for (int laws = 0; laws < 9; ++laws) {
        crowd a;
        crowd b;
        draw_crowd(&a, 12, 1, &seed);
        draw_crowd(&b, 12, 1, &seed);
        a.x[5] = b.x[6], a.y[5] = b.y[6], a.z[5] = b.z[6];
        mote_candidates c = draw_candidates(1, &seed);
        c.x[0] = a.x[2], c.y[0] = a.y[2], c.z[0] = a.z[2];
        c.x[1] = b.x[3], c.y[1] = b.y[3], c.z[1] = b.z[3];
        c.x[2] = a.x[5], c.y[2] = a.y[5], c.z[2] = a.z[5];
        c.x[3] = a.x[9], c.y[3] = a.y[9], c.z[3] = a.z[9];
        const mote_sources same = sources_of(&a, 12, 9, (mote_law)(laws % 3));
        const mote_sources other = sources_of(&b, 12, 12, (mote_law)(laws / 3));
        mote_potentials p;
        mote_potential(&c, &same, &other, 1, 4, &p);
        assert_true(p.major[0] == HUGE_VAL);
        assert_true(p.major[2] == HUGE_VAL);
        for (int l = 3; l < MOTE_LANES; ++l) {
            assert_true(isfinite(p.major[l]));
            assert_true(mote_potential_below(&p, 1, l));
            assert_true(mote_potential_below(&p, l, 0));
            assert_true(mote_potential_below(&p, l, 2));
        }
        /* no occupied place is better than another */
        assert_false(mote_potential_below(&p, 0, 2));
        assert_false(mote_potential_below(&p, 2, 0));
    }
}

TEST(potential_of_attraction_has_no_jump_at_the_reach)
{
    for (int law = 0; law < 3; ++law) {
        const double zero = 0;
        const mote_sources same = {.law = (mote_law)law};
        const mote_sources other = {&zero, &zero, &zero, 1, 1, (mote_law)law};
        mote_candidates c = {{0}, {0}, {0}};
        const double x[MOTE_LANES] = {0.25, 0.5, 0.75, 0.99999, 1, 1.00001, 2, 1e6};
        memcpy(c.x, x, sizeof x);
        mote_potentials p;
        mote_potential(&c, &same, &other, 1, 1, &p);
        for (int l = 0; l + 1 < MOTE_LANES; ++l)
            assert_int_equal(mote_potential_below(&p, l, l + 1), x[l] < 1);
        assert_close(value_of(&p, 3, law == 0), value_of(&p, 4, law == 0), 3e-5);
        assert_true(value_of(&p, 4, law == 0) == value_of(&p, 7, law == 0));
    }
}

/* The largest error of the differences of potentials at candidates up to h around particle 7
   when an expansion stands for the distant particles. */
static double error_of_expansion(const mote_sources *same, const mote_sources *other, double h)
{
    uint64_t seed = 6;
    const mote_vec3 here = {same->x[7], same->y[7], same->z[7]};
    mote_candidates c = draw_candidates(h, &seed);
    for (int l = 0; l < MOTE_LANES; ++l) {
        c.x[l] += here.x;
        c.y[l] += here.y;
        c.z[l] += here.z;
    }
    mote_far_cache *cache = NULL;
    mote_far_split split;
    mote_potentials p;
    assert_int_equal(mote_far_cache_create(same->count, 0.1, 1.2, 2, &cache), MOTE_OK);
    mote_far_cache_split(cache, 0, 7, here, same, other, INFINITY, &split);
    assert_in_range(split.same.count + split.other.count, 2, same->count);
    mote_potential(&c, &split.same, &split.other, 0.25, INFINITY, &p);
    mote_far_cache_add(&split, &c, 2, &p);
    double most = 0;
    for (int l = 1; l < MOTE_LANES; ++l) {
        const long double truth =
            sum_of(&c, l, same, 2, INFINITY) - sum_of(&c, l, other, 2, INFINITY) -
            sum_of(&c, 0, same, 2, INFINITY) + sum_of(&c, 0, other, 2, INFINITY);
        most = fmax(most, (double)fabsl(p.major[l] - p.major[0] - truth));
        assert_true(p.minor[l] == 0);
    }
    mote_far_cache_destroy(cache);
    return most;
}

/* The truncation error of a second-order potential decreases with the third power. */
TEST(far_cache_with_every_pair_of_laws_is_of_second_order)
{
    uint64_t seed = 5;
    crowd a;
    crowd b;
    draw_crowd(&a, 60, 2, &seed);
    draw_crowd(&b, 60, 2, &seed);
    for (int pair = 0; pair < 9; ++pair) {
        const mote_sources same = sources_of(&a, 60, 7, (mote_law)(pair / 3));
        const mote_sources other = sources_of(&b, 60, 60, (mote_law)(pair % 3));
        const double wide = error_of_expansion(&same, &other, 0.08);
        const double narrow = error_of_expansion(&same, &other, 0.01);
        assert_true(wide > 0 && wide < 0.2);
        assert_true(narrow * 300 < wide);
        assert_true(narrow * 900 > wide);
    }
}

/* An expansion is recomputed once a particle may have moved by more than half of part times the
   near distance. */
TEST(far_cache_keeps_an_expansion_while_all_moved_little)
{
    uint64_t seed = 5;
    crowd a;
    crowd b;
    draw_crowd(&a, 60, 2, &seed);
    draw_crowd(&b, 60, 2, &seed);
    const mote_sources same = sources_of(&a, 60, 7, MOTE_LAW_INVERSE);
    const mote_sources other = sources_of(&b, 60, 60, MOTE_LAW_LOG);
    const mote_vec3 here = {a.x[7], a.y[7], a.z[7]};
    mote_far_cache *cache = NULL;
    mote_far_split split;
    assert_int_equal(mote_far_cache_create(60, 0.1, 0.8, 2, &cache), MOTE_OK);
    mote_far_cache_split(cache, 0, 7, here, &same, &other, INFINITY, &split);
    for (int step = 0; step < 2; ++step) {
        const mote_vec3 there = mote_add(here, mote_vec3_make(0.02 * (step + 1), 0, 0));
        mote_far_cache_moved(cache, 0.025);
        mote_far_cache_step(cache);
        mote_far_cache_split(cache, 0, 7, there, &same, &other, INFINITY, &split);
        assert_true(split.centre.x == (step == 0 ? here.x : there.x));
    }
    const mote_vec3 last = mote_add(here, mote_vec3_make(0.05, 0, 0));
    mote_far_cache_reset(cache);
    mote_far_cache_split(cache, 0, 7, last, &same, &other, INFINITY, &split);
    assert_true(split.centre.x == last.x);
    mote_far_cache_destroy(cache);
}
