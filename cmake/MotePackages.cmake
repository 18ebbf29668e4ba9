# Debian packages of what is installed (make deb): mote, libmoteN, libmote-dev, python3-mote. Dependencies are
# computed: on shared libraries by dpkg-shlibdeps, on the packages of files that a static link needs by
# dpkg-query, between our own packages from the components below. Included last, when all is installed.
find_program(DPKG_QUERY dpkg-query)
find_program(DPKG_SHLIBDEPS dpkg-shlibdeps)
if(NOT DPKG_QUERY OR NOT DPKG_SHLIBDEPS)
  return()
endif()

# The packages that have these files, as a list of dependencies.
function(mote_packages_of result)
  set(packages "")
  foreach(file IN LISTS ARGN)
    execute_process(COMMAND ${DPKG_QUERY} -S ${file} RESULT_VARIABLE status OUTPUT_VARIABLE text ERROR_QUIET)
    if(NOT status EQUAL 0)
      message(STATUS "There will be no Debian packages: ${file} is in none")
      set(${result} NOTFOUND PARENT_SCOPE)
      return()
    endif()
    string(REGEX REPLACE "[:,].*" "" package "${text}")
    list(APPEND packages ${package})
  endforeach()
  list(REMOVE_DUPLICATES packages)
  list(JOIN packages ", " text)
  set(${result} "${text}" PARENT_SCOPE)
endfunction()

# What cmake/mote.pc.in names for a static link.
find_library(HACD_LIBRARY HACD)
find_library(MESHOPTIMIZER_LIBRARY meshoptimizer)
find_library(GSL_LIBRARY gsl)
execute_process(COMMAND ${CMAKE_CXX_COMPILER} -print-file-name=libstdc++.so OUTPUT_VARIABLE STDCXX_LIBRARY
                OUTPUT_STRIP_TRAILING_WHITESPACE)
mote_packages_of(static_needs ${GSL_LIBRARY} ${HACD_LIBRARY} ${MESHOPTIMIZER_LIBRARY} ${STDCXX_LIBRARY})
if(NOT static_needs)
  return()
endif()

# cpack installs what is built, and does not build the tests for it.
set(CMAKE_SKIP_INSTALL_ALL_DEPENDENCY ON)
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_DIRECTORY ${CMAKE_BINARY_DIR}/deb)
# The module for Python: on what it imports. It is left out where that is not installed.
set(python_needs NOTFOUND)
execute_process(COMMAND /usr/bin/python3 ${CMAKE_SOURCE_DIR}/cmake/python_files.py ${CMAKE_SOURCE_DIR}/core/python/mote
                RESULT_VARIABLE status OUTPUT_VARIABLE python_files OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(status EQUAL 0)
  string(REPLACE "\n" ";" python_files "${python_files}")
  mote_packages_of(python_needs ${python_files})
endif()

set(CPACK_COMPONENTS_ALL program library development)
if(python_needs)
  list(APPEND CPACK_COMPONENTS_ALL python)
else()
  message(STATUS "There will be no package python3-mote: what it imports is not installed")
endif()
set(CPACK_PACKAGE_NAME mote)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
# As with Debian's own tools, DEBFULLNAME and DEBEMAIL say who makes the packages.
set(CPACK_PACKAGE_CONTACT "The mote authors <mote@example.org>")
if(DEFINED ENV{DEBEMAIL} AND DEFINED ENV{DEBFULLNAME})
  set(CPACK_PACKAGE_CONTACT "$ENV{DEBFULLNAME} <$ENV{DEBEMAIL}>")
endif()
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "distances and contacts of deforming triangle meshes")
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_SOURCE_DIR}/cmake/package.cmake)
set(CPACK_MOTE_SOURCE_DIR ${CMAKE_SOURCE_DIR})

set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME mote)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS "gnuplot-nox, fonts-dejavu-core") # mote figures draws with them
set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME libmote${MOTE_SOVERSION})
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS_POLICY ">=")
file(WRITE ${CMAKE_BINARY_DIR}/package/triggers "activate-noawait ldconfig\n")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA ${CMAKE_BINARY_DIR}/package/triggers)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libmote-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "${static_needs}")
set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-mote)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3:any, ${python_needs}")
set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA ${CMAKE_SOURCE_DIR}/cmake/debian/postinst ${CMAKE_SOURCE_DIR}/cmake/debian/prerm)

include(CPack)
set(about "mote measures how much accuracy a collision query by a few particles
gives up against bounding volume hierarchies, on deforming triangle
meshes, and has a query that proves its exact answer.
")
cpack_add_component(program DESCRIPTION "${about}This package has the program mote with its scenarios.")
cpack_add_component(library DESCRIPTION "${about}This package has the shared library.")
cpack_add_component(development DEPENDS library DESCRIPTION "${about}This package has the headers, the static library, and what methods and
fields of your own are compiled against.")
if(python_needs)
  cpack_add_component(python DEPENDS library DESCRIPTION "${about}This package has the module mote for Python.")
endif()
