// Files that are embedded in the program at build time.
#pragma once

#include <cstddef>
#include <string_view>

// The assembler copies the file into the read-only data; CMake names the path and rebuilds when the file changes.
#define AXIS_EMBED(SYMBOL, FILE_NAME)                                             \
  asm(".section .rodata\n" #SYMBOL "_begin:\n.incbin \"" FILE_NAME "\"\n" #SYMBOL \
      "_end:\n.byte 0\n"                                                          \
      ".previous\n");                                                             \
  extern "C" const char SYMBOL##_begin[];                                         \
  extern "C" const char SYMBOL##_end[]

namespace host {

inline std::string_view embedded_file(const char* begin, const char* end) {
  return {begin, static_cast<std::size_t>(end - begin)};
}

}  // namespace host
