#include "core/parts/parts.h"
#include "core/parts/parts_clusters.hpp"
#include "core/parts/parts_hacd.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <queue>
#include <stdexcept>
#include <utility>
#include <vector>

#include <meshoptimizer.h>

namespace
{

using mote_parts_detail::Component;
using Corners = std::vector<unsigned>; /* vertices of the mesh, three a face */

constexpr uint32_t NO_LABEL = UINT32_MAX;

/* A component is not simplified to fewer triangles than this. */
constexpr size_t COMPONENT_TRIANGLES = 100;

/* The power of two that brings the extent of points to about 1, so that volumes stay numbers.
 */
double unit_of(const mote_vec3 *points, uint32_t count)
{
    double half = 0;
    for (uint32_t i = 0; i < count; ++i)
        half = std::max(half, mote_largest_coordinate(mote_sub(mote_scale(points[i], 0.5),
                                                               mote_scale(points[0], 0.5))));
    return half > 0 ? std::ldexp(1, -std::ilogb(std::max(half, DBL_MIN))) : 1;
}

/* The decomposition of a mesh, one connected component after another. */
class Decomposition
{
  public:
    Decomposition(const mote_mesh *mesh_, const mote_vec3 *positions_)
        : label(mesh_->vertex_count, NO_LABEL), mesh(mesh_), positions(positions_),
          unit(unit_of(positions_, mesh_->vertex_count)), number(mesh_->vertex_count, NO_LABEL)
    {
    }

    void run();

    uint32_t count = 0;
    uint32_t without_hacd = 0;   /* components that it did not split and should have */
    std::vector<uint32_t> label; /* of the vertices */

  private:
    std::vector<Corners> components() const;
    Corners simplify(const Corners &corners);
    Component component_of(const Corners &corners);
    void split(std::vector<Component> &components);
    void name(const Component &component, const Corners &corners);
    void spread();
    void renumber();

    const mote_mesh *mesh;
    const mote_vec3 *positions;
    double unit;
    std::vector<uint32_t> number; /* of a vertex among a component's points; else NO_LABEL */
    std::vector<float> xyz;       /* the positions for meshoptimizer, once needed */
};

void Decomposition::run()
{
    std::vector<Corners> simplified;
    std::vector<Component> split_ones;
    for (const Corners &corners : components()) {
        simplified.push_back(simplify(corners));
        split_ones.push_back(component_of(simplified.back()));
    }
    split(split_ones);
    for (size_t i = 0; i < split_ones.size(); ++i)
        name(split_ones[i], simplified[i]);
    spread();
    renumber();
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

Component Decomposition::component_of(const Corners &corners)
{
    Component component;
    for (unsigned v : corners) {
        if (number[v] != NO_LABEL)
            continue;
        number[v] = static_cast<uint32_t>(component.points.size());
        component.points.push_back(mote_scale(positions[v], unit));
    }
    for (size_t i = 0; i + 2 < corners.size(); i += 3)
        component.faces.push_back(
            {number[corners[i]], number[corners[i + 1]], number[corners[i + 2]]});
    for (unsigned v : corners)
        number[v] = NO_LABEL;
    return component;
}

/* One that is convex is one part: of spheres HACD makes three, and takes seconds. */
void Decomposition::split(std::vector<Component> &components)
{
    std::vector<Component *> rest;
    for (Component &component : components) {
        if (component.faces.empty())
            continue;
        if (mote_parts_detail::is_convex(component)) {
            component.count = 1;
            component.part.assign(component.faces.size(), 0);
        } else {
            rest.push_back(&component);
        }
    }
    mote_parts_detail::split_by_hacd(rest, MOTE_PARTS_SECONDS);
    for (Component *component : rest) {
        if (component->count > 0)
            continue;
        mote_parts_detail::split_by_planes(*component);
        ++without_hacd;
    }
}

/* Labels the vertices that the simplification of a component kept. */
void Decomposition::name(const Component &component, const Corners &corners)
{
    for (size_t i = 0; i < corners.size(); ++i) {
        if (label[corners[i]] == NO_LABEL)
            label[corners[i]] = count + component.part[i / 3];
    }
    count += component.count;
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
    decomposition.run();
    const std::vector<uint32_t> &label = decomposition.label;
    auto *result = static_cast<mote_parts *>(malloc(sizeof(mote_parts)));
    auto *copy = static_cast<uint32_t *>(malloc(label.size() * sizeof(uint32_t)));
    if (!result || !copy) {
        free(result);
        free(copy);
        return mote_fail(MOTE_ENOMEM, "no memory for the convex parts");
    }
    std::copy(label.begin(), label.end(), copy);
    *result =
        mote_parts{decomposition.count, mesh->vertex_count, copy, decomposition.without_hacd};
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
        if (!mote_is_finite(v))
            return mote_fail(MOTE_EINVAL, "vertex %u is (%g, %g, %g); it must be finite", i,
                             v.x, v.y, v.z);
    }
    try {
        return make_parts(mesh, positions, parts);
    } catch (const std::runtime_error &error) {
        return mote_fail(MOTE_ENOMEM, "convex parts: %s", error.what());
    } catch (...) { /* callers are in C: nothing may pass them */
        return mote_fail(MOTE_ENOMEM, "no memory for the convex parts");
    }
}

extern "C" void mote_parts_destroy(mote_parts *parts)
{
    if (!parts)
        return;
    free(parts->label);
    free(parts);
}
