/* Our distances against CGAL's, in an exact kernel that shares no code with ours.

       oracle_cgal [--pairs N] [--frames N]

   Pairs: the oracle's random pairs, most of them hard, except those of exactly degenerate
   triangles. Frames: evenly spaced ones of mv, tt-distance and ww. CGAL measures every pair of
   triangles whose boxes are no farther apart than the distance from `certified`, the nearest
   boxes first, so the whole frame is decided.

   Prints what it found; exit status 1 where our distance is off by more than 1e-15 of the
   pair's extent, or that of a frame by more than 1e-12 L. Also counts where CGAL's own distance
   of two triangles contradicts its predicate and its distances of edges and corners. */
#include "harness/engine/engine.h"
#include "core/body/deform.h"
#include "core/body/triangle.h"
#include "harness/base/memory.h"
#include "harness/scene/scenario.h"
#include "tests/support/peers/cgal_triangle.h"
#include "tests/support/triangle_pairs.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Errors allowed: of a pair over its extent, of a frame over L. */
#define PAIR_ERROR 1e-15
#define FRAME_ERROR 1e-12

typedef struct tally {
    uint64_t asked, degenerate, off, itself; /* itself: CGAL contradicts CGAL */
    double worst;
} tally;

static void judge_pairs(uint64_t pairs, tally *to)
{
    for (uint64_t i = 0; i < pairs; ++i) {
        uint64_t state = (i + 1) * 0x9e3779b97f4a7c15u;
        mote_vec3 s[3], t[3];
        pair_make((pair_sort)(i % PAIR_SORTS), s, t, &state);
        const cgal_verdict truth = cgal_triangles(s, t);
        if (truth.degenerate) {
            ++to->degenerate;
            continue;
        }
        const double extent = pair_extent(s, t, truth.parts);
        const double ours = sqrt(mote_triangle_triangle(s, t, NULL, NULL));
        const double error = fabs(ours - truth.parts) / extent;
        ++to->asked;
        to->off += error <= PAIR_ERROR ? 0 : 1;
        to->itself += fabs(truth.whole - truth.parts) > PAIR_ERROR * extent;
        to->worst = error > to->worst ? error : to->worst;
    }
}

typedef struct box {
    double low[3], high[3];
} box;

/* A pair of triangles, and the distance of their boxes. */
typedef struct candidate {
    double gap;
    uint32_t triangle[2];
} candidate;

/* A scenario being judged. */
typedef struct court {
    mote_scenario *scenario;
    mote_frame_buffer *buffer;
    mote_engine *engine;
    mote_deform *deform[2];
    mote_vec3 *world[2];
    box *boxes[2];
    candidate *candidates;
    size_t count, room;
} court;

static void corners(const court *c, int b, uint32_t triangle, mote_vec3 corner[3])
{
    for (int k = 0; k < 3; ++k)
        corner[k] = c->world[b][c->scenario->body[b].mesh->triangles[triangle][k]];
}

static box box_of(const mote_vec3 *points, size_t count)
{
    box made = {{HUGE_VAL, HUGE_VAL, HUGE_VAL}, {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}};
    for (size_t i = 0; i < count; ++i) {
        const double p[3] = {points[i].x, points[i].y, points[i].z};
        for (int k = 0; k < 3; ++k) {
            made.low[k] = fmin(made.low[k], p[k]);
            made.high[k] = fmax(made.high[k], p[k]);
        }
    }
    return made;
}

static double gap_of(const box *a, const box *b)
{
    double squared = 0;
    for (int k = 0; k < 3; ++k) {
        const double gap = fmax(0, fmax(a->low[k] - b->high[k], b->low[k] - a->high[k]));
        squared += gap * gap;
    }
    return sqrt(squared);
}

static void add(court *c, double gap, uint32_t i, uint32_t j)
{
    if (c->count == c->room) {
        c->room = 2 * c->room + 1024;
        c->candidates = mote_resize(c->candidates, c->room, sizeof *c->candidates);
    }
    c->candidates[c->count++] = (candidate){gap, {i, j}};
}

static int by_gap(const void *a, const void *b)
{
    const double x = ((const candidate *)a)->gap, y = ((const candidate *)b)->gap;
    return (x > y) - (x < y);
}

/* Lists the pairs of triangles with boxes at most `limit` apart, nearest first. */
static void list(court *c, double limit)
{
    box whole[2];
    for (int b = 0; b < 2; ++b) {
        const mote_mesh *mesh = c->scenario->body[b].mesh;
        whole[b] = box_of(c->world[b], mesh->vertex_count);
        for (uint32_t i = 0; i < mesh->triangle_count; ++i) {
            mote_vec3 corner[3];
            corners(c, b, i, corner);
            c->boxes[b][i] = box_of(corner, 3);
        }
    }
    c->count = 0;
    for (uint32_t i = 0; i < c->scenario->body[0].mesh->triangle_count; ++i) {
        if (gap_of(&c->boxes[0][i], &whole[1]) > limit)
            continue;
        for (uint32_t j = 0; j < c->scenario->body[1].mesh->triangle_count; ++j) {
            const double gap = gap_of(&c->boxes[0][i], &c->boxes[1][j]);
            if (gap <= limit)
                add(c, gap, i, j);
        }
    }
    qsort(c->candidates, c->count, sizeof *c->candidates, by_gap);
}

