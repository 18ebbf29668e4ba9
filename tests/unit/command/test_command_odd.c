/* Commands given what is seldom given: values at the ends of their ranges, names that are not
   UTF-8, output that cannot be replaced, frames that cannot be read. */
#include "harness/base/file.h"
#include "tests/support/command_lines.h"
#include "tests/support/diamond.h"
#include "tests/support/sheet.h"
#include "tests/support/test.h"

#include <sys/stat.h>
#include <unistd.h>

#define SCENE(more, first)                                                                     \
    "{\"purpose\": \"x\", \"frames\": 4, \"ask\": \"distance\"" more ", \"bodies\": [{" first  \
    "}, {\"file\": \"d.obj\", \"motion\": [{\"frame\": 1, "                                    \
    "\"position\": [2.1, 0.1, 0]}, {\"frame\": 4, \"position\": [1.9, 0.1, 0]}]}]}\n"
#define FIRST "\"file\": \"d.obj\""
#define SEVERAL                                                                                \
    "{\"purpose\": \"x\", \"frames\": 4, \"ask\": \"contact\", \"bodies\": {\"count\": 3, "    \
    "\"seed\": 2, \"near_pairs\": 1, \"near\": 0.2, \"speed\": 0.01, \"spin\": 1, "            \
    "\"shapes\": [{\"file\": \"d.obj\"}]}}\n"

/* Four edges of three faces each. */
static void put_books(void)
{
    mote_text text = {0};
    for (int k = 0; k < 4; ++k)
        mote_text_add(&text,
                      "v %d 0 0\nv %d 0 1\nv %d 1 0\nv %d -1 0\nv %d 1 1\nf -5 -4 -3\n"
                      "f -4 -5 -2\nf -5 -4 -1\n",
                      3 * k, 3 * k, 3 * k, 3 * k, 3 * k + 1);
    file_put("books.obj", text.data);
    free(text.data);
}

static int put_files(void)
{
    static const struct {
        const char *name, *text;
    } files[] = {{"d.obj", DIAMOND},
                 {"s.json", SCENE("", FIRST)},
                 {"\xff.json", SCENE("", FIRST)},
                 {"\xff.obj", DIAMOND},
                 {"b.json", SEVERAL},
                 {"\xfe.json", SEVERAL},
                 {"bad.json", SCENE("", "\"positions\": \"f1.obj\"")},
                 {"twice.json",
                  "{\"purpose\": \"x\", \"frames\": 4, \"ask\": \"distance\", \"bodies\": "
                  "[{\"file\": \"d.obj\"}, {\"file\": \"d.obj\"}]}\n"},
                 {"broken.csv", "frame,body\n"}};
    for (size_t i = 0; i < ROWS_OF(files); ++i)
        file_put(files[i].name, files[i].text);
    for (int k = 1; k <= 4; ++k) {
        char name[16];
        (void)snprintf(name, sizeof name, "f%d.obj", k);
        sheet_write_obj(name, k);
    }
    file_put("f3.obj", "v 0 0 nan\n");
    put_books();
    const bool made = mkdir("taken", 0700) == 0 && mkdir("taken/cloth.pc2", 0700) == 0 &&
                      symlink("round", "round") == 0;
    return made ? 0 : -1;
}

TEST_GROUP(put_files, NULL);

