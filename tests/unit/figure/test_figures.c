/* mote figures: the output for a small stored run, missing data, and names that look like
   commands. */
#include "harness/figure/figure.h"
#include "harness/figure/figure_scene.h"
#include "harness/base/hash.h"
#include "harness/base/record.h"
#include "tests/support/folder.h"
#include "tests/support/mote.h"
#include "tests/support/program.h"
#include "tests/support/stored_cells.h"
#include "tests/support/test.h"

#include <stddef.h>

#include <dirent.h>
#include <math.h>
#include <sys/stat.h>

static char text[1 << 18];

/* A scenario name that would be a command to gnuplot and to a shell if it were ever run. */
#define HOSTILE "'; system(\"touch HACKED\") `touch HACKED` $(touch HACKED)"

static bool exists(const char *name)
{
    struct stat info;
    return stat(name, &info) == 0 && info.st_size > 0;
}

/* Makes one small run: two scenarios, several n, two replicates. */
static int make_run(void)
{
    return mote("run tt --frames 1-60 --replicates 2 --particles 1,3 --method "
                "'particle-paper:refine=no|near' --method fcl-aabb --out run") ||
           mote("figures run");
}

TEST_GROUP(make_run, NULL);

static json_t *read_list(const char *directory, const char *key)
{
    json_t *object = NULL;
    assert_int_equal(mote_record_read_json(directory, "figures/figures.json", &object),
                     MOTE_OK);
    json_t *list = json_incref(json_object_get(object, key));
    json_decref(object);
    return list;
}

TEST(figures_of_a_run_are_there_in_every_format)
{
    static const char *const names[] = {"fig1",      "front-tt",  "errors-tt",
                                        "shares-tt", "ratios-tt", "error-time-tt"};
    static const char *const formats[] = {"svg", "png", "pdf"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; ++i) {
        for (size_t f = 0; f < 3; ++f) {
            char name[128];
            (void)snprintf(name, sizeof name, "run/figures/%s.%s", names[i], formats[f]);
            if (!exists(name))
                fail_msg("%s: not there, or empty", name);
        }
    }
    json_t *list = read_list("run", "figures");
    assert_int_equal(json_array_size(list), sizeof names / sizeof names[0]);
    json_decref(list);
}

TEST(figures_that_cannot_be_drawn_are_named)
{
    mote_expect(0, "", "figures run");
    assert_non_null(strstr(
        said, "run: figures that other commands measure: 2 (`make bench`), 3 (`make bench "
              "PROFILE=quick`), 6, 7 (`make sweep`), 10 (`make extremes OUT="));
    assert_non_null(strstr(said, "run`), 13, 14 (`make ingredients`), 15 (`make bodies`)\n"));
    assert_null(strstr(said, "figure ")); /* one line for all of them */
    json_t *missing = read_list("run", "missing");
    assert_int_equal(json_array_size(missing), 11); /* of figures 2 and 15, both */
    json_decref(missing);
}

/* Data of make ingredients on a few frames: a line an ingredient with its shares and its time
   relative to the whole, and the front over n, launch and track. */
TEST(figures_of_ingredients_have_the_rows_of_each)
{
    mote_expect(0, "",
                "run jump --frames 1-12 --replicates 1 --method particle:n=0 --method "
                "'particle:n=8,track=0|8,refine=1|4' --method particle:n=8,leap=off --method "
                "'particle:n=8,launch=1|8' --method 'particle:n=8,reseed=off,forces=off|on' "
                "--out parts");
    mote_expect(0, "", "figures parts");
    assert_true(exists("parts/figures/ingredients.svg"));
    assert_true(exists("parts/figures/tracked-jump.png"));
    program_read("parts/figures/ingredients.dat", text, sizeof text);
    const char *block = strstr(text, "\"jump\"\n0 0 ");
    assert_non_null(block); /* the whole algorithm is exact there */
    assert_non_null(strstr(block, " 1 1 1 \n1 "));
    int lines = 0;
    for (const char *p = strchr(block, '\n') + 1; *p; p = strchr(p, '\n') + 1) {
        double v[6];
        assert_int_equal(
            sscanf(p, "%lf %lf %lf %lf %lf %lf", &v[0], &v[1], &v[2], &v[3], &v[4], &v[5]), 6);
        assert_true(v[1] >= 0 && v[1] <= 100 && v[3] > 0);
        ++lines;
    }
    assert_int_equal(lines, 8);
    program_read("parts/figures/tracked-jump.dat", text, sizeof text);
    assert_non_null(strstr(text, "\"launch\"\n"));
    assert_null(strstr(text, "\"n\"\n\n")); /* no empty series of points */
}

