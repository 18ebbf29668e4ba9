/* Bodies of so many convex parts that pairs of them are counted in 64 bits. The linker replaces
   calloc, and the decomposition into parts, which would take hours, by those below (--wrap). */
#include "baselines/convex_part.h"
#include "tests/support/methods.h"
#include "tests/support/shapes.h"
#include "tests/support/test.h"

/* The number of pairs is 2^32 + 2^17 + 1. */
enum { PARTS = 65537 };

static size_t pairs_wanted;

void *__real_calloc(size_t count, size_t size);
void *__wrap_calloc(size_t count, size_t size);
mote_status __wrap_mote_convex_parts_create(const mote_mesh *mesh, mote_convex_parts **parts);

/* The list of pairs is the only one that is longer than the list of parts. */
void *__wrap_calloc(size_t count, size_t size)
{
    if (count <= PARTS)
        return __real_calloc(count, size);
    pairs_wanted = count;
    return NULL;
}

mote_status __wrap_mote_convex_parts_create(const mote_mesh *mesh, mote_convex_parts **parts)
{
    (void)mesh;
    mote_convex_parts *made = malloc(sizeof *made);
    need(made != NULL);
    *made = (mote_convex_parts){.count = PARTS, .part = calloc(PARTS, sizeof *made->part)};
    need(made->part != NULL);
    *parts = made;
    return MOTE_OK;
}

TEST(ccd_convex_counts_more_pairs_of_parts_than_32_bits_hold)
{
    double values[MOTE_PARAMETERS_MAX];
    const mote_method *m = method_with("ccd-convex", "", values);
    void *state = NULL;
    scene s;
    scene_init(&s, 6, 4, 1, false);
    const mote_setup setup = scene_setup(&s, MOTE_ASK_DISTANCE, 0, values);
    assert_int_equal(m->create(&setup, &state), MOTE_ENOMEM);
    assert_null(state);
    assert_true(pairs_wanted == (size_t)PARTS * PARTS);
    assert_string_equal(mote_error_text(), "no memory for 4295098369 pairs of parts");
    scene_free(&s);
}
