/* The data of the page's replay, read back as the page reads it. */
#include "harness/scene/probe.h"
#include "harness/report/replay.h"
#include "tests/support/program.h"
#include "tests/support/test.h"

#include <stddef.h>

#include <math.h>

#define FRAMES 5u

static char base[] = "/tmp/mote-test-replay-XXXXXX";
static char scenario_path[96], run_directory[96];
static mote_report report;

/* The tracks as a run orders them. */
enum { CERTIFIED, TRACKED, PAPER, PAPER_CHECKED, TRACKS };

static int make_run(void)
{
    static const char scenario[] =
        "{\"purpose\": \"p\", \"like\": \"mv\", \"frames\": 5, \"pace\": 149.75,\n"
        " \"warmup\": null, \"active\": null}\n";
    char line[512], said[96];
    if (!mkdtemp(base))
        return -1;
    (void)snprintf(run_directory, sizeof run_directory, "%s/run", base);
    (void)snprintf(scenario_path, sizeof scenario_path, "%s/five.json", base);
    (void)snprintf(said, sizeof said, "%s/said", base);
    if (mote_file_write(scenario_path, scenario, strlen(scenario)) != MOTE_OK)
        return -1;
    (void)snprintf(
        line, sizeof line,
        "run %s --out %s --method certified --method particle-paper:n=3,refine=no|near "
        "--method particle:n=3",
        scenario_path, run_directory);
    if (program_wait(program_start(line, said)) != 0)
        return -1;
    return mote_report_gather(run_directory, &report) == MOTE_OK ? 0 : -1;
}

static int remove_base(void)
{
    mote_report_free(&report);
    return program_remove(base);
}

TEST_GROUP(make_run, remove_base);

static void assert_near(double a, double b, double tolerance)
{
    if (!(fabs(a - b) <= tolerance))
        fail_msg("%.17g is not within %g of %.17g", a, tolerance, b);
}

