#include "harness/study_dynamics.h"

#include "core/random.h"
#include "harness/claim.h"
#include "harness/file.h"
#include "harness/json_print.h"
#include "harness/simulate.h"
#include "harness/turn.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* An approach, in L and frames: one body flies past or into the other, both turning. */
#define SLOWEST 0.002
#define FASTEST 0.02
#define MOST_DEGREES 2.0 /* a frame */
#define ASIDE 0.35       /* of the other's centre, at most */
#define CLEAR 0.2        /* between the bodies' spheres at the start */
#define APART 0.06       /* an approach ends so far apart */
#define MOST_STEPS 2000

/* What has to be kept, relative; paths are some hundred steps. */
#define MOST_DRIFT 1e-10

/* For the claim: the upper end of the share of passes. */
#define HOLDS 0.01
#define LIMITS 0.05

/* The approaches of one method on one scene. */
typedef struct row {
    const char *scene, *method;
    uint32_t trials;          /* simulated */
    uint32_t approaches;      /* of them that came to a contact in truth */
    uint32_t passes;          /* of those with a run of contacts that was never reported */
    uint32_t deep;            /* of those with a vertex inside the other body meanwhile */
    mote_confidence interval; /* of passes / approaches */
    uint64_t runs, run_passes, steps, contact_steps, missed_steps, false_steps, delay_sum;
    uint32_t delay_max;
    double depth_max, depth_passes, energy_drift, momentum_drift, angular_drift, query_ns;
} row;

typedef struct study {
    bool quick, met;
    json_t *rows, *failures;
    mote_claim claim;
} study;

static mote_vec3 random_direction(mote_random *random)
{
    for (;;) {
        mote_vec3 v;
        v.x = 2 * mote_random_unit(random) - 1;
        v.y = 2 * mote_random_unit(random) - 1;
        v.z = 2 * mote_random_unit(random) - 1;
        const double square = mote_length_squared(v);
        if (square > 0.01 && square <= 1)
            return mote_scale(v, 1 / sqrt(square));
    }
}

/* Evenly from all rotations (Shoemake 1992). */
static mote_quaternion random_turn(mote_random *random)
{
    const double part = mote_random_unit(random);
    double s, c, t, d;
    mote_turn(mote_random_unit(random), &s, &c);
    mote_turn(mote_random_unit(random), &t, &d);
    const double a = sqrt(1 - part), b = sqrt(part);
    return (mote_quaternion){b * d, a * s, a * c, b * t};
}

static double reach_of(const mote_mesh *mesh, mote_vec3 centre)
{
    double most = 0;
    for (uint32_t v = 0; v < mesh->vertex_count; ++v)
        most = fmax(most, mote_distance_squared(mesh->positions[v], centre));
    return sqrt(most);
}

/* Approach number `index`, the same for every method. */
static mote_simulation_start draw_start(const mote_scenario *scenario, const mote_mass *mass,
                                        uint32_t index)
{
    mote_random random = {0x64796e616d696373u + index};
    const double length = scenario->length;
    const double radian = 3.14159265358979323846 / 180;
    const double speed =
        length * SLOWEST * exp(log(FASTEST / SLOWEST) * mote_random_unit(&random));
    mote_simulation_start start = {
        .seed = index + 1, .apart = APART * length, .depth_unreported = true};
    start.first = 1 + (uint32_t)mote_random_below(&random, scenario->frames);
    for (int i = 0; i < 2; ++i) {
        start.state[i].turn = random_turn(&random);
        const double turning = MOST_DEGREES * radian * mote_random_unit(&random);
        start.state[i].angular_momentum = mote_rigid_angular_momentum(
            &mass[i], &start.state[i], mote_scale(random_direction(&random), turning));
    }
    const mote_vec3 from = random_direction(&random);
    mote_vec3 aside = mote_cross(from, random_direction(&random));
    aside = mote_scale(aside, ASIDE * length * sqrt(mote_random_unit(&random)));
    const double far = reach_of(scenario->body[0].mesh, mass[0].centre) +
                       reach_of(scenario->body[1].mesh, mass[1].centre) + CLEAR * length;
    start.state[1].centre = mote_add_scaled(aside, far, from);
    start.state[1].velocity = mote_scale(from, -speed);
    const double steps = ceil(2 * far / speed);
    start.steps = steps < MOST_STEPS ? (uint32_t)steps : MOST_STEPS;
    return start;
}

