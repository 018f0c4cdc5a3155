# TinyUSB's device stack, compiled from the sources in Debian's package. Its warnings are ignored.
include_guard()
axis_newer_package(tinyusb-source TINYUSB_PACKAGE REQUIRED)
set(TINYUSB "${TINYUSB_PACKAGE}/usr/src/tinyusb/src")
set(TINYUSB_SOURCES "${TINYUSB}/tusb.c" "${TINYUSB}/common/tusb_fifo.c" "${TINYUSB}/device/usbd.c"
    "${TINYUSB}/device/usbd_control.c")
# Its driver for the controller of the STM32F4.
set(TINYUSB_DWC2_SOURCES "${TINYUSB}/portable/synopsys/dwc2/dcd_dwc2.c" "${TINYUSB}/portable/synopsys/dwc2/dwc2_common.c")
file(GLOB HID_FUNCTION_SOURCES CONFIGURE_DEPENDS "${AXIS_ROOT}/hal/tinyusb/*.cpp")

# axis_usb_device(TARGET MCU [SOURCE...]): adds the stack, the HID function and SOURCEs of a controller driver.
function(axis_usb_device TARGET MCU)
  set(C_SOURCES ${TINYUSB_SOURCES} ${ARGN})
  list(FILTER C_SOURCES INCLUDE REGEX "\\.c$")
  set(C_OPTIONS -w -ffunction-sections -fno-sanitize=pointer-overflow)  # it advances null pointers by nothing
  set_source_files_properties(${C_SOURCES} PROPERTIES COMPILE_OPTIONS "${C_OPTIONS}")
  set_source_files_properties("${TINYUSB}/device/usbd.c" PROPERTIES COMPILE_OPTIONS
    "${C_OPTIONS};-Dtud_control_xfer=give_to_host")  # hal/tinyusb/hid_function.cpp
  target_sources(${TARGET} PRIVATE ${TINYUSB_SOURCES} ${HID_FUNCTION_SOURCES} ${ARGN})
  if(NOT CMAKE_SYSTEM_NAME STREQUAL "Generic")
    target_sources(${TARGET} PRIVATE "${AXIS_ROOT}/hal/usbip/stack_clock.cpp")
  endif()
  target_include_directories(${TARGET} PRIVATE "${AXIS_ROOT}/hal/tinyusb")
  target_include_directories(${TARGET} SYSTEM PRIVATE "${TINYUSB}")
  target_link_options(${TARGET} PUBLIC -Wl,--gc-sections)  # its delays would need a clock; nothing calls them
  target_compile_definitions(${TARGET} PRIVATE CFG_TUSB_MCU=${MCU})
endfunction()
