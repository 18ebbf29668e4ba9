# mote_registry(OUT NAME SOURCE...): writes NAME.c, the tables of all methods and fields that the
# sources define with MOTE_METHOD(identifier) and MOTE_FIELD(identifier), and of those methods that
# answer impacts, MOTE_IMPACT(identifier), sorted by file, so that a new one is one new file.
# Beside it in OUT: the sources that look things up in the tables, which go where the tables go.
set(registry_lookup ${CMAKE_SOURCE_DIR}/core/method/method_table.c
                    ${CMAKE_SOURCE_DIR}/core/body/field_table.c)
function(mote_registry out name)
  foreach(type method impact_method field_maker)
    set(${type}_declarations "")
    set(${type}_entries "")
  endforeach()
  foreach(source ${ARGN})
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${source})
    file(STRINGS ${source} lines REGEX "^MOTE_(METHOD|IMPACT|FIELD)\\([a-z0-9_]+\\)")
    foreach(line ${lines})
      string(REGEX REPLACE "^MOTE_[A-Z]+\\(([a-z0-9_]+)\\).*" "\\1" id "${line}")
      set(type method)
      if(line MATCHES "^MOTE_FIELD")
        set(type field_maker)
      elseif(line MATCHES "^MOTE_IMPACT")
        set(type impact_method)
      endif()
      string(APPEND ${type}_declarations "extern const mote_${type} mote_${type}_${id};\n")
      string(APPEND ${type}_entries "    &mote_${type}_${id},\n")
    endforeach()
  endforeach()
  set(tables "")
  foreach(type method impact_method field_maker)
    string(APPEND tables "
${${type}_declarations}
const mote_${type} *const mote_${type}s[] = {
${${type}_entries}    NULL,
};
")
  endforeach()
  set(file ${CMAKE_BINARY_DIR}/${name}.c)
  file(CONFIGURE OUTPUT ${file} @ONLY CONTENT "/* Written by the build: see cmake/MoteRegistry.cmake. */
#include \"core/body/field_maker.h\"
#include \"core/method/impact_method.h\"
#include \"core/method/method.h\"

#include <string.h>
${tables}")
  set(${out} ${file} ${registry_lookup} PARENT_SCOPE)
endfunction()
