/* The program itself, run as a user runs it. */
#include "tests/support/command_lines.h"
#include "tests/support/diamond.h"
#include "tests/support/test.h"

#include <unistd.h>

#define TEN "0123456789"
#define SEVENTY TEN TEN TEN TEN TEN TEN TEN
/* Two diamonds that pass each other. */
#define SCENARIO SCENE("", "2.1", "1.9")
/* more: further keys; from, until: along x, in L. They touch below 0.48. */
#define SCENE(more, from, until)                                                               \
    "{\"purpose\": \"a test\", \"frames\": 4, \"ask\": \"distance\"" more ", \"bodies\": [{"   \
    "\"file\": \"d.obj\"}, {\"file\": \"d.obj\", \"motion\": [{\"frame\": 1, \"position\": "   \
    "[" from ", 0.1, 0]}, {\"frame\": 4, \"position\": [" until ", 0.1, 0]}]}]}\n"

static const struct {
    const char *name, *text;
} files[] = {{"broken.json", "{\"purpose\": \"x\",\n \"frames\": }\n"},
             {"unknown.json", "{\"purpose\": \"x\",\n \"speed\": 1}\n"},
             {"d.obj", DIAMOND},
             {"s.json", SCENARIO},
             {"away.json", SCENE("", "0.9", "1.5")},
             {"near.json", SCENE(", \"active\": [1, 4]", "0.58", "0.6")},
             {"far.json", SCENE(", \"active\": [2, 4]", "0.6", "3")}};

static int put_files(void)
{
    for (size_t i = 0; i < ROWS_OF(files); ++i)
        file_put(files[i].name, files[i].text);
    return 0;
}

TEST_GROUP(put_files, NULL);

