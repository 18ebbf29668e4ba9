/* make certify: is a proven lower bound ever above the truth, and how far is the distance from
   it? Small deforming bodies move in many frames, by small steps and by leaps, near and far.
   Each frame is answered by certified queries with and without memory, slack and budget, and by
   all pairs of triangles. Usage: certify [--queries N] [--out FILE] [--checks FILE]. Exit
   status 1 where a bound is above the truth, an answer below it, or where an unstopped query's
   error or bracket exceeds its slack by more than 1e-12 L. */
#include "core/certificate/certificate.h"
#include "tests/support/checks.h"
#include "tests/support/shapes.h"

#include <math.h>
#include <stdio.h>

#define ROUNDING 1e-12 /* of L */

enum { VARIANTS = 5, FRAMES_A_SCENE = 500 };

typedef struct variant {
    const char *name;
    mote_certificate_options options;
    mote_certificate *certificate;
    bool exact;
    uint64_t queries, above, wrong, stopped;
    double least_margin; /* of truth - lower, over L, where apart */
    double most_error;   /* of |distance - truth|, over L, where exact */
} variant;

static void set_variants(variant v[VARIANTS], double length)
{
    static const char *const names[VARIANTS] = {"witness", "none", "slack", "budget", "pair"};
    for (int i = 0; i < VARIANTS; ++i) {
        v[i].name = names[i];
        v[i].options = mote_default_certificate_options(length);
        v[i].exact = i != 2 && i != 3;
    }
    v[1].options.seed = MOTE_CERT_SEED_NONE;
    v[2].options.slack = 1e-3;
    v[3].options.budget = 100;
    v[4].options.seed = MOTE_CERT_SEED_PAIR;
}

static bool create_all(variant v[VARIANTS], const scene *s)
{
    const mote_body *const bodies[2] = {&s->body[0], &s->body[1]};
    for (int i = 0; i < VARIANTS; ++i) {
        if (mote_certificate_create(bodies, &v[i].options, &v[i].certificate) != MOTE_OK) {
            fprintf(stderr, "certify: %s\n", mote_error_text());
            return false;
        }
    }
    return true;
}

static void check(variant *v, const scene *s, double truth)
{
    mote_certificate_answer a;
    mote_certificate_query(v->certificate, &s->frame, NULL, -1, &a);
    const double margin = (truth - a.lower) / s->length;
    const double error = fabs(a.distance - truth) / s->length;
    const double bracket = (a.distance - a.lower) / s->length;
    const double allowed = v->options.slack + ROUNDING;
    ++v->queries;
    v->stopped += a.stopped;
    v->above += a.lower <= truth ? 0 : 1;
    if (truth > 0 && margin < v->least_margin)
        v->least_margin = margin;
    const bool right = a.stopped ? a.distance >= truth - ROUNDING * s->length
                                 : error <= allowed && bracket <= allowed;
    v->wrong += right ? 0 : 1;
    if (v->exact)
        v->most_error = error > v->most_error ? error : v->most_error;
}

static bool run_scene(variant v[VARIANTS], uint32_t index)
{
    scene s;
    scene_init(&s, 8 + index % 5, 6 + index % 4, ldexp(1.1, (int)(index % 40) - 20),
               index % 4 != 0);
    s.random += index;
    set_variants(v, s.length);
    const bool made = create_all(v, &s);
    for (int k = 0; made && k < FRAMES_A_SCENE; ++k) {
        if (k % 10 == 0)
            scene_next(&s, 1.4, false);
        else
            scene_step(&s);
        const double truth = scene_distance(&s);
        for (int i = 0; i < VARIANTS; ++i)
            check(&v[i], &s, truth);
    }
    for (int i = 0; i < VARIANTS; ++i) {
        mote_certificate_destroy(v[i].certificate);
        v[i].certificate = NULL;
    }
    scene_free(&s);
    return made;
}

static uint64_t all_queries(const variant v[VARIANTS])
{
    uint64_t sum = 0;
    for (int i = 0; i < VARIANTS; ++i)
        sum += v[i].queries;
    return sum;
}

static bool write_json(const char *path, const variant v[VARIANTS])
{
    FILE *file = fopen(path, "w");
    if (!file) {
        fprintf(stderr, "certify: cannot write %s\n", path);
        return false;
    }
    fprintf(file, "[\n");
    for (int i = 0; i < VARIANTS; ++i)
        fprintf(file,
                "  {\"variant\": \"%s\", \"queries\": %llu, \"lower_above_truth\": %llu, "
                "\"wrong\": %llu, \"stopped\": %llu, \"least_margin\": %.3g, "
                "\"largest_error\": %.3g}%s\n",
                v[i].name, (unsigned long long)v[i].queries, (unsigned long long)v[i].above,
                (unsigned long long)v[i].wrong, (unsigned long long)v[i].stopped,
                v[i].least_margin, v[i].most_error, i + 1 < VARIANTS ? "," : "");
    fprintf(file, "]\n");
    return fclose(file) == 0;
}

static bool add_checks(const char *path, const variant v[VARIANTS])
{
    uint64_t above = 0, exact = 0, wrong = 0;
    for (int i = 0; i < VARIANTS; ++i) {
        above += v[i].above;
        wrong += v[i].wrong;
        exact += v[i].exact ? v[i].queries : 0;
    }
    return checks_add(path, "small scenes: a lower bound above the truth", all_queries(v),
                      above) &&
           checks_add(path, "small scenes: certified beyond 1e-12 L of brute force", exact,
                      wrong);
}

static int report(const variant v[VARIANTS], const char *out, const char *checks)
{
    bool good = true;
    printf("%-10s %10s %12s %8s %8s %14s %14s\n", "variant", "queries", "above truth", "wrong",
           "stopped", "least margin", "largest error");
    for (int i = 0; i < VARIANTS; ++i) {
        printf("%-10s %10llu %12llu %8llu %8llu %14.2e %14.2e\n", v[i].name,
               (unsigned long long)v[i].queries, (unsigned long long)v[i].above,
               (unsigned long long)v[i].wrong, (unsigned long long)v[i].stopped,
               v[i].least_margin, v[i].most_error);
        good = good && v[i].above == 0 && v[i].wrong == 0;
    }
    if ((out && !write_json(out, v)) || !add_checks(checks, v))
        return 1;
    return good ? 0 : 1;
}

int main(int argc, char **argv)
{
    checks_options options = {.queries = 25000};
    if (!checks_read(argc, argv, "certify", &options))
        return 2;
    variant v[VARIANTS] = {{.name = NULL}};
    for (int i = 0; i < VARIANTS; ++i)
        v[i].least_margin = HUGE_VAL;
    for (uint32_t index = 0; all_queries(v) < options.queries; ++index) {
        if (!run_scene(v, index))
            return 1;
    }
    return report(v, options.out, options.checks);
}
