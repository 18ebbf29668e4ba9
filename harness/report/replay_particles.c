/* Finds the particles of a track, which cells do not store. */
#include "harness/figure/particle_places.h"
#include "harness/report/replay.h"

mote_status mote_replay_particles(mote_replay_scene *scene, mote_replay_track *track)
{
    mote_particle_places places;
    mote_status status = mote_particle_places_find(scene->scenario, track->row->label,
                                                   track->cell, track->rows, &places);
    track->particles = places.count;
    track->place = places.at;
    if (status == MOTE_OK && places.why[0]) {
        char *text = mote_format("particles of %s: %s", track->row->label, places.why);
        (void)json_array_append_new(scene->notes, json_string(text));
        free(text);
    }
    return status;
}