static const command_line bad_lines[] = {
    {"", 2, "no command"},
    {"fly", 2, "unknown command fly; known are"},
    {"list", 2, "methods or scenarios"},
    {"list planets", 2, "planets"},
    {"list methods --yaml", 2, "unknown option --yaml"},
    {"letter W", 2, "missing"},
    {"letter W --triangles", 2, "needs a value"},
    {"letter W --triangles many -o W.obj", 2, "give an even number from 400 to 20000000"},
    {"letter W --triangles 401 -o W.obj", 2, "--triangles 401: give an even number"},
    {"letter WW --triangles 400 -o W.obj", 4, "not one letter"},
    {"letter W --triangles 400 -o no/W.obj", 4, "no/W.obj"},
    {"check", 2, "no scenario"},
    {"check nothing", 4, "nothing: no such scenario; known are"},
    {"check missing.json", 4, "missing.json: No such file"},
    {"check broken.json", 4, "broken.json:2:"},
    {"check unknown.json", 4, "unknown.json:2: speed: unknown key"},
    {"check ./", 4, "not a regular file"},
    {"check /dev/zero/", 4, "/dev/zero/"},
    {"export tt --frame 1", 2, "missing"},
    {"export tt --frame 0 --out x", 2, "--frame 0"},
    {"export tt --frame 601 --out x", 4, "frames 1-600"},
    {"export tt --frame 1 --out x --method magic", 4, "unknown method magic; known are"},
    {"export tt --frame 1 --out x --method fcl-aabb:speed=9", 4, "speed"},
    {"export tt --frame 1 --out x --method particle-paper:n=0", 4, "n"},
    {"export tt --frame 1 --out x --method particle-paper:n=100000", 4, "n"},
    {"export tt --frame 1 --out /proc/x", 4, "/proc/x"},
    {"export tt --frame 1 --out broken.json/x", 4, "broken.json"},
    {"approach tt -o x.json", 2, "missing"},
    {"approach tt --gaps 1:0.1,700:1 -o x.json", 4, "frame 700: tt has frames 1-600"},
    {"approach tt --gaps 1:0.1,zwei -o x.json", 2, "zwei"},
    {"run missing.json --method fcl-aabb --out x", 4, "missing.json"},
    {"run broken.json --method fcl-aabb --out x", 4, "broken.json:2:"},
    {"run tt --method magic --out x", 4, "magic"},
    {"run tt --method particle-paper:n=0 --out x", 4, "n"},
    {"run tt --method fcl-aabb --frames 9-3 --out x", 2, "9-3"},
    {"run tt --method fcl-aabb --out /proc/x", 4, "/proc/x"},
    {"run --pair a.obj", 2, "two mesh files"},
    {"run tt --direction 1,0,0", 2, "--direction is for --pair"},
    {"run --pair a.obj b.obj --direction 0,0,0", 2, "X,Y,Z, not all 0"},
    {"run --pair a.obj b.obj --direction up", 2, "X,Y,Z, not all 0"},
    {"run --pair a.obj b.obj --method fcl-aabb --out x", 4, "a.obj"},
    {"check pair:a.obj", 4, "not two files"},
    {"mesh", 2, "no file"},
    {"mesh nothing.obj", 4, "nothing.obj"},
    {"mesh broken.json", 4, "broken.json"},
    {"mesh .", 4, "not a regular file"},
    {"distance a.obj", 2, "two files"},
    {"distance a.obj b.obj", 4, "a.obj"},
    {"distance a.obj b.obj --method magic", 4, "magic"},
    {"check s.json s.json", 2, "one scenario at a time"},
    {"check far.json --json", 1, "far.json: active 2-4: only 0 of 3 frames"},
    {"check s.json --fast", 2, "unknown option --fast; known are: --json, --out DIR"},
    {"check s.json --json=yes", 2, "--json takes no value"},
    {"check -", 4, "-: no such scenario"},
    {"summarize --formats x", 2, "unknown option --formats"},
    {"summarize --format=yaml x", 2, "--format yaml: choose table"},
    {"summarize x y", 2, "y: one directory at a time"},
    {"summarize", 2, "no directory"},
    {"letter W --triangles 99999999999999999999999 -o W.obj", 2, "give an even number"},
    {"letter W --triangles 400x -o W.obj", 2, "--triangles 400x"},
    {"approach s.json --gaps 1:0.1 --direction 1,0 -o x.json", 2,
     "--direction 1,0: give x,y,z"},
    {"approach s.json --gaps 1:0.1 --direction 1,nan,0 -o x.json", 2, "give x,y,z"},
    {"approach s.json --gaps 1:0.1 --direction 1,,0 -o x.json", 2, "give x,y,z"},
    {"approach s.json --gaps 1:0.1 --direction 1,0,0,0 -o x.json", 2, "give x,y,z"},
    {"run s.json --frames 0-3 --out x", 2, "--frames 0-3: outside 1-"},
    {"run s.json --frames " SEVENTY " --out x", 2, "not a range"},
    {"run s.json --frames 1-x --out x", 2, "not a range"},
    {"run s.json --method " SEVENTY SEVENTY SEVENTY SEVENTY " --out x", 4,
     "longer than 255 characters"},
    {"run s.json --particles 1-2 --method " SEVENTY " --out x", 4, "unknown method 01234"},
    {"run s.json --particles 1-2 --method magic --out x", 4, "unknown method magic"},
    {"run s.json --particles 1-4000000000 --method particle --out x", 2, "more than 10000"},
    {"run s.json --particles 1-2 --replicates 1000 --out x", 4, "at most 10000 in one run"},
    {"run s.json --shard 1", 2, "--shard 1: expected I/N"},
    {"run s.json --shard " SEVENTY "/2", 2, "expected I/N"},
    {"run s.json --shard 1/x", 2, "--shard 1/x: expected I/N"},
    {"run s.json --seed -1", 2, "--seed -1: expected a whole number"},
    {"run s.json --timeout 0", 2, "--timeout 0: expected seconds"},
    {"run s.json --budget -1", 2, "--budget -1: expected seconds"},
    {"run s.json --until-ci %", 2, "expected a percentage"},
    {"run s.json --until-ci " SEVENTY "%", 2, "expected a percentage"},
    {"run s.json --until-ci 200%", 2, "expected a percentage"},
    {"run s.json --until-ci 25", 2, "expected a percentage"},
    {"run s.json --out ''", 2, "expected a directory"},
    {"run --pair d.obj d.obj --pair d.obj d.obj", 2, "two mesh files, once"},
    {"history --fast", 2, "unknown option --fast"},
    {"history --add x", 2, "go together"},
    {"history x --why y", 2, "go together"},
    {"history --add x --why ''", 4, "no reason"},
    {"merge --x", 2, "known are: none"},
    {"merge", 2, "runs are missing"},
    {"merge x", 2, "runs are missing"},
    {"tune --x", 2, "unknown option --x; known are: --best SCENARIO, --best-fcl SCENARIO"},
    {"tune x y", 2, "y: one directory at a time"},
    {"tune --best-fcl=s x", 4, "x/tune.json: there is none; `mote tune x` writes it"},
    {"compare --x", 2, "unknown option --x"},
    {"compare x", 2, "two runs are needed"},
    {"compare x y z", 2, "z: two runs at a time"},
    {"compare x y --floor nine", 2, "--floor nine: expected a share"},
    {"compare x y --format yaml", 2, "choose table or json"},
    {"instructions --x", 2, "unknown option --x"},
    {"instructions s.json s.json", 2, "one scenario at a time"},
    {"instructions --frames 1-2 --method certified --out x", 2, "a scenario, --frames"},
    {"instructions s.json --method certified --out x", 2, "a scenario, --frames"},
    {"instructions s.json --frames 1-2 --method certified", 2, "--out are needed"},
    {"instructions s.json --frames 1-2 --out x", 2, "--method and --out are needed"},
    {"instructions s.json --frames 2-1 --inside --method certified", 2, "2-1: an empty range"},
    {"instructions s.json --frames 1-9 --inside --method certified", 4, "it has frames 1-4"},
    {"instructions s.json --frames 1-2 --inside --method magic", 4, "unknown method magic"},
    {"instructions s.json --frames 1-2 --inside --particles 2,x --method particle", 2,
     "x: not a range"},
    {"instructions missing.json --frames 1-2 --inside --method certified", 4,
     "missing.json: No such file"},
    {"report --fast", 2, "known are: none"},
    {"report x y", 2, "y: one directory at a time"},
    {"report", 2, "no directory"},
    {"claims --quick x", 2, "x: mote claims takes no argument"},
    {"claims --out", 2, "--out needs a value"},
    {"mesh -- -x.obj", 4, "mote: -x.obj: No such file"},
    {"mesh -- -x.obj --", 2, "--: one file at a time"},
    {"check pair:d.obj:d.obj:0,0,0", 4, "not all 0"},
    {"approach s.json --gaps 2:1,1:2 -o x.json", 2, "--gaps frame 1 comes after frame 2"},
    {"approach s.json --gaps 1:0.1 --direction 0,0,0 -o x.json", 2, "not all 0"},
    {"approach away.json --gaps 1:0.5 -o no/x.json", 4,
     "no/: No such file or directory; name an existing folder"},
    {"letter W --triangles 400 -o no/W.obj", 4, "mote: no/W.obj: cannot be created"},
    {"letter W --triangles 400 -o /dev/full", 4, "mote: /dev/full: cannot be written"},
    {"run s.json --method particle:n=7 --out x", 4, "mote: particle:n=7 on s: n=7 is not "},
    {"compare . .", 4, "mote: .: neither cells nor a summary.json"},
    {"history d.obj", 4, "not the header of a history; name a file"},
};

