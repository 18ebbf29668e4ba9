/* The data of the page's replay, as the page reads it. */
#include "harness/engine/engine.h"
#include "harness/report/replay.h"
#include "harness/base/record.h"
#include "harness/report/report_rows.h"
#include "tests/support/folder.h"
#include "tests/support/page_data.h"
#include "tests/support/mote.h"
#include "tests/support/sheet.h"
#include "tests/support/test.h"

#include <stddef.h>

#include <math.h>

#define FRAMES 5u

static mote_report report;

/* Tracks, in no order: the report sorts them by time. */
enum { CERTIFIED, TRACKED, PAPER, PAPER_CHECKED, TRACKS };
static const char *const labels[TRACKS] = {
    "certified", "particle:n=3", "particle-paper:n=3,refine=no", "particle-paper:n=3"};

/* The index of a track among those of a scene. */
static size_t place_of(size_t track)
{
    size_t i = 0;
    while (strcmp(mote_report_row(&report, i)->label, labels[track]) != 0)
        ++i;
    return i;
}

static int make_run(void)
{
    static const char scenario[] =
        "{\"purpose\": \"p\", \"like\": \"mv\", \"frames\": 5, \"pace\": 149.75,\n"
        " \"warmup\": null, \"active\": null}\n";
    file_put("five.json", scenario);
    if (mote("run five.json --out run --method certified --method "
             "'particle-paper:n=3,refine=no|near' --method particle:n=3") != 0)
        return -1;
    return mote_report_gather("run", &report) == MOTE_OK ? 0 : -1;
}

static int remove_base(void)
{
    mote_report_free(&report);
    return 0;
}

TEST_GROUP(make_run, remove_base);

static void assert_near(double a, double b, double tolerance)
{
    if (!(fabs(a - b) <= tolerance))
        fail_msg("%.17g is not within %g of %.17g", a, tolerance, b);
}

static json_t *read_scenes(size_t *shown)
{
    json_t *root = NULL;
    assert_int_equal(mote_replay_json(&report, &root), MOTE_OK);
    *shown = json_array_size(json_object_get(root, "scenes"));
    return root;
}

static json_t *first_scene(const json_t *root)
{
    json_t *scene = json_array_get(json_object_get(root, "scenes"), 0);
    assert_non_null(scene);
    return scene;
}

static double number_at(const json_t *array, size_t i)
{
    const json_t *value = json_array_get(array, i);
    assert_true(json_is_number(value));
    return json_number_value(value);
}

static double number_of(const json_t *object, const char *key)
{
    return json_number_value(json_object_get(object, key));
}

/* Restores integers from their second differences; the caller frees them. */
static long *read_smooth(const json_t *array, size_t count, size_t columns)
{
    assert_int_equal(json_array_size(array), count);
    long *values = malloc((count + 1) * sizeof *values);
    assert_non_null(values);
    for (size_t i = 0; i < count; ++i)
        values[i] = (long)number_at(array, i);
    for (int times = 0; times < 2; ++times) {
        for (size_t i = columns; i < count; ++i)
            values[i] += values[i - columns];
    }
    return values;
}

TEST(replay_json_holds_the_poses_and_weights_of_each_frame)
{
    size_t shown;
    json_t *root = read_scenes(&shown);
    assert_int_equal(shown, 1);
    json_t *world = page_unpack_json(first_scene(root), "world");
    const double length = number_of(first_scene(root), "length");
    mote_scenario *scenario;
    mote_frame_buffer *buffer;
    assert_int_equal(mote_scenario_load("five.json", &scenario), MOTE_OK);
    buffer = mote_frame_buffer_create(scenario);
    for (size_t i = 0; i < 2; ++i) {
        const json_t *body = json_array_get(json_object_get(world, "bodies"), i);
        const size_t width = 3 * (size_t)scenario->body[i].field->count;
        assert_true(width > 0);
        long *poses = read_smooth(json_object_get(body, "poses"), 12 * FRAMES, 12);
        long *weights = read_smooth(json_object_get(body, "weights"), width * FRAMES, width);
        const double step = number_of(body, "weightStep"), pose = number_of(body, "poseStep");
        for (uint32_t k = 0; k < FRAMES; ++k) {
            const mote_body_state *at =
                &mote_scenario_frame(scenario, buffer, k + 1, 0)->body[i];
            assert_near(pose * length * (double)poses[12 * k + 9], at->pose.translation.x,
                        1e-6 * length);
            assert_near(pose * (double)poses[12 * k + 5], at->pose.rotation.m[1][2], 1e-6);
            const mote_vec3 w = {at->weights.x[1], at->weights.y[1], at->weights.z[1]};
            const mote_vec3 rest = mote_rotate_back(&at->pose.rotation, w);
            assert_near(step * (double)weights[width * k + 4], rest.y, step);
        }
        free(poses);
        free(weights);
    }
    mote_frame_buffer_destroy(buffer);
    mote_scenario_destroy(scenario);
    json_decref(world);
    json_decref(root);
}

