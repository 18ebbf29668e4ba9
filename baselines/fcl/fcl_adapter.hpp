/* Shared by all FCL methods: two models that are kept across frames and refitted, and queries
   by FCL's traversal nodes or public functions. A method is Adapter with a volume, a struct
   that names FCL's types and says what they can do.

   Vertices are world positions and transforms are identities, except for volumes to which FCL
   applies transforms in place (oriented): these are refitted only when the shape changed, and a
   motion without change of shape becomes a transform.

   Scale. FCL's triangle distance treats a triangle whose normal (edge cross edge) is shorter
   than 3.2e-8 as a line, whatever its size, and its rectangle distances use an absolute 1e-7.
   So everything is multiplied by the power of two that brings L into [2^20, 2^21), which costs
   three multiplications a vertex, changes no bit of a mantissa, and makes these
   thresholds 2.9e-20 L^2 and 1e-13 L. */
#ifndef MOTE_BASELINES_FCL_ADAPTER_HPP
#define MOTE_BASELINES_FCL_ADAPTER_HPP

/* Debian's library is built for plain x86-64 in C++14; with wider vectors or in C++17 Eigen
   would align and allocate its types differently from what the library expects. */
#define EIGEN_MAX_ALIGN_BYTES 16
#define EIGEN_HAS_CXX17_OVERALIGN 0

#include "baselines/fcl/fcl_parameters.hpp"
#include "baselines/fcl/sample_splitter.hpp"
#include "baselines/guard.hpp"
#include "baselines/input.h"
#include "core/body/triangle.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <new>
#include <utility>
#include <vector>

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/detail/traversal/collision/mesh_collision_traversal_node.h>
#include <fcl/narrowphase/detail/traversal/collision_node.h>
#include <fcl/narrowphase/detail/traversal/distance/mesh_distance_traversal_node.h>
#include <fcl/narrowphase/distance.h>

namespace mote_fcl
{

using Vector = fcl::Vector3<double>;
using Transform = fcl::Transform3<double>;

/* L is brought into [2^SIZE_EXPONENT, 2^(SIZE_EXPONENT + 1)). */
constexpr int SIZE_EXPONENT = 20;

inline double scale_for(double length)
{
    return std::ldexp(1.0, std::clamp(SIZE_EXPONENT - std::ilogb(length), -1000, 1000));
}

inline Vector to_fcl(mote_vec3 v, double scale)
{
    return Vector(v.x * scale, v.y * scale, v.z * scale);
}

/* Builds a new model; its splitter is set before. FCL's code, or std::bad_alloc where that says
   that memory ran out. */
template <class BV>
int build_model(const std::vector<Vector> &vertices,
                const std::vector<fcl::Triangle> &triangles, fcl::BVHModel<BV> &model)
{
    int code =
        model.beginModel(static_cast<int>(triangles.size()), static_cast<int>(vertices.size()));
    if (code == fcl::BVH_OK)
        code = model.addSubModel(vertices, triangles);
    if (code == fcl::BVH_OK)
        code = model.endModel();
    if (code == fcl::BVH_ERR_MODEL_OUT_OF_MEMORY)
        throw std::bad_alloc();
    return code;
}

/* The same for a mesh as it is at rest. */
template <class BV>
int build_model(const mote_mesh *mesh, double scale, fcl::BVHModel<BV> &model)
{
    std::vector<Vector> vertices(mesh->vertex_count);
    for (uint32_t i = 0; i < mesh->vertex_count; ++i)
        vertices[i] = to_fcl(mesh->positions[i], scale);
    std::vector<fcl::Triangle> triangles(mesh->triangle_count);
    for (uint32_t i = 0; i < mesh->triangle_count; ++i) {
        const uint32_t *t = mesh->triangles[i];
        triangles[i].set(t[0], t[1], t[2]);
    }
    return build_model(vertices, triangles, model);
}

/* Replaces the vertices of a model by world positions, checked in the same pass, and brings its
   tree up to date. body: its number, for messages. MOTE_EINVAL for vertices that
   mote_input_check_vertices refuses: the tree keeps its boxes, and some vertices are replaced.
 */
template <class BV>
mote_status replace_vertices(fcl::BVHModel<BV> &model, const mote_vec3 *vertices, double scale,
                             int body, UpdateMode mode)
{
    const uint32_t count = static_cast<uint32_t>(model.num_vertices);
    if (!vertices)
        return mote_input_check_vertices(vertices, count, body);
    int code = model.beginReplaceModel();
    double zero = 0;
    for (uint32_t i = 0; i < count && code == fcl::BVH_OK; ++i) {
        zero += mote_input_zero(vertices[i]);
        code = model.replaceVertex(to_fcl(vertices[i], scale));
    }
    if (std::isnan(zero)) {
        model.build_state = fcl::BVH_BUILD_STATE_PROCESSED; /* so that it can begin again */
        return mote_input_check_vertices(vertices, count, body);
    }
    if (code == fcl::BVH_OK)
        code = model.endReplaceModel(mode != REBUILD, mode == REFIT_BOTTOM_UP);
    if (code != fcl::BVH_OK)
        return mote_fail(MOTE_ENUMERIC, "FCL could not refit body %d: code %d", body, code);
    return MOTE_OK;
}

inline Transform to_fcl(const mote_pose &pose, double scale)
{
    Transform transform = Transform::Identity();
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column)
            transform.linear()(row, column) = pose.rotation.m[row][column];
    }
    transform.translation() = to_fcl(pose.translation, scale);
    return transform;
}

