/* make impacts: asks for the time of impact of two small bodies on random paths, and compares
   with 1,000 samples of the path by the certified distance, the first crossing bisected, and
   with all pairs of triangles at the bracket's end. The bodies are rigid, deform by radial
   functions, modes, bones, morph targets or both, or are arrays of positions with straight
   paths (samples of these are streamed queries), against their like or a body of another kind;
   they cross slowly and fast, turn a little or many times, graze each other at the sampled
   least distance, touch at the start, stand still, or swing past with a long arm. Usage:
   impacts [--queries N] [--out FILE] [--checks FILE]. Exit status 1 where an impact is missed
   or false, or found after another, or a bracket is too wide. */
#include "core/certificate/certificate.h"
#include "tests/support/checks.h"
#include "tests/support/impact_scene.h"

#include <stdio.h>

enum { SAMPLES = 1000, QUERIES_A_SCENE = 40 };

typedef enum family {
    CROSSING,
    SPINNING,
    MANY_TURNS,
    DEFORMING,
    GRAZING,
    TOUCHING,
    STILL,
    ARM,
    FAMILIES
} family;

static const char *const names[FAMILIES] = {"crossing", "spinning", "many turns", "deforming",
                                            "grazing",  "touching", "still",      "arm"};

typedef struct counts {
    uint64_t queries, found, missed, early, wrong, wide, grazing, undecided, iterations;
} counts;

/* Samples of a path's distances, by a certificate of their own, or by a streamed query. */
typedef struct samples {
    mote_certificate *certificate;
    mote_stream *stream; /* or NULL */
    double distance[SAMPLES + 1];
    double least;
} samples;

static double distance_at(impact_scene *s, samples *sampled, double time)
{
    static mote_frame frame;
    mote_certificate_answer a;
    if (sampled->stream) {
        mote_stream_frame placed = {.unchanged = {false, false}};
        for (int i = 0; i < 2; ++i) {
            impact_place(&s->of[i], time);
            placed.positions[i] = mote_positions_of(s->of[i].world);
        }
        need(mote_stream_query(sampled->stream, &placed, -1, &a) == MOTE_OK);
        return a.distance;
    }
    impact_frame(s, time, &frame);
    mote_certificate_query(sampled->certificate, &frame, NULL, -1, &a);
    return a.distance;
}

static void sample(impact_scene *s, samples *sampled)
{
    sampled->least = HUGE_VAL;
    for (int i = 0; i <= SAMPLES; ++i) {
        sampled->distance[i] = distance_at(s, sampled, (double)i / SAMPLES);
        sampled->least = fmin(sampled->least, sampled->distance[i]);
    }
}

/* The first time of contact that the samples show, bisected; 2 where they show none. */
static double first_contact(impact_scene *s, samples *sampled, double tolerance)
{
    for (int i = 0; i <= SAMPLES; ++i) {
        if (sampled->distance[i] > tolerance)
            continue;
        if (i == 0)
            return 0;
        double low = (i - 1.0) / SAMPLES, high = (double)i / SAMPLES;
        for (int k = 0; k < 40; ++k) {
            const double middle = 0.5 * (low + high);
            if (distance_at(s, sampled, middle) <= tolerance)
                high = middle;
            else
                low = middle;
        }
        return high;
    }
    return 2;
}

