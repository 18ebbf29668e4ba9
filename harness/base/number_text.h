/* Figures as a person reads them: three digits and a unit; "-" for MOTE_NONE. */
#ifndef MOTE_HARNESS_NUMBER_TEXT_H
#define MOTE_HARNESS_NUMBER_TEXT_H

#include <stdint.h>

#define MOTE_NUMBER_TEXT 24

/* Writes into text and returns text, or returns a constant. */
typedef const char *(*mote_number_show)(double value, char text[MOTE_NUMBER_TEXT]);

const char *mote_show_time(double ns, char text[MOTE_NUMBER_TEXT]);       /* "7.42 us" */
const char *mote_show_ratio(double value, char text[MOTE_NUMBER_TEXT]);   /* "41.3" */
const char *mote_show_percent(double share, char text[MOTE_NUMBER_TEXT]); /* "99.1 %" */
const char *mote_show_error(double error, char text[MOTE_NUMBER_TEXT]);   /* "1.2e-03" */
const char *mote_show_count(double value, char text[MOTE_NUMBER_TEXT]);   /* "12.5" */
const char *mote_show_bytes(double bytes, char text[MOTE_NUMBER_TEXT]);   /* "61.2 kB" */
const char *mote_show_whole(double value,
                            char text[MOTE_NUMBER_TEXT]); /* "11,920"; value >= 0 */
const char *mote_show_ordinal(uint32_t number, char text[MOTE_NUMBER_TEXT]); /* "16th", "2nd" */

#endif
