#include "tests/support/peers/coal_defects.h"

#include <coal/BVH/BVH_model.h>
#include <coal/collision_data.h>

#include <algorithm>
#include <vector>

namespace
{

using coal::Vec3s;

/* How far a point is outside of a volume. */
double outside(const coal::AABB &b, const Vec3s &p)
{
    return (b.min_ - p).cwiseMax(p - b.max_).cwiseMax(0.0).norm();
}

double outside(const coal::OBB &b, const Vec3s &p)
{
    return ((b.axes.transpose() * (p - b.To)).cwiseAbs() - b.extent).cwiseMax(0.0).norm();
}

double outside(const coal::RSS &b, const Vec3s &p)
{
    const Vec3s in = b.axes.transpose() * (p - b.Tr);
    const double x = std::max({0.0, -in[0], in[0] - b.length[0]});
    const double y = std::max({0.0, -in[1], in[1] - b.length[1]});
    return std::max(0.0, std::sqrt(x * x + y * y + in[2] * in[2]) - b.radius);
}

double outside(const coal::OBBRSS &b, const Vec3s &p)
{
    return std::max(outside(b.obb, p), outside(b.rss, p));
}

double outside(const coal::kIOS &b, const Vec3s &p)
{
    double most = outside(b.obb, p);
    for (unsigned i = 0; i < b.num_spheres; ++i)
        most = std::max(most, (p - b.spheres[i].o).norm() - b.spheres[i].r);
    return most;
}

template <class BV> class Tree
{
  public:
    explicit Tree(const mote_mesh *mesh_) : mesh(mesh_), scale(0x1p20 / mesh_->diagonal)
    {
        std::vector<coal::Triangle> triangles(mesh->triangle_count);
        for (uint32_t i = 0; i < mesh->triangle_count; ++i) {
            const uint32_t *t = mesh->triangles[i];
            triangles[i].set(t[0], t[1], t[2]);
        }
        model.beginModel(mesh->triangle_count, mesh->vertex_count);
        model.addSubModel(place(mesh->positions), triangles);
        model.endModel();
    }

    void refit(const mote_vec3 *vertices, bool bottom_up)
    {
        model.beginReplaceModel();
        model.replaceSubModel(place(vertices));
        model.endReplaceModel(true, bottom_up);
    }

    void count(coal_refit *to)
    {
        std::vector<double> excess(model.getNumBVs(), 0.0);
        std::vector<unsigned> path;
        descend(0, path, excess);
        for (double e : excess) {
            to->worst = std::max(to->worst, e);
            to->failing += e > 1e-9;
            ++to->volumes;
        }
    }

  private:
    std::vector<Vec3s> place(const mote_vec3 *vertices) const
    {
        std::vector<Vec3s> placed(mesh->vertex_count);
        for (uint32_t i = 0; i < mesh->vertex_count; ++i)
            placed[i] = Vec3s(vertices[i].x, vertices[i].y, vertices[i].z) * scale;
        return placed;
    }

    void descend(unsigned node, std::vector<unsigned> &path, std::vector<double> &excess) const
    {
        const auto &at = model.getBV(node);
        path.push_back(node);
        if (!at.isLeaf()) {
            descend(static_cast<unsigned>(at.leftChild()), path, excess);
            descend(static_cast<unsigned>(at.rightChild()), path, excess);
        } else {
            const auto &triangle = (*model.tri_indices)[static_cast<size_t>(at.primitiveId())];
            for (unsigned k = 0; k < 3; ++k) {
                const Vec3s &corner = (*model.vertices)[triangle[k]];
                for (unsigned a : path)
                    excess[a] =
                        std::max(excess[a], outside(model.getBV(a).bv, corner) / 0x1p20);
            }
        }
        path.pop_back();
    }

    const mote_mesh *mesh;
    double scale;
    coal::BVHModel<BV> model;
};

template <class BV>
coal_refit refit(bool bottom_up, const mote_mesh *mesh, const mote_vec3 *vertices, int poses)
{
    coal_refit counted = {};
    Tree<BV> tree(mesh);
    for (int k = 0; k < poses; ++k) {
        tree.refit(vertices + static_cast<size_t>(k) * mesh->vertex_count, bottom_up);
        tree.count(&counted);
    }
    return counted;
}

} // namespace

double mote_coal_sum_outside(double degrees)
{
    coal::OBB a, b;
    const double angle = degrees * 3.14159265358979323846 / 180;
    a.axes = Eigen::AngleAxisd(angle, Vec3s(1, -1, 0).normalized()).toRotationMatrix();
    b.axes.setIdentity();
    a.To.setZero();
    b.To = Vec3s(0, 0, 1);
    a.extent = b.extent = Vec3s(1, 1, 1);
    const coal::OBB sum = a + b;
    double most = 0;
    for (int i = 0; i < 8; ++i) {
        const Vec3s corner(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
        most = std::max(most, outside(sum, a.axes * corner));
    }
    return most;
}

double mote_coal_fit_outside(void)
{
    const std::vector<Vec3s> corners = {{0, 0, 3}, {2, 0, 0}, {3, 0, 2}, {2, 1, 0}, {3, 3, 2},
                                        {3, 0, 2}, {0, 3, 2}, {2, 1, 4}, {3, 2, 3}};
    coal::BVHModel<coal::RSS> model;
    model.beginModel(3, 9);
    model.addSubModel(corners, {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}});
    model.endModel();
    double most = 0;
    for (const Vec3s &corner : corners)
        most = std::max(most, outside(model.getBV(0).bv, corner));
    return most;
}

coal_refit mote_coal_refit(coal_volume volume, bool bottom_up, const mote_mesh *mesh,
                           const mote_vec3 *vertices, int poses)
{
    switch (volume) {
    case COAL_AABB:
        return refit<coal::AABB>(bottom_up, mesh, vertices, poses);
    case COAL_OBB:
        return refit<coal::OBB>(bottom_up, mesh, vertices, poses);
    case COAL_RSS:
        return refit<coal::RSS>(bottom_up, mesh, vertices, poses);
    case COAL_OBBRSS:
        return refit<coal::OBBRSS>(bottom_up, mesh, vertices, poses);
    default:
        return refit<coal::kIOS>(bottom_up, mesh, vertices, poses);
    }
}

double mote_coal_aabb_bound(void)
{
    const coal::AABB a(Vec3s(0, 0, 0), Vec3s(1, 1, 1)), b(Vec3s(2, -3, 0), Vec3s(3, -2, 1));
    const coal::CollisionRequest request(coal::DISTANCE_LOWER_BOUND, 0);
    double squared = 0;
    (void)a.overlap(b, request, squared);
    return squared;
}
