#include "harness/command/answer_json.h"

json_t *mote_answer_json(const mote_answer *answer)
{
    json_t *row = json_object();
    if (answer->has_distance)
        (void)json_object_set_new(row, "distance", json_real(answer->distance));
    if (answer->has_lower)
        (void)json_object_set_new(row, "lower", json_real(answer->lower));
    if (answer->has_contact)
        (void)json_object_set_new(row, "contact", json_boolean(answer->contact));
    for (int i = 0; i < 2 && answer->has_witness; ++i) {
        const mote_vec3 p = answer->witness[i];
        (void)json_object_set_new(row, i ? "b" : "a", json_pack("[f,f,f]", p.x, p.y, p.z));
    }
    return row;
}
