/* Meshes and their ordered rings against brute force over the faces. */
#include "tests/support/solids.h"
#include "tests/support/test.h"

#include <time.h>

/* Three numbers, to be sorted and compared. */
typedef struct triple {
    uint32_t v[3];
} triple;

static int compare_triples(const void *a, const void *b)
{
    const triple *p = a;
    const triple *q = b;
    for (int k = 0; k < 3; ++k) {
        if (p->v[k] != q->v[k])
            return p->v[k] < q->v[k] ? -1 : 1;
    }
    return 0;
}

static triple *allocate_triples(size_t count)
{
    triple *list = malloc((count ? count : 1) * sizeof *list);
    assert_non_null(list);
    return list;
}

/* The face v, a, b, starting from v. */
static triple corner_triple(uint32_t v, uint32_t a, uint32_t b)
{
    return (triple){{v, a < b ? a : b, a < b ? b : a}};
}

/* All corners of all faces, sorted: [3 * triangle_count]. */
static triple *corners_of_faces(const mote_mesh *mesh)
{
    triple *list = allocate_triples((size_t)3 * mesh->triangle_count);
    for (uint32_t f = 0; f < mesh->triangle_count; ++f) {
        const uint32_t *t = mesh->triangles[f];
        for (int k = 0; k < 3; ++k)
            list[3 * f + (uint32_t)k] = corner_triple(t[k], t[(k + 1) % 3], t[(k + 2) % 3]);
    }
    qsort(list, (size_t)3 * mesh->triangle_count, sizeof *list, compare_triples);
    return list;
}

/* The fans of one ring. */
typedef struct fan_counts {
    uint32_t faces, open, closed;
} fan_counts;

/* Reads the ring of v as the header describes it, appends its faces to list, and checks each
   fan: an open one has different ends; a closed one among several repeats its first neighbour;
   in between no neighbour occurs twice. */
static fan_counts read_ring(const mote_mesh *mesh, uint32_t v, triple *list)
{
    const uint32_t *ring = mesh->ring + mesh->ring_start[v];
    const uint32_t length = mesh->ring_start[v + 1] - mesh->ring_start[v];
    fan_counts counts = {0, 0, 0};
    assert_true(length >= 2);
    int ends = 0;
    for (uint32_t k = 0; k < length; ++k)
        ends += (ring[k] & MOTE_RING_END) != 0;
    if (ends == 0) {
        for (uint32_t k = 0; k < length; ++k)
            list[counts.faces++] = corner_triple(v, ring[k], ring[(k + 1) % length]);
        counts.closed = 1;
        return counts;
    }
    assert_true(ring[length - 1] & MOTE_RING_END);
    for (uint32_t first = 0; first < length;) {
        uint32_t last = first;
        while (!(ring[last] & MOTE_RING_END)) {
            const uint32_t next = MOTE_RING_VERTEX(ring[last + 1]);
            list[counts.faces++] = corner_triple(v, ring[last], next);
            ++last;
        }
        assert_true(last > first);
        if (ring[first] == MOTE_RING_VERTEX(ring[last]))
            ++counts.closed;
        else
            ++counts.open;
        first = last + 1;
    }
    return counts;
}

static uint32_t find_root(uint32_t *parent, uint32_t v)
{
    while (parent[v] != v)
        v = parent[v] = parent[parent[v]];
    return v;
}

/* Brute force: the faces around a vertex, joined if they share an edge there. A fan is open if
   one of its edges has one face. parent is scratch, [corner_count]. */
static fan_counts fans_by_faces(const triple *corners, size_t corner_count, uint32_t *parent)
{
    fan_counts counts = {(uint32_t)corner_count, 0, 0};
    for (uint32_t i = 0; i < corner_count; ++i)
        parent[i] = i;
    for (uint32_t i = 0; i < corner_count; ++i) {
        for (uint32_t j = 0; j < i; ++j) {
            const uint32_t *p = corners[i].v;
            const uint32_t *q = corners[j].v;
            if (p[1] == q[1] || p[1] == q[2] || p[2] == q[1] || p[2] == q[2])
                parent[find_root(parent, i)] = find_root(parent, j);
        }
    }
    for (uint32_t root = 0; root < corner_count; ++root) {
        if (find_root(parent, root) != root)
            continue;
        uint32_t once = 0; /* edges of this fan with one face */
        for (uint32_t i = 0; i < corner_count; ++i) {
            for (int side = 1; side <= 2; ++side) {
                uint32_t uses = 0;
                for (uint32_t j = 0; j < corner_count; ++j)
                    uses += corners[j].v[1] == corners[i].v[side] ||
                            corners[j].v[2] == corners[i].v[side];
                once += find_root(parent, i) == root && uses == 1;
            }
        }
        assert_true(once == 0 || once == 2);
        ++*(once ? &counts.open : &counts.closed);
    }
    return counts;
}

