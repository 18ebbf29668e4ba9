/* MOTE_CLONES marks a hot function that is compiled for several instruction sets, the widest
   being picked when the program is loaded. Sums in such functions go into a fixed number of
   lanes that are added in a fixed order, so every version gives the same bits. */
#ifndef MOTE_CORE_CLONES_H
#define MOTE_CORE_CLONES_H

#if defined(MOTE_HAVE_CLONES_V4)
#define MOTE_CLONES                                                                            \
    __attribute__((target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")))
#elif defined(MOTE_HAVE_CLONES)
#define MOTE_CLONES __attribute__((target_clones("default", "avx2", "avx512f")))
#else
#define MOTE_CLONES
#endif

/* Lanes of every vectorised sum over doubles. */
#define MOTE_LANES 8

#endif
