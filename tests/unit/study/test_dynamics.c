/* The study of the closed loop: its rows, its approaches, and resuming it. */
#include "harness/study/dynamics.h"

#include "harness/base/file.h"
#include "tests/support/folder.h"
#include "tests/support/mote.h"
#include "tests/support/test.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <stddef.h>

#define OUT "."
#define ROW OUT "/rows/tt-particle-paper-n-3-law-log.json"
#define LINE "dynamics --quick --scene tt --approaches 2 --jobs 2 --out " OUT

static const mote_dynamics_row *find(const mote_dynamics_row *rows, size_t count,
                                     const char *scene, const char *method)
{
    for (size_t i = 0; i < count; ++i) {
        if (strcmp(rows[i].scene, scene) == 0 && strcmp(rows[i].method, method) == 0)
            return &rows[i];
    }
    fail_msg("no row %s, %s", scene, method);
    return NULL;
}

static mote_status simulate_approaches(mote_scenario *scenario, const char *method,
                                       uint32_t wanted, mote_approaches *sum)
{
    const mote_approaches_plan plan = {.method = method, .wanted = wanted, .step = 1};
    return mote_approaches_simulate(scenario, &plan, sum);
}

TEST(plan_full_has_what_the_claim_needs)
{
    static const char *const scenes[] = {"tt", "mv", "ww", "vv", "tw", "comb"};
    static const char *const laws[] = {"log", "inverse", "inverse-square"};
    static const int numbers[] = {1, 2, 3, 4, 5, 6, 7, 8, 16};
    const mote_dynamics_size size = {0};
    mote_dynamics_row *rows;
    size_t count;
    assert_int_equal(mote_dynamics_plan(&size, &rows, &count), MOTE_OK);
    for (size_t s = 0; s < 6; ++s) {
        const uint32_t many = s < 3 ? 1000 : 200;
        for (size_t law = 0; law < (s < 3 ? 3 : 1); ++law) {
            for (size_t k = 0; k < 9; ++k) {
                char method[64];
                (void)snprintf(method, sizeof method, "particle-paper:n=%d,law=%s", numbers[k],
                               laws[law]);
                const mote_dynamics_row *row = find(rows, count, scenes[s], method);
                assert_true(row->wanted >= (law == 0 ? many : 200) && !row->exact);
            }
        }
        assert_true(find(rows, count, scenes[s], "particle:n=8")->wanted >= many);
        assert_true(find(rows, count, scenes[s], "certified")->wanted >= many);
        if (s < 3)
            assert_true(find(rows, count, scenes[s], "fcl-aabb:seed=previous,queue=64")->exact);
    }
    free(rows);
}

/* Sampled and continuous steps of each length, by themselves if asked for. */
TEST(plan_has_steps_with_paths)
{
    mote_dynamics_size size = {0};
    mote_dynamics_row *rows;
    size_t count;
    uint32_t continuous = 0, sampled = 0, whole = 0, longest = 0;
    assert_int_equal(mote_dynamics_plan(&size, &rows, &count), MOTE_OK);
    for (size_t i = 0; i < count; ++i) {
        continuous += rows[i].within == MOTE_STEPS_CONTINUOUS;
        sampled += rows[i].within == MOTE_STEPS_SAMPLED;
        whole += rows[i].within == MOTE_STEPS_WHOLE;
        if (rows[i].within == MOTE_STEPS_CONTINUOUS && rows[i].step > 29)
            longest += rows[i].wanted;
    }
    assert_int_equal(continuous, 40);
    assert_int_equal(sampled, 40);
    assert_true(whole > 100);
    assert_int_equal(longest, 4400);
    free(rows);
    size.step = 10;
    assert_int_equal(mote_dynamics_plan(&size, &rows, &count), MOTE_OK);
    assert_int_equal(count, 20);
    for (size_t i = 0; i < count; ++i)
        assert_true(rows[i].within != MOTE_STEPS_WHOLE && fabs(rows[i].step - 10) < 1e-9);
    free(rows);
    assert_true(mote_dynamics_has_step(1) && mote_dynamics_has_step(30));
    assert_false(mote_dynamics_has_step(7) || mote_dynamics_has_step(0));
}

