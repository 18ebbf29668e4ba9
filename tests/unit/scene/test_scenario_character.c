#include "core/certificate/certificate.h"
#include "core/skin/skin.h"
#include "harness/scene/bodies.h"
#include "harness/scene/scenario.h"
#include "harness/scene/scenario_move.h"
#include "harness/scene/scenario_read.h"
#include "tests/support/bar.h"
#include "tests/support/test.h"

#include <math.h>
#include <sys/stat.h>

#define HEAD "{\"purpose\": \"Bars.\", \"frames\": 121, \"ask\": \"distance\", \"bodies\": "
#define BOX "{\"letter\": \"T\", \"triangles\": 400}"
#define BAR(more) "{\"character\": \"bar.x\"" more "}"

/* Of the bar that is in bar.x. */
static mote_scenario *load_bodies(const char *bodies)
{
    mote_scenario *scenario = NULL;
    char text[2000];
    (void)snprintf(text, sizeof text, HEAD "%s}", bodies);
    file_put("bars.json", text);
    if (mote_scenario_load("./bars.json", &scenario) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    return scenario;
}

static mote_scenario *load(const char *bodies)
{
    bar_write("bar.x", bar_default());
    return load_bodies(bodies);
}

/* The angle by which the second bone has turned in a frame, from the middles of the bar's end
   faces. */
static double bent(const mote_scenario *s, mote_frame_buffer *buffer, uint32_t frame)
{
    const mote_frame *f = mote_scenario_frame(s, buffer, frame, 0);
    const mote_mesh *mesh = s->body[0].mesh;
    mote_vec3 end = {0, 0, 0}, root = {0, 0, 0};
    for (uint32_t v = 0; v < mesh->vertex_count; ++v) {
        const mote_vec3 p = mote_body_position(&s->body[0], &f->body[0], v);
        if (mesh->positions[v].x > mesh->high.x - 1e-6)
            end = mote_add_scaled(end, 0.25, p);
        if (mesh->positions[v].x < mesh->low.x + 1e-6)
            root = mote_add_scaled(root, 0.25, p);
    }
    const double half = (mesh->high.x - mesh->low.x) / 2;
    const mote_vec3 d = mote_sub(end, mote_add(root, mote_vec3_make(half, 0, 0)));
    return atan2(fabs(d.y), d.x) * 57.29577951308232;
}

static void check_bends(const char *more, const double wanted[3])
{
    char bodies[500];
    const uint32_t frames[3] = {1, 31, 121};
    (void)snprintf(bodies, sizeof bodies, "[{\"character\": \"bar.x\"%s}, " BOX "]", more);
    mote_scenario *s = load(bodies);
    mote_frame_buffer *buffer = mote_frame_buffer_create(s);
    test_row("%s", more);
    for (int k = 0; k < 3; ++k) {
        const double got = bent(s, buffer, frames[k]);
        if (!(fabs(got - wanted[k]) < 1e-4))
            fail_msg("frame %u: %g degrees, not %g", frames[k], got, wanted[k]);
    }
    mote_frame_buffer_destroy(buffer);
    mote_scenario_destroy(s);
}

/* The clip turns by 90 degrees in one second, which is 60 frames. */
TEST(mote_scenario_character_plays_its_clip)
{
    check_bends("", (const double[]){0, 45, 0});
    check_bends(", \"clip\": \"Bend\", \"loop\": false", (const double[]){0, 45, 90});
    check_bends(", \"clip\": 1, \"start\": 0.5", (const double[]){45, 0, 45});
    check_bends(", \"start\": 0.25, \"speed\": 0.5", (const double[]){22.5, 45, 22.5});
    check_bends(", \"start\": 0.5, \"speed\": -1", (const double[]){45, 0, 45});
    check_bends(", \"clip\": \"Still\"", (const double[]){0, 0, 0});
    check_bends(", \"scale\": 3, \"subdivide\": 0", (const double[]){0, 45, 0});
}

/* The first clip is named 2 and the second 1. */
TEST(mote_scenario_character_takes_a_number_for_the_number_of_its_clip)
{
    static const struct {
        const char *more;
        uint32_t clip;
    } rows[] = {{"", 0},
                {", \"clip\": 1", 0},
                {", \"clip\": 2", 1},
                {", \"clip\": \"1\"", 1},
                {", \"clip\": \"2\"", 0}};
    bar_text numbers = bar_default();
    numbers.clip[0] = "2";
    numbers.clip[1] = "1";
    bar_write("bar.x", numbers);
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        char bodies[500];
        test_row("%s", rows[i].more);
        (void)snprintf(bodies, sizeof bodies, "[{\"character\": \"bar.x\"%s}, " BOX "]",
                       rows[i].more);
        mote_scenario *s = load_bodies(bodies);
        assert_int_equal(s->motion->body[0].player->clip, rows[i].clip);
        mote_scenario_destroy(s);
    }
}

