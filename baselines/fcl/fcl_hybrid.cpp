/* hybrid-fcl: the particles find an upper bound, FCL with axis-aligned boxes starts from it and
   makes the answer exact (paper section 6: combining with existing techniques). Boxes are
   refitted bottom-up; the particles read the vertices that the refit needs anyway. */
#include "baselines/fcl/fcl_aabb.hpp"
#include "core/particle/particles.h"

#include <cstdio>

extern "C" const mote_method mote_method_particle_paper;

namespace
{

using namespace mote_fcl;

enum { HYBRID_N, HYBRID_REFINE, HYBRID_QUEUE, HYBRID_POSITIONS, HYBRID_COUNT };

constexpr uint32_t DEFAULT_COUNT = 8;

constexpr mote_parameter parameters[HYBRID_COUNT] = {
    {"n", MOTE_PARAMETER_INTEGER, 1, 65536, "auto", "auto",
     "particles on each body, at least one a connected component; auto: 8, or all vertices of "
     "a smaller body"},
    choice("refine", "no|near|always", "always",
           "exact check around the closest pair of particles, before FCL"),
    queue_parameter,
    positions_parameter,
};

const mote_method &particles = mote_method_particle_paper;

struct Hybrid {
    Hybrid(const mote_setup *setup, const Options &options) : pair(setup, options)
    {
    }

    ~Hybrid()
    {
        particles.destroy(system);
    }

    Hybrid(const Hybrid &) = delete;
    Hybrid &operator=(const Hybrid &) = delete;

    Pair<AabbVolume> pair;
    void *system = nullptr; /* of the particles */
    double values[MOTE_PARAMETERS_MAX];
};

Options fcl_options(const double *values)
{
    Options options = {};
    options.update = REFIT_BOTTOM_UP;
    options.queue = values[HYBRID_QUEUE] == 0 ? 2 : 64;
    options.given = values[HYBRID_POSITIONS] == 1;
    return options;
}

mote_traits traits(const double *values)
{
    mote_traits traits = {};
    traits.given_vertices = fcl_options(values).given;
    traits.needs_vertices = !traits.given_vertices;
    traits.keeps_state = traits.exact = true;
    return traits;
}

uint32_t count_of(const mote_setup *setup)
{
    const mote_mesh *a = setup->body[0]->mesh, *b = setup->body[1]->mesh;
    const double asked = setup->values[HYBRID_N];
    const uint32_t n = asked == MOTE_AUTO
                           ? std::min({DEFAULT_COUNT, a->vertex_count, b->vertex_count})
                           : static_cast<uint32_t>(asked);
    return mote_particles_at_least(n, a, b);
}

mote_status create_particles(const mote_setup *setup, Hybrid *hybrid)
{
    static const char *const refine[] = {"no", "near", "always"};
    char text[128];
    (void)std::snprintf(text, sizeof text,
                        "n=%u,start=fps,refine=%s,tolerance=0,positions=given", count_of(setup),
                        refine[static_cast<int>(setup->values[HYBRID_REFINE])]);
    mote_parameters_default(particles.parameters, particles.parameter_count, hybrid->values);
    mote_status status = mote_parameters_parse(particles.parameters, particles.parameter_count,
                                               text, hybrid->values);
    if (status != MOTE_OK)
        return status;
    mote_setup own = *setup;
    own.values = hybrid->values;
    return particles.create(&own, &hybrid->system);
}

mote_status create(const mote_setup *setup, void **state)
{
    mote_status status = mote_input_check(setup);
    if (status != MOTE_OK)
        return status;
    return guard([&] {
        auto hybrid = std::make_unique<Hybrid>(setup, fcl_options(setup->values));
        mote_status made = hybrid->pair.build(setup);
        if (made == MOTE_OK)
            made = create_particles(setup, hybrid.get());
        if (made == MOTE_OK)
            *state = hybrid.release();
        return made;
    });
}

void destroy(void *state)
{
    delete static_cast<Hybrid *>(state);
}

mote_status update(void *state, const mote_frame *frame)
{
    return guard([&] { return static_cast<Hybrid *>(state)->pair.update(frame); });
}

mote_status query(void *state, const mote_frame *frame, mote_answer *answer)
{
    Hybrid *hybrid = static_cast<Hybrid *>(state);
    mote_answer found = {};
    mote_status status = particles.query(hybrid->system, frame, &found);
    if (status != MOTE_OK)
        return status;
    answer->counters = found.counters;
    return guard([&] {
        return hybrid->pair.query(answer, hybrid->pair.bound(found.distance, found.witness));
    });
}

} // namespace

MOTE_METHOD(hybrid_fcl) = {
    "hybrid-fcl", "the particles' distance as upper bound for FCL's axis-aligned boxes",
    parameters,   HYBRID_COUNT,
    traits,       create,
    destroy,      update,
    query,        nullptr};
