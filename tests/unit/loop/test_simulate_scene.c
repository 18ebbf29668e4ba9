/* Several bodies in the closed loop: what is recorded, stored and refused. */
#include "harness/loop/contact_runs.h"
#include "harness/loop/simulate.h"

#include "harness/base/file.h"
#include "tests/support/folder.h"
#include "tests/support/mote.h"
#include "tests/support/solids.h"
#include "tests/support/test.h"

#include <unistd.h>

#define FILE_NAME "b.json"
#define FILM "film.gif"
#define TRACE "trace.json"
#define HEAD "frame,body,deformation,x,y,z,qw,qx,qy,qz\n"

static void write_file(const char *bodies)
{
    char *text =
        mote_format("{\"purpose\": \"a test\", \"frames\": 120, \"ask\": \"distance\",\n"
                    " \"bodies\": {%s}}\n",
                    bodies);
    assert_non_null(text);
    file_put(FILE_NAME, text);
    free(text);
}

/* Parses the pairs of a step: "0-1!" is a contact of bodies 0 and 1, "0-1" a near pair
   without. */
static size_t pairs_of(const char *text, mote_near_pair pairs[8])
{
    size_t count = 0;
    for (const char *c = text; *c; c += *c == ' ') {
        const bool contact = c[3] == '!';
        pairs[count++] = (mote_near_pair){
            .body = {(uint32_t)(c[0] - '0'), (uint32_t)(c[2] - '0')},
            .answer = {.has_contact = true, .contact = contact, .distance = contact ? 0 : 1}};
        c += contact ? 4 : 3;
    }
    return count;
}

/* The depth is the number of the second body. */
static mote_status depth_by_body(void *context, const uint32_t body[2], double above,
                                 double *depth)
{
    (void)context;
    *depth = fmax(above, 0.5 * body[1]);
    return MOTE_OK;
}

TEST(contact_runs_step_runs_of_several_pairs_are_kept_apart)
{
    static const char *const truth[] = {"0-1 2-3", "0-1! 2-3!", "0-1! 1-4! 2-3!", "0-1! 1-4",
                                        "0-1 1-4!"};
    static const char *const told[] = {"0-1! 2-3", "0-1 2-3!", "0-1! 1-4 2-3", "0-1!", "0-1"};
    mote_contact_runs runs = {.count = 0};
    for (uint32_t k = 0; k < 5; ++k) {
        mote_near_pair a[8], b[8];
        const size_t m = pairs_of(truth[k], a), n = pairs_of(told[k], b);
        assert_int_equal(mote_contact_runs_step(&runs, k, a, m, b, n, depth_by_body, NULL),
                         MOTE_OK);
    }
    mote_contact_runs_end(&runs);
    assert_int_equal(runs.contact_steps, 7);
    assert_int_equal(runs.missed_steps, 4); /* 0-1 at 1, 1-4 and 2-3 at 2, 1-4 at 4 */
    assert_int_equal(runs.false_steps, 1);
    assert_int_equal(runs.approaches, 4);
    assert_int_equal(runs.passes, 2); /* 1-4, twice */
    assert_int_equal(runs.deep_passes, 2);
    assert_int_equal(runs.delay_sum, 1);
    assert_int_equal(runs.delay_max, 1);
    assert_close(runs.depth_max, 2, 0);
    assert_close(runs.depth_passes, 2, 0);
    mote_contact_runs_free(&runs);
}

#define LETTERS                                                                                \
    "\"shapes\": [{\"letter\": \"V\", \"triangles\": 400, \"field\": {\"count\": 6, "          \
    "\"support\": 0.5, \"displacement\": {\"random\": {\"seed\": 5, \"amplitude\": 0.03, "     \
    "\"periods\": [40, 90]}}}}, {\"letter\": \"T\", \"triangles\": 400}]"

static mote_simulation_result simulate(const char *method, double restitution,
                                       mote_vec3 gravity)
{
    mote_bodies *bodies = NULL;
    mote_method_choice choice;
    mote_simulator *simulator = NULL;
    mote_simulation_result result;
    const mote_simulation_options options = {.density = 2,
                                             .restitution = restitution,
                                             .tolerance = 0.01,
                                             .gravity = gravity,
                                             .time_step = 1};
    if (mote_bodies_load(FILE_NAME, &bodies) != MOTE_OK ||
        mote_scene_choice_read(method, &choice) != MOTE_OK ||
        mote_simulator_create(&(mote_subject){.bodies = bodies}, &choice, &options,
                              &simulator) != MOTE_OK)
        fail_msg("%s: %s", method, mote_error_text());
    const mote_simulation_start start = mote_simulation_start_of(simulator);
    if (mote_simulator_run(simulator, &start, NULL, &result) != MOTE_OK)
        fail_msg("%s: %s", method, mote_error_text());
    mote_simulator_destroy(simulator);
    mote_bodies_destroy(bodies);
    assert_int_equal(result.steps, 119);
    assert_true(result.approaches > 0 && result.responses > 0 && result.bounces > 0);
    return result;
}

