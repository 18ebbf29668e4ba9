#include "core/body/parts.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <functional>
#include <new>
#include <queue>
#include <utility>
#include <vector>

#include <bullet/HACD/hacdHACD.h>
#include <meshoptimizer.h>

namespace
{

using Point = HACD::Vec3<HACD::Real>;
using Face = HACD::Vec3<long>;
using Corners = std::vector<unsigned>; /* vertices of the mesh, three a face */

constexpr uint32_t NO_LABEL = UINT32_MAX;

/* A component is not simplified to fewer triangles than this. */
constexpr size_t COMPONENT_TRIANGLES = 100;

/* Points that are no farther outside of a face's plane than this part of the size leave a
   component convex: the simplification of a sphere to 800 triangles leaves dents of 2 %, and
   what HACD calls concave is 10 %. */
constexpr double CONVEX_TOLERANCE = 0.03;

/* Whether every edge has two faces that go along it in opposite ways. */
bool is_closed(const std::vector<Face> &faces)
{
    std::vector<std::pair<long, long>> edges;
    for (const Face &face : faces) {
        const long v[3] = {face.X(), face.Y(), face.Z()};
        for (int k = 0; k < 3; ++k)
            edges.emplace_back(v[k], v[(k + 1) % 3]);
    }
    std::sort(edges.begin(), edges.end());
    if (std::adjacent_find(edges.begin(), edges.end()) != edges.end())
        return false;
    return std::all_of(edges.begin(), edges.end(), [&edges](const std::pair<long, long> &e) {
        return std::binary_search(edges.begin(), edges.end(),
                                  std::make_pair(e.second, e.first));
    });
}

/* How far points lie on each side of a face's plane, {behind, in front}, both >= 0. */
std::pair<double, double> sides_of(const std::vector<Point> &points, const Face &face)
{
    const Point &corner = points[static_cast<size_t>(face.X())];
    Point normal = (points[static_cast<size_t>(face.Y())] - corner) ^
                   (points[static_cast<size_t>(face.Z())] - corner);
    std::pair<double, double> sides(0, 0);
    if (!(normal.GetNorm() > 0))
        return sides;
    normal.Normalize();
    for (const Point &point : points) {
        const double height = normal * (point - corner);
        sides.first = std::max(sides.first, -height);
        sides.second = std::max(sides.second, height);
    }
    return sides;
}

/* Whether a component is the whole surface of a convex solid that is not flat: of spheres and
   the like HACD makes three parts, and takes seconds. False says nothing. */
bool is_convex_solid(const std::vector<Point> &points, const std::vector<Face> &faces)
{
    double size = 0;
    for (const Point &point : points)
        size = std::max(size, (point - points[0]).GetNorm());
    const double near = CONVEX_TOLERANCE * size;
    double outside[2] = {0, 0};
    for (const Face &face : faces) {
        const std::pair<double, double> sides = sides_of(points, face);
        outside[0] = std::max(outside[0], sides.first);
        outside[1] = std::max(outside[1], sides.second);
        if (std::min(outside[0], outside[1]) > near || sides.first + sides.second < 2 * near)
            return false;
    }
    return is_closed(faces);
}

/* The decomposition of a mesh, one connected component after another. */
class Decomposition
{
  public:
    Decomposition(const mote_mesh *mesh_, const mote_vec3 *positions_)
        : mesh(mesh_), positions(positions_), number(mesh_->vertex_count, -1),
          label(mesh_->vertex_count, NO_LABEL)
    {
    }

    bool run();

    uint32_t count = 0;
    const mote_mesh *mesh;
    const mote_vec3 *positions;

  private:
    std::vector<Corners> components() const;
    Corners simplify(const Corners &corners);
    bool decompose(const Corners &corners);
    bool cluster(std::vector<Point> &points, std::vector<Face> &faces, const Corners &corners);
    void spread();
    void renumber();

    std::vector<long> number; /* of a vertex among a component's points; -1 between calls */
    std::vector<float> xyz;   /* the positions for meshoptimizer, once needed */