/* Errors have six digits; those below 1e-12 are stored as 0. */
TEST(replay_json_holds_the_stored_answers)
{
    size_t shown;
    json_t *root = read_scenes(&shown);
    const json_t *tracks = json_object_get(first_scene(root), "tracks");
    json_t *world = page_unpack_json(first_scene(root), "world");
    assert_int_equal(json_array_size(tracks), TRACKS);
    for (size_t t = 0; t < TRACKS; ++t) {
        const json_t *track = json_array_get(tracks, t);
        const mote_stored_cell *cell = &mote_report_row(&report, t)->cells[0];
        assert_string_equal(json_string_value(json_object_get(track, "cell")), cell->id);
        json_t *answers = page_unpack_json(track, "answers");
        const json_t *errors = json_object_get(answers, "error");
        assert_int_equal(json_array_size(errors), FRAMES);
        for (size_t k = 0; k < FRAMES; ++k) {
            assert_near(number_at(errors, k), cell->error[k],
                        fmax(1e-12, 5e-6 * fabs(cell->error[k])));
            assert_int_equal(number_at(json_object_get(answers, "contact"), k),
                             cell->contact[k]);
            assert_true(number_at(json_object_get(world, "truth"), k) == cell->truth[k]);
        }
        json_decref(answers);
    }
    json_decref(world);
    json_decref(root);
}

/* A method's points, stored relative to the truth's, are as far apart as its distance, on a
   grid of 2^16 steps over the scene. */
TEST(replay_json_pairs_are_their_distance_apart)
{
    size_t shown;
    json_t *root = read_scenes(&shown);
    const json_t *scene = first_scene(root);
    json_t *world = page_unpack_json(scene, "world");
    const json_t *track = json_array_get(json_object_get(scene, "tracks"), place_of(PAPER));
    json_t *answers = page_unpack_json(track, "answers");
    const double step = number_of(scene, "step");
    const mote_stored_cell *cell = &mote_report_row(&report, place_of(PAPER))->cells[0];
    const json_t *truth = json_object_get(world, "pair"),
                 *pair = json_object_get(answers, "pair");
    assert_int_equal(json_array_size(truth), 6 * FRAMES); /* apart in every frame */
    assert_int_equal(json_array_size(pair), 6 * FRAMES);
    double places[6] = {0};
    for (size_t k = 0; k < FRAMES; ++k) {
        double squared = 0;
        for (size_t c = 0; c < 6; ++c)
            places[c] += number_at(truth, 6 * k + c); /* two columns of three */
        for (size_t c = 0; c < 3; ++c)
            squared += pow(step * (places[c] + number_at(pair, 6 * k + c) - places[3 + c] -
                                   number_at(pair, 6 * k + 3 + c)),
                           2);
        assert_near(sqrt(squared),
                    cell->truth[k] + cell->error[k] * mote_stored_number(cell, "length"),
                    4 * step);
    }
    json_decref(answers);
    json_decref(world);
    json_decref(root);
}

