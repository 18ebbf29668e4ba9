/* Certified queries with more basis functions than fit in a byte, both for a field that names
   the functions that reach a vertex and for one that does not. */
#include <stddef.h>

#include "core/body/field_kinds.h"
#include "core/body/deform.h"
#include "core/certificate/certificate_fitted.h"
#include "core/certificate/certificate_state.h"
#include "tests/support/shapes.h"
#include "tests/support/test.h"
#include "tests/support/truth.h"

enum { FUNCTIONS = 700, PADDED = 704, FRAMES = 30 };

/* Patch j of the torus: vertex v has functions 3 v mod 700 and the two that follow it. */
static double patch_value(const mote_mesh *mesh, uint32_t vertex, uint32_t k)
{
    const mote_vec3 x = mesh->positions[vertex];
    return 0.3 + 0.2 * sin(x.x + k) + (k == 1 ? 0.1 * x.z : 0.05 * x.y);
}

static uint32_t patch_number(uint32_t vertex, uint32_t k)
{
    return (3 * (vertex / 4) + k) % FUNCTIONS;
}

static void patch_basis(const mote_field *field, const mote_mesh *mesh, uint32_t vertex,
                        double *phi)
{
    memset(phi, 0, field->padded * sizeof *phi);
    for (uint32_t k = 0; k < 3; ++k)
        phi[patch_number(vertex, k)] = patch_value(mesh, vertex, k);
}

static uint32_t patch_sparse(const mote_field *field, const mote_mesh *mesh, uint32_t vertex,
                             uint32_t *functions, double *phi)
{
    uint32_t count = 0;
    (void)field;
    /* ascending, though the three may wrap around */
    for (uint32_t j = 0; j < 2; ++j) {
        for (uint32_t k = 0; k < 3; ++k) {
            const bool round = patch_number(vertex, k) < patch_number(vertex, 0);
            if (round != (j == 0))
                continue;
            functions[count] = patch_number(vertex, k);
            phi[count++] = patch_value(mesh, vertex, k);
        }
    }
    return count;
}

static mote_vec3 patch_displacement(const mote_field *field, const mote_mesh *mesh,
                                    uint32_t vertex, const mote_weights *weights)
{
    double phi[PADDED];
    patch_basis(field, mesh, vertex, phi);
    return mote_weighted_sum(phi, weights, PADDED);
}

static void patch_displacement_single(const mote_field *field, const mote_mesh *mesh,
                                      uint32_t vertex, const mote_weights_single *weights,
                                      float displacement[3])
{
    double phi[PADDED];
    patch_basis(field, mesh, vertex, phi);
    mote_weighted_sum_single(phi, weights, PADDED, displacement);
}

static void patch_destroy(mote_field *field)
{
    free(field);
}

static const mote_field_kind dense_kind = {.name = "dense patches",
                                           .basis = patch_basis,
                                           .displacement = patch_displacement,
                                           .displacement_single = patch_displacement_single,
                                           .destroy = patch_destroy};
static const mote_field_kind sparse_kind = {.name = "sparse patches",
                                            .basis = patch_basis,
                                            .sparse = patch_sparse,
                                            .destroy = patch_destroy};

static void use_patches(scene *s, const mote_field_kind *kind)
{
    for (int b = 0; b < 2; ++b) {
        mote_deform_destroy(s->deform[b]);
        mote_field_destroy(s->field[b]);
        need(mote_field_allocate(kind, FUNCTIONS, &s->field[b]) == MOTE_OK);
        if (kind->sparse)
            s->field[b]->most = 3;
        s->body[b].field = s->field[b];
        need(mote_deform_create(&s->body[b], &s->deform[b]) == MOTE_OK);
    }
}

/* The weights of one frame. */
typedef struct patch_weights {
    double at[2][3][PADDED];
} patch_weights;

static void next_frame(scene *s, patch_weights *w, double size)
{
    for (int b = 0; b < 2; ++b) {
        mote_body_state *state = &s->frame.body[b];
        state->pose.rotation = random_rotation(s);
        state->pose.translation = mote_vec3_make(b * scene_random(s, 0.2, 1.3) * s->length,
                                                 scene_random(s, -0.1, 0.1), 0);
        for (int c = 0; c < 3; ++c) {
            for (int j = 0; j < FUNCTIONS; ++j)
                w->at[b][c][j] = scene_random(s, -size, size);
        }
        state->weights =
            (mote_weights){w->at[b][0], w->at[b][1], w->at[b][2], FUNCTIONS, PADDED};
        mote_deform_all(s->deform[b], state, s->world[b]);
    }
    ++s->frame.number;
}

