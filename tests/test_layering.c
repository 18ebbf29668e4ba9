/* Who may include whom, read from the include lines of the sources. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include <dirent.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

typedef struct rule {
    const char *folder;
    const char *may[4]; /* folders that it may include */
} rule;

static const rule rules[] = {
    {"core", {"core"}},
    {"baselines", {"core", "baselines"}},
    {"datasets", {"core", "baselines", "harness", "datasets"}},
    {"harness", {"core", "baselines", "harness", "datasets"}},
};
static const char *const folders[] = {"core", "baselines", "datasets", "harness", "tests"};

/* A library's headers and how the names of the only files begin that may include them. */
typedef struct library {
    const char *begins; /* of the included name */
    const char *files[4];
} library;

static const library libraries[] = {
    {"gsl/gsl_linalg", {"core/base/linear_algebra.c"}},
    {"gsl/gsl_eigen", {"core/base/linear_algebra.c"}},
    {"gsl/gsl_statistics", {"harness/base/statistics.c"}},
    {"gsl/gsl_sort", {"harness/base/statistics.c"}},
    {"gsl/gsl_cdf", {"harness/base/statistics.c"}},
    {"meshoptimizer", {"core/parts"}},
    {"bullet/", {"core/parts"}},
    {"fcl/", {"baselines/fcl_"}},
};

typedef void (*visit)(const char *folder, const char *file, const char *included);

/* Calls visit for each include line of a file; returns how many there were. */
static int read_includes(const char *folder, const char *file, visit act)
{
    char path[1024], line[1024];
    (void)snprintf(path, sizeof path, "%s/%s/%s", MOTE_SOURCE_DIR, folder, file);
    FILE *in = fopen(path, "r");
    assert_non_null(in);
    int count = 0;
    while (fgets(line, sizeof line, in)) {
        char name[512];
        if (sscanf(line, " # include %*[\"<]%511[^\">]", name) != 1)
            continue;
        ++count;
        act(folder, file, name);
    }
    (void)fclose(in);
    return count;
}

static bool is_source(const char *name)
{
    const char *dot = strrchr(name, '.');
    return dot && (strcmp(dot, ".c") == 0 || strcmp(dot, ".h") == 0 ||
                   strcmp(dot, ".cpp") == 0 || strcmp(dot, ".hpp") == 0);
}

static int read_folder(const char *folder, visit act)
{
    char path[1024];
    (void)snprintf(path, sizeof path, "%s/%s", MOTE_SOURCE_DIR, folder);
    DIR *entries = opendir(path);
    assert_non_null(entries);
    int count = 0;
    for (const struct dirent *entry = readdir(entries); entry; entry = readdir(entries)) {
        if (is_source(entry->d_name))
            count += read_includes(folder, entry->d_name, act);
    }
    (void)closedir(entries);
    return count;
}

static const rule *rule_of(const char *folder)
{
    for (size_t i = 0; i < sizeof rules / sizeof rules[0]; ++i) {
        if (strcmp(rules[i].folder, folder) == 0)
            return &rules[i];
    }
    return NULL;
}

static void check_folder_rule(const char *folder, const char *file, const char *included)
{
    const rule *r = rule_of(folder);
    for (size_t i = 0; r && i < sizeof folders / sizeof folders[0]; ++i) {
        size_t length = strlen(folders[i]);
        if (strncmp(included, folders[i], length) != 0 || included[length] != '/')
            continue;
        bool allowed = false;
        for (size_t k = 0; k < 4 && r->may[k]; ++k)
            allowed = allowed || strcmp(r->may[k], folders[i]) == 0;
        if (!allowed)
            fail_msg("%s/%s includes %s: %s may not include %s", folder, file, included, folder,
                     folders[i]);
    }
}

static void check_library_rule(const char *folder, const char *file, const char *included)
{
    char path[512];
    (void)snprintf(path, sizeof path, "%s/%s", folder, file);
    for (size_t i = 0; i < sizeof libraries / sizeof libraries[0]; ++i) {
        const library *l = &libraries[i];
        if (strncmp(included, l->begins, strlen(l->begins)) != 0)
            continue;
        bool allowed = false;
        for (size_t k = 0; k < 4 && l->files[k]; ++k)
            allowed = allowed || strncmp(path, l->files[k], strlen(l->files[k])) == 0;
        if (!allowed)
            fail_msg("%s includes %s, which is left to %s", path, included, l->files[0]);
    }
}

static int assimp_files;
static char assimp_last[512];

static void count_assimp(const char *folder, const char *file, const char *included)
{
    char path[512];
    (void)snprintf(path, sizeof path, "%s/%s", folder, file);
    if (strncmp(included, "assimp/", 7) == 0 && strcmp(path, assimp_last) != 0) {
        ++assimp_files;
        memcpy(assimp_last, path, sizeof path);
    }
}

static void includes_of_each_folder_go_downwards_only(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof rules / sizeof rules[0]; ++i)
        assert_true(read_folder(rules[i].folder, check_folder_rule) > 0);
}

static void includes_of_libraries_stay_in_their_files(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof rules / sizeof rules[0]; ++i)
        assert_true(read_folder(rules[i].folder, check_library_rule) > 0);
}

static void includes_of_assimp_are_in_one_file_at_most(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof rules / sizeof rules[0]; ++i)
        assert_true(read_folder(rules[i].folder, count_assimp) > 0);
    assert_true(assimp_files <= 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(includes_of_each_folder_go_downwards_only),
        cmocka_unit_test(includes_of_libraries_stay_in_their_files),
        cmocka_unit_test(includes_of_assimp_are_in_one_file_at_most),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
