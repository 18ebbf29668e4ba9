#include "tests/support/peers/fcl_defects.h"

#include "baselines/fcl/fcl_adapter.hpp"

#include <fcl/math/motion/interp_motion.h>

#include <iostream>
#include <sstream>

namespace
{

using mote_fcl::Transform;
using mote_fcl::Vector;

/* FCL's error stream, silenced for the life of this object. */
class Silence
{
  public:
    Silence() : original(std::cerr.rdbuf(sink.rdbuf()))
    {
    }

    ~Silence()
    {
        std::cerr.rdbuf(original);
    }

    Silence(const Silence &) = delete;
    Silence &operator=(const Silence &) = delete;

  private:
    std::ostringstream sink;
    std::streambuf *original;
};

const std::vector<Vector> corners = {Vector(0, 0, 0), Vector(1, 0, 0), Vector(0, 1, 0)};

template <class BV> int build(fcl::BVHModel<BV> &model, const std::vector<Vector> &vertices)
{
    model.beginModel(1, 3);
    model.addSubModel(vertices, {fcl::Triangle(0, 1, 2)});
    return model.endModel();
}

} // namespace

double mote_fcl_rss_sum_cosine(void)
{
    Vector first[3] = {Vector(0, 0, 0), Vector(2, 0, 0), Vector(0, 1, 0)};
    Vector second[3] = {Vector(0, 0, 3), Vector(0, 1, 5), Vector(1, 3, 3)};
    fcl::RSS<double> a, b;
    fcl::fit(first, 3, a);
    fcl::fit(second, 3, b);
    const fcl::RSS<double> sum = a + b;
    double largest = 0;
    for (int k = 0; k < 3; ++k)
        largest = std::max(largest, std::abs(sum.axis.col(k).dot(sum.axis.col((k + 1) % 3))));
    return largest;
}

double mote_fcl_obb_sum_outside(double degrees)
{
    fcl::OBB<double> a, b;
    const double angle = degrees * 3.14159265358979323846 / 180;
    a.axis = Eigen::AngleAxisd(angle, Vector(1, -1, 0).normalized()).toRotationMatrix();
    b.axis.setIdentity();
    a.To.setZero();
    b.To = Vector(0, 0, 1);
    a.extent = b.extent = Vector(1, 1, 1);
    const fcl::OBB<double> sum = a + b;
    double most = 0;
    for (int i = 0; i < 8; ++i) {
        const Vector corner(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
        const Vector in = sum.axis.transpose() * (a.axis * corner - sum.To);
        most = std::max(most, (in.cwiseAbs() - sum.extent).maxCoeff());
    }
    return most;
}

double mote_fcl_fit_without_area(void)
{
    Vector corners_on_a_line[3] = {Vector(1, 2, 3), Vector(3, 2, 3), Vector(2, 2, 3)};
    fcl::OBB<double> box;
    fcl::fit(corners_on_a_line, 3, box);
    return (box.center() - corners_on_a_line[2]).norm();
}

int mote_fcl_contacts_without_area(void)
{
    /* Two points and two parallel segments, far apart. */
    const Vector triangles[4][3] = {{Vector(0, 0, 0), Vector(0, 0, 0), Vector(0, 0, 0)},
                                    {Vector(20, 0, 0), Vector(20, 0, 0), Vector(20, 0, 0)},
                                    {Vector(0, 20, 0), Vector(2, 20, 0), Vector(1, 20, 0)},
                                    {Vector(0, 0, 40), Vector(3, 0, 40), Vector(1, 0, 40)}};
    int touching = 0;
    for (int i = 0; i < 4; ++i) {
        for (int k = 0; k < i; ++k)
            touching += fcl::detail::Intersect<double>::intersect_Triangle(
                triangles[i][0], triangles[i][1], triangles[i][2], triangles[k][0],
                triangles[k][1], triangles[k][2]);
    }
    return touching;
}

bool mote_fcl_far_models_collide(bool bottom_up)
{
    const Vector up(0, 0, 100);
    std::vector<Vector> low = corners, high;
    low.insert(low.end(), 3, Vector(5, 5, 0));
    for (const Vector &v : low)
        high.push_back(v + up);
    fcl::BVHModel<fcl::OBB<double>> models[2];
    for (int i = 0; i < 2; ++i) {
        const std::vector<Vector> &vertices = i ? high : low;
        models[i].beginModel(2, 6);
        models[i].addSubModel(vertices, {fcl::Triangle(0, 1, 2), fcl::Triangle(3, 4, 5)});
        models[i].endModel();
        models[i].beginReplaceModel();
        models[i].replaceSubModel(vertices);
        models[i].endReplaceModel(true, bottom_up);
    }
    fcl::CollisionRequest<double> request;
    fcl::CollisionResult<double> result;
    fcl::collide(&models[0], Transform::Identity(), &models[1], Transform::Identity(), request,
                 result);
    return result.isCollision();
}

double mote_fcl_obb_distance(void)
{
    Silence silence;
    fcl::BVHModel<fcl::OBB<double>> a, b;
    build(a, corners);
    build(b, corners);
    Transform above = Transform::Identity();
    above.translation() = Vector(0, 0, 1);
    fcl::DistanceRequest<double> request;
    fcl::DistanceResult<double> result;
    fcl::distance(&a, Transform::Identity(), &b, above, request, result);
    return result.min_distance;
}

int mote_fcl_memory_usage(void)
{
    fcl::BVHModel<fcl::AABB<double>> model;
    build(model, corners);
    return model.memUsage(0);
}

int mote_fcl_replace_after_update(void)
{
    Silence silence;
    fcl::BVHModel<fcl::AABB<double>> model;
    build(model, corners);
    model.beginUpdateModel();
    model.updateSubModel(corners);
    model.endUpdateModel();
    return model.beginReplaceModel();
}

bool mote_fcl_builds_with_nan(void)
{
    fcl::BVHModel<fcl::AABB<double>> model;
    std::vector<Vector> vertices = corners;
    vertices[1][0] = std::numeric_limits<double>::quiet_NaN();
    return build(model, vertices) == fcl::BVH_OK;
}

double mote_fcl_turn_moves_by(bool has_point)
{
    using Motion = fcl::InterpMotion<double>;
    alignas(Motion) unsigned char memory[sizeof(Motion)];
    std::fill(memory, memory + sizeof memory, static_cast<unsigned char>(0x45));
    const Transform start = Transform::Identity();
    Transform end = start, middle = start;
    end.linear() = fcl::AngleAxis<double>(1, Vector::UnitY()).toRotationMatrix();
    Motion *motion = has_point ? new (memory)
                                     Motion(start.linear(), start.translation(), end.linear(),
                                            end.translation(), Vector::Zero())
                               : new (memory) Motion(start, end);
    motion->integrate(0.5);
    motion->getCurrentTransform(middle);
    motion->~Motion();
    return middle.translation().norm();
}