/* The particles are the same with and without the exact check, and are stored once. */
TEST(replay_json_particles_are_stored_once)
{
    size_t shown;
    json_t *root = read_scenes(&shown);
    json_t *sets = json_object_get(first_scene(root), "particles");
    assert_int_equal(json_object_size(sets), 2); /* the tracked ones differ */
    const json_t *tracks = json_object_get(first_scene(root), "tracks");
    const size_t a = place_of(PAPER), b = place_of(PAPER_CHECKED);
    const size_t first = a < b ? a : b;
    assert_int_equal(number_of(json_array_get(tracks, a), "particles"), first);
    assert_int_equal(number_of(json_array_get(tracks, b), "particles"), first);
    char key[16];
    (void)snprintf(key, sizeof key, "%zu", first);
    json_t *set = page_unpack_json(sets, key);
    assert_int_equal(number_of(set, "perBody"), 3);
    assert_int_equal(json_array_size(json_object_get(set, "places")), FRAMES * 2 * 3 * 3);
    json_decref(set);
    json_decref(root);
}

/* The page shows the replicate with the largest error, so its worst frame is the worst of
   all. */
TEST(replay_shows_the_replicate_with_the_largest_error)
{
    mote_report several;
    mote_replay_scene scene;
    mote_expect(0, "",
                "run tt --frames 1-40 --replicates 6 --out several --method "
                "particle-paper:n=2,refine=no");
    assert_int_equal(mote_report_gather("several", &several), MOTE_OK);
    assert_int_equal(mote_replay_load(&several, 0, 1, &scene), MOTE_OK);
    const mote_summary_row *row = mote_report_row(&several, 0);
    double largest[6], shown = 0;
    bool differ = false;
    for (size_t r = 0; r < 6; ++r) {
        largest[r] = 0;
        for (size_t k = 0; k < row->cells[r].frames; ++k)
            largest[r] = fmax(largest[r], fabs(row->cells[r].error[k]));
        differ = differ || largest[r] > largest[0];
        if (&row->cells[r] == scene.tracks[0].cell)
            shown = largest[r];
    }
    assert_true(differ); /* otherwise the first would do */
    for (size_t r = 0; r < 6; ++r)
        assert_true(shown >= largest[r]);
    assert_near(shown, row->error.max, 1e-15);
    mote_replay_free(&scene);
    mote_report_free(&several);
}

/* A field other than CSRBF has its functions at every vertex: those of `stretch` are the
   coordinates relative to the middle of the box, over its diagonal. */
TEST(replay_of_a_field_of_another_kind_has_its_functions)
{
    mote_report other;
    json_t *root = NULL;
    file_put("stretched.json",
             "{\"purpose\": \"p\", \"frames\": 3, \"ask\": \"distance\", \"bodies\": [\n"
             "{\"letter\": \"T\", \"triangles\": 400, \"field\": {\"kind\": \"stretch\",\n"
             " \"displacement\": {\"sines\": [{\"control\": 2, \"amplitude\": [0, 0.2, 0],\n"
             " \"period\": 7}]}}}, {\"letter\": \"T\", \"triangles\": 400, \"motion\":\n"
             " [{\"frame\": 1, \"position\": [1, 0, 0]}]}]}\n");
    mote_expect(0, "", "run ./stretched.json --out other --replicates 1 --method certified");
    assert_int_equal(mote_report_gather("other", &other), MOTE_OK);
    assert_int_equal(mote_replay_json(&other, &root), MOTE_OK);
    json_t *world = page_unpack_json(first_scene(root), "world");
    const json_t *body = json_array_get(json_object_get(world, "bodies"), 0);
    const json_t *basis = json_object_get(body, "basis");
    const double step = number_of(body, "basisStep");
    mote_scenario *scenario;
    assert_int_equal(mote_scenario_load("./stretched.json", &scenario), MOTE_OK);
    const mote_mesh *mesh = scenario->body[0].mesh;
    const mote_vec3 middle = mote_scale(mote_add(mesh->low, mesh->high), 0.5);
    assert_int_equal(number_of(body, "functions"), 3);
    assert_int_equal(json_array_size(basis), 3 * mesh->vertex_count);
    for (uint32_t i = 0; i < mesh->vertex_count; ++i) {
        const mote_vec3 x =
            mote_scale(mote_sub(mesh->positions[i], middle), 1 / mesh->diagonal);
        assert_near(step * number_at(basis, 3 * i), x.x, step);
        assert_near(step * number_at(basis, 3 * i + 1), x.y, step);
        assert_near(step * number_at(basis, 3 * i + 2), x.z, step);
    }
    mote_scenario_destroy(scenario);
    json_decref(world);
    json_decref(root);
    mote_report_free(&other);
}

