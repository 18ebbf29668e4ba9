/* Figures and the report of a run that has the data for every figure, while each place where
   they ask for files or processes fails once; and more of what commands read and write. */
#include "tests/faults/fault_lines.h"

#include "harness/base/file.h"
#include "tests/support/test.h"

#include <stddef.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define CUBE                                                                                   \
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\nf 1 3 2\n"        \
    "f 1 4 3\nf 5 6 7\nf 5 7 8\nf 1 2 6\nf 1 6 5\nf 2 3 7\nf 2 7 6\nf 3 4 8\nf 3 8 7\n"        \
    "f 4 1 5\nf 4 5 8\n"

/* A scenario in the folder of the mesh, with further keys for itself and for body 0. */
#define SCENE(ask, more, body)                                                                 \
    "{\"purpose\": \"a test\", \"frames\": 12, \"ask\": \"" ask "\"" more                      \
    ", \"bodies\": [{\"file\": \"cube.obj\"" body "}, {\"file\": \"cube.obj\", \"motion\": ["  \
    "{\"frame\": 1, \"position\": [0.8, 0.1, 0]}, {\"frame\": 12, \"position\": "              \
    "[0.5, 0.1, 0]}]}]}\n"
#define FIELD                                                                                  \
    ", \"field\": {\"count\": 3, \"support\": 0.7, \"displacement\": {\"random\": {\"seed\": " \
    "5, \"amplitude\": 0.05, \"periods\": [40, 90]}}}"
#define CENTRES                                                                                \
    ", \"field\": {\"centres\": [[0, 0, 0], [0.2, 0.1, 0]], \"support\": 0.7, "                \
    "\"displacement\": {\"sines\": [{\"control\": 1, \"amplitude\": [0.1, 0, 0], \"period\": " \
    "30, \"phase\": 0.25}]}}"
#define CLAIMS                                                                                 \
    "[{\"id\": \"a\", \"section\": \"3\", \"claim\": \"two is enough, with a text so long "    \
    "that it takes more than one line\", \"measured\": \"m\", \"value\": 2, \"interval\": "    \
    "[1.5, 2.5], \"unit\": \"L\", \"verdict\": \"holds within limits\", \"curve\": "           \
    "\"figures/claim_a.dat\", \"values\": [{\"name\": \"n = 3\", \"value\": 2, \"interval\": " \
    "[1, 3], \"unit\": \"us\", \"threshold\": {\"bound\": \"at most\", \"holds\": 1, "         \
    "\"limits\": 3}}, {\"name\": \"n = 5\", \"value\": null, \"interval\": null, \"unit\": "   \
    "\"\", \"threshold\": null}]}, {\"id\": \"b\", \"claim\": \"never\", \"value\": null, "    \
    "\"interval\": null, \"verdict\": \"does not hold\", \"values\": []}]\n"
#define BODIES                                                                                 \
    "{\"schema\": 1, \"rows\": [{\"label\": \"certified\", \"status\": \"ok\", "               \
    "\"near_pairs_wanted\": 1, \"bodies\": 1000, \"active_total_ns\": {\"mean\": 5}, "         \
    "\"rss_peak_bytes\": 7}, {}, 7, {\"label\": \"certified\", \"status\": 5}, "               \
    "{\"label\": \"fcl-aabb:refit=every\", \"status\": \"ok\", \"near_pairs_wanted\": 1, "     \
    "\"bodies\": 1000, \"active_total_ns\": {\"mean\": 150}}, "                                \
    "{\"label\": \"certified\", \"status\": \"ok\", \"bodies\": 10, "                          \
    "\"near_pairs_wanted\": \"x\"}, {\"label\": \"aabb-tree\", \"status\": \"ok\"}, "          \
    "{\"label\": \"certified\", \"status\": \"ok\", \"bodies\": 1000, "                        \
    "\"active_total_ns\": null}]}\n"
#define LETTERS                                                                                \
    "{\"purpose\": \"several\", \"frames\": 6, \"ask\": \"distance\", \"bodies\": {"           \
    "\"count\": 4, \"seed\": 2, \"near_pairs\": 1, \"near\": 0.3, \"speed\": 0.01, "           \
    "\"spin\": 1, \"shapes\": [{\"file\": \"cube.obj\"}]}}\n"

