#include "core/particle/particles.h"

#include "core/particle/far_cache.h"

#include <math.h>
#include <stdlib.h>

struct mote_particles {
    mote_particles_options options;
    double length, inverse_square_length;
    mote_lazy lazy[2];
    mote_site *site[2];  /* [count] */
    uint32_t *first[2];  /* [count] vertices of the first query */
    mote_far_cache *far; /* NULL when nothing is cached */
    double *place[2][3]; /* world positions by coordinate, [count] each */
};

/* Candidate sites of one particle, one a lane; unused lanes repeat lane 0. */
typedef struct candidate_batch {
    mote_candidates place;
    mote_site site[MOTE_LANES];
    int count;
} candidate_batch;

/* The best candidate so far, and what is needed to judge the next. */
typedef struct move_search {
    mote_particles *particles;
    int body;
    mote_vec3 here;
    mote_far_split
        split; /* what acts: the near particles, and the cached expansion of the others */
    candidate_batch batch;
    mote_site best;
    mote_vec3 best_place;
    double major, minor;
    bool started, moved; /* a candidate was judged; the best is not where the particle is */
} move_search;

mote_particles_options mote_default_particles_options(void)
{
    const mote_particles_options options = {.count = 8,
                                            .effective_radius = 1,
                                            .nmax = 64,
                                            .coherent = true,
                                            .start = MOTE_START_FARTHEST,
                                            .seed = 1};
    return options;
}

static mote_status allocate_body(mote_particles *p, const mote_body *body, int b)
{
    const size_t n = p->options.count;
    p->site[b] = malloc(n * sizeof *p->site[b]);
    p->first[b] = malloc(n * sizeof *p->first[b]);
    p->place[b][0] = calloc(3 * n, sizeof(double));
    if (!p->site[b] || !p->first[b] || !p->place[b][0])
        return mote_fail(MOTE_ENOMEM, "no memory for %zu particles", n);
    p->place[b][1] = p->place[b][0] + n;
    p->place[b][2] = p->place[b][1] + n;
    /* A warm query looks at about one ring for each particle and a few steps. With few
       particles there is room for many steps, so that the table hardly ever grows during a
       query. */
    const uint32_t expected = (uint32_t)fmin(fmax(16.0 * (double)n, 1024), 0x1p28);
    return p->options.single ? mote_lazy_init_single(&p->lazy[b], body, expected)
                             : mote_lazy_init(&p->lazy[b], body, expected);
}

static void place_at_start(mote_particles *p)
{
    for (int b = 0; b < 2; ++b) {
        for (uint32_t i = 0; i < p->options.count; ++i)
            p->site[b][i] = mote_site_vertex(p->first[b][i]);
    }
}

/* Over a ring of radius h the potential of a particle at distance r is quadratic to (h / r)^3.
 */
static double near_distance(const mote_body *const bodies[2])
{
    return 8 * fmax(bodies[0]->mesh->mean_edge, bodies[1]->mesh->mean_edge);
}

/* Floats hold numbers from 1e-38 to 1e38, and a margin is left for positions. */
static mote_status check_single(double length)
{
    if (length >= 1e-30 && length <= 1e30)
        return MOTE_OK;
    return mote_fail(MOTE_EINVAL,
                     "positions in single precision need an L from 1e-30 to 1e30, not %g; use "
                     "double precision, or another unit of length",
                     length);
}

/* Before anything is allocated by it, and before a body's components are looked at. */
static mote_status check_count(const mote_body *const bodies[2], uint32_t count)
{
    for (int b = 0; b < 2; ++b) {
        const uint32_t vertices = bodies[b]->mesh->vertex_count;
        if (count < 1 || count > vertices)
            return mote_fail(MOTE_EINVAL,
                             "n=%u is not valid; body %d has %u vertices, so n must be from 1 "
                             "to %u",
                             count, b, vertices, vertices);
    }
    return MOTE_OK;
}

mote_status mote_particles_create(const mote_body *const bodies[2], double length,
                                  const mote_particles_options *options,
                                  mote_particles **particles)
{
    mote_particles *made = calloc(1, sizeof *made);
    if (!made)
        return mote_fail(MOTE_ENOMEM, "no memory for particles");
    made->options = *options;
    made->length = length;
    made->inverse_square_length = 1 / length / length;
    mote_status status = options->single ? check_single(length) : MOTE_OK;
    if (status == MOTE_OK)
        status = check_count(bodies, options->count);
    for (int b = 0; b < 2 && status == MOTE_OK; ++b) {
        status = allocate_body(made, bodies[b], b);
        if (status == MOTE_OK)
            status = mote_start_vertices(bodies[b]->mesh, options->count, options->start,
                                         options->seed + (uint64_t)b, made->first[b]);
    }
    if (status == MOTE_OK && options->far_cache > 0)
        status = mote_far_cache_create(options->count, options->far_cache,
                                       near_distance(bodies), length, &made->far);
    if (status != MOTE_OK) {
        mote_particles_destroy(made);
        return status;
    }
    place_at_start(made);
    *particles = made;
    return MOTE_OK;
}

