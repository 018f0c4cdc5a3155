# Version and commit, as a header <build_version.hpp> that is written only if they change.
include_guard(GLOBAL)
set(AXIS_VERSION "0.1.0")
set(BUILD_VERSION "${CMAKE_BINARY_DIR}/version/build_version.hpp")
add_custom_target(build_version BYPRODUCTS "${BUILD_VERSION}"
  COMMAND "${CMAKE_COMMAND}" "-DROOT=${AXIS_ROOT}" "-DOUTPUT=${BUILD_VERSION}" "-DVERSION=${AXIS_VERSION}"
          -P "${AXIS_ROOT}/cmake/modules/WriteBuildVersion.cmake")
