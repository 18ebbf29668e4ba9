# libmote, static and shared, and what `cmake --install` puts where. Needs core_sources, the target
# mote_core and, unless MOTE_CORE_ONLY, the target mote.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
# The library's table of methods holds those of core/.
mote_registry(core_registry core_registry ${core_sources})

add_library(mote_static STATIC $<TARGET_OBJECTS:mote_core> ${core_registry})
target_link_libraries(mote_static PRIVATE mote_flags)
target_include_directories(mote_static PRIVATE ${CMAKE_SOURCE_DIR})
set_target_properties(mote_static PROPERTIES OUTPUT_NAME mote)

add_library(mote_shared SHARED $<TARGET_OBJECTS:mote_core> ${core_registry})
target_include_directories(mote_shared PRIVATE ${CMAKE_SOURCE_DIR})
target_link_options(mote_shared PRIVATE
  -Wl,--version-script=${CMAKE_BINARY_DIR}/libmote.map -Wl,-Bsymbolic-functions -Wl,--no-undefined)
target_link_libraries(mote_shared PRIVATE mote_flags m ${core_libraries})
set_target_properties(mote_shared PROPERTIES OUTPUT_NAME mote
  VERSION ${MOTE_SOVERSION}.${PROJECT_VERSION} SOVERSION ${MOTE_SOVERSION} C_VISIBILITY_PRESET default
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
                                 COMPATIBILITY SameMajorVersion)
# Found from where the file lies, so that an installation may be moved.
file(RELATIVE_PATH MOTE_PC_PREFIX /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
configure_file(cmake/mote.pc.in ${CMAKE_BINARY_DIR}/mote.pc @ONLY)

# Components are what packages are made of (MotePackages.cmake).
install(TARGETS mote_static mote_shared ARCHIVE COMPONENT development
        LIBRARY COMPONENT library NAMELINK_COMPONENT development)
install(DIRECTORY ${CMAKE_BINARY_DIR}/include/mote DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
        COMPONENT development)
install(FILES ${CMAKE_BINARY_DIR}/moteConfig.cmake ${CMAKE_BINARY_DIR}/moteConfigVersion.cmake
        DESTINATION ${package_folder} COMPONENT development)
install(FILES ${CMAKE_BINARY_DIR}/mote.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig
        COMPONENT development)

include(MotePython)

if(NOT MOTE_CORE_ONLY)
  set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME program)
  install(TARGETS mote)
  install(DIRECTORY datasets/characters datasets/meshes datasets/scenarios
          DESTINATION ${CMAKE_INSTALL_DATADIR}/mote/datasets PATTERN "*.py" EXCLUDE)
  install(FILES datasets/defects.md DESTINATION ${CMAKE_INSTALL_DATADIR}/mote/datasets)
  install(DIRECTORY plots DESTINATION ${CMAKE_INSTALL_DATADIR}/mote
          PATTERN node_modules EXCLUDE PATTERN "*.sh" EXCLUDE PATTERN "package*.json" EXCLUDE
          PATTERN ".npmrc" EXCLUDE)
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
