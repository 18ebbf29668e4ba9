/* make skins: checks certified queries of random skins and morph targets against a tree of
   boxes refitted to deformed vertices (aabb-tree, which shares no bound with them), and against
   all pairs of triangles where the two differ and occasionally elsewhere. Bones are any affine
   matrices: near rest or wild, stretched, sheared, mirrored, singular; there are 1 to some
   hundreds of them, one or several a vertex. Half of the poses leap, half are small steps.
   Every fourth query checks its boxes against every vertex inside. Usage: skins [--queries N]
   [--out FILE] [--checks FILE]. Exit status 1 where a distance is wrong by more than 1e-12 L, a
   lower bound is above the truth, or a vertex is outside its box. */
#include "tests/support/checks.h"
#include "tests/support/skin_scene.h"

#include <math.h>
#include <stdio.h>

#define ROUNDING 1e-12 /* of L */

enum { FRAMES_A_SCENE = 250, BOXES_EVERY = 4, ALL_PAIRS_EVERY = 500 };

typedef struct counts {
    uint64_t queries, wrong, above, contacts, all_pairs;
    uint64_t vertices, outside; /* checks of a vertex in a box, and those that failed */
    double largest_error;       /* over L */
} counts;

/* The reference for a scene: the other method's state, and room for its answer. */
typedef struct other {
    const mote_method *method;
    void *state;
    double values[64];
} other;

static void check_vertex(scene *s, const mote_certificate *c, int b, const mote_cert_node *node,
                         size_t l, uint32_t vertex, counts *n)
{
    /* bodies that touch have no direction between them */
    const bool faced = node->generation == c->generation && c->upper > 0;
    ++n->vertices;
    if ((faced && !in_reach(s, c, b, node, l, vertex)) ||
        (node->boxes &&
         !(in_box(s, c, b, node, l, vertex) && in_ends(s, c, b, node, l, vertex))))
        ++n->outside;
}

static void check_below(scene *s, const mote_certificate *c, int b, const mote_cert_node *node,
                        size_t l, int32_t child, counts *n)
{
    const mote_cert_tree *tree = c->side[b].tree;
    if (child >= 0) {
        const mote_cert_block *block = &tree->blocks[child];
        for (size_t k = 0; k < block->children; ++k)
            check_below(s, c, b, node, l, block->child[k], n);
        return;
    }
    const mote_cert_leaf *leaf = &tree->leaves[~child];
    for (uint32_t i = 0; i < leaf->vertex_count; ++i)
        check_vertex(s, c, b, node, l, tree->leaf_vertices[leaf->first_vertex + i], n);
}

/* Checks all boxes that the last query deformed and kept. */
static void check_boxes(scene *s, const mote_certificate *c, counts *n)
{
    for (int b = 0; b < 2; ++b) {
        for (uint32_t i = 0; i < c->side[b].node_count; ++i) {
            const mote_cert_node *node = &c->side[b].nodes[i];
            for (size_t l = 0; l < node->block->children; ++l)
                check_below(s, c, b, node, l, node->block->child[l], n);
        }
    }
}

static bool make_other(other *o, const scene *s)
{
    o->method = mote_method_find("aabb-tree");
    mote_parameters_default(o->method->parameters, o->method->parameter_count, o->values);
    const mote_setup setup = {.body = {&s->body[0], &s->body[1]},
                              .length = s->length,
                              .ask = MOTE_ASK_DISTANCE,
                              .seed = 1,
                              .values = o->values};
    return mote_method_create(o->method, &setup, &o->state) == MOTE_OK;
}

static bool ask_other(const other *o, scene *s, double *distance)
{
    mote_answer a = {.has_distance = false};
    for (int b = 0; b < 2; ++b)
        s->frame.body[b].vertices = s->world[b];
    const bool good = o->method->update(o->state, &s->frame) == MOTE_OK &&
                      o->method->query(o->state, &s->frame, &a) == MOTE_OK && a.has_distance;
    *distance = a.distance;
    return good;
}

