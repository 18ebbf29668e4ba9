/* A user's program: two octahedra, each half of them moved by a bone, and a morph target. The
   bone and the target both raise the upper corner of the lower octahedron. Its distance to the
   lower corner of the other, which does not move, is known. */
#include <mote/mote.h>

#include <math.h>
#include <stdio.h>

static const uint32_t faces[] = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, /* of an octahedron */
                                 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
static const double corners[] = {1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1};

int main(void)
{
    static const uint32_t start[] = {0, 1, 2, 3, 4, 5, 6}; /* one weight a vertex */
    static const uint16_t bone[] = {0, 0, 0, 0, 1, 0};
    static const double weight[] = {1, 1, 1, 1, 1, 1};
    static const uint32_t target_start[] = {0, 1}, target_vertex[] = {4};
    static const mote_vec3 target_move[] = {{0, 0, 0.25}};
    const mote_morph_targets targets = {1, target_start, target_vertex, target_move};
    const double amounts[2][1] = {{1}, {0}};
    double matrices[2][3][4] = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}},
                                {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
    double x[2][16], y[2][16], z[2][16];
    mote_mesh *mesh;
    mote_field *field;
    mote_certificate *certificate;
    if (mote_mesh_create(corners, 6, faces, 8, &mesh) ||
        mote_field_create_morphs(mesh, 2, start, bone, weight, &targets, &field))
        return puts(mote_error_text()), 1;
    const mote_body body = {.mesh = mesh, .field = field};
    const mote_body *const pair[] = {&body, &body};
    const mote_certificate_options options = mote_default_certificate_options(mesh->diagonal);
    if (field->padded > 16 || mote_certificate_create(pair, &options, &certificate))
        return puts(mote_error_text()), 1;
    mote_frame frame = {0};
    for (int b = 0; b < 2; ++b) {
        frame.body[b].pose.rotation = (mote_mat3){{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
        frame.body[b].pose.translation.z = 4 * b;
        frame.body[b].weights = (mote_weights){x[b], y[b], z[b], field->count, field->padded};
        frame.body[b].shape_changed = frame.body[b].pose_changed = true;
    }
    for (int step = 0; step <= 4; ++step) {
        matrices[1][2][3] = 0.25 * step; /* of bone 1, which moves the upper corner */
        for (int b = 0; b < 2; ++b)
            mote_morph_weights(field, b ? NULL : (const double(*)[3][4])matrices, amounts[b],
                               &frame.body[b].pose.rotation, x[b], y[b], z[b]);
        ++frame.number;
        mote_certificate_answer answer;
        mote_certificate_query(certificate, &frame, NULL, -1, &answer);
        const double expected = 4 - 2 - 0.25 - 0.25 * step;
        if (!(fabs(answer.distance - expected) <= 1e-12) || !(answer.lower <= expected))
            return printf("step %d: distance %.17g, expected %g\n", step, answer.distance,
                          expected),
                   1;
    }
    mote_certificate_destroy(certificate);
    mote_field_destroy(field);
    mote_mesh_destroy(mesh);
    return puts("skin: 5 distances as expected") < 0;
}
