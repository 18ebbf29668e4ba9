/* fcl-obb: FCL with oriented boxes, refit top-down. FCL has contact for them, but no distance.
   The distance is therefore ours: a node for FCL's traversal of FCL's trees, which bounds the
   distance of two boxes from below by their separating axes; triangles are measured by FCL. */
#include "baselines/fcl/fcl_adapter.hpp"

namespace
{

using Matrix = fcl::Matrix3<double>;
using mote_fcl::Transform;
using mote_fcl::Vector;
using Box = fcl::OBB<double>;

/* Two boxes: the half sizes of both, the centre of the second from that of the first and its
   axes (columns of rotation), in the axes of the first. */
struct BoxPair {
    Matrix rotation;
    Vector centre, a, b;
};

/* The square of the largest gap along a product of an edge of each box, or `best` if that is
   larger. */
double edge_gap_squared(const BoxPair &p, const Matrix &size, double best)
{
    for (int i = 0; i < 3; ++i) {
        int i1 = (i + 1) % 3, i2 = (i + 2) % 3;
        for (int j = 0; j < 3; ++j) {
            int j1 = (j + 1) % 3, j2 = (j + 2) % 3;
            double apart =
                std::abs(p.centre[i2] * p.rotation(i1, j) - p.centre[i1] * p.rotation(i2, j));
            double half_widths = p.a[i1] * size(i2, j) + p.a[i2] * size(i1, j) +
                                 p.b[j1] * size(i, j2) + p.b[j2] * size(i, j1);
            double axis_squared = 1 - size(i, j) * size(i, j);
            double gap = apart - half_widths;
            /* The product of nearly parallel edges consists of rounding errors. */
            if (gap > 0 && axis_squared > 1e-6 && gap * gap > best * axis_squared)
                best = gap * gap / axis_squared;
        }
    }
    return best;
}

/* A lower bound on the distance of two boxes by their 15 separating axes. The gaps along the
   three axes of one box are orthogonal, so they add up in squares. */
double axis_gap(const BoxPair &p)
{
    const Matrix size = p.rotation.cwiseAbs();
    Vector first = (p.centre.cwiseAbs() - p.a - size * p.b).cwiseMax(0.0);
    Vector turned = (p.rotation.transpose() * p.centre).cwiseAbs();
    Vector second = (turned - p.b - size.transpose() * p.a).cwiseMax(0.0);
    double best = std::max(first.squaredNorm(), second.squaredNorm());
    return std::sqrt(edge_gap_squared(p, size, best));
}

class ObbDistanceNode : public fcl::detail::MeshDistanceTraversalNode<Box>
{
  public:
    double BVTesting(int b1, int b2) const override
    {
        if (this->enable_statistics)
            this->num_bv_tests++;
        const Box &first = this->model1->getBV(b1).bv, &second = this->model2->getBV(b2).bv;
        Matrix axes = second.axis;
        Vector centre = second.To;
        if (moved) {
            axes = tf.linear() * axes;
            centre = tf * centre;
        }
        return axis_gap({first.axis.transpose() * axes,
                         first.axis.transpose() * (centre - first.To), first.extent,
                         second.extent});
    }

    void leafTesting(int b1, int b2) const override
    {
        if (!moved)
            return fcl::detail::MeshDistanceTraversalNode<Box>::leafTesting(b1, b2);
        fcl::detail::meshDistanceOrientedNodeLeafTesting(
            b1, b2, this->model1, this->model2, this->vertices1, this->vertices2,
            this->tri_indices1, this->tri_indices2, tf, this->enable_statistics,
            this->num_leaf_tests, this->request, *this->result);
    }

    void postprocess() override
    {
        fcl::detail::distancePostprocessOrientedNode(this->model1, this->model2, this->tf1,
                                                     this->request, *this->result);
    }

    Transform tf; /* of the second model in the first's frame; set by FCL's set-up */
    bool moved;   /* tf is not the identity */
};

/* As FCL's functions of that name. */
bool initialize(ObbDistanceNode &node, const fcl::BVHModel<Box> &first, const Transform &t1,
                const fcl::BVHModel<Box> &second, const Transform &t2,
                const fcl::DistanceRequest<double> &request,
                fcl::DistanceResult<double> &result)
{
    bool good = fcl::detail::setupMeshDistanceOrientedNode(node, first, t1, second, t2, request,
                                                           result);
    node.moved = !node.tf.matrix().isIdentity(0);
    return good;
}

struct ObbVolume {
    using BV = Box;
    using DistanceNode = ObbDistanceNode;
    using CollisionNode = fcl::detail::MeshCollisionTraversalNodeOBB<double>;
    static constexpr bool oriented = true;
    static constexpr bool bottom_up_encloses = false;
    static constexpr bool public_distance = false;
    static constexpr unsigned first_triangle_tests = 0;
};

} // namespace

MOTE_METHOD(fcl_obb) = mote_fcl::describe<ObbVolume>(
    "fcl-obb", "FCL 0.7: oriented boxes, refit top-down; its distance traversal is ours",
    mote_fcl::top_down_parameters);
