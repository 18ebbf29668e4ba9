/* mote check SCENARIO [--json] [--out DIR]: its fingerprint, and whether its active interval
   holds. */
#include "harness/command/command.h"
#include "harness/base/options.h"
#include "harness/base/record.h"
#include "harness/run/active.h"
#include "harness/run/scene_check.h"

#include <inttypes.h>
#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>

typedef struct scenario_facts {
    uint64_t fingerprint, faces;
    uint32_t contacts;        /* frames */
    uint32_t active_frames;   /* 0: the scenario names none */
    uint32_t active_contacts; /* frames of these */
    uint32_t active_near;
    bool active_holds;
    uint32_t checked;
    double smallest, largest; /* distance, of L */
    mote_interval longest;    /* the longest interval that may be called active */
} scenario_facts;

static void gather_facts(const mote_scenario *scenario, const mote_truth *truth,
                         scenario_facts *facts)
{
    facts->checked = truth->checked;
    facts->smallest = facts->largest = truth->distance[0] / scenario->length;
    for (uint32_t k = 0; k < truth->frames; ++k) {
        const double distance = truth->distance[k] / scenario->length;
        facts->smallest = distance < facts->smallest ? distance : facts->smallest;
        facts->largest = distance > facts->largest ? distance : facts->largest;
        facts->contacts += truth->contact[k];
        if (k + 1 < scenario->active.first || k + 1 > scenario->active.last)
            continue;
        ++facts->active_frames;
        facts->active_contacts += truth->contact[k];
    }
    facts->active_near = mote_active_near(scenario, truth, scenario->active);
    facts->active_holds = mote_active_holds(scenario, truth, scenario->active);
    facts->longest = mote_active_longest(scenario, truth);
}

static int print_json(const mote_scenario *scenario, const scenario_facts *facts)
{
    char fingerprint[32], faces[32];
    (void)snprintf(fingerprint, sizeof fingerprint, "%016" PRIx64, facts->fingerprint);
    (void)snprintf(faces, sizeof faces, "%016" PRIx64, facts->faces);
    json_t *root = json_pack(
        "{s:s, s:s, s:s, s:i, s:i, s:i, s:f, s:f, s:[i,i], s:[i,i]}", "scenario",
        scenario->name, "fingerprint", fingerprint, "faces", faces, "frames", scenario->frames,
        "checked", facts->checked, "contacts", facts->contacts, "smallest", facts->smallest,
        "largest", facts->largest, "active", scenario->active.first, scenario->active.last,
        "longest_active", facts->longest.first, facts->longest.last);
    if (root && facts->active_frames > 0) {
        (void)json_object_set_new(root, "active_contacts",
                                  json_integer(facts->active_contacts));
        (void)json_object_set_new(root, "active_near", json_integer(facts->active_near));
        (void)json_object_set_new(root, "active_holds", json_boolean(facts->active_holds));
    }
    return mote_json_put(root, JSON_INDENT(2), stdout) == MOTE_OK ? MOTE_EXIT_DONE
                                                                  : mote_command_fail();
}

static void print_lines(const mote_scenario *scenario, const scenario_facts *facts)
{
    (void)printf("%s: fingerprint %016" PRIx64 "\n", scenario->name, facts->fingerprint);
    (void)printf("%s: faces %016" PRIx64 "\n", scenario->name, facts->faces);
    (void)printf("%u frames, truth from %.4g to %.4g L, contact in %u (%.1f %%)\n",
                 scenario->frames, facts->smallest, facts->largest, facts->contacts,
                 100.0 * facts->contacts / scenario->frames);
    (void)printf("%u frames checked by brute force\n", facts->checked);
    if (facts->active_frames > 0)
        (void)printf(
            "active %u-%u: truth <= %g L in %.1f %% of frames (needed: %g %%), contact "
            "in %.1f %%\n",
            scenario->active.first, scenario->active.last, MOTE_ACTIVE_NEAR,
            100.0 * facts->active_near / facts->active_frames, 100 * MOTE_ACTIVE_SHARE,
            100.0 * facts->active_contacts / facts->active_frames);
    if (facts->longest.first > 0)
        (void)printf("longest interval that is active: %u-%u\n", facts->longest.first,
                     facts->longest.last);
}

/* With a directory, the truth is read from it or written to it. */
static mote_status find_truth(const mote_scenario *scenario, const char *directory,
                              uint64_t *fingerprint, mote_truth **truth)
{
    if (directory) {
        mote_status status = mote_truth_load_or_compute(scenario, directory, truth);
        if (status == MOTE_OK)
            *fingerprint = (*truth)->fingerprint;
        return status;
    }
    mote_status status = mote_scenario_fingerprint(scenario, fingerprint);
    return status == MOTE_OK ? mote_truth_compute(scenario, truth) : status;
}

