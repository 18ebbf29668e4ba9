/* What interrupted writes leave in a run directory. */
#ifndef MOTE_HARNESS_SWEEP_H
#define MOTE_HARNESS_SWEEP_H

/* Removes the temporary files (NAME.PID.part) that a run leaves when it is ended: of the files
   that it writes at the top of its directory, and of the JSON and CSV files in cells and truth.
   Any other file stays: the directory may be the user's own. */
void mote_run_sweep(const char *directory);

#endif