/* The same approaches pass where long steps are sampled, and do not where impacts are found. */
TEST(approaches_simulate_continuous_lets_nothing_pass)
{
    mote_scenario *scenario;
    assert_int_equal(mote_scenario_load("tt", &scenario), MOTE_OK);
    mote_dynamics_row row[3] = {{.within = MOTE_STEPS_WHOLE}};
    for (int w = MOTE_STEPS_SAMPLED; w <= MOTE_STEPS_CONTINUOUS; ++w) {
        row[w].wanted = 12;
        row[w].within = (mote_simulation_steps)w;
        const mote_approaches_plan plan = {"certified", 12, 30, row[w].within};
        assert_int_equal(mote_approaches_simulate(scenario, &plan, &row[w].sum), MOTE_OK);
    }
    const mote_approaches *a = &row[MOTE_STEPS_SAMPLED].sum;
    const mote_approaches *b = &row[MOTE_STEPS_CONTINUOUS].sum;
    assert_true(a->passes_through > 0 && a->intersecting > 6 && a->impacts == 0);
    assert_true(b->approaches == 12 && b->impacts >= 12);
    assert_int_equal(b->passes_through + b->intersecting + b->floor_unproven, 0);
    assert_null(mote_dynamics_failure(&row[MOTE_STEPS_CONTINUOUS]));
    row[MOTE_STEPS_CONTINUOUS].sum.intersecting = 1;
    assert_non_null(strstr(mote_dynamics_failure(&row[MOTE_STEPS_CONTINUOUS]), "intersect"));
    row[MOTE_STEPS_CONTINUOUS].sum.passes_through = 1;
    assert_non_null(strstr(mote_dynamics_failure(&row[MOTE_STEPS_CONTINUOUS]), "pass"));
    mote_scenario_destroy(scenario);
}

TEST(plan_unknown_scene_refused)
{
    const mote_dynamics_size size = {.scene = "nowhere"};
    mote_dynamics_row *rows;
    size_t count;
    assert_int_equal(mote_dynamics_plan(&size, &rows, &count), MOTE_EINVAL);
    assert_non_null(strstr(mote_error_text(), "nowhere"));
}

TEST(approach_draw_starts_apart_and_aims_at_the_other)
{
    mote_scenario *scenario;
    mote_mass mass[2];
    assert_int_equal(mote_scenario_load("mv", &scenario), MOTE_OK);
    for (int i = 0; i < 2; ++i)
        assert_int_equal(mote_mass_of_mesh(scenario->body[i].mesh, 1, &mass[i]), MOTE_OK);
    const double length = scenario->length;
    double slowest = HUGE_VAL, fastest = 0, most_aside = 0;
    for (uint32_t index = 0; index < 1000; ++index) {
        mote_rigid_state state[2], again[2];
        const mote_simulation_start a = mote_approach_draw(scenario, mass, index, state);
        const mote_simulation_start b = mote_approach_draw(scenario, mass, index, again);
        assert_memory_equal(state, again, sizeof state);
        assert_true(a.states == state && b.states == again && a.steps == b.steps);
        const mote_vec3 away = mote_sub(state[1].centre, state[0].centre);
        const mote_vec3 v = state[1].velocity;
        const double speed = mote_length(v), along = -mote_dot(away, v) / speed;
        const double aside = sqrt(fmax(0, mote_length_squared(away) - along * along));
        assert_true(along > length && a.steps * speed > along);
        assert_true(a.first >= 1 && a.first <= scenario->frames);
        for (int i = 0; i < 2; ++i) {
            const mote_vec3 w = mote_rigid_angular_velocity(&mass[i], &state[i]);
            assert_true(mote_length(w) <= 0.0349066);
        }
        slowest = fmin(slowest, speed / length);
        fastest = fmax(fastest, speed / length);
        most_aside = fmax(most_aside, aside / length);
    }
    assert_true(slowest >= 0.002 && slowest < 0.0021 && fastest <= 0.02 && fastest > 0.019);
    assert_true(most_aside <= 0.35 && most_aside > 0.33);
    mote_scenario_destroy(scenario);
}