/* Given positions become key frames: with so few vertices, every frame is one. */
TEST(replay_of_given_positions_has_them_in_every_frame)
{
    enum { SHOWN = 7 };
    mote_report other;
    json_t *root = NULL;
    sheet_write_obj("still.obj", 1);
    sheet_write_pc2("sheet.pc2", SHOWN, false);
    file_put("sheet.json",
             "{\"purpose\": \"p\", \"frames\": 7, \"ask\": \"distance\", \"bodies\": [\n"
             "{\"file\": \"still.obj\", \"positions\": \"sheet.pc2\"},\n"
             "{\"letter\": \"T\", \"triangles\": 400}]}\n");
    mote_expect(0, "", "run ./sheet.json --out sheet --replicates 1 --method stream");
    assert_int_equal(mote_report_gather("sheet", &other), MOTE_OK);
    assert_int_equal(mote_replay_json(&other, &root), MOTE_OK);
    json_t *world = page_unpack_json(first_scene(root), "world");
    const json_t *body = json_array_get(json_object_get(world, "bodies"), 0);
    const json_t *basis = json_object_get(body, "basis");
    const size_t width = (size_t)number_of(body, "functions");
    assert_int_equal(width, 3 * SHOWN);
    assert_int_equal(json_array_size(basis), width * SHEET_VERTICES);
    long *weights = read_smooth(json_object_get(body, "weights"), 3 * width * SHOWN, 3 * width);
    const double step = number_of(body, "weightStep") * number_of(body, "basisStep");
    for (size_t k = 0; k < SHOWN; ++k) {
        for (size_t v = 0; v < SHEET_VERTICES; ++v) {
            double moved[3] = {0, 0, 0};
            for (size_t j = 0; j < 3 * width; ++j)
                moved[j % 3] += step * (double)weights[3 * width * k + j] *
                                number_at(basis, v * width + j / 3);
            for (int c = 0; c < 3; ++c)
                assert_near(moved[c],
                            sheet_at((int)v, c, (double)k + 1) - sheet_at((int)v, c, 1), 1e-5);
        }
    }
    free(weights);
    json_decref(world);
    json_decref(root);
    mote_report_free(&other);
}

static size_t notes_with(const json_t *data, const char *text)
{
    size_t i, count = 0;
    const json_t *note;
    MOTE_EACH(i, note, json_object_get(data, "notes"))
    {
        count += strstr(json_string_value(note), text) != NULL;
    }
    return count;
}

/* What is not shown says why: impacts are no answers about frames, and the same vertices with
   other faces are another scenario. */
TEST(replay_of_impacts_or_of_other_faces_says_why_there_is_none)
{
    static const struct {
        const char *run, *changes, *note;
    } rows[] = {
        {"run ./five.json --step 2 --method certified", NULL, "asks for impacts"},
        {"run ./square.json --method certified", "f 1 2 4\nf 2 3 4\n", "fingerprint"},
        {"run ./square.json --method certified", NULL, NULL},
    };
#define CORNERS "v 0 0 0\nv 1 0 0.1\nv 1 1 0\nv 0 1 0.1\n"
    file_put("square.json",
             "{\"purpose\": \"p\", \"frames\": 3, \"ask\": \"distance\", \"bodies\": [\n"
             "{\"file\": \"square.obj\"}, {\"file\": \"square.obj\", \"motion\":\n"
             " [{\"frame\": 1, \"position\": [0, 0, 1]}]}]}\n");
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        mote_report other;
        json_t *root = NULL;
        char directory[] = "none-0", *text;
        directory[5] = (char)('0' + i);
        test_row("%zu", i);
        file_put("square.obj", CORNERS "f 1 2 3\nf 1 3 4\n");
        mote_expect(0, "", "%s --replicates 1 --out %s", rows[i].run, directory);
        if (rows[i].changes) {
            text = mote_format("%s%s", CORNERS, rows[i].changes);
            file_put("square.obj", text);
            free(text);
        }
        assert_int_equal(mote_report_gather(directory, &other), MOTE_OK);
        assert_int_equal(mote_replay_json(&other, &root), MOTE_OK);
        const size_t notes = json_array_size(json_object_get(root, "notes"));
        assert_int_equal(json_array_size(json_object_get(root, "scenes")), !rows[i].note);
        assert_int_equal(notes, rows[i].note != NULL);
        assert_true(!rows[i].note || notes_with(root, rows[i].note) == 1);
        json_decref(root);
        mote_report_free(&other);
    }
}

