/* Reads a scenario file: bodies, frames, intervals, the question. */
#include "harness/scene/scenario_read.h"

#include "harness/scene/catalog.h"
#include "harness/scene/scenario_path.h"
#include "harness/base/file.h"
#include "harness/base/memory.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

const char *const mote_ask_names[] = {"distance", "contact", "impact", NULL};

static mote_status read_interval(const mote_json *root, const char *name, uint32_t frames,
                                 mote_interval *interval)
{
    mote_json node = mote_json_member(root, name);
    if (!node.value)
        return MOTE_OK;
    double ends[2];
    size_t size;
    mote_status status = mote_json_array(&node, 2, 2, &size);
    int64_t end[2] = {0, 0};
    for (size_t i = 0; i < 2 && status == MOTE_OK; ++i) {
        mote_json element = mote_json_element(&node, i);
        status = mote_json_integer(&element, 1, frames, &end[i]);
        ends[i] = (double)end[i];
    }
    if (status == MOTE_OK && end[0] > end[1])
        status = mote_json_fail(&node, "%g to %g is empty; give first and last frame", ends[0],
                                ends[1]);
    if (status == MOTE_OK)
        *interval = (mote_interval){(uint32_t)end[0], (uint32_t)end[1]};
    return status;
}

static mote_status read_ask(const mote_json *root, mote_ask *ask)
{
    mote_json node = mote_json_member(root, "ask");
    const char *word;
    mote_status status = mote_json_string(&node, &word);
    if (status != MOTE_OK)
        return status;
    for (int k = 0; mote_ask_names[k]; ++k) {
        if (strcmp(word, mote_ask_names[k]) == 0) {
            *ask = (mote_ask)k;
            return MOTE_OK;
        }
    }
    return mote_json_fail(&node, "%s is neither distance, contact nor impact", word);
}

/* "step": of questions about impacts, which need it. */
static mote_status read_step(const mote_json *root, mote_scenario *scenario)
{
    mote_json node = mote_json_member(root, "step"), ask = mote_json_member(root, "ask");
    if (scenario->ask != MOTE_ASK_IMPACT)
        return node.value ? mote_json_fail(&node, "a step is of scenarios that ask for impact")
                          : MOTE_OK;
    if (!node.value)
        return mote_json_fail(&ask,
                              "a scenario that asks for impact needs \"step\", the frames "
                              "that each question spans");
    if (scenario->frames < 2)
        return mote_json_fail(&ask, "one frame alone; an impact is between two of them");
    int64_t step = 0;
    const mote_status status = mote_json_integer(&node, 1, scenario->frames - 1, &step);
    scenario->step = (uint32_t)step;
    return status;
}

mote_status mote_scenario_ask_impacts(mote_scenario *scenario, uint32_t step)
{
    if (step < 1 || step >= scenario->frames)
        return mote_fail(MOTE_EINVAL,
                         "%s: a step of %u frames; it has %u frames, so that a step is 1 to %u",
                         scenario->name, step, scenario->frames, scenario->frames - 1);
    mote_scenario_path *path = NULL;
    if (mote_scenario_path_create(scenario, 1, &path) != MOTE_OK) {
        char *why = mote_duplicate(mote_error_text());
        const mote_status status = mote_fail(
            mote_error_status(), "%s: %s; ask for distance or contact", scenario->name, why);
        free(why);
        return status;
    }
    mote_scenario_path_destroy(path);
    scenario->ask = MOTE_ASK_IMPACT;
    scenario->step = step;
    return MOTE_OK;
}

mote_status mote_scenario_read_facts(const mote_json *root, mote_scenario *scenario)
{
    mote_json key = mote_json_member(root, "frames");
    int64_t frames = 0;
    mote_status status = mote_json_integer(&key, 1, MOTE_FRAMES_MAX, &frames);
    scenario->frames = (uint32_t)frames;
    if (status == MOTE_OK)
        status = read_interval(root, "warmup", scenario->frames, &scenario->warmup);
    if (status == MOTE_OK)
        status = read_interval(root, "active", scenario->frames, &scenario->active);
    if (status == MOTE_OK)
        status = read_ask(root, &scenario->ask);
    if (status == MOTE_OK)
        status = read_step(root, scenario);
    key = mote_json_member(root, "tolerance");
    if (status == MOTE_OK && key.value)
        status = mote_json_real(&key, 0, 1e3, &scenario->tolerance);
    key = mote_json_member(root, "start");
    scenario->motion->start = scenario->motion->pace = 1;
    if (status == MOTE_OK && key.value)
        status = mote_json_real(&key, 1, MOTE_FRAMES_MAX, &scenario->motion->start);
    key = mote_json_member(root, "pace");
    if (status == MOTE_OK && key.value)
        status = mote_json_real(&key, 1e-6, 1e6, &scenario->motion->pace);
    key = mote_json_member(root, "purpose");
    const char *purpose;
    if (status == MOTE_OK)
        status = mote_json_string(&key, &purpose);
    if (status == MOTE_OK)
        scenario->purpose = mote_duplicate(purpose);
    return status;
}