/* Decodes the base 64 of a member; *size its bytes. The caller frees it. */
static void *decode(const json_t *object, const char *key, size_t *size)
{
    static const char digits[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const char *text = json_string_value(json_object_get(object, key));
    assert_non_null(text);
    unsigned char *bytes = malloc(strlen(text) + 1);
    assert_non_null(bytes);
    unsigned long bits = 0;
    size_t count = 0, used = 0;
    for (; *text && *text != '='; ++text) {
        const char *digit = strchr(digits, *text);
        assert_non_null(digit);
        bits = bits << 6 | (unsigned long)(digit - digits);
        if (++count % 4 != 1)
            bytes[used++] = (unsigned char)(bits >> (6 - 2 * ((count - 1) % 4)));
    }
    *size = used;
    return bytes;
}

static json_t *read_scenes(size_t *shown)
{
    mote_text text = {0};
    json_error_t error;
    assert_int_equal(mote_replay_json(&report, &text, shown), MOTE_OK);
    json_t *root = json_loads(text.data, 0, &error);
    if (!root)
        fail_msg("%d: %s", error.line, error.text);
    assert_null(strchr(text.data, '<'));
    free(text.data);
    return root;
}

static json_t *first_scene(const json_t *root)
{
    json_t *scene = json_array_get(json_object_get(root, "scenes"), 0);
    assert_non_null(scene);
    return scene;
}

TEST(replay_json_holds_the_poses_and_weights_of_each_frame)
{
    size_t shown, size;
    json_t *root = read_scenes(&shown);
    assert_int_equal(shown, 1);
    mote_scenario *scenario;
    mote_frame_buffer *buffer;
    assert_int_equal(mote_scenario_load(scenario_path, &scenario), MOTE_OK);
    assert_int_equal(mote_frame_buffer_create(scenario, &buffer), MOTE_OK);
    for (size_t i = 0; i < 2; ++i) {
        const json_t *body = json_array_get(json_object_get(first_scene(root), "bodies"), i);
        float *poses = decode(body, "poses", &size);
        assert_int_equal(size, FRAMES * 12 * sizeof *poses);
        int16_t *weights = decode(body, "weights", &size);
        const size_t width = 3 * (size_t)scenario->body[i].field->count;
        assert_true(width > 0);
        assert_int_equal(size, FRAMES * width * sizeof *weights);
        const double step = json_number_value(json_object_get(body, "weightStep"));
        for (uint32_t k = 0; k < FRAMES; ++k) {
            const mote_body_state *at =
                &mote_scenario_frame(scenario, buffer, k + 1, 0)->body[i];
            assert_near((double)poses[12 * k + 9], at->pose.translation.x, 1e-6);
            assert_near((double)poses[12 * k + 5], at->pose.rotation.m[1][2], 1e-6);
            const mote_vec3 w = {at->weights.x[1], at->weights.y[1], at->weights.z[1]};
            const mote_vec3 rest = mote_rotate_back(&at->pose.rotation, w);
            assert_near(step * weights[width * k + 4], rest.y, step);
        }
        free(poses);
        free(weights);
    }
    mote_frame_buffer_destroy(buffer);
    mote_scenario_destroy(scenario);
    json_decref(root);
}

TEST(replay_json_holds_the_stored_answers)
{
    size_t shown, size;
    json_t *root = read_scenes(&shown);
    const json_t *tracks = json_object_get(first_scene(root), "tracks");
    assert_int_equal(json_array_size(tracks), TRACKS);
    for (size_t t = 0; t < TRACKS; ++t) {
        const mote_stored_cell *cell = &report.cells.rows[t].cells[0];
        const json_t *track = json_array_get(tracks, t);
        assert_string_equal(json_string_value(json_object_get(track, "cell")), cell->id);
        double *distances = decode(track, "distance", &size);
        assert_int_equal(size, FRAMES * sizeof *distances);
        for (size_t k = 0; k < FRAMES; ++k) {
            const double length = mote_stored_number(cell, "length");
            assert_true((distances[k] - cell->truth[k]) / length == cell->error[k]);
        }
        free(distances);
    }
    json_decref(root);
}

/* The method's points are its distance apart, on a grid of 2^16 steps over the scene. */
TEST(replay_json_pairs_are_their_distance_apart)
{
    size_t shown, size;
    json_t *root = read_scenes(&shown);
    const json_t *scene = first_scene(root);
    const json_t *track = json_array_get(json_object_get(scene, "tracks"), 0);
    const double step = json_number_value(json_object_get(scene, "step"));
    double *distances = decode(track, "distance", &size);
    uint16_t *places = decode(track, "pair", &size);
    assert_int_equal(size, FRAMES * 6 * sizeof *places);
    for (size_t k = 0; k < FRAMES; ++k) {
        double squared = 0;
        for (size_t c = 0; c < 3; ++c)
            squared += pow(step * (places[6 * k + c] - places[6 * k + 3 + c]), 2);
        assert_near(sqrt(squared), distances[k], 4 * step);
    }
    free(distances);
    free(places);
    json_decref(root);
}

/* With and without the exact check the particles are the same: they are stored once. */
TEST(replay_json_particles_are_stored_once)
{
    size_t shown, size;
    json_t *root = read_scenes(&shown);
    json_t *sets = json_object_get(first_scene(root), "particles");
    assert_int_equal(json_object_size(sets), 2); /* the tracked ones are others */
    const json_t *tracks = json_object_get(first_scene(root), "tracks");
    for (size_t t = PAPER; t <= PAPER_CHECKED; ++t)
        assert_int_equal(
            json_integer_value(json_object_get(json_array_get(tracks, t), "particles")), PAPER);
    uint16_t *places = decode(sets, "2", &size);
    assert_int_equal(size, FRAMES * 2 * 3 * 3 * sizeof *places);
    free(places);
    json_decref(root);
}

/* Room for the meshes and motion alone, then for one track more, then for nothing. */
TEST(replay_write_of_a_small_budget_leaves_out_and_names)
{
    mote_replay_scene scene;
    assert_int_equal(mote_replay_load(&report, 0, report.cells.count, &scene), MOTE_OK);
    mote_text all = {0}, less = {0}, none = {0};
    assert_int_equal(mote_replay_write(&scene, 1u << 24, &all), MOTE_OK);
    assert_null(strstr(all.data, "left out"));
    assert_int_equal(mote_replay_write(&scene, all.size - 400, &less), MOTE_OK);
    assert_true(less.size < all.size);
    assert_non_null(strstr(less.data, "its particles are left out"));
    assert_int_equal(mote_replay_write(&scene, 1000, &none), MOTE_EUNSUPPORTED);
    assert_null(none.data);
    free(all.data);
    free(less.data);
    mote_replay_free(&scene);
}

/* The minima that are followed, the nearest first: its vertices are of the answer's faces. */
TEST(replay_particles_of_tracked_begin_with_the_pair)
{
    mote_replay_scene scene;
    assert_int_equal(mote_replay_load(&report, 0, report.cells.count, &scene), MOTE_OK);
    const mote_replay_track *track = &scene.tracks[TRACKED];
    assert_in_range(track->particles, 1, 9);
    assert_int_equal(track->rows, FRAMES);
    for (size_t k = 0; k < 2 * track->rows; ++k) {
        const mote_vec3 *first = &track->place[k * track->particles];
        assert_near(mote_length(mote_sub(*first, track->pair[k])), 0,
                    0.1 * mote_stored_number(track->cell, "length"));
    }
    mote_replay_free(&scene);
}

TEST(replay_particles_of_other_answers_are_not_shown)
{
    mote_replay_scene scene;
    assert_int_equal(mote_replay_load(&report, 0, report.cells.count, &scene), MOTE_OK);
    mote_replay_track *track = &scene.tracks[PAPER];
    assert_int_equal(track->particles, 3);
    free(track->place);
    track->place = NULL;
    track->particles = 0;
    track->distance[2] = nextafter(track->distance[2], 2);
    const size_t notes = json_array_size(scene.notes);
    assert_int_equal(mote_replay_particles(&scene, track), MOTE_OK);
    assert_int_equal(track->particles, 0);
    assert_null(track->place);
    assert_int_equal(json_array_size(scene.notes), notes + 1);
    mote_replay_free(&scene);
}

/* Down from all that there is: first particles, then tracks are left out, each named; what is
   written is JSON and no larger than what was allowed, but for its notes. */
TEST(replay_write_of_any_budget_names_all_that_is_left_out)
{
    mote_replay_scene scene;
    assert_int_equal(mote_replay_load(&report, 0, report.cells.count, &scene), MOTE_OK);
    mote_text all = {0};
    assert_int_equal(mote_replay_write(&scene, 1u << 24, &all), MOTE_OK);
    size_t tracks = TRACKS, least = TRACKS;
    for (size_t budget = all.size; tracks > 0; budget -= 150) {
        mote_text text = {0};
        const mote_status status = mote_replay_write(&scene, budget, &text);
        if (status == MOTE_EUNSUPPORTED) { /* not even the meshes and the motion */
            assert_non_null(strstr(mote_error_text(), "too large for the page"));
            break;
        }
        assert_int_equal(status, MOTE_OK);
        json_t *root = json_loads(text.data, 0, NULL);
        assert_non_null(root);
        tracks = json_array_size(json_object_get(root, "tracks"));
        size_t named = 0;
        for (const char *p = text.data; (p = strstr(p, ": left out, to keep")) != NULL; ++p)
            ++named;
        assert_int_equal(tracks + named, TRACKS);
        least = tracks < least ? tracks : least;
        json_decref(root);
        free(text.data);
    }
    assert_true(least < TRACKS);
    free(all.data);
    mote_replay_free(&scene);
}

/* What stands on the page before it leaves less room: first none is lost, then all. */
TEST(replay_json_of_a_full_page_shows_no_scene)
{
    static const size_t filled[] = {MOTE_REPLAY_PAGE_BYTES - 2000000, MOTE_REPLAY_PAGE_BYTES};
    for (size_t i = 0; i < 2; ++i) {
        char *blank = malloc(filled[i] + 1);
        assert_non_null(blank);
        memset(blank, ' ', filled[i]);
        blank[filled[i]] = '\0';
        mote_text text = {0};
        size_t shown = 0;
        mote_text_add(&text, "%s", blank);
        free(blank);
        assert_int_equal(mote_replay_json(&report, &text, &shown), MOTE_OK);
        assert_int_equal(shown, i == 0 ? 1 : 0);
        assert_true((strstr(text.data + filled[i], "too large for the page") != NULL) ==
                    (i == 1));
        free(text.data);
    }
}

/* A file that was cut or changed since it was read gives empty places, and no more rows. */
TEST(replay_read_cell_of_a_changed_file_gives_none)
{
    static const char *const texts[] = {"", "frame,distance", "frame,distance\n",
                                        "distance,frame\n0.5,1\n,2\n",
                                        "distance,ax,ay,az,bx,by,bz\n0.5,1,2,3,4,5,6\n7"};
    static const size_t known[] = {0, 0, 0, 1, 2};
    char path[128], id[] = "changed";
    (void)snprintf(path, sizeof path, "%s/cells/changed.csv", run_directory);
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; ++i) {
        const mote_stored_cell cell = {.id = id, .frames = 3};
        mote_replay_track track = {.cell = &cell};
        assert_int_equal(mote_file_write(path, texts[i], strlen(texts[i])), MOTE_OK);
        assert_int_equal(mote_replay_read_cell(run_directory, &track), MOTE_OK);
        assert_int_equal(track.rows, 3);
        size_t count = 0;
        for (size_t k = 0; k < track.rows; ++k)
            count += track.distance[k] == track.distance[k] ? 1 : 0;
        assert_int_equal(count, known[i]);
        free(track.distance);
        free(track.pair);
    }
    assert_int_equal(unlink(path), 0);
}

