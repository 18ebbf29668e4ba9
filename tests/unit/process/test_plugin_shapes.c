/* Shared libraries that offer something else than sound methods and fields, each in its own way
   (support/plugins/shaped.c), and how many there may be. */
#include "tests/support/folder.h"
#include "tests/support/mote.h"
#include "tests/support/test.h"

#include "core/base/parameter.h"
#include "harness/base/memory.h"
#include "harness/process/plugin.h"

#include <jansson.h>
#include <stdlib.h>
#include <string.h>

static void set_shape(const char *shape)
{
    assert_int_equal(setenv("MOTE_SHAPE", shape, 1), 0);
}

TEST_EACH(folder_next, NULL);

TEST(a_sound_library_is_listed_with_its_parameters)
{
    set_shape("sound");
    mote_expect(0, "length=2.5  a length", "list methods --plugin " MOTE_SHAPED);
    assert_non_null(strstr(said, "kind_2=two  a kind (one|two)"));
    mote_expect(0, "shaped-2: one line", "list fields --plugin " MOTE_SHAPED);
}

TEST(what_a_library_offers_is_checked)
{
    static const char name[] = "item 1: a name is a lower-case letter, then letters, digits",
                      summary[] = "shaped-1: its summary is not one line of up to 400";
    static const struct {
        const char *shape, *says;
    } rows[] = {
        {"items-missing", "no method and no field in it"},
        {"items-none", "no method and no field in it"},
        {"items-many", "65 methods and fields; at most 64"},
        {"item-missing", "item 1 is neither a method nor a field"},
        {"item-kind", "item 2 is neither a method nor a field"},
        {"field-size", "compiled against headers of another mote"},
        {"name-missing", name},
        {"name-empty", name},
        {"name-digit", name},
        {"name-long", name},
        {"name-mark", name},
        {"field-name", "item 2: a name is a lower-case letter"},
        {"summary-missing", summary},
        {"summary-empty", summary},
        {"summary-long", summary},
        {"summary-bytes", "shaped-1: a text of it is not UTF-8"},
        {"key", "shaped-1: the key of a parameter is a lower-case letter"},
        {"kind", "shaped-1: parameter length is of an unknown kind"},
        {"choices-missing", "shaped-1: parameter kind_2 is a choice without choices"},
        {"minimum", "shaped-1: parameter length ranges from -1 to 8"},
        {"help", "shaped-1: parameter length needs a default and a line of help"},
        {"fallback-missing", "shaped-1: parameter length needs a default and a line of help"},
        {"parameters-many", "shaped-1: 33 parameters; at most 32"},
        {"parameters-missing", "shaped-1: 2 parameters; at most 32, and a table of them"},
        {"field-create", "shaped-2: has no function create"},
        {"methods-17", "more than 16 methods from libraries"},
        {"fields-17", "more than 16 kinds of fields from libraries"},
    };
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        test_row("%s", rows[i].shape);
        set_shape(rows[i].shape);
        mote_expect(4, rows[i].says, "list methods --plugin " MOTE_SHAPED);
        assert_int_equal(strncmp(said, "mote: " MOTE_SHAPED, strlen("mote: " MOTE_SHAPED)), 0);
    }
    mote_expect(4, "no method and no field in it", "list methods --plugin " MOTE_NO_PLUGIN);
}

TEST(there_are_at_most_16_libraries)
{
    static const char option[] = " --plugin " MOTE_SHAPED;
    char line[(MOTE_PLUGINS_MAX + 1) * sizeof option] = "";
    set_shape("numbered");
    for (int i = 0; i < MOTE_PLUGINS_MAX; ++i)
        strcat(line, option);
    mote_expect(0, "shaped-1-16: one line", "list methods%s", line);
    strcat(line, option);
    mote_expect(4, "more than 16 libraries", "list methods%s", line);
}

#define SCENARIO                                                                               \
    "{\"purpose\": \"p\", \"frames\": 2, \"ask\": \"distance\", \"bodies\": [{\"letter\": "    \
    "\"T\", \"triangles\": 400}, {\"letter\": \"T\", \"triangles\": 400%s, \"motion\": "       \
    "[{\"frame\": 1, \"position\": [3, 0, 0]}, {\"frame\": 2, \"position\": [2.5, 0, "         \
    "0]}]}]}"
#define FIELD                                                                                  \
    ", \"field\": {\"kind\": \"shaped-2\", \"displacement\": {\"keyframes\": [{\"frame\": "    \
    "1, \"vectors\": [[0, 0, 0]]}]}}"