#define INSTALLED "share/mote/datasets/scenarios/"
#define FILM "{\"purpose\": \"a film\", \"like\": \"letters\", \"frames\": 11}\n"

static const struct {
    const char *name, *text;
} files[] = {
    {"share/mote/page/replay.js", "play();\n"},
    {"share/mote/datasets/defects.md",
     "# Defects\n\n## One\n\nof `two`\nlines\n\n    code\n\n    more\n\n##### Five\n\nend"},
    {"cube.obj", CUBE},
    {INSTALLED "cube.obj", CUBE},
    {INSTALLED "tt.json", SCENE("contact", ", \"active\": [2, 12]", "")},
    {INSTALLED "mv.json", SCENE("distance", "", FIELD)},
    {INSTALLED "ww.json", SCENE("distance", "", FIELD)},
    {INSTALLED "ww-1k.json", SCENE("distance", "", FIELD)},
    {INSTALLED "ww-2k.json", SCENE("distance", "", CENTRES)},
    {INSTALLED "letters.json", LETTERS},
    {"other.json", "{\"purpose\": \"like another\", \"like\": \"mv\", \"frames\": 4}\n"},
    {"another.json", "{\"purpose\": \"like another\", \"like\": \"ww\", \"frames\": 3}\n"},
    {"paced.json", "{\"purpose\": \"quick\", \"like\": \"mv\", \"frames\": 4, \"pace\": 2}\n"},
    {"late.json", "{\"purpose\": \"late\", \"like\": \"mv\", \"frames\": 4, \"start\": 3}\n"},
    {"like.json", "{\"purpose\": \"like another\", \"like\": \"mv\", \"frames\": 4}\n"},
    {"a.off", "OFF\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n"
              "3 1 2 3\n"},
    {"a.stl", "solid t\nfacet normal 0 0 -1\nouter loop\nvertex 0 0 0\nvertex 0 1 0\n"
              "vertex 1 0 0\nendloop\nendfacet\nendsolid t\n"}};

static bool exists(const char *path)
{
    struct stat info;
    return stat(path, &info) == 0 && info.st_size > 0;
}

/* Several bodies: a diagram and a film. The film's pictures are removed once it is drawn. */
TEST(figures_of_several_bodies_when_a_call_fails_say_so)
{
    static const fault_line list[] = {LINE(figures, " several", 0)};
    assert_true(fault_lines_run(list, 1));
    assert_true(exists("several/figures/bodies.svg"));
    assert_true(exists("several/figures/letters.gif"));
    assert_false(exists("several/figures/frames/000.dat"));
    FAIL_EACH(list);
}

TEST(figures_when_a_call_fails_say_so)
{
    static const fault_line list[] = {LINE(figures, " run", 0), LINE(figures, " parts", 0)};
    assert_true(fault_lines_run(list, 2));
    static const char *const names[] = {"fig1",       "fig2",      "size-time",
                                        "size-bytes", "shares-ww", "ratios-ww"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; ++i) {
        char path[64];
        (void)snprintf(path, sizeof path, "run/figures/%s.svg", names[i]);
        if (!exists(path))
            fail_msg("%s: not there, or empty", path);
    }
    assert_true(exists("parts/figures/ingredients.svg"));
    assert_true(exists("parts/figures/tracked-ww.svg"));
    FAIL_EACH(list);
}

TEST(report_when_a_call_fails_says_so)
{
    static const fault_line list[] = {LINE(report, " run", 0), LINE(report, " claims", 0)};
    FAIL_EACH(list);
}

/* A pair has no scenario file: the command that measured it names the meshes. */
TEST(report_of_a_pair_replays_it)
{
    static const fault_line lines[] = {
        LINE(letter, " V --triangles 400 -o v.obj", 0),
        LINE(run,
             " --pair v.obj v.obj --frames 1-3 --method certified --replicates 1 --stride 1 "
             "--out pair",
             0),
        LINE(report, " pair", 0),
    };
    char *text = NULL;
    size_t size = 0;
    assert_true(fault_lines_run(lines, sizeof lines / sizeof lines[0]));
    assert_int_equal(mote_file_read("pair/report.html", 1 << 24, &text, &size), MOTE_OK);
    assert_non_null(strstr(text, "{\"name\":\"v-v\""));
    assert_non_null(strstr(text, "],\"notes\":[]}</script>"));
    free(text);
}

