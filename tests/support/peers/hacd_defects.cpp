#include "tests/support/peers/hacd_defects.h"

#include <bullet/HACD/hacdICHull.h>

void mote_hacd_hulls(int times)
{
    const double points[5][3] = {{99.999999999999986, -300, 50},
                                 {0, -300, -100},
                                 {300, -300, 200},
                                 {-100, -100, -200},
                                 {200, -300, 200}};
    for (int i = 0; i < times; ++i) {
        HACD::ICHull hull;
        for (long k = 0; k < 5; ++k)
            hull.AddPoint(HACD::Vec3<double>(points[k][0], points[k][1], points[k][2]), k);
        hull.Process();
    }
}
