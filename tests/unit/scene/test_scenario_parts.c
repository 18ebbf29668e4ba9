/* Parts of scenarios that few use: names, folders, pairs of odd files, recorded poses. */
#include "harness/base/file.h"
#include "harness/scene/bodies_poses.h"
#include "harness/scene/scenario_move.h"
#include "harness/scene/scenario_read.h"
#include "harness/scene/spread.h"
#include "tests/support/bar.h"
#include "tests/support/diamond.h"
#include "tests/support/mote.h"
#include "tests/support/sheet.h"
#include "tests/support/test.h"

#include <math.h>
#include <sys/stat.h>
#include <unistd.h>

#define SCENE(head, first, second)                                                             \
    "{\"purpose\": \"x\", " head ", \"bodies\": [{" first "}, {" second "}]}\n"
#define FRAMES "\"frames\": 3, \"ask\": \"distance\""
#define DIAMOND_FILE "\"file\": \"d.obj\""

static int put_files(void)
{
    if (folder_next() != 0)
        return -1;
    file_put("d.obj", DIAMOND);
    bar_write("bar.x", bar_default());
    for (int k = 1; k <= 3; ++k) {
        char name[16];
        (void)snprintf(name, sizeof name, "f%d.obj", k);
        sheet_write_obj(name, k);
    }
    sheet_write_pc2("c.pc2", 3, false);
    return 0;
}

TEST_EACH(put_files, NULL);

static const struct {
    const char *text, *says;
} odd_values[] = {
    {SCENE("\"frames\": 1, \"ask\": \"impact\", \"step\": 1", DIAMOND_FILE, DIAMOND_FILE),
     "s.json:1: ask: one frame alone; an impact is between two of them"},
    {SCENE(FRAMES ", \"step\": 1", DIAMOND_FILE, DIAMOND_FILE),
     "s.json:1: step: a step is of scenarios that ask for impact"},
    {SCENE("\"frames\": 3, \"ask\": \"impact\", \"step\": 2", DIAMOND_FILE,
           "\"positions\": \"f1.obj\""),
     "s.json:1: ask: s: the paths of body 1's vertices between frames are not known"},
    {SCENE(FRAMES, "\"positions\": \"f1.obj\", \"field\": {}", DIAMOND_FILE),
     "s.json:1: bodies[0]: either a field, a character or positions; give one of them"},
    {SCENE(FRAMES, "\"positions\": \"f1.obj\", \"character\": \"bar.x\"", DIAMOND_FILE),
     "s.json:1: bodies[0]: either a field, a character or positions; give one of them"},
    {SCENE(FRAMES, "\"positions\": \"f1.obj\", \"scale\": 0", DIAMOND_FILE),
     "s.json:1: bodies[0].scale: 0 is out of range"},
    {SCENE(FRAMES, "\"positions\": \"f1.obj\", \"scale\": [1, 2]", DIAMOND_FILE),
     "s.json:1: bodies[0].scale: is an array of 2; give an array of 3"},
    {SCENE(FRAMES, "\"letter\": \"W\", \"triangles\": 401, \"positions\": \"c.pc2\"",
           DIAMOND_FILE),
     "bodies[0].letter: "},
    {SCENE(FRAMES, "\"letter\": \"W\", \"triangles\": 400, \"positions\": \"c.pc2\"",
           DIAMOND_FILE),
     "c.pc2: 25 vertices, and the mesh has "},
    {SCENE(FRAMES, "\"file\": \"d.obj\", \"positions\": \"c.pc2\"", DIAMOND_FILE),
     "c.pc2: 25 vertices, and the mesh has 6; give the mesh that the cache was made of"},
    {SCENE(FRAMES, "\"file\": 3, \"positions\": \"c.pc2\"", DIAMOND_FILE),
     "bodies[0].file: is 3; give a string"},
    {SCENE(FRAMES, "\"positions\": 3", DIAMOND_FILE),
     "bodies[0].positions: is 3; give a string"},
    {SCENE(FRAMES, DIAMOND_FILE ", \"scale\": 1e16", DIAMOND_FILE),
     "s.json:1: bodies[0].scale: 10000000000000000 is out of range"},
    {SCENE(FRAMES, DIAMOND_FILE ", \"scale\": true", DIAMOND_FILE),
     "bodies[0].scale: is true; give a number or an array of 3"},
    {SCENE(FRAMES, DIAMOND_FILE ", \"field\": 3", DIAMOND_FILE),
     "bodies[0].field: is 3; give an object"},
    {SCENE(FRAMES, DIAMOND_FILE ", \"field\": {\"kind\": \"soft\"}", DIAMOND_FILE),
     "bodies[0].field.kind: unknown kind soft; known are csrbf"},
    {SCENE(FRAMES, DIAMOND_FILE ", \"field\": {\"kind\": 3}", DIAMOND_FILE),
     "bodies[0].field.kind: is 3; give a string"},
    {SCENE(FRAMES, DIAMOND_FILE ", \"field\": {\"kind\": \"stretch\", \"a\": \"b\"}",
           DIAMOND_FILE),
     "bodies[0].field.a: unknown key; known here are kind"},
    {SCENE(FRAMES, DIAMOND_FILE ", \"field\": {\"count\": 7, \"support\": 1}", DIAMOND_FILE),
     "bodies[0].field.count: the mesh has only 6 different positions, not 7"},
    {SCENE(FRAMES, DIAMOND_FILE ", \"triangles\": \"400\"", DIAMOND_FILE),
     "bodies[0].triangles: is a string; give a whole number from 400 to 20000000"},
    {SCENE(FRAMES, DIAMOND_FILE, DIAMOND_FILE ", \"clip\": 1"),
     "bodies[1].clip: clip without a character"},
    {SCENE(FRAMES, "\"positions\": \"f1.obj\", \"loop\": true", DIAMOND_FILE),
     "bodies[0].loop: loop without a character"},
    {SCENE(FRAMES, DIAMOND_FILE ", \"letter\": \"W\", \"positions\": \"c.pc2\"", DIAMOND_FILE),
     "bodies[0]: a letter and a file; give one of them with the cache"},
    {SCENE(FRAMES ", \"frames|ask\": 1", DIAMOND_FILE, DIAMOND_FILE),
     "s.json:1: frames|ask: unknown key"},
    {SCENE(FRAMES, "\"character\": \"bar.x\", \"scale\": 0", DIAMOND_FILE),
     "bodies[0].scale: 0 is out of range"},
    {SCENE(FRAMES, DIAMOND_FILE,
           DIAMOND_FILE ", \"motion\": [{\"frame\": 2, "
                        "\"position\": [0, 0, 0]}, {\"frame\": 2, "
                        "\"position\": [0, 0, 0]}]"),
     "bodies[1].motion: "},
};

