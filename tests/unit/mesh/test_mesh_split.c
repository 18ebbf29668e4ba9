/* Edges of more than two faces are split, and nothing else changes. */
#include "core/base/random.h"
#include "core/body/mesh.h"
#include "harness/mesh/mesh_import.h"
#include "harness/mesh/mesh_soup.h"
#include "tests/support/folder.h"
#include "tests/support/mote.h"
#include "tests/support/test.h"

#include <fcntl.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define FACES_MAX 64

/* Two unit cubes that touch along the edge from (1, 1, 0) to (1, 1, 1). */
static const double cube_places[14][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1},
                                          {1, 0, 1}, {1, 1, 1}, {0, 1, 1}, {2, 1, 0}, {2, 2, 0},
                                          {1, 2, 0}, {2, 1, 1}, {2, 2, 1}, {1, 2, 1}};
static const uint32_t cube_faces[12][4] = {{0, 3, 2, 1},   {4, 5, 6, 7},    {0, 1, 5, 4},
                                           {1, 2, 6, 5},   {2, 3, 7, 6},    {3, 0, 4, 7},
                                           {2, 10, 9, 8},  {6, 11, 12, 13}, {2, 8, 11, 6},
                                           {8, 9, 12, 11}, {9, 10, 13, 12}, {10, 2, 6, 13}};

static mote_soup make_soup(const double (*places)[3], size_t count)
{
    mote_soup soup = {0};
    for (size_t i = 0; i < count; ++i)
        assert_int_equal(mote_soup_add_vertex(&soup, places[i][0], places[i][1], places[i][2]),
                         MOTE_OK);
    return soup;
}