/* Sets both paths of a query, and returns its tolerance. */
static double set_paths(impact_scene *s, family f, samples *sampled)
{
    static const double tolerances[] = {0, 1e-6, 1e-3, 1e-3, 0.02};
    mote_random *r = &s->random;
    const double length = s->length;
    double tolerance = tolerances[mote_random_below(r, 5)] * length;
    const uint32_t pieces = 1 + (uint32_t)mote_random_below(r, 2) * 3;
    for (int i = 0; i < 2; ++i) {
        const double far = f == ARM ? 0.6 : 1.6;
        impact_wild w = {.pieces = pieces,
                         .from = mote_scale(mote_random_direction(r), far * length),
                         .stray = f == CROSSING ? 0 : 0.2 * length,
                         .turn = 0.3,
                         .spins = mote_random_below(r, 2) == 1,
                         .weights = 0.08 * length};
        w.to = mote_add(mote_scale(w.from, -1), impact_vector(r, length));
        if (f == SPINNING || f == ARM)
            w.turn = 3;
        if (f == MANY_TURNS)
            w.turn = 40, w.spins = true;
        if (f == STILL)
            w.to = w.from, w.stray = w.turn = w.weights = 0;
        if (f == ARM)
            w.to = w.from;
        s->of[i].path.pivot = f == ARM ? s->of[i].mesh->low : impact_vector(r, 0.2 * length);
        impact_path_random(&s->of[i], &w, r);
    }
    sample(s, sampled);
    if (f == GRAZING && sampled->least > 0) {
        static const double parts[] = {1e-2, 1e-4, 1e-6, 1e-9, -1e-3, -1e-6};
        tolerance = sampled->least * (1 - parts[mote_random_below(r, 6)]);
    }
    if (f == TOUCHING)
        tolerance = sampled->distance[0] * (1 + 1e-12);
    return tolerance;
}

static void judge(impact_scene *s, samples *sampled, double tolerance,
                  const mote_impact_found *found, counts *n)
{
    const double first = first_contact(s, sampled, tolerance);
    ++n->queries;
    n->iterations += found->iterations;
    n->grazing += found->outcome == MOTE_IMPACT_GRAZING;
    n->undecided += found->outcome == MOTE_IMPACT_UNDECIDED;
    n->missed += found->outcome == MOTE_IMPACT_NONE && first <= 1;
    /* a contact before the time until which there is none by proof */
    n->early += found->outcome != MOTE_IMPACT_NONE && first < found->from;
    if (found->outcome == MOTE_IMPACT_GRAZING)
        n->wrong += impact_distance(s, found->from) > tolerance + 1e-9 * s->length;
    if (found->outcome != MOTE_IMPACT_FOUND)
        return;
    ++n->found;
    n->wrong += impact_distance(s, found->to) > tolerance + 1e-13 * s->length;
    n->wide += found->to - found->from > 1.0001e-6;
}

static mote_mesh *random_mesh(mote_random *r, family f, double size)
{
    if (f == ARM)
        return impact_box(2 * size, 0.1 * size, 0.1 * size);
    switch (mote_random_below(r, 3)) {
    case 0:
        return impact_box(size, 0.7 * size, impact_between(r, 0.1, 1) * size);
    case 1:
        return make_torus(7, 5, size / 3);
    default:
        return make_torus(12 + (uint32_t)mote_random_below(r, 9), 8, size / 3);
    }
}

/* The kinds of both bodies of a scene. */
static void choose_kinds(uint64_t index, family f, mote_random *r, impact_kind kinds[2])
{
    kinds[0] = kinds[1] = IMPACT_RIGID;
    if (f == DEFORMING)
        kinds[0] = kinds[1] = 1 + (impact_kind)(index / FAMILIES % (IMPACT_KINDS - 1));
    else if (index % 3 == 0)
        kinds[0] = kinds[1] = (impact_kind)mote_random_below(r, IMPACT_KINDS);
    else if (index % 3 == 1)
        kinds[mote_random_below(r, 2)] = (impact_kind)mote_random_below(r, IMPACT_KINDS);
}

static mote_status open_samples(const impact_scene *s, samples *sampled)
{
    const mote_body *const bodies[2] = {&s->of[0].body, &s->of[1].body};
    *sampled = (samples){.least = 0};
    if (mote_body_is_given(bodies[0]) || mote_body_is_given(bodies[1])) {
        const mote_stream_options streamed = mote_default_stream_options(s->length);
        return mote_stream_create(bodies, &streamed, &sampled->stream);
    }
    mote_certificate_options options = mote_default_certificate_options(s->length);
    options.directions = false; /* another way to the same distance */
    return mote_certificate_create(bodies, &options, &sampled->certificate);
}

