/* Every answer's witnesses lie on the surfaces and are as far apart as the answer says, to
   1e-12 L: for our own methods on every built-in scenario, and on random meshes with every kind
   of field. Checked against all faces of the deformed bodies. */
#include "core/body/deform.h"
#include "core/body/triangle.h"
#include "harness/scene/catalog.h"
#include "harness/engine/engine.h"
#include "harness/scene/scenario.h"
#include "tests/support/bodies.h"
#include "tests/support/test.h"

#include <stdio.h>

#define RIGHT 1e-12 /* of L */

/* Larger meshes are left to runs of the harness, unless MOTE_FULL=1 is set. */
#define FACES_MAX 12000

/* Sanitizers are slow: they test every fourth scenario only. */
#ifdef __SANITIZE_ADDRESS__
enum { STRIDE = 4 };
#else
enum { STRIDE = 1 };
#endif

static const char *const methods[] = {
    "particle:n=8",
    "particle:n=0",
    "particle:n=32,refine=1",
    "particle:n=8,positions=given",
    "particle:n=8,forces=on,refine=64,track=64",
    "particle-paper:n=32",
    "particle-paper:n=32,refine=no",
    "particle-paper:n=32,refine=always",
    "particle-paper:n=40,move=surface,refine=no",
    "particle-paper:n=40,move=surface,refine=near,law=inverse-square",
    "certified",
    "certified:seed=none",
};
enum { METHODS = sizeof methods / sizeof methods[0] };

/* Whether a point lies on a body's faces, to within a distance. */
static bool is_on(const mote_mesh *mesh, const mote_vec3 *vertices, mote_vec3 p, double within)
{
    for (uint32_t i = 0; i < mesh->triangle_count; ++i) {
        const mote_vec3 a = vertices[mesh->triangles[i][0]];
        const mote_vec3 b = vertices[mesh->triangles[i][1]];
        const mote_vec3 c = vertices[mesh->triangles[i][2]];
        if (p.x < fmin(a.x, fmin(b.x, c.x)) - within ||
            p.x > fmax(a.x, fmax(b.x, c.x)) + within ||
            p.y < fmin(a.y, fmin(b.y, c.y)) - within ||
            p.y > fmax(a.y, fmax(b.y, c.y)) + within)
            continue;
        const mote_vec3 corners[3] = {a, b, c};
        if (sqrt(mote_point_triangle(p, corners, NULL)) <= within)
            return true;
    }
    return false;
}

static void check_answer(const mote_answer *answer, const mote_body *const bodies[2],
                         const mote_frame *frame, double length, const char *where,
                         const char *method)
{
    if (!answer->has_distance || !answer->has_witness)
        fail_msg("%s, frame %u: %s tells no witnesses", where, (unsigned)frame->number, method);
    const double apart = mote_length(mote_sub(answer->witness[1], answer->witness[0]));
    if (!(fabs(apart - answer->distance) <= RIGHT * length))
        fail_msg("%s, frame %u: %s says %.17g, its witnesses are %.17g apart", where,
                 (unsigned)frame->number, method, answer->distance, apart);
    for (int b = 0; b < 2; ++b) {
        if (!is_on(bodies[b]->mesh, frame->body[b].vertices, answer->witness[b],
                   RIGHT * length))
            fail_msg("%s, frame %u: witness %d of %s is not on its surface", where,
                     (unsigned)frame->number, b, method);
    }
}

/* Methods ready to be asked about a pair of bodies. */
typedef struct panel {
    const mote_body *body[2];
    double length;
    const char *where;
    mote_engine *probe[METHODS];
    mote_deform *deform[2];
    mote_vec3 *world[2];
    size_t answers;
} panel;

static void open_panel(panel *p, const mote_body *a, const mote_body *b, double length,
                       const char *where)
{
    *p = (panel){.body = {a, b}, .length = length, .where = where};
    for (int m = 0; m < METHODS; ++m) {
        mote_method_choice choice;
        assert_int_equal(mote_method_choice_read(methods[m], &choice), MOTE_OK);
        const mote_status status =
            mote_engine_open_two(a, b, &choice, MOTE_ASK_DISTANCE, 0, 1, &p->probe[m]);
        /* Few vertices, or more components than particles. */
        if (status != MOTE_OK && status != MOTE_EUNSUPPORTED && status != MOTE_EINVAL)
            fail_msg("%s: %s: %s", where, methods[m], mote_error_text());
    }
    for (int i = 0; i < 2; ++i) {
        assert_int_equal(mote_deform_create(p->body[i], &p->deform[i]), MOTE_OK);
        p->world[i] = malloc(p->body[i]->mesh->vertex_count * sizeof *p->world[i]);
        assert_non_null(p->world[i]);
    }
}

static void check_frame(panel *p, const mote_frame *frame)
{
    mote_frame known = *frame;
    for (int i = 0; i < 2; ++i) {
        mote_deform_all(p->deform[i], &known.body[i], p->world[i]);
        known.body[i].vertices = p->world[i];
    }
    for (int m = 0; m < METHODS; ++m) {
        mote_answer answer = {0};
        if (!p->probe[m])
            continue;
        assert_int_equal(mote_engine_answer(p->probe[m], &known, &answer), MOTE_OK);
        check_answer(&answer, p->body, &known, p->length, p->where, methods[m]);
        ++p->answers;
    }
}

