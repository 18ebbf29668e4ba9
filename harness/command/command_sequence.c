/* mote sequence cloth --triangles 11920 --out DIR */
#include "datasets/letter.h"
#include "datasets/obj_write.h"
#include "datasets/simulated.h"
#include "harness/base/file.h"
#include "harness/base/memory.h"
#include "harness/base/options.h"
#include "harness/command/command.h"
#include "harness/process/stop.h"
#include "harness/scene/spread.h"
#include "harness/sequence/point_cache.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define FRAMES 200
#define FRAMES_MAX 100000

typedef struct request {
    const mote_simulated_body *kind;
    const char *directory;
    uint64_t triangles, frames;
} request;

static mote_status put(FILE *file, const void *data, size_t size, const char *path)
{
    return fwrite(data, 1, size, file) == size
               ? MOTE_OK
               : mote_fail(MOTE_EIO, "%s: cannot be written: %s", path, strerror(errno));
}

/* Simulates and writes frame by frame into an open file. */
static mote_status write_frames(const request *wish, const mote_mesh *mesh, void *state,
                                FILE *file, const char *path)
{
    const uint32_t count = mesh->vertex_count;
    mote_vec3 *positions = mote_copy(mesh->positions, count * sizeof *positions);
    unsigned char *bytes = mote_allocate(12, count), header[MOTE_POINT_CACHE_HEADER];
    mote_point_cache_put_header(count, (uint32_t)wish->frames, header);
    mote_status status = put(file, header, sizeof header, path);
    for (uint64_t k = 0; k < wish->frames && status == MOTE_OK; ++k) {
        if (mote_child_stop_asked()) {
            status = mote_child_stopped(path);
            break;
        }
        if (k > 0)
            wish->kind->step(state, positions);
        mote_point_cache_put(&positions[0].x, count, bytes);
        status = put(file, bytes, (size_t)12 * count, path);
    }
    free(positions);
    free(bytes);
    return status;
}

/* Writes under a temporary name first, so a file with the final name is complete. */
static mote_status write_cache(const request *wish, const mote_mesh *mesh, void *state,
                               const char *path)
{
    char *partial = mote_part_name(path);
    FILE *file = fopen(partial, "wb");
    mote_status status =
        file ? write_frames(wish, mesh, state, file, partial)
             : mote_fail(MOTE_EIO, "%s: cannot be written: %s", partial, strerror(errno));
    if (file && fclose(file) != 0 && status == MOTE_OK)
        status = mote_fail(MOTE_EIO, "%s: cannot be written: %s", partial, strerror(errno));
    if (status == MOTE_OK && rename(partial, path) != 0)
        status = mote_fail(MOTE_EIO, "%s: cannot be named so: %s", path, strerror(errno));
    if (status != MOTE_OK && file)
        (void)remove(partial);
    free(partial);
    return status;
}

/* The letter has about as many triangles, and stays where the simulation has it: a path is that
   of the middle of a mesh's box, which a letter's origin need not be, in L of the pair. */
static mote_status write_scenario(const request *wish, const mote_mesh *mesh, const char *path)
{
    const uint32_t triangles = mesh->triangle_count / 2 * 2;
    mote_mesh *letter;
    mote_status status = mote_letter_create(MOTE_SIMULATED_LETTER, triangles, &letter);
    if (status != MOTE_OK)
        return status;
    const double length = fmax(mesh->diagonal, letter->diagonal);
    const mote_vec3 middle = mote_scale(mote_mesh_centre(letter), 1 / length);
    char *text = mote_format(
        "{\n  \"purpose\": \"%s: %u triangles.\",\n  \"frames\": %" PRIu64
        ",\n  \"ask\": \"distance\",\n  \"bodies\": [\n    {\"file\": \"%s.obj\", "
        "\"positions\": \"%s.pc2\"},\n    {\"letter\": \"%c\", \"triangles\": %u, "
        "\"motion\": [{\"frame\": 1, \"position\": [%.17g, %.17g, %.17g]}]}\n  ]\n}\n",
        wish->kind->summary, mesh->triangle_count, wish->frames, wish->kind->name,
        wish->kind->name, MOTE_SIMULATED_LETTER, triangles, middle.x, middle.y, middle.z);
    status = mote_file_write(path, text, strlen(text));
    free(text);
    mote_mesh_destroy(letter);
    return status;
}