static mote_mesh *mesh_of(const mote_soup *soup)
{
    mote_mesh *mesh = NULL;
    if (mote_mesh_create(soup->xyz, soup->vertex_count, soup->indices, soup->triangle_count,
                         &mesh) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    return mesh;
}

TEST(split_cubes_that_touch_along_an_edge_both_stay_closed)
{
    mote_soup soup = make_soup(cube_places, 14);
    for (size_t f = 0; f < 12; ++f) {
        soup.line = (uint32_t)f + 15;
        assert_int_equal(mote_soup_add_polygon(&soup, cube_faces[f], 4), MOTE_OK);
    }
    mote_mesh *mesh = NULL;
    assert_int_equal(
        mote_mesh_create(soup.xyz, soup.vertex_count, soup.indices, soup.triangle_count, &mesh),
        MOTE_EINVAL);
    mote_split split;
    mote_soup_split(&soup, &split);
    assert_int_equal(split.edges, 1);
    assert_int_equal(split.vertices, 2);
    assert_string_equal(split.where,
                        "(1, 1, 0) to (1, 1, 1) with 4 faces on lines 18, 19, 23, 26");
    mesh = mesh_of(&soup);
    assert_int_equal(mesh->open_edge_count, 0);
    assert_int_equal(mesh->component_count, 2);
    assert_int_equal(mote_mesh_euler(mesh), 4);
    mote_mesh_destroy(mesh);
    mote_soup_free(&soup);
}

/* Pages of a book: an edge with `count` faces, wound alike or alternately. */
static mote_mesh *split_book(int count, bool in_turn, mote_split *split)
{
    static const double places[8][3] = {{0, 0, 0},  {0, 0, 1},  {1, 0, 0},   {1, 1, 0},
                                        {-1, 1, 0}, {-1, 0, 0}, {-1, -1, 0}, {1, -1, 0}};
    mote_soup soup = make_soup(places, 2 + (size_t)count);
    for (int i = 0; i < count; ++i) {
        const bool turned = in_turn && i % 2;
        mote_soup_add_triangle(&soup, turned, !turned, 2 + (uint32_t)i);
    }
    mote_soup_split(&soup, split);
    mote_mesh *mesh = mesh_of(&soup);
    mote_soup_free(&soup);
    return mesh;
}

TEST(split_pages_of_a_book_stay_together_where_they_enclose_an_inside)
{
    mote_split split;
    mote_mesh *mesh = split_book(6, true, &split);
    assert_int_equal(mesh->component_count, 3);
    assert_int_equal(mesh->open_edge_count, 12);
    /* The first page is wound forwards: it closes the inside that began at the last page. */
    assert_int_equal(mesh->component[2], mesh->component[7]);
    assert_int_equal(mesh->component[3], mesh->component[4]);
    mote_mesh_destroy(mesh);
    mesh = split_book(3, true, &split);
    assert_int_equal(split.edges, 1);
    assert_int_equal(split.vertices, 2);
    assert_int_equal(mesh->component_count, 2);
    mote_mesh_destroy(mesh);
    mesh = split_book(3, false, &split);
    assert_int_equal(split.vertices, 4);
    assert_int_equal(mesh->component_count, 3);
    mote_mesh_destroy(mesh);
}

TEST(split_leaves_a_mesh_of_edges_with_two_faces_as_it_is)
{
    /* Two tetrahedra with one vertex in common: its two fans are not an error. */
    static const double places[7][3] = {{0, 0, 0},  {1, 0, 0},  {0, 1, 0}, {0, 0, 1},
                                        {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
    static const uint32_t faces[8][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3},
                                         {0, 5, 4}, {0, 4, 6}, {0, 6, 5}, {4, 5, 6}};
    mote_soup soup = make_soup(places, 7);
    for (int f = 0; f < 8; ++f)
        mote_soup_add_triangle(&soup, faces[f][0], faces[f][1], faces[f][2]);
    mote_split split;
    mote_soup_split(&soup, &split);
    assert_int_equal(split.edges, 0);
    assert_int_equal(split.vertices, 0);
    assert_string_equal(split.where, "");
    assert_int_equal(soup.vertex_count, 7);
    assert_memory_equal(soup.indices, faces, sizeof faces);
    mote_soup_free(&soup);
}

static uint32_t draw(mote_random *random, uint32_t below)
{
    return (uint32_t)mote_random_below(random, below);
}

static bool has(const uint32_t face[3], uint32_t v)
{
    return face[0] == v || face[1] == v || face[2] == v;
}

/* The number of faces that share an edge; *pair receives two of them. */
static int faces_at(uint32_t (*faces)[3], int count, uint32_t a, uint32_t b, int pair[2])
{
    int found = 0;
    for (int f = 0; f < count; ++f) {
        if (has(faces[f], a) && has(faces[f], b))
            pair[found++ % 2] = f;
    }
    return found;
}

static uint32_t new_vertex(const mote_soup *soup, uint32_t (*before)[3], int face, uint32_t v)
{
    for (int k = 0; k < 3; ++k) {
        if (before[face][k] == v)
            return soup->indices[3 * face + k];
    }
    return UINT32_MAX;
}

/* The split mesh has the same positions in the same order, no edge of more than two faces, and
   every edge that had two faces before. */
static size_t check_split(const mote_soup *soup, const mote_split *split, uint32_t vertices,
                          uint32_t (*before)[3])
{
    const int count = (int)soup->triangle_count;
    size_t heavy = 0;
    for (uint32_t a = 0; a < vertices; ++a) {
        for (uint32_t b = a + 1; b < vertices; ++b) {
            int pair[2];
            const int faces = faces_at(before, count, a, b, pair);
            heavy += faces > 2;
            if (faces != 2)
                continue;
            assert_int_equal(new_vertex(soup, before, pair[0], a),
                             new_vertex(soup, before, pair[1], a));
            assert_int_equal(new_vertex(soup, before, pair[0], b),
                             new_vertex(soup, before, pair[1], b));
        }
    }
    assert_int_equal(split->edges, heavy);
    assert_int_equal(soup->vertex_count, vertices + split->vertices);
    for (int c = 0; c < 3 * count; ++c)
        assert_memory_equal(soup->xyz + 3 * soup->indices[c],
                            soup->xyz + 3 * before[c / 3][c % 3], 3 * sizeof(double));
    mote_mesh_destroy(mesh_of(soup));
    return heavy;
}

TEST(split_random_faces_make_a_mesh_of_the_same_places)
{
    mote_random random = {3};
    size_t heavy = 0;
    for (int round = 0; round < 20000; ++round) {
        const uint32_t vertices = 4 + draw(&random, 6), count = 3 + draw(&random, 30);
        uint32_t before[FACES_MAX][3];
        mote_soup soup = {0};
        for (uint32_t v = 0; v < vertices; ++v)
            assert_int_equal(mote_soup_add_vertex(&soup, draw(&random, 4), draw(&random, 4), v),
                             MOTE_OK);
        for (uint32_t f = 0; f < count;) {
            const uint32_t a = draw(&random, vertices), b = draw(&random, vertices),
                           c = draw(&random, vertices);
            if (a == b || b == c || c == a)
                continue;
            mote_soup_add_triangle(&soup, a, b, c);
            ++f;
        }
        mote_soup_compact(&soup);
        const uint32_t used = (uint32_t)soup.vertex_count;
        memcpy(before, soup.indices, count * sizeof before[0]);
        mote_split split;
        mote_soup_split(&soup, &split);
        heavy += check_split(&soup, &split, used, before);
        mote_soup_free(&soup);
    }
    assert_true(heavy > 10000);
}

/* The lines of the first faces of each of the first edges; unknown lines are left out. */
TEST(split_tells_the_first_lines_of_the_first_edges)
{
    mote_soup soup = {0};
    mote_split split;
    for (uint32_t book = 0; book < 5; ++book) {
        assert_int_equal(mote_soup_add_vertex(&soup, book, 0, 0), MOTE_OK);
        assert_int_equal(mote_soup_add_vertex(&soup, book, 0, 1), MOTE_OK);
        for (uint32_t k = 0; k < 12; ++k)
            assert_int_equal(mote_soup_add_vertex(&soup, book, 1 + k, 2), MOTE_OK);
        for (uint32_t k = 0; k < 12; ++k) {
            soup.line = book == 1 ? 0 : 100 * book + 12 - k;
            mote_soup_add_triangle(&soup, 14 * book, 14 * book + 1, 14 * book + 2 + k);
        }
    }
    mote_soup_split(&soup, &split);
    assert_int_equal(split.edges, 5);
    assert_non_null(strstr(split.where, "(0, 0, 0) to (0, 0, 1) with 12 faces on lines "));
    assert_non_null(strstr(split.where, ", ...; (1, 0, 0) to (1, 0, 1) with 12 faces; "));
    assert_null(strstr(split.where, "(4, 0, 0)"));
    mote_soup_free(&soup);
}

/* An edge whose ends are at one place, as OBJ may have it, has no direction to sort faces by.
 */
TEST(split_an_edge_of_no_length_gives_a_mesh)
{
    static const double places[6][3] = {{0, 0, 0}, {0, 0, 0},  {1, 0, 0},
                                        {0, 1, 0}, {-1, 0, 0}, {0, 0, 1}};
    mote_soup soup = make_soup(places, 6);
    mote_split split;
    for (uint32_t k = 0; k < 4; ++k)
        mote_soup_add_triangle(&soup, k % 2, 1 - k % 2, 2 + k);
    mote_soup_split(&soup, &split);
    assert_int_equal(split.edges, 1);
    for (int c = 0; c < 12; ++c)
        assert_memory_equal(soup.xyz + 3 * soup.indices[c], places[c % 3 == 2 ? 2 + c / 3 : 0],
                            sizeof places[0]);
    mote_mesh_destroy(mesh_of(&soup));
    mote_soup_free(&soup);
}

TEST(split_is_refused_with_the_number_of_edges)
{
    mote_import import = {.unused = 3};
    assert_int_equal(mote_import_refuse_split("b.obj", &import), MOTE_OK);
    (void)snprintf(import.split.where, sizeof import.split.where, "here");
    static const char *const says[] = {"b.obj: 1 edge of more than two faces (non-manifold): "
                                       "here; give each edge",
                                       "b.obj: 2 edges of more than two faces (non-manifold): "
                                       "here; give each edge"};
    for (size_t k = 0; k < 2; ++k) {
        import.split.edges = k + 1;
        assert_int_equal(mote_import_refuse_split("b.obj", &import), MOTE_EINVAL);
        assert_int_equal(strncmp(mote_error_text(), says[k], strlen(says[k])), 0);
    }
    import.split.edges = MOTE_SPLIT_EDGES_TOLD + 1;
    assert_int_equal(mote_import_refuse_split("b.obj", &import), MOTE_EINVAL);
    assert_non_null(strstr(mote_error_text(), "): here; ...; give each edge"));
}

/* Names are remembered up to a number; those beyond are told each time. */
TEST(split_is_told_once_a_file)
{
    mote_import import = {.split = {.edges = 2}};
    const int kept = dup(STDERR_FILENO), out = open("told", O_WRONLY | O_CREAT, 0600);
    (void)fflush(stderr);
    assert_true(kept >= 0 && out >= 0 && dup2(out, STDERR_FILENO) >= 0);
    for (int k = 0; k < 140; ++k) {
        char name[16];
        (void)snprintf(name, sizeof name, "f%02d.obj", k % 70);
        import.split.edges = k % 70 == 3 ? MOTE_SPLIT_EDGES_TOLD + 1 : k % 70 == 4 ? 0 : 1;
        mote_import_tell_split(name, &import);
    }
    (void)fflush(stderr);
    assert_true(dup2(kept, STDERR_FILENO) >= 0);
    assert_int_equal(close(kept) + close(out), 0);
    char *text = file_text("told");
    assert_int_equal(test_count(text, "mote: f02.obj: note: 1 edge of more than two faces"), 1);
    assert_int_equal(test_count(text, "f03.obj: note: "), 1);
    assert_int_equal(test_count(text, "; ...\n"), 1);
    assert_int_equal(test_count(text, "f04.obj"), 0);
    assert_int_equal(test_count(text, "f69.obj"), 2);
    free(text);
}

/* A hub of many faces at one edge must not be slow. */
TEST(split_an_edge_of_many_faces_takes_no_time)
{
    mote_soup soup = {0};
    assert_int_equal(mote_soup_add_vertex(&soup, 0, 0, 0), MOTE_OK);
    assert_int_equal(mote_soup_add_vertex(&soup, 0, 0, 1), MOTE_OK);
    for (uint32_t i = 0; i < 200000; ++i) {
        assert_int_equal(mote_soup_add_vertex(&soup, 1, i, 0), MOTE_OK);
        mote_soup_add_triangle(&soup, i % 2, 1 - i % 2, 2 + i);
    }
    mote_split split;
    mote_soup_split(&soup, &split);
    assert_int_equal(split.edges, 1);
    assert_int_equal(split.vertices, 2 * 99999);
    mote_soup_free(&soup);
}

static const char book[] = "v 0 0 0\nv 0 0 1\nv 1 0 0\nv 0 1 0\nv -1 -1 0\n"
                           "f 1 2 3\nf 2 1 4\nf 1 2 5\n";
static const char scene[] =
    "{\"purpose\": \"A book.\", \"frames\": 2, \"ask\": \"distance\", \"bodies\": ["
    "{\"file\": \"split_book.obj\"}, {\"file\": \"split_book.obj\", "
    "\"motion\": [{\"frame\": 1, \"position\": [3, 0, 0]}]}]}";

TEST(split_is_told_once_and_refused_by_strict)
{
    static const struct {
        const char *line;
        int code;
        const char *says;
        int notes; /* how often the note is printed */
    } cases[] = {
        {"mesh split_book.obj", 0,
         "non-manifold edges  1, cut apart with 2 new vertices: (0, 0, 0) to (0, 0, 1) with 3 "
         "faces on lines 6, 7, 8\n",
         0},
        {"mesh split_book.obj --json", 0, "\"non_manifold_edges\": 1,", 0},
        {"distance split_book.obj split_book.obj", 0, "note: 1 edge of more than two", 1},
        {"check split_book.json", 0, "note: 1 edge of more than two", 1},
        {"mesh --strict split_book.obj", 4,
         "(0, 0, 0) to (0, 0, 1) with 3 faces on lines 6, 7, 8;", 0},
        {"distance --strict split_book.obj split_book.obj", 4, "(non-manifold)", 0},
        {"run --strict split_book.json --dry-run", 4, "(non-manifold)", 0},
        {"--strict check split_book.json", 4, "(non-manifold)", 0},
    };
    file_put("split_book.obj", book);
    file_put("split_book.json", scene);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        const int code = mote("%s", cases[i].line);
        const int notes = (int)test_count(said, "note:");
        if (code != cases[i].code || !strstr(said, cases[i].says) || notes != cases[i].notes)
            fail_msg("%s: %d, %s", cases[i].line, code, said);
    }
}

/* A page ends at x = 1; the wall is at x = 3. */
TEST(split_edges_give_every_method_the_same_distance)
{
    static const char *const methods[] = {"certified",   "particle", "aabb-tree",
                                          "brute-force", "fcl-aabb", "fcl-obbrss"};
    file_put("split_book.obj", book);
    file_put("split_wall.obj", "v 3 -9 -9\nv 3 9 -9\nv 3 0 9\nf 1 2 3\n");
    for (size_t i = 0; i < sizeof methods / sizeof methods[0]; ++i) {
        char answer[64];
        (void)snprintf(answer, sizeof answer, "%s: distance 2,", methods[i]);
        mote_expect(0, answer, "distance split_book.obj split_wall.obj --method %s",
                    methods[i]);
    }
}