TEST(approaches_json_comes_back)
{
    mote_scenario *scenario;
    mote_approaches sum, again;
    assert_int_equal(mote_scenario_load("tt", &scenario), MOTE_OK);
    assert_int_equal(simulate_approaches(scenario, "particle:n=8", 3, &sum), MOTE_OK);
    assert_true(sum.approaches == 3 && sum.trials >= 3 && sum.contact_runs >= 3);
    assert_true(sum.steps > 50 && sum.truth_asked < sum.steps && sum.responses > 0);
    json_t *object = mote_approaches_json(&sum);
    assert_true(mote_approaches_read(object, &again));
    assert_memory_equal(&sum, &again, sizeof sum);
    /* No key may be missing or a text; a whole number is allowed. */
    const char *key;
    json_t *value;
    json_object_foreach(object, key, value)
    {
        json_t *copy = json_copy(object);
        assert_non_null(copy);
        assert_int_equal(json_object_del(copy, key), 0);
        assert_false(mote_approaches_read(copy, &again));
        assert_int_equal(json_object_set_new(copy, key, json_string("many")), 0);
        assert_false(mote_approaches_read(copy, &again));
        assert_int_equal(json_object_set_new(copy, key, json_integer(3)), 0);
        assert_true(mote_approaches_read(copy, &again));
        json_decref(copy);
    }
    json_decref(object);
    mote_scenario_destroy(scenario);
}

/* A stored row that was damaged: no share may exceed 1, no count be negative. */
TEST(approaches_read_of_impossible_counts_is_false)
{
    static const struct {
        const char *key;
        json_int_t value;
        bool read;
    } cases[] = {{"passes_through", 4, true}, {"passes_through", 5, false},
                 {"approaches", 0, false},    {"contact_runs_passed", 7, false},
                 {"contact_runs", 5, false},  {"missed_steps", INT64_MIN, false},
                 {"false_steps", -1, false},  {"delay_sum", INT64_MAX, false}};
    const mote_approaches sum = {.trials = 4,
                                 .approaches = 4,
                                 .passes_through = 3,
                                 .contact_runs = 6,
                                 .contact_runs_passed = 6};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        mote_approaches again;
        json_t *object = mote_approaches_json(&sum);
        assert_int_equal(
            json_object_set_new(object, cases[i].key, json_integer(cases[i].value)), 0);
        assert_int_equal(mote_approaches_read(object, &again), cases[i].read);
        json_decref(object);
        if (cases[i].read)
            assert_true(mote_approaches_interval(&again).high <= 1);
    }
}

/* Rows without an approach have no shares and are not drawn. */
TEST(row_without_approaches_has_no_share)
{
    const mote_dynamics_row row = {.scene = "tt", .method = "certified", .wanted = 3};
    json_t *object = mote_dynamics_row_json(&row);
    assert_true(json_is_null(json_object_get(object, "share")));
    assert_true(json_is_null(json_object_get(object, "interval")));
    assert_true(json_is_null(json_object_get(object, "n")));
    json_decref(object);
    assert_int_equal(mote_dynamics_csv(&row, 1, OUT), MOTE_OK);
    char *text = file_text(OUT "/dynamics.csv");
    assert_non_null(strstr(text, "\ntt,\"certified\",0,,,,,,,0,0,"));
    free(text);
    mote_claim claim = {0};
    mote_dynamics_claim(&claim);
    mote_dynamics_claim_add(&claim, &row);
    assert_int_equal(mote_claim_judge(&claim), MOTE_CLAIM_DOES_NOT_HOLD);
    mote_claim_free(&claim);
}

/* The figure shows rows of the printed law with a contact; the claim counts those of the
   paper's scenes. */
