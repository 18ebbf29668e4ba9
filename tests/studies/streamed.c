/* make streamed: are streamed queries exact, whatever the deformation and the layout of the
   positions? Small bodies deform, shake, leap, collapse and move far away in many frames. Each
   frame is answered by all pairs of triangles and by streamed queries with and without memory,
   slack and budget, of distance and contact, from doubles and floats at several strides. Usage:
   streamed [--queries N] [--out FILE] [--checks FILE]. Exit status 1 where a bound is above the
   truth, an answer below it, or where an unstopped query's error or bracket exceeds its slack
   by more than 1e-12 L. Here L is the larger of L at rest and half the size of the positions,
   which may be in another unit. */
#include "core/stream/stream.h"
#include "tests/support/shapes.h"
#include "tests/support/variants.h"

#define ROUNDING 1e-12 /* of L */

enum { VARIANTS = 6, FRAMES_A_SCENE = 200 };

typedef struct variant {
    mote_stream_options options;
    mote_stream *stream;
    size_t numbers; /* per vertex */
    bool single, contact;
    variant_counts found;
} variant;

/* Positions in the layouts of the variants. */
typedef struct layouts {
    void *data[2];
} layouts;

static const variant plain[VARIANTS] = {
    {.found.name = "witness", .numbers = 3},
    {.found.name = "none", .numbers = 4},
    {.found.name = "slack", .numbers = 3},
    {.found.name = "budget", .numbers = 3, .single = true},
    {.found.name = "floats", .numbers = 4, .single = true},
    {.found.name = "contact", .numbers = 3, .contact = true}};

static bool create_all(variant v[VARIANTS], const scene *s)
{
    const mote_body *const bodies[2] = {&s->body[0], &s->body[1]};
    for (int i = 0; i < VARIANTS; ++i) {
        v[i].options = mote_default_stream_options(s->length);
        v[i].options.coherent = i != 1;
        v[i].options.slack = i == 2 ? 1e-3 : 0;
        v[i].options.budget = i == 3 ? 100 : UINT64_MAX;
        if (mote_stream_create(bodies, &v[i].options, &v[i].stream) != MOTE_OK) {
            fprintf(stderr, "streamed: %s\n", mote_error_text());
            return false;
        }
    }
    return true;
}

/* Copies the scene's positions into the layout of a variant, in arrays that end with the last
   vertex. */
static void lay_out(const scene *s, const variant *v, layouts *l, mote_stream_frame *frame)
{
    const size_t size = v->single ? sizeof(float) : sizeof(double);
    for (int b = 0; b < 2; ++b) {
        const uint32_t count = s->mesh[b]->vertex_count;
        const size_t numbers = (count - 1) * v->numbers + 3;
        l->data[b] = malloc(numbers * size);
        need(l->data[b]);
        for (size_t i = 0; i < numbers; ++i) {
            const mote_vec3 p = s->world[b][i / v->numbers];
            const double part[4] = {p.x, p.y, p.z, 1e300};
            if (v->single)
                ((float *)l->data[b])[i] = (float)part[i % v->numbers];
            else
                ((double *)l->data[b])[i] = part[i % v->numbers];
        }
        frame->positions[b] = (mote_positions){
            .data = l->data[b], .stride = v->numbers * size, .single = v->single};
    }
}