/* The footer names the run of the manifest and the hash of the file that is drawn. */
TEST(footers_name_run_and_data)
{
    char expected[128];
    json_t *manifest = NULL;
    assert_int_equal(mote_record_read_json("run", "manifest.json", &manifest), MOTE_OK);
    const char *program = json_string_value(json_object_get(manifest, "program"));
    program_read("run/figures/shares-tt.dat", text, sizeof text);
    (void)snprintf(expected, sizeof expected, "data %016llx",
                   (unsigned long long)mote_hash_text(text));
    program_read("run/figures/shares-tt.svg", text, sizeof text);
    assert_non_null(strstr(text, expected));
    (void)snprintf(expected, sizeof expected, "-%.8s, commit", program);
    assert_non_null(strstr(text, expected));
    json_decref(manifest);
}

/* The published FNV-1a of "" and "foobar". */
TEST(hash_is_fnv_1a)
{
    assert_true(mote_hash_text("") == 0xcbf29ce484222325u);
    assert_true(mote_hash_text("foobar") == 0x85944171f73967e8u);
}

TEST(drawing_again_gives_the_same_bytes)
{
    static char again[1 << 20], before[1 << 20];
    static const char *const names[] = {"fig1.svg", "front-tt.svg", "errors-tt.svg",
                                        "figures.json"};
    char path[256];
    for (size_t i = 0; i < sizeof names / sizeof names[0]; ++i) {
        (void)snprintf(path, sizeof path, "run/figures/%s", names[i]);
        program_read(path, before, sizeof before);
        if (i == 0)
            mote_expect(0, "", "figures run");
        program_read(path, again, sizeof again);
        assert_true(strlen(again) > 100);
        assert_string_equal(before, again);
    }
}

/* Replaces text that begins with `from` by `to` in a file of the copy. */
static void rewrite(const char *path, const char *from, const char *to)
{
    program_read(path, text, sizeof text);
    char *at = strstr(text, from);
    FILE *out = fopen(path, "w");
    assert_non_null(out);
    if (at)
        (void)fprintf(out, "%.*s%s%s", (int)(at - text), text, to, at + strlen(from));
    else
        (void)fputs(text, out);
    (void)fclose(out);
}

/* Copies the run; calls change with each cell's JSON file. */
static void copy_run(const char *to, void (*change)(const char *path))
{
    char command[600], folder[256];
    (void)snprintf(command, sizeof command, "cp -r run %s && rm -r %s/figures", to, to);
    assert_int_equal(system(command), 0);
    (void)snprintf(folder, sizeof folder, "%s/cells", to);
    DIR *cells = opendir(folder);
    assert_non_null(cells);
    for (const struct dirent *entry = readdir(cells); entry; entry = readdir(cells)) {
        char path[600];
        (void)snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
        if (strstr(entry->d_name, ".json"))
            change(path);
    }
    (void)closedir(cells);
}

static void rename_scenario(const char *path)
{
    rewrite(path, "\"scenario\": \"tt\"",
            "\"scenario\": \"'; system(\\\"touch HACKED\\\") `touch HACKED` $(touch HACKED)\"");
}