void mote_particles_destroy(mote_particles *particles)
{
    if (!particles)
        return;
    for (int b = 0; b < 2; ++b) {
        free(particles->site[b]);
        free(particles->first[b]);
        free(particles->place[b][0]);
        mote_lazy_free(&particles->lazy[b]);
    }
    mote_far_cache_destroy(particles->far);
    free(particles);
}

static void set_place(mote_particles *p, int b, uint32_t i, mote_vec3 position)
{
    if (p->far)
        mote_far_cache_moved(p->far,
                             mote_length(mote_sub(position, mote_particles_position(p, b, i))));
    p->place[b][0][i] = position.x;
    p->place[b][1][i] = position.y;
    p->place[b][2][i] = position.z;
}

void mote_particles_begin(mote_particles *particles, const mote_frame *frame, bool use_given)
{
    if (!particles->options.coherent) {
        place_at_start(particles);
        if (particles->far)
            mote_far_cache_reset(particles->far);
    }
    if (particles->far)
        mote_far_cache_step(particles->far);
    for (int b = 0; b < 2; ++b) {
        mote_lazy_begin(&particles->lazy[b], &frame->body[b], use_given);
        for (uint32_t i = 0; i < particles->options.count; ++i)
            set_place(particles, b, i,
                      mote_site_position(&particles->lazy[b], particles->site[b][i]));
    }
}

static void add_candidate(candidate_batch *batch, mote_site site, mote_vec3 place)
{
    const int lane = batch->count++;
    batch->site[lane] = site;
    batch->place.x[lane] = place.x;
    batch->place.y[lane] = place.y;
    batch->place.z[lane] = place.z;
}

/* The first candidate is the particle's own site: others must be strictly lower than that, and
   among equals the lowest site wins. */
static void judge(move_search *search, mote_site site, mote_vec3 place, double major,
                  double minor)
{
    const bool lower =
        major < search->major || (major == search->major && minor < search->minor);
    const bool equal = major == search->major && minor == search->minor;
    if (search->started && !lower &&
        !(equal && search->moved && mote_site_before(site, search->best)))
        return;
    search->moved = search->started;
    search->started = true;
    search->best = site;
    search->best_place = place;
    search->major = major;
    search->minor = minor;
}

static mote_vec3 place_in_lane(const mote_candidates *c, int lane)
{
    return mote_vec3_make(c->x[lane], c->y[lane], c->z[lane]);
}

static double effective_radius_squared(const mote_particles *p)
{
    return p->options.effective_radius * p->options.effective_radius;
}

static void judge_batch(move_search *search)
{
    candidate_batch *batch = &search->batch;
    const mote_particles *p = search->particles;
    const int used = batch->count;
    for (int lane = used; lane < MOTE_LANES; ++lane)
        add_candidate(batch, batch->site[0], place_in_lane(&batch->place, 0));
    mote_potentials potentials;
    mote_potential(&batch->place, &search->split.same, &search->split.other,
                   p->inverse_square_length, effective_radius_squared(p), &potentials);
    if (p->far)
        mote_far_cache_add(&search->split, &batch->place, p->length, &potentials);
    for (int lane = 0; lane < used; ++lane)
        judge(search, batch->site[lane], place_in_lane(&batch->place, lane),
              potentials.major[lane], potentials.minor[lane]);
    batch->count = 0;
}

static void consider(move_search *search, mote_site site, mote_vec3 place)
{
    add_candidate(&search->batch, site, place);
    if (search->batch.count == MOTE_LANES)
        judge_batch(search);
}

static void consider_site(void *context, mote_site site)
{
    move_search *search = context;
    mote_lazy *lazy = &search->particles->lazy[search->body];
    consider(search, site, mote_site_position(lazy, site));
}

static void consider_ring(move_search *search, uint32_t vertex)
{
    mote_lazy *lazy = &search->particles->lazy[search->body];
    const mote_mesh *mesh = lazy->body->mesh;
    const uint32_t end = mesh->ring_start[vertex + 1];
    for (uint32_t k = mesh->ring_start[vertex]; k < end; ++k) {
        const uint32_t u = MOTE_RING_VERTEX(mesh->ring[k]);
        consider(search, mote_site_vertex(u), mote_lazy_position(lazy, u));
    }
}

