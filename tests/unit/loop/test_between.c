/* Steps of several frames: the bodies follow the same paths as frame by frame, continuous steps
   let nothing pass or intersect where sampled ones do, and resting contact does not stall. The
   truth, which a tree of boxes tells, looks four times a frame. */
#include "harness/loop/simulate.h"
#include "harness/loop/simulate_print.h"

#include "harness/base/file.h"
#include "tests/support/folder.h"
#include "tests/support/mote.h"
#include "tests/support/solids.h"
#include "tests/support/test.h"

#define FILE_NAME "s.json"

/* A thin plate in the way of a V; %s: fields of either, then the velocity and spin of the V. */
static const char form[] =
    "{\"purpose\": \"a test\", \"frames\": 181, \"ask\": \"distance\",\n"
    " \"bodies\": [{\"letter\": \"T\", \"triangles\": 400%s, \"velocity\": [0, 0, 0],\n"
    "   \"spin\": [0, 0, 0]},\n"
    "  {\"letter\": \"V\", \"triangles\": 400%s,\n"
    "   \"motion\": [{\"frame\": 1, \"position\": [%s]}], \"velocity\": [%s],\n"
    "   \"spin\": [%s]}]}\n";

#define FIELD                                                                                  \
    ", \"field\": {\"count\": 6, \"support\": 0.5, \"displacement\": {\"random\": "            \
    "{\"seed\": 5, \"amplitude\": 0.05, \"periods\": [40, 90]}}}"

