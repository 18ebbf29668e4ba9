/* Commands on bodies that move by files of their own (sequences, caches, characters), while
   each place where they ask for memory, files or processes fails once. */
#include "tests/faults/fault_lines.h"
#include "tests/support/bar.h"
#include "tests/support/sheet.h"
#include "tests/support/test.h"

#include <stddef.h>
#include <sys/stat.h>

#define FRAMES 3
#define SCENE(body)                                                                            \
    "{\"purpose\": \"a test\", \"frames\": 3, \"ask\": \"distance\", \"bodies\": [" body       \
    ", {\"file\": \"a.obj\"}]}\n"

/* A triangle and a morph target in cubic keys: the data are its corners twice, two times, and
   the tangents and values of a weight. */
#define GLTF                                                                                   \
    "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{"   \
    "\"name\":\"Part\",\"mesh\":0}],\"meshes\":[{\"primitives\":[{\"attributes\":{"            \
    "\"POSITION\":0},\"targets\":[{\"POSITION\":0}]}]}],\"accessors\":[{\"bufferView\":0,"     \
    "\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"min\":[0,0,0],\"max\":[1,1,0]},"   \
    "{\"bufferView\":0,\"byteOffset\":36,\"componentType\":5126,\"count\":2,\"type\":"         \
    "\"SCALAR\",\"min\":[0],\"max\":[2]},{\"bufferView\":0,\"byteOffset\":44,"                 \
    "\"componentType\":5126,\"count\":6,\"type\":\"SCALAR\"}],\"bufferViews\":[{\"buffer\":0," \
    "\"byteLength\":68}],\"buffers\":[{\"uri\":\"p.bin\",\"byteLength\":68}],\"animations\":[" \
    "{\"name\":\"Move\",\"channels\":[{\"sampler\":0,\"target\":{\"node\":0,\"path\":"         \
    "\"weights\"}}],\"samplers\":[{\"input\":1,\"output\":2,\"interpolation\":"                \
    "\"CUBICSPLINE\"}]}]}"

TEST(sequences_when_a_call_fails_say_so)
{
    static const fault_line list[] = {
        LINE(check, " files.json", 0),
        LINE(check, " plies.json", 0),
        LINE(export, " cache.json --frame 2 --out out --method aabb-tree", 0),
        LINE(run, " cache.json --method certified --replicates 1 --stride 1 --out out", 0),
        LINE(sequence, " cloth --triangles 800 --frames 2 --out out", 0),
    };
    FAIL_EACH(list);
}

TEST(characters_when_a_call_fails_say_so)
{
    static const fault_line list[] = {
        LINE(mesh, " bar.x", 0),
        LINE(mesh, " p.gltf --json", 0),
        LINE(export, " bar.json --frame 2 --out out --method certified", 0),
        LINE(check, " crowd.json", 0),
    };
    FAIL_EACH(list);
}

/* The meshes are copied beside the scenario, which lies elsewhere. */
TEST(scenarios_written_elsewhere_when_a_call_fails_say_so)
{
    static const fault_line list[] = {
        LINE(approach, " bar.json --gaps 1:0.5 -o elsewhere/a.json", 0),
        LINE(approach, " s.json --gaps 1:0.1 -o elsewhere/a.json", 0),
    };
    FAIL_EACH(list);
}

TEST(movers_whose_memory_runs_out_end_with_a_line)
{
    static const fault_line list[] = {
        LINE(export, " cache.json --frame 2 --out out", 0),
        LINE(export, " bar.json --frame 2 --out out", 0),
        LINE(mesh, " p.gltf --json", 0),
    };
    EXHAUST_EACH(list);
}

static int make_files(void)
{
    static const float data[17] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 2, 0, 0, 1, 0, 1, 0};
    static const struct {
        const char *name, *text;
    } files[] = {
        {"files.json", SCENE("{\"positions\": \"f1.obj\"}")},
        {"plies.json", SCENE("{\"positions\": \"f1.ply\"}")},
        {"cache.json", SCENE("{\"file\": \"f1.obj\", \"positions\": \"c.pc2\"}")},
        {"bar.json", SCENE("{\"character\": \"bar.x\", \"subdivide\": 1}")},
        {"crowd.json", "{\"purpose\": \"a test\", \"frames\": 3, \"ask\": \"contact\", "
                       "\"bodies\": {\"count\": 2, \"box\": 6, \"near\": 0.2, \"shapes\": ["
                       "{\"character\": \"bar.x\"}, {\"positions\": \"f1.ply\"}]}}\n"},
        {"p.gltf", GLTF},
    };
    if (!fault_lines_open() || mkdir("elsewhere", 0700) != 0)
        return -1;
    for (size_t i = 0; i < ROWS_OF(files); ++i) {
        if (!fault_lines_write(files[i].name, files[i].text))
            return -1;
    }
    for (int k = 1; k <= FRAMES; ++k) {
        char name[16];
        (void)snprintf(name, sizeof name, "f%d.obj", k);
        sheet_write_obj(name, k);
        (void)snprintf(name, sizeof name, "f%d.ply", k);
        sheet_write_ply(name, k, SHEET_LITTLE);
    }
    sheet_write_pc2("c.pc2", FRAMES, false);
    bar_write("bar.x", bar_default());
    file_write("p.bin", data, sizeof data);
    return 0;
}

TEST_GROUP(make_files, fault_lines_close);