static size_t close_panel(panel *p)
{
    for (int m = 0; m < METHODS; ++m)
        mote_engine_destroy(p->probe[m]);
    for (int i = 0; i < 2; ++i) {
        mote_deform_destroy(p->deform[i]);
        free(p->world[i]);
    }
    return p->answers;
}

/* A few consecutive frames at the start, in the middle and near the end: cold and warm
   queries. */
static size_t check_scenario(const mote_scenario *scenario)
{
    static const double parts[] = {0, 0.6};
    panel p;
    mote_frame_buffer *buffer;
    buffer = mote_frame_buffer_create(scenario);
    open_panel(&p, &scenario->body[0], &scenario->body[1], scenario->length, scenario->name);
    uint32_t previous = 0;
    for (size_t k = 0; k < sizeof parts / sizeof parts[0]; ++k) {
        const uint32_t first = 1 + (uint32_t)(parts[k] * scenario->frames);
        for (uint32_t i = first; i < first + 3 && i <= scenario->frames; ++i) {
            check_frame(&p, mote_scenario_frame(scenario, buffer, i, previous));
            previous = i;
        }
    }
    mote_frame_buffer_destroy(buffer);
    return close_panel(&p);
}

static bool is_small(const mote_scenario *scenario)
{
    return getenv("MOTE_FULL") || (scenario->body[0].mesh->triangle_count <= FACES_MAX &&
                                   scenario->body[1].mesh->triangle_count <= FACES_MAX);
}

TEST(answers_of_built_in_scenarios_have_witnesses_on_the_surfaces)
{
    mote_catalog catalog;
    size_t checked = 0, answers = 0;
    assert_int_equal(mote_catalog_read(&catalog), MOTE_OK);
    for (size_t i = 0; i < catalog.count; i += STRIDE) {
        const char *name = catalog.entries[i].name;
        const bool huge = strstr(name, "00k") || strstr(name, "1m") || strstr(name, "10m");
        if (huge && !getenv("MOTE_FULL"))
            continue; /* creating their meshes alone takes a minute */
        mote_scenario *scenario;
        if (mote_scenario_load(name, &scenario) != MOTE_OK) {
            if (strstr(mote_error_text(), "several bodies"))
                continue; /* not a pair */
            fail_msg("%s: %s", name, mote_error_text());
        }
        if (is_small(scenario)) {
            answers += check_scenario(scenario);
            ++checked;
        }
        mote_scenario_destroy(scenario);
    }
    mote_catalog_free(&catalog);
    assert_true(checked >= 20 / STRIDE && answers >= 1200 / STRIDE);
}

/* A mesh that exists in no file: a sphere of random radii, a torus, or an open sheet; rough,
   perhaps flat, perhaps two of them. */
static mote_mesh *random_mesh(uint64_t *seed)
{
    const uint64_t kind = random_bits(seed) % 4;
    solid s = kind == 0   ? solid_icosphere(3)
              : kind == 1 ? solid_torus(24, 12)
              : kind == 2 ? solid_grid(20, 15)
                          : solid_join(solid_icosphere(2), solid_torus(16, 8), 2.5);
    const double flat = random_bits(seed) % 3 == 0 ? random_between(seed, 1e-6, 1) : 1;
    const double rough = random_between(seed, 0, 0.1);
    for (size_t i = 0; i < s.vertex_count; ++i) {
        double *v = &s.xyz[3 * i];
        const mote_vec3 shift = random_vec3(seed, rough);
        solid_set_vertex(&s, i, v[0] + shift.x, v[1] + shift.y, flat * (v[2] + shift.z));
    }
    return solid_to_mesh(s);
}

TEST(answers_on_random_meshes_have_witnesses_on_the_surfaces)
{
    static const int fields[] = {6, -3, 0};
    uint64_t seed = 20;
    size_t answers = 0;
    for (int k = 0; k < 16; k += STRIDE) {
        test_body b[2];
        for (int i = 0; i < 2; ++i)
            test_body_init(&b[i], random_mesh(&seed), fields[(k + i * (k / 3)) % 3], &seed);
        const double length = fmax(b[0].mesh->diagonal, b[1].mesh->diagonal);
        char where[32];
        (void)snprintf(where, sizeof where, "random scene %d", k);
        panel p;
        open_panel(&p, &b[0].body, &b[1].body, length, where);
        mote_frame frame = {0};
        for (frame.number = 1; frame.number <= 12; ++frame.number) {
            for (int i = 0; i < 2 && frame.number % 4 == 1; ++i) /* a leap */
                frame.body[i] = test_body_state(&b[i], 0.1 * length, &seed);
            const double way = (frame.number % 4 == 1 ? 0.5 : -0.05) * length;
            frame.body[1].pose.translation =
                mote_add(frame.body[1].pose.translation, mote_vec3_make(way, 0, 0));
            check_frame(&p, &frame);
        }
        answers += close_panel(&p);
        test_body_free(&b[0]);
        test_body_free(&b[1]);
    }
    assert_true(answers >= 16 / STRIDE * 12 * 8);
}
