/* Field kinds named in scenarios. */
#include "core/body/field_maker.h"
#include "harness/scene/scenario.h"
#include "tests/support/methods.h"
#include "tests/support/test.h"

#include <stddef.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char path[] = "s.json";

/* Control 2 of body 0 is displaced by (0.3, 0.2, -0.1) L at frame 25; line 4 has the field. */
static void write_scenario(const char *field)
{
    FILE *out = fopen(path, "w");
    assert_non_null(out);
    (void)fprintf(out,
                  "{\"purpose\": \"test\", \"frames\": 40, \"ask\": \"distance\",\n"
                  "\"bodies\": [\n"
                  "{\"letter\": \"T\", \"triangles\": 600,\n"
                  "\"field\": {%s, \"displacement\": {\"sines\": [{\"control\": 2,"
                  " \"amplitude\": [0.3, 0.2, -0.1], \"period\": 100}]}}},\n"
                  "{\"letter\": \"V\", \"triangles\": 600,"
                  " \"motion\": [{\"frame\": 1, \"position\": [0.9, 0, 0]}]}]}\n",
                  field);
    assert_int_equal(fclose(out), 0);
}

/* Column y of the matrix: every vertex moves by its height above the middle, times the
   weight. */
TEST(stretch_in_a_scenario_moves_vertices_by_the_matrix)
{
    mote_scenario *s;
    mote_frame_buffer *buffer;
    write_scenario("\"kind\": \"stretch\"");
    assert_int_equal(mote_scenario_load(path, &s), MOTE_OK);
    buffer = mote_frame_buffer_create(s);
    const mote_frame *frame = mote_scenario_frame(s, buffer, 25, 0);
    const mote_mesh *mesh = s->body[0].mesh;
    double moved = 0;
    for (uint32_t i = 0; i < mesh->vertex_count; ++i) {
        const mote_vec3 x = mesh->positions[i];
        const mote_vec3 at = mote_body_position(&s->body[0], &frame->body[0], i);
        const mote_vec3 rest = mote_pose_apply(&frame->body[0].pose, x);
        const double height = x.y - (mesh->low.y + mesh->high.y) / 2;
        const mote_vec3 shift = mote_sub(at, rest);
        assert_true(fabs(shift.x - 0.3 * height) < 1e-14 * mesh->diagonal);
        assert_true(fabs(shift.y - 0.2 * height) < 1e-14 * mesh->diagonal);
        assert_true(fabs(shift.z + 0.1 * height) < 1e-14 * mesh->diagonal);
        moved = fmax(moved, mote_length(shift));
    }
    assert_true(moved > 0.1 * mesh->diagonal);
    mote_frame_buffer_destroy(buffer);
    mote_scenario_destroy(s);
}

TEST(stretch_gradient_is_the_slope_between_vertices)
{
    mote_scenario *s;
    write_scenario("\"kind\": \"stretch\"");
    assert_int_equal(mote_scenario_load(path, &s), MOTE_OK);
    const mote_mesh *mesh = s->body[0].mesh;
    const mote_field *field = s->body[0].field;
    double phi[2][MOTE_LANES];
    mote_vec3 gradient[MOTE_LANES];
    for (uint32_t i = 0; i + 1 < mesh->vertex_count; ++i) {
        const mote_vec3 step = mote_sub(mesh->positions[i + 1], mesh->positions[i]);
        field->kind->basis(field, mesh, i, phi[0]);
        field->kind->basis(field, mesh, i + 1, phi[1]);
        field->kind->gradient(field, mesh, i, gradient);
        for (int j = 0; j < MOTE_LANES; ++j)
            assert_true(fabs(phi[1][j] - phi[0][j] - mote_dot(gradient[j], step)) < 1e-15);
    }
    mote_scenario_destroy(s);
}

