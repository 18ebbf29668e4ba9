/* Reads "positions" of a body: numbered meshes, or a point cache with a mesh. */
#include "harness/scene/scenario_read.h"

#include "harness/base/file.h"
#include "harness/sequence/sequence.h"

#include <stdlib.h>

static mote_status open_files(const mote_json *body, const char *path, uint32_t last,
                              mote_sequence **sequence, mote_mesh **mesh, mote_import *import)
{
    if (mote_json_member(body, "file").value || mote_json_member(body, "letter").value)
        return mote_json_fail(body, "numbered files bring their own mesh; leave out file and "
                                    "letter, or give positions as .pc2 or .mdd");
    return mote_sequence_open_files(path, last, sequence, mesh, import);
}

static mote_status open_cache(const mote_json *body, const char *path, uint32_t last,
                              mote_sequence **sequence, mote_mesh **mesh, mote_import *import)
{
    const mote_json file = mote_json_member(body, "file");
    if (!file.value) {
        mote_status status = mote_scenario_read_plain(body, mesh);
        return status == MOTE_OK
                   ? mote_sequence_open_cache(path, NULL, last, sequence, mesh, import)
                   : status;
    }
    if (mote_json_member(body, "letter").value)
        return mote_json_fail(body, "a letter and a file; give one of them with the cache");
    char *beside = NULL;
    mote_status status = mote_scenario_file_path(&file, &beside);
    if (status == MOTE_OK)
        status = mote_sequence_open_cache(path, beside, last, sequence, mesh, import);
    free(beside);
    return status;
}

mote_status mote_scenario_read_positions(const mote_json *body, uint32_t last, mote_mesh **mesh,
                                         mote_sequence **sequence)
{
    const mote_json node = mote_json_member(body, "positions");
    const mote_json scale = mote_json_member(body, "scale");
    char *path = NULL;
    mote_import import = {0};
    if (mote_json_member(body, "field").value || mote_json_member(body, "character").value)
        return mote_json_fail(body,
                              "either a field, a character or positions; give one of them");
    mote_status status = mote_scenario_file_path(&node, &path);
    if (status == MOTE_OK)
        status = mote_sequence_is_cache(path)
                     ? open_cache(body, path, last, sequence, mesh, &import)
                     : open_files(body, path, last, sequence, mesh, &import);
    if (status == MOTE_OK)
        mote_import_tell_split(path, &import);
    free(path);
    if (status == MOTE_OK && scale.value)
        status = mote_scenario_scale(&scale, mesh, &(*sequence)->scale);
    return mote_json_blame(&node, status);
}
