/* Figures and the report of a run that has what every figure needs, with each place where they
   ask for memory, files or processes failing once; and more of what commands read and write. */
#include "tests/fault_lines.h"

#include "harness/file.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* A scenario in the folder of the mesh; %s: more keys of body 0 and of the scenario. */
#define SCENE(more, body)                                                                      \
    "{\"purpose\": \"a test\", \"frames\": 12, \"ask\": \"distance\"" more                     \
    ", \"bodies\": [{\"file\": \"a.obj\"" body "}, {\"file\": \"a.obj\", \"motion\": ["        \
    "{\"frame\": 1, \"position\": [2.1, 0.1, 0]}, {\"frame\": 12, \"position\": "              \
    "[1.8, 0.1, 0]}]}]}\n"
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
    "{\"schema\": 1, \"rows\": [{\"method\": \"certified\", \"status\": \"ok\", "              \
    "\"near_pairs_wanted\": 1, \"bodies\": 1000, \"ratio\": 30, \"step_mean_ns\": 5, "         \
    "\"rss_peak_bytes\": 7}]}\n"
#define RUN                                                                                    \
    " --method particle-paper:n=3|5 --method certified --method fcl-aabb --replicates 1 "      \
    "--stride 1 --out run"

static const struct {
    const char *name, *text;
} files[] = {
    {"tt.json", SCENE(", \"active\": [2, 12]", "")},
    {"mv.json", SCENE("", FIELD)},
    {"ww.json", SCENE("", FIELD)},
    {"ww-1k.json", SCENE("", FIELD)},
    {"ww-2k.json", SCENE("", CENTRES)},
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

/* Several bodies: a diagram and a film, whose pictures are gone when it is drawn. */
static void figures_of_several_bodies_alone_are_drawn(void **state)
{
    (void)state;
    static const fault_line list[] = {LINE(figures, " bodies", 0)};
    assert_true(fault_lines_run(list, 1));
    assert_true(exists("bodies/figures/bodies.svg"));
    assert_true(exists("bodies/figures/letters.gif"));
    assert_false(exists("bodies/figures/frames/000.dat"));
}

static void figures_when_a_call_fails_say_so(void **state)
{
    (void)state;
    static const fault_line list[] = {LINE(figures, " run", 0)};
    FAIL_EACH(list);
}

static void report_when_a_call_fails_says_so(void **state)
{
    (void)state;
    static const fault_line list[] = {LINE(report, " run", 0), LINE(report, " claims", 0)};
    FAIL_EACH(list);
}

static void comparisons_when_a_call_fails_say_so(void **state)
{
    (void)state;
    static const fault_line list[] = {LINE(compare, " run claims", 4), LINE(tune, " run", 0),
                                      LINE(tune, " run --best-fcl ww", 0),
                                      LINE(summarize, " run", 0)};
    FAIL_EACH(list);
}

static void scenarios_of_other_forms_when_a_call_fails_say_so(void **state)
{
    (void)state;
    static const fault_line list[] = {
        LINE(check, " ww-2k.json --json", 0),
        LINE(check, " tt.json --out out", 1),
        LINE(list, " fields --json", 0),
        LINE(list, " scenarios --json", 0),
        LINE(mesh, " a.off", 0),
        LINE(mesh, " a.stl", 0),
        LINE(distance, " a.obj a.off --method certified --method fcl-aabb", 0),
        LINE(approach, " mv.json --gaps 1:0.1,9:0.05 --every 4 --direction 1,0,0 -o out.json",
             0),
    };
    FAIL_EACH(list);
}

static void loops_when_a_call_fails_say_so(void **state)
{
    (void)state;
    static const fault_line list[] = {
        LINE(simulate, " mv.json --method certified --steps 4 --film out.gif", 0),
        LINE(simulate, " b.json --method certified --steps 3", 0),
        LINE(run,
             " mv.json --method certified --until-ci 100% --budget 0 --replicates 1 --out out",
             0),
        LINE(run, " b.json --dry-run", 0),
    };
    FAIL_EACH(list);
}

static int make_files(void **state)
{
    (void)state;
    static const fault_line runs[] = {
        LINE(run, " tt.json ww.json ww-1k.json ww-2k.json" RUN, 0)};
    if (!fault_lines_open())
        return -1;
    for (size_t i = 0; i < sizeof files / sizeof files[0]; ++i) {
        if (!fault_lines_write(files[i].name, files[i].text))
            return -1;
    }
    return fault_lines_run(runs, 1) && fault_lines_write("run/claims.json", CLAIMS) &&
                   fault_lines_write("run/requirements.json", CLAIMS) &&
                   mote_directory_make("bodies") == MOTE_OK &&
                   fault_lines_write("bodies/bodies.json", BODIES) &&
                   mote_directory_make("claims") == MOTE_OK &&
                   fault_lines_write("claims/claims.json", CLAIMS)
               ? 0
               : -1;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(report_when_a_call_fails_says_so),
        cmocka_unit_test(comparisons_when_a_call_fails_say_so),
        cmocka_unit_test(scenarios_of_other_forms_when_a_call_fails_say_so),
        cmocka_unit_test(loops_when_a_call_fails_say_so),
        cmocka_unit_test(figures_of_several_bodies_alone_are_drawn),
        cmocka_unit_test(figures_when_a_call_fails_say_so),
    };
    return cmocka_run_group_tests(tests, make_files, fault_lines_close);
}