/* Whether two bodies of a file name the same mesh, so that it is made only once. */
static bool same_mesh(const mote_json *a, const mote_json *b)
{
    static const char *const keys[] = {"letter", "triangles", "file",
                                       "scale",  "character", "subdivide"};
    if (mote_json_member(a, "positions").value || mote_json_member(b, "positions").value)
        return false; /* the mesh of given positions keeps vertices that others weld */
    for (size_t i = 0; i < sizeof keys / sizeof keys[0]; ++i) {
        json_t *x = json_object_get(a->value, keys[i]);
        json_t *y = json_object_get(b->value, keys[i]);
        if (!x != !y || (x && !json_equal(x, y)))
            return false;
    }
    return true;
}

/* The last frame of the path that is shown, rounded up for a fractional pace. */
static uint32_t last_frame(const mote_scenario *scenario)
{
    const mote_motion *motion = scenario->motion;
    const double place = motion->start + (scenario->frames - 1.0) * motion->pace;
    return (uint32_t)fmin(ceil(place), MOTE_FRAMES_MAX);
}

/* Reads the meshes of both bodies; characters[i] is that of body i, or NULL. */
static mote_status read_meshes(const mote_json body[2], mote_scenario *scenario,
                               mote_character *characters[2])
{
    const bool same = same_mesh(&body[0], &body[1]);
    mote_status status = MOTE_OK;
    for (size_t i = 0; i < 2 && status == MOTE_OK; ++i) {
        mote_mesh *mesh = NULL;
        mote_body_motion *motion = &scenario->motion->body[i];
        const bool is_read = i == 0 || !same || mote_json_member(&body[1], "character").value;
        if (mote_json_member(&body[i], "positions").value)
            status = mote_scenario_read_positions(&body[i], last_frame(scenario), &mesh,
                                                  &motion->sequence);
        else if (is_read)
            status = mote_scenario_read_mesh(&body[i], &mesh, &characters[i]);
        if (i == 1 && same) {
            mote_mesh_destroy(mesh);
            scenario->body[1].mesh = scenario->body[0].mesh;
        } else {
            scenario->body[i].mesh = mesh;
        }
    }
    return status;
}

/* Reads the field and motion of a body whose mesh is known. */
static mote_status read_body(const mote_json *body, size_t i, mote_character *character,
                             mote_scenario *scenario)
{
    const mote_mesh *mesh = scenario->body[i].mesh;
    mote_motion *motion = scenario->motion;
    mote_body_motion *own = &motion->body[i];
    const double place = motion->start + (scenario->frames - 1.0) * motion->pace;
    mote_field *field = NULL;
    mote_status status = own->sequence
                             ? mote_field_create_given(&field)
                             : mote_scenario_read_field(body, mesh, character, &field, own);
    scenario->body[i].field = field;
    if (status == MOTE_OK)
        status =
            mote_scenario_read_motion(body, mesh, scenario->length, last_frame(scenario), own);
    if (status == MOTE_OK && own->player)
        mote_scenario_set_samples(own->player, motion->start, place, &scenario->body[i]);
    return status;
}

static mote_status read_bodies(const mote_json *root, mote_scenario *scenario)
{
    mote_json bodies = mote_json_member(root, "bodies");
    mote_json body[2];
    mote_character *characters[2] = {NULL, NULL};
    size_t size;
    mote_status status = mote_json_array(&bodies, 2, 2, &size);
    for (size_t i = 0; i < 2 && status == MOTE_OK; ++i) {
        body[i] = mote_json_element(&bodies, i);
        status =
            mote_scenario_check_body(&body[i], "letter|triangles|file|positions|scale|field|"
                                               "motion|velocity|spin|" MOTE_CHARACTER_KEYS);
    }
    if (status == MOTE_OK)
        status = read_meshes(body, scenario, characters);
    if (status == MOTE_OK)
        scenario->length =
            fmax(scenario->body[0].mesh->diagonal, scenario->body[1].mesh->diagonal);
    for (size_t i = 0; i < 2; ++i) {
        if (status == MOTE_OK)
            status = read_body(&body[i], i, characters[i], scenario);
        else
            mote_character_destroy(characters[i]);
    }
    return status;
}