TEST(scenario_of_odd_values_is_refused_with_their_place)
{
    for (size_t i = 0; i < ROWS_OF(odd_values); ++i) {
        mote_scenario *scenario = NULL;
        test_row("%s", odd_values[i].text);
        file_put("s.json", odd_values[i].text);
        assert_int_equal(mote_scenario_load("s.json", &scenario), MOTE_EINVAL);
        const char *text = mote_error_text();
        /* Its place is told once. */
        if (!strstr(text, odd_values[i].says) || strncmp(text, "s.json:1: ", 10) != 0 ||
            strstr(text + 1, "s.json:1: "))
            fail_msg("%s", text);
        assert_null(scenario);
    }
}

static mote_scenario *load(const char *name)
{
    mote_scenario *scenario = NULL;
    if (mote_scenario_load(name, &scenario) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    return scenario;
}

static uint64_t fingerprint_of(const char *name)
{
    uint64_t fingerprint = 0;
    mote_scenario *scenario = load(name);
    assert_int_equal(mote_scenario_fingerprint(scenario, &fingerprint), MOTE_OK);
    mote_scenario_destroy(scenario);
    return fingerprint;
}

/* Questions for impacts span 1 to frames - 1 frames. */
TEST(scenario_asks_for_impacts_within_its_frames)
{
    static const uint32_t wrong[] = {0, 3, 4, UINT32_MAX};
    file_put("s.json", SCENE(FRAMES, DIAMOND_FILE, DIAMOND_FILE));
    mote_scenario *s = load("s.json");
    for (size_t i = 0; i < ROWS_OF(wrong); ++i) {
        assert_int_equal(mote_scenario_ask_impacts(s, wrong[i]), MOTE_EINVAL);
        assert_non_null(strstr(mote_error_text(), "it has 3 frames, so that a step is 1 to 2"));
        assert_int_equal(s->ask, MOTE_ASK_DISTANCE);
    }
    assert_int_equal(mote_scenario_ask_impacts(s, 2), MOTE_OK);
    assert_true(s->ask == MOTE_ASK_IMPACT && s->step == 2);
    mote_scenario_destroy(s);
}

TEST(scenario_name_has_no_control_characters)
{
    file_put("a\tb\x7f.json", SCENE(FRAMES, DIAMOND_FILE, DIAMOND_FILE));
    mote_scenario *s = load("a\tb\x7f.json");
    assert_string_equal(s->name, "a_b_");
    mote_scenario_destroy(s);
}

/* Either body may have positions; both are found from a folder above, and an object that the
   other scenario does not have is added to it. */
TEST(scenario_like_one_below_finds_positions_and_adds_objects)
{
    assert_int_equal(mkdir("in", 0700), 0);
    for (int k = 1; k <= 3; ++k) {
        char from[16], to[16];
        (void)snprintf(from, sizeof from, "f%d.obj", k);
        (void)snprintf(to, sizeof to, "in/f%d.obj", k);
        assert_int_equal(rename(from, to), 0);
    }
    assert_int_equal(rename("d.obj", "in/d.obj"), 0);
    file_put("in/s.json", SCENE(FRAMES, DIAMOND_FILE, "\"positions\": \"f1.obj\""));
    file_put("like.json", "{\"purpose\": \"y\", \"like\": \"in/s.json\"}");
    assert_true(fingerprint_of("like.json") == fingerprint_of("in/s.json"));
    file_put("more.json", "{\"like\": \"in/s.json\", \"bodies\": [{\"field\": {\"count\": 3, "
                          "\"support\": 1, \"displacement\": {\"random\": {\"seed\": 1, "
                          "\"amplitude\": 0.1, \"periods\": [9, 9]}}}}, {}]}");
    mote_scenario *more = load("more.json");
    assert_int_equal(more->body[0].field->count, 3);
    mote_scenario_destroy(more);
}

/* Two bodies in the place of several: null leaves a key out of them, too. */
TEST(scenario_like_one_of_several_bodies_may_leave_keys_out)
{
    file_put("c.json",
             "{\"purpose\": \"x\", " FRAMES ", \"bodies\": {\"count\": 2, \"box\": 9, "
             "\"shapes\": [{" DIAMOND_FILE "}]}}");
    file_put("like.json", "{\"like\": \"c.json\", \"bodies\": [{" DIAMOND_FILE
                          ", \"field\": null}, {" DIAMOND_FILE "}]}");
    mote_scenario *s = load("like.json");
    assert_int_equal(s->body[0].field->count, 0);
    mote_scenario_destroy(s);
}

/* Files whose names have colons or no ending, and a direction that is a file. */
TEST(pair_of_files_with_odd_names)
{
    static const struct {
        const char *file, *pair, *name;
    } rows[] = {
        {"a:b.x", "pair:a:b.x:bar.x", "a:b-bar"},
        {"bar", "pair:bar:bar.x", "bar-bar"},
        {".x", "pair:.x:bar", ".x-bar"},
        {"1,2,3", "pair:bar.x:1,2,3", "bar-1,2,3"},
    };
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        test_row("%s", rows[i].pair);
        bar_write(rows[i].file, bar_default());
        mote_scenario *s = load(rows[i].pair);
        assert_string_equal(s->name, rows[i].name);
        mote_scenario_destroy(s);
    }
}