TEST(figure_and_claim_take_rows_of_the_printed_law)
{
    const mote_approaches some = {.trials = 9, .approaches = 8, .passes_through = 2};
    const mote_dynamics_row rows[] = {
        {.scene = "ww", .method = "a", .n = 3, .law = "log", .paper = true, .sum = some},
        {.scene = "ww", .method = "b", .n = 4, .law = "log", .paper = true},
        {.scene = "ww", .method = "c", .n = 5, .law = "inverse", .paper = true, .sum = some},
        {.scene = "ww", .method = "d", .paper = true, .sum = some},
        {.scene = "vv", .method = "e", .n = 6, .law = "log", .sum = some}};
    assert_int_equal(mote_dynamics_figure(rows, 5, OUT), MOTE_OK);
    char *text = file_text(OUT "/figures/dynamics.dat");
    assert_non_null(strstr(text, "\"ww\"\n3 0.25 "));
    assert_non_null(strstr(text, "\"vv\"\n6 0.25 "));
    assert_null(strstr(text, "\n4 "));
    assert_null(strstr(text, "\n5 "));
    free(text);
    mote_claim claim = {0};
    mote_dynamics_claim(&claim);
    for (int k = 0; k < 5; ++k)
        mote_dynamics_claim_add(&claim, &rows[k]);
    json_t *object = mote_claim_json(&claim);
    static const char *const names[] = {"ww, n = 3", "ww, n = 4", "ww, c", "ww, d", "vv, e"};
    for (size_t k = 0; k < 5; ++k) {
        const json_t *value = json_array_get(json_object_get(object, "values"), k);
        assert_string_equal(json_string_value(json_object_get(value, "name")), names[k]);
        assert_true(json_is_object(json_object_get(value, "threshold")) == (k < 2));
    }
    json_decref(object);
    mote_claim_free(&claim);
}

/* Bodies of two particles each seldom meet: the approaches end, and are reported as too few. */
TEST(approaches_that_seldom_come_to_a_contact_end)
{
    static const char motes[] =
        "v 0 0 0\nv 0.01 0 0\nv 0 0.01 0\nv 0 0 0.01\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
        "v 1 0 0\nv 1.01 0 0\nv 1 0.01 0\nv 1 0 0.01\nf 5 7 6\nf 5 6 8\nf 5 8 7\nf 6 7 8\n";
    static const char scene[] =
        "{\"purpose\": \"motes\", \"frames\": 4, \"ask\": \"distance\", "
        "\"bodies\": [{\"file\": \"n.obj\"}, {\"file\": \"n.obj\"}]}\n";
    assert_int_equal(mote_file_write(OUT "/n.obj", motes, sizeof motes - 1), MOTE_OK);
    assert_int_equal(mote_file_write(OUT "/n.json", scene, sizeof scene - 1), MOTE_OK);
    mote_scenario *scenario = NULL;
    assert_int_equal(mote_scenario_load(OUT "/n.json", &scenario), MOTE_OK);
    mote_dynamics_row row = {.wanted = 3};
    assert_int_equal(simulate_approaches(scenario, "certified", 3, &row.sum), MOTE_OK);
    assert_int_equal(row.sum.trials, 12);
    assert_true(row.sum.approaches < 3 && row.sum.steps > 12);
    assert_non_null(strstr(mote_dynamics_failure(&row), "too few approaches"));
    assert_int_equal(simulate_approaches(scenario, "certified", 0, &row.sum), MOTE_OK);
    assert_int_equal(row.sum.trials, 0);
    assert_true(row.sum.query_ns == 0);
    assert_int_equal(simulate_approaches(scenario, "magic", 1, &row.sum), MOTE_EINVAL);
    assert_int_equal(simulate_approaches(scenario, "particle:n=9", 1, &row.sum), MOTE_EINVAL);
    assert_non_null(strstr(mote_error_text(), "n, particle:n=9, approach 1: "));
    mote_scenario_destroy(scenario);
}