/* Half the diagonal of the box around both bodies, or L at rest where that is larger. */
static double length_of(const scene *s)
{
    double low[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL};
    double high[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    for (int b = 0; b < 2; ++b) {
        for (uint32_t i = 0; i < s->mesh[b]->vertex_count; ++i) {
            const mote_vec3 p = s->world[b][i];
            const double x[3] = {p.x, p.y, p.z};
            for (int k = 0; k < 3; ++k) {
                low[k] = fmin(low[k], x[k]);
                high[k] = fmax(high[k], x[k]);
            }
        }
    }
    const double size =
        sqrt((high[0] - low[0]) * (high[0] - low[0]) + (high[1] - low[1]) * (high[1] - low[1]) +
             (high[2] - low[2]) * (high[2] - low[2]));
    return fmax(s->length, 0.5 * size);
}

static bool right(const variant *v, const mote_certificate_answer *a, double truth,
                  double tolerance, double length)
{
    const double allowed = v->options.slack * length + ROUNDING * length;
    if (a->distance < truth - ROUNDING * length)
        return false;
    if (v->contact)
        return truth <= tolerance ? a->distance <= tolerance : a->lower > tolerance;
    return a->stopped || (a->distance - truth <= allowed && a->distance - a->lower <= allowed);
}

/* False where a query is refused. */
static bool check(variant *v, const scene *s, double truth)
{
    const double length = length_of(s), tolerance = 0.03 * length;
    mote_stream_frame frame = {.unchanged = {false, false}};
    layouts l;
    mote_certificate_answer a;
    lay_out(s, v, &l, &frame);
    mote_status status = mote_stream_query(v->stream, &frame, v->contact ? tolerance : -1, &a);
    free(l.data[0]);
    free(l.data[1]);
    if (status != MOTE_OK) {
        fprintf(stderr, "streamed: %s\n", mote_error_text());
        return false;
    }
    const double error = fabs(a.distance - truth) / length;
    variant_count(&v->found, truth, a.lower, a.stopped, length);
    v->found.wrong += right(v, &a, truth, tolerance, length) ? 0 : 1;
    if (!v->contact && !a.stopped && !(v->options.slack > 0))
        v->found.most_error = error > v->found.most_error ? error : v->found.most_error;
    return true;
}

/* Changes that arrays of positions allow and no field makes: each vertex moves by itself; a
   body collapses towards its origin; both are far away. All numbers are floats. */
static void disturb(scene *s, uint32_t index, int frame)
{
    static const double shakes[] = {0, 1e-4, 0.01, 0.3};
    static const double offsets[] = {0, 0, 0, 1e3};
    const double shake = shakes[index % 4] * s->length;
    const double offset = offsets[index / 4 % 4] * s->length;
    const double size = index % 7 == 6 && frame % 3 == 0 ? 1e-5 : 1;
    for (int b = 0; b < 2; ++b) {
        for (uint32_t v = 0; v < s->mesh[b]->vertex_count; ++v) {
            const double x = scene_random(s, -shake, shake), y = scene_random(s, -shake, shake);
            const mote_vec3 d = {offset + x, y - offset, scene_random(s, -shake, shake)};
            const double part = b == 0 ? size : 1;
            s->world[b][v] = mote_as_floats(mote_add_scaled(d, part, s->world[b][v]));
        }
    }
}

static bool run_scene(variant v[VARIANTS], uint32_t index)
{
    scene s;
    const uint32_t finer = index % 8 == 7 ? 3 : 1;
    scene_init(&s, finer * (8 + index % 5), finer * (5 + index % 4),
               ldexp(1.1, (int)(index % 40) - 20), index % 4 != 0);
    s.random += index;
    bool good = create_all(v, &s);
    for (int k = 0; good && k < FRAMES_A_SCENE / (int)(finer * finer); ++k) {
        if (k % 10 == 0)
            scene_next(&s, 1.4, false);
        else
            scene_step(&s);
        disturb(&s, index, k);
        const double truth = scene_distance(&s);
        for (int i = 0; good && i < VARIANTS; ++i)
            good = check(&v[i], &s, truth);
    }
    for (int i = 0; i < VARIANTS; ++i) {
        mote_stream_destroy(v[i].stream);
        v[i].stream = NULL;
    }
    scene_free(&s);
    return good;
}

int main(int argc, char **argv)
{
    checks_options options = {.queries = 25000};
    if (!checks_read(argc, argv, "streamed", &options))
        return 2;
    variant v[VARIANTS];
    const variant_counts *found[VARIANTS];
    memcpy(v, plain, sizeof v);
    for (int i = 0; i < VARIANTS; ++i) {
        v[i].found.least_margin = HUGE_VAL;
        found[i] = &v[i].found;
    }
    for (uint32_t index = (uint32_t)options.first;
         variants_queries(found, VARIANTS) < options.queries; ++index) {
        if (!run_scene(v, index))
            return 1;
    }
    return variants_report(
        found, VARIANTS, &options, "arrays of positions: a lower bound above the truth",
        "arrays of positions: streamed beyond 1e-12 L", variants_queries(found, VARIANTS));
}
