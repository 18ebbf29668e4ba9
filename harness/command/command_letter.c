/* mote letter W --triangles 11920 -o W.obj */
#include "datasets/letter.h"
#include "datasets/obj_write.h"
#include "harness/command/command.h"
#include "harness/base/file.h"
#include "harness/base/options.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Writes the mesh to a stream. */
static mote_status print_mesh(const char *path, const mote_mesh *mesh)
{
    const int descriptor = mote_stream_open(path);
    FILE *file = descriptor >= 0 ? fdopen(descriptor, "w") : NULL;
    if (!file)
        return mote_fail(MOTE_EIO, "%s: cannot be written: %s", path, strerror(errno));
    mote_status status = mote_obj_print(file, NULL, mesh);
    if (status != MOTE_OK)
        status = mote_fail(status, "%s: %s", path, mote_error_text());
    if (fclose(file) != 0 && status == MOTE_OK)
        status = mote_fail(MOTE_EIO, "%s: cannot be written: %s", path, strerror(errno));
    return status;
}

static mote_status write_mesh(const char *path, const mote_mesh *mesh)
{
    char *target = mote_path_follow(path);
    if (!target)
        return mote_fail(MOTE_EIO, "%s: cannot be written: %s", path, strerror(errno));
    const mote_status status = mote_obj_write(target, NULL, mesh);
    free(target);
    return status;
}

const mote_option mote_options_letter[] = {
    {"triangles", "COUNT", "about how many triangles the mesh has; no default"},
    {"-o", "FILE", "the OBJ file to write; no default"},
    {NULL, NULL, NULL}};

int mote_command_letter(int argc, char **argv)
{
    mote_option_reader reader = mote_option_begin(mote_options_letter, argc, argv);
    const char *letter = NULL, *path = NULL, *value;
    uint64_t triangles = 0;
    for (int option; (option = mote_option_next(&reader, &value)) != MOTE_OPTION_END;) {
        if (option == MOTE_OPTION_ERROR)
            return MOTE_EXIT_USAGE;
        if (option == MOTE_OPTION_PLAIN && letter)
            return mote_command_usage("letter", "%s: one letter at a time", value);
        if (option == MOTE_OPTION_PLAIN)
            letter = value;
        else if (option == 1)
            path = value;
        else if (!mote_read_unsigned(value, 0, SIZE_MAX, &triangles))
            return mote_command_usage("letter", "--triangles %s: give a whole number", value);
    }
    if (!letter || !path || triangles == 0)
        return mote_command_usage("letter", "something is missing; write `mote letter W "
                                            "--triangles 11920 -o W.obj`");
    if (letter[0] == '\0' || letter[1] != '\0') {
        (void)mote_fail(MOTE_EINVAL, "letter %s: not one letter; give one capital", letter);
        return mote_command_fail();
    }
    mote_mesh *mesh;
    if (mote_letter_create(letter[0], triangles, &mesh) != MOTE_OK)
        return mote_command_fail();
    /* Facts printed about the mesh must not go into its file. */
    const bool is_stream = mote_path_is_stream(path);
    mote_status status = is_stream ? print_mesh(path, mesh) : write_mesh(path, mesh);
    if (status == MOTE_OK)
        (void)fprintf(is_stream ? stderr : stdout,
                      "%s: %u vertices, %u triangles, smallest angle %.1f degrees\n", path,
                      mesh->vertex_count, mesh->triangle_count, mote_mesh_smallest_angle(mesh));
    mote_mesh_destroy(mesh);
    return status == MOTE_OK ? mote_command_finish(MOTE_EXIT_DONE) : mote_command_fail();
}
