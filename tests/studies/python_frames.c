/* Writes the first frames of a scenario of two bodies as plain arrays, so that the module for
   Python can be asked the same as `mote run` (tests/python). python_frames SCENARIO FRAMES
   FOLDER */
#include "core/skin/skin.h"
#include "harness/base/memory.h"
#include "harness/scene/motion.h"
#include "harness/scene/player.h"
#include "harness/scene/scenario.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *folder;

static FILE *open_array(int body, const char *name)
{
    char path[4096];
    (void)snprintf(path, sizeof path, "%s/%c.%s", folder, 'a' + body, name);
    FILE *file = fopen(path, "ab");
    if (!file) {
        perror(path);
        exit(1);
    }
    return file;
}

static void append(int body, const char *name, const void *data, size_t bytes)
{
    FILE *file = open_array(body, name);
    if (fwrite(data, 1, bytes, file) != bytes || fclose(file) != 0) {
        perror(name);
        exit(1);
    }
}

static void write_skin(int body, const mote_player *player, uint32_t vertices)
{
    const mote_character *c = player->character;
    const uint32_t weights = c->rig.bones_count ? c->start[vertices] : 0;
    const uint64_t counts[2] = {c->rig.bones_count, c->rig.targets_count};
    append(body, "counts.u64", counts, sizeof counts);
    if (weights > 0) {
        append(body, "start.u32", c->start, (vertices + 1) * sizeof *c->start);
        append(body, "bone.u16", c->bone, weights * sizeof *c->bone);
        append(body, "weight.f64", c->weight, weights * sizeof *c->weight);
    }
    if (c->target_count > 0) {
        append(body, "shift_start.u32", c->shift_start,
               (vertices + 1) * sizeof *c->shift_start);
        append(body, "target.u32", c->target, c->target_count * sizeof *c->target);
        append(body, "shift.f64", c->shift, c->target_count * sizeof *c->shift);
    }
}

static void write_body(int b, const mote_scenario *scenario)
{
    const mote_mesh *mesh = scenario->body[b].mesh;
    const mote_field *field = scenario->body[b].field;
    append(b, "vertices.f64", mesh->positions, mesh->vertex_count * sizeof *mesh->positions);
    append(b, "faces.u32", mesh->triangles, mesh->triangle_count * sizeof *mesh->triangles);
    if (scenario->motion->body[b].player)
        write_skin(b, scenario->motion->body[b].player, mesh->vertex_count);
    if (!(field->support > 0))
        return;
    for (uint32_t j = 0; j < field->count; ++j) {
        const double centre[3] = {field->centre_x[j], field->centre_y[j], field->centre_z[j]};
        append(b, "centres.f64", centre, sizeof centre);
    }
    append(b, "support.f64", &field->support, sizeof field->support);
}

/* The weights before they are turned with the body, as the scenario has them. */
static void write_controls(int b, const mote_scenario *scenario, double place)
{
    const mote_body_motion *motion = &scenario->motion->body[b];
    mote_vec3 *moves = mote_allocate(scenario->body[b].field->count + 1, sizeof *moves);
    mote_vec3 *solution = mote_allocate(scenario->body[b].field->count + 1, sizeof *solution);
    if (motion->player) {
        const mote_player *p = motion->player;
        const mote_character *c = p->character;
        mote_character_pose pose = mote_character_pose_create(c);
        const double passed = p->start + (place - 1) * p->speed / MOTE_PLAYER_RATE;
        mote_character_pose_set(
            c, p->clip, mote_rig_clip_time(&c->rig.clips[p->clip], passed, p->loop), &pose);
        append(b, "matrices.f64", pose.matrices, c->rig.bones_count * sizeof *pose.matrices);
        append(b, "amounts.f64", pose.morphs, c->rig.targets_count * sizeof *pose.morphs);
        mote_character_pose_free(&pose);
    } else if (motion->control_count > 0) {
        mote_motion_displacements(motion, place, moves);
        if (motion->fit && mote_csrbf_fit_solve(motion->fit, moves, solution) != MOTE_OK)
            exit(1);
        append(b, "weights.f64", motion->fit ? solution : moves,
               scenario->body[b].field->count * sizeof *moves);
    }
    free(moves);
    free(solution);
}

static void write_frame(const mote_scenario *scenario, mote_frame_buffer *buffer,
                        uint32_t number)
{
    const mote_frame *frame = mote_scenario_frame(scenario, buffer, number, number - 1);
    const double place = scenario->motion->start + (number - 1) * scenario->motion->pace;
    for (int b = 0; b < 2; ++b) {
        const mote_body_state *state = &frame->body[b];
        const mote_vec3 t = state->pose.translation;
        const double translation[3] = {t.x, t.y, t.z};
        for (int r = 0; r < 3; ++r) {
            append(b, "poses.f64", state->pose.rotation.m[r], 3 * sizeof(double));
            append(b, "poses.f64", &translation[r], sizeof(double));
        }
        write_controls(b, scenario, place);
        const uint32_t count = scenario->body[b].mesh->vertex_count;
        mote_vec3 *world = mote_allocate(count, sizeof *world);
        for (uint32_t v = 0; v < count; ++v)
            world[v] = mote_body_position(&scenario->body[b], state, v);
        append(b, "positions.f64", world, count * sizeof *world);
        free(world);
    }
}

int main(int count, char **words)
{
    mote_scenario *scenario;
    if (count != 4)
        return fputs("usage: python_frames SCENARIO FRAMES FOLDER\n", stderr), 2;
    if (mote_scenario_load(words[1], &scenario) != MOTE_OK)
        return (void)fprintf(stderr, "%s\n", mote_error_text()), 4;
    folder = words[3];
    mote_frame_buffer *buffer = mote_frame_buffer_create(scenario);
    for (int b = 0; b < 2; ++b)
        write_body(b, scenario);
    const uint32_t frames = (uint32_t)strtoul(words[2], NULL, 10);
    for (uint32_t number = 1; number <= frames; ++number)
        write_frame(scenario, buffer, number);
    mote_frame_buffer_destroy(buffer);
    mote_scenario_destroy(scenario);
    return 0;
}
