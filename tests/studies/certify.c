/* make certify: is a proven lower bound ever above the truth, and how far is the distance from
   it? Small deforming bodies move in many frames, by small steps and by leaps, near and far.
   Each frame is answered by certified queries with and without memory, slack and budget, by two
   that ask for contact alone, and by all pairs of triangles; of every 50th frame each pair is
   measured, and otherwise those that their boxes leave over. Usage: certify [--queries N]
   [--out FILE] [--checks FILE]. Exit status 1 where a bound is above the truth, an answer below
   it, where an unstopped query's error or bracket exceeds its slack by more than 1e-12 L, or
   where contact is not decided rightly. */
#include "core/certificate/certificate.h"
#include "tests/support/truth.h"
#include "tests/support/variants.h"

#define ROUNDING 1e-12 /* of L */

enum { VARIANTS = 7, FRAMES_A_SCENE = 500, FRAMES_A_WHOLE_TRUTH = 50 };

typedef struct variant {
    mote_certificate_options options;
    mote_certificate *certificate;
    bool exact;
    double enough; /* over L, of a contact question; negative: the distance is asked for */
    variant_counts found;
} variant;

static void set_variants(variant v[VARIANTS], double length)
{
    static const char *const names[VARIANTS] = {"witness", "none",    "slack",   "budget",
                                                "pair",    "contact", "nearness"};
    for (int i = 0; i < VARIANTS; ++i) {
        v[i].found.name = names[i];
        v[i].options = mote_default_certificate_options(length);
        v[i].exact = i != 2 && i != 3 && i < 5;
        v[i].enough = -1;
    }
    v[1].options.seed = MOTE_CERT_SEED_NONE;
    v[2].options.slack = 1e-3;
    v[3].options.budget = 100;
    v[4].options.seed = MOTE_CERT_SEED_PAIR;
    v[5].enough = 0;
    v[6].enough = 0.1;
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

static void check_contact(variant *v, const scene *s, double truth)
{
    const double enough = v->enough * s->length;
    mote_certificate_answer a;
    mote_certificate_query(v->certificate, &s->frame, NULL, enough, &a);
    variant_count(&v->found, truth, a.lower, a.stopped, s->length);
    const bool contact = a.distance <= enough;
    const bool decided = contact != (a.lower > enough);
    const bool right = fabs(truth - enough) <= (enough > 0 ? ROUNDING * s->length : 0) ||
                       contact == (truth <= enough);
    v->found.wrong += decided && right && a.distance >= truth - ROUNDING * s->length ? 0 : 1;
}

static void check_distance(variant *v, const scene *s, double truth)
{
    mote_certificate_answer a;
    mote_certificate_query(v->certificate, &s->frame, NULL, -1, &a);
    const double error = fabs(a.distance - truth) / s->length;
    const double bracket = (a.distance - a.lower) / s->length;
    const double allowed = v->options.slack + ROUNDING;
    variant_count(&v->found, truth, a.lower, a.stopped, s->length);
    const bool right = a.stopped ? a.distance >= truth - ROUNDING * s->length
                                 : error <= allowed && bracket <= allowed;
    v->found.wrong += right ? 0 : 1;
    if (v->exact)
        v->found.most_error = error > v->found.most_error ? error : v->found.most_error;
}

static bool run_scene(variant v[VARIANTS], uint32_t index)
{
    scene s;
    scene_init(&s, 8 + index % 5, 6 + index % 4, ldexp(1.1, (int)(index % 40) - 20),
               index % 4 != 0);
    s.random += index;
    set_variants(v, s.length);
    bool made = create_all(v, &s);
    for (int k = 0; made && k < FRAMES_A_SCENE; ++k) {
        if (k % 10 == 0)
            scene_next(&s, 1.4, false);
        else
            scene_step(&s);
        const double truth = scene_truth(&s);
        if (k % FRAMES_A_WHOLE_TRUTH == 0 && truth != scene_distance(&s)) {
            fprintf(stderr,
                    "certify: boxes leave out the nearest triangles: scene %u, frame %d\n",
                    index, k);
            made = false;
        }
        for (int i = 0; i < VARIANTS; ++i)
            (v[i].enough < 0 ? check_distance : check_contact)(&v[i], &s, truth);
    }
    for (int i = 0; i < VARIANTS; ++i) {
        mote_certificate_destroy(v[i].certificate);
        v[i].certificate = NULL;
    }
    scene_free(&s);
    return made;
}

int main(int argc, char **argv)
{
    checks_options options = {.queries = 25000};
    if (!checks_read(argc, argv, "certify", &options))
        return 2;
    variant v[VARIANTS] = {{.exact = false}};
    const variant_counts *found[VARIANTS];
    uint64_t exact = 0;
    for (int i = 0; i < VARIANTS; ++i) {
        v[i].found.least_margin = HUGE_VAL;
        found[i] = &v[i].found;
    }
    for (uint32_t index = (uint32_t)options.first;
         variants_queries(found, VARIANTS) < options.queries; ++index) {
        if (!run_scene(v, index))
            return 1;
    }
    for (int i = 0; i < VARIANTS; ++i)
        exact += v[i].exact ? v[i].found.queries : 0;
    return variants_report(found, VARIANTS, &options,
                           "small scenes: a lower bound above the truth",
                           "small scenes: certified beyond 1e-12 L of brute force", exact);
}