static void add_result(row *sum, const mote_simulation_result *r)
{
    ++sum->trials;
    sum->approaches += r->approaches > 0;
    sum->passes += r->passes > 0;
    sum->deep += r->deep_passes > 0;
    sum->runs += r->approaches;
    sum->run_passes += r->passes;
    sum->query_ns += r->query_ns * (r->steps + 1.0);
    sum->steps += r->steps + 1;
    sum->contact_steps += r->contact_steps;
    sum->missed_steps += r->missed_steps;
    sum->false_steps += r->false_steps;
    sum->delay_sum += r->delay_sum;
    sum->delay_max = r->delay_max > sum->delay_max ? r->delay_max : sum->delay_max;
    sum->depth_max = fmax(sum->depth_max, r->depth_max);
    sum->depth_passes = fmax(sum->depth_passes, r->depth_passes);
    sum->energy_drift = fmax(sum->energy_drift, r->energy_drift);
    sum->momentum_drift = fmax(sum->momentum_drift, r->momentum_drift);
    sum->angular_drift = fmax(sum->angular_drift, r->angular_drift);
}

/* Simulates until so many approaches came to a contact, or four times as many did not. */
static mote_status simulate_row(const mote_scenario *scenario, const char *method,
                                uint32_t approaches, row *sum)
{
    mote_method_choice choice;
    mote_simulator *simulator = NULL;
    const mote_simulation_options options = mote_default_simulation_options(scenario);
    mote_status status = mote_method_choice_read(method, &choice);
    if (status == MOTE_OK)
        status = mote_simulator_create(scenario, &choice, &options, &simulator);
    *sum = (row){.scene = scenario->name, .method = method};
    for (uint32_t i = 0; status == MOTE_OK && sum->approaches < approaches; ++i) {
        if (i == 4 * approaches)
            break;
        const mote_simulation_start start =
            draw_start(scenario, mote_simulator_masses(simulator), i);
        mote_simulation_result result;
        status = mote_simulator_run(simulator, &start, NULL, &result);
        if (status == MOTE_OK)
            add_result(sum, &result);
        else
            status = mote_fail(status, "%s, %s, approach %u: %s", scenario->name, method, i + 1,
                               mote_error_text());
    }
    mote_simulator_destroy(simulator);
    if (sum->steps > 0)
        sum->query_ns /= (double)sum->steps;
    sum->interval = mote_statistics_share_interval(sum->passes, sum->approaches);
    return status;
}

static double share_of(const row *r)
{
    return r->approaches > 0 ? (double)r->passes / r->approaches : MOTE_NONE;
}

static json_t *row_json(const row *r)
{
    json_t *object =
        json_pack("{s:s, s:s, s:I, s:I, s:I, s:I, s:f, s:f, s:f, s:f, s:f, s:f}", "scenario",
                  r->scene, "method", r->method, "trials", (json_int_t)r->trials, "approaches",
                  (json_int_t)r->approaches, "passes_through", (json_int_t)r->passes,
                  "deep_passes_through", (json_int_t)r->deep, "max_penetration_unreported",
                  r->depth_max, "max_penetration_passes", r->depth_passes, "energy_drift",
                  r->energy_drift, "momentum_drift", r->momentum_drift,
                  "angular_momentum_drift", r->angular_drift, "query_ns", r->query_ns);
    const struct {
        const char *key;
        uint64_t value;
    } counts[] = {{"contact_runs", r->runs},
                  {"contact_runs_passed", r->run_passes},
                  {"steps", r->steps},
                  {"contact_steps", r->contact_steps},
                  {"missed_steps", r->missed_steps},
                  {"false_steps", r->false_steps},
                  {"delay_sum", r->delay_sum},
                  {"delay_max", r->delay_max}};
    for (size_t i = 0; i < sizeof counts / sizeof counts[0]; ++i)
        (void)json_object_set_new(object, counts[i].key,
                                  json_integer((json_int_t)counts[i].value));
    if (r->approaches > 0)
        (void)json_object_set_new(object, "interval",
                                  json_pack("[f,f]", r->interval.low, r->interval.high));
    return object;
}

