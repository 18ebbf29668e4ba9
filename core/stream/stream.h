/* The exact distance of two bodies of which only the vertices' positions in each frame are
   known: cloth, finite elements, captured sequences (docs/architecture.md, "The streamed
   query").

   A query starts from the last frame's nearest faces, slid downhill, which gives an upper bound
   and a direction. Then one pass over the positions boxes groups of 256 triangles only; the
   levels above follow from those. Both trees are traversed to pairs of groups, whose leaves of
   32 triangles are boxed only then, in axes the first of which is the direction of the gap. Two
   leaves are decided as the certificate decides them. Single precision only rules out pairs,
   with margins that hold; what decides the answer is computed in double precision. Half of the
   time is the pass, which costs little more than reading the positions. */
#ifndef MOTE_CORE_STREAM_H
#define MOTE_CORE_STREAM_H

#include "core/body/positions.h"
#include "core/certificate/certificate.h"

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

typedef struct mote_stream mote_stream;

typedef struct mote_stream_options {
    double length;    /* > 0: L of the pair */
    double slack;     /* >= 0: a query stops when upper - lower <= slack * length */
    uint64_t budget;  /* box tests after which a query stops and returns its bracket */
    bool coherent;    /* a query starts from the last one's faces; false: no state is kept */
    uint32_t threads; /* 1 .. 256, that share the pass where a body has 100,000 triangles */
} mote_stream_options;

/* No slack, no limit of box tests, a start from the last faces, one thread. */
mote_stream_options mote_default_stream_options(double length);

/* Builds a tree for each of two meshes: O(t log t), about 0.5 s a million triangles. The
   bodies' meshes are borrowed. Their fields are used for samples only, during this call, and
   may be NULL where sample_count is 0. MOTE_EINVAL: threads out of range; MOTE_ENOMEM. The
   caller destroys *stream; one thread at a time may use it. With two threads or more, a child
   process made by fork must not use it. */
mote_status mote_stream_create(const mote_body *const body[2],
                               const mote_stream_options *options, mote_stream **stream);

/* NULL is allowed. */
void mote_stream_destroy(mote_stream *stream);

/* Bytes of heap held: about 14 a triangle. */
size_t mote_stream_bytes(const mote_stream *stream);

/* Where the vertices of both bodies are, in the same axes. */
typedef struct mote_stream_frame {
    mote_positions positions[2]; /* of as many vertices as the meshes have */
    bool unchanged[2];           /* the same numbers as in the frame before, which may have been
                                    refused; spares the pass */
} mote_stream_frame;

/* Answers one frame. enough: a contact question's tolerance, so that the query ends when
   distance <= enough or lower > enough; negative for the distance. The answer is that of
   mote_certificate_query: the same bits on every instruction set and for any number of threads.
   MOTE_EINVAL, naming the body: no positions, a stride that is too small or not a multiple of
   the numbers' size, data that is not aligned to them; a position that is not finite (looked
   for in every frame but an unchanged one), naming the vertex; positions 10^18 times as far
   apart as the larger of L and the distance; bodies so far apart that the square of their
   distance is no double. No allocation. */
mote_status mote_stream_query(mote_stream *stream, const mote_stream_frame *frame,
                              double enough, mote_certificate_answer *answer);

/* An order of a mesh's vertices in which the pass reads memory from start to end:
   order[vertex_count], the old number of each new vertex. Vertices in this order halve a
   query's time at a million triangles. The body's field may be NULL where it has no
   samples. MOTE_ENOMEM. Cost O(t log t). */
mote_status mote_stream_order(const mote_body *body, uint32_t *order);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
