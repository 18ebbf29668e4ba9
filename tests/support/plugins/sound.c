/* Two methods and a field as a user would compile them, in C and in C++; for test_plugin. */
#include <mote/field_maker.h>
#include <mote/method.h>

#include <stdlib.h>
#include <unistd.h>

enum { DOES, SHARE, PARAMETER_COUNT };

static const mote_parameter parameters[PARAMETER_COUNT] = {
    {"does", MOTE_PARAMETER_CHOICE, 0, 0, "answer|crash|hang|leave", "answer",
     "what it does in frame 3"},
    {"share", MOTE_PARAMETER_REAL, 0, 1e300, NULL, "1", "of the distance that it tells"},
};

static mote_traits traits(const double *values)
{
    mote_traits own = {0};
    own.needs_vertices = values[SHARE] > 1;
    return own;
}

/* Returns the distance of the translations: bodies count as points. */
static mote_status query(void *state, const mote_frame *frame, mote_answer *answer)
{
    const mote_setup *setup = (const mote_setup *)state;
    if (frame->number == 3 && setup->values[DOES] == 1)
        abort(); /* a signal that no sanitizer takes for itself */
    while (frame->number == 3 && setup->values[DOES] == 2)
        (void)pause();
    if (frame->number == 3 && setup->values[DOES] == 3)
        _exit(0);
    answer->has_distance = true;
    answer->distance =
        setup->values[SHARE] *
        mote_length(mote_sub(frame->body[0].pose.translation, frame->body[1].pose.translation));
    return MOTE_OK;
}

/* Calls functions of the library, of which it uses the program's own copy. */
static mote_status refuse(const mote_setup *setup, void **state)
{
    (void)setup;
    (void)state;
    return mote_fail(MOTE_EUNSUPPORTED, "today is not a good day, says %s",
                     mote_method_find("plugin-points")->name);
}

static void destroy(void *state)
{
    free(state);
}

MOTE_METHOD(points) = {"plugin-points",
                       "the bodies are points",
                       parameters,
                       PARAMETER_COUNT,
                       traits,
                       NULL,
                       NULL,
                       NULL,
                       query,
                       NULL};

MOTE_METHOD(moody) = {"plugin-moody", "never answers", NULL, 0,     NULL,
                      refuse,         destroy,         NULL, query, NULL};

static void one(const mote_field *field, const mote_mesh *mesh, uint32_t vertex, double *phi)
{
    (void)mesh;
    (void)vertex;
    for (uint32_t j = 0; j < field->padded; ++j)
        phi[j] = j == 0 ? 1 : 0;
}

static void free_field(mote_field *field)
{
    free(field);
}

static mote_field_kind made_kind(void)
{
    mote_field_kind kind = {0};
    kind.name = "plugin-shift";
    kind.basis = one;
    kind.destroy = free_field;
    return kind;
}

static mote_status create_field(const mote_mesh *mesh, const double *values, mote_field **field)
{
    static mote_field_kind kind;
    (void)mesh;
    (void)values;
    kind = made_kind();
    return mote_field_allocate(&kind, 1, field);
}

MOTE_FIELD(shift) = {"plugin-shift", "moves every vertex by its weight", NULL, 0, create_field};