TEST(simulator_run_of_many_exact_methods_see_all_and_keep_the_invariants)
{
    static const char *const methods[] = {"certified", "aabb-tree", "certified:threads=2"};
    write_file("\"count\": 10, \"near_pairs\": 2, \"speed\": 0.03, \"spin\": 1, " LETTERS);
    mote_simulation_result r[3];
    for (int m = 0; m < 3; ++m) {
        r[m] = simulate(methods[m], 1, mote_vec3_make(0, 0, 0));
        assert_int_equal(r[m].missed_steps, 0);
        assert_int_equal(r[m].false_steps, 0);
        assert_int_equal(r[m].passes, 0);
        assert_true(r[m].energy_drift < 1e-12 && r[m].momentum_drift < 1e-13);
    }
    assert_int_equal(r[0].responses, r[2].responses);
    assert_int_equal(r[0].contact_steps, r[2].contact_steps);
}

/* The energy lost by impacts is recorded, and so is the energy gained from gravity. */
TEST(simulator_run_of_many_losses_and_gravity_are_booked)
{
    write_file("\"count\": 10, \"near_pairs\": 2, \"speed\": 0.03, \"spin\": 1, " LETTERS);
    const mote_simulation_result r = simulate("certified", 0.5, mote_vec3_make(0, -1e-3, 0));
    assert_true(r.energy_drift < 1e-11 && r.momentum_drift < 1e-11);
}

/* Particles that see contacts late or never: the missed ones are counted. */
TEST(simulator_run_of_many_one_particle_misses_contacts)
{
    write_file("\"count\": 10, \"near_pairs\": 2, \"speed\": 0.03, \"spin\": 1, " LETTERS);
    const mote_simulation_result r =
        simulate("particle-paper:n=1,refine=no", 1, mote_vec3_make(0, 0, 0));
    assert_true(r.missed_steps + r.false_steps > 0);
    assert_true(r.missed_steps <= r.contact_steps);
    assert_true(r.energy_drift < 1e-12 && r.momentum_drift < 1e-13);
}

TEST(mote_simulate_several_bodies_on_the_command_line)
{
    write_file("\"count\": 8, \"box\": 3, " LETTERS);
    mote_expect(0, "\"passes_through\": 0",
                "simulate " FILE_NAME " --method certified --steps 3 --json");
    mote_expect(0, "\"bodies\": 8",
                "simulate " FILE_NAME " --method certified --steps 3 --json");
    mote_expect(0, "8 bodies, 3 steps", "simulate " FILE_NAME " --method certified --steps 3");
    mote_expect(4, "no form for several bodies", "simulate " FILE_NAME " --method brute-force");
    mote_expect(4, "give n=", "simulate " FILE_NAME " --method particle");
    mote_expect(2, "at most 0.05", "simulate " FILE_NAME " --method certified --tolerance 0.2");
    mote_expect(2, "give frames", "simulate " FILE_NAME " --method certified --time-step 0");
    write_file("\"count\": 2, \"box\": 4, \"near\": 0.02, " LETTERS);
    mote_expect(4, "above near", "simulate " FILE_NAME " --method certified --tolerance 0.04");
    write_file("\"count\": 2, \"box\": 4, \"shapes\": [{\"file\": \"" MOTE_SOURCE_DIR
               "/datasets/meshes/teapot.obj\"}]");
    mote_expect(4, "shape 1 cannot respond", "simulate " FILE_NAME " --method certified");
}

/* The number after a key in the output. */
static double number_of(const char *key)
{
    const char *found = strstr(said, key);
    assert_non_null(found);
    return strtod(found + strlen(key), NULL);
}

