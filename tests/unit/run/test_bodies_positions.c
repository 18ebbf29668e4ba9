/* Scenes of many bodies of which some have positions instead of a field: what they show against
   the closed form, near pairs and distances against brute force over all pairs, bad input. */
#include "harness/loop/stage.h"
#include "harness/run/scene_check.h"
#include "harness/run/subject.h"
#include "tests/support/mote.h"
#include "tests/support/sheet.h"
#include "tests/support/solids.h"
#include "tests/support/test.h"

#define FRAMES 12
#define COUNT 9

TEST_EACH(folder_next, NULL);

static const char form[] = "{\"purpose\": \"p\", \"frames\": %d, \"ask\": \"distance\", "
                           "\"tolerance\": 0.02, \"bodies\": {%s}}";

#define LETTERS                                                                                \
    ", {\"letter\": \"T\", \"triangles\": 400}, {\"letter\": \"W\", \"triangles\": 400, "      \
    "\"field\": {\"count\": 6, \"support\": 0.5, \"displacement\": {\"random\": {\"seed\": "   \
    "5, \"amplitude\": 0.05, \"periods\": [40, 90]}}}}]"
#define SHEETS "\"shapes\": [{\"positions\": \"s01.obj\"}"
#define MOVING "\"count\": 9, \"near_pairs\": 2, \"speed\": 0.05, \"spin\": 4, "

static void write_scene(int frames, const char *bodies)
{
    char *text = mote_format(form, frames, bodies);
    file_put("b.json", text);
    free(text);
}

static void write_sheets(void)
{
    for (int k = 1; k <= FRAMES; ++k) {
        char name[16];
        (void)snprintf(name, sizeof name, "s%02d.obj", k);
        sheet_write_obj(name, k);
    }
    sheet_write_pc2("s.pc2", FRAMES, false);
}

