#define _XOPEN_SOURCE 700 /* nftw */
#include "tests/faults/fault_lines.h"

#include "harness/base/file.h"
#include "harness/base/heap_count.h"
#include "harness/base/json_memory.h"
#include "harness/base/options.h"
#include "tests/support/diamond.h"
#include "tests/support/folder.h"
#include "tests/faults/fault_points.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include <ftw.h>
#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define FIELD                                                                                  \
    "\"field\": {\"count\": 3, \"support\": 0.7, \"displacement\": {\"random\": {\"seed\": "   \
    "5, \"amplitude\": 0.05, \"periods\": [40, 90]}}}"
#define SCENARIO                                                                               \
    "{\"purpose\": \"a test\", \"frames\": 4, \"ask\": \"distance\", \"bodies\": ["            \
    "{\"file\": \"a.obj\", " FIELD "}, {\"file\": \"a.obj\", \"motion\": ["                    \
    "{\"frame\": 1, \"position\": [2.1, 0.1, 0]}, {\"frame\": 4, \"position\": "               \
    "[1.9, 0.1, 0]}]}]}\n"
#define BODIES                                                                                 \
    "{\"purpose\": \"a test\", \"frames\": 4, \"ask\": \"distance\", \"bodies\": {"            \
    "\"count\": 3, \"seed\": 2, \"near_pairs\": 1, \"near\": 0.2, \"speed\": 0.01, "           \
    "\"spin\": 1, \"shapes\": [{\"file\": \"a.obj\", " FIELD "}]}}\n"

/* Stand-ins for the programs that the commands run. Each writes at once what the command looks
   for. */
#define GNUPLOT                                                                                \
    "#!/bin/sh\nfor f in $8; do echo drawn > \"$5.$f\"; done\n[ -n \"$8\" ] || echo drawn\n"
#define VALGRIND                                                                               \
    "#!/bin/sh\nfor a; do case $a in --callgrind-out-file=*)\n"                                \
    "printf 'x\\ntotals: 4000\\n' > \"${a#*=}\";; esac; done\n"
#define GIT "#!/bin/sh\necho 0123456789abcdef\n"

static const struct {
    const char *name, *text;
    mode_t mode;
} files[] = {
    {"a.obj", DIAMOND, 0644},       {"s.json", SCENARIO, 0644},       {"b.json", BODIES, 0644},
    {"bin/gnuplot", GNUPLOT, 0755}, {"bin/valgrind", VALGRIND, 0755}, {"bin/git", GIT, 0755},
};

static int run_line(void *context)
{
    const fault_line *l = context;
    char copy[512], *argv[32];
    int argc = 0;
    (void)snprintf(copy, sizeof copy, "%s", l->text);
    for (char *word = strtok(copy, " "); word; word = strtok(NULL, " "))
        argv[argc++] = word;
    argv[argc] = NULL;
    return l->run(argc, argv);
}

/* What is wrong with the files left behind, or "". A process that ran out of memory ends at
   once and may leave a file under its temporary name. */
static char wrong[512];
static bool parts_may_be_left;
static int files_left;

static bool ends_with(const char *text, const char *ending)
{
    const size_t length = strlen(text), end = strlen(ending);
    return length >= end && strcmp(text + length - end, ending) == 0;
}

static int look_at(const char *path, const struct stat *info, int type, struct FTW *place)
{
    (void)place;
    char *text = NULL;
    size_t size = 0;
    if (type != FTW_F)
        return 0;
    ++files_left;
    if (ends_with(path, ".part") && !parts_may_be_left)
        (void)snprintf(wrong, sizeof wrong, "%s is left", path);
    if (info->st_size == 0 || mote_file_read(path, 1 << 26, &text, &size) != MOTE_OK)
        return 0;
    json_t *object = ends_with(path, ".json") ? json_loads(text, 0, NULL) : NULL;
    if (ends_with(path, ".json") && !object)
        (void)snprintf(wrong, sizeof wrong, "%s is not JSON", path);
    if (text[size - 1] != '\n' && (ends_with(path, ".json") || ends_with(path, ".csv")))
        (void)snprintf(wrong, sizeof wrong, "%s ends in a line", path);
    json_decref(object);
    free(text);
    return 0;
}

static void look_at_files(void)
{
    wrong[0] = '\0';
    files_left = 0;
    (void)nftw(".", look_at, 16, FTW_PHYS);
}

static char said[1 << 16];

static void read_said(const char *path)
{
    FILE *in = fopen(path, "r");
    const size_t size = in ? fread(said, 1, sizeof said - 1, in) : 0;
    said[size] = '\0';
    if (in)
        (void)fclose(in);
}

/* Whether an error is reported on a line of its own that does not consist of "mote: " alone. */
static bool has_error(void)
{
    const char *error = strstr(said, "mote: ");
    return error && (error == said || error[-1] == '\n') && strlen(error) > 12 &&
           !strstr(error, "(null)");
}

/* Whether the last line, and no earlier one, reports the lack of memory. */
static bool has_memory_error(void)
{
    const char *told = strstr(said, "memory"), *last = told;
    while (last > said && last[-1] != '\n')
        --last;
    return told && strncmp(last, "mote: ", 6) == 0 && last[strcspn(last, "\n") + 1] == '\0';
}

/* A process without memory ends: either the program itself or the process of a cell, which then
   becomes a failed row. */
