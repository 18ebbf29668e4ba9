/* The cloth and the jelly: free fall in closed form until they land, and invariants
   afterwards. */
#include "datasets/glyph.h"
#include "datasets/letter.h"
#include "datasets/simulated.h"
#include "harness/base/hash.h"
#include "harness/scene/scenario.h"
#include "tests/support/mote.h"
#include "tests/support/folder.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>

#define TRIANGLES 3000
#define FRAMES 120

/* The fall of either in a frame before it lands: `parts` steps, each of which keeps a share of
   the velocity and adds gravity's. */
static double fall(double *speed, int parts, double kept, bool damps_last)
{
    double way = 0;
    for (int i = 0; i < parts; ++i) {
        const double pull = 3e-4 / parts; /* L a frame, a frame */
        *speed = damps_last ? (*speed + pull) * kept : *speed * kept + pull;
        way += *speed / parts;
    }
    return way;
}

static void check_fall(const mote_simulated_body *kind, int frames, int parts, bool damps_last)
{
    mote_mesh *mesh;
    void *state;
    double speed = 0, way = 0;
    assert_int_equal(kind->create(TRIANGLES, &mesh, &state), MOTE_OK);
    mote_vec3 *now = malloc(mesh->vertex_count * sizeof *now);
    for (int k = 2; k <= frames; ++k) {
        kind->step(state, now);
        way += fall(&speed, parts, 0.999, damps_last);
        for (uint32_t v = 0; v < mesh->vertex_count; ++v) {
            const mote_vec3 rest = mesh->positions[v];
            assert_true(fabs(now[v].x - rest.x) + fabs(now[v].y - rest.y) < 1e-6);
            assert_true(fabs(now[v].z - (rest.z - way)) < 1e-6);
        }
    }
    free(now);
    kind->destroy(state);
    mote_mesh_destroy(mesh);
}

TEST(simulated_bodies_fall_freely_until_they_land)
{
    check_fall(&mote_simulated_cloth, 25, 8, false);
    check_fall(&mote_simulated_jelly, 30, 12, true);
}

static double edge_length(const mote_vec3 *at, const mote_mesh *mesh, uint32_t t, int k)
{
    return sqrt(
        mote_distance_squared(at[mesh->triangles[t][k]], at[mesh->triangles[t][(k + 1) % 3]]));
}

static void check_cloth(const mote_simulated_body *kind)
{
    mote_mesh *mesh;
    void *state;
    mote_glyph letter;
    assert_int_equal(mote_glyph_make(MOTE_SIMULATED_LETTER, &letter), MOTE_OK);
    assert_int_equal(kind->create(TRIANGLES, &mesh, &state), MOTE_OK);
    mote_vec3 *now = malloc(mesh->vertex_count * sizeof *now), gradient;
    double lowest = 1, longest = 0;
    for (int k = 2; k <= FRAMES; ++k) {
        kind->step(state, now);
        double sum = 0;
        for (uint32_t v = 0; v < mesh->vertex_count; ++v)
            assert_true(mote_glyph_field(&letter, now[v], &gradient) > 0);
        for (uint32_t t = 0; t < mesh->triangle_count; ++t) {
            const double stretch =
                edge_length(now, mesh, t, 0) / edge_length(mesh->positions, mesh, t, 0);
            longest = fmax(longest, stretch);
            sum += stretch;
        }
        lowest = fmin(lowest, sum / mesh->triangle_count);
    }
    assert_true(longest < 1.35 && lowest > 0.8);
    free(now);
    kind->destroy(state);
    mote_mesh_destroy(mesh);
}

TEST(cloths_stay_off_the_letter_and_hardly_stretch)
{
    check_cloth(&mote_simulated_cloth);
    check_cloth(&mote_simulated_banner);
}

/* The banner is held along one edge, and comes near to the letter again and again. */
TEST(banner_flutters_over_the_letter)
{
    mote_mesh *mesh;
    void *state;
    mote_glyph letter;
    int approaches = 0;
    double before = 0;
    assert_int_equal(mote_glyph_make(MOTE_SIMULATED_LETTER, &letter), MOTE_OK);
    assert_int_equal(mote_simulated_banner.create(TRIANGLES, &mesh, &state), MOTE_OK);
    mote_vec3 *now = malloc(mesh->vertex_count * sizeof *now), gradient;
    for (int k = 2; k <= 200; ++k) {
        double nearest = HUGE_VAL;
        mote_simulated_banner.step(state, now);
        for (uint32_t v = 0; v < mesh->vertex_count; ++v)
            nearest = fmin(nearest, mote_glyph_field(&letter, now[v], &gradient));
        approaches += k > 2 && nearest < 0.1 && !(before < 0.1);
        before = nearest;
        for (int v = 0; v < 10; ++v) /* of the edge that is held */
            assert_true(mote_distance_squared(now[v], mesh->positions[v]) < 1e-20);
    }
    assert_true(approaches >= 2);
    free(now);
    mote_simulated_banner.destroy(state);
    mote_mesh_destroy(mesh);
}

