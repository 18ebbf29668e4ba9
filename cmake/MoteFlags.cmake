# Flags shared by everything that we compile: the same for our methods and for the baselines.
add_library(mote_flags INTERFACE)
set(CMAKE_C_STANDARD 17)
set(CMAKE_C_STANDARD_REQUIRED ON)
set(CMAKE_C_EXTENSIONS OFF)
set(CMAKE_CXX_STANDARD 17)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_C_VISIBILITY_PRESET hidden)
set(CMAKE_CXX_VISIBILITY_PRESET hidden)
set(CMAKE_C_FLAGS_RELEASE "-O3 -DNDEBUG")
set(CMAKE_CXX_FLAGS_RELEASE "-O3 -DNDEBUG")

set(mote_c_warnings -Wall -Wextra -Wshadow -Wconversion -Wdouble-promotion -Wstrict-prototypes
    -Wmissing-prototypes -Wundef -Wvla -Wcast-qual -Wformat=2 -pedantic-errors)
target_compile_options(mote_flags INTERFACE
  -ffp-contract=off -fno-math-errno -fno-trapping-math
  $<$<COMPILE_LANGUAGE:C>:${mote_c_warnings}>
  $<$<COMPILE_LANGUAGE:CXX>:-Wall;-Wextra>)
# gcc 12 would fuse the lanes of two terms of a sum and then add them up in pairs.
target_compile_options(mote_flags INTERFACE
  $<$<COMPILE_LANG_AND_ID:C,GNU>:-fno-loop-unroll-and-jam>)
target_compile_definitions(mote_flags INTERFACE _POSIX_C_SOURCE=200809L MOTE_IN_TREE)
if(MOTE_WERROR)
  target_compile_options(mote_flags INTERFACE -Werror)
endif()
if(MOTE_SANITIZE)
  # Functions and lines are all that traces show; with more, each program links three times as long. What the
  # sanitizers store beside the code need not be relocated when a program that lies at a fixed place starts.
  target_compile_options(mote_flags INTERFACE -fsanitize=address,undefined
                         -fno-sanitize-recover=undefined -fno-omit-frame-pointer -g1)
  target_link_options(mote_flags INTERFACE -fsanitize=address,undefined
                      $<$<STREQUAL:$<TARGET_PROPERTY:TYPE>,EXECUTABLE>:-no-pie>)
  # Templates of others have no global arrays that could overflow, but thousands of places to report from, which
  # would be globals with red zones of their own: four times the data to read at each start and search for leaks.
  target_compile_options(mote_flags INTERFACE $<$<COMPILE_LANG_AND_ID:CXX,GNU>:--param=asan-globals=0>)
  # With sanitizers gcc loses track of sizes and values, so that these warnings are false. The
  # release build has them.
  target_compile_options(mote_flags INTERFACE
    $<$<C_COMPILER_ID:GNU>:-Wno-format-truncation;-Wno-maybe-uninitialized>)
endif()
if(MOTE_FORCE_ISA)
  target_compile_options(mote_flags INTERFACE -march=${MOTE_FORCE_ISA})
elseif(MOTE_CLONES AND NOT MOTE_SANITIZE AND CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64")
  include(CheckCSourceRuns) # some C libraries (musl) cannot pick a version at load time
  check_c_source_runs("
    __attribute__((target_clones(\"default\",\"arch=x86-64-v3\",\"arch=x86-64-v4\")))
    int f(int x) { return x + 1; }
    int main(void) { return f(-1); }" MOTE_HAVE_CLONES_V4)
  check_c_source_runs("
    __attribute__((target_clones(\"default\",\"avx2\",\"avx512f\")))
    int f(int x) { return x + 1; }
    int main(void) { return f(-1); }" MOTE_HAVE_CLONES)
  if(MOTE_HAVE_CLONES_V4)
    target_compile_definitions(mote_flags INTERFACE MOTE_HAVE_CLONES_V4=1)
  elseif(MOTE_HAVE_CLONES)
    target_compile_definitions(mote_flags INTERFACE MOTE_HAVE_CLONES=1)
  endif()
endif()
