/* Two of Coal's models, kept across frames and refitted, and queries by its traversal nodes or
   public functions: what the methods coal-... have in common (baselines/coal.cpp).

   Vertices are world positions and transforms are identities, except for oriented volumes of
   bodies that do not deform, which Coal moves in place.

   Scale. Coal's triangle contact works with absolute tolerances, and a leaf counts gaps below
   1e-3 as overlap in the bound that it hands up. So everything is multiplied by the power of
   two that brings L into [2^20, 2^21), as for FCL. */
#ifndef MOTE_BASELINES_COAL_PAIR_HPP
#define MOTE_BASELINES_COAL_PAIR_HPP

#include "baselines/input.h"
#include "core/body/triangle.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <coal/BVH/BVH_model.h>
#include <coal/collision.h>
#include <coal/distance.h>
#include <coal/internal/traversal_node_bvhs.h>
#include <coal/internal/traversal_node_setup.h>
#include <coal/internal/traversal_recurse.h>

namespace mote_coal
{

using Vector = coal::Vec3s;

enum UpdateMode { REFIT_BOTTOM_UP, REFIT_TOP_DOWN, REBUILD, NO_UPDATE };

struct Options {
    UpdateMode update;
    bool queued;   /* a priority queue of 64 in place of depth first */
    bool seeded;   /* start from the last query's triangle pair */
    bool api;      /* Coal's public functions in place of its traversal nodes */
    bool full;     /* boxes are bounded by all three axes */
    bool collides; /* contact by the collision traversal, else by a distance that stops */
    bool given;    /* deforming the vertices is not charged */
};

/* What Coal can do with a volume: apply a transform in place (oriented), and measure the
   distance of two meshes correctly (has_distance). */
template <class BV> struct Kind {
    static constexpr bool oriented = true;
    static constexpr bool has_distance = true;
    static constexpr int flags = 0;
};

template <> struct Kind<coal::AABB> {
    static constexpr bool oriented = false;
    static constexpr bool has_distance = true;
    static constexpr int flags = coal::RelativeTransformationIsIdentity;
};

/* Coal's public functions have no distance of oriented boxes, and its node for them passes the
   transform with the boxes in the other order than its contact traversal does. */
template <> struct Kind<coal::OBB> {
    static constexpr bool oriented = true;
    static constexpr bool has_distance = false;
    static constexpr int flags = 0;
};

/* Coal's distance node; with `full`, boxes are bounded by all axes, where Coal returns after
   the first one that separates them. Stops once a pair within `enough` is found. */
template <class BV>
class DistanceNode : public coal::MeshDistanceTraversalNode<BV, Kind<BV>::flags>
{
  public:
    using Base = coal::MeshDistanceTraversalNode<BV, Kind<BV>::flags>;

    DistanceNode(bool full_, double enough_) : full(full_), enough(enough_)
    {
    }

    double BVDistanceLowerBound(unsigned a, unsigned b) const override
    {
        if constexpr (!Kind<BV>::oriented) {
            if (full) {
                this->num_bv_tests++;
                const BV &x = this->model1->getBV(a).bv, &y = this->model2->getBV(b).bv;
                return (x.min_ - y.max_).cwiseMax(y.min_ - x.max_).cwiseMax(0.0).norm();
            }
        }
        return Base::BVDistanceLowerBound(a, b);
    }

    bool canStop(double bound) const override
    {
        return this->result->min_distance <= enough || Base::canStop(bound);
    }