static const command_line bad_lines[] = {
    {"sequence", 2, "something is missing; write `mote sequence cloth"},
    {"sequence cloth --triangles 800", 2, "something is missing"},
    {"sequence cloth --out x", 2, "something is missing"},
    {"sequence --triangles 800 --out x", 2, "something is missing"},
    {"sequence cloth cloth", 2, "cloth: one sequence at a time"},
    {"sequence silk", 2, "silk: not one of cloth"},
    {"sequence cloth --triangles many", 2,
     "--triangles many: give a whole number from 800 to 20000000"},
    {"sequence cloth --frames 0", 2, "--frames 0: give a whole number from 1 to 100000"},
    {"sequence cloth --frames 100001", 2, "--frames 100001: give a whole number from 1"},
    {"sequence cloth --speed 3", 2, "unknown option --speed"},
    {"sequence cloth --triangles 5 --out x", 2, "--triangles 5: give a whole number from 800"},
    {"sequence cloth --triangles 800 --out d.obj", 4, "d.obj"},
    {"letter W --triangles 0 -o W.obj", 2, "--triangles 0: give an even number"},
    {"letter W --triangles 400 -o round", 4, "round: cannot be written: Too many levels"},
    {"simulate s.json --method certified --jobs 0", 2, "give a whole number from 1 to 256"},
    {"simulate s.json --method certified --jobs 2", 2, "name a directory with --out"},
    {"simulate s.json --method certified --out k --film x.gif", 2, "leave out --out"},
    {"simulate s.json --method certified --out k --seed 9223372036854775807", 2,
     "with --out a whole number below 2^62"},
    {"simulate s.json nothing.json --method certified --out k --steps 2", 4, "nothing.json"},
    {"mesh $(printf '\\377.obj') --json", 4, "not UTF-8, which JSON needs; rename it"},
    {"check $(printf '\\377.json') --json", 4, "a name to be printed is not UTF-8"},
    {"check $(printf '\\376.json') --json", 4, "a name to be printed is not UTF-8"},
    {"check pair:$(printf '\\377.obj'):d.obj", 4, "names that are not UTF-8; rename them"},
    {"check bad.json", 4, "frame 3: f3.obj:1: a coordinate is not a finite double"},
    {"export bad.json --frame 3 --out e", 4, "frame 3: f3.obj:1: a coordinate"},
    {"run s.json --step 1,2,x --method certified --out k", 2, "--step 1,2,x"},
    {"race a b $(yes s.json | head -257) --method certified", 2,
     "s.json: more than 256 scenarios"},
    {"race /bin/true /bin/true s.json --method certified --until ''", 2, "--until : expected"},
    {"race /bin/true /bin/true s.json --method certified --until "
     "0.000000000000000000000000000000000001",
     2, "expected a share above 0, at most 100%, such as 1%"},
    {"race /bin/true /bin/true s.json --method certified --until 0.5 --real 2", 2, "--real 2"},
    {"dynamics --step 0 --out k", 2, "--step 0: give 1, 3, 10 or 30"},
    {"dynamics --step 2 --out k", 2, "--step 2: give 1, 3, 10 or 30"},
    {"dynamics --scene nope --out k", 4, "scene 'nope' is not in the study; choose tt, mv"},
    {"dynamics --scene vv --quick --out k", 4, "'vv' is not in the study; choose tt, mv or ww"},
    {"simulate s.json --method certified --gravity 1e200,0,0", 2,
     "--gravity 1e200,0,0: give x,y,z, in L per frame squared, at most 1e154 long"},
    {"dynamics --jobs 65 --out k", 2, "--jobs 65: give a whole number from 1 to 64"},
    {"dynamics --approaches x --out k", 2, "give a whole number from 1 to 1000000"},
    {"approach twice.json --gaps 1:0.1,4:-0.1 -o no/x.json", 4, "no/: No such file"},
    {"--pluginx check s.json", 2, "unknown command --pluginx"},
    {"mesh a.obj --plugins", 2, "unknown option --plugins"},
};

TEST(commands_with_odd_values_say_so_in_one_line_and_leave_nothing)
{
    command_refuses(bad_lines, ROWS_OF(bad_lines));
}

/* Numbers that do not fit their type, or that nothing could take, are errors of the command
   line: exit 2 with the option, whatever the files are. */
TEST(commands_refuse_numbers_that_do_not_fit_by_their_option)
{
    static const struct {
        const char *line;
        const char *options[12];
    } rows[] = {
        {"letter W -o W.obj", {"triangles"}},
        {"sequence cloth --out x", {"triangles", "frames"}},
        {"export s.json --out x", {"frame"}},
        {"approach s.json -o x.json", {"gaps", "every"}},
        {"run s.json --dry-run --method fcl-aabb --out x",
         {"particles", "replicates", "frames", "seed", "timeout", "stride", "step", "jobs",
          "until-ci", "budget", "progress", "shard"}},
        {"simulate s.json --method certified --out x",
         {"steps", "seed", "density", "restitution", "tolerance", "time-step", "step",
          "replicates", "jobs", "until-ci", "budget", "shard"}},
        {"dynamics --out x", {"jobs", "approaches", "step"}},
        {"compare x y", {"floor"}},
        {"race /bin/true /bin/true s.json --method fcl-aabb",
         {"particles", "frames", "until", "budget", "real", "timeout", "seed"}},
        {"instructions s.json --inside --method certified --frames 1-2",
         {"particles", "frames"}},
    };
    static const char *const values[] = {
        "99999999999999999999", "-1", "1e400", "nan", "''", "x"};
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        for (size_t k = 0; k < 12 && rows[i].options[k]; ++k) {
            for (size_t v = 0; v < ROWS_OF(values); ++v) {
                /* a density of 1e20 is one */
                if (v == 0 && strcmp(rows[i].options[k], "density") == 0)
                    continue;
                char *says = mote_format("--%s ", rows[i].options[k]);
                mote_expect(2, says, "%s --%s %s", rows[i].line, rows[i].options[k], values[v]);
                free(says);
            }
        }
    }
    mote_expect(0, "plan: ",
                "run s.json --dry-run --method fcl-aabb --out x --frames 2 --seed 0 "
                "--timeout 1e9 --stride 4294967295 --particles 4294967295");
    mote_expect(4, "outside s", "run s.json --method fcl-aabb --out x --frames 9999");
}

