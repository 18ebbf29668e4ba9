/* Any text as a scenario file. */
#include "harness/scene/scenario.h"
#include "tests/fuzz/fuzz.h"

#include <jansson.h>
#include <string.h>

/* Whether loading would legitimately take long: large letters, other files. */
static bool is_costly(json_t *value)
{
    const char *key;
    json_t *member;
    size_t index;
    bool costly = false;
    json_object_foreach(value, key, member)
    {
        costly = costly || strcmp(key, "file") == 0 || strcmp(key, "like") == 0 ||
                 strcmp(key, "character") == 0 ||
                 (strcmp(key, "triangles") == 0 && json_number_value(member) > 500) ||
                 is_costly(member);
    }
    json_array_foreach(value, index, member)
    {
        costly = costly || is_costly(member);
    }
    return costly;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    json_t *root = json_loadb((const char *)data, size, JSON_DECODE_INT_AS_REAL, NULL);
    const bool costly = is_costly(root);
    json_decref(root);
    mote_scenario *scenario = NULL;
    if (!costly && mote_scenario_load(fuzz_file(data, size), &scenario) == MOTE_OK) {
        mote_frame_buffer *buffer = mote_frame_buffer_create(scenario);
        (void)mote_scenario_frame(scenario, buffer, 1, 0);
        (void)mote_scenario_frame(scenario, buffer, scenario->frames, 1);
        mote_frame_buffer_destroy(buffer);
    }
    mote_scenario_destroy(scenario);
    return 0;
}
