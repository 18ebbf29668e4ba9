/* fcl-aabb: FCL with axis-aligned boxes. Bottom-up refit is correct and cheap for these. */
#include "baselines/fcl/fcl_aabb.hpp"

MOTE_METHOD(fcl_aabb) = mote_fcl::describe<mote_fcl::AabbVolume>(
    "fcl-aabb", "FCL 0.7: axis-aligned boxes, refit bottom-up, distance by its traversal node",
    mote_fcl::bottom_up_parameters);
