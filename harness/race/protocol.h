/* What `mote race` and the programs that it races say to each other, over two pipes: lines of
   fields between tabs, a line asked for each line answered.

       race-child's first line    mote-race FORMAT
       cell SCENARIO FIRST LAST CACHE SEED PRINT METHOD
                                  builds a method for frames FIRST .. LAST of a scenario;
                                  cells are numbered from 0. PRINT 1: with the fingerprint
                                  (else that is 0, since it takes long); LAST 0: to the end
                                  ok FINGERPRINT L LAST
       run CELL FIRST COUNT       measures frames FIRST .. FIRST + COUNT - 1
                                  ok HASH NAME=COUNT,... NS,NS,...
                                  HASH of the answers; sums of the counts; a time a frame,
                                  deformation, update and query together
       answers CELL               of the frames last run: ok DISTANCE:CONTACT,... (nan and -
   where there is none; else CONTACT is 0 or 1) anything that fails        no REASON

   The end of its input ends race-child. A change of this format raises MOTE_RACE_FORMAT: a
   program of another format is refused, never misread. */
#ifndef MOTE_HARNESS_RACE_PROTOCOL_H
#define MOTE_HARNESS_RACE_PROTOCOL_H

#define MOTE_RACE_FORMAT 1
#define MOTE_RACE_GREETING "mote-race"

/* At most this many bytes in a line, its end included. */
#define MOTE_RACE_LINE ((size_t)1 << 20)

/* At most this many frames in one `run`: their times fit in a line. */
#define MOTE_RACE_BLOCK_FRAMES 4096

/* At most this many cells in a child. */
#define MOTE_RACE_CELLS 256

#endif
