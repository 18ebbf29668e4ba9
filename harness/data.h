/* Where the files are that the program reads: datasets/ and plots/. */
#ifndef MOTE_HARNESS_DATA_H
#define MOTE_HARNESS_DATA_H

/* The folder that holds datasets/ and plots/: ../share/mote beside the folder of an installed
   program, else the sources that it was built from. Never NULL; lives on. Not for threads. */
const char *mote_data_directory(void);

#endif
