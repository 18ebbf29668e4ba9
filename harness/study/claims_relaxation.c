/* The paper's claims about relaxation: d, e, f. */
#include "harness/study/claims.h"

#include "harness/base/memory.h"
#include "core/particle/particles.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PARTICLES 5

/* The number of hops from a vertex to the farthest of others; queue and hops hold
   vertex_count. */
static uint32_t farthest_hops(const mote_mesh *mesh, uint32_t from, const uint32_t *others,
                              uint32_t *queue, uint32_t *hops)
{
    memset(hops, 0xff, mesh->vertex_count * sizeof *hops);
    uint32_t head = 0, tail = 0;
    queue[tail++] = from;
    hops[from] = 0;
    while (head < tail) {
        const uint32_t v = queue[head++];
        for (uint32_t k = mesh->ring_start[v]; k < mesh->ring_start[v + 1]; ++k) {
            const uint32_t u = MOTE_RING_VERTEX(mesh->ring[k]);
            if (hops[u] == UINT32_MAX) {
                hops[u] = hops[v] + 1;
                queue[tail++] = u;
            }
        }
    }
    uint32_t most = 0;
    for (int i = 0; i < PARTICLES; ++i)
        most = hops[others[i]] != UINT32_MAX && hops[others[i]] > most ? hops[others[i]] : most;
    return most;
}

/* The longest shortest route between two particles at their initial positions: vertices between
   them. */
static mote_status longest_route(const mote_scenario *scenario, uint64_t seed, double *route)
{
    double most = 0;
    for (int b = 0; b < 2; ++b) {
        const mote_mesh *mesh = scenario->body[b].mesh;
        uint32_t starts[PARTICLES];
        mote_status status =
            mote_start_vertices(mesh, PARTICLES, MOTE_START_RANDOM, seed + (uint64_t)b, starts);
        if (status != MOTE_OK)
            return status;
        uint32_t *work = mote_allocate(2 * (size_t)mesh->vertex_count, sizeof *work);
        for (int i = 0; i < PARTICLES; ++i)
            most = fmax(
                most, farthest_hops(mesh, starts[i], starts, work, work + mesh->vertex_count));
        free(work);
    }
    *route = most;
    return MOTE_OK;
}

/* The 95th percentile and the maximum of the number of steps of a query until nothing moves. */
static mote_status steps_to_rest(const mote_subject *subject, bool cold, uint64_t seed,
                                 double steps[2])
{
    const mote_tour tours[2] = {{.first = 900, .last = 1300, .seed = seed},
                                {.first = 10, .last = 1970, .stride = 40, .seed = seed}};
    mote_cell_result result;
    mote_status status =
        mote_study_measure(subject,
                           cold ? "particle-paper:n=5,nmin=1,nmax=1000000000,coherent=no"
                                : "particle-paper:n=5,nmin=1,nmax=1000000000",
                           tours[cold ? 1 : 0], &result);
    if (status != MOTE_OK)
        return status;
    double *all = mote_allocate(result.row_count, sizeof *all);
    /* The first warm query starts cold. */
    const size_t from = cold ? 0 : 1;
    const size_t count = result.row_count - from;
    for (size_t i = from; i < result.row_count; ++i)
        all[i - from] = (double)result.rows[i].answer.counters.steps;
    mote_statistics_sort(all, count);
    steps[0] = mote_statistics_quantile(all, count, 0.95);
    steps[1] = all[count - 1];
    free(all);
    mote_cell_result_free(&result);
    return MOTE_OK;
}

#define SIZES 8
#define ROUTE_SEEDS 4

/* Values for each size and seed. */
typedef struct route_data {
    double vertices[SIZES];
    double cold[SIZES][ROUTE_SEEDS], warm[SIZES][ROUTE_SEEDS], route[SIZES][ROUTE_SEEDS];
    double cold_ratio[ROUTE_SEEDS], most_ratio[ROUTE_SEEDS]; /* over sizes: mean, largest */
    double root_ratio[ROUTE_SEEDS]; /* mean over sizes of cold steps / sqrt(vertices) */
    size_t count;                   /* sizes measured so far */
} route_data;