/* A method that is not known here, more particles than a picture shows, and no rows. */
TEST(replay_particles_of_odd_tracks_are_not_shown)
{
    static const struct {
        const char *label, *note;
        size_t rows;
    } odd[] = {{"magic:n=3", NULL, FRAMES},
               {"certified", NULL, FRAMES},
               {"particle-paper:n=3", NULL, 0},
               {"particle-paper:n=65,refine=no", "more than a picture shows", 1},
               {"particle-paper:n=1000000", "n", FRAMES}};
    mote_replay_scene scene;
    assert_int_equal(mote_replay_load(&report, 0, report.cells.count, &scene), MOTE_OK);
    for (size_t i = 0; i < sizeof odd / sizeof odd[0]; ++i) {
        char label[64];
        (void)snprintf(label, sizeof label, "%s", odd[i].label);
        mote_summary_row row = *scene.tracks[PAPER].row;
        row.label = label;
        double distances[FRAMES] = {0};
        mote_replay_track track = {.row = &row,
                                   .cell = scene.tracks[PAPER].cell,
                                   .distance = distances,
                                   .rows = odd[i].rows};
        mote_method_choice choice;
        mote_probe *probe = NULL;
        mote_frame_buffer *buffer = NULL;
        if (odd[i].rows == 1) { /* with the answer that it gives */
            mote_answer answer = {0};
            assert_int_equal(mote_method_choice_read(label, &choice), MOTE_OK);
            assert_int_equal(
                mote_probe_create(&scene.scenario->body[0], &scene.scenario->body[1], &choice,
                                  scene.scenario->ask, 0, track.cell->replicate_seed, &probe),
                MOTE_OK);
            assert_int_equal(mote_frame_buffer_create(scene.scenario, &buffer), MOTE_OK);
            assert_int_equal(
                mote_probe_answer(probe, mote_scenario_frame(scene.scenario, buffer, 1, 0),
                                  &answer),
                MOTE_OK);
            distances[0] = answer.distance;
            mote_probe_destroy(probe);
            mote_frame_buffer_destroy(buffer);
        }
        const size_t notes = json_array_size(scene.notes);
        assert_int_equal(mote_replay_particles(&scene, &track), MOTE_OK);
        assert_int_equal(track.particles, 0);
        assert_null(track.place);
        assert_int_equal(json_array_size(scene.notes), notes + (odd[i].note ? 1 : 0));
        if (odd[i].note)
            assert_non_null(
                strstr(json_string_value(json_array_get(scene.notes, notes)), odd[i].note));
    }
    mote_replay_free(&scene);
}

