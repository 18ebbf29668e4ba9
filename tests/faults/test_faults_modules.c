/* Modules that a command reaches only after long work, called directly while each place where
   they ask for memory or files fails once. */
#include "tests/faults/fault_lines.h"

#include "harness/study/claim.h"
#include "harness/base/file.h"
#include "harness/process/load.h"
#include "harness/process/manifest.h"
#include "harness/run/measure.h"
#include "harness/base/options.h"
#include "harness/base/record.h"
#include "harness/study/study.h"
#include "harness/run/truth.h"
#include "tests/support/test.h"

#include <fcntl.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <sys/stat.h>
#include <unistd.h>

static mote_scenario *scenario;

static int exit_code(mote_status status)
{
    return status == MOTE_OK ? MOTE_EXIT_DONE : mote_command_fail();
}

/* An invented truth of the scenario. */
static mote_status make_truth(mote_truth **truth)
{
    *truth = mote_truth_allocate(scenario->frames);
    for (uint32_t k = 0; k < scenario->frames; ++k) {
        (*truth)->distance[k] = 0.25 * k;
        (*truth)->contact[k] = k == 0;
    }
    return MOTE_OK;
}

static int keep_truth(int argc, char **argv)
{
    (void)argc;
    (void)argv;
    mote_truth *truth = NULL, *read = NULL;
    mote_status status = make_truth(&truth);
    if (status == MOTE_OK)
        status = mote_directory_make("out");
    if (status == MOTE_OK)
        status = mote_truth_write(scenario, truth, "out/truth.csv");
    if (status == MOTE_OK)
        status = mote_truth_read(scenario, truth->fingerprint, "out/truth.csv", &read);
    if (status == MOTE_OK && read->distance[3] != 0.75)
        status = mote_fail(MOTE_EINVAL, "another truth was read than was written");
    mote_truth_destroy(truth);
    mote_truth_destroy(read);
    return exit_code(status);
}

static int draw_study(int argc, char **argv)
{
    (void)argc;
    (void)argv;
    mote_study study;
    mote_text curve = {0};
    mote_status status = mote_study_open("out", true, &study);
    if (status == MOTE_OK) {
        mote_text_add(&curve, "\"a\"\n1 2 1 3\n");
        status = mote_study_plot(&study, "claim_d", &curve);
    }
    mote_study_close(&study);
    return exit_code(status);
}

static int vary_scene(int argc, char **argv)
{
    (void)argc;
    (void)argv;
    static const mote_variant variant = {"tt", "small", 'V', 400, false};
    const mote_subject *subject = NULL;
    mote_study study;
    mote_status status = mote_study_open("out", true, &study);
    if (status == MOTE_OK)
        status = mote_study_variant(&study, &variant, &subject);
    mote_study_close(&study);
    return exit_code(status);
}

static int sample_method(int argc, char **argv)
{
    (void)argc;
    (void)argv;
    mote_subject subject = {.scenario = scenario};
    mote_sample samples[2];
    mote_status status = make_truth(&subject.truth);
    if (status == MOTE_OK)
        status = mote_study_sample(&subject, "particle-paper:n=2", (mote_tour){.seed = 1}, 2,
                                   samples);
    mote_truth_destroy(subject.truth);
    return exit_code(status);
}

/* Measures a cell as its process does. Arguments: METHOD, then anything to ask for evicted
   caches. */
static int measure_cell(int argc, char **argv)
{
    const mote_subject subject = {.scenario = scenario};
    mote_method_choice choice;
    mote_cell_result result;
    mote_status status = mote_method_choice_read(argv[1], &choice);
    const mote_cell cell = {.subject = &subject,
                            .choice = &choice,
                            .replicate = 2,
                            .first = 1,
                            .last = 2,
                            .stride = 1,
                            .seed = 1,
                            .cache = argc > 2 ? MOTE_CACHE_EVICT : MOTE_CACHE_HOT,
                            .fixed_seed = argc > 2};
    if (status == MOTE_OK)
        status = mote_measure_cell(&cell, 0, &result);
    if (status == MOTE_OK)
        mote_cell_result_free(&result);
    return exit_code(status);
}

static int write_claim(int argc, char **argv)
{
    (void)argc;
    (void)argv;
    mote_claim claim = {.id = "x", .section = "3", .claim = "c", .measured = "m"};
    const mote_estimate estimate = {2, {1, 3}};
    mote_status status = mote_directory_make("out");
    for (int i = 0; status == MOTE_OK && i < 9; ++i)
        mote_claim_add(&claim, estimate, "L", "figure %d", i);
    if (status == MOTE_OK)
        status = mote_record_json("out", "claim.json", mote_claim_json(&claim));
    mote_claim_free(&claim);
    return exit_code(status);
}

/* The machine's name and state. It is no error if the system does not report them. */
static int ask_machine(int argc, char **argv)
{
    (void)argc;
    (void)argv;
    char name[MOTE_MACHINE_SIZE];
    mote_machine_name(name, sizeof name);
    const double busy = mote_busy_cores(), clock = mote_core_clock(0);
    return busy >= 0 && clock >= 0 && mote_load_average() >= 0 ? 0 : 1;
}

/* Writes to a stream, which must stay what it is, even where nobody can tell what it is. */
static int write_stream(int argc, char **argv)
{
    (void)argc;
    (void)argv;
    struct stat info;
    (void)unlink("fifo");
    if (mkfifo("fifo", 0600) != 0)
        return 77;
    const int reader = open("fifo", O_RDWR); /* NOLINT(android-cloexec-open) */
    if (reader < 0)                          /* then writing would wait for one */
        return exit_code(mote_fail(MOTE_EIO, "fifo: cannot be opened"));
    const mote_status status = mote_file_write("fifo", "x", 1);
    const bool stayed = lstat("fifo", &info) == 0 && S_ISFIFO(info.st_mode);
    (void)close(reader);
    return stayed ? exit_code(status) : 77;
}

TEST(modules_when_a_call_fails_say_so)
{
    static const fault_line list[] = {
        {"the truth", keep_truth, 0},    {"the study's figure", draw_study, 0},
        {"a variant", vary_scene, 0},    {"a claim's file", write_claim, 0},
        {"the machine", ask_machine, 0}, {"a stream", write_stream, 0}};
    FAIL_EACH(list);
}

TEST(modules_whose_memory_runs_out_end_with_a_line)
{
    static const fault_line list[] = {{"the truth", keep_truth, 0},
                                      {"a sample", sample_method, 0},
                                      {"cell fcl-aabb evict", measure_cell, 0},
                                      {"cell particle:positions=given", measure_cell, 0},
                                      {"a claim's file", write_claim, 0}};
    EXHAUST_EACH(list);
}

static int make_files(void)
{
    if (!fault_lines_open() || mote_scenario_load("s.json", &scenario) != MOTE_OK)
        return -1;
    return 0;
}

static int remove_files(void)
{
    mote_scenario_destroy(scenario);
    return fault_lines_close();
}

TEST_GROUP(make_files, remove_files);
