/* The near pairs of a step, and what each keeps from the step before: against a table of all
   pairs. */
#include "core/certificate/pair_list.h"

#include "tests/support/solids.h"
#include "tests/support/test.h"

enum { BODIES = 9, STEPS = 200 };

/* Whether each pair was near in the last step, for how many steps, and what it keeps. */
typedef struct table {
    bool near[BODIES][BODIES];
    uint32_t steps[BODIES][BODIES];
    uint64_t kept[BODIES][BODIES];
} table;

/* Draws the pairs of a step; a pair stays near three times in four. */
static size_t next_pairs(uint64_t *seed, table *t, double share, uint32_t (*pairs)[2])
{
    size_t count = 0;
    for (uint32_t i = 0; i < BODIES; ++i) {
        for (uint32_t j = i + 1; j < BODIES; ++j) {
            t->near[i][j] = random_between(seed, 0, 1) < (t->near[i][j] ? 0.75 : share);
            t->steps[i][j] = t->near[i][j] ? t->steps[i][j] + 1 : 0;
            t->kept[i][j] = t->near[i][j] ? t->kept[i][j] : 0;
            if (t->near[i][j]) {
                pairs[count][0] = i;
                pairs[count++][1] = j;
            }
        }
    }
    return count;
}

static void check_list(const mote_pair_list *list, table *t, const uint32_t (*pairs)[2],
                       size_t count)
{
    assert_int_equal(list->count, count);
    assert_true(list->room >= count);
    for (size_t k = 0; k < count; ++k) {
        const uint32_t i = pairs[k][0], j = pairs[k][1];
        uint64_t kept;
        memcpy(&kept, list->memories + k * sizeof kept, sizeof kept);
        assert_int_equal(list->pairs[k].body[0], i);
        assert_int_equal(list->pairs[k].body[1], j);
        assert_int_equal(list->pairs[k].steps, t->steps[i][j]);
        assert_int_equal(kept, t->kept[i][j]);
        t->kept[i][j] = kept + i * 100 + j + 1; /* what the query of this step keeps */
        memcpy(list->memories + k * sizeof kept, &t->kept[i][j], sizeof kept);
    }
}

TEST(mote_pair_list_renew_keeps_the_memory_of_a_pair_while_it_is_near)
{
    static uint32_t pairs[BODIES * BODIES][2];
    static table t;
    mote_pair_list now = {.memory_size = sizeof(uint64_t)}, before = now;
    uint64_t seed = 5;
    size_t none = 0, most = 0;
    for (int step = 0; step < STEPS; ++step) {
        const double share = step % 20 < 10 ? 0 : 0.3; /* down to no pair, and up again */
        const size_t count = next_pairs(&seed, &t, share, pairs);
        const uint32_t(*given)[2] = (const uint32_t(*)[2])pairs;
        assert_int_equal(mote_pair_list_renew(&now, &before, given, count, BODIES), MOTE_OK);
        check_list(&now, &t, given, count);
        assert_int_equal(mote_pair_list_bytes(&now),
                         now.room * (sizeof *now.pairs + sizeof(uint64_t)));
        none += count == 0;
        most = count > most ? count : most;
    }
    assert_true(none > 0 && most > 10);
    mote_pair_list_free(&now);
    mote_pair_list_free(&before);
    assert_null(now.pairs);
    assert_null(now.memories);
}

TEST(mote_pair_list_renew_with_bad_pairs_changes_nothing)
{
    static const uint32_t good[][2] = {{0, 1}, {0, 2}, {1, 2}}, bad[][2] = {{0, 1}, {2, 3}};
    mote_pair_list now = {.memory_size = 8}, before = now;
    assert_int_equal(mote_pair_list_renew(&now, &before, good, 3, 3), MOTE_OK);
    const mote_pair_list own[2] = {now, before};
    assert_int_equal(mote_pair_list_renew(&now, &before, bad, 2, 3), MOTE_EINVAL);
    assert_memory_equal(&own[0], &now, sizeof now);
    assert_memory_equal(&own[1], &before, sizeof before);
    mote_pair_list_free(&now);
    mote_pair_list_free(&before);
}

TEST(mote_pair_list_check_names_the_first_bad_pair)
{
    static const struct {
        uint32_t pairs[4][2];
        const char *text; /* NULL: all are good */
    } rows[] = {
        {{{0, 1}, {0, 4}, {1, 2}, {3, 4}}, NULL},
        {{{0, 1}, {3, 3}, {1, 2}, {3, 4}},
         "pair 3, 3 is not valid; give i < j, both below 5 bodies"},
        {{{0, 1}, {0, 5}, {1, 2}, {3, 4}},
         "pair 0, 5 is not valid; give i < j, both below 5 bodies"},
        {{{0, 3}, {1, 2}, {0, 4}, {3, 4}},
         "pair 0, 4 follows 1, 2; give pairs in ascending order"},
        {{{0, 3}, {1, 4}, {1, 4}, {3, 4}},
         "pair 1, 4 follows 1, 4; give pairs in ascending order"},
    };
    for (size_t k = 0; k < ROWS_OF(rows); ++k) {
        test_row("%zu", k);
        assert_int_equal(mote_pair_list_check(rows[k].pairs, 4, 5),
                         rows[k].text ? MOTE_EINVAL : MOTE_OK);
        if (rows[k].text)
            assert_string_equal(mote_error_text(), rows[k].text);
    }
}

TEST(mote_scene_refuse_bad_accepts_the_least_and_the_most)
{
    static const uint32_t shape_of[2] = {0, 1};
    mote_scene_options options = mote_default_scene_options();
    assert_int_equal(mote_scene_refuse_bad(1, shape_of, 1, &options), MOTE_OK);
    options.threads = 256;
    assert_int_equal(mote_scene_refuse_bad(2, shape_of, 2, &options), MOTE_OK);
    options.threads = 257;
    assert_int_equal(mote_scene_refuse_bad(2, shape_of, 2, &options), MOTE_EINVAL);
    assert_string_equal(mote_error_text(), "257 threads is out of range; give 1 to 256");
    options.threads = 1;
    assert_int_equal(mote_scene_refuse_bad(0, shape_of, 2, &options), MOTE_EINVAL);
    assert_string_equal(
        mote_error_text(),
        "a scene needs at least one body and one shape; there are 2 bodies and 0 shapes");
    assert_int_equal(mote_scene_refuse_bad(1, shape_of, 2, &options), MOTE_EINVAL);
    assert_string_equal(mote_error_text(),
                        "body 1 has shape 1, which does not exist; there are 1 shapes");
}
