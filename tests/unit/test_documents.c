/* Whatever the documents mention exists: link targets, files, commands with their options, make
   targets, tests, functions. The files named in comments of the sources exist, too. */
#define _XOPEN_SOURCE 700 /* nftw */
#include "tests/support/program.h"
#include "tests/support/test.h"

#include <ctype.h>
#include <fnmatch.h>
#include <ftw.h>
#include <regex.h>
#include <stdbool.h>

/* Files of the project, named from its root, without the output of runs and builds. */
static char *files[4096];
static size_t file_count;
static char help_table[1 << 16], makefile[1 << 16];
static int missing; /* complaints so far */

/* Names of output, of examples, and of users' files. */
static const char *const not_ours[] = {
    "results/paper",   "results/quick",    "results/mine",
    "results/bending", "results/claims/*", "results/reliability/*",
    "results/bodies",  "results/base",     "core/sampled.c",
    "sampled.c",       "bend.c",           "compare.py",
    "x.cpp",           "core/bend.c",      "total_ns_median",
    "track.c",         "engine.c",         "datasets/scenarios/bending.json",
    "letters.py",      "bodies.py",        "front.py",
    "track.py",
};

static bool is_ours(const char *name)
{
    for (size_t i = 0; i < sizeof not_ours / sizeof not_ours[0]; ++i)
        if (fnmatch(not_ours[i], name, 0) == 0)
            return false;
    return true;
}

/* Runs leave any number of files in results/; these are the names of ours. The page brings
   packages of npm. */
static bool is_made(const char *name)
{
    static const char *const ours[] = {"results/README.md",   "results/fuzz.csv",
                                       "results/history.csv", "results/reference/*",
                                       "results/schema/*",    "results/records/*"};
    bool kept = strncmp(name, "results/", 8) != 0;
    for (size_t i = 0; i < sizeof ours / sizeof ours[0]; ++i)
        kept = kept || fnmatch(ours[i], name, 0) == 0;
    return !kept || strstr(name, "/node_modules/") != NULL;
}

static int keep_file(const char *path, const struct stat *information, int type,
                     struct FTW *walk)
{
    (void)information, (void)walk;
    const char *name = path + strlen(MOTE_SOURCE_DIR) + 1;
    if (type != FTW_F || name[0] == '.' || strncmp(name, "build", 5) == 0 || is_made(name))
        return 0;
    if (file_count == sizeof files / sizeof files[0] || !(files[file_count] = strdup(name)))
        return -1;
    ++file_count;
    return 0;
}

static int find_files(void)
{
    char said[] = "/tmp/mote-test-documents-XXXXXX";
    const int file = mkstemp(said);
    if (file < 0 || close(file) != 0 || program_wait(program_start("--help-table", said)) != 0)
        return -1;
    program_read(said, help_table, sizeof help_table);
    program_read(MOTE_SOURCE_DIR "/Makefile", makefile, sizeof makefile);
    (void)unlink(said);
    return nftw(MOTE_SOURCE_DIR, keep_file, 16, FTW_PHYS);
}

static int free_files(void)
{
    while (file_count > 0)
        free(files[--file_count]);
    return 0;
}

TEST_GROUP(find_files, free_files);

static char *text_of(const char *name)
{
    enum { SIZE = 1 << 18 };
    char path[4096], *text = malloc(SIZE);
    assert_non_null(text);
    (void)snprintf(path, sizeof path, "%s/%s", MOTE_SOURCE_DIR, name);
    program_read(path, text, SIZE);
    return text;
}

static bool starts(const char *text, const char *with)
{
    return strncmp(text, with, strlen(with)) == 0;
}

/* Keeps only the code of a document: each line of a block, and each span, as a line. A span may
   continue on the next line. */