static int check(const char *name, bool json, const char *directory)
{
    mote_scenario *scenario;
    if (mote_scenario_load(name, &scenario) != MOTE_OK)
        return mote_command_fail();
    scenario_facts facts = {.faces = mote_scenario_faces(scenario)};
    mote_truth *truth = NULL;
    mote_status status = find_truth(scenario, directory, &facts.fingerprint, &truth);
    int code;
    if (status == MOTE_OK) {
        gather_facts(scenario, truth, &facts);
        code = MOTE_EXIT_DONE;
        if (json)
            code = print_json(scenario, &facts);
        else
            print_lines(scenario, &facts);
        if (code == MOTE_EXIT_DONE && !facts.active_holds) {
            (void)fprintf(stderr,
                          "mote: %s: active %u-%u: only %u of %u frames have truth <= %g L; "
                          "name an interval in which at least %g %% have\n",
                          scenario->path, scenario->active.first, scenario->active.last,
                          facts.active_near, facts.active_frames, MOTE_ACTIVE_NEAR,
                          100 * MOTE_ACTIVE_SHARE);
            code = MOTE_EXIT_CHECK_FAILED;
        }
    } else {
        code = mote_command_fail();
        /* The bodies could be read, so a disagreement of two exact methods is a failed
           check. */
        code = status == MOTE_ENUMERIC ? MOTE_EXIT_CHECK_FAILED : code;
    }
    mote_truth_destroy(truth);
    mote_scenario_destroy(scenario);
    return mote_command_finish(code);
}

static int print_scene_json(const mote_subject *subject, const mote_scene_facts *facts)
{
    const mote_bodies *bodies = subject->bodies;
    char fingerprint[32], faces[32];
    (void)snprintf(fingerprint, sizeof fingerprint, "%016" PRIx64, subject->fingerprint);
    (void)snprintf(faces, sizeof faces, "%016" PRIx64, subject->faces);
    json_t *root = json_pack("{s:s, s:s, s:s, s:I, s:I, s:I, s:I, s:I, s:f}", "scenario",
                             bodies->name, "fingerprint", fingerprint, "faces", faces, "bodies",
                             (json_int_t)bodies->count, "frames", (json_int_t)bodies->frames,
                             "checked", (json_int_t)facts->checked, "contacts",
                             (json_int_t)facts->contacts, "pair_contacts",
                             (json_int_t)facts->pair_contacts, "near_pairs", facts->near_pairs);
    return mote_json_put(root, JSON_INDENT(2), stdout) == MOTE_OK ? MOTE_EXIT_DONE
                                                                  : mote_command_fail();
}

/* Checks more than two bodies: brute force judges some of certified's answers, and there is no
   active interval. */
static int check_scene(const char *name, bool json)
{
    mote_subject subject = {0};
    mote_scene_facts facts;
    mote_status status = mote_subject_load(name, &subject);
    if (status == MOTE_OK)
        status = mote_scene_check(&subject, &facts);
    int code = status == MOTE_OK ? MOTE_EXIT_DONE : mote_command_fail();
    /* As for two bodies, a disagreement is a failed check. */
    code = status == MOTE_ENUMERIC ? MOTE_EXIT_CHECK_FAILED : code;
    if (status == MOTE_OK && json) {
        code = print_scene_json(&subject, &facts);
    } else if (status == MOTE_OK) {
        const mote_bodies *bodies = subject.bodies;
        (void)printf("%s: fingerprint %016" PRIx64 "\n", bodies->name, subject.fingerprint);
        (void)printf("%s: faces %016" PRIx64 "\n", bodies->name, subject.faces);
        (void)printf("%u bodies, %u frames, %.4g near pairs a frame, contact in %u frames\n",
                     bodies->count, bodies->frames, facts.near_pairs, facts.contacts);
        (void)printf("%u near pairs checked by brute force\n", facts.checked);
    }
    mote_subject_free(&subject);
    return mote_command_finish(code);
}

const mote_option mote_options_check[] = {
    {"json", NULL, "as JSON (default: as text)"},
    {"out", "DIR",
     "keep the exact distances of two bodies in DIR/truth, or read them there (default: "
     "neither)"},
    {NULL, NULL, NULL}};

int mote_command_check(int argc, char **argv)
{
    mote_option_reader reader = mote_option_begin(mote_options_check, argc, argv);
    const char *name = NULL, *directory = NULL, *value;
    bool json = false;
    for (int option; (option = mote_option_next(&reader, &value)) != MOTE_OPTION_END;) {
        if (option == MOTE_OPTION_ERROR)
            return MOTE_EXIT_USAGE;
        if (option == MOTE_OPTION_PLAIN && name)
            return mote_command_usage("check", "%s: one scenario at a time", value);
        if (option == MOTE_OPTION_PLAIN)
            name = value;
        else if (option == 0)
            json = true;
        else
            directory = value;
    }
    if (!name)
        return mote_command_usage("check", "no scenario; write `mote check SCENARIO`");
    return mote_bodies_is(name) ? check_scene(name, json) : check(name, json, directory);
}
