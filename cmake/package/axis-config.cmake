# find_package(axis): the target axis::host, the library behind axistool. Headers as in the project: "host/record/record.hpp".
include(CMakeFindDependencyMacro)
find_dependency(Eigen3)
find_dependency(Ceres)
find_dependency(fmt)
find_dependency(nlohmann_json)
find_dependency(Threads)
find_dependency(PkgConfig)
pkg_check_modules(AXIS_TOMLPP REQUIRED IMPORTED_TARGET tomlplusplus)
pkg_check_modules(AXIS_FFTW REQUIRED IMPORTED_TARGET fftw3)

get_filename_component(AXIS_PREFIX "${CMAKE_CURRENT_LIST_DIR}/../../.." ABSOLUTE)
foreach(NAME IN ITEMS sim hal_usbip computing host)
  if(NOT TARGET axis::${NAME})
    add_library(axis::${NAME} STATIC IMPORTED)
    set_target_properties(axis::${NAME} PROPERTIES IMPORTED_LOCATION "${AXIS_PREFIX}/lib/axis/libaxis_${NAME}.a"
      INTERFACE_INCLUDE_DIRECTORIES "${AXIS_PREFIX}/include/axis" INTERFACE_COMPILE_FEATURES cxx_std_20)
  endif()
endforeach()
# Unused USB code would need a clock.
set_target_properties(axis::hal_usbip PROPERTIES INTERFACE_LINK_OPTIONS "-Wl,--gc-sections")
set_target_properties(axis::host PROPERTIES INTERFACE_LINK_LIBRARIES
  "axis::computing;axis::sim;axis::hal_usbip;Eigen3::Eigen;Ceres::ceres;fmt::fmt;nlohmann_json::nlohmann_json;PkgConfig::AXIS_TOMLPP;PkgConfig::AXIS_FFTW;Threads::Threads;${CMAKE_DL_LIBS}")
set_target_properties(axis::computing PROPERTIES INTERFACE_LINK_LIBRARIES axis::host)  # the two need each other
