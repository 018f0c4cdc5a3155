# How an image for the microcontroller is built, axis_image(), and the boot code in front of it, axis_boot_code().
include(AxisVersion)
set(AXIS_IMAGES "${CMAKE_BINARY_DIR}/images")
file(MAKE_DIRECTORY "${AXIS_IMAGES}")

# The program that completes image headers runs on this machine, so this machine's compiler builds it.
find_program(BUILD_MACHINE_CXX NAMES g++ c++ REQUIRED)
set(STAMP_IMAGE "${CMAKE_BINARY_DIR}/stamp_image")
add_custom_command(OUTPUT "${STAMP_IMAGE}"
  COMMAND "${BUILD_MACHINE_CXX}" -std=c++20 -O1 -I "${AXIS_ROOT}" "${AXIS_ROOT}/host/stamp_image/main.cpp" -o "${STAMP_IMAGE}"
  DEPENDS "${AXIS_ROOT}/host/stamp_image/main.cpp" "${AXIS_ROOT}/firmware/app/image_header.hpp"
          "${AXIS_ROOT}/firmware/app/crc32.hpp")
add_custom_target(stamp_program DEPENDS "${STAMP_IMAGE}")

set(CPU_FLAGS_m4 -mcpu=cortex-m4 -mthumb -mfloat-abi=hard -mfpu=fpv4-sp-d16)
set(CPU_FLAGS_m3 -mcpu=cortex-m3 -mthumb)
set(CPU_FLAGS_m0plus -mcpu=cortex-m0plus -mthumb)

# Contraction is off on every machine. With contraction, a multiplication and an addition would round once on one
# machine and twice on another.
add_library(axis_target_flags INTERFACE)
target_link_libraries(axis_target_flags INTERFACE axis_core_flags)
# Fixed-point operations are long, and -O3 copies them: 13 KB of flash to save 5 % of the instructions.
target_compile_options(axis_target_flags INTERFACE $<IF:$<BOOL:$<TARGET_PROPERTY:AXIS_FIXED_POINT>>,-O2,-O3>
  -fno-schedule-insns -g -ffp-contract=off -fno-exceptions -fno-rtti -fno-threadsafe-statics
  -fno-use-cxa-atexit -ffunction-sections -fdata-sections -fno-common -fstack-usage -fcallgraph-info=su)
target_link_options(axis_target_flags INTERFACE -nostartfiles --specs=nano.specs --specs=nosys.specs -Wl,--gc-sections
  -Wl,--no-warn-rwx-segments)

file(GLOB COMMON_SOURCES CONFIGURE_DEPENDS "${AXIS_ROOT}/firmware/boards/image/*.cpp")

# axis_boot_code(NAME CPU m4 BOARD folder HEADER board.hpp): images/NAME.elf, the boot code of a board whose folder has
# boot_memory.ld.
function(axis_boot_code NAME)
  cmake_parse_arguments(BOOT "" "CPU;BOARD;HEADER" "" ${ARGN})
  add_executable(${NAME} "${AXIS_ROOT}/firmware/boards/boot/boot.cpp")
  target_link_libraries(${NAME} PRIVATE axis_target_flags)
  target_compile_definitions(${NAME} PRIVATE "AXIS_BOOT_BOARD=\"${BOOT_HEADER}\"")
  target_compile_options(${NAME} PRIVATE ${CPU_FLAGS_${BOOT_CPU}})
  set_source_files_properties("${AXIS_ROOT}/firmware/boards/boot/boot.cpp" PROPERTIES COMPILE_OPTIONS -Os)
  target_link_options(${NAME} PRIVATE ${CPU_FLAGS_${BOOT_CPU}} -L "${AXIS_ROOT}/firmware/boards/boot"
    -T "${BOOT_BOARD}/boot_memory.ld" "-Wl,-Map=${AXIS_IMAGES}/${NAME}.map")
  set_target_properties(${NAME} PROPERTIES RUNTIME_OUTPUT_DIRECTORY "${AXIS_IMAGES}" SUFFIX .elf
    LINK_DEPENDS "${BOOT_BOARD}/boot_memory.ld;${AXIS_ROOT}/firmware/boards/boot/boot.ld")
endfunction()