/* A clip of no length moves nothing, so the mesh gets control points; a damaged character is
   not taken for a mesh. */
TEST(pair_of_characters_that_stand_still_or_are_damaged)
{
    bar_text part = bar_default();
    part.rotations = "0;4;1.0,0.0,0.0,0.0;;;";
    part.rotation_count = "1";
    bar_write("still.x", part);
    mote_scenario *s = load("pair:still.x:d.obj");
    assert_null(s->motion->body[0].player);
    assert_true(s->body[0].field->count > 0);
    mote_scenario_destroy(s);
    part.bind = "1e39,0.0,0.0,1.0";
    bar_write("bad.x", part);
    assert_int_equal(mote_scenario_load("pair:d.obj:bad.x", &s), MOTE_EINVAL);
    assert_non_null(strstr(mote_error_text(), "bad.x: the matrix of bone Upper is not finite"));
}

TEST(character_plays_as_its_body_says)
{
    static const struct {
        const char *more;
        bool loop;
        double frames;
    } rows[] = {{"", true, 60},
                {", \"loop\": true", true, 60},
                {", \"loop\": false", false, 60},
                {", \"speed\": -2", true, 30},
                {", \"speed\": 0", true, 1}};
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        char *text = mote_format(SCENE(FRAMES, "\"character\": \"bar.x\"%s", DIAMOND_FILE),
                                 rows[i].more);
        test_row("%s", rows[i].more);
        file_put("s.json", text);
        mote_scenario *s = load("s.json");
        const mote_player *player = s->motion->body[0].player;
        assert_int_equal(player->loop, rows[i].loop);
        assert_true(fabs(mote_player_frames(player) - rows[i].frames) < 1e-9);
        mote_scenario_destroy(s);
        free(text);
    }
}

