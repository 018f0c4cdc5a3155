#include "host/report/assets.hpp"

#include <algorithm>

// The assembler copies each file into the read-only data; CMake names the paths and rebuilds when a file changes.
#define AXIS_EMBED(SYMBOL, FILE_NAME)                                             \
  asm(".section .rodata\n" #SYMBOL "_begin:\n.incbin \"" FILE_NAME "\"\n" #SYMBOL \
      "_end:\n.byte 0\n"                                                          \
      ".previous\n");                                                             \
  extern "C" const char SYMBOL##_begin[];                                         \
  extern "C" const char SYMBOL##_end[]

AXIS_EMBED(axis_dygraphs_script, AXIS_DYGRAPHS_DIR "/dygraph.min.js");
AXIS_EMBED(axis_synchronizer_script, AXIS_DYGRAPHS_DIR "/src-es5/extras/synchronizer.js");
AXIS_EMBED(axis_dygraphs_style, AXIS_DYGRAPHS_DIR "/dygraph.min.css");
AXIS_EMBED(axis_heat_map_script, AXIS_REPORT_DIR "/heat_map.js");
AXIS_EMBED(axis_report_script, AXIS_REPORT_DIR "/report.js");
AXIS_EMBED(axis_report_style, AXIS_REPORT_DIR "/report.css");

namespace host::assets {

namespace {

/// A source map is of no use inside a report, and a browser would look for its file.
std::string_view without_source_map(std::string_view text) {
  return text.substr(0,
                     std::min({text.size(), text.rfind("//# sourceMappingURL="), text.rfind("/*# sourceMappingURL=")}));
}

std::string_view embedded(const char* begin, const char* end) { return {begin, static_cast<std::size_t>(end - begin)}; }

}  // namespace

std::string_view dygraphs_script() {
  return without_source_map(embedded(axis_dygraphs_script_begin, axis_dygraphs_script_end));
}
std::string_view synchronizer_script() {
  return without_source_map(embedded(axis_synchronizer_script_begin, axis_synchronizer_script_end));
}
std::string_view dygraphs_style() {
  return without_source_map(embedded(axis_dygraphs_style_begin, axis_dygraphs_style_end));
}
std::string_view heat_map_script() { return embedded(axis_heat_map_script_begin, axis_heat_map_script_end); }
std::string_view report_script() { return embedded(axis_report_script_begin, axis_report_script_end); }
std::string_view report_style() { return embedded(axis_report_style_begin, axis_report_style_end); }

}  // namespace host::assets
