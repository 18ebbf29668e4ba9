/* An answer as JSON. */
#ifndef MOTE_HARNESS_ANSWER_JSON_H
#define MOTE_HARNESS_ANSWER_JSON_H

#include "core/method/method.h"

#include <jansson.h>

/* {"distance", "lower", "contact", "a", "b"}, without what the method does not give. */
json_t *mote_answer_json(const mote_answer *answer);

#endif
