# Parses headers of other projects once for a target instead of once for each of its sources (AXIS_PRECOMPILE=ON). This
# saves clang a sixth to a third of the time of most sources, and gcc 3 s a folder. It is off with ccache, which finds
# more objects without it. It is also off with gcc, so that the build of single sources checks that each source includes
# what it uses.
set(AXIS_PRECOMPILE_DEFAULT OFF)
if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang" AND NOT CCACHE_PROGRAM)
  set(AXIS_PRECOMPILE_DEFAULT ON)
endif()
option(AXIS_PRECOMPILE "Precompile the headers of other projects" ${AXIS_PRECOMPILE_DEFAULT})

set(AXIS_LIBRARY_HEADERS <algorithm> <chrono> <cmath> <filesystem> <fstream> <functional> <map> <memory> <optional> <span>
                         <sstream> <string> <vector> <fmt/format.h> <fmt/ranges.h> <nlohmann/json.hpp>)

# gcc uses precompiled headers only with exactly the same options and definitions; those of the test programs differ.
function(axis_precompile TARGET)
  if(AXIS_PRECOMPILE AND (CMAKE_CXX_COMPILER_ID STREQUAL "Clang" OR NOT "${TARGET}" MATCHES "^test_"))
    target_precompile_headers(${TARGET} PRIVATE ${AXIS_LIBRARY_HEADERS} ${ARGN})
    # gcc 12 warns wrongly about std::string here; it does not warn where it reads the header as text.
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
      target_compile_options(${TARGET} PRIVATE -Wno-array-bounds -Wno-stringop-overflow -Wno-stringop-overread -Wno-restrict)
    endif()
  endif()
endfunction()

# Uses the headers precompiled for FROM, which has the same compiler options.
function(axis_precompile_as TARGET FROM)
  if(AXIS_PRECOMPILE AND CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    target_precompile_headers(${TARGET} REUSE_FROM ${FROM})
  endif()
endfunction()
