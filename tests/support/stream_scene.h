/* Streamed queries of small scenes that give positions only. */
#ifndef MOTE_TESTS_STREAM_SCENE_H
#define MOTE_TESTS_STREAM_SCENE_H

#include "core/stream/stream.h"
#include "tests/support/shapes.h"
#include "tests/support/test.h"

static inline mote_stream *stream_of(const scene *s, const mote_stream_options *options)
{
    const mote_body shapes[2] = {{.mesh = s->mesh[0]}, {.mesh = s->mesh[1]}};
    const mote_body *const bodies[2] = {&shapes[0], &shapes[1]};
    const mote_stream_options plain = mote_default_stream_options(s->length);
    mote_stream *stream = NULL;
    assert_int_equal(mote_stream_create(bodies, options ? options : &plain, &stream), MOTE_OK);
    return stream;
}

/* Moves every vertex by up to `size` of L, in addition to the scene's field. */
static inline void shake(scene *s, double size)
{
    for (int b = 0; b < 2; ++b) {
        for (uint32_t v = 0; v < s->mesh[b]->vertex_count; ++v) {
            double d[3];
            for (int k = 0; k < 3; ++k)
                d[k] = scene_random(s, -size, size) * s->length;
            s->world[b][v] = mote_add(s->world[b][v], mote_vec3_make(d[0], d[1], d[2]));
        }
    }
}

static inline mote_stream_frame positions_of(const scene *s)
{
    return (mote_stream_frame){
        .positions = {mote_positions_of(s->world[0]), mote_positions_of(s->world[1])}};
}

/* Copies vertices into another layout: `stride` numbers apart, the rest filled with NaN. The
   array ends with the last vertex; the caller frees it. */
static inline void *spread_out(const mote_vec3 *from, uint32_t count, size_t stride,
                               bool single)
{
    const size_t size = single ? sizeof(float) : sizeof(double);
    const size_t numbers = (count - 1) * stride + 3;
    char *made = malloc(numbers * size);
    need(made);
    for (size_t i = 0; i < numbers; ++i) {
        const mote_vec3 p = from[i / stride];
        const double part[3] = {p.x, p.y, p.z};
        const double x = i % stride < 3 ? part[i % stride] : (double)NAN;
        if (single)
            ((float *)(void *)made)[i] = (float)x;
        else
            ((double *)(void *)made)[i] = x;
    }
    return made;
}

static inline mote_certificate_answer
stream_answer(mote_stream *stream, const mote_stream_frame *frame, double enough)
{
    mote_certificate_answer answer;
    if (mote_stream_query(stream, frame, enough, &answer) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    return answer;
}

/* Checks that two answers are equal, however they were found. */
static inline void check_same_answer(const mote_certificate_answer *a,
                                     const mote_certificate_answer *b)
{
    assert_memory_equal(&a->distance, &b->distance, sizeof a->distance);
    assert_memory_equal(&a->lower, &b->lower, sizeof a->lower);
    assert_memory_equal(a->witness, b->witness, sizeof a->witness);
}

#endif