/* The distance that a method with default parameters gives at a frame. */
static double ask(const char *name, const mote_scenario *s, const mote_frame *frame)
{
    double values[MOTE_PARAMETERS_MAX];
    const mote_method *method = method_with(name, "", values);
    const mote_setup setup = {.body = {&s->body[0], &s->body[1]},
                              .length = s->length,
                              .ask = MOTE_ASK_DISTANCE,
                              .values = values};
    mote_frame with = *frame;
    for (int b = 0; b < 2; ++b) {
        const mote_body *body = &s->body[b];
        mote_vec3 *vertices = malloc(body->mesh->vertex_count * sizeof *vertices);
        assert_non_null(vertices);
        for (uint32_t i = 0; i < body->mesh->vertex_count; ++i)
            vertices[i] = mote_body_position(body, &frame->body[b], i);
        with.body[b].vertices = vertices;
    }
    void *state;
    mote_answer answer = {0};
    assert_int_equal(method->create(&setup, &state), MOTE_OK);
    if (method->update)
        assert_int_equal(method->update(state, &with), MOTE_OK);
    assert_int_equal(method->query(state, &with, &answer), MOTE_OK);
    method->destroy(state);
    for (int b = 0; b < 2; ++b)
        free((void *)(uintptr_t)with.body[b].vertices);
    assert_true(answer.has_distance);
    return answer.distance;
}

TEST(stretch_certified_agrees_with_every_pair_of_triangles)
{
    mote_scenario *s;
    mote_frame_buffer *buffer;
    write_scenario("\"kind\": \"stretch\"");
    assert_int_equal(mote_scenario_load(path, &s), MOTE_OK);
    buffer = mote_frame_buffer_create(s);
    double first = 0;
    for (uint32_t number = 1; number <= 40; number += 13) {
        const mote_frame *frame = mote_scenario_frame(s, buffer, number, 0);
        const double exact = ask("brute-force", s, frame);
        assert_true(fabs(ask("certified", s, frame) - exact) < 1e-12 * s->length);
        first = number == 1 ? exact : first;
        assert_true(number == 1 || fabs(exact - first) > 1e-3 * s->length);
    }
    mote_frame_buffer_destroy(buffer);
    mote_scenario_destroy(s);
}

TEST(field_of_an_unknown_kind_or_key_is_refused_with_its_line)
{
    static const char *const bad[][2] = {
        {"\"kind\": \"strech\"", "strech"},
        {"\"kind\": 3", "kind"},
        {"\"kind\": null", "kind"},
        {"\"kind\": \"stretch\", \"support\": 1", "support"},
        {"\"kind\": \"stretch\", \"law\": \"log\", \"power\": 1", "law"},
        {"\"kind\": \"csrbf\", \"power\": 1", "power"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; ++i) {
        mote_scenario *s = NULL;
        write_scenario(bad[i][0]);
        assert_int_equal(mote_scenario_load(path, &s), MOTE_EINVAL);
        assert_null(s);
        assert_non_null(strstr(mote_error_text(), "s.json:4:"));
        if (!strstr(mote_error_text(), bad[i][1]))
            fail_msg("%s: %s", bad[i][0], mote_error_text());
    }
}

TEST(field_of_kind_csrbf_is_the_default)
{
    uint64_t fingerprint[2];
    for (int k = 0; k < 2; ++k) {
        mote_scenario *s;
        write_scenario(k ? "\"count\": 6, \"support\": 0.5"
                         : "\"kind\": \"csrbf\", \"count\": 6, \"support\": 0.5");
        assert_int_equal(mote_scenario_load(path, &s), MOTE_OK);
        assert_int_equal(mote_scenario_fingerprint(s, &fingerprint[k]), MOTE_OK);
        mote_scenario_destroy(s);
    }
    assert_true(fingerprint[0] == fingerprint[1]);
}

/* A kind with a parameter of each type, which keeps what it was given. */
enum { LEVELS, REACH, SPEED, LAW, PARAMETERS };

static const mote_parameter parameters[PARAMETERS] = {
    [LEVELS] = {"levels", MOTE_PARAMETER_INTEGER, 1, 9, NULL, "3", "x"},
    [REACH] = {"reach", MOTE_PARAMETER_REAL, 0, 2, "auto", "auto", "x"},
    [SPEED] = {"speed", MOTE_PARAMETER_REAL, 0, HUGE_VAL, NULL, "1", "x"},
    [LAW] = {"law", MOTE_PARAMETER_CHOICE, 0, 0, "log|inverse", "log", "x"},
};
static double given[PARAMETERS];

static mote_status create_tuned(const mote_mesh *mesh, const double *values, mote_field **field)
{
    memcpy(given, values, sizeof given);
    return mote_field_maker_find("stretch")->create(mesh, NULL, field);
}

static void add_tuned(void)
{
    static const mote_field_maker tuned = {.name = "tuned",
                                           .summary = "x",
                                           .parameters = parameters,
                                           .parameter_count = PARAMETERS,
                                           .create = create_tuned};
    if (!mote_field_maker_find("tuned"))
        assert_int_equal(mote_field_maker_add(&tuned), MOTE_OK);
}

TEST(field_takes_its_kind_s_parameters)
{
    static const struct {
        const char *keys;
        double values[PARAMETERS];
    } rows[] = {
        {"\"kind\": \"tuned\"", {3, MOTE_AUTO, 1, 0}},
        {"\"kind\": \"tuned\", \"levels\": 9, \"reach\": 0.1, \"speed\": 1e300, \"law\": "
         "\"inverse\"",
         {9, 0.1, 1e300, 1}},
        {"\"kind\": \"tuned\", \"levels\": 2.0, \"reach\": \"auto\", \"speed\": \"inf\"",
         {2, MOTE_AUTO, HUGE_VAL, 0}},
    };
    add_tuned();
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        mote_scenario *s = NULL;
        test_row("%s", rows[i].keys);
        write_scenario(rows[i].keys);
        assert_int_equal(mote_scenario_load(path, &s), MOTE_OK);
        assert_memory_equal(given, rows[i].values, sizeof given);
        mote_scenario_destroy(s);
    }
}

