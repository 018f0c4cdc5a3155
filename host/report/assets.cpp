#include "host/report/assets.hpp"

#include <algorithm>

#include "host/embedded_file.hpp"

AXIS_EMBED(axis_dygraphs_script, AXIS_DYGRAPHS_DIR "/dygraph.min.js");
AXIS_EMBED(axis_synchronizer_script, AXIS_DYGRAPHS_DIR "/src-es5/extras/synchronizer.js");
AXIS_EMBED(axis_dygraphs_style, AXIS_DYGRAPHS_DIR "/dygraph.min.css");
AXIS_EMBED(axis_heat_map_script, AXIS_REPORT_DIR "/heat_map.js");
AXIS_EMBED(axis_report_script, AXIS_REPORT_DIR "/report.js");
AXIS_EMBED(axis_report_style, AXIS_REPORT_DIR "/report.css");

namespace host::assets {

namespace {

/// Removes the reference to a source map. It is of no use in a report, and a browser would look for the file.
std::string_view without_source_map(std::string_view text) {
  return text.substr(0,
                     std::min({text.size(), text.rfind("//# sourceMappingURL="), text.rfind("/*# sourceMappingURL=")}));
}

}  // namespace

std::string_view dygraphs_script() {
  return without_source_map(embedded_file(axis_dygraphs_script_begin, axis_dygraphs_script_end));
}
std::string_view synchronizer_script() {
  return without_source_map(embedded_file(axis_synchronizer_script_begin, axis_synchronizer_script_end));
}
std::string_view dygraphs_style() {
  return without_source_map(embedded_file(axis_dygraphs_style_begin, axis_dygraphs_style_end));
}
std::string_view heat_map_script() { return embedded_file(axis_heat_map_script_begin, axis_heat_map_script_end); }
std::string_view report_script() { return embedded_file(axis_report_script_begin, axis_report_script_end); }
std::string_view report_style() { return embedded_file(axis_report_style_begin, axis_report_style_end); }

}  // namespace host::assets
