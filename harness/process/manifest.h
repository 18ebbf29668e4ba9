/* The origin of measurements: program, sources, compiler, libraries, machine. */
#ifndef MOTE_HARNESS_MANIFEST_H
#define MOTE_HARNESS_MANIFEST_H

#include "core/base/status.h"

#include <stddef.h>
#include <stdint.h>

/* The hash of this program's own file, which changes with anything compiled in, and of the
   libraries loaded into it (plugin.h). MOTE_EIO if it cannot be read. */
mote_status mote_program_hash(uint64_t *hash);

/* The program of the last session that wrote directory/manifest.json; "" if it names none, or
   there is no manifest. */
#define MOTE_PROGRAM_SIZE 32
void mote_manifest_program(const char *directory, char program[MOTE_PROGRAM_SIZE]);

/* Identifies the machine, to decide whether two times may be compared: "name, processor", as
   far as the system tells; cut to size. */
#define MOTE_MACHINE_SIZE 320
void mote_machine_name(char *text, size_t size);

/* Writes directory/manifest.json: the present state, and under "sessions" an entry for each
   session that measured something into the directory, this one included. */
mote_status mote_manifest_write(const char *directory, uint64_t program, uint64_t seed,
                                int argc, char **argv);

#endif
