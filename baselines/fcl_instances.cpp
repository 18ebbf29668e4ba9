/* FCL's templates compiled with our flags, in place of those in Debian's library (which keeps
   Eigen's assertions). Built with -DMOTE_FCL_INSTANCES=ON only, to measure what the library's
   flags cost: at 11,840 triangles 1.1 to 1.16 times in a refit of axis-aligned boxes, 1.0
   to 1.05 in one of oriented boxes, 1.12 to 1.2 in a distance query of OBBRSS. The results that
   mote reports are the library's. */
#define EIGEN_MAX_ALIGN_BYTES 16
#define EIGEN_HAS_CXX17_OVERALIGN 0

#include <fcl/fcl.h>

namespace fcl
{

template class AABB<double>;
template class OBB<double>;
template class RSS<double>;
template class OBBRSS<double>;
template class kIOS<double>;

namespace detail
{

template class TriangleDistance<double>;
template class Intersect<double>;
template class BVFitter<OBB<double>>;
template class BVFitter<OBBRSS<double>>;
template class MeshDistanceTraversalNodeOBBRSS<double>;
template void distance(DistanceTraversalNodeBase<double> *, BVHFrontList *, int);
template void distanceRecurse(DistanceTraversalNodeBase<double> *, int, int, BVHFrontList *);
template void distanceQueueRecurse(DistanceTraversalNodeBase<double> *, int, int,
                                   BVHFrontList *, int);

} // namespace detail
} // namespace fcl