static mote_status make(const request *wish)
{
    mote_mesh *mesh = NULL;
    void *state = NULL;
    char *obj = mote_format("%s/%s.obj", wish->directory, wish->kind->name);
    char *cache = mote_format("%s/%s.pc2", wish->directory, wish->kind->name);
    char *scenario = mote_format("%s/%s.json", wish->directory, wish->kind->name);
    mote_status status = wish->kind->create(wish->triangles, &mesh, &state);
    if (status == MOTE_OK)
        status = mote_directory_make(wish->directory);
    mote_child_heed_signals(); /* no part of a file must outlive this process */
    if (status == MOTE_OK)
        status = mote_obj_write(obj, NULL, mesh);
    if (status == MOTE_OK)
        status = write_cache(wish, mesh, state, cache);
    if (status == MOTE_OK)
        status = write_scenario(wish, mesh, scenario);
    if (status == MOTE_OK)
        (void)printf("%s: %u triangles, %" PRIu64 " frames; its mesh and its positions are "
                     "beside it\n",
                     scenario, mesh->triangle_count, wish->frames);
    wish->kind->destroy(state);
    mote_mesh_destroy(mesh);
    free(obj);
    free(cache);
    free(scenario);
    return status;
}

static int unknown_kind(const char *name)
{
    mote_text known = {0};
    for (size_t i = 0; mote_simulated_list[i]; ++i)
        mote_text_add(&known, "%s%s", i > 0 ? ", " : "", mote_simulated_list[i]->name);
    const int status = mote_command_usage("sequence", "%s: not one of %s", name,
                                          known.data ? known.data : "none");
    free(known.data);
    return status;
}

const mote_option mote_options_sequence[] = {
    {"triangles", "COUNT", "about how many triangles the body has; no default"},
    {"frames", "COUNT", "how many frames are made (default: 200)"},
    {"out", "DIR", "where the scenario, its mesh and its positions are written; no default"},
    {NULL, NULL, NULL}};

int mote_command_sequence(int argc, char **argv)
{
    mote_option_reader reader = mote_option_begin(mote_options_sequence, argc, argv);
    const char *value;
    request wish = {.frames = FRAMES};
    for (int option; (option = mote_option_next(&reader, &value)) != MOTE_OPTION_END;) {
        if (option == MOTE_OPTION_ERROR)
            return MOTE_EXIT_USAGE;
        if (option == MOTE_OPTION_PLAIN && wish.kind)
            return mote_command_usage("sequence", "%s: one sequence at a time", value);
        if (option == MOTE_OPTION_PLAIN) {
            wish.kind = mote_simulated_find(value);
            if (!wish.kind)
                return unknown_kind(value);
        } else if (option == 2) {
            wish.directory = value;
        } else if (option == 1 && !mote_read_unsigned(value, 1, FRAMES_MAX, &wish.frames)) {
            return mote_command_usage(
                "sequence", "--frames %s: give a whole number from 1 to %d", value, FRAMES_MAX);
        } else if (option == 0 &&
                   !mote_read_unsigned(value, MOTE_SIMULATED_MIN_TRIANGLES,
                                       MOTE_SIMULATED_MAX_TRIANGLES, &wish.triangles)) {
            return mote_command_usage(
                "sequence", "--triangles %s: give a whole number from %d to %d", value,
                MOTE_SIMULATED_MIN_TRIANGLES, MOTE_SIMULATED_MAX_TRIANGLES);
        }
    }
    if (!wish.kind || !wish.directory || wish.triangles == 0)
        return mote_command_usage("sequence", "something is missing; write `mote sequence "
                                              "cloth --triangles 11920 --out DIR`");
    return make(&wish) == MOTE_OK ? mote_command_finish(MOTE_EXIT_DONE) : mote_command_fail();
}
