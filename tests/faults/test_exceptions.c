/* Bullet's adapter where something that it calls throws: a status with a text, and an exception
   that passes no function of the method. The linker replaces the functions called by those
   below
   (--wrap). */
#include "tests/support/methods.h"
#include "tests/support/shapes.h"
#include "tests/support/test.h"
#include "tests/faults/thrown.h"

/* Called where Bullet's method is created, updated and asked. */
#define REGISTER "_ZN27btGImpactCollisionAlgorithm17registerAlgorithmEP21btCollisionDispatcher"
#define FIND                                                                                   \
    "_ZN21btCollisionDispatcher13findAlgorithmEPK24btCollisionObjectWrapperS2_"                \
    "P20btPersistentManifold22ebtDispatcherQueryType"
void real_register(void *dispatcher) __asm__("__real_" REGISTER);
void wrap_register(void *dispatcher) __asm__("__wrap_" REGISTER);
mote_status __real_mote_input_check_pose(const mote_pose *pose, int body);
mote_status __wrap_mote_input_check_pose(const mote_pose *pose, int body);
void *real_find(void *dispatcher, const void *a, const void *b, void *manifold,
                int kind) __asm__("__real_" FIND);
void *wrap_find(void *dispatcher, const void *a, const void *b, void *manifold,
                int kind) __asm__("__wrap_" FIND);

static enum { NOWHERE, IN_CREATE, IN_UPDATE, IN_QUERY } throws;
static enum { BAD_ALLOC, LENGTH_ERROR, INT } thrown;

static void throw_in(int where)
{
    if (where != (int)throws)
        return;
    throws = NOWHERE;
    if (thrown == BAD_ALLOC)
        _ZSt17__throw_bad_allocv();
    if (thrown == LENGTH_ERROR)
        _ZSt20__throw_length_errorPKc("too long");
    __cxa_throw(__cxa_allocate_exception(sizeof(int)), _ZTIi, NULL);
}

void wrap_register(void *dispatcher)
{
    throw_in(IN_CREATE);
    real_register(dispatcher);
}

mote_status __wrap_mote_input_check_pose(const mote_pose *pose, int body)
{
    throw_in(IN_UPDATE);
    return __real_mote_input_check_pose(pose, body);
}

void *wrap_find(void *dispatcher, const void *a, const void *b, void *manifold, int kind)
{
    throw_in(IN_QUERY);
    return real_find(dispatcher, a, b, manifold, kind);
}

static mote_status run(const mote_method *m, const scene *s, const double *values)
{
    const mote_setup setup = scene_setup(s, MOTE_ASK_CONTACT, 0, values);
    void *state = NULL;
    mote_answer a = {0};
    mote_status status = m->create(&setup, &state);
    if (status == MOTE_OK)
        status = m->update(state, &s->frame);
    else
        assert_null(state);
    if (status == MOTE_OK)
        status = m->query(state, &s->frame, &a);
    m->destroy(state);
    return status;
}

TEST(bullet_turns_what_is_thrown_into_a_status)
{
    static const struct {
        mote_status status;
        const char *text;
    } expected[] = {[BAD_ALLOC] = {MOTE_ENOMEM, "Bullet ran out of memory"},
                    [LENGTH_ERROR] = {MOTE_ENUMERIC, "Bullet: too long"},
                    [INT] = {MOTE_ENUMERIC, "Bullet threw an unknown exception"}};
    double values[MOTE_PARAMETERS_MAX];
    const mote_method *m = method_with("bullet-gimpact", "", values);
    scene s;
    scene_init(&s, 6, 4, 1, true);
    (void)scene_next(&s, 0, false);
    for (int where = IN_CREATE; where <= IN_QUERY; ++where) {
        for (int what = BAD_ALLOC; what <= INT; ++what) {
            test_row("place %d, exception %d", where, what);
            throws = where;
            thrown = what;
            assert_int_equal(run(m, &s, values), expected[what].status);
            assert_string_equal(mote_error_text(), expected[what].text);
            assert_int_equal(throws, NOWHERE);
            assert_int_equal(run(m, &s, values), MOTE_OK);
        }
    }
    scene_free(&s);
}
