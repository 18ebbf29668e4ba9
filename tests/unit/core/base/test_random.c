/* Random numbers: within their range, uniform, the same on every machine. */
#include "core/base/random.h"
#include "tests/support/test.h"

#include <math.h>
#include <stddef.h>

/* The first numbers from seed 1234567 that splitmix64's authors print. */
TEST(next_of_a_known_seed_as_published)
{
    static const uint64_t published[5] = {6457827717110365317u, 3203168211198807973u,
                                          9817491932198370423u, 4593380528125082431u,
                                          16408922859458223821u};
    mote_random random = {1234567};
    for (int k = 0; k < 5; ++k)
        assert_true(mote_random_next(&random) == published[k]);
}

/* With a bound just above half of the range, about every second number is drawn again. */
TEST(below_a_bound_that_divides_badly_is_even)
{
    const uint64_t bound = (UINT64_C(1) << 63) + 1;
    mote_random random = {5};
    int low = 0, drawn = 0;
    for (int k = 0; k < 4000; ++k) {
        mote_random before = random;
        const uint64_t value = mote_random_below(&random, bound);
        assert_true(value < bound);
        low += value < bound / 2;
        while (before.state != random.state) {
            (void)mote_random_next(&before);
            ++drawn;
        }
    }
    /* Five standard deviations of 4000 fair draws; 8000 numbers for them. */
    assert_in_range(low, 2000 - 158, 2000 + 158);
    assert_in_range(drawn, 8000 - 450, 8000 + 450);
}

TEST(below_a_small_bound_takes_every_value)
{
    mote_random random = {9};
    int count[6] = {0};
    for (int k = 0; k < 6000; ++k)
        ++count[mote_random_below(&random, 6)];
    for (int k = 0; k < 6; ++k)
        assert_in_range(count[k], 1000 - 145, 1000 + 145);
    for (int k = 0; k < 10; ++k)
        assert_int_equal(mote_random_below(&random, 1), 0);
}

TEST(direction_is_a_unit_vector_of_no_preference)
{
    mote_random random = {2};
    mote_vec3 sum = {0, 0, 0};
    for (int k = 0; k < 4000; ++k) {
        const mote_vec3 v = mote_random_direction(&random);
        assert_true(fabs(mote_length(v) - 1) < 1e-15);
        sum = mote_add(sum, v);
    }
    /* Each coordinate has variance 1/3. */
    assert_true(fabs(sum.x) < 183 && fabs(sum.y) < 183 && fabs(sum.z) < 183);
}