/* A folder that begins like another one is another one; all files lie in the root. */
TEST(fence_tells_folders_by_their_whole_names)
{
    assert_int_equal(mkdir("own", 0700) + mkdir("own2", 0700), 0);
    assert_int_equal(rename("d.obj", "own2/d.obj"), 0);
    file_put("own/s.json",
             SCENE(FRAMES, "\"file\": \"../own2/d.obj\"", "\"file\": \"../own2/d.obj\""));
    mote_expect(4, "lies outside of the scenario's folder", "check own/s.json");
    mote_expect(4, "lies outside of the scenario's folder", "--allow own check own/s.json");
    mote_expect(0, "3 frames", "--allow own2 check own/s.json");
    mote_expect(0, "3 frames", "--allow / check own/s.json");
}

/* Positions, clips that do not loop and keyed fields end: bodies that show them begin at their
   beginning, and others at times of their own. */
TEST(crowd_whose_deformation_ends_begins_at_its_beginning)
{
    mote_bodies *bodies = NULL;
    file_put("c.json",
             "{\"purpose\": \"x\", " FRAMES ", \"bodies\": {\"count\": 4, \"box\": 40, "
             "\"shapes\": [{\"positions\": \"f1.obj\"}, {\"character\": \"bar.x\", \"loop\": "
             "false}, {" DIAMOND_FILE ", \"field\": {\"count\": 1, \"support\": 1, "
             "\"displacement\": {\"keyframes\": [{\"frame\": 1, \"vectors\": [[0, 0, 0]]}, "
             "{\"frame\": 3, \"vectors\": [[0, 0, 0.1]]}]}}}, {\"character\": \"bar.x\"}]}}");
    if (mote_bodies_load("c.json", &bodies) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    for (uint32_t i = 0; i < 4; ++i)
        assert_true((bodies->paths[i].time == 0) == (i < 3));
    mote_bodies_destroy(bodies);
}

/* One frame alone has the near pairs that are asked for. */
TEST(crowd_of_one_frame_has_its_near_pairs)
{
    mote_bodies *bodies = NULL;
    file_put("c.json", "{\"purpose\": \"x\", \"frames\": 1, \"ask\": \"contact\", \"bodies\": "
                       "{\"count\": 60, \"near_pairs\": 1, \"near\": 0.3, \"shapes\": "
                       "[{" DIAMOND_FILE "}]}}");
    if (mote_bodies_load("c.json", &bodies) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    assert_true(bodies->near_pairs > 0.8 && bodies->near_pairs < 1.25);
    mote_bodies_destroy(bodies);
}

/* Makes in/s.json of this text fit for a file elsewhere; the first body's name there, or the
   error. The caller frees it. */
static char *moved_name(const char *text, const char *key, const char *to)
{
    mote_json_file file;
    file_put("in/s.json", text);
    assert_int_equal(mote_scenario_open("in/s.json", &file), MOTE_OK);
    const mote_status status = mote_scenario_move(&file, to);
    json_t *bodies = json_object_get(file.root, "bodies");
    json_t *list = json_is_object(bodies) ? json_object_get(bodies, "shapes") : bodies;
    const char *name = json_string_value(json_object_get(json_array_get(list, 0), key));
    char *told = mote_format("%s", status == MOTE_OK ? (name ? name : "") : mote_error_text());
    mote_json_close(&file);
    return told;
}

/* A file below the new folder keeps its place; one elsewhere is copied beside the new file. */
TEST(scenario_moved_names_its_files_from_there)
{
    static const char of_file[] = SCENE(FRAMES, DIAMOND_FILE, "\"letter\": \"T\""),
                      of_bar[] = SCENE(FRAMES, "\"character\": \"bar.x\"", DIAMOND_FILE),
                      of_bare[] = SCENE(FRAMES, "\"character\": \"bar\"", DIAMOND_FILE),
                      of_two[] = SCENE(FRAMES, "\"character\": \"c.gltf\"", DIAMOND_FILE),
                      of_many[] = "{\"purpose\": \"x\", " FRAMES ", \"bodies\": {\"count\": 2, "
                                  "\"box\": 9, \"shapes\": [{" DIAMOND_FILE "}]}}",
                      of_none[] = SCENE(FRAMES, "\"file\": \"none.obj\"", DIAMOND_FILE);
    static const struct {
        const char *text, *key, *to, *name, *copy;
    } rows[] = {
        {of_file, "file", "in/t.json", "d.obj", NULL},
        {of_file, "file", "t.json", "in/d.obj", NULL},
        {of_file, "file", "in2/t.json", "t-body0.obj", "in2/t-body0.obj"},
        {of_file, "file", "in2/plain", "plain-body0.obj", "in2/plain-body0.obj"},
        {of_bar, "character", "in2/b.json", "b-body0.x", "in2/b-body0.x"},
        {of_bar, "character", "in2/b", "b-body0.x", "in2/b-body0.x"},
        {of_bare, "character", "in2/c.json", "c-body0", "in2/c-body0"},
        {of_many, "file", "in2/m.json", "m-body0.obj", "in2/m-body0.obj"},
        {of_file, "file", "none/t.json", "none/: No such file or directory; name an existing",
         NULL},
        {of_none, "file", "in2/n.json", "in/none.obj: No such file or directory", NULL},
        {of_two, "character", "in2/g.json", "c.gltf: cannot be copied alone (", NULL},
    };
    assert_int_equal(mkdir("in", 0700) + mkdir("in2", 0700), 0);
    assert_int_equal(rename("d.obj", "in/d.obj"), 0);
    bar_write("in/bar.x", bar_default());
    bar_write("in/bar", bar_default());
    file_put("in/c.gltf", "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"uri\":\"c.bin\","
                          "\"byteLength\":8}]}");
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        test_row("%zu: %s", i, rows[i].to);
        char *told = moved_name(rows[i].text, rows[i].key, rows[i].to);
        if (!strstr(told, rows[i].name) || (rows[i].copy && strcmp(told, rows[i].name) != 0))
            fail_msg("%s", told);
        assert_true(!rows[i].copy || file_exists(rows[i].copy));
        free(told);
    }
    assert_false(file_exists("in2/g-body0.gltf"));
}

TEST(scenario_moved_to_the_folder_of_the_process_names_its_copy)
{
    mote_json_file file;
    assert_int_equal(mkdir("in", 0700), 0);
    assert_int_equal(rename("d.obj", "in/d.obj"), 0);
    file_put("in/s.json", SCENE(FRAMES, DIAMOND_FILE, DIAMOND_FILE));
    assert_int_equal(mkdir("here", 0700) + chdir("here"), 0);
    assert_int_equal(mote_scenario_open("../in/s.json", &file), MOTE_OK);
    const mote_status status = mote_scenario_move(&file, "w.json");
    const bool copied = file_exists("w-body0.obj") && !file_exists("w-body1.obj");
    assert_int_equal(chdir(".."), 0);
    assert_int_equal(status, MOTE_OK);
    assert_true(copied); /* both bodies are one mesh */
    for (size_t i = 0; i < 2; ++i) {
        const json_t *body = json_array_get(json_object_get(file.root, "bodies"), i);
        assert_string_equal(json_string_value(json_object_get(body, "file")), "w-body0.obj");
    }
    mote_json_close(&file);
}

#define POSES "frame,body,deformation,x,y,z,qw,qx,qy,qz\n"
#define ROW_1 "1,1,1,0,0,0,1,0,0,0\n"
#define ROW_2 "2,1,2,0,1,0,-0.6,0,0.8,0\n"

static mote_status read_poses(const char *text, uint32_t frames, mote_bodies *bodies,
                              mote_bodies_path *path)
{
    *bodies = (mote_bodies){.frames = frames, .count = 1, .length = 2, .paths = path};
    file_put("p.csv", text);
    return mote_bodies_poses_read("p.csv", bodies);
}

TEST(poses_that_are_no_rows_are_refused_with_their_line)
{
    static const struct {
        const char *text, *says;
    } rows[] = {
        {"", "p.csv:1: not the columns of recorded poses; expected frame,body"},
        {"frame,body\n", "p.csv:1: not the columns of recorded poses"},
        {POSES, "p.csv:2: not a pose; expected frame 1, body 1, a deformation, a place"},
        {POSES ROW_1, "p.csv:3: not a pose; expected frame 2, body 1"},
        {POSES ROW_1 ROW_1, "p.csv:3: not a pose; expected frame 2, body 1"},
        {POSES ROW_1 "2;1,2,0,1,0,1,0,0,0\n", "p.csv:3: not a pose"},
        {POSES ROW_1 "2,2,2,0,1,0,1,0,0,0\n", "p.csv:3: not a pose"},
        {POSES ROW_1 "2,1;2,0,1,0,1,0,0,0\n", "p.csv:3: not a pose"},
        {POSES ROW_1 "2,1,2,0,1,0,1,0,0\n", "p.csv:3: not a pose"},
        {POSES ROW_1 "2,1,x,0,1,0,1,0,0,0\n", "p.csv:3: not a pose"},
        {POSES ROW_1 "2,1,2,nan,1,0,1,0,0,0\n", "p.csv:3: not a pose"},
        {POSES ROW_1 "2,1,2,0,2e6,0,1,0,0,0\n", "p.csv:3: not a pose"},
        {POSES ROW_1 "2,1,2e12,0,1,0,1,0,0,0\n", "p.csv:3: not a pose"},
        {POSES ROW_1 "2,1,2,0,1,0,0,0,0,0\n", "p.csv:3: not a pose"},
        {POSES ROW_1 "2,1,2,0,1,0,1,0,0,0,7\n", "p.csv:3: not a pose"},
        {POSES ROW_1 "2,1,2,0,1,\n0,1,0,0,0\n", "p.csv:3: not a pose"},
        {POSES ROW_1 "\n2,1,2,0,1,0,1,0,0,0\n", "p.csv:3: not a pose"},
        {POSES ROW_1 "2,1,2,0,1,0,1,0,0,0\r7", "p.csv:3: not a pose"},
        {POSES ROW_1 ROW_2 "3", "p.csv:4: more rows than 2 frames of 1 bodies"},
    };
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        mote_bodies bodies;
        mote_bodies_path path;
        test_row("%s", rows[i].text);
        assert_int_equal(read_poses(rows[i].text, 2, &bodies, &path), MOTE_EINVAL);
        if (strncmp(mote_error_text(), rows[i].says, strlen(rows[i].says)) != 0)
            fail_msg("%s", mote_error_text());
        free(bodies.recorded);
    }
    mote_bodies none = {.frames = 1, .count = 1};
    assert_int_equal(mote_bodies_poses_read("none.csv", &none), MOTE_EIO);
    /* no room for 6e13 bytes of poses is asked for before they are there */
    mote_bodies many = {.frames = 1000000, .count = 1000000, .length = 2};
    file_put("p.csv", POSES ROW_1);
    assert_int_equal(mote_bodies_poses_read("p.csv", &many), MOTE_EINVAL);
    assert_non_null(strstr(mote_error_text(), "p.csv:3: not a pose; expected frame 1, body 2"));
    free(many.recorded);
    assert_null(none.recorded);
}