static bool is_good_end(const fault_line *l, fault_kind kind, const fault_end *end)
{
    if (end->status == l->status)
        return true;
    if (kind == FAULT_MEMORY && end->status == MOTE_EXIT_OUT_OF_MEMORY)
        return has_memory_error();
    if (kind == FAULT_MEMORY)
        return end->status == MOTE_EXIT_CELL_FAILED && has_error();
    return (end->status == MOTE_EXIT_CHECK_FAILED || end->status == MOTE_EXIT_BAD_INPUT ||
            end->status == MOTE_EXIT_CELL_FAILED) &&
           has_error();
}

static int faults, lines;

static void clean(void)
{
    (void)folder_remove("out");
}

/* Runs the line with its k-th call failing. */
static void fail_call(const fault_line *l, const fault_work *work, fault_kind kind,
                      fault_mode mode, size_t k, int usual_files)
{
    static const char *const modes[] = {"", "failed", "was interrupted", "did a part"};
    fault_end end;
    clean();
    if (!fault_points_run(work, mode, k, &end))
        return;
    ++faults;
    read_said(work->error);
    parts_may_be_left = kind == FAULT_MEMORY;
    look_at_files();
    parts_may_be_left = false;
    if (wrong[0])
        fail_msg("%s: call %ld, %s %s: %s", l->text, end.call, end.function, modes[mode],
                 wrong);
    const bool same = end.status == l->status && files_left >= usual_files;
    if (mode == FAULT_FAIL ? !is_good_end(l, kind, &end) : !same)
        fail_msg("%s: call %ld, %s %s: exit %d, %d files, not %d:\n%s", l->text, end.call,
                 end.function, modes[mode], end.status, files_left, usual_files, said);
}

/* A coverage build tries every place, or every third of a line that has many and takes long.
   Other builds try a sample, to save time, or all places of a line that has few; with
   sanitizers a smaller sample. */
static size_t stride(size_t places)
{
#ifdef MOTE_COVERAGE
    return places > 350 ? 3 : 1;
#else
    if (!mote_heap_read().counted)
        return 40;
    return places <= 24 ? 1 : 20;
#endif
}

static void fail_each_call(const fault_line *l, fault_kind kind)
{
    fault_end end;
    fault_line copy = *l;
    const fault_work work = {run_line, &copy, "said", "error"};
    clean();
    const size_t count = fault_points_find(&work, kind, &end);
    read_said(work.error);
    look_at_files();
    if (end.status != l->status || count == 0 || wrong[0])
        fail_msg("%s: exit %d, %zu calls, %s:\n%s", l->text, end.status, count, wrong, said);
    const int usual_files = files_left;
    const size_t step = stride(count);
    for (size_t k = (size_t)lines % step; k < count; k += step) {
        for (int mode = FAULT_FAIL; mode <= FAULT_SHORT; ++mode)
            fail_call(l, &work, kind, (fault_mode)mode, k, usual_files);
    }
    printf("%s: %zu places\n", l->text, count);
    ++lines;
}

void fault_lines_fail(const fault_line *list, size_t count)
{
    for (size_t i = 0; i < count; ++i)
        fail_each_call(&list[i], FAULT_CALLS);
}

void fault_lines_exhaust(const fault_line *list, size_t count)
{
    for (size_t i = 0; i < count; ++i)
        fail_each_call(&list[i], FAULT_MEMORY);
}

bool fault_lines_run(const fault_line *list, size_t count)
{
    fault_end end = {0};
    for (size_t i = 0; i < count && end.status == 0; ++i) {
        fault_line copy = list[i];
        const fault_work work = {run_line, &copy, "said", "error"};
        (void)fault_points_find(&work, FAULT_CALLS, &end);
        read_said(work.error);
        if (end.status != 0)
            printf("%s: exit %d:\n%s", list[i].text, end.status, said);
    }
    return end.status == 0;
}

bool fault_lines_write(const char *name, const char *text)
{
    return mote_file_write(name, text, strlen(text)) == MOTE_OK;
}

bool fault_lines_open(void)
{
    char path[160];
    mote_json_use_memory();
    if (mkdir("bin", 0700) != 0 || snprintf(path, sizeof path, "%s/bin", folder_path()) < 0 ||
        setenv("PATH", path, 1) != 0)
        return false;
    for (size_t i = 0; i < sizeof files / sizeof files[0]; ++i) {
        if (mote_file_write(files[i].name, files[i].text, strlen(files[i].text)) != MOTE_OK ||
            chmod(files[i].name, files[i].mode) != 0)
            return false;
    }
    return true;
}

bool fault_lines_install(void)
{
    static char program[160];
    (void)snprintf(program, sizeof program, "%s/bin/mote", folder_path());
    fault_points_be(program);
    return mkdir("share", 0700) == 0 && mkdir("share/mote", 0700) == 0 &&
           mkdir("share/mote/page", 0700) == 0 && mkdir("share/mote/datasets", 0700) == 0 &&
           mkdir("share/mote/datasets/scenarios", 0700) == 0 &&
           symlink(MOTE_SOURCE_DIR "/plots", "share/mote/plots") == 0 &&
           fault_lines_write("bin/mote", "a program\n");
}

int fault_lines_close(void)
{
    printf("%d calls of %d command lines failed, were interrupted or did a part\n", faults,
           lines);
    return 0;
}