static bool run_scene(uint64_t index, counts all[FAMILIES], uint64_t *left)
{
    static const double sizes[] = {1, 1e-6, 1e5, 1, 3};
    mote_random r = {index + 1};
    const family f = (family)(index % FAMILIES);
    impact_kind kinds[2];
    choose_kinds(index, f, &r, kinds);
    const double size = sizes[mote_random_below(&r, 5)];
    impact_scene s;
    samples sampled;
    mote_mesh *const first = random_mesh(&r, f, size);
    static const uint32_t patiences[] = {10, 0, 3}; /* 0: sweeps in every step */
    impact_scene_init_kinds(&s, first, random_mesh(&r, f, size * impact_between(&r, 0.3, 1)),
                            kinds, index, patiences[index / FAMILIES % 3]);
    bool good = open_samples(&s, &sampled) == MOTE_OK;
    for (int k = 0; good && k<QUERIES_A_SCENE && * left> 0; ++k, --*left) {
        const double tolerance = set_paths(&s, f, &sampled);
        const mote_impact_question question = impact_question(&s, tolerance);
        mote_impact_found found;
        good = mote_impact_query(s.search, &question, &found) == MOTE_OK;
        if (good)
            judge(&s, &sampled, tolerance, &found, &all[f]);
    }
    if (!good)
        fprintf(stderr, "impacts: %s\n", mote_error_text());
    mote_certificate_destroy(sampled.certificate);
    mote_stream_destroy(sampled.stream);
    impact_scene_free(&s);
    return good;
}

static counts sum_of(const counts all[FAMILIES])
{
    counts sum = {.queries = 0};
    for (int f = 0; f < FAMILIES; ++f) {
        sum.queries += all[f].queries;
        sum.found += all[f].found;
        sum.missed += all[f].missed;
        sum.early += all[f].early;
        sum.wrong += all[f].wrong;
        sum.wide += all[f].wide;
        sum.grazing += all[f].grazing;
        sum.undecided += all[f].undecided;
        sum.iterations += all[f].iterations;
    }
    return sum;
}

static void print_row(const char *name, const counts *n)
{
    printf("%-10s %8" PRIu64 " %8" PRIu64 " %7" PRIu64 " %6" PRIu64 " %6" PRIu64 " %5" PRIu64
           " %8" PRIu64 " %9" PRIu64 " %11.1f\n",
           name, n->queries, n->found, n->missed, n->early, n->wrong, n->wide, n->grazing,
           n->undecided, n->queries > 0 ? (double)n->iterations / (double)n->queries : 0);
}

static bool write_json(const char *path, const counts *n)
{
    FILE *file = fopen(path, "w");
    bool good = file && fprintf(file,
                                "{\"intervals\": %" PRIu64 ", \"impacts\": %" PRIu64
                                ", \"missed\": %" PRIu64 ", \"after_another\": %" PRIu64
                                ", \"false\": %" PRIu64 ", \"too_wide\": %" PRIu64
                                ", \"grazing\": %" PRIu64 ", \"undecided\": %" PRIu64
                                ", \"iterations\": %" PRIu64 "}\n",
                                n->queries, n->found, n->missed, n->early, n->wrong, n->wide,
                                n->grazing, n->undecided, n->iterations) > 0;
    good = file && fclose(file) == 0 && good;
    if (!good)
        fprintf(stderr, "impacts: cannot write %s\n", path);
    return good;
}

int main(int argc, char **argv)
{
    checks_options options = {.queries = 2000};
    if (!checks_read(argc, argv, "impacts", &options))
        return 2;
    static counts all[FAMILIES];
    uint64_t left = options.queries;
    for (uint64_t index = options.first; left > 0; ++index) {
        if (!run_scene(index, all, &left))
            return 1;
    }
    printf("family     intervals  impacts  missed  early  false  wide  grazing undecided "
           "iterations\n");
    for (int f = 0; f < FAMILIES; ++f)
        print_row(names[f], &all[f]);
    const counts n = sum_of(all);
    print_row("all", &n);
    if ((options.out && !write_json(options.out, &n)) ||
        !checks_add(options.checks, "random paths: an impact missed", n.queries,
                    n.missed + n.early) ||
        !checks_add(options.checks, "random paths: a false impact", n.queries, n.wrong) ||
        !checks_add(options.checks, "random paths: a bracket above 1e-6", n.queries, n.wide))
        return 1;
    return n.missed + n.early + n.wrong + n.wide == 0 ? 0 : 1;
}
