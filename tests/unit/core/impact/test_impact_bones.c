/* Bounds on the motion of skins: no vertex is farther away, faster or accelerates more, and a
   body that one bone moves does nearly as much. */
#include "core/impact/impact_bones.h"

#include "core/impact/impact_state.h"
#include "tests/support/impact_scene.h"
#include "tests/support/test.h"

/* The largest of each kind of bound over all groups. */
typedef struct most {
    double reach, rate, change;
} most;

static most bounds_of(const impact_scene *s, mote_vec3 axis)
{
    const mote_impact_groups *groups = &s->search->groups[0];
    const mote_impact_balls balls = {groups->count, groups->padded, groups->middle,
                                     groups->radius};
    const size_t n = groups->padded;
    double *sums = malloc(3 * n * sizeof *sums);
    need(sums && groups->bones);
    (void)mote_impact_bones_bound(groups->bones, &balls, s->of[0].field,
                                  s->of[0].piece[0].weights, s->of[0].path.pivot, axis, sums);
    most all = {0, 0, 0};
    for (uint32_t g = 0; g < groups->count; ++g) {
        all.reach = fmax(all.reach, sums[g]);
        all.rate = fmax(all.rate, sums[n + g]);
        all.change = fmax(all.change, sums[2 * n + g]);
    }
    free(sums);
    return all;
}

/* The same of the vertices, by differences of their positions at 100 times. */
static most sampled(impact_scene *s, mote_vec3 axis)
{
    impact_body *b = &s->of[0];
    const uint32_t count = b->mesh->vertex_count;
    const double h = 1e-4;
    mote_vec3 *at[3];
    most all = {0, 0, 0};
    for (int k = 0; k < 3; ++k) {
        at[k] = malloc(count * sizeof *at[k]);
        need(at[k]);
    }
    for (int i = 1; i < 100; ++i) {
        for (int k = 0; k < 3; ++k) {
            impact_place(b, i / 100.0 + (k - 1) * h);
            memcpy(at[k], b->world, count * sizeof *b->world);
        }
        for (uint32_t v = 0; v < count; ++v) {
            const mote_vec3 arm = mote_sub(at[1][v], b->path.pivot);
            const double along = mote_dot(arm, axis);
            const mote_vec3 step = mote_sub(at[2][v], at[0][v]);
            const mote_vec3 bend =
                mote_sub(mote_add(at[2][v], at[0][v]), mote_scale(at[1][v], 2));
            all.reach = fmax(all.reach, sqrt(fmax(mote_dot(arm, arm) - along * along, 0)));
            all.rate = fmax(all.rate, mote_length(step) / (2 * h));
            all.change = fmax(all.change, mote_length(bend) / (h * h));
        }
    }
    for (int k = 0; k < 3; ++k)
        free(at[k]);
    return all;
}

static void check_bounds(const most *bound, const most *found)
{
    if (!(found->reach <= bound->reach * (1 + 1e-9) && found->rate <= bound->rate * 1.00001 &&
          found->change <= bound->change * 1.0001))
        fail_msg("vertices: %g, %g, %g; bounds: %g, %g, %g", found->reach, found->rate,
                 found->change, bound->reach, bound->rate, bound->change);
}

/* The pivot stays where it is, so that what is sampled is the skin's own motion. */
TEST(mote_impact_bones_bound_holds_for_every_vertex)
{
    static const impact_kind kinds[] = {IMPACT_SKIN, IMPACT_MORPHS, IMPACT_MORPHED_SKIN};
    for (int k = 0; k < 60; ++k) {
        impact_scene s;
        impact_scene_init_kinds(&s, make_torus(9, 5, 1), impact_box(1, 1, 1),
                                (const impact_kind[2]){kinds[k % 3], IMPACT_RIGID}, (uint64_t)k,
                                10);
        const mote_vec3 pivot = impact_vector(&s.random, 1);
        s.of[0].path.pivot = pivot;
        const impact_wild w = {
            .pieces = 1, .from = pivot, .to = pivot, .weights = k % 2 ? 0.1 : 2};
        impact_path_random(&s.of[0], &w, &s.random);
        for (int i = 0; i < 4; ++i)
            s.of[0].piece[0].turn[i] = (mote_quaternion){1, 0, 0, 0};
        const mote_vec3 none = {0, 0, 0}, axis = mote_random_direction(&s.random);
        const most free_bound = bounds_of(&s, none), free_found = sampled(&s, none);
        const most bound = bounds_of(&s, axis), found = sampled(&s, axis);
        check_bounds(&free_bound, &free_found);
        check_bounds(&bound, &found);
        impact_scene_free(&s);
    }
}

/* One bone, or none before a target that moves everything alike: the bounds are what happens.
 */
TEST(mote_impact_bones_bound_is_near_what_one_bone_or_target_does)
{
    mote_mesh *mesh = impact_box(1, 1, 1);
    const uint32_t start[] = {0, 8}, vertex[] = {0, 1, 2, 3, 4, 5, 6, 7};
    mote_vec3 move[8];
    for (int v = 0; v < 8; ++v)
        move[v] = mote_vec3_make(0, 0, 1);
    const mote_morph_targets targets = {1, start, vertex, move};
    mote_field *field = NULL;
    assert_int_equal(mote_field_create_morphs(mesh, 0, NULL, NULL, NULL, &targets, &field),
                     MOTE_OK);
    const mote_body body = {.mesh = mesh, .field = field};
    const mote_body *const bodies[2] = {&body, &body};
    const mote_impact_options options = mote_default_impact_options(mesh->diagonal);
    impact_scene s = {.search = NULL};
    assert_int_equal(mote_impact_create(bodies, &options, &s.search), MOTE_OK);
    const mote_mat3 same = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    double control[12 * 32] = {0};
    const size_t n = field->padded;
    assert_true(n <= 32);
    for (size_t i = 0; i < 4; ++i) {
        const double amount = (double)(i * i); /* derivatives within 3 .. 15, second 12 */
        mote_morph_weights(field, NULL, &amount, &same, control + 3 * i * n,
                           control + (3 * i + 1) * n, control + (3 * i + 2) * n);
    }
    s.of[0].field = field;
    s.of[0].piece[0].weights = control;
    const most bound = bounds_of(&s, (mote_vec3){0, 0, 0});
    assert_true(fabs(bound.rate - 15) < 1e-9);
    assert_true(fabs(bound.change - 12) < 1e-9);
    assert_true(bound.reach > 9.8 && bound.reach < 9.9); /* 9 and half of the diagonal */
    mote_impact_destroy(s.search);
    mote_field_destroy(field);
    mote_mesh_destroy(mesh);
}