static void print_row(const row *r)
{
    (void)printf("%-8s %-36s %6u %7u %6u %8.2f  [%5.2f, %6.2f] %8.4f %9.1f\n", r->scene,
                 r->method, r->approaches, r->passes, r->deep, 100 * share_of(r),
                 100 * r->interval.low, 100 * r->interval.high, r->depth_passes,
                 r->query_ns / 1e3);
    (void)fflush(stdout);
}

static void require(study *s, bool met, const row *r, const char *what)
{
    if (met)
        return;
    s->met = false;
    (void)json_array_append_new(s->failures, json_pack("{s:s, s:s, s:s}", "scenario", r->scene,
                                                       "method", r->method, "what", what));
    (void)fprintf(stderr, "mote: dynamics: %s, %s: %s\n", r->scene, r->method, what);
}

/* One row: measured, printed, kept, and checked. */
static mote_status measure(study *s, const mote_scenario *scenario, const char *method,
                           uint32_t approaches, bool exact, row *measured)
{
    const mote_status status = simulate_row(scenario, method, approaches, measured);
    if (status != MOTE_OK)
        return status;
    print_row(measured);
    (void)json_array_append_new(s->rows, row_json(measured));
    require(s, measured->approaches == approaches, measured,
            "too few approaches came to a contact");
    require(s, !exact || measured->passes == 0, measured,
            "an exact method let a body pass through");
    require(s, !exact || measured->missed_steps + measured->false_steps == 0, measured,
            "an exact method was wrong about a contact");
    require(s, measured->energy_drift <= MOST_DRIFT, measured, "energy was not kept");
    require(s, measured->momentum_drift <= MOST_DRIFT, measured, "momentum was not kept");
    require(s, measured->angular_drift <= MOST_DRIFT, measured,
            "angular momentum was not kept");
    return MOTE_OK;
}

static const int counts[] = {1, 2, 3, 4, 5, 6, 7, 8, 16};

static mote_status measure_law(study *s, const mote_scenario *scenario, const char *law,
                               uint32_t approaches, bool claimed)
{
    mote_status status = MOTE_OK;
    for (size_t k = 0; k < sizeof counts / sizeof counts[0] && status == MOTE_OK; ++k) {
        char method[64];
        row r;
        (void)snprintf(method, sizeof method, "particle-paper:n=%d,law=%s", counts[k], law);
        status = measure(s, scenario, method, approaches, false, &r);
        if (status != MOTE_OK || !claimed)
            continue;
        status = mote_claim_add(&s->claim, share_of(&r), r.interval, "", "%s, n = %d",
                                scenario->name, counts[k]);
        if (status == MOTE_OK && counts[k] >= 3 && counts[k] <= 5)
            mote_claim_require(&s->claim, MOTE_AT_MOST, HOLDS, LIMITS);
    }
    return status;
}

