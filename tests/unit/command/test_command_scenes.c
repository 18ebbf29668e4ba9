/* Commands for meshes, scenarios and studies, run as a user runs them: what each refuses and
   prints. The others are in test_command.c. */
#include "tests/support/command_lines.h"
#include "tests/support/diamond.h"
#include "tests/support/test.h"

#include <unistd.h>

/* Two tetrahedra far apart, and an unused vertex. */
#define TWO                                                                                    \
    "v 0 5 0\nv 1 5 0\nv 0 6 0\nv 0 5 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\nv 0 -6 0\n"       \
    "v 1 -6 0\nv 0 -5 0\nv 0 -6 1\nf 5 7 6\nf 5 6 8\nf 5 8 7\nf 6 7 8\nv 9 9 9\n"
#define STL                                                                                    \
    "solid t\nfacet normal 0 0 -1\nouter loop\nvertex 0 0 0\nvertex 0 1 0\nvertex 1 0 0\n"     \
    "endloop\nendfacet\nendsolid t\n"
#define SCENE(more, first)                                                                     \
    "{\"purpose\": \"x\", \"frames\": 4, \"ask\": \"distance\"" more                           \
    ", \"bodies\": [{\"file\": \"" first "\"}, {\"file\": \"a.obj\", \"motion\": ["            \
    "{\"frame\": 1, \"position\": [2.1, 0.1, 0], \"axis\": [0, 1, 0], \"degrees\": 30}, "      \
    "{\"frame\": 4, \"position\": [1.9, 0.1, 0]}]}]}\n"
#define SEVERAL                                                                                \
    "{\"purpose\": \"x\", \"frames\": 4, \"ask\": \"distance\", \"tolerance\": 0.01, "         \
    "\"bodies\": {\"count\": 3, \"seed\": 2, \"near_pairs\": 1, \"near\": 0.2, "               \
    "\"speed\": 0.01, \"spin\": 1, \"shapes\": [{\"file\": \"a.obj\"}]}}\n"

static const struct {
    const char *name, *text;
} files[] = {{"diamond.obj", DIAMOND},
             {"a.obj", DIAMOND},
             {"two.obj", TWO},
             {"t.stl", STL},
             {"s.json", SCENE("", "a.obj")},
             {"contact.json", SCENE(", \"tolerance\": 0.01", "a.obj")},
             {"start.json", SCENE(", \"start\": 2", "a.obj")},
             {"pace.json", SCENE(", \"pace\": 0.5", "a.obj")},
             {"like.json", "{\"purpose\": \"x\", \"like\": \"s.json\"}\n"},
             {"two.json", SCENE("", "two.obj")},
             {"b.json", SEVERAL}};

static int put_files(void)
{
    for (size_t i = 0; i < ROWS_OF(files); ++i)
        file_put(files[i].name, files[i].text);
    return 0;
}

TEST_GROUP(put_files, NULL);

