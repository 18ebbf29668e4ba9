/* The paper's particle system (paper 3.2 to 3.5): n particles on each of two bodies, attracted
   by those of the other body, repelled by those of their own, moving from site to site of the
   surface until few of them move. */
#ifndef MOTE_CORE_PARTICLES_H
#define MOTE_CORE_PARTICLES_H

#include "core/method/method.h"
#include "core/particle/potential.h"
#include "core/particle/site.h"
#include "core/particle/start.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct mote_particles_options {
    uint32_t count;          /* n, on each body; 1 .. vertex count */
    mote_law attract[2];     /* law by which particles of body 0, 1 are attracted */
    mote_law repel[2];       /* law by which they are repelled by their own kind */
    double effective_radius; /* R_eff / L (paper 3.3); 0: no attraction; infinite: no limit */
    uint32_t nmin;    /* a query ends when fewer than max(1, nmin) particles moved in a step */
    uint32_t nmax;    /* or after this many steps (paper 3.5); 0: particles never move */
    bool surface;     /* move over vertices, edge midpoints and face centroids (paper 3.4) */
    bool single;      /* positions evaluated and remembered in single precision */
    double far_cache; /* > 0: the influence of distant particles is kept until their distance
                         vector has changed by this part (paper 3.5); 0: never kept */
    bool coherent;    /* start where the last query ended; else where the first one did */
    mote_start start;
    uint64_t seed;
} mote_particles_options;

/* n = 8, log law, R_eff = L, nmin = 0, nmax = 64, vertices, coherent, farthest points, seed 1.
 */
mote_particles_options mote_default_particles_options(void);

/* n, or one particle for each connected component if that is more and each body has as many
   vertices. Otherwise n stays, and mote_particles_create says which body has too many
   components. */
static inline uint32_t mote_particles_at_least(uint32_t n, const mote_mesh *a,
                                               const mote_mesh *b)
{
    const uint32_t vertices =
        a->vertex_count < b->vertex_count ? a->vertex_count : b->vertex_count;
    const uint32_t components =
        a->component_count > b->component_count ? a->component_count : b->component_count;
    return components > n && components <= vertices ? components : n;
}

typedef struct mote_particles mote_particles;

/* Places the particles. bodies and what they point to are borrowed; length is L of the pair.
   Errors as mote_start_vertices, and MOTE_EINVAL for an L outside of 1e-30 .. 1e30 in single
   precision. Cost O(v) for random starts, O(n v) for farthest points. */
mote_status mote_particles_create(const mote_body *const bodies[2], double length,
                                  const mote_particles_options *options,
                                  mote_particles **particles);

/* NULL is allowed. */
void mote_particles_destroy(mote_particles *particles);

/* Starts a frame (borrowed until the next begin): particles keep their sites, whose positions
   are looked up anew. use_given: positions come from the frame's vertices. Cost O(n). */
void mote_particles_begin(mote_particles *particles, const mote_frame *frame, bool use_given);

/* Makes steps until the system is almost at rest. A step is one sweep over the particles of
   both bodies, body 0 first; each moves at once to the neighbouring site of lowest potential if
   that is strictly lower (to the lowest site on a tie). Also ends when the closest pair is not
   above stop_distance (negative: never). Adds to counters: steps, moves, ended_nmin,
   ended_nmax. Cost a step O(n^2) for rings of bounded size; no allocation but growth of the
   position table. */
void mote_particles_relax(mote_particles *particles, double stop_distance,
                          mote_counters *counters);

/* Index of the closest pair of particles of different bodies (lowest indices on a tie) and its
   squared distance. */
double mote_particles_closest(const mote_particles *particles, uint32_t pair[2]);

uint32_t mote_particles_count(const mote_particles *particles);
mote_site mote_particles_site(const mote_particles *particles, int body, uint32_t index);
mote_vec3 mote_particles_position(const mote_particles *particles, int body, uint32_t index);

/* The lazily deformed positions of a body in this frame; owned by the particles. */
mote_lazy *mote_particles_lazy(mote_particles *particles, int body);

#ifdef __cplusplus
}
#endif
#endif