inline mote_vec3 from_fcl(const Vector &v, double factor)
{
    return mote_vec3_make(v[0] * factor, v[1] * factor, v[2] * factor);
}

template <class Body> mote_status guard(Body &&body) noexcept
{
    return mote_guard("FCL", body);
}

/* A distance node that also stops once a pair within `enough` is found, which answers a contact
   question. */
template <class Node> class EarlyNode : public Node
{
  public:
    explicit EarlyNode(double enough_) : enough(enough_)
    {
    }

    bool canStop(double bound) const override
    {
        return this->result->min_distance <= enough || Node::canStop(bound);
    }

  private:
    double enough;
};

/* Splits FCL's trees by sample poses. */
template <class BV> class SampleSplitter final : public fcl::detail::BVSplitterBase<BV>
{
  public:
    explicit SampleSplitter(const mote_body &body) : sides(body)
    {
    }

    void set(Vector *, fcl::Triangle *, fcl::BVHModelType) override
    {
    }

    void computeRule(const BV &, unsigned *triangles, int count) override
    {
        sides.choose(triangles, static_cast<uint32_t>(count));
    }

    bool apply(const Vector &) const override
    {
        return sides.next();
    }

    void clear() override
    {
    }

  private:
    mote_samples::Sides sides;
};

/* An upper bound on the distance, scaled, with the points that attain it. */
struct Bound {
    double distance = std::numeric_limits<double>::infinity();
    mote_vec3 witness[2] = {};
};

/* One pair of models. Volume names BV, DistanceNode (void when FCL has none), CollisionNode,
   and the constants described in fcl_aabb.hpp. */