TEST(scenario_that_is_a_command_is_drawn_and_never_run)
{
    copy_run("hostile", rename_scenario);
    mote_expect(0, "", "figures hostile");
    assert_false(exists("hostile/figures/HACKED"));
    assert_int_equal(access("HACKED", F_OK), -1);
    json_t *list = read_list("hostile", "figures");
    assert_int_equal(json_array_size(list), 5);
    for (size_t i = 0; i < json_array_size(list); ++i) {
        const json_t *entry = json_array_get(list, i);
        const char *name = json_string_value(json_object_get(entry, "name"));
        char path[512];
        assert_int_equal(strspn(name, "abcdefghijklmnopqrstuvwxyzACDEHKT0123456789-_"),
                         strlen(name));
        assert_string_equal(json_string_value(json_object_get(entry, "scenario")), HOSTILE);
        (void)snprintf(path, sizeof path, "hostile/figures/%s.svg", name);
        program_read(path, text, sizeof text);
        if (!strstr(text, HOSTILE))
            fail_msg("%s does not show the scenario's name", path);
    }
    json_decref(list);
}

static int damaged;

static void damage_some(const char *path)
{
    if (damaged++ % 4 == 0)
        rewrite(path, "\"scenario\"", "\"scen");
}

TEST(damaged_cells_are_named_and_the_rest_is_drawn)
{
    copy_run("damaged", damage_some);
    mote_expect(0, "left out", "figures damaged");
    assert_true(exists("damaged/figures/shares-tt.svg"));
}

static void take_frames_away(const char *path)
{
    rewrite(path, "\"frames\": [\n  1,\n  60\n",
            "\"frames\": [\n  -9223372036854775807,\n  9223372036854775807\n");
}

/* A figure shows the frames named by most cells. */
TEST(cells_that_name_no_frames_are_drawn)
{
    copy_run("frames", take_frames_away);
    mote_expect(0, "", "figures frames");
    assert_true(exists("frames/figures/shares-tt.svg"));
}

#define FRAMES 400

/* Writes replicate r of a method into a folder: a row for every step-th frame, `ns` each. */
static void write_replicate(const char *name, const char *method, int r, int step, int ns)
{
    mote_text rows = {0};
    for (int k = 1; k <= FRAMES; k += step)
        mote_text_add(&rows, "%d,0,0,%d,0.5,0,0,0,7\n", k, ns);
    const stored_cell cell = {.method = method, .replicate = r, .rows = rows.data};
    stored_cell_put(name, cell);
    free(rows.data);
}

/* Processes are paired by their numbers, and one may have more frames than the first. */
TEST(ratios_of_processes_that_are_missing_or_cut_are_of_pairs)
{
    mote_summary summary;
    mote_figure figure = {0};
    write_replicate("pairs", "certified", 1, FRAMES - 1, 1000);
    write_replicate("pairs", "certified", 2, 1, 1000);
    write_replicate("pairs", "certified", 80, 1, 1000);
    write_replicate("pairs", "fcl-aabb", 2, 1, 4000);
    write_replicate("pairs", "fcl-aabb", 80, 1, 4000);
    write_replicate("pairs", "fcl-aabb", 81, 1, 9000);
    assert_int_equal(mote_summary_make("pairs", &summary), MOTE_OK);
    const mote_figure_run run = {"pairs", &summary, NULL};
    assert_int_equal(mote_figure_ratios(&run, "s", &figure), MOTE_OK);
    size_t lines = 0;
    for (const char *at = figure.data.data; (at = strchr(at, '\n')) && at[1]; ++lines) {
        double middle, ratio[3];
        assert_int_equal(
            sscanf(++at, "%lf %lf %lf %lf", &middle, &ratio[0], &ratio[1], &ratio[2]), 4);
        for (int i = 0; i < 3; ++i)
            assert_true(fabs(ratio[i] - 4) < 1e-9);
    }
    assert_int_equal(lines, 48);
    free(figure.data.data);
    free(figure.caption.data);
    free(figure.missing.data);
    mote_summary_free(&summary);
}

/* The axis follows the rows. */
TEST(errors_over_many_particles_are_within_the_axis)
{
    for (int n = 32; n <= 128; n *= 4) {
        char id[16], parameters[16];
        (void)snprintf(id, sizeof id, "p-%d", n);
        (void)snprintf(parameters, sizeof parameters, "{\"n\": %d}", n);
        stored_cell_put("many-n", (stored_cell){.id = id,
                                                .method = "particle",
                                                .parameters = parameters,
                                                .rows = "1,0,0,100,0.5,0,0,0,7\n"});
    }
    mote_expect(0, "many-n/figures/errors-s.svg", "figures many-n");
    program_read("many-n/figures/errors-s.svg", text, sizeof text);
    assert_non_null(strstr(text, "> 128<"));
    assert_null(strstr(text, "> 16<"));
}

