/* mote mesh FILE [--json] [--strict]: describes a mesh. */
#include "core/parts/parts.h"
#include "harness/command/character_facts.h"
#include "harness/command/command.h"
#include "harness/base/options.h"
#include "harness/mesh/mesh_import.h"
#include "harness/base/record.h"

#include <inttypes.h>
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

typedef struct edge_facts {
    double shortest, mean, longest;
} edge_facts;

static edge_facts measure_edges(const mote_mesh *mesh)
{
    edge_facts facts = {HUGE_VAL, mesh->mean_edge, 0};
    for (uint32_t t = 0; t < mesh->triangle_count; ++t) {
        for (int k = 0; k < 3; ++k) {
            const mote_vec3 a = mesh->positions[mesh->triangles[t][k]];
            const mote_vec3 b = mesh->positions[mesh->triangles[t][(k + 1) % 3]];
            const double length = sqrt(mote_distance_squared(a, b));
            facts.shortest = fmin(facts.shortest, length);
            facts.longest = fmax(facts.longest, length);
        }
    }
    return facts;
}

/* Prints one line per part: its label and its position. */
static void print_parts(const mote_mesh *mesh, const mote_parts *parts)
{
    (void)printf("convex parts        %" PRIu32, parts->count);
    if (parts->without_hacd > 0)
        (void)printf(
            " (of %" PRIu32 " component%s by their planes: HACD crashed, or needs more than "
            "%d s)",
            parts->without_hacd, parts->without_hacd > 1 ? "s" : "", MOTE_PARTS_SECONDS);
    (void)printf("\n");
    for (uint32_t label = 0; label < parts->count; ++label) {
        uint32_t count = 0;
        mote_vec3 sum = {0, 0, 0};
        for (uint32_t v = 0; v < mesh->vertex_count; ++v) {
            if (parts->label[v] != label)
                continue;
            ++count;
            sum = mote_add(sum, mesh->positions[v]);
        }
        const mote_vec3 middle = mote_scale(sum, 1.0 / count);
        (void)printf("  part %-4" PRIu32 "         %" PRIu32
                     " vertices about (%.3g, %.3g, %.3g)\n",
                     label, count, middle.x, middle.y, middle.z);
    }
}

static json_t *labels_json(const mote_parts *parts)
{
    json_t *labels = json_array();
    for (uint32_t v = 0; v < parts->vertex_count; ++v)
        json_array_append_new(labels, json_integer(parts->label[v]));
    return labels;
}

static void print_lines(const char *path, const mote_mesh *mesh, const mote_import *import,
                        const mote_parts *parts)
{
    const edge_facts edges = measure_edges(mesh);
    (void)printf("%s\n", path);
    (void)printf("vertices            %" PRIu32 "\n", mesh->vertex_count);
    (void)printf("triangles           %" PRIu32 "\n", mesh->triangle_count);
    (void)printf("edges               %" PRIu32 "\n", mesh->edge_count);
    (void)printf("open edges          %" PRIu32 "\n", mesh->open_edge_count);
    (void)printf("non-manifold edges  %zu", import->split.edges);
    if (import->split.edges > 0)
        (void)printf(", cut apart with %zu new vertices: %s%s", import->split.vertices,
                     import->split.where,
                     import->split.edges > MOTE_SPLIT_EDGES_TOLD ? "; ..." : "");
    (void)printf("\n");
    (void)printf("components          %" PRIu32 "\n", mesh->component_count);
    (void)printf("Euler               %" PRId64 "\n", mote_mesh_euler(mesh));
    (void)printf("smallest angle      %.4g degrees\n", mote_mesh_smallest_angle(mesh));
    (void)printf("L                   %.9g\n", mesh->diagonal);
    (void)printf("edge lengths        %.4g / %.4g / %.4g L (shortest / mean / longest)\n",
                 edges.shortest / mesh->diagonal, edges.mean / mesh->diagonal,
                 edges.longest / mesh->diagonal);
    print_parts(mesh, parts);
    (void)printf("coordinates         %s\n",
                 import->single_precision ? "32-bit floats (assimp's)" : "64-bit floats");
    if (import->welded + import->collapsed + import->unused > 0)
        (void)printf("cleaned             %zu vertices welded, %zu faces collapsed, %zu "
                     "vertices in no face\n",
                     import->welded, import->collapsed, import->unused);
    mote_character_facts_print(path);
}

