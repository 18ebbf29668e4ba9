/* HACD (Mamou 2009), where it can do no harm. */
#ifndef MOTE_CORE_PARTS_HACD_HPP
#define MOTE_CORE_PARTS_HACD_HPP

#include "core/parts/parts_component.hpp"

namespace mote_parts_detail
{

/* Splits each component into nearly convex parts (concavity 100 of a size of 1,000). HACD may
   crash, and takes minutes for some open meshes: it runs in a child process, which has so many
   seconds of the processor for all components together, and ten times as long by the clock.
   Components that it crashed on, failed on, or had no time for keep count = 0; the others do
   not notice. The caller's signals, open files and threads stay as they are. Throws
   std::bad_alloc also if HACD had no memory, and std::runtime_error if there is no process or
   pipe. */
void split_by_hacd(const std::vector<Component *> &components, double seconds);

} // namespace mote_parts_detail

#endif