/* Curves of one figure may be medians of different numbers of processes. */
TEST(queries_name_the_least_and_the_most_processes)
{
    static const struct {
        int others; /* of FCL; the particles have two */
        const char *said;
    } rows[] = {{1, "; the median of 1 to 2 processes. Shaded"},
                {2, "; the median of 2 processes. Shaded"},
                {3, "; the median of 2 to 3 processes. Shaded"}};
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        mote_summary summary;
        mote_figure figure = {0};
        char name[16];
        (void)snprintf(name, sizeof name, "queries-%d", rows[i].others);
        test_row("%s", name);
        for (int r = 1; r <= 2; ++r)
            stored_cell_put(name, (stored_cell){.method = "particle-paper",
                                                .parameters = "{\"n\": 5}",
                                                .replicate = r,
                                                .rows = "1,0,0,100,0.5,0,0,0,7\n"});
        for (int r = 1; r <= rows[i].others; ++r)
            write_replicate(name, "fcl-aabb", r, 1, 4000);
        assert_int_equal(mote_summary_make(name, &summary), MOTE_OK);
        const mote_figure_run run = {name, &summary, NULL};
        assert_int_equal(mote_figure_queries(&run, "s", &figure), MOTE_OK);
        assert_non_null(strstr(figure.caption.data, rows[i].said));
        free(figure.data.data);
        free(figure.caption.data);
        free(figure.missing.data);
        mote_summary_free(&summary);
    }
}

/* Ours has two processes, but the rival has only one: there is no interval. */
TEST(ratios_of_one_pair_have_no_band)
{
    mote_summary summary;
    mote_figure figure = {0};
    write_replicate("one-pair", "certified", 1, 1, 1000);
    write_replicate("one-pair", "certified", 2, 1, 1000);
    write_replicate("one-pair", "fcl-aabb", 2, 1, 4000);
    assert_int_equal(mote_summary_make("one-pair", &summary), MOTE_OK);
    const mote_figure_run run = {"one-pair", &summary, NULL};
    assert_int_equal(mote_figure_ratios(&run, "s", &figure), MOTE_OK);
    double middle, ratio[3];
    assert_int_equal(sscanf(strchr(figure.data.data, '\n') + 1, "%lf %lf %lf %lf", &middle,
                            &ratio[0], &ratio[1], &ratio[2]),
                     4);
    assert_true(fabs(ratio[0] - 4) < 1e-9 && isnan(ratio[1]) && isnan(ratio[2]));
    assert_string_equal(figure.missing.data,
                        "intervals on s, for which two replicates of both methods are needed");
    mote_expect(0, "one-pair/figures/ratios-s.svg", "figures one-pair");
    free(figure.data.data);
    free(figure.caption.data);
    free(figure.missing.data);
    mote_summary_free(&summary);
}

TEST(ratios_of_processes_without_a_pair_are_missing)
{
    mote_summary summary;
    mote_figure figure = {0};
    write_replicate("lone", "certified", 1, 1, 1000);
    write_replicate("lone", "fcl-aabb", 2, 1, 4000);
    assert_int_equal(mote_summary_make("lone", &summary), MOTE_OK);
    const mote_figure_run run = {"lone", &summary, NULL};
    assert_int_equal(mote_figure_ratios(&run, "s", &figure), MOTE_OK);
    assert_int_equal(figure.data.size, 0);
    assert_non_null(strstr(figure.missing.data, "a method of ours and one of others"));
    free(figure.caption.data);
    free(figure.missing.data);
    mote_summary_free(&summary);
}

/* The best engine of others has a name in the front, though it is none of the fixed families;
   what is slower than it, does not. */
