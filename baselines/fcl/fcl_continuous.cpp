/* fcl-continuous: FCL's continuous collision (fcl::continuousCollide), for impacts of rigid
   bodies. FCL moves a body between two poses, so that every piece of a path is asked about by
   itself, with the poses at its two ends, first piece first; in `parts` parts each, since
   between the ends FCL's motions differ a little from the path. FCL has no tolerance.

   A linear motion turns about the path's pivot. Of FCL's four ways to make one, only that from
   matrices and a point sets all of it (datasets/defects.md, 20). Its ray shooting is left out:
   it has no code, and answers -1. */
#include "baselines/fcl/fcl_adapter.hpp"

#include "core/method/impact_method.h"

#include <fcl/math/bv/OBB.h>
#include <fcl/math/bv/OBBRSS.h>
#include <fcl/math/bv/RSS.h>
#include <fcl/math/motion/interp_motion.h>
#include <fcl/math/motion/screw_motion.h>
#include <fcl/math/motion/translation_motion.h>
#include <fcl/narrowphase/continuous_collision.h>

#include <optional>
#include <stdexcept>

namespace
{

using mote_fcl::Transform;
using mote_fcl::Vector;

enum { SOLVER, VOLUME, MOTION, ITERATIONS, PRECISION, PARTS, COUNT };

const mote_parameter parameters[COUNT] = {
    {"solver", MOTE_PARAMETER_CHOICE, 0, 0, "naive|advancement|polynomial", "advancement",
     "of FCL: samples, conservative advancement, or one for bodies that do not turn"},
    {"volume", MOTE_PARAMETER_CHOICE, 0, 0, "rss|obb|obbrss", "rss",
     "of FCL's trees; advancement needs distances: rss or obbrss"},
    {"motion", MOTE_PARAMETER_CHOICE, 0, 0, "linear|screw|translation", "linear",
     "how FCL moves a body between two poses"},
    {"iterations", MOTE_PARAMETER_INTEGER, 2, 1e6, nullptr, "1000",
     "FCL's num_max_iterations for a part; of naive, the samples"},
    {"precision", MOTE_PARAMETER_REAL, 1e-9, 1, nullptr, "1e-4",
     "FCL's toc_err, as a part of a part's time"},
    {"parts", MOTE_PARAMETER_INTEGER, 1, 1000, nullptr, "1",
     "parts of equal length that each piece of a path is cut into"}};

/* A pair of models, in FCL's unit (fcl_adapter.hpp). */
class Models
{
  public:
    virtual ~Models() = default;
    virtual void add(int b, const mote_body *body, double scale) = 0;
    virtual const fcl::CollisionGeometry<double> *model(int b) const = 0;
};

template <class BV> class ModelsOf final : public Models
{
  public:
    void add(int b, const mote_body *body, double scale) override
    {
        if (mote_fcl::build_model(body->mesh, scale, models[b]) != fcl::BVH_OK)
            throw std::runtime_error("a model could not be built");
        models[b].computeLocalAABB();
    }

    const fcl::CollisionGeometry<double> *model(int b) const override
    {
        return &models[b];
    }

  private:
    fcl::BVHModel<BV> models[2];
};

std::unique_ptr<Models> make_models(int volume)
{
    if (volume == 0)
        return std::make_unique<ModelsOf<fcl::RSS<double>>>();
    if (volume == 1)
        return std::make_unique<ModelsOf<fcl::OBB<double>>>();
    return std::make_unique<ModelsOf<fcl::OBBRSS<double>>>();
}

class Continuous
{
  public:
    explicit Continuous(const mote_setup *setup)
        : models(make_models(static_cast<int>(setup->values[VOLUME]))),
          scale(mote_fcl::scale_for(setup->length)),
          parts(static_cast<uint32_t>(setup->values[PARTS]))
    {
        static const fcl::CCDSolverType solvers[] = {
            fcl::CCDC_NAIVE, fcl::CCDC_CONSERVATIVE_ADVANCEMENT, fcl::CCDC_POLYNOMIAL_SOLVER};
        static const fcl::CCDMotionType motions[] = {fcl::CCDM_LINEAR, fcl::CCDM_SCREW,
                                                     fcl::CCDM_TRANS};
        request.ccd_solver_type = solvers[static_cast<int>(setup->values[SOLVER])];
        request.ccd_motion_type = motions[static_cast<int>(setup->values[MOTION])];
        request.num_max_iterations = static_cast<std::size_t>(setup->values[ITERATIONS]);
        request.toc_err = setup->values[PRECISION];
        for (int b = 0; b < 2; ++b) {
            body[b] = *setup->body[b];
            models->add(b, &body[b], scale);
        }
    }

    void query(const mote_path *const path[2], mote_impact_answer *answer);

  private:
    /* A motion of one of three kinds, held in place: FCL deletes what Eigen allocated by the
       flags of its own build, which need not be those of this one. */
    struct Motion {
        std::optional<fcl::InterpMotion<double>> linear;
        std::optional<fcl::ScrewMotion<double>> screw;
        std::optional<fcl::TranslationMotion<double>> translation;
    };