static void keep_code(char *text)
{
    char *end = text;
    bool block = false, fence = false, span = false;
    for (const char *c = text; *c; ++c) {
        const bool new_line = c == text || c[-1] == '\n';
        if (new_line && starts(c, "```"))
            fence = !fence, c += 2;
        else if (new_line)
            block = fence || (!span && starts(c, "    "));
        if (!block && *c == '`')
            span = !span, *end++ = '\n';
        else if (block || span)
            *end++ = *c == '\n' && !block ? ' ' : *c;
    }
    *end = '\0';
}

/* Called with what a document mentions and the text that follows it there. */
typedef void mention_check(const char *document, const char *mentioned, const char *rest);

/* Checks what the second group of a pattern matches in a text; the first is the text before
   it. */
static void each_match(const char *document, const char *text, const char *pattern,
                       mention_check *check)
{
    regex_t compiled;
    regmatch_t match[3];
    assert_int_equal(regcomp(&compiled, pattern, REG_EXTENDED | REG_NEWLINE), 0);
    while (regexec(&compiled, text, 3, match, 0) == 0) {
        char mentioned[512];
        const int length = (int)(match[2].rm_eo - match[2].rm_so);
        (void)snprintf(mentioned, sizeof mentioned, "%.*s", length, text + match[2].rm_so);
        text += match[2].rm_eo;
        check(document, mentioned, text);
    }
    regfree(&compiled);
}

static bool is_record(const char *name)
{
    return starts(name, "results/records/");
}

static bool is_document(const char *name)
{
    return fnmatch("*.md", name, 0) == 0 && !is_record(name);
}

/* The same for every document, or only for its code. */
static void each_mention(const char *pattern, bool code_only, mention_check *check)
{
    size_t documents = 0;
    missing = 0;
    for (size_t i = 0; i < file_count; ++i) {
        if (!is_document(files[i]))
            continue;
        char *text = text_of(files[i]);
        assert_true(*text);
        if (code_only)
            keep_code(text);
        each_match(files[i], text, pattern, check);
        free(text);
        ++documents;
    }
    assert_true(documents > 10);
    assert_int_equal(missing, 0);
}

static void complain(const char *document, const char *what, const char *name)
{
    ++missing;
    print_error("%s: %s %s does not exist\n", document, what, name);
}

/* Whether a heading of a text has this anchor: "A head: of `two` words" is a-head-of-two-words.
 */
static bool has_anchor(const char *text, const char *anchor)
{
    for (const char *line = strstr(text, "\n#"); line; line = strstr(line + 1, "\n#")) {
        char made[256];
        size_t length = 0;
        for (const char *c = strchr(line, ' ') + 1; *c != '\n' && length < 255; ++c)
            if (isalnum((unsigned char)*c) || *c == '-' || *c == '_' || *c == ' ')
                made[length++] = *c == ' ' ? '-' : (char)tolower((unsigned char)*c);
        made[length] = '\0';
        if (strcmp(made, anchor) == 0)
            return true;
    }
    return false;
}

static void check_link(const char *document, const char *target, const char *rest)
{
    char name[1024], path[4096];
    (void)rest;
    if (starts(target, "https://"))
        return;
    const char *anchor = strchr(target, '#'), *slash = strrchr(document, '/');
    (void)snprintf(name, sizeof name, "%.*s%.*s", slash ? (int)(slash - document) + 1 : 0,
                   document, (int)strcspn(target, "#"), target);
    if (anchor == target)
        (void)snprintf(name, sizeof name, "%s", document);
    (void)snprintf(path, sizeof path, "%s/%s", MOTE_SOURCE_DIR, name);
    if (access(path, F_OK) != 0) {
        complain(document, "the target of the link", target);
    } else if (anchor) {
        char *text = text_of(name);
        if (!has_anchor(text, anchor + 1))
            complain(document, "the heading", target);
        free(text);
    }
}

TEST(links_of_documents_lead_somewhere)
{
    each_mention("(\\]\\()([^) ]+)\\)", false, check_link);
}

