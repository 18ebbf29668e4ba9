/* posed-parts: rigid parts, as engines collide with characters that they do not want to refit.
   A control: not exact.

   Each triangle is given to the bone that has most of the weight of its corners, and moves with
   that bone, so nothing is deformed or refitted. The error is what blending would bend:
   triangles between bones, and morph targets. A body whose triangles follow one bone each is
   exact.

   search=fcl: a tree of FCL for each part, built once over the rest pose and posed by its bone,
   which FCL can only turn and move: the nearest rotation stands for a bone that scales or
   shears. search=certified: the certified query on a skin in which every vertex follows one
   bone, which shows what blending costs that query. */
#include "baselines/fcl/fcl_adapter.hpp"
#include "core/certificate/certificate.h"
#include "core/skin/skin.h"

#include <Eigen/SVD>

namespace
{

using mote_fcl::Transform;
using mote_fcl::Vector;
using Matrix = fcl::Matrix3<double>;
/* On characters 1.0 to 1.1 times as fast as OBBRSS (bison-15k and jumper-20k), in 3/5 of its
   memory. */
using Model = fcl::BVHModel<fcl::RSS<double>>;
using Node = fcl::detail::MeshDistanceTraversalNodeRSS<double>;

enum { SEARCH, SEED, PARAMETER_COUNT };

enum { SEARCH_FCL, SEARCH_CERTIFIED };

constexpr mote_parameter parameters[PARAMETER_COUNT] = {
    mote_fcl::choice("search", "fcl|certified", "fcl",
                     "by trees of FCL, one a part, or by the certified query"),
    mote_fcl::choice("seed", "none|previous", "previous",
                     "first upper bound: none, or from the last query's triangle pair")};

constexpr double NO_LIMIT = std::numeric_limits<double>::infinity();

/* The bone that has most of the weight of the corners; the first among equals. sum is as long
   as there are bones, and zero before and after. */
uint32_t leading_bone(const mote_skin &skin, const uint32_t *corners, std::vector<double> &sum)
{
    uint32_t leader = skin.bone[skin.start[corners[0]]];
    const auto each = [&](auto &&visit) {
        for (int k = 0; k < 3; ++k) {
            for (uint32_t i = skin.start[corners[k]]; i < skin.start[corners[k] + 1]; ++i)
                visit(uint32_t{skin.bone[i]}, double{skin.weight[i]});
        }
    };
    each([&](uint32_t bone, double weight) { sum[bone] += weight; });
    each([&](uint32_t bone, double) {
        if (sum[bone] > sum[leader] || (!(sum[bone] < sum[leader]) && bone < leader))
            leader = bone;
    });
    each([&](uint32_t bone, double) { sum[bone] = 0; });
    return leader;
}

/* The leading bone of each triangle; 0 in a body without bones. */
std::vector<uint32_t> leading_bones(const mote_body &body)
{
    const mote_skin *skin = mote_field_skin(body.field);
    std::vector<uint32_t> leaders(body.mesh->triangle_count);
    std::vector<double> sum(skin ? skin->bones : 0);
    for (uint32_t t = 0; t < leaders.size() && skin; ++t)
        leaders[t] = leading_bone(*skin, body.mesh->triangles[t], sum);
    return leaders;
}

/* What answers for the parts. */
class Search
{
  public:
    virtual ~Search() = default;
    virtual mote_status update(const mote_frame *frame) = 0;
    virtual mote_status query(const mote_frame *frame, mote_answer *answer) = 0;
};

/* An axis-aligned box in the world, scaled. */
struct Box {
    Vector low = Vector::Constant(NO_LIMIT), high = Vector::Constant(-NO_LIMIT);

    void add(const Box &other)
    {
        low = low.cwiseMin(other.low);
        high = high.cwiseMax(other.high);
    }
};

double gap_squared(const Box &a, const Box &b)
{
    return (a.low - b.high).cwiseMax(b.low - a.high).cwiseMax(0.0).squaredNorm();
}

struct Part {
    uint32_t bone;
    Model model;         /* rest positions, scaled */
    Vector middle, half; /* of the box at rest */
    Transform pose = Transform::Identity();
    Box box;
};

/* Two parts, and the square of the gap of their boxes. */
struct Near {
    double squared;
    uint32_t part[2];
};

class FclParts final : public Search
{
  public:
    /* Builds the trees. */
    mote_status build(const mote_setup *setup);

