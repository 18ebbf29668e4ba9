# What libmote offers: its public headers, as they are installed, and the functions that they
# declare. The shared library exports these and nothing else, and so does the program, for the
# methods and fields of shared libraries that it loads (--plugin).
# The number in the library's name, libmote.so.N: raised when a program that was linked with the last
# release might fail (docs/compatibility.md), and not with the version.
set(MOTE_SOVERSION 0)

# Headers of the installed library; everything else in core/ is not for users.
set(public_headers status vec3 clones mesh field field_maker body positions triangle parameter plugin
    method certificate scene stream stream_scene mass skin skin_data quaternion rigid_motion response
    lazy certificate_tree certificate_box certificate_side certificate_bounds certificate_project path impact impact_method
    impact_scene
    version controls batch_run batch stream_batch crowd)
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
  if(declared AND NOT text MATCHES "#pragma GCC visibility push\\(default\\)")
    message(FATAL_ERROR "${header}: its functions are public; put them between "
            "`#pragma GCC visibility push(default)` and `#pragma GCC visibility pop`")
  endif()
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

list(REMOVE_DUPLICATES symbols)
list(JOIN symbols ";\n    " symbol_lines)
file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/libmote.map @ONLY CONTENT
"MOTE_${MOTE_SOVERSION} {
  global:
    ${symbol_lines};
  local:
    *;
};
")
file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/program.list @ONLY CONTENT
"{
    ${symbol_lines};
};
")

# A program that loads such libraries: it has all of core, since they may call any public function.
function(mote_takes_plugins program)
  target_sources(${program} PRIVATE $<TARGET_OBJECTS:mote_core>)
  target_link_libraries(${program} PRIVATE ${CMAKE_DL_LIBS})
  target_link_options(${program} PRIVATE -Wl,--dynamic-list=${CMAKE_BINARY_DIR}/program.list)
  set_property(TARGET ${program} PROPERTY LINK_DEPENDS ${CMAKE_BINARY_DIR}/program.list)
endfunction()
