/* Streamed queries of two bodies. */
#include "core/stream/stream_beside.h"

#include "core/stream/stream_state.h"

#include <stdlib.h>

struct mote_stream {
    mote_stream_tree *tree[2];
    bool borrowed; /* the trees are another one's */
    mote_stream_body body[2];
    mote_stream_search search;
    mote_stream_memory memory;
    mote_pool *pool; /* or NULL */
};

mote_stream_options mote_default_stream_options(double length)
{
    return (mote_stream_options){
        .length = length, .budget = UINT64_MAX, .coherent = true, .threads = 1};
}

void mote_stream_destroy(mote_stream *stream)
{
    if (!stream)
        return;
    mote_pool_destroy(stream->pool);
    mote_stream_search_free(&stream->search);
    for (int b = 0; b < 2; ++b) {
        mote_stream_body_free(&stream->body[b]);
        if (!stream->borrowed)
            mote_stream_tree_destroy(stream->tree[b]);
    }
    free(stream);
}

/* Makes everything but the trees. */
static mote_status build_on_trees(mote_stream *stream, const mote_stream_options *options)
{
    const mote_body *body[2];
    uint32_t room[2];
    mote_status status = MOTE_OK;
    if (options->threads != 1)
        status = mote_pool_create(options->threads, &stream->pool);
    for (int b = 0; b < 2 && status == MOTE_OK; ++b) {
        body[b] = &stream->tree[b]->body;
        room[b] = stream->tree[b]->groups;
        status = mote_stream_body_init(&stream->body[b], stream->tree[b]);
    }
    if (status == MOTE_OK)
        status = mote_stream_search_init(&stream->search, options, body, room);
    return status;
}

static mote_stream *allocate(void)
{
    mote_stream *made = aligned_alloc(64, (sizeof *made + 63) / 64 * 64);
    if (made)
        *made = (mote_stream){.pool = NULL};
    else
        (void)mote_fail(MOTE_ENOMEM, "no memory for a streamed query");
    return made;
}

mote_status mote_stream_create(const mote_body *const body[2],
                               const mote_stream_options *options, mote_stream **stream)
{
    mote_stream *made = allocate();
    if (!made)
        return MOTE_ENOMEM;
    mote_status status = MOTE_OK;
    for (int b = 0; b < 2 && status == MOTE_OK; ++b)
        status = mote_stream_tree_create(body[b], &made->tree[b]);
    if (status == MOTE_OK)
        status = build_on_trees(made, options);
    if (status == MOTE_OK)
        *stream = made;
    else
        mote_stream_destroy(made);
    return status;
}

mote_status mote_stream_create_beside(const mote_stream *owner, mote_stream **stream)
{
    mote_stream *made = allocate();
    if (!made)
        return MOTE_ENOMEM;
    made->borrowed = true;
    for (int b = 0; b < 2; ++b)
        made->tree[b] = owner->tree[b];
    mote_status status = build_on_trees(made, &owner->search.options);
    if (status == MOTE_OK)
        *stream = made;
    else
        mote_stream_destroy(made);
    return status;
}

void mote_stream_forget(mote_stream *stream)
{
    stream->memory = (mote_stream_memory){.has_last = false};
}

size_t mote_stream_bytes(const mote_stream *stream)
{
    size_t bytes = sizeof *stream + mote_stream_search_bytes(&stream->search);
    for (int b = 0; b < 2; ++b)
        bytes += (stream->borrowed ? 0 : mote_stream_tree_bytes(stream->tree[b])) +
                 mote_stream_body_bytes(&stream->body[b]);
    return bytes;
}

/* After a frame that was refused, an unchanged one has the positions of that frame. */
static void forget_boxes(mote_stream *stream)
{
    for (int b = 0; b < 2; ++b)
        stream->body[b].placed = stream->body[b].checked = false;
}

/* Sets a frame's positions; boxes that were made for other positions are then invalid. */
static mote_status set_positions(mote_stream *stream, const mote_stream_frame *frame)
{
    for (int b = 0; b < 2; ++b) {
        mote_status status = mote_stream_check(&frame->positions[b], b);
        if (status != MOTE_OK) {
            forget_boxes(stream);
            return status;
        }
    }
    for (int b = 0; b < 2; ++b) {
        mote_stream_body *body = &stream->body[b];
        body->positions = frame->positions[b];
        body->placed = body->placed && frame->unchanged[b];
        body->checked = body->checked && frame->unchanged[b];
    }
    return MOTE_OK;
}

/* Checks the positions that no pass will read. */
static mote_status check_positions(mote_stream *stream)
{
    for (int b = 0; b < 2; ++b) {
        mote_status status = mote_stream_finite(&stream->body[b], b);
        if (status != MOTE_OK)
            return status;
    }
    return MOTE_OK;
}

/* Boxes bodies that moved, or whose boxes have another scale. */
static mote_status pass(mote_stream *stream)
{
    mote_stream_search *s = &stream->search;
    mote_stream_choose(s);
    for (int b = 0; b < 2; ++b) {
        mote_stream_body *body = &stream->body[b];
        if (body->placed && !(body->scale < s->scale || body->scale > s->scale))
            continue;
        mote_status status = mote_stream_pass(body, s->origin, s->scale, stream->pool, b);
        if (status != MOTE_OK)
            return status;
        s->counters.positions += body->tree->mesh->vertex_count;
    }
    return MOTE_OK;
}

mote_status mote_stream_query(mote_stream *stream, const mote_stream_frame *frame,
                              double enough, mote_certificate_answer *answer)
{
    mote_stream_search *s = &stream->search;
    mote_stream_body *const body[2] = {&stream->body[0], &stream->body[1]};
    mote_status status = set_positions(stream, frame);
    if (status != MOTE_OK)
        return status;
    const bool near = mote_stream_seed(s, body, &stream->memory, enough);
    if (!isfinite(s->upper) || s->done)
        status = check_positions(stream);
    if (status == MOTE_OK && !isfinite(s->upper))
        status =
            mote_fail(MOTE_EINVAL, "the bodies are too far apart to square their distance");
    if (status == MOTE_OK && !s->done)
        status = pass(stream);
    if (status == MOTE_OK && !s->done)
        status = mote_stream_prove(s, !near);
    if (status == MOTE_OK)
        mote_stream_write(s, &stream->memory, answer);
    return status;
}