TEST(failure_names_what_was_not_met)
{
    mote_dynamics_row row = {.wanted = 10, .sum = {.trials = 12, .approaches = 10}};
    row.sum.passes_through = row.sum.missed_steps = 1;
    assert_null(mote_dynamics_failure(&row));
    row.exact = true;
    assert_non_null(strstr(mote_dynamics_failure(&row), "pass"));
    row.sum.passes_through = 0;
    assert_non_null(strstr(mote_dynamics_failure(&row), "contact"));
    row.sum.missed_steps = 0;
    assert_null(mote_dynamics_failure(&row));
    row.sum.angular_momentum_drift = 1e-6;
    assert_string_equal(mote_dynamics_failure(&row), "angular momentum was not kept");
    row.sum.momentum_drift = (double)NAN;
    assert_string_equal(mote_dynamics_failure(&row), "momentum was not kept");
    row.sum.energy_drift = 1e-6;
    assert_non_null(strstr(mote_dynamics_failure(&row), "energy"));
    row.sum.approaches = 9;
    assert_non_null(strstr(mote_dynamics_failure(&row), "too few"));
}

/* The claim needs every row of 3 to 5 particles, by the upper end of its interval. */
TEST(claim_follows_from_the_rows)
{
    static const struct {
        uint64_t passes, approaches;
        mote_claim_verdict verdict;
    } cases[] = {{0, 1000, MOTE_CLAIM_HOLDS},
                 {3, 1000, MOTE_CLAIM_HOLDS},
                 {5, 1000, MOTE_CLAIM_LIMITS},
                 {0, 100, MOTE_CLAIM_LIMITS},
                 {45, 1000, MOTE_CLAIM_DOES_NOT_HOLD}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        mote_claim claim = {0};
        mote_dynamics_claim(&claim);
        for (uint32_t n = 2; n <= 5; ++n) {
            mote_dynamics_row row = {.scene = "ww", .law = "log", .n = n, .paper = true};
            row.sum.approaches = n == 4 ? cases[i].approaches : 1000;
            row.sum.passes_through = n == 4 ? cases[i].passes : 0;
            if (n == 2)
                row.sum.passes_through = 500;
            mote_dynamics_claim_add(&claim, &row);
        }
        assert_int_equal(mote_claim_judge(&claim), cases[i].verdict);
        mote_claim_free(&claim);
    }
}

static void run_study(void)
{
    mote_expect(0, "", LINE);
}

/* Existing rows are reused, except one of another build and a damaged one. */
TEST(command_dynamics_goes_on_where_it_stopped)
{
    char *row;
    run_study();
    assert_non_null(strstr(said, "dynamics: tt, particle-paper:n=3,law=log:"));
    assert_non_null(strstr(said, "dynamics: tt, certified: 0 passes of 2"));
    assert_int_equal(access(OUT "/dynamics.json", R_OK), 0);
    assert_int_equal(access(OUT "/dynamics.csv", R_OK), 0);
    assert_int_equal(access(OUT "/figures/dynamics.svg", R_OK), 0);
    run_study();
    assert_null(strstr(said, "dynamics: tt,"));
    assert_non_null(strstr(said, "tt, n = 3"));
    row = file_text(ROW);
    char *program = strstr(row, "\"program\": \"");
    assert_non_null(program);
    program[12] = program[12] == '0' ? '1' : '0';
    file_put(ROW, row);
    free(row);
    file_put(OUT "/rows/tt-certified.json", "{");
    run_study();
    const char *first = strstr(said, "dynamics: tt,");
    assert_non_null(strstr(said, "dynamics: tt, particle-paper:n=3,law=log:"));
    assert_non_null(strstr(said, "dynamics: tt, certified:"));
    const char *second = strstr(first + 1, "dynamics: tt,");
    assert_non_null(second);
    assert_null(strstr(second + 1, "dynamics: tt,"));
}

static int count_measured(void)
{
    return (int)test_count(said, "dynamics: tt,");
}

/* Replaces a text once in a stored row. */
static void change_row(const char *name, const char *from, const char *to)
{
    char *path = mote_format(OUT "/rows/%s.json", name);
    char *row = file_text(path), *at = strstr(row, from);
    assert_non_null(at);
    char *changed = mote_format("%.*s%s%s", (int)(at - row), row, to, at + strlen(from));
    file_put(path, changed);
    free(changed);
    free(row);
    free(path);
}

