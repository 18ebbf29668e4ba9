/* The closed loop: its records against independent truth, what it stores, and what it
   refuses. */
#include "harness/loop/simulate.h"

#include "core/body/triangle.h"
#include "harness/base/file.h"
#include "harness/loop/film.h"
#include "harness/scene/motion.h"
#include "harness/loop/penetration.h"
#include "harness/loop/trace.h"
#include "harness/run/truth.h"
#include "tests/support/folder.h"
#include "tests/support/mote.h"
#include "tests/support/solids.h"
#include "tests/support/test.h"

#include <sys/stat.h>
#include <unistd.h>

#define FILE_NAME "s.json"
#define ONE "one.json"
#define TRACE "trace.json"
#define FILM "film.gif"

/* A deforming V flies at a turning T; the %s are further keys of the V and of the scenario. */
static const char form[] =
    "{\"purpose\": \"a test\", \"frames\": 160, \"ask\": \"distance\"%s,\n"
    " \"bodies\": [{\"letter\": \"T\", \"triangles\": 400, \"velocity\": [0, 0, 0],\n"
    "   \"spin\": [0, 0.7, 0]},\n"
    "  {\"letter\": \"V\", \"triangles\": 400, \"field\": {\"count\": 6, \"support\": 0.5,\n"
    "   \"displacement\": {\"random\": {\"seed\": 5, \"amplitude\": 0.05, \"periods\": [40, "
    "90]}}},\n"
    "   \"motion\": [{\"frame\": 1, \"position\": [%s]}], %s}]}\n";
#define FLYING "\"velocity\": [-0.012, 0, 0], \"spin\": [1, 0, 0.4]"

