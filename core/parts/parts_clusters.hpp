/* Nearly convex parts by our own means: for components that are convex, which need no HACD, and
   for those that HACD fails on. */
#ifndef MOTE_CORE_PARTS_CLUSTERS_HPP
#define MOTE_CORE_PARTS_CLUSTERS_HPP

#include "core/parts/parts_component.hpp"

namespace mote_parts_detail
{

/* Whether a component is the whole surface of a convex solid, or a flat sheet with a convex
   outline, but for dents of a few percent of its size. False says nothing. O(faces points). */
bool is_convex(const Component &component);

/* Splits a component: faces that share a point are joined, those first that lie least in front
   of each other, as long as no point of a part lies farther than a part of the component's
   size in front of a face's plane, or beyond an open edge of a face within that plane.
   Deterministic, and the same at every scale by a power of two. O(faces^2) time and memory.
   Throws std::bad_alloc. */
void split_by_planes(Component &component);

} // namespace mote_parts_detail

#endif