static mote_status measure_size(const mote_subject *subject, size_t sizes, route_data *d,
                                mote_text *curve)
{
    const double vertices = subject->scenario->body[0].mesh->vertex_count;
    const size_t at = d->count++;
    d->vertices[at] = vertices;
    for (uint64_t s = 0; s < ROUTE_SEEDS; ++s) {
        double cold[2] = {0, 0}, warm[2] = {0, 0}, route = 0;
        mote_status status = steps_to_rest(subject, true, s + 1, cold);
        if (status == MOTE_OK)
            status = steps_to_rest(subject, false, s + 1, warm);
        if (status == MOTE_OK)
            status = longest_route(subject->scenario, s + 1, &route);
        if (status != MOTE_OK)
            return status;
        d->cold[at][s] = cold[0];
        d->warm[at][s] = fmax(warm[0], 1);
        d->route[at][s] = route;
        d->cold_ratio[s] += cold[0] / route / (double)sizes;
        d->root_ratio[s] += cold[0] / sqrt(vertices) / (double)sizes;
        d->most_ratio[s] = fmax(d->most_ratio[s], cold[1] / route);
        mote_text_add(curve, "%g\t%g\t%g\t%g\t%g\t%g\n", vertices, cold[0], warm[0], route,
                      cold[1], sqrt(vertices));
    }
    return MOTE_OK;
}

static mote_status add_exponent(mote_claim *claim, const route_data *d,
                                const double steps[][ROUTE_SEEDS], const char *name)
{
    mote_estimate exponent;
    const mote_status status =
        mote_estimate_exponent(d->vertices, steps[0], d->count, ROUTE_SEEDS, &exponent);
    if (status == MOTE_OK)
        mote_claim_add(claim, exponent, "", "exponent of %s over vertices", name);
    return status;
}

static mote_status fill_route(mote_claim *claim, const route_data *d)
{
    const mote_estimate mean = mote_estimate_make(d->cold_ratio, ROUTE_SEEDS);
    mote_claim_add(claim, mean, "",
                   "cold steps (95th percentile) / longest route, mean over sizes");
    mote_claim_require(claim, MOTE_AT_MOST, 1, 2);
    mote_claim_add(claim, mean, "",
                   "the same, from below: a bound that is not needlessly large");
    mote_claim_require(claim, MOTE_AT_LEAST, 0.5, 0.25);
    mote_claim_add(claim, mote_estimate_make(d->most_ratio, ROUTE_SEEDS), "",
                   "the longest cold query / longest route, worst size");
    mote_claim_require(claim, MOTE_AT_MOST, 1.5, MOTE_NONE);
    mote_claim_add(claim, mote_estimate_make(d->root_ratio, ROUTE_SEEDS), "",
                   "cold steps / sqrt(vertices), our default N_max");
    mote_status status = add_exponent(claim, d, d->cold, "cold steps");
    if (status == MOTE_OK)
        status = add_exponent(claim, d, d->route, "the longest route");
    if (status == MOTE_OK)
        status = add_exponent(claim, d, d->warm, "warm steps");
    return status;
}

mote_status mote_claim_longest_route(mote_study *study, mote_claim *claim)
{
    claim->id = "d";
    claim->section = "3.5";
    claim->claim =
        "N_max should be about the longest shortest route between particles, counted "
        "in vertices";
    claim->measured =
        "steps until nothing moves, W-W of 500 to 1,000,000 triangles, n = 5, "
        "against the routes between the first places; cold: from these places anew";
    claim->curve = "figures/claim_d.dat";
    static const size_t sizes[SIZES] = {500, 1600, 5000, 12000, 30000, 100000, 300000, 1000000};
    const size_t count = study->quick ? 5 : SIZES;
    route_data d = {.count = 0};
    mote_text curve = {0};
    mote_status status = MOTE_OK;
    for (size_t i = 0; i < count && status == MOTE_OK; ++i) {
        char name[32];
        (void)snprintf(name, sizeof name, "ww-%zu", sizes[i]);
        const mote_variant variant = {"ww", name, '\0', sizes[i], false};
        const mote_subject *subject = NULL;
        status = mote_study_variant(study, &variant, &subject);
        if (status == MOTE_OK)
            status = measure_size(subject, count, &d, &curve);
    }
    if (status == MOTE_OK)
        status = fill_route(claim, &d);
    if (status == MOTE_OK)
        status = mote_study_plot(study, "claim_d", &curve);
    free(curve.data);
    return status;
}

/* Statistics of the relaxation of one seed's queries. */
typedef struct relaxation {
    double moving, steps_counted; /* sum of shares of particles that moved; number of steps */
    double steps, steps_saved;    /* until rest; of these, after the stop by N_min */
    double *change;               /* [frames] |closest at the stop - closest at rest| / L */
    size_t frames;
} relaxation;

#define STEPS_MAX 4096

