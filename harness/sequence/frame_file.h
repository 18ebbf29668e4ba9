/* The positions in one file of a sequence, read frame by frame in a separate process
   (sequence_reader.h). PLY is read by mote_frame_file_read_ply of mesh_soup.h. */
#ifndef MOTE_HARNESS_FRAME_FILE_H
#define MOTE_HARNESS_FRAME_FILE_H

#include "harness/mesh/mesh_soup.h"

/* Reads the vertices and faces of an OBJ text (ended by a 0 byte) like mote_soup_read_obj,
   without making triangles. MOTE_EINVAL with "FILE:LINE: what". */
mote_status mote_frame_file_read_obj(const char *path, const char *text, mote_frame_file *file);

#endif
