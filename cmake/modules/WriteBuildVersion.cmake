# Script: cmake -DROOT=... -DOUTPUT=... -DVERSION=... -P WriteBuildVersion.cmake
# Writes the header that tells an image its version and the commit it was built from; leaves it
# unchanged if both are the same.
set(HASH unknown)
find_program(GIT git)
if(GIT)
  execute_process(COMMAND "${GIT}" -C "${ROOT}" rev-parse --short=12 HEAD OUTPUT_VARIABLE COMMIT
                  OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE FAILED)
  if(NOT FAILED)
    execute_process(COMMAND "${GIT}" -C "${ROOT}" status --porcelain --untracked-files=no OUTPUT_VARIABLE CHANGES
                    ERROR_QUIET)
    set(HASH "${COMMIT}")
    if(CHANGES)
      string(APPEND HASH "-changed")
    endif()
  endif()
endif()
set(TEXT "// Written by the build.\n#pragma once\n\n#define AXIS_VERSION \"${VERSION}\"\n#define AXIS_GIT_HASH \"${HASH}\"\n")
if(EXISTS "${OUTPUT}")
  file(READ "${OUTPUT}" PRESENT)
endif()
if(NOT "${PRESENT}" STREQUAL "${TEXT}")
  file(WRITE "${OUTPUT}" "${TEXT}")
endif()