static double height_of(const mote_vec3 *at, uint32_t count)
{
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (uint32_t v = 0; v < count; ++v) {
        low = fmin(low, at[v].z);
        high = fmax(high, at[v].z);
    }
    return high - low;
}

/* The lattice determines the motion: a finer surface on it moves in the same way. */
TEST(jelly_of_any_size_makes_the_same_motion)
{
    mote_mesh *mesh[2];
    void *state[2];
    double least = HUGE_VAL;
    for (int i = 0; i < 2; ++i)
        assert_int_equal(mote_simulated_jelly.create(i ? 6000 : 1500, &mesh[i], &state[i]),
                         MOTE_OK);
    for (int k = 2; k <= FRAMES; ++k) {
        double height[2];
        for (int i = 0; i < 2; ++i) {
            mote_vec3 *now = malloc(mesh[i]->vertex_count * sizeof *now);
            mote_simulated_jelly.step(state[i], now);
            height[i] = height_of(now, mesh[i]->vertex_count);
            free(now);
        }
        assert_true(fabs(height[0] - height[1]) < 0.01);
        least = fmin(least, height[0]);
    }
    /* It has fallen over without being squashed. */
    assert_true(least > 0.1 && least < 0.5);
    for (int i = 0; i < 2; ++i) {
        mote_simulated_jelly.destroy(state[i]);
        mote_mesh_destroy(mesh[i]);
    }
}

/* The bits of the last frame, as they were on x86-64 with gcc 12. */
TEST(simulated_bodies_have_the_same_bits_everywhere)
{
    static const struct {
        const mote_simulated_body *kind;
        uint64_t hash;
    } rows[] = {{&mote_simulated_cloth, 0x19bfbed01935690e},
                {&mote_simulated_banner, 0x1774b4172f0c9417},
                {&mote_simulated_jelly, 0xdd19688adc2b7bf7}};
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        mote_mesh *mesh;
        void *state;
        uint64_t hash = MOTE_HASH_START;
        test_row("%s", rows[i].kind->name);
        assert_int_equal(rows[i].kind->create(TRIANGLES, &mesh, &state), MOTE_OK);
        mote_vec3 *now = malloc(mesh->vertex_count * sizeof *now);
        for (int k = 2; k <= FRAMES; ++k)
            rows[i].kind->step(state, now);
        for (uint32_t v = 0; v < mesh->vertex_count; ++v)
            hash = mote_hash_double(
                mote_hash_double(mote_hash_double(hash, now[v].x), now[v].y), now[v].z);
        if (hash != rows[i].hash)
            fail_msg("0x%016llx", (unsigned long long)hash);
        free(now);
        rows[i].kind->destroy(state);
        mote_mesh_destroy(mesh);
    }
}

TEST(sequence_command_writes_a_scenario_that_runs)
{
    for (size_t i = 0; mote_simulated_list[i]; ++i) {
        const char *name = mote_simulated_list[i]->name;
        mote_expect(0, "12 frames", "sequence %s --triangles 1000 --frames 12 --out d", name);
        mote_expect(0, "checked by brute force", "check d/%s.json", name);
    }
    assert_int_equal(folder_count("d", ".part"), 0);
    assert_int_equal(folder_count("d", ".partial"), 0);
    mote_expect(2, "give a whole number from 800 to", "sequence cloth --triangles 799 --out e");
    mote_expect(2, "not one of cloth, banner, jelly", "sequence flag --triangles 799 --out e");
    mote_expect(2, "something is missing", "sequence cloth --triangles 800");
    mote_expect(2, "--frames 0", "sequence cloth --triangles 800 --frames 0 --out e");
    assert_false(file_exists("e"));
}

/* The letter's origin is not the middle of its box, which is what a scenario places. */
TEST(sequence_scenario_has_the_letter_where_the_simulation_has_it)
{
    mote_scenario *scenario;
    mote_mesh *letter;
    mote_expect(0, "2 frames", "sequence cloth --triangles 1000 --frames 2 --out d");
    assert_int_equal(mote_scenario_load("d/cloth.json", &scenario), MOTE_OK);
    const mote_body *body = &scenario->body[1];
    assert_int_equal(
        mote_letter_create(MOTE_SIMULATED_LETTER, body->mesh->triangle_count, &letter),
        MOTE_OK);
    mote_frame_buffer *buffer = mote_frame_buffer_create(scenario);
    const mote_frame *frame = mote_scenario_frame(scenario, buffer, 1, 0);
    for (uint32_t v = 0; v < letter->vertex_count; ++v) {
        const mote_vec3 at = mote_body_position(body, &frame->body[1], v);
        assert_true(mote_distance_squared(at, letter->positions[v]) < 1e-28);
    }
    mote_frame_buffer_destroy(buffer);
    mote_mesh_destroy(letter);
    mote_scenario_destroy(scenario);
}
