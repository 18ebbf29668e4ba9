# Versions of libraries that have no pkg-config file, for manifest.json.

# mote_header_version(RESULT FOLDER HEADER MACRO): the text or number that a header defines.
function(mote_header_version result folder header macro)
  file(STRINGS "${folder}/${header}" line REGEX "^#define ${macro} " LIMIT_COUNT 1)
  string(REGEX REPLACE "^#define ${macro} \"?([0-9.]+).*" "\\1" version "${line}")
  set(${result} "${version}" PARENT_SCOPE)
endfunction()

# meshoptimizer writes 0.18 as 180.
find_path(MESHOPTIMIZER_INCLUDE meshoptimizer.h)
mote_header_version(number "${MESHOPTIMIZER_INCLUDE}" meshoptimizer.h MESHOPTIMIZER_VERSION)
math(EXPR major "${number} / 1000")
math(EXPR minor "${number} % 1000 / 10")
set(MESHOPTIMIZER_VERSION "${major}.${minor}")

# HACD's own header says 0.0 for ever. Its library has the version of the Bullet that it came with.
find_library(HACD_LIBRARY HACD)
get_filename_component(file "${HACD_LIBRARY}" REALPATH)
string(REGEX MATCH "[0-9][0-9.]*$" HACD_VERSION "${file}")
if(NOT HACD_VERSION)
  set(HACD_VERSION unknown)
endif()

if(EMBREE_FOUND)
  mote_header_version(EMBREE_VERSION "${EMBREE_INCLUDE}" embree3/rtcore_config.h RTC_VERSION_STRING)
endif()