static mote_scenario *load(const char *more, const char *position, const char *motion)
{
    char *text = mote_format(form, more, position, motion);
    mote_scenario *scenario = NULL;
    assert_non_null(text);
    file_put(FILE_NAME, text);
    free(text);
    if (mote_scenario_load(FILE_NAME, &scenario) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    return scenario;
}

static mote_simulation_options options_of(mote_scenario *scenario)
{
    return mote_default_simulation_options(&(mote_subject){.scenario = scenario});
}

static mote_simulator *simulator_of(mote_scenario *scenario, const mote_method_choice *m,
                                    const mote_simulation_options *options)
{
    mote_simulator *simulator = NULL;
    if (mote_simulator_create(&(mote_subject){.scenario = scenario}, m, options, &simulator) !=
        MOTE_OK)
        fail_msg("%s", mote_error_text());
    return simulator;
}

static mote_method_choice choice_of(const char *text)
{
    mote_method_choice choice;
    if (mote_method_choice_read(text, &choice) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    return choice;
}

/* A method whose answer the test prescribes: contact or not, a distance, an error, or
   nothing. */
static bool told;
static enum { SAY_CONTACT, SAY_DISTANCE, SAY_NOTHING, SAY_ERROR } told_form;

static mote_traits told_traits(const double *values)
{
    (void)values;
    return (mote_traits){0};
}

static mote_status told_create(const mote_setup *setup, void **state)
{
    (void)setup;
    *state = NULL;
    return MOTE_OK;
}

static void told_destroy(void *state)
{
    (void)state;
}

static mote_status told_query(void *state, const mote_frame *frame, mote_answer *answer)
{
    (void)state;
    (void)frame;
    if (told_form == SAY_ERROR)
        return mote_fail(MOTE_ENUMERIC, "told to fail");
    answer->has_contact = told_form == SAY_CONTACT;
    answer->contact = told;
    answer->has_distance = told_form == SAY_DISTANCE;
    answer->distance = told ? 0 : 1;
    answer->has_witness = told_form == SAY_DISTANCE; /* both at the origin: no normal */
    return MOTE_OK;
}

static const mote_method told_method = {.name = "told",
                                        .traits = told_traits,
                                        .create = told_create,
                                        .destroy = told_destroy,
                                        .query = told_query};

static mote_simulation_result run_of(mote_scenario *scenario, const mote_method_choice *choice,
                                     const mote_simulation_options *options,
                                     mote_rigid_state (*trace)[2])
{
    mote_simulator *simulator = simulator_of(scenario, choice, options);
    const mote_simulation_start start = mote_simulation_start_of(simulator);
    mote_simulation_result result;
    if (mote_simulator_run(simulator, &start, trace ? trace[0] : NULL, &result) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    mote_simulator_destroy(simulator);
    return result;
}

TEST(simulator_run_exact_methods_agree_and_miss_nothing)
{
    static const char *const methods[] = {"certified", "aabb-tree", "fcl-aabb"};
    mote_scenario *scenario = load("", "1.1, 0.1, 0", FLYING);
    const mote_simulation_options options = options_of(scenario);
    mote_rigid_state(*trace[3])[2];
    for (int i = 0; i < 3; ++i) {
        const mote_method_choice choice = choice_of(methods[i]);
        trace[i] = calloc(scenario->frames, sizeof *trace[i]);
        const mote_simulation_result r = run_of(scenario, &choice, &options, trace[i]);
        assert_int_equal(r.steps, 159);
        assert_true(r.approaches > 0 && r.responses > 0 && r.truth_asked < r.steps);
        assert_int_equal(r.passes + r.missed_steps + r.false_steps + r.delay_max, 0);
        assert_true(r.energy_drift < 1e-12 && r.momentum_drift < 1e-12);
        assert_true(r.angular_drift < 1e-12);
    }
    for (int i = 1; i < 3; ++i) {
        for (uint32_t k = 0; k < scenario->frames; ++k) {
            const mote_vec3 a = trace[0][k][1].centre, b = trace[i][k][1].centre;
            assert_true(mote_length(mote_sub(a, b)) < 1e-9 * scenario->length);
        }
    }
    for (int i = 0; i < 3; ++i)
        free(trace[i]);
    mote_scenario_destroy(scenario);
}

TEST(simulator_run_blind_method_passes_through)
{
    const mote_method_choice blind = {.method = &told_method, .text = "told"};
    told = false;
    mote_scenario *scenario = load("", "1.1, 0.1, 0", FLYING);
    const mote_simulation_options options = options_of(scenario);
    mote_rigid_state(*trace)[2] = calloc(scenario->frames, sizeof *trace);
    const mote_simulation_result r = run_of(scenario, &blind, &options, trace);
    assert_true(r.approaches > 0 && r.passes == r.approaches && r.deep_passes > 0);
    assert_true(r.depth_passes > 0.02 && r.depth_max == r.depth_passes);
    assert_int_equal(r.missed_steps, r.contact_steps);
    assert_int_equal(r.responses, 0);
    /* Replayed as a scenario, the truth, which has code of its own, finds the same contacts. */
    mote_simulator *simulator = simulator_of(scenario, &blind, &options);
    assert_int_equal(mote_trace_write(&(mote_subject){.scenario = scenario},
                                      mote_simulator_masses(simulator), trace[0],
                                      scenario->frames, &options, TRACE),
                     MOTE_OK);
    mote_scenario *replay = NULL;
    mote_truth *truth = NULL;
    assert_int_equal(mote_scenario_load(TRACE, &replay), MOTE_OK);
    assert_int_equal(replay->frames, scenario->frames);
    assert_int_equal(mote_truth_compute(replay, &truth), MOTE_OK);
    uint32_t contacts = 0, begins = 0;
    for (uint32_t k = 0; k < truth->frames; ++k) {
        contacts += truth->contact[k];
        begins += truth->contact[k] && (k == 0 || !truth->contact[k - 1]);
    }
    assert_int_equal(contacts, r.contact_steps);
    assert_int_equal(begins, r.approaches);
    for (uint32_t k = 0; k < replay->frames; ++k) {
        const mote_pose a = mote_rigid_pose(mote_simulator_masses(simulator) + 1, &trace[k][1]);
        const mote_pose b = mote_motion_pose(&replay->motion->body[1], k + 1.0);
        assert_true(mote_length(mote_sub(a.translation, b.translation)) <
                    1e-13 * replay->length);
        for (int i = 0; i < 9; ++i)
            assert_close(a.rotation.m[i / 3][i % 3], b.rotation.m[i / 3][i % 3], 1e-14);
    }
    mote_truth_destroy(truth);
    mote_scenario_destroy(replay);
    mote_simulator_destroy(simulator);
    mote_scenario_destroy(scenario);
    free(trace);
    assert_int_equal(unlink(TRACE), 0);
}

TEST(simulator_run_at_rest_stays)
{
    mote_scenario *scenario =
        load("", "1.1, 0, 0", "\"velocity\": [0, 0, 0], \"spin\": [0, 0, 0]");
    const mote_simulation_options options = options_of(scenario);
    const mote_method_choice choice = choice_of("certified");
    mote_rigid_state(*trace)[2] = calloc(scenario->frames, sizeof *trace);
    const mote_simulation_result r = run_of(scenario, &choice, &options, trace);
    assert_int_equal(r.contact_steps + r.responses, 0);
    assert_memory_equal(&trace[0][1].centre, &trace[159][1].centre, sizeof(mote_vec3));
    free(trace);
    mote_scenario_destroy(scenario);
}

TEST(simulator_run_gravity_and_restitution_are_accounted_for)
{
    mote_scenario *scenario = load("", "1.1, 0.1, 0", FLYING);
    mote_simulation_options options = options_of(scenario);
    options.gravity = mote_vec3_make(1e-5, -2e-5, 3e-5);
    options.restitution = 0.4;
    options.density = 7;
    const mote_method_choice choice = choice_of("certified");
    const mote_simulation_result r = run_of(scenario, &choice, &options, NULL);
    assert_true(r.responses > 0);
    assert_true(r.energy_drift < 1e-12 && r.momentum_drift < 1e-12 && isnan(r.angular_drift));
    mote_scenario_destroy(scenario);
}

TEST(simulator_run_refuses_with_reason)
{
    const mote_method_choice method = {.method = &told_method, .text = "told"};
    mote_simulation_result r = {.steps = 77};
    /* A contact without a normal. */
    told = true;
    mote_scenario *scenario = load("", "1.1, 0, 0", FLYING);
    const mote_simulation_options good = options_of(scenario);
    mote_simulator *simulator = simulator_of(scenario, &method, &good);
    mote_simulation_start start = mote_simulation_start_of(simulator);
    assert_int_equal(mote_simulator_run(simulator, &start, NULL, &r), MOTE_EUNSUPPORTED);
    assert_non_null(strstr(mote_error_text(), "witness"));
    mote_simulator_destroy(simulator);
    /* Options out of range. */
    mote_simulation_options bad[11] = {good, good, good, good, good, good,
                                       good, good, good, good, good};
    static const char *const says[] = {"density 0",        "density -1",      "tolerance 0",
                                       "tolerance",        "restitution",     "gravity",
                                       "time step 0",      "time step -0.5",  "time step",
                                       "restitution -0.1", "time step 1e+300"};
    bad[0].density = 0;
    bad[1].density = -1;
    bad[2].tolerance = 0;
    bad[3].tolerance = 0.06;
    bad[4].restitution = 2;
    bad[5].gravity.x = NAN;
    bad[6].time_step = 0;
    bad[7].time_step = -0.5;
    bad[8].time_step = NAN;
    bad[9].restitution = -0.1;
    bad[10].time_step = 1e300;
    for (int i = 0; i < 11; ++i) {
        assert_int_equal(mote_simulator_create(&(mote_subject){.scenario = scenario}, &method,
                                               &bad[i], &simulator),
                         MOTE_EINVAL);
        assert_non_null(strstr(mote_error_text(), says[i]));
    }
    mote_scenario_destroy(scenario);
    /* Bodies that start in contact. */
    told = false;
    scenario = load("", "0.05, 0, 0", FLYING);
    simulator = simulator_of(scenario, &method, &good);
    start = mote_simulation_start_of(simulator);
    assert_int_equal(mote_simulator_run(simulator, &start, NULL, &r), MOTE_EINVAL);
    assert_non_null(strstr(mote_error_text(), "start in contact"));
    assert_int_equal(r.steps, 77);
    mote_simulator_destroy(simulator);
    mote_scenario_destroy(scenario);
}

/* Anything else than an answer ends the simulation; a distance serves as well as a contact. */
TEST(simulator_run_needs_an_answer)
{
    static const struct {
        int form;
        bool told;
        mote_status status;
        const char *says;
    } cases[] = {{SAY_NOTHING, false, MOTE_EUNSUPPORTED, "neither distance nor contact"},
                 {SAY_ERROR, false, MOTE_ENUMERIC, "told to fail"},
                 {SAY_DISTANCE, false, MOTE_OK, ""},
                 {SAY_DISTANCE, true, MOTE_EUNSUPPORTED, "has given no witness points"}};
    const mote_method_choice method = {.method = &told_method, .text = "told"};
    mote_scenario *scenario = load(", \"tolerance\": 0.01", "1.1, 0, 0", FLYING);
    const mote_simulation_options options = options_of(scenario);
    assert_close(options.tolerance, 0.01, 1e-15);
    mote_simulator *simulator = simulator_of(scenario, &method, &options);
    mote_simulation_start start = mote_simulation_start_of(simulator);
    start.steps = 5;
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; ++k) {
        mote_simulation_result r = {.steps = 77};
        told_form = cases[k].form;
        told = cases[k].told;
        assert_int_equal(mote_simulator_run(simulator, &start, NULL, &r), cases[k].status);
        if (cases[k].status != MOTE_OK && !strstr(mote_error_text(), cases[k].says))
            fail_msg("case %zu: %s", k, mote_error_text());
        assert_int_equal(r.steps, cases[k].status == MOTE_OK ? 5 : 77);
    }
    told_form = SAY_CONTACT;
    mote_simulator_destroy(simulator);
    mote_simulator_destroy(NULL);
    mote_scenario_destroy(scenario);
}

/* A scenario of one frame has one shape, but its bodies still move. */
TEST(simulator_run_of_one_frame_moves_on)
{
    static const char text[] =
        "{\"purpose\": \"a test\", \"frames\": 1, \"like\": \"s.json\"}\n";
    mote_scenario_destroy(load("", "1.1, 0, 0", FLYING));
    assert_int_equal(mote_file_write(ONE, text, sizeof text - 1), MOTE_OK);
    mote_scenario *scenario = NULL;
    assert_int_equal(mote_scenario_load(ONE, &scenario), MOTE_OK);
    const mote_simulation_options options = options_of(scenario);
    const mote_method_choice choice = choice_of("certified");
    mote_simulator *simulator = simulator_of(scenario, &choice, &options);
    mote_simulation_start start = mote_simulation_start_of(simulator);
    start.steps = 30;
    mote_rigid_state(*trace)[2] = calloc(31, sizeof *trace);
    mote_simulation_result r;
    assert_int_equal(mote_simulator_run(simulator, &start, trace[0], &r), MOTE_OK);
    assert_int_equal(r.steps, 30);
    assert_close(trace[30][1].centre.x - trace[0][1].centre.x, 30 * trace[0][1].velocity.x,
                 1e-12);
    free(trace);
    mote_simulator_destroy(simulator);
    mote_scenario_destroy(scenario);
    assert_int_equal(unlink(ONE), 0);
}

/* Steps of half a frame and of two frames: the same paths until the first contact, and the same
   duration. */
TEST(simulator_run_time_step_keeps_the_pace)
{
    mote_scenario *scenario = load("", "1.1, 0.1, 0", FLYING);
    const mote_method_choice choice = choice_of("certified");
    mote_simulation_options options = options_of(scenario);
    mote_rigid_state(*trace[3])[2];
    static const double sizes[] = {1, 0.5, 2};
    static const uint32_t counts[] = {159, 318, 80};
    for (int i = 0; i < 3; ++i) {
        options.time_step = sizes[i];
        trace[i] = calloc(counts[i] + 1, sizeof *trace[i]);
        const mote_simulation_result r = run_of(scenario, &choice, &options, trace[i]);
        assert_int_equal(r.steps, counts[i]);
        assert_true(r.responses > 0 && r.approaches > 0 && r.passes == 0);
        assert_true(r.energy_drift < 1e-12 && r.momentum_drift < 1e-12);
    }
    for (uint32_t k = 0; k <= 20; k += 2) {
        for (int i = 1; i < 3; ++i) {
            const mote_rigid_state *a = &trace[0][k][1],
                                   *b = &trace[i][i == 1 ? 2 * k : k / 2][1];
            assert_true(mote_length(mote_sub(a->centre, b->centre)) < 1e-12 * scenario->length);
            const double turned = a->turn.w * b->turn.w + a->turn.x * b->turn.x +
                                  a->turn.y * b->turn.y + a->turn.z * b->turn.z;
            assert_close(fabs(turned), 1, 1e-6); /* of second order */
        }
    }
    for (int i = 0; i < 3; ++i)
        free(trace[i]);
    mote_scenario_destroy(scenario);
}

/* The winding number of a closed surface around p by solid angles (van Oosterom, Strackee). */
static double solid_angles(const mote_mesh *mesh, const mote_vec3 *world, mote_vec3 p)
{
    double sum = 0;
    for (uint32_t f = 0; f < mesh->triangle_count; ++f) {
        const uint32_t *t = mesh->triangles[f];
        const mote_vec3 a = mote_sub(world[t[0]], p), b = mote_sub(world[t[1]], p);
        const mote_vec3 c = mote_sub(world[t[2]], p);
        const double la = mote_length(a), lb = mote_length(b), lc = mote_length(c);
        sum += 2 * atan2(mote_dot(a, mote_cross(b, c)), la * lb * lc + mote_dot(a, b) * lc +
                                                            mote_dot(b, c) * la +
                                                            mote_dot(c, a) * lb);
    }
    return sum / (4 * 3.14159265358979323846);
}

static double depth_by_angles(mote_mesh *const mesh[2], mote_vec3 *const world[2])
{
    double deepest = 0;
    for (int i = 0; i < 2; ++i) {
        const mote_mesh *other = mesh[1 - i];
        for (uint32_t v = 0; v < mesh[i]->vertex_count; ++v) {
            const mote_vec3 p = world[i][v];
            if (fabs(solid_angles(other, world[1 - i], p)) < 0.5)
                continue;
            double nearest = HUGE_VAL;
            for (uint32_t f = 0; f < other->triangle_count; ++f) {
                mote_vec3 corner[3];
                for (int k = 0; k < 3; ++k)
                    corner[k] = world[1 - i][other->triangles[f][k]];
                nearest = fmin(nearest, mote_point_triangle(p, corner, NULL));
            }
            deepest = fmax(deepest, sqrt(nearest));
        }
    }
    return deepest;
}

TEST(penetration_depth_random_poses_as_by_solid_angles)
{
    uint64_t seed = 21;
    mote_mesh *mesh[2] = {solid_to_mesh(solid_torus(24, 12)),
                          solid_to_mesh(solid_icosphere(2))};
    mote_vec3 *world[2];
    mote_penetration *penetration = NULL;
    assert_int_equal(mote_penetration_create(mesh[0], mesh[1], &penetration), MOTE_OK);
    for (int i = 0; i < 2; ++i)
        world[i] = malloc(mesh[i]->vertex_count * sizeof *world[i]);
    int deep = 0;
    for (int trial = 0; trial < 60; ++trial) {
        for (int i = 0; i < 2; ++i) {
            /* Every third time axes stay parallel, so edges and vertices lie on the rays. */
            const mote_pose pose = {trial % 3 ? random_rotation_matrix(&seed)
                                              : (mote_mat3){{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
                                    mote_scale(random_vec3(&seed, 1.6), i)};
            for (uint32_t v = 0; v < mesh[i]->vertex_count; ++v)
                world[i][v] =
                    mote_pose_apply(&pose, mote_scale(mesh[i]->positions[v], i ? 0.6 : 1));
        }
        const double depth = mote_penetration_depth(penetration, world[0], world[1], 0);
        assert_close(depth, depth_by_angles(mesh, world), 1e-14);
        deep += depth > 0.01;
        /* Depths below `above` are not reported. */
        for (int part = -1; part <= 1; ++part) {
            const double above = depth * (1 + 0.1 * part) + 0.01 * (part > 0);
            const double found = mote_penetration_depth(penetration, world[0], world[1], above);
            assert_true(found == (part < 0 ? depth : above));
        }
    }
    assert_true(deep > 10 && deep < 60);
    mote_penetration_destroy(penetration);
    for (int i = 0; i < 2; ++i) {
        free(world[i]);
        mote_mesh_destroy(mesh[i]);
    }
}

/* When shifted along the ray, every vertex of one lies on rays through vertices of the
   other. */
TEST(penetration_depth_aligned_tori_ties_as_by_solid_angles)
{
    mote_mesh *mesh[2] = {solid_to_mesh(solid_torus(16, 8)), solid_to_mesh(solid_torus(16, 8))};
    mote_penetration *penetration = NULL;
    assert_int_equal(mote_penetration_create(mesh[0], mesh[1], &penetration), MOTE_OK);
    mote_vec3 *moved = malloc(mesh[1]->vertex_count * sizeof *moved);
    mote_vec3 *const world[2] = {mesh[0]->positions, moved};
    for (int i = 1; i < 8; ++i) {
        for (uint32_t v = 0; v < mesh[1]->vertex_count; ++v)
            moved[v] = mote_add(mesh[1]->positions[v], mote_vec3_make(0.06 * i, 0, 0));
        const double depth = mote_penetration_depth(penetration, world[0], world[1], 0);
        assert_close(depth, depth_by_angles(mesh, world), 1e-14);
        assert_true(depth > 0.01);
    }
    free(moved);
    mote_penetration_destroy(penetration);
    mote_mesh_destroy(mesh[0]);
    mote_mesh_destroy(mesh[1]);
}

TEST(command_simulate_json_has_the_keys)
{
    static const char *const keys[] = {"steps",           "approaches",   "passes_through",
                                       "max_penetration", "energy_drift", "momentum_drift"};
    mote_scenario_destroy(load("", "1.1, 0.1, 0", FLYING));
    mote_expect(0, "\"passes_through\": 0,",
                "simulate " FILE_NAME " --method certified --json");
    for (size_t i = 0; i < sizeof keys / sizeof keys[0]; ++i) {
        char quoted[64];
        (void)snprintf(quoted, sizeof quoted, "\"%s\":", keys[i]);
        if (!strstr(said, quoted))
            fail_msg("no %s in %s", keys[i], said);
    }
}

/* The film is a GIF of nine pictures, and nothing else is left. */
TEST(command_simulate_film_is_a_gif)
{
    static const unsigned char control[] = {0x21, 0xf9, 0x04};
    char *gif;
    size_t size, pictures = 0;
    mote_scenario_destroy(load("", "1.1, 0.1, 0", FLYING));
    mote_expect(0, "",
                "simulate " FILE_NAME " --method particle-paper:n=3 --steps 8 --film " FILM);
    assert_int_equal(mote_file_read(FILM, 1 << 24, &gif, &size), MOTE_OK);
    assert_memory_equal(gif, "GIF89a", 6);
    for (size_t i = 0; i + sizeof control <= size; ++i)
        pictures += memcmp(gif + i, control, sizeof control) == 0;
    assert_true(pictures >= 9);
    free(gif);
    assert_int_not_equal(access(FILM ".frames", F_OK), 0);
}

/* Where the film cannot be written, the trace still is. */
TEST(command_simulate_keeps_the_trace_without_a_film)
{
    mote_scenario_destroy(load("", "1.1, 0.1, 0", FLYING));
    assert_int_equal(mkdir("taken.gif", 0700), 0);
    mote_expect(4, "taken.gif",
                "simulate " FILE_NAME
                " --method particle-paper:n=3 --steps 8 --film taken.gif --trace kept.json");
    assert_int_equal(access("kept.json", F_OK), 0);
    assert_int_equal(unlink("kept.json"), 0);
    assert_int_equal(rmdir("taken.gif"), 0);
}

/* More steps with a contact than a film has pictures, bodies above each other or in one place,
   and a method without witnesses: gnuplot can read the pictures, and there are at most twice as
   many. */
TEST(film_watch_of_odd_steps_keeps_its_bounds)
{
    static const char *const places[] = {"0, 0, 0", "0, 2, 0"};
    const mote_method_choice choice = choice_of("certified");
    for (size_t p = 0; p < 2; ++p) {
        mote_scenario *scenario = load("", places[p], FLYING);
        mote_film *film = NULL;
        mote_engine *probe = NULL;
        mote_frame_buffer *buffer = NULL;
        const mote_near_pair none = {.body = {0, 1}};
        char name[64], *text = NULL;
        size_t size = 0;
        const mote_simulation_options options = options_of(scenario);
        mote_simulator *simulator = simulator_of(scenario, &choice, &options);
        assert_int_equal(mote_film_create(simulator, "certified", 1000, FILM, &film), MOTE_OK);
        assert_int_equal(mote_engine_open_two(&scenario->body[0], &scenario->body[1], &choice,
                                              scenario->ask, 0, 1, &probe),
                         MOTE_OK);
        buffer = mote_frame_buffer_create(scenario);
        mote_simulation_view view = {.said = &none, .said_count = 1, .method = probe};
        view.states = mote_scenario_frame(scenario, buffer, 1, 0)->body;
        for (view.step = 0; view.step < (p == 0 ? 500 : 3); ++view.step) {
            view.contact = view.step % 2 == 1;
            assert_int_equal(mote_film_watch(film, &view), MOTE_OK);
        }
        (void)snprintf(name, sizeof name, FILM ".frames/%03u.dat", p == 0 ? 239 : 1);
        assert_int_equal(mote_file_read(name, 1 << 24, &text, &size), MOTE_OK);
        assert_non_null(strstr(text, p == 0 ? "1 0 4" : "1 0 1"));
        const char *middle = strstr(text, "NaN NaN NaN\n\n\nNaN NaN NaN\n\n\nNaN NaN NaN\n");
        assert_non_null(middle); /* no particles, no closest points */
        assert_true(strstr(text, "nan") == NULL && strstr(text, "inf") == NULL);
        assert_int_not_equal(access(FILM ".frames/240.dat", F_OK), 0);
        free(text);
        mote_film_destroy(film);
        assert_int_not_equal(access(FILM ".frames", F_OK), 0);
        mote_frame_buffer_destroy(buffer);
        mote_engine_destroy(probe);
        mote_simulator_destroy(simulator);
        mote_scenario_destroy(scenario);
    }
}
