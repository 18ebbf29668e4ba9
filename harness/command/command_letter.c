/* mote letter W --triangles 11920 -o W.obj */
#include "core/base/random.h"
#include "core/stream/stream.h"
#include "datasets/letter.h"
#include "datasets/obj_write.h"
#include "harness/command/command.h"
#include "harness/base/file.h"
#include "harness/base/memory.h"
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

/* order[new] = old, in a random order that is always the same. */
static void draw_order(uint32_t *order, uint32_t count)
{
    mote_random random = {1};
    for (uint32_t v = 0; v < count; ++v)
        order[v] = v;
    for (uint32_t v = count; v > 1; --v) {
        const uint32_t other = (uint32_t)mote_random_below(&random, v);
        const uint32_t kept = order[v - 1];
        order[v - 1] = order[other];
        order[other] = kept;
    }
}

/* Replaces *mesh with one whose vertices are in another order. */
static mote_status reorder(const uint32_t *order, mote_mesh **mesh)
{
    const mote_mesh *old = *mesh;
    mote_mesh *made = NULL;
    const size_t corners = (size_t)3 * old->triangle_count;
    mote_vec3 *positions = mote_allocate(old->vertex_count, sizeof *positions);
    uint32_t *place = mote_allocate(old->vertex_count, sizeof *place);
    uint32_t *triangles = mote_allocate(corners, sizeof *triangles);
    for (uint32_t v = 0; v < old->vertex_count; ++v) {
        positions[v] = old->positions[order[v]];
        place[order[v]] = v;
    }
    for (size_t i = 0; i < corners; ++i)
        triangles[i] = place[old->triangles[i / 3][i % 3]];
    const mote_status status = mote_mesh_create(&positions[0].x, old->vertex_count, triangles,
                                                old->triangle_count, &made);
    free(positions);
    free(place);
    free(triangles);
    if (status == MOTE_OK) {
        mote_mesh_destroy(*mesh);
        *mesh = made;
    }
    return status;
}

/* Makes a letter with its vertices in the order that --order names. */
static mote_status make_letter(char letter, uint64_t triangles, const char *order,
                               mote_mesh **mesh)
{
    mote_field *field = NULL;
    mote_status status = mote_letter_create(letter, triangles, mesh);
    if (status != MOTE_OK || strcmp(order, "letter") == 0)
        return status;
    uint32_t *numbers = mote_allocate((*mesh)->vertex_count, sizeof *numbers);
    if (strcmp(order, "random") == 0) {
        draw_order(numbers, (*mesh)->vertex_count);
    } else {
        status = mote_field_create_given(&field);
        if (status == MOTE_OK)
            status = mote_stream_order(&(mote_body){.mesh = *mesh, .field = field}, numbers);
        mote_field_destroy(field);
    }
    if (status == MOTE_OK)
        status = reorder(numbers, mesh);
    free(numbers);
    if (status != MOTE_OK)
        mote_mesh_destroy(*mesh);
    return status;
}

const mote_option mote_options_letter[] = {
    {"triangles", "COUNT",
     "how many triangles the mesh has: an even number, 400 to 20,000,000; no default"},
    {"-o", "FILE", "the OBJ file to write; no default"},
    {"order", "letter|leaf|random",
     "of the vertices: as a scenario's letter has them; as the method stream reads them; "
     "random, "
     "always the same (default: letter)"},
    {NULL, NULL, NULL}};

int mote_command_letter(int argc, char **argv)
{
    mote_option_reader reader = mote_option_begin(mote_options_letter, argc, argv);
    const char *letter = NULL, *path = NULL, *order = "letter", *value;
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
        else if (option == 2)
            order = value;
        else if (!mote_read_unsigned(value, MOTE_LETTER_MIN_TRIANGLES,
                                     MOTE_LETTER_MAX_TRIANGLES, &triangles) ||
                 triangles % 2 != 0)
            return mote_command_usage(
                "letter", "--triangles %s: give an even number from %d to %d", value,
                MOTE_LETTER_MIN_TRIANGLES, MOTE_LETTER_MAX_TRIANGLES);
    }
    if (!letter || !path || triangles == 0)
        return mote_command_usage("letter", "something is missing; write `mote letter W "
                                            "--triangles 11920 -o W.obj`");
    if (strcmp(order, "letter") != 0 && strcmp(order, "leaf") != 0 &&
        strcmp(order, "random") != 0)
        return mote_command_usage("letter", "--order %s: give letter, leaf or random", order);
    if (letter[0] == '\0' || letter[1] != '\0') {
        (void)mote_fail(MOTE_EINVAL, "letter %s: not one letter; give one capital", letter);
        return mote_command_fail();
    }
    mote_mesh *mesh;
    if (make_letter(letter[0], triangles, order, &mesh) != MOTE_OK)
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