template <class Volume> class Pair
{
  public:
    using BV = typename Volume::BV;
    using Model = fcl::BVHModel<BV>;
    using Request = fcl::DistanceRequest<double>;
    using Result = fcl::DistanceResult<double>;

    static constexpr bool has_distance = !std::is_void_v<typename Volume::DistanceNode>;

    Pair(const mote_setup *setup, const Options &options_)
        : options(options_), ask(setup->ask), scale(scale_for(setup->length)),
          tolerance(setup->tolerance * scale)
    {
        for (int b = 0; b < 2; ++b) {
            rigid[b] = mote_body_is_rigid(setup->body[b]);
            transform[b] = Transform::Identity();
            refit_pose[b] = mote_pose{};
        }
    }

    /* Builds both trees over the rest pose. */
    mote_status build(const mote_setup *setup);

    /* Updates the trees to a frame. */
    mote_status update(const mote_frame *frame);

    /* known: an upper bound that the caller has found. Adds to the answer's counters. */
    mote_status query(mote_answer *answer, const Bound &known = Bound());

    /* A distance between two points of the surfaces, in the form that query expects. */
    Bound bound(double distance, const mote_vec3 witness[2]) const;

  private:
    bool needs_refit(int b, const mote_body_state &state) const;
    Bound seed() const;
    void corners(int b, mote_vec3 corner[3]) const;
    void collide(mote_answer *answer);
    mote_status measure(mote_answer *answer, const Bound &known);
    void traverse(Result &result, mote_answer *answer);
    template <class Node> void drive(Node &node, Result &result, mote_answer *answer);
    void report(const Result &result, const Bound &bound, mote_answer *answer);

    Model model[2];
    Transform transform[2];  /* from the model's vertices to the world */
    mote_pose refit_pose[2]; /* the body's pose at the last refit */
    Options options;
    mote_ask ask;
    double scale;
    double tolerance; /* scaled */
    bool rigid[2];
    bool spoilt[2] = {};       /* the last vertices were refused */
    int closest[2] = {-1, -1}; /* the last query's triangles; -1: none yet */
};

template <class Volume> mote_status Pair<Volume>::build(const mote_setup *setup)
{
    for (int b = 0; b < 2; ++b) {
        if (options.samples)
            model[b].bv_splitter = std::make_shared<SampleSplitter<BV>>(*setup->body[b]);
        const int code = build_model(setup->body[b]->mesh, scale, model[b]);
        if (code != fcl::BVH_OK)
            return mote_fail(MOTE_ENUMERIC, "FCL could not build body %d: code %d", b, code);
    }
    return MOTE_OK;
}

/* Whether a body's tree no longer fits. Weights are in world axes, so that a body which can
   deform keeps its shape only as long as it does not turn. */
template <class Volume>
bool Pair<Volume>::needs_refit(int b, const mote_body_state &state) const
{
    if (spoilt[b])
        return true;
    if (!Volume::oriented)
        return state.shape_changed || state.pose_changed;
    const mote_mat3 &rotation = state.pose.rotation;
    bool turned = std::memcmp(&rotation, &refit_pose[b].rotation, sizeof rotation) != 0;
    return !rigid[b] && (state.shape_changed || turned);
}

template <class Volume> mote_status Pair<Volume>::update(const mote_frame *frame)
{
    for (int b = 0; b < 2; ++b) {
        const mote_body_state &state = frame->body[b];
        mote_status status = mote_input_check_pose(&state.pose, b);
        if (status != MOTE_OK)
            return status;
        if (needs_refit(b, state)) {
            status = replace_vertices(model[b], state.vertices, scale, b, options.update);
            spoilt[b] = status != MOTE_OK;
            if (spoilt[b])
                return status;
            refit_pose[b] = state.pose;
        }
        if (Volume::oriented && rigid[b])
            transform[b] = to_fcl(state.pose, scale);
        else if (Volume::oriented)
            transform[b].translation() =
                to_fcl(mote_sub(state.pose.translation, refit_pose[b].translation), scale);
    }
    return MOTE_OK;
}

/* World positions, scaled, of the corners of the last query's triangle of body b. */
template <class Volume> void Pair<Volume>::corners(int b, mote_vec3 corner[3]) const
{
    const fcl::Triangle &triangle = model[b].tri_indices[closest[b]];
    for (int k = 0; k < 3; ++k)
        corner[k] = from_fcl(transform[b] * model[b].vertices[triangle[k]], 1);
}

template <class Volume> Bound Pair<Volume>::seed() const
{
    Bound bound;
    if (!options.seeded || closest[0] < 0)
        return bound;
    mote_vec3 s[3], t[3];
    corners(0, s);
    corners(1, t);
    bound.distance =
        std::sqrt(mote_triangle_triangle(s, t, &bound.witness[0], &bound.witness[1]));
    return bound;
}