/* Steps one query to rest. The second half of its steps is "near equilibrium". */
static void relax_query(mote_particles *particles, double length, relaxation *r)
{
    const double all = 2.0 * mote_particles_count(particles);
    const uint32_t nmin = mote_particles_count(particles) / 10;
    double share[STEPS_MAX];
    double stopped = MOTE_NONE;
    size_t steps = 0, stop = 0;
    uint32_t pair[2];
    for (uint64_t moved = 1; moved > 0 && steps < STEPS_MAX; ++steps) {
        mote_counters counters = {0};
        mote_particles_relax(particles, -1, &counters);
        moved = counters.moves;
        share[steps] = (double)moved / all;
        if (stopped != stopped && moved < (nmin > 1 ? nmin : 1)) {
            stopped = sqrt(mote_particles_closest(particles, pair));
            stop = steps + 1;
        }
    }
    /* Nothing moved in the last step. */
    for (size_t i = (steps - 1) / 2; i + 1 < steps; ++i) {
        r->moving += share[i];
        r->steps_counted += 1;
    }
    r->steps += (double)steps;
    r->steps_saved += (double)(steps - stop);
    r->change[r->frames++] =
        fabs(stopped - sqrt(mote_particles_closest(particles, pair))) / length;
}

static mote_status relax_frames(const mote_scenario *scenario, uint32_t n, bool cold,
                                uint64_t seed, relaxation *r)
{
    const mote_body *const bodies[2] = {&scenario->body[0], &scenario->body[1]};
    mote_particles_options options = mote_default_particles_options();
    options.count = n;
    options.nmax = 1; /* one step per call */
    options.nmin = 1;
    options.start = MOTE_START_RANDOM;
    options.seed = seed;
    options.coherent = !cold;
    mote_particles *particles = NULL;
    mote_frame_buffer *buffer = NULL;
    mote_status status = mote_particles_create(bodies, scenario->length, &options, &particles);
    if (status == MOTE_OK)
        buffer = mote_frame_buffer_create(scenario);
    for (uint32_t number = 900; number <= 1300 && status == MOTE_OK; number += cold ? 8 : 1) {
        mote_particles_begin(particles, mote_scenario_frame(scenario, buffer, number, 0),
                             false);
        relax_query(particles, scenario->length, r);
    }
    mote_frame_buffer_destroy(buffer);
    mote_particles_destroy(particles);
    return status;
}

/* Adds values for one n, cold or warm. Only cold queries decide: a warm query is almost at rest
   at its start, so almost nothing moves in its steps. */
static mote_status add_near_rest(const mote_study *study, const mote_subject *subject,
                                 uint32_t n, bool cold, mote_claim *claim)
{
    double moving[MOTE_STUDY_SEEDS], change[MOTE_STUDY_SEEDS], saved[MOTE_STUDY_SEEDS];
    double off[MOTE_STUDY_SEEDS];
    double *changes = mote_allocate(512, sizeof *changes);
    mote_status status = MOTE_OK;
    for (size_t s = 0; s < study->seeds && status == MOTE_OK; ++s) {
        relaxation r = {.change = changes};
        status = relax_frames(subject->scenario, n, cold, s + 1, &r);
        if (status != MOTE_OK)
            break;
        mote_statistics_sort(r.change, r.frames);
        moving[s] = r.steps_counted > 0 ? r.moving / r.steps_counted : 0;
        off[s] = fmax(moving[s], 0.1) / fmax(fmin(moving[s], 0.1), 1e-3);
        change[s] = mote_statistics_quantile(r.change, r.frames, 0.95);
        saved[s] = r.steps_saved / r.steps;
    }
    free(changes);
    if (status != MOTE_OK)
        return status;
    const char *kind = cold ? "cold" : "warm";
    mote_claim_add(claim, mote_estimate_make(moving, study->seeds), "",
                   "%s, n = %u: share of particles moving near rest", kind, n);
    if (cold) {
        mote_claim_add(claim, mote_estimate_make(off, study->seeds), "",
                       "%s, n = %u: that share is off 10 %% by a factor of", kind, n);
        mote_claim_require(claim, MOTE_AT_MOST, 2, MOTE_NONE);
    }
    mote_claim_add(claim, mote_estimate_make(change, study->seeds), "L",
                   "%s, n = %u: distance changes after the stop, 95th percentile", kind, n);
    mote_claim_require(claim, MOTE_AT_MOST, 0.01, 0.01);
    mote_claim_add(claim, mote_estimate_make(saved, study->seeds), "",
                   "%s, n = %u: share of the steps that the stop saves", kind, n);
    return MOTE_OK;
}