static mote_sources sources_of(const mote_particles *p, int b, mote_law law, uint32_t skip)
{
    const mote_sources sources = {.x = p->place[b][0],
                                  .y = p->place[b][1],
                                  .z = p->place[b][2],
                                  .count = p->options.count,
                                  .skip = skip,
                                  .law = law};
    return sources;
}

/* What acts on particle i: all particles, or the near ones and the expansion of the others. */
static void find_sources(move_search *search, uint32_t i)
{
    mote_particles *p = search->particles;
    const int b = search->body;
    const mote_sources same = sources_of(p, b, p->options.repel[b], i);
    const mote_sources other = sources_of(p, 1 - b, p->options.attract[b], p->options.count);
    if (p->far)
        mote_far_cache_split(p->far, b, i, search->here, &same, &other,
                             effective_radius_squared(p), &search->split);
    else
        search->split = (mote_far_split){.same = same, .other = other};
}

/* Moves particle i of body b to its best neighbouring site; says whether it moved. */
static bool move_particle(mote_particles *p, int b, uint32_t i)
{
    move_search search;
    search.particles = p;
    search.body = b;
    search.here = mote_particles_position(p, b, i);
    find_sources(&search, i);
    search.batch.count = 0;
    search.started = search.moved = false;
    search.major = search.minor = 0; /* read before the first candidate, but never used then */
    const mote_site here = p->site[b][i];
    consider(&search, here, search.here);
    if (p->options.surface)
        mote_site_neighbours(p->lazy[b].body->mesh, here, consider_site, &search);
    else
        consider_ring(&search, here.a);
    if (search.batch.count > 0)
        judge_batch(&search);
    if (!search.moved)
        return false;
    p->site[b][i] = search.best;
    set_place(p, b, i, search.best_place);
    return true;
}

static uint32_t sweep(mote_particles *p)
{
    uint32_t moved = 0;
    if (p->far)
        mote_far_cache_step(p->far);
    for (int b = 0; b < 2; ++b) {
        for (uint32_t i = 0; i < p->options.count; ++i)
            moved += move_particle(p, b, i);
    }
    return moved;
}

void mote_particles_relax(mote_particles *particles, double stop_distance,
                          mote_counters *counters)
{
    const uint32_t nmin = particles->options.nmin > 1 ? particles->options.nmin : 1;
    uint32_t pair[2];
    for (uint32_t step = 0; step < particles->options.nmax; ++step) {
        if (stop_distance >= 0 &&
            sqrt(mote_particles_closest(particles, pair)) <= stop_distance)
            return;
        const uint32_t moved = sweep(particles);
        ++counters->steps;
        counters->moves += moved;
        if (moved < nmin) {
            counters->ended_nmin = 1;
            return;
        }
    }
    counters->ended_nmax = 1;
}

/* Squared distance of a point to the nearest of count places, and its lowest index. */
MOTE_CLONES
static double nearest_place(mote_vec3 p, double *const place[3], uint32_t count,
                            uint32_t *index)
{
    double least = HUGE_VAL;
    for (size_t j = 0; j < count; ++j) {
        const double dx = place[0][j] - p.x;
        const double dy = place[1][j] - p.y;
        const double dz = place[2][j] - p.z;
        const double squared = dx * dx + dy * dy + dz * dz;
        if (squared < least) {
            least = squared;
            *index = (uint32_t)j;
        }
    }
    return least;
}

double mote_particles_closest(const mote_particles *particles, uint32_t pair[2])
{
    double least = HUGE_VAL;
    pair[0] = pair[1] = 0;
    for (uint32_t i = 0; i < particles->options.count; ++i) {
        uint32_t j = 0;
        const double squared = nearest_place(mote_particles_position(particles, 0, i),
                                             particles->place[1], particles->options.count, &j);
        if (squared < least) {
            least = squared;
            pair[0] = i;
            pair[1] = j;
        }
    }
    return least;
}

uint32_t mote_particles_count(const mote_particles *particles)
{
    return particles->options.count;
}

mote_site mote_particles_site(const mote_particles *particles, int body, uint32_t index)
{
    return particles->site[body][index];
}

mote_vec3 mote_particles_position(const mote_particles *particles, int body, uint32_t index)
{
    return mote_vec3_make(particles->place[body][0][index], particles->place[body][1][index],
                          particles->place[body][2][index]);
}

mote_lazy *mote_particles_lazy(mote_particles *particles, int body)
{
    return &particles->lazy[body];
}