    Transform place(const mote_path *path, int b, double time) const;
    const fcl::MotionBase<double> *move(const mote_path *path, const Transform &from,
                                        const Transform &to, Motion *motion) const;

    std::unique_ptr<Models> models;
    mote_body body[2];
    double scale;
    uint32_t parts;
    fcl::ContinuousCollisionRequest<double> request;
};

Transform Continuous::place(const mote_path *path, int b, double time) const
{
    mote_body_state state;
    mote_path_state(path, &body[b], time, nullptr, &state);
    return mote_fcl::to_fcl(state.pose, scale);
}

const fcl::MotionBase<double> *Continuous::move(const mote_path *path, const Transform &from,
                                                const Transform &to, Motion *motion) const
{
    if (request.ccd_motion_type == fcl::CCDM_LINEAR)
        return &motion->linear.emplace(from.linear(), from.translation(), to.linear(),
                                       to.translation(), mote_fcl::to_fcl(path->pivot, scale));
    if (request.ccd_motion_type == fcl::CCDM_SCREW)
        return &motion->screw.emplace(from, to);
    return &motion->translation.emplace(from, to);
}

/* A time of contact outside of 0 .. 1, or none, is no answer. */
void Continuous::query(const mote_path *const path[2], mote_impact_answer *answer)
{
    const uint32_t total = path[0]->count * parts;
    Transform from[2] = {place(path[0], 0, 0), place(path[1], 1, 0)};
    for (uint32_t k = 0; k < total; ++k) {
        const double end = static_cast<double>(k + 1) / total;
        const Transform to[2] = {place(path[0], 0, end), place(path[1], 1, end)};
        fcl::ContinuousCollisionResult<double> result;
        Motion motion[2];
        const double time = fcl::continuousCollide(
            models->model(0), move(path[0], from[0], to[0], &motion[0]), models->model(1),
            move(path[1], from[1], to[1], &motion[1]), request, result);
        ++answer->iterations;
        if (!(time >= 0 && time <= 1))
            return;
        if (result.is_collide) {
            answer->answered = answer->impact = true;
            answer->from = static_cast<double>(k) / total;
            answer->to = (k + result.time_of_contact) / total;
            return;
        }
        from[0] = to[0];
        from[1] = to[1];
    }
    answer->answered = true;
    answer->from = answer->to = 1;
}

mote_traits traits(const double *)
{
    return {};
}

mote_status refuse(const mote_setup *, void **)
{
    return mote_fail(MOTE_EUNSUPPORTED,
                     "fcl-continuous answers impacts alone; for distances and contacts take "
                     "another of FCL's methods, as fcl-obbrss");
}

/* Never called: there is no state to call it with. */
mote_status no_query(void *state, const mote_frame *, mote_answer *)
{
    return refuse(nullptr, &state);
}

void destroy(void *state)
{
    delete static_cast<Continuous *>(state);
}

mote_status supported(const mote_setup *setup)
{
    for (int b = 0; b < 2; ++b) {
        if (!mote_body_is_rigid(setup->body[b]))
            return mote_fail(MOTE_EUNSUPPORTED,
                             "FCL's continuous collision is of rigid bodies; body %d deforms",
                             b);
    }
    const int solver = static_cast<int>(setup->values[SOLVER]);
    if (solver == 1 && static_cast<int>(setup->values[VOLUME]) == 1)
        return mote_fail(MOTE_EUNSUPPORTED,
                         "solver=advancement needs distances, which FCL does "
                         "not have for OBB; volume=rss or volume=obbrss");
    if (solver == 2 && static_cast<int>(setup->values[MOTION]) != 2)
        return mote_fail(
            MOTE_EUNSUPPORTED,
            "solver=polynomial is for bodies that do not turn; motion=translation");
    if (setup->tolerance > 0)
        return mote_fail(MOTE_EUNSUPPORTED,
                         "FCL's continuous collision has no tolerance; take a scenario with "
                         "tolerance 0");
    return MOTE_OK;
}

mote_status create(const mote_setup *setup, uint32_t, void **state)
{
    mote_status status = supported(setup);
    if (status == MOTE_OK)
        status = mote_input_check(setup);
    if (status != MOTE_OK)
        return status;
    return mote_fcl::guard([&] {
        *state = std::make_unique<Continuous>(setup).release();
        return MOTE_OK;
    });
}

/* What FCL throws is a failure on these paths, which is counted, and no end of the run. */
mote_status query(void *state, const mote_path *const path[2], mote_impact_answer *answer)
{
    const mote_status status = mote_fcl::guard([&] {
        static_cast<Continuous *>(state)->query(path, answer);
        return MOTE_OK;
    });
    return status == MOTE_ENUMERIC ? MOTE_OK : status;
}

} // namespace

MOTE_METHOD(fcl_continuous) = {
    "fcl-continuous", "FCL's continuous collision of rigid bodies: impacts at tolerance 0",
    parameters,       COUNT,
    traits,           refuse,
    destroy,          nullptr,
    no_query,         nullptr};

MOTE_IMPACT(fcl_continuous) = {"fcl-continuous", true, create, destroy, query};