static int print_json(const char *path, const mote_mesh *mesh, const mote_import *import,
                      const mote_parts *parts)
{
    const edge_facts edges = measure_edges(mesh);
    json_t *root = json_pack(
        "{s:s, s:i, s:i, s:i, s:i, s:I, s:i, s:I, s:f, s:f, s:[f,f,f], s:i, s:i, s:s, s:I, "
        "s:I, "
        "s:I, s:I}",
        "file", path, "vertices", mesh->vertex_count, "triangles", mesh->triangle_count,
        "edges", mesh->edge_count, "open_edges", mesh->open_edge_count, "non_manifold_edges",
        (json_int_t)import->split.edges, "components", mesh->component_count, "euler",
        (json_int_t)mote_mesh_euler(mesh), "smallest_angle", mote_mesh_smallest_angle(mesh),
        "length", mesh->diagonal, "edge_lengths", edges.shortest, edges.mean, edges.longest,
        "parts", parts->count, "parts_without_hacd", parts->without_hacd, "coordinates",
        import->single_precision ? "float" : "double", "welded", (json_int_t)import->welded,
        "collapsed", (json_int_t)import->collapsed, "unused", (json_int_t)import->unused,
        "split_vertices", (json_int_t)import->split.vertices);
    if (!root) {
        (void)mote_fail(MOTE_EINVAL, "%s: not UTF-8, which JSON needs; rename it", path);
        return mote_command_fail();
    }
    /* The part of each vertex, in vertex order. */
    (void)json_object_set_new(root, "part_labels", labels_json(parts));
    (void)json_object_set_new(root, "character", mote_character_facts_json(path));
    return mote_json_put(root, JSON_INDENT(2), stdout) == MOTE_OK ? MOTE_EXIT_DONE
                                                                  : mote_command_fail();
}

const mote_option mote_options_mesh[] = {
    {"json", NULL, "as JSON (default: as text)"},
    {"strict", NULL, "refuse edges of more than two faces (default: cut them apart)"},
    {NULL, NULL, NULL}};

int mote_command_mesh(int argc, char **argv)
{
    mote_option_reader reader = mote_option_begin(mote_options_mesh, argc, argv);
    const char *path = NULL, *value;
    bool json = false;
    for (int option; (option = mote_option_next(&reader, &value)) != MOTE_OPTION_END;) {
        if (option == MOTE_OPTION_ERROR)
            return MOTE_EXIT_USAGE;
        if (option == MOTE_OPTION_PLAIN && path)
            return mote_command_usage("mesh", "%s: one file at a time", value);
        if (option == MOTE_OPTION_PLAIN)
            path = value;
        else if (option == 0)
            json = true;
        else
            mote_mesh_import_strictly();
    }
    if (!path)
        return mote_command_usage("mesh", "no file; write `mote mesh FILE`");
    mote_mesh *mesh;
    mote_import import;
    if (mote_mesh_import(path, &mesh, &import) != MOTE_OK)
        return mote_command_fail();
    mote_parts *parts;
    int code = MOTE_EXIT_DONE;
    if (mote_parts_create(mesh, NULL, &parts) != MOTE_OK) {
        code = mote_command_fail();
    } else {
        if (json)
            code = print_json(path, mesh, &import, parts);
        else
            print_lines(path, mesh, &import, parts);
        mote_parts_destroy(parts);
    }
    mote_mesh_destroy(mesh);
    return mote_command_finish(code);
}