/* Nothing of another type is taken for a number, and no text for several parameters. */
TEST(field_refuses_parameters_of_another_type)
{
    static const struct {
        const char *keys, *says;
    } rows[] = {
        {"\"levels\": null", "levels: is null; give a number from 1 to 9"},
        {"\"levels\": true", "levels: is true; give a number from 1 to 9"},
        {"\"levels\": \"4\"", "levels: is a string; give a number from 1 to 9"},
        {"\"levels\": [4]", "levels: is an array of 1; give a number from 1 to 9"},
        {"\"levels\": \"auto\"", "levels: is a string; give a number from 1 to 9"},
        {"\"levels\": 10", "levels must be a whole number from 1 to 9"},
        {"\"levels\": 1.5", "levels must be a whole number from 1 to 9"},
        {"\"reach\": false", "reach: is false; give a number from 0 to 2, or \"auto\""},
        {"\"reach\": {}", "reach: is an object; give a number from 0 to 2, or \"auto\""},
        {"\"reach\": \"0.5\"", "reach: is a string; give a number from 0 to 2, or \"auto\""},
        {"\"reach\": \"inf\"", "reach: is a string; give a number"},
        {"\"speed\": \"1\"", "speed: is a string; give a number from 0 to inf"},
        {"\"law\": null", "law: is null; give one of log|inverse"},
        {"\"law\": \"cubic\"", "law must be one of log|inverse"},
        {"\"law\": 1", "law must be one of log|inverse"},
        {"\"law\": \"log,levels=4\"", "law: is a string; give one of log|inverse"},
        {"\"reach=1,levels\": 4", "reach=1,levels: unknown key; known here are kind|"},
        {"\"levels|reach\": 4", "levels|reach: unknown key; known here are kind|"},
    };
    add_tuned();
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        mote_scenario *s = NULL;
        char keys[200];
        test_row("%s", rows[i].keys);
        (void)snprintf(keys, sizeof keys, "\"kind\": \"tuned\", %s", rows[i].keys);
        write_scenario(keys);
        assert_int_equal(mote_scenario_load(path, &s), MOTE_EINVAL);
        assert_null(s);
        if (!strstr(mote_error_text(), rows[i].says) ||
            !strstr(mote_error_text(), "s.json:4: bodies[0].field"))
            fail_msg("%s", mote_error_text());
    }
}