/* The mesh is written before the cache, which then cannot get its name; no part of it is left.
 */
TEST(command_sequence_that_cannot_name_its_cache_leaves_no_part)
{
    mote_expect(4, "taken/cloth.pc2: cannot be named so: Is a directory",
                "sequence cloth --triangles 800 --frames 2 --out taken");
    assert_int_equal(folder_count("taken", ".part"), 0);
    assert_int_equal(folder_count("taken", ".partial"), 0);
    assert_false(file_exists("taken/cloth.json"));
}

TEST(command_sequence_makes_a_scenario_that_is_read)
{
    mote_expect(0, "2 frames; its mesh and its positions are beside it",
                "sequence cloth --triangles 800 --frames 2 --out cloth");
    mote_expect(0, "2 frames", "check cloth/cloth.json");
}

TEST(command_mesh_tells_the_first_of_many_cut_edges)
{
    mote_expect(0, "non-manifold edges  4, cut apart with ", "mesh books.obj");
    const char *line = strstr(said, "non-manifold edges");
    const char *end = strchr(line, '\n');
    assert_true(strncmp(end - 5, "; ...", 5) == 0);
    mote_expect(4,
                "4 edges of more than two faces (non-manifold): ", "mesh --strict books.obj");
    assert_non_null(strstr(said, "; ...; give each edge"));
    mote_expect(0, "note: 4 edges of more than two faces cut apart",
                "distance books.obj d.obj --method aabb-tree");
    assert_non_null(strstr(said, "; ...\n"));
}

TEST(command_list_prints_scenarios_as_text_and_as_json)
{
    mote_expect(0, "ww           ", "list scenarios");
    assert_null(strstr(said, "\"name\""));
    mote_expect(0, "\"name\": \"ww\"", "list scenarios --json");
    mote_expect(0, "\"parameters\"", "list fields --json");
}

#define RACE "race " MOTE_PROGRAM " " MOTE_PROGRAM
#define QUICKLY " --method certified --until 0.9 --real 90%% --budget 0.2"

/* A race whose answer is JSON, with everything given that may be given. */
TEST(command_race_of_all_options_prints_json)
{
    static const char *const wanted[] = {"\"a\": \"old\"", "\"b\": \"new\"", "\"evict\"",
                                         "\"s.json\""};
    (void)mote(RACE " s.json@1-2 s.json --frames 1-4 --cache evict --timeout 60 --seed 3 "
                    "--labels old,new --instructions --format json --out race.json" QUICKLY
                    " 2>/dev/null");
    char *text = file_text("race.json");
    for (size_t i = 0; i < ROWS_OF(wanted); ++i)
        assert_true(strstr(text, wanted[i]) && strstr(said, wanted[i]));
    free(text);
    (void)mote(RACE " s.json --format table --cache hot --allow-changes" QUICKLY);
    assert_non_null(strstr(said, "s.json/certified/hot"));
}

TEST(command_race_that_cannot_be_told_says_why)
{
    mote_expect(4, "s.json@x", RACE " s.json@x" QUICKLY);
    mote_expect(4, "more than 256 cells; race fewer",
                RACE " $(yes s.json | head -200) --method aabb-tree" QUICKLY);
    mote_expect(4, "a name that is not UTF-8 cannot be written",
                RACE " s.json --labels $(printf '\\377'),b --out odd.json" QUICKLY);
    assert_false(file_exists("odd.json"));
    mote_expect(4, "is not UTF-8; rename what has it",
                RACE " s.json --labels $(printf '\\377'),b --format json" QUICKLY);
}