    mote_status update(const mote_frame *frame) override;
    mote_status query(const mote_frame *frame, mote_answer *answer) override;

  private:
    mote_status build_body(const mote_body &body, int b);
    void find_near(double limit, mote_answer *answer);
    mote_fcl::Bound seed(mote_answer *answer) const;
    void measure(const Near &pair, double enough, mote_fcl::Bound &bound, mote_answer *answer);
    void report(const mote_fcl::Bound &bound, mote_answer *answer) const;

    mote_ask ask;
    bool seeded;
    double scale, tolerance; /* the tolerance scaled */
    const mote_skin *skin[2];
    std::vector<std::unique_ptr<Part>> parts[2];
    Box box[2];
    std::vector<uint32_t> facing[2]; /* parts near the other body */
    std::vector<Near> near;
    bool has_last = false;
    uint32_t last_part[2];
    int last_triangle[2];
};

mote_status build_part(const mote_mesh &mesh, const std::vector<uint32_t> &triangles,
                       double scale, Part &part)
{
    std::vector<uint32_t> used;
    for (uint32_t t : triangles)
        used.insert(used.end(), mesh.triangles[t], mesh.triangles[t] + 3);
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    const auto place = [&](uint32_t vertex) {
        return static_cast<std::size_t>(std::lower_bound(used.begin(), used.end(), vertex) -
                                        used.begin());
    };
    Box box;
    std::vector<Vector> vertices;
    for (uint32_t v : used) {
        vertices.push_back(mote_fcl::to_fcl(mesh.positions[v], scale));
        box.add({vertices.back(), vertices.back()});
    }
    part.middle = (box.low + box.high) / 2;
    part.half = (box.high - box.low) / 2;
    std::vector<fcl::Triangle> faces;
    for (uint32_t t : triangles) {
        const uint32_t *corner = mesh.triangles[t];
        faces.emplace_back(place(corner[0]), place(corner[1]), place(corner[2]));
    }
    const int code = mote_fcl::build_model(vertices, faces, part.model);
    if (code != fcl::BVH_OK)
        return mote_fail(MOTE_ENUMERIC, "FCL could not build the part of bone %u: code %d",
                         part.bone, code);
    return MOTE_OK;
}

/* One part for each bone that leads triangles. */
mote_status FclParts::build_body(const mote_body &body, int b)
{
    const std::vector<uint32_t> leaders = leading_bones(body);
    std::vector<std::vector<uint32_t>> led(skin[b] ? skin[b]->bones : 1);
    for (uint32_t t = 0; t < leaders.size(); ++t)
        led[leaders[t]].push_back(t);
    mote_status status = MOTE_OK;
    for (uint32_t bone = 0; bone < led.size() && status == MOTE_OK; ++bone) {
        if (led[bone].empty())
            continue;
        parts[b].push_back(std::make_unique<Part>());
        parts[b].back()->bone = bone;
        status = build_part(*body.mesh, led[bone], scale, *parts[b].back());
    }
    return status;
}

mote_status FclParts::build(const mote_setup *setup)
{
    ask = setup->ask;
    seeded = setup->values[SEED] == 1;
    scale = mote_fcl::scale_for(setup->length);
    tolerance = setup->tolerance * scale;
    mote_status status = MOTE_OK;
    for (int b = 0; b < 2 && status == MOTE_OK; ++b) {
        skin[b] = mote_field_skin(setup->body[b]->field);
        status = build_body(*setup->body[b], b);
    }
    return status;
}

/* The nearest rotation. Steps of Schulz' converge to it from matrices that are nearly one, as
   bones mostly are; the others are decomposed, for 20 times the cost. */
Matrix rotation_near(Matrix a)
{
    for (int step = 0; step < 8; ++step) {
        const Matrix excess = a.transpose() * a - Matrix::Identity();
        const double size = excess.cwiseAbs().maxCoeff();
        if (!(size < 0.1) || a.determinant() < 0)
            break;
        if (size < 1e-14)
            return a;
        a -= a * excess / 2;
    }
    const Eigen::JacobiSVD<Matrix> svd(a, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Matrix turn = Matrix::Identity();
    turn(2, 2) = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1;
    return svd.matrixU() * turn * svd.matrixV().transpose();
}

/* From rest positions to the world, scaled, of a vertex that follows one bone only. */
Transform bone_to_world(const mote_skin *skin, uint32_t bone, const mote_body_state &state,
                        double scale)
{
    Transform map = mote_fcl::to_fcl(state.pose, scale);
    if (!skin)
        return map;
    const mote_weights &w = state.weights;
    const auto weight = [&](uint32_t k) {
        return Vector(w.x[4 * bone + k], w.y[4 * bone + k], w.z[4 * bone + k]);
    };
    const Vector origin(skin->origin.x, skin->origin.y, skin->origin.z);
    map.translation() += scale * weight(3);
    for (uint32_t k = 0; k < 3; ++k) {
        const Vector column = weight(k) / skin->unit;
        map.linear().col(k) += column;
        map.translation() -= scale * origin[k] * column;
    }
    return map;
}

mote_status pose_part(const mote_skin *skin, const mote_body_state &state, double scale,
                      Part &part)
{
    const Transform map = bone_to_world(skin, part.bone, state, scale);
    if (!map.matrix().allFinite())
        return mote_fail(MOTE_EINVAL, "the matrix of bone %u is not finite", part.bone);
    const Vector middle = map * part.middle;
    part.pose.linear() = rotation_near(map.linear());
    part.pose.translation() = middle - part.pose.linear() * part.middle;
    const Vector extent = part.pose.linear().cwiseAbs() * part.half;
    part.box = {middle - extent, middle + extent};
    return MOTE_OK;
}

mote_status FclParts::update(const mote_frame *frame)
{
    for (int b = 0; b < 2; ++b) {
        const mote_body_state &moved = frame->body[b];
        if (!moved.shape_changed && !moved.pose_changed)
            continue;
        mote_status status = mote_input_check_pose(&moved.pose, b);
        box[b] = Box();
        for (std::size_t i = 0; i < parts[b].size() && status == MOTE_OK; ++i) {
            status = pose_part(skin[b], moved, scale, *parts[b][i]);
            box[b].add(parts[b][i]->box);
        }
        if (status != MOTE_OK)
            return status;
    }
    return MOTE_OK;
}

/* Lists the pairs of parts whose boxes are nearer than the square root of limit, nearest first.
 */
void FclParts::find_near(double limit, mote_answer *answer)
{
    for (int b = 0; b < 2; ++b) {
        facing[b].clear();
        for (uint32_t i = 0; i < parts[b].size(); ++i) {
            if (gap_squared(parts[b][i]->box, box[1 - b]) <= limit)
                facing[b].push_back(i);
        }
    }
    near.clear();
    for (uint32_t i : facing[0]) {
        for (uint32_t j : facing[1]) {
            const double squared = gap_squared(parts[0][i]->box, parts[1][j]->box);
            if (squared <= limit)
                near.push_back({squared, {i, j}});
        }
    }
    answer->counters.box_tests +=
        parts[0].size() + parts[1].size() + uint64_t{facing[0].size()} * facing[1].size();
    std::sort(near.begin(), near.end(),
              [](const Near &a, const Near &b) { return a.squared < b.squared; });
}

/* The distance of the last closest triangles where they are now, scaled. */
mote_fcl::Bound FclParts::seed(mote_answer *answer) const
{
    mote_fcl::Bound bound;
    if (!seeded || !has_last)
        return bound;
    mote_vec3 corner[2][3];
    for (int b = 0; b < 2; ++b) {
        const Part &part = *parts[b][last_part[b]];
        const fcl::Triangle &triangle = part.model.tri_indices[last_triangle[b]];
        for (int k = 0; k < 3; ++k)
            corner[b][k] = mote_fcl::from_fcl(part.pose * part.model.vertices[triangle[k]], 1);
    }
    bound.distance = std::sqrt(
        mote_triangle_triangle(corner[0], corner[1], &bound.witness[0], &bound.witness[1]));
    answer->counters.triangle_tests++;
    return bound;
}

/* Replaces the bound where two parts are nearer. */
void FclParts::measure(const Near &pair, double enough, mote_fcl::Bound &bound,
                       mote_answer *answer)
{
    const Part &a = *parts[0][pair.part[0]], &b = *parts[1][pair.part[1]];
    const fcl::DistanceRequest<double> request(true);
    fcl::DistanceResult<double> result(
        std::min(bound.distance, std::numeric_limits<double>::max()));
    mote_fcl::EarlyNode<Node> node(enough);
    initialize(static_cast<Node &>(node), a.model, a.pose, b.model, b.pose, request, result);
    node.enable_statistics = true;
    node.rel_err = node.abs_err = 0;
    fcl::detail::distance(&node, nullptr, 2);
    answer->counters.box_tests += static_cast<uint64_t>(node.num_bv_tests);
    answer->counters.triangle_tests += static_cast<uint64_t>(node.num_leaf_tests) + 1;
    if (!result.o1)
        return;
    bound.distance = result.min_distance;
    for (int k = 0; k < 2; ++k) {
        bound.witness[k] = mote_fcl::from_fcl(result.nearest_points[k], 1);
        last_part[k] = pair.part[k];
    }
    last_triangle[0] = static_cast<int>(result.b1);
    last_triangle[1] = static_cast<int>(result.b2);
    has_last = true;
}

void FclParts::report(const mote_fcl::Bound &bound, mote_answer *answer) const
{
    answer->has_contact = true;
    answer->contact = bound.distance <= tolerance;
    if (ask == MOTE_ASK_CONTACT)
        return;
    answer->has_distance = true;
    answer->distance = bound.distance / scale;
    answer->has_witness =
        bound.distance > 0; /* FCL's points of surfaces that meet mean nothing */
    for (int b = 0; b < 2 && answer->has_witness; ++b)
        answer->witness[b] = mote_scale(bound.witness[b], 1 / scale);
}

mote_status FclParts::query(const mote_frame *, mote_answer *answer)
{
    const bool contact_only = ask == MOTE_ASK_CONTACT;
    const double enough = contact_only ? tolerance : 0;
    mote_fcl::Bound bound = seed(answer);
    if (contact_only && bound.distance > tolerance)
        bound.distance = std::nextafter(tolerance, NO_LIMIT);
    near.clear();
    if (bound.distance > enough)
        find_near(bound.distance * bound.distance, answer);
    for (const Near &pair : near) {
        if (bound.distance <= enough || pair.squared > bound.distance * bound.distance)
            break;
        measure(pair, enough, bound, answer);
    }
    report(bound, answer);
    return MOTE_OK;
}

/* A body whose triangles follow one bone each: every bone's triangles have corners of their
   own. */
struct HardBody {
    mote_mesh *mesh = nullptr;
    mote_field *field = nullptr;
    mote_body body = {};
    std::vector<double> weights; /* x, y, z of a frame */

    HardBody() = default;
    HardBody(const HardBody &) = delete;
    HardBody &operator=(const HardBody &) = delete;

    ~HardBody()
    {
        mote_field_destroy(field);
        mote_mesh_destroy(mesh);
    }

    mote_status build(const mote_body &from);
    mote_body_state pose(mote_body_state state);
};

mote_status HardBody::build(const mote_body &from)
{
    const mote_skin *skin = mote_field_skin(from.field);
    body = from;
    if (!skin)
        return MOTE_OK;
    const std::vector<uint32_t> leaders = leading_bones(from);
    std::vector<std::pair<uint32_t, uint32_t>> corners; /* a bone and a vertex */
    for (uint32_t t = 0; t < leaders.size(); ++t) {
        for (uint32_t v : from.mesh->triangles[t])
            corners.emplace_back(leaders[t], v);
    }
    std::vector<std::pair<uint32_t, uint32_t>> used = corners;
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    std::vector<double> xyz, weight(used.size(), 1);
    std::vector<uint16_t> bone;
    std::vector<uint32_t> start(1), face;
    for (const auto &[leader, v] : used) {
        const mote_vec3 p = from.mesh->positions[v];
        xyz.insert(xyz.end(), {p.x, p.y, p.z});
        bone.push_back(static_cast<uint16_t>(leader));
        start.push_back(start.back() + 1);
    }
    for (const auto &corner : corners)
        face.push_back(static_cast<uint32_t>(
            std::lower_bound(used.begin(), used.end(), corner) - used.begin()));
    mote_status status =
        mote_mesh_create(xyz.data(), used.size(), face.data(), leaders.size(), &mesh);
    if (status == MOTE_OK)
        status = mote_field_create_skin(mesh, skin->bones, start.data(), bone.data(),
                                        weight.data(), &field);
    if (status != MOTE_OK)
        return status;
    weights.assign(std::size_t{3} * field->padded, 0);
    body.mesh = mesh;
    body.field = field;
    if (skin->morph.targets > 0) /* its sample poses are of other functions */
        body.sample_count = 0;
    return MOTE_OK;
}

/* The state of the body that it stands for, without morph targets: the weights of the bones
   come first, and the box at rest, which they refer to, is the same. */
mote_body_state HardBody::pose(mote_body_state state)
{
    if (!field)
        return state;
    const uint32_t count = field->count, padded = field->padded;
    const double *const from[3] = {state.weights.x, state.weights.y, state.weights.z};
    double *to = weights.data();
    for (int k = 0; k < 3; ++k)
        std::copy(from[k], from[k] + count, to + k * padded);
    state.weights = {to, to + padded, to + 2 * padded, count, padded};
    return state;
}

class CertifiedParts final : public Search
{
  public:
    ~CertifiedParts() override
    {
        mote_certificate_destroy(certificate);
    }

    mote_status build(const mote_setup *setup)
    {
        ask = setup->ask;
        tolerance = setup->tolerance;
        mote_status status = MOTE_OK;
        for (int b = 0; b < 2 && status == MOTE_OK; ++b)
            status = hard[b].build(*setup->body[b]);
        if (status != MOTE_OK)
            return status;
        const mote_body *const body[2] = {&hard[0].body, &hard[1].body};
        mote_certificate_options options = mote_default_certificate_options(setup->length);
        if (setup->values[SEED] != 1)
            options.seed = MOTE_CERT_SEED_NONE;
        return mote_certificate_create(body, &options, &certificate);
    }

    mote_status update(const mote_frame *) override
    {
        return MOTE_OK;
    }

    mote_status query(const mote_frame *frame, mote_answer *answer) override
    {
        const mote_frame posed = {frame->number,
                                  {hard[0].pose(frame->body[0]), hard[1].pose(frame->body[1])}};
        mote_certificate_answer found;
        mote_certificate_query(certificate, &posed, nullptr,
                               ask == MOTE_ASK_CONTACT ? tolerance : -1, &found);
        mote_certificate_report(&found, ask, tolerance, true, answer);
        /* What is proven of the parts does not hold for the body. */
        answer->has_lower = false;
        answer->lower = 0;
        return MOTE_OK;
    }

  private:
    HardBody hard[2];
    mote_certificate *certificate = nullptr;
    mote_ask ask = MOTE_ASK_DISTANCE;
    double tolerance = 0;
};

mote_traits traits(const double *values)
{
    mote_traits traits = {};
    traits.needs_field = true;
    traits.keeps_state = values[SEED] == 1;
    return traits;
}

mote_status supported(const mote_setup *setup)
{
    for (int b = 0; b < 2; ++b) {
        const mote_body *body = setup->body[b];
        if (!mote_body_is_rigid(body) && !mote_field_skin(body->field))
            return mote_fail(MOTE_EUNSUPPORTED,
                             "parts are posed by bones; body %d deforms and has none", b);
    }
    return mote_input_check(setup);
}

template <class Parts> mote_status create_parts(const mote_setup *setup, void **state)
{
    auto parts = std::make_unique<Parts>();
    const mote_status status = parts->build(setup);
    if (status == MOTE_OK)
        *state = static_cast<Search *>(parts.release());
    return status;
}

mote_status create(const mote_setup *setup, void **state)
{
    const mote_status status = supported(setup);
    if (status != MOTE_OK)
        return status;
    return mote_fcl::guard([&] {
        return setup->values[SEARCH] == SEARCH_FCL ? create_parts<FclParts>(setup, state)
                                                   : create_parts<CertifiedParts>(setup, state);
    });
}

void destroy(void *state)
{
    delete static_cast<Search *>(state);
}

mote_status update(void *state, const mote_frame *frame)
{
    return mote_fcl::guard([&] { return static_cast<Search *>(state)->update(frame); });
}

mote_status query(void *state, const mote_frame *frame, mote_answer *answer)
{
    return mote_fcl::guard([&] { return static_cast<Search *>(state)->query(frame, answer); });
}

} // namespace

MOTE_METHOD(posed_parts) = {
    "posed-parts", "rigid parts posed by bones, never refitted, by FCL or certified; not exact",
    parameters,    PARAMETER_COUNT,
    traits,        create,
    destroy,       update,
    query,         nullptr};
