/* mote run --until-ci: further replicates of what is not known precisely, and of the method
   that ratios are relative to; and what mote merge makes of manifests. */
#include "tests/support/folder.h"
#include "tests/support/mote.h"
#include "tests/support/test.h"

#define RUN                                                                                    \
    "run plain.json --method fcl-aabb --method certified --replicates 1 --stride 1 --out r "

static int put_files(void)
{
    file_put(
        "plain.json",
        "{\"purpose\": \"p\", \"frames\": 5, \"ask\": \"distance\", \"bodies\": "
        "[{\"letter\": \"T\", \"triangles\": 400}, {\"letter\": \"T\", \"triangles\": 400, "
        "\"motion\": [{\"frame\": 1, \"position\": [8, 0, 0]}, {\"frame\": 5, "
        "\"position\": [2, 0, 0]}]}]}");
    return 0;
}

TEST_GROUP(put_files, NULL);

static int cells_of(const char *method)
{
    char command[128];
    (void)snprintf(command, sizeof command, "ls r/cells | grep -c -- '-%s-.*json' > count",
                   method);
    (void)system(command);
    char *text = file_text("count");
    const int count = atoi(text);
    free(text);
    return count;
}

TEST(run_until_ci_adds_replicates_of_what_is_wide_and_of_fcl)
{
    mote_expect(0, "plan: 2 cells, 0 of them done", RUN "--until-ci 5%% --dry-run");
    assert_null(strstr(said, "interval"));
    mote_expect(0, "after 1 replicates the widest interval is +-inf %, wider than asked for",
                RUN "--until-ci 5%% --budget 0");
    assert_int_equal(cells_of("certified"), 1);
    mote_expect(0, "replicates the widest interval is", RUN "--until-ci 95%% --budget 10");
    assert_true(cells_of("certified") >= 2);
    assert_true(cells_of("fcl-aabb") >= cells_of("certified"));
}

TEST(merge_refuses_a_manifest_without_sessions)
{
    mote_expect(0, "", "run plain.json --method certified --replicates 1 --frames 1-2 --out a");
    mote_expect(0, "1 cells copied", "merge m a");
    mote_expect(0, "0 cells copied, 1 were there", "merge m a");
    assert_int_equal(system("sed -i 's/\"sessions\"/\"others\"/' m/manifest.json"), 0);
    mote_expect(4, "m/manifest.json: no list of sessions; remove it", "merge m a");
}