char *mote_scenario_name_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    const char *base = slash ? slash + 1 : path;
    const size_t ending = mote_name_ends(base, ".json") ? strlen(".json") : 0;
    char *name = mote_format("%.*s", (int)(strlen(base) - ending), base);
    mote_scenario_clean_name(name);
    return name;
}

void mote_scenario_clean_name(char *name)
{
    for (char *p = name; *p; ++p) {
        if ((unsigned char)*p < ' ' || *p == 0x7f)
            *p = '_';
    }
}

static mote_status read_scenario(const mote_json_file *file, mote_scenario *scenario)
{
    mote_json root = mote_json_root(file);
    scenario->motion = mote_allocate(1, sizeof *scenario->motion);
    scenario->path = mote_duplicate(file->path);
    scenario->name = mote_scenario_name_of(file->path);
    mote_status status = mote_json_object(
        &root, "purpose|bodies|frames|start|pace|warmup|active|ask|step|tolerance");
    if (status == MOTE_OK)
        status = mote_scenario_read_facts(&root, scenario);
    if (status == MOTE_OK)
        status = read_bodies(&root, scenario);
    scenario->tolerance *= scenario->length;
    if (status == MOTE_OK && scenario->ask == MOTE_ASK_IMPACT) {
        const mote_json ask = mote_json_member(&root, "ask");
        status = mote_json_blame(&ask, mote_scenario_ask_impacts(scenario, scenario->step));
    }
    return status;
}

static bool is_path(const char *name)
{
    return strchr(name, '/') || mote_name_ends(name, ".json");
}

/* Fails for an unknown built-in scenario; the error lists those that exist. */
static mote_status unknown_name(const char *name)
{
    mote_catalog catalog;
    mote_status status = mote_catalog_read(&catalog);
    if (status != MOTE_OK)
        return status;
    mote_text known = {0};
    for (size_t i = 0; i < catalog.count; ++i)
        mote_text_add(&known, "%s%s", i ? ", " : "", catalog.entries[i].name);
    mote_catalog_free(&catalog);
    status = mote_fail(MOTE_EIO, "%s: no such scenario; known are: %s; or name a .json file",
                       name, known.data ? known.data : "none");
    free(known.data);
    return status;
}

static bool is_listed(const char *name)
{
    mote_catalog catalog;
    if (mote_catalog_read(&catalog) != MOTE_OK)
        return true; /* opening its file will report why */
    bool found = false;
    for (size_t i = 0; i < catalog.count; ++i)
        found = found || strcmp(catalog.entries[i].name, name) == 0;
    mote_catalog_free(&catalog);
    return found;
}

mote_status mote_scenario_read(const mote_json_file *file, mote_scenario **scenario)
{
    mote_scenario *made = mote_allocate(1, sizeof *made);
    const mote_status status = read_scenario(file, made);
    if (status == MOTE_OK)
        *scenario = made;
    else
        mote_scenario_destroy(made);
    return status;
}

bool mote_scenario_of_bodies(const mote_json_file *file)
{
    return json_is_object(json_object_get(file->root, "bodies"));
}

static mote_status open_pair(const char *name, mote_json_file *file)
{
    mote_scenario *scenario;
    mote_status status = mote_scenario_make_pair(name, file, &scenario);
    if (status == MOTE_OK)
        mote_scenario_destroy(scenario);
    return status;
}

mote_status mote_scenario_open(const char *name_or_path, mote_json_file *file)
{
    char *path;
    if (mote_scenario_is_pair(name_or_path))
        return open_pair(name_or_path, file);
    if (is_path(name_or_path))
        path = mote_duplicate(name_or_path);
    else if (!is_listed(name_or_path))
        return unknown_name(name_or_path);
    else
        path = mote_catalog_path(name_or_path);
    mote_json_file opened;
    mote_status status = mote_json_open(path, &opened);
    free(path);
    if (status != MOTE_OK)
        return status;
    status = mote_scenario_merge_like(&opened);
    if (status == MOTE_OK)
        *file = opened;
    else
        mote_json_close(&opened);
    return status;
}

mote_status mote_scenario_load(const char *name_or_path, mote_scenario **scenario)
{
    if (mote_scenario_is_pair(name_or_path))
        return mote_scenario_make_pair(name_or_path, NULL, scenario);
    mote_json_file file = {0};
    mote_status status = mote_scenario_open(name_or_path, &file);
    if (status != MOTE_OK)
        return status;
    assert(file.path); /* it was opened */
    mote_json root = mote_json_root(&file);
    mote_json bodies = mote_json_member(&root, "bodies");
    if (mote_scenario_of_bodies(&file))
        status =
            mote_json_fail(&bodies, "several bodies, where two are needed; name a scenario "
                                    "of two bodies");
    else
        status = mote_scenario_read(&file, scenario);
    mote_json_close(&file);
    return status;
}
