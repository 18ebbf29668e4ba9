# libmote, static and shared, and what `cmake --install` puts where. Needs core_sources, the target
# mote_core and, unless MOTE_CORE_ONLY, the target mote.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(MOTE_SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}) # 0.x: each minor its own

# Headers of the installed library; everything else in core/ is not for users.
set(public_headers status vec3 clones mesh field body positions triangle parameter method certificate scene stream stream_scene mass
    skin skin_data quaternion rigid_motion response)
if(NOT MOTE_CORE_ONLY)
  list(APPEND public_headers csrbf_fit parts)
endif()
set(umbrella "")
set(symbols "")
foreach(name ${public_headers})
  file(GLOB header ${CMAKE_SOURCE_DIR}/core/${name}.h ${CMAKE_SOURCE_DIR}/core/*/${name}.h)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${header})
  # Installed as <mote/NAME.h>; in the sources they include each other from the root.
  file(READ ${header} text)
  string(REGEX REPLACE "#include \"core/([a-z]+/)?" "#include \"mote/" text "${text}")
  file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/include/mote/${name}.h CONTENT "${text}" @ONLY)
  # The functions that they declare, in the first column, are what the shared library exports.
  string(REGEX MATCHALL "\n[a-z][^\n;(]*[ *]mote_[a-z0-9_]+(\\(|\\[\\];)" declared "${text}")
  list(FILTER declared EXCLUDE REGEX "^\n(static|typedef) ")
  list(TRANSFORM declared REPLACE "^.*[ *](mote_[a-z0-9_]+).*$" "\\1")
  list(APPEND symbols ${declared})
  string(APPEND umbrella "#include \"mote/${name}.h\"\n")
endforeach()
file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/include/mote/mote.h @ONLY CONTENT
"/* Everything that libmote ${PROJECT_VERSION} offers. */
#ifndef MOTE_MOTE_H
#define MOTE_MOTE_H

${umbrella}
#endif
")

# The library's table of methods holds those of core/.
mote_registry(core_registry core_registry ${core_sources})

add_library(mote_static STATIC $<TARGET_OBJECTS:mote_core> ${core_registry})
target_link_libraries(mote_static PRIVATE mote_flags)
target_include_directories(mote_static PRIVATE ${CMAKE_SOURCE_DIR})
set_target_properties(mote_static PROPERTIES OUTPUT_NAME mote)

# Compiled once more, with visible functions, of which only those of the public headers leave it.
# In the program itself they stay hidden, so that nothing is called through tables there.
list(JOIN symbols ";\n    " symbols)
file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/libmote.map @ONLY CONTENT
"MOTE_${MOTE_SOVERSION} {
  global:
    ${symbols};
  local:
    *;
};
")
add_library(mote_shared SHARED ${core_sources} ${core_registry})
target_include_directories(mote_shared PRIVATE ${CMAKE_SOURCE_DIR})
target_compile_options(mote_shared PRIVATE -fno-semantic-interposition)
target_link_options(mote_shared PRIVATE
  -Wl,--version-script=${CMAKE_BINARY_DIR}/libmote.map -Wl,-Bsymbolic-functions -Wl,--no-undefined)
target_link_libraries(mote_shared PRIVATE mote_flags m ${core_libraries})
set_target_properties(mote_shared PROPERTIES OUTPUT_NAME mote VERSION ${PROJECT_VERSION}
  SOVERSION ${MOTE_SOVERSION} C_VISIBILITY_PRESET default CXX_VISIBILITY_PRESET default
  LINK_DEPENDS "${CMAKE_BINARY_DIR}/libmote.map")

# What a program that is linked with the static library needs besides. pkg-config asks gsl's own file.
set(MOTE_PRIVATE_LIBRARIES m)
set(MOTE_PRIVATE_FLAGS -lm)
set(MOTE_PRIVATE_REQUIRES "")
if(NOT MOTE_CORE_ONLY)
  set(MOTE_PRIVATE_LIBRARIES gsl gslcblas HACD meshoptimizer stdc++ m)
  set(MOTE_PRIVATE_FLAGS "-lHACD -lmeshoptimizer -lstdc++ -lm")
  set(MOTE_PRIVATE_REQUIRES gsl)
endif()

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/mote)
configure_package_config_file(cmake/moteConfig.cmake.in ${CMAKE_BINARY_DIR}/moteConfig.cmake
  INSTALL_DESTINATION ${package_folder} PATH_VARS CMAKE_INSTALL_INCLUDEDIR CMAKE_INSTALL_LIBDIR)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/moteConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
# Found from where the file lies, so that an installation may be moved.
file(RELATIVE_PATH MOTE_PC_PREFIX /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
configure_file(cmake/mote.pc.in ${CMAKE_BINARY_DIR}/mote.pc @ONLY)

install(TARGETS mote_static mote_shared)
install(DIRECTORY ${CMAKE_BINARY_DIR}/include/mote DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(FILES ${CMAKE_BINARY_DIR}/moteConfig.cmake ${CMAKE_BINARY_DIR}/moteConfigVersion.cmake
        DESTINATION ${package_folder})
install(FILES ${CMAKE_BINARY_DIR}/mote.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)

if(NOT MOTE_CORE_ONLY)
  install(TARGETS mote)
  install(DIRECTORY datasets/scenarios datasets/meshes
          DESTINATION ${CMAKE_INSTALL_DATADIR}/mote/datasets PATTERN "*.py" EXCLUDE)
  install(FILES datasets/defects.md DESTINATION ${CMAKE_INSTALL_DATADIR}/mote/datasets)
  install(DIRECTORY plots DESTINATION ${CMAKE_INSTALL_DATADIR}/mote
          PATTERN node_modules EXCLUDE PATTERN "*.sh" EXCLUDE PATTERN "package*.json" EXCLUDE)
  install(FILES ${CMAKE_BINARY_DIR}/page/replay.js OPTIONAL
          DESTINATION ${CMAKE_INSTALL_DATADIR}/mote/page)
  install(FILES docs/mote.bash RENAME mote
          DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
  # The commands as the program itself tells them.
  add_custom_command(OUTPUT mote.1
    COMMAND ${CMAKE_SOURCE_DIR}/docs/manual.sh $<TARGET_FILE:mote> ${CMAKE_BINARY_DIR}/mote.1
    DEPENDS mote docs/manual.sh docs/mote.1.in VERBATIM)
  add_custom_target(manual ALL DEPENDS mote.1)
  install(FILES ${CMAKE_BINARY_DIR}/mote.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
endif()