/* Programs for tables write other line ends, or none after the last row. */
TEST(poses_may_end_their_lines_otherwise)
{
    static const char unended[] = POSES ROW_1 "2,1,2,0,1,0,-0.6,0,0.8,0",
                      returned[] = POSES ROW_1 "2,1,2,0,1,0,-0.6,0,0.8,0\r",
                      both[] = "frame,body,deformation,x,y,z,qw,qx,qy,qz\r\n"
                               "1,1,1,0,0,0,1,0,0,0\r\n2,1,2,0,1,0,-0.6,0,0.8,0\r\n";
    static const char *const texts[] = {unended, returned, both};
    for (size_t i = 0; i < ROWS_OF(texts); ++i) {
        mote_bodies bodies;
        mote_bodies_path path;
        test_row("%s", texts[i]);
        assert_int_equal(read_poses(texts[i], 2, &bodies, &path), MOTE_OK);
        assert_true(path.velocity.y == 2);
        free(bodies.recorded);
    }
}

/* A path leads from the first frame to the second: here by L along y, and about y by
   2 acos(0.6), the shorter way round. One frame alone stands still. */
TEST(poses_give_the_start_of_a_path)
{
    for (uint32_t frames = 1; frames <= 2; ++frames) {
        mote_bodies bodies;
        mote_bodies_path path;
        assert_int_equal(
            read_poses(frames == 1 ? POSES ROW_1 : POSES ROW_1 ROW_2, frames, &bodies, &path),
            MOTE_OK);
        assert_true(path.velocity.y == (frames == 1 ? 0 : 2));
        const double degrees = frames == 1 ? 0 : 2 * acos(0.6) * 57.29577951308232;
        assert_true(fabs(path.spin - degrees) < 1e-12);
        assert_true(frames == 1 || path.axis.y == -1);
        free(bodies.recorded);
    }
}

