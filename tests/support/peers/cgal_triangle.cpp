#include "tests/support/peers/cgal_triangle.h"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/intersections.h>
#include <CGAL/squared_distance_3.h>

#include <algorithm>
#include <cmath>

namespace
{

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Number = Kernel::FT;
using Point = Kernel::Point_3;
using Triangle = Kernel::Triangle_3;

Triangle triangle(const mote_vec3 c[3])
{
    return Triangle(Point(c[0].x, c[0].y, c[0].z), Point(c[1].x, c[1].y, c[1].z),
                    Point(c[2].x, c[2].y, c[2].z));
}

Kernel::Segment_3 edge(const Triangle &t, int i)
{
    return Kernel::Segment_3(t.vertex(i), t.vertex(i + 1));
}

double root(const Number &squared)
{
    return std::sqrt(CGAL::to_double(CGAL::exact(squared)));
}

Number least_of_parts(const Triangle &a, const Triangle &b)
{
    Number least = CGAL::squared_distance(a.vertex(0), b);
    for (int i = 0; i < 3; ++i) {
        least = std::min(least, CGAL::squared_distance(a.vertex(i), b));
        least = std::min(least, CGAL::squared_distance(b.vertex(i), a));
        for (int j = 0; j < 3; ++j)
            least = std::min(least, CGAL::squared_distance(edge(a, i), edge(b, j)));
    }
    return least;
}

} // namespace

cgal_verdict cgal_triangles(const mote_vec3 s[3], const mote_vec3 t[3])
{
    const Triangle a = triangle(s), b = triangle(t);
    cgal_verdict verdict = {};
    verdict.degenerate = a.is_degenerate() || b.is_degenerate();
    if (verdict.degenerate)
        return verdict;
    verdict.touch = CGAL::do_intersect(a, b);
    verdict.parts = verdict.touch ? 0 : root(least_of_parts(a, b));
    verdict.whole = root(CGAL::squared_distance(a, b));
    return verdict;
}