/* Runs one query; false where the other method could not answer. */
static bool check(skinned *k, mote_certificate *c, const other *o, counts *n)
{
    scene *s = &k->s;
    double truth;
    mote_certificate_answer a;
    if (!ask_other(o, s, &truth))
        return false;
    mote_certificate_query(c, &s->frame, NULL, -1, &a);
    ++n->queries;
    if (n->queries % BOXES_EVERY == 0)
        check_boxes(s, c, n);
    const bool differs = fabs(a.distance - truth) > ROUNDING * s->length || a.lower > truth;
    if (differs || n->queries % ALL_PAIRS_EVERY == 0) {
        ++n->all_pairs;
        truth = scene_distance(s);
    }
    const double error = fabs(a.distance - truth) / s->length;
    n->largest_error = error > n->largest_error ? error : n->largest_error;
    n->wrong += error <= ROUNDING ? 0 : 1;
    n->above += a.lower <= truth ? 0 : 1;
    n->contacts += truth > 0 ? 0 : 1;
    return true;
}

static bool run_scene(uint64_t index, counts *n, uint64_t limit)
{
    static const uint32_t bones[] = {1, 2, 5, 0, 12, 40, 0, 120, 300, 700};
    static const uint32_t each[] = {1, 3, 4, 2, 9, 24};
    static const uint32_t targets[] = {0, 3, 0, 8, 0, 24, 1};
    static const double wild[] = {0.02, 0.1, 0.3, 1, 3};
    skin_plan plan = {bones[index % 10], each[index % 6], targets[index % 7]};
    if (plan.each > plan.bones)
        plan.each = plan.bones;
    if (plan.bones == 0 && plan.targets == 0)
        plan.targets = 5;
    skinned k;
    skinned_init(&k, 8 + (uint32_t)(index % 11), 5 + (uint32_t)(index % 8), plan);
    k.s.random += index;
    const mote_body *const bodies[2] = {&k.s.body[0], &k.s.body[1]};
    const mote_certificate_options options = mote_default_certificate_options(k.s.length);
    mote_certificate *c = NULL;
    other o = {.state = NULL};
    bool good =
        mote_certificate_create(bodies, &options, &c) == MOTE_OK && make_other(&o, &k.s);
    for (int frame = 0; good && frame < FRAMES_A_SCENE && n->queries < limit; ++frame) {
        if (frame / 10 % 2 == 0 || frame % 10 == 0)
            next_pose(&k, wild[frame % 5], frame % 3 ? 2.5 : 1.2);
        else
            step_pose(&k, 0.01);
        good = check(&k, c, &o, n);
    }
    if (!good)
        fprintf(stderr, "skins: %s\n", mote_error_text());
    mote_certificate_destroy(c);
    mote_method_destroy(mote_method_find("aabb-tree"), o.state);
    skinned_free(&k);
    return good;
}

static bool write_json(const char *path, const counts *n)
{
    FILE *file = fopen(path, "w");
    bool good = file && fprintf(file,
                                "{\"queries\": %" PRIu64 ", \"wrong\": %" PRIu64
                                ", \"lower_above_truth\": %" PRIu64 ", \"contacts\": %" PRIu64
                                ", \"all_pairs\": %" PRIu64 ", \"vertices_in_boxes\": %" PRIu64
                                ", \"outside\": %" PRIu64 ", \"largest_error\": %.3g}\n",
                                n->queries, n->wrong, n->above, n->contacts, n->all_pairs,
                                n->vertices, n->outside, n->largest_error) > 0;
    good = file && fclose(file) == 0 && good;
    if (!good)
        fprintf(stderr, "skins: cannot write %s\n", path);
    return good;
}

int main(int argc, char **argv)
{
    checks_options options = {.queries = 20000};
    if (!checks_read(argc, argv, "skins", &options))
        return 2;
    counts n = {.queries = 0};
    for (uint64_t index = options.first; n.queries < options.queries; ++index) {
        if (!run_scene(index, &n, options.queries))
            return 1;
    }
    printf("%" PRIu64 " queries of random skins, %" PRIu64 " in contact, %" PRIu64
           " also against all pairs\n",
           n.queries, n.contacts, n.all_pairs);
    printf("%" PRIu64 " beyond 1e-12 L (the largest error is %.2g L), %" PRIu64
           " lower bounds above the truth\n",
           n.wrong, n.largest_error, n.above);
    printf("%" PRIu64 " checks of a vertex in a box, %" PRIu64 " outside\n", n.vertices,
           n.outside);
    if ((options.out && !write_json(options.out, &n)) ||
        !checks_add(options.checks, "random skins: certified beyond 1e-12 L", n.queries,
                    n.wrong) ||
        !checks_add(options.checks, "random skins: a lower bound above the truth", n.queries,
                    n.above) ||
        !checks_add(options.checks, "random skins: a vertex outside of a box", n.vertices,
                    n.outside))
        return 1;
    return n.wrong == 0 && n.above == 0 && n.outside == 0 ? 0 : 1;
}
