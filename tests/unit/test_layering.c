/* Which files may include which, read from the include lines of the sources. */
#define _DEFAULT_SOURCE /* DT_DIR */
#include "tests/support/test.h"

#include <stddef.h>

#include <dirent.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct rule {
    const char *folder;
    const char *may[4]; /* folders that it may include */
} rule;

static const rule rules[] = {
    {"core", {"core"}},
    {"baselines", {"core", "baselines"}},
    {"datasets", {"core", "datasets"}},
    {"harness", {"core", "baselines", "datasets", "harness"}},
};
#define FOLDERS (sizeof rules / sizeof rules[0])

/* The rooms of a folder, from the bottom up: each may include itself and those before it. */
typedef struct house {
    const char *folder;
    const char *rooms[16];
} house;

static const house houses[] = {
    {"core",
     {"base", "body", "parts", "method", "particle", "certificate", "skin", "stream", "impact",
      "batch", "motion"}},
    {"harness",
     {"base", "process", "engine", "gltf", "mesh", "sequence", "scene", "run", "loop",
      "summary", "compare", "race", "figure", "study", "report", "command"}},
};
#define HOUSES (sizeof houses / sizeof houses[0])

/* In a folder with more files than this it is hard to find one's way. */
#define FILES_MAX 40

/* A library's headers, and the prefixes of the only files that may include them. */
typedef struct library {
    const char *begins; /* of the included name */
    const char *files[2];
} library;

static const library libraries[] = {
    {"gsl/gsl_linalg", {"core/base/linear_algebra.c"}},
    {"gsl/gsl_eigen", {"core/base/linear_algebra.c"}},
    {"gsl/gsl_statistics", {"harness/base/statistics.c"}},
    {"gsl/gsl_sort", {"harness/base/statistics.c"}},
    {"gsl/gsl_cdf", {"harness/base/statistics.c"}},
    {"meshoptimizer", {"core/parts/parts"}},
    {"bullet/", {"core/parts/parts"}},
    {"fcl/", {"baselines/fcl/"}},
    {"embree", {"baselines/embree_"}},
    {"ode/", {"baselines/ode.c"}},
    {"btBullet", {"baselines/bullet_"}},
    {"BulletCollision", {"baselines/bullet_"}},
    {"assimp/", {"harness/mesh/mesh_assimp", "harness/mesh/character_"}},
};

/* An include line. Both names are relative to the root; that of another library is as
   written. A module is a header and its source: their common name without the suffix, of this
   length; 0: a name without one. */
typedef struct include {
    char file[400];
    char included[160];
    size_t file_module, included_module;
} include;

static include includes[8192];
static size_t include_count;

static bool begins_with(const char *text, const char *start)
{
    return strncmp(text, start, strlen(start)) == 0;
}

static bool is_source(const char *name)
{
    const char *dot = strrchr(name, '.');
    return dot && (strcmp(dot, ".c") == 0 || strcmp(dot, ".h") == 0 ||
                   strcmp(dot, ".cpp") == 0 || strcmp(dot, ".hpp") == 0);
}

static size_t module_length(const char *file)
{
    const char *dot = strrchr(file, '.');
    return dot ? (size_t)(dot - file) : 0;
}

static void read_includes(const char *file)
{
    char path[1024], line[1024];
    (void)snprintf(path, sizeof path, "%s/%s", MOTE_SOURCE_DIR, file);
    FILE *in = fopen(path, "r");
    assert_non_null(in);
    while (fgets(line, sizeof line, in)) {
        assert_true(include_count < sizeof includes / sizeof includes[0]);
        include *next = &includes[include_count];
        if (sscanf(line, " # include %*[\"<]%159[^\">]", next->included) == 1) {
            (void)snprintf(next->file, sizeof next->file, "%s", file);
            next->file_module = module_length(next->file);
            next->included_module = module_length(next->included);
            ++include_count;
        }
    }
    (void)fclose(in);
}

/* Reads the sources below a folder; too many files in one folder are an error. */
static void read_folder(const char *folder)
{
    char path[1024];
    (void)snprintf(path, sizeof path, "%s/%s", MOTE_SOURCE_DIR, folder);
    DIR *entries = opendir(path);
    assert_non_null(entries);
    int files = 0;
    for (const struct dirent *entry = readdir(entries); entry; entry = readdir(entries)) {
        char name[400];
        if (entry->d_name[0] == '.')
            continue;
        (void)snprintf(name, sizeof name, "%s/%s", folder, entry->d_name);
        if (is_source(name)) {
            ++files;
            read_includes(name);
        } else if (entry->d_type == DT_DIR) {
            read_folder(name);
        }
    }
    (void)closedir(entries);
    if (files > FILES_MAX)
        fail_msg("%s holds %d sources; make rooms of at most %d", folder, files, FILES_MAX);
}