static const command_line bad_lines[] = {
    {"--allow nowhere check s.json", 4, "nowhere: No such file"},
    {"--allow", 2, "no folder; write `mote --allow DIR COMMAND`"},
    {"--allow .", 2, "no command"},
    {"list methods scenarios", 2, "scenarios: one list at a time"},
    {"list -", 2, "-; choose fields"},
    {"list methods --json=1", 2, "--json takes no value"},
    {"list methods --jsonx", 2, "unknown option --jsonx; known are: --json"},
    {"figures --quick", 2, "unknown option --quick; known are: none"},
    {"figures one two", 2, "two: one directory at a time"},
    {"figures", 2, "no directory; write `mote figures results/paper`"},
    {"extremes here", 2,
     "here: mote extremes takes no argument; write `mote extremes --out DIR`"},
    {"extremes --quick --quick=1", 2, "--quick takes no value"},
    {"extremes --method", 2, "--method needs a value: --method NAME"},
    {"extremes --method tree", 4, "unknown method tree; `mote list methods` names them"},
    {"extremes --family tuch", 4, "unknown family tuch; known are: plain, scale,"},
    {"extremes --out", 2, "--out needs a value: --out DIR"},
    {"extremes --out /proc/x", 4, "/proc/x"},
    {"bodies here", 2, "here: mote bodies takes no argument; write `mote bodies --out DIR`"},
    {"bodies --quick --out /proc/x", 4, "/proc/x"},
    {"dynamics --every 3", 2, "unknown option --every; known are: --out DIR, --quick"},
    {"letter --size 3", 2,
     "unknown option --size; known are: --triangles COUNT, -o FILE, "
     "--order letter|leaf|random"},
    {"letter W V", 2, "V: one letter at a time"},
    {"letter --triangles 400 -o W.obj", 2, "missing"},
    {"letter W --triangles 400", 2, "missing"},
    {"letter '' --triangles 400 -o W.obj", 4, "not one letter"},
    {"mesh a.obj two.obj", 2, "two.obj: one file at a time"},
    {"mesh a.obj --yaml", 2, "unknown option --yaml"},
    {"export s.json --yaml", 2, "unknown option --yaml"},
    {"export s.json a.json", 2, "a.json: one scenario at a time"},
    {"export --frame 1 --out x", 2, "missing"},
    {"export s.json --out x", 2, "missing"},
    {"export s.json --frame 99999999999999999999999 --out x", 2, "--frame 99999999"},
    {"export s.json --frame 4294967296 --out x", 2, "--frame 4294967296"},
    {"export s.json --frame 3rd --out x", 2, "--frame 3rd"},
    {"export s.json --frame 2 --out x $(yes -- '--method certified' | head -65)", 2,
     "at most 64 methods"},
    {"export s.json --frame 2 --out x --method certified:$(printf %0300d 1)", 4, "longer than"},
    {"distance a.obj two.obj t.stl", 2, "t.stl: two files at a time"},
    {"distance a.obj two.obj --yaml", 2, "unknown option --yaml"},
    {"distance a.obj two.obj $(yes -- '--method certified' | head -65)", 2,
     "at most 64 methods"},
    {"distance a.obj two.obj --method particle-paper:n=9", 4, "body 0 has 6 vertices"},
    {"approach", 2, "missing"},
    {"approach s.json --gaps 1:0.1", 2, "missing"},
    {"approach s.json --yaml", 2, "unknown option --yaml"},
    {"approach s.json b.json", 2, "b.json: one scenario at a time"},
    {"approach s.json --every 0", 2, "--every 0: give a whole number of frames from 1"},
    {"approach s.json --direction 1,x,2", 2, "--direction 1,x,2: give x,y,z"},
    {"approach s.json --direction inf,1,2", 2, "--direction inf,1,2: give x,y,z"},
    {"approach s.json --direction 0,0,0", 2, "--direction 0,0,0: give x,y,z"},
    {"approach s.json --gaps 1 -o x.json", 2, "--gaps 1: write FRAME:GAP"},
    {"approach s.json --gaps 0:1 -o x.json", 2, "--gaps 0:1: write FRAME:GAP"},
    {"approach s.json --gaps 1:0.2,5:1 -o x.json", 4, "frame 5: s has frames 1-4"},
    {"approach s.json --gaps 1: -o x.json", 2, "not a gap"},
    {"approach s.json --gaps 1:0.2x -o x.json", 2, "0.2x: not a gap"},
    {"approach s.json --gaps 1:-1 -o x.json", 2, "-1: not a gap"},
    {"approach s.json --gaps 1:1000 -o x.json", 2, "1000: not a gap"},
    {"approach s.json --gaps 4:0.1,1:0.2 -o x.json", 2, "ascending order"},
    {"approach s.json --gaps $(seq 1 1025 | sed 's/$/:0.1/' | paste -sd,) -o x.json", 2,
     "write FRAME:GAP,FRAME:GAP, at most 1024"},
    {"approach start.json --gaps 1:0.1 -o x.json", 4, "start and pace cannot be kept"},
    {"approach pace.json --gaps 1:0.1 -o x.json", 4, "start and pace cannot be kept"},
    {"approach nothing --gaps 1:0.1 -o x.json", 4, "nothing: no such scenario"},
    {"approach two.json --gaps 1:0.01 -o x.json", 4, "the bodies pass each other"},
    {"check pair::a.obj", 4, "not two files"},
    {"check pair:a.obj:", 4, "not two files"},
    {"check pair:none.obj:a.obj", 4, "none.obj: No such file"},
    {"simulate", 2, "missing"},
    {"simulate tt", 2, "missing"},
    {"simulate tt --method certified --steps 0", 2, "--steps 0"},
    {"simulate tt --method certified --gravity 1,2", 2, "--gravity"},
    {"simulate tt --method certified --density 0", 2, "--density 0: give a number above 0"},
    {"simulate tt --method certified --density -3", 2, "--density -3: give a number above 0"},
    {"simulate tt --method certified --tolerance 0", 2,
     "--tolerance 0: give L, above 0 and at most 0.05"},
    {"simulate tt --method magic", 4, "magic"},
    {"simulate nothing --method certified", 4, "nothing"},
    {"simulate teapot --method certified", 4,
     "body 1 cannot respond to a collision: its mesh is open (528 edges have one face), so "
     "that "
     "it has no volume and no mass; give a mesh without open edges, which `mote mesh FILE`"},
    {"simulate tt --method certified --steps 2 --film /proc/x.gif", 4, "/proc/x.gif"},
    {"simulate tt --method certified --time-step x", 2, "--time-step x"},
    {"simulate tt --method certified --time-step nan", 2, "--time-step nan"},
    {"simulate tt --method certified --time-step 0", 2,
     "--time-step 0: give frames, above 0 and at most 1000"},
    {"simulate tt --method certified --time-step -1", 2, "--time-step -1: give frames"},
    {"simulate jump --method certified", 4, "start in contact"},
    {"simulate mv --method certified --time-step 0.5 --steps 2 --trace x.json", 4,
     "time step of 1"},
    {"simulate tt --method certified --steps 2 --trace /proc/x.json", 4, "/proc/x.json"},
    {"simulate s.json --method certified --yaml", 2, "unknown option --yaml"},
    {"simulate s.json b.json --method certified", 2, "one scenario at a time"},
    {"simulate s.json --method certified --seed -1", 2, "--seed -1: give a whole number"},
    {"simulate s.json --method certified --density x", 2, "--density x: give a number"},
    {"simulate s.json --method certified --restitution x", 2, "--restitution x: give"},
    {"simulate s.json --method certified --tolerance 0.1.2", 2, "--tolerance 0.1.2: give"},
    {"simulate s.json --method certified --restitution -0.5", 2,
     "--restitution -0.5: give a number from 0 to 1"},
    {"simulate s.json --method certified --gravity 1e200,0,0", 2, "--gravity 1e200,0,0"},
    {"simulate b.json --method certified --steps 2 --trace /dev/null", 4, "name a file"},
};

