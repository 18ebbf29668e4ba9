#include "harness/loop/bodies_book.h"

#include <stdlib.h>
#include <string.h>

/* The pair of these bodies from *at on, which is moved there; NULL: none. */
static const mote_bodies_pair *seek(const mote_bodies_pair *pairs, size_t count, size_t *at,
                                    const uint32_t body[2])
{
    while (*at < count && mote_pair_order(pairs[*at].body, body) < 0)
        ++*at;
    return *at < count && mote_pair_order(pairs[*at].body, body) == 0 ? &pairs[*at] : NULL;
}

static void end_touch(mote_bodies_book *book, const mote_bodies_touch *touch)
{
    ++book->approaches;
    book->depth_max = fmax(book->depth_max, touch->depth);
    if (touch->reported)
        return;
    ++book->passes;
    book->deep_passes += touch->depth > 0;
    book->depth_passes = fmax(book->depth_passes, touch->depth);
}

static mote_status make_room(mote_bodies_book *book, size_t count)
{
    if (count <= book->room)
        return MOTE_OK;
    const size_t room = 2 * count + 16;
    mote_bodies_touch *touches = realloc(book->touches, room * sizeof *touches);
    book->touches = touches ? touches : book->touches;
    mote_bodies_touch *spare = realloc(book->spare, room * sizeof *spare);
    book->spare = spare ? spare : book->spare;
    if (!touches || !spare)
        return mote_fail(MOTE_ENOMEM, "no memory for %zu contacts", count);
    book->room = room;
    return MOTE_OK;
}

/* Books a contact of the truth into its run. */
static mote_status book_contact(mote_bodies_book *book, uint32_t k,
                                const mote_bodies_pair *truth, bool said,
                                mote_bodies_touch *touch, mote_bodies_depth depth,
                                void *context)
{
    ++book->contact_steps;
    book->missed_steps += !said;
    if (said && !touch->reported) {
        const uint64_t delay = k - touch->began;
        touch->reported = true;
        book->delay_sum += delay;
        book->delay_max = delay > book->delay_max ? delay : book->delay_max;
    }
    if (truth->answer.distance > 0) /* apart, no vertex is inside */
        return MOTE_OK;
    return depth(context, truth->body, touch->depth, &touch->depth);
}

/* Contacts that the method alone says. */
static void book_false(mote_bodies_book *book, const mote_bodies_pair *truth,
                       size_t truth_count, const mote_bodies_pair *said, size_t said_count)
{
    size_t at = 0;
    for (size_t k = 0; k < said_count; ++k) {
        const mote_bodies_pair *real = seek(truth, truth_count, &at, said[k].body);
        book->false_steps += said[k].answer.contact && !(real && real->answer.contact);
    }
}

mote_status mote_bodies_book_step(mote_bodies_book *book, uint32_t k,
                                  const mote_bodies_pair *truth, size_t truth_count,
                                  const mote_bodies_pair *said, size_t said_count,
                                  mote_bodies_depth depth, void *context)
{
    size_t old = 0, at = 0, count = 0;
    mote_status status = make_room(book, truth_count);
    for (size_t i = 0; i < truth_count && status == MOTE_OK; ++i) {
        const mote_bodies_pair *pair = &truth[i];
        if (!pair->answer.contact)
            continue;
        for (; old < book->count && mote_pair_order(book->touches[old].body, pair->body) < 0;
             ++old)
            end_touch(book, &book->touches[old]);
        mote_bodies_touch *touch = &book->spare[count++];
        *touch = (mote_bodies_touch){.body = {pair->body[0], pair->body[1]}, .began = k};
        if (old < book->count && mote_pair_order(book->touches[old].body, pair->body) == 0)
            *touch = book->touches[old++];
        const mote_bodies_pair *other = seek(said, said_count, &at, pair->body);
        status =
            book_contact(book, k, pair, other && other->answer.contact, touch, depth, context);
    }
    for (; old < book->count && status == MOTE_OK; ++old)
        end_touch(book, &book->touches[old]);
    mote_bodies_touch *swapped = book->touches;
    book->touches = book->spare;
    book->spare = swapped;
    book->count = count;
    book_false(book, truth, truth_count, said, said_count);
    return status;
}

void mote_bodies_book_end(mote_bodies_book *book)
{
    for (size_t k = 0; k < book->count; ++k)
        end_touch(book, &book->touches[k]);
    book->count = 0;
}

void mote_bodies_book_free(mote_bodies_book *book)
{
    free(book->touches);
    free(book->spare);
    *book = (mote_bodies_book){.count = 0};
}