  private:
    bool full;
    double enough;
};

template <class BV> class Pair
{
  public:
    Pair(const mote_setup *setup, const Options &options_);

    mote_status update(const mote_frame *frame);
    mote_status query(mote_answer *answer);

  private:
    void build(int b, const mote_mesh *mesh);
    mote_status replace(int b, const mote_vec3 *vertices);
    void corners(int b, mote_vec3 corner[3]) const;
    double seed(mote_vec3 witness[2]) const;
    void collide(mote_answer *answer);
    void traverse(coal::DistanceResult &result, mote_answer *answer);
    mote_status measure(mote_answer *answer);

    coal::BVHModel<BV> model[2];
    coal::Transform3s transform[2];
    Options options;
    mote_ask ask;
    double scale, tolerance;   /* tolerance is scaled */
    bool moves[2];             /* Coal moves the body in place */
    bool spoilt[2] = {};       /* the last vertices were refused */
    int closest[2] = {-1, -1}; /* the last query's triangles; -1: none yet */
};

inline double scale_for(double length)
{
    return std::ldexp(1.0, std::clamp(20 - std::ilogb(length), -1000, 1000));
}

inline Vector to_coal(mote_vec3 v, double scale)
{
    return Vector(v.x * scale, v.y * scale, v.z * scale);
}

inline mote_vec3 from_coal(const Vector &v, double factor)
{
    return mote_vec3_make(v[0] * factor, v[1] * factor, v[2] * factor);
}

template <class BV>
Pair<BV>::Pair(const mote_setup *setup, const Options &options_)
    : options(options_), ask(setup->ask), scale(scale_for(setup->length)),
      tolerance(setup->tolerance * scale)
{
    for (int b = 0; b < 2; ++b) {
        moves[b] = Kind<BV>::oriented && mote_body_is_rigid(setup->body[b]);
        build(b, setup->body[b]->mesh);
    }
}

template <class BV> void Pair<BV>::build(int b, const mote_mesh *mesh)
{
    std::vector<Vector> vertices(mesh->vertex_count);
    for (uint32_t i = 0; i < mesh->vertex_count; ++i)
        vertices[i] = to_coal(mesh->positions[i], scale);
    std::vector<coal::Triangle> triangles(mesh->triangle_count);
    for (uint32_t i = 0; i < mesh->triangle_count; ++i) {
        const uint32_t *t = mesh->triangles[i];
        triangles[i].set(t[0], t[1], t[2]);
    }
    model[b].beginModel(mesh->triangle_count, mesh->vertex_count);
    model[b].addSubModel(vertices, triangles);
    model[b].endModel();
}

/* Checks the vertices in the pass that hands them to Coal. */
template <class BV> mote_status Pair<BV>::replace(int b, const mote_vec3 *vertices)
{
    coal::BVHModel<BV> &m = model[b];
    if (!vertices)
        return mote_input_check_vertices(vertices, m.num_vertices, b);
    m.beginReplaceModel();
    double zero = 0;
    for (unsigned i = 0; i < m.num_vertices; ++i) {
        zero += mote_input_zero(vertices[i]);
        m.replaceVertex(to_coal(vertices[i], scale));
    }
    spoilt[b] = std::isnan(zero);
    if (spoilt[b]) {
        m.build_state = coal::BVH_BUILD_STATE_PROCESSED; /* so that it can begin again */
        return mote_input_check_vertices(vertices, m.num_vertices, b);
    }
    m.endReplaceModel(options.update != REBUILD, options.update == REFIT_BOTTOM_UP);
    return MOTE_OK;
}

template <class BV> mote_status Pair<BV>::update(const mote_frame *frame)
{
    for (int b = 0; b < 2; ++b) {
        const mote_body_state &state = frame->body[b];
        mote_status status = mote_input_check_pose(&state.pose, b);
        if (status == MOTE_OK && moves[b]) {
            coal::Matrix3s rotation;
            for (int i = 0; i < 3; ++i) {
                for (int j = 0; j < 3; ++j)
                    rotation(i, j) = state.pose.rotation.m[i][j];
            }
            transform[b].setTransform(rotation, to_coal(state.pose.translation, scale));
        } else if (status == MOTE_OK &&
                   (spoilt[b] || state.shape_changed || state.pose_changed)) {
            status = replace(b, state.vertices);
        }
        if (status != MOTE_OK)
            return status;
    }
    return MOTE_OK;
}

/* World positions, scaled, of the corners of the last query's triangle of body b. */
template <class BV> void Pair<BV>::corners(int b, mote_vec3 corner[3]) const
{
    const coal::Triangle &triangle = (*model[b].tri_indices)[static_cast<size_t>(closest[b])];
    for (unsigned k = 0; k < 3; ++k)
        corner[k] = from_coal(transform[b].transform((*model[b].vertices)[triangle[k]]), 1);
}

/* The scaled distance of the last query's triangles, or infinity. */
template <class BV> double Pair<BV>::seed(mote_vec3 witness[2]) const
{
    if (!options.seeded || closest[0] < 0)
        return std::numeric_limits<double>::infinity();
    mote_vec3 s[3], t[3];
    corners(0, s);
    corners(1, t);
    return std::sqrt(mote_triangle_triangle(s, t, &witness[0], &witness[1]));
}

template <class BV> void Pair<BV>::collide(mote_answer *answer)
{
    coal::CollisionRequest request(coal::NO_REQUEST, 1); /* one contact, without details */
    coal::CollisionResult result;
    if (options.api) {
        coal::collide(&model[0], transform[0], &model[1], transform[1], request, result);
    } else {
        coal::MeshCollisionTraversalNode<BV, Kind<BV>::flags> node(request);
        if constexpr (Kind<BV>::oriented)
            initialize(node, std::as_const(model[0]), transform[0], std::as_const(model[1]),
                       transform[1], result);
        else
            initialize(node, model[0], transform[0], model[1], transform[1], result);
        node.enable_statistics = true;
        double bound = 0;
        coal::collisionRecurse(&node, 0, 0, nullptr, bound);
        answer->counters.box_tests = static_cast<uint64_t>(node.num_bv_tests);
        answer->counters.triangle_tests = static_cast<uint64_t>(node.num_leaf_tests);
    }
    answer->has_contact = true;
    answer->contact = result.isCollision();
}

template <class BV> void Pair<BV>::traverse(coal::DistanceResult &result, mote_answer *answer)
{
    const coal::DistanceRequest request(true, false);
    if (options.api) {
        coal::distance(&model[0], transform[0], &model[1], transform[1], request, result);
        return;
    }
    if constexpr (Kind<BV>::has_distance) {
        DistanceNode<BV> node(options.full, ask == MOTE_ASK_CONTACT ? tolerance : -1);
        auto &base = static_cast<typename DistanceNode<BV>::Base &>(node);
        if constexpr (Kind<BV>::oriented)
            initialize(base, std::as_const(model[0]), transform[0], std::as_const(model[1]),
                       transform[1], request, result);
        else
            initialize(base, model[0], transform[0], model[1], transform[1], request, result);
        node.rel_err = node.abs_err = 0;
        node.enable_statistics = true;
        node.preprocess();
        if (options.queued)
            coal::distanceQueueRecurse(&node, 0, 0, nullptr, 64);
        else
            coal::distanceRecurse(&node, 0, 0, nullptr);
        node.postprocess();
        answer->counters.box_tests = static_cast<uint64_t>(node.num_bv_tests);
        answer->counters.triangle_tests = static_cast<uint64_t>(node.num_leaf_tests);
    }
}

template <class BV> mote_status Pair<BV>::measure(mote_answer *answer)
{
    mote_vec3 witness[2] = {};
    const double known = seed(witness);
    /* A little above the bound, so that its pair is found again with its points. */
    const double most = std::numeric_limits<double>::max();
    coal::DistanceResult result(std::min(known * (1 + 1e-9), most));
    if (ask == MOTE_ASK_CONTACT) /* nothing beyond the tolerance matters */
        result.min_distance = std::min(result.min_distance, std::nextafter(tolerance, most));
    if (known > (ask == MOTE_ASK_CONTACT ? tolerance : 0))
        traverse(result, answer);
    const bool found = result.o1 != nullptr;
    if (ask == MOTE_ASK_DISTANCE && !found && std::isinf(known))
        return mote_fail(MOTE_ENUMERIC, "Coal found no pair of triangles");
    const double distance = found ? result.min_distance : known;
    if (found) {
        closest[0] = result.b1;
        closest[1] = result.b2;
    }
    answer->has_contact = true;
    answer->contact = distance <= tolerance;
    if (ask == MOTE_ASK_CONTACT)
        return MOTE_OK;
    answer->has_distance = true;
    answer->distance = distance / scale;
    answer->has_witness = !found || distance > 0;
    for (int b = 0; b < 2 && answer->has_witness; ++b)
        answer->witness[b] =
            found ? from_coal(result.nearest_points[static_cast<size_t>(b)], 1 / scale)
                  : mote_scale(witness[b], 1 / scale);
    return MOTE_OK;
}

template <class BV> mote_status Pair<BV>::query(mote_answer *answer)
{
    if (ask == MOTE_ASK_CONTACT && tolerance == 0 && options.collides) {
        collide(answer);
        return MOTE_OK;
    }
    return measure(answer);
}

} // namespace mote_coal

#endif
