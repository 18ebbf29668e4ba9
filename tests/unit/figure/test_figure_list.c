/* results/README.md names every figure that the program draws, with the command that measures
   its data: compared with figures.json, and with the scripts in plots/. */
#include "harness/base/file.h"
#include "harness/base/record.h"
#include "tests/support/folder.h"
#include "tests/support/mote.h"
#include "tests/support/test.h"

#include <stddef.h>

#include <dirent.h>

static char *readme;

static int make_run(void)
{
    readme = file_text(MOTE_SOURCE_DIR "/results/README.md");
    return mote(
               "run tt --frames 1-20 --replicates 2 --method fcl-aabb --method certified --out "
               "run") ||
           mote("figures run");
}

static int free_readme(void)
{
    free(readme);
    return 0;
}

TEST_GROUP(make_run, free_readme);

/* The line of README about a figure: "| 4 | `front-SCENARIO` | ...", or NULL. */
static const char *line_of(int number, const char *name)
{
    char exact[128], each[128];
    (void)snprintf(exact, sizeof exact, "\n| %d | `%s` |", number, name);
    (void)snprintf(each, sizeof each, "\n| %d | `%s-SCENARIO` |", number, name);
    const char *line = strstr(readme, exact);
    return line ? line : strstr(readme, each);
}

TEST(every_drawn_figure_is_in_the_readme)
{
    size_t i;
    const json_t *figure;
    json_t *list;
    assert_int_equal(mote_record_read_json("run", "figures/figures.json", &list), MOTE_OK);
    assert_true(json_array_size(json_object_get(list, "figures")) > 0);
    MOTE_EACH(i, figure, json_object_get(list, "figures"))
    {
        const int number = (int)json_integer_value(json_object_get(figure, "number"));
        char name[64];
        (void)snprintf(name, sizeof name, "%s",
                       json_string_value(json_object_get(figure, "name")));
        char *scenario = strstr(name, "-tt");
        if (scenario)
            *scenario = '\0';
        if (!line_of(number, name))
            fail_msg("figure %d, %s, has no line in results/README.md", number, name);
    }
    json_decref(list);
}

/* README also gives the command; OUT=DIR stands for this run. */
TEST(every_figure_not_drawn_is_in_the_readme_with_its_command)
{
    size_t i;
    const json_t *figure;
    json_t *list;
    assert_int_equal(mote_record_read_json("run", "figures/figures.json", &list), MOTE_OK);
    assert_true(json_array_size(json_object_get(list, "not_drawn")) > 6);
    MOTE_EACH(i, figure, json_object_get(list, "not_drawn"))
    {
        const int number = (int)json_integer_value(json_object_get(figure, "number"));
        const char *name = json_string_value(json_object_get(figure, "name"));
        char command[256], ending[300];
        (void)snprintf(command, sizeof command, "%s",
                       json_string_value(json_object_get(figure, "command")));
        char *directory = strstr(command, "run");
        if (directory)
            (void)strcpy(directory, "DIR");
        (void)snprintf(ending, sizeof ending, "| `%s` |\n", command);
        const char *line = line_of(number, name);
        if (!line)
            fail_msg("figure %d, %s, has no line in results/README.md", number, name);
        const char *end = strchr(line + 1, '\n') + 1;
        if (strncmp(end - strlen(ending), ending, strlen(ending)) != 0)
            fail_msg("figure %d, %s: results/README.md does not say %s", number, name, command);
    }
    json_decref(list);
}

/* The program does not list figures that other commands draw, but plots/NAME.gp exists. */
TEST(every_script_that_draws_is_in_the_readme)
{
    static const char *const shared[] = {"draw", "style", "solid"};
    size_t scripts = 0;
    DIR *folder = opendir(MOTE_SOURCE_DIR "/plots");
    assert_non_null(folder);
    for (const struct dirent *entry; (entry = readdir(folder)) != NULL;) {
        char name[64], quoted[80], each[96];
        bool helper = false;
        if (!mote_name_ends(entry->d_name, ".gp"))
            continue;
        (void)snprintf(name, sizeof name, "%.*s", (int)strlen(entry->d_name) - 3,
                       entry->d_name);
        for (size_t k = 0; k < sizeof shared / sizeof shared[0]; ++k)
            helper = helper || strcmp(shared[k], name) == 0;
        (void)snprintf(quoted, sizeof quoted, "`%s`", name);
        (void)snprintf(each, sizeof each, "`%s-SCENARIO`", name);
        if (!helper && !strstr(readme, quoted) && !strstr(readme, each))
            fail_msg("plots/%s.gp draws a figure that results/README.md does not name", name);
        ++scripts;
    }
    (void)closedir(folder);
    assert_true(scripts > 20);
}