/* A word in capitals within a name matches anything. */
static void make_pattern(const char *name, char *pattern, size_t size)
{
    size_t length = 0;
    for (const char *c = name; *c && length < size - 1;) {
        const size_t capitals = strspn(c, "ABCDEFGHIJKLMNOPQRSTUVWXYZ");
        const bool any = capitals > 1 && !starts(c, "README") && !starts(c, "CM");
        pattern[length++] = any ? '*' : *c;
        c += any ? capitals : 1;
    }
    pattern[length] = '\0';
}

/* Of a file or a folder; a name without a folder may be in any. */
static void check_file(const char *document, const char *name, const char *rest)
{
    char file[600], folder[600], anywhere[640];
    (void)rest;
    make_pattern(name, file, 512);
    const size_t length = strlen(file) - (file[strlen(file) - 1] == '/');
    (void)snprintf(folder, sizeof folder, "%.*s/*", (int)length, file);
    (void)snprintf(anywhere, sizeof anywhere, "*/%s", file);
    bool there = !is_ours(name);
    for (size_t i = 0; i < file_count && !there; ++i)
        there = fnmatch(file, files[i], 0) == 0 || fnmatch(folder, files[i], 0) == 0 ||
                (!strchr(name, '/') && fnmatch(anywhere, files[i], 0) == 0);
    if (!there)
        complain(document, "the file", name);
}

#define FOLDERS "(core|baselines|harness|datasets|docs|tests|plots|cmake|results)/"
#define SOURCE "[A-Za-z0-9_*-]+\\.(c|h|cpp|hpp|py|sh|gp|js|mjs|sbatch)\\>"

TEST(files_that_documents_mention_exist)
{
    each_mention("(^|[ (])(" FOLDERS "[A-Za-z0-9_./*-]*[A-Za-z0-9_/*])", true, check_file);
    each_mention("(^|[ (])(" SOURCE ")", true, check_file);
}

static void check_target(const char *document, const char *target, const char *rest)
{
    char line[600];
    (void)rest;
    (void)snprintf(line, sizeof line, "\n%s:", target);
    if (!strstr(makefile, line))
        complain(document, "the target of make", target);
}

TEST(targets_of_make_that_documents_mention_exist)
{
    each_mention("(^ *make )([a-z][a-z-]*)", true, check_target);
    missing = 0;
    each_match("Makefile", makefile, "(^#   make )([a-z][a-z-]*)", check_target);
    assert_int_equal(missing, 0);
}

/* The part of the help table about a command, up to the next one, or NULL. */
static const char *help_of(const char *command)
{
    char line[600];
    (void)snprintf(line, sizeof line, "command\t%s\t", command);
    return strstr(help_table, line);
}

static bool has_option(const char *command, const char *option)
{
    char line[600];
    (void)snprintf(line, sizeof line, "\noption\t%s\t", option);
    const char *help = command ? help_of(command) : help_table;
    const char *next = help && command ? strstr(help, "\ncommand\t") : NULL;
    const char *found = help ? strstr(help, line) : NULL;
    return found && (!next || found < next);
}

/* A command and the options after it in its line, up to a comment. */
static void check_command(const char *document, const char *command, const char *rest)
{
    char line[1024], *state = NULL;
    if (!help_of(command)) {
        complain(document, "the command", command);
        return;
    }
    (void)snprintf(line, sizeof line, "%.*s", (int)strcspn(rest, "#\n"), rest);
    for (char *word = strtok_r(line, " []()|=,.:", &state); word;
         word = strtok_r(NULL, " []()|=,.:", &state))
        if (starts(word, "--") && strcmp(word, "--plugin") != 0 && !has_option(command, word))
            complain(document, command, word);
}

TEST(commands_that_documents_mention_exist_and_have_their_options)
{
    each_mention("(\\<mote )([a-z][a-z-]*)", true, check_command);
}

/* An option of any command, of all (--help, --plugin), of none (`mote --allow DIR COMMAND`), or
   of Slurm's sbatch. */
static void check_option(const char *document, const char *option, const char *rest)
{
    static const char *const others[] = {"--allow",     "--help", "--plugin",
                                         "--partition", "--time", "--constraint"};
    bool known = has_option(NULL, option);
    (void)rest;
    for (size_t i = 0; i < sizeof others / sizeof others[0]; ++i)
        known = known || strcmp(option, others[i]) == 0;
    if (!known)
        complain(document, "the option", option);
}

