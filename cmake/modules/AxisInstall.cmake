# The files that `make install` puts below PREFIX, and the Debian package that `make deb` makes of them.
include(AxisVersion)
set(AXIS_ZSH_DIR "share/zsh/site-functions" CACHE STRING "Where zsh looks for completions, below the prefix")
set(DOCUMENTS "${CMAKE_BINARY_DIR}/documents")

# The program itself writes manual, completions and udev rule.
add_custom_command(OUTPUT "${DOCUMENTS}/stamp"
  COMMAND "${CMAKE_COMMAND}" -E rm -rf "${DOCUMENTS}"
  COMMAND "${AXIS_ROOT}/cmake/package/documents.sh" "$<TARGET_FILE:axistool>" "${DOCUMENTS}" "${AXIS_ROOT}" "${AXIS_VERSION}"
  COMMAND "${CMAKE_COMMAND}" -E touch "${DOCUMENTS}/stamp"
  DEPENDS axistool "${AXIS_ROOT}/cmake/package/documents.sh" "${AXIS_ROOT}/.github/CHANGELOG.md" VERBATIM)
add_custom_target(axistool_documents ALL DEPENDS "${DOCUMENTS}/stamp")

set(IN_PACKAGE COMPONENT axistool)
install(TARGETS axistool DESTINATION bin ${IN_PACKAGE})
install(DIRECTORY "${AXIS_ROOT}/host/hil/scenarios" DESTINATION share/axistool ${IN_PACKAGE})
install(DIRECTORY "${AXIS_ROOT}/host/commission/machines" DESTINATION share/axistool ${IN_PACKAGE})
install(DIRECTORY "${AXIS_ROOT}/tests/data/drive-cases/none/case-00/" DESTINATION share/axistool/drive ${IN_PACKAGE})
install(DIRECTORY "${DOCUMENTS}/man1" DESTINATION share/man ${IN_PACKAGE})
install(FILES "${DOCUMENTS}/axistool.bash" RENAME axistool DESTINATION share/bash-completion/completions ${IN_PACKAGE})
install(FILES "${DOCUMENTS}/axistool.zsh" RENAME _axistool DESTINATION "${AXIS_ZSH_DIR}" ${IN_PACKAGE})
install(FILES "${DOCUMENTS}/axistool.fish" DESTINATION share/fish/vendor_completions.d ${IN_PACKAGE})
install(FILES "${DOCUMENTS}/70-axis.rules" DESTINATION lib/udev/rules.d ${IN_PACKAGE})
install(FILES "${DOCUMENTS}/changelog.gz" "${DOCUMENTS}/copyright" DESTINATION share/doc/axistool ${IN_PACKAGE})

# The Python package, of the component "python": in the Debian package python3-axistool. Debian's Python looks in another
# folder below /usr/local than below /usr.
if(TARGET axis_python)
  set(AXIS_PYTHON_DIR "lib/python${Python3_VERSION_MAJOR}.${Python3_VERSION_MINOR}/dist-packages" CACHE STRING
      "Where Python looks for packages, below the prefix")
  install(DIRECTORY "${AXIS_ROOT}/host/python/axistool" DESTINATION "${AXIS_PYTHON_DIR}" COMPONENT python
    FILES_MATCHING PATTERN "*.py" PATTERN "*.pyi" PATTERN "py.typed" PATTERN "__pycache__" EXCLUDE)
  install(TARGETS axis_python LIBRARY DESTINATION "${AXIS_PYTHON_DIR}/axistool" COMPONENT python)
  install(FILES "${DOCUMENTS}/changelog.gz" "${DOCUMENTS}/copyright" DESTINATION share/doc/python3-axistool COMPONENT python)
endif()

# The library for C++, of the component "development": find_package(axis), target axis::host.
set(FOR_CPP COMPONENT development)
install(TARGETS axis_host axis_computing axis_sim axis_hal_usbip ARCHIVE DESTINATION lib/axis ${FOR_CPP})
install(DIRECTORY "${AXIS_ROOT}/host" "${AXIS_ROOT}/sim" "${AXIS_ROOT}/hal" "${AXIS_ROOT}/firmware"
  DESTINATION include/axis ${FOR_CPP} FILES_MATCHING PATTERN "*.hpp" PATTERN "axistool" EXCLUDE
  PATTERN "workbench" EXCLUDE PATTERN "boards" EXCLUDE)
include(CMakePackageConfigHelpers)
write_basic_package_version_file("${CMAKE_BINARY_DIR}/axis-config-version.cmake" VERSION ${AXIS_VERSION}
                                 COMPATIBILITY SameMinorVersion)
install(FILES "${AXIS_ROOT}/cmake/package/axis-config.cmake" "${CMAKE_BINARY_DIR}/axis-config-version.cmake"
  DESTINATION lib/cmake/axis ${FOR_CPP})

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME axistool)
set(CPACK_PACKAGE_VERSION "${AXIS_VERSION}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_COMPONENTS_ALL axistool python)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_AXISTOOL_PACKAGE_NAME axistool)
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGE_DIRECTORY "${CMAKE_BINARY_DIR}")
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_MAINTAINER "The axis maintainers <maintainers@axis.invalid>")
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_AXISTOOL_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_AXISTOOL_PACKAGE_DEPENDS "libhidapi-hidraw0")  # loaded at run time, as these are
set(CPACK_DEBIAN_AXISTOOL_PACKAGE_RECOMMENDS "${AXIS_READER_PACKAGES}")  # one a kind of log
set(CPACK_DEBIAN_AXISTOOL_PACKAGE_SUGGESTS "dfu-util, openocd")
set(CPACK_DEBIAN_AXISTOOL_DESCRIPTION "identify feed drives and find the physical effect a model lacks
axistool identifies the drives of machine tools from measurements (inertia,
friction, tachometer, noise), compares models with records, names the physical
effect that a model lacks, and designs the estimator and controller of an
axis board.

It sets the parameters of boards over USB, moves their axes and captures
records; a simulated board takes the place of a real one for trying it out.")
if(TARGET axis_python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-axistool)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
  math(EXPR NEXT_PYTHON "${Python3_VERSION_MINOR} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3 (>= 3.${Python3_VERSION_MINOR}~), python3 (<< 3.${NEXT_PYTHON}), python3-numpy, libhidapi-hidraw0")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS "axistool, ${AXIS_READER_PACKAGES}")  # the udev rule and the shipped drive come with the program
  set(CPACK_DEBIAN_PYTHON_DESCRIPTION "identify feed drives from Python
The analysis of axistool as functions of Python with typed results: records
as NumPy arrays, models, identify, compare, diagnose, add, improve, design,
and captures from boards. The figures are those of the command line.")
  # Byte code is written at installation and removed with the package, as by dh_python3.
  set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA "${AXIS_ROOT}/cmake/package/postinst;${AXIS_ROOT}/cmake/package/prerm")
else()
  set(CPACK_COMPONENTS_ALL axistool)
endif()
include(CPack)
