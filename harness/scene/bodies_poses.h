/* The recorded motion of several bodies: a CSV beside the scenario with a row for each frame
   and body, "frame,body,deformation,x,y,z,qw,qx,qy,qz". Lengths are in L; x, y, z is the middle
   of the body's box, the quaternion rotates it from rest; deformation is the frame of the
   shape's deformation. */
#ifndef MOTE_HARNESS_BODIES_POSES_H
#define MOTE_HARNESS_BODIES_POSES_H

#include "harness/scene/bodies.h"

/* Reads the file for bodies->count bodies and bodies->frames frames into bodies->recorded, and
   sets their paths to lead from frame 1 to frame 2. MOTE_EIO; MOTE_EINVAL with file and line
   for anything but these rows in this order. */
mote_status mote_bodies_poses_read(const char *path, mote_bodies *bodies);

/* Writes records[frames][bodies->count]. MOTE_EIO. */
mote_status mote_bodies_poses_write(const char *path, const mote_bodies *bodies,
                                    const mote_bodies_record *records, uint32_t frames);

#endif
