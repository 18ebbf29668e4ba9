# The module for Python: python/mote in the build, for tests, and where python3 looks for modules
# when it is installed. Nothing is compiled for it.
set(python_folder ${CMAKE_BINARY_DIR}/python/mote)
file(GLOB python_sources CONFIGURE_DEPENDS core/python/mote/*.py core/python/mote/py.typed)
foreach(source ${python_sources})
  get_filename_component(name ${source} NAME)
  configure_file(${source} ${python_folder}/${name} COPYONLY)
endforeach()
# From the module's folder to the library; MotePythonInstall.cmake writes another for where it goes.
set(MOTE_PYTHON_LIBRARY ../../libmote.so.${MOTE_SOVERSION})
configure_file(core/python/mote/_place.py.in ${python_folder}/_place.py @ONLY)
configure_file(cmake/MotePythonInstall.cmake.in ${CMAKE_BINARY_DIR}/MotePythonInstall.cmake @ONLY)
install(SCRIPT ${CMAKE_BINARY_DIR}/MotePythonInstall.cmake COMPONENT python)