TEST(commands_with_a_bad_line_say_so_in_one_line_and_leave_nothing)
{
    command_refuses(bad_lines, ROWS_OF(bad_lines));
}

typedef struct good_line {
    const char *arguments;
    const char *says[3];
} good_line;

static const good_line good_lines[] = {
    {"help", {"mote check SCENARIO", "Exit status: 0 done"}},
    {"-h", {"mote check SCENARIO"}},
    {"--version", {"mote "}},
    {"list --help", {"mote list "}},
    {"list -h", {"mote list "}},
    {"list fields", {"stretch: "}},
    {"--allow . check s.json", {"4 frames"}},
    {"mesh two.obj",
     {"components          2", "cleaned             0 vertices welded, 0 faces "
                               "collapsed, 1 vertices in no face"}},
    {"mesh two.obj --json", {"\"components\": 2", "\"unused\": 1", "\"part_labels\""}},
    {"mesh t.stl", {"32-bit floats"}},
    {"distance t.stl a.obj", {"fcl-aabb: distance 0, contact", "t.stl was read in 32-bit"}},
    {"distance a.obj t.stl", {"t.stl was read in 32-bit floats"}},
    {"distance a.obj t.stl --json", {"\"coordinates\": \"float\""}},
    {"distance t.stl a.obj --json", {"\"coordinates\": \"float\""}},
    {"distance a.obj two.obj --json", {"\"coordinates\": \"double\"", "\"contact\": false"}},
    {"distance a.obj two.obj --method fcl-kdop18", {"fcl-kdop18: no contact"}},
    {"distance a.obj t.stl --method fcl-kdop18", {"fcl-kdop18: contact"}},
    {"distance a.obj two.obj --method fcl-aabb:update=none",
     {"fcl-aabb:update=none: unsupported: update=none needs"}},
    {"distance a.obj two.obj --method fcl-aabb:update=none --json",
     {"\"fcl-aabb:update=none\": {", "\"unsupported\": \"update=none needs"}},
    {"simulate s.json --method certified --gravity 0,0.001,0 --restitution 0.5 --steps 3",
     {"3 steps", "momentum "}},
    {"simulate s.json --method certified --gravity 0,0.001,0 --steps 3 --json",
     {"\"steps\": 3,", "\"angular_momentum_drift\": null"}},
    {"simulate s.json --method certified --seed 7 --steps 2 --tolerance 0.01 --time-step 0.5",
     {"2 steps"}},
    {"simulate contact.json --method certified --steps 2 --json", {"\"steps\": 2,"}},
    {"simulate b.json --method certified --steps 2 --restitution 0.5", {"2 steps"}},
    {"simulate b.json --method certified --steps 2 --tolerance 0.02 --json", {"\"steps\": 2,"}},
};

TEST(commands_with_a_good_line_say_what_was_asked)
{
    const int before = folder_count(".", "");
    for (size_t i = 0; i < ROWS_OF(good_lines); ++i) {
        const good_line *good = &good_lines[i];
        mote_expect(0, "", "%s", good->arguments);
        for (int k = 0; k < 3; ++k) {
            if (good->says[k] && !strstr(said, good->says[k]))
                fail_msg("mote %s: not \"%s\":\n%s", good->arguments, good->says[k], said);
        }
        assert_int_equal(folder_count(".", ""), before);
    }
}

/* A method without a distance exports its contact; one that cannot answer at all says why. */
TEST(command_export_tells_what_a_method_cannot_answer)
{
    assert_int_equal(mote("export s.json --frame 3 --out e --method fcl-kdop18 --method "
                          "fcl-aabb:update=none"),
                     0);
    char *text = file_text("e/answers.json");
    assert_non_null(strstr(text, "\"contact\": false"));
    assert_null(strstr(text, "\"distance\""));
    assert_non_null(strstr(text, "\"unsupported\": \"update=none needs"));
    free(text);
}

/* Keys keep their rotations and get the positions found. */
TEST(command_approach_replaces_positions_only)
{
    assert_int_equal(mote("approach s.json --gaps 1:0.1,4:0.05 --every 2 --direction 0,1,0 -o "
                          "found.json"),
                     0);
    char *text = file_text("found.json");
    assert_non_null(strstr(text, "\"degrees\": 30"));
    assert_null(strstr(text, "2.1"));
    assert_int_equal(test_count(text, "\"position\""), 3); /* frames 1, 3, 4 */
    free(text);
}
