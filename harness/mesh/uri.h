/* The files that a mesh file names: a glTF file's buffers are URIs (glTF 2.0, section 2.8), in
   which exporters write a space as %20. */
#ifndef MOTE_HARNESS_URI_H
#define MOTE_HARNESS_URI_H

/* The URI with %41 and the like decoded (RFC 3986, section 2.1), except for %00; a percent sign
   without two hexadecimal digits stays. The caller frees it. */
char *mote_uri_decode(const char *uri);

/* The path of the file that a URI in `file` names, from the folder of `file`: as it is written
   if there is such a file, otherwise decoded. The caller frees it. */
char *mote_uri_path(const char *file, const char *uri);

#endif