template <class Volume> void Pair<Volume>::collide(mote_answer *answer)
{
    fcl::CollisionRequest<double> request; /* asks for one contact, without details */
    fcl::CollisionResult<double> result;
    if (options.api) {
        fcl::collide(&model[0], transform[0], &model[1], transform[1], request, result);
    } else {
        typename Volume::CollisionNode node;
        node.enable_statistics = true;
        if constexpr (Volume::oriented)
            initialize(node, std::as_const(model[0]), transform[0], std::as_const(model[1]),
                       transform[1], request, result);
        else
            initialize(node, model[0], transform[0], model[1], transform[1], request, result);
        fcl::detail::collide(&node);
        answer->counters.box_tests += static_cast<uint64_t>(node.num_bv_tests);
        answer->counters.triangle_tests += static_cast<uint64_t>(node.num_leaf_tests);
    }
    answer->has_contact = true;
    answer->contact = result.isCollision();
}

template <class Volume>
template <class Node>
void Pair<Volume>::drive(Node &node, Result &result, mote_answer *answer)
{
    Request request(true);
    auto &base = static_cast<typename Volume::DistanceNode &>(node);
    if constexpr (Volume::oriented)
        initialize(base, std::as_const(model[0]), transform[0], std::as_const(model[1]),
                   transform[1], request, result);
    else
        initialize(base, model[0], transform[0], model[1], transform[1], request, result);
    node.enable_statistics = true;
    node.rel_err = node.abs_err = 0;
    fcl::detail::distance(&node, nullptr, options.queue);
    answer->counters.box_tests += static_cast<uint64_t>(node.num_bv_tests);
    answer->counters.triangle_tests +=
        static_cast<uint64_t>(node.num_leaf_tests) + Volume::first_triangle_tests;
}

template <class Volume> void Pair<Volume>::traverse(Result &result, mote_answer *answer)
{
    if constexpr (has_distance) {
        if (options.api) {
            fcl::distance(&model[0], transform[0], &model[1], transform[1], Request(true),
                          result);
        } else if (ask == MOTE_ASK_CONTACT) {
            EarlyNode<typename Volume::DistanceNode> node(tolerance);
            drive(node, result, answer);
        } else {
            typename Volume::DistanceNode node;
            drive(node, result, answer);
        }
    }
}

template <class Volume>
void Pair<Volume>::report(const Result &result, const Bound &bound, mote_answer *answer)
{
    bool found = result.o1 != nullptr;
    double distance = found ? result.min_distance : bound.distance;
    if (found) {
        closest[0] = static_cast<int>(result.b1);
        closest[1] = static_cast<int>(result.b2);
    }
    answer->has_contact = true;
    answer->contact = distance <= tolerance;
    if (ask == MOTE_ASK_CONTACT)
        return;
    answer->has_distance = true;
    answer->distance = distance / scale;
    /* FCL's points mean nothing where the surfaces intersect. */
    answer->has_witness = !found || distance > 0;
    for (int b = 0; b < 2 && answer->has_witness; ++b) {
        if (found)
            answer->witness[b] = from_fcl(result.nearest_points[b], 1 / scale);
        else
            answer->witness[b] = mote_scale(bound.witness[b], 1 / scale);
    }
}

template <class Volume>
mote_status Pair<Volume>::measure(mote_answer *answer, const Bound &known_bound)
{
    Bound bound = seed();
    if (bound.distance < std::numeric_limits<double>::infinity())
        answer->counters.triangle_tests++;
    if (known_bound.distance < bound.distance)
        bound = known_bound;
    /* A little above the bound, so that the pair it came from is found again with its points.
     */
    Result result(std::min(bound.distance * (1 + 1e-9), std::numeric_limits<double>::max()));
    bool known = bound.distance == 0;
    if (ask == MOTE_ASK_CONTACT) {
        /* Nothing beyond the tolerance matters. */
        double limit = std::numeric_limits<double>::infinity();
        result.min_distance = std::min(result.min_distance, std::nextafter(tolerance, limit));
        known = bound.distance <= tolerance;
    }
    if (!known)
        traverse(result, answer);
    if (ask == MOTE_ASK_DISTANCE && !result.o1 && std::isinf(bound.distance))
        return mote_fail(MOTE_ENUMERIC, "FCL found no pair of triangles");
    report(result, bound, answer);
    return MOTE_OK;
}

