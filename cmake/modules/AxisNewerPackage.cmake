# Packages of Debian 13 that Debian 12 lacks, unpacked and never installed; one place for all build trees.
set(AXIS_PACKAGES "${AXIS_ROOT}/build/packages" CACHE PATH "Where packages are unpacked that are not installed")

# axis_newer_package(NAME FOLDER_VARIABLE [REQUIRED]): sets FOLDER_VARIABLE to the folder that contains the package's
# files as under /, or to nothing if the package is not available.
function(axis_newer_package NAME FOLDER)
  execute_process(COMMAND "${AXIS_ROOT}/cmake/packages/fetch_newer.sh" "${AXIS_PACKAGES}" "${NAME}"
                  RESULT_VARIABLE STATUS ERROR_VARIABLE WHY)
  if(STATUS EQUAL 0)
    set(${FOLDER} "${AXIS_PACKAGES}/${NAME}" PARENT_SCOPE)
  elseif("REQUIRED" IN_LIST ARGN)
    message(FATAL_ERROR "${WHY}")
  else()
    message(WARNING "${WHY}")
    set(${FOLDER} "" PARENT_SCOPE)
  endif()
endfunction()
