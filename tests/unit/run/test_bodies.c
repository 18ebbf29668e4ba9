/* Scenarios of several bodies: positions, paths, the engines' answers, bad input. */
#include "harness/run/subject.h"

#include "harness/figure/figure.h"
#include "harness/base/file.h"
#include "tests/support/folder.h"
#include "tests/support/mote.h"
#include "tests/support/solids.h"
#include "tests/support/test.h"

#define FILE_NAME "b.json"

#define FIELD                                                                                  \
    "\"field\": {\"count\": 6, \"support\": 0.5, \"displacement\": {\"random\": {\"seed\": "   \
    "5, "                                                                                      \
    "\"amplitude\": 0.05, \"periods\": [40, 90]}}}"
#define SHAPES                                                                                 \
    "\"shapes\": [{\"letter\": \"W\", \"triangles\": 400, " FIELD                              \
    "}, {\"letter\": \"T\", \"triangles\": 400}]"

#define SHAPE "\"shapes\": [{\"letter\": \"T\", \"triangles\": 400}]"

/* The %s are further keys of the scenario and of its bodies. */
static const char form[] =
    "{\"purpose\": \"a test\", \"frames\": 40, \"ask\": \"distance\"%s,\n"
    " \"bodies\": {%s}}\n";

static void write_file(const char *more, const char *bodies)
{
    char *text = mote_format(form, more, bodies);
    assert_non_null(text);
    file_put(FILE_NAME, text);
    free(text);
}