TEST(comparisons_when_a_call_fails_say_so)
{
    static const fault_line list[] = {LINE(compare, " run claims", 4), LINE(tune, " run", 0),
                                      LINE(tune, " run --best-fcl ww", 0),
                                      LINE(summarize, " run", 0)};
    FAIL_EACH(list);
}

TEST(scenarios_of_other_forms_when_a_call_fails_say_so)
{
    static const fault_line list[] = {
        LINE(check, " ww-2k --json", 0),
        LINE(check, " " INSTALLED "tt.json --out out", 1),
        LINE(list, " scenarios --json", 0),
        LINE(mesh, " a.off", 0),
        LINE(mesh, " a.stl", 0),
        LINE(distance, " a.obj a.off --method certified --method fcl-aabb", 0),
        LINE(approach, " mv --gaps 1:0.1,9:0.05 --every 4 --direction 1,0,0 -o out.json", 0),
    };
    FAIL_EACH(list);
}

TEST(loops_when_a_call_fails_say_so)
{
    static const fault_line list[] = {
        LINE(simulate, " mv --method certified --steps 4 --film out.gif", 0),
        LINE(simulate, " mv --method certified --steps 4 --trace trace.json", 0),
        LINE(simulate, " " INSTALLED "mv.json --method certified --steps 3 --trace t.json", 0),
        LINE(simulate, " tt --method certified --steps 20 --trace trace.json", 0),
        LINE(simulate, " " INSTALLED "mv.json --method certified --steps 20 --trace trace.json",
             4),
        LINE(simulate, " paced.json --method certified --steps 2 --trace trace.json", 4),
        LINE(simulate, " late.json --method certified --steps 2 --trace trace.json", 4),
        LINE(simulate, " b.json --method certified --steps 3", 0),
        LINE(run, " mv --method certified --until-ci 100% --budget 0 --replicates 1 --out out",
             0),
        LINE(run, " b.json --method particle:n=4 --dry-run", 0),
    };
    FAIL_EACH(list);
}

static bool make_runs(void)
{
    static const fault_line runs[] = {
        LINE(run,
             " tt mv ww ww-1k ww-2k --method particle-paper:n=3|5 --method certified --method "
             "fcl-aabb --replicates 1 --stride 1 --out run",
             0),
        LINE(run, " tt --method certified --cache evict --replicates 1 --stride 1 --out run",
             0),
        LINE(run,
             " mv --method particle:n=3,positions=given --replicates 1 --stride 1 --out run",
             0),
        LINE(run,
             " another.json other.json --method certified --replicates 1 --stride 1 --out run",
             0),
        LINE(run,
             " ww --method particle:n=0|2|8 --method particle:n=8,track=0|4 --method "
             "particle:n=8,leap=off --method particle:n=8,launch=1|8 --method "
             "particle:n=8,reseed=off --method fcl-aabb --replicates 2 --stride 1 --out parts",
             0)};
    return fault_lines_run(runs, sizeof runs / sizeof runs[0]);
}

/* The film as `make bodies` leaves it. */
static bool make_film(void)
{
    static const fault_line run[] = {LINE(run,
                                          " several/film/letters.json --method certified "
                                          "--pairs contacts --replicates 1 --out several/film",
                                          0)};
    return mote_directory_make("several/film") == MOTE_OK &&
           fault_lines_write("several/film/letters.json", FILM) && fault_lines_run(run, 1);
}

static int make_files(void)
{
    if (!fault_lines_open() || !fault_lines_install())
        return -1;
    for (size_t i = 0; i < sizeof files / sizeof files[0]; ++i) {
        if (!fault_lines_write(files[i].name, files[i].text))
            return -1;
    }
    return make_runs() && make_film() && fault_lines_write("run/claims.json", CLAIMS) &&
                   fault_lines_write("run/requirements.json", CLAIMS) &&
                   fault_lines_write("several/summary.json", BODIES) &&
                   mote_directory_make("claims") == MOTE_OK &&
                   fault_lines_write("claims/claims.json", CLAIMS)
               ? 0
               : -1;
}

TEST_GROUP(make_files, fault_lines_close);