  public:
    std::vector<uint32_t> label; /* of the vertices */
};

bool Decomposition::run()
{
    for (const Corners &corners : components()) {
        if (!decompose(simplify(corners)))
            return false;
    }
    spread();
    renumber();
    return true;
}

std::vector<Corners> Decomposition::components() const
{
    std::vector<Corners> result(mesh->component_count);
    for (uint32_t f = 0; f < mesh->triangle_count; ++f) {
        const uint32_t *t = mesh->triangles[f];
        Corners &corners = result[mesh->component[t[0]]];
        corners.insert(corners.end(), t, t + 3);
    }
    return result;
}

/* The component, simplified to its share of MOTE_PARTS_TRIANGLES. */
Corners Decomposition::simplify(const Corners &corners)
{
    size_t share = MOTE_PARTS_TRIANGLES * (corners.size() / 3) / mesh->triangle_count;
    size_t target = 3 * std::max(share, COMPONENT_TRIANGLES);
    if (corners.size() <= target)
        return corners;
    if (xyz.empty()) {
        /* Moved to the origin and scaled to unit size, since meshoptimizer has floats only. */
        for (uint32_t i = 0; i < mesh->vertex_count; ++i) {
            mote_vec3 v = mote_scale(mote_sub(positions[i], positions[0]), 1 / mesh->diagonal);
            xyz.insert(xyz.end(), {static_cast<float>(v.x), static_cast<float>(v.y),
                                   static_cast<float>(v.z)});
        }
    }
    Corners kept(corners.size());
    size_t size =
        meshopt_simplify(kept.data(), corners.data(), corners.size(), xyz.data(),
                         mesh->vertex_count, 3 * sizeof(float), target, 1e30f, 0, nullptr);
    /* It keeps vertices where several fans meet, and may then stop early; the sloppy form does
       not preserve topology. */
    if (size > 2 * target)
        size = meshopt_simplifySloppy(kept.data(), corners.data(), corners.size(), xyz.data(),
                                      mesh->vertex_count, 3 * sizeof(float), target, 1e30f,
                                      nullptr);
    kept.resize(size);
    return kept;
}

/* Labels the vertices that the simplification of one component kept. */
bool Decomposition::decompose(const Corners &corners)
{
    std::vector<Point> points;
    std::vector<Face> faces;
    for (uint32_t v : corners) {
        if (number[v] >= 0)
            continue;
        number[v] = static_cast<long>(points.size());
        points.emplace_back(positions[v].x, positions[v].y, positions[v].z);
    }
    for (size_t i = 0; i + 2 < corners.size(); i += 3)
        faces.emplace_back(number[corners[i]], number[corners[i + 1]], number[corners[i + 2]]);
    for (uint32_t v : corners)
        number[v] = -1;
    if (faces.empty())
        return true;
    if (!is_convex_solid(points, faces))
        return cluster(points, faces, corners);
    for (uint32_t v : corners)
        label[v] = count;
    ++count;
    return true;
}

bool Decomposition::cluster(std::vector<Point> &points, std::vector<Face> &faces,
                            const Corners &corners)
{
    HACD::HACD hacd;
    hacd.SetPoints(points.data());
    hacd.SetNPoints(points.size());
    hacd.SetTriangles(faces.data());
    hacd.SetNTriangles(faces.size());
    hacd.SetNClusters(1);
    hacd.SetConcavity(100);
    hacd.SetCompacityWeight(0.1);
    hacd.SetVolumeWeight(0);
    hacd.SetAddExtraDistPoints(true);
    hacd.SetAddFacesPoints(true);
    hacd.SetNVerticesPerCH(100);
    if (!hacd.Compute())
        return false;
    const long *partition = hacd.GetPartition();
    uint32_t clusters = static_cast<uint32_t>(hacd.GetNClusters());
    for (size_t i = 0; i < corners.size(); ++i) {
        long part = partition[i / 3];
        /* HACD has never numbered its clusters otherwise; if it did, nothing must be written
           outside the arrays. */
        if (part < 0 || part >= static_cast<long>(clusters)) /* GCOVR_EXCL_BR_LINE: see above */
            return false;
        if (label[corners[i]] == NO_LABEL)
            label[corners[i]] = count + static_cast<uint32_t>(part);
    }
    count += clusters;
    return true;
}

/* Labels spread along the edges, each vertex taking that of the nearest labelled one (Dijkstra;
   ties go to the lower vertex number). */
void Decomposition::spread()
{
    using Entry = std::pair<double, uint32_t>;
    std::vector<double> distance(mesh->vertex_count, HUGE_VAL);
    std::priority_queue<Entry, std::vector<Entry>, std::greater<Entry>> queue;
    for (uint32_t v = 0; v < mesh->vertex_count; ++v) {
        if (label[v] != NO_LABEL) {
            distance[v] = 0;
            queue.emplace(0.0, v);
        }
    }
    while (!queue.empty()) {
        auto [length, v] = queue.top();
        queue.pop();
        if (length > distance[v])
            continue;
        for (uint32_t k = mesh->ring_start[v]; k < mesh->ring_start[v + 1]; ++k) {
            uint32_t next = MOTE_RING_VERTEX(mesh->ring[k]);
            double step = mote_length(mote_sub(positions[next], positions[v]));
            if (length + step < distance[next]) {
                distance[next] = length + step;
                label[next] = label[v];
                queue.emplace(distance[next], next);
            }
        }
    }
}

/* Numbers the labels in order of first appearance; a component without a label becomes a part
   of its own. */
void Decomposition::renumber()
{
    std::vector<uint32_t> renumbered(size_t{count} + mesh->component_count, NO_LABEL);
    uint32_t used = 0;
    for (uint32_t v = 0; v < mesh->vertex_count; ++v) {
        uint32_t old = label[v] == NO_LABEL ? count + mesh->component[v] : label[v];
        if (renumbered[old] == NO_LABEL)
            renumbered[old] = used++;
        label[v] = renumbered[old];
    }
    count = used;
}

mote_status make_parts(const mote_mesh *mesh, const mote_vec3 *positions, mote_parts **parts)
{
    Decomposition decomposition(mesh, positions);
    if (!decomposition.run())
        return mote_fail(MOTE_ENUMERIC, "HACD could not decompose the mesh into convex parts");
    const std::vector<uint32_t> &label = decomposition.label;
    auto *result = static_cast<mote_parts *>(malloc(sizeof(mote_parts)));
    auto *copy = static_cast<uint32_t *>(malloc(label.size() * sizeof(uint32_t)));
    if (!result || !copy) {
        free(result);
        free(copy);
        return mote_fail(MOTE_ENOMEM, "no memory for the convex parts");
    }
    std::copy(label.begin(), label.end(), copy);
    *result = mote_parts{decomposition.count, mesh->vertex_count, copy};
    *parts = result;
    return MOTE_OK;
}

} // namespace

extern "C" mote_status mote_parts_create(const mote_mesh *mesh, const mote_vec3 *positions,
                                         mote_parts **parts)
{
    if (!positions)
        positions = mesh->positions;
    for (uint32_t i = 0; i < mesh->vertex_count; ++i) {
        mote_vec3 v = positions[i];
        if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z))
            return mote_fail(MOTE_EINVAL, "vertex %u is (%g, %g, %g); it must be finite", i,
                             v.x, v.y, v.z);
    }
    try {
        return make_parts(mesh, positions, parts);
    } catch (const std::bad_alloc &) {
        return mote_fail(MOTE_ENOMEM, "no memory for the convex parts");
    } catch (const std::exception &error) {
        return mote_fail(MOTE_ENUMERIC, "convex parts: %s", error.what());
    } catch (...) {
        return mote_fail(MOTE_ENUMERIC, "HACD threw an unknown exception");
    }
}

extern "C" void mote_parts_destroy(mote_parts *parts)
{
    if (!parts)
        return;
    free(parts->label);
    free(parts);
}