TEST(front_names_the_best_engine)
{
    mote_summary summary;
    mote_figure figure = {0};
    write_replicate("engines", "certified", 1, 1, 100);
    write_replicate("engines", "fcl-rss", 1, 1, 4000);
    write_replicate("engines", "coal-aabb", 1, 1, 1000);
    assert_int_equal(mote_summary_make("engines", &summary), MOTE_OK);
    const mote_figure_run run = {"engines", &summary, NULL};
    assert_int_equal(mote_figure_front(&run, "s", &figure), MOTE_OK);
    assert_non_null(strstr(figure.data.data, "coal-aabb"));
    assert_null(strstr(figure.data.data, "fcl-rss"));
    assert_non_null(strstr(figure.data.data, "others"));
    assert_non_null(
        strstr(figure.caption.data, "coal-aabb is the fastest engine of others in this run"));
    free(figure.data.data);
    free(figure.caption.data);
    mote_summary_free(&summary);
}

/* Two blocks: ours and the best FCL, each against the engine that is faster than FCL. */
TEST(ratios_are_to_the_best_engine_with_the_best_fcl_beside)
{
    mote_summary summary;
    mote_figure figure = {0};
    for (int r = 1; r <= 2; ++r) {
        write_replicate("rivals", "certified", r, 1, 100);
        write_replicate("rivals", "fcl-aabb", r, 1, 4000);
        write_replicate("rivals", "coal-aabb", r, 1, 1000);
    }
    assert_int_equal(mote_summary_make("rivals", &summary), MOTE_OK);
    const mote_figure_run run = {"rivals", &summary, NULL};
    assert_int_equal(mote_figure_ratios(&run, "s", &figure), MOTE_OK);
    const char *ours = strstr(figure.data.data, "certified");
    const char *fcl = strstr(figure.data.data, "fcl-aabb");
    assert_true(ours && fcl && ours < fcl);
    double middle, ratio;
    assert_int_equal(sscanf(strchr(ours, '\n') + 1, "%lf %lf", &middle, &ratio), 2);
    assert_true(fabs(ratio - 10) < 1e-9);
    assert_int_equal(sscanf(strchr(fcl, '\n') + 1, "%lf %lf", &middle, &ratio), 2);
    assert_true(fabs(ratio - 0.25) < 1e-9);
    assert_non_null(strstr(figure.caption.data, "coal-aabb, the fastest engine of others"));
    free(figure.data.data);
    free(figure.caption.data);
    free(figure.missing.data);
    mote_summary_free(&summary);
}

TEST(figures_of_many_bodies_say_how_many)
{
    assert_int_equal(
        mote("run letters --frames 1-2 --replicates 1 --method certified --out many"), 0);
    assert_int_equal(mote("figures many"), 0);
    char *drawing = file_text("many/figures/shares-letters.svg");
    assert_non_null(strstr(drawing, "letters, 100 bodies"));
    assert_null(strstr(drawing, "triangles"));
    free(drawing);
}

/* By its name a scenario of 10,000 bodies may sort before one of 10, but lines go from left to
   right. */
TEST(lines_over_bodies_ascend)
{
    static const int bodies[] = {10000, 10, 1000, 100};
    mote_text rows = {0};
    mote_figure figure = {0};
    const mote_summary none = {0};
    for (size_t i = 0; i < sizeof bodies / sizeof bodies[0]; ++i)
        mote_text_add(&rows,
                      "%s{\"label\": \"certified\", \"status\": \"ok\", \"near_pairs_wanted\": "
                      "0.1, \"bodies\": %d, \"active_total_ns\": {\"mean\": 2000}, "
                      "\"rss_peak_bytes\": 3e6}",
                      i ? ", " : "", bodies[i]);
    assert_int_equal(mkdir("over-bodies", 0777), 0);
    const mote_figure_run run = {"over-bodies", &none, NULL};
    char *summary = mote_format("{\"rows\": [%s]}", rows.data);
    file_put("over-bodies/summary.json", summary);
    assert_int_equal(mote_figure_bodies(&run, NULL, &figure), MOTE_OK);
    assert_int_equal(strncmp(figure.data.data,
                             "\"certified\"\n10 2 3\n100 2 3\n1000 2 3\n10000 2 3\n\n\n", 47),
                     0);
    free(figure.data.data);
    free(figure.caption.data);
    free(rows.data);
    free(summary);
}

