# mote_registry(OUT NAME SOURCE...): writes NAME.c, the table of all methods that the sources define
# with MOTE_METHOD(identifier), sorted by file, so that a new method is one new file.
function(mote_registry out name)
  set(declarations "")
  set(entries "")
  foreach(source ${ARGN})
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${source})
    file(STRINGS ${source} lines REGEX "^MOTE_METHOD\\([a-z0-9_]+\\)")
    foreach(line ${lines})
      string(REGEX REPLACE "^MOTE_METHOD\\(([a-z0-9_]+)\\).*" "\\1" id "${line}")
      string(APPEND declarations "extern const mote_method mote_method_${id};\n")
      string(APPEND entries "    &mote_method_${id},\n")
    endforeach()
  endforeach()
  set(file ${CMAKE_BINARY_DIR}/${name}.c)
  file(CONFIGURE OUTPUT ${file} @ONLY CONTENT "/* Written by the build: see cmake/MoteRegistry.cmake. */
#include \"core/method.h\"

#include <string.h>

${declarations}
const mote_method *const mote_methods[] = {
${entries}    NULL,
};

const mote_method *mote_method_find(const char *name)
{
    for (size_t i = 0; mote_methods[i]; ++i) {
        if (strcmp(mote_methods[i]->name, name) == 0)
            return mote_methods[i];
    }
    return NULL;
}
")
  set(${out} ${file} PARENT_SCOPE)
endfunction()