/* It was sound when it was asked, and is not when it is used. */
TEST(a_library_that_changes_costs_its_cells)
{
    char text[1024];
    (void)snprintf(text, sizeof text, SCENARIO, "");
    file_put("plain.json", text);
    set_shape("once");
    mote_expect(
        4, "no method and no field in it",
        "run plain.json --replicates 1 --method shaped-1 --out r --plugin " MOTE_SHAPED);
    (void)snprintf(text, sizeof text, SCENARIO, FIELD);
    file_put("field.json", text);
    assert_int_equal(folder_remove("asked"), 0);
    mote_expect(4, "no method and no field in it", "check field.json --plugin " MOTE_SHAPED);
}

/* What was planned is not looked for at its number in another library. */
TEST(a_library_that_is_built_again_during_a_run_is_refused)
{
    static const struct {
        const char *shape, *says;
    } rows[] = {
        {"later-fewer", "offers other methods, fields or parameters than when this command"},
        {"later-kind", "offers other methods, fields or parameters"},
        {"later-size", "compiled against headers of another mote"},
        {"later-name", "offers other methods, fields or parameters"},
        {"later-parameters", "offers other methods, fields or parameters"},
    };
    char text[1024];
    (void)snprintf(text, sizeof text, SCENARIO, FIELD);
    file_put("field.json", text);
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        test_row("%s", rows[i].shape);
        set_shape(rows[i].shape);
        mote_expect(4, rows[i].says, "check field.json --plugin " MOTE_SHAPED);
        assert_non_null(strstr(said, MOTE_SHAPED ": "));
        assert_int_equal(folder_remove("asked"), 0);
    }
}

/* One library, loaded once, makes a method and a field. */
TEST(a_field_that_cannot_be_made_is_an_error_of_the_scenario)
{
    char text[1024];
    (void)snprintf(text, sizeof text, SCENARIO, FIELD);
    file_put("field.json", text);
    set_shape("sound");
    mote_expect(4, "no such field today", "check field.json --plugin " MOTE_SHAPED);
}

/* A method that fails in its second frame: what it says reaches the user, wherever it runs. */
TEST(a_method_that_fails_in_a_frame_says_why)
{
    static const struct {
        const char *shape, *says, *cell, *simulation; /* how they end */
        int run, simulate;
    } rows[] = {
        {"query-refuses", "the query refuses", "unsupported: ", "unsupported: ", 0, 0},
        {"query-fails", "the query fails", "", "", 4, 4},
        {"update-fails", "the update fails", "crashed: ", "crashed: ", 5, 5},
    };
    char text[1024];
    (void)snprintf(text, sizeof text, SCENARIO, "");
    file_put("plain.json", text);
    file_put("requests", "cell\tplain.json\t1\t2\thot\t1\t0\tshaped-1\n"
                         "run\t0\t1\t2\nrun\t0\t1\t1\nanswers\t0\n");
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        test_row("%s", rows[i].shape);
        set_shape(rows[i].shape);
        mote_expect(rows[i].run, rows[i].says,
                    "run plain.json --replicates 1 --method shaped-1 --out r-%zu "
                    "--plugin " MOTE_SHAPED,
                    i);
        assert_non_null(strstr(said, rows[i].cell));
        mote_expect(rows[i].simulate, rows[i].says,
                    "simulate plain.json --method shaped-1 --out s-%zu --plugin " MOTE_SHAPED,
                    i);
        assert_non_null(strstr(said, rows[i].simulation));
        mote_expect(4, rows[i].says,
                    "simulate plain.json --method shaped-1 --plugin " MOTE_SHAPED);
        mote_expect(0, "no\tframe 2: the method failed",
                    "race-child --plugin " MOTE_SHAPED " < requests");
    }
}

/* Memory that runs out is no fault of the method: the simulation is not kept as crashed, and is
   simulated again by the same command. */
TEST(a_simulation_whose_memory_runs_out_is_simulated_again)
{
    static const char simulate[] = "simulate plain.json --method certified --method shaped-1 "
                                   "--jobs 1 --out s --plugin " MOTE_SHAPED;
    char text[1024];
    (void)snprintf(text, sizeof text, SCENARIO, "");
    file_put("plain.json", text);
    set_shape("update-lacks-memory");
    mote_expect(6, "no memory for the update", "%s", simulate);
    assert_null(strstr(said, "crashed"));
    assert_int_equal(folder_count("s/simulations", ".json"), 1); /* certified's */
    set_shape("sound");
    mote_expect(0, "plan: 2 simulations, 1 of them done", "%s", simulate);
}