template <class Volume> mote_status Pair<Volume>::query(mote_answer *answer, const Bound &known)
{
    if (ask == MOTE_ASK_CONTACT && tolerance == 0 && known.distance > 0) {
        collide(answer);
        return MOTE_OK;
    }
    return measure(answer, known);
}

template <class Volume>
Bound Pair<Volume>::bound(double distance, const mote_vec3 witness[2]) const
{
    Bound result;
    result.distance = distance * scale;
    for (int b = 0; b < 2; ++b)
        result.witness[b] = mote_scale(witness[b], scale);
    return result;
}

/* The functions of a method (core/method/method.h) for one volume. */
template <class Volume> struct Adapter {
    static mote_traits traits(const double *values)
    {
        Options options = read_options(values);
        mote_traits traits = {};
        bool vertices = !(Volume::oriented && options.update == NO_UPDATE);
        traits.needs_vertices = vertices && !options.given;
        traits.given_vertices = vertices && options.given;
        traits.keeps_state = options.seeded;
        traits.samples = options.samples;
        traits.exact = Pair<Volume>::has_distance &&
                       (Volume::bottom_up_encloses || options.update != REFIT_BOTTOM_UP);
        return traits;
    }

    static mote_status supported(const mote_setup *setup, const Options &options)
    {
        bool distance = setup->ask == MOTE_ASK_DISTANCE || setup->tolerance > 0;
        if (distance && !Pair<Volume>::has_distance)
            return mote_fail(
                MOTE_EUNSUPPORTED,
                "FCL has no distance for this volume, only contact at tolerance 0");
        if (distance && options.api && !Volume::public_distance)
            return mote_fail(MOTE_EUNSUPPORTED,
                             "FCL's public distance does not support this volume; call=node");
        if (options.api && options.queue != 2)
            return mote_fail(MOTE_EUNSUPPORTED,
                             "FCL's public functions have no queue; queue=2 or call=node");
        if (options.update == REBUILD && options.samples)
            return mote_fail(MOTE_EUNSUPPORTED,
                             "update=rebuild splits by the vertices of each frame; build=rest");
        if (options.update != NO_UPDATE)
            return MOTE_OK;
        if (!Volume::oriented)
            return mote_fail(
                MOTE_EUNSUPPORTED,
                "update=none needs a volume that FCL transforms in place; this one "
                "is rebuilt at every transform");
        for (int b = 0; b < 2; ++b) {
            if (!mote_body_is_rigid(setup->body[b]))
                return mote_fail(MOTE_EUNSUPPORTED,
                                 "update=none needs rigid bodies; body %d deforms", b);
        }
        return MOTE_OK;
    }

    static mote_status create(const mote_setup *setup, void **state)
    {
        Options options = read_options(setup->values);
        mote_status status = supported(setup, options);
        if (status == MOTE_OK)
            status = mote_input_check(setup);
        if (status != MOTE_OK)
            return status;
        return guard([&] {
            auto pair = std::make_unique<Pair<Volume>>(setup, options);
            mote_status built = pair->build(setup);
            if (built == MOTE_OK)
                *state = pair.release();
            return built;
        });
    }

    static void destroy(void *state)
    {
        delete static_cast<Pair<Volume> *>(state);
    }

    static mote_status update(void *state, const mote_frame *frame)
    {
        return guard([&] { return static_cast<Pair<Volume> *>(state)->update(frame); });
    }

    static mote_status query(void *state, const mote_frame *, mote_answer *answer)
    {
        return guard([&] { return static_cast<Pair<Volume> *>(state)->query(answer); });
    }
};

/* The descriptor of a volume's method. parameters has PARAMETER_COUNT entries in the order of
   ParameterIndex. */
template <class Volume>
constexpr mote_method describe(const char *name, const char *summary,
                               const mote_parameter (&parameters)[PARAMETER_COUNT])
{
    using A = Adapter<Volume>;
    return mote_method{name,      summary,    parameters, PARAMETER_COUNT, A::traits,
                       A::create, A::destroy, A::update,  A::query,        nullptr};
}

} // namespace mote_fcl

#endif