/* A clip that does not move is reported to methods as no change of shape. */
TEST(mote_scenario_character_tells_what_changes)
{
    mote_scenario *s = load("[" BAR("") ", " BAR(", \"clip\": \"Still\"") "]");
    mote_frame_buffer *buffer = mote_frame_buffer_create(s);
    const mote_frame *frame = mote_scenario_frame(s, buffer, 2, 1);
    assert_true(frame->body[0].shape_changed && !frame->body[1].shape_changed);
    assert_ptr_equal(s->body[0].mesh, s->body[1].mesh);
    assert_int_equal(s->body[0].sample_count, MOTE_PLAYER_SAMPLES);
    mote_frame_buffer_destroy(buffer);
    mote_scenario_destroy(s);
}

/* The area and the surface are the same: midpoints are on it. */
TEST(mote_scenario_character_subdivided_has_four_times_the_triangles)
{
    mote_scenario *s = load("[" BAR(", \"subdivide\": 2") ", " BAR("") "]");
    const mote_mesh *fine = s->body[0].mesh, *coarse = s->body[1].mesh;
    double area[2] = {0, 0};
    assert_int_equal(fine->triangle_count, 16 * coarse->triangle_count);
    assert_int_equal(fine->vertex_count, fine->triangle_count / 2 + 2);
    assert_int_equal(fine->open_edge_count, 0);
    for (int b = 0; b < 2; ++b) {
        const mote_mesh *mesh = b ? coarse : fine;
        for (uint32_t t = 0; t < mesh->triangle_count; ++t) {
            const mote_vec3 *p = mesh->positions;
            const uint32_t *c = mesh->triangles[t];
            area[b] += mote_length(
                           mote_cross(mote_sub(p[c[1]], p[c[0]]), mote_sub(p[c[2]], p[c[0]]))) /
                       2;
        }
    }
    assert_true(fabs(area[0] - area[1]) < 1e-12 * area[1]);
    mote_scenario_destroy(s);
}

TEST(mote_scenario_character_errors_say_what_and_where)
{
    static const struct {
        const char *body, *said;
    } rows[] = {
        {BAR(", \"clip\": \"Run\""),
         "./bars.json:1: bodies[0].clip: no clip Run; it has 1 Bend (1 s), 2 Still (0 s)"},
        {BAR(", \"clip\": 3"), "bodies[0].clip: no clip 3; it has 1 Bend"},
        {BAR(", \"clip\": 1.5"), "bodies[0].clip: is 1.5; give a whole number"},
        {BAR(", \"clip\": true"), "bodies[0].clip: is true; give the name of a clip"},
        {BAR(", \"loop\": 1"), "bodies[0].loop: is 1; give true or false"},
        {BAR(", \"speed\": 1e9"), "bodies[0].speed: "},
        {BAR(", \"start\": \"now\""), "bodies[0].start: "},
        {BAR(", \"subdivide\": 9"), "bodies[0].subdivide: "},
        {BAR(", \"field\": {\"count\": 3}"), "bodies[0].field: a character has no field"},
        {BAR(", \"letter\": \"T\""), "bodies[0].letter: a character has no letter"},
        {"{\"letter\": \"T\", \"triangles\": 400, \"clip\": 1}",
         "bodies[0].clip: clip without a character"},
        {"{\"character\": \"none.x\"}", "bodies[0].character: "},
        {"{\"character\": \"../bar.x\"}", "bodies[0].character: "},
        {"{\"character\": \"still.obj\"}",
         "bodies[0].character: ./still.obj: no bones, morph targets or clips"},
        {"{\"character\": \"bad.x\"}", "bodies[0].character: ./bad.x: the vertex at"},
        {"{}", "bodies[0]: needs either letter, file or character, not neither"}};
    bar_text bad = bar_default();
    bad.upper_weights = "0.5,0.5,0.5,0.5,1.0,1e40,1.0,1.0";
    bar_write("bar.x", bar_default());
    bar_write("bad.x", bad);
    file_put("still.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        mote_scenario *scenario = NULL;
        char text[2000];
        test_row("%s", rows[i].body);
        (void)snprintf(text, sizeof text, HEAD "[%s, " BOX "]}", rows[i].body);
        file_put("bars.json", text);
        assert_int_equal(mote_scenario_load("./bars.json", &scenario), MOTE_EINVAL);
        if (!strstr(mote_error_text(), rows[i].said))
            fail_msg("%s", mote_error_text());
    }
}

/* A crowd of bars, each with a clip time of its own: poses differ, and the weights are those of
   the clip. */
