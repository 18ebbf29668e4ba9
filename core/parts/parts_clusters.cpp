#include "core/parts/parts_clusters.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <queue>
#include <tuple>
#include <utility>

namespace mote_parts_detail
{
namespace
{

/* Points that are no farther outside of a face's plane than this part of the size leave a
   component convex: the simplification of a sphere to 800 triangles leaves dents of 2 %, and
   what HACD calls concave is 10 %. */
constexpr double CONVEX_TOLERANCE = 0.03;

/* The same for a part among several, as large as HACD's. With it, T, V, M and W have 9, 9, 16
   and 11 parts (by HACD 4, 3, 10 and 8), a comb of 20 teeth 21 (23); with 0.04 18, 17, 31,
   18, 21. */
constexpr double PART_TOLERANCE = 0.1;

using Edge = std::array<uint32_t, 2>;

/* A plane that bounds a convex body to which a face belongs; the normal has length 1, or 0. */
struct Plane {
    mote_vec3 point, normal;
};

double height(const Plane &plane, mote_vec3 point)
{
    return mote_dot(plane.normal, mote_sub(point, plane.point));
}

mote_vec3 unit(mote_vec3 v)
{
    const double largest = mote_largest_coordinate(v);
    if (!(largest > 0))
        return mote_vec3_make(0, 0, 0);
    v = mote_vec3_make(v.x / largest, v.y / largest, v.z / largest); /* squares are numbers */
    return mote_scale(v, 1 / mote_length(v));
}

Plane plane_of(const Component &c, const std::array<uint32_t, 3> &face)
{
    const mote_vec3 a = c.points[face[0]];
    return {a,
            unit(mote_cross(mote_sub(c.points[face[1]], a), mote_sub(c.points[face[2]], a)))};
}

/* The edges of all faces in the order in which these go round. */
std::vector<Edge> sorted_edges(const Component &c)
{
    std::vector<Edge> edges;
    for (const auto &face : c.faces) {
        for (size_t k = 0; k < 3; ++k)
            edges.push_back({face[k], face[(k + 1) % 3]});
    }
    std::sort(edges.begin(), edges.end());
    return edges;
}

bool has(const std::vector<Edge> &edges, uint32_t from, uint32_t to)
{
    return std::binary_search(edges.begin(), edges.end(), Edge{from, to});
}

/* Whether every edge has two faces that go along it in opposite ways. */
bool is_closed(const std::vector<Edge> &edges)
{
    if (std::adjacent_find(edges.begin(), edges.end()) != edges.end())
        return false;
    return std::all_of(edges.begin(), edges.end(),
                       [&edges](const Edge &e) { return has(edges, e[1], e[0]); });
}

double size_of(const Component &c)
{
    double size = 0;
    for (const mote_vec3 &point : c.points)
        size = std::max(size, mote_length(mote_sub(point, c.points[0])));
    return size;
}

/* Six times the volume, seen from the first point: negative if the faces look inwards. */
double volume_of(const Component &c)
{
    double volume = 0;
    for (const auto &face : c.faces) {
        mote_vec3 v[3];
        for (size_t k = 0; k < 3; ++k)
            v[k] = mote_sub(c.points[face[k]], c.points[0]);
        volume += mote_dot(v[0], mote_cross(v[1], v[2]));
    }
    return volume;
}

/* Through the edge of a face that has no face on its other side, upright on the face. */
Plane plane_of_edge(const Plane &face, mote_vec3 from, mote_vec3 to)
{
    return {from, unit(mote_cross(mote_sub(to, from), face.normal))};
}

/* The planes of a face: its own, turned outwards, and those of its open edges. */
std::vector<Plane> planes_of(const Component &c, const std::array<uint32_t, 3> &face,
                             const std::vector<Edge> &edges, bool inwards)
{
    Plane own = plane_of(c, face);
    std::vector<Plane> planes;
    for (size_t k = 0; k < 3; ++k) {
        const uint32_t from = face[k], to = face[(k + 1) % 3];
        if (!has(edges, to, from))
            planes.push_back(plane_of_edge(own, c.points[from], c.points[to]));
    }
    if (inwards)
        own.normal = mote_scale(own.normal, -1);
    planes.push_back(own);
    return planes;
}

/* Whether a component with open edges is a flat sheet with a convex outline. */
bool is_convex_sheet(const Component &c, const std::vector<Edge> &edges, double near)
{
    for (const auto &face : c.faces) {
        for (const Plane &plane : planes_of(c, face, edges, false)) {
            for (const mote_vec3 &point : c.points) {
                if (height(plane, point) > near)
                    return false;
            }
        }
        const Plane own = plane_of(c, face);
        for (const mote_vec3 &point : c.points) {
            if (height(own, point) < -near)
                return false;
        }
    }
    return true;
}

/* Whether all points lie on one side of every face, the same for all faces, and not all of them
   near to it. */
bool is_convex_solid(const Component &c, double near)
{
    double outside[2] = {0, 0};
    for (const auto &face : c.faces) {
        const Plane plane = plane_of(c, face);
        double sides[2] = {0, 0};
        for (const mote_vec3 &point : c.points) {
            const double above = height(plane, point);
            sides[0] = std::max(sides[0], -above);
            sides[1] = std::max(sides[1], above);
        }
        for (int k = 0; k < 2; ++k)
            outside[k] = std::max(outside[k], sides[k]);
        if (std::min(outside[0], outside[1]) > near || sides[0] + sides[1] < 2 * near)
            return false;
    }
    return true;
}

/* How far faces lie in front of each other, and which are joined. */
class Clusters
{
  public:
    explicit Clusters(const Component &component);
    void join(double limit);
    void number(Component &component);