static int compare_numbers(const void *a, const void *b)
{
    const uint32_t p = *(const uint32_t *)a;
    const uint32_t q = *(const uint32_t *)b;
    return (p > q) - (p < q);
}

/* The neighbours in the ring, sorted, without the repetition that closes a fan. */
static uint32_t ring_neighbours(const mote_mesh *mesh, uint32_t v, uint32_t *out)
{
    uint32_t count = 0;
    uint32_t first = mesh->ring_start[v];
    for (uint32_t k = first; k < mesh->ring_start[v + 1]; ++k) {
        const uint32_t entry = mesh->ring[k];
        const uint32_t u = MOTE_RING_VERTEX(entry);
        if (!(k > first && u == mesh->ring[first]))
            out[count++] = u;
        if (entry & MOTE_RING_END)
            first = k + 1;
    }
    qsort(out, count, sizeof *out, compare_numbers);
    return count;
}

static uint32_t face_neighbours(const triple *corners, size_t corner_count, uint32_t *out)
{
    uint32_t count = 0;
    for (size_t i = 0; i < corner_count; ++i) {
        out[count++] = corners[i].v[1];
        out[count++] = corners[i].v[2];
    }
    qsort(out, count, sizeof *out, compare_numbers);
    uint32_t kept = 0;
    for (uint32_t i = 0; i < count; ++i) {
        if (i == 0 || out[i] != out[i - 1])
            out[kept++] = out[i];
    }
    return kept;
}

static void check_rings(const mote_mesh *mesh)
{
    const size_t corner_count = (size_t)3 * mesh->triangle_count;
    triple *expected = corners_of_faces(mesh);
    triple *seen = allocate_triples(corner_count);
    uint32_t *scratch = malloc(2 * corner_count * sizeof *scratch);
    uint32_t *named = malloc(2 * corner_count * sizeof *named);
    assert_true(scratch && named);
    size_t at = 0;
    assert_int_equal(mesh->ring_start[0], 0);
    for (uint32_t v = 0; v < mesh->vertex_count; ++v) {
        size_t end = at;
        while (end < corner_count && expected[end].v[0] == v)
            ++end;
        assert_true(mesh->ring_start[v + 1] - mesh->ring_start[v] <= 2 * (end - at));
        const fan_counts got = read_ring(mesh, v, seen + at);
        const fan_counts want = fans_by_faces(expected + at, end - at, scratch);
        assert_int_equal(got.faces, want.faces);
        assert_int_equal(got.open, want.open);
        assert_int_equal(got.closed, want.closed);
        const uint32_t count = ring_neighbours(mesh, v, named);
        assert_int_equal(count, face_neighbours(expected + at, end - at, scratch));
        assert_memory_equal(named, scratch, count * sizeof *named);
        qsort(seen + at, end - at, sizeof *seen, compare_triples);
        at = end;
    }
    assert_memory_equal(seen, expected, corner_count * sizeof *seen);
    free(expected);
    free(seen);
    free(scratch);
    free(named);
}

/* Edges by sorting every side of every face: counts, mean length. */
static void check_edges(const mote_mesh *mesh)
{
    const size_t sides = (size_t)3 * mesh->triangle_count;
    triple *list = allocate_triples(sides);
    for (uint32_t f = 0; f < mesh->triangle_count; ++f) {
        const uint32_t *t = mesh->triangles[f];
        for (int k = 0; k < 3; ++k)
            list[3 * f + (uint32_t)k] = corner_triple(0, t[k], t[(k + 1) % 3]);
    }
    qsort(list, sides, sizeof *list, compare_triples);
    uint32_t edges = 0;
    uint32_t open = 0;
    long double sum = 0;
    for (size_t i = 0; i < sides;) {
        size_t end = i + 1;
        while (end < sides && compare_triples(&list[i], &list[end]) == 0)
            ++end;
        assert_true(end - i <= 2);
        ++edges;
        open += end - i == 1;
        const mote_vec3 p = mesh->positions[list[i].v[1]];
        const mote_vec3 q = mesh->positions[list[i].v[2]];
        sum += hypotl(hypotl((long double)p.x - q.x, (long double)p.y - q.y),
                      (long double)p.z - q.z);
        i = end;
    }
    assert_int_equal(mesh->edge_count, edges);
    assert_int_equal(mesh->open_edge_count, open);
    assert_close(mesh->mean_edge, sum / edges, 1e-13L * sum / edges);
    assert_int_equal(mote_mesh_euler(mesh),
                     (int64_t)mesh->vertex_count - edges + mesh->triangle_count);
    free(list);
}

