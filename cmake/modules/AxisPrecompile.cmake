# Headers of other projects, parsed once for a target instead of once for each of its sources: for clang a sixth to a
# third of the time of most sources, for gcc 3 s a folder (AXIS_PRECOMPILE=ON). Where ccache keeps objects, it finds them
# better by the sources' own text. gcc's build of single sources shows that each names what it includes.
set(AXIS_PRECOMPILE_DEFAULT OFF)
if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang" AND NOT CCACHE_PROGRAM)
  set(AXIS_PRECOMPILE_DEFAULT ON)
endif()
option(AXIS_PRECOMPILE "Precompile the headers of other projects" ${AXIS_PRECOMPILE_DEFAULT})

set(AXIS_LIBRARY_HEADERS <algorithm> <chrono> <cmath> <filesystem> <fstream> <functional> <map> <memory> <optional> <span>
                         <sstream> <string> <vector> <fmt/format.h> <fmt/ranges.h> <nlohmann/json.hpp>)

# gcc takes what was precompiled only with the very same options and definitions, in which the test programs differ.
function(axis_precompile TARGET)
  if(AXIS_PRECOMPILE AND (CMAKE_CXX_COMPILER_ID STREQUAL "Clang" OR NOT "${TARGET}" MATCHES "^test_"))
    target_precompile_headers(${TARGET} PRIVATE ${AXIS_LIBRARY_HEADERS} ${ARGN})
    # False alarms of gcc 12 about std::string, which it keeps to itself where it reads the header as text.
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
      target_compile_options(${TARGET} PRIVATE -Wno-array-bounds -Wno-stringop-overflow -Wno-stringop-overread -Wno-restrict)
    endif()
  endif()
endfunction()

# Takes what was precompiled for FROM, which has the same compiler options.
function(axis_precompile_as TARGET FROM)
  if(AXIS_PRECOMPILE AND CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    target_precompile_headers(${TARGET} REUSE_FROM ${FROM})
  endif()
endfunction()
