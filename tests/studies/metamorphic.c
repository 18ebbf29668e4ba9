/* The metamorphic part of make reliability: changes of a scene that must not change an answer,
   or only by a known factor. Scaled by a power of two, every method must answer with the same
   bits. With the bodies swapped, reordered, wound differently, moved rigidly or refined, exact
   methods must agree to 1e-12 L, and the errors of the others must keep their quantiles. Usage:
   metamorphic [--queries N] [--out FILE] [--checks FILE]: N queries a change. Exit status 1
   where something broke. */
#include "harness/engine/engine.h"
#include "harness/base/statistics.h"
#include "tests/support/checks.h"
#include "tests/studies/twin.h"

#include <stdio.h>

enum { METHODS = 6, EXACT = 3, FRAMES_A_SCENE = 200, FRAMES_A_LEAP = 10, QUANTILES = 3 };

#define ROUNDING 1e-12 /* of L: answers that differ by less are equal */

/* The exact ones first. */
static const char *const methods[METHODS] = {
    "certified",    "certified:seed=tracked", "aabb-tree",
    "particle:n=8", "particle-paper:n=5",     "particle-paper:n=8,refine=always,law=inverse"};

static const double quantiles[QUANTILES] = {0.5, 0.9, 0.99};

/* Errors of a method over L, at the frames before a leap, which are nearly independent of each
   other. */
typedef struct errors {
    double *of_base, *of_twin;
    size_t count;
} errors;

typedef struct relation {
    const char *name;
    twin_change change;
    bool same_bits; /* every method, apart from the factor; otherwise exact ones to 1e-12 L */
    bool rigid;     /* scenes without deformation only */
    bool keeps_vertices; /* then the errors of particles, which walk on vertices, keep their
                            quantiles */
    uint64_t tried, failed;
    double difference; /* the largest of exact methods, over L */
    errors errors[METHODS];
} relation;

typedef struct pair {
    scene base, twin;
    twin_change change;
    mote_engine *probe[2][METHODS]; /* of base, of twin */
} pair;

static bool open_pair(pair *p, const relation *r, uint32_t index)
{
    memset(p, 0, sizeof *p);
    scene_init(&p->base, 8 + index % 5, 6 + index % 4, 1.1, !r->rigid && index % 4 != 0);
    p->base.random += index;
    p->change = r->change;
    p->change.seed = index + 1;
    p->change.exponent = r->same_bits ? (int)(index * 7 % 81) - 40 : 0;
    twin_init(&p->base, &p->change, &p->twin);
    for (int m = 0; m < 2 * METHODS; ++m) {
        const scene *s = m < METHODS ? &p->base : &p->twin;
        mote_method_choice choice;
        if (mote_method_choice_read(methods[m % METHODS], &choice) != MOTE_OK ||
            mote_engine_open_two(&s->body[0], &s->body[1], &choice, MOTE_ASK_DISTANCE, 0, 1,
                                 &p->probe[m / METHODS][m % METHODS]) != MOTE_OK) {
            fprintf(stderr, "metamorphic: %s\n", mote_error_text());
            return false;
        }
    }
    return true;
}

static void close_pair(pair *p)
{
    for (int m = 0; m < METHODS; ++m) {
        mote_engine_destroy(p->probe[0][m]);
        mote_engine_destroy(p->probe[1][m]);
    }
    scene_free(&p->base);
    scene_free(&p->twin);
}

