/* What a program in C does frame after frame, for tests/python/speed.py: a library that it
   loads beside libmote. */
#include <mote/mote.h>

#include <string.h>

/* Answers for frames 0 .. count - 1 of two bodies with CSRBF fields, as a program would that
   keeps its states in mote_frame; poses[count][2][3][4], weights[count][J][3] of each in the
   bodies' axes. */
int pair_loop(mote_certificate *certificate, const mote_field *const fields[2], size_t count,
              const double *poses, const double *const weights[2], double *distance);

int pair_loop(mote_certificate *certificate, const mote_field *const fields[2], size_t count,
              const double *poses, const double *const weights[2], double *distance)
{
    double room[2][3][256];
    memset(room, 0, sizeof room);
    for (size_t f = 0; f < count; ++f) {
        mote_frame frame = {.number = f + 1};
        for (int b = 0; b < 2; ++b) {
            const double *pose = poses + (2 * f + (size_t)b) * 12;
            mote_body_state *state = &frame.body[b];
            for (int r = 0; r < 3; ++r)
                memcpy(state->pose.rotation.m[r], pose + 4 * r, 3 * sizeof *pose);
            state->pose.translation = mote_vec3_make(pose[3], pose[7], pose[11]);
            const uint32_t n = fields[b]->count;
            if (n > 256)
                return 1;
            const double *w = weights[b] + (size_t)3 * n * f;
            for (uint32_t j = 0; j < n; ++j) {
                const mote_vec3 turned =
                    mote_rotate(&state->pose.rotation,
                                mote_vec3_make(w[3 * j], w[3 * j + 1], w[3 * j + 2]));
                room[b][0][j] = turned.x;
                room[b][1][j] = turned.y;
                room[b][2][j] = turned.z;
            }
            state->weights =
                (mote_weights){room[b][0], room[b][1], room[b][2], n, fields[b]->padded};
            state->shape_changed = state->pose_changed = true;
        }
        mote_certificate_answer answer;
        mote_certificate_query(certificate, &frame, NULL, -1, &answer);
        distance[f] = answer.distance;
    }
    return 0;
}

/* A certificate of two bodies for pair_loop; NULL: no memory. bodies is where it keeps them. */
mote_certificate *pair_loop_create(const mote_mesh *const meshes[2],
                                   const mote_field *const fields[2], mote_body bodies[2]);

mote_certificate *pair_loop_create(const mote_mesh *const meshes[2],
                                   const mote_field *const fields[2], mote_body bodies[2])
{
    mote_certificate *made = NULL;
    for (int b = 0; b < 2; ++b)
        bodies[b] = (mote_body){.mesh = meshes[b], .field = fields[b]};
    const mote_certificate_options options = mote_default_certificate_options(
        meshes[0]->diagonal > meshes[1]->diagonal ? meshes[0]->diagonal : meshes[1]->diagonal);
    const mote_body *const pair[] = {&bodies[0], &bodies[1]};
    return mote_certificate_create(pair, &options, &made) == MOTE_OK ? made : NULL;
}
