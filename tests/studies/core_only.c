/* The core without other libraries (tests/scripts/core_only.sh). Prints its answers with all
   digits, to compare compilers and C libraries, and checks those that are known. */
#include <mote/mote.h>

#include <stdio.h>

static int failures;

static void expect(const char *what, double value, double expected, double within)
{
    if (fabs(value - expected) <= within)
        return;
    (void)printf("%s is %.17g, not %.17g\n", what, value, expected);
    ++failures;
}

/* A box of the given edges, turned by 30 degrees about z: 12 triangles. */
static mote_mesh *make_box(double a, double b, double c)
{
    static const uint32_t faces[12][3] = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6},
                                          {0, 1, 4}, {1, 5, 4}, {2, 6, 3}, {3, 6, 7},
                                          {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    const double cosine = sqrt(0.75), sine = 0.5;
    double xyz[8][3];
    for (int i = 0; i < 8; ++i) {
        const double x = i & 1 ? a : 0, y = i & 2 ? b : 0;
        xyz[i][0] = cosine * x - sine * y;
        xyz[i][1] = sine * x + cosine * y;
        xyz[i][2] = i & 4 ? c : 0;
    }
    mote_mesh *mesh = NULL;
    if (mote_mesh_create(xyz[0], 8, faces[0], 12, &mesh) != MOTE_OK)
        (void)puts(mote_error_text());
    return mesh;
}

/* Moments of a solid box about its middle. */
static void check_mass(const mote_mesh *box)
{
    mote_mass mass = {0};
    if (mote_mass_of_mesh(box, 2, &mass) != MOTE_OK)
        (void)puts(mote_error_text());
    expect("mass", mass.mass, 2 * 1 * 2 * 3, 1e-13);
    expect("least moment", mass.inertia.x, mass.mass * (1 + 4) / 12, 1e-12);
    expect("middle moment", mass.inertia.y, mass.mass * (1 + 9) / 12, 1e-12);
    expect("largest moment", mass.inertia.z, mass.mass * (4 + 9) / 12, 1e-12);
    const mote_vec3 x = {mass.axes.m[0][0], mass.axes.m[1][0], mass.axes.m[2][0]};
    const mote_vec3 y = {mass.axes.m[0][1], mass.axes.m[1][1], mass.axes.m[2][1]};
    const mote_vec3 z = {mass.axes.m[0][2], mass.axes.m[1][2], mass.axes.m[2][2]};
    expect("handedness of the main axes", mote_dot(mote_cross(x, y), z), 1, 1e-14);
    expect("axis of the least moment along z", fabs(x.z), 1, 1e-14);
}

/* Runs a method on two boxes that deform and prints its distances. */
static void run_method(const char *name, const char *keys, const mote_body *body)
{
    const mote_method *method = mote_method_find(name);
    double values[MOTE_PARAMETERS_MAX];
    mote_parameters_default(method->parameters, method->parameter_count, values);
    (void)mote_parameters_parse(method->parameters, method->parameter_count, keys, values);
    const mote_setup setup = {.body = {&body[0], &body[1]},
                              .length = body[0].mesh->diagonal,
                              .ask = MOTE_ASK_DISTANCE,
                              .seed = 1,
                              .values = values};
    void *state = NULL;
    if (method->create(&setup, &state) != MOTE_OK) {
        (void)printf("%s:%s: %s\n", name, keys, mote_error_text());
        return;
    }
    double weight[2][3][MOTE_LANES] = {{{0}}};
    mote_frame frame = {0};
    for (int b = 0; b < 2; ++b) {
        const mote_pose pose = {{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, {4.0 * b, 0, 0}};
        const mote_body_state body_state = {
            .pose = pose,
            .weights = {weight[b][0], weight[b][1], weight[b][2], 2, MOTE_LANES},
            .shape_changed = true,
            .pose_changed = true};
        frame.body[b] = body_state;
    }
    for (frame.number = 1; frame.number <= 5; ++frame.number) {
        mote_answer answer = {0};
        weight[0][0][0] = 0.125 * (double)frame.number;
        weight[1][2][1] = -0.25 * (double)frame.number;
        if ((method->update && method->update(state, &frame) != MOTE_OK) ||
            method->query(state, &frame, &answer) != MOTE_OK)
            (void)puts(mote_error_text());
        (void)printf("%s:%s %d %.17g\n", name, keys, (int)frame.number, answer.distance);
    }
    method->destroy(state);
}

int main(void)
{
    const mote_vec3 centres[2] = {{1, 0.5, 1}, {0, 1.5, 2}};
    mote_body body[2];
    for (int b = 0; b < 2; ++b) {
        mote_field *field = NULL;
        if (mote_field_create_csrbf(centres, 2, 3, &field) != MOTE_OK)
            (void)puts(mote_error_text());
        body[b] = (mote_body){.mesh = make_box(1, 2, 3), .field = field};
    }
    check_mass(body[0].mesh);
    run_method("certified", "", body);
    run_method("particle", "n=4", body);
    run_method("particle-paper", "n=4", body);
    run_method("particle-paper", "", body); /* no convex parts: a clear refusal */
    return failures ? 1 : 0;
}