static mote_subject load(const char *bodies)
{
    mote_subject subject = {0};
    write_sheets();
    write_scene(FRAMES, bodies);
    if (mote_subject_load("./b.json", &subject) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    return subject;
}

static const mote_body *body_of(const mote_bodies *b, uint32_t i)
{
    return &b->shapes[b->shape_of[i]].body;
}

/* Each vertex is where the pose puts the sheet's vertex of that frame. */
TEST(positions_of_bodies_follow_sequence_and_pose)
{
    static const char *const sheets[] = {SHEETS LETTERS,
                                         "\"shapes\": [{\"file\": \"s01.obj\", \"positions\": "
                                         "\"s.pc2\"}" LETTERS};
    uint64_t fingerprint[2];
    for (int k = 0; k < 2; ++k) {
        char *text = mote_format(MOVING "%s", sheets[k]);
        mote_subject subject = load(text);
        free(text);
        const mote_bodies *b = subject.bodies;
        mote_subject_frame frame = mote_subject_frame_create(&subject, 0);
        fingerprint[k] = subject.fingerprint;
        for (uint32_t f = FRAMES; f >= 1; --f) { /* any order */
            assert_int_equal(mote_subject_frame_set(&subject, f, 0, &frame), MOTE_OK);
            for (uint32_t i = 0; i < b->count; ++i) {
                const mote_body_state *state = &frame.states[i];
                if (b->shape_of[i] != 0) {
                    assert_null(state->vertices);
                    continue;
                }
                for (int v = 0; v < SHEET_VERTICES; ++v) {
                    const mote_vec3 rest = {sheet_at(v, 0, f), sheet_at(v, 1, f),
                                            sheet_at(v, 2, f)};
                    const mote_vec3 wanted = mote_pose_apply(&state->pose, rest);
                    assert_true(mote_distance_squared(state->vertices[v], wanted) == 0);
                }
            }
        }
        mote_subject_frame_free(&frame);
        mote_subject_free(&subject);
    }
    assert_true(fingerprint[0] == fingerprint[1]); /* both formats hold the same bits */
}

/* The distance of two bodies in a frame by comparing all their triangles. */
static double brute_force(const mote_bodies *b, const mote_body_state *states, uint32_t i,
                          uint32_t j)
{
    const mote_body pair[2] = {*body_of(b, i), *body_of(b, j)};
    const mote_frame frame = {.number = 1, .body = {states[i], states[j]}};
    mote_engine *engine = NULL;
    mote_answer answer;
    if (mote_engine_open_distance(pair, "brute-force", &engine) != MOTE_OK ||
        mote_engine_answer(engine, &frame, &answer) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    mote_engine_destroy(engine);
    return answer.distance;
}

static const mote_answer *find(const mote_engine *engine, uint32_t i, uint32_t j)
{
    size_t count;
    const mote_near_pair *pairs = mote_engine_pairs(engine, &count);
    for (size_t k = 0; k < count; ++k) {
        if (pairs[k].body[0] == i && pairs[k].body[1] == j)
            return &pairs[k].answer;
    }
    return NULL;
}

static const char *const exact[] = {
    "stream",   "stream:threads=2",      "stream:positions=deform", "aabb-tree",
    "fcl-aabb", "aabb-tree:refit=every", "fcl-aabb:refit=every"};
#define EXACT ROWS_OF(exact)

static mote_status open_engine(const mote_subject *subject, const char *text,
                               mote_engine **engine)
{
    mote_method_choice choice;
    mote_engine_setup setup = mote_subject_engine(subject);
    setup.seed = 1;
    mote_status status = mote_scene_choice_read(text, &choice);
    if (status == MOTE_OK)
        status = mote_engine_create(&setup, &choice, engine);
    return status == MOTE_OK ? mote_engine_build(*engine) : status;
}

/* Counts the pairs that the engines were asked about and that are in contact. */
static void check_frame(const mote_subject *subject, const mote_body_state *states,
                        mote_engine *const *engines, int *near, int *contacts)
{
    const mote_bodies *b = subject->bodies;
    for (uint32_t i = 0; i < b->count; ++i) {
        for (uint32_t j = i + 1; j < b->count; ++j) {
            const double truth = brute_force(b, states, i, j);
            const bool contact = truth <= b->tolerance;
            *near += truth <= b->near;
            *contacts += contact;
            for (size_t m = 0; m < EXACT; ++m) {
                const mote_answer *answer = find(engines[m], i, j);
                assert_true(answer || truth > b->near);
                if (!answer)
                    continue;
                test_row("%s", exact[m]);
                assert_close(answer->distance, truth, 1e-12 * b->length);
                assert_int_equal(answer->contact, contact);
            }
        }
    }
}

static void check_scene(const char *bodies)
{
    mote_subject subject = load(bodies);
    mote_subject_frame frame = mote_subject_frame_create(&subject, 0);
    mote_engine *engines[EXACT] = {0}, *particles = NULL;
    int near = 0, contacts = 0;
    for (size_t m = 0; m < EXACT; ++m) {
        if (open_engine(&subject, exact[m], &engines[m]) != MOTE_OK)
            fail_msg("%s: %s", exact[m], mote_error_text());
    }
    assert_int_equal(open_engine(&subject, "particle:n=8", &particles), MOTE_OK);
    for (uint32_t f = 1; f <= FRAMES; ++f) {
        mote_engine_cost cost;
        assert_int_equal(mote_subject_frame_set(&subject, f, f - 1, &frame), MOTE_OK);
        for (size_t m = 0; m < EXACT; ++m) {
            mote_engine_show(engines[m], frame.states);
            assert_int_equal(mote_engine_ask(engines[m], &cost), MOTE_OK);
        }
        mote_engine_show(particles, frame.states);
        assert_int_equal(mote_engine_ask(particles, &cost), MOTE_OK);
        check_frame(&subject, frame.states, engines, &near, &contacts);
    }
    assert_true(near > contacts && contacts > 0);
    for (size_t m = 0; m < EXACT; ++m)
        mote_engine_destroy(engines[m]);
    mote_engine_destroy(particles);
    mote_subject_frame_free(&frame);
    mote_subject_free(&subject);
}

TEST(bodies_with_positions_and_with_fields_agree_with_brute_force)
{
    check_scene(MOVING SHEETS LETTERS);
}

TEST(bodies_that_all_have_positions_agree_with_brute_force)
{
    check_scene(MOVING SHEETS "]");
}

TEST(mote_scene_check_judges_bodies_with_positions)
{
    mote_subject subject = load(MOVING SHEETS LETTERS);
    mote_scene_facts facts;
    assert_int_equal(mote_scene_check(&subject, &facts), MOTE_OK);
    assert_true(facts.checked > 0 && facts.near_pairs > 1 && facts.contacts > 0);
    mote_subject_free(&subject);
}

TEST(what_needs_fields_says_so)
{
    mote_subject subject = load(MOVING SHEETS LETTERS);
    mote_engine *engine = NULL;
    assert_int_equal(open_engine(&subject, "certified", &engine), MOTE_EUNSUPPORTED);
    assert_non_null(strstr(mote_error_text(), "of shape 1 only positions are given"));
    mote_method_choice choice;
    mote_stage *stage = NULL;
    const mote_simulation_options options = {.density = 1, .tolerance = 0.01, .time_step = 1};
    assert_int_equal(mote_scene_choice_read("stream", &choice), MOTE_OK);
    assert_int_equal(mote_stage_create(&subject, &choice, &options, NULL, &stage),
                     MOTE_EUNSUPPORTED);
    assert_non_null(strstr(mote_error_text(), "of shape 1 only positions are given"));
    mote_subject_free(&subject);
}

TEST(a_position_that_is_not_finite_names_the_body)
{
    mote_subject subject = load(MOVING SHEETS LETTERS);
    mote_subject_frame frame = mote_subject_frame_create(&subject, 0);
    assert_int_equal(mote_subject_frame_set(&subject, 3, 0, &frame), MOTE_OK);
    frame.scene.states[3].vertices = NULL;
    mote_vec3 spoilt[SHEET_VERTICES] = {{0, 0, 0}};
    for (size_t m = 0; m < EXACT; ++m) {
        for (int v = 0; v < SHEET_VERTICES; v += SHEET_VERTICES - 1) {
            mote_engine *engine = NULL;
            mote_engine_cost cost;
            memset(spoilt, 0, sizeof spoilt);
            spoilt[v].y = v == 0 ? (double)NAN : (double)INFINITY;
            frame.scene.states[3].vertices = spoilt;
            assert_int_equal(open_engine(&subject, exact[m], &engine), MOTE_OK);
            mote_engine_show(engine, frame.states);
            test_row("%s", exact[m]);
            assert_int_equal(mote_engine_ask(engine, &cost), MOTE_EINVAL);
            if (strncmp(mote_error_text(), "body 4: ", 8) != 0) /* counted from 1 */
                fail_msg("%s", mote_error_text());
            mote_engine_destroy(engine);
        }
    }
    mote_subject_frame_free(&frame);
    mote_subject_free(&subject);
}

typedef struct refusal {
    const char *bodies, *text;
    int frames;
} refusal;

TEST(positions_of_bodies_that_are_wrong_are_refused)
{
    static const refusal cases[] = {
        {MOVING "\"shapes\": [{\"positions\": \"s01.obj\", \"field\": {\"count\": 3}}]",
         "either a field, a character or positions", FRAMES},
        {MOVING "\"shapes\": [{\"positions\": \"s01.obj\", \"letter\": \"W\"}]",
         "bring their own mesh", FRAMES},
        {MOVING "\"shapes\": [{\"positions\": \"sheet.obj\"}]", "no number", FRAMES},
        {MOVING "\"shapes\": [{\"positions\": 3}]", "positions", FRAMES},
        {MOVING SHEETS LETTERS, "s13.obj", FRAMES + 1},
        {MOVING "\"shapes\": [{\"file\": \"s01.obj\", \"positions\": \"s.pc2\"}]", "12 frames",
         FRAMES + 1},
        {MOVING "\"shapes\": [{\"letter\": \"W\", \"triangles\": 400, \"positions\": "
                "\"s.pc2\"}]",
         "25", FRAMES},
    };
    write_sheets();
    for (size_t k = 0; k < ROWS_OF(cases); ++k) {
        mote_bodies *b = NULL;
        test_row("%s", cases[k].bodies);
        write_scene(cases[k].frames, cases[k].bodies);
        assert_true(mote_bodies_load("./b.json", &b) != MOTE_OK);
        assert_null(b);
        if (!strstr(mote_error_text(), cases[k].text))
            fail_msg("%s", mote_error_text());
    }
}

/* Frame 7 is found to be bad when its fingerprint is taken, before anything is measured, though
   no pose between is looked at. */
TEST(a_frame_with_another_topology_is_named)
{
    mote_subject subject = {0};
    write_sheets();
    file_put("s07.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    write_scene(FRAMES, MOVING SHEETS LETTERS);
    const mote_status status = mote_subject_load("./b.json", &subject);
    assert_int_equal(status, MOTE_EINVAL);
    assert_non_null(strstr(mote_error_text(), "s07.obj"));
    mote_subject_free(&subject);
}

TEST(recorded_motion_shows_only_frames_that_there_are)
{
    static const struct {
        double shown;
        bool right;
    } cases[] = {{1, true}, {2, true}, {1.5, true}, {0.5, false}, {2.5, false}};
    write_sheets();
    write_scene(2, "\"count\": 2, \"box\": 9, \"poses\": \"b.csv\", " SHEETS "]");
    for (size_t k = 0; k < ROWS_OF(cases); ++k) {
        mote_bodies *b = NULL;
        char *text = mote_format("frame,body,deformation,x,y,z,qw,qx,qy,qz\n"
                                 "1,1,1,0,0,0,1,0,0,0\n1,2,2,2,0,0,1,0,0,0\n"
                                 "2,1,1,0,0,0,1,0,0,0\n2,2,%g,2,0,0,1,0,0,0\n",
                                 cases[k].shown);
        file_put("b.csv", text);
        free(text);
        test_row("%g", cases[k].shown);
        const mote_status status = mote_bodies_load("./b.json", &b);
        assert_int_equal(status, cases[k].right ? MOTE_OK : MOTE_EINVAL);
        if (status == MOTE_OK) { /* frame 2 of body 2: between frames 1 and 2 of the sheet */
            mote_bodies_frame frame = mote_bodies_frame_create(b);
            assert_int_equal(mote_bodies_frame_set(b, 2, &frame), MOTE_OK);
            const double fall = frame.states[1].vertices[0].z - frame.states[0].vertices[0].z;
            assert_close(fall, (1 - cases[k].shown) / 64, 1e-15);
            mote_bodies_frame_free(&frame);
        } else {
            assert_non_null(strstr(mote_error_text(), "b.csv:5: shows frame"));
        }
        mote_bodies_destroy(b);
    }
}