TEST(command_dynamics_measures_rows_again_that_lack_something)
{
    run_study();
    change_row("tt-particle-n-8", "\"program\"", "\"programs\"");
    change_row("tt-particle-paper-n-1-law-log", "\"measured\"", "\"measures\"");
    change_row("tt-particle-paper-n-2-law-log", "\"commit\"", "\"commits\"");
    change_row("tt-particle-paper-n-4-law-log", "\"wanted\": 2", "\"wanted\": 3");
    change_row("tt-particle-paper-n-5-law-log", "\"steps\"", "\"stairs\"");
    run_study();
    assert_int_equal(count_measured(), 5);
    run_study();
    assert_int_equal(count_measured(), 0);
}

/* Another process measures rows, and ends without having stored one. */
TEST(command_dynamics_waits_for_rows_of_another_process)
{
    int ready[2];
    char byte = 0;
    assert_int_equal(unlink(ROW), 0);
    assert_int_equal(pipe(ready), 0);
    const pid_t other = fork();
    if (other == 0) {
        struct flock whole = {.l_type = F_WRLCK, .l_whence = SEEK_SET};
        const int lock = open(OUT "/rows/lock", O_RDWR);
        const struct timespec half = {0, 500000000};
        const bool locked = lock >= 0 && fcntl(lock, F_SETLK, &whole) == 0;
        if (!locked || write(ready[1], "", 1) != 1 || nanosleep(&half, NULL) != 0)
            _exit(1);
        _exit(0);
    }
    assert_int_equal(read(ready[0], &byte, 1), 1);
    run_study();
    assert_int_equal(count_measured(), 1);
    int status = 1;
    assert_int_equal(waitpid(other, &status, 0), other);
    assert_int_equal(status, 0);
    assert_int_equal(close(ready[0]) + close(ready[1]), 0);
}

/* Steps within which bodies have paths: neither particles nor the claim about them. */
TEST(command_dynamics_of_one_step_leaves_particles_out)
{
    mote_expect(0, "sampled", LINE " --step 3");
    assert_int_equal(count_measured(), 0);
    assert_null(strstr(said, "tt, n = 3"));
    assert_null(strstr(said, "particle"));
}

/* With --keep rows of other builds stay, and name their sources. */
TEST(command_dynamics_keeps_rows_of_other_builds_when_asked)
{
    static const char changed[] = "0123456789abcdef0123456789abcdef01234567";
    char *row = file_text(ROW);
    char *program = strstr(row, "\"program\": \""), *commit = strstr(row, "\"commit\": \"");
    assert_non_null(program);
    assert_non_null(commit);
    program[12] = program[12] == '0' ? '1' : '0';
    commit += strlen("\"commit\": \""); /* empty if git does not answer */
    char *other =
        mote_format("%.*s%s%s", (int)(commit - row), row, changed, strchr(commit, '"'));
    file_put(ROW, other);
    free(other);
    free(row);
    mote_expect(0, "", LINE " --keep");
    assert_null(strstr(said, "dynamics: tt,"));
    char *table = file_text(OUT "/dynamics.csv");
    char *line = strstr(table, "particle-paper:n=3,law=log");
    assert_non_null(line);
    const char *found = strstr(line, changed);
    assert_true(found && found < strchr(line, '\n'));
    assert_null(strstr(found + 1, changed));
    free(table);
}

TEST(command_dynamics_bad_line_refused)
{
    static const struct {
        const char *line, *says;
        int status;
    } bad[] = {{"dynamics tt", "takes no argument", 2},
               {"dynamics --jobs 0", "--jobs 0", 2},
               {"dynamics --approaches 0", "--approaches 0", 2},
               {"dynamics --quick --scene vv --out " OUT, "vv", 4},
               {"dynamics --quick --out /proc/x", "/proc/x", 4}};
    for (size_t i = 0; i < ROWS_OF(bad); ++i)
        mote_expect(bad[i].status, bad[i].says, "%s", bad[i].line);
}