  private:
    /* A pair of clusters that touch, by two of their faces. */
    struct Pair {
        double reach;
        uint32_t a, b;
        bool operator>(const Pair &other) const
        {
            return std::tie(reach, a, b) > std::tie(other.reach, other.a, other.b);
        }
    };

    double &reach(uint32_t a, uint32_t b)
    {
        return reaches[size_t{a} * count + b];
    }
    uint32_t root(uint32_t face);
    void measure(const Component &c);

    uint32_t count;
    std::vector<double> reaches; /* [count][count], of roots: that of their faces at most */
    std::vector<uint32_t> parent;
    std::vector<std::pair<uint32_t, uint32_t>> neighbours; /* faces with a common point */
};

Clusters::Clusters(const Component &c)
    : count(static_cast<uint32_t>(c.faces.size())), reaches(c.faces.size() * c.faces.size(), 0),
      parent(c.faces.size())
{
    std::iota(parent.begin(), parent.end(), 0);
    measure(c);
    std::vector<std::vector<uint32_t>> around(c.points.size());
    for (uint32_t f = 0; f < count; ++f) {
        for (uint32_t v : c.faces[f]) {
            for (uint32_t other : around[v])
                neighbours.emplace_back(other, f);
            around[v].push_back(f);
        }
    }
}

void Clusters::measure(const Component &c)
{
    const std::vector<Edge> edges = sorted_edges(c);
    const bool inwards = volume_of(c) < 0;
    for (uint32_t f = 0; f < count; ++f) {
        const std::vector<Plane> planes = planes_of(c, c.faces[f], edges, inwards);
        for (uint32_t g = 0; g < count; ++g) {
            double highest = 0;
            for (uint32_t v : c.faces[g]) {
                for (const Plane &plane : planes)
                    highest = std::max(highest, height(plane, c.points[v]));
            }
            reach(f, g) = std::max(reach(f, g), highest);
            reach(g, f) = std::max(reach(g, f), highest);
        }
    }
}

uint32_t Clusters::root(uint32_t face)
{
    while (parent[face] != face)
        face = parent[face] = parent[parent[face]];
    return face;
}

/* What a pair reaches only grows: one that has grown since it was queued is queued again. */
void Clusters::join(double limit)
{
    std::priority_queue<Pair, std::vector<Pair>, std::greater<Pair>> queue;
    for (const auto &[a, b] : neighbours)
        queue.push({reach(a, b), a, b});
    while (!queue.empty() && queue.top().reach <= limit) {
        Pair pair = queue.top();
        queue.pop();
        const uint32_t a = root(pair.a), b = root(pair.b);
        if (a == b)
            continue;
        if (reach(a, b) > pair.reach) {
            pair.reach = reach(a, b);
            queue.push(pair);
            continue;
        }
        parent[b] = a;
        for (uint32_t other = 0; other < count; ++other)
            reach(a, other) = reach(other, a) = std::max(reach(a, other), reach(b, other));
    }
}

void Clusters::number(Component &c)
{
    constexpr uint32_t none = UINT32_MAX;
    std::vector<uint32_t> numbers(count, none);
    c.part.assign(count, 0);
    c.count = 0;
    for (uint32_t f = 0; f < count; ++f) {
        uint32_t &number = numbers[root(f)];
        if (number == none)
            number = c.count++;
        c.part[f] = number;
    }
}

} // namespace

bool is_convex(const Component &c)
{
    const std::vector<Edge> edges = sorted_edges(c);
    const double near = CONVEX_TOLERANCE * size_of(c);
    return is_closed(edges) ? is_convex_solid(c, near) : is_convex_sheet(c, edges, near);
}

void split_by_planes(Component &c)
{
    Clusters clusters(c);
    clusters.join(PART_TOLERANCE * size_of(c));
    clusters.number(c);
}

} // namespace mote_parts_detail