static mote_certificate *certificate_of(const scene *s)
{
    const mote_body *const bodies[2] = {&s->body[0], &s->body[1]};
    const mote_certificate_options plain = mote_default_certificate_options(s->length);
    mote_certificate *c = NULL;
    assert_int_equal(mote_certificate_create(bodies, &plain, &c), MOTE_OK);
    return c;
}

TEST(query_with_700_functions_equals_all_pairs_sparse_or_dense)
{
    static patch_weights w;
    const mote_field_kind *kinds[2] = {&dense_kind, &sparse_kind};
    scene s[2];
    mote_certificate *c[2];
    for (int k = 0; k < 2; ++k) {
        scene_init(&s[k], 30, 14, 2.5, false);
        use_patches(&s[k], kinds[k]);
        c[k] = certificate_of(&s[k]);
    }
    assert_true(c[0]->side[0].tree->blocks[0].active_count > 256);
    for (int frame = 0; frame < FRAMES; ++frame) {
        mote_certificate_answer a[2];
        for (int k = 0; k < 2; ++k) {
            next_frame(&s[k], &w, 0.1 * s[k].length);
            mote_certificate_query(c[k], &s[k].frame, NULL, -1, &a[k]);
            const double truth = scene_truth(&s[k]);
            assert_true(fabs(a[k].distance - truth) <= 1e-12 * s[k].length);
            assert_true(a[k].lower <= truth);
            assert_true(a[k].lower >= truth - 1e-12 * s[k].length);
        }
        assert_memory_equal(&a[0].distance, &a[1].distance, sizeof a[0].distance);
        assert_memory_equal(a[0].witness, a[1].witness, sizeof a[0].witness);
    }
    for (int k = 0; k < 2; ++k) {
        mote_certificate_destroy(c[k]);
        scene_free(&s[k]);
    }
}

/* Every box reaches at least as far as the vertices of its leaves, with all functions: an index
   truncated to a byte would omit some. */
static void check_reaches(const scene *s, mote_certificate *c, mote_cert_node *node)
{
    const mote_cert_side *side = &c->side[0];
    for (size_t l = 0; l < node->block->children; ++l) {
        const int32_t child = node->block->child[l];
        if (child >= 0) {
            check_reaches(s, c, mote_cert_child(c, 0, node, l, 0));
            continue;
        }
        const mote_cert_leaf *leaf = &side->tree->leaves[~child];
        for (uint32_t i = 0; i < leaf->vertex_count; ++i) {
            const mote_vec3 x = s->world[0][side->tree->leaf_vertices[leaf->first_vertex + i]];
            const double at = mote_dot(mote_sub(x, c->origin), side->facing) * c->scale;
            assert_true((double)node->reach[l] >= at);
        }
    }
}

TEST(boxes_enclose_their_vertices_with_700_functions)
{
    static patch_weights w;
    scene s;
    scene_init(&s, 30, 14, 2.5, false);
    use_patches(&s, &sparse_kind);
    mote_certificate *c = certificate_of(&s);
    for (int frame = 0; frame < FRAMES; ++frame) {
        next_frame(&s, &w, 0.5 * s.length);
        c->origin = s.frame.body[0].pose.translation;
        ++c->generation;
        const mote_mat3 r = random_rotation(&s);
        mote_cert_side_begin(&c->side[0], &s.frame.body[0], c->origin);
        mote_cert_side_face(&c->side[0], mote_vec3_make(r.m[0][0], r.m[0][1], r.m[0][2]), 0);
        check_reaches(&s, c, mote_cert_root(c, 0));
    }
    mote_certificate_destroy(c);
    scene_free(&s);
}

/* What a row says of a function at a vertex of child `lane`, and its residual. */
static double row_value(const mote_cert_row *row, size_t lane, const double z[3],
                        double *residual)
{
    *residual = (double)mote_cert_upper(row->rest[lane]);
    return (double)row->offset[lane] + (double)mote_cert_upper(row->slopes[lane]) * z[0] +
           (double)mote_cert_lower(row->slopes[lane]) * z[1] +
           (double)mote_cert_lower(row->rest[lane]) * z[2];
}

