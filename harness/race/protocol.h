/* The protocol between `mote race` and the programs that it races, over two pipes: lines of
   fields separated by tabs, one line of answer for each request.

       race-child's first line    mote-race FORMAT
       cell SCENARIO FIRST LAST CACHE SEED PRINT METHOD
                                  builds a method for frames FIRST .. LAST of a scenario
                                  (for impacts: those in which a question begins);
                                  cells are numbered from 0. PRINT 1: with the fingerprint
                                  (otherwise 0, since it takes long); LAST 0: to the end
                                  ok FINGERPRINT L LAST FACES ASK STEP TOLERANCE
                                  FACES: a hash of the triangles, 0 without PRINT; ASK:
                                  distance, contact or impact
       run CELL FIRST COUNT       measures frames FIRST .. FIRST + COUNT - 1
                                  ok HASH NAME=COUNT,... NS,NS,...
                                  HASH of the answers; sums of the counts; time per frame of
                                  deformation, update and query together
       answers CELL               the answers of the frames last run
                                  ok DISTANCE:CONTACT,...
                                  nan and - where missing; CONTACT is 0 or 1
                                  of impacts and of more than two bodies
                                  ok DISTANCE:CONTACT:SET:VALUE:VALUE,...
                                  SET: a hash of the pairs in contact, 0 of impacts; VALUES of
                                  an impact: from and to, as parts of the question's time; of
                                  many bodies: a sum over the distances of near pairs, in L
       any request that fails     no REASON
                                  to `cell`: the program cannot measure it, or does not have
                                  it; to another request: the method failed

   What follows LAST and CONTACT was added later: programs that do not know it leave it out, or
   do not read it. race-child ends at the end of its input. A change of this format raises
   MOTE_RACE_FORMAT: a program with another format is refused, never misread. */
#ifndef MOTE_HARNESS_RACE_PROTOCOL_H
#define MOTE_HARNESS_RACE_PROTOCOL_H

#define MOTE_RACE_FORMAT 1
#define MOTE_RACE_GREETING "mote-race"

/* The largest line in bytes, including its end. */
#define MOTE_RACE_LINE ((size_t)1 << 20)

/* The largest number of frames in one `run`: their times must fit in a line. */
#define MOTE_RACE_BLOCK_FRAMES 4096

/* The largest number of cells in a child. */
#define MOTE_RACE_CELLS 256

#endif