static mote_bodies *load(const char *more, const char *bodies)
{
    mote_bodies *b = NULL;
    write_file(more, bodies);
    if (mote_bodies_load(FILE_NAME, &b) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    return b;
}

static mote_bodies_frame frame_of(const mote_bodies *b)
{
    mote_bodies_frame frame;
    frame = mote_bodies_frame_create(b);
    return frame;
}

static mote_engine *engine_of(mote_bodies *b, const char *text)
{
    mote_method_choice choice;
    mote_engine *engine = NULL;
    mote_engine_setup setup = mote_subject_engine(&(mote_subject){.bodies = b});
    setup.seed = 1;
    if (mote_scene_choice_read(text, &choice) != MOTE_OK ||
        mote_engine_create(&setup, &choice, &engine) != MOTE_OK ||
        mote_engine_build(engine) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    return engine;
}

static mote_status ask(mote_engine *engine, const mote_bodies_frame *frame,
                       mote_engine_cost *cost)
{
    mote_engine_show(engine, frame->states);
    return mote_engine_ask(engine, cost);
}

TEST(mote_bodies_frame_set_long_paths_stay_in_the_box)
{
    mote_bodies *b = load("", "\"count\": 20, \"box\": [4, 3, 2], \"speed\": 0.3, " SHAPES);
    mote_bodies_frame frame = frame_of(b);
    mote_vec3 before[20];
    for (uint32_t f = 1; f <= 400; ++f) {
        mote_bodies_frame_set(b, f, &frame);
        for (uint32_t i = 0; i < b->count; ++i) {
            const mote_bodies_shape *shape = &b->shapes[b->shape_of[i]];
            const mote_vec3 at = mote_pose_apply(&frame.states[i].pose, shape->motion.centre);
            assert_true(fabs(at.x) <= b->room.x + 1e-12 && fabs(at.y) <= b->room.y + 1e-12 &&
                        fabs(at.z) <= b->room.z + 1e-12);
            for (uint32_t v = 0; v < shape->body.mesh->vertex_count && f % 100 == 0; ++v) {
                const mote_vec3 p =
                    mote_pose_apply(&frame.states[i].pose, shape->body.mesh->positions[v]);
                assert_true(fabs(p.x) <= b->box.x + 1e-9 && fabs(p.z) <= b->box.z + 1e-9);
            }
            /* No leap: a step is at most the speed, or less at a wall. */
            assert_true(f == 1 ||
                        mote_distance_squared(at, before[i]) <= 0.091 * b->length * b->length);
            before[i] = at;
        }
    }
    mote_bodies_frame_free(&frame);
    mote_bodies_destroy(b);
}

/* Two bodies of one shape deform differently, and turn with their poses. */
TEST(mote_bodies_frame_set_each_body_has_its_own_weights)
{
    mote_bodies *b = load("", "\"count\": 6, \"box\": 4, " SHAPES);
    mote_bodies_frame frame = frame_of(b);
    mote_bodies_frame_set(b, 7, &frame);
    const mote_weights *first = &frame.states[0].weights, *third = &frame.states[2].weights;
    assert_int_equal(first->count, 6);
    assert_int_equal(frame.states[1].weights.count, 0);
    for (uint32_t j = 0; j < first->count; ++j) {
        const mote_vec3 a =
            mote_rotate_back(&frame.states[0].pose.rotation,
                             mote_vec3_make(first->x[j], first->y[j], first->z[j]));
        const mote_vec3 c =
            mote_rotate_back(&frame.states[2].pose.rotation,
                             mote_vec3_make(third->x[j], third->y[j], third->z[j]));
        assert_true(mote_distance_squared(a, c) > 1e-8);
    }
    mote_bodies_frame_free(&frame);
    mote_bodies_destroy(b);
}

TEST(mote_bodies_load_same_seed_same_bits)
{
    mote_bodies *b[3];
    b[0] = load("", "\"count\": 20, \"near_pairs\": 1, \"seed\": 4, " SHAPES);
    b[1] = load("", "\"count\": 20, \"near_pairs\": 1, \"seed\": 4, " SHAPES);
    b[2] = load("", "\"count\": 20, \"near_pairs\": 1, \"seed\": 5, " SHAPES);
    assert_memory_equal(b[0]->paths, b[1]->paths, 20 * sizeof *b[0]->paths);
    assert_memory_equal(&b[0]->box, &b[1]->box, sizeof b[0]->box);
    assert_memory_not_equal(b[0]->paths, b[2]->paths, 20 * sizeof *b[0]->paths);
    for (int k = 0; k < 3; ++k)
        mote_bodies_destroy(b[k]);
}

/* The answer for a pair of bodies, or NULL if it is not near for this engine. */
static const mote_answer *find(const mote_engine *engine, const uint32_t body[2])
{
    size_t count;
    const mote_near_pair *pairs = mote_engine_pairs(engine, &count);
    for (size_t k = 0; k < count; ++k) {
        if (pairs[k].body[0] == body[0] && pairs[k].body[1] == body[1])
            return &pairs[k].answer;
    }
    return NULL;
}

/* All engines must report every pair within `near`, with equal distance and contact. */
static void check_agreement(const mote_bodies *b, mote_engine *const *engines, int count,
                            size_t *near, size_t *contacts)
{
    for (int from = 0; from < count; ++from) {
        size_t size;
        const mote_near_pair *pairs = mote_engine_pairs(engines[from], &size);
        for (size_t k = 0; k < size; ++k) {
            const mote_answer *a = &pairs[k].answer;
            if (a->distance > b->near)
                continue;
            *near += from == 0;
            *contacts += from == 0 && a->contact;
            for (int to = 0; to < count; ++to) {
                const mote_answer *other = find(engines[to], pairs[k].body);
                assert_non_null(other);
                assert_close(other->distance, a->distance, 1e-12 * b->length);
                assert_int_equal(other->contact, a->contact);
            }
        }
    }
}

TEST(mote_engine_ask_exact_methods_agree)
{
    static const char *const texts[] = {
        "certified", "fcl-aabb:refit=every",  "fcl-aabb",
        "aabb-tree", "aabb-tree:refit=every", "stream:threads=2"};
    mote_bodies *b = load(", \"tolerance\": 0.01",
                          "\"count\": 16, \"near_pairs\": 2, \"speed\": 0.03, " SHAPES);
    mote_engine *engines[6];
    mote_bodies_frame frame = frame_of(b);
    size_t near = 0, contacts = 0;
    for (int m = 0; m < 6; ++m)
        engines[m] = engine_of(b, texts[m]);
    for (uint32_t f = 1; f <= 10; ++f) {
        mote_bodies_frame_set(b, f, &frame);
        for (int m = 0; m < 6; ++m) {
            mote_engine_cost step;
            if (ask(engines[m], &frame, &step) != MOTE_OK)
                fail_msg("%s: %s", texts[m], mote_error_text());
        }
        check_agreement(b, engines, 6, &near, &contacts);
    }
    assert_true(near > contacts && contacts > 0);
    for (int m = 0; m < 6; ++m)
        mote_engine_destroy(engines[m]);
    mote_bodies_frame_free(&frame);
    mote_bodies_destroy(b);
}

TEST(mote_engine_ask_contact_question_agrees)
{
    static const char *const texts[] = {"certified", "fcl-aabb", "aabb-tree", "stream"};
    write_file("", "");
    char *text = mote_format("{\"purpose\": \"a test\", \"frames\": 40, \"ask\": \"contact\", "
                             "\"tolerance\": 0.02, \"bodies\": {\"count\": 20, "
                             "\"near_pairs\": 2, \"speed\": 0.03, " SHAPES "}}");
    file_put(FILE_NAME, text);
    free(text);
    mote_bodies *b = NULL;
    assert_int_equal(mote_bodies_load(FILE_NAME, &b), MOTE_OK);
    mote_engine *engines[4];
    mote_bodies_frame frame = frame_of(b);
    size_t contacts = 0;
    for (int m = 0; m < 4; ++m)
        engines[m] = engine_of(b, texts[m]);
    for (uint32_t f = 1; f <= 20; ++f) {
        mote_bodies_frame_set(b, f, &frame);
        mote_engine_cost step[4];
        for (int m = 0; m < 4; ++m)
            assert_int_equal(ask(engines[m], &frame, &step[m]), MOTE_OK);
        size_t count;
        const mote_near_pair *pairs = mote_engine_pairs(engines[0], &count);
        for (size_t k = 0; k < count; ++k) {
            for (int m = 1; m < 4; ++m) { /* tighter boxes leave out pairs that are apart */
                const mote_answer *other = find(engines[m], pairs[k].body);
                assert_int_equal(other && other->contact, pairs[k].answer.contact);
            }
        }
        contacts += step[0].contacts;
    }
    assert_true(contacts > 0);
    for (int m = 0; m < 4; ++m)
        mote_engine_destroy(engines[m]);
    mote_bodies_frame_free(&frame);
    mote_bodies_destroy(b);
}

static char *whole_file(const char *pattern)
{
    char *command = mote_format("cat %s > found 2>/dev/null", pattern);
    assert_int_equal(system(command), 0);
    free(command);
    char *text = file_text("found");
    assert_true(strlen(text) > 200);
    return text;
}

/* Every pair and step has the same record, digit for digit. */
TEST(mote_run_threads_and_frames_ahead_give_the_same_records)
{
    static const char *const ways[] = {"certified",         "certified:threads=2",
                                       "certified:ahead=1", "certified:threads=3,ahead=4",
                                       "particle:n=4",      "particle:threads=3,n=4,ahead=2"};
    char *texts[6];
    write_file("", "\"count\": 20, \"near_pairs\": 2, \"speed\": 0.03, " SHAPES);
    for (int k = 0; k < 6; ++k) {
        mote_expect(0, "",
                    "run " FILE_NAME " --frames 3-10 --replicates 1 --out run%d --method %s", k,
                    ways[k]);
        char *pattern = mote_format("run%d/cells/*.pairs.csv", k);
        texts[k] = whole_file(pattern);
        free(pattern);
    }
    for (int k = 0; k < 6; ++k)
        assert_string_equal(texts[k], texts[k < 4 ? 0 : 4]);
    for (int k = 0; k < 6; ++k)
        free(texts[k]);
}

static size_t count_lines(const char *text)
{
    size_t lines = 0;
    for (const char *c = text; *c; ++c)
        lines += *c == '\n';
    return lines;
}

#define BOTH_METHODS                                                                           \
    "run " FILE_NAME " --frames 1-6 --replicates 2 --out both"                                 \
    " --method certified --method aabb-tree"

TEST(mote_run_writes_a_row_a_frame_and_a_summary)
{
    write_file("", "\"count\": 12, \"near_pairs\": 2, \"speed\": 0.03, " SHAPES);
    mote_expect(0, "aabb-tree", BOTH_METHODS);
    assert_non_null(strstr(said, "b: 12 bodies of 400 triangles, 6 frames, 2 replicates"));
    char *text = whole_file("both/cells/*-r[12]-????????????????.csv");
    static const char begins[] =
        "frame,deform_ns,update_ns,query_ns,distance,lower,truth,error";
    assert_int_equal(strncmp(text, begins, strlen(begins)), 0);
    assert_non_null(
        strstr(text, ",motion_ns,bounds_ns,broad_ns,near_pairs,new_pairs,pair_contacts\n"));
    assert_int_equal(count_lines(text), 4 * 7);
    free(text);
    text = whole_file("both/summary.json");
    assert_non_null(strstr(text, "\"missed\": 0"));
    assert_null(strstr(text, "\"missed\": 1"));
    assert_non_null(strstr(text, "\"contacts_of\": \"aabb-tree\""));
    assert_non_null(strstr(text, "\"bodies\": 12"));
    assert_null(strstr(text, "\"status\": \"crashed\""));
    free(text);
}

/* Features for two bodies work for many: resuming, replicates, shards, jobs, comparing. */
TEST(mote_run_of_many_bodies_goes_the_road_of_two)
{
    write_file("", "\"count\": 12, \"near_pairs\": 2, \"speed\": 0.03, " SHAPES);
    if (file_exists("both"))
        assert_int_equal(folder_remove("both"), 0);
    mote_expect(0, "", BOTH_METHODS);
    mote_expect(0, "4 cells, 4 of them done", BOTH_METHODS);
    assert_int_equal(system("rm "
                            "both/cells/*certified-r2-*.json"),
                     0);
    mote_expect(0, "4 cells, 3 of them done", BOTH_METHODS);
    mote_expect(0, "b/certified/hot", "compare both both");
    mote_expect(0, "", "merge merged both");
    mote_expect(0, "certified", "summarize merged --format csv");
    mote_expect(0, "0 cells",
                "run " FILE_NAME " --frames 1-4 --shard 2/2 --method certified --out shard");
    mote_expect(
        0, "2 cells at once",
        "run " FILE_NAME
        " --frames 1-4 --replicates 2 --jobs 2 --cache evict --method certified --out jobs");
    mote_expect(0, "after 2 replicates the widest interval is",
                "run " FILE_NAME " --frames 1-4 --replicates 2 --until-ci 100%% --budget 0.001 "
                "--method certified --out until");
}

/* Two bodies and many in one run, each with the columns of its kind. */
TEST(mote_run_two_bodies_beside_many)
{
    write_file("", "\"count\": 12, \"near_pairs\": 2, \"speed\": 0.03, " SHAPES);
    mote_expect(
        0, "",
        "run tt " FILE_NAME
        " --frames 1-4 --replicates 1 --method certified --method brute-force --out mixed");
    char *text = whole_file("mixed/summary.json");
    assert_non_null(strstr(text, "\"scenario\": \"tt\""));
    assert_non_null(strstr(text, "\"scenario\": \"b\""));
    assert_non_null(strstr(text, "no form for several bodies"));
    free(text);
    mote_expect(4, "keys for more than two bodies",
                "run tt --frames 1-4 --method certified:threads=2 --out keys");
}

/* If only contacts are asked for, pairs that are apart get no row. */
TEST(mote_run_pairs_contacts_keeps_rows_of_contacts)
{
    static const char *const wishes[] = {"all", "contacts"};
    size_t lines[2], contacts[2] = {0, 0};
    write_file(", \"tolerance\": 0.02",
               "\"count\": 12, \"near_pairs\": 2, \"speed\": 0.03, " SHAPES);
    for (int k = 0; k < 2; ++k) {
        mote_expect(0, "",
                    "run " FILE_NAME " --frames 1-20 --replicates 1 --pairs %s --method "
                    "certified --out pairs-%s",
                    wishes[k], wishes[k]);
        char *files = mote_format("pairs-%s/cells/*.pairs.csv", wishes[k]);
        char *text = whole_file(files);
        lines[k] = count_lines(text) - 1;
        for (const char *at = strchr(text, '\n') + 1; *at; at = strchr(at, '\n') + 1) {
            const char *field = at;
            for (int f = 0; f < 6; ++f)
                field = strchr(field, ',') + 1;
            contacts[k] += *field == '1';
        }
        free(text);
        free(files);
    }
    assert_true(contacts[0] > 0 && lines[0] > contacts[0]);
    assert_int_equal(lines[1], contacts[0]);
    assert_int_equal(contacts[1], contacts[0]);
}

/* A scenario that is refused: further keys, the bodies, part of the message. */
typedef struct refusal {
    const char *more, *bodies, *text;
} refusal;

TEST(mote_bodies_load_bad_input_names_the_place)
{
    static const refusal cases[] = {
        {"", "\"count\": 0, \"box\": 4, " SHAPE, "bodies.count"},
        {"", "\"count\": -5, \"box\": 4, " SHAPE, "bodies.count"},
        {"", "\"count\": 1000001, \"box\": 4, " SHAPE, "1000000"},
        {"", "\"count\": 1e30, \"box\": 4, " SHAPE, "bodies.count"},
        {"", "\"count\": \"many\", \"box\": 4, " SHAPE, "bodies.count"},
        {"", "\"box\": 4, " SHAPE, "bodies.count"},
        {"", "\"count\": 5, \"box\": 0.5, " SHAPE, "smaller than a body"},
        {"", "\"count\": 5, \"box\": [4, 4, 0.2], " SHAPE, "smaller than a body"},
        {"", "\"count\": 5, \"box\": 0, " SHAPE, "bodies.box"},
        {"", "\"count\": 200, \"box\": 1.5, " SHAPE, "of the 200 bodies without overlap"},
        {"", "\"count\": 5, \"near_pairs\": 4, " SHAPE, "near pairs each"},
        {"", "\"count\": 5, \"near_pairs\": 0, " SHAPE, "bodies.near_pairs"},
        {"", "\"count\": 5, \"near_pairs\": 1, \"box\": 4, " SHAPE, "not both"},
        {"", "\"count\": 5, " SHAPE, "not neither"},
        {"", "\"count\": 2, \"box\": 4, \"places\": [[0, 0, 0], [0.05, 0, 0]], " SHAPE,
         "bodies 1 and 2 are"},
        {"", "\"count\": 2, \"box\": 4, \"places\": [[0, 0, 0], [1.9, 0, 0]], " SHAPE,
         "body 2 does not turn within the box"},
        {"", "\"count\": 3, \"box\": 4, \"places\": [[0, 0, 0], [1, 0, 0]], " SHAPE,
         "bodies.places"},
        {"", "\"count\": 2, \"near_pairs\": 0.1, \"places\": [[0, 0, 0], [1, 0, 0]], " SHAPE,
         "places go with a box"},
        {"", "\"count\": 5, \"box\": 4, \"shapes\": []", "bodies.shapes"},
        {"", "\"count\": 5, \"box\": 4", "bodies.shapes"},
        {"", "\"count\": 5, \"box\": 4, \"shapes\": [{\"letter\": \"W\"}]", "triangles"},
        {"", "\"count\": 5, \"box\": 4, \"motion\": 1, " SHAPE, "motion"},
        {"", "\"count\": 5, \"box\": 4, \"seed\": -1, " SHAPE, "bodies.seed"},
        {"", "\"count\": 5, \"box\": 4, \"speed\": -1, " SHAPE, "bodies.speed"},
        {", \"tolerance\": 0.2", "\"count\": 5, \"box\": 4, " SHAPE, "below the tolerance"},
        {"", "\"count\": 5, \"box\": [4, 4], " SHAPE, "array of 3"},
        {"", "\"count\": 5, \"box\": \"big\", " SHAPE, "array of 3"},
        {"", "\"count\": 5, \"box\": [0.2, 4, 4], " SHAPE, "smaller than a body"},
        {"", "\"count\": 5, \"box\": [4, 0.2, 4], " SHAPE, "smaller than a body"},
        {"", "\"count\": 2, \"box\": 4, \"places\": [[0, 0, 0], [0, -1.9, 0]], " SHAPE,
         "body 2 does not turn within the box"},
        {"", "\"count\": 2, \"box\": 4, \"places\": [[0, 0, 1.9], [0, 0, 0]], " SHAPE,
         "body 1 does not turn within the box"},
        {"", "\"count\": 2, \"box\": 4, \"places\": [[0, 0, \"x\"], [0, 0, 0]], " SHAPE,
         "bodies.places[0][2]"},
        {"", "\"count\": 5, \"box\": 4, \"near\": -1, " SHAPE, "bodies.near"},
        {"", "\"count\": 5, \"box\": 4, \"shapes\": [3]",
         "bodies.shapes[0]: is 3; give an object"},
        {"",
         "\"count\": 5, \"box\": 4, \"shapes\": [{\"letter\": \"T\", \"triangles\": 400, "
         "\"mass\": 1}]",
         "bodies.shapes[0].mass: unknown key"},
        {", \"pace\": 2", "\"count\": 5, \"box\": 4, " SHAPE, "pace"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; ++k) {
        mote_bodies *b = NULL;
        write_file(cases[k].more, cases[k].bodies);
        if (mote_bodies_load(FILE_NAME, &b) != MOTE_EINVAL)
            fail_msg("%s: not refused", cases[k].bodies);
        assert_null(b);
        if (!strstr(mote_error_text(), cases[k].text) ||
            !strstr(mote_error_text(), FILE_NAME ":"))
            fail_msg("%s: %s", cases[k].bodies, mote_error_text());
    }
}

TEST(mote_bodies_choice_read_keys_are_taken_apart)
{
    mote_method_choice c, own;
    assert_int_equal(mote_scene_choice_read("particle:threads=3,n=7,ahead=2,levels=1", &c),
                     MOTE_EINVAL);
    assert_int_equal(mote_scene_choice_read("particle-paper:threads=3,n=7,ahead=2", &c),
                     MOTE_OK);
    assert_int_equal(c.scene[MOTE_SCENE_THREADS], 3);
    assert_int_equal(c.scene[MOTE_SCENE_AHEAD], 2);
    assert_int_equal(mote_method_choice_read("particle-paper:n=7", &own), MOTE_OK);
    assert_memory_equal(c.values, own.values, sizeof own.values);
    assert_true(mote_method_choice_is_of_scenes(&c) && !mote_method_choice_is_of_scenes(&own));
    assert_string_equal(c.text, "particle-paper:threads=3,n=7,ahead=2");
    assert_int_equal(mote_scene_choice_read("fcl-aabb:refit=every", &c), MOTE_OK);
    assert_int_equal(c.scene[MOTE_SCENE_REFIT], MOTE_REFIT_EVERY);
    assert_int_equal(c.scene[MOTE_SCENE_THREADS], 1);
    static const char *const bad[][2] = {
        {"obb", "unknown method"},
        {"brute-force", "no form for several bodies"},
        {"fcl-obbrss", "no form for several bodies"},
        {"certified:threads=0", "threads must be a whole number"},
        {"certified:threads=257", "threads must be a whole number"},
        {"certified:ahead=65", "ahead must be a whole number"},
        {"certified:ahead=-1", "ahead must be a whole number"},
        {"certified:refit=near", "have refit="},
        {"certified:ahead=2,refit=every", "have refit="},
        {"certified:ahead=2,slack=0.1", "takes only threads= and ahead="},
        {"certified:slack=0.1", "takes only threads= and ahead="},
        {"fcl-aabb:refit=some", "near|every"},
        {"fcl-aabb:threads=2", "threads= is for"},
        {"fcl-aabb:queue=64", "takes only refit= and ahead="},
    };
    for (size_t k = 0; k < sizeof bad / sizeof bad[0]; ++k) {
        if (mote_scene_choice_read(bad[k][0], &c) == MOTE_OK &&
            mote_engine_check_choice(&c) == MOTE_OK)
            fail_msg("%s: not refused", bad[k][0]);
        if (!strstr(mote_error_text(), bad[k][1]))
            fail_msg("%s: %s", bad[k][0], mote_error_text());
    }
}

TEST(mote_run_bad_requests_have_their_exit_codes)
{
    static const struct {
        const char *line, *text;
        int code;
    } cases[] = {
        {"run " FILE_NAME " --method brute-force --replicates 1 --out "
         "none",
         "unsupported: brute-force has no form for several bodies", 0},
        {"run " FILE_NAME " --method nothing", "unknown method", 4},
        {"run " FILE_NAME " --frames 30-41 --method certified", "it has frames 1-40", 4},
        {"run " FILE_NAME " --pairs some", "expected all|contacts", 2},
        {"check " FILE_NAME, "6 bodies, 40 frames, ", 0},
        {"check " FILE_NAME " --json", "\"near_pairs\": ", 0},
        {"approach " FILE_NAME " --gaps 1:0.1 -o x.json", "several bodies", 4},
        {"run "
         "none.json --method certified",
         "none.json", 4},
        {"run " FILE_NAME " --method particle --replicates 1 --out "
         "auto",
         "unsupported", 0},
    };
    write_file("", "\"count\": 6, \"near_pairs\": 1, " SHAPES);
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; ++k) {
        mote_expect(cases[k].code, cases[k].text, "%s", cases[k].line);
    }
}

/* A run without cells. */
static const mote_summary no_cells;

static const char other_density[] =
    "{\"schema\": 1, \"rows\": [{\"label\": \"certified\", \"status\": \"ok\", "
    "\"bodies\": 20, \"near_pairs_wanted\": 1.5, \"active_total_ns\": {\"mean\": 2500000}, "
    "\"rss_peak_bytes\": 9000000}]}\n";

/* The figure has three densities; a run of another one has no point in it. */
TEST(mote_figure_bodies_without_a_point_is_missing)
{
    const mote_figure_run run = {.directory = "other", .summary = &no_cells};
    mote_figure figure = {0};
    assert_int_equal(mote_directory_make("other"), MOTE_OK);
    assert_int_equal(
        mote_file_write("other/summary.json", other_density, sizeof other_density - 1),
        MOTE_OK);
    assert_int_equal(mote_figure_bodies(&run, NULL, &figure), MOTE_OK);
    assert_int_equal(figure.data.size, 0);
    assert_non_null(strstr(figure.missing.data, "0.1, 1 or 4"));
    free(figure.missing.data);
}

/* Rows of summary.json, including one of a failed cell and one of two bodies. */
static const char stored[] =
    "{\"schema\": 1, \"rows\": [{\"label\": \"certified\", \"status\": \"ok\", "
    "\"bodies\": 1000, \"near_pairs_wanted\": 0.1, \"active_total_ns\": {\"mean\": 2500000}, "
    "\"rss_peak_bytes\": 9000000}, {\"label\": \"aabb-tree\", \"status\": \"timeout\", "
    "\"bodies\": 1000, \"near_pairs_wanted\": 0.1, \"active_total_ns\": null, "
    "\"rss_peak_bytes\": 1}, {\"label\": \"fcl-aabb:refit=every\", \"status\": \"ok\", "
    "\"bodies\": 1000, \"near_pairs_wanted\": 0.1, \"active_total_ns\": {\"mean\": 651e6}, "
    "\"rss_peak_bytes\": 7000000}, {\"label\": \"certified\", \"status\": \"ok\", "
    "\"active_total_ns\": {\"mean\": 7}, \"rss_peak_bytes\": 8}]}\n";

TEST(mote_figure_bodies_stored_rows_become_lines)
{
    const mote_figure_run run = {.directory = "stored", .summary = &no_cells};
    mote_figure figure = {0};
    assert_int_equal(mote_directory_make("stored"), MOTE_OK);
    (void)remove("stored/summary.json");
    assert_int_equal(mote_figure_bodies(&run, NULL, &figure), MOTE_OK);
    assert_int_equal(figure.data.size, 0);
    assert_non_null(strstr(figure.missing.data, "make bodies"));
    free(figure.missing.data);
    figure = (mote_figure){0};
    assert_int_equal(mote_file_write("stored/summary.json", stored, sizeof stored - 1),
                     MOTE_OK);
    assert_int_equal(mote_figure_bodies(&run, NULL, &figure), MOTE_OK);
    assert_null(figure.missing.data);
    assert_int_equal(test_count(figure.data.data, "\"\n"), 18);          /* blocks */
    assert_int_equal(test_count(figure.data.data, "NaN NaN NaN\n"), 16); /* empty ones */
    assert_non_null(strstr(figure.data.data, "\"certified\"\n1000 2500 9\n"));
    assert_non_null(strstr(figure.caption.data, "1/260 of the time"));
    free(figure.data.data);
    free(figure.caption.data);
}