/* Components by union-find; labels are numbered from 0 without a gap. */
static void check_components(const mote_mesh *mesh)
{
    uint32_t *parent = malloc(mesh->vertex_count * sizeof *parent);
    uint32_t *label = malloc(mesh->vertex_count * sizeof *label);
    assert_true(parent && label);
    for (uint32_t v = 0; v < mesh->vertex_count; ++v) {
        parent[v] = v;
        label[v] = UINT32_MAX;
    }
    for (uint32_t f = 0; f < mesh->triangle_count; ++f) {
        const uint32_t *t = mesh->triangles[f];
        parent[find_root(parent, t[0])] = find_root(parent, t[1]);
        parent[find_root(parent, t[1])] = find_root(parent, t[2]);
    }
    uint32_t roots = 0;
    for (uint32_t v = 0; v < mesh->vertex_count; ++v) {
        const uint32_t root = find_root(parent, v);
        roots += root == v;
        assert_true(mesh->component[v] < mesh->component_count);
        if (label[root] == UINT32_MAX)
            label[root] = mesh->component[v];
        assert_int_equal(mesh->component[v], label[root]);
    }
    assert_int_equal(mesh->component_count, roots);
    free(parent);
    free(label);
}

static void check_extent(const mote_mesh *mesh)
{
    long double low[3] = {INFINITY, INFINITY, INFINITY};
    long double high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (uint32_t v = 0; v < mesh->vertex_count; ++v) {
        const mote_vec3 p = mesh->positions[v];
        const double x[3] = {p.x, p.y, p.z};
        for (int k = 0; k < 3; ++k) {
            low[k] = fminl(low[k], x[k]);
            high[k] = fmaxl(high[k], x[k]);
        }
    }
    assert_true(mesh->low.x == low[0] && mesh->low.y == low[1] && mesh->low.z == low[2]);
    assert_true(mesh->high.x == high[0] && mesh->high.y == high[1] && mesh->high.z == high[2]);
    const long double diagonal =
        hypotl(hypotl(high[0] - low[0], high[1] - low[1]), high[2] - low[2]);
    assert_close(mesh->diagonal, diagonal, 4e-16L * diagonal);
}

static void check_mesh(const mote_mesh *mesh)
{
    check_rings(mesh);
    check_edges(mesh);
    check_components(mesh);
    check_extent(mesh);
}

/* Makes the mesh of s (freed), checks all of it, and returns it. */
static mote_mesh *checked_mesh(solid s)
{
    mote_mesh *mesh = solid_to_mesh(s);
    check_mesh(mesh);
    return mesh;
}

static void check_counts(const mote_mesh *mesh, uint32_t edges, uint32_t open, int64_t euler,
                         uint32_t components)
{
    assert_int_equal(mesh->edge_count, edges);
    assert_int_equal(mesh->open_edge_count, open);
    assert_int_equal(mote_mesh_euler(mesh), euler);
    assert_int_equal(mesh->component_count, components);
}

TEST(create_tetrahedron_has_closed_rings_of_three)
{
    mote_mesh *mesh = checked_mesh(solid_tetrahedron());
    check_counts(mesh, 6, 0, 2, 1);
    for (uint32_t v = 0; v < 4; ++v)
        assert_int_equal(mesh->ring_start[v + 1] - mesh->ring_start[v], 3);
    assert_close(mesh->diagonal, sqrtl(12), 1e-15);
    assert_close(mesh->mean_edge, sqrtl(8), 1e-15);
    assert_close(mote_mesh_smallest_angle(mesh), 60, 1e-13);
    mote_mesh_destroy(mesh);
}

