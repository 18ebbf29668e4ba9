# Branch coverage (preset coverage, make coverage): core and harness are compiled without
# optimisation, so that the branches are those of the source, and without assertions.
foreach(target mote_core mote_harness mote)
  target_compile_options(${target} PRIVATE --coverage -O0)
  target_compile_definitions(${target} PRIVATE NDEBUG MOTE_COVERAGE)
endforeach()
target_link_options(mote_core PUBLIC --coverage)

# Children end by _exit, run another program, or may not write.
target_sources(mote_core PRIVATE cmake/coverage_exit.c)
target_link_options(mote_core PUBLIC -Wl,--wrap=_exit)
target_sources(mote_harness PRIVATE cmake/coverage.c)
target_link_options(mote_harness PUBLIC -Wl,--wrap=execvp -Wl,--wrap=mote_confine)
