/* make readers: compares our readers of mesh files with assimp's. Both read every OBJ and OFF
   file found; every other mesh that assimp reads is first written as OBJ and as OFF, with its
   faces unchanged. Where both accept a file, the surfaces must have the same area, volume and
   bounds, and no point of one may be off the other. Allowed are assimp's rounding to 32-bit
   floats and the thickness of faces that are not flat, which the two triangulate differently.

   Usage: readers [--plant] --out DIR FILE|FOLDER...
   Each file is also imported as mote imports it; a refusal must be one line that names the file
   and what would be right. DIR/readers.tsv has a row a reading; DIR/readers.md and standard
   output have the table. --plant replaces our triangles by fans.

   Exit status 1 where readings differ, unless the faces' area by Newell's formula shows that
   assimp's is wrong; where a refusal is not clear; where nothing was compared. */
#define _XOPEN_SOURCE 700 /* nftw */
#include "harness/base/file.h"
#include "harness/base/memory.h"
#include "harness/mesh/mesh_import.h"
#include "harness/process/child.h"
#include "tests/studies/readers_assimp.h"

#include <ctype.h>
#include <fcntl.h>
#include <ftw.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define SECONDS 120
#define MEMORY_BYTES ((size_t)4 << 30)
#define SAID_MAX 240

typedef enum verdict {
    SAME,
    NOT_FLAT, /* the same apart from the thickness of faces that are not flat */
    ASSIMP_WRONG,
    DIFFERENT,
    WE_REFUSE,
    ASSIMP_REFUSES,
    BOTH_REFUSE
} verdict;
#define VERDICTS 7
static const char *const verdict_names[VERDICTS] = {"same",       "not flat",  "assimp wrong",
                                                    "different",  "we refuse", "assimp refuses",
                                                    "both refuse"};

typedef enum model_kind { OBJ_FILE, OFF_FILE, AS_OBJ, AS_OFF } model_kind;
#define KINDS 4
static const char *const kind_names[KINDS] = {"OBJ files", "OFF files", "others as OBJ",
                                              "others as OFF"};

typedef struct reading {
    const char *path; /* of the model */
    model_kind kind;
    const char *written; /* where AS_OBJ and AS_OFF are written */
    bool plant;
} reading;

typedef struct row {
    verdict verdict;
    difference d;
    double faces_area; /* Newell's */
    size_t triangles;
    char said[SAID_MAX]; /* by the reader that refuses */
} row;

static bool write_polygons(const char *path, const polygons *p, bool is_off)
{
    FILE *file = fopen(path, "w");
    if (!file)
        return false;
    if (is_off)
        fprintf(file, "OFF\n%zu %zu 0\n", p->vertex_count, p->face_count);
    for (size_t i = 0; i < p->vertex_count; ++i)
        fprintf(file, "%s%.17g %.17g %.17g\n", is_off ? "" : "v ", p->at[i].x, p->at[i].y,
                p->at[i].z);
    for (size_t f = 0; f < p->face_count; ++f) {
        if (is_off)
            fprintf(file, "%zu", p->first[f + 1] - p->first[f]);
        else
            fprintf(file, "f");
        for (size_t i = p->first[f]; i < p->first[f + 1]; ++i)
            fprintf(file, " %u", p->corners[i] + (is_off ? 0 : 1));
        fprintf(file, "\n");
    }
    return fclose(file) == 0;
}

static bool read_ours(const char *path, surface *s, char *said)
{
    mote_mesh *mesh;
    *s = (surface){0};
    if (mote_mesh_import(path, &mesh, NULL) != MOTE_OK) {
        (void)snprintf(said, SAID_MAX, "%s", mote_error_text());
        return false;
    }
    for (uint32_t t = 0; t < mesh->triangle_count; ++t)
        surface_add(s, mesh->positions[mesh->triangles[t][0]],
                    mesh->positions[mesh->triangles[t][1]],
                    mesh->positions[mesh->triangles[t][2]]);
    mote_mesh_destroy(mesh);
    return true;
}

/* Compares with faces taken as flat, then with their thickness. */
static verdict judge(row *r, const surface *ours, const surface *theirs, double thickness)
{
    r->d = surface_compare(ours, theirs, 0);
    if (difference_is_rounding(&r->d))
        return SAME;
    r->d = surface_compare(ours, theirs, thickness);
    if (difference_is_rounding(&r->d))
        return NOT_FLAT;
    const bool we_are_right = fabs(r->d.area[0] - r->faces_area) <= r->d.area_allowed;
    const bool assimp_is_right = fabs(r->d.area[1] - r->faces_area) <= r->d.area_allowed;
    return we_are_right && !assimp_is_right ? ASSIMP_WRONG : DIFFERENT;
}