/* Every function at every vertex of a leaf is within its row's residual; a function without a
   row is 0. Returns how many values were compared. */
static size_t check_leaf_rows(const mote_cert_tree *tree, const mote_cert_block *block,
                              size_t lane)
{
    const mote_cert_row *rows =
        (const mote_cert_row *)(const void *)(tree->strips + block->first_strip);
    const mote_cert_leaf *leaf = &tree->leaves[~block->child[lane]];
    const double *scale = mote_cert_scales_of(tree).scale;
    mote_cert_box box = {.centre = mote_vec3_make((double)block->centre[0][lane],
                                                  (double)block->centre[1][lane],
                                                  (double)block->centre[2][lane])};
    for (int k = 0; k < 3; ++k)
        box.half[k] =
            mote_vec3_make((double)block->half[k][0][lane], (double)block->half[k][1][lane],
                           (double)block->half[k][2][lane]);
    for (uint32_t i = 0; i < leaf->vertex_count; ++i) {
        const uint32_t v = tree->leaf_vertices[leaf->first_vertex + i];
        double phi[PADDED], z[3], residual;
        patch_basis(tree->body->field, tree->body->mesh, v, phi);
        mote_cert_box_coordinates(&box, mote_cert_tree_position(tree, v), z);
        for (uint32_t k = 0; k < block->active_count; ++k) {
            const uint32_t j = tree->active[block->first_active + k];
            const double value = row_value(&rows[k], lane, z, &residual);
            assert_true(fabs(phi[j] * scale[j] - value) <= residual);
            phi[j] = 0;
        }
        for (int j = 0; j < PADDED; ++j)
            assert_true(phi[j] == 0);
    }
    return (size_t)leaf->vertex_count * block->active_count;
}

/* The bound of a function is at least what its row adds up to, at any vertex of a child. */
static void check_bound(const mote_cert_row *row, size_t lane, double bound)
{
    static const double centre[3] = {0, 0, 0};
    double residual;
    const double offset = row_value(row, lane, centre, &residual);
    double sum = fabs(offset) + residual;
    for (int k = 0; k < 3; ++k) {
        double z[3] = {0, 0, 0}, ignored;
        z[k] = 1;
        sum += fabs(row_value(row, lane, z, &ignored) - offset);
    }
    assert_true(bound >= sum * (1 - 1e-15));
}

static void mark_reached(const mote_cert_tree *tree, int32_t node, bool reached[PADDED])
{
    if (node >= 0) {
        const mote_cert_block *block = &tree->blocks[node];
        for (size_t l = 0; l < block->children; ++l)
            mark_reached(tree, block->child[l], reached);
        return;
    }
    const mote_cert_leaf *leaf = &tree->leaves[~node];
    for (uint32_t i = 0; i < leaf->vertex_count; ++i) {
        double phi[PADDED];
        patch_basis(tree->body->field, tree->body->mesh,
                    tree->leaf_vertices[leaf->first_vertex + i], phi);
        for (int j = 0; j < PADDED; ++j)
            reached[j] = reached[j] || phi[j] != 0;
    }
}

/* A block lists, in order, the functions that are not 0 at all of its vertices, and no other:
   a row too many costs time in every query. */
static void check_listed(const mote_cert_tree *tree, uint32_t number)
{
    bool reached[PADDED] = {false};
    const mote_cert_block *block = &tree->blocks[number];
    uint32_t k = 0;
    mark_reached(tree, (int32_t)number, reached);
    for (uint32_t j = 0; j < PADDED; ++j) {
        if (reached[j]) {
            assert_true(k < block->active_count);
            assert_int_equal(tree->active[block->first_active + k++], j);
        }
    }
    assert_int_equal(block->active_count, k);
}

/* Denormal numbers are slow on some processors, so no half of a word may make one. */
static void check_words(const mote_cert_row *row, size_t lane)
{
    const float parts[4] = {mote_cert_upper(row->slopes[lane]),
                            mote_cert_lower(row->slopes[lane]),
                            mote_cert_upper(row->rest[lane]), mote_cert_lower(row->rest[lane])};
    for (int k = 0; k < 4; ++k)
        assert_true(parts[k] == 0 || fabsf(parts[k]) >= 0x1p-61F);
}

