/* The regular octahedron with its corners at 1 and -1 on the axes, as an OBJ file. */
#ifndef MOTE_TESTS_DIAMOND_H
#define MOTE_TESTS_DIAMOND_H

#define DIAMOND                                                                                \
    "v 1 0 0\nv -1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nv 0 0 -1\nf 1 3 5\nf 3 2 5\nf 2 4 5\n"     \
    "f 4 1 5\nf 3 1 6\nf 2 3 6\nf 4 2 6\nf 1 4 6\n"

#endif