/* The distance of the frame by CGAL: the least over the candidates. */
static double by_cgal(const court *c, tally *to)
{
    double least = HUGE_VAL;
    for (size_t k = 0; k < c->count && c->candidates[k].gap <= least && least > 0; ++k) {
        mote_vec3 s[3], t[3];
        corners(c, 0, c->candidates[k].triangle[0], s);
        corners(c, 1, c->candidates[k].triangle[1], t);
        const cgal_verdict truth = cgal_triangles(s, t);
        to->degenerate += truth.degenerate;
        if (!truth.degenerate)
            least = fmin(least, truth.parts);
    }
    return least;
}

static mote_status open_court(const char *name, court *c)
{
    *c = (court){0};
    mote_status status = mote_scenario_load(name, &c->scenario);
    if (status == MOTE_OK)
        status = mote_engine_open_distance(c->scenario->body, "certified", &c->engine);
    for (int b = 0; b < 2 && status == MOTE_OK; ++b) {
        const mote_body *body = &c->scenario->body[b];
        c->world[b] = mote_allocate(body->mesh->vertex_count, sizeof *c->world[b]);
        c->boxes[b] = mote_allocate(body->mesh->triangle_count, sizeof *c->boxes[b]);
        status = mote_deform_create(body, &c->deform[b]);
    }
    if (status == MOTE_OK)
        c->buffer = mote_frame_buffer_create(c->scenario);
    return status;
}

static void close_court(court *c)
{
    mote_engine_destroy(c->engine);
    mote_frame_buffer_destroy(c->buffer);
    for (int b = 0; b < 2; ++b) {
        mote_deform_destroy(c->deform[b]);
        free(c->world[b]);
        free(c->boxes[b]);
    }
    free(c->candidates);
    mote_scenario_destroy(c->scenario);
}

static mote_status judge_frames(const char *name, uint32_t frames, tally *to)
{
    court c;
    mote_status status = open_court(name, &c);
    for (uint32_t k = 0; k < frames && status == MOTE_OK; ++k) {
        const uint64_t middle = (2 * (uint64_t)k + 1) * c.scenario->frames;
        const uint32_t number = 1 + (uint32_t)(middle / (2 * frames));
        const mote_frame *frame = mote_scenario_frame(c.scenario, c.buffer, number, 0);
        mote_answer ours = {0};
        for (int b = 0; b < 2; ++b)
            mote_deform_all(c.deform[b], &frame->body[b], c.world[b]);
        status = mote_engine_answer(c.engine, frame, &ours);
        if (status != MOTE_OK)
            break;
        const double length = c.scenario->length;
        list(&c, ours.distance + FRAME_ERROR * length);
        const double error = fabs(ours.distance - by_cgal(&c, to)) / length;
        ++to->asked;
        to->off += error <= FRAME_ERROR ? 0 : 1;
        to->worst = error > to->worst ? error : to->worst;
    }
    close_court(&c);
    return status;
}

static bool read_number(const char *text, uint64_t *number)
{
    char *end = NULL;
    *number = text ? strtoull(text, &end, 10) : 0;
    return text && end != text && *end == 0 && *text != '-' && *number <= 1000000000;
}

int main(int argc, char **argv)
{
    static const char *const scenarios[] = {"mv", "tt-distance", "ww"};
    uint64_t pairs = 19000, frames = 1000;
    for (int i = 1; i < argc; i += 2) {
        uint64_t *value = strcmp(argv[i], "--pairs") == 0    ? &pairs
                          : strcmp(argv[i], "--frames") == 0 ? &frames
                                                             : NULL;
        if (!value || !read_number(i + 1 < argc ? argv[i + 1] : NULL, value)) {
            (void)fprintf(stderr,
                          "oracle_cgal: %s: not an option with a whole number; "
                          "--pairs N and --frames N are\n",
                          argv[i]);
            return 2;
        }
    }
    tally p = {0}, all = {0};
    judge_pairs(pairs, &p);
    (void)printf(
        "pairs   %8llu asked, %llu degenerate, %llu off, worst %.2g of the extent; CGAL "
        "contradicts itself in %llu\n",
        (unsigned long long)p.asked, (unsigned long long)p.degenerate,
        (unsigned long long)p.off, p.worst, (unsigned long long)p.itself);
    for (size_t i = 0; i < sizeof scenarios / sizeof *scenarios; ++i) {
        tally f = {0};
        /* Two fifths of the frames each of mv and tt-distance, the rest of ww. */
        const uint64_t share = i < 2 ? frames * 2 / 5 : frames - 2 * (frames * 2 / 5);
        if (judge_frames(scenarios[i], (uint32_t)share, &f) != MOTE_OK) {
            (void)fprintf(stderr, "oracle_cgal: %s: %s\n", scenarios[i], mote_error_text());
            return 4;
        }
        (void)printf("%-12s %3llu frames, %llu off, worst %.2g L; %llu degenerate pairs left "
                     "out\n",
                     scenarios[i], (unsigned long long)f.asked, (unsigned long long)f.off,
                     f.worst, (unsigned long long)f.degenerate);
        all.off += f.off;
    }
    return p.off + all.off > 0;
}
