# Sources of one folder are compiled together: most of a source's time goes to headers (Eigen, fmt, JSON, CLI11) and to what
# is made of their templates, which a folder then pays for once. Names in anonymous namespaces must therefore differ within
# a folder. `make UNITY=ON` builds so. OFF compiles each source by itself, for work on a few of them; `make lint` looks at
# each by itself too, which shows that it includes what it names.
option(AXIS_UNITY "Compile the sources of a folder together" OFF)

# axis_unity(TARGET SOURCE...): at most AXIS_UNITY_SOURCES a group. A source with options of its own stays by itself.
set(AXIS_UNITY_SOURCES 12)
function(axis_unity TARGET)
  if(NOT AXIS_UNITY)
    return()
  endif()
  set_target_properties(${TARGET} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  foreach(SOURCE IN LISTS ARGN)
    cmake_path(GET SOURCE PARENT_PATH FOLDER)
    cmake_path(GET FOLDER FILENAME FOLDER)
    math(EXPR NUMBER "${COUNT_${FOLDER}} + 0")
    math(EXPR COUNT_${FOLDER} "${NUMBER} + 1")
    math(EXPR GROUP "${NUMBER} / ${AXIS_UNITY_SOURCES}")
    set_source_files_properties("${SOURCE}" PROPERTIES UNITY_GROUP "${FOLDER}_${GROUP}")
  endforeach()
endfunction()