/* The program as it is installed, with its scenarios missing, none, or two of one name. */
TEST(installed_program_tells_what_is_wrong_with_its_scenarios)
{
    static const char scene[] = SCENE(FRAMES, DIAMOND_FILE, DIAMOND_FILE);
    assert_int_equal(system("mkdir -p bin share/mote/datasets && cp " MOTE_PROGRAM " bin/mote"),
                     0);
    static const struct {
        const char *folder, *file, *line, *says;
    } rows[] = {
        {NULL, NULL, "list scenarios", "datasets/scenarios: No such file or directory"},
        {NULL, NULL, "check tt", "datasets/scenarios/tt.json: No such file or directory"},
        {"scenarios", NULL, "check tt", "tt: no such scenario; known are: none; or name"},
        {"scenarios", "tt.txt", "list scenarios", ""},
        {"scenarios/a", "a/tt.json", "list scenarios", "tt           x\n"},
        {"scenarios/b", "b/tt.json", "list scenarios", "has the same name; rename one"},
    };
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        char path[128];
        test_row("%zu", i);
        (void)snprintf(path, sizeof path, "share/mote/datasets/%s",
                       rows[i].folder ? rows[i].folder : "");
        assert_true(!rows[i].folder || access(path, F_OK) == 0 || mkdir(path, 0700) == 0);
        (void)snprintf(path, sizeof path, "share/mote/datasets/scenarios/%s",
                       rows[i].file ? rows[i].file : "");
        if (rows[i].file)
            file_put(path, scene);
        char *line = mote_format("./bin/mote %s > told 2>&1", rows[i].line);
        const bool good = system(line) == 0;
        char *told = file_text("told");
        assert_int_equal(good, i == 3 || i == 4);
        if (!strstr(told, rows[i].says))
            fail_msg("%s", told);
        free(told);
        free(line);
    }
}