static bool same(mote_vec3 a, mote_vec3 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

/* Whether the twin's answer is the base's times a power of two, bit for bit. */
static bool scaled(const mote_answer *base, const mote_answer *twin, double scale)
{
    bool equal = twin->distance == scale * base->distance && twin->contact == base->contact &&
                 twin->has_lower == base->has_lower && twin->lower == scale * base->lower &&
                 twin->has_witness == base->has_witness;
    for (int b = 0; b < 2 && equal && base->has_witness; ++b)
        equal = same(twin->witness[b], mote_scale(base->witness[b], scale));
    return equal;
}

static void note_error(errors *e, double truth, const double said[2], double length)
{
    if ((e->count & (e->count - 1)) == 0) {
        const size_t room = e->count ? 2 * e->count : 64;
        e->of_base = realloc(e->of_base, room * sizeof *e->of_base);
        e->of_twin = realloc(e->of_twin, room * sizeof *e->of_twin);
        need(e->of_base && e->of_twin);
    }
    for (int k = 0; k < 2; ++k) {
        const double error = fabs(said[k] - truth) / length;
        (k == 0 ? e->of_base : e->of_twin)[e->count] = error > ROUNDING ? error : 0;
    }
    ++e->count;
}

static bool compare_frame(relation *r, pair *p, bool sampled)
{
    const double scale = p->twin.length / p->base.length;
    double truth = 0;
    for (int m = 0; m < METHODS; ++m) {
        mote_answer base, twin;
        if (mote_engine_answer(p->probe[0][m], &p->base.frame, &base) != MOTE_OK ||
            mote_engine_answer(p->probe[1][m], &p->twin.frame, &twin) != MOTE_OK) {
            fprintf(stderr, "metamorphic: %s: %s\n", methods[m], mote_error_text());
            return false;
        }
        const double said[2] = {base.distance, twin.distance / scale};
        const double difference = fabs(said[1] - said[0]) / p->base.length;
        truth = m == 0 ? base.distance : truth;
        if (r->same_bits || m < EXACT) {
            ++r->tried;
            r->failed +=
                r->same_bits ? !scaled(&base, &twin, scale) : !(difference <= ROUNDING);
        } else if (!(difference < HUGE_VAL)) {
            ++r->failed; /* NaN is not a valid answer */
        }
        if (m < EXACT && !(difference <= r->difference))
            r->difference = difference;
        if (m >= EXACT && r->keeps_vertices && sampled)
            note_error(&r->errors[m], truth, said, p->base.length);
    }
    return true;
}

static bool run_pair(relation *r, uint32_t index)
{
    pair p;
    bool good = open_pair(&p, r, index);
    for (int k = 0; k < FRAMES_A_SCENE && good; ++k) {
        if (k % FRAMES_A_LEAP == 0)
            scene_next(&p.base, 1.4, false);
        else
            scene_step(&p.base);
        twin_follow(&p.base, &p.change, &p.twin);
        good = compare_frame(r, &p, k % FRAMES_A_LEAP == FRAMES_A_LEAP - 1);
    }
    close_pair(&p);
    return good;
}

/* Whether the quantiles' intervals, four standard errors of the rank to each side, overlap. */
static bool quantile_kept(const errors *e, double q)
{
    const double spread = 4 * sqrt(q * (1 - q) / (double)e->count);
    const double low = fmax(0, q - spread), high = fmin(1, q + spread);
    return mote_statistics_quantile(e->of_twin, e->count, low) <=
               mote_statistics_quantile(e->of_base, e->count, high) &&
           mote_statistics_quantile(e->of_base, e->count, low) <=
               mote_statistics_quantile(e->of_twin, e->count, high);
}

/* Compares the quantiles of errors; counts each as tried, and as failed if it moved. */
static void compare_quantiles(relation *r)
{
    for (int m = EXACT; m < METHODS && r->keeps_vertices; ++m) {
        errors *e = &r->errors[m];
        mote_statistics_sort(e->of_base, e->count);
        mote_statistics_sort(e->of_twin, e->count);
        for (int k = 0; k < QUANTILES; ++k) {
            const bool kept = quantile_kept(e, quantiles[k]);
            ++r->tried;
            r->failed += !kept;
            printf("    %-46s p%-3g %9.3g %9.3g%s\n", methods[m], 100 * quantiles[k],
                   mote_statistics_quantile(e->of_base, e->count, quantiles[k]),
                   mote_statistics_quantile(e->of_twin, e->count, quantiles[k]),
                   kept ? "" : "  moved");
        }
    }
}

static bool write_json(const char *path, const relation *relations, size_t count)
{
    FILE *file = fopen(path, "w");
    if (!file) {
        fprintf(stderr, "metamorphic: cannot write %s\n", path);
        return false;
    }
    fprintf(file, "[\n");
    for (size_t i = 0; i < count; ++i)
        fprintf(file,
                "  {\"check\": \"metamorphic: %s\", \"tried\": %llu, \"failed\": %llu, "
                "\"largest_difference\": %.3g}%s\n",
                relations[i].name, (unsigned long long)relations[i].tried,
                (unsigned long long)relations[i].failed, relations[i].difference,
                i + 1 < count ? "," : "");
    fprintf(file, "]\n");
    return fclose(file) == 0;
}

static bool run_relation(relation *r, const checks_options *options)
{
    for (uint32_t index = (uint32_t)options->first; r->tried < options->queries; ++index) {
        if (!run_pair(r, index))
            return false;
    }
    printf("%-34s %10llu queries %8llu differ, exact methods by %.2e L at most\n", r->name,
           (unsigned long long)r->tried, (unsigned long long)r->failed, r->difference);
    compare_quantiles(r);
    for (int m = 0; m < METHODS; ++m) {
        free(r->errors[m].of_base);
        free(r->errors[m].of_twin);
    }
    return true;
}

int main(int argc, char **argv)
{
    checks_options options = {.queries = 20000};
    if (!checks_read(argc, argv, "metamorphic", &options))
        return 2;
    relation relations[] = {
        {.name = "scaled by a power of two", .same_bits = true},
        {.name = "bodies swapped", .change = {.swap = true}, .keeps_vertices = true},
        {.name = "vertices and faces permuted",
         .change = {.permute = true},
         .keeps_vertices = true},
        {.name = "faces wound the other way", .change = {.flip = true}, .keeps_vertices = true},
        {.name = "moved rigidly", .change = {.move = true}, .keeps_vertices = true},
        {.name = "refined", .change = {.refine = true}, .rigid = true},
    };
    const size_t count = sizeof relations / sizeof *relations;
    uint64_t failed = 0;
    for (size_t i = 0; i < count; ++i) {
        if (!run_relation(&relations[i], &options))
            return 1;
        failed += relations[i].failed;
        char name[64];
        (void)snprintf(name, sizeof name, "metamorphic: %s", relations[i].name);
        if (!checks_add(options.checks, name, relations[i].tried, relations[i].failed))
            return 1;
    }
    if (options.out && !write_json(options.out, relations, count))
        return 1;
    return failed == 0 ? 0 : 1;
}