TEST(mote_bodies_play_clips_at_times_of_their_own)
{
    mote_bodies *bodies = NULL;
    bar_write("bar.x", bar_default());
    file_put("crowd.json", HEAD "{\"count\": 5, \"box\": 6, \"shapes\": [" BAR("") "]}}");
    if (mote_bodies_load("./crowd.json", &bodies) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    mote_bodies_frame frame = mote_bodies_frame_create(bodies);
    mote_bodies_frame_set(bodies, 7, &frame);
    const mote_player *player = bodies->shapes[0].motion.player;
    double x[8], y[8], z[8];
    assert_int_equal(player->field->padded, 8);
    assert_int_equal(bodies->shapes[0].body.sample_count, MOTE_PLAYER_SAMPLES);
    for (uint32_t i = 0; i < 5; ++i) {
        mote_player_weights(player, bodies->paths[i].time + 7, &frame.states[i].pose.rotation,
                            x, y, z);
        assert_memory_equal(frame.states[i].weights.x, x, sizeof x);
        assert_memory_equal(frame.states[i].weights.z, z, sizeof z);
        assert_true(i == 0 || bodies->paths[i].time != bodies->paths[0].time);
    }
    mote_bodies_frame_free(&frame);
    mote_bodies_destroy(bodies);
}

/* "like" finds the character from the other file's folder; writing a scenario elsewhere copies
   the character, too. */
TEST(mote_scenario_character_is_found_from_elsewhere)
{
    uint64_t there = 0, here = 1, moved = 2;
    mote_scenario *s = NULL;
    mote_json_file file;
    assert_int_equal(mkdir("in", 0700), 0);
    assert_int_equal(mkdir("out", 0700), 0);
    bar_write("in/bar.x", bar_default());
    file_put("in/bars.json", HEAD "[" BAR("") ", " BAR(", \"speed\": 2") "]}");
    file_put("like.json", "{\"purpose\": \"The same.\", \"like\": \"in/bars.json\"}");
    assert_int_equal(mote_scenario_load("in/bars.json", &s), MOTE_OK);
    assert_int_equal(mote_scenario_fingerprint(s, &there), MOTE_OK);
    mote_scenario_destroy(s);
    if (mote_scenario_load("./like.json", &s) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    assert_int_equal(mote_scenario_fingerprint(s, &here), MOTE_OK);
    mote_scenario_destroy(s);
    assert_true(here == there);
    assert_int_equal(mote_scenario_open("in/bars.json", &file), MOTE_OK);
    if (mote_scenario_move(&file, "out/bars.json") != MOTE_OK)
        fail_msg("%s", mote_error_text());
    char *text = json_dumps(file.root, 0);
    file_put("out/bars.json", text);
    free(text);
    mote_json_close(&file);
    assert_true(file_exists("out/bars-body0.x") && !file_exists("out/bars-body1.x"));
    assert_int_equal(mote_scenario_load("out/bars.json", &s), MOTE_OK);
    assert_int_equal(mote_scenario_fingerprint(s, &moved), MOTE_OK);
    mote_scenario_destroy(s);
    assert_true(moved == there);
}

TEST(mote_scenario_pair_of_characters_plays_their_clips)
{
    mote_scenario *s = NULL;
    bar_write("bar.x", bar_default());
    if (mote_scenario_load("pair:bar.x:bar.x", &s) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    assert_string_equal(s->name, "bar-bar");
    assert_true(s->motion->body[0].player && s->motion->body[1].player);
    mote_scenario_destroy(s);
    bar_text numbers = bar_default();
    numbers.clip[0] = "2";
    numbers.clip[1] = "1";
    bar_write("bar.x", numbers);
    assert_int_equal(mote_scenario_load("pair:bar.x:bar.x", &s), MOTE_OK);
    assert_int_equal(s->motion->body[0].player->clip, 0); /* the other does not move */
    mote_scenario_destroy(s);
}

/* 110 B a vertex beyond the rest mesh: trees, a query's workspace and the skin itself, of which
   the header says 4 bytes a vertex and 6 a weight. */
TEST(certificate_of_a_character_takes_at_most_110_bytes_a_vertex)
{
    mote_scenario *s = NULL;
    assert_int_equal(mote_scenario_load("bison-15k", &s), MOTE_OK);
    const mote_body *const bodies[2] = {&s->body[0], &s->body[1]};
    const mote_certificate_options options = mote_default_certificate_options(s->length);
    mote_certificate *c = NULL;
    assert_int_equal(mote_certificate_create(bodies, &options, &c), MOTE_OK);
    double vertices = 0, bytes = (double)mote_certificate_bytes(c);
    for (int b = 0; b < 2; ++b) {
        const uint32_t count = bodies[b]->mesh->vertex_count;
        vertices += count;
        bytes +=
            4 * (double)count + 6 * (double)mote_field_skin(bodies[b]->field)->start[count];
    }
    assert_true(bytes <= 110 * vertices);
    assert_true(bytes > 50 * vertices);
    mote_certificate_destroy(c);
    mote_scenario_destroy(s);
}
