/* Sine and cosine of an angle in turns, with the same bits on every machine and compiler: those
   of the C library may differ in the last place, but fingerprints of scenarios must not. */
#ifndef MOTE_CORE_TURN_H
#define MOTE_CORE_TURN_H

/* turns: any finite number of magnitude up to 1e15; one turn is 360 degrees. Errors below
   2e-16. */
void mote_turn(double turns, double *sine, double *cosine);

#endif