/* From the full size down: first particles, then tracks are left out, each named, until not
   even the bodies fit. */
TEST(replay_write_of_any_budget_names_all_that_is_left_out)
{
    mote_replay_scene scene;
    json_t *data = NULL;
    size_t all = 0, least_tracks = TRACKS, least_sets = 2;
    assert_int_equal(mote_replay_load(&report, 0, report.summary.count, &scene), MOTE_OK);
    assert_int_equal(mote_replay_write(&scene, 1u << 24, &data, &all), MOTE_OK);
    assert_int_equal(notes_with(data, "left out"), 0);
    json_decref(data);
    mote_status status = MOTE_OK;
    for (size_t budget = all; status == MOTE_OK; budget -= 40) {
        size_t used;
        status = mote_replay_write(&scene, budget, &data, &used);
        if (status != MOTE_OK)
            break;
        assert_true(used <= budget);
        const size_t tracks = json_array_size(json_object_get(data, "tracks"));
        const size_t sets = json_object_size(json_object_get(data, "particles"));
        assert_int_equal(tracks + notes_with(data, ": left out, to keep"), TRACKS);
        assert_int_equal(sets + notes_with(data, "its particles are left out"), 2);
        least_tracks = tracks < least_tracks ? tracks : least_tracks;
        least_sets = sets < least_sets ? sets : least_sets;
        json_decref(data);
    }
    assert_int_equal(status, MOTE_EUNSUPPORTED);
    assert_non_null(strstr(mote_error_text(), "too large for the page"));
    assert_int_equal(least_tracks, 0);
    assert_int_equal(least_sets, 0);
    mote_replay_free(&scene);
}

/* The tracked minima, the nearest first: its vertices belong to the answer's faces. */
TEST(replay_particles_of_tracked_begin_with_the_pair)
{
    mote_replay_scene scene;
    assert_int_equal(mote_replay_load(&report, 0, report.summary.count, &scene), MOTE_OK);
    const mote_replay_track *track = &scene.tracks[place_of(TRACKED)];
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
    assert_int_equal(mote_replay_load(&report, 0, report.summary.count, &scene), MOTE_OK);
    mote_replay_track *track = &scene.tracks[place_of(PAPER)];
    assert_int_equal(track->particles, 3);
    free(track->place);
    track->place = NULL;
    track->particles = 0;
    double *error = &track->cell->error[2];
    const double stored = *error;
    *error = nextafter(stored, 2);
    const size_t notes = json_array_size(scene.notes);
    assert_int_equal(mote_replay_particles(&scene, track), MOTE_OK);
    *error = stored;
    assert_int_equal(track->particles, 0);
    assert_null(track->place);
    assert_int_equal(json_array_size(scene.notes), notes + 1);
    mote_replay_free(&scene);
}

/* If a file was truncated or changed since it was read, missing values are empty and no rows
   follow. */