TEST(main_bad_line_one_line_and_its_exit_status)
{
    command_refuses(bad_lines, ROWS_OF(bad_lines));
}

/* Valid command lines, and what they must print. */
static const command_line good_lines[] = {
    {"run s.json --dry-run --replicates 1 --particles 1-2 --method particle-paper:n=3", 0,
     "plan: 1 cells, 0 of them done"},
    {"run s.json --dry-run --replicates 1 --particles 1-2 --method particle-paper:law=log,n=3",
     0, "s particle-paper:law=log,n=3 replicate 1, frames 1-4"},
    {"run s.json --dry-run --replicates 1 --particles 1-2 --method particle-paper", 0,
     "plan: 2 cells"},
    {"run s.json s.json --dry-run --replicates 1 --method 'fcl-aabb|fcl-rss' --method "
     "fcl-aabb:queue=2",
     0, "plan: 2 cells"},
    {"run s.json --dry-run --method fcl-aabb --seed 3 --fixed-seed --cache evict --stride 2 "
     "--jobs 2 --force --timeout 3 --budget 2",
     0, "s fcl-aabb replicate 3, frames 1-4, stride 2, evict"},
    {"run s.json --dry-run --method fcl-aabb --cache hot --stride auto --frames 2-3", 0,
     "s fcl-aabb replicate 1, frames 2-3, stride 1, hot"},
    {"check away.json", 0, "4 frames checked by brute force\n"},
    {"check away.json --json", 0, "\"longest_active\": [\n    0,\n    0\n"},
    {"check near.json", 0, "active 1-4: truth <= 0.1 L in 100.0 % of frames"},
    {"check near.json --json", 0, "\"active_holds\": true"},
    {"instructions s.json --frames 1-2 --inside --method certified", 0, ""},
    {"instructions s.json --frames 4 --inside --particles 2,3 --method particle-paper", 0, ""},
};

TEST(main_good_line_says_what_it_will_do)
{
    const int before = folder_count(".", "");
    for (size_t i = 0; i < ROWS_OF(good_lines); ++i) {
        const command_line *good = &good_lines[i];
        mote_expect(0, good->says, "%s", good->arguments);
        test_row("%s", good->arguments);
        assert_null(strstr(said, "mote: "));
        if (good->says[0] == '\0')
            assert_string_equal(said, "");
        assert_int_equal(folder_count(".", ""), before);
    }
}

TEST(command_list_names_what_there_is)
{
    assert_int_equal(mote("list methods"), 0);
    assert_non_null(strstr(said, "fcl-aabb"));
    assert_non_null(strstr(said, "particle-paper"));
    assert_int_equal(mote("list scenarios --json"), 0);
    assert_non_null(strstr(said, "\"ww\""));
    assert_int_equal(mote("--help"), 0);
    assert_non_null(strstr(said, "mote check SCENARIO"));
}

