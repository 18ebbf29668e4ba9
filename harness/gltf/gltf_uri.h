/* The files that a mesh file names: a glTF file's buffers are URIs (glTF 2.0, section 2.8), in
   which exporters write a space as %20. */
#ifndef MOTE_HARNESS_GLTF_URI_H
#define MOTE_HARNESS_GLTF_URI_H

#include "core/base/status.h"

/* The path of the file that a URI in `file` names, from the folder of `file`: as it is written
   if there is such a file, otherwise with %41 and the like decoded (RFC 3986, section 2.1),
   except for %00. MOTE_EINVAL: it would lie outside of the folder, since a file from somebody
   else must not make this program read other files. The caller frees *path. */
mote_status mote_gltf_path(const char *file, const char *uri, char **path);

#endif
