/* make characters: which files with animations can be read as characters. Every file found is
   imported as a mesh and as a character; each clip of a character is posed at 17 times, and all
   vertices must be finite.

   Usage: characters FILE|FOLDER...
   Prints a table with a line for each file with clips, then the counts. Exit status 1 where a
   refusal is not one line that names the file and what would be right, where a pose is not
   finite, or where no file was read. */
#define _XOPEN_SOURCE 700 /* nftw */
#include "harness/mesh/character.h"

#include <ftw.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#define TIMES 17

static struct tally {
    size_t read, whole, refused, unclear, wild; /* whole: with no edge of more than two faces */
} tally;

static mote_vec3 place(const mote_character *c, const mote_character_pose *pose, uint32_t v)
{
    mote_vec3 x = c->mesh->positions[v], at = {0, 0, 0};
    for (uint32_t i = c->shift_start[v]; i < c->shift_start[v + 1]; ++i)
        x = mote_add_scaled(x, pose->morphs[c->target[i]], c->shift[i]);
    for (uint32_t i = c->start[v]; i < c->start[v + 1]; ++i)
        at = mote_add_scaled(at, c->weight[i],
                             mote_affine_apply(&pose->matrices[c->bone[i]], x));
    return at;
}

static bool is_finite(const mote_character *c)
{
    mote_character_pose pose = mote_character_pose_create(c);
    double sum = 0;
    for (uint32_t k = 0; k < c->rig.clips_count; ++k) {
        for (int t = 0; t < TIMES; ++t) {
            mote_character_pose_set(c, k, c->rig.clips[k].seconds * t / (TIMES - 1), &pose);
            for (uint32_t v = 0; v < c->mesh->vertex_count; ++v)
                sum += 0 * mote_length_squared(place(c, &pose, v));
        }
    }
    mote_character_pose_free(&pose);
    return sum == 0;
}

static void note_read(const char *path, const mote_character *c, const mote_import *mesh)
{
    const bool finite = is_finite(c);
    ++tally.read;
    tally.whole += mesh->split.edges == 0;
    tally.wild += !finite;
    printf("%9u %5zu %5zu %7zu %5zu  %s%s\n", c->mesh->triangle_count, mesh->split.edges,
           c->rig.bones_count, c->rig.targets_count, c->rig.clips_count, path,
           finite ? "" : ": a pose is not finite");
}

static void note_refused(const char *path)
{
    const char *text = mote_error_text();
    const bool clear =
        strncmp(text, path, strlen(path)) == 0 && strstr(text, "; ") && !strchr(text, '\n');
    ++tally.refused;
    tally.unclear += !clear;
    printf("%35s  %s\n", clear ? "refused:" : "refused, not clear:", text);
}

static int visit(const char *path, const struct stat *info, int type, struct FTW *where)
{
    (void)info, (void)where;
    mote_character *c = NULL;
    mote_character_import import;
    mote_mesh *mesh = NULL;
    if (type != FTW_F)
        return 0;
    const mote_status status = mote_character_import_file(path, &c, &import);
    if (status == MOTE_OK && c->rig.clips_count > 0) {
        note_read(path, c, &import.mesh);
    } else if (status != MOTE_OK && status != MOTE_EUNSUPPORTED &&
               mote_mesh_import(path, &mesh, NULL) == MOTE_OK) {
        mote_mesh_destroy(mesh); /* it is a mesh, so only its animation can be wrong */
        (void)mote_character_import_file(path, &c, &import);
        note_refused(path);
    }
    mote_character_destroy(c);
    return 0;
}

int main(int argc, char **argv)
{
    if (argc < 2) {
        fprintf(stderr, "usage: characters FILE|FOLDER...\n");
        return 2;
    }
    /* "edges" counts those of more than two faces. */
    printf("%9s %5s %5s %7s %5s  %s\n", "triangles", "edges", "bones", "targets", "clips",
           "file");
    for (int at = 1; at < argc; ++at)
        (void)nftw(argv[at], visit, 16, FTW_PHYS);
    printf(
        "\nOf %zu files with clips %zu are read, %zu of them without an edge of more than two "
        "faces; %zu are refused, %zu of these without a clear line; %zu have a pose that is "
        "not finite.\n",
        tally.read + tally.refused, tally.read, tally.whole, tally.refused, tally.unclear,
        tally.wild);
    return tally.read > 0 && tally.unclear == 0 && tally.wild == 0 ? 0 : 1;
}