TEST(options_that_documents_mention_exist)
{
    each_mention("(^)(--[a-z][a-z-]*)", true, check_option);
}

/* Whether a file may declare a name: documents and records may not. */
static bool is_source(const char *name)
{
    if (is_record(name))
        return false;
    static const char *const ends[] = {".c",   ".h",     ".cpp",  ".hpp",
                                       ".txt", ".cmake", ".json", ".sh"};
    const char *dot = strrchr(name, '.');
    for (size_t i = 0; dot && i < sizeof ends / sizeof ends[0]; ++i)
        if (strcmp(dot, ends[i]) == 0)
            return true;
    return false;
}

/* All sources, one after another. */
static char *sources;

static int read_sources(void)
{
    size_t size = 0;
    for (size_t i = 0; i < file_count; ++i) {
        if (!is_source(files[i]))
            continue;
        char *text = text_of(files[i]);
        sources = realloc(sources, size + strlen(text) + 1);
        assert_non_null(sources);
        memcpy(sources + size, text, strlen(text) + 1);
        size += strlen(text);
        free(text);
    }
    return size == 0;
}

/* A test, or a function shared by tests. */
static void check_test(const char *document, const char *test, const char *rest)
{
    char file[600], call[600];
    (void)rest;
    (void)snprintf(file, sizeof file, "%s.*", test); /* in C or Python */
    (void)snprintf(call, sizeof call, "%s(", test);
    if (!strstr(sources, call))
        check_file(document, file, rest);
}

TEST(tests_that_documents_mention_exist)
{
    assert_int_equal(read_sources(), 0);
    each_mention("(\\<)(test_[a-z0-9_]+)\\>", true, check_test);
    free(sources);
    sources = NULL;
}

/* Tests are checked by themselves; reports to other projects name what is theirs. */
static void check_name(const char *document, const char *name, const char *rest)
{
    (void)rest;
    if (is_ours(name) && !starts(name, "test_") && !starts(document, "docs/upstream/") &&
        !strstr(sources, name))
        complain(document, "the name", name);
}

TEST(names_of_the_code_that_documents_mention_exist)
{
    assert_int_equal(read_sources(), 0);
    each_mention("(\\<)(mote_[a-z0-9_]+|MOTE_[A-Z0-9_]+)\\>", true, check_name);
    each_mention("(^)([a-z][a-z0-9]*_[a-z0-9_]+)$", true, check_name);
    free(sources);
    sources = NULL;
}

/* A line that may belong to a comment: not an include line and nothing in quotes. */
static void check_comment(const char *source, const char *line, const char *rest)
{
    (void)rest;
    if (!strpbrk(line, "\"<$"))
        each_match(source, line,
                   "(^|[ (])(" FOLDERS "[A-Za-z0-9_./*-]*\\.(c|h|cpp|py|sh|md|json|txt))\\>",
                   check_file);
}

TEST(files_that_comments_mention_exist)
{
    missing = 0;
    for (size_t i = 0; i < file_count; ++i) {
        const char *dot = strrchr(files[i], '.');
        const bool script = strcmp(files[i], "Makefile") == 0 ||
                            (dot && (strcmp(dot, ".sh") == 0 || strcmp(dot, ".cmake") == 0 ||
                                     strcmp(dot, ".py") == 0 || strcmp(dot, ".gp") == 0));
        if (!script && !is_source(files[i]))
            continue;
        char *text = text_of(files[i]);
        each_match(files[i], text, script ? "(^)(.*#.*)$" : "(^)(.*\\*.*|.*//.*|   [^;]*)$",
                   check_comment);
        free(text);
    }
    assert_int_equal(missing, 0);
}

TEST(the_readme_is_a_front_page)
{
    char *text = text_of("README.md");
    assert_in_range(strlen(text), 1, 8192);
    free(text);
}
