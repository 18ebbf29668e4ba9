#include "core/body/mass.h"

#include "core/base/linear_algebra.h"

#include <float.h>
#include <stdlib.h>

/* A volume below this part of the sum of the tetrahedra's absolute volumes is taken for
 * rounding. */
#define LEAST_VOLUME 1e-12

/* Integrals over the solid, about the middle of the box and in units of L. */
typedef struct integrals {
    double volume, size;        /* size: sum of the absolute volumes of the tetrahedra */
    mote_vec3 first;            /* of the position */
    double square[3], mixed[3]; /* of xx, yy, zz; of yz, zx, xy */
} integrals;

static int compare_edges(const void *a, const void *b)
{
    const uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return (x > y) - (x < y);
}

/* Finds an edge that two faces traverse in the same direction. */
static mote_status check_winding(const mote_mesh *mesh)
{
    const size_t count = (size_t)3 * mesh->triangle_count;
    uint64_t *edges = malloc(count * sizeof *edges);
    if (!edges)
        return mote_fail(MOTE_ENOMEM, "no memory for %zu edges", count);
    for (size_t e = 0; e < count; ++e) {
        const uint32_t *t = mesh->triangles[e / 3];
        edges[e] = (uint64_t)t[e % 3] << 32 | t[(e + 1) % 3];
    }
    qsort(edges, count, sizeof *edges, compare_edges);
    mote_status status = MOTE_OK;
    for (size_t e = 1; e < count && status == MOTE_OK; ++e) {
        if (edges[e] == edges[e - 1])
            status = mote_fail(MOTE_EINVAL,
                               "the faces at the edge of vertices %u and %u are wound "
                               "differently, so that inside and outside are not defined; wind "
                               "all faces the same way",
                               (uint32_t)(edges[e] >> 32), (uint32_t)edges[e]);
    }
    free(edges);
    return status;
}

static void add_tetrahedron(integrals *sum, mote_vec3 a, mote_vec3 b, mote_vec3 c)
{
    const double six = mote_dot(a, mote_cross(b, c)); /* six times the volume */
    const mote_vec3 s = mote_add(mote_add(a, b), c);
    sum->volume += six / 6;
    sum->size += fabs(six) / 6;
    sum->first = mote_add_scaled(sum->first, six / 24, s);
    sum->square[0] += six / 120 * (a.x * a.x + b.x * b.x + c.x * c.x + s.x * s.x);
    sum->square[1] += six / 120 * (a.y * a.y + b.y * b.y + c.y * c.y + s.y * s.y);
    sum->square[2] += six / 120 * (a.z * a.z + b.z * b.z + c.z * c.z + s.z * s.z);
    sum->mixed[0] += six / 120 * (a.y * a.z + b.y * b.z + c.y * c.z + s.y * s.z);
    sum->mixed[1] += six / 120 * (a.z * a.x + b.z * b.x + c.z * c.x + s.z * s.x);
    sum->mixed[2] += six / 120 * (a.x * a.y + b.x * b.y + c.x * c.y + s.x * s.y);
}

static integrals integrate(const mote_mesh *mesh, mote_vec3 middle)
{
    integrals sum = {0};
    for (uint32_t f = 0; f < mesh->triangle_count; ++f) {
        mote_vec3 corner[3];
        for (int k = 0; k < 3; ++k)
            corner[k] = mote_scale(mote_sub(mesh->positions[mesh->triangles[f][k]], middle),
                                   1 / mesh->diagonal);
        add_tetrahedron(&sum, corner[0], corner[1], corner[2]);
    }
    return sum;
}

/* About the centre c, all in units of L and of the volume's sign. */
static mote_mat3 inertia_matrix(const integrals *sum, mote_vec3 c)
{
    const double sign = sum->volume < 0 ? -1 : 1;
    const double volume = fabs(sum->volume);
    const double xx = sign * sum->square[0] - volume * c.x * c.x;
    const double yy = sign * sum->square[1] - volume * c.y * c.y;
    const double zz = sign * sum->square[2] - volume * c.z * c.z;
    const double yz = sign * sum->mixed[0] - volume * c.y * c.z;
    const double zx = sign * sum->mixed[1] - volume * c.z * c.x;
    const double xy = sign * sum->mixed[2] - volume * c.x * c.y;
    return (mote_mat3){{{yy + zz, -xy, -zx}, {-xy, xx + zz, -yz}, {-zx, -yz, xx + yy}}};
}

static bool is_positive(double value)
{
    return value > 0 && isfinite(value);
}

mote_status mote_mass_of_mesh(const mote_mesh *mesh, double density, mote_mass *mass)
{
    if (!is_positive(density))
        return mote_fail(MOTE_EINVAL,
                         "density %g is not valid; it must be a finite number above 0",
                         density);
    if (mesh->open_edge_count > 0)
        return mote_fail(MOTE_EINVAL,
                         "the mesh is open (%u edges have one face), so it has no volume and "
                         "no mass; close it",
                         mesh->open_edge_count);
    mote_status status = check_winding(mesh);
    if (status != MOTE_OK)
        return status;
    const mote_vec3 middle = mote_scale(mote_add(mesh->low, mesh->high), 0.5);
    const integrals sum = integrate(mesh, middle);
    if (!(fabs(sum.volume) > LEAST_VOLUME * sum.size))
        return mote_fail(
            MOTE_EINVAL,
            "the mesh bounds no volume (%g of that of its tetrahedra); it must be a solid",
            sum.size > 0 ? sum.volume / sum.size : 0.0);
    const mote_vec3 centre = mote_scale(sum.first, 1 / sum.volume);
    const mote_mat3 inertia = inertia_matrix(&sum, centre);
    mote_mass made;
    status = mote_eigen_symmetric(&inertia, &made.inertia, &made.axes);
    if (status != MOTE_OK)
        return status;
    const double length = mesh->diagonal;
    made.volume = fabs(sum.volume) * length * length * length;
    made.mass = density * made.volume;
    made.centre = mote_add_scaled(middle, length, centre);
    made.inertia =
        mote_scale(made.inertia, density * length * length * length * length * length);
    /* The moments are ascending: the first and the last decide. One that is subnormal has lost
       digits. */
    if (!(made.mass >= DBL_MIN && made.inertia.x >= DBL_MIN) || !isfinite(made.mass) ||
        !isfinite(made.inertia.z))
        return mote_fail(
            MOTE_EINVAL,
            "mass %g with principal moments %g, %g, %g is not that of a solid; the "
            "mesh must be of moderate size and must not overlap itself",
            made.mass, made.inertia.x, made.inertia.y, made.inertia.z);
    *mass = made;
    return MOTE_OK;
}
