# Compiler flags that every target of the project shares. Warnings are errors.
add_library(axis_flags INTERFACE)
target_include_directories(axis_flags INTERFACE "${AXIS_ROOT}")
target_compile_options(axis_flags INTERFACE -Wall -Wextra -Wpedantic
                       # If sources are compiled together, a local name may also exist in another source.
                       $<$<NOT:$<OR:$<BOOL:${AXIS_UNITY}>,$<BOOL:$<TARGET_PROPERTY:UNITY_BUILD>>>>:-Wshadow> -Wconversion -Wno-sign-conversion -Werror
                       -ffp-contract=off)
if(AXIS_UNITY AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # For larger files: the compiler collects free memory less often. This saves a twelfth of its time and takes at most
  # 130 MB more.
  target_compile_options(axis_flags INTERFACE --param=ggc-min-expand=300 --param=ggc-min-heapsize=600000)
endif()
if(AXIS_SANITIZE)
  target_compile_options(axis_flags INTERFACE -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer
                         -O1 -g1)
  target_link_options(axis_flags INTERFACE -fsanitize=address,undefined)
endif()
# The host tools omit checks that the address sanitizer or the processor also makes: they take a third of the compile
# time.
add_library(axis_host_flags INTERFACE)  # linked after axis_flags
if(AXIS_SANITIZE)
  target_compile_options(axis_host_flags INTERFACE -fno-sanitize=null,alignment,vptr,object-size,pointer-overflow)
endif()
if(AXIS_FUZZ)
  target_compile_options(axis_flags INTERFACE -fsanitize=fuzzer-no-link)
endif()

# The control core is compiled for a microcontroller too: on the host it obeys the same restrictions.
add_library(axis_core_flags INTERFACE)
target_link_libraries(axis_core_flags INTERFACE axis_flags)
target_compile_options(axis_core_flags INTERFACE -Wdouble-promotion -Wfloat-conversion)
