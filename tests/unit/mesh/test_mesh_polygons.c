/* Prisms over concave polygons, read from files: area, volume and distance in closed form. */
#include "core/body/mesh.h"
#include "core/body/triangle.h"
#include "harness/base/file.h"
#include "harness/mesh/mesh_import.h"
#include "tests/support/folder.h"
#include "tests/support/polygons.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

/* How a format writes a prism of n corners below and above. */
typedef struct format {
    const char *name, *head, *vertex, *face, *corner;
    bool has_count; /* a face begins with its number of corners */
    size_t first;   /* number of the first vertex */
} format;

static const format formats[] = {
    {"p.obj", "# %zu vertices, %zu faces\n", "v %g %g %g\n", "f", " %zu", false, 1},
    {"p.off", "OFF\n%zu %zu 0\n", "%g %g %g\n", "", " %zu", true, 0},
    {"p.ply",
     "ply\nformat ascii 1.0\nelement vertex %zu\nproperty double x\nproperty double y\n"
     "property double z\nelement face %zu\nproperty list uchar int vertex_indices\n"
     "end_header\n",
     "%g %g %g\n", "", " %zu", true, 0},
};

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wformat-nonliteral"
static void add_face(mote_text *out, const format *f, size_t count, const size_t *corners)
{
    mote_text_add(out, "%s", f->face);
    if (f->has_count)
        mote_text_add(out, "%zu", count);
    for (size_t i = 0; i < count; ++i)
        mote_text_add(out, f->corner, corners[i] + f->first);
    mote_text_add(out, "\n");
}

/* From height 0 to 1; the outline as written from corner `start` on. */
static void write_prism(mote_text *out, const format *f, const polygon_shape *shape,
                        size_t start)
{
    const size_t n = shape->count;
    size_t below[POLYGON_CORNERS_MAX], above[POLYGON_CORNERS_MAX];
    mote_text_add(out, f->head, 2 * n, n + 2);
    for (size_t i = 0; i < 2 * n; ++i) {
        const double *at = polygon_corner(shape, start, i % n);
        mote_text_add(out, f->vertex, at[0], at[1], i < n ? 0.0 : 1.0);
    }
    for (size_t i = 0; i < n; ++i) {
        below[i] = n - 1 - i;
        above[i] = n + i;
    }
    add_face(out, f, n, below);
    add_face(out, f, n, above);
    for (size_t i = 0; i < n; ++i) {
        const size_t next = (i + 1) % n;
        add_face(out, f, 4, (const size_t[4]){i, next, n + next, n + i});
    }
}
#pragma GCC diagnostic pop

typedef struct measures {
    double area, volume, distance;
} measures;

static measures measure(const mote_mesh *mesh, mote_vec3 dot)
{
    measures m = {0, 0, HUGE_VAL};
    for (uint32_t f = 0; f < mesh->triangle_count; ++f) {
        mote_vec3 t[3], closest;
        for (int k = 0; k < 3; ++k)
            t[k] = mesh->positions[mesh->triangles[f][k]];
        m.area += mote_length(mote_cross(mote_sub(t[1], t[0]), mote_sub(t[2], t[0]))) / 2;
        m.volume += mote_dot(t[0], mote_cross(t[1], t[2])) / 6;
        m.distance = fmin(m.distance, sqrt(mote_point_triangle(dot, t, &closest)));
    }
    return m;
}

static void check_prism(const format *f, const polygon_shape *shape, size_t start)
{
    mote_text out = {0};
    mote_mesh *mesh = NULL;
    write_prism(&out, f, shape, start);
    file_write(f->name, out.data, out.size);
    free(out.data);
    if (mote_mesh_import(f->name, &mesh, NULL) != MOTE_OK)
        fail_msg("%s from corner %zu: %s", shape->name, start, mote_error_text());
    const measures m = measure(mesh, mote_vec3_make(shape->dot[0], shape->dot[1], 1));
    if (fabs(m.area - 2 * shape->area - shape->length) > 1e-12 * m.area ||
        fabs(fabs(m.volume) - shape->area) > 1e-12 * shape->area ||
        fabs(m.distance - shape->distance) > 1e-15)
        fail_msg("%s from corner %zu in %s: area %.17g, volume %.17g, distance %.17g",
                 shape->name, start, f->name, m.area, m.volume, m.distance);
    assert_true((m.volume > 0) == (start < shape->count));
    assert_int_equal(mesh->open_edge_count, 0);
    assert_int_equal(mote_mesh_euler(mesh), 2);
    mote_mesh_destroy(mesh);
}

TEST(prism_has_its_area_volume_and_distance_in_every_format)
{
    for (size_t f = 0; f < sizeof formats / sizeof formats[0]; ++f) {
        for (size_t s = 0; s < polygon_shape_count; ++s) {
            for (size_t start = 0; start < 2 * polygon_shapes[s].count; ++start)
                check_prism(&formats[f], &polygon_shapes[s], start);
        }
    }
}