TEST(replay_read_cell_of_a_changed_file_gives_none)
{
    static const char *const texts[] = {"", "frame,distance", "frame,distance\n",
                                        "distance,frame\n0.5,1\n,2\n",
                                        "distance,ax,ay,az,bx,by,bz\n0.5,1,2,3,4,5,6\n7"};
    static const size_t known[] = {0, 0, 0, 1, 2};
    char path[128], id[] = "changed";
    (void)snprintf(path, sizeof path, "run/cells/changed.csv");
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; ++i) {
        const mote_stored_cell cell = {.id = id, .frames = 3};
        mote_replay_track track = {.cell = &cell};
        assert_int_equal(mote_file_write(path, texts[i], strlen(texts[i])), MOTE_OK);
        assert_int_equal(mote_replay_read_cell("run", &track), MOTE_OK);
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

/* An unknown method, more particles than a picture shows, and no rows. */
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
    assert_int_equal(mote_replay_load(&report, 0, report.summary.count, &scene), MOTE_OK);
    for (size_t i = 0; i < sizeof odd / sizeof odd[0]; ++i) {
        char label[64];
        (void)snprintf(label, sizeof label, "%s", odd[i].label);
        mote_summary_row row = *scene.tracks[place_of(PAPER)].row;
        row.label = label;
        mote_stored_cell cell = *scene.tracks[place_of(PAPER)].cell;
        double errors[FRAMES] = {0};
        cell.error = errors;
        mote_replay_track track = {.row = &row, .cell = &cell, .rows = odd[i].rows};
        mote_method_choice choice;
        mote_engine *probe = NULL;
        mote_frame_buffer *buffer = NULL;
        if (odd[i].rows == 1) { /* with the answer that it gives */
            mote_answer answer = {0};
            assert_int_equal(mote_method_choice_read(label, &choice), MOTE_OK);
            assert_int_equal(mote_engine_open_two(
                                 &scene.scenario->body[0], &scene.scenario->body[1], &choice,
                                 scene.scenario->ask, 0, track.cell->replicate_seed, &probe),
                             MOTE_OK);
            buffer = mote_frame_buffer_create(scene.scenario);
            assert_int_equal(
                mote_engine_answer(probe, mote_scenario_frame(scene.scenario, buffer, 1, 0),
                                   &answer),
                MOTE_OK);
            errors[0] = (answer.distance - cell.truth[0]) / mote_stored_number(&cell, "length");
            mote_engine_destroy(probe);
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

/* Frame numbers come from a file: one after the scenario's end has no data. */
TEST(replay_load_of_a_frame_that_the_scenario_has_not_is_refused)
{
    static const uint32_t numbers[] = {FRAMES + 1, 100000, UINT32_MAX};
    uint32_t *last = &mote_report_row(&report, place_of(CERTIFIED))->first->frame[FRAMES - 1];
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; ++i) {
        mote_replay_scene scene;
        *last = numbers[i];
        assert_int_equal(mote_replay_load(&report, 0, report.summary.count, &scene),
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
    file_put("five.json", other);
    assert_int_equal(mote_replay_load(&report, 0, report.summary.count, &scene),
                     MOTE_EUNSUPPORTED);
    assert_non_null(strstr(mote_error_text(), "moved or changed"));
    size_t shown;
    json_t *root = read_scenes(&shown);
    assert_int_equal(shown, 0);
    assert_int_equal(json_array_size(json_object_get(root, "notes")), 1);
    json_decref(root);
}

/* A pair of meshes is found again from the words of the run's command, in any form. */
TEST(replay_finds_a_pair_by_the_words_of_its_command)
{
    static const char *const words[] = {"", "--direction 1,0.5,0", "--direction=1,0.5,0"};
    file_put("t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\n"
                      "f 2 3 4\n");
    for (size_t i = 0; i < ROWS_OF(words); ++i) {
        mote_report pair;
        json_t *root = NULL;
        test_row("%s", words[i]);
        mote_expect(0, "",
                    "run --out pair%zu %s --pair t.obj t.obj --frames 400-404 "
                    "--method certified --replicates 1 --seed 3",
                    i, words[i]);
        char folder[16];
        (void)snprintf(folder, sizeof folder, "pair%zu", i);
        assert_int_equal(mote_report_gather(folder, &pair), MOTE_OK);
        assert_int_equal(mote_replay_json(&pair, &root), MOTE_OK);
        assert_int_equal(json_array_size(json_object_get(root, "notes")), 0);
        assert_int_equal(json_array_size(json_object_get(root, "scenes")), 1);
        json_decref(root);
        /* Another direction in the words is another scenario. */
        json_t *sessions = json_object_get(pair.manifest, "sessions");
        json_t *command = json_object_get(json_array_get(sessions, 0), "command");
        (void)json_array_insert_new(command, 1, json_string("--direction=0,0,1"));
        (void)json_array_insert_new(command, 1, json_string("--directions"));
        (void)json_array_insert_new(command, 1, json_integer(7));
        assert_int_equal(mote_replay_json(&pair, &root), MOTE_OK);
        assert_int_equal(json_array_size(json_object_get(root, "scenes")), 0);
        assert_int_equal(json_array_size(json_object_get(root, "notes")), 1);
        json_decref(root);
        mote_report_free(&pair);
    }
}
