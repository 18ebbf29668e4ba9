#include "tests/support/peers/fcl_triangle.h"

#include <limits>

#include <fcl/narrowphase/detail/primitive_shape_algorithm/triangle_distance.h>

double mote_fcl_triangle_distance(const mote_vec3 s[3], const mote_vec3 t[3])
{
    using Vector = fcl::Vector3<double>;
    Vector a[3], b[3], p, q;
    for (int k = 0; k < 3; ++k) {
        a[k] = Vector(s[k].x, s[k].y, s[k].z);
        b[k] = Vector(t[k].x, t[k].y, t[k].z);
    }
    try {
        return fcl::detail::TriangleDistance<double>::triDistance(a, b, p, q);
    } catch (...) {
        return std::numeric_limits<double>::quiet_NaN();
    }
}