/* Numbers of frames are read from a file: one after the scenario's end is of nothing there. */
TEST(replay_load_of_a_frame_that_the_scenario_has_not_is_refused)
{
    static const uint32_t numbers[] = {FRAMES + 1, 100000, UINT32_MAX};
    uint32_t *last = &report.cells.rows[CERTIFIED].first->frame[FRAMES - 1];
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; ++i) {
        mote_replay_scene scene;
        *last = numbers[i];
        assert_int_equal(mote_replay_load(&report, 0, report.cells.count, &scene),
                         MOTE_EUNSUPPORTED);
        assert_non_null(strstr(mote_error_text(), "the scenario has frames 1-5"));
    }
    *last = FRAMES;
}

TEST(replay_load_of_a_changed_scenario_is_refused)
{
    mote_replay_scene scene;
    static const char other[] =
        "{\"purpose\": \"p\", \"like\": \"mv\", \"frames\": 5, \"pace\": 100,\n"
        " \"warmup\": null, \"active\": null}\n";
    assert_int_equal(mote_file_write(scenario_path, other, strlen(other)), MOTE_OK);
    assert_int_equal(mote_replay_load(&report, 0, report.cells.count, &scene),
                     MOTE_EUNSUPPORTED);
    assert_non_null(strstr(mote_error_text(), "moved or changed"));
    size_t shown;
    json_t *root = read_scenes(&shown);
    assert_int_equal(shown, 0);
    assert_int_equal(json_array_size(json_object_get(root, "notes")), 1);
    json_decref(root);
}