/* Reads one file both ways; p holds its faces. */
static void read_both(const char *path, const polygons *p, bool plant, row *r)
{
    surface ours, theirs;
    double thickness;
    char we_said[SAID_MAX] = "", assimp_said[SAID_MAX] = "";
    bool accepted = true;
    r->faces_area = polygons_area(p, &thickness);
    if (plant)
        surface_of_fans(p, &ours);
    else
        accepted = read_ours(path, &ours, we_said);
    surface_read_assimp(path, &theirs, assimp_said, sizeof assimp_said);
    r->triangles = ours.count;
    if (accepted && theirs.count > 0) {
        r->verdict = judge(r, &ours, &theirs, thickness);
    } else {
        r->verdict = accepted ? ASSIMP_REFUSES : theirs.count > 0 ? WE_REFUSE : BOTH_REFUSE;
        (void)snprintf(r->said, sizeof r->said, "%s", accepted ? assimp_said : we_said);
    }
    surface_free(&ours);
    surface_free(&theirs);
}

/* assimp prints what it stumbles over. */
static void silence(void)
{
    const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
    if (nowhere >= 0)
        (void)dup2(nowhere, STDERR_FILENO);
}

/* Runs in a child, because assimp may crash. Writes a row, or nothing if assimp has no face to
   write. */
static mote_status look(void *context, int output)
{
    const reading *one = context;
    const bool is_written = one->kind == AS_OBJ || one->kind == AS_OFF;
    polygons p;
    row r;
    char said[SAID_MAX];
    mote_status status = MOTE_OK;
    silence();
    memset(&r, 0, sizeof r);
    polygons_read(one->path, &p, said, sizeof said);
    if (is_written && p.face_count > 0 &&
        !write_polygons(one->written, &p, one->kind == AS_OFF))
        status = mote_fail(MOTE_EIO, "%s: cannot be written", one->written);
    if (status == MOTE_OK && (!is_written || p.face_count > 0)) {
        read_both(is_written ? one->written : one->path, &p, one->plant, &r);
        status = mote_child_put(output, &r, sizeof r);
    }
    polygons_free(&p);
    return status;
}

typedef struct tally {
    size_t of[VERDICTS], compared;
    double farthest; /* among the equal ones, in L */
} tally;

typedef struct study {
    const char *out;
    bool plant;
    FILE *rows;
    size_t imported, refused,
        unclear; /* files; unclear: refusals that are not one clear line */
    tally tallies[KINDS];
} study;

static void note_row(study *s, const reading *one, const row *r)
{
    tally *t = &s->tallies[one->kind];
    const difference *d = &r->d;
    const double far = d->size > 0 ? fmax(d->there, d->back) / d->size : 0;
    ++t->of[r->verdict];
    t->compared += r->verdict <= DIFFERENT;
    if (r->verdict == SAME)
        t->farthest = fmax(t->farthest, far);
    fprintf(s->rows, "%s\t%s\t%s\t%zu\t%.9g\t%.9g\t%.9g\t%.9g\t%.9g\t%.3g\t%.3g\t%s\n",
            one->path, kind_names[one->kind], verdict_names[r->verdict], r->triangles,
            r->faces_area, d->area[0], d->area[1], d->volume[0], d->volume[1], d->bounds, far,
            r->said);
    if (r->verdict == DIFFERENT || r->verdict == ASSIMP_WRONG)
        fprintf(
            stderr,
            "readers: %s (%s): %s: area %.9g, assimp's %.9g, of its faces %.9g; %.3g L off\n",
            one->path, kind_names[one->kind], verdict_names[r->verdict], d->area[0], d->area[1],
            r->faces_area, far);
}

static void look_at(study *s, const char *path, model_kind kind)
{
    char *written = mote_format("%s/model.%s", s->out, kind == AS_OFF ? "off" : "obj");
    reading one = {path, kind, written, s->plant};
    const mote_child_limits limits = {
        .seconds = SECONDS, .memory_bytes = MEMORY_BYTES, .output_bytes = sizeof(row)};
    char *output = NULL;
    size_t size = 0;
    row r = {.verdict = BOTH_REFUSE};
    const bool done = mote_child_run("assimp", look, &one, limits, &output, &size) == MOTE_OK;
    if (!done)
        (void)snprintf(r.said, sizeof r.said, "%.200s", mote_error_text());
    else if (size == sizeof r)
        memcpy(&r, output, sizeof r);
    if (!done || size == sizeof r)
        note_row(s, &one, &r);
    free(output);
    (void)unlink(written);
    free(written);
}

