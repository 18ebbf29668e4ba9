/* Memory in pages of 2 MB. Arrays that are larger than a processor's own caches are read at
   another speed in every process, by where the system happens to put their small pages: the
   streamed query of 100,000 triangles took between 90 and 280 us. Huge pages leave less to
   chance, for all methods alike. Many systems give them to every program; where a program has
   to ask, ours does. */
#ifndef MOTE_HARNESS_HUGE_PAGES_H
#define MOTE_HARNESS_HUGE_PAGES_H

/* Starts this program anew with GLIBC_TUNABLES=glibc.malloc.hugetlb=1, which is how glibc is
   asked, and how children inherit it. Returns where that isn't needed or not wanted: the system
   gives huge pages to all programs or to none, the variable already says something about them,
   or another library is loaded first (LD_PRELOAD), as by valgrind, which would lose sight of
   the new program. It takes as long as starting does, 10 ms, so only commands that measure call
   it, before they open anything. */
void mote_huge_pages_ask(char **argv);

/* "always" and "never" by the system's choice, else "asked" or "not asked"; "unknown" where
   the system does not tell. */
const char *mote_huge_pages(void);

#endif
