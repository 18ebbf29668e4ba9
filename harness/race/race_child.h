/* The measuring side of `mote race`: see harness/race/protocol.h. */
#ifndef MOTE_HARNESS_RACE_CHILD_H
#define MOTE_HARNESS_RACE_CHILD_H

/* `mote race-child --core N --stack BYTES --heap BYTES`: answers lines on standard input until
   it ends. It measures on core N - 1 (0: on any), and builds wherever there is room. The stack
   starts lower and the heap higher by these many bytes, since their position affects times.
   Returns a mote_exit. */
int mote_race_child(int argc, char **argv);

#endif