/* Only n varies, as in `make bench`: every line of the figure but one would be empty. */
TEST(tracked_particles_of_one_parameter_are_no_figure_14)
{
    static const int n[] = {2, 4, 8, 16, 32};
    char parameters[32], id[32];
    mote_summary summary;
    mote_figure figure = {0};
    for (size_t i = 0; i < sizeof n / sizeof n[0]; ++i) {
        (void)snprintf(parameters, sizeof parameters, "{\"n\": %d}", n[i]);
        (void)snprintf(id, sizeof id, "particle-%d", n[i]);
        const stored_cell cell = {.id = id,
                                  .method = "particle",
                                  .parameters = parameters,
                                  .rows = "1,0,0,100,0.5,0,0,0,7\n2,0,0,100,0.5,0.1,0,0,7\n"};
        stored_cell_put("n-alone", cell);
    }
    assert_int_equal(mote_summary_make("n-alone", &summary), MOTE_OK);
    assert_int_equal(summary.count, sizeof n / sizeof n[0]);
    const mote_figure_run run = {"n-alone", &summary, NULL};
    assert_int_equal(mote_figure_tracked(&run, "s", &figure), MOTE_OK);
    assert_int_equal(figure.data.size, 0);
    assert_string_equal(figure.missing.data, "the rows of `make ingredients`");
    free(figure.missing.data);
    mote_summary_free(&summary);
}

/* All frames up to the one shown are queried again: none may be beyond the scenario. */
TEST(scene_of_a_cell_with_a_frame_that_is_not_there_is_refused)
{
    mote_summary summary;
    assert_int_equal(mote_summary_make("run", &summary), MOTE_OK);
    /* A method that is slow here is asked in some of the 60 frames only. */
    const mote_stored_cell *cell = summary.rows[0].first;
    uint32_t *last = &cell->frame[cell->frames - 1];
    const uint32_t frames[] = {*last, 2001, UINT32_MAX};
    for (size_t i = 0; i < sizeof frames / sizeof frames[0]; ++i) {
        mote_figure_scene scene;
        *last = frames[i];
        const mote_status status = mote_figure_scene_open(&summary.rows[0], &scene);
        mote_figure_scene_close(&scene);
        assert_int_equal(status, i == 0 ? MOTE_OK : MOTE_EINVAL);
    }
    assert_non_null(strstr(mote_error_text(), "tt: other frames or faces than those measured"));
    mote_summary_free(&summary);
}

static void remove_csv(const char *path)
{
    char csv[600];
    (void)snprintf(csv, sizeof csv, "%.*scsv", (int)strlen(path) - 4, path);
    assert_int_equal(unlink(csv), 0);
}

TEST(run_of_which_nothing_can_be_drawn_is_bad_input)
{
    copy_run("bare", remove_csv);
    mote_expect(4, "left out", "figures bare");
    mote_expect(4, "nowhere: No such file", "figures nowhere");
    mote_expect(4, "", "figures said");
    assert_int_equal(mkdir("empty", 0777), 0);
    mote_expect(4, "nothing to draw", "figures empty");
}

TEST(claims_alone_are_drawn)
{
    file_put("claims/claims.json",
             "[{\"id\": \"a\", \"claim\": \"two is enough\", \"value\": 2, \"interval\": "
             "[1.5, 2.5], \"unit\": \"L\", \"verdict\": \"holds within limits\", "
             "\"values\": [{\"name\": \"n = 3\"}]}]");
    mote_expect(0, "", "figures claims");
    program_read("claims/figures/claims.svg", text, sizeof text);
    assert_non_null(strstr(text, "two is enough"));
    assert_non_null(strstr(text, "n = 3: 2 [1.5, 2.5] L"));
    assert_non_null(strstr(text, "within limits"));
}

TEST(quoted_text_has_no_quote_nor_line_end_inside)
{
    mote_text made = {0};
    mote_gnuplot_quote(&made, "a\"b\nc\\");
    assert_string_equal(made.data, "\"a\xe2\x80\x9d"
                                   "b c\\\"");
    free(made.data);
}