static void check_all_rows(const mote_cert_tree *tree)
{
    size_t compared = 0;
    for (uint32_t b = 0; b < tree->block_count; ++b) {
        const mote_cert_block *block = &tree->blocks[b];
        const mote_cert_row *rows =
            (const mote_cert_row *)(const void *)(tree->strips + block->first_strip);
        check_listed(tree, b);
        for (size_t l = 0; l < block->children; ++l) {
            for (uint32_t k = 0; k < block->active_count; ++k) {
                const uint32_t j = tree->active[block->first_active + k];
                check_words(&rows[k], l);
                check_bound(&rows[k], l, mote_cert_scales_of(tree).bound[j]);
            }
            compared += block->child[l] < 0 ? check_leaf_rows(tree, block, l) : 0;
        }
    }
    assert_true(compared > 1000);
}

TEST(rows_are_within_their_residuals_as_they_are_read)
{
    for (int fits = 0; fits < 2; ++fits) {
        scene s;
        scene_init(&s, 30, 14, 2.5, false);
        use_patches(&s, &sparse_kind);
        const mote_cert_tree_options options = {
            .length = s.length, .width = MOTE_CERT_WIDTH, .linear_fits = fits == 1};
        mote_cert_tree *tree = NULL;
        assert_int_equal(mote_cert_tree_create(&s.body[0], &options, &tree), MOTE_OK);
        check_all_rows(tree);
        mote_cert_tree_destroy(tree);
        scene_free(&s);
    }
}

/* The sums over sparse() and basis() are the same bits, one vertex at a time and all at once.
 */
TEST(sparse_and_dense_displacements_are_the_same_bits)
{
    static patch_weights w;
    static float single[3][PADDED];
    scene s;
    scene_init(&s, 30, 14, 1, false);
    use_patches(&s, &sparse_kind);
    mote_field *dense = NULL;
    assert_int_equal(mote_field_allocate(&dense_kind, FUNCTIONS, &dense), MOTE_OK);
    next_frame(&s, &w, 1);
    const mote_body_state *state = &s.frame.body[0];
    for (int c = 0; c < 3; ++c) {
        for (int j = 0; j < PADDED; ++j)
            single[c][j] = (float)w.at[0][c][j];
    }
    const mote_weights_single rounded = {single[0], single[1], single[2], PADDED};
    const mote_body other = {.mesh = s.mesh[0], .field = dense};
    for (uint32_t v = 0; v < s.mesh[0]->vertex_count; ++v) {
        const mote_vec3 p = mote_body_position(&s.body[0], state, v);
        const mote_vec3 q = mote_body_position(&other, state, v);
        assert_memory_equal(&p, &q, sizeof p);
        assert_memory_equal(&p, &s.world[0][v], sizeof p);
        float a[3], b[3];
        mote_field_displacement_single(s.field[0], s.mesh[0], v, &rounded, a);
        mote_field_displacement_single(dense, s.mesh[0], v, &rounded, b);
        assert_memory_equal(a, b, sizeof a);
    }
    mote_field_destroy(dense);
    scene_free(&s);
}

TEST(field_allocate_of_too_many_functions_says_what)
{
    const mote_field_kind summed = {
        .name = "summed", .basis = patch_basis, .destroy = patch_destroy};
    /* one that adds up doubles by itself, and not floats */
    mote_field_kind half_summed = summed;
    half_summed.displacement = patch_displacement;
    mote_field mark;
    mote_field *field = &mark;
    const mote_field_kind *const kinds[2] = {&summed, &half_summed};
    for (int k = 0; k < 2; ++k) {
        assert_int_equal(mote_field_allocate(kinds[k], 257, &field), MOTE_EINVAL);
        assert_string_equal(mote_error_text(),
                            "a field of kind summed has at most 256 basis functions, not 257");
    }
    assert_int_equal(mote_field_allocate(&sparse_kind, 65529, &field), MOTE_EINVAL);
    assert_string_equal(
        mote_error_text(),
        "a field of kind sparse patches has at most 65528 basis functions, not 65529");
    assert_ptr_equal(field, &mark);
    assert_int_equal(mote_field_allocate(&sparse_kind, 65528, &field), MOTE_OK);
    assert_int_equal(field->padded, 65528);
    mote_field_destroy(field);
}