static int read_sources(void)
{
    for (size_t i = 0; i < FOLDERS; ++i)
        read_folder(rules[i].folder);
    read_folder("tests");
    return include_count == 0;
}

TEST_GROUP(read_sources, NULL);

/* Whether a name lies in a folder, given without a slash. */
static bool lies_in(const char *name, const char *folder)
{
    return begins_with(name, folder) && name[strlen(folder)] == '/';
}

static void check_folders(const rule *r, const include *line)
{
    for (size_t i = 0; i < FOLDERS; ++i) {
        if (!lies_in(line->included, rules[i].folder))
            continue;
        bool allowed = false;
        for (size_t k = 0; k < 4 && r->may[k]; ++k)
            allowed = allowed || strcmp(r->may[k], rules[i].folder) == 0;
        if (!allowed)
            fail_msg("%s includes %s: %s may not include %s", line->file, line->included,
                     r->folder, rules[i].folder);
    }
    if (lies_in(line->included, "tests"))
        fail_msg("%s includes %s: only tests may", line->file, line->included);
}

TEST(folders_include_only_what_they_may)
{
    for (size_t i = 0; i < include_count; ++i) {
        for (size_t k = 0; k < FOLDERS; ++k) {
            if (lies_in(includes[i].file, rules[k].folder))
                check_folders(&rules[k], &includes[i]);
        }
    }
}

/* The position of a file's room in its house, counted from below, or -1. */
static int floor_of(const house *h, const char *file)
{
    if (!lies_in(file, h->folder))
        return -1;
    for (int i = 0; h->rooms[i]; ++i) {
        if (lies_in(file + strlen(h->folder) + 1, h->rooms[i]))
            return i;
    }
    return -1;
}

TEST(rooms_include_only_rooms_below_them)
{
    for (size_t i = 0; i < include_count; ++i) {
        for (size_t k = 0; k < HOUSES; ++k) {
            if (!lies_in(includes[i].file, houses[k].folder))
                continue;
            const int own = floor_of(&houses[k], includes[i].file);
            if (own < 0)
                fail_msg("%s lies in no room of %s", includes[i].file, houses[k].folder);
            if (floor_of(&houses[k], includes[i].included) > own)
                fail_msg("%s includes %s, of a room above it", includes[i].file,
                         includes[i].included);
        }
    }
}

static bool includes_itself(const include *line)
{
    return line->file_module == line->included_module &&
           strncmp(line->file, line->included, line->file_module) == 0;
}

static bool visited[sizeof includes / sizeof includes[0]];

/* Whether includes lead from the module that one line includes to the file of another. */
static bool reaches(const include *from, const include *target)
{
    for (size_t i = 0; i < include_count; ++i) {
        const include *line = &includes[i];
        if (line->file_module != from->included_module || visited[i] ||
            strncmp(line->file, from->included, line->file_module) != 0 ||
            includes_itself(line) || line->included_module == 0)
            continue;
        visited[i] = true;
        if ((line->included_module == target->file_module &&
             strncmp(line->included, target->file, line->included_module) == 0) ||
            reaches(line, target))
            return true;
    }
    return false;
}

TEST(no_module_includes_itself_in_a_circle)
{
    for (size_t i = 0; i < include_count; ++i) {
        const include *line = &includes[i];
        if (lies_in(line->file, "tests") || includes_itself(line) ||
            !strchr(line->included, '/'))
            continue;
        memset(visited, 0, sizeof visited);
        if (reaches(line, line))
            fail_msg("%s includes %s, which comes back to it", line->file, line->included);
    }
}

TEST(libraries_are_included_by_their_own_files)
{
    for (size_t i = 0; i < include_count; ++i) {
        for (size_t k = 0; k < sizeof libraries / sizeof libraries[0]; ++k) {
            const library *l = &libraries[k];
            if (!begins_with(includes[i].included, l->begins) ||
                lies_in(includes[i].file, "tests"))
                continue;
            if (!begins_with(includes[i].file, l->files[0]) &&
                !(l->files[1] && begins_with(includes[i].file, l->files[1])))
                fail_msg("%s includes %s, which is left to %s", includes[i].file,
                         includes[i].included, l->files[0]);
        }
    }
}