static mote_scenario *load(const char *field, const char *position, const char *velocity,
                           const char *spin)
{
    char *text = mote_format(form, field, field, position, velocity, spin);
    mote_scenario *scenario = NULL;
    file_put(FILE_NAME, text);
    free(text);
    if (mote_scenario_load(FILE_NAME, &scenario) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    return scenario;
}

typedef struct setting {
    double step;
    mote_simulation_steps within;
    double restitution;
    mote_vec3 gravity;
    uint32_t steps; /* 0: all frames */
} setting;

static mote_simulation_result run(const mote_subject *subject, const setting *set,
                                  mote_rigid_state *trace)
{
    mote_simulation_options options = mote_default_simulation_options(subject);
    mote_simulator *simulator = NULL;
    mote_method_choice choice;
    mote_simulation_result result;
    options.time_step = set->step;
    options.within = set->within;
    options.restitution = set->restitution;
    options.gravity = set->gravity;
    assert_int_equal(mote_method_choice_read("certified", &choice), MOTE_OK);
    if (mote_simulator_create(subject, &choice, &options, &simulator) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    mote_simulation_start start = mote_simulation_start_of(simulator);
    start.steps = set->steps > 0 ? set->steps : start.steps;
    if (mote_simulator_run(simulator, &start, trace, &result) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    mote_simulator_destroy(simulator);
    return result;
}

static mote_simulation_result run_pair(mote_scenario *scenario, setting set)
{
    return run(&(mote_subject){.scenario = scenario}, &set, NULL);
}

/* A V that flies through the T within a step: it is on the other side before anybody looks. */
TEST(simulator_run_sampled_passes_and_continuous_does_not)
{
    static const char *const fields[] = {"", FIELD};
    for (int f = 0; f < 2; ++f) {
        mote_scenario *scenario =
            load(fields[f], "0.1, 0.1, 1.5", "0, 0, -0.06", f ? "0.3, 1, 0.4" : "0, 0, 0");
        const mote_simulation_result sampled = run_pair(
            scenario, (setting){.step = 60, .within = MOTE_STEPS_SAMPLED, .restitution = 1});
        assert_true(sampled.passes > 0 && sampled.intersections > 0);
        assert_int_equal(sampled.responses + sampled.impacts, 0);
        static const double steps[] = {1, 7.5, 60};
        for (int k = 0; k < 3; ++k) {
            const mote_simulation_result r = run_pair(
                scenario,
                (setting){.step = steps[k], .within = MOTE_STEPS_CONTINUOUS, .restitution = 1});
            assert_true(r.impacts > 0 && r.responses > 0 && r.approaches > 0);
            assert_int_equal(r.passes + r.intersections + r.unproven + r.false_steps, 0);
            assert_true(!(r.depth_max > 0));
            assert_true(r.energy_drift < 1e-6 && r.momentum_drift < 1e-12);
            assert_true(r.angular_drift < 1e-12);
        }
        mote_scenario_destroy(scenario);
    }
}

/* A V that turns by 50 degrees a frame follows arcs, on which its arms meet the T. */
TEST(simulator_run_of_fast_spins_lets_nothing_pass)
{
    static const double steps[] = {1, 7.5};
    mote_scenario *scenario = load("", "0.1, 0.1, 1.5", "0, 0, -0.06", "5, 50, 3");
    for (size_t k = 0; k < ROWS_OF(steps); ++k) {
        const mote_simulation_result r =
            run_pair(scenario, (setting){.step = steps[k],
                                         .within = MOTE_STEPS_CONTINUOUS,
                                         .restitution = 1,
                                         .steps = (uint32_t)(60 / steps[k])});
        test_row("steps of %g frames", steps[k]);
        assert_true(r.impacts > 0 && r.responses > 0);
        assert_int_equal(r.passes + r.intersections + r.unproven + r.false_steps, 0);
        assert_true(!(r.depth_max > 0));
        assert_true(r.momentum_drift < 1e-12);
    }
    mote_scenario_destroy(scenario);
}

/* Without an impact, all steps follow the same path as single frames do. */
TEST(simulator_run_between_impacts_nothing_depends_on_the_step)
{
    mote_scenario *scenario = load(FIELD, "3, 0.1, 0", "0, 0.01, 0", "1, 2, 0.4");
    const mote_subject subject = {.scenario = scenario};
    mote_rigid_state whole[181][2], long_steps[7][2];
    const setting frames = {.step = 1, .restitution = 1};
    const setting thirty = {.step = 30, .within = MOTE_STEPS_CONTINUOUS, .restitution = 1};
    const mote_simulation_result a = run(&subject, &frames, whole[0]);
    const mote_simulation_result b = run(&subject, &thirty, long_steps[0]);
    assert_int_equal(a.steps, 180);
    assert_int_equal(b.steps, 6);
    assert_int_equal(a.responses + b.responses, 0);
    for (int k = 0; k <= 6; ++k) {
        const mote_rigid_state *p = &whole[30 * k][1], *q = &long_steps[k][1];
        assert_true(mote_length(mote_sub(p->centre, q->centre)) < 1e-12);
        assert_close(fabs(p->turn.w * q->turn.w + p->turn.x * q->turn.x +
                          p->turn.y * q->turn.y + p->turn.z * q->turn.z),
                     1, 1e-12);
    }
    mote_scenario_destroy(scenario);
}

/* Bodies that stick together and are drawn to each other: there is no end of impacts. */
TEST(simulator_run_resting_contact_goes_on)
{
    mote_scenario *scenario = load(FIELD, "0.05, 1.1, 0.02", "0, -0.01, 0", "0, 0, 0");
    const mote_simulation_result r =
        run_pair(scenario, (setting){.step = 10, .within = MOTE_STEPS_CONTINUOUS});
    assert_true(r.impacts > 0);
    assert_int_equal(r.steps, 18);
    assert_int_equal(r.passes + r.intersections, 0);
    mote_scenario_destroy(scenario);
}

#define LETTERS                                                                                \
    "\"shapes\": [{\"letter\": \"V\", \"triangles\": 400, \"field\": {\"count\": 6, "          \
    "\"support\": 0.5, \"displacement\": {\"random\": {\"seed\": 5, \"amplitude\": 0.03, "     \
    "\"periods\": [40, 90]}}}}, {\"letter\": \"T\", \"triangles\": 400}]"

/* Many bodies in a box too small for them, sticking together: floors are needed and reported.
 */
TEST(simulator_run_of_many_continuous)
{
    file_put(FILE_NAME, "{\"purpose\": \"a test\", \"frames\": 90, \"ask\": \"distance\",\n"
                        " \"bodies\": {\"count\": 10, \"near_pairs\": 2, \"speed\": 0.03, "
                        "\"spin\": 1, " LETTERS "}}\n");
    mote_bodies *bodies = NULL;
    assert_int_equal(mote_bodies_load(FILE_NAME, &bodies), MOTE_OK);
    const mote_subject subject = {.bodies = bodies};
    setting set = {.step = 15, .within = MOTE_STEPS_SAMPLED, .restitution = 1};
    const mote_simulation_result sampled = run(&subject, &set, NULL);
    assert_true(sampled.passes > 0 && sampled.intersections > 0);
    set.within = MOTE_STEPS_CONTINUOUS;
    for (int k = 0; k < 2; ++k) {
        set.restitution = k;
        const mote_simulation_result r = run(&subject, &set, NULL);
        assert_true(r.impacts > 3 && r.bounces > 0 && r.near_pairs > 0);
        assert_int_equal(r.passes + r.intersections + r.unproven, 0);
        assert_true(k == 1 || r.pushes > 0);
        assert_true(r.momentum_drift < 1e-12 && r.energy_drift < 1e-4);
    }
    mote_bodies_destroy(bodies);
}

TEST(simulator_run_continuous_refuses_with_reason)
{
    mote_scenario *scenario = load("", "3, 0.1, 0", "0, 0.01, 0", "1, 2, 0.4");
    const mote_subject subject = {.scenario = scenario};
    mote_simulation_options options = mote_default_simulation_options(&subject);
    mote_simulator *simulator = NULL;
    mote_method_choice choice;
    options.within = MOTE_STEPS_CONTINUOUS;
    assert_int_equal(mote_method_choice_read("aabb-tree", &choice), MOTE_OK);
    assert_int_equal(mote_simulator_create(&subject, &choice, &options, &simulator),
                     MOTE_EUNSUPPORTED);
    assert_non_null(strstr(mote_error_text(), "certified"));
    assert_null(simulator);
    mote_scenario_destroy(scenario);
}

/* Files from before there were paths lack their figures; those count as none. */
TEST(simulation_read_takes_older_files)
{
    const mote_simulation_result result = {.steps = 5, .impacts = 3, .intersections = 2};
    json_t *object = mote_simulation_json("s", 2, "m", &result);
    mote_simulation_result back = {.steps = 0};
    assert_true(mote_simulation_read(object, &back));
    assert_int_equal(back.impacts, 3);
    assert_int_equal(json_object_del(object, "impacts"), 0);
    assert_true(mote_simulation_read(object, &back));
    assert_int_equal(back.impacts, 0);
    assert_int_equal(json_object_del(object, "responses"), 0);
    assert_false(mote_simulation_read(object, &back));
    json_decref(object);
}

TEST(command_simulate_step_tells_what_it_did_and_what_does_not_fit)
{
    mote_scenario_destroy(load("", "0.1, 0.1, 1.5", "0, 0, -0.06", "0, 0, 0"));
    mote_expect(0, "impacts between steps 2", "simulate s.json --method certified --step 60");
    mote_expect(0, "\"impacts\": 2", "simulate s.json --method certified --step 60 --json");
    mote_expect(0, "passes through 1",
                "simulate s.json --method certified --step 60 --sampled");
    mote_expect(2, "--time-step", "simulate s.json --method certified --step 9 --time-step 2");
    mote_expect(2, "--step K", "simulate s.json --method certified --sampled");
    mote_expect(2, "give frames", "simulate s.json --method certified --step many");
    mote_expect(2, "above 0 and at most 1000", "simulate s.json --method certified --step 0");
    mote_expect(2, "above 0 and at most 1000",
                "simulate s.json --method certified --step 1001");
    mote_expect(4, "choose certified", "simulate s.json --method aabb-tree --step 3");
}
