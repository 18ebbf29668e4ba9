/* MOTE_CLONES marks a hot function that is compiled for several instruction sets; the widest
   that the processor has is chosen when the program is loaded. Sums in such functions go into a
   fixed number of lanes that are added in a fixed order, so every version gives the same bits.
 */
#ifndef MOTE_CORE_CLONES_H
#define MOTE_CORE_CLONES_H

/* clang before 18 gives the name of a cloned function only to callers in the same file. */
#if defined(__clang__) && __clang_major__ < 18
#define MOTE_CLONES
#elif defined(MOTE_HAVE_CLONES_V4)
#define MOTE_CLONES                                                                            \
    __attribute__((target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")))
#elif defined(MOTE_HAVE_CLONES)
#define MOTE_CLONES __attribute__((target_clones("default", "avx2", "avx512f")))
#else
#define MOTE_CLONES
#endif

/* Marks helpers of such functions: one that is not inlined would run with the narrowest
   instruction set. A build that counts branches has one instruction set and inlines nothing, so
   that each branch counts once. */
#if defined(__GNUC__) && !defined(MOTE_COVERAGE)
#define MOTE_INLINE static inline __attribute__((always_inline))
#else
#define MOTE_INLINE static inline
#endif

/* restrict, which compilers of C++ know under another name. */
#ifdef __cplusplus
#define MOTE_RESTRICT __restrict
#else
#define MOTE_RESTRICT restrict
#endif

/* Lanes of every vectorised sum over doubles. */
#define MOTE_LANES 8

/* Stands before a loop over lanes: keeps gcc from unrolling it into scalar code before its
   vectoriser sees it. clang does not need it. */
#if defined(__GNUC__) && !defined(__clang__)
#define MOTE_LANE_LOOP _Pragma("GCC unroll 1")
#else
#define MOTE_LANE_LOOP
#endif

/* The fixed order in which MOTE_LANES partial sums are added. */
static inline double mote_lane_sum(const double lane[MOTE_LANES])
{
    return ((lane[0] + lane[4]) + (lane[2] + lane[6])) +
           ((lane[1] + lane[5]) + (lane[3] + lane[7]));
}

#endif