TEST(command_run_without_summary_leaves_it_to_summarize)
{
    assert_int_equal(
        mote("run s.json --method aabb-tree --replicates 1 --out later --no-summary"), 0);
    assert_null(strstr(said, ", caches hot"));
    assert_int_equal(folder_count("later/cells", ".json"), 1);
    assert_false(file_exists("later/summary.json"));
    assert_int_equal(mote("summarize later"), 0);
    assert_true(file_exists("later/summary.json"));
}

TEST(command_letter_writes_that_many_triangles)
{
    assert_int_equal(mote("letter V --triangles 500 -o V.obj"), 0);
    char *text = file_text("V.obj");
    assert_int_equal(test_count(text, "\nf "), 500);
    free(text);
}

/* A letter as a file has it: its vertices, and the signed volume under each face. */
typedef struct letter_file {
    double vertex[400][3], volume[600];
    int vertices, faces;
} letter_file;

static letter_file read_letter(const char *path)
{
    letter_file letter = {.vertices = 0};
    char *text = file_text(path);
    for (const char *line = text; line && *line; line = strchr(line, '\n')) {
        double *v = letter.vertex[letter.vertices];
        int f[3];
        line += *line == '\n';
        if (sscanf(line, "v %lf %lf %lf", &v[0], &v[1], &v[2]) == 3)
            ++letter.vertices;
        if (sscanf(line, "f %d %d %d", &f[0], &f[1], &f[2]) != 3)
            continue;
        const double *a = letter.vertex[f[0] - 1], *b = letter.vertex[f[1] - 1];
        const double *c = letter.vertex[f[2] - 1];
        letter.volume[letter.faces++] = a[0] * (b[1] * c[2] - b[2] * c[1]) +
                                        a[1] * (b[2] * c[0] - b[0] * c[2]) +
                                        a[2] * (b[0] * c[1] - b[1] * c[0]);
    }
    free(text);
    return letter;
}

static int compare_numbers(const void *a, const void *b)
{
    const double *x = a, *y = b;
    for (int c = 0; c < 3; ++c) {
        if (x[c] < y[c] || x[c] > y[c])
            return x[c] < y[c] ? -1 : 1;
    }
    return 0;
}

/* Other orders of the same vertices, and in each place the same face. */
TEST(command_letter_writes_vertices_in_any_order)
{
    static const char *const lines[] = {"letter V --triangles 500 -o V.obj",
                                        "letter V --triangles 500 --order leaf -o V.obj",
                                        "letter V --triangles 500 --order random -o V.obj"};
    static letter_file letter[3];
    for (int k = 0; k < 3; ++k) {
        assert_int_equal(mote("%s", lines[k]), 0);
        letter[k] = read_letter("V.obj");
        assert_int_equal(letter[k].faces, 500);
        assert_memory_equal(letter[k].volume, letter[0].volume, sizeof letter[0].volume);
        if (k > 0)
            assert_memory_not_equal(letter[k].vertex, letter[0].vertex, 100 * sizeof(double));
    }
    for (int k = 0; k < 3; ++k) {
        qsort(letter[k].vertex, (size_t)letter[k].vertices, sizeof letter[k].vertex[0],
              compare_numbers);
        assert_memory_equal(letter[k].vertex, letter[0].vertex, sizeof letter[0].vertex);
    }
    assert_int_equal(mote("letter V --triangles 500 --order down -o V.obj"), 2);
    assert_non_null(strstr(said, "give letter, leaf or random"));
}

TEST(command_export_answers_match_between_exact_methods)
{
    assert_int_equal(mote("export tt --frame 120 --out e --method brute-force "
                          "--method fcl-aabb:seed=previous,queue=64"),
                     0);
    char *text = file_text("e/answers.json");
    double distance[2] = {-1, -2};
    const char *at = text;
    for (int i = 0; i < 2; ++i) {
        at = strstr(at, "\"distance\": ");
        assert_non_null(at);
        at += strlen("\"distance\": ");
        distance[i] = strtod(at, NULL);
    }
    assert_true(distance[0] > 0);
    assert_true(distance[0] - distance[1] < 1e-12 && distance[1] - distance[0] < 1e-12);
    free(text);
    assert_int_equal(folder_count("e", ""), 3);
    assert_true(file_exists("e/A.obj") && file_exists("e/B.obj"));
}

TEST(command_list_full_disk_is_an_error)
{
    if (access("/dev/full", W_OK) != 0)
        skip();
    assert_int_equal(mote("list methods >/dev/full"), 4);
}
