# Headers of other projects, parsed once for a target instead of once for each of its sources: for clang a sixth to a
# third of the time of most sources, for gcc little. Where ccache keeps objects, it finds them better by the sources' own
# text. gcc's build shows that every source names what it includes.
set(AXIS_PRECOMPILE_DEFAULT OFF)
if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang" AND NOT CCACHE_PROGRAM)
  set(AXIS_PRECOMPILE_DEFAULT ON)
endif()
option(AXIS_PRECOMPILE "Precompile the headers of other projects" ${AXIS_PRECOMPILE_DEFAULT})

set(AXIS_LIBRARY_HEADERS <algorithm> <chrono> <cmath> <filesystem> <fstream> <functional> <map> <memory> <optional> <span>
                         <sstream> <string> <vector> <fmt/format.h> <fmt/ranges.h> <nlohmann/json.hpp>)

function(axis_precompile TARGET)
  if(AXIS_PRECOMPILE)
    target_precompile_headers(${TARGET} PRIVATE ${AXIS_LIBRARY_HEADERS} ${ARGN})
  endif()
endfunction()

# Takes what was precompiled for FROM, which has the same compiler options.
function(axis_precompile_as TARGET FROM)
  if(AXIS_PRECOMPILE)
    target_precompile_headers(${TARGET} REUSE_FROM ${FROM})
  endif()
endfunction()