static void check_import(study *s, const char *path)
{
    mote_mesh *mesh;
    if (mote_mesh_import(path, &mesh, NULL) == MOTE_OK) {
        mote_mesh_destroy(mesh);
        ++s->imported;
        return;
    }
    const char *text = mote_error_text();
    ++s->refused;
    if (strncmp(text, path, strlen(path)) == 0 && strstr(text, "; ") && !strchr(text, '\n'))
        return;
    ++s->unclear;
    fprintf(stderr, "readers: %s: refused without a clear line: %s\n", path, text);
}

static study *the_study; /* nftw has no context */

static bool ends_with(const char *path, const char *ending)
{
    const size_t length = strlen(path), size = strlen(ending);
    if (length < size)
        return false;
    for (size_t i = 0; i < size; ++i) {
        if (tolower((unsigned char)path[length - size + i]) != ending[i])
            return false;
    }
    return true;
}

static int visit(const char *path, const struct stat *info, int type, struct FTW *where)
{
    (void)info, (void)where;
    if (type != FTW_F)
        return 0;
    check_import(the_study, path);
    if (ends_with(path, ".obj") || ends_with(path, ".off")) {
        look_at(the_study, path, ends_with(path, ".obj") ? OBJ_FILE : OFF_FILE);
    } else {
        look_at(the_study, path, AS_OBJ);
        look_at(the_study, path, AS_OFF);
    }
    return 0;
}

/* As Markdown. */
static bool print_table(const study *s, FILE *file)
{
    fprintf(file, "| files | both accept | same | same but for faces that are not flat | "
                  "assimp wrong | different | only we refuse | only "
                  "assimp refuses | both refuse | farthest of the same, L |\n"
                  "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
    for (int k = 0; k < KINDS; ++k) {
        const tally *t = &s->tallies[k];
        fprintf(file, "| %s | %zu |", kind_names[k], t->compared);
        for (int v = 0; v < VERDICTS; ++v)
            fprintf(file, " %zu |", t->of[v]);
        fprintf(file, " %.2g |\n", t->farthest);
    }
    fprintf(
        file,
        "\nOf %zu files mote reads %zu and refuses %zu, %zu of these without a clear line.\n",
        s->imported + s->refused, s->imported, s->refused, s->unclear);
    return !ferror(file);
}

static bool write_table(const study *s)
{
    char *path = mote_format("%s/readers.md", s->out);
    FILE *file = fopen(path, "w");
    bool good = file && print_table(s, file);
    good = file && fclose(file) == 0 && good;
    free(path);
    return good && print_table(s, stdout);
}

static int conclude(const study *s)
{
    size_t compared = 0, different = 0;
    for (int k = 0; k < KINDS; ++k) {
        compared += s->tallies[k].compared;
        different += s->tallies[k].of[DIFFERENT];
    }
    if (compared == 0)
        fprintf(stderr, "readers: nothing that both accept; name mesh files\n");
    return compared > 0 && different == 0 && s->unclear == 0 ? 0 : 1;
}

int main(int argc, char **argv)
{
    study s = {.out = NULL};
    int at = 1;
    for (; at < argc && argv[at][0] == '-'; ++at) {
        if (strcmp(argv[at], "--plant") == 0)
            s.plant = true;
        else if (strcmp(argv[at], "--out") == 0 && at + 1 < argc)
            s.out = argv[++at];
    }
    if (!s.out || at == argc) {
        fprintf(stderr, "usage: readers [--plant] --out DIR FILE|FOLDER...\n");
        return 2;
    }
    char *path = mote_format("%s/readers.tsv", s.out);
    s.rows = mote_directory_make(s.out) == MOTE_OK ? fopen(path, "w") : NULL;
    free(path);
    if (!s.rows) {
        fprintf(stderr, "readers: nothing can be written to %s\n", s.out);
        return 1;
    }
    fprintf(s.rows,
            "model\tread as\tverdict\ttriangles\tarea of faces\tarea\tassimp's\tvolume\t"
            "assimp's\tbounds apart\tfarthest in L\twhy refused\n");
    the_study = &s;
    for (; at < argc; ++at)
        (void)nftw(argv[at], visit, 16, FTW_PHYS);
    const bool written = fclose(s.rows) == 0 && write_table(&s);
    return written ? conclude(&s) : 1;
}