/* Replayed as a scenario, certified finds the contacts that the simulation counted. */
TEST(mote_simulate_traces_of_several_bodies_are_scenarios)
{
    write_file("\"count\": 10, \"near_pairs\": 2, \"speed\": 0.03, \"spin\": 1, " LETTERS);
    mote_expect(0, "",
                "simulate " FILE_NAME " --method certified --steps 50 --time-step 1.5 "
                "--json --trace " TRACE);
    const double contacts = number_of("\"contact_steps\": "),
                 near = number_of("near_pairs\": ");
    assert_true(contacts > 0);
    mote_expect(0, "\"bodies\": 10", "check " TRACE " --json");
    assert_close(number_of("\"frames\": "), 51, 0);
    assert_close(number_of("\"pair_contacts\": "), contacts, 0);
    assert_close(number_of("\"near_pairs\": "), near, 1e-12 * near);
    mote_expect(0, "10 bodies", "run " TRACE " --method certified --replicates 1 --out traced");
    /* A scenario elsewhere may use "like" on it: the poses are still found. */
    static const char like[] = "{\"purpose\": \"a test\", \"like\": \"../" TRACE "\"}\n";
    assert_int_equal(mote_directory_make("other"), MOTE_OK);
    assert_int_equal(mote_file_write("other/like.json", like, strlen(like)), MOTE_OK);
    mote_expect(0, "10 bodies, 51 frames", "--allow . check other/like.json");
    /* A simulation of it starts from the same state. */
    mote_expect(0, "10 bodies, 3 steps", "simulate " TRACE " --method certified --steps 3");
}

/* A file of poses that is incomplete or belongs to other bodies is refused with its line. */
TEST(mote_bodies_load_poses_that_are_wrong_are_refused)
{
    static const char *const cases[][2] = {
        {"", "p.csv:1: not the columns"},
        {HEAD "1,1,1,0,0,0,1,0,0,0\n", "p.csv:3: not a pose; expected frame 1, body 2"},
        {HEAD "1,1,1,0,0,0,0,0,0,0\n", "p.csv:2: not a pose"},
        {HEAD "1,1,1,0,0,1e9,1,0,0,0\n", "p.csv:2: not a pose"},
        {HEAD "1,1,1,0,0,0,1,0,0,0\n1,2,1,3,0,0,1,0,0,0\n1,3,1,0,0,0,1,0,0,0\n",
         "p.csv:4: more rows than 1 frames of 2 bodies"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; ++k) {
        char *text = mote_format("{\"purpose\": \"a test\", \"frames\": 1, \"ask\": "
                                 "\"distance\", \"bodies\": {\"count\": 2, \"box\": 9, "
                                 "\"poses\": \"p.csv\", %s}}\n",
                                 LETTERS);
        assert_int_equal(mote_file_write(FILE_NAME, text, strlen(text)), MOTE_OK);
        assert_int_equal(mote_file_write("p.csv", cases[k][0], strlen(cases[k][0])), MOTE_OK);
        mote_expect(4, cases[k][1], "check " FILE_NAME);
        free(text);
    }
    write_file("\"count\": 2, \"near_pairs\": 1, \"poses\": \"p.csv\", " LETTERS);
    mote_expect(4, "poses go with a box", "check " FILE_NAME);
    /* Without --allow a scenario reads no file outside its folder. */
    write_file("\"count\": 2, \"box\": 9, \"poses\": \"/etc/passwd\", " LETTERS);
    mote_expect(4, "--allow", "check " FILE_NAME);
}

/* Pictures of eight bodies, also when a contact is reported. */
TEST(mote_simulate_films_several_bodies)
{
    char *gif = NULL;
    size_t size = 0;
    write_file("\"count\": 8, \"box\": 3, " LETTERS);
    mote_expect(0, "8 bodies",
                "simulate " FILE_NAME " --method certified --steps 3 --film " FILM);
    assert_int_equal(mote_file_read(FILM, 1 << 24, &gif, &size), MOTE_OK);
    assert_memory_equal(gif, "GIF89a", 6);
    free(gif);
    assert_int_equal(unlink(FILM), 0);
    assert_int_not_equal(access(FILM ".frames", F_OK), 0);
}

TEST(mote_simulate_refuses_a_film_of_one_body)
{
    write_file("\"count\": 1, \"box\": 3, " LETTERS);
    mote_expect(4, "a film is of two bodies or more",
                "simulate " FILE_NAME " --method certified --steps 3 --film " FILM);
    assert_int_not_equal(access(FILM, F_OK), 0);
}

/* Morph targets in flights, whose first impacts come within a frame of each other. */
TEST(mote_simulate_flies_bodies_with_morph_targets)
{
    mote_expect(0, "2 bodies, 60 steps",
                "simulate morph --method certified --step 7 --steps 60 --tolerance 0.02");
}

/* Farther apart than scenarios require, but nearer than this contact's distance. */
TEST(mote_simulate_bodies_that_start_in_contact_are_refused)
{
    write_file("\"count\": 40, \"near_pairs\": 5, " LETTERS);
    mote_expect(4, "start in contact",
                "simulate " FILE_NAME " --method certified --tolerance 0.05");
}
