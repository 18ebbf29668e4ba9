/* A streamed query of small scenes of which every part can be set and read. */
#ifndef MOTE_TESTS_OWN_STREAM_H
#define MOTE_TESTS_OWN_STREAM_H

#include "core/stream/stream_state.h"
#include "tests/support/stream_scene.h"

typedef struct own_query {
    mote_stream_tree *tree[2];
    mote_stream_body body[2];
    mote_stream_search search;
    mote_stream_memory memory;
} own_query;

static inline void own_init(own_query *own, const scene *s)
{
    mote_stream_options options = mote_default_stream_options(s->length);
    const mote_body *largest[2];
    uint32_t room[2];
    options.coherent = false;
    own->memory = (mote_stream_memory){.has_last = false};
    for (int b = 0; b < 2; ++b) {
        assert_int_equal(mote_stream_tree_create(&s->body[b], &own->tree[b]), MOTE_OK);
        assert_int_equal(mote_stream_body_init(&own->body[b], own->tree[b]), MOTE_OK);
        largest[b] = &own->tree[b]->body;
        room[b] = own->tree[b]->groups;
    }
    assert_int_equal(mote_stream_search_init(&own->search, &options, largest, room), MOTE_OK);
}

static inline void own_free(own_query *own)
{
    mote_stream_search_free(&own->search);
    for (int b = 0; b < 2; ++b) {
        mote_stream_body_free(&own->body[b]);
        mote_stream_tree_destroy(own->tree[b]);
    }
}

/* Asks about the positions that the bodies have. */
static inline mote_certificate_answer own_ask_again(own_query *own)
{
    mote_stream_search *search = &own->search;
    mote_stream_body *const body[2] = {&own->body[0], &own->body[1]};
    mote_certificate_answer answer;
    const bool near = mote_stream_seed(search, body, &own->memory, -1);
    mote_stream_choose(search);
    for (int b = 0; b < 2; ++b)
        assert_int_equal(mote_stream_pass(body[b], search->origin, search->scale, NULL, b),
                         MOTE_OK);
    assert_int_equal(mote_stream_prove(search, !near), MOTE_OK);
    mote_stream_write(search, &own->memory, &answer);
    return answer;
}

static inline mote_certificate_answer own_ask(own_query *own, const scene *s)
{
    for (int b = 0; b < 2; ++b)
        own->body[b].positions = mote_positions_of(s->world[b]);
    return own_ask_again(own);
}

#endif