TEST(create_icospheres_are_closed_with_euler_two)
{
    for (int level = 0; level < 5; ++level) {
        mote_mesh *mesh = checked_mesh(solid_icosphere(level));
        const uint32_t triangles = 20u << (2 * level);
        assert_int_equal(mesh->triangle_count, triangles);
        check_counts(mesh, triangles / 2 * 3, 0, 2, 1);
        mote_mesh_destroy(mesh);
    }
}

TEST(create_torus_is_closed_with_euler_zero)
{
    mote_mesh *mesh = checked_mesh(solid_torus(17, 9));
    check_counts(mesh, 3 * 17 * 9, 0, 0, 1);
    for (uint32_t v = 0; v < mesh->vertex_count; ++v)
        assert_int_equal(mesh->ring_start[v + 1] - mesh->ring_start[v], 6);
    mote_mesh_destroy(mesh);
}

TEST(create_single_triangle_is_open)
{
    mote_mesh *mesh = checked_mesh(solid_triangle());
    check_counts(mesh, 3, 3, 1, 1);
    assert_true(mesh->diagonal == 5);
    assert_true(mesh->mean_edge == 4);
    assert_close(mote_mesh_smallest_angle(mesh), atanl(0.75L) * 180 / acosl(-1), 1e-13);
    mote_mesh_destroy(mesh);
}

TEST(create_grid_counts_its_open_edges)
{
    mote_mesh *mesh = checked_mesh(solid_grid(7, 5));
    check_counts(mesh, 7 * 6 + 8 * 5 + 35, 2 * (7 + 5), 1, 1);
    assert_close(mote_mesh_smallest_angle(mesh), 45, 1e-13);
    mote_mesh_destroy(mesh);
}

TEST(create_two_solids_has_two_components)
{
    mote_mesh *mesh = checked_mesh(solid_join(solid_icosphere(1), solid_torus(5, 4), 4));
    check_counts(mesh, 120 + 60, 0, 2 + 0, 2);
    assert_int_equal(mesh->component[0], 0);
    assert_int_equal(mesh->component[mesh->vertex_count - 1], 1);
    mote_mesh_destroy(mesh);
}

TEST(create_closed_bow_tie_keeps_both_fans)
{
    solid s = solid_join(solid_tetrahedron(), solid_icosahedron(), 3);
    solid_weld(&s, 4, 0); /* a corner of the second onto a corner of the first */
    mote_mesh *mesh = checked_mesh(s);
    check_counts(mesh, 6 + 30, 0, 3, 1);
    assert_int_equal(mesh->ring_start[1] - mesh->ring_start[0], 3 + 1 + 5 + 1);
    mote_mesh_destroy(mesh);
}

TEST(create_open_bow_tie_keeps_both_fans)
{
    solid s = solid_join(solid_triangle(), solid_tetrahedron(), 1);
    solid_weld(&s, 3, 1); /* an open and a closed fan at one vertex */
    mote_mesh *mesh = checked_mesh(s);
    check_counts(mesh, 3 + 6, 3, 2, 1);
    mote_mesh_destroy(mesh);
    s = solid_join(solid_triangle(), solid_triangle(), 1);
    solid_weld(&s, 3, 1);
    mesh = checked_mesh(s);
    check_counts(mesh, 6, 6, 1, 1);
    mote_mesh_destroy(mesh);
}

TEST(create_inconsistent_winding_gives_the_same_counts)
{
    solid s = solid_icosphere(2);
    for (size_t f = 0; f < s.triangle_count; f += 3) {
        const uint32_t swap = s.faces[3 * f];
        s.faces[3 * f] = s.faces[3 * f + 1];
        s.faces[3 * f + 1] = swap;
    }
    mote_mesh *mesh = checked_mesh(s);
    check_counts(mesh, 480, 0, 2, 1);
    mote_mesh_destroy(mesh);
}

TEST(create_duplicate_face_closes_the_pair)
{
    solid s = solid_allocate(3, 2);
    solid_set_vertex(&s, 0, 0, 0, 0);
    solid_set_vertex(&s, 1, 1, 0, 0);
    solid_set_vertex(&s, 2, 0, 1, 0);
    solid_set_face(&s, 0, 0, 1, 2);
    solid_set_face(&s, 1, 1, 2, 0);
    mote_mesh *mesh = checked_mesh(s);
    check_counts(mesh, 3, 0, 2, 1);
    for (uint32_t v = 0; v < 3; ++v)
        assert_int_equal(mesh->ring_start[v + 1] - mesh->ring_start[v], 2);
    mote_mesh_destroy(mesh);
}