# axis_image(NAME CPU m4|m3|m0plus BOARD folder [MEMORY script] [BOOT target address] [DEFINES ...] SOURCES ...):
# images/NAME.elf, .bin and .hex with a complete header, and NAME.map beside them. With BOOT the .bin and the .hex hold
# that boot code, from `address` on, in front of the program.
function(axis_image NAME)
  cmake_parse_arguments(IMAGE "" "CPU;BOARD;MEMORY" "BOOT;DEFINES;SOURCES" ${ARGN})
  set(MEMORY "${AXIS_ROOT}/firmware/boards/${IMAGE_BOARD}/memory.ld")
  if(IMAGE_MEMORY)
    set(MEMORY "${IMAGE_MEMORY}")
  endif()
  add_executable(${NAME} ${COMMON_SOURCES} ${IMAGE_SOURCES})
  add_dependencies(${NAME} build_version)
  target_link_libraries(${NAME} PRIVATE axis_target_flags)
  target_include_directories(${NAME} PRIVATE "${CMAKE_BINARY_DIR}/version")
  target_compile_definitions(${NAME} PRIVATE "AXIS_BOARD_NAME=\"${IMAGE_BOARD}\"" ${IMAGE_DEFINES})
  target_compile_options(${NAME} PRIVATE ${CPU_FLAGS_${IMAGE_CPU}})
  target_link_options(${NAME} PRIVATE ${CPU_FLAGS_${IMAGE_CPU}} -L "${AXIS_ROOT}/firmware/boards/image"
    -T "${MEMORY}" "-Wl,-Map=${AXIS_IMAGES}/${NAME}.map")
  if("${IMAGE_DEFINES}" MATCHES "AXIS_SCALAR_FIXED|FixedPoint")
    set_target_properties(${NAME} PROPERTIES AXIS_FIXED_POINT ON)
  endif()
  set_target_properties(${NAME} PROPERTIES RUNTIME_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/linked" SUFFIX .elf
    LINK_DEPENDS "${MEMORY};${AXIS_ROOT}/firmware/boards/image/sections.ld")
  set(IMAGE "${AXIS_IMAGES}/${NAME}")
  set(BOOT "")
  if(IMAGE_BOOT)
    list(GET IMAGE_BOOT 0 BOOT)
    list(GET IMAGE_BOOT 1 ADDRESS)
    math(EXPR PROGRAM "${ADDRESS} + 0x4000" OUTPUT_FORMAT HEXADECIMAL)  # kBootCodeSize
    set(MERGE
      COMMAND "${CMAKE_OBJCOPY}" -O binary --gap-fill 0xFF --pad-to ${PROGRAM} "$<TARGET_FILE:${BOOT}>" "${IMAGE}.boot"
      COMMAND "${CMAKE_COMMAND}" -E rename "${IMAGE}.bin" "${IMAGE}.program"
      COMMAND "${CMAKE_COMMAND}" -E cat "${IMAGE}.boot" "${IMAGE}.program" > "${IMAGE}.bin"
      COMMAND "${CMAKE_OBJCOPY}" -I binary -O ihex --change-addresses ${ADDRESS} "${IMAGE}.bin" "${IMAGE}.hex"
      COMMAND "${CMAKE_COMMAND}" -E rm "${IMAGE}.boot" "${IMAGE}.program")
  endif()
  add_custom_command(OUTPUT "${IMAGE}.elf" "${IMAGE}.bin" "${IMAGE}.hex"
    COMMAND "${CMAKE_OBJCOPY}" -O binary "$<TARGET_FILE:${NAME}>" "${IMAGE}.unstamped"
    COMMAND "${STAMP_IMAGE}" "${IMAGE}.unstamped" "${IMAGE}.header"
    COMMAND "${CMAKE_OBJCOPY}" --update-section ".image_header=${IMAGE}.header" "$<TARGET_FILE:${NAME}>" "${IMAGE}.elf"
    COMMAND "${CMAKE_OBJCOPY}" -O binary "${IMAGE}.elf" "${IMAGE}.bin"
    COMMAND "${CMAKE_OBJCOPY}" -O ihex "${IMAGE}.elf" "${IMAGE}.hex"
    COMMAND "${CMAKE_COMMAND}" -E rm "${IMAGE}.unstamped" "${IMAGE}.header"
    ${MERGE}
    DEPENDS ${NAME} ${BOOT} stamp_program "${STAMP_IMAGE}")
  add_custom_target(${NAME}_image ALL DEPENDS "${IMAGE}.elf")
endfunction()
