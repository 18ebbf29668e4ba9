#include "core/certificate/pair_list.h"

#include "core/base/pool.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

mote_status mote_scene_refuse_bad(uint32_t shape_count, const uint32_t *shape_of,
                                  uint32_t body_count, const mote_scene_options *options)
{
    if (shape_count < 1 || body_count < 1)
        return mote_fail(
            MOTE_EINVAL,
            "a scene needs at least one body and one shape; there are %u bodies and %u shapes",
            body_count, shape_count);
    if (options->threads < 1 || options->threads > MOTE_POOL_MAX)
        return mote_fail(MOTE_EINVAL, "%u threads is out of range; give 1 to %u",
                         options->threads, MOTE_POOL_MAX);
    if (!(options->tolerance >= 0) || !isfinite(options->tolerance))
        return mote_fail(MOTE_EINVAL,
                         "tolerance %g is not valid; it must be a finite number of at least 0",
                         options->tolerance);
    for (uint32_t i = 0; i < body_count; ++i) {
        if (shape_of[i] >= shape_count)
            return mote_fail(MOTE_EINVAL,
                             "body %u has shape %u, which does not exist; there are %u shapes",
                             i, shape_of[i], shape_count);
    }
    return MOTE_OK;
}

void mote_pair_list_free(mote_pair_list *list)
{
    free(list->pairs);
    free(list->memories);
    list->pairs = NULL;
    list->memories = NULL;
}

size_t mote_pair_list_bytes(const mote_pair_list *list)
{
    return list->room * (sizeof *list->pairs + list->memory_size);
}

mote_status mote_pair_list_check(const uint32_t (*pairs)[2], size_t count, uint32_t bodies)
{
    for (size_t k = 0; k < count; ++k) {
        if (pairs[k][0] >= pairs[k][1] || pairs[k][1] >= bodies)
            return mote_fail(MOTE_EINVAL,
                             "pair %u, %u is not valid; give i < j, both below %u bodies",
                             pairs[k][0], pairs[k][1], bodies);
        if (k > 0 && mote_pair_order(pairs[k - 1], pairs[k]) >= 0)
            return mote_fail(MOTE_EINVAL,
                             "pair %u, %u follows %u, %u; give pairs in ascending order",
                             pairs[k][0], pairs[k][1], pairs[k - 1][0], pairs[k - 1][1]);
    }
    return MOTE_OK;
}

/* Makes room for count pairs; the contents of the list are lost. */
static mote_status make_room(mote_pair_list *list, size_t count)
{
    if (count <= list->room)
        return MOTE_OK;
    const size_t room = count + count / 4 + 16;
    mote_scene_pair *pairs = malloc(room * sizeof *pairs);
    char *memories = malloc(room * list->memory_size);
    if (!pairs || !memories) {
        free(pairs);
        free(memories);
        return mote_fail(MOTE_ENOMEM, "no memory for %zu near pairs", count);
    }
    mote_pair_list_free(list);
    list->pairs = pairs;
    list->memories = memories;
    list->room = room;
    return MOTE_OK;
}

/* Fills a list with the pairs, each with its state from the last step, if it has one. */
static void carry_over(const mote_pair_list *last, const uint32_t (*pairs)[2], size_t count,
                       mote_pair_list *list)
{
    const size_t size = list->memory_size;
    size_t old = 0;
    list->count = count;
    for (size_t k = 0; k < count; ++k) {
        while (old < last->count && mote_pair_order(last->pairs[old].body, pairs[k]) < 0)
            ++old;
        const bool known =
            old < last->count && mote_pair_order(last->pairs[old].body, pairs[k]) == 0;
        list->pairs[k] = (mote_scene_pair){.body = {pairs[k][0], pairs[k][1]}, .steps = 1};
        if (known) {
            list->pairs[k].steps += last->pairs[old].steps;
            memcpy(list->memories + k * size, last->memories + old * size, size);
        } else {
            memset(list->memories + k * size, 0, size);
        }
    }
}

mote_status mote_pair_list_renew(mote_pair_list *now, mote_pair_list *before,
                                 const uint32_t (*pairs)[2], size_t count, uint32_t bodies)
{
    mote_status status = mote_pair_list_check(pairs, count, bodies);
    if (status == MOTE_OK)
        status = make_room(before, count);
    if (status != MOTE_OK)
        return status;
    carry_over(now, pairs, count, before);
    const mote_pair_list swapped = *now;
    *now = *before;
    *before = swapped;
    return MOTE_OK;
}