/* A scene of the paper: every method. */
static mote_status measure_scene(study *s, const mote_scenario *scenario)
{
    const uint32_t many = s->quick ? 100 : 1000, few = s->quick ? 20 : 200;
    row r;
    mote_status status = measure_law(s, scenario, "log", many, true);
    if (status == MOTE_OK)
        status = measure(s, scenario, "particle:n=8", many, false, &r);
    if (status == MOTE_OK)
        status = measure(s, scenario, "certified", many, true, &r);
    if (status == MOTE_OK)
        status = measure(s, scenario, "fcl-aabb:seed=previous,queue=64", few, true, &r);
    if (!s->quick && status == MOTE_OK)
        status = measure_law(s, scenario, "inverse", few, false);
    if (!s->quick && status == MOTE_OK)
        status = measure_law(s, scenario, "inverse-square", few, false);
    return status;
}

static mote_status measure_other(study *s, const mote_scenario *scenario)
{
    row r;
    mote_status status = measure_law(s, scenario, "log", 200, false);
    if (status == MOTE_OK)
        status = measure(s, scenario, "particle:n=8", 200, false, &r);
    return status == MOTE_OK ? measure(s, scenario, "certified", 200, true, &r) : status;
}

static mote_status measure_all(study *s)
{
    static const char *const paper[] = {"tt", "mv", "ww"};
    static const char *const others[] = {"vv", "tw", "comb", "bunny"};
    const size_t other_count = s->quick ? 0 : sizeof others / sizeof others[0];
    mote_status status = MOTE_OK;
    (void)printf("%-8s %-36s %6s %7s %6s %8s  %-15s %8s %9s\n", "scene", "method", "appr.",
                 "passes", "deep", "%", "95 %", "depth/L", "us a step");
    for (size_t i = 0; i < 3 + other_count && status == MOTE_OK; ++i) {
        mote_scenario *scenario = NULL;
        status = mote_scenario_load(i < 3 ? paper[i] : others[i - 3], &scenario);
        if (status == MOTE_OK)
            status = i < 3 ? measure_scene(s, scenario) : measure_other(s, scenario);
        mote_scenario_destroy(scenario);
    }
    return status;
}

static mote_status write_study(const study *s, const char *directory)
{
    json_t *root = json_pack("{s:i, s:s, s:{s:[f,f], s:f, s:f, s:f}, s:O, s:O, s:b}", "schema",
                             1, "profile", s->quick ? "quick" : "full", "approach", "speed",
                             SLOWEST, FASTEST, "degrees", MOST_DEGREES, "aside", ASIDE, "apart",
                             APART, "rows", s->rows, "failures", s->failures, "met", s->met);
    (void)json_object_set_new(root, "claim", mote_claim_json(&s->claim));
    mote_text text = {0};
    mote_json_print(root, 17, &text);
    json_decref(root);
    char *path = mote_format("%s/dynamics.json", directory);
    const mote_status status = text.failed || !path
                                   ? mote_fail(MOTE_ENOMEM, "no memory for a study's figures")
                                   : mote_file_write(path, text.data, text.size);
    free(path);
    free(text.data);
    return status;
}

mote_status mote_study_dynamics(const char *directory, bool quick, bool *met)
{
    study s = {
        .quick = quick,
        .met = true,
        .claim = {.id = "dynamics",
                  .section = "4, 5",
                  .claim = "Even a very small number of particles (2-3; 3 to 5) is enough "
                           "to find the collision, so that bodies do not pass through "
                           "each other.",
                  .measured = "Share of random approaches in the closed loop with a run "
                              "of contacts that the method never reports; exact binomial "
                              "intervals (Clopper and Pearson)."}};
    mote_status status = mote_directory_make(directory);
    s.rows = json_array();
    s.failures = json_array();
    if (status == MOTE_OK)
        status = measure_all(&s);
    if (status == MOTE_OK) {
        (void)printf("\n");
        mote_claim_print(&s.claim);
        status = write_study(&s, directory);
    }
    json_decref(s.rows);
    json_decref(s.failures);
    mote_claim_free(&s.claim);
    if (status == MOTE_OK)
        *met = s.met;
    return status;
}