TEST(create_zero_area_faces_are_allowed)
{
    solid s = solid_grid(3, 3);
    solid_set_vertex(&s, 5, 0, 1, 0); /* onto vertex 1: two equal corners, zero area */
    mote_mesh *mesh = checked_mesh(s);
    check_counts(mesh, 33, 12, 1, 1);
    assert_true(mote_mesh_smallest_angle(mesh) == 0);
    mote_mesh_destroy(mesh);
}

/* Random faces, without those that would give an edge a third face: open and closed fans,
   several at a vertex, duplicates and mixed winding, in all combinations. */
TEST(create_random_faces_match_brute_force)
{
    uint64_t seed = 11;
    for (int round = 0; round < 400; ++round) {
        const uint32_t n = 4 + (uint32_t)(random_bits(&seed) % 12);
        const size_t tries = 1 + random_bits(&seed) % 60;
        uint8_t uses[16][16] = {{0}};
        solid s = solid_allocate(n, tries);
        s.triangle_count = 0;
        for (size_t k = 0; k < tries; ++k) {
            const uint32_t a = (uint32_t)(random_bits(&seed) % n);
            const uint32_t b = (uint32_t)(random_bits(&seed) % n);
            const uint32_t c = (uint32_t)(random_bits(&seed) % n);
            if (a == b || b == c || c == a || uses[a][b] == 2 || uses[b][c] == 2 ||
                uses[c][a] == 2)
                continue;
            ++uses[a][b], ++uses[b][c], ++uses[c][a];
            ++uses[b][a], ++uses[c][b], ++uses[a][c];
            solid_set_face(&s, s.triangle_count++, a, b, c);
        }
        for (uint32_t v = 0; v < n; ++v) {
            const mote_vec3 p = random_vec3(&seed, 1);
            solid_set_vertex(&s, v, p.x, p.y, p.z);
        }
        for (uint32_t v = (uint32_t)s.vertex_count; v-- > 0;) {
            int used = 0;
            for (size_t k = 0; k < 3 * s.triangle_count; ++k)
                used |= s.faces[k] == v;
            if (!used)
                solid_weld(&s, v, v);
        }
        if (s.triangle_count == 0)
            solid_free(&s);
        else
            mote_mesh_destroy(checked_mesh(s));
    }
}

TEST(create_copies_its_input)
{
    solid s = solid_icosphere(1);
    mote_mesh *mesh = NULL;
    assert_int_equal(mote_mesh_create(s.xyz, s.vertex_count, s.faces, s.triangle_count, &mesh),
                     MOTE_OK);
    assert_int_equal(mesh->vertex_count, s.vertex_count);
    assert_int_equal(mesh->triangle_count, s.triangle_count);
    assert_memory_equal(mesh->positions, s.xyz, 3 * s.vertex_count * sizeof(double));
    assert_memory_equal(mesh->triangles, s.faces, 3 * s.triangle_count * sizeof(uint32_t));
    assert_ptr_not_equal(mesh->positions, s.xyz);
    assert_int_equal(mote_mesh_bytes(mesh),
                     sizeof *mesh + 42 * (24 + 4) + 43 * 4 + 80 * 12 + 240 * 4);
    solid_free(&s);
    check_mesh(mesh);
    mote_mesh_destroy(mesh);
    mote_mesh_destroy(NULL);
}

static double process_seconds(void)
{
    return (double)clock() / CLOCKS_PER_SEC;
}

TEST(create_fan_of_100000_faces_takes_linear_time)
{
    for (int closed = 0; closed <= 1; ++closed) {
        solid s = solid_fan(100000u + (closed ? 1 : 2), closed);
        const double start = process_seconds();
        mote_mesh *mesh = solid_to_mesh(s);
        assert_true(process_seconds() - start < 2);
        assert_int_equal(mesh->triangle_count, 100000);
        const uint32_t length = mesh->ring_start[1] - mesh->ring_start[0];
        assert_int_equal(length, closed ? 100000 : 100001);
        for (uint32_t k = 0; k + 1 < length; ++k) {
            const uint32_t step = MOTE_RING_VERTEX(mesh->ring[k + 1]) - mesh->ring[k];
            assert_true(step == 1 || step == UINT32_MAX || step == 99999 || -step == 99999);
        }
        check_counts(mesh, closed ? 200000 : 200001, closed ? 100000 : 100002, 1, 1);
        check_edges(mesh);
        mote_mesh_destroy(mesh);
    }
}