mote_status mote_claim_almost_at_rest(mote_study *study, mote_claim *claim)
{
    claim->id = "e";
    claim->section = "3.5";
    claim->claim =
        "about 10 % of the particles still move near equilibrium, so that N_min should "
        "be n / 10";
    claim->measured =
        "share of particles that move in a step, second half of the steps to rest "
        "of a query, W-W; closest distance at the stop by n / 10 against rest";
    const mote_subject *subject;
    static const uint32_t numbers[] = {64, 20};
    mote_status status = mote_study_scene(study, "ww", &subject);
    for (int cold = 1; cold >= 0; --cold) {
        for (int i = 0; i < 2 && status == MOTE_OK; ++i)
            status = add_near_rest(study, subject, numbers[i], cold != 0, claim);
    }
    return status;
}

#define WARM_QUERY 50
#define SAME_ANSWER 1e-9 /* of L */
#define PAIRS 8
#define BLOCK 62

/* The share of queries, from query 50 on, for which two starts agree; also added to agree[] by
   blocks of queries. */
static mote_status compare_starts(const mote_subject *subject, const char *method,
                                  uint64_t seed, double *share, double *agree)
{
    mote_cell_result a, b;
    const mote_tour first = {.seed = seed}, second = {.seed = seed + 1000};
    mote_status status = mote_study_measure(subject, method, first, &a);
    if (status != MOTE_OK)
        return status;
    status = mote_study_measure(subject, method, second, &b);
    if (status == MOTE_OK) {
        double same = 0, counted = 0;
        for (size_t i = 0; i < a.row_count; ++i) {
            const double apart = fabs(a.rows[i].answer.distance - b.rows[i].answer.distance);
            const bool equal = apart <= SAME_ANSWER * subject->scenario->length;
            agree[i / BLOCK] += equal ? 1 : 0;
            counted += a.rows[i].frame >= WARM_QUERY ? 1 : 0;
            same += equal && a.rows[i].frame >= WARM_QUERY ? 1 : 0;
        }
        *share = same / counted;
        mote_cell_result_free(&b);
    }
    mote_cell_result_free(&a);
    return status;
}

static mote_status add_starts(const mote_study *study, const mote_subject *subject,
                              const char *method, const char *name, mote_claim *claim,
                              mote_text *curve)
{
    double shares[PAIRS], agree[4096 / BLOCK + 1] = {0};
    const size_t pairs = study->quick ? 3 : PAIRS;
    mote_status status = MOTE_OK;
    for (size_t k = 0; k < pairs && status == MOTE_OK; ++k)
        status = compare_starts(subject, method, k + 1, &shares[k], agree);
    if (status != MOTE_OK)
        return status;
    mote_text_add(curve, "%s\"%s\"\n", curve->size ? "\n\n" : "", name);
    const uint32_t frames = subject->scenario->frames;
    for (uint32_t k = 0; (k + 1) * BLOCK <= frames; ++k)
        mote_text_add(curve, "%u\t%g\n", k * BLOCK + BLOCK / 2,
                      agree[k] / (double)(BLOCK * pairs));
    mote_estimate e = mote_estimate_make(shares, pairs);
    e.interval.low = fmax(e.interval.low, 0);
    e.interval.high = fmin(e.interval.high, 1);
    mote_claim_add(claim, e, "", "%s: share of later queries on which two starts agree", name);
    return MOTE_OK;
}

mote_status mote_claim_initial_places(mote_study *study, mote_claim *claim)
{
    claim->id = "f";
    claim->section = "3.3";
    claim->claim = "initial positions affect only the first query";
    claim->measured =
        "two random starts, same frames: share of queries from the 50th on with the "
        "same distance to 1e-9 L";
    claim->curve = "figures/claim_f.dat";
    static const struct {
        const char *scene, *method, *name;
        bool decides;
    } cases[] = {
        {"ww", "particle-paper:n=5", "W-W, n = 5", true},
        {"tt", "particle-paper:n=3", "T-T, n = 3", true},
        {"ww", "particle-paper:n=16", "W-W, n = 16", false},
        {"ww", "particle-paper:n=64", "W-W, n = 64", false},
        {"ww", "particle-paper:n=16,refine=always", "W-W, n = 16, exact check", false},
    };
    mote_text curve = {0};
    mote_status status = MOTE_OK;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0] && status == MOTE_OK; ++i) {
        const mote_subject *subject;
        status = mote_study_scene(study, cases[i].scene, &subject);
        if (status == MOTE_OK)
            status = add_starts(study, subject, cases[i].method, cases[i].name, claim, &curve);
        if (status == MOTE_OK && cases[i].decides)
            mote_claim_require(claim, MOTE_AT_LEAST, 0.95, 0.8);
    }
    if (status == MOTE_OK)
        status = mote_study_plot(study, "claim_f", &curve);
    free(curve.data);
    return status;
}
